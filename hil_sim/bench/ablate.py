# SPDX-License-Identifier: MIT
"""What each rule and constant of the evidence is worth: the fault manager without it, on the same streams."""

from __future__ import annotations

import math
import multiprocessing
import operator
import tempfile
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

from hil_sim.bench.passive import Finding, Verdict, judge_stream
from hil_sim.bench.stats import quantile
from hil_sim.bench.stream import Stream, load_stream
from hil_sim.bench.variants import Variant, Workshop
from hil_sim.core.replay import Engine

CHANCE: Final = 0.05


@dataclass(frozen=True)
class Worth:
    """A variant against the whole: what is lost without the rule, and what is said wrongly without it.

    lost, won: faults found in time by one of the two only; p: that chance alone makes them so unequal. ever: faults
    found at all, more by the whole. names, disables: how many more false ones there are without. names_p: as p, of
    the streams that have more with one and more with the other. latency_s: the median without, less that of the whole.
    """

    name: str
    says: str
    lost: int
    won: int
    p: float
    ever: int
    names: int
    names_p: float
    disables: int
    latency_s: float
    changed: int

    @property
    def earns(self) -> bool:
        """It finds more than chance would, or saves false names or disables."""
        finds = self.lost > self.won and self.p < CHANCE
        return finds or (self.names > 0 and self.names_p < CHANCE) or self.disables > 0


Tell = Callable[[Worth], None]
"""Called when a variant has been judged."""


def sign_test(one: int, other: int) -> float:
    """Return the chance, two-sided, that two like things come out as unequal as this.

    >>> sign_test(0, 0), sign_test(5, 0), sign_test(3, 2)
    (1.0, 0.0625, 1.0)
    """
    total, less = one + other, min(one, other)
    tail: float = sum(math.comb(total, k) for k in range(less + 1)) / 2**total
    return min(1.0, 2 * tail)


def _pairs(
    whole: Sequence[Verdict], without: Sequence[Verdict]
) -> Iterator[tuple[Finding | None, Finding | None]]:
    """The findings on the same fault. One that only the other found in a stream that shows little is a miss here."""
    for a, b in zip(whole, without, strict=True):
        ones, others = list(a.findings), list(b.findings)
        for i in range(max(len(ones), len(others))):
            yield (ones[i] if i < len(ones) else None, others[i] if i < len(others) else None)


def _in_time(finding: Finding | None) -> bool:
    return finding is not None and finding.in_time


def median_latency_s(verdicts: Sequence[Verdict]) -> float:
    """Return the median time to find a fault, those never found included as infinite; nan of none."""
    found = [f.latency_s if f.latency_s is not None else math.inf for v in verdicts for f in v.findings]
    middle = quantile(found, 0.5)
    return math.nan if middle is None else middle


def compare(variant: Variant, whole: Sequence[Verdict], without: Sequence[Verdict]) -> Worth:
    """Return what a rule is worth by the verdicts on the same streams with it and without it."""
    pairs = list(_pairs(whole, without))
    lost, won = _only_one(pairs), _only_one([(b, a) for a, b in pairs])
    names = [len(b.names) - len(a.names) for a, b in zip(whole, without, strict=True)]
    return Worth(
        variant.name,
        variant.says,
        lost,
        won,
        sign_test(lost, won),
        _ever_found(whole) - _ever_found(without),
        sum(names),
        _chance_of(names),
        _disables(without) - _disables(whole),
        median_latency_s(without) - median_latency_s(whole),
        sum(map(operator.ne, whole, without)),
    )


def _only_one(pairs: Sequence[tuple[Finding | None, Finding | None]]) -> int:
    """How many faults only the first of the two found in time."""
    return sum(_in_time(a) and not _in_time(b) for a, b in pairs)


def _chance_of(more: Sequence[int]) -> float:
    return sign_test(sum(n > 0 for n in more), sum(n < 0 for n in more))


def _ever_found(verdicts: Sequence[Verdict]) -> int:
    return sum(f.latency_s is not None for v in verdicts for f in v.findings)


def _disables(verdicts: Sequence[Verdict]) -> int:
    return sum(len(v.disables) for v in verdicts)


@lru_cache(maxsize=1)
def _streams(paths: tuple[Path, ...]) -> tuple[Stream, ...]:
    return tuple(load_stream(path) for path in paths)


def judge_all(paths: Sequence[Path], library: Path) -> list[Verdict]:
    """Return the verdicts on all streams of a manager."""
    engine = Engine(library)
    return [judge_stream(stream, engine) for stream in _streams(tuple(paths))]


def _judge_variant(paths: tuple[Path, ...], workshop: Workshop, variant: Variant) -> list[Verdict]:
    library = workshop.build(variant)
    try:
        return judge_all(paths, library)
    finally:
        library.unlink()


def ablate(
    paths: Sequence[Path],
    variants: Sequence[Variant],
    jobs: int,
    progress: Tell,
) -> tuple[list[Verdict], list[Worth]]:
    """Judge the streams by the whole and by each variant; return the verdicts of the whole, and what each is worth."""
    with tempfile.TemporaryDirectory(prefix="argus-ablate-") as folder:
        workshop = Workshop(Path(folder))
        whole = judge_all(paths, workshop.whole())
        found = []
        for variant, without in zip(variants, _judged(tuple(paths), workshop, variants, jobs), strict=True):
            worth = compare(variant, whole, without)
            progress(worth)
            found.append(worth)
    return whole, found


def _judged(
    paths: tuple[Path, ...], workshop: Workshop, variants: Sequence[Variant], jobs: int
) -> Iterator[list[Verdict]]:
    if jobs <= 1:
        yield from (_judge_variant(paths, workshop, variant) for variant in variants)
        return
    with ProcessPoolExecutor(jobs, multiprocessing.get_context("spawn")) as pool:
        futures = [pool.submit(_judge_variant, paths, workshop, variant) for variant in variants]
        try:
            yield from (future.result() for future in futures)
        finally:
            pool.shutdown(wait=True, cancel_futures=True)  # they write into the folder that goes


def table(worths: Sequence[Worth]) -> str:
    """Return the table, what earns most first."""
    lines = [
        "| without | that | lost / won in time | ever | false names | false disables | median, s | earns its place |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for w in sorted(worths, key=lambda w: (not w.earns, w.won - w.lost, -w.names)):
        lines.append(
            f"| `{w.name}` | {w.says} | {w.lost} / {w.won} (p {w.p:.2g}) | {-w.ever:+d} "
            f"| {w.names:+d} (p {w.names_p:.2g}) | {w.disables:+d} | {w.latency_s:+.2f} "
            f"| {'yes' if w.earns else 'no'} |"
        )
    return "\n".join(lines) + "\n"


def to_json(worths: Sequence[Worth]) -> list[dict[str, Any]]:
    """Return the rows for a file."""
    return [vars(w) | {"earns": w.earns} for w in worths]
