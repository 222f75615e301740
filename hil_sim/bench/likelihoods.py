# SPDX-License-Identifier: MIT
"""Measures how often each pair of verdicts comes with a fault and without, and writes the tables of the core."""

from __future__ import annotations

import ctypes
import json
import math
import tempfile
import tomllib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from hil_sim.bench.passive import SETTINGS
from hil_sim.bench.stream import Stream, load_stream
from hil_sim.bench.variants import Edit, Variant, Workshop
from hil_sim.core.replay import Engine
from hil_sim.errors import SimError
from hil_sim.sil import FaultTruth

Counts = npt.NDArray[np.int64]

VERDICTS: Final = ("UNSEEN", "QUIET", "AGREED", "CONTRADICTED", "DIVIDED", "SAME")
"""As the enumeration of crosscheck.c, in its order."""
LAGS: Final = range(2, 10)
OFFSETS_DEG: Final = (-24, -18, -12, 12, 18, 24)
HYPOTHESES: Final = len(LAGS) + len(OFFSETS_DEG)
_SHAPE: Final = (2, HYPOTHESES, len(VERDICTS), len(VERDICTS))
_NEAR_DEG: Final = 4.0
"""A hypothesis of an axis offset holds for a fault that is at most so far from it."""
TELLING: Final = ("QUIET", "AGREED", "CONTRADICTED", "SAME")
"""Verdicts on a mapped ping that tell something of the hypothesis: the others say that no sonar looked there."""
LEAST: Final = 30
RARE: Final = 5.0
"""Pings, added to those that came and to those that were to be expected: a rare cell tells little."""
MOST: Final = 400
"""Hundredths of a nat, of one cell: rarer things happen for reasons that no stream has."""
SMALL: Final = 500
FAR: Final = 0.25
"""A row of at least SMALL pings of a small run may have shares so far from those of the large one. Pings of one
stream are alike."""
FILE: Final = Path(__file__).parents[1] / "tables" / "likelihoods.toml"
CLASSES: Final = ("healthy", "fault", "other")
TABLES: Final = ("lag", "offset")

_OBSERVER: Final = f"""
_Static_assert(ARGUS_LEAST_LAG == {LAGS.start}, "the least lag");
_Static_assert(ARGUS_LAGS == {len(LAGS)}, "the number of lags");
_Static_assert(ARGUS_OFFSETS == {len(OFFSETS_DEG)}, "the number of offsets");
_Static_assert(SAYINGS == {len(VERDICTS)}, "the number of verdicts");
__attribute__((visibility("default"))) int32_t argus_observed{"".join(f"[{n}]" for n in _SHAPE)};
__attribute__((visibility("default"))) int32_t argus_observe_sonar;
__attribute__((visibility("default"))) uint32_t argus_observe_from_ms;
__attribute__((visibility("default"))) uint32_t argus_observe_to_ms;
static void observe(const argus_knowledge_t *knowledge, int sonar, int hypothesis, int verdict, int mapped) {{
    const uint32_t now_ms = knowledge->sip_ms;
    if (now_ms >= argus_observe_from_ms && now_ms <= argus_observe_to_ms) {{
        argus_observed[sonar == argus_observe_sonar][hypothesis][verdict][mapped]++;
    }}
}}
"""
_TAP_LAGS: Final = r"""
    for (int h = 0; h < ARGUS_LAGS; h++) {
        observe(knowledge, sonar, h, (int)verdict, (int)as_late(self, knowledge, sonar, back, h + ARGUS_LEAST_LAG));
    }
"""
_TAP_OFFSETS: Final = r"""
    for (int h = 0; h < ARGUS_OFFSETS; h++) {
        observe(knowledge, sonar, ARGUS_LAGS + h, (int)verdict, (int)as_offset(self, knowledge, sonar, at, h));
    }
"""
OBSERVED: Final = Variant(
    "observed",
    "the fault manager as it is, which counts the verdicts on every ping",
    (
        Edit("crosscheck.c", r"(} verdict_t;\n)", _OBSERVER),
        Edit("crosscheck.c", r"(static void weigh_lags\([^{;]*\{\n)", _TAP_LAGS),
        Edit("crosscheck.c", r"(static void weigh_offsets\([^{;]*\{\n)", _TAP_OFFSETS),
    ),
)


