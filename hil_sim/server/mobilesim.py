# SPDX-License-Identifier: MIT
"""The vendor emulator's habits, `--quirks mobilesim`: what it answers where the robot answers otherwise."""

from __future__ import annotations

import logging
import math
from dataclasses import replace
from typing import Any, Final

from hil_sim.arcos import COMMAND, FLAG, SIP, TIMING, TYPE, Command, SyncReply
from hil_sim.arcos import Sip as SipPacket
from hil_sim.robot.report import config_pac, sip
from hil_sim.robot.robot import Robot
from hil_sim.server.server import ArcosServer, State

NAME: Final = "MobileSim"
_LOG: Final = logging.getLogger("argus.sim")
_CEILING: Final = 9999
_ALL_ARRAYS: Final = FLAG["SONAR1"] | FLAG["SONAR2"] | FLAG["SONAR3"] | FLAG["SONAR4"]
_TEMPERATURE_NONE: Final = -127

OBEYED: Final = (
    "PULSE", "OPEN", "CLOSE", "SONAR", "ENABLE", "VEL", "VEL2", "RVEL", "ROTATE", "MOVE", "HEAD", "DHEAD",
    "STOP", "E_STOP", "QSTOP", "SETA", "SETV", "SETRA", "SETRV", "SETO", "BUMPSTALL", "CONFIG", "BATTEST",
    "SIM_SET_POSE", "SIM_RESET", "SIM_STAT", "RESET", "MAINTENANCE",
)  # fmt: skip
"""The commands that have an effect there."""

# CONFIGpac fields that are not 0 and not the robot's.
_CONFIG: Final[dict[str, Any]] = {
    "serial_number": b"SIM",
    "rot_vel_top": _CEILING,
    "trans_vel_top": _CEILING,
    "rot_acc_top": _CEILING,
    "trans_acc_top": _CEILING,
    "pwm_max": 400,
    "name": NAME.encode(),
    "version": b"S.0",
    "lat_vel_top": _CEILING,
    "lat_acc_top": _CEILING,
}
_CONFIG_ZERO: Final = (
    "host_baud", "aux1_baud", "gripper", "low_battery_dv", "rev_count", "p2mpacs", "stall_val",
    "stall_count_ms", "joy_vel", "joy_rvel", "rot_kp", "rot_kv", "rot_ki", "trans_kp", "trans_kv", "trans_ki",
    "front_bumps", "rear_bumps", "charger", "sonar_cycle_ms", "has_gyro", "drift_factor", "aux2_baud",
    "aux3_baud", "ticks_mm", "shutdown_dv", "gyro_cw", "gyro_ccw", "kinematics_delay_ms", "lat_vel_max",
    "lat_acc", "lat_decel", "charge_threshold",
)  # fmt: skip


class MobileSimServer(ArcosServer):
    """Speaks ARCOS as MobileSim does.

    A session begins at SYNC2 in whatever order the SYNCs come, with all sonars on. SIPs begin at OPEN and hold
    the readings of all sonars. The watchdog only warns. CLOSE, RESET and a lost connection end session and
    connection.
    """

    LASER_NAMES = (*ArcosServer.LASER_NAMES, ("ADSEL", "GRIPPERVAL", "GRIPREQUEST", "GYROCALCW"))
    """Its forerunner's numbers, too: those are of other commands of a robot. ARIA sends only these."""

    def __init__(self, robot: Robot, **options: Any) -> None:
        super().__init__(robot, **options)
        robot.watchdog_stops = False
        robot.fires_in_turn = False
        robot.drive.motors = True
        robot.drive.approach_proportionally()
        robot.bumpers = robot.rear_segments = 0
        self._warned = False

    def advance(self, now_ms: float) -> None:
        """Let time pass up to now; a silent client is warned of, once, and nothing else."""
        super().advance(now_ms)
        quiet_ms = self.robot.now_ms - self.robot.last_heard_ms
        overdue = self.state is State.CONNECTED and quiet_ms > TIMING["WATCHDOG_MS"]
        if overdue and not self._warned:
            _LOG.warning("%s: no command for %d ms; the robot goes on", self.name.decode("latin-1"), quiet_ms)
        self._warned = overdue

    def client_gone(self) -> None:
        """The connection is the session."""
        if self.state is State.CONNECTED:
            self._end_session("client gone")

    def _handshake(self, command: Command) -> None:
        if command.number != COMMAND["CLOSE"]:
            self._send(command.data)
            return
        self._send(SyncReply(self.name, self._class, self.subclass).data)
        self.state = State.CONNECTED
        self.robot.open()
        self._next_sip_ms = math.inf
        self._log("session", state="open")

    def _table(self) -> dict[int, Any]:
        table = super()._table()
        own = {"OPEN": self._begin_sips, "SONAR": self._sonar, "SETO": self._set_odometry}
        ends = dict.fromkeys(("CLOSE", "RESET", "MAINTENANCE"), self._close)
        table |= {COMMAND[name]: handler for name, handler in (own | ends).items()}
        return {COMMAND[name]: table[COMMAND[name]] for name in OBEYED}

    def _begin_sips(self, _command: Command) -> None:
        if self._next_sip_ms == math.inf:
            self._next_sip_ms = float(self.robot.now_ms + self.sip_cycle_ms)

    def _close(self, _command: Command) -> None:
        self._end_session("close")
        self.hangs_up = True

    def _sonar(self, command: Command) -> None:
        self.robot.sonar(int(command.value != 0))

    def _set_odometry(self, command: Command) -> None:
        raw = command.argument
        if len(raw) < 7:
            self.robot.set_origin()
            return
        x, y, th = (int.from_bytes(raw[k : k + 2], "little", signed=True) for k in (1, 3, 5))
        self.robot.drive.set_odometry(x, y, th)

    def _config(self, _command: Command) -> None:
        packet = config_pac(self.robot, self.name, self.subclass)
        fields = dict.fromkeys(_CONFIG_ZERO, 0) | _CONFIG | {"sip_cycle_ms": self.sip_cycle_ms}
        self._send(replace(packet, **fields).data)

    def _sip(self) -> SipPacket:
        robot = self.robot
        robot.fire_all()
        packet = sip(robot)
        degrees = round(packet.th * 360 / SIP["TURN"])
        stalled = int(packet.left_stalled or packet.right_stalled)
        sonar_flags = _ALL_ARRAYS if robot.sonar_on else 0
        return replace(
            packet,
            type=TYPE["SIP_STATIONARY"],
            th=round(degrees * SIP["TURN"] / 360),
            stall_left=stalled,
            stall_right=stalled,
            flags=packet.flags & ~_ALL_ARRAYS | sonar_flags,
            digout=0xFF,
            lat_vel=0,
            temperature=_TEMPERATURE_NONE,
            charge_percent=0,
        )
