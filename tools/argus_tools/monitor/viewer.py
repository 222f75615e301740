# SPDX-License-Identifier: MIT
"""One page on its websocket: what it may ask, and the control of the robot while it has it."""

from __future__ import annotations

import asyncio
import contextlib
import json
import time
from collections.abc import Awaitable, Callable, Mapping
from typing import Any, Final, Protocol

from argus_tools.monitor.hub import Hub
from argus_tools.monitor.upstream import Message, Upstream, UpstreamError
from hil_sim.faults.kinds import SONAR_KINDS

ORDERS: Final[Mapping[str, tuple[str, ...]]] = {
    "stop": (),
    "go": (),
    "active": (),
    "passive": (),
    "recheck": (),
    "step": ("way",),
    "turn": ("deg",),
    "goto": ("x_mm", "y_mm"),
    "retest": ("sonar",),
    "pin": ("sonar",),
    "unpin": ("sonar",),
    "out": ("sonar",),
}
"""Orders that a page may give, with their members; argusd checks the values."""
FAULTS: Final[Mapping[str, str]] = {kind: f"{kind}:{{}}" for kind in SONAR_KINDS} | {
    "wrong": "wrong:{}:scale=0.5"
}
"""Faults that a page may inject, as the emulator has them."""
INJECTED_FOR_MS: Final = 60_000
"""On a real robot an injected fault ends by itself after so long."""


class Refused(Exception):
    """A request that is not carried out; the message is one sentence for the person at the page."""


def _plain(value: Any) -> int | str:
    """Return a member that argusd can read: a line with an endless number or half a character has no reply."""
    if isinstance(value, int) and not isinstance(value, bool) and abs(value) < 1 << 31:
        return value
    if isinstance(value, str) and value.isascii() and value.isprintable():
        return value
    raise Refused("an order's members are whole numbers and plain words")


class Page(Protocol):
    """What a viewer tells its page."""

    def put(self, message: Message) -> None:
        """Send it when there is room."""


class Control:
    """A connection of its own to argusd, which alone decides who has control; it ends with the page."""

    def __init__(self, hub: Hub, page: Page) -> None:
        self._hub = hub
        self._page = page
        self._upstream: Upstream | None = None
        self._grant = ""
        self._seq = 0

    @property
    def held(self) -> bool:
        """This page has control."""
        return bool(self._grant)

    async def take(self, force: bool) -> Message:
        """Ask for control; what argusd answers."""
        if self.held and self._upstream is not None and not self._upstream.closed.is_set():
            return {"ok": True}
        await self.drop()
        self._upstream = await Upstream.open(self._hub.address, self._told)
        answer = await self._upstream.ask("take", force=force)
        if not answer.get("ok"):
            await self.drop()
            return answer
        self._grant, self._seq = str(answer["grant"]), 0
        self._page.put({"control": "mine"})
        return {"ok": True}

    async def order(self, order: str, **members: Any) -> Message:
        """Give an order under the grant."""
        if self._upstream is None or not self.held:
            return {"ok": False, "why": "not_in_control", "say": "take control first"}
        self._seq += 1
        return await self._upstream.ask("order", grant=self._grant, seq=self._seq, order=order, **members)

    async def drop(self) -> None:
        """Give control back, by hanging up."""
        upstream, self._upstream = self._upstream, None
        if self.held:
            self._grant = ""
            self._page.put({"control": "none"})
        if upstream is not None:
            await upstream.close()

    def _told(self, message: Message) -> None:
        if message.get("lost") == "control":
            self._grant = ""
            self._page.put({"control": "lost"})


class Viewer:
    """Answers one page's requests."""

    def __init__(self, hub: Hub, page: Page) -> None:
        self._hub = hub
        self._page = page
        self.control = Control(hub, page)
        self._does: Mapping[str, Callable[[Message], Awaitable[Message]]] = {
            "clock": self._clock,
            "take": self._take,
            "release": self._release,
            "order": self._order,
            "break": self._break,
            "mend": self._mend,
        }

    async def handle(self, text: str) -> None:
        """Take one message of the page; each has one reply."""
        request: Any = None
        try:
            with contextlib.suppress(ValueError, RecursionError):
                request = json.loads(text)
            if not isinstance(request, dict):
                raise Refused("that is no JSON object")
            does = self._does.get(str(request.get("do")))
            if does is None:
                raise Refused("there is no such request")
            answer = await does(request)
        except (Refused, UpstreamError) as error:
            answer = {"ok": False, "why": "refused", "say": str(error)}
        number = request.get("id") if isinstance(request, dict) else None
        reply: Message = {"re": number if isinstance(number, int) else None}
        reply.update((key, answer[key]) for key in ("ok", "why", "say", "unix") if key in answer)
        self._page.put(reply)

    async def _clock(self, request: Message) -> Message:
        """Answer with the time here: by this the page tells ages, and that the connection carries something."""
        del request
        return {"ok": True, "unix": time.time()}

    async def _take(self, request: Message) -> Message:
        return await self.control.take(request.get("force") is True)

    async def _release(self, request: Message) -> Message:
        del request
        await self.control.drop()
        return {"ok": True}

    async def _order(self, request: Message) -> Message:
        order = str(request.get("order"))
        if order not in ORDERS:
            raise Refused("a page may not give that order")
        if order == "stop":  # whoever looks on may
            return await self._hub.ask("order", order="stop")
        members: Message = {name: _plain(request[name]) for name in ORDERS[order] if name in request}
        answer = await self.control.order(order, **members)
        if order == "goto" and answer.get("ok"):
            self._hub.set_goal([members["x_mm"], members["y_mm"]])
        return answer

    async def _break(self, request: Message) -> Message:
        kind = request.get("kind")
        if not isinstance(kind, str) or kind not in FAULTS:
            raise Refused(f"a sonar can be broken as {', '.join(FAULTS)}")
        return await self._fault(request, kind)

    async def _mend(self, request: Message) -> Message:
        return await self._fault(request, "ok")

    async def _fault(self, request: Message, kind: str) -> Message:
        sonar = request.get("sonar")
        if (
            not isinstance(sonar, int)
            or isinstance(sonar, bool)
            or not 0 <= sonar < self._hub.memory.table.sonars
        ):
            raise Refused("there is no such sonar")
        breaker = self._hub.breaker
        if breaker is None:
            return await self.control.order("fail", sonar=sonar, kind=kind, for_ms=INJECTED_FOR_MS)
        if not self.control.held:
            return {"ok": False, "why": "not_in_control", "say": "take control first"}
        line = f"mend {sonar}" if kind == "ok" else f"break {FAULTS[kind].format(sonar)}"
        return await breaker.order(line)

    async def close(self) -> None:
        """End with the page; what it drove by hand stops."""
        with contextlib.suppress(UpstreamError, asyncio.CancelledError):
            await self.control.drop()
