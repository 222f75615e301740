# SPDX-License-Identifier: MIT
"""The TCP link inside captured frames: which bytes each side sent, in order, and frames made from bytes."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final

from argus_tools.chunks import (
    CLIENT_TO_ROBOT,
    ROBOT_TO_CLIENT,
    Chunk,
    Damage,
    Direction,
    Offsets,
    ReadOptions,
)
from argus_tools.formats.bin import guess_direction

DEFAULT_PORT: Final = 8101
CLIENT_PORT: Final = 50000
LINK_ETHERNET: Final = 1
SEGMENT_BYTES: Final = 1400
# Out-of-order segments held back before the missing ones are given up.
HELD_MAX: Final = 64
CONNECTIONS_MAX: Final = 4096
_HEADER: Final = b"\xfa\xfb"
_FIN, _SYN, _RST, _PSH, _ACK = 1, 2, 4, 8, 16
_TCP: Final = 6
_IPV4, _IPV6 = 0x0800, 0x86DD
_VLANS: Final = (0x8100, 0x88A8)
# Bytes before the network header, and where in them its protocol number stands.
_LINKS: Final = {1: (14, 12), 113: (16, 14), 276: (20, 0)}
_RAW_LINKS: Final = {0: 4, 12: 0, 14: 0, 101: 0, 108: 4, 228: 0, 229: 0}
IP_LINKS: Final = frozenset((*_LINKS, *_RAW_LINKS))

Endpoint = tuple[bytes, int]


@dataclass(frozen=True)
class Segment:
    """One TCP segment."""

    source: Endpoint
    target: Endpoint
    seq: int
    flags: int
    data: bytes


def _network(link: int, frame: bytes) -> bytes:
    """Return the frame from its IP header on, or nothing."""
    if link in _RAW_LINKS:
        return frame[_RAW_LINKS[link] :]
    if link not in _LINKS:
        return b""
    at, kind_at = _LINKS[link]
    kind = int.from_bytes(frame[kind_at : kind_at + 2], "big")
    while kind in _VLANS:
        kind = int.from_bytes(frame[at + 2 : at + 4], "big")
        at += 4
    return frame[at:] if kind in (_IPV4, _IPV6) else b""


def parse(link: int, frame: bytes) -> Segment | None:
    """Return the TCP segment in a captured frame, None if it holds no (whole) one."""
    packet = _network(link, frame)
    if len(packet) < 20:
        return None
    if packet[0] >> 4 == 4:
        total, at = int.from_bytes(packet[2:4], "big"), (packet[0] & 0xF) * 4
        fragment = int.from_bytes(packet[6:8], "big") & 0x3FFF
        if packet[9] != _TCP or fragment:
            return None
        source, target = packet[12:16], packet[16:20]
        packet = packet[at : total or None]
    elif packet[0] >> 4 == 6 and len(packet) >= 40 and packet[6] == _TCP:
        source, target = packet[8:24], packet[24:40]
        packet = packet[40 : 40 + int.from_bytes(packet[4:6], "big")]
    else:
        return None
    if len(packet) < 20:
        return None
    source_port, target_port, seq, _, offset, flags = struct.unpack_from(">HHIIBB", packet)
    data = packet[(offset >> 4) * 4 :]
    return Segment((source, source_port), (target, target_port), seq, flags, data)


@dataclass
class _Half:
    """One direction of a connection."""

    next_seq: int | None = None
    held: dict[int, tuple[float | None, bytes]] = field(default_factory=dict)


@dataclass
class Streams:
    """Follows the connections to one robot and yields what was sent over them."""

    options: ReadOptions
    damage: list[Damage]
    robot: Endpoint | None = None
    _offsets: Offsets = field(default_factory=Offsets)
    _halves: dict[tuple[Endpoint, Endpoint], _Half] = field(default_factory=dict)
    _servers: dict[Endpoint, None] = field(default_factory=dict)
    _others: set[Endpoint] = field(default_factory=set)

    @property
    def is_used(self) -> bool:
        """Whether a robot was found."""
        return self.robot is not None

    def take(self, t: float | None, number: int, segment: Segment) -> Iterator[Chunk]:
        """Take the next segment, from frame `number` of the file."""
        key = (segment.source, segment.target)
        if segment.flags & _SYN:
            if self.robot is not None and self.robot not in key:
                return
            self._forget_oldest()
            self._servers[segment.source if segment.flags & _ACK else segment.target] = None
            self._halves[key] = _Half((segment.seq + 1) & 0xFFFFFFFF)
            return
        if not segment.data or not self._is_ours(segment, number):
            return
        half = self._halves.setdefault(key, _Half())
        if half.next_seq is None:
            half.next_seq = segment.seq
        direction = ROBOT_TO_CLIENT if segment.source == self.robot else CLIENT_TO_ROBOT
        half.held.setdefault(segment.seq, (t, segment.data))
        yield from self._release(half, direction)
        if len(half.held) > HELD_MAX:
            yield from self._skip_gap(half, direction, f"frame {number}")

    def finish(self) -> Iterator[Chunk]:
        """Yield what waited for segments that never came."""
        for (source, _), half in self._halves.items():
            direction = ROBOT_TO_CLIENT if source == self.robot else CLIENT_TO_ROBOT
            while half.held:
                yield from self._skip_gap(half, direction, "end of file")

    def _forget_oldest(self) -> None:
        """Keep no more than so many connections, as a capture of a busy network has any number."""
        while len(self._halves) >= CONNECTIONS_MAX and self._forget(next(iter(self._halves))):
            pass
        while len(self._servers) >= CONNECTIONS_MAX:
            del self._servers[next(iter(self._servers))]

    def _forget(self, key: tuple[Endpoint, Endpoint]) -> bool:
        """Forget one direction of a connection; False if something of it is still to be read."""
        if self._halves[key].held:
            return False
        del self._halves[key]
        return True

    def _is_ours(self, segment: Segment, number: int) -> bool:
        if self.robot is None:
            if self.options.port is None and _HEADER not in segment.data:
                return False
            self.robot = self._find_robot(segment)
        if self.robot is None:
            return False
        if self.robot in (segment.source, segment.target):
            return True
        if self.options.port is None and segment.data.startswith(_HEADER):
            other = min(segment.source, segment.target, key=lambda end: end[1])
            if other not in self._others:
                self._others.add(other)
                what = f"port {other[1]} is left out, as port {self.robot[1]} came first; choose with --port"
                self.damage.append(Damage(f"frame {number}", what))
        return False

    def _find_robot(self, segment: Segment) -> Endpoint | None:
        ends = (segment.source, segment.target)
        if self.options.port is not None:
            return next((end for end in ends if end[1] == self.options.port), None)
        for end in ends:
            if end in self._servers or (
                end[1] == DEFAULT_PORT and not any(other in self._servers for other in ends)
            ):
                return end
        return segment.source if guess_direction(segment.data) == ROBOT_TO_CLIENT else segment.target

    def _release(self, half: _Half, direction: Direction) -> Iterator[Chunk]:
        assert half.next_seq is not None
        progress = True
        while progress and half.held:
            progress = False
            for seq in tuple(half.held):
                old = (half.next_seq - seq) & 0xFFFFFFFF
                if old > 0x7FFFFFFF:
                    continue
                t, data = half.held.pop(seq)
                if old < len(data):
                    half.next_seq = (seq + len(data)) & 0xFFFFFFFF
                    yield self._offsets.chunk(t, direction, data[old:])
                    progress = True

    def _skip_gap(self, half: _Half, direction: Direction, place: str) -> Iterator[Chunk]:
        assert half.next_seq is not None
        start = half.next_seq
        nearest = min(half.held, key=lambda seq: (seq - start) & 0xFFFFFFFF)
        missing = (nearest - start) & 0xFFFFFFFF
        self.damage.append(Damage(place, f"{missing} bytes of the TCP stream were not captured"))
        half.next_seq = nearest
        yield from self._release(half, direction)


def _sum16(data: bytes) -> int:
    data += b"\0" * (len(data) & 1)
    total: int = sum(struct.unpack(f">{len(data) // 2}H", data))
    while total >> 16:
        total = (total & 0xFFFF) + (total >> 16)
    return total ^ 0xFFFF


class Connection:
    """Makes the frames of one connection on the loopback addresses, its opening included."""

    def __init__(self, port: int = DEFAULT_PORT) -> None:
        self._port = port
        self._seq: dict[Direction, int] = {CLIENT_TO_ROBOT: 1000, ROBOT_TO_CLIENT: 5000}

    def opening(self) -> list[bytes]:
        """The three frames that open the connection."""
        frames = [self._frame(CLIENT_TO_ROBOT, _SYN), self._frame(ROBOT_TO_CLIENT, _SYN | _ACK)]
        return [*frames, self._frame(CLIENT_TO_ROBOT, _ACK)]

    def frames(self, direction: Direction, data: bytes) -> list[bytes]:
        """The frames that carry the data."""
        parts = (data[at : at + SEGMENT_BYTES] for at in range(0, len(data), SEGMENT_BYTES))
        return [self._frame(direction, _PSH | _ACK, part) for part in parts]

    def _frame(self, direction: Direction, flags: int, data: bytes = b"") -> bytes:
        is_robot = direction == ROBOT_TO_CLIENT
        other: Direction = CLIENT_TO_ROBOT if is_robot else ROBOT_TO_CLIENT
        client, robot = b"\x7f\0\0\1", b"\x7f\0\0\2"
        source, target = (robot, client) if is_robot else (client, robot)
        ports = (self._port, CLIENT_PORT) if is_robot else (CLIENT_PORT, self._port)
        ack = self._seq[other] if flags & _ACK else 0
        head = struct.pack(">HHIIBBHHH", *ports, self._seq[direction], ack, 5 << 4, flags, 65535, 0, 0)
        pseudo = source + target + struct.pack(">BBH", 0, _TCP, len(head) + len(data))
        head = head[:16] + _sum16(pseudo + head + data).to_bytes(2, "big") + head[18:]
        total = 20 + len(head) + len(data)
        ip = struct.pack(">BBHHHBBH4s4s", 0x45, 0, total, 0, 0x4000, 64, _TCP, 0, source, target)
        ip = ip[:10] + _sum16(ip).to_bytes(2, "big") + ip[12:]
        self._seq[direction] = (self._seq[direction] + len(data) + bool(flags & _SYN)) & 0xFFFFFFFF
        return b"\0" * 12 + _IPV4.to_bytes(2, "big") + ip + head + data
