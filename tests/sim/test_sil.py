# SPDX-License-Identifier: MIT
"""Rule: a mission under virtual time is the run that the programs make of it: the bytes of the real server, paced as by
the real wire, the same for the same seed in any process; and its outcome tells what truly happened."""

from __future__ import annotations

import dataclasses
import itertools
import math
import os
import pickle
import re
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

from hil_sim.errors import SimError
from hil_sim.faults.grammar import parse_fault
from hil_sim.links.base import Link
from hil_sim.links.loop import Loop
from hil_sim.links.wire import Wire
from hil_sim.scenario.build import build_robot
from hil_sim.scenario.scenario import Scenario
from hil_sim.server.server import ArcosServer
from hil_sim.sil import Frozen, Mission, Outcome, Packet, Sighting, Sil, run
from hil_sim.sonar.params import SonarParams
from hil_sim.world.files import load_world
from hil_sim.world.movers import Door, Person

FAULTS = ("off:3@travelled>600", "wrong:6@9s:scale=0.5", "silent:12@2s-4s", "slow:1@3s:n=2")
MOVERS = (Person(((-1000.0, -900.0), (1700.0, -900.0))), Door((2000.0, 800.0), width=500, period=6))
PAPER = {"profile": "paper"}
TOUR = Mission("demo", ((1700, 0), (1700, 1550)), faults=FAULTS, movers=MOVERS, config=PAPER, limit_s=25)
STAND = Mission("demo", (), config={"active": "off"}, limit_s=5)


def traffic(mission: Mission) -> tuple[list[Packet], Outcome]:
    sil = Sil(mission)
    sil.traffic = []
    outcome = sil.run()
    return sil.traffic, outcome


# ---- the same run -----------------------------------------------------------------------------------------------


def test_the_same_mission_gives_the_same_bytes_in_any_process() -> None:
    first, again = run(TOUR), run(TOUR)
    assert first.digest == again.digest
    assert first == again
    program = "import sys; from hil_sim.sil import *; print(run(Mission.from_json(sys.argv[1])).digest)"
    for hash_seed in ("1", "2"):
        done = subprocess.run(
            [sys.executable, "-c", program, TOUR.to_json()],
            env={"PYTHONHASHSEED": hash_seed, "PATH": "/usr/bin:/bin"},
            capture_output=True,
            text=True,
            check=True,
        )
        assert done.stdout.strip() == first.digest


@pytest.mark.parametrize("change", [{"seed": 2}, {"baud": 19200}, {"faults": FAULTS[1:]}, {"movers": ()}])
def test_another_mission_gives_other_bytes(change: dict[str, Any]) -> None:
    values = {**vars(TOUR), **change}
    assert run(Mission(**values)).digest != run(TOUR).digest


def test_missions_do_not_touch_each_other() -> None:
    one, two = Sil(TOUR), Sil(Mission(**{**vars(TOUR), "seed": 7}))
    while not (one.over and two.over):
        one.step()
        two.step()
    assert one.outcome().digest == run(TOUR).digest
    assert two.outcome().digest != one.outcome().digest


def test_a_mission_survives_json_and_pickle_and_can_be_a_key() -> None:
    mission = Mission(
        "lab",
        ((1, 2), (3.5, -4)),
        (1, 2, 3),
        FAULTS,
        7,
        {"speed_mm_s": 150, **PAPER},
        {"crosstalk": 0.0, "specular": False},
        MOVERS,
        10.0,
        b"\x00\xff",
        38400,
        False,
    )
    for copy in (Mission.from_json(mission.to_json()), pickle.loads(pickle.dumps(mission))):
        assert copy == mission
        assert hash(copy) == hash(mission)
    assert Frozen({"a": 1, "b": 2}) == {"b": 2, "a": 1}
    assert hash(Frozen({"a": 1, "b": 2})) == hash(Frozen({"b": 2, "a": 1}))


# ---- the bytes of the real server ---------------------------------------------------------------------------------


class Replayed(Link):
    """A client that sends given bytes at given times, and keeps what it gets."""

    address = "replay"

    def __init__(self, sent: Iterable[Packet]) -> None:
        self.sent = list(sent)
        self.got: list[tuple[float, bytes]] = []

    def open(self) -> None: ...

    def receive(self, now_ms: float) -> list[bytes]:
        due = [packet.data for packet in self.sent if packet.t_ms <= now_ms]
        self.sent = self.sent[len(due) :]
        return due

    def send(self, packet: bytes, now_ms: float) -> None:
        self.got.append((now_ms, packet))

    def transmit(self, now_ms: float) -> None: ...

    def readers(self) -> list[Any]:
        return []

    def close(self) -> None: ...


