# SPDX-License-Identifier: MIT
"""The ARCOS server: sessions, every command of a robot, the packets that go back; in virtual time."""

from __future__ import annotations

import enum
import functools
import logging
import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Final

from hil_sim.arcos import (
    BAUD_OF_CODE,
    COMMAND,
    DEFAULT,
    SIP,
    TIMING,
    TYPE,
    Command,
    Sip,
    SyncEcho,
    SyncReply,
    Unframer,
    frame,
)
from hil_sim.laser.scanner import Scanner
from hil_sim.record.truth import Log
from hil_sim.robot.report import config_pac, encoder_pac, io_pac, sim_stat, sip
from hil_sim.robot.robot import Robot
from hil_sim.server.commands import WHY_IGNORED, describe
from hil_sim.server.laser import LaserPort
from hil_sim.world.step import STEP_MS

_SYNC0, _SYNC1, _SYNC2 = COMMAND["PULSE"], COMMAND["OPEN"], COMMAND["CLOSE"]
SIP_CYCLE_MS: Final = TIMING["SIP_CYCLE_MS"]
_FLASH_BAUD: Final = BAUD_OF_CODE[DEFAULT["HOSTBAUD"]]

_LOG: Final = logging.getLogger("argus.sim")
_AUX_MAX: Final = 200
_JOYSTICK_REST: Final = bytes(2) + 3 * (512).to_bytes(2, "little")
"""JOYSTICKpac of a port with nothing plugged in: no button, both axes and the throttle in the middle."""
_OLD_SUBCLASS: Final = b"p3dx"

# Run-time parameters that only show in the CONFIGpac, by the field in which they show.
_CONFIG_FIELD: Final = {
    COMMAND["ROTKP"]: "rot_kp",
    COMMAND["ROTKV"]: "rot_kv",
    COMMAND["ROTKI"]: "rot_ki",
    COMMAND["TRANSKP"]: "trans_kp",
    COMMAND["TRANSKV"]: "trans_kv",
    COMMAND["TRANSKI"]: "trans_ki",
    COMMAND["REVCOUNT"]: "rev_count",
    COMMAND["TICKSMM"]: "ticks_mm",
}
_AUX_BAUD_FIELD: Final = {
    COMMAND["AUX1BAUD"]: "aux1_baud",
    COMMAND["AUX2BAUD"]: "aux2_baud",
    COMMAND["AUX3BAUD"]: "aux3_baud",
}


@dataclass
class AuxPort:
    """One auxiliary serial port: bytes wait here until a client has asked for as many."""

    packet_type: int
    loops_back: bool = False
    held: bytearray = field(default_factory=bytearray)
    wanted: int = 0


class State(enum.Enum):
    """Where a session stands."""

    WAIT = "wait"
    SYNCED = "synced"
    CONNECTED = "connected"


def _with_value(act: Callable[[int], None], command: Command) -> None:
    act(command.value)


