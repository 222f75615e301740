# SPDX-License-Identifier: MIT
"""What both nodes share: parameters with descriptions, errors of one line, lifecycle, the frames of the sonars."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Final

import rclpy
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy._rclpy_pybind11 import RCLError
from rclpy.clock import Clock, ClockType
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.exceptions import InvalidParameterValueException, ParameterException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_policy_name_from_kind

from argus_ros import messages, parameters
from argus_ros.parameters import Parameter, Read
from argus_ros.repair import Dead, NoEcho, Policy, Trust
from hil_sim.tables.robot import RobotTable, robot_table

try:
    from tf2_msgs.msg import TFMessage as TFMessage
except ImportError:  # no part of the packages on PyPI; docs/ros.md says how it is made there
    TFMessage = None
try:
    from p2os_msgs.msg import SonarArray as SonarArray
except ImportError:  # a package of p2os2, where that driver is
    SonarArray = None

EXIT_USAGE: Final = 2
TICK_S: Final = 0.1
_RAISED_MAX: Final = 16
LATCHED: Final = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Refused(Exception):
    """A parameter does not hold; the text is one line that says what to give."""


class ArgusLifecycleNode(LifecycleNode):  # type: ignore[misc]
    """A lifecycle node whose parameters come from a table, and that may start by itself.

    A node has `_configure`, which makes its parts, `_rest`, which stops what moves, and `_tick`. In every state but
    active it takes nothing and publishes nothing. Where a state ends by cleanup, shutdown or error, all parts end.
    """

    refusal = ""

    def __init__(self, name: str, table: parameters.Table, **options: Any) -> None:
        self._active = self._is_configured = False
        self._parts: list[Any] = []
        self._taken: dict[str, str] = {}
        self._mismatched: dict[str, str] = {}
        self._raised: Counter[str] = Counter()
        self._table_of_parameters = table
        super().__init__(name, **options)
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.add_on_set_parameters_callback(self._judge_parameters)
        for key, parameter in table.items():
            try:
                self.declare_parameter(key, parameter.default, _descriptor(parameter))
            except ParameterException as error:
                raise Refused(self._why_not(key, parameter, error)) from error
        self.owner = self.get_fully_qualified_name().strip("/")
        self.prefix = ""

    def _why_not(self, key: str, parameter: Parameter, error: Exception) -> str:
        """Return one line about what was given for a parameter."""
        if not isinstance(error, InvalidParameterValueException):
            return str(error)  # of another type
        given = self._parameter_overrides[key].value
        return f"parameter {key} is '{given}': {parameter.why_not(given)}"

    def value(self, key: str) -> Any:
        """Return a parameter."""
        return self.get_parameter(key).value

    def frame(self, key: str) -> str:
        """Return the frame that a parameter says, with the prefix of all frames."""
        return f"{self.prefix}{self.value(key)}"

    def _judge_parameters(self, given: list[Any]) -> Any:
        """Refuse what does not hold, and what would have no effect."""
        for one in given:
            parameter = self._table_of_parameters.get(one.name)
            if parameter is None:
                continue
            why = parameter.why_not(one.value)
            if not why and self._is_configured and parameter.read is Read.CONFIGURE:
                why = "it is read when the node is configured: deactivate and clean up first"
            if why:
                return SetParametersResult(successful=False, reason=f"{one.name}: {why}")
        return SetParametersResult(successful=True)

    def start(self) -> None:
        """Configure and activate, unless another node is to do it."""
        if not self.value("autostart"):
            return
        if self.trigger_configure() != TransitionCallbackReturn.SUCCESS:
            raise Refused("the node cannot be configured")
        self.trigger_activate()

    def policy(self) -> Policy:
        """Return how readings are repaired."""
        return Policy(Dead(self.value("dead")), NoEcho(self.value("no_echo")), Trust(self.value("trust")))

    def robot(self) -> RobotTable:
        """Return the table of the robot that a parameter names."""
        return robot_table(self.value("robot"))

    # ---- lifecycle

    def on_configure(self, state: Any) -> Any:
        """Read the parameters and make all parts; one line tells what is wrong."""
        del state
        self.refusal = ""
        self.prefix = self.value("frame_prefix")
        if self.prefix == parameters.AUTO:
            namespace = self.get_namespace().strip("/")
            self.prefix = f"{namespace}/" if namespace else ""
        try:
            self._configure()
            self._parts.append(self.create_timer(TICK_S, self._tick, clock=self._steady))
        except Exception as error:  # rclpy would swallow any without a word
            self.refusal = " ".join(str(error).split()) or type(error).__name__
            self.get_logger().error(self.refusal)
            self._end()
            return TransitionCallbackReturn.FAILURE
        self._is_configured = True
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: Any) -> Any:
        """Begin to take and to publish."""
        self._active = True
        return super().on_activate(state)

    def on_deactivate(self, state: Any) -> Any:
        """Stop what moves, take nothing, publish nothing."""
        self._active = False
        self._rest()
        return super().on_deactivate(state)

    def on_cleanup(self, state: Any) -> Any:
        """End all parts; what was learned is forgotten."""
        del state
        self._end()
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: Any) -> Any:
        """End all parts for ever."""
        result = self.on_cleanup(state)
        self._finish()
        return result

    def on_error(self, state: Any) -> Any:
        """End all parts after a transition that failed; the node may be configured again."""
        return self.on_cleanup(state)

    def _end(self) -> None:
        """End all parts; one that raises keeps no other from its end."""
        self._active = self._is_configured = False
        parts, self._parts = self._parts, []
        self._taken.clear()
        self._mismatched.clear()
        steps: list[Callable[[], None]] = [self._rest, self._close]
        steps += [partial(self.discard, part) for part in parts]
        for step in steps:
            try:
                step()
            except Exception as error:
                self.note_raised(error)

    def destroy_node(self) -> None:
        """End all parts, then the node; it may be one that was not made whole."""
        self._end()
        self._finish()
        super().destroy_node()

    # ---- topics

    def publisher(self, kind: Any, topic: str, qos: Any = 10) -> Any:
        """Make a publisher that is a part of this node, and hears of subscribers that cannot be served."""
        events = PublisherEventCallbacks(incompatible_qos=self._mismatch(topic, "a subscriber asks"))
        made = self.create_publisher(kind, topic, qos, event_callbacks=events)
        self._parts.append(made)
        return made

    def take_topic(self, kind: Any, topic: str, take: Callable[[Any], None], qos: Any) -> None:
        """Make a subscription that is a part of this node, and hears of publishers that cannot be taken."""
        events = SubscriptionEventCallbacks(incompatible_qos=self._mismatch(topic, "a publisher offers"))
        self._taken[topic] = type_name(kind)
        self._parts.append(self.create_subscription(kind, topic, take, qos, event_callbacks=events))

    def note_raised(self, error: Exception) -> None:
        """Report what a callback raised, once for each kind, and count it."""
        words = f"{type(error).__name__}: {' '.join(str(error).split())}"
        if words not in self._raised and len(self._raised) < _RAISED_MAX:
            self.get_logger().error(f"a message or request was not handled: {words}")
        if words in self._raised or len(self._raised) < _RAISED_MAX:
            self._raised[words] += 1

    def _mismatch(self, topic: str, who: str) -> Callable[[Any], None]:
        def noted(event: Any) -> None:
            policy = qos_policy_name_from_kind(event.last_policy_kind)
            self._mismatched[topic] = f"{who} another QoS: {policy}"

        return noted

    def topics_status(self) -> Any:
        """Return whether all topics are joined to who is there for them: type and QoS have to fit."""
        found = dict(self._mismatched)
        for topic, kind in self._taken.items():
            types = {info.topic_type for info in self.get_publishers_info_by_topic(topic)}
            if others := sorted(types - {*kind.split()}):
                found[topic] = f"published as {others[0]}, taken as {kind}"
        found |= {words: f"not handled, {count} times" for words, count in self._raised.items()}
        words = "; ".join(f"{topic}: {why}" for topic, why in found.items()) or "all fit"
        level = messages.WARN if found else messages.OK
        return messages.status(level, f"{self.owner}: topics", words, "", found)

    def _configure(self) -> None:
        raise NotImplementedError

    def _tick(self) -> None:
        raise NotImplementedError

    def _rest(self) -> None:
        """Stop what moves."""

    def _close(self) -> None:
        """End threads and connections."""

    def _finish(self) -> None:
        """End what lives as long as the node."""

    def discard(self, part: Any) -> None:
        """Destroy a publisher, subscription, service, timer or guard condition of this node."""
        for destroy in (
            self.destroy_publisher,
            self.destroy_subscription,
            self.destroy_service,
            self.destroy_timer,
            self.destroy_guard_condition,
        ):
            if destroy(part):
                return


def type_name(kind: Any) -> str:
    """Return the name of a message's type as the graph has it."""
    package, _, _ = kind.__module__.partition(".")
    return f"{package}/msg/{kind.__name__}"


