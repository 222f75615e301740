# SPDX-License-Identifier: MIT
"""The robot behind the ARCOS server: motion, odometry, bumpers, stalls, battery, and what a SIP says of them.

Time is virtual: `advance` moves it in fixed sub-steps and nothing here reads a clock. The controller works in
odometry space, as the real one does with its encoders; the true pose follows with a small error of its own.
"""

from __future__ import annotations

import math
import random
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final, Protocol

from hil_sim.arcos import (
    BUMPSTALL,
    DEFAULT,
    FLAG,
    MOTION,
    SIP,
    SONAR_CYCLE_MS,
    TIMING,
    TYPE,
    ConfigPac,
    EncoderPac,
    IoPac,
    SimStat,
    Sip,
)
from hil_sim.energy import Energy
from hil_sim.faults import FaultChange
from hil_sim.motion import STEP_MS, STEP_S, approach, ramp
from hil_sim.tables import load
from hil_sim.world import Pose

_STATE_EVERY_MS: Final = 100
_DEG: Final = math.pi / 180
_TRACK_MM: Final[float] = MOTION["track_mm"]
_SWING_MM: Final[float] = load("robots/p3dx-sh")["body"]["swing_radius_mm"]
_WATCHDOG_MS: Final = TIMING["WATCHDOG_MS"]
_TOUCH_RELEASE_MM: Final = 5.0
_BUMPER_MASK: Final = SIP["BUMPER_MASK"]
_STALLS_FRONT: Final = BUMPSTALL["FRONT"]
_STALLS_REAR: Final = BUMPSTALL["REAR"]

Log = Callable[[str, dict[str, Any]], None]
"""Receives one truth record: its type and its fields, `t_s` included."""


class Contact(Protocol):
    """Where the body meets a solid."""

    @property
    def front_segments(self) -> int:
        """Bit mask as in the SIP: bits 1 to 5, leftmost to rightmost front segment."""

    @property
    def rear_segments(self) -> int:
        """Bit mask as in the SIP for the rear."""


class Body(Protocol):
    """What the robot asks of the physics of its body."""

    def contact(self, pose: Pose, now_ms: float) -> Contact | None:
        """Return the contact at a pose, None when free."""

    def clearance_mm(self, pose: Pose) -> float:
        """Return the distance from the body to the nearest solid."""


class Moving(Protocol):
    """What the robot asks of solids that move by themselves."""

    def step(self, robot: Pose) -> None:
        """Let a sub-step pass; the robot's true pose is given for those that wait for it."""

    @property
    def fastest_mm_s(self) -> float:
        """No point of any of them is faster."""


class SonarReading(Protocol):
    """One reading as the ring gives it."""

    @property
    def t_ms(self) -> float:
        """When it was completed."""

    @property
    def number(self) -> int:
        """Sonar 0 to 15, as in the SIP."""

    @property
    def range_mm(self) -> int:
        """What is reported."""

    @property
    def true_mm(self) -> int:
        """What a faultless sonar would have reported."""

    @property
    def fault(self) -> str | None:
        """The fault kind that made it, if any."""


class Ring(Protocol):
    """What the robot asks of its sonar arrays."""

    enabled: list[bool]
    cycle_ms: int

    def set_polling(self, numbers: Sequence[int]) -> None:
        """Take a POLLING string: one-based transducer numbers."""

    def reset(self) -> None:
        """Return to the default firing order."""

    def advance(self, now_ms: float, pose_at: Callable[[float], Pose]) -> Sequence[SonarReading]:
        """Fire what is due up to now; return the readings completed."""

    def fire_all(self, now_ms: float, pose: Pose) -> Sequence[SonarReading]:
        """Return a reading of every sonar of the enabled arrays, without noise."""


class Faults(Protocol):
    """What the robot asks of the injected faults."""

    def update(self, now_ms: float, pose: Pose, travelled_mm: float) -> Sequence[FaultChange]:
        """Switch faults on and off; return the changes."""

    def bumper(self, now_ms: float) -> int:
        """Return the front bumper bits that a fault presses."""


@dataclass(frozen=True)
class OdometryError:
    """How far the wheels lie: standard deviations of errors drawn once per robot."""

    distance: float = 0.002
    turn: float = 0.002
    drift_deg_per_m: float = 0.1


