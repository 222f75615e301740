# SPDX-License-Identifier: MIT
"""The one time of a ring of topics: that of most of them. What is stamped by another clock is held, then discarded."""

from __future__ import annotations

import math
from typing import Any, Final

from argus_tools.rings.intake import ORDER_S, Odd

_LIVE_S: Final = 2.0
_CLOUD_S: Final = 0.1
_EARLY_S: Final = _CLOUD_S / 2

Taken = tuple[str, float, Any]
"""Topic, stamp, message."""


class Timeline:
    """Puts messages of many topics on one time.

    A topic whose stamps are more than ORDER_S away from the others' is on another clock. When more topics are on that
    clock than on the present one, it is the clock: a bag was played again, or the driver started anew.
    """

    def __init__(self) -> None:
        self.now_s = -math.inf
        self.jumps = 0
        self._last: dict[str, tuple[float, float]] = {}
        self._held: dict[str, tuple[float, float, Any]] = {}

    def take(self, topic: str, at_s: float, message: Any, steady_s: float) -> list[Taken]:
        """Return the messages that may be used now, in order; `steady_s`: time by a clock that never jumps."""
        if self.now_s == -math.inf or abs(at_s - self.now_s) <= ORDER_S:
            return self._in_time(topic, at_s, message, steady_s)
        is_second = topic in self._held
        self._held[topic] = (at_s, steady_s, message)
        if taken := self._vote(at_s, steady_s):
            return taken
        if is_second:
            raise Odd("stamp is of another clock than the other topics have")
        return []

    def _in_time(self, topic: str, at_s: float, message: Any, steady_s: float) -> list[Taken]:
        last_s = self._last.get(topic, (-math.inf, 0.0))[0]
        self._held.pop(topic, None)
        if at_s == last_s:
            return []  # the same reading again
        if last_s - ORDER_S < at_s < last_s:
            raise Odd("stamp is older than the last")
        self._last[topic] = (at_s, steady_s)
        self.now_s = max(self.now_s, at_s)
        return [(topic, at_s, message)]

    def _vote(self, at_s: float, steady_s: float) -> list[Taken]:
        """Return what was held, if most topics are on its clock now."""
        held = {
            topic: one
            for topic, one in self._held.items()
            if abs(one[0] - at_s) <= ORDER_S and steady_s - one[1] <= _LIVE_S
        }
        present = [
            topic
            for topic, (last_s, heard_s) in self._last.items()
            if topic not in held and abs(self.now_s - last_s) <= ORDER_S and steady_s - heard_s <= _LIVE_S
        ]
        if len(held) <= len(present):
            return []
        self.jumps += 1
        self.now_s = max(one[0] for one in held.values())
        for topic, (one_s, heard_s, _) in held.items():
            self._last[topic] = (one_s, heard_s)
            del self._held[topic]
        return sorted(
            ((topic, one_s, message) for topic, (one_s, _, message) in held.items()), key=lambda one: one[1]
        )


class Pace:
    """When a cloud is due: ten times a second, and with each packet of a driver that sends nearly so often."""

    def __init__(self) -> None:
        self._due_s = -math.inf

    def is_due(self, at_s: float) -> bool:
        """Whether one is due at a time; it is then taken as published. A jump of the clock begins anew."""
        if self._due_s - _CLOUD_S - ORDER_S < at_s < self._due_s:
            return False
        ahead_s = at_s - self._due_s
        # Due half a period before the packet, so that packets may come somewhat early or late.
        self._due_s = self._due_s + _CLOUD_S if 0 <= ahead_s < _CLOUD_S else at_s + _EARLY_S
        return True
