# SPDX-License-Identifier: MIT
"""Semi-real streams: real odometry and a real laser; sonars cast into its scans, with the statistics of real ones."""

from __future__ import annotations

import json
import math
import subprocess
import sys
import zlib
from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from hil_sim.bench.passive import SETTINGS, Verdict, judge_changes
from hil_sim.bench.stream import Stream
from hil_sim.core.library import Core, setting_value
from hil_sim.core.replay import Change
from hil_sim.errors import SimError
from hil_sim.faults.grammar import parse_fault
from hil_sim.sil.noted import NotedFaults
from hil_sim.sonar.echo import EchoModel
from hil_sim.sonar.params import MIN_MM, NO_ECHO_MM, Reading, SonarParams, transducer_pose
from hil_sim.sonar.patch import MovingEchoes
from hil_sim.sonar.ring import SonarRing
from hil_sim.sonar.rough import Roughness
from hil_sim.tables import load
from hil_sim.tables.robot import RobotTable, robot_table
from hil_sim.world.model import Floats, Pose, World
from hil_sim.world.physics import SETS

_FORMS: Final = (".bag", ".mcap", ".log", ".clf", ".csv", ".tsv", ".jsonl")
READER: Final = ("-m", "argus_tools.rings.drives")
"""Reads the forms that argus-log reads; in a process of its own, since the tools rest on the emulator."""
STEP_MS: Final = 100
GAP_MS: Final = 2000
"""A longer pause between two scans ends a drive: nothing says how the robot moved."""
AFTER_S: Final = 42.0
LOW_FROM_MM: Final = (300.0, 1000.0)
"""A thing below the laser's plane stands so far before what the laser sees."""
LOW_CLEAR_MM: Final = 450.0
LOW_LOOK: Final = 20
"""Of so many scans one is searched for places of such things."""


@dataclass(frozen=True)
class Sweep:
    """One scan: when, where the robot was by its odometry, and the returns, N x 2, mm in the same frame."""

    t_ms: float
    pose: Pose
    returns: Floats


@dataclass(frozen=True)
class Drive:
    """One recorded drive. field_deg: from which to which bearing of the robot its laser looks."""

    name: str
    sweeps: tuple[Sweep, ...]
    field_deg: tuple[float, float]

    @property
    def end_ms(self) -> float:
        """Its length."""
        return self.sweeps[-1].t_ms

    def covered(self, table: RobotTable) -> tuple[int, ...]:
        """Return the sonars on whose bearings the laser looks."""
        low, high = self.field_deg
        return tuple(
            n
            for n, mount in enumerate(table.mounts)
            if low - 1 <= (mount.heading_deg - low + 1) % 360 + low - 1 <= high + 1
        )

    def fires(self, table: RobotTable) -> tuple[int, ...]:
        """Return the sonars that there are: arrays that the laser covers whole, else what it covers."""
        covered = self.covered(table)
        whole = [n for order in table.orders if set(order) <= set(covered) for n in order]
        return tuple(sorted(whole)) or covered


def _sweep(line: Mapping[str, Any], begin_s: float) -> tuple[Sweep, tuple[float, float]]:
    heading = float(line["heading"])
    x, y, yaw = line["laser"]
    first, step = line["angles"]
    mm = np.array(line["mm"], dtype=np.float64)
    bearings = yaw + first + step * np.arange(len(mm))
    echo = mm > 0
    on_x = x * 1000 + mm[echo] * np.cos(bearings[echo])
    on_y = y * 1000 + mm[echo] * np.sin(bearings[echo])
    c, s = math.cos(heading), math.sin(heading)
    at_x, at_y = float(line["x"]) * 1000, float(line["y"]) * 1000
    points = np.column_stack((at_x + on_x * c - on_y * s, at_y + on_x * s + on_y * c))
    ends = sorted(map(math.degrees, (yaw + first, yaw + first + step * (len(mm) - 1))))
    sweep = Sweep((float(line["t"]) - begin_s) * 1000, Pose(at_x, at_y, math.degrees(heading)), points)
    return sweep, (ends[0], ends[1])


def read_drive(path: Path, most_s: float) -> Drive:
    """Return the longest stretch without a gap, up to so many seconds of it; SimError where there is no drive."""
    command = [sys.executable, *READER, str(path)]
    best: list[Sweep] = []
    sweeps: list[Sweep] = []
    field, begin_s = (0.0, 0.0), math.nan
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    for line in map(json.loads, done.stdout.splitlines()):
        begin_s = line["t"] if not sweeps else begin_s
        sweep, field = _sweep(line, begin_s)
        since_ms = sweep.t_ms - sweeps[-1].t_ms if sweeps else 1.0
        if not -GAP_MS < since_ms < GAP_MS:
            best, sweeps = max(best, sweeps, key=len), []
        elif since_ms > 0 and sweep.t_ms <= most_s * 1000:
            sweeps.append(sweep)
    best = max(best, sweeps, key=len)
    if len(best) < 2:
        said = done.stderr.strip()
        raise SimError(said.splitlines()[-1] if said else f"{path.name}: no drive of two scans or more in it")
    return Drive(path.name, tuple(best), field)


