# SPDX-License-Identifier: MIT
"""Rule: an order breaks or mends the sonars it names, at once and no others, and any line gets one answer."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil_sim.cli.main import main
from hil_sim.faults.execute import FaultSet
from hil_sim.faults.grammar import parse_fault
from hil_sim.faults.kinds import SonarFault
from hil_sim.links.orders import Orders
from hil_sim.scenario.build import build_robot
from hil_sim.scenario.scenario import Scenario
from hil_sim.world.files import load_world
from hil_sim.world.model import Pose

ROOT = Path(__file__).resolve().parents[2]
HOME = Pose(0, 0, 0)
KINDS = ("off", "silent", "stuck", "wrong:{}:offset=-300", "garbage", "slow", "intermittent")


def no_angle(angle_deg: float) -> int:
    raise AssertionError("nobody asked for another axis")


def fault(text: str) -> SonarFault:
    found = parse_fault(text)
    assert isinstance(found, SonarFault)
    return found


class Desk:
    """An emulator's robot with its orders, and both ends of the pipes."""

    def __init__(self) -> None:
        world = load_world("hall")
        self.robot = build_robot(Scenario(), world, world.start, None, faults_to_come=True)
        source, self.to_orders = os.pipe()
        self.from_orders, answers = os.pipe()
        assert isinstance(self.robot.faults, FaultSet)
        self.faults = self.robot.faults
        self.orders = Orders(self.robot, self.faults, source, answers)
        self.open = [source, self.to_orders, self.from_orders, answers]

    def give(self, data: bytes) -> list[dict[str, Any]]:
        os.write(self.to_orders, data)
        self.orders.obey()
        self.robot.step()
        os.set_blocking(self.from_orders, False)
        try:
            told = os.read(self.from_orders, 1 << 20)
        except BlockingIOError:
            return []
        return [json.loads(line) for line in told.splitlines()]

    def close(self) -> None:
        for descriptor in self.open:
            os.close(descriptor)


@pytest.fixture
def desk() -> Iterator[Desk]:
    made = Desk()
    yield made
    made.close()


@pytest.mark.parametrize("kind", KINDS)
def test_a_sonar_is_broken_and_mended_while_others_stay(desk: Desk, kind: str) -> None:
    target, _, rest = kind.partition(":{}")
    (answer,) = desk.give(f"break {target}:3{rest}\n".encode())
    assert answer["ok"] is True
    assert answer["broken"] == {"3": target}
    assert desk.faults.apply(3, 0.0, 1234, no_angle)[1] == target
    assert desk.faults.apply(4, 0.0, 1234, no_angle) == (1234, None)
    (answer,) = desk.give(b"mend 3\n")
    assert answer["broken"] == {}
    assert desk.faults.apply(3, 0.0, 1234, no_angle) == (1234, None)


def test_the_last_order_wins_and_mend_takes_all_that_lie_below() -> None:
    made = FaultSet([parse_fault("off:3+6"), parse_fault("stuck:3@9s")], np.random.default_rng(1))
    made.update(0.0, HOME, 0.0)
    made.inject(fault("stuck:3:value=400"))
    made.update(10.0, HOME, 0.0)
    assert made.apply(3, 0.0, 1234, no_angle) == (400, "stuck")
    assert made.mend(3)
    assert made.apply(3, 0.0, 1234, no_angle) == (1234, None)
    assert made.apply(6, 0.0, 1234, no_angle) == (5000, "off"), "another sonar of the same fault keeps it"
    made.update(10_000.0, HOME, 0.0)
    assert made.apply(3, 0.0, 1234, no_angle) == (1234, None), "a fault to come was mended too"
    assert not made.mend(3)


def test_truth_tells_the_onset_and_the_end_of_each_once() -> None:
    made = FaultSet()
    made.inject(fault("off:3+6"))
    told = [(c.sonar, c.on) for c in made.update(10.0, HOME, 0.0)]
    made.mend(3)
    told += [(c.sonar, c.on) for c in made.update(20.0, HOME, 0.0)]
    made.mend(6)
    told += [(c.sonar, c.on) for c in made.update(30.0, HOME, 0.0)]
    told += [(c.sonar, c.on) for c in made.update(40.0, HOME, 0.0)]
    assert told == [(3, True), (6, True), (3, False), (6, False)]


