# SPDX-License-Identifier: MIT
"""Rule: a page that comes late is told what it has missed, in bounded space, and echoes lie where the sonars point."""

from __future__ import annotations

import asyncio
import math
from typing import Any

import pytest
from argus_tools.monitor.geometry import robot_message, robot_of, walls_of
from argus_tools.monitor.hub import Outbox
from argus_tools.monitor.memory import ECHOES_KEPT, EVENTS_KEPT, PATH_KEPT, Memory, kind_of
from fake_argusd import recorded

from hil_sim.world.files import load_world
from hil_sim.world.model import Pose

Message = dict[str, Any]


def state(t: float, x: int = 0, y: int = 0, cdeg: int = 0, **more: Any) -> Message:
    base: Message = {"event": "STATUS", "t": t, "x_mm": x, "y_mm": y, "heading_cdeg": cdeg}
    base |= {"subclass": "p3dx-sh", "kind": [""] * 16, "health": ["HEALTHY"] * 16}
    return base | more


def readings(mm: dict[int, int], age_ms: int = 0) -> Message:
    ages = [age_ms if k in mm else 900 for k in range(16)]
    return {"readings": {"t": 1.0, "sip": 1, "mm": [mm.get(k, 5000) for k in range(16)], "age_ms": ages}}


def echoes_of(told: list[Message]) -> list[tuple[int, int, int]]:
    return [echo for message in told for echo in message.get("trail", {}).get("echoes", ())]


def test_a_recorded_drive_is_remembered() -> None:
    memory = Memory()
    for message in recorded():
        memory.take(message)
    (trail, goal, *lines) = memory.story()
    assert goal == {"goal": None}
    assert len(trail["trail"]["path"]) > 20
    assert len(trail["trail"]["echoes"]) > 50
    kinds = [kind_of(line) for line in lines]
    assert set(kinds) == {"event", "state", "readings", "evidence"}
    assert kinds.count("state") == 1
    last = [line for line in recorded() if line.get("event") == "STATUS"][-1]
    assert last in lines


@pytest.mark.parametrize("cdeg", [0, 9000, -4500, 18000])
@pytest.mark.parametrize("sonar", [0, 3, 9, 15])
def test_an_echo_lies_where_its_sonar_points(sonar: int, cdeg: int) -> None:
    memory = Memory()
    memory.take(state(1.0, 1000, -500, cdeg))
    ((x, y, trusted),) = echoes_of(memory.take(readings({sonar: 2000})))
    mount = robot_of("p3dx-sh").mounts[sonar]
    turn = math.radians(cdeg / 100)
    face_x = 1000 + mount.x_mm * math.cos(turn) - mount.y_mm * math.sin(turn)
    face_y = -500 + mount.x_mm * math.sin(turn) + mount.y_mm * math.cos(turn)
    assert math.dist((face_x, face_y), (x, y)) == pytest.approx(2000, abs=2)
    seen = math.degrees(math.atan2(y - face_y, x - face_x)) - cdeg / 100 - mount.heading_deg
    assert (seen + 540) % 360 - 180 == pytest.approx(0, abs=0.1)
    assert trusted == 1


def test_only_fresh_echoes_of_a_robot_that_moved_are_drawn() -> None:
    memory = Memory()
    assert echoes_of(memory.take(readings({3: 2000}))) == [], "nobody knows yet where the robot is"
    memory.take(state(1.0))
    assert echoes_of(memory.take(readings({3: 5000}))) == [], "no echo"
    assert echoes_of(memory.take(readings({3: 2000}, age_ms=400))) == [], "an old one"
    assert len(echoes_of(memory.take(readings({3: 2000})))) == 1
    assert echoes_of(memory.take(readings({3: 2000}))) == [], "the same from the same place"
    memory.take(state(2.0, x=60))
    assert len(echoes_of(memory.take(readings({3: 2000})))) == 1