def drive_files(folder: Path) -> list[Path]:
    """Return what may be recordings in a folder: files, and bags of ROS 2, which are folders."""
    if not folder.is_dir():
        raise SimError(f"{folder}: no such folder; --bags takes one with recordings")
    bags = sorted({path.parent for path in folder.rglob("metadata.yaml")})
    files = [
        path
        for path in sorted(folder.rglob("*"))
        if path.suffix in _FORMS and path.is_file() and path.parent not in bags
    ]
    return [*bags, *files]


class ScanEchoes(EchoModel):
    """What sonars hear of a scan: the nearest return within the cone, or a thing that the laser looks over."""

    def __init__(self, params: SonarParams, table: RobotTable) -> None:
        super().__init__(World("scans", np.zeros((0, 4)), np.zeros(0)), params, table, in_c=False)
        self._mounts = table.mounts
        self.points: Floats = np.zeros((0, 2))

    def ping_mm(
        self,
        number: int,
        pose: Pose,
        angle_deg: float = 0.0,
        moving: MovingEchoes | None = None,
        gain_db: float = 0.0,
    ) -> int:
        """Return what a sonar of a robot at `pose` reads, its axis turned by `angle_deg`."""
        del moving, gain_db  # a scan has all that is there
        at = transducer_pose(self._mounts[number], pose)
        dx, dy = self.points[:, 0] - at.x_mm, self.points[:, 1] - at.y_mm
        heading = math.radians(at.heading_deg + angle_deg)
        along = dx * math.cos(heading) + dy * math.sin(heading)
        far = np.hypot(dx, dy)
        seen = far[along >= far * math.cos(math.radians(self.params.cone_deg / 2))]
        nearest = float(seen.min()) if seen.size else float(NO_ECHO_MM)
        return min(NO_ECHO_MM, max(MIN_MM, round(nearest)))

    def bounce_mm(
        self, number: int, pose: Pose, angle_deg: float = 0.0, moving: MovingEchoes | None = None
    ) -> int | None:
        """Return None: a scan does not tell what mirrors."""
        del number, pose, angle_deg, moving
        return None


class _Ring(SonarRing):
    """A ring whose world is another one with each scan."""

    def true_range(self, number: int, pose: Pose) -> int:
        """Return what a sonar reads at a pose without noise, crosstalk and faults."""
        return self._measure(number, pose, 0.0)


def low_things(drive: Drive, share: float, rng: np.random.Generator) -> Floats:
    """Return places of things below the laser's plane, before a share of the patches that it sees, off the way."""
    patch_mm = float(load("recorded")["silence"]["patch_mm"])
    way = np.array([sweep.pose[:2] for sweep in drive.sweeps])
    known: set[tuple[int, int]] = set()
    found = []
    for sweep in drive.sweeps[::LOW_LOOK]:
        here = np.array(sweep.pose[:2])
        for place in sweep.returns:
            cell = (math.floor(place[0] / patch_mm), math.floor(place[1] / patch_mm))
            away = place - here
            far_mm = float(np.hypot(*away))
            if cell in known or far_mm > NO_ECHO_MM:
                continue
            known.add(cell)
            drawn, before = rng.random(), rng.uniform(*LOW_FROM_MM)
            at = place - away / max(far_mm, 1.0) * before
            if drawn < share and far_mm > before and np.hypot(*(way - at).T).min() > LOW_CLEAR_MM:
                found.append(at)
    return np.array(found, dtype=np.float64).reshape(-1, 2)


@dataclass
class _Way:
    """Where the robot is at a time, between its scans."""

    drive: Drive

    def __post_init__(self) -> None:
        self._times = [sweep.t_ms for sweep in self.drive.sweeps]

    def sweep(self, t_ms: float) -> Sweep:
        """Return the last scan before a time."""
        return self.drive.sweeps[max(0, bisect_right(self._times, t_ms) - 1)]

    def pose(self, t_ms: float) -> Pose:
        """Return the pose at a time."""
        k = min(max(1, bisect_right(self._times, t_ms)), len(self._times) - 1)
        a, b = self.drive.sweeps[k - 1], self.drive.sweeps[k]
        part = min(1.0, max(0.0, (t_ms - a.t_ms) / (b.t_ms - a.t_ms)))
        turn = math.remainder(b.pose.heading_deg - a.pose.heading_deg, 360)
        return Pose(
            a.pose.x_mm + part * (b.pose.x_mm - a.pose.x_mm),
            a.pose.y_mm + part * (b.pose.y_mm - a.pose.y_mm),
            a.pose.heading_deg + part * turn,
        )


def _motion(before: Pose, pose: Pose) -> tuple[int, int, int, int, int]:
    turn = math.remainder(pose.heading_deg - before.heading_deg, 360)
    middle = math.radians(before.heading_deg + turn / 2)
    along = (pose.x_mm - before.x_mm) * math.cos(middle) + (pose.y_mm - before.y_mm) * math.sin(middle)
    per_s = 1000 / STEP_MS
    heading = (round(pose.heading_deg * 100) + 18_000) % 36_000 - 18_000
    return round(pose.x_mm), round(pose.y_mm), heading, round(along * per_s), round(turn * per_s * 100)


