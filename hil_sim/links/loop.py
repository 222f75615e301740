# SPDX-License-Identifier: MIT
"""The loop that serves one robot on one link in real time, and several in one thread."""

from __future__ import annotations

import contextlib
import select
import time
from collections.abc import Callable, Iterable, Sequence
from typing import Final

from hil_sim.faults.link import LinkFaults
from hil_sim.links.base import Link
from hil_sim.links.orders import Orders
from hil_sim.record.recording import Kind, Recorder
from hil_sim.server.server import ArcosServer

IDLE_MS: Final = 20.0
"""Time passes for a robot at least this often, so that several in one thread do not all do it when a SIP is due."""
_GAP_MS: Final = 500.0
"""A longer silence of the clock (the process was suspended, or starved) is taken out of the robot's time."""
LATE_MS: Final = 100.0
"""A turn that comes later than this after it was due is told: a SIP may have come a whole cycle late."""


def _now_ms() -> float:
    return time.monotonic() * 1000


class Loop:
    """Serves one robot on one link in real time, in one thread."""

    def __init__(
        self,
        server: ArcosServer,
        link: Link,
        faults: LinkFaults | None = None,
        clock_ms: Callable[[], float] = _now_ms,
        recorder: Recorder | None = None,
        orders: Orders | None = None,
    ) -> None:
        """`recorder`: gets what is on the link, so after the faults towards the client, before the others.

        `orders`: obeyed as they come; their end is the end of the loop.
        """
        self.server = server
        self.link = link
        self.faults = faults
        self.recorder = recorder
        self.orders = orders
        self._clock_ms = clock_ms
        self._origin_ms = clock_ms() - server.robot.now_ms
        self._last_ms = float(server.robot.now_ms)
        self._baud = server.baud
        self._due_ms: float | None = None
        self._suspended = False
        self.skipped_ms = 0.0
        self.late_max_ms = 0.0
        self.late_turns = 0

    def now_ms(self) -> float:
        """Robot time: the monotonic clock less the time this process was suspended."""
        now = self._clock_ms() - self._origin_ms
        gap = now - self._last_ms
        if gap > _GAP_MS:
            self._origin_ms += gap - _GAP_MS
            self.skipped_ms += gap - _GAP_MS
            now = self._last_ms + _GAP_MS
        self._last_ms = now
        return now

    def turn(self) -> float:
        """Do what is due; return how long the loop may then sleep, in ms."""
        now = self._begin_turn()
        server, link, faults = self.server, self.link, self.faults
        if self.orders is not None:
            self.orders.obey()
        if faults is not None:
            faults.update(now)
        for data in link.receive(now):
            if self.recorder is not None:
                self.recorder.note(Kind.TO_ROBOT, data)
            self._hear(data, now)
        if link.take_lost():
            server.client_gone()
        if faults is not None:
            for data in faults.pop(now, "to_robot"):
                self._to_server(data, now)
        server.advance(now)
        self._follow_baud()
        self._answer(now)
        link.transmit(now)
        if server.take_hang_up():
            link.hang_up()
        rest_ms = self._rest_ms(now)
        self._due_ms = now + rest_ms
        return rest_ms

    def _answer(self, now: float) -> None:
        """Send what the server says, as far as the faults let it through."""
        packets: Iterable[bytes] = self.server.outgoing()
        if self.faults is not None:
            for packet in packets:
                self.faults.push(packet, now, "to_client")
            packets = self.faults.pop(now, "to_client")
        for packet in packets:
            self._send(packet, now)

    def resumed(self) -> None:
        """Tell that this process was suspended on purpose (SIGCONT says so): the next turn is not late."""
        self._suspended = True

    def _begin_turn(self) -> float:
        """Return robot time, and account how late the host is with this turn."""
        skipped_ms = self.skipped_ms
        now = self.now_ms()
        suspended, self._suspended = self._suspended, False
        if self._due_ms is None or suspended:
            return now
        late_ms = now + self.skipped_ms - skipped_ms - self._due_ms
        self.late_max_ms = max(self.late_max_ms, late_ms)
        if late_ms > LATE_MS:
            self.late_turns += 1
            if self.server.log is not None:
                self.server.log("late", {"t_s": now / 1000, "late_ms": round(late_ms, 1)})
        return now

    def _send(self, packet: bytes, now: float) -> None:
        self.link.send(packet, now)
        if self.recorder is not None:
            self.recorder.note(Kind.FROM_ROBOT, packet)

    def _hear(self, data: bytes, now: float) -> None:
        if self.faults is None:
            self._to_server(data, now)
        else:
            self.faults.push(data, now, "to_robot")

    def _to_server(self, data: bytes, now: float) -> None:
        self.server.receive(data, now)
        self._follow_baud()

    def _follow_baud(self) -> None:
        if self.server.baud != self._baud:
            self._baud = self.server.baud
            self.link.set_baud(self._baud)

    def _rest_ms(self, now: float) -> float:
        times = [now + IDLE_MS, self.server.next_due_ms, self.link.due_ms()]
        if self.faults is not None:
            times.append(self.faults.due_ms())
        return max(0.0, min(t for t in times if t is not None) - now)

    def run(self, stop: Callable[[], bool], duration_ms: float | None = None) -> None:
        """Serve until `stop()`, the end of orders, or for `duration_ms` of robot time."""
        while not stop() and (duration_ms is None or self._last_ms < duration_ms):
            if self.orders is not None and self.orders.ended:
                break
            self.link.wait(self.turn())


class Fleet:
    """Serves several robots, each on its own link, in one thread."""

    def __init__(self, loops: Sequence[Loop], clock_ms: Callable[[], float] = _now_ms) -> None:
        self.loops = list(loops)
        self._clock_ms = clock_ms
        self._due_ms = [0.0] * len(self.loops)

    def turn(self) -> float:
        """Do what is due; return how long all may then sleep, in ms."""
        for k, loop in enumerate(self.loops):
            now = self._clock_ms()
            if self._due_ms[k] <= now:
                self._due_ms[k] = now + loop.turn()
        return min(self._due_ms) - self._clock_ms()

    def wait(self, timeout_ms: float) -> None:
        """Sleep until input or the timeout; a port with input is due."""
        owner = {reader: k for k, loop in enumerate(self.loops) for reader in loop.link.readers()}
        with contextlib.suppress(InterruptedError):
            ready, _, _ = select.select(list(owner), [], [], max(0.0, timeout_ms) / 1000)
            for reader in ready:
                self._due_ms[owner[reader]] = 0.0

    def run(self, stop: Callable[[], bool], duration_ms: float | None = None) -> None:
        """Serve until `stop()` or for `duration_ms`."""
        start_ms = self._clock_ms()
        while not stop() and (duration_ms is None or self._clock_ms() - start_ms < duration_ms):
            self.wait(self.turn())
