# SPDX-License-Identifier: MIT
"""The judge: compares what really happened (truth records) with what argusd said (events); pure functions only.

Two clocks: truth counts robot time from the emulator's start, argusd counts from its own start. Both run at the
rate of the host's clock, so one offset joins them; `clock_offset_s` finds it. Every time in a `Verdict` is robot time.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from itertools import pairwise
from typing import Any, Final

from hil_sim.errors import SimError
from hil_sim.faults.kinds import KIND_NAME
from hil_sim.tables import load

Record = Mapping[str, Any]

REACHED_MM: Final = 150.0
FAULT_LEAD_MM: Final = 1500.0
"""A fault must come at least this much of the way before the goal, or the drive proves nothing."""
TIME_LIMIT_S: Final = 60.0
PAPER_LIMIT_S: Final = 120.0
"""The paper's method stops every 200 mm."""
IDLE_FACTORS: Final = (0.5, 1.0, 2.0)

_REST_MM_S: Final = 1.0
_REST_DEG_S: Final = 0.5
_REST_S: Final = 0.3
_OFF_MM: Final = 100.0
_OFF_PART: Final = 0.05
_SONAR_NAME: Final = re.compile(r"sonar/[a-z]+/(\d+)")


@dataclass(frozen=True)
class Injected:
    """One fault that was asked for."""

    kind: str
    sonar: int

    def __str__(self) -> str:
        return f"sonar {self.sonar} {self.kind}"


@dataclass(frozen=True)
class Task:
    """What the drive had to do: the goal in the world's frame, the faults asked for, the limit in robot time."""

    goal_mm: tuple[float, float]
    faults: tuple[Injected, ...]
    limit_s: float = TIME_LIMIT_S


@dataclass(frozen=True)
class Rule:
    """One condition of the verdict, whether it holds, and the figures that say why."""

    name: str
    holds: bool
    detail: str


@dataclass(frozen=True)
class Moment:
    """A true pose at a time."""

    t_s: float
    x_mm: float
    y_mm: float
    heading_deg: float


@dataclass(frozen=True)
class Finding:
    """One fault: injected and diagnosed side by side. `None` where it never came to that."""

    fault: Injected
    injected: Moment | None
    way_left_mm: float | None
    first_off_s: float | None
    diagnosed_kind: str | None
    diagnosed: Moment | None

    @property
    def latency_s(self) -> float | None:
        """From the first fired reading that was off, or missing, to the diagnosis."""
        if self.diagnosed is None or self.first_off_s is None:
            return None
        return self.diagnosed.t_s - self.first_off_s


@dataclass(frozen=True)
class Plan:
    """A plan as argusd announced it."""

    t_s: float
    rotations_deg: tuple[int, ...]


@dataclass(frozen=True)
class Journey:
    """What the drive took, measured on the truth between the session's opening and the end."""

    start_s: float
    end_s: float
    way_mm: float
    standstills: int
    stop_commands: int
    steps: int
    sweeps: int
    turns: int
    turned_deg: float
    plans: tuple[Plan, ...]
    energy_j: Mapping[str, float]
    closest: Moment | None
    closest_mm: float | None

    @property
    def time_s(self) -> float:
        """Robot time of the journey."""
        return self.end_s - self.start_s


