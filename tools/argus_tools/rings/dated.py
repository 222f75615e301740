# SPDX-License-Identifier: MIT
"""Messages of a recording with their times made rising, where those of every log are."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Iterable, Iterator
from typing import Final

from argus_tools.chunks import DamageList
from argus_tools.rings.intake import Odd, stamp_of
from argus_tools.rings.recording import Message
from argus_tools.timeline import DISORDER_S, STANDS_BYTES, STANDS_CHUNKS, STEP_S, Item, Stepped, Timeline

CYCLE_BYTES: Final = STANDS_BYTES // STANDS_CHUNKS
"""As much counts a cycle of the ring to the timeline, whose messages are of no serial port."""
SECOND_MOST: Final = 4000
"""So many messages a second may come of a ring, its odometry and its transforms."""
LATE_MOST_S: Final = 10.0
"""By more than this no recorder is late: a queue has some hundred messages."""
JITTER_S: Final = 0.05
PEEKED_MOST: Final = 200
"""Among so many messages the next of a topic is looked for."""


class Dated:
    """Iterates messages with their times corrected, and whether the clock stands, where these are a cycle apart.

    A message's stamp does not date it, but shows where the recorder's clock is set: stamps of another clock go on as
    before there. ring: topics whose messages come once a cycle, of which others are told apart by their frame.
    """

    def __init__(self, messages: Iterable[Message], ring: Collection[str], damage: DamageList) -> None:
        self._messages, self._ring, self._damage = iter(messages), frozenset(ring), damage
        self._peeked: deque[Message] = deque()
        self._seen: set[tuple[str, str]] = set()
        self._stamps: dict[str, tuple[float, float]] = {}
        self._last: float | None = None

    def __iter__(self) -> Iterator[tuple[Message, bool]]:
        now = 0.0
        for item in Timeline(self._items(), self._damage, most=SECOND_MOST):
            stands = item.t is None
            if item.t is not None:
                now = item.t
            elif item.data:
                now = round(now + STEP_S, 9)
            yield item.body._replace(t=now), stands

    def _items(self) -> Iterator[Item[Message]]:
        """Yield the messages as they come; the one with which a cycle begins has the cycle's bytes."""
        for message in self._coming():
            passed_s = self._passed_s(message)
            t = message.t if passed_s is None else Stepped(message.t, passed_s)
            size = CYCLE_BYTES + 1 if self._begins(message) else 0
            yield Item(t, bytes(size), f"{message.topic} at {message.t:.3f} s", message)

    def _begins(self, message: Message) -> bool:
        """Whether a cycle begins: a topic and frame come again."""
        if message.topic not in self._ring:
            return False
        key = message.topic, getattr(getattr(message.body, "header", None), "frame_id", "")
        if key in self._seen or not self._seen:
            self._seen = {key}
            return True
        self._seen.add(key)
        return False

    def _passed_s(self, message: Message) -> float | None:
        """Return what passed since the message before, by the stamps of its topic; None: the clock was not set."""
        last, self._last = self._last, message.t
        stamp_s, before = _stamp_of(message), self._stamps.get(message.topic)
        if stamp_s is None:
            return None
        if before is None or message.t != before[0]:
            self._stamps[message.topic] = message.t, stamp_s
        if last is None or before is None or abs(last - before[0]) > DISORDER_S:
            return None
        passed_s = stamp_s - before[1]
        ahead_s = message.t - before[0] - passed_s
        is_ahead = ahead_s > LATE_MOST_S or (ahead_s > DISORDER_S and self._goes_on(message, stamp_s))
        if passed_s > 0 and (is_ahead or message.t < last - DISORDER_S):
            return max(0.0, round(passed_s - (last - before[0]), 6))
        return None

    def _coming(self) -> Iterator[Message]:
        while True:
            if self._peeked:
                yield self._peeked.popleft()
            elif (message := next(self._messages, None)) is not None:
                yield message
            else:
                return

    def _goes_on(self, message: Message, stamp_s: float) -> bool:
        """Whether both clocks go on alike to the next of its topic; those that waited for a recorder come at once."""
        for number in range(PEEKED_MOST):
            if number == len(self._peeked):
                following = next(self._messages, None)
                if following is None:
                    break
                self._peeked.append(following)
            other = self._peeked[number]
            if other.topic == message.topic and (other_s := _stamp_of(other)) is not None:
                passed_s = other_s - stamp_s
                return abs(other.t - message.t - passed_s) < max(passed_s / 2, JITTER_S)
        return False


def _stamp_of(message: Message) -> float | None:
    header = getattr(message.body, "header", None)
    try:
        return stamp_of(header) if header is not None else None
    except Odd:
        return None
