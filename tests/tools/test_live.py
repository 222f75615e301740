# SPDX-License-Identifier: MIT
"""Rule: the live client, plain or async, does the same; it returns when the goal is reached, raises when it is not, and
stops the robot whenever anything else ends the waiting."""

from __future__ import annotations

import asyncio
import inspect
import json
import socket
import threading
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any, Final

import argus
import pytest
from argus_tools.control.client import Message

STREAM: Final = Path(__file__).resolve().parents[1] / "data/control/stream.jsonl"
STATUS: Final = next(
    line for line in map(json.loads, STREAM.read_text(encoding="utf-8").splitlines()) if "health" in line
)
STOP, MOVE, TURN, PASSIVE = 1, 4, 5, 6
Talk = Callable[[Any], Awaitable[Any]]


def event(name: str, value: int, about: str = "task") -> Message:
    return {"t": 1.0, "event": name, "id": 1, "level": 0, "name": about, "value": value, "state": "IsNormal"}


def status(**changed: Any) -> Message:
    return {**STATUS, **changed}


class Argusd:
    """Obeys every order; after the first of a name it streams what is given for it. Keeps what it was asked."""

    def __init__(self, folder: Path, streams: dict[str, list[Message]], **changed: Any) -> None:
        self.place = f"unix:{folder}/s"
        self.asked: list[Message] = []
        self._streams = dict(streams)
        self._status = status(**changed)
        self._listening = socket.socket(socket.AF_UNIX)
        self._listening.bind(str(folder / "s"))
        self._listening.listen()
        threading.Thread(target=self._run, daemon=True).start()

    def orders(self) -> list[str]:
        return [asked["order"] for asked in self.asked if asked["do"] == "order"]

    def _run(self) -> None:
        near, _ = self._listening.accept()
        with near, self._listening, near.makefile("rw", encoding="utf-8") as lines:

            def say(*messages: Message) -> None:
                lines.writelines(json.dumps(message) + "\n" for message in messages)
                lines.flush()

            say({"control": 1, "argus": "0.1.0", "auth": "none"})
            for line in lines:
                asked = json.loads(line)
                self.asked.append(asked)
                say({"re": asked["id"], "ok": True, "grant": "g", "state": self._status})
                say(*self._streams.pop(asked.get("order", asked["do"]), []))


class _Awaited:
    """The plain robot as if it were the async one, so that a test is written once."""

    def __init__(self, robot: argus.Robot) -> None:
        self._robot = robot

    def __getattr__(self, name: str) -> Callable[..., Awaitable[Any]]:
        async def call(*args: Any, **named: Any) -> Any:
            return getattr(self._robot, name)(*args, **named)

        return call


def plain(place: str, talk: Talk) -> Any:
    with argus.connect(place) as robot:
        return asyncio.run(_run(talk, _Awaited(robot)))


async def _run(talk: Talk, robot: Any) -> Any:
    return await talk(robot)


def awaited(place: str, talk: Talk) -> Any:
    async def run() -> Any:
        async with argus.connect_async(place) as robot:
            return await talk(robot)

    return asyncio.run(run())


Speak = Callable[[str, Talk], Any]
either = pytest.mark.parametrize("speak", [plain, awaited])


def test_both_have_the_same_methods() -> None:
    def public(kind: type) -> dict[str, list[str]]:
        return {
            name: list(inspect.signature(method).parameters)
            for name, method in vars(kind).items()
            if callable(method) and not name.startswith("_")
        }

    assert public(argus.Robot) == public(argus.AsyncRobot)
    assert len(public(argus.Robot)) > 12


@either
def test_a_state_is_typed_and_in_the_units_of_its_names(speak: Speak, tmp_path: Path) -> None:
    health = ["HEALTHY"] * 3 + ["DISABLED"] + ["HEALTHY"] * 12
    kind = ["", "", "", "off", *[""] * 12]
    ages = [-1, *[20] * 15]
    argusd = Argusd(tmp_path, {}, heading_cdeg=-9000, health=health, kind=kind, age_ms=ages)
    state = speak(argusd.place, lambda robot: robot.state())
    assert (state.heading_deg, state.battery_v, state.subclass) == (-90.0, 12.7, "p3dx-sh")
    assert [sonar.number for sonar in state.failing] == [3]
    assert state.sonars[0].reading_mm is None
    assert str(state.sonars[0]) == "sonar  0 at   90 deg: HEALTHY, never reported"
    assert str(state.sonars[3]) == "sonar  3 at   10 deg: DISABLED, off, 2443 mm"
    assert str(state.sonars[5]) == "sonar  5 at  -30 deg: HEALTHY, no echo"


