# SPDX-License-Identifier: MIT
"""One mission, step by step or to its end."""

from __future__ import annotations

import dataclasses
import hashlib
import math
import struct
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Final

from hil_sim.core import library as core_module
from hil_sim.core.library import EVENT_FIELDS, Core, CoreEvent, setting_value
from hil_sim.errors import InputError, SimError
from hil_sim.faults.grammar import parse_fault
from hil_sim.faults.kinds import Fault, LinkFault
from hil_sim.faults.link import LinkFaults
from hil_sim.scenario.build import assemble
from hil_sim.server.quirks import server_kind
from hil_sim.server.server import ArcosServer
from hil_sim.sil.line import Line, Packet
from hil_sim.sil.loop import Loop
from hil_sim.sil.mission import Mission
from hil_sim.sil.noted import NotedFaults, NotedRobot
from hil_sim.sil.outcome import Event, Outcome
from hil_sim.sil.shared import shared_echoes, shared_world, sonar_params, stamp_of
from hil_sim.sil.sightings import Sighting, Sightings
from hil_sim.tables.robot import robot_table
from hil_sim.world.model import Pose
from hil_sim.world.physics import parse_physics

SONARS: Final = 16
"""Of so many at least the health is kept: those that a robot has not got are ABSENT."""
REACHED_MM: Final = 150.0
_MOVING_MM_S: Final = 5.0
_TURNING_DEG_S: Final = 1.0
_PENDING_MS: Final = 20.0
_GRID_MS: Final = 10.0
_HEAD: Final = 2
_IN_C: Final = (
    "_turn", "_to_server", "_note", "_deliver", "_collect", "_look_at_robot", "_to_manager", "_serve_core", "_next_ms",
)  # fmt: skip
"""What loop.c does instead; a class that does one of these otherwise is left to Python."""
_WORTH_MS: Final = 50.0
"""For less than that it is not worth to change over to C."""


Trace = Callable[["Sil", Sighting], None]
"""Called for each SIP when the fault manager has taken it."""


@lru_cache(maxsize=1)
def _codes() -> tuple[int, tuple[int, int]]:
    """The numbers of the mode VERIFYING, and of missions that are over."""
    modes = [core_module.mode_name(number) for number in range(64)]
    missions = [core_module.mission_name(number) for number in range(16)]
    return modes.index("VERIFYING"), (missions.index("reached"), missions.index("failed"))


def _in_robot_frame(start: Pose, points: Sequence[tuple[float, float]]) -> list[tuple[int, int]]:
    heading = math.radians(start.heading_deg)
    c, s = math.cos(heading), math.sin(heading)
    moved = [(x - start.x_mm, y - start.y_mm) for x, y in points]
    return [(round(x * c + y * s), round(y * c - x * s)) for x, y in moved]


