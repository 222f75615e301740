# SPDX-License-Identifier: MIT
"""`argus-sim bench laser`: how soon faults of a laser are found, and whether a healthy one is left alone."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import Final

import numpy as np

from hil_sim.bench.arguments import Parser
from hil_sim.bench.worlds import make_world
from hil_sim.core.library import Core, kind_name
from hil_sim.laser.drive import Step, roam
from hil_sim.laser.faults import FAULTS
from hil_sim.laser.scan import Beams, laser_of, scan
from hil_sim.sonar.echo import EchoModel
from hil_sim.sonar.params import SonarParams
from hil_sim.tables.robot import RobotTable, robot_table
from hil_sim.world.model import Floats, Pose, World

WORLDS: Final = ("gen-room", "gen-office", "gen-clutter", "gen-corridor", "gen-hall")
RINGS: Final = Path(__file__).resolve().parents[1] / "laser" / "rings"
_CLEAR_MM: Final = 700.0
_BEGINS_MS: Final = 20_000
_SONAR_NOISE_MM: Final = 5.0
_FIRING: Final = ((0, 2, 4, 6, 1, 3, 5, 7), (8, 10, 12, 14, 9, 11, 13, 15))


@dataclass
class Outcome:
    """One drive: when each sensor was named or disabled, ms since its start, and how far the robot went, mm."""

    named: dict[int, int] = field(default_factory=dict)
    kinds: dict[int, str] = field(default_factory=dict)
    disabled: dict[int, int] = field(default_factory=dict)
    laser_ms: int | None = None
    laser: int = 0
    way_mm: float = 0.0
    dead: tuple[int, ...] = ()


class _Sonars:
    """The sonars of a robot, fired in turn as its arrays do."""

    def __init__(self, table: RobotTable, world: World, rng: np.random.Generator) -> None:
        self._count = table.sonars - len(table.sectors)
        self._echoes = EchoModel(world, SonarParams(), table) if self._count else None
        self._rng = rng
        self._fired = 0

    def heard(self, pose: Pose, dead: tuple[int, ...]) -> list[tuple[int, int, int]]:
        """Return sonar, range and age of what was heard in the last 100 ms: five firings of two arrays in two steps."""
        found: list[tuple[int, int, int]] = []
        if self._echoes is None:
            return found
        for _ in range(2 + self._fired % 2):
            for order in _FIRING:
                number = order[self._fired % len(order)]
                if number < self._count:
                    mm = 5000 if number in dead else self._echoes.ping_mm(number, pose)
                    mm = mm if mm >= 5000 else max(100, round(mm + self._rng.normal(0, _SONAR_NOISE_MM)))
                    found.append((number, mm, 40))
            self._fired += 1
        return found


def drive(
    ring: str, world_name: str, seed: int, seconds: float, fault: str = "", dead: tuple[int, ...] = ()
) -> Outcome:
    """Drive about a generated world, with a fault of the laser or dead sonars from 20 s on."""
    table = robot_table(ring)
    rng = np.random.default_rng([seed, len(world_name)])
    with tempfile.TemporaryDirectory() as folder:
        world, room, _ = make_world(world_name, (seed,), Path(folder))
    places = room.places(_CLEAR_MM)
    place = places[rng.integers(len(places))]
    start = Pose(float(place[0]), float(place[1]), float(rng.uniform(-180, 180)))
    laser = laser_of(table)
    beams = Beams(table, laser.angles)
    core = Core(0, {"active": 0}, table.ring)
    core.link_up(0)
    outcome, scans = Outcome(dead=dead), list[Floats]()
    sonars = _Sonars(table, world, rng)
    for step in roam(world, start, seconds, rng):
        scans.append(scan(laser, world, step.true, rng))
        begun = step.t_ms >= _BEGINS_MS
        ranges = sonars.heard(step.true, dead if begun else ())
        ranges += _sectors_of(beams, _reported(scans, step.t_ms, fault))
        core.observe(step.t_ms, _motion(step), ranges)
        core.process(step.t_ms)
        core.transmit()
        _note(outcome, core)
        outcome.way_mm += abs(step.speed_mm_s) * 0.1 if begun or not (fault or dead) else 0.0
    return outcome


def _sectors_of(beams: Beams, reported: Floats | None) -> list[tuple[int, int, int]]:
    """The nearest of each sector as the core takes it; none where the laser sends no scan."""
    if reported is None:
        return []
    return [
        (number, 5000 if mm >= 5000 else max(1, round(mm)), 0)
        for number, mm in beams.nearest(reported).items()
    ]


def _reported(scans: Sequence[Floats], t_ms: int, fault: str) -> Floats | None:
    if not fault or t_ms < _BEGINS_MS:
        return scans[-1]
    return FAULTS[fault][0](scans, (t_ms - _BEGINS_MS) // 100)


def _motion(step: Step) -> tuple[int, int, int, int, int]:
    pose = step.odometry
    heading = round(pose.heading_deg * 100)
    return (
        round(pose.x_mm),
        round(pose.y_mm),
        (heading + 18_000) % 36_000 - 18_000,
        round(step.speed_mm_s),
        round(step.turn_deg_s * 100),
    )


def _note(outcome: Outcome, core: Core) -> None:
    for event in core.events():
        if event.event == "LASER_FAULT":
            outcome.laser_ms, outcome.laser = event.t_ms, event.value
        elif event.sonar is not None and event.event in ("SONAR_NAMED", "SONAR_DISABLED", "SONAR_STALE"):
            outcome.named.setdefault(event.sonar, event.t_ms)
            if event.event == "SONAR_DISABLED":
                outcome.disabled.setdefault(event.sonar, event.t_ms)
            if event.event != "SONAR_STALE":
                outcome.kinds[event.sonar] = kind_name(event.value)


def found_ms(outcome: Outcome, sensors: Sequence[int]) -> int | None:
    """Return how long after the fault began one of these sensors was named, or the laser as a whole; None: not."""
    times = [outcome.named[k] for k in sensors if outcome.named.get(k, -1) >= _BEGINS_MS]
    if outcome.laser_ms is not None and outcome.laser_ms >= _BEGINS_MS:
        times.append(outcome.laser_ms)
    return min(times) - _BEGINS_MS if times else None


def table_of(ring: str, seeds: Sequence[int], seconds: float, worlds: Sequence[str] = WORLDS) -> list[str]:
    """Return a table: a healthy laser, then each fault."""
    places = [(world, seed) for world in worlds for seed in seeds]
    lines = ["| laser | drives | found in time | median s | bar s |", "|---|---|---|---|---|"]
    lines.append(_healthy_row(ring, places, seconds))
    lines += [_fault_row(ring, places, fault, bar_s) for fault, (_, bar_s) in FAULTS.items()]
    return lines


def _healthy_row(ring: str, places: Sequence[tuple[str, int]], seconds: float) -> str:
    sectors = robot_table(ring).sectors
    healthy = [drive(ring, world, seed, seconds) for world, seed in places]
    named = sum(any(k in one.named for k in sectors) or one.laser_ms is not None for one in healthy)
    sonars = sum(any(k not in sectors for k in one.named) for one in healthy)
    hours = seconds * len(healthy) / 3600
    return f"| healthy | {len(healthy)} | named {named}, sonars {sonars} in {hours:.1f} h | | |"


def _fault_row(ring: str, places: Sequence[tuple[str, int]], fault: str, bar_s: float) -> str:
    sectors = robot_table(ring).sectors
    seconds = _BEGINS_MS / 1000 + max(90.0, bar_s + 5)
    times = [found_ms(drive(ring, world, seed, seconds, fault), sectors) for world, seed in places]
    found = [t / 1000 for t in times if t is not None]
    in_time = sum(t <= bar_s for t in found)
    middle = f"{median(found):.1f}" if found else ""
    return f"| {fault} | {len(times)} | {in_time} | {middle} | {bar_s:.0f} |"


def main(words: Sequence[str]) -> int:
    """Print the table; return the exit code."""
    parser = Parser(
        prog="argus-sim bench laser",
        description="Drive about generated worlds with a laser, sound and faulty; print how soon faults are found.",
        epilog="example: argus-sim bench laser --seeds 1 --seconds 200",
    )
    parser.add_argument("--ring", default=str(RINGS / "laser.toml"), help="a TOML file with a laser")
    parser.add_argument("--seeds", type=int, default=2, help="so many drives in each world (default 2)")
    parser.add_argument("--seconds", type=float, default=300.0, help="of a healthy drive (default 300)")
    args = parser.parse_args(words)
    if args.seeds < 1 or not args.seconds > 0:
        parser.error("--seeds must be 1 or more, --seconds above 0")
    print("\n".join(table_of(args.ring, range(1, args.seeds + 1), args.seconds)))
    return 0
