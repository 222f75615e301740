# SPDX-License-Identifier: MIT
"""What the robot's packets say of it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from hil_sim.arcos import FLAG, SIP, TYPE, ConfigPac, EncoderPac, IoPac, SimStat, Sip
from hil_sim.robot.chassis import wrapped
from hil_sim.robot.robot import Robot
from hil_sim.world.step import STEP_MS


def sip(robot: Robot) -> Sip:
    """Return the SIP due now; its readings and stall bits are those since the one before."""
    chassis = robot.chassis
    left, right = (round(speed) for speed in robot.drive.wheel_speeds())
    moving = abs(left) >= 1 or abs(right) >= 1 or robot.wants_motion
    battery_dv = round(robot.battery_v * 10)
    stalled_left, stalled_right = robot.stall.take()
    return Sip.of(
        {
            "type": TYPE["SIP_MOVING"] if moving else TYPE["SIP_STATIONARY"],
            "x": round(chassis.odo_x / robot.unit_mm) & 0xFFFF,
            "y": round(chassis.odo_y / robot.unit_mm) & 0xFFFF,
            "th": angle_units(chassis.odo_th),
            "left_vel": left,
            "right_vel": right,
            "battery": min(battery_dv, 255),
            "stall_left": robot.rear_bumpers | int(stalled_left),
            "stall_right": robot.front_bumpers | int(stalled_right),
            "flags": _flags(robot),
            "sonars": tuple((reading.number, reading.range_mm) for reading in robot.take_readings()),
            "anport": robot.anport,
            "digout": robot.digout,
            "battery_x10": battery_dv,
            "rotvel": round(robot.drive.w * 10),
        }
    )


def _flags(robot: Robot) -> int:
    return other_flags(robot) | (FLAG["MOTORS"] if robot.drive.motors else 0)


def other_flags(robot: Robot) -> int:
    """Return the flags of a SIP without that of the motors."""
    flags = 0
    for array in range(len(robot.table.orders)):
        if robot.ring.enabled[array]:
            flags |= FLAG[f"SONAR{array + 1}"]
    if robot.estop_pressed:
        flags |= FLAG["ESTOP"]
    return flags | (FLAG["ESTALL"] if robot.estalled else 0)


def config_pac(robot: Robot, name: bytes, subclass: bytes) -> ConfigPac:
    """Return the CONFIGpac: FLASH values, those changed at run time in their place."""
    now, table = robot.drive.settings, robot.table
    packet = ConfigPac(
        robot_type=table.robot_class.encode(),
        subtype=subclass,
        serial_number=table.serial.encode(),
        four_motors=table.motion["four_motors"],
        rot_vel_top=table.motion["rotvel_top_deg_s"],
        trans_vel_top=table.motion["vel_top_mm_s"],
        rot_acc_top=table.motion["rotaccel_top_deg_s2"],
        trans_acc_top=table.motion["accel_top_mm_s2"],
        name=name,
        front_sonar=int(bool(table.front)),
        rear_sonar=int(bool(table.rear)),
        rev_count=table.motion["rev_count"],
        ticks_mm=table.motion["ticks_per_mm"],
        front_bumps=robot.bumpers,
        rear_bumps=robot.rear_segments,
        trans_vel_max=int(now.v_max),
        rot_vel_max=int(now.rv_max),
        trans_acc=int(now.accel),
        trans_decel=int(now.decel),
        rot_acc=int(now.raccel),
        rot_decel=int(now.rdecel),
        sonar_cycle_ms=robot.ring.cycle_ms,
    )
    extra: dict[str, Any] = now.config
    return replace(packet, **extra)


def encoder_pac(robot: Robot) -> EncoderPac:
    """Return the ENCODERpac due now."""
    ticks = robot.table.motion["ticks_per_mm"]
    return EncoderPac(round(robot.chassis.left_mm * ticks), round(robot.chassis.right_mm * ticks))


def io_pac(robot: Robot) -> IoPac:
    """Return the IOpac due now; bumper inputs are pulled up, so a pressed segment reads 0."""
    front, rear = ~robot.front_bumpers & 0xFF, ~robot.rear_bumpers & 0xFF
    battery = min(1023, round(robot.battery_v / 20 * 1023))
    return IoPac(bytes((0xFF, front, rear, 0xFF)), bytes((robot.digout,)), (0,) * 8 + (battery,))


def sim_stat(robot: Robot) -> SimStat:
    """Return the simulator's report of the true pose."""
    chassis = robot.chassis
    return SimStat(
        flags=0b10,
        interval_ms=STEP_MS,
        real_interval_ms=STEP_MS,
        last_interval_ms=STEP_MS,
        x_mm=round(chassis.x),
        y_mm=round(chassis.y),
        th_deg=round(wrapped(chassis.th)),
    )


def angle_units(deg: float) -> int:
    """Return a heading in units of the SIP, within half a turn of 0."""
    turn = SIP["TURN"]
    return (round(deg * turn / 360) + turn // 2) % turn - turn // 2
