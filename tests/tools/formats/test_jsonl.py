# SPDX-License-Identifier: MIT
"""Rule: records of JSON are read as they stand, in lines or in an array, whatever stands above the first."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from argus_tools.formats import open_log
from forms import CLIENT, COMMANDS, ROBOT, SIPS, joined

RECORDS = [
    {"t": n / 10, "dir": direction, "hex": data.hex()}
    for n, pair in enumerate(zip(SIPS, COMMANDS, strict=True))
    for direction, data in zip(("r2c", "c2r"), pair, strict=True)
]
LINES = "".join(json.dumps(record) + "\n" for record in RECORDS)
ARRAYS = {
    "one line": json.dumps(RECORDS),
    "one line and an end": json.dumps(RECORDS) + "\n",
    "indented": json.dumps(RECORDS, indent=2),
    "a record in a line": "[\n" + ",\n".join(map(json.dumps, RECORDS)) + "\n]\n",
    "carriage returns": json.dumps(RECORDS, indent=1).replace("\n", "\r\n"),
    "braces and quotes in a string": json.dumps([{"note": 'a "}{" \\'}, *RECORDS]),
    "objects in it": json.dumps([{**record, "more": {"a": [{}]}} for record in RECORDS], indent=2),
}
ABOVE = {
    "a comment": "# hall 3, robot 7\n",
    "many comments": "".join(f"# note {n}\n" for n in range(300)),
    "a comment with bytes": "# fa fb 03 00 00 00\n\n",
    "blank lines": "\n\n",
}


def check(path: Path, text: str, damage: int = 0) -> None:
    path.write_text(text, newline="")
    log = open_log(str(path))
    chunks = list(log)
    assert log.format.name == "jsonl"
    assert (joined(chunks, "r2c"), joined(chunks, "c2r")) == (ROBOT, CLIENT)
    assert [chunk.t for chunk in chunks] == [record["t"] for record in RECORDS]
    assert len(log.damage) == damage, log.damage


@pytest.mark.parametrize("name", ARRAYS)
def test_an_array_is_read(name: str, tmp_path: Path) -> None:
    check(tmp_path / "a.json", ARRAYS[name])


def test_a_long_array_is_read_in_pieces(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text(json.dumps(RECORDS * 200, indent=4))
    assert joined(open_log(str(path)), "r2c") == ROBOT * 200


def test_a_record_of_an_array_that_is_none_is_told(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text(json.dumps([RECORDS[0], {"dir": "up", "hex": "00"}, RECORDS[1]], indent=2))
    log = open_log(str(path))
    assert len(list(log)) == 2
    assert [entry.place for entry in log.damage] == ["record 2"]


@pytest.mark.parametrize("name", ABOVE)
def test_what_is_passed_over_may_stand_above(name: str, tmp_path: Path) -> None:
    check(tmp_path / "a.jsonl", ABOVE[name] + LINES)
    check(tmp_path / "b.jsonl", ABOVE[name] + json.dumps(RECORDS))


@pytest.mark.parametrize("title", ["robot seven", "2026-11-25 06:38:47", "// hall 3", "; hall 3"])
def test_a_title_is_told_and_the_records_are_read(title: str, tmp_path: Path) -> None:
    check(tmp_path / "a.jsonl", title + "\n" + LINES, damage=1)
