# SPDX-License-Identifier: MIT
"""Drives a robot over a port that speaks ARCOS, argusd's guard as a rule: speeds in, and a watchdog that stops it."""

from __future__ import annotations

import select
import socket
import threading
import time
from collections.abc import Callable
from typing import Final

from hil_sim.arcos import COMMAND, Command, PacketError, Sip, SyncEcho, SyncReply, Unframer, decode, frame

_PAUSE_S: Final = 1.0
_SYNC_S: Final = 0.5
_TRIES: Final = 6
_PULSE_S: Final = 0.5
_TICK_S: Final = 0.05
_SILENT_S: Final = 1.5


class Lost(Exception):
    """The port is gone, or no robot answers; the text is one line."""


class Wheels:
    """A client of an ARCOS port on TCP, in a thread of its own; it connects again when the port was lost.

    Without a new order for `timeout_s` the robot is stopped. Before the first order the motors are left alone.
    """

    def __init__(
        self, host: str, port: int, timeout_s: float, tell: Callable[[str], None] = lambda _: None
    ) -> None:
        self._place, self.timeout_s, self._tell = (host, port), timeout_s, tell
        self._lock = threading.Lock()
        self._wanted = (0, 0)
        self._wanted_s = -1.0
        self._said: tuple[int, int] | None = None
        self._sock: socket.socket | None = None
        self._unframer = Unframer()
        self._sent_s = self._heard_s = 0.0
        self._ended = threading.Event()
        self.connected = False
        self.why_not = "not tried yet"
        self.sips, self.last = 0, Sip()
        self._thread = threading.Thread(target=self._run, name="wheels", daemon=True)
        self._thread.start()

    def drive(self, speed_mm_s: int, turn_deg_s: int) -> bool:
        """Order speeds; False when there is no robot to drive."""
        with self._lock:
            self._wanted, self._wanted_s = (speed_mm_s, turn_deg_s), time.monotonic()
            if self.connected:
                try:
                    self._follow_order()
                except OSError:
                    return False
            return self.connected

    def halt(self) -> None:
        """Stop the robot if it was ordered to drive; motors that nobody has used are left alone."""
        with self._lock:
            is_driven = self._said is not None
        if is_driven:
            self.drive(0, 0)

    def close(self) -> None:
        """Stop the robot and leave."""
        self._ended.set()
        self._thread.join()

    # ---- the thread

    def _run(self) -> None:
        told = ""
        while not self._ended.is_set():
            try:
                self._connect()
                told = ""
                self._tell("the robot's port is open")
                while not self._ended.is_set():
                    self._turn()
                self._leave()
            except (OSError, Lost) as error:
                why = f"{self._place[0]}:{self._place[1]}: {error}"
                self.why_not = why
                if why != told:
                    self._tell(f"cmd_vel goes nowhere: {why}")
                told = why
            with self._lock:
                self.connected = False
                if self._sock is not None:
                    self._sock.close()
                self._sock = None
            self._ended.wait(_PAUSE_S)

    def _connect(self) -> None:
        self._sock = socket.create_connection(self._place, 2.0)
        self._sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._unframer, self._said = Unframer(), None
        for name in ("PULSE", "OPEN", "CLOSE"):  # SYNC0, SYNC1, SYNC2
            self._sync(name)
        self._send("OPEN", 1)
        self._heard_s = time.monotonic()
        with self._lock:
            self.connected = True

    def _sync(self, name: str) -> None:
        for _ in range(_TRIES):
            self._send(name)
            until = time.monotonic() + _SYNC_S
            while (left := until - time.monotonic()) > 0:
                for packet in self._packets(left):
                    if isinstance(packet, SyncReply) or packet == SyncEcho(COMMAND[name]):
                        return
        raise Lost("no robot answers")

    def _packets(self, timeout_s: float) -> list[object]:
        assert self._sock is not None
        if not select.select([self._sock], [], [], timeout_s)[0]:
            return []
        data = self._sock.recv(4096)
        if not data:
            raise Lost("the connection was closed")
        found: list[object] = []
        for content in self._unframer.feed(data, time.monotonic() * 1000):
            try:
                found.append(decode(content))
            except PacketError:
                continue
        return found

    def _turn(self) -> None:
        now = time.monotonic()
        for packet in self._packets(_TICK_S):
            if isinstance(packet, Sip):
                self.sips, self.last = self.sips + 1, packet
                self._heard_s = now
        if now - self._heard_s > _SILENT_S:
            raise Lost("the robot has become silent")
        with self._lock:
            if self._said not in (None, (0, 0)) and now - self._wanted_s > self.timeout_s:
                self._tell(f"no cmd_vel for {self.timeout_s:g} s: stopped")
                self._wanted = (0, 0)
                self._follow_order()
            if now - self._sent_s > _PULSE_S:
                self._send("PULSE")

    def _follow_order(self) -> None:
        """Send what is wanted, where it differs from what was said."""
        speed, turn = self._wanted
        if self._said is None:
            self._send("ENABLE", 1)
        if self._said is None or self._said[0] != speed:
            self._send("VEL", speed)
        if self._said is None or self._said[1] != turn:
            self._send("RVEL", turn)
        self._said = self._wanted

    def _leave(self) -> None:
        with self._lock:
            if self._said is not None:
                self._send("VEL", 0)
                self._send("RVEL", 0)
            self._send("CLOSE")

    def _send(self, name: str, value: int | None = None) -> None:
        assert self._sock is not None
        number = COMMAND[name]
        command = Command(number) if value is None else Command.integer(number, value)
        self._sent_s = time.monotonic()
        self._sock.sendall(frame(command.data))
