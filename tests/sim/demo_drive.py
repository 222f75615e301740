# SPDX-License-Identifier: MIT
"""A made-up drive for the tests of the demonstration: records and events as the two programs write them."""

from __future__ import annotations

import copy
import math
from functools import cache
from random import Random
from typing import Any

from hil_sim.demo.judge import Injected, Task, Verdict, judge
from hil_sim.demo.scene import Drive as Drawing
from hil_sim.world.files import load_world

OPEN_S = 1.0
"""Robot time at which the session opens."""
CLOCK_S = 37.5
"""argusd's clock minus robot time."""

WALL_S = 9000.0
"""The host's clock minus robot time."""

WAYPOINTS = ((0.0, 0.0), (1700.0, 0.0), (1700.0, 1550.0))
FAULTS = (Injected("off", 3), Injected("wrong", 6))
TASK = Task(WAYPOINTS[-1], FAULTS)

Record = dict[str, Any]

_DT = 0.1
_LEVEL = {"SONAR_DISABLED": 2, "FAILURE_STATE": 1}
_KIND = {"off": 1, "wrong": 4}


class Drive:
    """Writes both records while a scripted robot drives; faults come at 0.6 m and 1.2 m of way."""

    def __init__(self) -> None:
        self.truth: list[dict[str, Any]] = [{"type": "meta", "world": "demo", "seed": 1}]
        self.events: list[dict[str, Any]] = []
        self.t_s, (self.x, self.y), self.heading = 0.0, WAYPOINTS[0], 0.0
        self.v = self.w = self.way = 0.0
        self.wheel_m = 0.0
        self.active: dict[int, str] = {}
        self.pending = [(600.0, FAULTS[0]), (1200.0, FAULTS[1])]

    def say(self, event: str, name: str = "health", value: int = 0, state: str = "IsNormal") -> None:
        """Write one event of argusd."""
        record: Record = {
            "t": round(self.t_s + CLOCK_S, 3),
            "event": event,
            "id": 0,
            "level": _LEVEL.get(event, 0),
        }
        self.events.append(record | {"name": name, "value": value, "state": state})

    def status(self) -> None:
        """Write the periodic status with what the live view shows."""
        self.say("STATUS", "status")
        sick = [self.active.get(number, "") for number in range(16)]
        self.events[-1] |= {
            "mode": "DRIVING",
            "goal_mm": max(0, round(3250 - self.way)),
            "course_mm": 3250,
            "plan_deg": [-20] if self.active else [],
            "reading_mm": [1800 + number for number in range(16)],
            "health": ["DISABLED" if kind else "HEALTHY" for kind in sick],
            "kind": sick,
        }

    def tick(self) -> None:
        """Let 100 ms pass: move, fire two sonars, write the state."""
        self.t_s = round(self.t_s + _DT, 3)
        self.heading += self.w * _DT
        self.x += self.v * _DT * math.cos(math.radians(self.heading))
        self.y += self.v * _DT * math.sin(math.radians(self.heading))
        self.way += abs(self.v) * _DT
        self.wheel_m += 2 * abs(self.v) * _DT / 1000
        for number in range(1, 7):
            kind = self.active.get(number)
            seen = {"off": 5000, "wrong": 900}.get(kind or "", 1800)
            ping: Record = {"type": "sonar", "t_s": self.t_s, "sonar": number, "fault": kind}
            self.truth.append(ping | {"range_mm": seen, "true_mm": 1800})
        energy: Record = {"total": 0.0, "idle_s": self.t_s, "sonar_s": self.t_s}
        energy |= {"wheel_m": self.wheel_m, "accel_j": 0.1}
        state = {"x_mm": self.x, "y_mm": self.y, "heading_deg": math.remainder(self.heading, 360)}
        state |= {"v_mm_s": self.v, "w_deg_s": self.w, "clearance_mm": 400 + abs(self.x - 2500) / 4}
        self.truth.append({"type": "state", "t_s": self.t_s, **state, "energy_j": energy, "battery_v": 12.6})
        while self.pending and self.way >= self.pending[0][0]:
            fault = self.pending.pop(0)[1]
            self.active[fault.sonar] = fault.kind
            record: Record = {"type": "fault", "t_s": self.t_s, "kind": fault.kind, "active": True}
            self.truth.append(record | {"sonars": [fault.sonar]})

    def stand(self, seconds: float) -> None:
        """Stand still."""
        self.v = self.w = 0.0
        for _ in range(round(seconds / _DT)):
            self.tick()

    def turn(self, degrees: float) -> None:
        """Turn on the spot at 40 degrees a second."""
        ticks = max(1, round(abs(degrees) / 4))
        self.v, self.w = 0.0, degrees / (ticks * _DT)
        for _ in range(ticks):
            self.tick()
        self.stand(0.3)

    def check(self) -> None:
        """Diagnose what has come since, as argusd would."""
        for sonar, kind in self.active.items():
            name = f"sonar/front/{sonar:02}"
            if not any(e["event"] == "SONAR_DISABLED" and e["name"] == name for e in self.events):
                self.stand(0.5)
                self.say("STOPPED")
                self.say("SONAR_DISABLED", name, _KIND[kind], "IsMinor")
                self.say("FAILURE_STATE", value=len(self.active), state="IsMinor")
                self.say("PLAN", "plan", 1, "IsMinor")
                self.say("PLAN_ROTATION", "plan", -20, "IsMinor")

    def drive(self, length_mm: float) -> None:
        """Drive straight on: at 200 mm/s, or in failure mode in steps after a sweep each."""
        left = length_mm
        while left > 1:
            self.check()
            if self.active:
                self.turn(-20)
                self.turn(20)
                self.say("SWEEP", "drive", 1500, "IsMinor")
                self.say("STEP", "drive", 200, "IsMinor")
            self.status()
            run = min(200.0, left)
            ticks = math.ceil(run / (10 if self.active else 20))
            self.v, self.w = run / (ticks * _DT), 0.0
            for _ in range(ticks):
                self.tick()
            left -= run

    def run(self) -> Drive:
        """Drive the whole course."""
        self.stand(OPEN_S)
        self.truth.append({"type": "session", "t_s": self.t_s, "state": "open"})
        self.say("SESSION_OPEN", "session", 1)
        self.say("MISSION_START", "task", len(WAYPOINTS) - 1)
        for x, y in WAYPOINTS[1:]:
            bearing = math.degrees(math.atan2(y - self.y, x - self.x))
            self.turn(math.remainder(bearing - self.heading, 360))
            self.drive(math.hypot(x - self.x, y - self.y))
        self.stand(0.5)
        self.say("GOAL_REACHED", "task", 20, "IsMinor")
        self.stand(1.0)
        return self


