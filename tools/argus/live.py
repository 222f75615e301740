# SPDX-License-Identifier: MIT
"""A running argusd, watched and ordered over its control socket: `connect`, and `connect_async` for asyncio.

    with argus.connect("unix:/tmp/argus.sock") as robot:
        robot.drive_to(2000, 0)
        print(robot.state().failing)

Both give the same. Numbers are in the units of their names; a pose is that since argusd connected to the robot. Refused
is raised when argusd, or another program that has control, does not let it; ControlError when nobody answers.
"""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import AsyncIterator, Iterator, Sequence
from os import PathLike
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self, TypeVar, cast

from argus_tools.control.client import Client, ControlError, Message, Refused, default_place, read_token
from argus_tools.control.script import Ask, Hear, Session, Steps
from argus_tools.control.values import LiveEvent, RobotState, SonarHealth, event_of
from argus_tools.monitor.upstream import Upstream, UpstreamError, parse_address

__all__ = [
    "AsyncRobot",
    "ControlError",
    "LiveEvent",
    "Refused",
    "Robot",
    "RobotState",
    "SonarHealth",
    "connect",
    "connect_async",
]

DRIVE_S: Final = 900.0
Point = tuple[int, int]
T = TypeVar("T")


def _token(path: str | PathLike[str] | None) -> str | None:
    return None if path is None else read_token(Path(path))


def _fault(sonar: int, kind: str, for_s: float) -> Message:
    if kind == "ok":
        return {"sonar": sonar, "kind": kind}
    return {"sonar": sonar, "kind": kind, "for_ms": round(1000 * for_s)}


class Robot:
    """A robot that argusd manages; a context manager, made by `connect`.

    One connection at a time has control: the first order takes it, `take(force=True)` takes it from another. Every one
    may watch and stop.
    """

    def __init__(self, client: Client) -> None:
        self._client = client
        self._session = Session()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """End the connection. A course goes on; a step or a turn that goes on is stopped by argusd."""
        self._client.close()

    def _do(self, steps: Steps[T]) -> T:
        """Carry out STEPS; what a step raises is raised in them."""
        answer: Message | None = None
        problem: BaseException | None = None
        while True:
            try:
                step = steps.throw(problem) if problem is not None else steps.send(answer)
            except StopIteration as end:
                return cast(T, end.value)
            answer, problem = None, None
            try:
                if isinstance(step, Ask):
                    answer = self._client.request(step.do, **step.members)
                elif isinstance(step, Hear):
                    answer = self._client.message(step.timeout_s)
                else:
                    time.sleep(step.seconds)
                    answer = {}
            except BaseException as raised:
                problem = raised

    def state(self) -> RobotState:
        """Return what the robot and its sonars do now."""
        return self._do(self._session.state())

    def health(self) -> tuple[SonarHealth, ...]:
        """Return every sonar with its health, its fault and what it reads."""
        return self.state().sonars

    def events(self, timeout_s: float | None = None) -> Iterator[LiveEvent]:
        """Yield what happens from now on, until argusd ends or nothing happens for TIMEOUT_S (None: for ever).

        Orders may be given meanwhile.
        """
        topics = ("events",)
        self._do(self._session.watch(topics))
        try:
            while True:
                try:
                    yield event_of(self._do(self._session.event(timeout_s)))
                except (ControlError, TimeoutError):
                    return
        finally:
            with contextlib.suppress(ControlError, TimeoutError):
                self._do(self._session.unwatch(topics))

    def take(self, *, force: bool = False) -> None:
        """Take control; Refused with `why` "taken" when another has it, unless FORCE takes it away."""
        self._do(self._session.take(force))

    def release(self) -> None:
        """Give control back."""
        self._do(self._session.release())

    def order(self, order: str, **members: Any) -> None:
        """Give any order of SPEC.md, Control socket, without waiting for what becomes of it."""
        self._do(self._session.order(order, members))

    def activate(self) -> None:
        """Allow it to drive."""
        self.order("active")

    def passivate(self) -> None:
        """Stop it; from now on it only reports."""
        self.order("passive")

    def stop(self) -> None:
        """Stop it, and stay: the course is paused. Needs no control."""
        self.order("stop")

    def go_on(self) -> None:
        """Go on with a course that was stopped."""
        self.order("go")

    def drive_to(self, x_mm: int, y_mm: int, *, timeout_s: float = DRIVE_S) -> RobotState:
        """Drive to a point and wait until it is reached; return the state there.

        Refused when the course is given up or another stops it. When anything else ends the waiting, as TimeoutError or
        Ctrl-C does, the robot is stopped.
        """
        return self.drive_through([(x_mm, y_mm)], timeout_s=timeout_s)

    def drive_through(self, points: Sequence[Point], *, timeout_s: float = DRIVE_S) -> RobotState:
        """Drive through 1 to 64 points, as `drive_to`."""
        return self._do(self._session.drive(points, timeout_s))

    def turn(self, deg: int) -> RobotState:
        """Turn on the spot, positive to the left, and wait until it stands."""
        return self._do(self._session.by_hand("turn", {"deg": deg}))

    def step(self, *, back: bool = False) -> RobotState:
        """Drive one step ahead, or back, and wait until it stands."""
        return self._do(self._session.by_hand("step", {"way": "back" if back else "ahead"}))

    def recheck(self) -> None:
        """Check all sonars again."""
        self.order("recheck")

    def fail(self, sonar: int, kind: str, *, for_s: float = 30.0) -> None:
        """Let a sonar fail for a while, or with "ok" no more; argusd must run with --inject."""
        self.order("fail", **_fault(sonar, kind, for_s))