@dataclass(frozen=True)
class Verdict:
    """All rules with their outcome, and the figures of the drive."""

    rules: tuple[Rule, ...]
    findings: tuple[Finding, ...]
    journey: Journey | None
    false_disables: tuple[tuple[float, int, str], ...] = field(default=())
    host_late_ms: tuple[float, ...] = field(default=())
    """How late the host was with each turn that the emulator calls late: a failure then says little of Argus."""

    @property
    def passed(self) -> bool:
        """Every rule holds."""
        return all(rule.holds for rule in self.rules)

    def as_record(self) -> dict[str, Any]:
        """Return the verdict as plain data for JSON."""
        record: dict[str, Any] = {"passed": self.passed, "rules": [asdict(rule) for rule in self.rules]}
        record["findings"] = [asdict(one) | {"latency_s": one.latency_s} for one in self.findings]
        record["journey"] = asdict(self.journey) | {"time_s": self.journey.time_s} if self.journey else None
        record["host"] = {
            "late_turns": len(self.host_late_ms),
            "late_max_ms": max(self.host_late_ms, default=0.0),
        }
        record["false_disables"] = [
            {"t_s": t_s, "sonar": sonar, "kind": kind} for t_s, sonar, kind in self.false_disables
        ]
        return record


def sonar_of(event: Record) -> int | None:
    """The number of the sonar an event is about, from its name (`sonar/front/03`)."""
    match = _SONAR_NAME.fullmatch(str(event.get("name", "")))
    return int(match[1]) if match else None


def event_s(event: Record) -> float:
    """When argusd raised an event, in seconds of its own clock."""
    return float(event["t"])


def of_type(truth: Sequence[Record], kind: str) -> list[Record]:
    """The truth records of one type, in order."""
    return [record for record in truth if record.get("type") == kind]


def _least(records: Sequence[Record], wall: str, own: str) -> float | None:
    """The smallest (wall clock - own clock) of a stream: that of the line that waited least."""
    return min(
        (float(one[wall]) - float(one[own]) for one in records if wall in one and own in one), default=None
    )


def clock_offset_s(truth: Sequence[Record], events: Sequence[Record]) -> float:
    """What to add to argusd's time to get robot time.

    Best: the reader of both streams noted the wall clock beside each line (`wall_s`). A line can only be read after
    it was written. So in each stream the smallest (wall - own time) is that of the line read with the least delay.
    With thousands of lines that delay is a few ms, and the difference of the two minima is the offset. Next: the
    calendar time that both programs write themselves, `unix_s` in the emulator's clock record and `unix` in argusd's
    status. It does as well unless a person set the clock. Last: argusd's SESSION_OPEN is taken to be simultaneous
    with the emulator's. It is up to 0.3 s later, so a diagnosis may then seem to come before its fault.
    """
    for wall_truth, wall_events in (("wall_s", "wall_s"), ("unix_s", "unix")):
        of_truth, of_events = _least(truth, wall_truth, "t_s"), _least(events, wall_events, "t")
        if of_truth is not None and of_events is not None:
            return of_events - of_truth
    opened_truth = [record["t_s"] for record in of_type(truth, "session") if record.get("state") == "open"]
    opened_events = [event_s(event) for event in events if event.get("event") == "SESSION_OPEN"]
    if not opened_truth or not opened_events:
        raise SimError(
            "the two clocks cannot be joined: no wall times and no opened session in the recording"
        )
    return float(opened_truth[0]) - opened_events[0]


class _Drive:
    """The recording, indexed; times are robot time."""

    def __init__(self, truth: Sequence[Record], events: Sequence[Record]) -> None:
        self.truth = truth
        self.states = of_type(truth, "state")
        self.offset_s = clock_offset_s(truth, events)
        self.events = [(event_s(event) + self.offset_s, event) for event in events]
        opened = [record["t_s"] for record in of_type(truth, "session") if record.get("state") == "open"]
        self.start_s = float(opened[0]) if opened else 0.0
        self.way_mm = [0.0]
        for before, after in pairwise(self.states):
            step = math.hypot(after["x_mm"] - before["x_mm"], after["y_mm"] - before["y_mm"])
            self.way_mm.append(self.way_mm[-1] + step)

    def named(self, name: str) -> list[tuple[float, Record]]:
        return [(t_s, event) for t_s, event in self.events if event.get("event") == name]

    @property
    def goal_s(self) -> float | None:
        said = self.named("GOAL_REACHED")
        return said[0][0] if said else None

    @property
    def end_s(self) -> float:
        last = float(self.states[-1]["t_s"]) if self.states else self.start_s
        return min(self.goal_s, last) if self.goal_s is not None else last

    def index(self, t_s: float) -> int:
        """The state nearest to a time."""
        return min(range(len(self.states)), key=lambda i: abs(self.states[i]["t_s"] - t_s))

    def moment(self, t_s: float) -> Moment:
        state = self.states[self.index(t_s)]
        return Moment(t_s, state["x_mm"], state["y_mm"], state["heading_deg"])

    def within(self) -> list[Record]:
        return [state for state in self.states if self.start_s <= state["t_s"] <= self.end_s]


