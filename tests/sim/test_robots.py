# SPDX-License-Identifier: MIT
"""Rule: the emulator is the robot that its table describes: who it says it is, its body, its sonars and no others."""

from __future__ import annotations

from pathlib import Path

import pytest
from doubles import Session, cmd, sips

from hil_sim.arcos import FLAG, ConfigPac, SyncReply
from hil_sim.cli.arguments import parser
from hil_sim.cli.choose import scenario_of
from hil_sim.errors import SimError
from hil_sim.faults.grammar import parse_fault
from hil_sim.faults.kinds import SonarFault
from hil_sim.robot.robot import Robot
from hil_sim.scenario.build import build_robot
from hil_sim.scenario.scenario import Scenario, load_scenario
from hil_sim.server.server import ArcosServer
from hil_sim.sil import Mission, run
from hil_sim.sonar.params import MIN_MM, NO_ECHO_MM, SonarParams
from hil_sim.tables import load, robots, section
from hil_sim.tables.robot import robot_table
from hil_sim.world.files import load_world
from hil_sim.world.model import Pose

QUIET = SonarParams(noise_mm=0, noise_part=0, crosstalk=0)


def robot_in(name: str, world: str = "hall", *faults: str) -> Robot:
    table = robot_table(name)
    given = tuple(parse_fault(text, table) for text in faults)
    scenario = Scenario(world=world, robot=name, sonar=QUIET, faults=given)
    loaded = load_world(world)
    return build_robot(scenario, loaded, loaded.start, None)


def session_with(robot: Robot) -> Session:
    session = Session(ArcosServer(robot))
    session.connect()
    return session


@pytest.mark.parametrize("name", robots())
def test_it_says_who_it_is_and_what_it_can(name: str) -> None:
    table = robot_table(name)
    server = ArcosServer(robot_in(name))
    session = Session(server)
    session.connect()
    assert SyncReply(table.name.encode(), b"Pioneer", name.encode()) in session.packets
    (config,) = [packet for packet in session.send(cmd("CONFIG")) if isinstance(packet, ConfigPac)]
    motion = section(f"robots/{name}", "motion")
    assert config.subtype == name.encode()
    assert config.trans_vel_top == motion["vel_top_mm_s"]
    assert config.rot_vel_top == motion["rotvel_top_deg_s"]
    assert config.front_bumps == load(f"robots/{name}")["body"]["front_bumpers"]


@pytest.mark.parametrize("name", robots())
def test_every_sonar_of_it_fires_in_turn_and_no_other(name: str) -> None:
    table = robot_table(name)
    session = session_with(robot_in(name))
    heard = sips(session.run(2 * table.refresh_ms + 100))
    fired = [number for sip in heard for number, _ in sip.sonars]
    assert set(fired) == set(range(table.sonars))
    for order in table.orders:
        mine = [number for number in fired if number in order]
        assert mine[: len(order)] == list(order)
    on = sum(FLAG[f"SONAR{k + 1}"] for k in range(len(table.orders)))
    assert heard[-1].flags & (FLAG["SONAR1"] | FLAG["SONAR2"] | FLAG["SONAR3"] | FLAG["SONAR4"]) == on


@pytest.mark.parametrize("name", robots())
def test_every_array_of_it_is_switched_alone(name: str) -> None:
    table = robot_table(name)
    for array in range(4):
        session = session_with(robot_in(name))
        session.send(cmd("SONAR", 2 * (array + 1)))
        session.run(400)
        heard = sips(session.run(400))
        fired = {number for sip in heard for number, _ in sip.sonars}
        off = set(table.orders[array]) if array < len(table.orders) else set()
        assert fired == set(range(table.sonars)) - off, array


