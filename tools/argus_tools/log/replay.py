# SPDX-License-Identifier: MIT
"""`argus-log replay`: serves a log as a robot on a pseudo-terminal or TCP port, for any client."""

from __future__ import annotations

import argparse
import contextlib
import os
import select
import signal
import sys
import time
from collections.abc import Callable, Iterator
from typing import Any, Final

from argus_tools.chunks import ROBOT_TO_CLIENT, LogError
from argus_tools.log.common import Input, add_log_arguments, add_robot_arguments
from argus_tools.log.exits import EXIT_READ
from argus_tools.log.opening import identity_in
from argus_tools.log.packets import Row
from hil_sim.arcos import COMMAND, TIMING, Command, ConfigPac, SyncEcho, SyncReply, Unframer, frame
from hil_sim.links.base import Link
from hil_sim.links.pty import PtyLink
from hil_sim.links.tcp import TcpLink

EXAMPLES: Final = """\
  argus-log replay drive.rec                          on a pseudo-terminal; prints the device to open
  argus-log replay drive.rec --tcp 8101 --speed 10    ten times as fast, where clients look for a simulator
  argus-log replay drive.rec --tcp 8101 --step        Enter lets one SIP through, 20 and Enter twenty

The handshake and CONFIG are answered; the log begins with the client's OPEN, anew with each session. Other commands
change nothing. Of a pause longer than 10 s only so much is played. With the log ends the program. A log without
times is taken as one SIP each 100 ms.
"""
_HOST: Final = "localhost"
_IDLE_MS: Final = 50.0
# What a pseudo-terminal may still hold of the log's last packets.
_DRAIN_MS: Final = 500.0
_SIP_MS: Final = TIMING["SIP_CYCLE_MS"]
# No drive pauses so long, and no client waits for it.
_PAUSE_MAX_S: Final = 10.0
_LOOK_ROWS: Final = 500
_SPEED_MAX: Final = 1000.0
_BAUDS: Final = (9600, 19200, 38400, 57600, 115200)
_SYNC_REPLIES: Final = frozenset(("SYNC0", "SYNC1", "SYNC2"))
_STEPS_MAX: Final = 1_000_000
_REPLAYED_NAME: Final = b"replay"


class Identity:
    """What the robot of a log is, as far as the log tells; the rest is a P3-DX without accessories."""

    def __init__(self, rows: Iterator[Row], subclass: str | None) -> None:
        name = (subclass or "p3dx-sh").encode("latin-1", "replace")
        self.reply = SyncReply(_REPLAYED_NAME, b"Pioneer", name)
        self.config = ConfigPac(subtype=name, name=_REPLAYED_NAME).data
        for row, _ in zip(rows, range(_LOOK_ROWS), strict=False):
            if not row.ok or row.dir != ROBOT_TO_CLIENT:
                continue
            if reply := identity_in(row):
                self.reply = reply
            elif row.type == "CONFIGPAC":
                self.config = row.data
        if subclass:
            self.reply = SyncReply(self.reply.name, self.reply.robot_class, name)