@dataclass
class Tally:
    """Counts of pairs of verdicts: as it stands, as mapped. By table and class."""

    counts: dict[str, dict[str, Counts]] = field(
        default_factory=lambda: {
            table: {name: np.zeros(_SHAPE[2:], dtype=np.int64) for name in CLASSES} for table in TABLES
        }
    )

    def add(self, table: str, name: str, counts: Iterable[Counts]) -> None:
        """Take in the counts of some hypotheses."""
        for one in counts:
            self.counts[table][name] += one

    @classmethod
    def of(cls, found: Any) -> Tally:
        """Take counts by table and class; SimError when they are of another size."""
        result = cls()
        try:
            for table in TABLES:
                for name in CLASSES:
                    counts = np.array(found[table][name], dtype=np.int64)
                    if counts.shape != _SHAPE[2:] or (counts < 0).any():
                        raise ValueError("another size")
                    result.counts[table][name] = counts
        except (KeyError, TypeError, ValueError) as error:
            raise SimError(
                f"the counts of the likelihoods are of another version ({error}); measure anew with --write"
            ) from error
        return result


def right_lags(truth: FaultTruth) -> list[int]:
    """Return the hypotheses of a lag that hold for a fault: late by n firings is the reading of n + 1 pings ago."""
    n = _parameter(truth, "n")
    return [] if truth.kind != "slow" or n is None else [i for i, lag in enumerate(LAGS) if lag == int(n) + 1]


def right_offsets(truth: FaultTruth) -> list[int]:
    """Return the hypotheses of an axis offset that hold for a fault."""
    angle = _parameter(truth, "angle")
    return [] if angle is None else [i for i, deg in enumerate(OFFSETS_DEG) if abs(deg - angle) <= _NEAR_DEG]


def _parameter(truth: FaultTruth, name: str) -> float | None:
    for part in truth.text.split(":"):
        key, equals, value = part.partition("=")
        if equals and key == name:
            return float(value)
    return None


class Observer:
    """A fault manager that counts; built from OBSERVED."""

    def __init__(self, library: Path) -> None:
        self._engine = Engine(library)
        loaded = ctypes.CDLL(str(library))
        size = math.prod(_SHAPE)
        self._observed = (ctypes.c_int32 * size).in_dll(loaded, "argus_observed")
        self._sonar = ctypes.c_int32.in_dll(loaded, "argus_observe_sonar")
        self._from_ms = ctypes.c_uint32.in_dll(loaded, "argus_observe_from_ms")
        self._to_ms = ctypes.c_uint32.in_dll(loaded, "argus_observe_to_ms")

    def count(self, stream: Stream) -> Counts:
        """Return the counts of one stream, of healthy sonars and of the one at fault: while the fault shows.

        The healthy ones are counted in that time only, too, so that what the robot does then favours neither.
        """
        self._sonar.value, from_s, to_s = -1, 0.0, stream.end_s
        for truth in stream.truth:
            visible_s = truth.first_visible_s
            self._sonar.value, from_s = truth.sonar, stream.end_s if visible_s is None else visible_s
            to_s = truth.end_s if truth.end_s is not None else stream.end_s
        self._from_ms.value, self._to_ms.value = int(from_s * 1000), int(to_s * 1000)
        ctypes.memset(self._observed, 0, ctypes.sizeof(self._observed))
        self._engine.replay(stream.times_ms.tobytes(), stream.lengths.tobytes(), stream.data, SETTINGS)
        return np.array(self._observed[:], dtype=np.int64).reshape(_SHAPE)


def observe(paths: Iterable[Path]) -> Tally:
    """Build the manager that counts; return the counts of recorded streams."""
    with tempfile.TemporaryDirectory(prefix="argus-observe-") as folder:
        workshop = Workshop(Path(folder))
        workshop.whole()
        return measure((load_stream(path) for path in paths), Observer(workshop.build(OBSERVED)))


def measure(streams: Iterable[Stream], observer: Observer) -> Tally:
    """Return the counts of all streams that have one fault at most."""
    tally = Tally()
    for stream in streams:
        if len(stream.truth) > 1:
            continue
        counts = observer.count(stream)
        for table, part, right in _parts(stream):
            tally.add(table, "healthy", counts[0][part])
            if right:
                tally.add(table, "fault", (counts[1][part][i] for i in right))
            elif right is not None:
                tally.add(table, "other", counts[1][part])
    return tally


