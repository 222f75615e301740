# SPDX-License-Identifier: MIT
"""The client of the conformance checks: bytes to and from a target, packets with their times, sessions."""

from __future__ import annotations

import re
import select
import socket
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import serial

from hil_sim.arcos import BAUD, COMMAND, Command, Packet, PacketError, Sip, SyncReply, Unframer, decode, frame
from hil_sim.errors import LinkError, SimError

PATIENCE_S: Final = 2.0
"""An answer that has not come after this long does not come."""
QUIET_S: Final = 0.35
"""No SIP for this long: the stream has ended."""
_PULSE_S: Final = 0.5


class Failed(Exception):
    """A check did not find what it expects; the text is what was observed."""


class NotApplicable(Exception):
    """The target lacks what the check is about; the text says what."""


@dataclass(frozen=True)
class Target:
    """Where the server is: `host` and `port`, or a serial `path` and its `baud`."""

    host: str = ""
    port: int = 0
    path: str = ""
    baud: int = BAUD["B9600"]

    @property
    def is_tcp(self) -> bool:
        """A TCP connection, which has no rate."""
        return bool(self.host)


def parse_target(text: str) -> Target:
    """Read tcp:HOST:PORT or serial:PATH[@BAUD].

    >>> parse_target("serial:/dev/ttyUSB0@38400").baud
    38400
    """
    kind, _, rest = text.partition(":")
    if kind == "tcp":
        host, _, port = rest.rpartition(":")
        if host and port.isdigit() and 0 < int(port) <= 65535:
            return Target(host=host.strip("[]"), port=int(port))
    if kind == "serial":
        match = re.fullmatch(r"(.+?)(?:@(\d+))?", rest)
        if match and int(match[2] or BAUD["B9600"]) in BAUD.values():
            return Target(path=match[1], baud=int(match[2] or BAUD["B9600"]))
    rates = ", ".join(map(str, BAUD.values()))
    raise SimError(f"--target {text}: not tcp:HOST:PORT or serial:PATH[@BAUD] with a rate of {rates}")


@dataclass(frozen=True)
class Heard:
    """A packet and when it came, seconds of the monotonic clock."""

    t_s: float
    packet: Packet


