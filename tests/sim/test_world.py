# SPDX-License-Identifier: MIT
"""Rule: a world file gives exactly the solids, start and goals that it names, or one line `file:line: ...` and exit 2;
and the worlds that come with the emulator keep what they promise."""

from __future__ import annotations

import itertools
import math
import random
from collections import deque
from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from hil_sim.cli.main import main
from hil_sim.errors import SimError
from hil_sim.scenario.scenario import load_scenario
from hil_sim.sonar.echo import EchoModel
from hil_sim.tables import load
from hil_sim.tables.robot import robot_table
from hil_sim.world import aria_map, files
from hil_sim.world.aria_map import MAP_ROUGHNESS, load_map
from hil_sim.world.body import BodyModel
from hil_sim.world.files import load_world, load_yaml, world_names
from hil_sim.world.model import Pose, World

SWING_MM = load("robots/p3dx-sh")["body"]["swing_radius_mm"]
FRONT = range(8)
ROOM = "walls:\n  - {points: [[-2000, -2000], [2000, -2000], [2000, 2000], [-2000, 2000]], closed: true}\n"


def write(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


def assert_one_line(error: SimError, path: Path) -> None:
    assert str(error).startswith(f"{path}:")
    assert str(error).isprintable()


def refused(path: Path, capsys: pytest.CaptureFixture[str]) -> str:
    """Refuse through argus-sim; return the line after the path."""
    assert main(["--world", str(path), "--duration", "1"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    lines = err.splitlines()
    assert len(lines) == 1, err
    assert lines[0].startswith(f"argus-sim: {path}:"), err
    return lines[0].removeprefix(f"argus-sim: {path}:")


# ---- our own format ---------------------------------------------------------------------------------------------


def test_every_key_ends_where_it_belongs(tmp_path: Path) -> None:
    text = """\
about: all of it
start: [100, -200, 90]
goals: {one: [1, 2], two: [3, 4, 45]}
roughness: 0.25
walls:
  - {points: [[0, 1000], [500, 1000], [500, 1500]]}
  - {points: [[-900, 900], [-800, 900], [-800, 950]], closed: true, roughness: 0.75}
boxes:
  - {centre: [0, 2000], size: [200, 100], turn: 90, roughness: 1}
posts:
  - {centre: [3000, 0], diameter: 100}
"""
    world = load_yaml(write(tmp_path / "all.yaml", text))
    assert (world.name, world.about) == ("all", "all of it")
    assert world.start == Pose(100, -200, 90)
    assert world.goals == {"one": Pose(1, 2, 0), "two": Pose(3, 4, 45)}
    assert world.roughness.tolist() == [0.25] * 2 + [0.75] * 3 + [1.0] * 4 + [0.25] * 8
    assert world.segments[:2].tolist() == [[0, 1000, 500, 1000], [500, 1000, 500, 1500]]
    assert world.segments[4].tolist() == [-800, 950, -900, 900]
    box = world.segments[5:9]
    assert box[:, 0::2].min() == pytest.approx(-50)
    assert box[:, 0::2].max() == pytest.approx(50)
    assert (box[:, 1::2].min(), box[:, 1::2].max()) == (pytest.approx(1900), pytest.approx(2100))
    post = world.segments[9:]
    assert np.hypot(post[:, 0] - 3000, post[:, 1]) == pytest.approx([50.0] * 8)
    # Closed outlines: each segment begins where the one before ended.
    for ring in (world.segments[2:5], box, post):
        assert np.roll(ring[:, 2:], 1, axis=0) == pytest.approx(ring[:, :2])
    assert world.bounds == pytest.approx((-900, -200, 3000 + 50 * math.cos(math.pi / 8), 2100))


def test_a_world_may_be_bare(tmp_path: Path) -> None:
    world = load_yaml(write(tmp_path / "bare.yaml", "about: nothing here\n"))
    assert world.segments.shape == (0, 4)
    assert world.bounds == (0, 0, 0, 0)


BAD_YAML = {
    "unknown key": ("walls: []\nwals: []\n", "2: unknown key 'wals'"),
    "unknown key within": (
        "walls:\n  - {points: [[0, 0], [1, 1]], colour: red}\n",
        "2: unknown key 'colour'",
    ),
    "no points": ("walls:\n  - {closed: true}\n", "2: 'points' is missing"),
    "one point": ("walls:\n  - {points: [[0, 900]]}\n", "2: a wall needs two points"),
    "one place": ("walls:\n  - {points: [[0, 900], [0, 900]]}\n", "2: all points of the wall are the same"),
    "three coordinates": ("walls:\n  - points:\n    - [0, 0, 0]\n", "3: expected a list of 2 numbers"),
    "text": ("walls:\n  - {points: [[0, 0], [a, 1]]}\n", "2: expected a number"),
    "NaN": ("walls:\n  - points: [[0, 0],\n      [.nan, 1]]\n", "3: expected a number"),
    "infinite": ("boxes:\n  - {centre: [0, .inf], size: [1, 1]}\n", "2: expected a number"),
    "far away": ("posts:\n  - {centre: [0, 2000000], diameter: 9}\n", "2: 2e+06 is outside"),
    "flat box": ("boxes:\n  - {centre: [900, 0], size: [100, 0]}\n", "2: both sides of a box"),
    "no size": ("boxes:\n  - {centre: [0, 0]}\n", "2: 'size' is missing"),
    "turn": ("boxes:\n  - {centre: [0, 0], size: [1, 1], turn: 361}\n", "2: 361 is outside -360 to 360"),
    "thin post": ("posts:\n  - {centre: [900, 0], diameter: 0}\n", "2: 0 is outside"),
    "roughness": ("roughness: 1.5\n", "1: 1.5 is outside 0 to 1"),
    "wall's roughness": ("walls:\n  - {points: [[0, 0], [1, 1]], roughness: -1}\n", "2: -1 is outside"),
    "walls no list": ("walls: 3\n", "1: expected a list"),
    "goals no mapping": ("goals: [1, 2]\n", "1: expected a mapping of names"),
    "goal": ("goals:\n  a: [1, 2]\n  b: [1]\n", "3: expected a list of 2 or 3 numbers"),
    "closed": ("walls:\n  - {points: [[0, 9], [1, 9]], closed: 1}\n", "2: expected true or false"),
    "start": ("about: x\nstart: [0]\n", "2: expected a list of 2 or 3 numbers"),
    "start in a wall": (
        "walls: [{points: [[0, -900], [0, 900]]}]\nstart: [0, 0]\n",
        "2: the robot would start inside",
    ),
    "about": ("about: 5\n", "1: expected text"),
    "no YAML": ("walls: [\n", "2: not valid YAML"),
    "empty": ("", "1: the file is empty"),
    "a list": ("- a\n", "1: expected a mapping"),
}


@pytest.mark.parametrize("name", BAD_YAML)
def test_a_bad_world_is_one_line_with_its_place(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    text, expected = BAD_YAML[name]
    assert refused(write(tmp_path / "bad.yaml", text), capsys).startswith(expected)


@pytest.mark.parametrize("suffix", ["yaml", "yml", "map"])
def test_missing_and_binary_files_are_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], suffix: str
) -> None:
    path = tmp_path / f"w.{suffix}"
    assert "cannot be read (No such file" in refused(path, capsys)
    path.write_bytes(b"\x7fELF\x02\x01\xff\xfe\x00" * 20)
    assert "not UTF-8 text" in refused(path, capsys)
    path.write_bytes(b"\x00\x01\x02\x03")
    assert refused(path, capsys).startswith("1: not")
    path.unlink()
    path.mkdir()
    assert "cannot be read (Is a directory" in refused(path, capsys)


def test_an_unknown_name_lists_the_known_ones(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--world", "mars\n", "--duration", "1"]) == 2
    err = capsys.readouterr().err
    assert len(err.splitlines()) == 1
    assert all(name in err for name in world_names())


def test_too_many_solids_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in (aria_map, files):
        monkeypatch.setattr(module, "MAX_SEGMENTS", 3)
    assert "more than 3 solids" in refused(write(tmp_path / "w.yaml", ROOM), capsys)
    text = "2D-Map\nLINES\n" + "".join(f"{k} 0 {k} 5000\n" for k in range(1000, 1004))
    assert refused(write(tmp_path / "w.map", text), capsys).startswith("6: more than 3 solids")
    assert refused(write(tmp_path / "p.map", "2D-Map\nDATA\n0 0\n900 0\n"), capsys).startswith(
        "4: more than 3"
    )


@settings(max_examples=120, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.dictionaries(
        st.sampled_from(["about", "start", "goals", "roughness", "walls", "boxes", "posts", "x"]),
        st.recursive(
            st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
            lambda inner: (
                st.lists(inner, max_size=4)
                | st.dictionaries(
                    st.sampled_from(["points", "closed", "roughness", "centre", "size", "turn", "diameter"]),
                    inner,
                )
            ),
            max_leaves=12,
        ),
    )
)
def test_any_document_is_a_world_or_one_line(
    tmp_path_factory: pytest.TempPathFactory, document: object
) -> None:
    path = tmp_path_factory.getbasetemp() / "any-world.yaml"
    path.write_text(yaml.safe_dump(document, allow_unicode=True), encoding="utf-8", errors="surrogatepass")
    try:
        world = load_yaml(path)
    except SimError as error:
        assert_one_line(error, path)
        return
    assert np.isfinite(world.segments).all()
    assert len(world.roughness) == len(world.segments)


# ---- ARIA maps --------------------------------------------------------------------------------------------------

NEW_MAP = """\
2D-Map-Ex2
LineMinPos: -3000 -3000
LineMaxPos: 5000 3000
NumLines: 2
MinPos: 0 0
MaxPos: 4000 4000
NumPoints: 3
PointsAreSorted: false
Resolution: 20
Sources: LMS1XX Extra
ExtraNumLines: 1
MapInfo: GoalType Name=Special "Label=Special goal" Heading=Required
Cairn: RobotHome 100 200 90 "" ICON "RobotHome1"
Cairn: RobotHome 900 900 0 "" ICON "RobotHome2"
Cairn: Goal 1000 -500 30 "" ICON "kitchen"
Cairn: GoalWithHeading 1500 0 -90 "" ICON "desk with lamp"
Cairn: Dock 10 20 30 "" ICON ""
Cairn: ForbiddenLine 0 0 0 "" ICON "" -100 -200 300 400
Cairn: ForbiddenArea 0 0 90 "" ICON "" 0 0 100 200
Cairn: Sim.BoxObstacle 0 0 0 "" ICON "crate" 2000 1000 2500 1600
Cairn: Reflector 0 0 0 "" ICON "" 1 2 3 4
Cairn: Special 5 6 7 "" ICON "ignored"

LINES
-3000 -3000 5000 -3000
5000 -3000 5000 3000
DATA
0 4000
3 4001
4019 19
Extra_LINES
-3000 3000 5000 3000
"""


@pytest.mark.parametrize("header", ["2D-Map", "2D-Map-Ex", "2D-Map-Ex2", "\ufeff2D-Map"])
def test_a_map_gives_back_the_numbers_written_into_it(tmp_path: Path, header: str) -> None:
    world = load_map(write(tmp_path / "small.map", NEW_MAP.replace("2D-Map-Ex2", header)))
    assert world.start == Pose(100, 200, 90)
    assert world.goals == {
        "kitchen": Pose(1000, -500, 30),
        "desk with lamp": Pose(1500, 0, -90),
        "goal 3": Pose(10, 20, 30),
    }
    # The box comes first: its line does. Its two corners are opposite ones.
    assert world.segments[:4].tolist() == [
        [2000, 1000, 2500, 1000],
        [2500, 1000, 2500, 1600],
        [2500, 1600, 2000, 1600],
        [2000, 1600, 2000, 1000],
    ]
    assert world.segments[4:7].tolist() == [
        [-3000, -3000, 5000, -3000],
        [5000, -3000, 5000, 3000],
        [-3000, 3000, 5000, 3000],
    ]
    # Two of the three points fall on one place of the grid; each place is a cross of 20 mm.
    assert len(world.segments) == 4 + 3 + 2 * 2
    assert world.roughness.tolist() == [MAP_ROUGHNESS] * 7 + [1.0] * 4
    centres = {tuple(p) for p in ((world.segments[7:, :2] + world.segments[7:, 2:]) / 2).tolist()}
    assert centres == {(0.0, 4000.0), (4020.0, 20.0)}
    assert world.forbidden[0].tolist() == [-100, -200, 300, 400]
    # Turned by 90 degrees about the origin: x to y, y to -x.
    area = world.forbidden[1:]
    assert len(area) == 4
    assert (area[:, 0::2].min(), area[:, 0::2].max()) == (pytest.approx(-200), pytest.approx(0))
    assert (area[:, 1::2].min(), area[:, 1::2].max()) == (pytest.approx(0), pytest.approx(100))


@pytest.mark.parametrize("seed", range(5))
def test_random_maps_come_back_number_by_number(tmp_path: Path, seed: int) -> None:
    rng = random.Random(seed)
    lines = [[rng.randrange(1000, 9000) for _ in range(4)] for _ in range(rng.randrange(1, 40))]
    lines = [line for line in lines if line[:2] != line[2:]]
    text = f"2D-Map\nNumLines: {len(lines)}\nLINES\n" + "".join(
        " ".join(map(str, line)) + "\n" for line in lines
    )
    world = load_map(write(tmp_path / "r.map", text))
    assert world.segments.tolist() == lines, f"seed {seed}"
    assert world.start == Pose(0, 0, 0)


BAD_MAP = {
    "empty": ("", "1: not an ARIA map"),
    "header": ("3D-Map\n", "1: not an ARIA map"),
    "word": ("2D-Map\nhello\n", "2: 'hello' is neither"),
    "line of three": ("2D-Map\nLINES\n1 2 3\n", "3: a line needs 4 numbers"),
    "line of five": ("2D-Map\nLINES\n1 2 3 4\n1 2 3 4 5\n", "4: a line needs 4 numbers"),
    "point of one": ("2D-Map\nDATA\n1\n", "3: a DATA point needs 2 numbers"),
    "NaN": ("2D-Map\nLINES\n1 2 3 nan\n", "3: a line needs 4 numbers"),
    "infinite": ("2D-Map\nDATA\n1e999 0\n", "3: a DATA point needs 2 numbers"),
    "word in data": ("2D-Map\nDATA\n1 2\nx y\n", "4: a DATA point needs 2 numbers"),
    "count": ("2D-Map\nNumLines: many\n", "2: NumLines needs a whole number, not 'many', and none follow"),
    "decimal commas": ("2D-Map\nLINES\n0,5 900,5 9,5 900,5\n", "3: a line needs 4 numbers"),
    "commented out": (
        "2D-Map\nNumLines: 1\nLINES\n# 0 900 9 900\n",
        "2: NumLines announces 1 but none follow",
    ),
    "negative count": ("2D-Map\nNumPoints: -1\n", "2: NumPoints needs a whole number"),
    "no count": ("2D-Map\nNumPoints:\n", "2: NumPoints needs a whole number"),
    "cut before": ("2D-Map\nResolution: 20\nNumPoints: 7\n", "3: NumPoints announces 7 but none follow"),
    "cut in a line": ("2D-Map\nNumLines: 2\nLINES\n0 900 9 900\n0 8", "5: a line needs 4 numbers"),
    "newer, but no map": ("2D-Map-Exotic\n", "1: not an ARIA map"),
    "cairn": ("2D-Map\nCairn: Goal 1 2\n", "2: expected Cairn: Goal X Y HEADING"),
    "cairn's place": ('2D-Map\nCairn: Goal 1 b 0 "" ICON "g"\n', "2: Cairn Goal needs 3 numbers"),
    "forbidden": ('2D-Map\nCairn: ForbiddenLine 0 0 0 "" ICON "" 1 2 3\n', "2: Cairn ForbiddenLine needs 4"),
}


@pytest.mark.parametrize("name", BAD_MAP)
def test_a_bad_map_is_one_line_with_its_place(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    text, expected = BAD_MAP[name]
    path = write(tmp_path / "bad.map", text)
    assert refused(path, capsys).startswith(expected)


ODD_MAP = {
    "short": ("2D-Map\nNumLines: 2\nLINES\n0 900 9 900\n", "2: NumLines announces 2 but 1 follow", 1),
    "long": ("2D-Map\nNumLines: 0\nLINES\n0 900 9 900\n", "2: NumLines announces 0 but 1 follow", 1),
    "short of another": (
        "2D-Map-Ex\nLaserNumPoints: 2\nLaser_DATA\n1 1\n", "2: LaserNumPoints announces 2 but 1", 2,
    ),
    "negative count": ("2D-Map\nNumLines: -1\nLINES\n0 900 9 900\n", "2: NumLines needs a whole number, not '-1'", 1),
    "count in words": ("2D-Map\nNumLines: four\nLINES\n0 900 9 900\n", "not 'four': the 1 that follow are read", 1),
    "no count": ("2D-Map\nNumPoints:\nDATA\n5000 900\n", "2: NumPoints needs a whole number, not ''", 2),
    "count with a unit": ("2D-Map\nNumLines: 1 line\nLINES\n0 900 9 900\n", "not '1 line'", 1),
    "decimal count": ("2D-Map\nNumLines: 1.0\nLINES\n0 900 9 900\n", "not '1.0'", 1),
    "comment": ("2D-Map\nLINES\n# a wall\n0 900 9 900\n# and more\n0 800 9 800\n", "3: a comment (#)", 2),
    "comment above all": ("# by Mapper\n\n2D-Map\nLINES\n0 900 9 900\n", "1: a comment (#)", 1),
    "comment in the header": ("2D-Map\n# of Monday\nNumLines: 1\nLINES\n0 900 9 900\n", "2: a comment (#)", 1),
    "comment behind numbers": ("2D-Map\nNumLines: 1\nLINES\n0 900 9 900 # wall\n", "4: a comment (#)", 1),
    "comment in DATA": ("2D-Map\nNumPoints: 1\nDATA\n#\n5000 900\n", "4: a comment (#)", 2),
    "commas": ("2D-Map\nLINES\n0, 900, 9, 900\n0,800,9,800\n", "3: commas between the numbers", 2),
    "comma at the end": ("2D-Map\nLINES\n0 900 9 900,\n", "3: commas between the numbers", 1),
    "commas in DATA": ("2D-Map\nDATA\n5000,900\n", "3: commas between the numbers", 2),
    "newer": ("2D-Map-Ex3\nLINES\n0 900 9 900\n", "1: 2D-Map-Ex3 is a form that is not known", 1),
    "much newer": ("2D-Map-Ex17\nLINES\n0 900 9 900\n", "1: 2D-Map-Ex17 is a form", 1),
    "Latin-1": ('2D-Map\nCairn: Goal 1 2 0 "" ICON "Caf\udce9"\nLINES\n0 900 9 900\n', "not UTF-8 (byte 37)", 1),
}  # fmt: skip


@pytest.mark.parametrize("name", ODD_MAP)
def test_an_odd_map_is_read_with_a_warning(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, name: str
) -> None:
    text, expected, segments = ODD_MAP[name]
    path = tmp_path / "odd.map"
    path.write_bytes(text.encode("utf-8", "surrogateescape"))
    world = load_map(path)
    assert len(world.segments) == segments
    assert [record.getMessage() for record in caplog.records] == [caplog.records[0].getMessage()]
    assert expected in caplog.records[0].getMessage()
    if name == "Latin-1":
        assert list(world.goals) == ["Caf\u00e9"]


def test_a_name_may_have_the_mark_of_a_comment(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    text = '2D-Map\nCairn: Goal 1 2 0 "" ICON "desk #3"\nLINES\n0 900 9 900\n'
    assert list(load_map(write(tmp_path / "a.map", text)).goals) == ["desk #3"]
    assert not caplog.records


def test_what_is_no_text_is_no_map(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "binary.map"
    path.write_bytes(b"2D-Map\n\0\xff\xfe")
    assert "not UTF-8 text" in refused(path, capsys)


def test_a_map_whose_home_is_in_a_wall_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path / "home.map", "2D-Map\nLINES\n0 -900 0 900\n")
    assert main(["--world", str(path), "--duration", "1"]) == 2
    assert "a solid of world home is there; choose another start" in capsys.readouterr().err


def test_more_entries_than_announced_are_all_read(tmp_path: Path) -> None:
    world = load_map(write(tmp_path / "m.map", "2D-Map\nNumLines: 1\nLINES\n0 900 9 900\n0 800 9 800\n"))
    assert len(world.segments) == 2


mappish = st.lists(
    st.sampled_from(
        [
            "2D-Map",
            "LINES",
            "DATA",
            "X_DATA",
            "1 2 3 4",
            "1 2",
            "NumLines: 3",
            "XNumPoints: 1",
            "",
            " ",
            ":",
            "Cairn:",
            'Cairn: Goal 1 2 3 "" ICON "g"',
            'Cairn: RobotHome 1 2 3 "" ICON ""',
            "Cairn: Goal",
            "nan nan",
            'Cairn: ForbiddenArea 0 0 45 "" ICON "" 1 2 3 4',
            'Cairn: Sim.BoxObstacle 0 0 1e9 "" ICON "" 1 2 3 4',
        ]
    )
    | st.text(max_size=12),
    max_size=12,
).map("\n".join)


@settings(max_examples=200, deadline=None)
@example("2D-Map\n\u2028LINES\x1c1 2 3 4")
@given(mappish.map(lambda text: "2D-Map\n" + text) | st.text())
def test_any_text_is_a_map_or_one_line(tmp_path_factory: pytest.TempPathFactory, text: str) -> None:
    path = tmp_path_factory.getbasetemp() / "any.map"
    path.write_text(text, encoding="utf-8", errors="surrogatepass")
    try:
        world = load_map(path)
    except SimError as error:
        assert_one_line(error, path)
        return
    assert np.isfinite(world.segments).all()
    assert np.isfinite(world.forbidden).all()
    assert len(world.roughness) == len(world.segments)


# ---- the worlds that come with it -------------------------------------------------------------------------------


@pytest.mark.tour(3)
@pytest.mark.parametrize("name", world_names())
def test_a_shipped_world_has_room_at_start_and_goals_and_a_way_between(name: str) -> None:
    world = load_world(name)
    assert world.about
    assert world.goals
    body = BodyModel(world)
    assert body.contact(world.start, 0.0) is None
    for place, pose in {"start": world.start, **world.goals}.items():
        for heading in range(0, 360, 10):
            clearance = body.clearance_mm(Pose(pose.x_mm, pose.y_mm, heading))
            assert clearance >= 250, f"{place} at {heading} degrees"
    reached = reachable(world)
    for place, pose in world.goals.items():
        near = [c for c in reached if math.hypot(c[0] - pose.x_mm, c[1] - pose.y_mm) <= 150]
        assert near, f"no way from the start to {place}"


def reachable(world: World, step: float = 100.0) -> set[tuple[float, float]]:
    """Places of a grid that the robot reaches with its whole swing circle free: it may turn anywhere on the way."""

    def free(x: float, y: float) -> bool:
        a, b = world.segments[:, :2], world.segments[:, 2:]
        e = b - a
        t = np.clip((((x, y) - a) * e).sum(1) / (e * e).sum(1), 0, 1)[:, None]
        return bool(np.hypot(*((x, y) - a - t * e).T).min() > SWING_MM)

    begin = (world.start.x_mm, world.start.y_mm)
    seen, queue = {begin}, deque([begin])
    while queue:
        x, y = queue.popleft()
        for place in ((x + step, y), (x - step, y), (x, y + step), (x, y - step)):
            if place not in seen and free(*place):
                seen.add(place)
                queue.append(place)
    return seen


# ---- what the demonstration's world promises --------------------------------------------------------------------


def from_sonar(pose: Pose, number: int) -> Pose:
    mount = robot_table().mounts[number]
    c, s = math.cos(math.radians(pose.heading_deg)), math.sin(math.radians(pose.heading_deg))
    x, y = pose.x_mm + mount.x_mm * c - mount.y_mm * s, pose.y_mm + mount.x_mm * s + mount.y_mm * c
    return Pose(x, y, pose.heading_deg + mount.heading_deg)


def axis_range(world: World, at: Pose) -> float:
    """Distance to the first solid along the axis, by itself: no cone, no losses."""
    heading = math.radians(at.heading_deg)
    ux, uy = math.cos(heading), math.sin(heading)
    best = math.inf
    for x1, y1, x2, y2 in world.segments.tolist():
        # Across and along the axis.
        a1, a2 = (ux * (y - at.y_mm) - uy * (x - at.x_mm) for x, y in ((x1, y1), (x2, y2)))
        l1, l2 = (ux * (x - at.x_mm) + uy * (y - at.y_mm) for x, y in ((x1, y1), (x2, y2)))
        if a1 * a2 <= 0 and a1 != a2:
            along = l1 + (l2 - l1) * a1 / (a1 - a2)
            best = min(best, along) if along > 0 else best
    return best


def demo_course() -> list[tuple[float, float]]:
    scenario = load_scenario("demo")
    start = scenario.start or load_world(scenario.world).start
    return [(start.x_mm, start.y_mm), *scenario.course]


@pytest.mark.tour(2)
@pytest.mark.parametrize("seed", range(4))
def test_from_everywhere_near_the_demo_course_every_front_sonar_hears_a_surface_within_4_m(seed: int) -> None:
    rng = random.Random(seed)
    scenario = load_scenario("demo")
    world = load_world(scenario.world)
    echoes = EchoModel(world, scenario.sonar)
    points = demo_course()
    for _ in range(150):
        (x1, y1), (x2, y2) = rng.choice(list(itertools.pairwise(points)))
        part, off, way = rng.random(), 300 * math.sqrt(rng.random()), rng.random() * 2 * math.pi
        x, y = x1 + (x2 - x1) * part + off * math.cos(way), y1 + (y2 - y1) * part + off * math.sin(way)
        for turn in range(12):
            pose = Pose(x, y, 30 * turn + rng.uniform(0, 30))
            for number in FRONT:
                at = from_sonar(pose, number)
                assert axis_range(world, at) <= 4000, f"seed {seed}: sonar {number} at {pose}"
                heard = echoes.range_mm(at.x_mm, at.y_mm, at.heading_deg)
                assert heard <= 4000, f"seed {seed}: sonar {number} at {pose}"


def test_all_surfaces_of_the_demo_are_rough_and_the_smooth_world_is_its_twin() -> None:
    demo, smooth = load_world("demo"), load_world("smooth")
    assert (demo.roughness == 1).all()
    assert (smooth.roughness == 0).all()
    assert demo.segments.tolist() == smooth.segments.tolist()
    assert load_scenario("demo").sonar.crosstalk == 0
    assert load_scenario("demo").sonar.noise_mm > 0


def test_on_the_demo_course_nothing_comes_within_the_object_range() -> None:
    scenario = load_scenario("demo")
    world = load_world(scenario.world)
    echoes = EchoModel(world, scenario.sonar)
    body = BodyModel(world)
    points = demo_course()
    poses = []
    heading = (scenario.start or world.start).heading_deg
    for (x1, y1), (x2, y2) in itertools.pairwise(points):
        wanted = math.degrees(math.atan2(y2 - y1, x2 - x1))
        poses += [Pose(x1, y1, heading + (wanted - heading) * k / 45) for k in range(46)]
        count = round(math.hypot(x2 - x1, y2 - y1) / 20)
        poses += [
            Pose(x1 + (x2 - x1) * k / count, y1 + (y2 - y1) * k / count, wanted) for k in range(count + 1)
        ]
        heading = wanted
    for pose in poses:
        assert body.clearance_mm(pose) > 300, pose
        for number in FRONT:
            at = from_sonar(pose, number)
            assert echoes.range_mm(at.x_mm, at.y_mm, at.heading_deg) > 300, f"sonar {number} at {pose}"
