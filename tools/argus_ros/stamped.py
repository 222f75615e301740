# SPDX-License-Identifier: MIT
"""A second type on a topic, in a participant of its own: DDS lets one participant take each topic as one type."""

from __future__ import annotations

import contextlib
import threading
from collections import deque
from collections.abc import Callable
from typing import Any, Final

from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node

_JOIN_S: Final = 2.0


class Beside:
    """Takes a topic as another type beside the subscription of a node, and wakes the node for the newest message."""

    def __init__(self, node: Any, kind: Any, topic: str, qos: Any, wake: Callable[[], None]) -> None:
        self._kept: deque[Any] = deque(maxlen=1)
        self._wake = wake
        self._context = Context()
        self._context.init(domain_id=node.context.get_domain_id())
        self._node = Node(
            f"_{node.get_name()}_{kind.__name__.lower()}",  # hidden: it is a part of that node
            namespace=node.get_namespace(),
            context=self._context,
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        self._node.create_subscription(kind, node.resolve_topic_name(topic), self._take, qos)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._run, name=kind.__name__, daemon=True)
        self._thread.start()

    def take(self) -> list[Any]:
        """Return what came since the last call."""
        found = []
        while self._kept:
            found.append(self._kept.popleft())
        return found

    def close(self) -> None:
        """End the participant."""
        self._executor.shutdown()
        self._thread.join(_JOIN_S)
        self._node.destroy_node()
        self._context.try_shutdown()

    def _take(self, message: Any) -> None:
        self._kept.append(message)
        self._wake()

    def _run(self) -> None:
        with contextlib.suppress(ExternalShutdownException):
            self._executor.spin()
