# SPDX-License-Identifier: MIT
"""Software in the loop: the C fault manager and the emulated robot in one process, under virtual time.

Nothing sleeps and no thread runs. The robot is the one that `argus-sim` serves, the fault manager the one that
argusd runs; between them the bytes take the time that a serial line would need. The same mission gives the same
run, to the byte.

>>> mission = Mission("demo", ((1700, 0),), faults=("off:3@2s",), limit_s=3.0)
>>> Mission.from_json(mission.to_json()) == mission
True
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
import math
import struct
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, Final, Generic, NamedTuple, TypeVar

import numpy as np
from argus_tools import core as core_module
from argus_tools.core import Core, setting_value
from argus_tools.formats.base import LogError

from hil_sim.arcos import TIMING
from hil_sim.body import BodyModel
from hil_sim.errors import SimError
from hil_sim.faults import FaultChange, FaultSet, LinkFault, parse_fault
from hil_sim.link_faults import LinkFaults
from hil_sim.movers import Door, Mover, Person, plain
from hil_sim.moving import moving_solids
from hil_sim.robot import Robot, SonarReading
from hil_sim.server import ArcosServer
from hil_sim.sonar import EchoModel, SonarParams, SonarRing
from hil_sim.world import Pose, World, load_world

SONARS: Final = 16
REACHED_MM: Final = 150.0
VISIBLE_MM: Final = 100.0
VISIBLE_PART: Final = 0.05
"""A fault shows in a reading that is off by more than the larger of VISIBLE_MM and this part of the truth."""
_MOVING_MM_S: Final = 5.0
_TURNING_DEG_S: Final = 1.0
_BACKLOG_MS: Final = 200.0
_PENDING_MS: Final = 20.0
_GRID_MS: Final = 10.0
_HEAD: Final = 2

V = TypeVar("V")


class Frozen(Mapping[str, V], Generic[V]):
    """A mapping that can be a key and that no one changes; equal to any with the same content."""

    __slots__ = ("_values",)

    def __init__(self, values: Mapping[str, V] | None = None) -> None:
        self._values = dict(sorted((values or {}).items()))

    def __getitem__(self, key: str) -> V:
        return self._values[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __hash__(self) -> int:
        return hash(tuple(self._values.items()))

    def __repr__(self) -> str:
        return repr(self._values)

    def __reduce__(self) -> tuple[Any, ...]:
        return Frozen, (self._values,)


@dataclass(frozen=True)
class Mission:
    """Everything that one run depends on.

    world: a name or a file, as for `argus-sim --world`. course: world axes, mm; the last point is the goal.
    start: x, y in mm and heading in degrees; None takes the world's. faults: texts of the grammar of faults.
    config: settings of the fault manager by name; `baud` is that of the mission unless it is given.
    sonar: parameters of the sonar model by name. movers: people and doors besides the world's own.
    limit_s: robot time at which the run is given up.
    record: the persistent record of an earlier mission. stop_at_goal: False goes on to the limit.
    """

    world: str
    course: tuple[tuple[float, float], ...]
    start: tuple[float, float, float] | None = None
    faults: tuple[str, ...] = ()
    seed: int = 1
    config: Mapping[str, int | str] = field(default_factory=Frozen)
    sonar: Mapping[str, float] = field(default_factory=Frozen)
    movers: tuple[Mover, ...] = ()
    limit_s: float = 300.0
    record: bytes | None = None
    baud: int = 9600
    stop_at_goal: bool = True

    def __post_init__(self) -> None:
        fix = object.__setattr__
        fix(self, "course", tuple((float(x), float(y)) for x, y in self.course))
        fix(self, "faults", tuple(self.faults))
        fix(self, "movers", tuple(self.movers))
        fix(self, "config", Frozen(self.config))
        fix(self, "sonar", Frozen(self.sonar))

    def to_json(self) -> str:
        """Return the mission as one line of JSON."""
        values = {f.name: getattr(self, f.name) for f in dataclasses.fields(self)}
        values["config"], values["sonar"] = dict(self.config), dict(self.sonar)
        values["record"] = None if self.record is None else self.record.hex()
        values["movers"] = [plain(mover) for mover in self.movers]
        return json.dumps(values, separators=(",", ":"))

    @classmethod
    def from_json(cls, text: str) -> Mission:
        """Return the mission that `to_json` wrote."""
        values = json.loads(text)
        values["course"] = tuple((x, y) for x, y in values["course"])
        values["start"] = None if values["start"] is None else tuple(values["start"])
        values["record"] = None if values["record"] is None else bytes.fromhex(values["record"])
        values["movers"] = tuple(_mover(fields) for fields in values["movers"])
        return cls(**values)


def _mover(fields: dict[str, Any]) -> Mover:
    return Person(**fields) if "path" in fields else Door(**fields)


class Event(NamedTuple):
    """One thing that the fault manager said: `name` as in its catalogue, `state` the failure state then."""

    t_s: float
    name: str
    sonar: int | None
    value: int
    state: str


class Collision(NamedTuple):
    """The body met a solid at this place; `struck`: the robot stood, the solid came to it."""

    t_s: float
    x: float
    y: float
    struck: bool


@dataclass
class FaultTruth:
    """One fault of one sonar as it was injected; `driven` is the true way driven until then.

    first_visible_s: the first reading that it changed by more than max(100 mm, 5 %), or took away; None while
    none was (then it could not be seen by anyone).
    """

    kind: str
    sonar: int
    text: str
    onset_s: float
    onset_driven_mm: float
    end_s: float | None = None
    first_visible_s: float | None = None
    first_visible_driven_mm: float | None = None


@dataclass
class Outcome:
    """What came of a mission.

    t_s: robot time at the end. goal_mm: true distance from the goal then. driving_s: time in motion. health:
    for each sonar every change of time, health and kind, looked at with each SIP. final: health and kind at the
    end. verifying_s: time spent on verification by turning. digest: of all bytes both ways and their times.
    """

    mission: Mission
    reached: bool
    t_s: float
    goal_mm: float
    driven_mm: float
    driving_s: float
    collisions: list[Collision]
    events: list[Event]
    health: list[list[tuple[float, str, str]]]
    truth: list[FaultTruth]
    final: list[tuple[str, str]]
    record: bytes
    stops: int
    verifications: int
    verifying_s: float
    digest: str


@dataclass(frozen=True)
class Sighting:
    """What a SIP says, and the truth: the reading as reported, what no fault, noise and crosstalk would give."""

    t_s: float
    pose: Pose
    readings: tuple[SonarReading, ...]


Trace = Callable[["Sil", Sighting], None]
"""Called for each SIP when the fault manager has taken it."""


class _Robot(Robot):
    """The robot, with its SIPs and its collisions noted."""

    noted: tuple[SonarReading, ...] = ()
    hits: list[Collision]

    def sip(self) -> Any:
        self.noted = tuple(self._readings)
        return super().sip()

    def _collide(self, moved_in: bool = False) -> None:
        super()._collide(moved_in)
        self.hits.append(Collision(self.now_ms / 1000, self.x, self.y, moved_in))


class _Faults(FaultSet):
    """The injected faults, with what they did to each sonar noted."""

    travelled_mm = 0.0

    def __init__(self, faults: Sequence[Any], rng: np.random.Generator) -> None:
        super().__init__(faults, rng)
        self.truth: list[FaultTruth] = []
        self._open: dict[tuple[str, int], FaultTruth] = {}

    def update(self, now_ms: float, pose: Pose, travelled_mm: float) -> list[FaultChange]:
        self.travelled_mm = travelled_mm
        changes = super().update(now_ms, pose, travelled_mm)
        for change in changes:
            if change.sonar is not None:
                self._note(change, change.sonar)
        return changes

    def _note(self, change: FaultChange, sonar: int) -> None:
        if change.on:
            truth = FaultTruth(change.kind, sonar, change.text, change.t_ms / 1000, self.travelled_mm)
            self._open[change.text, sonar] = truth
            self.truth.append(truth)
        else:
            # Of a fault that is written twice the first end counts.
            key = change.text, sonar
            if key in self._open:
                self._open.pop(key).end_s = change.t_ms / 1000

    def watch(self, t_ms: float, number: int, true_mm: int, heard_mm: int, value: int | None) -> None:
        """Note the first reading in which the fault shows."""
        fault = self.active(number)
        truth = self._open.get((fault.text, number)) if fault is not None else None
        if truth is None or truth.first_visible_s is not None:
            return
        if value is not None:
            limit = max(VISIBLE_MM, VISIBLE_PART * true_mm)
            if abs(value - true_mm) <= limit or abs(value - heard_mm) <= limit:
                return
        truth.first_visible_s = t_ms / 1000
        truth.first_visible_driven_mm = self.travelled_mm


class _Line:
    """One direction of a serial line: each packet is handed over when its last bit is through."""

    def __init__(self, baud: int) -> None:
        self.byte_ms = TIMING["BITS_PER_BYTE"] * 1000 / baud
        self.held: deque[tuple[float, bytes]] = deque()
        self._free_ms = 0.0

    def push(self, data: bytes, now_ms: float) -> None:
        """Put a packet on the line; one that would wait too long is lost, as by a robot out of buffers."""
        if self._free_ms - now_ms > _BACKLOG_MS:
            return
        self._free_ms = max(self._free_ms, now_ms) + len(data) * self.byte_ms
        self.held.append((self._free_ms, data))

    @property
    def due_ms(self) -> float:
        """When the next packet is through."""
        return self.held[0][0] if self.held else math.inf


_Stamp = tuple[int, int] | None


def _stamp(name: str) -> _Stamp:
    """What changes when the file of a world is written anew; None for one of ours."""
    try:
        status = Path(name).stat()
    except (OSError, ValueError):
        return None
    return status.st_mtime_ns, status.st_size


# What is worked out for a world serves all missions in it; only few at a time, since that takes memory.
@lru_cache(maxsize=8)
def _world(name: str, stamp: _Stamp) -> World:  # noqa: ARG001 (a key)
    return load_world(name)


@lru_cache(maxsize=8)
def _echoes(name: str, stamp: _Stamp, params: SonarParams) -> EchoModel:
    return EchoModel(_world(name, stamp), params)


@lru_cache(maxsize=1)
def _codes() -> tuple[int, tuple[int, int]]:
    """The numbers of the mode VERIFYING, and of missions that are over."""
    modes = [core_module.mode_name(number) for number in range(64)]
    missions = [core_module.mission_name(number) for number in range(16)]
    return modes.index("VERIFYING"), (missions.index("reached"), missions.index("failed"))


def _params(values: Mapping[str, float]) -> SonarParams:
    known = {f.name for f in dataclasses.fields(SonarParams)}
    if wrong := set(values) - known:
        raise SimError(
            f"sonar: '{min(wrong)}' is no parameter of the model; there are {', '.join(sorted(known))}"
        )
    given: dict[str, Any] = dict(values)
    return SonarParams(**given)


def _in_robot_frame(start: Pose, points: Sequence[tuple[float, float]]) -> list[tuple[int, int]]:
    heading = math.radians(start.heading_deg)
    c, s = math.cos(heading), math.sin(heading)
    moved = [(x - start.x_mm, y - start.y_mm) for x, y in points]
    return [(round(x * c + y * s), round(y * c - x * s)) for x, y in moved]


class Packet(NamedTuple):
    """One packet as it was handed over: `to_robot` or to the fault manager."""

    t_ms: float
    to_robot: bool
    data: bytes


class Sil:
    """One mission, step by step.

    core: the fault manager. robot, server: the emulated one. events, health: as in the outcome, so far.
    traffic: a list to which every packet is added when it is handed over; None keeps none.
    """

    def __init__(self, mission: Mission, *, trace: Trace | None = None) -> None:
        self.mission = mission
        self.trace = trace
        self.traffic: list[Packet] | None = None
        self.now_ms = 0.0
        self._stamp = _stamp(mission.world)
        self.world = _world(mission.world, self._stamp)
        self.start = Pose(*mission.start) if mission.start is not None else self.world.start
        self.robot, self._faults, links = self._build_robot()
        self.server = ArcosServer(self.robot, flash_baud=mission.baud)
        self._disturb = LinkFaults(links, mission.seed) if links else None
        self.core = self._build_core()
        self.events: list[Event] = []
        self.health: list[list[tuple[float, str, str]]] = [[] for _ in range(SONARS)]
        self._to_core, self._to_robot = _Line(mission.baud), _Line(mission.baud)
        self._sightings: deque[tuple[bytes, Sighting]] = deque()
        self._digest = hashlib.sha256()
        self._core_due_ms = 0.0
        self._verifying, self._done = _codes()
        self._brief = b""
        self._brief_ms = 0.0
        self._verifying_ms = 0.0
        self._driving_ms = 0.0
        self._sips = 0
        self.core.link_up(0)
        self._serve_core(0)

    def _build_robot(self) -> tuple[_Robot, _Faults | None, list[LinkFault]]:
        mission = self.mission
        params = _params(mission.sonar)
        moving = moving_solids((*self.world.movers, *mission.movers))
        body = BodyModel(self.world, moving)
        if body.contact(self.start, 0.0) is not None:
            place = f"{self.start.x_mm:g},{self.start.y_mm:g},{self.start.heading_deg:g}"
            raise SimError(
                f"start {place}: a solid of world {self.world.name} is there; choose another start"
            )
        given = [parse_fault(text) for text in mission.faults]
        links = [fault for fault in given if isinstance(fault, LinkFault)]
        # Streams as those of argus-sim, so that a run there and here sees the same noise.
        faults = _Faults(given, np.random.default_rng([mission.seed, 1])) if given else None
        ring = SonarRing(
            self.world,
            params,
            faults,
            np.random.default_rng([mission.seed, 2]),
            echoes=_echoes(mission.world, self._stamp, params),
            moving=moving,
        )
        if faults is not None:
            ring.watch = faults.watch
        robot = _Robot(body, ring, self.start, faults=faults, seed=mission.seed, moving=moving)
        robot.hits = []
        return robot, faults, links

    def _build_core(self) -> Core:
        mission = self.mission
        given: dict[str, int] = {"baud": mission.baud}
        try:
            for key, value in mission.config.items():
                given[key] = setting_value(key, str(value))
            core = Core(0, given)
            if mission.course:
                core.set_course(_in_robot_frame(self.start, mission.course))
        except LogError as error:
            raise SimError(str(error)) from error
        if mission.record is not None:
            core.load_record(mission.record)
        return core

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
        line = self._to_robot
        while line.held and line.held[0][0] <= now_ms:
            self._to_server(line.held.popleft()[1], now_ms)
        if self._disturb is not None:
            self._disturb.update(now_ms)
            for data in self._disturb.pop(now_ms, "to_robot"):
                self._deliver(data, now_ms)
        server_ms = self.server.next_due_ms
        if (server_ms is not None and server_ms <= now_ms) or self.server.unframer.pending:
            self.server.advance(now_ms)
        self._collect(now_ms)
        line = self._to_core
        while line.held and line.held[0][0] <= now_ms:
            self._to_manager(line.held.popleft()[1])
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
        if abs(robot.v) > _MOVING_MM_S or abs(robot.w) > _TURNING_DEG_S:
            self._driving_ms += self.server.sip_cycle_ms
        if self.trace is not None:
            self._sightings.append((packet, Sighting(robot.now_ms / 1000, robot.pose, robot.noted)))

    def _to_manager(self, data: bytes) -> None:
        now = int(self.now_ms)
        self._note(Packet(self.now_ms, False, data))
        self.core.receive(now, data)
        self._serve_core(now)
        while self._sightings and self.trace is not None:
            packet, sighting = self._sightings[0]
            if packet == data:
                self.trace(self, sighting)
            elif len(self._sightings) == 1:
                break
            self._sightings.popleft()

    def _serve_core(self, now: int) -> None:
        core = self.core
        self._core_due_ms = now + core.process(now)
        for packet in core.transmit():
            self._to_robot.push(packet, self.now_ms)
        for event in core.events():
            self.events.append(Event(event.t_ms / 1000, event.event, event.sonar, event.value, event.state))
        brief = core.brief()
        if self._brief and self._brief[0] == self._verifying:
            self._verifying_ms += self.now_ms - self._brief_ms
        self._brief_ms = self.now_ms
        if brief != self._brief:
            self._note_health(brief)

    def _note_health(self, brief: bytes) -> None:
        before, self._brief = self._brief, brief
        for k in range(SONARS):
            at, kind = _HEAD + k, _HEAD + SONARS + k
            if not before or (brief[at], brief[kind]) != (before[at], before[kind]):
                names = core_module.health_name(brief[at]), core_module.kind_name(brief[kind])
                self.health[k].append((self.now_ms / 1000, *names))

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
        return math.hypot(x - self.robot.x, y - self.robot.y)

    def outcome(self) -> Outcome:
        """Return what has come of the mission so far."""
        self.server.advance(self.now_ms)
        robot = self.robot
        status = self.core.status()
        goal_mm = self._goal_mm()
        at_rest = abs(robot.v) <= _MOVING_MM_S and abs(robot.w) <= _TURNING_DEG_S
        return Outcome(
            mission=self.mission,
            reached=bool(self.mission.course) and goal_mm <= REACHED_MM and at_rest,
            t_s=self.now_ms / 1000,
            goal_mm=goal_mm,
            driven_mm=robot.travelled_mm,
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


def run(mission: Mission, *, trace: Trace | None = None) -> Outcome:
    """Run a mission to its end."""
    return Sil(mission, trace=trace).run()
