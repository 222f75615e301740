# SPDX-License-Identifier: MIT
"""Rule: motion follows the set accelerations and ends where it was told to, the SIP says what the wheels did,
and a solid, a bumper, the watchdog or missing power stop it."""

from __future__ import annotations

import math
import random
from typing import Any

import pytest
from doubles import FakeFaults, Session, WallAhead, cmd, make_robot, sips

from hil_sim.robot.chassis import wrapped
from hil_sim.robot.motion import approach
from hil_sim.robot.report import angle_units, config_pac, encoder_pac, sip
from hil_sim.robot.robot import Robot
from hil_sim.server.server import ArcosServer
from hil_sim.world.model import Pose
from hil_sim.world.step import STEP_MS


def opened(**options: Any) -> Robot:
    robot = make_robot(**options)
    robot.open()
    robot.enable(True)
    return robot


def run(robot: Robot, ms: int) -> list[tuple[float, float]]:
    """Advance with the watchdog fed; return (v, w) of each sub-step."""
    speeds = []
    for _ in range(ms // STEP_MS):
        robot.heard()
        robot.step()
        speeds.append((robot.drive.v, robot.drive.w))
    return speeds


@pytest.mark.parametrize("distance", [1, 7, 50, 66, 200, 1000, -1, -300, 3333])
@pytest.mark.parametrize("speed", [100, 200, 750])
def test_move_ends_exactly_without_overshoot(distance: int, speed: int) -> None:
    robot = opened()
    robot.drive.set_speed(speed)
    robot.drive.move(distance)
    furthest = 0.0
    previous = 0.0
    for _ in range(4000):
        robot.heard()
        robot.step()
        furthest = max(furthest, robot.chassis.odo_x * math.copysign(1, distance))
        assert abs(robot.drive.v) <= speed + 1e-9
        assert abs(robot.drive.v - previous) <= 300 * STEP_MS / 1000 + 1e-9
        previous = robot.drive.v
    assert robot.chassis.odo_x == pytest.approx(distance, abs=1e-6)
    assert furthest <= abs(distance) + 1e-6
    assert robot.drive.v == 0
    assert not robot.wants_motion


def test_move_takes_the_time_of_its_trapezoid() -> None:
    robot = opened()
    robot.drive.set_speed(200)
    robot.drive.move(1000)
    steps = 0
    while robot.wants_motion or robot.drive.v:
        run(robot, STEP_MS)
        steps += 1
    assert steps * STEP_MS / 1000 == pytest.approx(1000 / 200 + 200 / 300, abs=0.03)


def test_a_move_renewed_each_sip_runs_smoothly() -> None:
    robot = opened()
    robot.drive.set_speed(200)
    speeds: list[float] = []
    for _ in range(40):
        robot.drive.move(400)
        speeds += [v for v, _ in run(robot, 100)]
    assert min(speeds[100:]) == max(speeds[100:]) == 200


def test_a_shorter_move_in_motion_ends_on_its_point() -> None:
    robot = opened()
    robot.drive.set_speed(200)
    robot.drive.move(1000)
    run(robot, 2000)
    where = robot.chassis.odo_x
    robot.drive.move(10)
    run(robot, 5000)
    assert robot.chassis.odo_x == pytest.approx(where + 10, abs=1e-6)


def test_approach_random_starts_end_on_the_point() -> None:
    for case in range(300):
        rng = random.Random(case)
        speed, left = rng.uniform(-300, 300), rng.uniform(-500, 500)
        top, accel, decel = rng.uniform(20, 400), rng.uniform(50, 900), rng.uniform(50, 900)
        for _ in range(20_000):
            new, done = approach(speed, left, top, accel, decel)
            assert abs(new - speed) <= max(accel, decel) * STEP_MS / 1000 + 1e-9, f"case {case}"
            left -= left if done else (speed + new) / 2 * STEP_MS / 1000
            speed = new
            if done:
                break
        assert done, f"case {case}"
        assert speed == 0, f"case {case}"


@pytest.mark.parametrize("target", [1, 20, -20, 40, 90, 180, -179, 359, 720, -400])
def test_head_ends_exactly_the_shortest_way(target: int) -> None:
    robot = opened()
    robot.drive.head(target)
    turned = 0.0
    for _ in range(600):
        before = robot.chassis.odo_th
        run(robot, STEP_MS)
        turned += robot.chassis.odo_th - before
    assert math.remainder(robot.chassis.odo_th - target, 360) == pytest.approx(0, abs=1e-6)
    assert abs(turned) <= 180 + 1e-6
    assert robot.drive.w == 0


def test_dhead_is_from_here_and_dchead_from_the_set_point() -> None:
    robot = opened()
    robot.drive.dhead(90)
    run(robot, 500)
    robot.drive.dchead(-30)
    run(robot, 5000)
    assert robot.chassis.odo_th == pytest.approx(60, abs=1e-6)
    robot.drive.dhead(-180)
    run(robot, 6000)
    assert robot.chassis.odo_th == pytest.approx(-120, abs=1e-6)


def test_head_is_relative_to_the_odometry_zero() -> None:
    robot = opened()
    robot.drive.dhead(50)
    run(robot, 4000)
    robot.set_origin()
    robot.drive.head(10)
    run(robot, 4000)
    assert robot.chassis.odo_th == pytest.approx(10, abs=1e-6)
    assert robot.chassis.th == pytest.approx(60, abs=1e-6)


def test_translation_and_rotation_are_independent_channels() -> None:
    robot = opened()
    robot.drive.vel(200)
    robot.drive.rvel(20)
    run(robot, 3000)
    assert (robot.drive.v, robot.drive.w) == (200, 20)
    robot.drive.head(0)
    run(robot, 8000)
    assert robot.drive.v == 200
    assert robot.drive.w == 0
    robot.drive.move(100)
    run(robot, 4000)
    assert robot.drive.v == 0


def test_vel2_takes_both_channels_until_the_next_command() -> None:
    robot = opened()
    robot.drive.vel2(300, 100)
    run(robot, 3000)
    left, right = robot.drive.wheel_speeds()
    assert (left, right) == pytest.approx((300, 100))
    robot.drive.vel(100)
    run(robot, 3000)
    assert (robot.drive.v, robot.drive.w) == (100, 0)


def test_speeds_are_capped_and_accelerations_obeyed() -> None:
    robot = opened()
    robot.drive.set_speed(5000)
    robot.drive.set_accel(500)
    robot.drive.set_accel(-100)
    robot.drive.vel(9000)
    speeds = [v for v, _ in run(robot, 4000)]
    assert max(speeds) == 1500
    assert speeds[0] == pytest.approx(5.0)
    robot.drive.stop()
    before = robot.drive.v
    assert run(robot, STEP_MS)[0][0] == pytest.approx(before - 1.0)


def test_stop_brakes_and_estop_stands_at_once() -> None:
    robot = opened()
    robot.drive.vel(300)
    run(robot, 2000)
    robot.drive.stop()
    assert run(robot, 500)[-1][0] == pytest.approx(150)
    robot.drive.vel(300)
    run(robot, 2000)
    robot.drive.halt()
    assert robot.drive.v == 0
    assert robot.drive.motors
    assert run(robot, 100)[-1][0] == 0


def test_motion_needs_motors_and_set_points_do_not_outlive_them() -> None:
    robot = make_robot()
    robot.open()
    robot.drive.vel(300)
    robot.drive.move(100)
    robot.enable(True)
    run(robot, 1000)
    assert robot.drive.v == 0
    assert robot.chassis.odo_x == 0
    robot.drive.vel(300)
    run(robot, 2000)
    robot.enable(False)
    run(robot, 1000)
    robot.enable(True)
    run(robot, 1000)
    assert robot.drive.v == 0


def test_estop_button_needs_release_and_enable() -> None:
    robot = opened()
    robot.drive.vel(200)
    run(robot, 1000)
    robot.press_estop(True)
    assert robot.drive.v == 0
    assert sip(robot).flags & 0x61 == 0x60
    robot.enable(True)
    assert not robot.drive.motors
    robot.press_estop(False)
    assert sip(robot).flags & 0x21 == 0
    robot.enable(True)
    assert sip(robot).flags & 0x61 == 0x01


def test_watchdog_brakes_then_resumes_the_set_points() -> None:
    robot = opened()
    robot.drive.vel(200)
    robot.heard()
    for _ in range(200):
        robot.step()
    assert robot.drive.v == 200
    for _ in range(30):
        robot.step()
    assert 0 < robot.drive.v < 200
    for _ in range(50):
        robot.step()
    assert robot.drive.v == 0
    assert sip(robot).type == 0x32
    robot.heard()
    run(robot, 1000)
    assert robot.drive.v == 200


def test_a_move_cut_by_the_watchdog_is_finished_afterwards() -> None:
    robot = opened()
    robot.drive.set_speed(200)
    robot.drive.move(1000)
    robot.heard()
    for _ in range(500):
        robot.step()
    assert robot.drive.v == 0
    assert 0 < robot.chassis.odo_x < 600
    run(robot, 6000)
    assert robot.chassis.odo_x == pytest.approx(1000, abs=1e-6)


def test_a_wall_stops_the_body_at_its_surface_and_stalls_the_wheels() -> None:
    records: list[tuple[str, dict[str, Any]]] = []
    robot = opened(wall_mm=1000, log=lambda kind, fields: records.append((kind, fields)))
    robot.drive.settings.bumpstall = 0
    robot.drive.vel(300)
    run(robot, 4000)
    assert 0 <= 1000 - 210 - robot.chassis.x < 0.5
    assert robot.drive.v == 0
    assert robot.chassis.odo_x == pytest.approx(robot.chassis.x)
    assert sip(robot).stall_right == 0b1001
    assert [kind for kind, _ in records].count("collision") == 1
    robot.drive.move(-100)
    run(robot, 3000)
    assert robot.chassis.x == pytest.approx(690, abs=1)
    assert robot.front_bumpers == 0
    sip(robot)
    assert sip(robot).stall_right == 0
    assert [fields["front"] for kind, fields in records if kind == "bumper"] == [0b1000, 0]
    robot.drive.vel(300)
    run(robot, 3000)
    assert [kind for kind, _ in records].count("collision") == 2


def test_a_bumper_stalls_only_motion_towards_it() -> None:
    faults = FakeFaults()
    robot = opened(faults=faults)
    robot.drive.vel(200)
    run(robot, 1000)
    faults.bits = 0b10
    run(robot, 500)
    assert robot.drive.v == 0
    packet = sip(robot)
    assert packet.front_bumpers == 0b10
    assert packet.left_stalled
    assert packet.right_stalled
    robot.drive.move(-150)
    run(robot, 3000)
    assert robot.drive.v == 0
    assert robot.chassis.odo_x < 120
    robot.drive.settings.bumpstall = 0
    robot.drive.vel(200)
    run(robot, 1000)
    assert robot.drive.v == 200


def test_a_bare_robot_reports_no_bumper() -> None:
    robot = opened(wall_mm=400, bumpers=0)
    robot.drive.vel(300)
    run(robot, 3000)
    assert robot.chassis.collisions == 1
    assert sip(robot).front_bumpers == 0
    assert config_pac(robot, b"n", b"s").front_bumps == 0


def test_odometry_errs_little_and_by_seed_only() -> None:
    def drive(seed: int) -> tuple[float, float, float]:
        robot = opened(seed=seed, odometry_error=None)
        robot.drive.rvel(10)
        robot.drive.vel(200)
        run(robot, 20_000)
        return (
            robot.chassis.x - robot.chassis.odo_x,
            robot.chassis.y - robot.chassis.odo_y,
            robot.chassis.th - robot.chassis.odo_th,
        )

    errors = [drive(seed) for seed in range(8)]
    assert drive(3) == errors[3]
    assert len(set(errors)) == 8
    assert all(abs(x) < 100 and abs(y) < 100 and abs(th) < 5 for x, y, th in errors)
    assert any(abs(th) > 0.01 for _, _, th in errors)


def test_sip_units_and_wraps() -> None:
    robot = opened()
    robot.chassis.odo_x, robot.chassis.odo_y, robot.chassis.odo_th = -1.4, 70_000.0, 270.0
    packet = sip(robot)
    assert (packet.x, packet.y, packet.th) == (0xFFFF, 70_000 & 0xFFFF, -1024)
    robot.drive.v, robot.drive.w = 100.0, 10.0
    packet = sip(robot)
    assert packet.rotvel == 100
    assert packet.type == 0x33
    assert packet.right_vel - packet.left_vel == pytest.approx(math.radians(10) * 330, abs=1)
    assert [angle_units(deg) for deg in (0, 90, 179.99, 180, -90, 359.99)] == [
        0,
        1024,
        -2048,
        -2048,
        -1024,
        0,
    ]
    assert [wrapped(deg) for deg in (0, 180, -180, 181, 540, -541)] == [0, 180, 180, -179, 180, 179]


def test_encoders_count_both_wheels() -> None:
    robot = opened()
    robot.drive.move(100)
    run(robot, 3000)
    robot.drive.dhead(90)
    run(robot, 4000)
    counts = encoder_pac(robot)
    assert counts.left + counts.right == pytest.approx(2 * 100 * 128, abs=2)
    assert counts.right - counts.left == pytest.approx(math.pi / 2 * 330 * 128, rel=1e-3)


def test_energy_is_split_and_the_battery_falls_with_it() -> None:
    robot = opened()
    before = robot.battery_v
    robot.drive.set_speed(200)
    robot.drive.move(1000)
    run(robot, 10_000)
    energy = robot.energy
    assert energy.idle_s == pytest.approx(10)
    assert energy.sonar_s == pytest.approx(10)
    assert energy.wheel_m == pytest.approx(2.0, rel=0.01)
    assert energy.accel_j == pytest.approx(1.43 * 14.2 * 0.2**2 / 2, rel=0.05)
    assert robot.battery_v < before
    robot.energy.idle_s = 1e9
    assert 10.5 < robot.battery_v < 11.0


def test_pose_at_interpolates_backwards() -> None:
    robot = opened()
    robot.drive.vel(100)
    run(robot, 2000)
    here = robot.chassis.x
    assert robot.pose_at(robot.now_ms).x_mm == here
    assert robot.pose_at(robot.now_ms - 5).x_mm == pytest.approx(here - 0.5)
    assert robot.pose_at(robot.now_ms - 250).x_mm == pytest.approx(here - 25)
    assert robot.pose_at(robot.now_ms + 100).x_mm == here


def test_time_is_virtual_and_its_steps_do_not_matter() -> None:
    first, second = opened(), opened()
    for robot in (first, second):
        robot.drive.vel(200)
        robot.drive.rvel(15)
    first.advance(1500)
    for _ in range(1000):
        second.advance(1.5)
    assert first.pose == second.pose
    assert first.now_ms == second.now_ms == 1500


def test_a_robot_far_from_walls_seldom_asks_for_contact() -> None:
    robot = opened(wall_mm=5000)
    robot.drive.vel(200)
    run(robot, 10_000)
    assert isinstance(robot.body, WallAhead)
    assert robot.body.contacts < 50


def test_placed_inside_a_solid_only_the_way_out_is_open() -> None:
    robot = opened(wall_mm=1000)
    robot.chassis.place(900, 0, 0)
    robot.drive.settings.bumpstall = 0
    robot.drive.vel(100)
    run(robot, 1000)
    assert robot.chassis.x == 900
    robot.drive.vel(-100)
    run(robot, 4000)
    assert robot.chassis.x < 790
    assert robot.front_bumpers == 0


def test_a_moved_solid_strikes_a_standing_robot() -> None:
    kinds: list[str] = []
    robot = make_robot(dynamic=True, log=lambda kind, _: kinds.append(kind))
    assert isinstance(robot.body, WallAhead)
    robot.body.wall_mm = 200
    run(robot, 200)
    assert kinds.count("struck") == 1
    assert "collision" not in kinds
    assert robot.front_bumpers == 0b1000


def test_random_commands_keep_the_robot_sane() -> None:
    names = [
        "VEL",
        "RVEL",
        "MOVE",
        "HEAD",
        "DHEAD",
        "DCHEAD",
        "VEL2",
        "SETA",
        "SETV",
        "SETRA",
        "SETRV",
        "STOP",
    ]
    names += ["E_STOP", "ENABLE", "ROTATE", "SETO", "BUMPSTALL", "SONAR", "PULSE"]
    for seed in range(40):
        rng = random.Random(seed)
        wall_mm = rng.choice((1e9, 1500.0))
        robot = make_robot(wall_mm=wall_mm, seed=seed)
        session = Session(ArcosServer(robot))
        session.connect()
        for _ in range(60):
            session.send(
                cmd(
                    rng.choice(names),
                    rng.choice((0, 1, -1, rng.randint(-32767, 32767), rng.randint(-300, 300))),
                )
            )
            session.run(rng.choice((50, 100, 700)), keep_alive=False)
        assert len(sips(session.packets)) > 100, f"seed {seed}"
        assert abs(robot.drive.v) <= 1500, f"seed {seed}"
        assert abs(robot.drive.w) <= 360, f"seed {seed}"
        assert all(math.isfinite(value) for value in (robot.chassis.x, robot.chassis.y, robot.chassis.th)), (
            f"seed {seed}"
        )
        assert robot.chassis.x + 210 <= wall_mm, f"seed {seed}"


def test_start_pose_is_the_true_pose() -> None:
    robot = make_robot()
    robot.chassis.place(10, 20, 190)
    assert robot.pose == Pose(10, 20, -170)
    robot.reset_pose()
    assert robot.pose == Pose(0, 0, 0)