@pytest.mark.parametrize("name", robots())
def test_a_fault_of_any_of_its_sonars_works_and_another_is_refused(name: str) -> None:
    table = robot_table(name)
    for number in range(table.sonars):
        session = session_with(robot_in(name, "hall", f"stuck:{number}:value=777"))
        heard = sips(session.run(700))
        readings = {range_mm for sip in heard for sonar, range_mm in sip.sonars if sonar == number}
        assert readings == {777}, number
    for missing in (table.sonars, 32):
        with pytest.raises(SimError, match=f"no sonar of {name}; name 0 to {table.sonars - 1}"):
            parse_fault(f"off:{missing}", table)
    every = {*table.front, *table.rear}
    assert every == set(range(table.sonars))
    assert parse_fault("off:rear", table) == SonarFault("off:rear", "off", table.rear)


@pytest.mark.parametrize("name", robots())
def test_its_own_body_meets_the_wall(name: str, tmp_path: Path) -> None:
    (tmp_path / "wall.yaml").write_text("walls: [{points: [[1000, -3000], [1000, 3000]]}]\n")
    shape = robot_table(name).body
    world = load_world(str(tmp_path / "wall.yaml"))
    scenario = Scenario(world=world.name, robot=name, sonar=QUIET, bumpers=0)
    robot = build_robot(scenario, world, Pose(0.0, 0.0, 0.0), None)
    robot.open()
    robot.enable(True)
    robot.drive.vel(200)
    for _ in range(800):
        robot.heard()
        robot.step()
    assert robot.chassis.collisions == 1
    assert robot.chassis.x + shape.front_mm == pytest.approx(1000, abs=1)
    with pytest.raises(SimError, match="a solid of world"):
        build_robot(scenario, world, Pose(1000 - shape.front_mm + 1, 0.0, 0.0), None)
    build_robot(scenario, world, Pose(1000 - shape.front_mm - 1, 0.0, 0.0), None)


def test_a_sonar_hears_from_where_it_stands() -> None:
    robot = robot_in("amigo-sh", "box-ahead")
    table = robot_table("amigo-sh")
    robot.open()
    readings = {reading.number: reading for reading in robot.ring.fire_all(0, robot.pose)}
    assert set(readings) == set(range(8))
    assert all(MIN_MM <= reading.range_mm <= NO_ECHO_MM for reading in readings.values())
    assert table.forward == (1, 2, 3, 4)


def test_a_robot_is_chosen_by_option_scenario_and_mission(tmp_path: Path) -> None:
    assert scenario_of(parser().parse_args([])).robot == "p3dx-sh"
    assert scenario_of(parser().parse_args(["--robot", "p3at-sh"])).robot == "p3at-sh"
    with pytest.raises(SystemExit):
        parser().parse_args(["--robot", "roomba"])
    path = tmp_path / "a.yaml"
    Scenario(robot="peoplebot-sh", faults=(parse_fault("off:31", robot_table("peoplebot-sh")),)).save(path)
    assert load_scenario(path).robot == "peoplebot-sh"
    with pytest.raises(SimError, match="'31' is no sonar of amigo-sh"):
        scenario_of(parser().parse_args(["--scenario", str(path), "--robot", "amigo-sh"]))
    path.write_text("robot: roomba\n")
    with pytest.raises(SimError, match=r"a\.yaml:1: no robot 'roomba'; name one of amigo-sh"):
        load_scenario(path)
    with pytest.raises(SimError, match="no robot 'roomba'"):
        run(Mission("hall", ((1000, 0),), robot="roomba", limit_s=1.0))


@pytest.mark.parametrize("name", robots())
def test_a_mission_with_it_is_the_same_twice(name: str) -> None:
    mission = Mission("hall", ((1500, 0),), robot=name, faults=("off:2@2s",), limit_s=5.0)
    assert Mission.from_json(mission.to_json()) == mission
    assert run(mission).digest == run(mission).digest


def test_all_tables_agree_on_what_a_reading_can_be() -> None:
    for name in robots():
        sonar = load(f"robots/{name}")["sonar"]
        assert (sonar["min_mm"], sonar["no_echo_mm"]) == (MIN_MM, NO_ECHO_MM)
        assert sonar["cone_deg"] == SonarParams().cone_deg
