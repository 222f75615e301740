# SPDX-License-Identifier: MIT
"""What the slots of dead sonars are worth to those that look ahead: how often each is heard, before and after."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import mean
from typing import Final

from hil_sim.experiment.stage import Heard, Seen, Stage
from hil_sim.sil import Mission
from hil_sim.tables.robot import robot_table

MASKS: Final = ("3", "1+6", "2+3", "1+2+3", "2+4+5+6", "1+2+3+4+5")
PROFILES: Final = ("paper", "argus")
DEAD_S: Final = 8.0
SETTLED_S: Final = 12.0
END_S: Final = 24.0
WORLD: Final = "demo"
_BEGIN_S: Final = 3.0


@dataclass(frozen=True)
class Row:
    """Refresh times in ms, by sonar, with every sonar alive and with these dead."""

    profile: str
    dead: str
    before_ms: Mapping[int, float]
    after_ms: Mapping[int, float]

    @property
    def ahead(self) -> list[int]:
        """The living sonars that look ahead."""
        gone = {int(number) for number in self.dead.split("+")}
        return [number for number in robot_table().forward if number not in gone]

    def mean_ms(self, sonars: Sequence[int]) -> tuple[float, float]:
        """Return the mean over some sonars, before and after."""
        return mean(self.before_ms[n] for n in sonars), mean(self.after_ms[n] for n in sonars)


def run_one(stage: Stage, profile: str, dead: str, seed: int = 1) -> Row:
    """Let sonars of a robot at rest fall silent, and time the readings of all before and after."""
    mission = Mission(
        WORLD,
        (),
        faults=(f"silent:{dead}@{DEAD_S:g}s",),
        seed=seed,
        config={"profile": profile},
        sonar={"crosstalk": 0.0},
        limit_s=END_S,
    )
    seen = stage(mission, lambda _seen: False)
    return Row(profile, dead, _refresh_ms(seen, _BEGIN_S, DEAD_S), _refresh_ms(seen, SETTLED_S, END_S))


def _refresh_ms(seen: Seen, begin_s: float, end_s: float) -> dict[int, float]:
    """The mean time between two readings of each sonar."""
    times: dict[int, list[float]] = {}
    for heard in sorted(seen.readings, key=_when):
        if begin_s <= heard.t_s <= end_s:
            times.setdefault(heard.sonar, []).append(heard.t_s)
    return {n: 1000 * (at[-1] - at[0]) / (len(at) - 1) for n, at in times.items() if len(at) > 1}


def _when(heard: Heard) -> float:
    return heard.t_s


def run(stage: Stage, seed: int = 1) -> list[Row]:
    """Time all sets under both profiles."""
    return [run_one(stage, profile, dead, seed) for profile in PROFILES for dead in MASKS]


def table(rows: Sequence[Row]) -> str:
    """Return the rows in Markdown."""
    lines = [
        "| profile | dead | each living sonar ahead, ms: before | after | gained | 0 and 7, ms: before | after |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        before, after = row.mean_ms(row.ahead)
        beside = row.mean_ms((0, 7))
        lines.append(
            f"| {row.profile} | {row.dead.replace('+', ', ')} | {before:.0f} | {after:.0f} | "
            f"{100 * (1 - after / before):.0f} % | {beside[0]:.0f} | {beside[1]:.0f} |"
        )
    return "\n".join(lines) + "\n"
