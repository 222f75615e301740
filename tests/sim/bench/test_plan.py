# SPDX-License-Identifier: MIT
"""Rule: an id is the whole of a mission: the same in every process, and no mission of one split occurs in the other."""

from __future__ import annotations

from pathlib import Path

import pytest
from bench.processes import outputs

from hil_sim.bench import plan
from hil_sim.bench.plan import Case, faults_of, make_cases, mission_of, parse_id, world_of
from hil_sim.errors import SimError
from hil_sim.faults.grammar import parse_fault
from hil_sim.faults.kinds import SonarFault

IDS = (
    "argus/tune/office/7/wrong-scale0.5",
    "paper/judge/lab/3/pair",
    "argus/judge/gen-room/2/free-people",
    "argus:step_mm=100/tune/gen-hall/5/slow-8~crosstalk=0.05",
)


def test_an_id_is_the_case_it_names() -> None:
    for case in make_cases(
        ["argus", "paper"], "judge", ["office"], range(1, 4), plan.KINDS, sensitivity=True
    ):
        assert parse_id(case.id) == case


def test_an_id_gives_the_same_mission_in_any_process() -> None:
    program = (
        "import sys; from hil_sim.bench.plan import mission_of, parse_id, world_of\n"
        "for name in sys.argv[1:]:\n"
        "    case = parse_id(name); mission = mission_of(case)\n"
        "    world = world_of(case.world, case.split, case.seed)[0]\n"
        "    print(mission.course, mission.faults, mission.seed, mission.movers, dict(mission.config), world.start)\n"
    )
    runs = outputs(program, IDS)
    assert len(runs) == 1
    lines = runs.pop().splitlines()
    for name, line in zip(IDS, lines, strict=True):
        mission = mission_of(parse_id(name))
        assert str(mission.faults) in line
        assert str(mission.seed) in line


@pytest.mark.soak
def test_the_splits_share_nothing_that_is_drawn() -> None:
    drawn: dict[str, set[object]] = {}
    for split in plan.SPLITS:
        cases = [Case("argus", split, "lab", seed, "wrong-offset+300") for seed in range(1, 16)]
        missions = [mission_of(case) for case in cases]
        drawn[split] = {value for m in missions for value in (m.seed, m.course, m.faults)} | {
            Path(world_of("gen-room", split, seed)[2]).read_text(encoding="utf-8") for seed in range(1, 4)
        }
        assert len(drawn[split]) == 3 * 15 + 3
    assert not drawn["tune"] & drawn["judge"]


def test_profiles_and_sweeps_meet_the_same_mission() -> None:
    one = mission_of(parse_id("argus/tune/lab/4/garbage"))
    for other in ("paper/tune/lab/4/garbage", "argus:step_mm=100/tune/lab/4/garbage~noise_mm=20"):
        again = mission_of(parse_id(other))
        assert (again.course, again.faults, again.seed) == (one.course, one.faults, one.seed)


def test_every_severity_is_in_the_range_that_was_asked_for() -> None:
    for variant, (kind, _) in plan.SINGLE.items():
        for seed in range(1, 6):
            (text,) = faults_of(Case("argus", "tune", "lab", seed, variant))
            fault = parse_fault(text)
            assert isinstance(fault, SonarFault)
            assert fault.kind == kind
            values = dict(part.partition("=")[::2] for part in text.split(":")[3:])
            assert abs(float(values.get("scale", 0.5)) - 1) >= 0.2 - 1e-9
            assert abs(float(values.get("offset", 300))) >= 300
            assert abs(float(values.get("angle", 15))) >= 15
            assert float(values.get("p", 0.2)) >= 0.2


def test_a_pair_hits_two_sonars_and_free_none() -> None:
    for seed in range(1, 40):
        sonars = [
            text.split("@")[0].split(":")[1] for text in faults_of(Case("argus", "tune", "lab", seed, "pair"))
        ]
        assert len(set(sonars)) == 2
    assert faults_of(Case("argus", "tune", "lab", 1, "free")) == ()


def test_seeds_take_the_severities_in_turn_and_every_takes_all() -> None:
    worlds = ["office"]
    turn = {case.variant for case in make_cases(["argus"], "tune", worlds, range(1, 13), ["wrong"])}
    every = [case.variant for case in make_cases(["argus"], "tune", worlds, [1], ["wrong"], every=True)]
    assert turn == set(every) == set(plan.VARIANTS["wrong"])


@pytest.mark.parametrize(
    "name",
    [
        "",
        "argus/tune/office/7",
        "argus/dev/office/7/off",
        "argus/tune/office/x/off",
        "argus/tune/office/7/broken",
        "argus/tune/office/7/off~noise_mm=loud",
        "argus/tune/office/7/off~speed=1",
        "nobody/tune/office/7/off",
        "argus:speed=fast/tune/office/7/off",
    ],
)
def test_what_is_no_id_is_refused(name: str) -> None:
    with pytest.raises(SimError):
        parse_id(name)


def test_worlds_are_found_by_pattern(tmp_path: Path) -> None:
    (tmp_path / "a.map").write_text("", encoding="utf-8")
    assert plan.find_worlds(["office,gen-r*"]) == ["office", "gen-room"]
    assert plan.find_worlds([f"{tmp_path}/*.map"]) == [f"{tmp_path}/a.map"]
    with pytest.raises(SimError, match="matches nothing"):
        plan.find_worlds([f"{tmp_path}/*.yaml"])