class Player:
    """The robot that is played: `receive` bytes, `advance` time, collect `outgoing`; times are in ms.

    With `is_stepped` time stands; `release` lets SIPs through, each with what came before it.
    """

    def __init__(
        self,
        identity: Identity,
        begin: Callable[[], Iterator[Row]],
        speed: float = 1.0,
        is_stepped: bool = False,
    ) -> None:
        self.is_open = False
        self.is_over = False
        self.sips = 0
        self.packets = 0
        self._identity = identity
        self._begin = begin
        self._speed = speed
        self._is_stepped = is_stepped
        self._released = 0
        self._unframer = Unframer()
        self._synced = -1
        self._rows: Iterator[Row] = iter(())
        self._next: Row | None = None
        self._log_ms = 0.0
        self._first_ms = 0.0
        self._last_t: float | None = None
        self._left_out_s = 0.0
        self._opened_ms = 0.0
        self._out: list[bytes] = []

    def receive(self, data: bytes, now_ms: float) -> None:
        """Take bytes from the client."""
        for packet in self._unframer.feed(data, now_ms):
            number = Command.decode(packet).number
            if not self.is_open:
                self._handshake(number, now_ms)
            elif number == COMMAND["CLOSE"]:
                self.client_gone()
            elif number == COMMAND["CONFIG"]:
                self._out.append(frame(self._identity.config))

    def _handshake(self, number: int, now_ms: float) -> None:
        if number == COMMAND["OPEN"] and self._synced == COMMAND["CLOSE"]:
            self._start(now_ms)
        elif number == 0 or (number <= COMMAND["CLOSE"] and self._synced in (number - 1, number)):
            self._synced = number
            is_last = number == COMMAND["CLOSE"]
            self._out.append(frame(self._identity.reply.data if is_last else SyncEcho(number).data))
        else:
            self._synced = -1

    def _start(self, now_ms: float) -> None:
        self.is_open = True
        self._synced = -1
        self._opened_ms = now_ms
        self._log_ms = 0.0
        self._last_t, self._left_out_s = None, 0.0
        self._rows = (row for row in self._begin() if row.dir == ROBOT_TO_CLIENT)
        self._fetch()
        # A robot's first SIP comes a cycle after OPEN.
        self._first_ms = self._log_ms - _SIP_MS

    def _played(self, t: float) -> float:
        """Return a time of the log less what is left out of its long pauses, as between two drives in one file."""
        if self._last_t is not None and t - self._last_t > _PAUSE_MAX_S:
            self._left_out_s += t - self._last_t - _PAUSE_MAX_S
            _say(f"nothing came for {t - self._last_t:.0f} s; {_PAUSE_MAX_S:.0f} s of that are played")
        self._last_t = t if self._last_t is None else max(self._last_t, t)
        return t - self._left_out_s

    def client_gone(self) -> None:
        """The session is over."""
        self.is_open = False
        self._synced = -1
        self._next = None
        self._released = 0

    def release(self, sips: int) -> None:
        """Let more SIPs through."""
        self._released = min(self._released + sips, _STEPS_MAX)

    def _fetch(self) -> None:
        """Look at the next packet that the robot sent by itself."""
        for row in self._rows:
            if row.ok and (row.type in _SYNC_REPLIES or row.type == "CONFIGPAC"):
                continue
            if row.t is not None:
                self._log_ms = max(self._log_ms, self._played(row.t) * 1000)
            elif row.type == "SIP":
                self._log_ms += _SIP_MS
            self._next = row
            return
        self._next = None
        self.is_over = True

    @property
    def next_due_ms(self) -> float | None:
        """When the next packet is due; None when it is not a matter of time."""
        if self._next is None:
            return None
        if self._is_stepped:
            return self._opened_ms if self._released else None
        return self._opened_ms + (self._log_ms - self._first_ms) / self._speed

    def advance(self, now_ms: float) -> None:
        """Let time pass up to now."""
        while self._next is not None and (due_ms := self.next_due_ms) is not None and due_ms <= now_ms:
            row = self._next
            self._out.append(row.wire)
            self.packets += 1
            if row.type == "SIP":
                self.sips += 1
                self._released -= self._is_stepped
            self._fetch()

    def outgoing(self) -> list[bytes]:
        """Return what is to be sent now."""
        out, self._out = self._out, []
        return out


def again(begin: Callable[[], Iterator[Row]]) -> Iterator[Row]:
    """Yield a log over and over, each time a SIP cycle behind the last."""
    shift_s = 0.0
    while True:
        first_s: float | None = None
        last_s = 0.0
        for row in begin():
            if row.t is None:
                yield row
                continue
            first_s, last_s = row.t if first_s is None else first_s, row.t
            yield row._replace(t=row.t + shift_s)
        if first_s is not None:
            shift_s += last_s - first_s + _SIP_MS / 1000


def _tcp(text: str) -> tuple[str, int]:
    host, _, port = text.rpartition(":")
    if not port.isdecimal() or int(port) > 65535:
        raise argparse.ArgumentTypeError(f"'{text}' is no [HOST:]PORT, for example 8101")
    return host or _HOST, int(port)


