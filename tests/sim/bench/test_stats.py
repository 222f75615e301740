# SPDX-License-Identifier: MIT
"""Rule: the bounds are the exact ones of the textbooks, and cover as often as they say."""

from __future__ import annotations

import math

import pytest

from hil_sim.bench.stats import beta_cdf, count_bound_high, quantile, share_bound_low, share_interval


@pytest.mark.parametrize(("total", "least"), [(299, 0.99), (59, 0.95), (29, 0.90), (99, 0.97)])
def test_without_a_miss_the_bound_is_the_root_of_5_percent(total: int, least: float) -> None:
    assert share_bound_low(total, total) == pytest.approx(0.05 ** (1 / total), abs=1e-9)
    assert share_bound_low(total, total) > least > share_bound_low(total - 1, total - 1)


@pytest.mark.parametrize(
    ("hits", "total", "low", "high"),
    # Clopper and Pearson, two-sided 95 %.
    [
        (0, 10, 0.0, 0.308497),
        (1, 10, 0.002529, 0.445016),
        (5, 10, 0.187086, 0.812914),
        (10, 10, 0.691503, 1.0),
    ],
)
def test_the_interval_of_a_share(hits: int, total: int, low: float, high: float) -> None:
    assert share_interval(hits, total) == pytest.approx((low, high), abs=1e-6)


def test_nothing_tried_tells_nothing() -> None:
    assert share_interval(0, 0) == (0.0, 1.0)
    assert share_bound_low(0, 0) == 0.0


@pytest.mark.parametrize(("hits", "total"), [(3, 7), (40, 50), (988, 1000)])
def test_the_bound_leaves_5_percent_to_the_tail_of_the_binomial(hits: int, total: int) -> None:
    p = share_bound_low(hits, total)
    tail = sum(math.comb(total, k) * p**k * (1 - p) ** (total - k) for k in range(hits, total + 1))
    assert tail == pytest.approx(0.05, abs=1e-6)


@pytest.mark.parametrize(
    ("count", "high"), [(0, 2.995732), (1, 4.743865), (2, 6.295794), (5, 10.513035), (10, 16.962219)]
)
def test_the_bound_of_a_count_is_that_of_poisson(count: int, high: float) -> None:
    assert count_bound_high(count) == pytest.approx(high, abs=1e-5)


def test_far_up_the_bound_of_a_count_goes_on_without_a_jump() -> None:
    steps = [count_bound_high(k + 1) - count_bound_high(k) for k in range(495, 506)]
    assert all(1.036 < step < 1.038 for step in steps), steps


@pytest.mark.parametrize(("x", "a", "b"), [(0.2, 1, 1), (0.5, 3, 3), (0.9, 40, 7), (0.01, 0.5, 200)])
def test_beta_is_the_integral_of_its_density(x: float, a: float, b: float) -> None:
    front = math.gamma(a + b) / math.gamma(a) / math.gamma(b) if a + b < 100 else None
    assert beta_cdf(x, a, b) == pytest.approx(1 - beta_cdf(1 - x, b, a), abs=1e-12)
    if front is not None and a >= 1:
        n = 20_000
        area = (
            sum(((k + 0.5) * x / n) ** (a - 1) * (1 - (k + 0.5) * x / n) ** (b - 1) for k in range(n)) * x / n
        )
        assert beta_cdf(x, a, b) == pytest.approx(front * area, rel=1e-5)


def test_a_quantile_is_a_value_that_occurred() -> None:
    assert quantile([], 0.5) is None
    assert quantile([7.0], 0.99) == 7.0
    assert quantile(list(range(1, 101)), 0.99) == 99
    assert quantile(list(range(1, 101)), 0.5) == 50
    assert quantile([3.0, 1.0], 1.0) == 3.0
