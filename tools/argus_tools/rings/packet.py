# SPDX-License-Identifier: MIT
"""Ranges and a motion as a packet of the robot whose ring it is: all that the fault manager takes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

from argus_tools.rings.motion import Motion
from hil_sim.arcos import FLAG, Sip, SyncReply, frame
from hil_sim.tables.robot import RobotTable

FLAGS: Final = FLAG["MOTORS"] | FLAG["SONAR1"] | FLAG["SONAR2"] | FLAG["SONAR3"] | FLAG["SONAR4"]
_WORD: Final = 0xFFFF
_MM: Final = 1000
_SPEED_MOST: Final = 0x7FFF
_BATTERY: Final = 120


def identity_of(table: RobotTable) -> SyncReply:
    """Return what the robot says of itself when a session begins."""
    return SyncReply(b"", table.robot_class.encode(), table.subclass.encode())


def empty() -> Sip:
    """Return a packet of a robot that has reported nothing yet."""
    return Sip(flags=FLAGS)


def packet(table: RobotTable, motion: Motion, ranges_mm: Mapping[int, int]) -> bytes:
    """Return the framed packet that reports these ranges, by sonar, and this motion."""
    return frame(sip_of(table, motion, ranges_mm).data)


def sip_of(table: RobotTable, motion: Motion, ranges_mm: Mapping[int, int]) -> Sip:
    """Return what such a packet holds."""
    odometry = table.odometry
    unit_mm = odometry["dist_conv_um"] / 1000
    speed_unit = odometry["vel_conv_um_s"] / 1000
    range_unit = odometry["range_conv_um"] / 1000
    turn = odometry["angle_per_turn"]
    half_mm = table.motion["track_mm"] / 2
    speed, across = motion.speed_m_s * _MM, motion.turn_rad_s * half_mm
    return Sip(
        x=round(motion.x_m * _MM / unit_mm) & _WORD,
        y=round(motion.y_m * _MM / unit_mm) & _WORD,
        th=round(motion.heading_rad / math.tau * turn) % turn,
        left_vel=_speed((speed - across) / speed_unit),
        right_vel=_speed((speed + across) / speed_unit),
        battery=_BATTERY,
        flags=FLAGS,
        sonars=tuple((number, round(mm / range_unit) & _WORD) for number, mm in sorted(ranges_mm.items())),
        battery_x10=_BATTERY,
    )


def _speed(units: float) -> int:
    return round(min(max(units, -_SPEED_MOST), _SPEED_MOST))
