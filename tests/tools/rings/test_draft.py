# SPDX-License-Identifier: MIT
"""Rule: a draft of a ring has each sonar where URDF or bag say, holds as a ring, and reports what it does not know."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from argus_tools.chunks import LogError
from argus_tools.log.cli import main
from argus_tools.log.draft import drafted
from bags import START, single, transform, write

from hil_sim.tables.robot import robot_table

POSES = {"us_0": (0, 140, 90), "us_1": (110, 40, 17), "us_2": (110, -40, -17), "us_10": (-140, 0, 180)}
BASE_LINK = '<link name="base_footprint"/><link name="base_link"/>'


def urdf(axle_mm: int = 0, wheels: bool = True) -> str:
    """Return a round robot of 300 mm as xacro makes it, its axle ahead of the base."""

    def joint(child: str, x_mm: float, y_mm: float, deg: float, kind: str = "fixed") -> str:
        at = f'xyz="{(x_mm + axle_mm) / 1000} {y_mm / 1000} 0.1" rpy="0 0 {math.radians(deg)}"'
        ends = f'<parent link="base_link"/><child link="{child}"/><origin {at}/>'
        return f'<link name="{child}"/><joint name="to_{child}" type="{kind}">{ends}</joint>'

    shape = '<geometry><cylinder radius="0.15" length="0.1"/></geometry>'
    at = f'<origin xyz="{axle_mm / 1000} 0 0"/>'
    body = f'<link name="base_link"><collision>{at}{shape}</collision></link>'
    feet = '<joint name="feet" type="fixed"><parent link="base_footprint"/><child link="base_link"/></joint>'
    parts = [joint(name, *pose) for name, pose in POSES.items()]
    if wheels:
        parts += [
            joint(f"{side}_wheel", 0, y, 0, "continuous") for side, y in (("left", 120), ("right", -120))
        ]
    parts.append(joint("caster_wheel", -100, 20, 0, "continuous"))
    return f'<robot name="round bot"><link name="base_footprint"/>{body}{feet}{"".join(parts)}</robot>'


def draft(path: Path, capsys: pytest.CaptureFixture[str]) -> tuple[str, Path]:
    """Draft, check the draft as a ring, and return it and its file."""
    assert main(["ring", "--draft", str(path)]) == 0, capsys.readouterr().err
    text = capsys.readouterr().out
    made = path.parent / "draft.toml"
    made.write_text(text)
    assert main(["ring", str(made)]) == 0, capsys.readouterr().err
    return text, made


def assert_poses(made: Path) -> None:
    mounts = robot_table(str(made)).mounts
    assert [(m.x_mm, m.y_mm, m.heading_deg) for m in mounts] == list(POSES.values())
    assert [m.role for m in mounts] == ["abeam", "ahead", "ahead", "astern"]
    assert robot_table(str(made)).forward == (1, 2)


@pytest.mark.parametrize("axle_mm", [0, -30])
def test_of_a_urdf(axle_mm: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "robot.urdf"
    path.write_text(urdf(axle_mm))
    text, made = draft(path, capsys)
    assert_poses(made)
    robot = robot_table(str(made))
    assert (robot.body.front_mm, robot.body.rear_mm, 2 * robot.body.half_mm) == (150, 150, 300)
    assert robot.motion["track_mm"] == 240
    assert ("counted from the axle" in text) == (axle_mm != 0)
    assert "no_echo_mm: not known" in text


@pytest.mark.parametrize("storage", ["ros1", "sqlite3", "mcap"])
def test_of_a_bag(storage: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sent = []
    for n in range(20):
        t = START + n / 10
        for k, (name, (x, y, deg)) in enumerate(POSES.items()):
            sent.append(single(t, k, 1.0, f"/{name}", name, 4.0))
            sent.append(transform(t, name, "base_link", x / 1000, y / 1000, math.radians(deg)))
    path = write(tmp_path / ("drive.bag" if storage == "ros1" else "drive"), sent, storage)
    text, made = draft(path, capsys)
    assert_poses(made)
    robot = robot_table(str(made))
    assert (robot.no_echo_mm, robot.min_mm, robot.cone_deg) == (4000, 100, 29)
    assert text.count("MEASURE IT") == 3


@pytest.mark.parametrize(
    ("name", "text", "why"),
    [
        ("a.urdf", "<robot", "no XML"),
        ("a.urdf", "<sdf/>", "no plain URDF"),
        ("a.urdf", '<robot name="a"><link name="wheel"/></robot>', "no link base_link"),
        ("a.urdf", f'<robot name="a">{BASE_LINK}</robot>', "no sonars whose place is known"),
        (
            "a.xacro",
            '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include/></robot>',
            "xacro a.xacro > robot.urdf",
        ),
        ("a.bag", "no bag at all", "cannot be read"),
        ("nowhere.bag", None, "no such file"),
    ],
)
def test_what_has_no_ring_is_refused(
    name: str, text: str | None, why: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / name
    if text is not None:
        path.write_text(text)
    assert main(["ring", "--draft", str(path)]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert why in told.err
    assert told.err.count("\n") == 1


def test_without_transforms_the_frames_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sent = [single(START + n / 10, 0, 1.0, "/us_0", "us_0") for n in range(5)]
    path = write(tmp_path / "drive.bag", sent)
    assert main(["ring", "--draft", str(path)]) == 2
    assert "no transforms from a base to us_0" in capsys.readouterr().err


@pytest.mark.parametrize(
    "part",
    [
        '<collision><geometry><box size="a b c"/></geometry></collision>',
        '<collision><geometry><cylinder radius="wide" length="1"/></geometry></collision>',
        '<collision><origin xyz="0 0 x"/><geometry><sphere radius="1"/></geometry></collision>',
    ],
)
def test_a_number_that_is_none_is_an_error_of_one_line(tmp_path: Path, part: str) -> None:
    path = tmp_path / "odd.urdf"
    path.write_text(f'<robot name="r"><link name="base_link">{part}</link></robot>')
    with pytest.raises(LogError, match="a number in the URDF that is none"):
        drafted(path)
