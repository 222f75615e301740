# SPDX-License-Identifier: MIT
"""Rule: all robots' tables have the same keys, and what each says of its robot agrees with itself."""

from __future__ import annotations

import math
import tomllib
from decimal import Decimal
from typing import Any

import pytest

from hil_sim.tables import TABLE_DIR, load, robots, section

NAMES = ("amigo-sh", "p3at-sh", "p3dx-sh", "peoplebot-sh")
COUNTS = {"amigo-sh": 8, "p3at-sh": 16, "p3dx-sh": 16, "peoplebot-sh": 32}
ROLES = ("ahead", "astern", "abeam", "none")


def table(name: str) -> dict[str, Any]:
    return load(f"robots/{name}")


def keys(values: Any) -> Any:
    """The shape of a table: its keys, and those of the rows of its lists."""
    if isinstance(values, dict):
        return {key: keys(value) for key, value in values.items()}
    if isinstance(values, list) and values and isinstance(values[0], dict):
        rows = {str(keys(row)) for row in values}
        assert len(rows) == 1, "rows of a list with different keys"
        return rows
    return type(values).__name__


def test_the_four_robots_have_a_table_of_one_shape() -> None:
    assert robots() == NAMES
    for name in NAMES:
        assert keys(table(name)) == keys(table("p3dx-sh")), name
        assert table(name)["identity"]["subclass"] == name


@pytest.mark.parametrize("name", NAMES)
def test_every_figure_is_an_integer_or_a_decimal_of_one_place(name: str) -> None:
    text = (TABLE_DIR / "robots" / f"{name}.toml").read_text(encoding="utf-8")

    def walk(value: Any) -> None:
        if isinstance(value, dict | list):
            for part in value.values() if isinstance(value, dict) else value:
                walk(part)
        elif not isinstance(value, str):
            assert value * 10 == int(value * 10), value

    walk(tomllib.loads(text, parse_float=Decimal))


@pytest.mark.parametrize("name", NAMES)
def test_body_agrees_with_itself(name: str) -> None:
    body = table(name)["body"]
    front, rear, half = body["front_mm"], body["rear_mm"], body["width_mm"] / 2
    assert body["corners_mm"] == [[front, half], [-rear, half], [-rear, -half], [front, -half]]
    assert 0 <= body["swing_radius_mm"] - max(math.hypot(x, y) for x, y in body["corners_mm"]) < 10
    assert front + rear >= body["length_mm"]
    for pose in table(name)["sonar"]["pose"]:
        assert -rear <= pose["x_mm"] <= front, pose
        assert abs(pose["y_mm"]) <= half, pose


@pytest.mark.parametrize("name", NAMES)
def test_sonars_agree_with_themselves(name: str) -> None:
    sonar = table(name)["sonar"]
    poses, arrays = sonar["pose"], sonar["array"]
    assert len(poses) == COUNTS[name]
    assert [pose["number"] for pose in poses] == list(range(len(poses)))
    assert [array["index"] for array in arrays] == list(range(sonar["arrays"]))
    for array in arrays:
        in_it = [pose["number"] for pose in poses if pose["array"] == array["index"]]
        assert sorted(array["order"]) == in_it
        first = sonar["transducers_per_array"] * array["index"]
        assert all(first <= number < first + sonar["transducers_per_array"] for number in in_it)
    assert max(pose["x_mm"] for pose in poses) == table(name)["body"]["sonar_face_mm"]
    assert sonar["rear_sonars"] == any(pose["role"] == "astern" for pose in poses)


@pytest.mark.parametrize("name", NAMES)
def test_roles_follow_the_headings(name: str) -> None:
    poses = table(name)["sonar"]["pose"]
    for pose in poses:
        assert pose["role"] in ROLES
        off = abs(pose["heading_deg"])
        assert pose["role"] in (("ahead" if off < 90 else "abeam" if off == 90 else "astern"), "none"), pose
    forward = table(name)["sonar"]["forward"]
    headings = [poses[number]["heading_deg"] for number in forward]
    assert all(poses[number]["role"] == "ahead" for number in forward)
    assert headings == sorted(headings, reverse=True), "left to right"


@pytest.mark.parametrize("name", NAMES)
def test_odometry_agrees_with_the_drive(name: str) -> None:
    motion, odometry = section(f"robots/{name}", "motion"), section(f"robots/{name}", "odometry")
    quarter = math.pi * motion["track_mm"] * motion["ticks_per_mm"] / 8
    assert motion["rev_count"] == pytest.approx(quarter, rel=0.002)
    # DiffConvFactor is 2 / track; that of the P3-DX is of the older robot with a wider track.
    assert 2e6 / odometry["diff_conv_urad_mm"] == pytest.approx(motion["track_mm"], rel=0.09)
    assert motion["vel_max_mm_s"] <= motion["vel_top_mm_s"]
    assert motion["rotvel_max_deg_s"] <= motion["rotvel_top_deg_s"]