@either
def test_a_drive_ends_at_its_goal(speak: Speak, tmp_path: Path) -> None:
    stream = [status(), event("MISSION_START", 1), status(), event("GOAL_REACHED", 12), event("STOPPED", 0)]
    argusd = Argusd(tmp_path, {"goto": stream})
    state = speak(argusd.place, lambda robot: robot.drive_to(2000, -5))
    assert state.robot == STATUS["robot"]
    (order,) = [asked for asked in argusd.asked if asked["do"] == "order"]
    assert (order["x_mm"], order["y_mm"], order["grant"], order["seq"]) == (2000, -5, "g", 1)
    assert argusd.asked[-1]["topics"] == [], "nothing is streamed to who does not listen"


@either
@pytest.mark.parametrize(
    ("stream", "why"),
    [
        ([event("MISSION_START", 2), event("MISSION_FAILED", 800)], "given up 800 mm from its goal"),
        ([event("MISSION_START", 2), event("OPERATOR", STOP)], "another order stopped"),
        ([event("MISSION_START", 2), event("OPERATOR", PASSIVE)], "another order stopped"),
        ([event("MISSION_START", 2), event("MISSION_START", 1)], "another course"),
        ([event("MISSION_START", 7)], "another course"),
    ],
)
def test_a_drive_that_ends_otherwise_is_refused(
    speak: Speak, stream: list[Message], why: str, tmp_path: Path
) -> None:
    argusd = Argusd(tmp_path, {"course": stream})
    with pytest.raises(argus.Refused, match=why):
        speak(argusd.place, lambda robot: robot.drive_through([(500, 0), (500, 500)]))
    assert argusd.orders() == ["course"], "it does not stop what another ordered"


@either
def test_what_was_over_before_is_no_end(speak: Speak, tmp_path: Path) -> None:
    stream = [event("GOAL_REACHED", 3), event("OPERATOR", STOP), event("MISSION_FAILED", 9)]
    argusd = Argusd(tmp_path, {"goto": [*stream, event("MISSION_START", 1), event("GOAL_REACHED", 1)]})
    assert speak(argusd.place, lambda robot: robot.drive_to(1, 1)).online


@either
def test_a_passive_robot_is_not_waited_for(speak: Speak, tmp_path: Path) -> None:
    argusd = Argusd(tmp_path, {}, active=False)
    with pytest.raises(argus.Refused, match="passive"):
        speak(argusd.place, lambda robot: robot.drive_to(2000, 0))
    assert argusd.orders() == []


@either
def test_a_drive_that_takes_too_long_is_stopped(speak: Speak, tmp_path: Path) -> None:
    argusd = Argusd(tmp_path, {"goto": [event("MISSION_START", 1)]})
    with pytest.raises(TimeoutError, match="the robot is stopped"):
        speak(argusd.place, lambda robot: robot.drive_to(2000, 0, timeout_s=0.3))
    assert argusd.orders() == ["goto", "stop"]


def test_a_cancelled_drive_is_stopped(tmp_path: Path) -> None:
    argusd = Argusd(tmp_path, {"goto": [event("MISSION_START", 1)]})

    async def talk(robot: argus.AsyncRobot) -> None:
        driving = asyncio.create_task(robot.drive_to(2000, 0))
        while "goto" not in argusd.orders():
            await asyncio.sleep(0.01)
        driving.cancel()
        with pytest.raises(asyncio.CancelledError):
            await driving

    awaited(argusd.place, talk)
    assert argusd.orders() == ["goto", "stop"]


@either
def test_a_turn_ends_when_the_robot_stands(speak: Speak, tmp_path: Path) -> None:
    modes = ("IDLE", "STEPPING", "IDLE")
    stream = [event("OPERATOR", TURN), *(status(mode=mode, t=2.0) for mode in modes)]
    argusd = Argusd(tmp_path, {"turn": stream})
    speak(argusd.place, lambda robot: robot.turn(-30))
    assert argusd.orders() == ["turn"]


def test_events_go_on_while_orders_are_given(tmp_path: Path) -> None:
    on_the_way = event("SONAR_SUSPECT", 900, "sonar/rear/11")
    stream = [event("MISSION_START", 1), on_the_way, event("GOAL_REACHED", 1)]
    argusd = Argusd(tmp_path, {"watch": [event("HEALTH_CHECK", 0, "health")], "goto": stream})
    seen = []
    with argus.connect(argusd.place) as robot:
        for found in robot.events(timeout_s=60):
            seen.append((found.event, found.sonar))
            if found.event == "HEALTH_CHECK":
                robot.drive_to(300, 0)
            elif found.event == "GOAL_REACHED":
                break
    assert seen == [
        ("HEALTH_CHECK", None),
        ("MISSION_START", None),
        ("SONAR_SUSPECT", 11),
        ("GOAL_REACHED", None),
    ]


def test_nobody_there_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(argus.ControlError, match="is argusd running there"):
        argus.connect(f"unix:{tmp_path}/none")

    async def nobody() -> None:
        async with argus.connect_async(f"unix:{tmp_path}/none"):
            pass

    with pytest.raises(argus.ControlError, match="No such file"):
        asyncio.run(nobody())
