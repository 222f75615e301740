# SPDX-License-Identifier: MIT
"""Rule under attack: a ring is data: a file of it is judged with file, line and reason, and every program takes it."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest
from argus_tools.log.cli import main

from hil_sim.core.library import Core, library, sonars_of
from hil_sim.errors import InputError, SimError
from hil_sim.sil import Mission, run
from hil_sim.tables import load, robots
from hil_sim.tables.robot import own_ring, robot_table

ROOT = Path(__file__).resolve().parents[2]
RINGS = ROOT / "docs/samples/rings"
GOOD = """\
[identity]
subclass = "mine"

[body]
front_mm = 150
rear_mm = 150
width_mm = 300

[sonar]
forward = [1, 2]

[[sonar.pose]]
x_mm = 0
y_mm = 140
heading_deg = 90
role = "abeam"

[[sonar.pose]]
x_mm = 100
y_mm = 50
heading_deg = 20
role = "ahead"

[[sonar.pose]]
x_mm = 100
y_mm = -50
heading_deg = -20
role = "ahead"
"""
BAD = [
    ("front_mm = 150", "front_mm = ", 5, "not valid TOML"),
    ("front_mm = 150", "", 4, "front_mm must be given"),
    ("front_mm = 150", "front_mm = 150.5", 5, "whole number"),
    ("front_mm = 150", "front_mm = 5000", 5, "out of its range"),
    ("width_mm", "widht_mm", 7, "did you mean width_mm?"),
    ("[body]", "[bodi]", 4, "did you mean body?"),
    ('"mine"', '"a name of many letters"', 2, "1 to 15 letters"),
    ('"mine"', '"p3dx-sh"', 2, "is a robot that is known"),
    ("forward = [1, 2]", "forward = [1]", 10, "2 to 6 sonars"),
    ("forward = [1, 2]", "forward = [1, 3]", 10, "0 to 2"),
    ("forward = [1, 2]", "forward = [2, 1]", 18, "left to right"),
    ("forward = [1, 2]", "forward = [0, 1]", 12, "role ahead"),
    ("forward = [1, 2]", "forward = [1, 2]\nno_echo_mm = 9000", 11, "out of its range"),
    ("forward = [1, 2]", "forward = [1, 2]\nno_echo_mm = 200000", 11, "whole number"),
    ("x_mm = 0", "x_mm = 151", 12, "beside the body"),
    ("y_mm = 140", "y_mm = 152", 12, "beside the body"),
    ("y_mm = 140\n", "", 12, "y_mm is missing"),
    ("heading_deg = 90", "heading_deg = 190", 12, "180 degrees"),
    ('"abeam"', '"sideways"', 16, "role must be one of"),
    ("y_mm = -50\nheading_deg = -20", "y_mm = 50\nheading_deg = 20", 24, "as one before it"),
    ("[body]", "[body]\nswing_radius_mm = 100", 5, "S7"),
    ("x_mm = 0", "x_mm = 0\nz_mm = 3", 14, "no such key"),
    ("x_mm = 0", "number = 1\nx_mm = 0", 13, "number must be 0"),
]


def asked(capsys: pytest.CaptureFixture[str], *words: object) -> tuple[int, str, str]:
    """Run argus-log; return its exit code and what it printed."""
    code = main([str(word) for word in words])
    out, err = capsys.readouterr()
    return code, out, err


def has_room(name: str) -> bool:
    """Whether this build manages as many sonars as a sample has."""
    with (RINGS / name).open("rb") as file:
        return len(tomllib.load(file).get("sonar", {}).get("pose", [])) <= sonars_of(library())


@pytest.mark.parametrize("name", sorted(path.name for path in RINGS.glob("*.toml")))
def test_the_samples_hold(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "ring.png"
    code, out, err = asked(capsys, "ring", RINGS / name, "-o", picture)
    if has_room(name):
        assert (code, err) == (0, "")
        assert "nothing is wrong" in out.splitlines()[0]
        assert picture.read_bytes().startswith(b"\x89PNG")
    else:
        assert code == 2
        assert re.search(r"toml:\d+: this build manages fewer sonars", err)


@pytest.mark.parametrize(("old", "new", "line", "why"), BAD)
def test_what_is_wrong_is_told_with_its_line(
    old: str, new: str, line: int, why: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert old in GOOD
    path = tmp_path / "mine.toml"
    path.write_text(GOOD.replace(old, new, 1))
    code, out, err = asked(capsys, "ring", path)
    assert (code, out) == (2, "")
    assert err.startswith(f"argus-log: {path}:{line}: "), err
    assert why in err
    assert err.count("\n") == 1


def test_the_good_one_holds(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(GOOD)
    assert asked(capsys, "ring", path)[0] == 0
    ring = own_ring("mine")
    assert ring is not None
    assert ring.mounts == ((0, 140, 90, 3), (100, 50, 20, 1), (100, -50, -20, 1))


@pytest.mark.parametrize("name", robots())
def test_the_known_robots_are_files_of_the_same_form(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "other.toml"
    path.write_text(f'inherits = "{name}"\n[identity]\nsubclass = "other"\n')
    code, _, err = asked(capsys, "ring", path)
    if robot_table(name).sonars > sonars_of(library()):
        assert (code, "this build manages fewer sonars" in err) == (2, True)
        return
    assert code == 0
    copy, known = robot_table("other"), robot_table(name)
    assert (copy.mounts, copy.body, copy.motion, copy.orders) == (
        known.mounts,
        known.body,
        known.motion,
        known.orders,
    )


def test_the_whole_of_a_ring_is_the_ring(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    # What is written without `inherits` reads back as what it was written of.
    code, out, _ = asked(capsys, "ring", RINGS / "amigobot.toml", "--whole", "-")
    assert code == 0
    path = tmp_path / "whole.toml"
    path.write_text(out)
    assert "inherits" not in tomllib.loads(out)
    assert robot_table(str(path)).ring == robot_table(str(RINGS / "amigobot.toml")).ring
    assert robot_table(str(path)).no_echo_mm == 3000
    assert load("robots/amigo-sh")["sonar"]["no_echo_mm"] == 5000


def test_one_that_inherits_from_nothing_says_what_there_is(tmp_path: Path) -> None:
    path = tmp_path / "lost.toml"
    path.write_text('inherits = "nobody"\n')
    with pytest.raises(SimError, match=r"nobody.*name one of amigo-sh"):
        robot_table(str(path))


def test_a_mission_is_driven_with_a_ring_of_ones_own() -> None:
    # The emulator has the ring's sonars, the fault manager their bearings: it gets there, and finds the dead one.
    mission = Mission(
        "office", ((1500, 0),), faults=("off:2@travelled>300",), seed=11, robot=str(RINGS / "amigobot.toml")
    )
    outcome = run(mission)
    assert outcome.reached, f"seed {mission.seed}"
    assert outcome.collisions == []


def test_a_table_is_judged_by_a_ring_of_ones_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(GOOD)
    table = tmp_path / "drive.csv"
    rows = [f"{t / 10:.1f},{t * 0.02:.3f},0,0,{900},{3000 - t * 19},{2990 - t * 19}" for t in range(100)]
    table.write_text("t_s,x_m,y_m,heading_rad,sonar_0_mm,sonar_1_mm,sonar_2_mm\n" + "\n".join(rows) + "\n")
    code, out, err = asked(capsys, "faults", table, "--ring", path)
    assert code == 0, err
    assert "ring of mine" in err
    assert "3 of 3" in out


def test_settings_are_judged_by_the_ring() -> None:
    # At 250 mm/s a P3-DX meets what it sees at 250 mm before it stands, the small round robot does not.
    settings = {"speed_mm_s": 240, "object_range_mm": 250}
    with pytest.raises(InputError, match="S5"):
        Core(0, settings)
    Core(0, settings, robot_table(str(RINGS / "roundbot.toml")).ring)
    with pytest.raises(InputError, match="S5"):
        Core(0, {**settings, "speed_mm_s": 400}, robot_table(str(RINGS / "roundbot.toml")).ring)
    with pytest.raises(InputError, match="speed_mm_s is out of its range"):
        Core(0, {"speed_mm_s": 5000}, robot_table(str(RINGS / "roundbot.toml")).ring)


def test_the_time_between_two_pings_is_that_of_the_ring() -> None:
    # Six at 60 ms: what the robot is asked is what the file has, and S5 reckons with it.
    ring = robot_table(str(RINGS / "roundbot.toml")).ring
    assert ring is not None
    assert ring.figures["sonar.cycle_ms"] == 60
    outcome = run(Mission("office", ((600, 0),), seed=12, robot=str(RINGS / "roundbot.toml")))
    assert outcome.reached, "seed 12"
    with pytest.raises(InputError, match="S5"):
        Core(0, {"speed_mm_s": 300, "object_range_mm": 300}, ring)
    Core(0, {"speed_mm_s": 300, "object_range_mm": 300, "sonar_cycle_ms": 40}, ring)


@pytest.mark.parametrize(
    "path", sorted((ROOT / "tests/data/rings").glob("*.toml")), ids=lambda path: path.stem
)
def test_the_verdict_is_that_of_argusd(path: Path) -> None:
    # The corpus that argusd judges, too (test_ring_file.c).
    if path.stem.startswith("good-"):
        assert robot_table(str(path)).sonars == 3
        return
    with pytest.raises(SimError) as told:
        robot_table(str(path))
    assert str(told.value).startswith(str(path))
