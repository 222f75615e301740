# SPDX-License-Identifier: MIT
"""Rule: no message on cmd_vel ends the node, moves the robot faster than the bounds, or moves it while the node is not
active; behind shutdown nothing moves it."""

from __future__ import annotations

import math
import random
import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from argus_ros import argus_node
from argus_ros.argus_node import ArgusNode
from argus_ros.intake import UNFORESEEN
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.parameter import Parameter
from test_intake import OK, random_float, random_stamp

MOST_MM_S, MOST_DEG_S = 300, 57
STEP_S = 0.01


class Recorded:
    """Stands for the wheels: keeps what they are ordered."""

    made: list[Recorded]

    def __init__(self, host: str, port: int, timeout_s: float, tell: Callable[[str], None]) -> None:
        del host, port, tell
        self.timeout_s = timeout_s
        self.orders: list[tuple[int, int]] = []
        self.connected, self.is_closed, self.why_not = True, False, ""
        Recorded.made.append(self)

    def drive(self, speed_mm_s: int, turn_deg_s: int) -> bool:
        assert not self.is_closed, "an order behind the end"
        self.orders.append((speed_mm_s, turn_deg_s))
        return True

    def halt(self) -> None:
        if self.orders:
            self.orders.append((0, 0))

    def close(self) -> None:
        self.is_closed = True


class Stormed:
    """A node whose callbacks are called as the executor would, and what it publishes and orders."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        Recorded.made = []
        monkeypatch.setattr(argus_node, "Wheels", Recorded)
        given = {
            "control": "unix:/nonexistent/argus.sock",
            "guard": "127.0.0.1:1",
            "max_speed_m_s": MOST_MM_S / 1000,
            "max_turn_rad_s": 1.0,
        }
        self.node = ArgusNode(parameter_overrides=[Parameter(k, value=v) for k, v in given.items()])
        self.diagnoses: list[Any] = []
        self.takes: dict[str, Callable[[Any], None]] = {}
        subscribe, publish = self.node.take_topic, self.node.publisher

        def take_topic(kind: Any, topic: str, take: Callable[[Any], None], qos: Any) -> None:
            self.takes[topic] = take
            subscribe(kind, topic, take, qos)

        def publisher(kind: Any, topic: str, qos: Any = 10) -> Any:
            made = publish(kind, topic, qos)
            if topic == "/diagnostics":
                monkeypatch.setattr(made, "publish", self.diagnoses.append)
            return made

        monkeypatch.setattr(self.node, "take_topic", take_topic)
        monkeypatch.setattr(self.node, "publisher", publisher)
        self.node.start()

    @property
    def wheels(self) -> Recorded:
        return Recorded.made[-1]

    def plain(self, message: Any) -> None:
        self.takes["cmd_vel"](message)

    def stamped(self, message: Any) -> None:
        """As the second participant hands one over."""
        if self.node._stamped is not None:
            self.node._stamped._kept.append(message)
        self.node._take_stamped()


@pytest.fixture
def stormed(monkeypatch: pytest.MonkeyPatch) -> Iterator[Stormed]:
    one = Stormed(monkeypatch)
    yield one
    one.node.destroy_node()


def random_twist(chance: random.Random) -> Any:
    twist = Twist()
    for part in (twist.linear, twist.angular):
        for axis in "xyz":
            if chance.random() < 0.5:
                setattr(part, axis, random_float(chance))
    if chance.random() < 0.3:
        twist.linear.x, twist.angular.z = chance.uniform(-1, 1), chance.uniform(-2, 2)
    return twist


def send(one: Stormed, chance: random.Random) -> Any:
    """Give one random message of either type; return its twist."""
    twist = random_twist(chance)
    if chance.random() < 0.5:
        one.plain(twist)
        return twist
    message = TwistStamped(twist=twist)
    message.header.stamp = random_stamp(chance, one.node.get_clock().now().nanoseconds / 1e9)
    one.stamped(message)
    return twist


def change(one: Stormed, chance: random.Random, cleanups: float) -> None:
    """Make a random transition from an active node, and come back; `cleanups`: how often it is configured anew."""
    node = one.node
    node.trigger_deactivate()
    orders = one.wheels.orders
    assert orders == [] or orders[-1] == (0, 0)
    count = len(orders)
    for _ in range(20):
        send(one, chance)
    assert len(orders) == count, "an order while the node is not active"
    if chance.random() < cleanups:
        before = one.wheels
        node.trigger_cleanup()
        assert before.is_closed
        for _ in range(20):
            send(one, chance)
        assert node.trigger_configure() == TransitionCallbackReturn.SUCCESS
    node.trigger_activate()


def storm(one: Stormed, count: int, seed: int, cleanups: float = 0.3) -> None:
    print(f"seed {seed}")
    chance = random.Random(seed)
    driven = 0
    for k in range(count):
        orders = one.wheels.orders
        before = len(orders)
        twist = send(one, chance)
        for speed, turn in orders[before:]:
            assert isinstance(speed, int)
            assert isinstance(turn, int)
            assert abs(speed) <= MOST_MM_S
            assert abs(turn) <= MOST_DEG_S
            driven += (speed, turn) != (0, 0)
        if not (math.isfinite(twist.linear.x) and math.isfinite(twist.angular.z)):
            assert orders[before:] in ([], [(0, 0)]), "a speed that is no number moves it"
        if k % 100 == 0:
            one.node._tick()
            one.node._diagnose()
            # No argusd is here, so nothing is judged.
            assert all(array.status[0].level != OK for array in one.diagnoses)
            one.diagnoses.clear()
            del orders[:-1]
        if k % 500 == 499:
            change(one, chance, cleanups)
    assert driven > count / 20
    reasons = {why for counts in one.node._intake.counts.values() for why in counts}
    assert not [why for why in reasons if why.startswith(UNFORESEEN)]
    one.node.trigger_shutdown()
    assert all(wheels.is_closed for wheels in Recorded.made)
    last = list(one.wheels.orders)
    assert last[-1:] in ([], [(0, 0)])  # one that was just made has no orders
    for _ in range(200):
        send(one, chance)
    assert one.wheels.orders == last


@pytest.mark.parametrize("seed", [1, 2])
def test_random_orders_end_no_node_and_move_it_within_bounds(stormed: Stormed, seed: int) -> None:
    storm(stormed, 4000, seed)


@pytest.mark.soak
def test_a_million_random_orders(stormed: Stormed) -> None:
    storm(stormed, 1_000_000, 3, cleanups=0.03)
    assert threading.active_count() <= 3
