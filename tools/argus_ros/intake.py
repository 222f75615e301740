# SPDX-License-Identifier: MIT
"""The one place that judges what other nodes send: finite, in range, newer. What is odd is discarded and counted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import Any, Final

from argus_tools.rings.intake import Odd


class Intake:
    """Hands on what holds, and counts what was discarded by topic and reason. `told` hears of each new pair."""

    def __init__(self, told: Callable[[str, str], None]) -> None:
        self._told = told
        self.counts: dict[str, Counter[str]] = {}
        self.last: dict[str, str] = {}
        """By topic: why its last message was discarded; a topic whose last message held is not here."""

    def taker(self, topic: str, take: Callable[[Any], None]) -> Callable[[Any], None]:
        """Return what a subscription calls: no message raises there."""

        def judged(message: Any) -> None:
            try:
                take(message)
            except Odd as error:
                self.discard(topic, str(error))
            except (ArithmeticError, ValueError, LookupError, TypeError, AttributeError) as error:
                self.discard(topic, f"{UNFORESEEN}: {type(error).__name__}: {error}")
            else:
                self.last.pop(topic, None)

        return judged

    def discard(self, topic: str, why: str) -> None:
        """Count a message that is not used."""
        counts = self.counts.setdefault(topic, Counter())
        is_new = why not in counts and len(counts) < _REASONS_MAX
        counts[why if is_new or why in counts else _OTHER] += 1
        self.last[topic] = why
        if is_new:
            self._told(topic, why)

    def discarded(self, topic: str | None = None) -> int:
        """Return how many messages were discarded, of one topic or of all."""
        chosen = self.counts.values() if topic is None else [self.counts.get(topic, Counter())]
        return sum(sum(counts.values()) for counts in chosen)


UNFORESEEN: Final = "not foreseen"
_REASONS_MAX: Final = 16
_OTHER: Final = "other"
