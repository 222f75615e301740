# SPDX-License-Identifier: MIT
"""One rising time of what a log's clock gave: every reader's times pass here, and each correction is reported."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain, groupby
from typing import Final

from argus_tools.chunks import Chunk, Damage, DamageList

DISORDER_S: Final = 1.0
"""Two directions or two threads of a recorder may be out of order by so much; a greater fall is a clock set back."""
STEP_S: Final = 0.1
"""What a clock that was set is taken to have passed meanwhile: a SIP cycle."""
BOOT_MAX_S: Final = 1e8
EPOCH_MIN_S: Final = 1e9
DAY_S: Final = 86400.0
NEAR_MIDNIGHT_S: Final = 3600.0
"""Times below BOOT_MAX_S are since a start, above EPOCH_MIN_S since 1970: one clock gives no log both."""
SECONDS_SEEN: Final = 3
"""So many seconds that are over tell whether a clock has whole seconds only."""
SECOND_MOST: Final = 400
"""More chunks than the fastest link carries in that time are not waited for."""


class Timeline:
    """Iterates chunks with their times made rising; what had to be corrected is appended to `damage`.

    Small disorder (DISORDER_S) is left as it is. A clock of the day goes on over midnight. One that falls, or is set
    from a time since boot to one since 1970, goes on from where it was. Negative times are shifted to begin at 0. Of
    whole seconds only, the chunks of one second are spread evenly over it.

    A log that is followed is not held up for that: its whole seconds stay.

    chunks: a reader, whose attribute `place`, where it has one, says where in the file the chunk just given ends.
    """

    def __init__(self, chunks: Iterable[Chunk], damage: DamageList, is_followed: bool = False) -> None:
        self._chunks = chunks
        self._is_followed = is_followed
        self._damage = damage
        self._add_s = 0.0
        self._last: float | None = None

    def __iter__(self) -> Iterator[Chunk]:
        return self._rising() if self._is_followed else self._spread(self._rising())

    def _rising(self) -> Iterator[Chunk]:
        for chunk in self._chunks:
            t = chunk.t
            if t is None:
                yield chunk
                continue
            last = self._last
            if last is None:
                if t < 0:
                    self._add_s = -t
                    self._report(chunk, f"times begin at {t:.6f} s; they are counted from there")
            else:
                self._follow(chunk, t, last)
            if self._add_s:
                t = round(t + self._add_s, 9)
                chunk = chunk._replace(t=t)
            self._last = t if last is None else max(last, t)
            yield chunk

    def _follow(self, chunk: Chunk, t: float, last: float) -> None:
        """Change what is added to the times where the clock stepped between `last`, as corrected, and `t`."""
        now = t + self._add_s
        if now < last - DISORDER_S:
            midnight = self._add_s + DAY_S
            if 0 <= t < NEAR_MIDNIGHT_S and 0 <= t + midnight - last < NEAR_MIDNIGHT_S:
                self._add_s = midnight
                return
            self._add_s = last + STEP_S - t
            self._report(chunk, f"the clock falls by {last - now:.3f} s; times go on from before")
        elif last < BOOT_MAX_S and now > EPOCH_MIN_S:
            self._add_s = last + STEP_S - t
            self._report(chunk, f"the clock is set {now - last:.0f} s ahead; times go on from before")

    def _report(self, chunk: Chunk, what: str) -> None:
        place = getattr(self._chunks, "place", "") or f"byte {chunk.offset} of {chunk.dir}"
        self._damage.correct(Damage(place, what))

    def _spread(self, chunks: Iterator[Chunk]) -> Iterator[Chunk]:
        head: list[Chunk] = []
        coarse: bool | None = None
        for chunk in chunks:
            head.append(chunk)
            if (coarse := _is_coarse(head)) is not None:
                break
        if not coarse:
            yield from head
            yield from chunks
            return
        what = "gives whole seconds; what lies within one is spread evenly over it"
        self._damage.correct(Damage("its clock", what))
        for _, second in groupby(chain(head, chunks), key=lambda chunk: chunk.t):
            yield from _evenly(list(second))


def _is_coarse(head: list[Chunk]) -> bool | None:
    """Whether a clock gives whole seconds only, seen from a log's beginning; None while it may yet.

    It passes on by whole seconds, with several chunks in each of those that are over.
    """
    last = head[-1].t
    if last is None or last != int(last) or len(head) > SECOND_MOST:
        return False
    if last == head[0].t:
        return None
    sizes = [len(list(second)) for _, second in groupby(head, key=lambda chunk: chunk.t)]
    if len(sizes) <= SECONDS_SEEN:
        return None
    return all(size > 1 for size in sizes[:-1])


def _evenly(second: list[Chunk]) -> Iterator[Chunk]:
    """Yield chunks of one second, spread over it."""
    for number, chunk in enumerate(second):
        t = chunk.t
        yield chunk if t is None else chunk._replace(t=round(t + number / len(second), 6))