def _speed(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.01 <= value <= _SPEED_MAX:
        raise argparse.ArgumentTypeError(f"'{text}' is no speed from 0.01 to {_SPEED_MAX:g}")
    return value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_log_arguments(parser)
    parser.add_argument(
        "--tcp", type=_tcp, metavar="[HOST:]PORT", help="listen there (default: a pseudo-terminal)"
    )
    parser.add_argument(
        "--link-name", metavar="PATH", help="symlink to the pseudo-terminal, removed at the end"
    )
    parser.add_argument("--baud", type=int, choices=_BAUDS, help="rate of the pseudo-terminal (default 9600)")
    pace = parser.add_mutually_exclusive_group()
    pace.add_argument(
        "--speed", type=_speed, default=1.0, metavar="X", help="so many times as fast (default 1)"
    )
    pace.add_argument("--step", action="store_true", help="Enter lets one SIP through, N and Enter N of them")
    parser.add_argument("--loop", action="store_true", help="begin anew at the log's end, until Ctrl-C")
    add_robot_arguments(parser)


def _link(args: argparse.Namespace) -> Link:
    if args.tcp is None:
        return PtyLink(args.baud or _BAUDS[0], args.link_name)
    if args.link_name or args.baud:
        raise LogError("--link-name and --baud are for a pseudo-terminal; leave them out with --tcp")
    return TcpLink(*args.tcp)


def _say(text: str) -> None:
    print(f"argus-log: {text}", file=sys.stderr, flush=True)


def run(args: argparse.Namespace) -> int:
    """Serve the log until it is over; return the exit code."""
    if args.log == "-":
        raise LogError("replay begins the log anew with each session: give a file, not standard input")

    def begin() -> Iterator[Row]:
        return again(lambda: Input(args).rows()) if args.loop else Input(args).rows()

    identity = Identity(Input(args).rows(), args.subclass)
    if not any(row.type == "SIP" and row.dir == ROBOT_TO_CLIENT for row in Input(args).rows()):
        raise LogError(f"{args.log}: holds no SIP from the robot, so there is nothing to serve")
    player = Player(identity, begin, args.speed, args.step)
    link = _link(args)
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        link.open()
        print(link.address, flush=True)
        with contextlib.suppress(KeyboardInterrupt):
            _serve(player, link, sys.stdin.fileno() if args.step else None)
    finally:
        signal.signal(signal.SIGTERM, before)
        link.close()
    _say(f"{'the log is over' if player.is_over else 'ended'}: {player.packets} packets, {player.sips} SIPs")
    lost = getattr(link, "lost_packets", 0)
    if lost:
        _say(f"{lost} packets did not fit on the wire; give a higher --baud or a lower --speed")
    return EXIT_READ


def _serve(player: Player, link: Link, keys: int | None) -> None:
    origin_s = time.monotonic()
    was_open = False
    over_ms = 0.0
    while True:
        now_ms = (time.monotonic() - origin_s) * 1000
        for data in link.receive(now_ms):
            player.receive(data, now_ms)
        if link.take_lost():
            player.client_gone()
        player.advance(now_ms)
        for packet in player.outgoing():
            link.send(packet, now_ms)
        link.transmit(now_ms)
        if player.is_open != was_open:
            was_open = player.is_open
            _say("the session is open" if was_open else "the session is closed")
        if not player.is_over:
            over_ms = now_ms
        elif now_ms - over_ms > _DRAIN_MS:
            return
        if not _wait(player, link, keys, now_ms):
            return


def _wait(player: Player, link: Link, keys: int | None, now_ms: float) -> bool:
    """Sleep until something is due or arrives; False when no key can come any more."""
    times = [now_ms + _IDLE_MS, player.next_due_ms, link.due_ms()]
    timeout_s = max(0.0, min(t for t in times if t is not None) - now_ms) / 1000
    readers: list[Any] = link.readers()
    ready, _, _ = select.select([*readers, *([] if keys is None else [keys])], [], [], timeout_s)
    if keys is None or keys not in ready:
        return True
    text = os.read(keys, 4096)
    for line in text.split(b"\n")[:-1]:
        player.release(int(line) if line.strip().isdigit() else 1)
    return bool(text)