@dataclass
class Settings:
    """Run-time values that return to FLASH on CLOSE and RESET."""

    v_max: float = float(MOTION["vel_max_mm_s"])
    rv_max: float = float(MOTION["rotvel_max_deg_s"])
    accel: float = float(MOTION["accel_mm_s2"])
    decel: float = float(MOTION["decel_mm_s2"])
    raccel: float = float(MOTION["rotaccel_deg_s2"])
    rdecel: float = float(MOTION["rotdecel_deg_s2"])
    bumpstall: int = DEFAULT["BUMPSTALL"]
    estall: bool = True
    joydrive: bool = False
    config: dict[str, int] = field(default_factory=dict)


class Robot:
    """A P3-DX in a world: commands in, true pose, odometry, sonar readings and packets out."""

    def __init__(
        self,
        body: Body,
        ring: Ring,
        start: Pose,
        *,
        faults: Faults | None = None,
        bumpers: int = 5,
        rear_bumpers: int = 0,
        seed: int = 0,
        odometry_error: OdometryError | None = None,
        dynamic: bool = False,
        moving: Moving | None = None,
        log: Log | None = None,
    ) -> None:
        """`dynamic`: solids may move by themselves, so contact is looked for at rest too; `moving` are such."""
        self.body = body
        self.ring = ring
        self.faults = faults
        self.start = start
        self.bumpers = bumpers
        self.rear_segments = rear_bumpers
        self.dynamic = dynamic or moving is not None
        self.moving = moving
        # While the nearest solid cannot have arrived nobody needs to look; of `dynamic` alone nothing is known.
        self._knows_free = moving is not None or not dynamic
        self._closing_mm = moving.fastest_mm_s * STEP_S if moving is not None else 0.0
        self.log = log
        error = odometry_error or OdometryError()
        rng = random.Random(f"odometry {seed}")
        self._true_distance = 1 + rng.gauss(0, error.distance)
        self._true_turn = 1 + rng.gauss(0, error.turn)
        self._drift_deg_mm = rng.gauss(0, error.drift_deg_per_m) / 1000

        self.now_ms = 0
        self._debt_ms = 0.0
        self._pose = start
        self._pose_th = start.heading_deg
        self.x = start.x_mm
        self.y = start.y_mm
        self.th = start.heading_deg
        self.travelled_mm = 0.0
        self.odo_x = self.odo_y = self.odo_th = 0.0
        self.left_mm = self.right_mm = 0.0
        self.v = self.w = 0.0
        self.energy = Energy()
        self.settings = Settings()
        self.motors = False
        self.connected = False
        self.watchdog_stops = True
        self.fires_in_turn = True
        self.unit_mm = 1.0
        self.estop_pressed = False
        self.estalled = False
        self.last_heard_ms = 0
        self.anport = 0
        self.digout = 0
        self.battery_test_dv = 0
        self.collisions = 0
        self.fault_bumpers = 0
        self.contact_front = 0
        self.contact_rear = 0
        self._readings: list[SonarReading] = []
        self._stall_left = self._stall_right = False
        self._stall_seen_left = self._stall_seen_right = False
        self._blocked_ms = 0
        self._relax_until_ms = 0
        self._touching = False
        self._free_mm = 0.0
        self._logged_bumpers = 0
        self._watchdog_logged = False
        self._history: deque[tuple[float, float, float]] = deque([(self.x, self.y, self.th)], maxlen=64)
        self._move_mode = self._head_mode = self._vel2 = False
        self._v_set = self._w_set = 0.0
        self._move_left = self._head_left = 0.0
        self._head_set = 0.0
        ring.enabled[:] = [False] * len(ring.enabled)

    # ---- commands

    def heard(self) -> None:
        """A packet arrived: re-arm the watchdog."""
        self.last_heard_ms = self.now_ms

    def open(self) -> None:
        """Start a session: odometry at zero, sonar on, motors off."""
        self.connected = True
        self.heard()
        self._to_flash()
        self.set_origin()
        self.sonar(1)
        self._readings.clear()

    def close(self) -> None:
        """End a session: motors and sonar off, FLASH values back."""
        self.connected = False
        self.enable(False)
        self.sonar(0)
        self._to_flash()
        self._readings.clear()

    def _to_flash(self) -> None:
        self.settings = Settings()
        self.battery_test_dv = 0
        self.estalled = False
        self.ring.reset()
        self.ring.cycle_ms = SONAR_CYCLE_MS

    def enable(self, on: bool) -> None:
        """Motors on or off; off also forgets the set points."""
        self.motors = on and not self.estop_pressed
        if self.motors:
            self.estalled = False
        else:
            self._clear_set_points()

    def _clear_set_points(self) -> None:
        self._move_mode = self._head_mode = self._vel2 = False
        self._v_set = self._w_set = 0.0
        self._move_left = self._head_left = 0.0

    def press_estop(self, pressed: bool) -> None:
        """The emergency stop button, which some models have: motors stay off after its release."""
        self.estop_pressed = pressed
        if pressed:
            self.estalled = self.settings.estall
            self.v = self.w = 0.0
            self.enable(False)

    def set_accel(self, value: int) -> None:
        """SETA: positive acceleration, negative deceleration, 0 changes nothing."""
        limit = min(float(abs(value)), float(MOTION["accel_top_mm_s2"]))
        if value > 0:
            self.settings.accel = limit
        elif value < 0:
            self.settings.decel = limit

    def set_turn_accel(self, value: int) -> None:
        """SETRA: as SETA, for turning."""
        limit = min(float(abs(value)), float(MOTION["rotaccel_top_deg_s2"]))
        if value > 0:
            self.settings.raccel = limit
        elif value < 0:
            self.settings.rdecel = limit

    def set_speed(self, value: int) -> None:
        """SETV: speed of MOVE and cap of VEL."""
        self.settings.v_max = min(float(abs(value)), float(MOTION["vel_top_mm_s"]))

    def set_turn_speed(self, value: int) -> None:
        """SETRV: speed of HEAD and cap of RVEL."""
        self.settings.rv_max = min(float(abs(value)), float(MOTION["rotvel_top_deg_s"]))

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
            self._w_set = (right_mm_s - left_mm_s) / _TRACK_MM / _DEG

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
            self._head_left = math.remainder(deg - self.odo_th, 360)
            self._head_set = deg

    def dhead(self, deg: float) -> None:
        """DHEAD: turn relative to the heading now, the shortest way."""
        if self.motors:
            turn = math.remainder(deg, 360)
            self.head(self.odo_th + turn)
            self._head_left = turn

    def dchead(self, deg: float) -> None:
        """DCHEAD: turn relative to the heading set point."""
        self.head((self._head_set if self._head_mode else self.odo_th) + deg)

    def stop(self) -> None:
        """STOP: brake with the set decelerations; motors stay on."""
        self._clear_set_points()

    def emergency_stop(self) -> None:
        """E_STOP: stand still at once."""
        self._clear_set_points()
        self.v = self.w = 0.0

    def set_origin(self) -> None:
        """SETO: odometry becomes (0, 0, 0) here."""
        self.set_odometry(0.0, 0.0, 0.0)

    def set_odometry(self, x_mm: float, y_mm: float, heading_deg: float) -> None:
        """Let odometry say that the robot is there; a turn that is under way goes on."""
        self._head_set += heading_deg - self.odo_th
        self.odo_x, self.odo_y, self.odo_th = x_mm, y_mm, heading_deg

    def sonar(self, argument: int) -> None:
        """SONAR: bit 0 on or off, bits 1 to 3 the array, 0 for all; a P3-DX has arrays 1 and 2."""
        bits = abs(argument)
        array = bits >> 1 & 7
        for fitted in (1, 2):
            if array in (0, fitted):
                self.ring.enabled[fitted - 1] = bool(bits & 1)

    def sonar_cycle(self, ms: int) -> None:
        """SONAR_CYCLE: time between firings in an array."""
        low, high = TIMING["SONAR_CYCLE_MIN_MS"], TIMING["SONAR_CYCLE_MAX_MS"]
        if low <= ms <= high:
            self.ring.cycle_ms = ms

    def place(self, x_mm: float, y_mm: float, heading_deg: float) -> None:
        """Put the true robot elsewhere; odometry does not notice."""
        self.x, self.y, self.th = float(x_mm), float(y_mm), float(heading_deg)
        self._history.clear()
        self._history.append((self.x, self.y, self.th))
        self._free_mm = 0.0
        self._touching = False
        self.contact_front = self.contact_rear = 0

    def reset_pose(self) -> None:
        """Back to the start with odometry at zero."""
        self.place(self.start.x_mm, self.start.y_mm, self.start.heading_deg)
        self.set_origin()

    # ---- state

    @property
    def pose(self) -> Pose:
        """The true pose; heading in (-180, 180]."""
        pose = self._pose
        if pose.x_mm != self.x or pose.y_mm != self.y or self._pose_th != self.th:
            self._pose = pose = Pose(self.x, self.y, _wrapped(self.th))
            self._pose_th = self.th
        return pose

    @property
    def watchdog_expired(self) -> bool:
        """No packet for so long that the robot stops by itself."""
        quiet_ms = self.now_ms - self.last_heard_ms
        return self.connected and self.watchdog_stops and quiet_ms > _WATCHDOG_MS

    @property
    def sonar_on(self) -> bool:
        """Some array is firing."""
        return any(self.ring.enabled)

    @property
    def front_bumpers(self) -> int:
        """Front bumper bits as in the SIP."""
        return (self.contact_front | self.fault_bumpers) & _BUMPER_MASK if self.bumpers else 0

    @property
    def rear_bumpers(self) -> int:
        """Rear bumper bits as in the SIP."""
        return self.contact_rear & _BUMPER_MASK if self.rear_segments else 0

    @property
    def wants_motion(self) -> bool:
        """A set point is not yet reached and nothing forbids it."""
        if not self.motors or self.watchdog_expired:
            return False
        translation = self._move_left if self._move_mode else self._v_set
        rotation = self._head_left if self._head_mode else self._w_set
        return translation != 0 or rotation != 0

    @property
    def battery_v(self) -> float:
        """Terminal voltage: falls with the charge and with the load."""
        if self.battery_test_dv:
            return self.battery_test_dv / 10
        left, right = self._wheel_speeds()
        return self.energy.battery_v(self.sonar_on, abs(left) + abs(right))

    def _wheel_speeds(self) -> tuple[float, float]:
        half = self.w * _DEG * _TRACK_MM / 2
        return self.v - half, self.v + half

    def pose_at(self, t_ms: float) -> Pose:
        """The true pose at a recent time (up to 0.6 s ago), between sub-steps on a straight line."""
        if t_ms == self.now_ms:
            return self.pose
        back = min(max(self.now_ms - t_ms, 0.0) / STEP_MS, len(self._history) - 1.0)
        k = int(back)
        x, y, th = self._history[-1 - k]
        part = back - k
        if part > 0:
            x2, y2, th2 = self._history[-2 - k]
            x, y, th = x + (x2 - x) * part, y + (y2 - y) * part, th + (th2 - th) * part
        return Pose(x, y, _wrapped(th))

    # ---- time

    def advance(self, dt_ms: float) -> None:
        """Let `dt_ms` pass; what is left over from whole sub-steps is kept for the next call."""
        self._debt_ms += dt_ms
        while self._debt_ms >= STEP_MS:
            self._debt_ms -= STEP_MS
            self.step()

    def step(self) -> None:
        """Let one sub-step pass."""
        self.now_ms += STEP_MS
        if self.moving is not None:
            self.moving.step(self.pose)
            self._free_mm -= self._closing_mm
        if self.v or self.w or self.wants_motion:
            self._drive()
        elif self._stall_left or self._stall_right:
            self._stall_left = self._stall_right = False
        if self.dynamic:
            self._look_for_contact()
        self._history.append((self.x, self.y, self.th))
        if self.faults is not None:
            self._update_faults(self.faults)
        self.energy.idle_s += STEP_S
        if self.sonar_on:
            self.energy.sonar_s += STEP_S
            if self.fires_in_turn and (readings := self.ring.advance(self.now_ms, self.pose_at)):
                self._hear(readings)
        if self.log is not None:
            self._log_step(self.log)

    def _drive(self) -> None:
        settings = self.settings
        v_old, w_old = self.v, self.w
        moved = turned = False
        if not self.motors:
            # Without power only friction brakes the wheels: far stronger than any set deceleration.
            self.v = ramp(v_old, 0.0, 0.0, MOTION["accel_top_mm_s2"])
            self.w = ramp(w_old, 0.0, 0.0, MOTION["rotaccel_top_deg_s2"])
        elif self._is_relaxed():
            self.v = ramp(v_old, 0.0, 0.0, MOTION["accel_top_mm_s2"])
            self.w = ramp(w_old, 0.0, 0.0, MOTION["rotaccel_top_deg_s2"])
        elif self.watchdog_expired:
            self.v = ramp(v_old, 0.0, 0.0, settings.decel)
            self.w = ramp(w_old, 0.0, 0.0, settings.rdecel)
        else:
            if self._move_mode:
                top = settings.v_max
                self.v, moved = approach(v_old, self._move_left, top, settings.accel, settings.decel)
            else:
                target = max(-settings.v_max, min(settings.v_max, self._v_set))
                self.v = ramp(v_old, target, settings.accel, settings.decel)
            if self._head_mode:
                top = settings.rv_max
                self.w, turned = approach(w_old, self._head_left, top, settings.raccel, settings.rdecel)
            else:
                target = max(-settings.rv_max, min(settings.rv_max, self._w_set))
                self.w = ramp(w_old, target, settings.raccel, settings.rdecel)
        ds = self._move_left if moved else (v_old + self.v) / 2 * STEP_S
        dth = self._head_left if turned else (w_old + self.w) / 2 * STEP_S
        if ds or dth:
            part = self._displace(ds, dth)
            if self._move_mode:
                self._move_left = 0.0 if moved and part == 1 else self._move_left - ds * part
            if self._head_mode:
                self._head_left = 0.0 if turned and part == 1 else self._head_left - dth * part
        left, right = self._wheel_speeds()
        self.energy.drive((abs(left) + abs(right)) * STEP_S, self.v, self.w, v_old, w_old)

    def _is_relaxed(self) -> bool:
        """A stalled robot's wheels are without drive; a bumper counts as a stall in its own direction."""
        if self.now_ms < self._relax_until_ms:
            return True
        ahead = self._move_left if self._move_mode else self._v_set
        front = ahead > 0 and self.front_bumpers and self.settings.bumpstall & _STALLS_FRONT
        rear = ahead < 0 and self.rear_bumpers and self.settings.bumpstall & _STALLS_REAR
        hit = bool(front or rear)
        if hit or self._stall_left or self._stall_right:
            self._set_stall(hit, hit)
        return hit

    def _set_stall(self, left: bool, right: bool) -> None:
        self._stall_left, self._stall_right = left, right
        self._stall_seen_left |= left
        self._stall_seen_right |= right

    def _displace(self, ds: float, dth: float) -> float:
        """Move the body as far as the solids let it; return the part of the step that was possible."""
        true_ds = ds * self._true_distance
        true_dth = dth * self._true_turn + ds * self._drift_deg_mm
        self._free_mm -= abs(true_ds) + abs(true_dth) * _DEG * _SWING_MM
        part = 1.0
        if self._free_mm <= 0:
            part = self._free_part(true_ds, true_dth)
        if part > 0:
            self.x, self.y, self.th = _moved(self.x, self.y, self.th, true_ds * part, true_dth * part)
            ds, dth = ds * part, dth * part
            self.odo_x, self.odo_y, self.odo_th = _moved(self.odo_x, self.odo_y, self.odo_th, ds, dth)
            half = dth * _DEG * _TRACK_MM / 2
            self.left_mm += ds - half
            self.right_mm += ds + half
            self.travelled_mm += abs(true_ds) * part
        if part == 1:
            self._blocked_ms = 0
            if self._free_mm <= 0 and (self._touching or self._knows_free):
                self._measure_clearance()
        else:
            self._block()
        return part

    def _free_part(self, ds: float, dth: float) -> float:
        contact = self._contact_after(ds, dth)
        if contact is None:
            return 1.0
        here = self.body.contact(self.pose, self.now_ms)
        if here is not None:
            # Already inside a solid (placed there, or it moved in): only the way out is open.
            self._touch(here)
            if self.moving is not None and not self._touching:
                self._collide()
            self._touching = True
            inward = (ds > 0 and here.front_segments) or (ds < 0 and here.rear_segments)
            return 0.0 if inward else 1.0
        if self._touching:
            self._touch(contact)
            return 0.0
        low, high = 0.0, 1.0
        for _ in range(7):
            middle = (low + high) / 2
            found = self._contact_after(ds * middle, dth * middle)
            if found is None:
                low = middle
            else:
                high, contact = middle, found
        self._touch(contact)
        self._collide()
        return low

    def _contact_after(self, ds: float, dth: float) -> Contact | None:
        x, y, th = _moved(self.x, self.y, self.th, ds, dth)
        return self.body.contact(Pose(x, y, _wrapped(th)), self.now_ms)

    def _touch(self, contact: Contact) -> None:
        self.contact_front = contact.front_segments
        self.contact_rear = contact.rear_segments

    def _collide(self, moved_in: bool = False) -> None:
        self._touching = True
        self._free_mm = 0.0
        if not moved_in:
            self.collisions += 1
        if self.log is not None:
            fields = {
                "t_s": self.now_ms / 1000,
                "x_mm": round(self.x, 1),
                "y_mm": round(self.y, 1),
                "heading_deg": round(_wrapped(self.th), 2),
                "v_mm_s": round(self.v, 1),
                "front": self.contact_front,
                "rear": self.contact_rear,
            }
            self.log("struck" if moved_in else "collision", fields)

    def _block(self) -> None:
        """Against a solid: the wheels stand; after a while the stall monitor takes their power away."""
        left, right = self._wheel_speeds()
        self.v = self.w = 0.0
        self._blocked_ms += STEP_MS
        if self._blocked_ms >= TIMING["STALL_TIME_MS"]:
            self._blocked_ms = 0
            self._relax_until_ms = self.now_ms + DEFAULT["STALLCOUNT_MS"]
            self._set_stall(abs(left) > 0, abs(right) > 0)

    def _measure_clearance(self) -> None:
        clearance = self.body.clearance_mm(self.pose)
        self._free_mm = clearance if self._knows_free else 0.0
        if self._touching and clearance > _TOUCH_RELEASE_MM:
            self._touching = False
            self.contact_front = self.contact_rear = 0

    def _look_for_contact(self) -> None:
        """A solid that moves by itself may meet a robot that does not."""
        if self.v or self.w or self.now_ms % 50 or (self.moving is not None and self._free_mm > 0):
            return
        contact = self.body.contact(self.pose, self.now_ms)
        if contact is not None:
            self._touch(contact)
            if not self._touching:
                self._collide(moved_in=True)
        elif self._touching or self.moving is not None:
            self._measure_clearance()

    def _update_faults(self, faults: Faults) -> None:
        changes = faults.update(self.now_ms, self.pose, self.travelled_mm)
        self.fault_bumpers = faults.bumper(self.now_ms)
        if self.log is not None:
            for change in changes:
                self.log("fault", {"t_s": self.now_ms / 1000, **_fault_fields(change)})

    def fire_all(self) -> None:
        """Let every sonar fire now, as no real array does; the next SIP has all their readings."""
        if self.sonar_on:
            self._readings.clear()
            self._hear(self.ring.fire_all(self.now_ms, self.pose))

    def _hear(self, readings: Sequence[SonarReading]) -> None:
        self._readings += readings
        if self.log is not None:
            for reading in readings:
                fields = {"sonar": reading.number, "range_mm": reading.range_mm, "true_mm": reading.true_mm}
                self.log("sonar", {"t_s": round(reading.t_ms / 1000, 4), **fields, "fault": reading.fault})

    def _log_step(self, log: Log) -> None:
        now_s = self.now_ms / 1000
        if self.front_bumpers != self._logged_bumpers:
            self._logged_bumpers = self.front_bumpers
            log("bumper", {"t_s": now_s, "front": self._logged_bumpers})
        if self.watchdog_expired != self._watchdog_logged:
            self._watchdog_logged = not self._watchdog_logged
            log("watchdog", {"t_s": now_s, "expired": self._watchdog_logged})
        if self.now_ms % _STATE_EVERY_MS == 0:
            log("state", {"t_s": now_s, **self.state()})

    def state(self) -> dict[str, Any]:
        """The truth about the robot now, as the truth record holds it."""
        energy = self.energy
        return {
            "x_mm": round(self.x, 1),
            "y_mm": round(self.y, 1),
            "heading_deg": round(_wrapped(self.th), 2),
            "v_mm_s": round(self.v * self._true_distance, 1),
            "w_deg_s": round(self.w * self._true_turn, 2),
            "clearance_mm": round(self.body.clearance_mm(self.pose), 1),
            "energy_j": {
                "total": round(energy.total_j, 2),
                "idle_s": round(energy.idle_s, 2),
                "sonar_s": round(energy.sonar_s, 2),
                "wheel_m": round(energy.wheel_m, 4),
                "accel_j": round(energy.accel_j, 3),
            },
            "battery_v": round(self.battery_v, 3),
        }

    # ---- packets

    def sip(self) -> Sip:
        """The SIP due now; its readings and stall bits are those since the one before."""
        left, right = (round(speed) for speed in self._wheel_speeds())
        moving = abs(left) >= 1 or abs(right) >= 1 or self.wants_motion
        battery_dv = round(self.battery_v * 10)
        readings = tuple((reading.number, reading.range_mm) for reading in self._readings)
        packet = Sip.of(
            {
                "type": TYPE["SIP_MOVING"] if moving else TYPE["SIP_STATIONARY"],
                "x": round(self.odo_x / self.unit_mm) & 0xFFFF,
                "y": round(self.odo_y / self.unit_mm) & 0xFFFF,
                "th": _angle_units(self.odo_th),
                "left_vel": left,
                "right_vel": right,
                "battery": min(battery_dv, 255),
                "stall_left": self.rear_bumpers | int(self._stall_seen_left or self._stall_left),
                "stall_right": self.front_bumpers | int(self._stall_seen_right or self._stall_right),
                "flags": self._flags(),
                "sonars": readings,
                "anport": self.anport,
                "digout": self.digout,
                "battery_x10": battery_dv,
                "rotvel": round(self.w * 10),
            }
        )
        self._readings.clear()
        self._stall_seen_left = self._stall_seen_right = False
        return packet

    def _flags(self) -> int:
        flags = FLAG["MOTORS"] if self.motors else 0
        for array, name in enumerate(("SONAR1", "SONAR2")):
            if self.ring.enabled[array]:
                flags |= FLAG[name]
        if self.estop_pressed:
            flags |= FLAG["ESTOP"]
        return flags | (FLAG["ESTALL"] if self.estalled else 0)

    def config_pac(self, name: bytes, subclass: bytes) -> ConfigPac:
        """The CONFIGpac: FLASH values, those changed at run time in their place."""
        now = self.settings
        packet = ConfigPac(
            subtype=subclass,
            name=name,
            front_bumps=self.bumpers,
            rear_bumps=self.rear_segments,
            trans_vel_max=int(now.v_max),
            rot_vel_max=int(now.rv_max),
            trans_acc=int(now.accel),
            trans_decel=int(now.decel),
            rot_acc=int(now.raccel),
            rot_decel=int(now.rdecel),
            sonar_cycle_ms=self.ring.cycle_ms,
        )
        extra: dict[str, Any] = now.config
        return replace(packet, **extra)

    def encoder_pac(self) -> EncoderPac:
        """The ENCODERpac due now."""
        ticks = MOTION["ticks_per_mm"]
        return EncoderPac(round(self.left_mm * ticks), round(self.right_mm * ticks))

    def io_pac(self) -> IoPac:
        """The IOpac due now; bumper inputs are pulled up, so a pressed segment reads 0."""
        front, rear = ~self.front_bumpers & 0xFF, ~self.rear_bumpers & 0xFF
        battery = min(1023, round(self.battery_v / 20 * 1023))
        return IoPac(bytes((0xFF, front, rear, 0xFF)), bytes((self.digout,)), (0,) * 8 + (battery,))

    def sim_stat(self) -> SimStat:
        """The simulator's report of the true pose."""
        return SimStat(
            flags=0b10,
            interval_ms=STEP_MS,
            real_interval_ms=STEP_MS,
            last_interval_ms=STEP_MS,
            x_mm=round(self.x),
            y_mm=round(self.y),
            th_deg=round(_wrapped(self.th)),
        )


def _moved(x: float, y: float, th: float, ds: float, dth: float) -> tuple[float, float, float]:
    middle = (th + dth / 2) * _DEG
    return x + ds * math.cos(middle), y + ds * math.sin(middle), th + dth


def _wrapped(deg: float) -> float:
    """The same angle in (-180, 180]."""
    return deg if -180 < deg <= 180 else 180 - (180 - deg) % 360


def _angle_units(deg: float) -> int:
    turn = SIP["TURN"]
    return (round(deg * turn / 360) + turn // 2) % turn - turn // 2


def _fault_fields(change: FaultChange) -> dict[str, Any]:
    """A fault change as truth fields; which sonars it is about is a list whether it is one or none."""
    fields = change.as_record()
    return fields | {"active": fields.pop("on"), "sonars": [] if change.sonar is None else [change.sonar]}