def served(mission: Mission, sent: list[Packet]) -> list[tuple[float, bytes]]:
    """What the loop of argus-sim answers to these bytes, in steps of a millisecond."""
    world = load_world(mission.world)
    scenario = Scenario(
        mission.world,
        mission.seed,
        faults=tuple(parse_fault(text) for text in mission.faults),
        sonar=SonarParams(**dict(mission.sonar)),  # type: ignore[arg-type]
        people=tuple(mover for mover in mission.movers if isinstance(mover, Person)),
        doors=tuple(mover for mover in mission.movers if isinstance(mover, Door)),
    )
    link = Replayed(sent)
    now = [0.0]
    server = ArcosServer(build_robot(scenario, world, world.start, None), flash_baud=mission.baud)
    loop = Loop(server, link, clock_ms=lambda: now[0])
    times = {packet.t_ms for packet in sent} | {float(t) for t in range(int(mission.limit_s * 1000) + 1)}
    for now[0] in sorted(times):
        loop.turn()
    return link.got


@pytest.mark.parametrize("baud", [9600, 115200])
@pytest.mark.parametrize("world", ["demo", "office"])
def test_the_bytes_are_those_of_the_real_server_on_the_real_wire(world: str, baud: int) -> None:
    mission = Mission(**{**vars(TOUR), "world": world, "baud": baud, "limit_s": 14.0, "stop_at_goal": False})
    packets, _ = traffic(mission)
    down = [packet for packet in packets if not packet.to_robot]
    got = served(mission, [packet for packet in packets if packet.to_robot])
    assert len(down) > 130
    assert [data for _, data in got[: len(down)]] == [packet.data for packet in down]
    assert len(got) <= len(down) + 1, "all but what is still on the wire"
    wire = Wire(baud)
    waiting = list(got)
    for packet in down:
        while waiting and waiting[0][0] < packet.t_ms:
            sent_ms, data = waiting.pop(0)
            wire.push(data, sent_ms)
        before = b"".join(data for data, _ in wire.pop(packet.t_ms - 0.01))
        after = b"".join(data for data, _ in wire.pop(packet.t_ms + 0.01))
        assert len(after) == 1
        assert packet.data.endswith(before[-len(packet.data) :] + after)


# ---- what truly happened ------------------------------------------------------------------------------------------


def test_a_mission_ends_at_the_goal_or_at_the_limit() -> None:
    short = Mission("demo", ((800, 0),), config=PAPER, sonar={"crosstalk": 0.0}, limit_s=60)
    outcome = run(short)
    assert outcome.reached
    assert outcome.goal_mm <= 150
    assert outcome.t_s < 30
    assert 700 < outcome.driven_mm < 900
    assert 3 < outcome.driving_s < outcome.t_s
    assert outcome.events[-1].name == "GOAL_REACHED" or outcome.events[-2].name == "GOAL_REACHED"
    assert not outcome.collisions
    assert len(outcome.health) == len(outcome.final) == 16
    assert all(state == changes[-1][1:] for state, changes in zip(outcome.final, outcome.health, strict=True))
    on = run(Mission(**{**vars(short), "stop_at_goal": False, "limit_s": 35.0}))
    assert on.t_s == 35
    assert on.reached
    late = run(Mission(**{**vars(short), "limit_s": 4.0}))
    assert not late.reached
    assert late.t_s == 4


def test_the_truth_tells_when_a_fault_came_and_when_it_first_showed() -> None:
    outcome = run(TOUR)
    truth = {(t.kind, t.sonar): t for t in outcome.truth}
    assert {kind for kind, _ in truth} == {"off", "wrong", "silent", "slow"}
    off = truth["off", 3]
    assert off.text == FAULTS[0]
    assert 600 < off.onset_driven_mm < 603
    assert off.first_visible_s is not None
    assert off.first_visible_driven_mm is not None
    assert 0 <= off.first_visible_s - off.onset_s <= 0.4, "each sonar fires every 320 ms"
    silent = truth["silent", 12]
    assert (silent.onset_s, silent.end_s) == (2.0, 4.0)
    assert silent.first_visible_s is not None
    standing = run(Mission("demo", (), faults=("slow:4@1s",), config={"active": "off"}, limit_s=4))
    assert standing.truth[0].first_visible_s is None, "what does not change looks the same later"


def test_what_reads_5000_anyway_hides_a_dead_sonar() -> None:
    hall = Mission("hall", (), faults=("off:front@1s",), config={"active": "off"}, limit_s=4)
    assert [t.first_visible_s for t in run(hall).truth] == [None] * 8


def test_collisions_are_told_from_being_struck() -> None:
    sil = Sil(STAND)
    sil.run_until(1.0)
    sil.robot.enable(True)
    sil.robot.drive.vel(300)
    sil.run_until(20.0)
    hits = sil.outcome().collisions
    assert [hit.struck for hit in hits] == [False]
    assert math.hypot(hits[0].x - sil.robot.chassis.x, hits[0].y - sil.robot.chassis.y) < 5
    rude = Person(((0.0, -1500.0), (0.0, 1000.0)), yields=False)
    hits = run(Mission(**{**vars(STAND), "movers": (rude,)})).collisions
    assert [hit.struck for hit in hits] == [True]
    polite = Person(((0.0, -1500.0), (0.0, 1000.0)))
    assert not run(Mission(**{**vars(STAND), "movers": (polite,)})).collisions


