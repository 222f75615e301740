# SPDX-License-Identifier: MIT
"""Rule: tables and JSON of ranges are read by the names and units of their columns."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from argus_tools.formats import find_format
from bags import NO_ECHO_MM, START, Drive
from logs import decode, run

DRIVE = Drive()


def rows(names: str, scales: tuple[float, float, float, float]) -> list[dict[str, float]]:
    """Return the drive in columns of these names (time, x, y, heading, and of ranges up to the number)."""
    t_name, x_name, y_name, heading_name, range_name, first = names.split()
    time, length, angle, reach = scales
    return [
        {
            t_name: t * time,
            x_name: place[0] / 1000 * length,
            y_name: place[1] / 1000 * length,
            heading_name: heading * angle,
            **{range_name.replace("#", str(k + int(first))): ranges[k] / 1000 * reach for k in range(8)},
        }
        for t, place, heading, ranges in DRIVE.steps
    ]


NAMES = {
    "t_s x_m y_m heading_rad sonar_#_m 0": (1.0, 1.0, 1.0, 1.0),
    "Time[ms] X(mm) Y(mm) Theta(deg) Sonar-#-mm 1": (1e3, 1e3, 180 / math.pi, 1e3),
    "timestamp pose.x pose.y yaw range# 0": (1e9, 1.0, 1.0, 1000.0),
    "stamp odom_x_cm odom_y_cm th us_#_cm 1": (1.0, 100.0, 1.0, 100.0),
}


def as_csv(path: Path, table: list[dict[str, float]], separator: str = ",", is_comma: bool = False) -> Path:
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(table[0]), delimiter=separator)
        writer.writeheader()
        for row in table:
            writer.writerow({k: str(v).replace(".", ",") for k, v in row.items()} if is_comma else row)
    return path


WAYS: dict[str, Callable[[Path, list[dict[str, float]]], Any]] = {
    "csv": as_csv,
    "semicolons": lambda path, table: as_csv(path, table, ";", True),
    "tabs": lambda path, table: as_csv(path, table, "\t"),
    "lines": lambda path, table: path.write_text("".join(json.dumps(row) + "\n" for row in table)),
    "array": lambda path, table: path.write_text(json.dumps(table, indent=1)),
}


@pytest.mark.parametrize("names", NAMES)
@pytest.mark.parametrize("way", WAYS)
def test_columns_are_read_by_name_and_unit(tmp_path: Path, names: str, way: str) -> None:
    path = tmp_path / "drive"
    WAYS[way](path, rows(names, NAMES[names]))
    sips = [row for row in decode(path) if row["type"] == "SIP"]
    assert len(sips) == len(DRIVE.steps)
    for row, (t, place, heading, ranges) in zip(sips, DRIVE.steps, strict=True):
        assert row["t"] == pytest.approx(t, abs=1e-3)
        assert (row["x_mm"], row["y_mm"]) == pytest.approx(place, abs=1)
        assert row["heading_deg"] == pytest.approx(math.degrees(heading), abs=0.1)
        assert row["sonar"] == {str(k): pytest.approx(ranges[k], abs=1) for k in range(8)}
    assert sips[50]["vel_left_mm_s"] == pytest.approx(250, abs=30)
    assert run("faults", path).stdout.decode().startswith("nothing wrong: 8 of 8")


def test_a_sonar_that_lies_is_found_in_a_table(tmp_path: Path) -> None:
    table = rows("t_s x_m y_m heading_rad sonar_#_m 0", (1.0, 1.0, 1.0, 1.0))
    for row in table[50:]:
        row["sonar_2_m"] = 0.7
    told = run("faults", as_csv(tmp_path / "a.csv", table)).stdout.decode()
    assert "sonar/front/02" in told
    assert told.count("sonar/") == 1


def test_nested_keys_and_lists_are_flat(tmp_path: Path) -> None:
    records = [
        {
            "time": t - START,
            "pose": {"x": place[0] / 1000, "y": place[1] / 1000, "yaw": h},
            "ranges": ranges[:8],
        }
        for t, place, h, ranges in DRIVE.steps
    ]
    path = tmp_path / "a.json"
    path.write_text("".join(json.dumps(record) + "\n" for record in records))
    sips = [row for row in decode(path) if row["type"] == "SIP"]
    assert sips[-1]["sonar"]["7"] == round(min(NO_ECHO_MM, DRIVE.steps[-1][3][7]))
    assert sips[-1]["x_mm"] == pytest.approx(DRIVE.steps[-1][1][0], abs=1)


def test_what_decode_prints_is_read_again(tmp_path: Path) -> None:
    first = as_csv(tmp_path / "a.csv", rows("t_s x_m y_m heading_rad sonar_#_m 0", (1.0, 1.0, 1.0, 1.0)))
    sips = [row for row in decode(first) if row["type"] == "SIP"]
    for name, option in (("b.csv", "--csv"), ("b.jsonl", "--json")):
        (tmp_path / name).write_bytes(run("decode", first, option, "--type", "SIP").stdout)
        again = [row for row in decode(tmp_path / name) if row["type"] == "SIP"]
        keys = ("x_mm", "y_mm", "heading_deg", "sonar", "vel_left_mm_s", "t")
        assert [[row[key] for key in keys] for row in again] == [[row[key] for key in keys] for row in sips]


def test_other_packets_may_stand_before_the_first_ring() -> None:
    """As in what decode prints of a whole session: SYNC replies and CONFIGpacs first."""
    ring = json.loads('{"t": 0.0, "type": "SIP", "sonar": {"0": 1500, "1": 1600}}')
    heads = [
        {"t": 0.0, "type": "SYNC2", "subclass": "p3dx-sh"},
        {"t": 0.0, "type": "CONFIGPAC", "limits": {"vel": 750}},
    ]
    for text in (
        "\n".join(map(json.dumps, [*heads, ring])),
        json.dumps([*heads, ring], indent=1),
    ):
        assert find_format(text.encode()).name == "range-json"
    assert find_format(json.dumps({"t": 0.0, "dir": "r2c", "hex": "FAFB"}).encode()).name == "jsonl"


def test_rows_out_of_order_and_torn_rows_are_told(tmp_path: Path) -> None:
    path = as_csv(tmp_path / "a.csv", rows("t_s x_m y_m heading_rad sonar_#_m 0", (1.0, 1.0, 1.0, 1.0)))
    lines = path.read_text().splitlines()
    lines[20], lines[22] = lines[22], lines[20]
    lines[30] = lines[30][:20]
    path.write_text("\n".join(lines) + "\n")
    done = run("faults", path)
    assert "line 31: 2 cells, but 12 headings" in done.stderr.decode()
    assert "discarded: 2 x row that is not newer than the last" in done.stderr.decode()
    assert run("faults", path, "--strict").returncode == 1


def test_more_ranges_than_sonars_are_refused(tmp_path: Path) -> None:
    table = [{"t": n / 10, **{f"sonar_{k}": 1000.0 for k in range(24)}} for n in range(20)]
    done = run("faults", as_csv(tmp_path / "a.csv", table))
    assert done.returncode == 2
    assert "a range of sonar 23, but p3dx-sh has 16 sonars" in done.stderr.decode()


def test_a_table_without_a_pose_says_so(tmp_path: Path) -> None:
    table = [{"t": n / 10, **{f"sonar_{k}": 1000.0 + n for k in range(8)}} for n in range(20)]
    assert "no columns of a pose" in run("stats", as_csv(tmp_path / "a.csv", table)).stderr.decode()


FOREIGN = {
    **{"Zeit": "t_ms", "odo 1": "x_m", "odo 2": "y_m", "Kurs": "heading_rad"},
    **{f"US{k:02}.w": f"sonar_{k}_mm" for k in range(8)},
}


@pytest.mark.parametrize("way", ["csv", "json"])
def test_columns_of_any_name_are_named_by_the_user(tmp_path: Path, way: str) -> None:
    own = rows("t_ms x_m y_m heading_rad sonar_#_mm 0", (1e3, 1.0, 1.0, 1e3))
    names = {meaning: name for name, meaning in FOREIGN.items()}
    foreign = [{names[key]: value for key, value in row.items()} for row in own]

    def write(path: Path, table: list[dict[str, float]]) -> Path:
        if way == "csv":
            return as_csv(path, table)
        path.write_text("\n".join(map(json.dumps, table)) + "\n")
        return path

    told = ",".join(f"{meaning}={name}" for name, meaning in FOREIGN.items())
    theirs = write(tmp_path / f"theirs.{way}", foreign)
    here = decode(write(tmp_path / f"own.{way}", own))
    assert decode(theirs, "--columns", told) == here
    first, rest = told.split(",", 1)
    assert decode(theirs, "--columns", first, "--columns", rest) == here
    assert run("stats", theirs).returncode == 2


@pytest.mark.parametrize(
    ("told", "why"),
    [
        ("t_s=nowhere", "no such column; name one of Zeit"),
        ("voltage=Zeit", "give NAME=COLUMN"),
        ("t_s", "give NAME=COLUMN"),
        ("x_m=odo 1", "no columns of time and ranges"),
    ],
)
def test_what_no_column_is_is_refused(tmp_path: Path, told: str, why: str) -> None:
    names = {meaning: name for name, meaning in FOREIGN.items()}
    own = rows("t_ms x_m y_m heading_rad sonar_#_mm 0", (1e3, 1.0, 1.0, 1e3))
    foreign = [{names[key]: value for key, value in row.items()} for row in own]
    done = run("stats", as_csv(tmp_path / "a.csv", foreign), "--columns", told)
    assert done.returncode == 2
    assert why in done.stderr.decode()