def is_at_rest(state: Record) -> bool:
    """The true robot stands, as far as a truth record shows it."""
    return bool(abs(state["v_mm_s"]) <= _REST_MM_S and abs(state["w_deg_s"]) <= _REST_DEG_S)


def _onset(drive: _Drive, fault: Injected) -> Record | None:
    for record in of_type(drive.truth, "fault"):
        sonars = record.get("sonars", ())
        if record.get("active") and record.get("kind") == fault.kind and fault.sonar in sonars:
            return record
    return None


def _first_off_s(drive: _Drive, fault: Injected, onset_s: float) -> float | None:
    """The first fired reading off by more than max(100 mm, 5 %) after a fault's onset."""
    for record in of_type(drive.truth, "sonar"):
        if record["sonar"] == fault.sonar and record["t_s"] >= onset_s:
            limit = max(_OFF_MM, _OFF_PART * record["true_mm"])
            if abs(record["range_mm"] - record["true_mm"]) > limit:
                return float(record["t_s"])
    return None


def _disables(drive: _Drive) -> list[tuple[float, int, str]]:
    found = []
    for t_s, event in drive.named("SONAR_DISABLED"):
        sonar = sonar_of(event)
        found.append((t_s, -1 if sonar is None else sonar, _kind_of(event)))
    return found


def _finding(drive: _Drive, fault: Injected) -> Finding:
    onset = _onset(drive, fault)
    own = [t_s for t_s, sonar, _ in _disables(drive) if sonar == fault.sonar]
    diagnosed = drive.moment(own[0]) if own else None
    kind = _kinds(drive).get(fault.sonar)
    if onset is None:
        return Finding(fault, None, None, None, kind, diagnosed)
    at_s = float(onset["t_s"])
    left = drive.way_mm[-1] - drive.way_mm[drive.index(at_s)]
    return Finding(fault, drive.moment(at_s), left, _first_off_s(drive, fault, at_s), kind, diagnosed)


def _kind_of(event: Record) -> str:
    return KIND_NAME.get(event.get("value", 0), "unknown")


def _kinds(drive: _Drive, *, at_the_end: bool = False) -> dict[int, str]:
    """The sonars that argusd called DISABLED, or holds so at the end, with the kinds that it gave them last."""
    held: dict[int, str] = {}
    for _, event in drive.events:
        sonar, name = sonar_of(event), event.get("event")
        if sonar is None:
            continue
        if name == "SONAR_DISABLED" or (name == "SONAR_KIND" and sonar in held):
            held[sonar] = _kind_of(event)
        elif name == "SONAR_HEALTHY" and at_the_end:
            held.pop(sonar, None)
    return held


def _false_disables(drive: _Drive, findings: Sequence[Finding]) -> list[tuple[float, int, str]]:
    injected = {one.fault.sonar: one.injected for one in findings}
    return [
        (t_s, sonar, kind)
        for t_s, sonar, kind in _disables(drive)
        if (moment := injected.get(sonar)) is None or t_s < moment.t_s
    ]


def _set_text(held: Mapping[int, str]) -> str:
    return ", ".join(f"{sonar} {kind}" for sonar, kind in sorted(held.items())) or "none"


# ---- the rules ---------------------------------------------------------------------------------------------


