# SPDX-License-Identifier: MIT
"""`argus-log stats`: what a log holds, how regular and how whole it is, and each sonar's record."""

from __future__ import annotations

import argparse
import itertools
import json
import math
import sys
from dataclasses import dataclass, field
from typing import Any, Final

from argus_tools.log.common import Input, Times, add_log_arguments, add_time_arguments, show_table
from argus_tools.log.packets import JUNK, Row
from hil_sim.arcos import TIMING
from hil_sim.tables import load

EXAMPLES: Final = """\
  argus-log stats drive.rec
  argus-log stats drive.pcapng --from +60 --json
"""
NO_ECHO_MM: Final[int] = load("robots/p3dx-sh")["sonar"]["no_echo_mm"]
BIN_MM: Final = 500
BINS: Final = NO_ECHO_MM // BIN_MM
# A SIP that comes later than this many cycles is a gap.
GAP_CYCLES: Final = 3
GAP_S: Final = GAP_CYCLES * TIMING["SIP_CYCLE_MS"] / 1000
_BATCH_ROWS: Final = 4096
_BARS: Final = " ▁▂▃▄▅▆▇█"
_ASCII_BARS: Final = " .:-=+*#@"


@dataclass
class Spacing:
    """Times of one kind of event: how many, and the mean, spread and extremes of the intervals."""

    count: int = 0
    first: float | None = None
    last: float | None = None
    intervals: int = 0
    mean: float = 0.0
    longest: float = 0.0
    longest_at: float | None = None
    shortest: float = math.inf
    _m2: float = 0.0

    def add(self, t: float | None) -> None:
        """Count one event."""
        self.count += 1
        if t is None:
            return
        if self.last is None:
            self.first = t
        else:
            interval = t - self.last
            self.intervals += 1
            delta = interval - self.mean
            self.mean += delta / self.intervals
            self._m2 += delta * (interval - self.mean)
            if interval > self.longest:
                self.longest, self.longest_at = interval, self.last
            self.shortest = min(self.shortest, interval)
        self.last = t

    def add_spread(self, squares: float) -> None:
        """Add to the sum of squared deviations, of intervals that were counted together."""
        self._m2 += squares

    @property
    def jitter(self) -> float | None:
        """Standard deviation of the intervals."""
        return math.sqrt(self._m2 / self.intervals) if self.intervals else None

    def summary(self) -> dict[str, Any]:
        """Return count, rate and intervals in s; null where the log keeps no times."""
        some = self.intervals > 0
        return {
            "count": self.count,
            "rate_hz": round(1 / self.mean, 4) if some and self.mean > 0 else None,
            "mean_s": round(self.mean, 6) if some else None,
            "jitter_s": round(self.jitter or 0.0, 6) if some else None,
            "shortest_s": round(self.shortest, 6) if some else None,
            "longest_s": round(self.longest, 6) if some else None,
            "longest_at": self.longest_at,
        }


