# SPDX-License-Identifier: MIT
"""Rule: a node has one second participant for its life, which takes a topic as another type while the node is
configured, and nothing at any other time."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest
from argus_ros.argus_node import ArgusNode
from geometry_msgs.msg import TwistStamped
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter

NAME = "beside"


def ours() -> int:
    """How many second participants there are in this process."""
    return sum(thread.name == NAME for thread in threading.enumerate())


@pytest.fixture
def node() -> Iterator[Any]:
    given = {"control": "unix:/nonexistent/argus.sock", "guard": "127.0.0.1:1"}
    made = ArgusNode(parameter_overrides=[Parameter(k, value=v) for k, v in given.items()])
    yield made
    made.destroy_node()
    assert ours() == 0


def test_configured_again_and_again_it_has_one_participant(node: Any) -> None:
    kept = []
    for _ in range(12):
        node.trigger_configure()
        kept.append(node._stamped)
        assert ours() == 1
        node.trigger_cleanup()
    assert len(set(map(id, kept))) == 1


@pytest.fixture
def sender() -> Iterator[Any]:
    """A publisher of the second type, in a participant of its own."""
    context = Context()
    context.init()
    node = Node("sender", context=context)
    yield node.create_publisher(TwistStamped, "cmd_vel", 1)
    node.destroy_node()
    context.shutdown()


def await_takers(sender: Any, count: int) -> None:
    end = time.monotonic() + 90
    while sender.get_subscription_count() != count:
        assert time.monotonic() < end, f"{sender.get_subscription_count()} take it, not {count}"
        time.sleep(0.05)


@pytest.mark.parametrize("end", ["cleanup", "shutdown", "error"])
def test_it_takes_the_topic_only_while_the_node_is_configured(
    node: Any, sender: Any, end: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for _ in range(2 if end == "cleanup" else 1):
        node.trigger_configure()
        await_takers(sender, 1)
        if end == "error":
            node.trigger_activate()
            monkeypatch.setattr(node, "_rest", lambda: 1 / 0)  # in the transition, and in its error again
            node.trigger_deactivate()
        else:
            getattr(node, f"trigger_{end}")()
        await_takers(sender, 0)


def test_a_node_that_is_shut_down_has_none(node: Any) -> None:
    node.trigger_configure()
    node.trigger_shutdown()
    assert ours() == 0


def test_what_comes_late_is_not_taken(node: Any) -> None:
    node.trigger_configure()
    beside = node._stamped
    node.trigger_cleanup()
    beside._take(TwistStamped())
    assert beside.take() == []