def _rule_goal(drive: _Drive, task: Task) -> Rule:
    last = drive.states[-1]
    off = math.hypot(last["x_mm"] - task.goal_mm[0], last["y_mm"] - task.goal_mm[1])
    detail = f"the true centre ended {off:.0f} mm from the goal; at most {REACHED_MM:.0f} allowed"
    return Rule("goal reached", off <= REACHED_MM, detail)


def _rule_rest(drive: _Drive) -> Rule:
    last = drive.states[-1]
    moving = [
        state for state in drive.states if state["t_s"] > last["t_s"] - _REST_S and not is_at_rest(state)
    ]
    detail = f"{last['v_mm_s']:.0f} mm/s and {last['w_deg_s']:.0f} deg/s at the end"
    return Rule("at rest", not moving, detail)


def _rule_said(drive: _Drive) -> Rule:
    failed = drive.named("MISSION_FAILED")
    if failed:
        detail = f"argusd gave the course up at {failed[0][0]:.1f} s, {failed[0][1].get('value')} mm before the goal"
    elif drive.goal_s is None:
        detail = "argusd never said GOAL_REACHED"
    else:
        detail = f"argusd said so at {drive.goal_s:.1f} s"
    return Rule("argusd knows it arrived", drive.goal_s is not None and not failed, detail)


def _rule_time(drive: _Drive, task: Task) -> Rule:
    taken = drive.end_s - drive.start_s
    holds = drive.goal_s is not None and taken <= task.limit_s
    late = "" if drive.goal_s is not None else " without reaching the goal"
    return Rule("in time", holds, f"{taken:.1f} s of robot time{late}; at most {task.limit_s:.0f} allowed")


def _rule_collision(drive: _Drive) -> Rule:
    hits = of_type(drive.truth, "collision")
    if not hits:
        return Rule("nothing hit", True, "no collision")
    first = hits[0]
    place = f"first at {first['t_s']:.1f} s, x {first['x_mm']:.0f} y {first['y_mm']:.0f} mm"
    return Rule("nothing hit", False, f"{len(hits)} collision{'s' * (len(hits) > 1)}, {place}")


def _rule_injected(findings: Sequence[Finding]) -> Rule:
    wrong = [f"{one.fault}: never injected" for one in findings if one.injected is None]
    wrong += [
        f"{one.fault}: only {one.way_left_mm:.0f} mm of way were left"
        for one in findings
        if one.way_left_mm is not None and one.way_left_mm < FAULT_LEAD_MM
    ]
    least = min((one.way_left_mm for one in findings if one.way_left_mm is not None), default=0.0)
    detail = "; ".join(wrong) or f"at least {least:.0f} mm of way were left; {FAULT_LEAD_MM:.0f} wanted"
    return Rule("faults came in time", not wrong, detail)


def _rule_equals(drive: _Drive, task: Task) -> Rule:
    wanted = {fault.sonar: fault.kind for fault in task.faults}
    held = _kinds(drive, at_the_end=True)
    detail = f"injected: {_set_text(wanted)}; DISABLED at the end: {_set_text(held)}"
    return Rule("diagnosis equals injection", wanted == held, detail)


def _rule_after(findings: Sequence[Finding]) -> Rule:
    early = [
        f"{one.fault}: DISABLED at {one.diagnosed.t_s:.2f} s"
        + (f", injected at {one.injected.t_s:.2f} s" if one.injected else ", never injected")
        for one in findings
        if one.diagnosed is not None and (one.injected is None or one.diagnosed.t_s < one.injected.t_s)
    ]
    return Rule(
        "each after its injection", not early, "; ".join(early) or "no diagnosis came before its fault"
    )


def _rule_healthy(false: Sequence[tuple[float, int, str]]) -> Rule:
    detail = "; ".join(f"sonar {sonar} DISABLED as {kind} at {t_s:.1f} s" for t_s, sonar, kind in false)
    return Rule("no healthy sonar disabled", not false, detail or "none was")


