# SPDX-License-Identifier: MIT
"""What a live client does, step by step and free of I/O: a plain client and an async one carry out the same steps."""

from __future__ import annotations

import time
from collections import Counter, deque
from collections.abc import Callable, Generator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, Final, TypeVar

from argus_tools.control.client import Message, Refused
from argus_tools.control.motion import MOTION_S, RETRY_S, Course, Motion, Patience
from argus_tools.control.values import RobotState, state_of

PERIOD_MS: Final = 200
T = TypeVar("T")


@dataclass(frozen=True)
class Ask:
    """Send a request; goes on with its reply."""

    do: str
    members: Message = field(default_factory=dict)


@dataclass(frozen=True)
class Hear:
    """Wait for the next streamed line; TimeoutError when none came in time."""

    timeout_s: float | None


@dataclass(frozen=True)
class Rest:
    """Let some time pass."""

    seconds: float


Step = Ask | Hear | Rest
Steps = Generator[Step, Any, T]


class Session:
    """What is known of one connection: control, numbers of orders, what is watched, events that nobody took yet."""

    def __init__(self) -> None:
        self._grant: str | None = None
        self._seq = 0
        self._watched = Counter[str]()
        self._period_ms = PERIOD_MS
        self._events = deque[Message]()

    def state(self) -> Steps[RobotState]:
        """Ask for the state."""
        answer = yield Ask("status")
        return state_of(answer["state"])

    def take(self, force: bool = False) -> Steps[None]:
        """Take control."""
        answer = yield Ask("take", {"force": force})
        self._grant, self._seq = str(answer["grant"]), 0

    def release(self) -> Steps[None]:
        """Give control back."""
        yield Ask("release")
        self._grant = None

    def order(self, order: str, members: Message) -> Steps[None]:
        """Give an order; what was not taken before is taken, stop needs no control."""
        if self._grant is None and order != "stop":
            yield from self.take()
        self._seq += 1
        entitled = {"grant": self._grant, "seq": self._seq} if self._grant is not None else {}
        yield Ask("order", {"order": order, **entitled, **members})

    def watch(self, topics: Sequence[str]) -> Steps[None]:
        """Stream TOPICS, beside those that are streamed already."""
        self._watched.update(topics)
        yield from self._rewatch()

    def unwatch(self, topics: Sequence[str]) -> Steps[None]:
        """End what `watch` began."""
        self._watched.subtract(topics)
        self._watched = +self._watched
        yield from self._rewatch()

    def _rewatch(self) -> Steps[None]:
        yield Ask("watch", {"topics": sorted(self._watched), "period_ms": self._period_ms})

    def event(self, timeout_s: float | None) -> Steps[Message]:
        """Return the next event; states and readings between them are passed over."""
        until = None if timeout_s is None else time.monotonic() + timeout_s
        if self._events:
            return self._events.popleft()
        while True:
            message: Message = yield Hear(None if until is None else max(0.0, until - time.monotonic()))
            if "event" in message and message["event"] != "STATUS":
                return message

    def drive(self, points: Sequence[tuple[int, int]], timeout_s: float) -> Steps[RobotState]:
        """Order a course and wait until its goal is reached."""
        state = yield from self.state()
        if not state.active:
            raise Refused("refused", "it is passive and would not drive: activate() first")
        members: Message = {"points": [list(point) for point in points]}
        if len(points) == 1:
            members = {"x_mm": points[0][0], "y_mm": points[0][1]}
        order = "goto" if len(points) == 1 else "course"
        return (yield from self._wait(order, members, Course(len(points)).is_over, timeout_s))

    def by_hand(self, order: str, members: Message) -> Steps[RobotState]:
        """Order a step or a turn and wait until the robot stands."""
        return (yield from self._wait(order, members, Motion(order).is_over, MOTION_S))

    def _wait(
        self, order: str, members: Message, is_over: Callable[[Message], bool], timeout_s: float
    ) -> Steps[RobotState]:
        topics = ("events", "state")
        yield from self.watch(topics)
        try:
            yield from self._order_once_checked(order, members)
            yield from self._until(is_over, timeout_s)
        except Refused:  # it stands, or what another ordered goes on
            raise
        except BaseException:
            with suppress(Exception):
                yield from self.order("stop", {})
            raise
        state = yield from self.state()
        yield from self.unwatch(topics)
        return state

    def _until(self, is_over: Callable[[Message], bool], timeout_s: float) -> Steps[None]:
        until = time.monotonic() + timeout_s
        while True:
            try:
                message: Message = yield Hear(max(0.0, until - time.monotonic()))
            except TimeoutError:
                raise TimeoutError(f"not done after {timeout_s:g} s: the robot is stopped") from None
            if self._watched["events"] > 1 and message.get("event", "STATUS") != "STATUS":
                self._events.append(message)
            if is_over(message):
                return

    def _order_once_checked(self, order: str, members: Message) -> Steps[None]:
        """Order a motion; a check of the sonars, as after each stop, is waited for."""
        patience = Patience()
        while True:
            try:
                yield from self.order(order, members)
            except Refused as refusal:
                if not patience.bears(refusal):
                    raise
                yield Rest(RETRY_S)
            else:
                return
