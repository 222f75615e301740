# SPDX-License-Identifier: MIT
"""The loop of a mission in C (loop.c) for what is plain; each other turn is `Sil`'s, on the same memory."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any, Final

from hil_sim import native
from hil_sim.arcos import ARGUMENT, COMMAND, FLAG, SIP, TYPE
from hil_sim.core.library import Core
from hil_sim.robot import energy
from hil_sim.robot.report import other_flags
from hil_sim.server.server import ArcosServer
from hil_sim.sil.line import Line
from hil_sim.sil.noted import NotedRobot
from hil_sim.sil.sightings import ROW

_HELD: Final = 128
_NOTES: Final = 1 << 16
_ROWS: Final = 64
_FIELDS: Final = 8
_BRIEF: Final = 128
_FRAME: Final = 260
_CYCLE_LEAST_MS: Final = 20
"""With sonars that fire faster a SIP may hold more readings than C has room for."""
_D, _I, _L, _P, _U, _B = (
    ctypes.c_double, ctypes.c_int32, ctypes.c_int64, ctypes.c_void_p, ctypes.c_uint8, ctypes.c_bool,
)  # fmt: skip
_PLAIN: Final = ctypes.CFUNCTYPE(None)
COMMANDS: Final = ("PULSE", "SETV", "MOVE", "VEL", "HEAD", "ADSEL")
"""Those that C obeys."""


class _Packet(ctypes.Structure):
    _fields_ = [("t_ms", _D), ("length", _I), ("data", _U * _FRAME)]


class _Line(ctypes.Structure):
    _fields_ = [("byte_ms", _D), ("free_ms", _D), ("first", _L), ("count", _L), ("held", _Packet * _HELD)]

    def put(self, line: Line) -> None:
        """Go on from a line."""
        self.byte_ms, self.free_ms, self.first, self.count = line.byte_ms, line.free_ms, 0, len(line.held)
        for packet, (t_ms, data) in zip(self.held, line.held, strict=False):
            packet.t_ms, packet.length = t_ms, len(data)
            packet.data[: len(data)] = data
        line.held.clear()

    def give(self, line: Line) -> None:
        """Let the line go on from here."""
        line.free_ms = self.free_ms
        for k in range(self.count):
            packet = self.held[(self.first + k) % _HELD]
            line.held.append((packet.t_ms, bytes(packet.data[: packet.length])))
        self.count = 0


class _Brief(ctypes.Structure):
    _fields_ = [("t_ms", _D), ("data", _U * _BRIEF)]


class State(ctypes.Structure):
    """What loop.c works on."""

    _fields_ = [
        ("parts", _P),
        *((name, _P) for name in ("core", "receive", "process", "transmit", "event", "brief_of")),
        *((name, _PLAIN) for name in ("step", "taken")),
        ("seen", _P),
        *((name, _D) for name in ("unit_mm", "idle_w", "sonar_w", "wheel_j_m", "full_v", "empty_v")),
        *((name, _D) for name in ("capacity_j", "internal_ohm")),
        *((name, _I) for name in ("turn", "flags", "motors", "still", "moving", "digout")),
        *((name, _D) for name in ("vel_top", "now_ms", "next_sip_ms", "core_due_ms", "brief_ms")),
        *((name, _D) for name in ("verifying_ms", "driving_ms")),
        *((name, _L) for name in ("turns", "sips", "packets", "sip_cycle_ms")),
        ("command", _I * len(COMMANDS)),
        *((name, _I) for name in ("negative", "positive", "verifying", "over_first", "over_second")),
        *((name, _I) for name in ("brief_size", "notes_count", "events_count", "briefs_count", "fields")),
        *((name, _B) for name in ("traces", "stops_at_goal", "stop")),
        ("brief", _U * _BRIEF),
        ("to_core", _Line),
        ("to_robot", _Line),
        ("out", _U * _FRAME),
        ("out_length", _I),
        ("made", _D * (ROW.itemsize // 8)),
        ("events", _I * (_ROWS * _FIELDS)),
        ("briefs", _Brief * _ROWS),
        ("notes", _U * _NOTES),
    ]


class Calls:
    """What C asks of Python; an error is kept, and ends the loop."""

    def __init__(self, state: State) -> None:
        self._state = state
        self._error: BaseException | None = None
        self._kept: list[Any] = []

    def take(self, call: Callable[..., None], kind: Any) -> Any:
        """Return a call as C can make it."""

        def guarded(*arguments: Any) -> None:
            try:
                call(*arguments)
            except BaseException as error:
                self._error, self._state.stop = error, True

        made = kind(guarded)
        self._kept.append(made)
        return made

    def check(self) -> None:
        """Raise what was raised."""
        if self._error is not None:
            error, self._error = self._error, None
            raise error


class Loop:
    """The loop of one mission in C.

    step: a sub-step, for which C asks. taken: the fault manager has taken a SIP.
    """

    def __init__(
        self,
        of: tuple[Core, NotedRobot, ArcosServer],
        *,
        step: Callable[[], None],
        taken: Callable[[], None],
    ) -> None:
        found = native.library()
        assert found is not None
        self.of = of
        core, robot, server = of
        self._run, self._robot = found.argus_sim_loop, robot
        self.state = state = State()
        if found.argus_sim_loop_size() != ctypes.sizeof(State):
            raise AssertionError(
                f"loop.c has {found.argus_sim_loop_size()} bytes, loop.py {ctypes.sizeof(State)}"
            )
        self._calls = Calls(state)
        state.step, state.taken = (self._calls.take(call, _PLAIN) for call in (step, taken))
        for name, value in core.for_c().items():
            setattr(state, name, value)
        state.unit_mm = robot.unit_mm
        state.idle_w, state.sonar_w, state.wheel_j_m = energy.IDLE_W, energy.SONAR_W, energy.WHEEL_J_M
        battery = energy.BATTERY
        state.full_v, state.empty_v = battery["full_v"], battery["empty_v"]
        state.capacity_j, state.internal_ohm = battery["capacity_wh"] * 3600, battery["internal_ohm"]
        state.turn, state.motors = SIP["TURN"], FLAG["MOTORS"]
        state.still, state.moving = TYPE["SIP_STATIONARY"], TYPE["SIP_MOVING"]
        state.vel_top = robot.table.motion["vel_top_mm_s"]
        state.sip_cycle_ms = server.sip_cycle_ms
        state.command = tuple(COMMAND[name] for name in COMMANDS)
        state.negative, state.positive = ARGUMENT["NEGATIVE"], ARGUMENT["POSITIVE"]

    def prepare(self) -> bool:
        """Let C know what only Python changes; False: all is Python's now."""
        robot, state = self._robot, self.state
        ticks = robot.ticks
        if ticks is None or robot.battery_test_dv or robot.ring.cycle_ms < _CYCLE_LEAST_MS:
            return False
        state.parts, state.flags, state.digout = ticks.address, other_flags(robot), robot.digout
        return True

    def run(self, end_ms: float) -> bool:
        """Let turns pass as long as they are plain; False: none was."""
        self.state.stop, self.state.turns = False, 0
        self._run(ctypes.addressof(self.state), end_ms)
        return bool(self.state.turns)

    def check(self) -> None:
        """Raise what a call has raised."""
        self._calls.check()
