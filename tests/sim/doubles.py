# SPDX-License-Identifier: MIT
"""Stand-ins for the physics, so that the robot and the server are tested without it."""

from __future__ import annotations

import os
import select
import termios
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from hil_sim.arcos import COMMAND, Command, Packet, Sip, SyncEcho, SyncReply, Unframer, decode, frame
from hil_sim.faults.kinds import FaultChange
from hil_sim.robot.chassis import OdometryError
from hil_sim.robot.robot import Robot
from hil_sim.server.server import ArcosServer
from hil_sim.world.model import Pose

FRONT_MM = 210.0


@dataclass(frozen=True)
class FlatContact:
    """A contact of the front, middle segment."""

    front_segments: int = 0b001000
    rear_segments: int = 0
    front: bool = True


@dataclass
class WallAhead:
    """A body in a world whose only solid is a wall across the x axis."""

    wall_mm: float = 1e9
    contacts: int = 0

    def contact(self, pose: Pose, now_ms: float) -> FlatContact | None:
        """Touch when the front is at the wall."""
        self.contacts += 1
        return FlatContact() if pose.x_mm + FRONT_MM >= self.wall_mm else None

    def clearance_mm(self, pose: Pose) -> float:
        """Distance of the front from the wall."""
        return max(0.0, self.wall_mm - FRONT_MM - pose.x_mm)


@dataclass(frozen=True)
class FakeReading:
    """A reading of the fake ring."""

    t_ms: float
    number: int
    range_mm: int
    true_mm: int
    fault: str | None = None


@dataclass
class FakeRing:
    """Two arrays that fire in turn and see 1000 mm + their number."""

    enabled: list[bool] = field(default_factory=lambda: [False] * 4)
    cycle_ms: int = 40
    polled: list[list[int]] = field(default_factory=list)
    resets: int = 0
    _next_ms: float = 0.0
    _slot: int = 0

    def set_polling(self, numbers: Sequence[int]) -> None:
        """Note the order."""
        self.polled.append(list(numbers))

    def reset(self) -> None:
        """Count."""
        self.resets += 1

    def advance(self, now_ms: float, pose_at: Callable[[float], Pose]) -> list[FakeReading]:
        """Fire what is due."""
        self._next_ms = max(self._next_ms, now_ms - self.cycle_ms)
        out = []
        while self._next_ms <= now_ms:
            pose_at(self._next_ms)
            for array in range(2):
                if self.enabled[array]:
                    number = 8 * array + self._slot % 8
                    out.append(FakeReading(self._next_ms, number, 1000 + number, 1000 + number))
            self._slot += 1
            self._next_ms += self.cycle_ms
        return out

    def fire_all(self, now_ms: float, pose: Pose) -> list[FakeReading]:
        """Fire everything at once."""
        numbers = [number for number in range(16) if self.enabled[number // 8]]
        return [FakeReading(now_ms, number, 1000 + number, 1000 + number) for number in numbers]


@dataclass
class FakeFaults:
    """Presses bumper bits when told."""

    bits: int = 0

    def update(self, now_ms: float, pose: Pose, travelled_mm: float) -> list[FaultChange]:
        """No changes."""
        return []

    def wheels(self) -> tuple[float, float]:
        return 1.0, 1.0

    def bumper(self, now_ms: float) -> int:
        """The bits set."""
        return self.bits


PERFECT = OdometryError(0, 0, 0)


def make_robot(wall_mm: float = 1e9, **options: Any) -> Robot:
    """A robot at the origin with perfect odometry."""
    options.setdefault("odometry_error", PERFECT)
    return Robot(WallAhead(wall_mm), FakeRing(), Pose(0, 0, 0), **options)


def cmd(name: str, value: int | None = None) -> bytes:
    """A framed command."""
    number = COMMAND[name]
    return frame((Command(number) if value is None else Command.integer(number, value)).data)


class Session:
    """A client of a server in virtual time; `packets` holds everything received."""

    def __init__(self, server: ArcosServer) -> None:
        self.server = server
        self.now_ms = 0.0
        self.packets: list[Packet] = []
        self._unframer = Unframer()

    def send(self, *packets: bytes) -> list[Packet]:
        """Send packets in one write; return what is answered at once."""
        self.server.receive(b"".join(packets), self.now_ms)
        return self._collect()

    def run(self, ms: float, keep_alive: bool = True) -> list[Packet]:
        """Let time pass; return what is received."""
        got: list[Packet] = []
        end = self.now_ms + ms
        while self.now_ms < end:
            self.now_ms = min(end, self.now_ms + 50)
            if keep_alive and self.now_ms % 500 == 0:
                got += self.send(cmd("PULSE"))
            self.server.advance(self.now_ms)
            got += self._collect()
        return got

    def _collect(self) -> list[Packet]:
        got = []
        for packet in self.server.outgoing():
            got += [decode(data) for data in self._unframer.feed(packet)]
        self.packets += got
        return got

    def connect(self, enable: bool = True) -> None:
        """Handshake, OPEN, motors on."""
        self.send(cmd("PULSE"))
        self.send(cmd("OPEN"))
        self.send(cmd("CLOSE"))
        self.send(cmd("OPEN", 1))
        if enable:
            self.send(cmd("ENABLE", 1))


def sips(packets: Sequence[Packet]) -> list[Sip]:
    """The SIPs among packets."""
    return [packet for packet in packets if isinstance(packet, Sip)]


class Port:
    """The client's side of a serial device."""

    def __init__(self, path: str, speed: int | None = None) -> None:
        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        self.unframer = Unframer()
        if speed is not None:
            self.speed(speed)

    def speed(self, code: int) -> None:
        """Change the rate (a termios constant)."""
        settings = termios.tcgetattr(self.fd)
        settings[4] = settings[5] = code
        termios.tcsetattr(self.fd, termios.TCSANOW, settings)

    def send(self, data: bytes) -> None:
        """Write bytes."""
        os.write(self.fd, data)

    def read(self, seconds: float, enough: int = 1000) -> list[Packet]:
        """Packets received until `enough` or for `seconds`."""
        got: list[Packet] = []
        end = time.monotonic() + seconds
        while len(got) < enough and (left := end - time.monotonic()) > 0:
            if select.select([self.fd], [], [], left)[0]:
                data = os.read(self.fd, 4096)
                got += [decode(item) for item in self.unframer.feed(data, time.monotonic() * 1000)]
        return got

    def close(self) -> None:
        """Leave."""
        os.close(self.fd)


def connect(port: Port) -> None:
    """Handshake and OPEN. SYNC0 is sent again, as clients do: a pty drops what comes before its opening is seen."""
    for _ in range(5):
        port.send(cmd("PULSE"))
        if port.read(1, 1):
            break
    port.read(0.2)
    for name, kind in (("PULSE", SyncEcho), ("OPEN", SyncEcho), ("CLOSE", SyncReply)):
        port.send(cmd(name))
        assert [type(packet) for packet in port.read(5, 1)] == [kind]
    port.send(cmd("OPEN", 1))
