# SPDX-License-Identifier: MIT
"""Framing: the checksum, and packets found in a byte stream whatever is between or inside them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from hil_sim.arcos.fields import PacketError
from hil_sim.arcos.numbers import BAUD, FRAME, SIP, TIMING, TYPE

_HEADER: Final = bytes((FRAME["HEADER0"], FRAME["HEADER1"]))
_COUNT_MIN: Final = FRAME["COUNT_MIN"]
_COUNT_MAX: Final = FRAME["COUNT_MAX"]
_OVERHEAD: Final = FRAME["OVERHEAD"]
_QUIET_MS: Final = FRAME["RESYNC_QUIET_MS"]
_EXTRA_MS: Final = FRAME["RESYNC_EXTRA_MS"]
_CONFIG_COUNT_MAX: Final = FRAME["RESYNC_CONFIG_COUNT_MAX"]
_OTHER_COUNT_MAX: Final = FRAME["RESYNC_OTHER_COUNT_MAX"]
_SIP_TAIL_MAX: Final = FRAME["RESYNC_SIP_TAIL_MAX"]
_PACKET_MIN: Final = _COUNT_MIN + _OVERHEAD
_SIP_TYPES: Final = (TYPE["SIP_STATIONARY"], TYPE["SIP_MOVING"])
_SONAR_COUNT_AT: Final = SIP["OFFSET_SONAR_COUNT"]
_BARE_SIP: Final = SIP["OFFSET_SONAR"] + 2  # header to sonar count, and the checksum


def checksum(data: bytes | bytearray) -> int:
    """Return the 16-bit checksum over the data bytes (header and COUNT excluded).

    >>> hex(checksum(bytes([0x0B, 0x3B, 0x2C, 0x01])))
    '0x373c'
    """
    even = len(data) & ~1
    total = ((sum(data[0:even:2]) << 8) + sum(data[1:even:2])) & 0xFFFF
    if len(data) & 1:
        total ^= data[-1]
    return total


def frame(data: bytes) -> bytes:
    """Return `data` (command or type byte first) as it goes over the wire."""
    count = len(data) + 2
    if not _COUNT_MIN <= count <= _COUNT_MAX:
        raise PacketError(f"{len(data)} data bytes: a packet holds {_COUNT_MIN - 2} to {_COUNT_MAX - 2}")
    return _HEADER + bytes((count,)) + data + checksum(data).to_bytes(2, "big")


@dataclass
class UnframerCounters:
    """What an `Unframer` has met; the counts only grow."""

    packets: int = 0
    bad_checksum: int = 0
    bad_count: int = 0
    junk_bytes: int = 0
    rescued: int = 0
    timed_out: int = 0


class Unframer:
    """Finds the packets in a byte stream, whatever is between or inside them (SPEC.md, Framing).

    After a rejected header the search goes on one byte further, so a damaged packet never takes an intact one
    with it. An incomplete packet that is doubtful gives way to a whole one inside it. `feed` and `poll`
    return data parts (command or type byte first). Times are ms of any clock that does not step back.
    """

    def __init__(self) -> None:
        self.counters = UnframerCounters()
        self._held = bytearray()
        self._broken_off = False
        self._since_ms = 0.0
        self._last_byte_ms = 0.0

    @property
    def pending(self) -> int:
        """Bytes held of a packet that is not complete."""
        return len(self._held)

    def clear(self) -> None:
        """Forget the bytes held."""
        self._advance(len(self._held))

    def feed(self, chunk: bytes, now_ms: float = 0.0) -> list[bytes]:
        """Take received bytes; return the data of each packet they complete."""
        found = self.poll(now_ms)
        at = 0
        while at < len(chunk):
            if not self._held:
                start = chunk.find(_HEADER[0], at)
                start = len(chunk) if start < 0 else start
                self.counters.junk_bytes += start - at
                at = start
                self._since_ms = now_ms
            self._last_byte_ms = now_ms
            # No more than the first packet lacks: what is decided may not depend on how the bytes arrive.
            at = self._append(chunk, at)
            at = self._append(chunk, at)
            found += self.poll(now_ms)
        return found

    def poll(self, now_ms: float) -> list[bytes]:
        """Let time pass without bytes; return the packets that are released by it."""
        found = []
        while data := self._next(now_ms):
            found.append(data)
        return found

    def _next(self, now_ms: float) -> bytes:
        if self._held and now_ms - self._last_byte_ms >= _QUIET_MS:
            self._broken_off = True
        while self._seek():
            if self._owed() == 0:
                if self._accept():
                    return self._take()
            elif self._is_doubtful() and (start := self._find_inside()):
                self.counters.rescued += 1
                self._skip(start)
                return self._take()
            elif self._is_overdue(now_ms):
                self.counters.timed_out += 1
                self._skip(1)
            else:
                break
        return b""

    def _append(self, chunk: bytes, at: int) -> int:
        taken = chunk[at : at + self._owed()]
        self._held += taken
        return at + len(taken)

    def _owed(self) -> int:
        held = self._held
        total = held[2] + _OVERHEAD if len(held) >= 3 else 3
        return max(0, total - len(held))

    def _advance(self, count: int) -> None:
        del self._held[:count]
        self._since_ms = self._last_byte_ms
        if not self._held:
            self._broken_off = False

    def _skip(self, count: int) -> None:
        self.counters.junk_bytes += count
        self._advance(count)

    def _seek(self) -> bool:
        """Go to the first byte that can start a packet; False when there is none."""
        held = self._held
        start = held.find(_HEADER)
        if start < 0:
            start = len(held) - (held[-1:] == _HEADER[:1])
        if start:
            self._skip(start)
        return bool(held)

    def _checksum_holds(self, start: int, end: int) -> bool:
        held = self._held
        return checksum(held[start + 3 : end - 2]) == held[end - 2] << 8 | held[end - 1]

    def _accept(self) -> bool:
        """Whether the complete packet at the front is good; the header of a bad one is skipped."""
        if self._held[2] < _COUNT_MIN:
            self.counters.bad_count += 1
        elif self._checksum_holds(0, self._held[2] + _OVERHEAD):
            return True
        else:
            self.counters.bad_checksum += 1
        self._skip(1)
        return False

    def _take(self) -> bytes:
        total = self._held[2] + _OVERHEAD
        data = bytes(self._held[3 : total - 2])
        self.counters.packets += 1
        self._broken_off = False
        self._advance(total)
        return data

    def _is_doubtful(self) -> bool:
        held = self._held
        if len(held) < _PACKET_MIN:
            return False
        count, kind = held[2], held[3]
        if kind in _SIP_TYPES:
            if len(held) <= _SONAR_COUNT_AT:
                return False
            tail = count + _OVERHEAD - _BARE_SIP - SIP["SONAR_BYTES"] * held[_SONAR_COUNT_AT]
            return not 0 <= tail <= _SIP_TAIL_MAX
        limit = _CONFIG_COUNT_MAX if kind == TYPE["CONFIGPAC"] else _OTHER_COUNT_MAX
        return self._broken_off or count > limit

    def _find_inside(self) -> int:
        """Return where a whole, good packet starts inside the first one, or 0."""
        held = self._held
        start = held.find(_HEADER, 1)
        while 0 < start <= len(held) - _PACKET_MIN:
            count = held[start + 2]
            end = start + count + _OVERHEAD
            if count >= _COUNT_MIN and end <= len(held) and self._checksum_holds(start, end):
                return start
            start = held.find(_HEADER, start + 1)
        return 0

    def _is_overdue(self, now_ms: float) -> bool:
        count = self._held[2] if len(self._held) >= 3 else 0
        wire_ms = count * TIMING["BITS_PER_BYTE"] * 1000 // BAUD["B9600"]
        return now_ms - self._last_byte_ms >= _QUIET_MS and now_ms - self._since_ms > wire_ms + _EXTRA_MS