def _descriptor(parameter: Parameter) -> Any:
    """Return what `ros2 param describe` tells of a parameter."""
    made = ParameterDescriptor(
        description=parameter.meaning,
        read_only=parameter.read is Read.START,
        additional_constraints=" or ".join(parameter.choices),
    )
    if parameter.read is Read.CONFIGURE:
        made.additional_constraints = "read when the node is configured"
    if parameter.low is not None and parameter.high is not None:
        if isinstance(parameter.default, float):
            span = FloatingPointRange(from_value=parameter.low, to_value=parameter.high)
            made.floating_point_range = [span]
        else:
            made.integer_range = [IntegerRange(from_value=int(parameter.low), to_value=int(parameter.high))]
    return made


def spin(node: ArgusLifecycleNode, executor: Any) -> None:
    """Spin to the end of the context. What a callback raises ends no node: it is reported and counted.

    Our own callbacks raise for no message; some of rclpy's do, as that of /clock for a time before 1970.
    """
    while node.context.ok():
        try:
            executor.spin()
        except (KeyboardInterrupt, ExternalShutdownException):
            raise
        except Exception as error:
            node.note_raised(error)
        else:
            return


def run_node(make: Callable[[], ArgusLifecycleNode], arguments: Sequence[str]) -> int:
    """Run a node to its end; return the exit code."""
    try:
        rclpy.init(args=[sys.argv[0], *arguments])
    except RCLError as error:
        print(f"{' '.join(str(error).split())}; see --help", file=sys.stderr)
        return EXIT_USAGE
    try:
        node = make()
    except (Refused, ParameterException) as error:
        print(f"{error}; see --help", file=sys.stderr)
        rclpy.try_shutdown()
        return EXIT_USAGE
    except KeyboardInterrupt:
        return 0
    try:
        node.start()
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        spin(node, executor)
    except Refused as error:
        print(f"{node.get_name()}: {node.refusal or error}", file=sys.stderr)
        return EXIT_USAGE
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
    return 0