@dataclass
class SonarRecord:
    """The readings of one sonar."""

    spacing: Spacing = field(default_factory=Spacing)
    dropouts: int = 0
    smallest: int | None = None
    largest: int | None = None
    total: int = 0
    bins: list[int] = field(default_factory=lambda: [0] * BINS)

    def add(self, t: float | None, range_mm: int) -> None:
        """Take one reading."""
        self.spacing.add(t)
        if range_mm >= NO_ECHO_MM:
            self.dropouts += 1
            return
        self.total += range_mm
        self.smallest = range_mm if self.smallest is None else min(self.smallest, range_mm)
        self.largest = range_mm if self.largest is None else max(self.largest, range_mm)
        self.bins[range_mm // BIN_MM] += 1

    def summary(self) -> dict[str, Any]:
        """Return what is known of the sonar."""
        count = self.spacing.count
        echoes = count - self.dropouts
        return {
            "readings": count,
            "refresh_s": self.spacing.summary()["mean_s"],
            "longest_gap_s": self.spacing.summary()["longest_s"],
            "dropout_share": round(self.dropouts / count, 4),
            "min_mm": self.smallest,
            "mean_mm": round(self.total / echoes, 1) if echoes else None,
            "max_mm": self.largest,
            "histogram_mm": {
                "bin": BIN_MM, "counts": list(self.bins), "no_echo": self.dropouts,
            },
        }  # fmt: skip


@dataclass
class Stats:
    """Everything that is counted over one log."""

    types: dict[tuple[str, str], Spacing] = field(default_factory=dict)
    damage: dict[str, dict[str, int]] = field(default_factory=dict)
    sizes: dict[str, int] = field(default_factory=dict)
    sonars: dict[int, SonarRecord] = field(default_factory=dict)
    gaps: list[tuple[float, float]] = field(default_factory=list)
    all: Spacing = field(default_factory=Spacing)
    gaps_total: int = 0

    def add(self, row: Row) -> None:
        """Count one row."""
        size = len(row.data) + (5 if row.ok else 0)
        self.sizes[row.dir] = self.sizes.get(row.dir, 0) + size
        if not row.ok:
            found = self.damage.setdefault(row.dir, {"packets": 0, "bad_checksum": 0, "bytes": 0})
            found["packets"] += row.type != JUNK
            found["bad_checksum"] += row.error.startswith("checksum")
            found["bytes"] += size
            return
        self.all.add(row.t)
        spacing = self.types.setdefault((row.dir, row.type), Spacing())
        if row.type == "SIP":
            if row.t is not None and spacing.last is not None and row.t - spacing.last > GAP_S:
                self.gaps_total += 1
                if len(self.gaps) < 1000:
                    self.gaps.append((spacing.last, row.t - spacing.last))
            self._add_sonars(row.t, row.data)
        spacing.add(row.t)

    def _add_sonars(self, t: float | None, data: bytes) -> None:
        count = data[19] if len(data) > 19 else 0
        readings: dict[int, int] = {}
        for at in range(20, min(20 + 3 * count, len(data) - 2), 3):
            readings[data[at]] = data[at + 1] | data[at + 2] << 8
        for number, range_mm in readings.items():
            record = self.sonars.get(number)
            if record is None:
                record = self.sonars[number] = SonarRecord()
            record.add(t, range_mm)

    def summary(self) -> dict[str, Any]:
        """Return everything as one object."""
        first, last = self.all.first, self.all.last
        return {
            "packets": self.all.count,
            "start": first,
            "duration_s": None if first is None or last is None else round(last - first, 6),
            "bytes": self.sizes,
            "types": [
                {"dir": direction, "type": name, **spacing.summary()}
                for (direction, name), spacing in sorted(self.types.items())
            ],
            "damage": self.damage,
            "sip_gaps": {
                "count": self.gaps_total,
                "over_s": GAP_S,
                "first": [list(gap) for gap in self.gaps[:20]],
            },
            "sonar": {str(number): self.sonars[number].summary() for number in sorted(self.sonars)},
        }


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_log_arguments(parser)
    parser.add_argument("--json", action="store_true", help="one JSON object instead of tables")
    add_time_arguments(parser)


def run(args: argparse.Namespace) -> int:
    """Print the statistics; return the exit code."""
    source = Input(args)
    times = Times(args.start, args.end)
    stats = Stats()
    rows = source.selected()
    if not times.is_open:
        rows = (row for row in rows if times(row.t, args.log))
    if source.is_live:
        for row in rows:
            stats.add(row)
    else:
        from argus_tools.log.stats_bulk import add_rows

        while batch := list(itertools.islice(rows, _BATCH_ROWS)):
            add_rows(stats, batch)
    summary = {"file": args.log, "format": source.log.format.name} | stats.summary()
    print(json.dumps(summary) if args.json else _text(summary))
    return source.exit_code


def _cell(value: float | None, digits: int = 3) -> str:
    return "-" if value is None else f"{value:.{digits}f}"


def _sparkline(counts: list[int]) -> str:
    top = max(counts) or 1
    bars = _bars()
    return "".join(bars[math.ceil(count * (len(bars) - 1) / top)] for count in counts)


def _bars() -> str:
    """Blocks, or what stands for them where standard output has none."""
    try:
        _BARS.encode(sys.stdout.encoding or "ascii")
    except UnicodeEncodeError:
        return _ASCII_BARS
    return _BARS


def _text(summary: dict[str, Any]) -> str:
    duration = summary["duration_s"]
    span = "no times" if duration is None else f"{duration:.3f} s from t = {summary['start']:.3f}"
    parts = [f"{summary['file']} ({summary['format']}): {summary['packets']} packets, {span}"]
    head: tuple[str, ...] = ("dir", "type", "packets", "per s", "mean s", "jitter s", "longest s", "at")
    rows: list[tuple[Any, ...]] = [
        (
            kind["dir"], kind["type"], kind["count"], _cell(kind["rate_hz"], 2), _cell(kind["mean_s"]),
            _cell(kind["jitter_s"], 4), _cell(kind["longest_s"]), _cell(kind["longest_at"]),
        )
        for kind in summary["types"]
    ]  # fmt: skip
    parts.append(show_table([head, *rows], frozenset(range(2, 8))))
    damage = [
        (direction, size, *summary["damage"].get(direction, {"p": 0, "b": 0, "s": 0}).values())
        for direction, size in summary["bytes"].items()
    ]
    head = ("dir", "bytes", "damaged packets", "bad checksums", "bytes skipped")
    parts.append(show_table([head, *damage], frozenset(range(1, 5))))
    gaps = summary["sip_gaps"]
    if duration is not None:
        listed = ", ".join(f"{length:.3f} s at {at:.3f}" for at, length in gaps["first"][:5])
        more = f": {listed}{' ...' if gaps['count'] > 5 else ''}" if listed else ""
        parts.append(f"gaps between SIPs over {gaps['over_s']:.1f} s: {gaps['count']}{more}")
    if summary["sonar"]:
        head = ("sonar", "readings", "refresh s", "longest s", "no echo", "min mm", "mean mm", "max mm",
                f"0..{NO_ECHO_MM} mm")  # fmt: skip
        rows = [
            (
                number, one["readings"], _cell(one["refresh_s"]), _cell(one["longest_gap_s"]),
                f"{one['dropout_share']:.1%}", _cell(one["min_mm"], 0), _cell(one["mean_mm"], 0),
                _cell(one["max_mm"], 0), "|" + _sparkline(one["histogram_mm"]["counts"]) + "|",
            )
            for number, one in summary["sonar"].items()
        ]  # fmt: skip
        parts.append(show_table([head, *rows], frozenset(range(8))))
    return "\n\n".join(parts)