def _rule_whole(drive: _Drive) -> Rule:
    bad = [
        f"{event['event']} {event.get('value')}"
        for name in ("INVARIANT", "EVENTS_LOST")
        for _, event in drive.named(name)
    ]
    return Rule("argusd is consistent", not bad, "; ".join(bad) or "no broken invariant, no lost event")


# ---- the journey -------------------------------------------------------------------------------------------


def energy_j(start: Record, end: Record, idle_factor: float = 1.0) -> float:
    """Energy drawn between two truth states with the idle power scaled; constants from the energy table."""
    power = load("energy")["power"]
    account = {
        key: end["energy_j"][key] - start["energy_j"][key]
        for key in ("idle_s", "sonar_s", "wheel_m", "accel_j")
    }
    total = account["idle_s"] * power["idle_w"] * idle_factor + account["sonar_s"] * power["sonar_w"]
    return float(total + account["wheel_m"] * power["wheel_j_per_m"] + account["accel_j"])


def _plans(drive: _Drive) -> tuple[Plan, ...]:
    plans: list[Plan] = []
    for t_s, event in drive.events:
        if event.get("event") == "PLAN":
            plans.append(Plan(t_s, ()))
        elif event.get("event") == "PLAN_ROTATION" and plans:
            last = plans[-1]
            plans[-1] = Plan(last.t_s, (*last.rotations_deg, int(event["value"])))
    return tuple(plans)


def _rises(flags: Sequence[bool]) -> int:
    """How often a flag goes from false to true."""
    return sum(after and not before for before, after in pairwise(flags))


def _journey(drive: _Drive) -> Journey | None:
    states = drive.within()
    if len(states) < 2:
        return None
    closest = min(states, key=lambda state: state["clearance_mm"])
    turned = sum(
        abs(math.remainder(after["heading_deg"] - before["heading_deg"], 360))
        for before, after in pairwise(states)
    )
    first, last = drive.index(states[0]["t_s"]), drive.index(states[-1]["t_s"])
    return Journey(
        start_s=drive.start_s,
        end_s=drive.end_s,
        way_mm=drive.way_mm[last] - drive.way_mm[first],
        standstills=_rises([abs(state["v_mm_s"]) <= _REST_MM_S for state in states]),
        stop_commands=len(drive.named("STOPPED")),
        steps=len(drive.named("STEP")),
        sweeps=len(drive.named("SWEEP")),
        turns=_rises([abs(state["w_deg_s"]) > 2 for state in states]),
        turned_deg=turned,
        plans=_plans(drive),
        energy_j={f"idle x {factor:g}": energy_j(states[0], states[-1], factor) for factor in IDLE_FACTORS},
        closest=Moment(closest["t_s"], closest["x_mm"], closest["y_mm"], closest["heading_deg"]),
        closest_mm=float(closest["clearance_mm"]),
    )


def judge(truth: Sequence[Record], events: Sequence[Record], task: Task) -> Verdict:
    """Return the verdict on one drive; raises `SimError` when the recording is too poor to judge."""
    if not of_type(truth, "state"):
        raise SimError("the truth record holds no state of the robot: nothing to judge")
    drive = _Drive(truth, events)
    findings = tuple(_finding(drive, fault) for fault in task.faults)
    false = tuple(_false_disables(drive, findings))
    rules = (
        _rule_goal(drive, task),
        _rule_rest(drive),
        _rule_said(drive),
        _rule_time(drive, task),
        _rule_collision(drive),
        _rule_injected(findings),
        _rule_equals(drive, task),
        _rule_after(findings),
        _rule_healthy(false),
        _rule_whole(drive),
    )
    late = tuple(float(record["late_ms"]) for record in of_type(truth, "late"))
    return Verdict(rules, findings, _journey(drive), false, late)
