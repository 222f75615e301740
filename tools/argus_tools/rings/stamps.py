# SPDX-License-Identifier: MIT
"""Stamps in the headers of recorded messages: they discard repeats, never date. The recorder's clock dates."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, Final

import numpy as np

from argus_tools.rings.intake import ORDER_S, Odd, stamp_of
from argus_tools.rings.recording import Message

APART_MOST_S: Final = 1.0
RATE_MOST: Final = 0.1
"""A clock of stamps that is faster or slower than the recorder's by more is another time, as a simulation's."""
RATE_SPAN_S: Final = 5.0
STILL_S: Final = 0.25
STILL_SEEN: Final = 3
"""So many messages in a row without a newer stamp, over so long, are no repeats and not late: the clock stands."""
_UNSEEN: Final = -math.inf


@dataclass
class _Seen:
    """The stamps of one topic and frame."""

    stamp_s: float = _UNSEEN
    t: float = _UNSEEN
    """When, by the recorder's clock, a stamp was last newer."""
    last_t: float = _UNSEEN
    body: Any = None
    held: int = 0
    """Messages in a row since then."""

    @property
    def is_standing(self) -> bool:
        """Whether a clock that stands, or falls, explains what came since."""
        return self.held >= STILL_SEEN and self.last_t - self.t > STILL_S

    def take(self, stamp_s: float, message: Message) -> bool:
        """Take a stamp; whether it is newer, or of another clock."""
        self.last_t = message.t
        if self.stamp_s - ORDER_S < stamp_s <= self.stamp_s:
            self.held += 1
            return False
        self.stamp_s, self.t, self.body, self.held = stamp_s, message.t, message.body, 0
        return True


@dataclass
class _Clock:
    """What is to be told of one topic's stamps."""

    apart_s: float
    first: tuple[float, float]
    last: tuple[float, float]
    still: int = 0
    jumps: int = 0
    jump_s: float = 0.0
    jump_t: float = 0.0

    def note(self, jump_s: float, t: float) -> None:
        """Note how much more than the recorder's clock a stamp went on."""
        if abs(jump_s) > APART_MOST_S:
            self.jumps += 1
            if abs(jump_s) > abs(self.jump_s):
                self.jump_s, self.jump_t = jump_s, t


class Newer:
    """Discards repeats and what is older than the last of its topic; tells of stamps that bear out neither."""

    def __init__(self, first: Iterable[Message] = ()) -> None:
        """first: messages from the beginning, which are taken later, too; they show which stamps stand still."""
        self._seen: dict[tuple[str, str], _Seen] = {}
        self._never = _standing(first)
        self._clocks: dict[str, _Clock] = {}
        self._without: dict[str, int] = {}

    def check(self, message: Message) -> None:
        """Take a message with a header; Odd for a repeat or an older one."""
        try:
            stamp_s = stamp_of(message.body.header)
        except Odd:
            stamp_s = None
        if stamp_s is None:
            self._without[message.topic] = self._without.get(message.topic, 0) + 1
            return
        now = (message.t, stamp_s)
        clock = self._clocks.setdefault(message.topic, _Clock(stamp_s - message.t, now, now))
        key = _key(message)
        seen = self._seen.setdefault(key, _Seen())
        before_s, before_t, stood = seen.stamp_s, seen.t, seen.is_standing
        if not seen.take(stamp_s, message):
            if key not in self._never and not _is_new(seen, stamp_s, message):
                raise Odd("stamp is not newer than the last")
            clock.still += 1
            seen.body = message.body
            return
        clock.last = now
        if before_s != _UNSEEN and not stood:
            clock.note(stamp_s - before_s - (message.t - before_t), message.t)

    def words(self) -> Iterator[str]:
        """Yield what is to be told of stamps that are not used."""
        for topic, count in self._without.items():
            yield f"{count} stamps of {topic} are zero or no time; the recorder's clock is used"
        for topic, clock in self._clocks.items():
            yield from (f"{what}; the recorder's clock is used" for what in _words(topic, clock))


def _key(message: Message) -> tuple[str, str]:
    return message.topic, getattr(message.body.header, "frame_id", "")


def _standing(messages: Iterable[Message]) -> frozenset[tuple[str, str]]:
    """Return the topics and frames whose stamps stand still, or fall."""
    newest: dict[tuple[str, str], _Seen] = {}
    found: set[tuple[str, str]] = set()
    for message in messages:
        with suppress(Odd):
            stamp_s = stamp_of(message.body.header)
            if stamp_s is not None:
                seen = newest.setdefault(_key(message), _Seen())
                seen.take(stamp_s, message)
                if seen.is_standing:
                    found.add(_key(message))
    return frozenset(found)


def _words(topic: str, clock: _Clock) -> Iterator[str]:
    if clock.still:
        yield f"stamps of {topic} stand still or fall in {clock.still} messages"
    if clock.jumps:
        side = "ahead" if clock.jump_s > 0 else "back"
        times = "" if clock.jumps == 1 else f", at most (of {clock.jumps} jumps)"
        yield f"stamps of {topic} jump {abs(clock.jump_s):,.1f} s {side} at {clock.jump_t:.3f} s{times}"
    if abs(clock.apart_s) > APART_MOST_S:
        side = "ahead of" if clock.apart_s > 0 else "behind"
        yield f"stamps of {topic} are {abs(clock.apart_s):,.1f} s {side} the recorder's clock"
    passed_s = clock.last[0] - clock.first[0]
    if passed_s >= RATE_SPAN_S and not clock.still and not clock.jumps:
        rate = (clock.last[1] - clock.first[1]) / passed_s
        if abs(rate - 1) > RATE_MOST:
            yield f"stamps of {topic} run at {rate:.2f} times the speed of the recorder's clock"


def _is_new(seen: _Seen, stamp_s: float, message: Message) -> bool:
    """Whether a message without a newer stamp is new all the same."""
    return seen.is_standing or (stamp_s == seen.stamp_s and not _is_same(seen.body, message.body))


def _is_same(one: Any, other: Any) -> bool:
    """Whether two bodies of one type hold the same, but for their headers."""
    if hasattr(one, "__dataclass_fields__") or isinstance(one, SimpleNamespace):
        mine, others = vars(one), vars(other)
        return mine.keys() == others.keys() and all(
            name == "header" or _is_same(value, others[name]) for name, value in mine.items()
        )
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(_is_same, one, other))
    if isinstance(one, np.ndarray):
        numbers = one.dtype.kind == "f"
        return bool(np.array_equal(one, other, equal_nan=numbers))
    return bool(one == other or (one != one and other != other))
