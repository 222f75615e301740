# SPDX-License-Identifier: MIT
"""A link that went through a telnet server: its negotiation taken out, its doubled bytes made one; found and told."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from argus_tools.chunks import (
    CLIENT_TO_ROBOT,
    ROBOT_TO_CLIENT,
    Chunk,
    Damage,
    DamageList,
    Direction,
    Offsets,
)
from hil_sim.arcos import Unframer

_IAC: Final = 255
_IAC_BYTE: Final = bytes((_IAC,))
_SUB, _SUB_END = 250, 240
# WILL, WON'T, DO and DON'T have an option behind them.
_OPTIONS: Final = range(251, 255)
_LOOKED_AT: Final = 1 << 16
_SUB_MAX: Final = 1 << 10
TOLD: Final = (
    "a telnet server was between (negotiation, each FF doubled): undone; next time let the server pass bytes as they "
    'are, in ser2net "accepter: tcp,PORT" without telnet'
)


class Telnet:
    """Takes the bytes of one direction as telnet sends them; returns those that were meant."""

    def __init__(self) -> None:
        self._held = b""

    def feed(self, data: bytes) -> bytes:
        """Return what is sure by now."""
        data = self._held + data
        self._held = b""
        out: list[bytes] = []
        at = 0
        while (found := data.find(_IAC_BYTE, at)) >= 0:
            out.append(data[at:found])
            end = _end(data, found)
            if end is None:
                self._held = data[found:]
                return b"".join(out)
            if data[found + 1] == _IAC:
                out.append(_IAC_BYTE)
            at = end
        out.append(data[at:])
        return b"".join(out)


def _end(data: bytes, at: int) -> int | None:
    """Return where a command that begins there ends; None if its end is still to come."""
    if at + 1 >= len(data):
        return None
    kind = data[at + 1]
    if kind == _SUB:
        end = data.find(bytes((_IAC, _SUB_END)), at + 2)
        if end >= 0:
            return end + 2
        return None if len(data) - at < _SUB_MAX else at + 2
    if kind in _OPTIONS:
        return at + 3 if at + 2 < len(data) else None
    return at + 2


def _packets(data: bytes) -> int:
    return sum(len(packet) > 1 for packet in Unframer().feed(data))


def is_telnet(samples: Iterable[bytes]) -> bool:
    """Whether the bytes of each direction hold more packets once telnet is undone."""
    plain = undone = 0
    for sample in samples:
        plain += _packets(sample)
        undone += _packets(Telnet().feed(sample)) if _IAC_BYTE in sample else _packets(sample)
    return undone > plain


class Untelneted:
    """Iterates a reader's chunks; those of a telnet link as they were meant."""

    def __init__(self, reader: Iterable[Chunk], damage: DamageList) -> None:
        self._reader = reader
        self._damage = damage
        self._place: str | None = None

    @property
    def place(self) -> str:
        """Where in the file the last chunk stands."""
        return self._place if self._place is not None else str(getattr(self._reader, "place", ""))

    def __iter__(self) -> Iterator[Chunk]:
        chunks = iter(self._reader)
        head: list[tuple[Chunk, str]] = []
        samples: dict[Direction, bytearray] = {ROBOT_TO_CLIENT: bytearray(), CLIENT_TO_ROBOT: bytearray()}
        size = 0
        for chunk in chunks:
            head.append((chunk, self.place))
            samples[chunk.dir] += chunk.data
            size += len(chunk.data)
            if size >= _LOOKED_AT:
                break
        if not is_telnet(map(bytes, samples.values())):
            for chunk, self._place in head:
                yield chunk
            self._place = None
            yield from chunks
            return
        self._damage.correct(Damage("the link", TOLD))
        sides = {ROBOT_TO_CLIENT: Telnet(), CLIENT_TO_ROBOT: Telnet()}
        offsets = Offsets()
        for chunk, self._place in head:
            yield offsets.chunk(chunk.t, chunk.dir, sides[chunk.dir].feed(chunk.data))
        self._place = None
        for chunk in chunks:
            yield offsets.chunk(chunk.t, chunk.dir, sides[chunk.dir].feed(chunk.data))