def test_the_record_of_one_mission_is_history_in_the_next() -> None:
    record = run(TOUR).record
    assert record
    taken = run(Mission(**{**vars(STAND), "record": record}))
    assert not any(event.name == "RECORD_IGNORED" for event in taken.events)
    spoilt = bytes((record[0], record[1] ^ 1, *record[2:]))
    refused = run(Mission(**{**vars(STAND), "record": spoilt}))
    assert any(event.name == "RECORD_IGNORED" for event in refused.events)


def test_every_sip_is_traced_with_the_truth() -> None:
    seen: list[tuple[float, Sighting]] = []
    mission = Mission(**{**vars(STAND), "faults": ("off:3",), "sonar": {"crosstalk": 0.0}})
    sil = Sil(mission, trace=lambda sil, sighting: seen.append((sil.now_ms, sighting)))
    sil.run()
    gaps = {round(b.t_s - a.t_s, 6) for (_, a), (_, b) in itertools.pairwise(seen)}
    assert gaps == {0.1}
    assert all(0 < now_ms / 1000 - sighting.t_s < 0.15 for now_ms, sighting in seen)
    readings = [reading for _, sighting in seen for reading in sighting.readings]
    assert {reading.number for reading in readings} == set(range(16))
    for reading in readings:
        if reading.number == 3:
            assert (reading.range_mm, reading.fault) == (5000, "off")
        else:
            assert abs(reading.range_mm - reading.true_mm) < 80
        assert 100 <= reading.true_mm < 5000


def test_a_bad_line_is_bad_here_too() -> None:
    cut = run(Mission(**{**vars(STAND), "faults": ("link-cut@2s-4s",), "limit_s": 6.0}))
    names = [event.name for event in cut.events]
    assert "LINK_STALLED" in names
    assert "LINK_RESUMED" in names
    noisy = Mission(**{**vars(STAND), "faults": ("link-corrupt:p=0.2", "link-drop:p=0.05"), "limit_s": 12.0})
    sil = Sil(noisy)
    outcome = sil.run()
    assert sil.core.status()["bad_checksums"] > 3
    assert outcome.digest == run(noisy).digest


@pytest.mark.parametrize(
    ("change", "part"),
    [
        ({"world": "moon"}, "no world 'moon'; name one of"),
        ({"start": (99000.0, 0.0, 0.0), "world": "none.yaml"}, "cannot be read"),
        ({"start": (2500.0, 0.0, 0.0)}, "a solid of world demo is there"),
        ({"sonar": {"loudness": 1.0}}, "'loudness' is no parameter of the model"),
        ({"config": {"colour": 1}}, "colour: no such setting"),
        ({"config": {"speed_mm_s": 700}}, "driving would be unsafe"),
        ({"course": ((0.0, 0.0),) * 2000}, "does not fit the fault manager"),
        ({"faults": ("odd:3",)}, "KIND:TARGET@FROM has no kind 'odd'"),
        ({"movers": (Person(((0.0, 0.0), (500.0, 0.0))),)}, "a solid of world demo is there"),
    ],
)
def test_a_mission_that_cannot_be_is_one_line(change: dict[str, Any], part: str) -> None:
    with pytest.raises(SimError) as failed:
        Sil(Mission(**{**vars(STAND), **change}))
    assert part in str(failed.value)
    assert "\n" not in str(failed.value)


def test_the_fault_manager_is_seen_as_it_is() -> None:
    sil = Sil(TOUR)
    sil.run_until(12.0)
    status = sil.core.status()
    assert [changes[-1][1:] for changes in sil.health] == list(
        zip(status["health"], status["kind"], strict=True)
    )
    assert sil.mode == status["mode"]
    assert sil.state_of_mission == "running"
    assert status["goal_mm"] > 1000
    times = [t_s for changes in sil.health for t_s, *_ in changes]
    assert all(0 <= t_s <= 12 for t_s in times)
    assert {"UNKNOWN", "HEALTHY"} <= {name for changes in sil.health for _, name, _ in changes}


def test_a_world_file_that_is_written_anew_is_read_anew(tmp_path: Path) -> None:
    file = tmp_path / "w.yaml"
    seen = []
    for distance in (1000, 2000):
        file.write_text(f"walls: [{{points: [[{distance}, -900], [{distance}, 900]]}}]\n")
        os.utime(file, ns=(distance, distance))
        seen.append(Sil(Mission(str(file), ())).world.segments[0, 0])
    assert seen == [1000, 2000]


def test_the_document_has_every_field_and_a_true_example(capsys: pytest.CaptureFixture[str]) -> None:
    text = (Path(__file__).resolve().parents[2] / "docs" / "sil.md").read_text(encoding="utf-8")
    for kind in (Mission, Outcome):
        for field in dataclasses.fields(kind):
            assert f"`{field.name}`" in text or field.name == "mission", field.name
    code = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert code
    for example in code:
        exec(compile(example, "docs/sil.md", "exec"), {})
    assert "off 3 " in capsys.readouterr().out
