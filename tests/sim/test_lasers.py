# SPDX-License-Identifier: MIT
"""Rule: each fault of a laser is found in a simulated drive, and nothing is said of a sound one."""

from __future__ import annotations

import math

import numpy as np
import pytest
from doubles import Session, cmd, sips

from hil_sim.bench.lasers import RINGS, drive, found_ms
from hil_sim.faults.grammar import parse_fault
from hil_sim.laser.faults import FAULTS
from hil_sim.laser.scan import Beams, Laser, cast, laser_of, scan
from hil_sim.scenario.build import build_robot
from hil_sim.scenario.scenario import Scenario
from hil_sim.server.server import ArcosServer
from hil_sim.sil import Mission, run
from hil_sim.tables.robot import robot_table
from hil_sim.world.files import load_world

ALONE = str(RINGS / "laser.toml")
SECTORS = range(15)


def test_a_beam_ends_at_the_nearest_solid() -> None:
    world = load_world("office")
    found = cast(world, world.start.x_mm, world.start.y_mm, np.radians([0.0, 90.0, 180.0]))
    assert np.isfinite(found).all()
    for far, bearing in zip(found, (0.0, math.pi / 2, math.pi), strict=True):
        x = world.start.x_mm + far * math.cos(bearing)
        y = world.start.y_mm + far * math.sin(bearing)
        x1, y1, x2, y2 = world.segments.T
        ex, ey = x2 - x1, y2 - y1
        along = np.clip(((x - x1) * ex + (y - y1) * ey) / (ex**2 + ey**2), 0, 1)
        assert np.hypot(x1 + along * ex - x, y1 + along * ey - y).min() < 1


def test_a_sector_takes_its_nearest_beam() -> None:
    table = robot_table(ALONE)
    ranges = np.full(181, np.inf)
    ranges[90 + 14] = 1234.0
    found = Beams(table, Laser().angles).nearest(ranges)
    assert {k: mm for k, mm in found.items() if np.isfinite(mm)} == {6: 1234.0}
    assert table.mounts[6].heading_deg == 12


@pytest.mark.parametrize("ring", ["laser", "sonars-laser"])
def test_nothing_is_said_of_a_sound_one(ring: str) -> None:
    outcome = drive(str(RINGS / f"{ring}.toml"), "gen-office", 1, 60.0)
    assert not outcome.named, "gen-office 1"
    assert outcome.laser_ms is None


@pytest.mark.parametrize("fault", ["dead", "dark", "frozen", "late1s"])
def test_what_is_plain_is_found_in_time(fault: str) -> None:
    after = found_ms(drive(ALONE, "gen-room", 1, 40.0, fault), SECTORS)
    assert after is not None, "gen-room 1"
    assert after <= FAULTS[fault][1] * 1000


@pytest.mark.parametrize(("fault", "value"), [("yaw10", 5), ("scale0.9", 6)])
def test_what_takes_way_is_found(fault: str, value: int) -> None:
    outcome = drive(ALONE, "gen-room", 1, 80.0, fault)
    assert outcome.laser == value, "gen-room 1"
    assert outcome.laser_ms is not None
    assert outcome.laser_ms <= 80_000


def test_a_laser_bears_witness_against_a_dead_sonar() -> None:
    outcome = drive(str(RINGS / "sonars-laser.toml"), "gen-corridor", 2, 30.0, dead=(0,))
    assert set(outcome.named) == {0}, "gen-corridor 2"
    assert outcome.named[0] <= 20_000 + 3_000


@pytest.mark.parametrize(("world", "seconds"), [("gen-corridor", 130.0), ("gen-clutter", 100.0)])
def test_a_laser_names_no_healthy_sonar(world: str, seconds: float) -> None:
    # What is at the rim of a cone a laser returns and a sonar may miss.
    assert drive(str(RINGS / "sonars-laser.toml"), world, 2, seconds).named == {}, f"{world} 2"


def emulated(ring: str, *faults: str) -> Session:
    """A client of a robot whose ring has a laser, in an office."""
    name = str(RINGS / f"{ring}.toml")
    table = robot_table(name)
    scenario = Scenario(
        world="office", robot=name, faults=tuple(parse_fault(text, table) for text in faults), seed=46
    )
    world = load_world("office")
    session = Session(ArcosServer(build_robot(scenario, world, world.start, None)))
    session.connect()
    return session


@pytest.mark.parametrize(("ring", "first"), [("laser", 0), ("sonars-laser", 16)])
def test_a_sip_has_the_sectors_of_the_scan_of_its_moment(ring: str, first: int) -> None:
    session = emulated(ring)
    world, table = load_world("office"), robot_table(str(RINGS / f"{ring}.toml"))
    for sip in sips(session.run(500)):
        sectors = {number: mm for number, mm in sip.sonars if number >= first}
        assert list(sectors) == list(table.sectors)
        laser = laser_of(table)
        true = Beams(table, laser.angles).nearest(scan(laser, world, world.start, np.random.default_rng(1)))
        for number, mm in sectors.items():
            assert mm == pytest.approx(min(true[number], 5000), abs=100), f"sector {number}, seed 46"


def test_a_laser_whose_arrays_are_off_is_silent() -> None:
    session = emulated("sonars-laser")
    session.send(cmd("SONAR", 0))
    assert all(not sip.sonars for sip in sips(session.run(500))[1:])


def test_a_sector_has_the_faults_of_a_sonar() -> None:
    session = emulated("sonars-laser", "off:20", "stuck:25:value=777")
    last = dict(sips(session.run(500))[-1].sonars)
    assert (last[20], last[25]) == (5000, 777)


def test_a_mission_with_a_laser_gets_there_with_nothing_named() -> None:
    world = load_world("office")
    goal = (world.start.x_mm + 2500.0, world.start.y_mm)
    outcome = run(Mission("office", (goal,), robot=str(RINGS / "sonars-laser.toml"), seed=46, baud=57_600))
    assert outcome.reached, "seed 46"
    assert not any(event.name in ("SONAR_NAMED", "LASER_FAULT") for event in outcome.events), "seed 46"
