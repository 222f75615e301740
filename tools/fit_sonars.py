#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fit how real sonars behave to recordings: makes the table that `physics = recorded` draws from."""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np

ROOT: Final = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tools")]

from argus_tools.chunks import DamageList, LogError  # noqa: E402
from argus_tools.rings.dated import Dated  # noqa: E402
from argus_tools.rings.intake import Odd  # noqa: E402
from argus_tools.rings.plan import Place, Plan, planned  # noqa: E402
from argus_tools.rings.recording import Bag, Broken  # noqa: E402
from argus_tools.rings.sensors import ARRAYS, CLOUD, CLOUD2, SCAN, Scan  # noqa: E402

from hil_sim.sonar.echo import EchoModel  # noqa: E402
from hil_sim.sonar.params import NO_ECHO_MM, SonarParams, transducer_pose  # noqa: E402
from hil_sim.tables.robot import robot_table  # noqa: E402
from hil_sim.world.files import load_world  # noqa: E402
from hil_sim.world.model import Pose  # noqa: E402

TABLE: Final = ROOT / "hil_sim/tables/recorded.toml"
ROUND_S: Final = 0.32
"""Each sonar fires once in such a round; drivers repeat its value in between."""
FIRINGS_LEAST: Final = 8
STILL_M_S: Final = 0.005
STILL_RAD_S: Final = 0.01
HEARD_MM: Final = 4600
"""Nearer than this a sonar should hear what a laser sees in its cone."""
CONE_DEG: Final = 15.0
NEARER_MM: Final = 300
NEAR_SHARE: Final = 0.01
PATCH_MM: Final = 600
LEAST_MM: Final = 500
PLACE_MM: Final = 100
PLACE_DEG: Final = 5
EPILOG: Final = """examples:
  tools/fit_sonars.py --bags lab.bag corner.bag --stops map_1.json                print what is measured
  tools/fit_sonars.py --bags lab.bag corner.bag --stops map_1.json --write        and make it the table

--bags: ROS 1 or ROS 2 bags with the ring of a P3-DX, as argus-log reads them; with odometry what is measured at rest
is taken where the robot stands, without it the robot is taken to stand. With a laser on the robot they also tell how
often a sonar is silent. --stops: JSON, a list of objects, each of one stop: "sonar": a point for each sonar, x and y
in m in the robot's axes, "scan": ranges of a laser in m, evenly from -90 to 90 degrees, null for no return.
The model's own share of silence is measured in the worlds office and lab and taken off.

exit codes: 0 done, 2 wrong argument or file"""


@dataclass
class Rest:
    """The firings of one sonar that stands, mm."""

    where: str
    values: list[int] = field(default_factory=list)


@dataclass
class Found:
    """What the recordings hold. pairs: sonar, its reading, and what the laser sees in its cone, mm."""

    rests: list[Rest] = field(default_factory=list)
    pairs: list[tuple[int, float, float]] = field(default_factory=list)


# ---- reading


def _rings(bag: Bag) -> Iterator[str]:
    """Yield one topic of sonars for each robot of a bag."""
    seen = set()
    for kinds in (ARRAYS, (CLOUD,), (CLOUD2,)):
        for topic in bag.topics:
            robot = topic.name.rpartition("/")[0]
            if topic.type in kinds and topic.count and robot not in seen:
                seen.add(robot)
                yield topic.name


def read_bag(path: Path, found: Found) -> None:
    """Add what a bag holds."""
    bag = Bag(path, path.suffix == ".bag", path.name)
    try:
        for topic in _rings(bag):
            try:
                plan = planned(bag, path.name, topic, None)
            except LogError as error:
                print(f"fit_sonars: {error}; passed over", file=sys.stderr)
                continue
            _read_ring(bag, plan, found, f"{path.name} {topic}")
    finally:
        bag.close()


def _read_ring(bag: Bag, plan: Plan, found: Found, where: str) -> None:
    robot = plan.topics[0].split("/")[:2]
    lasers = [one.name for one in bag.topics if one.type == SCAN and one.name.split("/")[:2] == robot]
    rests = {number: Rest(f"{where} sonar {number}") for number in plan.present}
    place, scan, seen, last_s = Place(plan), None, {}, -math.inf
    corrected = DamageList()
    try:
        wanted = [*plan.topics, *lasers[:1], *filter(None, [plan.odometry])]
        for message, _ in Dated(bag.messages(wanted), plan.topics[:1], corrected):
            try:
                if message.topic == plan.odometry:
                    place.take(message)
                elif message.type == SCAN:
                    scan = scan or Scan([message], plan.table, plan.frames)
                    seen = scan.take(message)
                elif message.t - last_s >= ROUND_S - 0.02:
                    last_s = message.t
                    _take(plan, place, rests, seen, found, message)
            except Odd:
                continue
    except Broken as error:
        print(f"fit_sonars: {where}: {error}; the rest is not read", file=sys.stderr)
    for one in corrected:
        print(f"fit_sonars: {where}: {one.place}: {one.what}", file=sys.stderr)
    found.rests += [rest for rest in rests.values() if len(rest.values) >= FIRINGS_LEAST]


