# SPDX-License-Identifier: MIT
"""Safety by the truth: S1, S4, S5 and S7 asked at every tick of the simulator, whatever the fault manager believes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from hil_sim.experiment.ground import Ground
from hil_sim.experiment.home import Home
from hil_sim.robot.interfaces import SonarReading
from hil_sim.sil import Sil
from hil_sim.tables.robot import robot_table
from hil_sim.world.body import BodyModel
from hil_sim.world.model import Pose

RULES: Final = ("S1", "S4", "S5", "S7")
CREEPS: Final = "CREEPING"
DRIVES_MM_S: Final = 5.0
TURNS_DEG_S: Final = 1.0
STEP_MM: Final = 200.0
OVER_MM: Final = 20.0
"""A step ends a little late, and odometry is off by a part of it."""
BRAKE_MM_S2: Final = 300.0
"""S5 counts on no harder braking, though a robot that is set so brakes harder."""
ANSWER_MS: Final = 200
"""From the verdict to the STOP that it calls for: a SIP and what the wire takes."""
_RECHECK_MM: Final = 20.0
_FAR_MM: Final = 500.0
"""No braking way is longer."""
_ABREAST: Final = np.linspace(-1.0, 1.0, 7)
_PARTS_DEG: Final = 3.0
_PARTS_MM: Final = 25.0
_MOST: Final = 20


class Breach(NamedTuple):
    """A rule broken: when, truly where, and in what way."""

    rule: str
    t_s: float
    x_mm: float
    y_mm: float
    says: str


class Safety:
    """Watches one mission.

    S1: with a sonar ahead out of use the leading end moves only over ground that a living sonar has looked at. Or it
    stays within a step of a place where living sonars looked along every blind bearing. S4: after sweeps and looks the
    heading is the one before. S5: the way that braking takes is free. S7: what a turn on the spot sweeps is free, and
    no bumper is pressed. While it creeps, which an operator must allow, nothing is seen. Then S5 asks for no more than
    that speed. breaches: the first of them; counts: of each rule.
    """

    def __init__(self, sil: Sil) -> None:
        self._sil, self._robot = sil, sil.robot
        table = robot_table(sil.mission.robot)
        self._table = table
        self._body = BodyModel(sil.world, None, table.body)
        self._ground = Ground(table)
        self.breaches: list[Breach] = []
        self.counts = dict.fromkeys(RULES, 0)
        self.closest_mm = math.inf
        self._reversed = False
        self._events = 0
        self._mode = ""
        self._home = Home()
        self._turned_deg = 0.0
        self._last_th = sil.robot.chassis.th
        self._clear: tuple[float, float, float] | None = None
        self._asked: tuple[float, float] = (-math.inf, 0.0)
        self._checked_mm: float | None = None
        self._turning = self._moves = False
        self._known_out: list[int] = []
        self._out_ms = 0

    def tick(self, news: Sequence[SonarReading]) -> None:
        """Take a sub-step of the robot. Cost: some microseconds, in motion a few more."""
        robot, drive, chassis = self._robot, self._robot.drive, self._robot.chassis
        self._turned_deg += abs(chassis.th - self._last_th)
        self._last_th = chassis.th
        for reading in news:
            if reading.fault is None:
                fired_ms = reading.t_ms - reading.true_mm * 2 / 343.0
                at_rest = abs(drive.v) <= DRIVES_MM_S
                self._ground.hear(reading, robot.pose_at(fired_ms), at_rest=at_rest)
        self._take_events()
        mode = self._sil.mode
        if mode != self._mode:
            self._ask_home(self._home.change(mode, chassis.th))
            self._mode = mode
        if drive.v == 0 and drive.w == 0:
            self._home.still(chassis.th)
        self._ask_turn(drive.v, drive.w)
        if abs(drive.v) > DRIVES_MM_S:
            self._ask_way(drive.v)
        elif self._moves:
            self._moves = False

    # ---- what the fault manager says and does

    def _take_events(self) -> None:
        events = self._sil.events
        heading = self._robot.chassis.th
        for event in events[self._events :]:
            if event.name == "REVERSED":
                self._reversed = event.value == 1
            self._ask_home(self._home.hear(event.name, event.value, heading))
        self._events = len(events)

    def _ask_home(self, wrong: str | None) -> None:
        """S4."""
        if wrong is not None:
            self._breach("S4", wrong)

    # ---- motion

    def _ask_turn(self, v: float, w: float) -> None:
        turning = abs(w) > TURNS_DEG_S and abs(v) <= DRIVES_MM_S
        if turning and not self._turning:
            self._ask_swept()
        if self._turning and not turning:
            self._home.rest(self._robot.chassis.th)
        self._turning = turning

    def _ask_swept(self) -> None:
        """S7."""
        robot = self._robot
        if robot.front_bumpers or robot.rear_bumpers:
            self._breach("S7", "turns with a bumper pressed")
        left = robot.drive.turn_left
        pose = robot.pose
        if self._body.clearance_mm(pose) > math.radians(abs(left)) * self._table.body.reach_mm:
            return
        for part in range(1, math.ceil(abs(left) / _PARTS_DEG) + 1):
            by = math.copysign(min(part * _PARTS_DEG, abs(left)), left)
            turned = Pose(pose.x_mm, pose.y_mm, pose.heading_deg + by)
            if self._body.contact(turned, 0.0) is not None:
                self._breach("S7", f"a solid lies {by:.0f} degrees into a turn of {left:.0f}")
                return

    def _ask_way(self, v: float) -> None:
        robot, chassis = self._robot, self._robot.chassis
        pose = robot.pose
        if not self._moves:
            self._moves = True
            self._checked_mm = chassis.travelled_mm if self._is_checked(pose) else None
            self._asked = (-math.inf, 0.0)
        clear = self._note_clearance(pose)
        if v > 0 or self._reversed:
            self._ask_braking(pose, v, clear)
        # What was ordered ahead, not what is left of it while the robot brakes.
        ahead = -robot.drive.ahead if self._reversed else robot.drive.ahead
        if ahead > 0 and chassis.travelled_mm - self._asked[0] >= _RECHECK_MM:
            self._asked = (chassis.travelled_mm, 0.0)
            self._ask_seen(pose)

    def _note_clearance(self, pose: Pose) -> float:
        """Return at most the distance from the nearest solid; measured only where it matters."""
        chassis = self._robot.chassis
        if self._clear is not None:
            clear, driven, turned = self._clear
            reach = math.radians(self._turned_deg - turned) * self._table.body.reach_mm
            bound = clear - (chassis.travelled_mm - driven) - reach
            if bound > max(self.closest_mm, _FAR_MM):
                return bound
        clear = self._body.clearance_mm(pose)
        self._clear = clear, chassis.travelled_mm, self._turned_deg
        self.closest_mm = min(self.closest_mm, clear)
        return clear

    def _ask_braking(self, pose: Pose, v: float, clear_mm: float) -> None:
        """S5."""
        if self._mode == CREEPS:
            if abs(v) > float(self._sil.mission.config.get("creep_mm_s", 0)) + DRIVES_MM_S:
                self._breach("S5", f"creeps at {abs(v):.0f} mm/s")
            return
        brake = v * v / (2 * BRAKE_MM_S2)
        if clear_mm > brake:
            return
        c, s = math.cos(math.radians(pose.heading_deg)), math.sin(math.radians(pose.heading_deg))
        for part in range(1, math.ceil(brake / _PARTS_MM) + 1):
            way = math.copysign(min(part * _PARTS_MM, brake), v)
            there = Pose(pose.x_mm + way * c, pose.y_mm + way * s, pose.heading_deg)
            if self._body.contact(there, 0.0) is not None:
                self._breach("S5", f"{abs(v):.0f} mm/s with a solid {abs(way):.0f} mm ahead")
                return

    def _forward(self) -> list[int]:
        return [n + 8 if self._reversed else n for n in self._table.forward]

    def _out(self) -> list[int]:
        """Sonars of the leading end that the fault manager has taken out of use."""
        health = self._sil.health
        return [n for n in self._forward() if health[n] and health[n][-1][1] in ("DISABLED", "PROBATION")]

    def _is_checked(self, pose: Pose) -> bool:
        bearings = [pose.heading_deg + self._table.mounts[n].heading_deg for n in self._out()]
        return self._ground.looked_along(bearings, pose)

    def _ask_seen(self, pose: Pose) -> None:
        """S1."""
        if self._mode == CREEPS:
            return
        out = self._out()
        if out != self._known_out:
            self._known_out, self._out_ms = out, self._robot.now_ms
        if not out or self._robot.now_ms - self._out_ms < ANSWER_MS:
            return
        driven = self._robot.chassis.travelled_mm
        if self._checked_mm is not None and driven - self._checked_mm <= STEP_MM + OVER_MM:
            return
        body = self._table.body
        c, s = math.cos(math.radians(pose.heading_deg)), math.sin(math.radians(pose.heading_deg))
        ahead = -body.rear_mm if self._reversed else body.front_mm
        side = _ABREAST * body.half_mm
        points = np.stack((pose.x_mm + ahead * c - side * s, pose.y_mm + ahead * s + side * c), axis=1)
        if not self._ground.is_seen(points, self._robot.now_ms):
            self._breach("S1", "moves on over ground that no living sonar has looked at")

    def _breach(self, rule: str, says: str) -> None:
        self.counts[rule] += 1
        if len(self.breaches) < _MOST:
            chassis = self._robot.chassis
            now_s = self._robot.now_ms / 1000
            self.breaches.append(Breach(rule, now_s, round(chassis.x), round(chassis.y), says))


def watch(sil: Sil) -> Safety:
    """Ask the rules at every tick of a mission from now on."""
    safety = Safety(sil)
    sil.robot.watch = safety.tick
    return safety
