# SPDX-License-Identifier: MIT
"""What there is to draw of a drive, and what follows from it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from hil_sim.demo.ink import ABOUT_MM, FRONT, MARGIN_MM, ROBOT, place
from hil_sim.demo.judge import Record, Verdict, of_type, sonar_of
from hil_sim.sonar.params import NO_ECHO_MM
from hil_sim.world.model import World

_STANDS_MM_S: Final = 5.0


@dataclass(frozen=True)
class Drive:
    """What there is to draw; times of `events` are argusd's, `offset_s` makes them robot time."""

    world: World
    course_mm: Sequence[tuple[float, float]]
    truth: Sequence[Record]
    events: Sequence[Record]
    verdict: Verdict
    offset_s: float
    title: str

    @property
    def start_s(self) -> float:
        """Robot time at which the session opened."""
        return self.verdict.journey.start_s if self.verdict.journey else 0.0

    @property
    def end_s(self) -> float:
        """Robot time at which the journey ended."""
        return self.verdict.journey.end_s if self.verdict.journey else 0.0

    def states(self) -> list[Record]:
        """True states of the journey."""
        return [state for state in of_type(self.truth, "state") if self.start_s <= state["t_s"] <= self.end_s]

    def said(self, *names: str) -> list[tuple[float, Record]]:
        """Events of these names with robot times."""
        return [(e["t"] + self.offset_s, e) for e in self.events if e.get("event") in names]


def loops(world: World) -> Iterator[list[tuple[float, float]]]:
    """Closed outlines among consecutive segments of a world: rooms, boxes, posts."""
    chain: list[tuple[float, float]] = []
    for x1, y1, x2, y2 in world.segments:
        if not chain or chain[-1] != (x1, y1):
            chain = [(x1, y1)]
        chain.append((x2, y2))
        if chain[0] == chain[-1]:
            yield chain[:-1]
            chain = []


def area(points: Sequence[tuple[float, float]]) -> float:
    """Return what a closed line encloses, mm2."""
    shifted = [*points[1:], points[0]]
    return abs(sum(x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in zip(points, shifted, strict=True))) / 2


def hits(drive: Drive) -> Iterator[tuple[int, float, float, str | None]]:
    """Sonar number, place of the reported echo, and the fault that made it, for every echo of sonars 1 to 6."""
    states = drive.states()
    k = 0
    for record in of_type(drive.truth, "sonar"):
        if not drive.start_s <= record["t_s"] <= drive.end_s or record["range_mm"] >= NO_ECHO_MM:
            continue
        while k + 1 < len(states) and states[k + 1]["t_s"] <= record["t_s"]:
            k += 1
        pose = ROBOT.mounts[record["sonar"]]
        axis = math.radians(pose.heading_deg)
        reach = record["range_mm"]
        echo = (pose.x_mm + reach * math.cos(axis), pose.y_mm + reach * math.sin(axis))
        state = states[k]
        x, y = place(state["x_mm"], state["y_mm"], state["heading_deg"], echo)
        if record["sonar"] in FRONT:
            yield record["sonar"], x, y, record.get("fault")


def failure_since_s(drive: Drive) -> float:
    """When the first plan was made: from then on the robot drives in steps."""
    planned = (
        [plan.t_s for plan in drive.verdict.journey.plans if plan.rotations_deg]
        if drive.verdict.journey
        else []
    )
    return min(planned, default=math.inf)


def standstills(states: Sequence[Record]) -> Iterator[list[Record]]:
    """Runs of states during which the robot did not translate."""
    run: list[Record] = []
    for state in states:
        if abs(state["v_mm_s"]) <= _STANDS_MM_S:
            run.append(state)
        elif run:
            yield run
            run = []
    if run:
        yield run


def health_spans(drive: Drive, sonar: int) -> list[tuple[float, float, str]]:
    """What argusd held of a sonar: from, to, one of healthy, suspect, disabled."""
    word = {"SONAR_SUSPECT": "suspect", "SONAR_CLEARED": "healthy", "SUSPICION_DROPPED": "healthy"}
    word |= {"SONAR_HEALTHY": "healthy", "SONAR_DISABLED": "disabled"}
    spans: list[tuple[float, float, str]] = []
    since, now = drive.start_s, "unknown"
    for t_s, event in drive.said(*word):
        if sonar_of(event) == sonar and word[event["event"]] != now:
            spans.append((since, t_s, now))
            since, now = t_s, word[event["event"]]
    return [*spans, (since, drive.end_s, now)]


def doubted_s(drive: Drive, sonar: int, since_s: float) -> float | None:
    """Return when argusd first doubted a sonar from a time on, None if it never did."""
    starts = (
        start for start, _, word in health_spans(drive, sonar) if word == "suspect" and start >= since_s
    )
    return next(starts, None)


def robot_spans(drive: Drive) -> Iterator[tuple[float, float, str]]:
    """What the robot did: from, to, one of drive, turn, stand."""
    since, now = drive.start_s, ""
    for state in drive.states():
        doing = (
            "drive"
            if abs(state["v_mm_s"]) > _STANDS_MM_S
            else "turn"
            if abs(state["w_deg_s"]) > 1
            else "stand"
        )
        if doing != now:
            if now:
                yield since, state["t_s"], now
            since, now = state["t_s"], doing
    if now:
        yield since, drive.end_s, now


def window(drive: Drive) -> tuple[float, float, float, float]:
    """What the map shows: the whole of a room and some paper beside it, of a larger world what lies about the way."""
    states = drive.states() or [{"x_mm": 0.0, "y_mm": 0.0}]
    xs, ys = [s["x_mm"] for s in states], [s["y_mm"] for s in states]
    x1, y1, x2, y2 = drive.world.bounds
    return (
        max(x1, min(xs) - ABOUT_MM),
        max(y1, min(ys) - ABOUT_MM),
        min(x2 + MARGIN_MM, max(xs) + ABOUT_MM),
        min(y2, max(ys) + ABOUT_MM),
    )