def _take(
    plan: Plan, place: Place, rests: dict[int, Rest], seen: dict[int, float], found: Found, message: Any
) -> None:
    motion = place.motion
    still = abs(motion.speed_m_s) <= STILL_M_S and abs(motion.turn_rad_s) <= STILL_RAD_S
    for number, range_m in plan.sensors.take(message).items():
        reading = plan.silence.millimetres(range_m)
        if reading is None:
            continue
        if still:
            rests[number].values.append(reading)
        if not still and math.isfinite(seen.get(number, math.inf)):
            found.pairs.append((number, reading, seen[number] * 1000))


def read_stops(path: Path, found: Found) -> None:
    """Add what a file of stops holds."""
    mounts = robot_table().mounts
    for stop in json.loads(path.read_text(encoding="utf-8")):
        scan = np.array([math.inf if one is None else float(one) for one in stop["scan"]]) * 1000
        angles = np.radians(np.linspace(-90, 90, len(scan)))
        near = np.isfinite(scan) & (scan > 0)
        x, y = scan[near] * np.cos(angles[near]) + LASER_X_MM, scan[near] * np.sin(angles[near])
        for number, (px, py) in enumerate(stop["sonar"][: len(mounts)]):
            mount = mounts[number]
            if (px, py) == (0, 0):
                continue
            off = np.degrees(np.arctan2(y - mount.y_mm, x - mount.x_mm)) - mount.heading_deg
            cone = np.abs((off + 180) % 360 - 180) <= CONE_DEG
            if cone.any():
                laser = float(np.hypot(x - mount.x_mm, y - mount.y_mm)[cone].min())
                reading = math.hypot(px * 1000 - mount.x_mm, py * 1000 - mount.y_mm)
                found.pairs.append((number, reading, laser))


LASER_X_MM: Final = 160.0
"""Where a laser stands on the deck of a P3-DX, ahead of its centre."""


# ---- fitting


def _echoes(rests: Sequence[Rest]) -> list[np.ndarray[Any, Any]]:
    """Return the ranges of each sonar that heard one thing all the time."""
    arrays = [np.array(rest.values) for rest in rests]
    return [one for one in arrays if one.max() < NO_ECHO_MM]


def _step_mm(echoes: Sequence[np.ndarray[Any, Any]]) -> float:
    """Return how far the clusters of a sonar at rest are apart: leaps of more than a mm or two, each of one step."""
    leaps = np.abs(np.concatenate([np.diff(one) for one in echoes]))
    leaps = leaps[(leaps >= 2) & (leaps <= 5)]
    return float(leaps.mean()) if leaps.size else 0.0


def _fit_rest(rests: Sequence[Rest]) -> dict[str, Any]:
    echoes = _echoes(rests)
    if not echoes:
        raise LogError("no sonar that stands and hears something all the time; record for 3 s at rest")
    step_mm = _step_mm(echoes)
    low = [one - np.median(one) for one in echoes]
    within = [np.abs(one) < step_mm / 2 for one in low]
    same = np.concatenate([np.diff(one) == 0 for one in echoes])
    return {
        "jitter_mm": sorted(round(float(one[ok].std()), 2) for one, ok in zip(low, within, strict=True)),
        "late": sorted(round(float(1 - ok.mean()), 2) for ok in within),
        "step_mm": round(step_mm, 2),
        "repeats": round(float(same.mean()), 2),
        "spread_mm": round(float(np.median([one.std() for one in echoes])), 2),
        "firings": len(same),
    }