@cache
def _made() -> tuple[list[Record], list[Record]]:
    drive = Drive().run()
    return drive.truth, drive.events


def made_up() -> tuple[list[Record], list[Record]]:
    """Return truth and events of a drive on which every rule holds; the caller may doctor them."""
    truth, events = _made()
    return copy.deepcopy(truth), copy.deepcopy(events)


def robot_s(event: Record) -> float:
    """Robot time of an event."""
    return float(event["t"]) - CLOCK_S


def read_late(truth: list[Record], events: list[Record], seed: int) -> None:
    """Note the wall clock at which each line was read: 0 to 400 ms late, one of each stream at once."""
    random = Random(seed)
    for records, own_s in ((truth, lambda r: r["t_s"]), (events, robot_s)):
        timed = [record for record in records if "t_s" in record or "t" in record]
        prompt = random.randrange(len(timed))
        for number, record in enumerate(timed):
            late_s = 0.0 if number == prompt else random.uniform(0.0, 0.4)
            record["wall_s"] = own_s(record) + WALL_S + late_s


def named(events: list[Record], name: str) -> list[Record]:
    """The events of one name."""
    return [event for event in events if event["event"] == name]


def verdict_on(truth: list[Record], events: list[Record]) -> Verdict:
    """What the judge says to the task of these drives."""
    return judge(truth, events, TASK)


def drawing(truth: list[Record], events: list[Record]) -> Drawing:
    """Return what the picture is drawn from."""
    verdict = verdict_on(truth, events)
    return Drawing(load_world("demo"), WAYPOINTS[1:], truth, events, verdict, -CLOCK_S, "A made-up drive")
