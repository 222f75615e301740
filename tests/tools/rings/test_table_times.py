# SPDX-License-Identifier: MIT
"""Rule: of a table, too, whatever its clock does is corrected and reported, and gives no silence of the link."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable
from pathlib import Path

import pytest
from logs import ROOT, run

SAMPLE = ROOT / "docs/samples/two-failing-sonars.rec.gz"
CLOCKS: dict[str, tuple[Callable[[float], float], str]] = {
    "steps of 5 s": (lambda s: s // 5 * 5, "gives steps of 5 s"),
    "stands, right again": (lambda s: 30.0 if 30 <= s < 55 else s, "stands at"),
    "stands, set ahead": (lambda s: 30.0 if 30 <= s < 55 else s + 3600 * (s >= 55), "stands at"),
    "falls": (lambda s: s + 9000 - 3600 * (s > 70), "the clock falls by"),
    "below zero": (lambda s: s - 400.25, "times begin at -"),
}


@pytest.mark.parametrize("form", ["csv", "json"])
@pytest.mark.parametrize("clock", CLOCKS)
def test_the_answer_is_that_of_a_good_clock(clock: str, form: str, tmp_path: Path) -> None:
    time_of, words = CLOCKS[clock]
    rows = list(csv.DictReader(io.StringIO(run("decode", SAMPLE, "--csv", "--type", "SIP").stdout.decode())))
    begin = float(rows[0]["t"])
    for row in rows:
        row["t"] = f"{time_of(float(row['t']) - begin):.6f}"
    path = tmp_path / f"table.{form}"
    with path.open("w", encoding="utf-8") as file:
        if form == "csv":
            writer = csv.DictWriter(file, list(rows[0]))
            writer.writeheader()
            writer.writerows(rows)
        else:
            file.writelines(json.dumps(row) + "\n" for row in rows)
    done = run("faults", path)
    told = done.stdout.decode()
    assert words in done.stderr.decode()
    assert done.returncode == 1
    assert "sonar/front/03" in told.splitlines()[0], told
    assert "sonar/front/06 suspect" in told, told
    assert "14 of 16 sonars healthy" in told
    assert "LINK_LOST" not in told