class Sil:
    """One mission, step by step.

    core: the fault manager. robot, server: the emulated one. events, health: as in the outcome, so far.
    traffic: a list to which every packet is added when it is handed over; None keeps none.
    """

    def __init__(
        self, mission: Mission, *, trace: Trace | None = None, sightings: Sightings | None = None
    ) -> None:
        """`trace`: called for each SIP, which costs some 20 us. `sightings`: takes each SIP, with less to be had."""
        self.mission = mission
        self._sightings = sightings if sightings is not None or trace is None else Sightings(keep=False)
        self._trace = trace
        self.traffic: list[Packet] | None = None
        self.now_ms = 0.0
        self._stamp = stamp_of(mission.world)
        self.world = shared_world(mission.world, self._stamp)
        self.start = Pose(*mission.start) if mission.start is not None else self.world.start
        table = robot_table(mission.robot)
        given = [parse_fault(text, table) for text in mission.faults]
        self.robot = self._build_robot(given)
        self._faults = self.robot.faults if isinstance(self.robot.faults, NotedFaults) else None
        links = [fault for fault in given if isinstance(fault, LinkFault)]
        self.server = server_kind(mission.quirks)(self.robot, flash_baud=mission.baud)
        self._disturb = LinkFaults(links, mission.seed) if links else None
        self.core = self._build_core()
        self.events: list[Event] = []
        self.health: list[list[tuple[float, str, str]]] = [[] for _ in range(max(SONARS, len(table.mounts)))]
        self._to_core, self._to_robot = Line(mission.baud), Line(mission.baud)
        self._digest = hashlib.sha256()
        self._core_due_ms = 0.0
        self._verifying, self._done = _codes()
        self._brief = b""
        self._brief_ms = 0.0
        self._verifying_ms = 0.0
        self._driving_ms = 0.0
        self._sips = 0
        self._loop = self._build_loop()
        self.core.link_up(0)
        self._serve_core(0)

    def _build_robot(self, given: Sequence[Fault]) -> NotedRobot:
        mission = self.mission
        params = sonar_params(mission.sonar)
        robot = assemble(
            self.world,
            self.start,
            make=NotedRobot,
            table=robot_table(mission.robot),
            seed=mission.seed,
            sonar=params,
            physics=parse_physics(mission.physics) if mission.physics else None,
            faults=given,
            movers=mission.movers,
            echoes=shared_echoes(mission.world, self._stamp, params, mission.robot),
            make_faults=NotedFaults,
        )
        if self._sightings is not None:
            self._sightings.begin(robot.kinds)
        return robot

    @property
    def trace(self) -> Trace | None:
        """What is called for each SIP; it may be set at any time."""
        return self._trace

    @trace.setter
    def trace(self, trace: Trace | None) -> None:
        self._trace = trace
        if trace is not None and self._sightings is None:
            self._sightings = Sightings(keep=False)
            self._sightings.begin(self.robot.kinds)

    def _build_core(self) -> Core:
        mission = self.mission
        given: dict[str, int] = {"baud": mission.baud}
        try:
            for key, value in mission.config.items():
                given[key] = setting_value(key, str(value))
            core = Core(0, given, robot_table(mission.robot).ring)
            if mission.course:
                core.set_course(_in_robot_frame(self.start, mission.course))
        except InputError as error:
            raise SimError(str(error)) from error
        if mission.record is not None:
            core.load_record(mission.record)
        return core

    # ---- C

    def _build_loop(self) -> Loop | None:
        """Return the loop in C, if the mission may have turns that it can do."""
        if (
            self.robot.ticks is None
            or self._disturb is not None
            or type(self.server) is not ArcosServer
            or type(self.core) is not Core
            or any(getattr(type(self), name) is not getattr(Sil, name) for name in _IN_C)
        ):
            return None
        loop = Loop(
            (self.core, self.robot, self.server),
            step=self._step_robot,
            taken=self._taken,
        )
        state = loop.state
        state.verifying, (state.over_first, state.over_second) = self._verifying, self._done
        state.stops_at_goal = self.mission.stop_at_goal
        return loop

    def _run_loop(self, loop: Loop, end_ms: float) -> bool:
        """Let turns pass in C; False: it has done none."""
        server, state = self.server, loop.state
        if (
            end_ms - self.now_ms < _WORTH_MS
            or loop.of != (self.core, self.robot, self.server)
            or self.traffic is not None
            or not server.is_plain
            or not loop.prepare()
        ):
            return False
        state.now_ms, state.next_sip_ms, state.core_due_ms = (
            self.now_ms,
            server.next_due_ms,
            self._core_due_ms,
        )
        state.brief_ms, state.verifying_ms = self._brief_ms, self._verifying_ms
        state.driving_ms, state.sips = self._driving_ms, server.sips
        state.traces = self.trace is not None
        state.seen = None
        if self._sightings is not None:
            state.seen = self._sightings.address
            self._sightings.make_room()
        state.brief[: len(self._brief)] = [*self._brief]
        state.to_core.put(self._to_core)
        state.to_robot.put(self._to_robot)
        done = loop.run(end_ms)
        state.to_core.give(self._to_core)
        state.to_robot.give(self._to_robot)
        self._absorb(loop)
        loop.check()
        return done

    def _absorb(self, loop: Loop) -> None:
        """Take over what the loop has come to."""
        server, state = self.server, loop.state
        self.now_ms, server.next_due_ms, self._core_due_ms = (
            state.now_ms,
            state.next_sip_ms,
            state.core_due_ms,
        )
        self._driving_ms, self._sips = state.driving_ms, state.sips
        server.sips = state.sips
        server.unframer.counters.packets += state.packets
        self._brief_ms, self._verifying_ms = state.brief_ms, state.verifying_ms
        self._digest.update(memoryview(state.notes)[: state.notes_count])
        for event in self.core.said(state.events[: EVENT_FIELDS * state.events_count]):
            self._say(event)
        for row in state.briefs[: state.briefs_count]:
            self._note_health(bytes(row.data[: state.brief_size]), row.t_ms)
        state.packets = state.notes_count = state.events_count = state.briefs_count = 0

    def _step_robot(self) -> None:
        """A sub-step that is Python's."""
        self.robot.step()
        self._prepare()

    def _prepare(self) -> None:
        assert self._loop is not None
        if not self._loop.prepare():
            self._loop.state.stop = True

    def _taken(self) -> None:
        """The fault manager has taken a SIP."""
        assert self._loop is not None
        self._absorb(self._loop)
        self._show()
        if self.trace is None or self.traffic is not None:
            self._loop.state.stop = True
        self._prepare()

    # ---- time

    def _next_ms(self) -> float:
        """When something happens next."""
        server_ms = self.server.next_due_ms
        due = min(self._core_due_ms, self._to_core.due_ms, self._to_robot.due_ms)
        if server_ms is not None and server_ms < due:
            due = server_ms
        if self.server.unframer.pending:
            due = min(due, self.now_ms + _PENDING_MS)
        if self._disturb is not None:
            due = min(due, self.now_ms + _GRID_MS)
        return due

    def _turn(self, now_ms: float) -> None:
        """Do what is due at this moment, in the order in which argus-sim's loop does."""
        self.now_ms = now_ms
        for data in self._to_robot.pop(now_ms):
            self._to_server(data, now_ms)
        if self._disturb is not None:
            self._disturb.update(now_ms)
            for data in self._disturb.pop(now_ms, "to_robot"):
                self._deliver(data, now_ms)
        server_ms = self.server.next_due_ms
        if (server_ms is not None and server_ms <= now_ms) or self.server.unframer.pending:
            self.server.advance(now_ms)
        self._collect(now_ms)
        for data in self._to_core.pop(now_ms):
            self._to_manager(data)
        if self._core_due_ms <= now_ms:
            self._serve_core(int(now_ms))

    def _to_server(self, data: bytes, now_ms: float) -> None:
        if self._disturb is not None:
            self._disturb.push(data, now_ms, "to_robot")
        else:
            self._deliver(data, now_ms)

    def _note(self, packet: Packet) -> None:
        self._digest.update(struct.pack("<d?", packet.t_ms, packet.to_robot) + packet.data)
        if self.traffic is not None:
            self.traffic.append(packet)

    def _deliver(self, data: bytes, now_ms: float) -> None:
        self._note(Packet(now_ms, True, data))
        self.server.receive(data, now_ms)

    def _collect(self, now_ms: float) -> None:
        """Put what the robot says on the line."""
        packets = self.server.outgoing()
        sips = self.server.sips
        for packet in packets:
            if sips != self._sips:
                self._sips = sips
                self._look_at_robot(packet)
            if self._disturb is not None:
                self._disturb.push(packet, now_ms, "to_client")
            else:
                self._to_core.push(packet, now_ms)
        if self._disturb is not None:
            for packet in self._disturb.pop(now_ms, "to_client"):
                self._to_core.push(packet, now_ms)

    def _look_at_robot(self, packet: bytes) -> None:
        robot = self.robot
        if abs(robot.drive.v) > _MOVING_MM_S or abs(robot.drive.w) > _TURNING_DEG_S:
            self._driving_ms += self.server.sip_cycle_ms
        if self._sightings is not None:
            self._sightings.sent(packet, robot, robot.noted)

    def _to_manager(self, data: bytes) -> None:
        now = int(self.now_ms)
        self._note(Packet(self.now_ms, False, data))
        self.core.receive(now, data)
        self._serve_core(now)
        if self._sightings is not None and self._sightings.taken(data, self.robot, self._brief[0]):
            self._show()

    def _show(self) -> None:
        """Let the trace see what is known of the SIP that the fault manager has taken."""
        if self.trace is not None and self._sightings is not None:
            self.trace(self, self._sightings.last)

    def _serve_core(self, now: int) -> None:
        core = self.core
        self._core_due_ms = now + core.process(now)
        for packet in core.transmit():
            self._to_robot.push(packet, self.now_ms)
        for event in core.events():
            self._say(event)
        brief = core.brief()
        if self._brief and self._brief[0] == self._verifying:
            self._verifying_ms += self.now_ms - self._brief_ms
        self._brief_ms = self.now_ms
        if brief != self._brief:
            self._note_health(brief, self.now_ms)

    def _say(self, event: CoreEvent) -> None:
        self.events.append(Event(event.t_ms / 1000, event.event, event.sonar, event.value, event.state))

    def _note_health(self, brief: bytes, now_ms: float) -> None:
        before, self._brief = self._brief, brief
        managed = (len(brief) - _HEAD) // 2
        for k in range(min(managed, len(self.health))):
            at, kind = _HEAD + k, _HEAD + managed + k
            if not before or (brief[at], brief[kind]) != (before[at], before[kind]):
                names = core_module.health_name(brief[at]), core_module.kind_name(brief[kind])
                self.health[k].append((now_ms / 1000, *names))

    @property
    def mode(self) -> str:
        """What the fault manager is doing."""
        return core_module.mode_name(self._brief[0])

    @property
    def state_of_mission(self) -> str:
        """How the fault manager sees the mission: none, running, reached or failed."""
        return core_module.mission_name(self._brief[1])

    def run_until(self, t_s: float) -> None:
        """Let robot time pass up to `t_s`."""
        self._run_until_ms(round(t_s * 1000, 3))

    def _run_until_ms(self, end_ms: float) -> None:
        while (due := self._next_ms()) <= end_ms:
            if self._loop is None or not self._run_loop(self._loop, end_ms):
                self._turn(due)
            if self._is_over:
                return
        self.now_ms = max(self.now_ms, end_ms)

    def step(self) -> None:
        """Let 10 ms pass."""
        self._run_until_ms((math.floor(self.now_ms / _GRID_MS) + 1) * _GRID_MS)

    @property
    def _is_over(self) -> bool:
        return self.mission.stop_at_goal and self._brief[1] in self._done

    @property
    def over(self) -> bool:
        """The limit has come, or the goal was reached or given up by a mission that stops then."""
        return self.now_ms >= self.mission.limit_s * 1000 or self._is_over

    def run(self) -> Outcome:
        """Run to the end."""
        self.run_until(self.mission.limit_s)
        return self.outcome()

    # ---- result

    def _goal_mm(self) -> float:
        if not self.mission.course:
            return 0.0
        x, y = self.mission.course[-1]
        return math.hypot(x - self.robot.chassis.x, y - self.robot.chassis.y)

    def outcome(self) -> Outcome:
        """Return what has come of the mission so far."""
        self.server.advance(self.now_ms)
        robot = self.robot
        status = self.core.status()
        goal_mm = self._goal_mm()
        at_rest = abs(robot.drive.v) <= _MOVING_MM_S and abs(robot.drive.w) <= _TURNING_DEG_S
        return Outcome(
            mission=self.mission,
            reached=bool(self.mission.course) and goal_mm <= REACHED_MM and at_rest,
            t_s=self.now_ms / 1000,
            goal_mm=goal_mm,
            driven_mm=robot.chassis.travelled_mm,
            driving_s=self._driving_ms / 1000,
            collisions=list(robot.hits),
            events=list(self.events),
            health=[list(changes) for changes in self.health],
            truth=[dataclasses.replace(t) for t in self._faults.truth] if self._faults is not None else [],
            final=list(zip(status["health"], status["kind"], strict=True)),
            record=self.core.save_record(),
            stops=status["stops"],
            verifications=sum(event.name == "SONAR_VERIFYING" for event in self.events),
            verifying_s=self._verifying_ms / 1000,
            digest=self._digest.hexdigest(),
        )


def run(mission: Mission, *, trace: Trace | None = None, sightings: Sightings | None = None) -> Outcome:
    """Run a mission to its end."""
    return Sil(mission, trace=trace, sightings=sightings).run()
