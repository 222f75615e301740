# SPDX-License-Identifier: MIT
"""A robot whose end of the CAN link has the manners of a test: the emulator's server on an `End` of raw frames."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from typing import Any

from canbus import Background, End

from hil_sim.links.base import Link
from hil_sim.links.loop import Loop
from hil_sim.scenario.build import build_robot
from hil_sim.scenario.scenario import Scenario
from hil_sim.server.server import ArcosServer
from hil_sim.world.files import load_world

_FLOW_WITHIN_S = 0.5


class RawLink(Link):
    """A link that does what its end's manners say."""

    def __init__(self, interface: str) -> None:
        self.end = End.robot(interface)
        self.before: list[bytes] = []
        """Messages to send before the next packet, whatever they are."""
        self.hush_until_s = 0.0
        """Nothing is sent before this (monotonic clock)."""
        self._waiting: list[bytes] = []

    def open(self) -> None:
        """Nothing to do."""

    def receive(self, now_ms: float) -> Iterable[bytes]:
        """Yield the messages that are complete."""
        self.end.pump(0.001)
        got, self.end.heard = self.end.heard, []
        return got

    def send(self, packet: bytes, now_ms: float) -> None:
        """Keep a packet for `transmit`."""
        self._waiting.append(packet)

    def transmit(self, now_ms: float) -> None:
        """Send what waits."""
        packets, self._waiting = self._waiting, []
        if time.monotonic() < self.hush_until_s:
            return
        if packets:
            packets[:0], self.before = self.before, []
        for packet in packets:
            self.end.send(packet, _FLOW_WITHIN_S)

    def readers(self) -> Sequence[Any]:  # type: ignore[override]
        """The raw socket."""
        return [self.end.raw]

    @property
    def address(self) -> str:
        """Nobody asks."""
        return "raw"

    def close(self) -> None:
        """Close the socket."""
        self.end.close()


class RawRobot:
    """A running robot on a `RawLink`."""

    def __init__(self, interface: str) -> None:
        scenario = Scenario()
        world = load_world(scenario.world)
        robot = build_robot(scenario, world, scenario.start or world.start, None)
        self.link = RawLink(interface)
        self._loop = Loop(ArcosServer(robot), self.link)
        self._thread = Background(self._step)

    def _step(self) -> None:
        self.link.wait(min(20.0, self._loop.turn()))

    def end(self) -> None:
        """End it."""
        self._thread.end()
        self.link.close()
