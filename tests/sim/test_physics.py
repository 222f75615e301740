# SPDX-License-Identifier: MIT
"""Rule: each departure from the plain model does what it says, from the seed alone, and is off unless asked for."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from doubles import Session, cmd, make_robot, sips

from hil_sim import native
from hil_sim.cli.arguments import parser
from hil_sim.cli.choose import scenario_of
from hil_sim.errors import SimError
from hil_sim.faults.execute import FaultSet
from hil_sim.faults.grammar import parse_fault
from hil_sim.robot.robot import Robot
from hil_sim.scenario.build import build_robot
from hil_sim.scenario.scenario import Scenario, load_scenario
from hil_sim.server.mobilesim import MobileSimServer
from hil_sim.server.server import ArcosServer
from hil_sim.sil import Mission, run
from hil_sim.sonar.echo import EchoModel
from hil_sim.sonar.params import NO_ECHO_MM, Reading, SonarParams
from hil_sim.sonar.ring import SonarRing
from hil_sim.sonar.rough import Roughness
from hil_sim.tables.robot import robot_table
from hil_sim.world.files import load_world
from hil_sim.world.model import Floats, Pose, World
from hil_sim.world.physics import LIMITS, PLAIN, SETS, Physics, parse_physics

SEED = 11
QUIET = SonarParams(noise_mm=0, noise_part=0, crosstalk=0)
HERE = Pose(0.0, 0.0, 0.0)


def world_of(*walls: Sequence[float], roughness: float = 1.0) -> World:
    segments: Floats = np.array(walls, dtype=np.float64)
    return World("made", segments, np.full(len(walls), roughness))


BOX = world_of((2000, -2000, 2000, 2000), (-2000, -2000, -2000, 2000), (-2000, 2000, 2000, 2000),
               (-2000, -2000, 2000, -2000))  # fmt: skip


def readings(
    world: World, physics: Physics, ms: int = 32_000, params: SonarParams = QUIET, seed: int = SEED
) -> list[Reading]:
    rough = Roughness(physics, 16, np.random.default_rng([seed, 3]))
    ring = SonarRing(world, params, None, np.random.default_rng([seed, 2]), rough=rough)
    found: list[Reading] = []
    for now in range(0, ms, 10):
        found += ring.advance(now, lambda _: HERE)
    return found


def of(found: list[Reading], number: int) -> list[int]:
    return [reading.range_mm for reading in found if reading.number == number]


def test_off_is_off() -> None:
    assert not PLAIN.on_sonars
    assert PLAIN.text == "plain"
    plain = readings(BOX, PLAIN)
    assert plain
    assert all(reading.range_mm == reading.true_mm for reading in plain)
    mission = Mission("office", ((1000, 0),), limit_s=10.0)
    assert run(mission).digest == run(dataclasses.replace(mission, physics="plain")).digest


def test_rough_day_is_as_it_is_said_to_be() -> None:
    assert SETS["rough-day"] == Physics(
        dropout=0.01, gain_db=4, double_bounce=0.08, range_scale=0.01, sound=0.01, range_step_mm=10,
        odometry_scale=0.01, odometry_drift_deg_m=0.5,
    )  # fmt: skip


def test_dropouts_are_a_share_of_all_pings() -> None:
    found = readings(BOX, Physics(dropout=0.05), 128_000)
    lost = sum(reading.range_mm == NO_ECHO_MM != reading.true_mm for reading in found)
    heard = sum(reading.true_mm != NO_ECHO_MM for reading in found)
    assert heard > 5000
    spread = math.sqrt(0.05 * 0.95 / heard)
    assert abs(lost / heard - 0.05) < 4 * spread, f"{lost} of {heard}, seed {SEED}"


def test_gain_changes_what_is_loud_enough_for_each_sonar() -> None:
    slanted = world_of((1000, -3000, 1800, 3000), roughness=0.2)
    for seed in range(20):
        rough = Roughness(Physics(gain_db=6), 16, np.random.default_rng([seed, 3]))
        assert len({round(gain, 6) for gain in rough.gain_db}) == 16
        assert max(map(abs, rough.gain_db)) <= 6
    model = EchoModel(slanted, QUIET)
    far = [model.range_mm(0, 0, 0, gain_db=gain) for gain in (-25.0, 0.0, 25.0)]
    assert far == sorted(far, reverse=True), "a louder receiver hears nearer or more"
    assert far[0] == NO_ECHO_MM


def test_scale_is_of_each_sonar_and_sound_of_all() -> None:
    for seed in range(5):
        scaled = readings(BOX, Physics(range_scale=0.02), 1000, seed=seed)
        parts = {r.number: r.range_mm / r.true_mm for r in scaled if r.true_mm < 4000}
        assert len({round(part, 3) for part in parts.values()}) > 5, f"seed {seed}"
        assert all(abs(part - 1) <= 0.02 + 0.001 for part in parts.values())
        common = readings(BOX, Physics(sound=0.02), 1000, seed=seed)
        same = [r.range_mm / r.true_mm for r in common if r.true_mm < 4000]
        assert max(same) - min(same) < 0.002, f"seed {seed}"


def test_ranges_come_in_steps() -> None:
    found = readings(BOX, Physics(range_step_mm=10), 4000, SonarParams(crosstalk=0))
    assert found
    assert all(reading.range_mm % 10 == 0 for reading in found)


def test_what_is_too_near_is_heard_again_or_not_at_all() -> None:
    near = world_of((386, -3000, 386, 3000))  # 220 mm ahead of sonars 3 and 4
    true_mm = of(readings(near, PLAIN, 1000), 3)[0]
    assert of(readings(near, Physics(blind_mm=true_mm - 1), 1000), 3)[0] == true_mm
    assert of(readings(near, Physics(blind_mm=true_mm + 1), 1000), 3)[0] == 2 * true_mm
    assert of(readings(near, Physics(blind_mm=3 * true_mm + 1), 1000), 3)[0] == NO_ECHO_MM


def test_a_double_bounce_goes_by_way_of_a_smooth_surface_to_the_next() -> None:
    # A smooth wall turned by 45 degrees ahead of sonar 3's axis sends its sound to the rough wall at y = 1500.
    heading = 10.0
    mirror = (1000.0, -800.0, 2600.0, 800.0)
    world = World("made", np.array([mirror, (-3000, 1500, 3000, 1500)]), np.array([0.0, 1.0]))
    model = EchoModel(world, QUIET)
    way = model.bounce_mm(3, HERE)
    assert way is not None
    mount = robot_table().mounts[3]
    c, s = math.cos(math.radians(heading)), math.sin(math.radians(heading))
    # Onto y = x - 1800 from (x0, y0) along (c, s), then along (s, c), its mirror image, to y = 1500.
    first = (1800 - mount.x_mm + mount.y_mm) / (c - s)
    second = (1500 - (mount.y_mm + first * s)) / c
    assert way == pytest.approx(first + second, abs=1)
    rough = World("made", world.segments, np.array([1.0, 1.0]))
    assert EchoModel(rough, QUIET).bounce_mm(3, HERE) is None
    found = of(readings(world, Physics(double_bounce=0.3), 64_000), 3)
    share = found.count(way) / len(found)
    assert abs(share - 0.3) < 4 * math.sqrt(0.21 / len(found)), f"{share}, seed {SEED}"


def test_side_lobes_hear_beside_the_cone() -> None:
    beside = world_of((-500, 900, 1500, 900))
    deaf, wide = EchoModel(beside, QUIET), dataclasses.replace(QUIET, side_lobe_db=20.0, side_lobe_deg=120)
    assert deaf.range_mm(0, 0, 40) == NO_ECHO_MM or deaf.range_mm(0, 0, 40) > 950
    assert EchoModel(beside, wide).range_mm(0, 0, 40) < deaf.range_mm(0, 0, 40)
    assert EchoModel(beside, dataclasses.replace(wide, side_lobe_db=29.0)).range_mm(0, 0, 40) >= EchoModel(
        beside, wide
    ).range_mm(0, 0, 40)


def test_the_ping_of_the_other_array_is_heard_when_it_comes_sooner() -> None:
    near_behind = world_of((-900, -4000, -900, 4000), (3500, -4000, 3500, 4000))
    plain = of(readings(near_behind, PLAIN, 32_000), 3)
    crossed = of(readings(near_behind, Physics(cross_array=0.4), 32_000), 3)
    changed = [value for value, before in zip(crossed, plain, strict=True) if value != before]
    assert 0.25 < len(changed) / len(plain) < 0.55, f"seed {SEED}"
    assert all(value < min(plain) for value in changed)


@pytest.mark.skipif(native.library() is None, reason="libargus_sim.so is not built")
@pytest.mark.parametrize("name", ["office", "lab", "smooth", "posts"])
def test_gain_and_side_lobes_are_the_same_in_c_and_numpy(name: str) -> None:
    world = load_world(name)
    low_x, low_y, high_x, high_y = world.bounds
    rng = np.random.default_rng(SEED)
    for params in (QUIET, dataclasses.replace(QUIET, side_lobe_db=24.0, side_lobe_deg=100)):
        in_c, here = EchoModel(world, params), EchoModel(world, params, in_c=False)
        for _ in range(150):
            x, y = rng.uniform(low_x, high_x), rng.uniform(low_y, high_y)
            heading, gain = rng.uniform(-180, 180), rng.uniform(-8, 8)
            want = here.range_mm(x, y, heading, gain_db=gain)
            assert in_c.range_mm(x, y, heading, gain_db=gain) == want, (x, y, heading, gain)
            pose, number = Pose(x, y, heading), int(rng.integers(16))
            assert in_c.ping_mm(number, pose, 3.0, None, gain) == here.ping_mm(number, pose, 3.0, None, gain)
            assert in_c.bounce_mm(number, pose) == here.bounce_mm(number, pose)


def test_a_rough_day_is_the_same_again_and_with_another_seed_another() -> None:
    mission = Mission("office", ((3000, 0),), physics="rough-day", limit_s=20.0)
    assert Mission.from_json(mission.to_json()) == mission
    once = run(mission).digest
    assert run(mission).digest == once
    assert run(dataclasses.replace(mission, seed=2)).digest != once
    assert run(dataclasses.replace(mission, physics="")).digest != once


def driven(physics: Physics, seed: int) -> Robot:
    robot = make_robot(physics=physics, seed=seed)
    robot.open()
    robot.enable(True)
    robot.drive.move(5000)
    for _ in range(2500):
        robot.heard()
        robot.step()
    assert robot.chassis.odo_x == pytest.approx(5000, abs=0.01)
    return robot


def test_wheels_lie_as_asked() -> None:
    signs = set()
    for seed in range(8):
        robot = driven(Physics(odometry_scale=0.01), seed)
        assert abs(robot.chassis.x - 5000) == pytest.approx(50, abs=0.1), f"seed {seed}"
        signs.add(robot.chassis.x > 5000)
        turned = driven(Physics(odometry_drift_deg_m=0.5), seed)
        assert abs(turned.chassis.th) == pytest.approx(2.5, abs=0.01), f"seed {seed}"
        assert turned.chassis.odo_th == 0
    assert signs == {True, False}


def test_slipping_wheels_leave_the_body_behind() -> None:
    assert driven(Physics(slip=1.0), 1).chassis.x == pytest.approx(2500, abs=1)
    made = [driven(Physics(slip=0.2), seed).chassis.x for seed in range(10)]
    assert 4200 < sum(made) / len(made) < 4800
    assert len({round(x) for x in made}) > 3


@pytest.mark.parametrize("name", LIMITS)
def test_each_is_read_and_written_and_kept_within_its_limits(name: str, tmp_path: Path) -> None:
    low, high = LIMITS[name]
    value = (low + high) / 2
    physics = Physics(**{name: value})
    assert parse_physics(physics.text) == physics
    for path, text in (("a.yaml", f"physics: {{{name}: {value}}}"), ("b.yaml", f"physics: {name}={value}")):
        (tmp_path / path).write_text(text + "\n")
        scenario = load_scenario(tmp_path / path)
        assert scenario.physics == physics
        scenario.save(tmp_path / "c.yaml")
        assert load_scenario(tmp_path / "c.yaml") == scenario
    assert scenario_of(parser().parse_args(["--physics", f"{name}={value}"])).physics == physics
    for bad in (f"{name}={high + 1}", f"{name}=-1", f"{name}=nan", f"{name}=", name):
        with pytest.raises(SimError, match="physics"):
            parse_physics(bad)
    (tmp_path / "d.yaml").write_text(f"physics: {{{name}: {high + 1}}}\n")
    with pytest.raises(SimError, match=r"d\.yaml:1: "):
        load_scenario(tmp_path / "d.yaml")


def test_a_world_may_have_its_own_and_a_scenario_another(tmp_path: Path) -> None:
    path = tmp_path / "w.yaml"
    path.write_text("physics: rough-day\nwalls: [{points: [[2000, -3000], [2000, 3000]]}]\n")
    world = load_world(str(path))
    assert world.physics == SETS["rough-day"]
    robot = build_robot(Scenario(world=str(path)), world, world.start, None)
    plain = build_robot(Scenario(world=str(path), physics=PLAIN), world, world.start, None)
    assert isinstance(robot.ring, SonarRing)
    assert isinstance(plain.ring, SonarRing)
    assert robot.ring._rough is not None
    assert plain.ring._rough is None
    with pytest.raises(SystemExit):
        parser().parse_args(["--physics", "sunny-day"])
    with pytest.raises(SystemExit):
        parser().parse_args(["--sonar", "cone_deg=900"])
    given = scenario_of(parser().parse_args(["--sonar", "side_lobe_db=20", "--sonar", "noise_mm=1"]))
    assert given.sonar == dataclasses.replace(SonarParams(), side_lobe_db=20.0, noise_mm=1.0)


# ---- the vendor's emulator


def session_of(kind: type[ArcosServer]) -> Session:
    session = Session(kind(make_robot()))
    session.connect()
    return session


def test_mobilesim_comes_nearer_and_nearer_and_the_robot_arrives() -> None:
    for kind, low, high in ((MobileSimServer, 796, 816), (ArcosServer, 1000, 1000)):
        session = session_of(kind)
        session.send(cmd("MOVE", 1000))
        session.run(8500)
        assert low <= session.server.robot.chassis.odo_x <= high, kind
    for kind, low_s, high_s in ((MobileSimServer, 3.5, 4.0), (ArcosServer, 0.5, 1.5)):
        session = session_of(kind)
        session.send(cmd("HEAD", 20))
        while session.server.robot.chassis.odo_th < 19.5:
            session.run(50)
            assert session.now_ms < 10_000
        assert low_s <= session.now_ms / 1000 <= high_s, kind


def test_mobilesim_is_had_in_a_mission() -> None:
    mission = Mission("hall", ((2000, 0),), quirks="mobilesim", limit_s=60.0)
    assert Mission.from_json(mission.to_json()) == mission
    outcome = run(mission)
    assert outcome.digest == run(mission).digest
    assert outcome.driven_mm > 0
    with pytest.raises(SimError, match="no quirks 'toy'; name one of robot, mobilesim"):
        run(dataclasses.replace(mission, quirks="toy"))


# ---- the wire's extremes


@pytest.mark.parametrize(
    ("text", "possible"),
    [
        ("stuck:3:value=0", {0}),
        ("stuck:3:value=65535", {65535}),
        ("intermittent:3:p=1:value=0", {0}),
        ("wrong:3:offset=60000:high=65535", {61000}),
        ("wrong:3:offset=60000", {5000}),
        ("wrong:3:offset=-60000:low=0", {0}),
        ("wrong:3:offset=-60000", {100}),
        ("garbage:3:low=65535:high=65535", {65535}),
    ],
)
def test_a_fault_may_give_what_a_sip_can_carry(text: str, possible: set[int]) -> None:
    faults = FaultSet([parse_fault(text)])
    faults.update(0, HERE, 0.0)
    assert {faults.apply(3, 0.0, 1000, lambda _: 1000)[0] for _ in range(20)} == possible


def test_extremes_go_over_the_wire() -> None:
    faults = (parse_fault("stuck:3:value=65535"), parse_fault("stuck:4:value=0"))
    world = load_world("hall")
    robot = build_robot(Scenario(world="hall", faults=faults), world, world.start, None)
    session = Session(ArcosServer(robot))
    session.connect()
    heard = [pair for sip in sips(session.run(1000)) for pair in sip.sonars]
    assert {range_mm for number, range_mm in heard if number == 3} == {65535}
    assert {range_mm for number, range_mm in heard if number == 4} == {0}


@pytest.mark.parametrize(
    "text", ["wrong:3:scale=1:low=200:high=100", "garbage:3:high=65536", "stuck:3:value=-1"]
)
def test_what_no_sip_can_carry_is_refused(text: str) -> None:
    with pytest.raises(SimError, match="fault '"):
        parse_fault(text)
