# SPDX-License-Identifier: MIT
"""Coverage below its floor fails the stage, of all files and of one by itself; nothing measured is no success."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest
from devtool import coverage
from devtool.base import VENV
from devtool.coverage import File, Reached
from devtool.stages import StageFailed

ALL = File("firmware/a.c", Reached(10, 10), Reached(10, 10))


def test_all_reached_is_told_in_one_line() -> None:
    """What is reached is in the note of the stage; MC/DC only where a compiler counted it."""
    assert coverage.judge([ALL]) == "firmware/: lines 100.00 %, branches 100.00 %"
    with_mcdc = File("firmware/a.c", Reached(10, 10), Reached(10, 10), Reached(999, 1000))
    assert coverage.judge([with_mcdc]).endswith("mcdc 99.90 %")


@pytest.mark.parametrize(
    ("lines", "branches", "mcdc", "told"),
    [
        (50, 100, 100, "lines of all: 75.00 %"),
        (100, 50, 100, "branches of all: 75.00 %"),
        (100, 100, 10, "mcdc of all: 55.00 %"),
    ],
)
def test_too_little_of_all_fails(
    lines: int, branches: int, mcdc: int, told: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each measure has its own floor."""
    least = {"lines": 90.0, "branches": 90.0, "mcdc": 60.0, "branches_of_a_file": 0.0}
    monkeypatch.setattr(coverage, "floors", lambda: least)
    full = File("firmware/a.c", Reached(100, 100), Reached(100, 100), Reached(100, 100))
    poor = File("firmware/b.c", Reached(lines, 100), Reached(branches, 100), Reached(mcdc, 100))
    with pytest.raises(StageFailed, match=told):
        coverage.judge([full, poor])


def test_one_poor_file_among_many_fails() -> None:
    """A new source without tests is not hidden by thousands of tested lines."""
    many = File("firmware/a.c", Reached(9000, 9000), Reached(9000, 9000))
    new = File("firmware/new.c", Reached(9, 9), Reached(1, 10))
    with pytest.raises(StageFailed, match=r"branches of firmware/new\.c: 10\.00 %"):
        coverage.judge([many, new])


def test_nothing_measured_fails() -> None:
    """A run that counted nothing has shown nothing."""
    with pytest.raises(StageFailed, match="nothing was measured"):
        coverage.judge([])
    with pytest.raises(StageFailed, match="nothing was measured"):
        coverage.judge_hal([ALL])


def test_lines_of_hal_have_a_floor_of_their_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the firmware's tests reach says nothing of hal/."""
    monkeypatch.setattr(coverage, "floors", lambda: {"hal_lines": 95.0})
    hal = File("hal/linux/a.c", Reached(95, 100), Reached(1, 100))
    assert coverage.judge_hal([ALL, hal]) == "hal/: lines 95.00 %"
    with pytest.raises(StageFailed, match=r"lines of hal/: 94\.50 %"):
        coverage.judge_hal([ALL, hal, File("hal/linux/b.c", Reached(94, 100), Reached(1, 1))])


def test_floors_are_near_what_is_promised() -> None:
    """The floors are percentages, and none is so low that it holds nothing."""
    floors = coverage.floors()
    assert set(floors) == {"lines", "branches", "branches_of_a_file", "mcdc", "hal_lines"}
    assert all(50.0 <= value <= 100.0 for value in floors.values())


def test_table_has_the_worst_first_and_leaves_out_what_is_whole() -> None:
    """Who adds tests begins where most is missed."""
    little = File("firmware/little.c", Reached(9, 10), Reached(10, 10))
    much = File("firmware/much.c", Reached(1, 10), Reached(1, 10))
    rows = list(coverage.table([ALL, little, much]))
    assert [row.split()[-1] for row in rows[1:]] == ["firmware/much.c", "firmware/little.c", "all"]


def test_counts_of_gcc_are_those_of_the_lines(tmp_path: Path) -> None:
    """gcovr's summary is read as it is written: a branch that is not taken is one missed of two."""
    source = tmp_path / "firmware/one.c"
    source.parent.mkdir()
    source.write_text(
        "int main(int count, char **words)\n{\n    if (words && count > 1)\n        return 1;\n    return 0;\n}\n"
    )
    subprocess.run(["gcc", "--coverage", "-O0", "-o", "one", source], cwd=tmp_path, check=True)
    subprocess.run(["./one"], cwd=tmp_path, check=True)
    gcovr: list[str | Path] = [VENV / "bin/gcovr", "--root", tmp_path, "--json-summary", "summary.json"]
    subprocess.run(gcovr, cwd=tmp_path, check=True)
    (one,) = json.loads((tmp_path / "summary.json").read_text())["files"]
    found = coverage.file_of_gcovr(one)
    assert (found.name, found.lines, found.branches) == ("firmware/one.c", Reached(3, 4), Reached(2, 4))


def test_a_clang_too_old_is_none(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Where no compiler counts MC/DC, the stage is skipped with a word that tells what to install."""
    (tmp_path / "clang").write_text("#!/bin/sh\necho Debian clang version 14.0.6\n")
    (tmp_path / "clang").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    coverage.modern_clang.cache_clear()
    assert coverage.modern_clang() is None
    assert "apt install" in coverage.mcdc_stage(lambda _command: pytest.fail("nothing is to be run"))
    coverage.modern_clang.cache_clear()


def test_sources_have_the_names_of_the_tree_by_llvm_too() -> None:
    """It puts the folder of the build before them."""
    summary = {measure: {"covered": 3, "count": 4} for measure in ("lines", "branches", "mcdc")}
    told = coverage.file_of_llvm({"filename": "build/mcdc/firmware/arcos/sip.c", "summary": summary})
    assert told == File("firmware/arcos/sip.c", Reached(3, 4), Reached(3, 4), Reached(3, 4))
