# SPDX-License-Identifier: MIT
"""Rule: a scenario file gives the run it describes, and comes back from what it saves; or one line `file:line: ...` and
exit 2; and every example in the documents is true."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil_sim.cli.main import main
from hil_sim.errors import SimError
from hil_sim.faults.grammar import fault_help, parse_fault
from hil_sim.faults.kinds import LINK_KINDS, SONAR_KINDS, WHEEL_KINDS, LinkFault
from hil_sim.scenario.scenario import _SONAR_LIMITS, SEED_MAX, Scenario, load_scenario, scenario_names
from hil_sim.sonar.params import SonarParams
from hil_sim.tables import robots
from hil_sim.tables.robot import robot_table
from hil_sim.world.body import BodyModel
from hil_sim.world.files import load_world, load_yaml, world_names
from hil_sim.world.model import Pose
from hil_sim.world.physics import LIMITS, Physics

DOCS = Path(__file__).resolve().parents[2] / "docs"


def write(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


ALL = """\
about: all of it
world: demo
seed: 42
start: [100, -50, 30]
course: [[1700, 0], [1700, 1550]]
sonar:
  noise_mm: 7
  noise_part: 0.01
  crosstalk: 0.02
  specular: false
  cone_deg: 25
  edge_db: 10
  margin_db: 35
  air_db_m: 3
  mirror_db_deg2: 0.1
  corner_db: 4
  tip_db: 12
faults:
  - off:3@12s
  - link-drop@1s-2s:p=0.5
  - bumper:2@3s