def test_echoes_of_a_sonar_with_a_fault_are_marked() -> None:
    memory = Memory()
    memory.take(state(1.0, kind=["off" if k == 3 else "" for k in range(16)]))
    assert [echo[2] for echo in echoes_of(memory.take(readings({2: 900, 3: 900})))] == [1, 0]


def test_memory_is_bounded() -> None:
    memory = Memory()
    for k in range(5000):
        memory.take(state(k, x=k * 40))
        memory.take(readings(dict.fromkeys(range(16), 1000)))
        memory.take({"event": "OBJECT", "t": k, "name": "object"})
    assert len(memory.path) == PATH_KEPT
    assert len(memory.echoes) == ECHOES_KEPT
    assert len(memory.events) == EVENTS_KEPT


def test_an_argusd_that_began_anew_is_told_and_the_old_forgotten() -> None:
    memory = Memory()
    memory.take(state(100.0, x=900))
    assert {"anew": True} in memory.take(state(1.0))
    assert list(memory.path) == [(0, 0)]


def test_another_robot_is_told() -> None:
    memory = Memory()
    assert {"robot": None} not in memory.take(state(1.0))
    assert {"robot": None} in memory.take(state(2.0, subclass="amigo-sh"))
    assert len(robot_message(memory.table)["sonars"]) == 8
    memory.take(state(3.0, subclass="nobody-knows-it"))
    assert len(robot_message(memory.table)["sonars"]) == 16


def test_walls_are_seen_from_where_the_robot_started() -> None:
    world = load_world("office")
    x1, y1, x2, y2 = world.segments[0]
    assert walls_of(world, Pose(0, 0, 0))[0] == [round(x1), round(y1), round(x2), round(y2)]
    turned = walls_of(world, Pose(x1, y1, 90))[0]
    assert turned[:2] == [0, 0]
    assert turned[2:] == [round(y2 - y1), round(-(x2 - x1))]


def test_a_slow_page_gets_the_newest_state_and_every_event_it_has_room_for() -> None:
    async def run() -> list[Message]:
        box = Outbox()
        for k in range(2000):
            box.put(state(k))
            box.put(readings({3: k}))
            box.put({"event": "OBJECT", "t": k})
        return await box.take()

    lines = asyncio.run(run())
    assert [line["t"] for line in lines if line.get("event") == "STATUS"] == [1999]
    assert [line["readings"]["mm"][3] for line in lines if "readings" in line] == [1999]
    events = [line["t"] for line in lines if line.get("event") == "OBJECT"]
    assert events == list(range(len(events)))
    assert len(events) >= 100
    assert lines[-1] == {"lost": "lines", "count": 2000 - len(events)}


@pytest.mark.parametrize(
    ("t", "unix", "anew"),
    [
        (300.0, 1300.0, False),
        (300.0, 1300.4, False),
        (300.0, 5300.0, True),
        (3.0, 1300.0, True),
        (9.0, 900.0, True),
    ],
)
def test_another_run_of_argusd_is_known_by_its_beginning(t: float, unix: float, anew: bool) -> None:
    # It may have run for longer than the one before, when the page was away for so long.
    memory = Memory()
    memory.take(state(200.0, unix=1200.0))
    memory.reconnected()
    assert ({"anew": True} in memory.take(state(t, unix=unix))) is anew
    assert {"anew": True} not in memory.take(
        state(t + 1, unix=unix + 3600)
    )  # a clock that is set is no new run


def test_an_event_carries_its_value_in_words() -> None:
    memory = Memory()
    for name, value, shown in (
        ("STOPPED", -9298, " -92.98 deg"),
        ("SONAR_SILENT", 2**31 - 1, " (never)"),
        ("X", 1, ""),
    ):
        event: Message = {"event": name, "t": 1.0, "name": "drive", "value": value}
        memory.take(event)
        assert (event["shown"], memory.events[-1]["shown"]) == (shown, shown)
    bare: Message = {"event": "STOPPED", "t": 1.0, "name": "drive"}
    memory.take(bare)
    assert bare["shown"] == ""