class AsyncRobot:
    """`Robot` for asyncio: the same methods, to be awaited; an async context manager, made by `connect_async`."""

    def __init__(self, place: str, token: str | None, timeout_s: float) -> None:
        self._place = place
        self._token = token
        self._timeout_s = timeout_s
        self._session = Session()
        self._streamed: asyncio.Queue[Message] = asyncio.Queue()
        self._upstream: Upstream | None = None

    async def __aenter__(self) -> Self:
        try:
            address = parse_address(self._place, self._token or "")
            self._upstream = await Upstream.open(address, self._streamed.put_nowait, self._timeout_s)
        except (UpstreamError, ValueError) as problem:
            raise ControlError(str(problem)) from None
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    async def close(self) -> None:
        """End the connection, as `Robot.close` does."""
        if self._upstream is not None:
            await self._upstream.close()

    async def _ask(self, step: Ask) -> Message:
        if self._upstream is None:
            raise ControlError(f"{self._place}: not connected; use `async with`")
        try:
            answer = await self._upstream.ask(step.do, **step.members)
        except UpstreamError as problem:
            raise ControlError(f"{self._place}: {problem}") from None
        if not answer.get("ok"):
            raise Refused(str(answer.get("why", "refused")), str(answer.get("say", "no reason is given")))
        return answer

    async def _hear(self, timeout_s: float | None) -> Message:
        assert self._upstream is not None
        hearing = asyncio.ensure_future(self._streamed.get())
        ending = asyncio.ensure_future(self._upstream.closed.wait())
        try:
            await asyncio.wait((hearing, ending), timeout=timeout_s, return_when=asyncio.FIRST_COMPLETED)
            if hearing.done():
                return hearing.result()
            if ending.done():
                raise ControlError(f"{self._place}: argusd has closed the connection")
            raise TimeoutError(f"{self._place}: nothing was said in time")
        finally:
            hearing.cancel()
            ending.cancel()

    async def _do(self, steps: Steps[T]) -> T:
        answer: Message | None = None
        problem: BaseException | None = None
        while True:
            try:
                step = steps.throw(problem) if problem is not None else steps.send(answer)
            except StopIteration as end:
                return cast(T, end.value)
            answer, problem = None, None
            try:
                if isinstance(step, Ask):
                    answer = await self._ask(step)
                elif isinstance(step, Hear):
                    answer = await self._hear(step.timeout_s)
                else:
                    await asyncio.sleep(step.seconds)
                    answer = {}
            except BaseException as raised:
                problem = raised

    async def state(self) -> RobotState:
        """As `Robot.state`."""
        return await self._do(self._session.state())

    async def health(self) -> tuple[SonarHealth, ...]:
        """As `Robot.health`."""
        return (await self.state()).sonars

    async def events(self, timeout_s: float | None = None) -> AsyncIterator[LiveEvent]:
        """As `Robot.events`: `async for event in robot.events()`."""
        topics = ("events",)
        await self._do(self._session.watch(topics))
        try:
            while True:
                try:
                    yield event_of(await self._do(self._session.event(timeout_s)))
                except (ControlError, TimeoutError):
                    return
        finally:
            with contextlib.suppress(ControlError, TimeoutError):
                await self._do(self._session.unwatch(topics))

    async def take(self, *, force: bool = False) -> None:
        """As `Robot.take`."""
        await self._do(self._session.take(force))

    async def release(self) -> None:
        """As `Robot.release`."""
        await self._do(self._session.release())

    async def order(self, order: str, **members: Any) -> None:
        """As `Robot.order`."""
        await self._do(self._session.order(order, members))

    async def activate(self) -> None:
        """As `Robot.activate`."""
        await self.order("active")

    async def passivate(self) -> None:
        """As `Robot.passivate`."""
        await self.order("passive")

    async def stop(self) -> None:
        """As `Robot.stop`."""
        await self.order("stop")

    async def go_on(self) -> None:
        """As `Robot.go_on`."""
        await self.order("go")

    async def drive_to(self, x_mm: int, y_mm: int, *, timeout_s: float = DRIVE_S) -> RobotState:
        """As `Robot.drive_to`; a task that is cancelled stops the robot."""
        return await self.drive_through([(x_mm, y_mm)], timeout_s=timeout_s)

    async def drive_through(self, points: Sequence[Point], *, timeout_s: float = DRIVE_S) -> RobotState:
        """As `Robot.drive_through`."""
        return await self._do(self._session.drive(points, timeout_s))

    async def turn(self, deg: int) -> RobotState:
        """As `Robot.turn`."""
        return await self._do(self._session.by_hand("turn", {"deg": deg}))

    async def step(self, *, back: bool = False) -> RobotState:
        """As `Robot.step`."""
        return await self._do(self._session.by_hand("step", {"way": "back" if back else "ahead"}))

    async def recheck(self) -> None:
        """As `Robot.recheck`."""
        await self.order("recheck")

    async def fail(self, sonar: int, kind: str, *, for_s: float = 30.0) -> None:
        """As `Robot.fail`."""
        await self.order("fail", **_fault(sonar, kind, for_s))


def connect(
    place: str | None = None, *, token: str | PathLike[str] | None = None, timeout_s: float = 10.0
) -> Robot:
    """Connect to the argusd at PLACE, unix:PATH or tcp:HOST:PORT; None is ARGUS_CONTROL, else the service's own.

    token: the file with the token that a TCP place asks for. timeout_s: to wait for a connection and for each reply.
    """
    return Robot(Client(place, _token(token), timeout_s))


def connect_async(
    place: str | None = None, *, token: str | PathLike[str] | None = None, timeout_s: float = 10.0
) -> AsyncRobot:
    """As `connect`, for asyncio: `async with argus.connect_async(...) as robot`."""
    return AsyncRobot(place or default_place(), _token(token), timeout_s)
