# SPDX-License-Identifier: MIT
"""The motion controller: set points from the client, speeds from one sub-step to the next.

It works in odometry space, as the real one does with its encoders.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Final, NamedTuple

from hil_sim.arcos import DEFAULT
from hil_sim.robot.chassis import DEG, Chassis
from hil_sim.robot.motion import approach, proportional, ramp
from hil_sim.robot.state import DriveState, SettingsState
from hil_sim.tables.robot import RobotTable
from hil_sim.world.step import STEP_S

MOVE_GAIN: Final = 0.2
"""1/s: MobileSim has made 806 mm of MOVE 1000 after 8.5 s (measured)."""
HEAD_GAIN: Final = 1.0
"""1/s: MobileSim needs 3.7 s for HEAD 20, to within the half degree that it reports (measured)."""


Law = Callable[[float, float, float, float, float], tuple[float, bool]]
"""How a place is approached: as `approach`."""


class Settings(SettingsState):
    """Run-time values that return to FLASH on CLOSE and RESET."""

    def __init__(self, **limits: float) -> None:
        super().__init__(bumpstall=DEFAULT["BUMPSTALL"], **limits)
        self.estall = True
        self.joydrive = False
        self.config: dict[str, int] = {}


def flash_settings(table: RobotTable) -> Settings:
    """Return the values that a robot has at power-up."""
    motion = table.motion
    return Settings(
        v_max=float(motion["vel_max_mm_s"]),
        rv_max=float(motion["rotvel_max_deg_s"]),
        accel=float(motion["accel_mm_s2"]),
        decel=float(motion["decel_mm_s2"]),
        raccel=float(motion["rotaccel_deg_s2"]),
        rdecel=float(motion["rotdecel_deg_s2"]),
    )


class Step(NamedTuple):
    """What one sub-step asks for, and whether it ends a MOVE or a HEAD."""

    ds_mm: float
    dth_deg: float
    moved: bool
    turned: bool


class Drive(DriveState):
    """Two channels, translation and rotation, each with a speed or a place as its set point.

    v, w: speeds now, mm/s and deg/s. motors: powered; without power commands are not taken.
    """

    def __init__(self, chassis: Chassis, table: RobotTable) -> None:
        self._chassis = chassis
        self.wheels = (1.0, 1.0)
        self._motion = table.motion
        self._track_mm = table.motion["track_mm"]
        self.settings = flash_settings(table)
        self.motors = False
        self._move_law: Law = approach
        self._head_law: Law = approach
        self.v = self.w = 0.0
        self._move_mode = self._head_mode = self._vel2 = False
        self._v_set = self._w_set = 0.0
        self._move_left = self._head_left = 0.0
        self._head_set = 0.0

    @property
    def wheels(self) -> tuple[float, float]:
        """The part that the left and the right wheel turn of what they should."""
        return self._left_part, self._right_part

    @wheels.setter
    def wheels(self, parts: tuple[float, float]) -> None:
        self._left_part, self._right_part = parts

    @property
    def is_plain(self) -> bool:
        """Places are approached as the robot does it."""
        return self._move_law is approach and self._head_law is approach

    def approach_proportionally(self) -> None:
        """End MOVE and HEAD slower and slower from now on, as the vendor's emulator does, not as a trapezoid."""
        self._move_law = partial(proportional, gain=MOVE_GAIN)
        self._head_law = partial(proportional, gain=HEAD_GAIN)

    # ---- commands

    def set_accel(self, value: int) -> None:
        """SETA: positive acceleration, negative deceleration, 0 changes nothing."""
        limit = min(float(abs(value)), float(self._motion["accel_top_mm_s2"]))
        if value > 0:
            self.settings.accel = limit
        elif value < 0:
            self.settings.decel = limit

    def set_turn_accel(self, value: int) -> None:
        """SETRA: as SETA, for turning."""
        limit = min(float(abs(value)), float(self._motion["rotaccel_top_deg_s2"]))
        if value > 0:
            self.settings.raccel = limit
        elif value < 0:
            self.settings.rdecel = limit

    def set_speed(self, value: int) -> None:
        """SETV: speed of MOVE and cap of VEL."""
        self.settings.v_max = min(float(abs(value)), float(self._motion["vel_top_mm_s"]))

    def set_turn_speed(self, value: int) -> None:
        """SETRV: speed of HEAD and cap of RVEL."""
        self.settings.rv_max = min(float(abs(value)), float(self._motion["rotvel_top_deg_s"]))

    def _leave_vel2(self) -> None:
        if self._vel2:
            self._vel2 = False
            self._v_set = self._w_set = 0.0

    def vel(self, mm_s: float) -> None:
        """VEL: translate."""
        if self.motors:
            self._leave_vel2()
            self._move_mode = False
            self._v_set = float(mm_s)

    def rvel(self, deg_s: float) -> None:
        """RVEL, ROTATE: turn."""
        if self.motors:
            self._leave_vel2()
            self._head_mode = False
            self._w_set = float(deg_s)

    def vel2(self, left_mm_s: float, right_mm_s: float) -> None:
        """VEL2: both wheels; split into translation and rotation, each with its own limits."""
        if self.motors:
            self._move_mode = self._head_mode = False
            self._vel2 = True
            self._v_set = (left_mm_s + right_mm_s) / 2
            self._w_set = (right_mm_s - left_mm_s) / self._track_mm / DEG

    def move(self, mm: float) -> None:
        """MOVE: end `mm` ahead of here, at rest."""
        if self.motors:
            self._leave_vel2()
            self._move_mode = True
            self._move_left = float(mm)

    def head(self, deg: float) -> None:
        """HEAD: turn to an absolute odometry heading, the shortest way."""
        if self.motors:
            self._leave_vel2()
            self._head_mode = True
            self._head_left = math.remainder(deg - self._chassis.odo_th, 360)
            self._head_set = deg

    def dhead(self, deg: float) -> None:
        """DHEAD: turn relative to the heading now, the shortest way."""
        if self.motors:
            turn = math.remainder(deg, 360)
            self.head(self._chassis.odo_th + turn)
            self._head_left = turn

    def dchead(self, deg: float) -> None:
        """DCHEAD: turn relative to the heading set point."""
        self.head((self._head_set if self._head_mode else self._chassis.odo_th) + deg)

    def stop(self) -> None:
        """STOP: brake with the set decelerations; motors stay on."""
        self._move_mode = self._head_mode = self._vel2 = False
        self._v_set = self._w_set = 0.0
        self._move_left = self._head_left = 0.0

    def halt(self) -> None:
        """E_STOP: stand still at once."""
        self.stop()
        self.v = self.w = 0.0

    def set_odometry(self, x_mm: float, y_mm: float, heading_deg: float) -> None:
        """Let odometry say that the robot is there; a turn that is under way goes on."""
        chassis = self._chassis
        self._head_set += heading_deg - chassis.odo_th
        chassis.odo_x, chassis.odo_y, chassis.odo_th = x_mm, y_mm, heading_deg

    # ---- state

    @property
    def ahead(self) -> float:
        """The set point of the translation: its sign says which way."""
        return self._move_left if self._move_mode else self._v_set

    @property
    def has_set_point(self) -> bool:
        """Some set point is not yet reached."""
        rotation = self._head_left if self._head_mode else self._w_set
        return self.ahead != 0 or rotation != 0

    @property
    def turn_left(self) -> float:
        """Degrees left of a HEAD, 0 without one."""
        return self._head_left if self._head_mode else 0.0

    def wheel_speeds(self) -> tuple[float, float]:
        """Left and right, mm/s."""
        half = self.w * DEG * self._track_mm / 2
        return (self.v - half) * self._left_part, (self.v + half) * self._right_part

    def _as_wheels_turn(self, ds: float, dth: float) -> tuple[float, float]:
        """What is made of a step by wheels that turn less than they should: the encoders see it so as well."""
        left, right = self._left_part, self._right_part
        if left == right == 1.0:
            return ds, dth
        half = dth * DEG * self._track_mm / 2
        made_left, made_right = (ds - half) * left, (ds + half) * right
        return (made_left + made_right) / 2, (made_right - made_left) / self._track_mm / DEG

    # ---- time

    def coast(self) -> Step:
        """A sub-step without power: only friction brakes the wheels, far stronger than any set deceleration."""
        return self._brake(self._motion["accel_top_mm_s2"], self._motion["rotaccel_top_deg_s2"])

    def brake(self) -> Step:
        """A sub-step of braking with the set decelerations, whatever the set points are."""
        return self._brake(self.settings.decel, self.settings.rdecel)

    def _brake(self, decel: float, rdecel: float) -> Step:
        v_old, w_old = self.v, self.w
        self.v, self.w = ramp(v_old, 0.0, 0.0, decel), ramp(w_old, 0.0, 0.0, rdecel)
        ds, dth = self._as_wheels_turn((v_old + self.v) / 2 * STEP_S, (w_old + self.w) / 2 * STEP_S)
        return Step(ds, dth, False, False)

    def follow(self) -> Step:
        """A sub-step towards the set points."""
        settings = self.settings
        v_old, w_old = self.v, self.w
        moved = turned = False
        if self._move_mode:
            top = settings.v_max
            self.v, moved = self._move_law(v_old, self._move_left, top, settings.accel, settings.decel)
        else:
            target = max(-settings.v_max, min(settings.v_max, self._v_set))
            self.v = ramp(v_old, target, settings.accel, settings.decel)
        if self._head_mode:
            top = settings.rv_max
            self.w, turned = self._head_law(w_old, self._head_left, top, settings.raccel, settings.rdecel)
        else:
            target = max(-settings.rv_max, min(settings.rv_max, self._w_set))
            self.w = ramp(w_old, target, settings.raccel, settings.rdecel)
        ds = self._move_left if moved else (v_old + self.v) / 2 * STEP_S
        dth = self._head_left if turned else (w_old + self.w) / 2 * STEP_S
        return Step(*self._as_wheels_turn(ds, dth), moved, turned)

    def done(self, step: Step, part: float) -> None:
        """Account for the part of a step that was possible, by the encoders.

        A HEAD that is done stays done: what turns the robot on its way afterwards is not held against.
        """
        if self._move_mode:
            self._move_left = 0.0 if step.moved and part == 1 else self._move_left - step.ds_mm * part
        if self._head_mode and self._head_left:
            self._head_left = 0.0 if step.turned and part == 1 else self._head_left - step.dth_deg * part