def _fit_silence(pairs: Sequence[tuple[int, float, float]]) -> dict[str, Any]:
    rows = np.array([pair for pair in pairs if pair[2] < HEARD_MM]).reshape(-1, 3)
    if not len(rows):
        raise LogError("no reading beside one of a laser; give --stops, or bags of a drive with a laser")
    silent = rows[:, 1] >= NO_ECHO_MM - 10
    heard = rows[~silent]
    numbers = sorted(set(rows[:, 0].astype(int)))
    return {
        "by_sonar": [round(float(silent[rows[:, 0] == n].mean()), 2) for n in numbers],
        "all": round(float(silent.mean()), 2),
        "nearer": round(float((heard[:, 1] < heard[:, 2] - NEARER_MM).mean()), 2) if len(heard) else 0.0,
        "readings": len(rows),
    }


def model_silence(worlds: Sequence[str] = ("office", "lab"), poses: int = 300, seed: int = 1) -> float:
    """Return how often the plain model is silent where a laser would see something in the cone, nearer than 4.6 m."""
    rng, table = np.random.default_rng(seed), robot_table()
    silent = []
    for name in worlds:
        world = load_world(name)
        all_heard = SonarParams(margin_db=100, tip_db=0, edge_db=0, specular=False)
        echoes, laser = EchoModel(world, SonarParams()), EchoModel(world, all_heard)
        low_x, low_y, high_x, high_y = world.bounds
        for _ in range(poses):
            pose = Pose(rng.uniform(low_x, high_x), rng.uniform(low_y, high_y), rng.uniform(-180, 180))
            for number, mount in enumerate(table.mounts):
                at = transducer_pose(mount, pose)
                if laser.range_mm(at.x_mm, at.y_mm, at.heading_deg) < HEARD_MM:
                    silent.append(echoes.ping_mm(number, pose) >= NO_ECHO_MM)
    return round(float(np.mean(silent)), 2)


def _list(values: Sequence[float]) -> str:
    return "[" + ", ".join(f"{value:g}" for value in values) + "]"


def table_text(rest: dict[str, Any], silence: dict[str, Any], model: float, bound: float) -> str:
    """Return the table."""
    return f"""# SPDX-License-Identifier: MIT
# How sonars of real P3-DX behave, by tools/fit_sonars.py, which writes this file; the recordings are in docs/worlds.md.

[rest]
# Of each sonar that stood and heard one thing: standard deviation within a step; share of the pings that are later.
jitter_mm = {_list(rest["jitter_mm"])}
late = {_list(rest["late"])}
# From one cluster of its readings to the next: half a wave of 50 kHz, by which a weak echo is found later.
step_mm = {rest["step_mm"]:g}
# What these come to: share of the firings that read the same mm as the one before; median standard deviation.
repeats = {rest["repeats"]:g}
spread_mm = {rest["spread_mm"]:g}
firings = {rest["firings"]}

[silence]
# Of each sonar: share of the readings without an echo although a laser sees something nearer than 4.6 m in its cone.
by_sonar = {_list(silence["by_sonar"])}
all = {silence["all"]:g}
readings = {silence["readings"]}
# The same of the plain model, in the worlds office and lab: so much of it needs no drawing.
model = {model:g}
# Our choice: surfaces are alike in patches of this size; nearer than the second nothing is missed.
patch_mm = {PATCH_MM}
heard_mm = {LEAST_MM}

[near]
# Our choice: share of the places at which a sonar hears something nearer that no other sees. At rest none did in
# {rest["firings"]} firings, so it is at most {100 * bound:.1f} % there (95 %).
share = {NEAR_SHARE:g}
# A place is so large.
place_mm = {PLACE_MM}
place_deg = {PLACE_DEG}
# Share of the echoes that are more than 300 mm shorter than the laser: things below its plane, in worlds solids.
below_laser = {silence["nearer"]:g}
"""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the program; return its exit code."""
    options = argparse.ArgumentParser(
        prog="fit_sonars.py", description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    options.add_argument(
        "--bags", nargs="+", type=Path, default=[], metavar="BAG", help="recordings of rings"
    )
    options.add_argument(
        "--stops", nargs="+", type=Path, default=[], metavar="JSON", help="stops with a laser"
    )
    options.add_argument("--write", action="store_true", help=f"write {TABLE.relative_to(ROOT)}")
    arguments = options.parse_args(argv)
    found = Found()
    try:
        for path in arguments.bags:
            read_bag(path, found)
        for path in arguments.stops:
            read_stops(path, found)
        rest, silence = _fit_rest(found.rests), _fit_silence(found.pairs)
    except (LogError, OSError, ValueError, KeyError, TypeError) as error:
        print(f"fit_sonars: {error}", file=sys.stderr)
        return 2
    text = table_text(rest, silence, model_silence(), 3 / rest["firings"])
    if arguments.write:
        TABLE.write_text(text, encoding="utf-8")
    print(text, end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
