# SPDX-License-Identifier: MIT
"""What stands for "no echo" in ranges of unknown origin: found from the data, and reported."""

from __future__ import annotations

import math
from collections import Counter
from typing import Final

_MM: Final = 1000
NEAR: Final = 0.98
"""So near below the greatest range a value that comes again and again stands for no echo: 4999."""
AGAIN_LEAST: Final = 3
ALONE_LEAST: Final = 20
"""So often a value comes of several sonars, or of one alone."""
ABOVE_MOST: Final = 0.1
"""Echoes beyond it, as a share of these."""


class Silence:
    """Learns from readings (`note`, then `settle`) and turns each into millimetres; None is no reading.

    no_echo_mm: what the fault manager takes for no echo. greatest_m: the limit that the messages declare, if they do.
    """

    def __init__(self, no_echo_mm: int, least_mm: int, greatest_m: float | None = None) -> None:
        self._no_echo_mm, self._least_mm = no_echo_mm, least_mm
        self._from_mm: float = no_echo_mm
        if greatest_m is not None and 0 < greatest_m * _MM < no_echo_mm:
            self._from_mm = greatest_m * _MM - 0.5
        self._far: Counter[int] = Counter()
        self._of: dict[int, set[int]] = {}
        self._readings = self._infinite = self._missing = 0
        self._zeros = 0
        self._is_zero = self._is_missing = False

    def note(self, sonar: int, range_m: float) -> None:
        """Take a reading to learn from."""
        self._readings += 1
        if math.isnan(range_m):
            self._missing += 1
        elif math.isinf(range_m):
            self._infinite += range_m > 0
        elif range_m <= 0:
            self._zeros += 1
        elif range_m * _MM >= NEAR * self._from_mm:
            mm = round(range_m * _MM)
            self._far[mm] += 1
            self._of.setdefault(mm, set()).add(sonar)

    def settle(self) -> str:
        """Decide; return what was found, in words."""
        told = []
        if self._far:
            common = max(self._far, key=lambda mm: self._far[mm])
            times, above = self._far[common], sum(n for mm, n in self._far.items() if mm > common)
            is_again = times >= (AGAIN_LEAST if len(self._of[common]) > 1 else ALONE_LEAST)
            if is_again and above <= ABOVE_MOST * times:
                self._from_mm = min(self._from_mm, common - 0.5)
            count = sum(n for mm, n in self._far.items() if mm >= self._from_mm)
            if count >= AGAIN_LEAST:
                told.append(self._words(f"{common / _MM:.3f} m", count))
        if self._infinite:
            told.append(self._words("inf", self._infinite))
        if not told and self._zeros:
            self._is_zero = True
            told.append(self._words("0", self._zeros))
        if not told and self._missing:
            self._is_missing = True
            told.append(self._words("NaN", self._missing))
        return f"no echo is {' and '.join(told)}" if told else "no reading is without an echo"

    def _words(self, what: str, count: int) -> str:
        return f"{what} ({100 * count / self._readings:.0f} % of the readings)"

    def millimetres(self, range_m: float) -> int | None:
        """Return a reading as the fault manager takes it, rounded."""
        if math.isnan(range_m):
            return self._no_echo_mm if self._is_missing else None
        if range_m == math.inf or range_m * _MM >= self._from_mm:
            return self._no_echo_mm
        if range_m == -math.inf:
            return self._least_mm
        if range_m <= 0:
            return self._no_echo_mm if self._is_zero else 0
        return min(round(range_m * _MM), self._no_echo_mm - 1)