class Run:
    """One drive with one fault, or none, through a fault manager that only listens."""

    def __init__(self, drive: Drive, fault: str, seed: int) -> None:
        self.drive, self._way = drive, _Way(drive)
        table = robot_table()
        word = zlib.crc32(drive.name.encode())
        rngs = [np.random.default_rng([seed, word, k]) for k in range(4)]
        physics = SETS["recorded"]
        self._faults = NotedFaults([parse_fault(fault)] if fault else [], rngs[0])
        self._echoes = ScanEchoes(SonarParams(), table)
        rough = Roughness(physics, table.sonars, rngs[1], hears_all=True)
        self._low = low_things(drive, float(load("recorded")["near"]["below_laser"]), rngs[2])
        self._ring = _Ring(
            World("scans", np.zeros((0, 4)), np.zeros(0)), SonarParams(), self._faults, rngs[3],
            robot=table, echoes=self._echoes, rough=rough,
        )  # fmt: skip
        self._fires = drive.fires(table)
        self._ring.enabled = [any(n in self._fires for n in order) for order in table.orders]
        self._ring.set_polling([n + 1 for n in self._fires])
        self._core = Core(0, {**SETTINGS, "robot": setting_value("robot", table.subclass)})
        self._core.link_up(0)
        self._health = [("", "")] * table.sonars
        self.changes: list[Change] = []
        self.rows: list[tuple[int, int, int, int, int]] = []
        self.travelled_mm = 0.0

    def go(self) -> Verdict:
        """Drive it to its end, or until the fault has shown for long enough; return the verdict."""
        before, t_ms = self._way.pose(0.0), 0
        while t_ms + STEP_MS <= self.drive.end_ms and not self._has_shown(t_ms):
            t_ms += STEP_MS
            pose = self._way.pose(t_ms)
            self.travelled_mm += math.hypot(pose.x_mm - before.x_mm, pose.y_mm - before.y_mm)
            self._faults.update(t_ms, pose, self.travelled_mm)
            self._echoes.points = np.concatenate((self._way.sweep(t_ms).returns, self._low))
            readings = self._ring.advance(t_ms, self._way.pose)
            self._tell(t_ms, _motion(before, pose), readings)
            before = pose
        return judge_changes(self._stream(t_ms), self.changes)

    def _tell(self, t_ms: int, motion: tuple[int, int, int, int, int], readings: Sequence[Reading]) -> None:
        heard = [(one.number, one.range_mm, round(t_ms - one.t_ms)) for one in readings]
        self._core.observe(t_ms, motion, heard)
        self._core.process(t_ms)
        self._core.transmit()
        for _ in self._core.events():
            pass
        self.rows += [
            (r.number, r.range_mm, r.true_mm, int(r.fault is not None), round(r.t_ms)) for r in readings
        ]
        status = self._core.status()
        for number, now in enumerate(zip(status["health"], status["kind"], strict=True)):
            if number in self._fires and now != self._health[number]:
                self._health[number] = now
                self.changes.append(Change(t_ms / 1000, number, *now))

    def _has_shown(self, t_ms: int) -> bool:
        first = [truth.first_visible_s for truth in self._faults.truth]
        return bool(first) and all(at is not None and t_ms / 1000 >= at + AFTER_S for at in first)

    def _stream(self, t_ms: int) -> Stream:
        return Stream(
            id=self.drive.name,
            times_ms=np.zeros(0, dtype=np.uint32),
            lengths=np.zeros(0, dtype=np.uint16),
            data=b"",
            readings=np.array(self.rows, dtype=np.int32).reshape(-1, 5),
            truth=tuple(self._faults.truth),
            people=False,
            place="room",
            driving_s=t_ms / 1000,
            end_s=t_ms / 1000,
        )


def way_mm(drive: Drive) -> float:
    """Return how far a drive goes."""
    points: Floats = np.array([sweep.pose[:2] for sweep in drive.sweeps])
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def faults_of(drive: Drive, kinds: Iterable[str], seed: int, variants: Mapping[str, Any]) -> list[str]:
    """Return a fault of each kind: of a sonar that is covered, from a place in the first half of the way."""
    table = robot_table()
    fires, whole_mm = drive.fires(table), way_mm(drive)
    texts = []
    for kind in kinds:
        rng = np.random.default_rng([seed, zlib.crc32(drive.name.encode()), zlib.crc32(kind.encode())])
        if kind == "free":
            texts.append("")
            continue
        rows = variants[kind]
        _, parameter = rows[(seed + zlib.crc32(drive.name.encode())) % len(rows)]
        parameter = f"value={int(rng.integers(300, 4000))}" if parameter == "value" else parameter
        onset = rng.uniform(0.1, 0.5) * whole_mm
        sonar = int(rng.choice(fires))
        texts.append(f"{kind}:{sonar}@travelled>{onset:.0f}" + (f":{parameter}" if parameter else ""))
    return texts