def test_slow_begins_with_what_it_has_heard() -> None:
    made = FaultSet()
    made.inject(fault("slow:3:n=2"))
    made.update(0.0, HOME, 0.0)
    assert [made.apply(3, 0.0, value, no_angle)[0] for value in (1, 2, 3, 4)] == [1, 1, 1, 2]


@pytest.mark.parametrize(
    ("line", "says"),
    [
        (b"", "is no order"),
        (b"break", "is no order"),
        (b"break off:16", "is no sonar"),
        (b"break nonsense:3", "has no kind 'nonsense'"),
        (b"break link-cut@1s", "sonars only"),
        (b"break bumper:3@1s", "sonars only"),
        (b"mend 16", "no sonar 16"),
        (b"mend -1", "is no order"),
        (b"break off:3 mend 3", "is no order"),
        (b"\xff\xfe\x00", "is no order"),
        (b"x" * 1025, "at most 1024 bytes"),
    ],
)
def test_a_bad_line_is_refused_in_one_answer_and_changes_nothing(desk: Desk, line: bytes, says: str) -> None:
    (answer,) = desk.give(line + b"\n")
    assert answer["ok"] is False
    assert says in answer["say"]
    assert answer["broken"] == {}


def test_lines_come_in_pieces_and_a_line_without_end_is_bounded(desk: Desk) -> None:
    assert desk.give(b"brea") == []
    first, second = desk.give(b"k off:1\nmend 1\n")
    assert (first["broken"], second["broken"]) == ({"1": "off"}, {})
    assert any(not answer["ok"] for answer in desk.give(b"y" * 4000))
    assert desk.give(b"\nmend all\n")[-1]["ok"] is True


def test_a_reader_that_takes_no_answers_does_not_stop_the_robot(desk: Desk) -> None:
    for _ in range(1500):
        os.write(desk.to_orders, b"break off:1\n")
        desk.orders.obey()
    assert desk.faults.active(1) is not None


def test_who_watches_is_told_of_faults_that_begin_and_end_by_themselves(desk: Desk) -> None:
    desk.faults.inject(fault("stuck:2"))
    desk.faults.inject(fault("off:3@0.1s-0.2s"))
    assert desk.give(b"") == [], "nobody watches yet"
    (answer,) = desk.give(b"watch\n")
    assert (answer["ok"], answer["broken"]) == (True, {"2": "stuck"}), "what is broken from the start"
    told = []
    while desk.robot.now_ms < 300:
        told += desk.give(b"")
    assert [line["broken"] for line in told] == [{"2": "stuck", "3": "off"}, {"2": "stuck"}]
    assert all("order" not in line for line in told), "they are no answers"
    assert 0.1 <= told[0]["t_s"] < 0.15 < told[1]["t_s"] < 0.25
    assert len(desk.give(b"mend all\n")) == 1, "what an answer has told is not told again"
    assert desk.give(b"") == []


@settings(max_examples=25, deadline=None)
@given(st.binary(max_size=200))
def test_any_bytes_get_an_answer_a_line(data: bytes) -> None:
    desk = Desk()
    try:
        assert len(desk.give(data + b"\n")) == data.count(b"\n") + 1
    finally:
        desk.close()


def test_the_program_obeys_and_ends_with_its_input(tmp_path: Path) -> None:
    """The first line is the address, then an answer for each order; end of input ends the emulator."""
    truth = tmp_path / "truth.jsonl"
    command = [sys.executable, "-m", "hil_sim.cli", "--orders", "--tcp", "0", "--truth", str(truth)]
    done = subprocess.run(
        command, input=b"break off:3\nmend all\n", capture_output=True, cwd=ROOT, timeout=120, check=True
    )
    address, *answers = done.stdout.decode().splitlines()
    assert address.startswith("127.0.0.1:")
    assert [json.loads(line)["broken"] for line in answers] == [{"3": "off"}, {}]


def test_orders_are_for_one_robot(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--orders", "--robots", "2"]) == 2
    assert "--orders are for one robot" in capsys.readouterr().err
