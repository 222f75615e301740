# SPDX-License-Identifier: MIT
"""Confidence bounds of rates and counts, exact, and quantiles; without a statistics package."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from statistics import NormalDist
from typing import Any, Final

CONFIDENCE: Final = 0.95
_ITERATIONS: Final = 300
_TINY: Final = 1e-300


def beta_cdf(x: float, a: float, b: float) -> float:
    """Return the regularised incomplete beta function, the chance that a Beta(a, b) variable is at most `x`."""
    if x <= 0:
        return 0.0
    if x >= 1:
        return 1.0
    log_front = math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b) + a * math.log(x) + b * math.log1p(-x)
    # The fraction converges fast on this side of the mean; the other side is its mirror image.
    if x < (a + 1) / (a + b + 2):
        return math.exp(log_front) * _beta_fraction(x, a, b) / a
    return 1.0 - math.exp(log_front) * _beta_fraction(1 - x, b, a) / b


def _beta_fraction(x: float, a: float, b: float) -> float:
    """The continued fraction of the incomplete beta function by Lentz's method."""
    c, d = 1.0, 1.0 / _away(1 - (a + b) * x / (a + 1))
    result = d
    for m in range(1, _ITERATIONS):
        for numerator in (
            m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
            -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1)),
        ):
            d = 1.0 / _away(1 + numerator * d)
            c = _away(1 + numerator / c)
            result *= c * d
        if abs(c * d - 1) < 1e-14:
            break
    return result


def _away(value: float) -> float:
    return value if abs(value) > _TINY else _TINY


def _solve(rising: Callable[[float], float], target: float, low: float, high: float) -> float:
    """Where a rising function takes a value, by halving."""
    for _ in range(200):
        middle = (low + high) / 2
        if rising(middle) < target:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def share_bound_low(hits: int, total: int, confidence: float = CONFIDENCE) -> float:
    """Return the exact one-sided lower bound (Clopper and Pearson) of a share.

    >>> share_bound_low(299, 299) > 0.99 > share_bound_low(298, 298)
    True
    """
    if hits <= 0 or total <= 0:
        return 0.0
    return _solve(lambda p: beta_cdf(p, hits, total - hits + 1), 1 - confidence, 0.0, 1.0)


def share_interval(hits: int, total: int, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """Return the exact two-sided interval (Clopper and Pearson) of a share; 0 to 1 where nothing was tried."""
    if total <= 0:
        return 0.0, 1.0
    tail = (1 - confidence) / 2
    low = share_bound_low(hits, total, 1 - tail)
    return low, 1 - share_bound_low(total - hits, total, 1 - tail)


def count_bound_high(count: int, confidence: float = CONFIDENCE) -> float:
    """Return the exact one-sided upper bound of the mean of a Poisson count.

    >>> round(count_bound_high(0), 2)
    3.0
    """

    def above(mean: float) -> float:
        term, total = math.exp(-mean), 0.0
        for k in range(count + 1):
            total += term
            term *= mean / (k + 1)
        return 1 - total

    # exp(-mean) is 0 in floating point beyond 745: far up Wilson and Hilferty's approximation is as good as exact.
    if count > 500:
        n = count + 1
        return float(n * (1 - 1 / (9 * n) + NormalDist().inv_cdf(confidence) / (3 * math.sqrt(n))) ** 3)
    return _solve(above, confidence, 0.0, 10.0 + 3 * count)


def quantile(values: Sequence[float], part: float) -> float | None:
    """Return the smallest value that `part` of all values do not exceed; None of nothing.

    >>> quantile([3, 1, 2], 0.5), quantile(range(100), 0.99)
    (2, 98)
    """
    if not values:
        return None
    return sorted(values)[max(0, math.ceil(part * len(values)) - 1)]


def share(hits: int, total: int) -> dict[str, Any]:
    """Return a share of a total with its exact interval, as it goes into JSON; `share` is None of nothing."""
    low, high = share_interval(hits, total)
    return {"hits": hits, "of": total, "share": hits / total if total else None, "low": low, "high": high}


def rate(count: int, hours: float) -> dict[str, Any]:
    """Return a count in some hours and the exact interval of its rate, as it goes into JSON; None without hours."""
    tail = (1 + CONFIDENCE) / 2
    # The lower bound of the mean of a Poisson count: where one less is as likely exceeded as the tail.
    low, high = count_bound_high(count - 1, 1 - tail) if count else 0.0, count_bound_high(count, tail)
    if not hours:
        return {"count": count, "hours": hours, "rate": None, "low": None, "high": None}
    return {"count": count, "hours": hours, "rate": count / hours, "low": low / hours, "high": high / hours}
