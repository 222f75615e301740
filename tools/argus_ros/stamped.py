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
_DONE_S: Final = 5.0


class Beside:
    """Takes topics as another type beside the subscriptions of a node, and wakes the node for the newest message.

    There is one for the life of the node: it leaves a topic and takes it again, because a participant costs DDS much
    more than a subscription, and some hundreds made and destroyed in one process were seen to hang.
    """

    def __init__(self, node: Any) -> None:
        self._kept: deque[Any] = deque(maxlen=1)
        self._wake: Callable[[], None] | None = None
        self._subscription: Any = None
        self._context = Context()
        self._context.init(domain_id=node.context.get_domain_id())
        self._node = Node(
            f"_{node.get_name()}_beside",  # hidden: it is a part of that node
            namespace=node.get_namespace(),
            context=self._context,
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._run, name="beside", daemon=True)
        self._thread.start()

    def join(self, kind: Any, topic: str, qos: Any, wake: Callable[[], None]) -> None:
        """Begin to take a topic, whose name is the full one."""
        self._wake = wake

        def subscribe() -> None:
            self._subscription = self._node.create_subscription(kind, topic, self._take, qos)

        self._in_thread(subscribe)

    def leave(self) -> None:
        """Take nothing any more."""
        self._wake = None
        if self._subscription is not None:
            self._in_thread(lambda: self._node.destroy_subscription(self._subscription))
            self._subscription = None
        self._kept.clear()

    def take(self) -> list[Any]:
        """Return what came since the last call."""
        found = []
        while self._kept:
            found.append(self._kept.popleft())
        return found

    def close(self) -> None:
        """End the participant."""
        self.leave()
        self._executor.shutdown()
        self._thread.join(_JOIN_S)
        self._node.destroy_node()
        self._context.try_shutdown()

    def _in_thread(self, act: Callable[[], object]) -> None:
        """Do something where nothing waits on the node meanwhile."""
        done = threading.Event()

        def once() -> None:
            try:
                act()
            finally:
                done.set()

        self._executor.create_task(once)
        done.wait(_DONE_S)

    def _take(self, message: Any) -> None:
        wake = self._wake
        if wake is not None:
            self._kept.append(message)
            wake()

    def _run(self) -> None:
        with contextlib.suppress(ExternalShutdownException):
            self._executor.spin()