class Client:
    """Talks to a target; while it waits it keeps the watchdog fed, unless `pulses` is off."""

    def __init__(self, target: Target, patience_s: float = PATIENCE_S) -> None:
        """`patience_s`: how long an answer may take before it counts as none."""
        self.target = target
        self.patience_s = patience_s
        self.pulses = True
        self.in_session = False
        self.damaged = 0
        self.identity: SyncReply | None = None
        self._line: Any = None
        self._unframer = Unframer()
        self._waiting: deque[Heard] = deque()
        self._sent_s = 0.0

    # ---- transport

    def open(self) -> None:
        """Connect; a connection refused is tried again for a while, since some servers listen late."""
        self._unframer = Unframer()
        self._waiting.clear()
        if not self.target.is_tcp:
            try:
                self._line = serial.Serial(self.target.path, self.target.baud, timeout=0, exclusive=True)
            except (OSError, ValueError) as error:
                raise LinkError(f"{self.target.path}: {error}; check the device and its rights") from error
            return
        until = time.monotonic() + self.patience_s
        while True:
            try:
                self._line = socket.create_connection((self.target.host, self.target.port), self.patience_s)
                self._line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self._line.setblocking(False)
            except OSError as error:
                if time.monotonic() < until:
                    time.sleep(0.1)
                    continue
                place = f"{self.target.host}:{self.target.port}"
                raise LinkError(f"{place}: {error.strerror or error}; is the server running?") from error
            return

    def close(self) -> None:
        """Leave; a session is ended first."""
        if self._line is not None and self.in_session:
            self.command("CLOSE", 1)
            self.hear(0.2)
        self._shut()

    def _shut(self) -> None:
        if self._line is not None:
            self._line.close()
        self._line = None
        self.in_session = False

    @property
    def connected(self) -> bool:
        """The transport stands; a server may close it."""
        return self._line is not None

    def set_baud(self, baud: int) -> None:
        """Change our side of a serial line."""
        self._line.baudrate = baud

    def send(self, data: bytes) -> None:
        """Send bytes in one write."""
        self._sent_s = time.monotonic()
        if self._line is None:
            raise Failed("the server closed the connection")
        try:
            if self.target.is_tcp:
                self._line.sendall(data)
            else:
                self._line.write(data)
        except (BrokenPipeError, ConnectionError):
            self._shut()

    def command(self, name: str, value: int | None = None) -> None:
        """Send one command by its name."""
        number = COMMAND[name]
        self.send(frame((Command(number) if value is None else Command.integer(number, value)).data))

    def _read(self, timeout_s: float) -> bytes:
        if self._line is None:
            time.sleep(max(0.0, timeout_s))
            return b""
        if not select.select([self._line], [], [], max(0.0, timeout_s))[0]:
            return b""
        try:
            data = bytes(self._line.recv(4096) if self.target.is_tcp else self._line.read(4096))
        except ConnectionError:
            data = b""
        except OSError as error:
            raise LinkError(f"{self.target.path}: lost ({error}); check the cable") from error
        if not data and self.target.is_tcp:
            self._shut()
        return data

    # ---- packets

    def hear(self, seconds: float, enough: Callable[[Packet], bool] | None = None) -> list[Heard]:
        """Return what comes within `seconds`, or until a packet of which `enough` is true."""
        heard: list[Heard] = []
        until = time.monotonic() + seconds
        while (now := time.monotonic()) < until:
            self._pulse(now)
            if not self._waiting:
                self._take(min(until - now, 0.1))
            while self._waiting:
                heard.append(self._waiting.popleft())
                if enough is not None and enough(heard[-1].packet):
                    return heard
            if self._line is None:
                break
        return heard

    def _pulse(self, now: float) -> None:
        """Keep a session alive in which nothing was said for a while."""
        if self.pulses and self.in_session and now - self._sent_s > _PULSE_S and self._line is not None:
            self.command("PULSE")

    def _take(self, timeout_s: float) -> None:
        data = self._read(timeout_s)
        now = time.monotonic()
        for item in self._unframer.feed(data, now * 1000) + self._unframer.poll(now * 1000):
            try:
                self._waiting.append(Heard(now, decode(item)))
            except PacketError:
                self.damaged += 1

    def answer(self, kind: type[Packet], seconds: float | None = None) -> Packet | None:
        """The first packet of a kind, None if it does not come."""
        heard = self.hear(seconds or self.patience_s, lambda packet: isinstance(packet, kind))
        return heard[-1].packet if heard and isinstance(heard[-1].packet, kind) else None

    def sips(self, count: int) -> list[Sip]:
        """The next SIPs, `count` of them."""
        return [sip for _, sip in self.timed_sips(count)]

    def timed_sips(self, count: int) -> list[tuple[float, Sip]]:
        """The next SIPs with their times."""
        found: list[tuple[float, Sip]] = []
        while len(found) < count:
            heard = self.hear(self.patience_s, lambda packet: isinstance(packet, Sip))
            if not heard or not isinstance(heard[-1].packet, Sip):
                raise Failed(f"no SIP for {self.patience_s:g} s")
            found.append((heard[-1].t_s, heard[-1].packet))
        return found

    def until(self, what: str, probe: Callable[[Sip], bool], sips: int) -> Sip:
        """The first of the next `sips` SIPs of which `probe` is true."""
        for _ in range(sips):
            (sip,) = self.sips(1)
            if probe(sip):
                return sip
        raise Failed(f"not within {sips} SIPs: {what}")

    # ---- sessions

    def fresh(self) -> None:
        """Come to a server that waits for a handshake, whatever was before."""
        self.pulses = True
        if self.in_session and self.connected:
            self.command("CLOSE", 1)
            self.in_session = False
            self.hear(0.15)
        if self.target.is_tcp or not self.connected:
            self._shut()
            self.open()
        heard = self.hear(QUIET_S)
        if not self.connected:
            # A server that serves one client at a time may have been about to stop listening.
            self.open()
            heard = self.hear(QUIET_S)
        if any(isinstance(item.packet, Sip) for item in heard):
            for name, value in (("VEL", 0), ("RVEL", 0), ("CLOSE", 1)):
                self.command(name, value)
            self.hear(QUIET_S)
            if not self.connected:
                self.open()

    def halt(self) -> None:
        """Let the robot stand, whatever it was ordered before."""
        self.pulses = True
        if self.in_session and self.connected:
            self.command("VEL", 0)
            self.command("RVEL", 0)

    def waiting(self) -> None:
        """Come to a server that has heard no SYNC since its last session."""
        self.start()
        self.command("CLOSE", 1)
        self.in_session = False
        self.fresh()

    def sync(self, name: str, seconds: float | None = None) -> Packet | None:
        """Send one SYNC (PULSE, OPEN, CLOSE by number) and return what answers it."""
        self.command(name)
        heard = self.hear(seconds or self.patience_s, lambda _: True)
        return heard[0].packet if heard else None

    def start(self, motors: bool = False) -> None:
        """Begin a session: the three SYNCs and OPEN."""
        self.fresh()
        self.begin()
        if motors:
            self.command("ENABLE", 1)
            self.until("FLAGS bit 0 after ENABLE 1", lambda sip: bool(sip.flags & 1), 10)

    def begin(self) -> None:
        """The three SYNCs and OPEN, from a server that waits for them."""
        for name in ("PULSE", "OPEN", "CLOSE"):
            reply = self.sync(name)
            if reply is None:
                raise Failed(f"no answer to SYNC{COMMAND[name]}")
            if isinstance(reply, SyncReply):
                self.identity = reply
        self.command("OPEN", 1)
        self.in_session = True
        self.sips(1)
