# SPDX-License-Identifier: MIT
"""The robot behind the ARCOS server: drive, chassis, sonars, bumpers and battery, from one sub-step to the next.

Time is virtual: `advance` moves it in fixed sub-steps and nothing here reads a clock.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from hil_sim.arcos import BUMPSTALL, SIP, TIMING
from hil_sim.faults.kinds import FaultChange
from hil_sim.record.truth import Log
from hil_sim.robot.chassis import Chassis, OdometryError, wrapped
from hil_sim.robot.drive import Drive, Step, flash_settings
from hil_sim.robot.energy import Energy
from hil_sim.robot.interfaces import Body, Faults, Moving, Ring, SonarReading
from hil_sim.robot.sectors import Sectors
from hil_sim.robot.stall import StallMonitor
from hil_sim.robot.state import RobotState
from hil_sim.robot.ticks import Parts, Ticks, ticks_of
from hil_sim.tables.robot import RobotTable, robot_table
from hil_sim.world.model import Pose
from hil_sim.world.physics import PLAIN, Physics
from hil_sim.world.step import STEP_MS, STEP_S

_STATE_EVERY_MS: Final = 100
_WATCHDOG_MS: Final = TIMING["WATCHDOG_MS"]
_BUMPER_MASK: Final = SIP["BUMPER_MASK"]
_STALLS_FRONT: Final = BUMPSTALL["FRONT"]
_STALLS_REAR: Final = BUMPSTALL["REAR"]


class Robot(RobotState):
    """A robot in a world: commands in, true pose, odometry and sonar readings out.

    drive: what the motion commands act on. chassis: where the robot is and what it meets. stall: the stall monitor.
    """

    def __init__(
        self,
        body: Body,
        ring: Ring,
        start: Pose,
        *,
        table: RobotTable | None = None,
        faults: Faults | None = None,
        bumpers: int | None = None,
        rear_bumpers: int | None = None,
        seed: int = 0,
        odometry_error: OdometryError | None = None,
        physics: Physics = PLAIN,
        dynamic: bool = False,
        moving: Moving | None = None,
        log: Log | None = None,
        sectors: Sectors | None = None,
    ) -> None:
        """`table`: which robot it is; None is the one that is emulated by default. Bumpers: None is as the table says.

        `dynamic`: solids may move by themselves, so contact is looked for at rest too; `moving` are such.

        `sectors`: a laser among its sensors.
        """
        self.table = table = table if table is not None else robot_table()
        self.body = body
        self.ring = ring
        self.faults = faults
        self.start = start
        self.bumpers = table.body.front_bumpers if bumpers is None else bumpers
        self.rear_segments = table.body.rear_bumpers if rear_bumpers is None else rear_bumpers
        self.dynamic = dynamic or moving is not None
        self.moving = moving
        self._sectors = sectors
        self._closing_mm = moving.fastest_mm_s * STEP_S if moving is not None else 0.0
        self.log = log
        self.chassis = Chassis(
            body,
            start,
            table,
            odometry_error or OdometryError(),
            seed,
            physics=physics,
            moving=moving is not None,
            dynamic=dynamic,
            on_hit=self._hit,
        )
        self.drive = Drive(self.chassis, table)
        self.stall = StallMonitor()
        self.now_ms = 0
        self._debt_ms = 0.0
        self.energy = Energy()
        self.connected = False
        self.watchdog_stops = True
        self.fires_in_turn = True
        self.unit_mm = 1.0
        self.estop_pressed = False
        self.estalled = False
        self.last_heard_ms = 0
        self.digout = 0
        self.battery_test_dv = 0
        self.fault_bumpers = 0
        self._readings: list[SonarReading] = []
        self._logged_bumpers = 0
        self._watchdog_logged = False
        ring.enabled[:] = [False] * len(ring.enabled)
        parts = Parts(self, table, self.drive, self.chassis, self.stall, self.energy, ring, faults, moving)
        self._ticks: Ticks | None = ticks_of(parts)

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
        self._forget_readings()

    def close(self) -> None:
        """End a session: motors and sonar off, FLASH values back."""
        self.connected = False
        self.enable(False)
        self.sonar(0)
        self._to_flash()
        self._forget_readings()

    def _to_flash(self) -> None:
        self.drive.settings = flash_settings(self.table)
        self.battery_test_dv = 0
        self.estalled = False
        self.ring.reset()
        self.ring.cycle_ms = self.table.cycle_ms

    def enable(self, on: bool) -> None:
        """Motors on or off; off also forgets the set points."""
        self.drive.motors = on and not self.estop_pressed
        if self.drive.motors:
            self.estalled = False
        else:
            self.drive.stop()

    def press_estop(self, pressed: bool) -> None:
        """The emergency stop button, which some models have: motors stay off after its release."""
        self.estop_pressed = pressed
        if pressed:
            self.estalled = self.drive.settings.estall
            self.drive.halt()
            self.enable(False)

    def set_origin(self) -> None:
        """SETO: odometry becomes (0, 0, 0) here."""
        self.drive.set_odometry(0.0, 0.0, 0.0)

    def sonar(self, argument: int) -> None:
        """SONAR: bit 0 on or off, bits 1 to 3 the array, 0 for all; arrays that are not fitted stay off."""
        bits = abs(argument)
        array = bits >> 1 & 7
        for fitted in range(1, len(self.table.orders) + 1):
            if array in (0, fitted):
                self.ring.enabled[fitted - 1] = bool(bits & 1)

    def sonar_cycle(self, ms: int) -> None:
        """SONAR_CYCLE: time between firings in an array."""
        low, high = TIMING["SONAR_CYCLE_MIN_MS"], TIMING["SONAR_CYCLE_MAX_MS"]
        if low <= ms <= high:
            self.ring.cycle_ms = ms

    def reset_pose(self) -> None:
        """Back to the start with odometry at zero."""
        self.chassis.place(self.start.x_mm, self.start.y_mm, self.start.heading_deg)
        self.set_origin()

    # ---- state

    @property
    def pose(self) -> Pose:
        """The true pose; heading in (-180, 180]."""
        return self.chassis.pose

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
        return (self.chassis.contact_front | self.fault_bumpers) & _BUMPER_MASK if self.bumpers else 0

    @property
    def rear_bumpers(self) -> int:
        """Rear bumper bits as in the SIP."""
        return self.chassis.contact_rear & _BUMPER_MASK if self.rear_segments else 0

    @property
    def wants_motion(self) -> bool:
        """A set point is not yet reached and nothing forbids it."""
        return self.drive.motors and not self.watchdog_expired and self.drive.has_set_point

    @property
    def battery_v(self) -> float:
        """Terminal voltage: falls with the charge and with the load."""
        if self.battery_test_dv:
            return self.battery_test_dv / 10
        left, right = self.drive.wheel_speeds()
        return self.energy.battery_v(self.sonar_on, abs(left) + abs(right))

    def pose_at(self, t_ms: float) -> Pose:
        """The true pose at a recent time (up to 0.6 s ago), between sub-steps on a straight line."""
        return self.chassis.pose_at(self.now_ms - t_ms)

    # ---- time

    def advance(self, dt_ms: float) -> None:
        """Let `dt_ms` pass; what is left over from whole sub-steps is kept for the next call."""
        self._debt_ms += dt_ms
        while self._debt_ms >= STEP_MS:
            self._debt_ms -= STEP_MS
            self.step()

    def run(self, stop_ms: float, limit_ms: float) -> None:
        """Let sub-steps pass until `stop_ms`, none beyond `limit_ms`."""
        while self.now_ms + STEP_MS <= limit_ms:
            ticks = self._in_c()
            if ticks is not None and ticks.run(stop_ms, limit_ms):
                return
            self.step()
            if self.now_ms >= stop_ms:
                return

    def step(self) -> None:
        """Let one sub-step pass."""
        self.now_ms += STEP_MS
        if self.moving is not None:
            self.moving.step(self.pose)
            self.chassis.free_mm -= self._closing_mm
        self._move()
        self.chassis.remember()
        if self.faults is not None:
            self._update_faults(self.faults)
        self.energy.idle_s += STEP_S
        if self.sonar_on:
            self.energy.sonar_s += STEP_S
            if self.fires_in_turn and (readings := self.ring.advance(self.now_ms, self.pose_at)):
                self._hear(readings)
        if self.log is not None:
            self._log_step(self.log)

    def _move(self) -> None:
        drive = self.drive
        if drive.v or drive.w or self.wants_motion:
            self._drive()
        elif self.stall.left or self.stall.right:
            self.stall.clear()
        if self.dynamic and not drive.v and not drive.w:
            self.chassis.look_for_contact(self.now_ms)

    def _drive(self) -> None:
        drive = self.drive
        v_old, w_old = drive.v, drive.w
        step = self._next_step()
        if step.ds_mm or step.dth_deg:
            part = self.chassis.displace(step.ds_mm, step.dth_deg, self.now_ms)
            if part == 1:
                self.stall.free()
            else:
                self._block()
            drive.done(step, part)
        left, right = drive.wheel_speeds()
        self.energy.drive((abs(left) + abs(right)) * STEP_S, drive.v, drive.w, v_old, w_old)

    def _next_step(self) -> Step:
        drive = self.drive
        if not drive.motors or self._is_relaxed():
            return drive.coast()
        return drive.brake() if self.watchdog_expired else drive.follow()

    def _is_relaxed(self) -> bool:
        """A stalled robot's wheels are without drive; a bumper counts as a stall in its own direction."""
        if self.stall.is_relaxing(self.now_ms):
            return True
        hit = self._bumper_stalls(self.drive.ahead)
        if hit or self.stall.left or self.stall.right:
            self.stall.set(hit, hit)
        return hit

    def _bumper_stalls(self, ahead: float) -> bool:
        stalls = self.drive.settings.bumpstall
        if ahead > 0:
            return bool(self.front_bumpers and stalls & _STALLS_FRONT)
        return bool(ahead < 0 and self.rear_bumpers and stalls & _STALLS_REAR)

    def _block(self) -> None:
        """Against a solid: the wheels stand; after a while the stall monitor takes their power away."""
        left, right = self.drive.wheel_speeds()
        self.drive.v = self.drive.w = 0.0
        self.stall.block(self.now_ms, abs(left) > 0, abs(right) > 0)

    def _hit(self, moved_in: bool) -> None:
        """The body met a solid; `moved_in`: the solid came to the robot at rest."""
        if self.log is not None:
            chassis = self.chassis
            fields = {
                "t_s": self.now_ms / 1000,
                "x_mm": round(chassis.x, 1),
                "y_mm": round(chassis.y, 1),
                "heading_deg": round(wrapped(chassis.th), 2),
                "v_mm_s": round(self.drive.v, 1),
                "front": chassis.contact_front,
                "rear": chassis.contact_rear,
            }
            self.log("struck" if moved_in else "collision", fields)

    def _update_faults(self, faults: Faults) -> None:
        changes = faults.update(self.now_ms, self.pose, self.chassis.travelled_mm)
        self.fault_bumpers = faults.bumper(self.now_ms)
        self.drive.wheels = faults.wheels()
        if self.log is not None:
            for change in changes:
                self.log("fault", {"t_s": self.now_ms / 1000, **_fault_fields(change)})

    def fire_all(self) -> None:
        """Let every sonar fire now, as no real array does; the next SIP has all their readings."""
        if self.sonar_on:
            self._forget_readings()
            self._hear(self.ring.fire_all(self.now_ms, self.pose))

    def _in_c(self) -> Ticks | None:
        """What lets sub-steps pass in C, if that may be."""
        return self._ticks if self.log is None and self.drive.is_plain else None

    @property
    def ticks(self) -> Ticks | None:
        """The same, for a loop in C around sub-steps and SIPs; it has the readings so far. Not of a laser."""
        ticks = self._in_c() if self._sectors is None else None
        if ticks is not None:
            # Those of Python may be older than those that C has: all go back in their order.
            self._gather()
            ticks.hold(self._readings)  # type: ignore[arg-type]
            self._readings.clear()
            ticks.prepare()
        return ticks

    def _forget_readings(self) -> None:
        self._gather()
        self._readings.clear()

    def _gather(self) -> None:
        """Take what C has heard."""
        if self._ticks is not None:
            self._readings += self._ticks.heard()

    def _hear(self, readings: Sequence[SonarReading]) -> None:
        self._gather()
        self._readings += readings
        if self.log is not None:
            for reading in readings:
                fields = {"sonar": reading.number, "range_mm": reading.range_mm, "true_mm": reading.true_mm}
                self.log("sonar", {"t_s": round(reading.t_ms / 1000, 4), **fields, "fault": reading.fault})

    def take_readings(self) -> list[SonarReading]:
        """Return the readings completed since the last call, and those of a laser now."""
        if self._sectors is not None:
            self._hear(self._sectors.readings(self.now_ms, self.pose, self.ring.enabled))
        self._gather()
        readings, self._readings = self._readings, []
        return readings

    # ---- truth

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
        chassis, energy = self.chassis, self.energy
        return {
            "x_mm": round(chassis.x, 1),
            "y_mm": round(chassis.y, 1),
            "heading_deg": round(wrapped(chassis.th), 2),
            "v_mm_s": round(self.drive.v * chassis.true_distance, 1),
            "w_deg_s": round(self.drive.w * chassis.true_turn, 2),
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


def _fault_fields(change: FaultChange) -> dict[str, Any]:
    """A fault change as truth fields; which sonars it is about is a list whether it is one or none."""
    fields = change.as_record()
    return fields | {"active": fields.pop("on"), "sonars": [] if change.sonar is None else [change.sonar]}