def _parts(stream: Stream) -> Iterator[tuple[str, slice, list[int] | None]]:
    """Per table: its hypotheses, and those that hold; empty: of another fault; None: it tells of neither."""
    truth = stream.truth[0] if stream.truth else None
    lags = None if truth is None else right_lags(truth)
    offsets = None if truth is None else right_offsets(truth)
    if truth is not None and not offsets and _parameter(truth, "angle") is not None:
        offsets = None
    yield "lag", slice(0, len(LAGS)), lags
    yield "offset", slice(len(LAGS), HYPOTHESES), offsets


def log_ratio(one: Counts, other: Counts) -> npt.NDArray[np.int64]:
    """Return ln of what came over what was to be expected, hundredths of a nat, of each cell, given its row.

    0 in the columns of mapped pings that no sonar can judge, and in rows with fewer than LEAST pings. Whether the
    map leaves a ping in its place comes of how the robot moves, so that tells nothing. But the hypothesis does not
    explain one that is contradicted there.
    """
    expected = other * (one.sum(axis=1) / np.maximum(other.sum(axis=1), 1))[:, None]
    ratio = np.log((one + RARE) / (expected + RARE))
    enough = np.minimum(one.sum(axis=1), other.sum(axis=1)) >= LEAST
    told = np.outer(enough, [name in TELLING for name in VERDICTS])
    told[[name != "CONTRADICTED" for name in VERDICTS], VERDICTS.index("SAME")] = False
    return np.where(told, np.clip(np.rint(100 * ratio), -MOST, MOST), 0).astype(np.int64)


def cells(tally: Tally, table: str, over: str) -> npt.NDArray[np.int64]:
    """Return the table of a hypothesis over another class.

    A lag takes every reading, an offset one of a place. So for a lag only a ping that is contradicted as it stands
    speaks: what agrees anyway would be counted again and again.
    """
    result = log_ratio(tally.counts[table]["fault"], tally.counts[table][over])
    if table == "lag":
        others = [i for i, name in enumerate(VERDICTS) if name != "CONTRADICTED"]
        result[others] = np.minimum(result[others], 0)
    return result


def to_toml(tally: Tally, command: str) -> str:
    """Return the file that tools/gen_tables.py makes the header of."""
    lines = [
        "# SPDX-License-Identifier: MIT",
        "# Verdicts on pings with a fault and without, counted by the command below; not to be edited.",
        "# Rows: the verdict on a ping as it stands; columns: on the ping as a hypothesis maps it.",
        f"command = {json.dumps(command, ensure_ascii=False)}",
        f"verdicts = {list(VERDICTS)}".replace("'", '"'),
    ]
    for table in TABLES:
        for name in CLASSES:
            lines += ["", *_matrix(f"{table}.count.{name}", tally.counts[table][name])]
        for over in CLASSES[::2]:
            lines += [
                "",
                "# hundredths of a nat",
                *_matrix(f"{table}.over.{over}", cells(tally, table, over)),
            ]
    return "\n".join(lines) + "\n"


def _matrix(name: str, values: npt.NDArray[np.int64]) -> list[str]:
    rows = ",\n".join(f"    [{', '.join(str(int(v)) for v in row)}]" for row in values)
    return [f"[{name}]", f"rows = [\n{rows},\n]"]


def from_toml(text: str) -> Tally:
    """Read the counts of such a file; SimError when they do not give its tables."""
    found = tomllib.loads(text)
    try:
        tally = Tally.of({t: {n: found[t]["count"][n]["rows"] for n in CLASSES} for t in TABLES})
    except (KeyError, TypeError) as error:
        raise SimError(f"{FILE.name}: {error} is missing; measure anew with --write") from error
    if to_toml(tally, found.get("command", "")) != text:
        raise SimError(f"{FILE.name}: its tables are not those of its counts; measure anew with --write")
    return tally


def differences(small: Tally, large: Tally) -> list[str]:
    """Return where a small run has shares that the large one does not bear out, in words."""
    found = []
    for table in TABLES:
        for name in CLASSES:
            few, many = small.counts[table][name], large.counts[table][name]
            for i in np.flatnonzero((few.sum(axis=1) >= SMALL) & (many.sum(axis=1) >= SMALL)):
                off = np.abs(few[i] / few[i].sum() - many[i] / many[i].sum())
                if off.max() > FAR:
                    found.append(
                        f"{table}, {name}, {VERDICTS[i]} mapped to {VERDICTS[int(off.argmax())]}: "
                        f"{100 * off.max():.0f} points apart"
                    )
    return found
