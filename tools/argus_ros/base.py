# SPDX-License-Identifier: MIT
"""What both nodes share: parameters with descriptions, errors of one line, lifecycle, the frames of the sonars."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import Any, Final

import rclpy
from argus_tools.formats.base import LogError
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.exceptions import ParameterException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.qos import DurabilityPolicy, QoSProfile

from argus_ros.repair import Dead, NoEcho, Policy, Trust
from hil_sim.errors import SimError
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
LATCHED: Final = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Refused(Exception):
    """A parameter does not hold; the text is one line that says what to give."""


class ArgusLifecycleNode(LifecycleNode):  # type: ignore[misc]
    """A lifecycle node whose parameters come from a table, and that may start by itself."""

    def __init__(self, name: str, table: dict[str, tuple[Any, str]]) -> None:
        super().__init__(name)
        self._table_of_parameters = table
        for key, (default, meaning) in table.items():
            self.declare_parameter(key, default, ParameterDescriptor(description=meaning))

    def value(self, key: str) -> Any:
        """Return a parameter."""
        return self.get_parameter(key).value

    def start(self) -> None:
        """Configure and activate, unless another node is to do it."""
        if not self.value("autostart"):
            return
        if self.trigger_configure() != TransitionCallbackReturn.SUCCESS:
            raise Refused("the node cannot be configured")
        self.trigger_activate()

    def chosen(self, key: str, choices: type[Any]) -> Any:
        """Return the member of an enumeration that a parameter names."""
        try:
            return choices(self.value(key))
        except ValueError:
            names = " or ".join(choice.value for choice in choices)
            raise Refused(f"parameter {key} is '{self.value(key)}': give {names}") from None

    def policy(self) -> Policy:
        """Return how readings are repaired."""
        return Policy(self.chosen("dead", Dead), self.chosen("no_echo", NoEcho), self.chosen("trust", Trust))

    def robot(self) -> RobotTable:
        """Return the table of the robot that a parameter names."""
        try:
            return robot_table(self.value("robot"))
        except SimError as error:
            raise Refused(f"parameter robot: {error}") from error

    def checked(self, configure: Callable[[], None]) -> Any:
        """Run what configures; one line tells what is wrong."""
        try:
            configure()
        except (Refused, LogError, SimError) as error:
            self.get_logger().error(str(error))
            self.refusal = str(error)
            return TransitionCallbackReturn.FAILURE
        return TransitionCallbackReturn.SUCCESS

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

    refusal = ""


def run_node(make: Callable[[], ArgusLifecycleNode], arguments: Sequence[str]) -> int:
    """Run a node to its end; return the exit code."""
    rclpy.init(args=[sys.argv[0], *arguments])
    try:
        node = make()
    except ParameterException as error:
        print(f"{error}; see --help", file=sys.stderr)
        rclpy.try_shutdown()
        return EXIT_USAGE
    except KeyboardInterrupt:
        return 0
    try:
        node.start()
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        executor.spin()
    except Refused as error:
        print(f"{node.get_name()}: {node.refusal or error}", file=sys.stderr)
        return EXIT_USAGE
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
    return 0
