# SPDX-License-Identifier: MIT
"""Keeps the connection to argusd and passes on to every page what comes; no page holds up another."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections import deque
from collections.abc import Callable
from typing import Any, Final, Protocol

from argus_tools.monitor.geometry import robot_message
from argus_tools.monitor.memory import Memory, kind_of
from argus_tools.monitor.upstream import Address, Message, Upstream, UpstreamError

PERIOD_MS: Final = 100
_PAUSES_S: Final = (0.25, 0.5, 1.0, 2.0)
_WAITING_MAX: Final = 500
SILENT_S: Final = 1.5
_LOOK_S: Final = 0.25


class Breaker(Protocol):
    """Breaks and mends sonars: an emulator that runs beside us."""

    broken: dict[str, str]
    changed: Callable[[], None]
    """Called when another sonar is broken, or one no longer is."""

    async def order(self, line: str) -> Message:
        """Give an order; the answer has ok, and say where it was refused."""


class Outbox:
    """What one page has still to be sent: of state, readings and evidence the last only, of the rest all, bounded."""

    def __init__(self) -> None:
        self._queue: deque[Message] = deque()
        self._newest: dict[str, Message] = {}
        self._ready = asyncio.Event()
        self.lost = 0

    def put(self, message: Message) -> None:
        """Add a line; never waits."""
        kind = kind_of(message)
        if kind in ("state", "readings", "evidence"):
            self._newest[kind] = message
        elif len(self._queue) < _WAITING_MAX:
            self._queue.append(message)
        else:
            self.lost += 1
        self._ready.set()

    async def take(self) -> list[Message]:
        """Wait for lines and return all there are."""
        await self._ready.wait()
        self._ready.clear()
        lines = [*self._queue, *self._newest.values()]
        self._queue.clear()
        self._newest.clear()
        if self.lost:
            lines.append({"lost": "lines", "count": self.lost})
            self.lost = 0
        return lines


class Hub:
    """One connection that watches, and the pages that see what it tells."""

    def __init__(self, address: Address, breaker: Breaker | None = None, **about: Any) -> None:
        """`about`: what pages are told of this program, once each."""
        self.address = address
        self.breaker = breaker
        self.memory = Memory()
        self.about = about
        self.why = "connecting"
        self.told: Callable[[str], None] = lambda _: None
        """Hears why argusd is not reached, once for each reason, and that it is again."""
        self._told = ""
        self._heard_s = 0.0
        self._boxes: set[Outbox] = set()
        self._upstream: Upstream | None = None
        if breaker is not None:
            breaker.changed = self.tell_broken

    # ---- pages

    def join(self) -> Outbox:
        """Take a page up and tell it all that it has missed."""
        box = Outbox()
        box.put({"about": self.about | {"sim": self.breaker is not None}})
        box.put({"robot": robot_message(self.memory.table)})
        box.put(self._link())
        for message in self.memory.story():
            box.put(message)
        if self.breaker is not None:
            box.put({"broken": self.breaker.broken})
        self._boxes.add(box)
        self.tell_viewers()
        return box

    def leave(self, box: Outbox) -> None:
        """Forget a page."""
        self._boxes.discard(box)
        self.tell_viewers()

    @property
    def viewers(self) -> int:
        """How many pages look on."""
        return len(self._boxes)

    def tell(self, message: Message) -> None:
        """Tell every page."""
        for box in self._boxes:
            box.put(message)

    def set_goal(self, goal: list[int]) -> None:
        """Remember where a page sent the robot, and tell every page."""
        self.memory.goal = goal
        self.tell({"goal": goal})

    def tell_viewers(self) -> None:
        """Tell how many look on."""
        self.tell({"viewers": len(self._boxes)})

    def tell_broken(self) -> None:
        """Tell which sonars the emulator has broken."""
        if self.breaker is not None:
            self.tell({"broken": self.breaker.broken})

    def _link(self) -> Message:
        return {"link": {"up": self._upstream is not None, "why": self.why}}

    # ---- argusd

    def hear(self, message: Message) -> None:
        """Take a line of argusd."""
        self._heard_s = time.monotonic()
        for more in self.memory.take(message):
            self.tell({"robot": robot_message(self.memory.table)} if "robot" in more else more)
        if kind_of(message):
            self.tell(message)

    async def ask(self, request: str, **members: Any) -> Message:
        """Ask argusd on the connection that watches; what it answers, or why not, in the same form."""
        if self._upstream is None:
            return {"ok": False, "why": "refused", "say": f"argusd is not reached: {self.why}"}
        try:
            return await self._upstream.ask(request, **members)
        except UpstreamError as error:
            return {"ok": False, "why": "refused", "say": str(error)}

    async def run(self) -> None:
        """Watch until cancelled; a connection that is lost is opened again."""
        attempt = 0
        while True:
            try:
                await self._watch()
                attempt = 0
            except UpstreamError as error:
                self.why = str(error)
            self._upstream = None
            self.tell(self._link())
            self._report(f"{self.why}; trying again")
            await asyncio.sleep(_PAUSES_S[min(attempt, len(_PAUSES_S) - 1)])
            attempt += 1

    def _report(self, why: str) -> None:
        if why != self._told:
            self._told = why
            self.told(why)

    async def _end_of(self, upstream: Upstream) -> str:
        """Wait until the connection ends, or carries nothing; return which."""
        while time.monotonic() - self._heard_s <= SILENT_S:
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(_LOOK_S):
                    await upstream.closed.wait()
                return "argusd has closed the connection"
        return "argusd reports nothing"

    async def _watch(self) -> None:
        upstream = await Upstream.open(self.address, self.hear)
        try:
            answer = await upstream.ask(
                "watch", topics=["events", "state", "readings", "evidence"], period_ms=PERIOD_MS
            )
            if not answer.get("ok"):
                raise UpstreamError(f"{self.address}: {answer.get('say', 'it lets nobody watch')}")
            self._upstream, self.why = upstream, ""
            self._heard_s = time.monotonic()
            if self._told:
                self._report("argusd is reached")
            self.memory.reconnected()
            self.tell(self._link())
            self.why = await self._end_of(upstream)
        finally:
            self._upstream = None
            with contextlib.suppress(UpstreamError):
                await upstream.close()
