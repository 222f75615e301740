# SPDX-License-Identifier: MIT
"""One rising time of what a log's clock gave: every reader's times pass here, and each correction is reported."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from decimal import Decimal
from itertools import chain, groupby, pairwise
from math import gcd
from statistics import median
from typing import Any, Final, Generic, NamedTuple, Self, TypeVar

from argus_tools.chunks import Chunk, Damage, DamageList

DISORDER_S: Final = 1.0
"""Two directions or two threads of a recorder may be out of order by so much; a greater fall is a clock set back."""
STEP_S: Final = 0.1
"""What a clock that was set is taken to have passed meanwhile: a SIP cycle."""
BOOT_MAX_S: Final = 1e8
EPOCH_MIN_S: Final = 1e9
DAY_S: Final = 86400.0
YEAR_S: Final = 365 * DAY_S
LEAP_YEAR_S: Final = 366 * DAY_S
NEAR: Final = ((DAY_S, 3600.0), (YEAR_S, DAY_S), (LEAP_YEAR_S, DAY_S))
"""A period of a clock, and how near its end and its beginning a fall is one of a clock that nobody said to be such.

Times below BOOT_MAX_S are since a start, above EPOCH_MIN_S since 1970: one clock gives no log both.
"""
STANDS_CHUNKS: Final = 20
STANDS_BYTES: Final = 4096
"""More chunks and bytes of one time than a late reader finds waiting at a serial port: a clock that stands."""
ALL_BYTES: Final = 1000
"""So much takes longer than a second at the slowest rate: a whole log of it has not one time."""
SECONDS_SEEN: Final = 3
"""So many seconds that are over tell whether a clock has whole seconds only."""
SECOND_MOST: Final = 400
"""More chunks than the fastest link carries in that time are not waited for."""
STEP_MOST_S: Final = 10
STEP_LEAST: Final = 5
"""A clock of steps of several seconds has so many chunks a second in most of them; a link that pauses has fewer."""


Body = TypeVar("Body")


class Item(NamedTuple, Generic[Body]):
    """What has a time and is no chunk; `data` is as long as what a link would have carried for it."""

    t: float | None
    data: bytes
    place: str
    body: Body


Timed = TypeVar("Timed", Chunk, Item[Any])


class Wrapping(float):
    """A time of a clock that begins anew each `period_s`, as one of the day does that has no date."""

    period_s: float

    def __new__(cls, t: float, period_s: float) -> Self:
        """Return the time; it is a float to all but the timeline."""
        made = super().__new__(cls, t)
        made.period_s = period_s
        return made


class Stepped(float):
    """A time of a clock that was set just before: `passed_s` is what passed since the last, as another clock has it."""

    passed_s: float

    def __new__(cls, t: float, passed_s: float) -> Self:
        """Return the time; it is a float to all but the timeline."""
        made = super().__new__(cls, t)
        made.passed_s = passed_s
        return made


def nanoseconds(t: float) -> int:
    """Return a time in nanoseconds as its digits say it; a float of today has a quarter of a microsecond only.

    >>> nanoseconds(1795590184.251103)
    1795590184251103000
    """
    return max(0, round(Decimal(repr(float(t))).scaleb(9)))


class Timeline(Generic[Timed]):
    """Iterates chunks, or items, with their times made rising; what had to be corrected is appended to `damage`.

    Small disorder (DISORDER_S) is left as it is. A clock of the day goes on over midnight, one without a year over
    New Year. One that falls goes on from where it was, and so does one that is set ahead: from a time since boot to
    one since 1970, or as a `Stepped` time says. Negative times are shifted to begin at 0. Of whole seconds only, the
    chunks of one second are spread evenly over it. Where the clock stands the chunks have no time, as those of a log
    that keeps none, but for the first.

    A log that is followed is not held up for that: its first whole seconds stay, and each later one is spread by how
    many chunks the one before it had.

    chunks: a reader, whose attribute `place`, where it has one, says where in the file the chunk just given ends.
    most: chunks that may come in a second; more are not waited for.
    """

    def __init__(
        self, chunks: Iterable[Timed], damage: DamageList, is_followed: bool = False, most: int = SECOND_MOST
    ) -> None:
        self._chunks: Iterable[Timed] = chunks
        self._is_followed = is_followed
        self._damage = damage
        self._most = most
        self._add_s = 0.0
        self._before_s: float | None = None
        self._raw = 0.0
        self._last: float | None = None
        self._stands_at: float | None = None
        self._told_at: float | None = None

    def __iter__(self) -> Iterator[Timed]:
        return self._moving(
            self._paced(self._rising()) if self._is_followed else self._spread(self._rising())
        )

    def _rising(self) -> Iterator[Timed]:
        for chunk in self._chunks:
            t = chunk.t
            if t is None:
                yield chunk
                continue
            last = self._last
            if type(t) is float and last is not None and last <= t <= last + DISORDER_S and self._is_plain:
                self._raw = self._last = t
                yield chunk
                continue
            if last is None:
                if t < 0:
                    self._add_s = -t
                    self._report(chunk, f"times begin at {t:.6f} s; they are counted from there")
            else:
                self._follow(chunk, t, last)
            self._raw = float(t)
            if self._add_s or type(t) is not float:
                t = round(float(t) + self._add_s, 9)
                chunk = chunk._replace(t=t)
            self._last = t if last is None else max(last, t)
            yield chunk

    @property
    def _is_plain(self) -> bool:
        """Whether times are taken as they are, and no midnight has just passed."""
        return not self._add_s and self._before_s is None

    def _follow(self, chunk: Timed, t: float, last: float) -> None:
        """Change what is added to the times where the clock stepped between `last`, as corrected, and `t`."""
        now = t + self._add_s
        before_s = self._before_s
        if before_s is not None:
            if abs(t + before_s - last) < DISORDER_S < abs(now - last):
                # Of two directions one is still, or is already, on the other side of midnight.
                self._add_s, self._before_s = before_s, self._add_s
                return
            if now > last + DISORDER_S:
                self._before_s = None
        if now < last - DISORDER_S:
            if period_s := _period(t, self._raw):
                self._before_s, self._add_s = self._add_s, self._add_s + period_s
                return
            self._add_s = last + _passed_s(t) - t
            self._report(chunk, f"the clock falls by {last - now:.3f} s; times go on from before")
        elif isinstance(t, Stepped) or (last < BOOT_MAX_S and now > EPOCH_MIN_S):
            self._add_s = last + _passed_s(t) - t
            self._report(chunk, f"the clock is set {now - last:.0f} s ahead; times go on from before")

    def _report(self, chunk: Timed, what: str) -> None:
        if isinstance(chunk, Item):
            place = chunk.place
        else:
            place = getattr(self._chunks, "place", "") or f"byte {chunk.offset} of {chunk.dir}"
        self._damage.correct(Damage(place, what))

    def _report_coarse(self, step_s: int = 1) -> None:
        steps = "whole seconds" if step_s == 1 else f"steps of {step_s} s"
        what = f"gives {steps}; what lies within one is spread evenly over it"
        self._damage.correct(Damage("its clock", what))

    def _stand(self, t: float | None) -> None:
        self._stands_at = t
        self._report_standing(t)

    def _report_standing(self, t: float | None) -> None:
        if t != self._told_at:
            self._told_at = t
            what = f"stands at {t}: when that came which has this time is not known"
            self._damage.correct(Damage("its clock", what))

    def _moving(self, chunks: Iterator[Timed]) -> Iterator[Timed]:
        """Take the time from what comes while the clock stands, but for the first: when it came is not known.

        What may be such is held until that is clear, unless the log is followed.
        """
        held: list[Timed] = []
        last: float | None = None
        count = size = 0
        for chunk in chunks:
            t = chunk.t
            if t is None or t != last:
                yield from held
                held = []
            if t is None:
                yield chunk
                continue
            if t == self._stands_at:
                yield chunk._replace(t=None)
                continue
            if t != last:
                last, count, size = t, 0, 0
            count += 1
            size += len(chunk.data)
            held.append(chunk)
            if count > STANDS_CHUNKS and size > STANDS_BYTES:
                self._stand(t)
                yield from (one._replace(t=None) for one in held)
                held = []
            elif count == 1 or self._is_followed or len(held) == self._most:
                yield from held
                held = []
        yield from held

    def _paced(self, chunks: Iterator[Timed]) -> Iterator[Timed]:
        """Spread whole seconds without a look ahead."""
        last: float | None = None
        seconds = size = before = 0
        for chunk in chunks:
            t = chunk.t
            if t is None or t != int(t):
                yield chunk
                break
            if t != last:
                last, before, size, seconds = t, size, 0, seconds + 1
                if seconds == SECONDS_SEEN + 1 and before > 1:
                    self._report_coarse()
            if seconds > SECONDS_SEEN and before > 1:
                chunk = chunk._replace(t=round(t + min(size / before, 0.999), 6))
            size += 1
            yield chunk
        yield from chunks

    def _spread(self, chunks: Iterator[Timed]) -> Iterator[Timed]:
        head: list[Timed] = []
        step_s: int | None = None
        for chunk in chunks:
            head.append(chunk)
            if (step_s := _step_s(head, self._most)) is not None:
                break
        else:
            if len(head) > STANDS_CHUNKS and head[0].t == head[-1].t and _bytes(head) > ALL_BYTES:
                self._stand(head[0].t)
        if not step_s:
            yield from head
            yield from chunks
            return
        self._report_coarse(step_s)
        held: list[Timed] = []
        usual, stands = _usual(head), False
        for chunk in chain(head, chunks):
            if held and chunk.t != held[0].t:
                missing = max(0, usual - len(held)) if held[0] is head[0] else 0
                yield from held[1:] if stands else _evenly(held, step_s, missing)
                held, stands = [], False
            if stands:
                yield chunk
                continue
            held.append(chunk)
            if len(held) > self._most * step_s:
                # More than a link carries: a clock that stands, of whose entries none is held.
                self._report_standing(chunk.t)
                yield from held
                held, stands = held[:1], True
        yield from held[1:] if stands else _evenly(held, step_s, 0, max(0, usual - len(held)))


def _passed_s(t: float) -> float:
    """Return what passed between two times between which the clock was set, the later one given."""
    return t.passed_s if isinstance(t, Stepped) else STEP_S


def _period(t: float, raw: float) -> float | None:
    """Return the period of a clock that began anew between two of its times, the later one first; None if none did.

    One that is known for a clock of a period fell by more than half of it. Of another both are near its ends.
    """
    if isinstance(t, Wrapping):
        return t.period_s if raw - t > t.period_s / 2 else None
    return next(
        (
            period
            for period, near in NEAR
            if 0 <= t < near and 0 <= period - raw <= near and period - raw + t < near
        ),
        None,
    )


def _step_s(head: Sequence[Timed], most: int) -> int | None:
    """Return the whole seconds by which a clock steps, by a log's beginning; 0: it is finer; None: not known yet.

    It passes on by these, with several chunks in most of those that are over; the first may be cut.
    """
    last, first = head[-1].t, head[0].t
    if last is None or first is None or len(head) > most * STEP_MOST_S:
        return 0
    if last == first:
        return 0 if len(head) > most and _bytes(head) > STANDS_BYTES else None
    if last != int(last):
        return 0
    if last == head[-2].t:
        return None
    seconds = [(t, len(list(second))) for t, second in groupby(head, key=lambda chunk: chunk.t)]
    if len(seconds) <= SECONDS_SEEN:
        return None
    over = [size for _, size in seconds[1:-1]]
    step_s = gcd(*(int(after - before) for (before, _), (after, _) in pairwise(seconds) if before and after))
    if 1 < step_s <= STEP_MOST_S and median(over) >= STEP_LEAST * step_s:
        return step_s
    return int(2 * sum(size > 1 for size in over) > len(over))


def _bytes(chunks: Sequence[Timed]) -> int:
    return sum(len(chunk.data) for chunk in chunks)


def _usual(head: Sequence[Timed]) -> int:
    """Return how many chunks a whole step has, by a log's beginning."""
    steps = [len(list(step)) for _, step in groupby(head, key=lambda chunk: chunk.t)]
    return round(median(steps[1:-1]))


def _evenly(second: Sequence[Timed], step_s: int, before: int = 0, behind: int = 0) -> Iterator[Timed]:
    """Yield chunks of one second, or of one step of a coarser clock, spread over it.

    before, behind: so many more it would have, had the log begun earlier, or ended later.
    """
    size = before + len(second) + behind
    for number, chunk in enumerate(second, before):
        t = chunk.t
        yield chunk if t is None else chunk._replace(t=round(t + step_s * number / size, 6))
