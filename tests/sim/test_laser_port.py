# SPDX-License-Identifier: MIT
"""Rule: a client that asks for the simulated laser gets a scan of what is there behind each SIP."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest
from doubles import Session, cmd, make_robot

from hil_sim.arcos import (
    COMMAND,
    FRAME,
    TYPE,
    Command,
    PacketError,
    SimLaser,
    Unframer,
    decode,
    frame,
)
from hil_sim.laser.scan import Laser
from hil_sim.laser.scanner import Scanner
from hil_sim.server.laser import PART
from hil_sim.server.mobilesim import MobileSimServer
from hil_sim.server.server import ArcosServer
from hil_sim.world.model import World
from hil_sim.world.movers import Person
from hil_sim.world.moving import MovingSolids

BOX = np.array(
    [(-3000, -2000, 4000, -2000), (4000, -2000, 4000, 2500), (4000, 2500, -3000, 2500)], dtype=float
)
"""Walls on the right, ahead and on the left of a robot at the origin; none behind."""
FAR_MM = 32_000
ASK = ("SIM_LRF_SET_FOV_START", "SIM_LRF_SET_FOV_END", "SIM_LRF_SET_RES", "SIM_LRF_ENABLE")
FORERUNNER = bytes.fromhex("fafb06241b5a007e1bfafb06253b5a007f3bfafb06263b64008a3bfafb06233b0200253b")
"""What ARIA asks for before it takes a scan: 36 -90, 37 90, 38 100, 35 2."""


def new(kind: type[ArcosServer] = ArcosServer, moving: MovingSolids | None = None) -> Session:
    world = World("box", BOX, np.ones(3))
    scanner = Scanner(Laser(most_mm=FAR_MM), world, moving, np.random.default_rng(46))
    session = Session(kind(make_robot(), scanner=scanner))
    session.connect()
    return session


def parts_after(session: Session, ms: int = 100) -> list[SimLaser]:
    return [packet for packet in session.run(ms) if isinstance(packet, SimLaser)]


def joined(parts: list[SimLaser]) -> list[int]:
    """The ranges of one scan, which its parts hold in their order."""
    ranges: list[int] = []
    for part in parts:
        assert part.first == len(ranges)
        assert part.total == parts[0].total
        assert 1 <= len(part.ranges) <= PART
        assert len(part.data) + FRAME["OVERHEAD"] + 2 <= FRAME["SEND_TOTAL_MAX"]
        ranges += part.ranges
    assert len(ranges) == parts[0].total
    return ranges


def truth(bearing_deg: float) -> float:
    """How far the box is from where the laser stands."""
    x_mm = Laser().x_mm
    cos, sin = math.cos(math.radians(bearing_deg)), math.sin(math.radians(bearing_deg))
    ways = [
        (4000 - x_mm) / cos if cos > 1e-9 else math.inf,
        (2500 if sin > 0 else -2000) / sin if abs(sin) > 1e-9 else math.inf,
    ]
    return min(ways)


def test_nobody_gets_a_scan_unasked_nor_after_it_is_off() -> None:
    session = new()
    assert parts_after(session, 500) == []
    session.send(cmd("SIM_LRF_ENABLE", 1))
    assert len(parts_after(session, 300)) == 3 * math.ceil(181 / PART)
    session.send(cmd("SIM_LRF_ENABLE", 0))
    assert parts_after(session, 500) == []


def test_a_scan_is_of_the_truth_from_right_to_left() -> None:
    session = new()
    session.send(cmd("SIM_LRF_ENABLE", 1))
    ranges = joined(parts_after(session))
    assert len(ranges) == 181
    for n, mm in enumerate(ranges):
        assert mm == pytest.approx(truth(n - 90), abs=60), f"beam {n}, seed 46"


def test_the_plain_form_has_the_place_by_odometry_and_the_extended_one_what_reflects() -> None:
    session = new()
    session.server.robot.drive.set_odometry(-1234, 567, 90)
    session.send(cmd("SIM_LRF_ENABLE", 1))
    plain = parts_after(session)[0]
    assert plain.place == (-1234, 567, 90)
    assert plain.data[:1] == bytes((TYPE["SIMLASER"],))
    session.send(cmd("SIM_LRF_ENABLE", 2))
    extended = parts_after(session)[0]
    assert extended.place is None
    assert extended.data[:1] == bytes((TYPE["SIMLASER2"],))
    assert extended.reflectance == (0,) * PART
    assert extended.rest == bytes(2)


@pytest.mark.parametrize(
    ("start", "end", "step", "bearings"),
    [
        (-90, 90, 50, [n / 2 - 90 for n in range(361)]),
        (-30, 30, 1000, [-30, -20, -10, 0, 10, 20, 30]),
        (30, -30, 1000, [30, 20, 10, 0, -10, -20, -30]),
        (0, 45, 700, [0, 7, 14, 21, 28, 35, 42]),
    ],
)
def test_field_and_step_are_those_asked_for(start: int, end: int, step: int, bearings: list[float]) -> None:
    session = new()
    session.send(*(cmd(name, value) for name, value in zip(ASK, (start, end, step, 1), strict=True)))
    ranges = joined(parts_after(session))
    assert len(ranges) == len(bearings)
    for mm, bearing in zip(ranges, bearings, strict=True):
        assert mm == pytest.approx(truth(bearing), abs=60), f"{bearing} degrees, seed 46"


def test_nothing_returned_is_the_greatest_range() -> None:
    session = new()
    session.send(
        cmd("SIM_LRF_SET_FOV_START", -180), cmd("SIM_LRF_SET_FOV_END", 180), cmd("SIM_LRF_ENABLE", 1)
    )
    ranges = joined(parts_after(session))
    assert len(ranges) == 361
    assert ranges[0] == ranges[360] == FAR_MM


@pytest.mark.parametrize("step", [0, -100])
def test_a_step_that_is_none_changes_nothing(step: int) -> None:
    session = new()
    session.send(cmd("SIM_LRF_SET_RES", step), cmd("SIM_LRF_ENABLE", 1))
    assert len(joined(parts_after(session))) == 181


def test_an_ended_session_ends_the_scans_and_what_was_set() -> None:
    session = new()
    session.send(cmd("SIM_LRF_SET_RES", 1000), cmd("SIM_LRF_ENABLE", 1))
    assert len(joined(parts_after(session))) == 19
    session.send(cmd("CLOSE"))
    session.connect()
    assert parts_after(session) == []
    session.send(cmd("SIM_LRF_ENABLE", 1))
    assert len(joined(parts_after(session))) == 181


def test_a_scan_sees_who_walks_there() -> None:
    stands = Person(path=((1500.0, 0.0), (1501.0, 0.0)), delay=1000.0)
    session = new(moving=MovingSolids([stands]))
    session.send(cmd("SIM_LRF_ENABLE", 1))
    assert joined(parts_after(session))[90] < 1500


def test_what_aria_sends_starts_the_vendor_emulators_laser_and_no_robots() -> None:
    session = new(MobileSimServer)
    assert Unframer().feed(FORERUNNER)[0] == Command.integer(COMMAND["GRIPPERVAL"], -90).data
    session.send(FORERUNNER)
    parts = parts_after(session)
    assert len(joined(parts)) == 181
    # length, type, ranges in all, first of these, how many; at the end of the scan the rest of them
    assert frame(parts[1].data)[:9] == bytes.fromhex("fafbaa61b500200020")
    assert frame(parts[5].data)[:9] == bytes.fromhex("fafb7361b500a00015")
    robot = new()
    robot.send(FORERUNNER)
    assert parts_after(robot) == []
    assert robot.server.robot.anport == 2


def test_a_robot_without_a_laser_sends_no_scan() -> None:
    for kind in (ArcosServer, MobileSimServer):
        session = Session(kind(make_robot()))
        session.connect()
        session.send(cmd("SIM_LRF_ENABLE", 1), FORERUNNER)
        assert parts_after(session, 300) == []


def test_parts_of_a_scan_round_trip_and_cut_ones_are_refused() -> None:
    rng = random.Random(46)
    for case in range(300):
        ranges = tuple(rng.randrange(1 << 16) for _ in range(rng.randrange(PART + 1)))
        place = tuple(rng.randrange(-32768, 32768) for _ in range(3)) if case % 2 else None
        packet = SimLaser(
            rng.randrange(1 << 16), rng.randrange(1 << 16), ranges,
            place,  # type: ignore[arg-type]
            () if place else tuple(rng.randrange(256) for _ in ranges), rng.randbytes(rng.randrange(3)),
        )  # fmt: skip
        assert decode(packet.data) == packet, f"seed 46, case {case}"
        whole = len(packet.data) - len(packet.rest)
        for end in range(1, whole):
            with pytest.raises(PacketError):
                decode(packet.data[:end])
