# SPDX-License-Identifier: MIT
"""The robot's body on its way: true pose, odometry, and what happens where a solid is in the way."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from hil_sim.robot.interfaces import Body, Contact
from hil_sim.robot.state import HISTORY, ChassisState
from hil_sim.tables.robot import RobotTable
from hil_sim.world.model import Pose
from hil_sim.world.physics import PLAIN, Physics
from hil_sim.world.step import STEP_MS

DEG: Final = math.pi / 180
_TOUCH_RELEASE_MM: Final = 5.0
_BISECTIONS: Final = 7
_LOOK_MS: Final = 50
SLIP_STRETCH_MM: Final = 100.0
"""For each stretch it is drawn whether the wheels slip on it."""
SLIP_GRIP: Final = 0.5
"""Part of the way of slipping wheels that the body makes."""


@dataclass(frozen=True)
class OdometryError:
    """How far the wheels lie: standard deviations of errors drawn once per robot."""

    distance: float = 0.002
    turn: float = 0.002
    drift_deg_per_m: float = 0.1


class Slip:
    """Stretches of the way on which the wheels slip and the body is left behind."""

    def __init__(self, share: float, rng: random.Random) -> None:
        self._share, self._rng = share, rng
        self._left_mm = 0.0
        self._slips = False

    def grip(self, ds: float) -> float:
        """Return the part of a step of the wheels that the body makes."""
        if self._left_mm <= 0:
            self._left_mm = SLIP_STRETCH_MM
            self._slips = self._rng.random() < self._share
        self._left_mm -= abs(ds)
        return SLIP_GRIP if self._slips else 1.0


class Chassis(ChassisState):
    """True pose and odometry of a body among solids.

    `on_hit(moved_in)` is called when the body meets a solid; `moved_in`: the solid came to it.
    """

    def __init__(
        self,
        body: Body,
        start: Pose,
        table: RobotTable,
        error: OdometryError,
        seed: int,
        *,
        physics: Physics = PLAIN,
        moving: bool,
        dynamic: bool,
        on_hit: Callable[[bool], None],
    ) -> None:
        """`moving`: solids move by themselves and tell when; `dynamic`: some may, of which nothing is known."""
        self.body = body
        self._swing_mm = table.body.swing_mm
        self._track_mm = table.motion["track_mm"]
        self._moving = moving
        # While the nearest solid cannot have arrived no look is needed; of `dynamic` alone nothing is known.
        self._knows_free = moving or not dynamic
        self._on_hit = on_hit
        rng = random.Random(f"odometry {seed}")
        self.true_distance = 1 + rng.gauss(0, error.distance)
        self.true_turn = 1 + rng.gauss(0, error.turn)
        self._drift_deg_mm = rng.gauss(0, error.drift_deg_per_m) / 1000
        # The size is as asked for, the sign is drawn.
        wheels = random.Random(f"wheels {seed}")
        self.true_distance *= 1 + wheels.choice((-1, 1)) * physics.odometry_scale
        self._drift_deg_mm += wheels.choice((-1, 1)) * physics.odometry_drift_deg_m / 1000
        self._slip = Slip(physics.slip, wheels) if physics.slip else None
        self._pose = start
        self._pose_th = start.heading_deg
        self.x = start.x_mm
        self.y = start.y_mm
        self.th = start.heading_deg
        self.odo_x = self.odo_y = self.odo_th = 0.0
        self.left_mm = self.right_mm = 0.0
        self.travelled_mm = 0.0
        self.collisions = 0
        self.contact_front = 0
        self.contact_rear = 0
        self._touching = False
        self.free_mm = 0.0
        self._places = self._kept
        self._forget()

    @property
    def is_special(self) -> bool:
        """Wheels may slip, or solids may move of which nothing is known."""
        return self._slip is not None or not self._knows_free

    @property
    def pose(self) -> Pose:
        """The true pose; heading in (-180, 180]."""
        pose = self._pose
        if pose.x_mm != self.x or pose.y_mm != self.y or self._pose_th != self.th:
            self._pose = pose = Pose(self.x, self.y, wrapped(self.th))
            self._pose_th = self.th
        return pose

    def place(self, x_mm: float, y_mm: float, heading_deg: float) -> None:
        """Put the true robot elsewhere; odometry does not notice."""
        self.x, self.y, self.th = float(x_mm), float(y_mm), float(heading_deg)
        self._forget()
        self.free_mm = 0.0
        self._touching = False
        self.contact_front = self.contact_rear = 0

    def remember(self) -> None:
        """Note the pose at the end of a sub-step, for `pose_at`."""
        at = self._kept_at = (self._kept_at + 1) % HISTORY
        self._places[3 * at], self._places[3 * at + 1], self._places[3 * at + 2] = self.x, self.y, self.th
        self._kept_count = min(self._kept_count + 1, HISTORY)

    def _forget(self) -> None:
        """Let the history begin here."""
        self._kept_count = 0
        self.remember()

    def _place(self, back: int) -> tuple[float, float, float]:
        at = 3 * ((self._kept_at - back) % HISTORY)
        return self._places[at], self._places[at + 1], self._places[at + 2]

    def pose_at(self, back_ms: float) -> Pose:
        """The true pose so long ago (up to 0.6 s), between sub-steps on a straight line."""
        if back_ms == 0:
            return self.pose
        back = min(max(back_ms, 0.0) / STEP_MS, self._kept_count - 1.0)
        k = int(back)
        x, y, th = self._place(k)
        part = back - k
        if part > 0:
            x2, y2, th2 = self._place(k + 1)
            x, y, th = x + (x2 - x) * part, y + (y2 - y) * part, th + (th2 - th) * part
        return Pose(x, y, wrapped(th))

    # ---- the way

    def displace(self, ds: float, dth: float, now_ms: float) -> float:
        """Move the body as far as the solids let it; return the part of the step that was possible."""
        true_ds = ds * self.true_distance
        true_dth = dth * self.true_turn + ds * self._drift_deg_mm
        if self._slip is not None:
            true_ds *= self._slip.grip(ds)
        self.free_mm -= abs(true_ds) + abs(true_dth) * DEG * self._swing_mm
        part = 1.0
        if self.free_mm <= 0:
            part = self._free_part(true_ds, true_dth, now_ms)
        if part > 0:
            self.x, self.y, self.th = _moved(self.x, self.y, self.th, true_ds * part, true_dth * part)
            self._count(ds * part, dth * part)
            self.travelled_mm += abs(true_ds) * part
        if part == 1 and self.free_mm <= 0 and (self._touching or self._knows_free):
            self._measure_clearance()
        return part

    def _count(self, ds: float, dth: float) -> None:
        """Let the encoders see a step."""
        self.odo_x, self.odo_y, self.odo_th = _moved(self.odo_x, self.odo_y, self.odo_th, ds, dth)
        half = dth * DEG * self._track_mm / 2
        self.left_mm += ds - half
        self.right_mm += ds + half

    def _free_part(self, ds: float, dth: float, now_ms: float) -> float:
        contact = self._contact_after(ds, dth, now_ms)
        if contact is None:
            return 1.0
        here = self.body.contact(self.pose, now_ms)
        if here is not None:
            return self._part_inside(here, ds)
        if self._touching:
            self._touch(contact)
            return 0.0
        low, high = 0.0, 1.0
        for _ in range(_BISECTIONS):
            middle = (low + high) / 2
            found = self._contact_after(ds * middle, dth * middle, now_ms)
            if found is None:
                low = middle
            else:
                high, contact = middle, found
        self._touch(contact)
        self._collide()
        return low

    def _part_inside(self, here: Contact, ds: float) -> float:
        """Already inside a solid (placed there, or it moved in): only the way out is open."""
        self._touch(here)
        if self._moving and not self._touching:
            self._collide()
        self._touching = True
        inward = (ds > 0 and here.front_segments) or (ds < 0 and here.rear_segments)
        return 0.0 if inward else 1.0

    def _contact_after(self, ds: float, dth: float, now_ms: float) -> Contact | None:
        x, y, th = _moved(self.x, self.y, self.th, ds, dth)
        return self.body.contact(Pose(x, y, wrapped(th)), now_ms)

    def _touch(self, contact: Contact) -> None:
        self.contact_front = contact.front_segments
        self.contact_rear = contact.rear_segments

    def _collide(self, moved_in: bool = False) -> None:
        self._touching = True
        self.free_mm = 0.0
        if not moved_in:
            self.collisions += 1
        self._on_hit(moved_in)

    def _measure_clearance(self) -> None:
        clearance = self.body.clearance_mm(self.pose)
        self.free_mm = clearance if self._knows_free else 0.0
        if self._touching and clearance > _TOUCH_RELEASE_MM:
            self._touching = False
            self.contact_front = self.contact_rear = 0

    def look_for_contact(self, now_ms: int) -> None:
        """At rest: a solid that moves by itself may meet the body."""
        if now_ms % _LOOK_MS or (self._moving and self.free_mm > 0):
            return
        contact = self.body.contact(self.pose, now_ms)
        if contact is not None:
            self._touch(contact)
            if not self._touching:
                self._collide(moved_in=True)
        elif self._touching or self._moving:
            self._measure_clearance()


def _moved(x: float, y: float, th: float, ds: float, dth: float) -> tuple[float, float, float]:
    middle = (th + dth / 2) * DEG
    return x + ds * math.cos(middle), y + ds * math.sin(middle), th + dth


def wrapped(deg: float) -> float:
    """The same angle in (-180, 180]."""
    return deg if -180 < deg <= 180 else 180 - (180 - deg) % 360