bumpers: 0
"""


def test_every_key_ends_where_it_belongs_and_comes_back_when_saved(tmp_path: Path) -> None:
    scenario = load_scenario(write(tmp_path / "all.yaml", ALL))
    assert scenario == Scenario(
        world="demo",
        seed=42,
        start=Pose(100, -50, 30),
        course=((1700, 0), (1700, 1550)),
        sonar=SonarParams(7, 0.01, 0.02, False, 25, 10, 35, 3, 0.1, 4, 12),
        faults=tuple(parse_fault(t) for t in ("off:3@12s", "link-drop@1s-2s:p=0.5", "bumper:2@3s")),
        bumpers=0,
        about="all of it",
    )
    assert [str(fault) for fault in scenario.link_faults] == ["link-drop@1s-2s:p=0.5"]
    scenario.save(tmp_path / "again.yaml")
    assert load_scenario(tmp_path / "again.yaml") == scenario


def test_a_goal_instead_of_a_course_and_defaults_for_the_rest(tmp_path: Path) -> None:
    scenario = load_scenario(write(tmp_path / "g.yaml", "goal: [1, -2.5]\n"))
    assert scenario == Scenario(goal=(1, -2.5))
    assert (scenario.world, scenario.seed, scenario.start, scenario.bumpers) == ("lab", 1, None, None)
    scenario.save(tmp_path / "again.yaml")
    assert load_scenario(tmp_path / "again.yaml") == scenario


def test_every_sonar_parameter_has_a_key_and_only_those() -> None:
    assert {*_SONAR_LIMITS, "specular"} == {f.name for f in dataclasses.fields(SonarParams)}
    for name, (low, high) in _SONAR_LIMITS.items():
        assert low <= getattr(SonarParams(), name) <= high


def test_a_world_is_looked_for_beside_the_scenario(tmp_path: Path) -> None:
    write(tmp_path / "mine.yaml", "about: mine\n")
    scenario = load_scenario(write(tmp_path / "s.yaml", "world: mine.yaml\n"))
    assert load_world(scenario.world).about == "mine"
    assert load_scenario(write(tmp_path / "t.yaml", "world: other.yaml\n")).world == "other.yaml"


BAD = {
    "unknown key": ("world: lab\nsede: 1\n", "2: unknown key 'sede'"),
    "world": ("world: 5\n", "1: expected text"),
    "seed": ("seed: -1\n", "1: expected a whole number"),
    "large seed": (f"seed: {SEED_MAX + 1}\n", "1: expected a whole number"),
    "text seed": ("seed: one\n", "1: expected a whole number from 0 to 9223372036854775807, not 'one'"),
    "start": ("start: [1, 2]\n", "1: expected a list of 3 numbers"),
    "NaN start": ("start: [1, 2, .nan]\n", "1: expected a number"),
    "course": ("course: 5\n", "1: expected a list"),
    "empty course": ("course: []\n", "1: a course needs one point"),
    "course point": ("course:\n  - [1, 2]\n  - [1]\n", "3: expected a list of 2 numbers"),
    "both": ("course: [[1, 2]]\ngoal: [1, 2]\n", "2: give a course or a goal, not both"),
    "sonar": ("sonar: loud\n", "1: expected a mapping"),
    "sonar key": ("sonar:\n  noise: 1\n", "2: unknown key 'noise'"),
    "crosstalk": ("sonar: {crosstalk: 1.5}\n", "1: 1.5 is outside 0 to 1"),
    "specular": ("sonar: {specular: 1}\n", "1: expected true or false"),
    "cone": ("sonar: {cone_deg: 0}\n", "1: 0 is outside 1 to 90"),
    "fault": ("faults:\n  - off:3\n  - of:3\n", "3: fault 'of:3': KIND:TARGET@FROM has no kind 'of'; did"),
    "fault's value": ("faults: ['wrong:3:scale=x']\n", "1: fault 'wrong:3:scale=x': scale must be"),
    "fault no text": ("faults: [5]\n", "1: expected text"),
    "faults no list": ("faults: off:3\n", "1: expected a list"),
    "bumpers": ("bumpers: 3\n", "1: bumpers is 0 or 5, not '3'"),
    "bumpers flag": ("bumpers: false\n", "1: bumpers is 0 or 5"),
    "bumpers list": ("bumpers: [5]\n", "1: bumpers is 0 or 5"),
    "YAML": ("seed: 1\n  x: [\n", "2: not valid YAML"),
    "empty": ("", "1: the file is empty"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_scenario_is_one_line_with_its_place(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    text, expected = BAD[name]
    path = write(tmp_path / "bad.yaml", text)
    assert main(["--scenario", str(path), "--duration", "1"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert len(err.splitlines()) == 1, err
    assert err.startswith(f"argus-sim: {path}:{expected}"), err


@pytest.mark.parametrize(
    "world", ["mars", "a\\nb", "x" * 300 + ".yaml", "\\0.yaml", "\\ud800.map", "/no/where.map"]
)
def test_a_world_that_cannot_be_loaded_is_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], world: str
) -> None:
    path = write(tmp_path / "s.yaml", f'world: "{world}"\n')
    assert main(["--scenario", str(path), "--duration", "1"]) == 2
    err = capsys.readouterr().err
    assert len(err.splitlines()) == 1, err
    assert err.startswith("argus-sim: ")


@pytest.mark.parametrize("name", ["nowhere", "nowhere.yaml", "y" * 300, "nul\0"])
def test_a_scenario_that_is_not_there_is_one_line(name: str) -> None:
    with pytest.raises(
        SimError, match=r"cannot be read|no file can have this name|no scenario .*; name one of bad-day, "
    ) as caught:
        load_scenario(name)
    assert str(caught.value).isprintable()


def test_a_scenario_that_cannot_be_written_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(SimError, match="cannot write the scenario"):
        Scenario().save(tmp_path / "no" / "dir.yaml")


numbers = st.floats(-1e6, 1e6, allow_nan=False)
points = st.tuples(numbers, numbers)
# Of sonars that the smallest robot has, too.
texts = ["off:3", "wrong:6@travelled>1400:scale=0.5", "bumper:1@2s", "link-delay:ms=10", "slow:rear@x<-1:n=7"]


@settings(max_examples=200, deadline=None)
@given(
    seed=st.integers(0, SEED_MAX),
    start=st.none() | st.builds(Pose, numbers, numbers, numbers),
    way=st.tuples(st.lists(points, max_size=4).map(tuple), st.none()) | st.tuples(st.just(()), points),
    crosstalk=st.floats(0, 1),
    specular=st.booleans(),
    faults=st.lists(st.sampled_from(texts), max_size=4),
    bumpers=st.sampled_from([None, 0, 5]),
    robot=st.sampled_from(robots()),
    physics=st.none() | st.builds(Physics, **{name: st.floats(*LIMITS[name]) for name in LIMITS}),
    about=st.text(max_size=20),
    world=st.sampled_from(world_names()),
)
def test_any_scenario_comes_back_from_its_text(
    tmp_path_factory: pytest.TempPathFactory,
    way: tuple[Any, Any],
    crosstalk: float,
    specular: bool,
    faults: list[str],
    robot: str,
    **rest: object,
) -> None:
    scenario = Scenario(
        course=way[0],
        goal=way[1],
        sonar=SonarParams(crosstalk=crosstalk, specular=specular),
        faults=tuple(parse_fault(text, robot_table(robot)) for text in faults),
        robot=robot,
        **rest,  # type: ignore[arg-type]
    )
    path = tmp_path_factory.getbasetemp() / "any-scenario.yaml"
    scenario.save(path)
    assert load_scenario(path) == scenario


# ---- what comes with it, and what the documents say -------------------------------------------------------------


@pytest.mark.parametrize("name", scenario_names())
def test_a_shipped_scenario_loads_with_room_at_its_start_and_points(name: str) -> None:
    scenario = load_scenario(name)
    world = load_world(scenario.world)
    assert scenario.about
    assert load_scenario(name) == scenario
    start = scenario.start or world.start
    body = BodyModel(world)
    assert body.contact(start, 0.0) is None
    places = [(start.x_mm, start.y_mm), *scenario.course, *([scenario.goal] if scenario.goal else [])]
    assert len(places) > 1
    for x, y in places:
        for heading in range(0, 360, 10):
            assert body.clearance_mm(Pose(x, y, heading)) >= 250, f"{x}, {y} at {heading} degrees"


def test_the_bad_day_has_every_kind_of_fault() -> None:
    kinds = set()
    for fault in load_scenario("bad-day").faults:
        kinds.add(str(fault).split(":")[0].split("@")[0])
    assert kinds == {*SONAR_KINDS, *LINK_KINDS, "bumper"}


def blocks(name: str, language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", (DOCS / name).read_text(encoding="utf-8"), re.DOTALL)


def test_the_examples_in_the_scenario_document_are_true(tmp_path: Path) -> None:
    scenarios = blocks("scenarios.md", "yaml")
    assert scenarios
    for k, text in enumerate(scenarios):
        load_world(load_scenario(write(tmp_path / f"{k}.yaml", text)).world)
    faults = "\n".join(blocks("scenarios.md", "faults")).splitlines()
    assert len(faults) > 15
    parsed = [parse_fault(line.split("#")[0].strip()) for line in faults]
    assert any(isinstance(fault, LinkFault) for fault in parsed)
    used = {line.split(":")[0].split("@")[0].split("#")[0].strip() for line in faults}
    assert used == {*SONAR_KINDS, *WHEEL_KINDS, *LINK_KINDS, "bumper"}


def test_the_scenario_document_names_every_key_kind_and_parameter(tmp_path: Path) -> None:
    text = (DOCS / "scenarios.md").read_text(encoding="utf-8")
    for field in dataclasses.fields(Scenario):
        assert f"| `{field.name}` |" in text
    for kind in (*SONAR_KINDS, *LINK_KINDS, "bumper"):
        assert f"| `{kind}` |" in text
    for name in re.findall(r"[:=]?([a-z]+)=", fault_help()):
        assert f"`{name}=" in text, name
    for name in scenario_names():
        assert f"`{name}`" in text


def test_the_world_document_has_every_world_parameter_and_a_true_example(tmp_path: Path) -> None:
    text = (DOCS / "worlds.md").read_text(encoding="utf-8")
    examples = blocks("worlds.md", "yaml")
    assert examples
    for k, example in enumerate(examples):
        load_yaml(write(tmp_path / f"{k}.yaml", example))
    maps = blocks("worlds.md", "map")
    assert maps
    for k, example in enumerate(maps):
        world = load_world(str(write(tmp_path / f"{k}.map", example)))
        assert world.goals
        assert len(world.segments)
    for name in world_names():
        assert f"| `{name}` |" in text
    for field in dataclasses.fields(SonarParams):
        default = str(field.default).lower() if isinstance(field.default, bool) else f"{field.default:g}"
        assert re.search(rf"\| `{field.name}` \| {re.escape(default)} \|", text), field.name
