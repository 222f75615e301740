# SPDX-License-Identifier: MIT
"""Many packets at a time by numpy: which bytes are whole packets, and SIPs as lines of JSON."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from hil_sim.arcos import FRAME, SIP

_HEADER0: Final = FRAME["HEADER0"]
_HEADER1: Final = FRAME["HEADER1"]
_OVERHEAD: Final = FRAME["OVERHEAD"]
_COUNT_MIN: Final = FRAME["COUNT_MIN"]
_SHORTEST: Final = _OVERHEAD + _COUNT_MIN
# Data bytes of a SIP before its readings, and those of them that seldom change.
SIP_HEAD: Final = SIP["OFFSET_SONAR"] - 3
_STATE_BYTES: Final = (0, *range(11, SIP_HEAD - 1))

Array = NDArray[Any]


def leading_packets(buffer: bytes) -> tuple[list[int], int]:
    """Return where the packets begin that follow each other from the first byte on, and where they end.

    >>> leading_packets(bytes.fromhex("fafb03010001fafb03000000fafb03020003"))
    ([0, 6], 12)
    """
    starts: list[int] = []
    at, last = 0, len(buffer) - _SHORTEST
    while at <= last:
        starts.append(at)
        at += buffer[at + 2] + _OVERHEAD
    if not starts:
        return starts, 0
    if at > len(buffer):
        at = starts.pop()
    whole = np.frombuffer(buffer, np.uint8)
    good = _are_packets(whole, np.array(starts, np.intp))
    if good.all():
        return starts, at
    first_bad = int(good.argmin())
    return starts[:first_bad], starts[first_bad]


def _are_packets(data: Array, starts: Array) -> Array:
    """Return for each place whether a packet is there; as long as its COUNT says there are bytes."""
    # Sums, modulo 65536, of the big-endian words that begin at even and at odd places.
    sums = np.zeros((2, len(data) // 2 + 1), np.uint16)
    for begin in (0, 1):
        words = data[begin : begin + (len(data) - begin & ~1)].view(">u2")
        np.cumsum(words, out=sums[begin, 1 : len(words) + 1], dtype=np.uint16)
    counts = data[starts + 2].astype(np.intp)
    first = starts + 3
    parity, word = first & 1, first >> 1
    total = sums[parity, word + np.maximum(counts - 2 >> 1, 0)] - sums[parity, word]
    sent_at = first + np.maximum(counts - 2, 0)
    total ^= np.where(counts & 1, data[sent_at - 1], 0).astype(np.uint16)
    sent = data[sent_at].astype(np.uint16) << 8 | data[sent_at + 1]
    is_header = (data[starts] == _HEADER0) & (data[starts + 1] == _HEADER1) & (counts >= _COUNT_MIN)
    found: Array = is_header & (total == sent)
    return found


def _table(texts: Iterable[str]) -> Array:
    return np.array(list(texts), object)


@cache
def heading_texts() -> Array:
    """Return the headings in degrees by number, as text."""
    turn = SIP["TURN"]
    return _table(repr((n if n <= turn // 2 else n - turn) * 360 / turn) for n in range(turn))


@cache
def unsigned_texts() -> Array:
    """Return the numbers of 16 bits as text."""
    return _table(map(str, range(1 << 16)))


@cache
def signed_texts() -> Array:
    """Return the numbers of 16 bits, in two's complement, as text."""
    half = 1 << 15
    return np.concatenate([unsigned_texts()[:half], _table(map(str, range(-half, 0)))])


@cache
def key_texts() -> Array:
    """Return the keys of an object by sonar number."""
    return _table(f', "{number}": ' for number in range(256))


@cache
def first_key_texts() -> Array:
    """Return the keys that an object may begin with."""
    return _table(f'"{number}": ' for number in range(256))


class Sips:
    """The data of several SIPs as columns."""

    def __init__(self, data: list[bytes]) -> None:
        self.buffer = np.frombuffer(b"".join(data), np.uint8)
        self.sizes = np.fromiter(map(len, data), np.intp, len(data))
        self.begins = np.cumsum(self.sizes) - self.sizes
        self.head = self.buffer[self.begins[:, None] + np.arange(SIP_HEAD)]
        words: Array = np.ascontiguousarray(self.head[:, 1:11]).view("<u2")
        self.x, self.y, self.th = words[:, 0], words[:, 1], words[:, 2]
        self._texts = heading_texts()[self.th & (SIP["TURN"] - 1)], signed_texts()[words[:, 3:5]]

    def kinds(self) -> Iterator[tuple[Array, int, int]]:
        """Yield the SIPs of one length and number of readings: which they are, length, number."""
        both = self.sizes << 8 | self.head[:, SIP_HEAD - 1]
        for kind in np.unique(both).tolist():
            yield np.flatnonzero(both == kind), kind >> 8, kind & 0xFF

    def layouts(self, chosen: Array, count: int) -> dict[bytes, int]:
        """Return the lists of sonar numbers that occur, each with the last SIP that has it."""
        numbers = self._numbers(chosen, count).tobytes()
        return {numbers[count * n : count * n + count]: at for n, at in enumerate(chosen.tolist())}

    def _numbers(self, chosen: Array, count: int) -> Array:
        found: Array = self.buffer[(self.begins[chosen] + SIP_HEAD)[:, None] + 3 * np.arange(count)]
        return found

    def texts(
        self, chosen: Array, count: int, heads: list[str], states: list[str], tails: list[str]
    ) -> Array:
        """Return the lines of JSON in parts; `heads` are of all SIPs, `states` and `tails` of the chosen ones."""
        parts = np.empty((len(chosen), 8 + 2 * count), object)
        headings, velocities = self._texts
        parts[:, 0] = np.array(heads, object)[chosen]
        parts[:, 1] = headings[chosen]
        parts[:, 2] = ', "vel_left_mm_s": '
        parts[:, 3] = velocities[chosen, 0]
        parts[:, 4] = ', "vel_right_mm_s": '
        parts[:, 5] = velocities[chosen, 1]
        parts[:, 6] = states
        at = (self.begins[chosen] + SIP_HEAD)[:, None] + 3 * np.arange(count)
        parts[:, 7:-1:2] = key_texts()[self.buffer[at]]
        if count:
            parts[:, 7] = first_key_texts()[self.buffer[at[:, 0]]]
        parts[:, 8:-1:2] = unsigned_texts()[self.buffer[at + 1] | self.buffer[at + 2].astype(np.uint16) << 8]
        parts[:, -1] = tails
        return parts

    def changes(self, chosen: Array, size: int, count: int) -> list[int]:
        """Return at which of the chosen the state or the tail is another than at the one before."""
        head = self.head[chosen][:, _STATE_BYTES]
        tail_at = SIP_HEAD + 3 * count
        tail = self.buffer[self.begins[chosen][:, None] + np.arange(tail_at, size)]
        changed = (head[1:] != head[:-1]).any(axis=1) | (tail[1:] != tail[:-1]).any(axis=1)
        return [0, *(np.flatnonzero(changed) + 1).tolist(), len(chosen)]


def unwrapped(raw: Array, last: int, span: int) -> list[int]:
    """Return positions that are known modulo `span`, each as near as may be to the one before.

    >>> unwrapped(np.array([10, 120, 5]), 0, 128)
    [10, -8, 5]
    """
    steps: Array = np.diff(raw.astype(np.int64), prepend=last)
    half = span >> 1
    found: list[int] = (last + np.cumsum(((steps + half) % span) - half)).tolist()
    return found
