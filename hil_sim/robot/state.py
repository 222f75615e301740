# SPDX-License-Identifier: MIT
"""What changes from one sub-step to the next, laid out so that tick.c works on the same memory as the Python."""

from __future__ import annotations

import ctypes
from typing import Final

HISTORY: Final = 64
"""So many poses are kept."""
_D, _I, _L, _B = ctypes.c_double, ctypes.c_int32, ctypes.c_int64, ctypes.c_bool


class SettingsState(ctypes.Structure):
    """Limits of the drive."""

    v_max: float
    rv_max: float
    accel: float
    decel: float
    raccel: float
    rdecel: float
    bumpstall: int
    _fields_ = [
        *((name, _D) for name in ("v_max", "rv_max", "accel", "decel", "raccel", "rdecel")),
        ("bumpstall", _I),
    ]


class DriveState(ctypes.Structure):
    """Speeds and set points."""

    v: float
    w: float
    motors: bool
    _v_set: float
    _w_set: float
    _move_left: float
    _head_left: float
    _head_set: float
    _left_part: float
    _right_part: float
    _move_mode: bool
    _head_mode: bool
    _vel2: bool
    _fields_ = [
        *((name, _D) for name in ("v", "w", "_v_set", "_w_set", "_move_left", "_head_left", "_head_set")),
        *((name, _D) for name in ("_left_part", "_right_part")),
        *((name, _B) for name in ("motors", "_move_mode", "_head_mode", "_vel2")),
    ]


class ChassisState(ctypes.Structure):
    """True pose, odometry, how they differ, and what the body touches."""

    x: float
    y: float
    th: float
    odo_x: float
    odo_y: float
    odo_th: float
    left_mm: float
    right_mm: float
    travelled_mm: float
    free_mm: float
    true_distance: float
    true_turn: float
    contact_front: int
    contact_rear: int
    _drift_deg_mm: float
    _kept: ctypes.Array[ctypes.c_double]
    _kept_at: int
    _kept_count: int
    _fields_ = [
        *((name, _D) for name in ("x", "y", "th", "odo_x", "odo_y", "odo_th", "left_mm", "right_mm")),
        *((name, _D) for name in ("travelled_mm", "free_mm", "true_distance", "true_turn", "_drift_deg_mm")),
        ("_kept", _D * (3 * HISTORY)),
        *((name, _I) for name in ("contact_front", "contact_rear", "_kept_at", "_kept_count")),
    ]


class StallState(ctypes.Structure):
    """Which wheels are stalled, and until when they have no drive."""

    left: bool
    right: bool
    _blocked_ms: int
    _relax_until_ms: int
    _seen_left: bool
    _seen_right: bool
    _fields_ = [
        ("_blocked_ms", _L),
        ("_relax_until_ms", _L),
        *((name, _B) for name in ("left", "right", "_seen_left", "_seen_right")),
    ]


class EnergyState(ctypes.Structure):
    """Energy account."""

    idle_s: float
    sonar_s: float
    wheel_m: float
    accel_j: float
    _fields_ = [(name, _D) for name in ("idle_s", "sonar_s", "wheel_m", "accel_j")]


class RobotState(ctypes.Structure):
    """The clock, and what the rules of the robot ask."""

    now_ms: int
    last_heard_ms: int
    bumpers: int
    rear_segments: int
    fault_bumpers: int
    anport: int
    connected: bool
    watchdog_stops: bool
    fires_in_turn: bool
    _fields_ = [
        ("now_ms", _L),
        ("last_heard_ms", _L),
        *((name, _I) for name in ("bumpers", "rear_segments", "fault_bumpers", "anport")),
        *((name, _B) for name in ("connected", "watchdog_stops", "fires_in_turn")),
    ]