class ArcosServer:
    """Speaks ARCOS for a `Robot`: `receive` bytes, `advance` time, collect `outgoing` packets.

    Times are virtual milliseconds on the caller's axis and must not fall. `baud` is the rate the robot's side
    of the wire has now; a link that has a wire follows it.
    """

    def __init__(
        self,
        robot: Robot,
        *,
        name: str | None = None,
        subclass: str | None = None,
        flash_baud: int = _FLASH_BAUD,
        sip_cycle_ms: int = SIP_CYCLE_MS,
        aux_loopback: bool = False,
        log: Log | None = None,
        scanner: Scanner | None = None,
    ) -> None:
        """`name`, `subclass`: None is as the robot's table says.

        `flash_baud`: the rate at which the robot starts and to which it returns. `sip_cycle_ms`: a multiple
        of 10. `aux_loopback`: a plug on each AUX port sends back what goes out. `scanner`: a laser that clients may
        ask for.
        """
        self.robot = robot
        table = robot.table
        self.name = (name or table.name).encode("latin-1", "replace")[:20]
        self.subclass = (subclass or table.subclass).encode("latin-1", "replace")
        self._class = table.robot_class.encode()
        self.log = log
        self.state = State.WAIT
        self.baud = self._flash_baud = flash_baud
        self.unframer = Unframer()
        self.sips = 0
        self._out: list[bytes] = []
        self._synced = -1
        self._next_sip_ms = 0.0
        self.sip_cycle_ms = sip_cycle_ms
        old = self.subclass == _OLD_SUBCLASS
        robot.unit_mm = (SIP["OLD_UNIT_UM"] if old else table.odometry["dist_conv_um"]) / 1000
        self.hangs_up = False
        self._encoders = self._io = self._sim_stat = self._joystick = False
        self._aux = {
            1: AuxPort(TYPE["SERAUXPAC"], aux_loopback),
            2: AuxPort(TYPE["SERAUX2PAC"], aux_loopback),
            3: AuxPort(TYPE["SERAUX3PAC"], aux_loopback),
        }
        self._laser = LaserPort(scanner) if scanner is not None else None
        self._handlers = self._table() | self._laser_table()

    # ---- the link's side

    @property
    def next_due_ms(self) -> float | None:
        """When `advance` next has something to send by itself; None while waiting for a client."""
        return self._next_sip_ms if self.state is State.CONNECTED else None

    @next_due_ms.setter
    def next_due_ms(self, due_ms: float) -> None:
        self._next_sip_ms = due_ms

    @property
    def is_plain(self) -> bool:
        """Nothing waits, nobody asked for more than SIPs, and nobody reads along."""
        laser = self._laser is not None and self._laser.form != 0
        asked = self._encoders or self._io or self._sim_stat or self._joystick or laser
        rests = self.state is not State.CONNECTED or asked
        return not (rests or self._out or self.unframer.pending or _LOG.isEnabledFor(logging.DEBUG))

    def receive(self, data: bytes, now_ms: float) -> None:
        """Take bytes that have arrived by now; answers are in `outgoing`."""
        self.advance(now_ms)
        for packet in self.unframer.feed(data, now_ms):
            self._packet(packet)

    def advance(self, now_ms: float) -> None:
        """Let time pass up to now."""
        if self.unframer.pending:
            for packet in self.unframer.poll(now_ms):
                self._packet(packet)
        robot = self.robot
        while robot.now_ms + STEP_MS <= now_ms:
            robot.run(self._next_sip_ms if self.state is State.CONNECTED else math.inf, now_ms)
            if self.state is State.CONNECTED and robot.now_ms >= self._next_sip_ms:
                self._next_sip_ms += self.sip_cycle_ms
                self._send_sip()

    def outgoing(self) -> list[bytes]:
        """Return the packets sent since the last call, framed, oldest first."""
        out, self._out = self._out, []
        return out

    def take_hang_up(self) -> bool:
        """Tell once whether the connection is to be closed from this side; a robot on a wire never does."""
        wanted, self.hangs_up = self.hangs_up, False
        return wanted

    def client_gone(self) -> None:
        """The link lost its client: a wire does not tell, so the session goes on."""

    # ---- sessions

    def _packet(self, data: bytes) -> None:
        command = Command.decode(data)
        if self.state is State.CONNECTED:
            self.robot.heard()
            self._obey(command)
        else:
            self._handshake(command)

    def _obey(self, command: Command) -> None:
        handler = self._handlers.get(command.number)
        if _LOG.isEnabledFor(logging.DEBUG):
            why = "" if handler else f": ignored, {WHY_IGNORED.get(command.number, 'no such command')}"
            name, t_s = self.name.decode("latin-1"), self.robot.now_ms / 1000
            _LOG.debug("%s %.3f s: %s%s", name, t_s, describe(command), why)
        if handler:
            handler(command)

    def _handshake(self, command: Command) -> None:
        number = command.number
        if number in (_SYNC0, _SYNC1, _SYNC2):
            self._sync(number)
        elif number == COMMAND["RESET"]:
            self._end_session("reset")
        elif number in (COMMAND["SIM_SET_POSE"], COMMAND["SIM_RESET"]):
            self._handlers[number](command)

    def _sync(self, number: int) -> None:
        """Answer the next SYNC or the same again; any other begins anew."""
        if number == _SYNC0:
            self._synced, self.state = _SYNC0, State.WAIT
            self._send(SyncEcho(number).data)
        elif self.state is State.SYNCED and number == _SYNC1:
            self._open()
        elif number == _SYNC1 and self._synced in (_SYNC0, _SYNC1):
            self._synced = _SYNC1
            self._send(SyncEcho(number).data)
        elif number == _SYNC2 and self._synced in (_SYNC1, _SYNC2):
            self._synced, self.state = _SYNC2, State.SYNCED
            self._send(SyncReply(self.name, self._class, self.subclass).data)
        else:
            self._synced, self.state = -1, State.WAIT

    def _open(self) -> None:
        self.state = State.CONNECTED
        self.robot.open()
        self._next_sip_ms = float(self.robot.now_ms + self.sip_cycle_ms)
        self._log("session", state="open")

    def _end_session(self, reason: str) -> None:
        was_open = self.state is State.CONNECTED
        self.state, self._synced = State.WAIT, -1
        self.baud = self._flash_baud
        self._encoders = self._io = self._sim_stat = self._joystick = False
        for port in self._aux.values():
            port.held.clear()
            port.wanted = 0
        if self._laser is not None:
            self._laser.reset()
        self.robot.close()
        if was_open:
            self._log("session", state="closed", reason=reason)

    def _log(self, kind: str, **fields: Any) -> None:
        if self.log is not None:
            self.log(kind, {"t_s": self.robot.now_ms / 1000, **fields})

    # ---- sending

    def _send(self, data: bytes) -> None:
        self._out.append(frame(data))

    def _send_sip(self) -> None:
        self.sips += 1
        if self._joystick:
            self._send_joystick()
        self._send(self._sip().data)
        if self._io:
            self._send(io_pac(self.robot).data)
        if self._encoders:
            self._send(encoder_pac(self.robot).data)
        if self._sim_stat:
            self._send(sim_stat(self.robot).data)
        if self._laser is not None:
            for part in self._laser.packets(self.robot):
                self._send(part.data)

    def _sip(self) -> Sip:
        return sip(self.robot)

    def _send_joystick(self) -> None:
        self._send(bytes((TYPE["JOYSTICKPAC"],)) + _JOYSTICK_REST)

    # ---- commands

    def _table(self) -> dict[int, Callable[[Command], None]]:
        """Command number to what it does; any other is ignored, as by a robot without the part."""
        robot = self.robot
        unit = robot.table.odometry["vel2_unit_mm_s"]
        by_name: dict[str, Callable[[Command], None]] = {
            "PULSE": lambda c: None,
            "OPEN": lambda c: None,
            "CLOSE": lambda c: self._end_session("close"),
            "RESET": lambda c: self._end_session("reset"),
            "POLLING": lambda c: robot.ring.set_polling(list(c.text)),
            "ENABLE": lambda c: robot.enable(c.value != 0),
            "SETA": lambda c: robot.drive.set_accel(c.value),
            "SETV": lambda c: robot.drive.set_speed(c.value),
            "SETO": lambda c: robot.set_origin(),
            "MOVE": lambda c: robot.drive.move(c.value),
            "ROTATE": lambda c: robot.drive.rvel(c.value),
            "SETRV": lambda c: robot.drive.set_turn_speed(c.value),
            "VEL": lambda c: robot.drive.vel(c.value),
            "HEAD": lambda c: robot.drive.head(c.value),
            "DHEAD": lambda c: robot.drive.dhead(c.value),
            "DCHEAD": lambda c: robot.drive.dchead(c.value),
            "RVEL": lambda c: robot.drive.rvel(c.value),
            "SETRA": lambda c: robot.drive.set_turn_accel(c.value),
            "SONAR": lambda c: robot.sonar(c.value),
            "STOP": lambda c: robot.drive.stop(),
            "VEL2": lambda c: robot.drive.vel2(c.bytes_pair[0] * unit, c.bytes_pair[1] * unit),
            "E_STOP": lambda c: robot.drive.halt(),
            "QSTOP": lambda c: robot.drive.halt(),
            "CONFIG": self._config,
            "ENCODER": self._encoder,
            "IOREQUEST": self._io_request,
            "JOYREQUEST": self._joystick_request,
            "JOYDRIVE": lambda c: setattr(robot.drive.settings, "joydrive", c.value != 0),
            "TTY2": lambda c: self._aux_out(1, c.text),
            "TTY3": lambda c: self._aux_out(2, c.text),
            "TTY4": lambda c: self._aux_out(3, c.text),
            "GETAUX": lambda c: self._aux_request(1, c.value),
            "GETAUX2": lambda c: self._aux_request(2, c.value),
            "GETAUX3": lambda c: self._aux_request(3, c.value),
            "BUMPSTALL": lambda c: setattr(robot.drive.settings, "bumpstall", c.value & 3),
            "E_STALL": lambda c: setattr(robot.drive.settings, "estall", c.value != 0),
            "SONAR_CYCLE": lambda c: robot.sonar_cycle(c.value),
            "HOSTBAUD": self._host_baud,
            "DIGOUT": self._digout,
            "ADSEL": lambda c: setattr(robot, "anport", c.value & 0xFF),
            "BATTEST": lambda c: setattr(robot, "battery_test_dv", max(0, min(c.value, 255))),
            "DRIFTFACTOR": lambda c: robot.drive.settings.config.update(drift_factor=c.value),
            "SIM_SET_POSE": self._sim_set_pose,
            "SIM_RESET": lambda c: robot.reset_pose(),
            "SIM_STAT": self._sim_stat_request,
        }
        table = {COMMAND[name]: handler for name, handler in by_name.items()}
        table.update(dict.fromkeys(_CONFIG_FIELD, self._parameter))
        table.update(dict.fromkeys(_AUX_BAUD_FIELD, self._aux_baud))
        return table

    LASER_NAMES: ClassVar[tuple[tuple[str, ...], ...]] = (
        ("SIM_LRF_ENABLE", "SIM_LRF_SET_FOV_START", "SIM_LRF_SET_FOV_END", "SIM_LRF_SET_RES"),
    )
    """The commands to a laser: on or off, where its scan begins and ends, how far apart the beams are."""

    def _laser_table(self) -> dict[int, Callable[[Command], None]]:
        """The same for the commands to the laser; empty without one."""
        laser = self._laser
        if laser is None:
            return {}
        acts = (laser.enable, laser.set_start, laser.set_end, laser.set_step)
        return {
            COMMAND[name]: functools.partial(_with_value, act)
            for names in self.LASER_NAMES
            for name, act in zip(names, acts, strict=True)
        }

    def _config(self, _command: Command) -> None:
        codes = {baud: code for code, baud in BAUD_OF_CODE.items()}
        packet = config_pac(self.robot, self.name, self.subclass)
        baud = codes.get(self._flash_baud, 0)
        self._send(replace(packet, host_baud=baud, sip_cycle_ms=self.sip_cycle_ms).data)

    def _parameter(self, command: Command) -> None:
        self.robot.drive.settings.config[_CONFIG_FIELD[command.number]] = command.value & 0xFFFF

    def _encoder(self, command: Command) -> None:
        self._encoders = command.value > 1
        if command.value == 1:
            self._send(encoder_pac(self.robot).data)

    def _io_request(self, command: Command) -> None:
        self._io = command.value > 1
        if command.value == 1:
            self._send(io_pac(self.robot).data)

    def _joystick_request(self, command: Command) -> None:
        self._joystick = command.value > 1
        if command.value == 1:
            self._send_joystick()

    def aux_receive(self, port: int, data: bytes) -> None:
        """Bytes come in at AUX port 1, 2 or 3, from what is plugged in there."""
        aux = self._aux[port]
        aux.held = (aux.held + data)[-_AUX_MAX:]
        if aux.wanted and len(aux.held) >= aux.wanted:
            self._send(bytes((aux.packet_type,)) + aux.held[: aux.wanted])
            del aux.held[: aux.wanted]
            aux.wanted = 0

    def _aux_out(self, port: int, data: bytes) -> None:
        if self._aux[port].loops_back:
            self.aux_receive(port, data)

    def _aux_request(self, port: int, count: int) -> None:
        aux = self._aux[port]
        if 1 <= count <= _AUX_MAX:
            aux.wanted = count
            self.aux_receive(port, b"")
        elif count == 0:
            aux.held.clear()
            aux.wanted = 0

    def _aux_baud(self, command: Command) -> None:
        if command.value in BAUD_OF_CODE:
            self.robot.drive.settings.config[_AUX_BAUD_FIELD[command.number]] = command.value

    def _sim_stat_request(self, command: Command) -> None:
        self._sim_stat = command.value > 1
        if command.value == 1:
            self._send(sim_stat(self.robot).data)

    def _host_baud(self, command: Command) -> None:
        self.baud = BAUD_OF_CODE.get(command.value, self.baud)

    def _digout(self, command: Command) -> None:
        word = command.value & 0xFFFF
        mask = word >> 8
        self.robot.digout = self.robot.digout & ~mask | word & mask

    def _sim_set_pose(self, command: Command) -> None:
        raw = command.argument
        if len(raw) < 13:
            return
        x, y, th = (int.from_bytes(raw[k : k + 4], "little", signed=True) for k in (1, 5, 9))
        self.robot.chassis.place(x, y, th)
