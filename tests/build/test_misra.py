# SPDX-License-Identifier: MIT
"""A hit of a MISRA rule without a deviation fails, and so does one outside of the files that the deviation names."""

from __future__ import annotations

from pathlib import Path

import pytest
from devtool import misra
from devtool.base import ROOT
from devtool.stages import StageFailed

PAGE = misra.PAGE.read_text(encoding="utf-8")
LISTED = misra.deviations(PAGE)


def test_each_row_of_the_page_is_read() -> None:
    """A row that is laid out otherwise would allow nothing, or anything."""
    rows = [line for line in PAGE.splitlines() if line.startswith("| ") and line[2].isdigit()]
    assert len(rows) == len(LISTED) > 20


def test_a_row_without_a_reason_is_none() -> None:
    """A deviation has a reason."""
    assert misra.deviations("| 15.5 | one return | all |  |\n") == {}


def test_the_files_that_the_page_names_are_there() -> None:
    """A deviation for a file that is gone would wait for the next one of that name."""
    named = {file for where in LISTED.values() for file in where if file != misra.EVERYWHERE}
    assert sorted(file for file in named if not (ROOT / "firmware" / file).exists()) == []


def test_what_is_not_listed_is_found() -> None:
    """By its rule, and by its place."""
    allowed = {"15.5": frozenset({"all"}), "1.4": frozenset({"robot/make.c"})}
    hits = [
        ("robot/make.c", 3, "1.4"),
        ("robot/robot.c", 4, "15.5"),
        ("robot/robot.c", 5, "1.4"),
        ("a.c", 6, "17.2"),
    ]
    assert misra.beyond(hits, allowed) == ["firmware/robot/robot.c:5: rule 1.4", "firmware/a.c:6: rule 17.2"]


def test_a_hit_is_counted_once() -> None:
    """A header is reported with each source that includes it; other lines of the checker are no hits."""
    line = "firmware/include/argus/argus.h:744:misra-c2012-19.2"
    assert misra.hits_of([line, line, "nofile:0:missingIncludeSystem", ""]) == [
        ("include/argus/argus.h", 744, "19.2")
    ]


def test_a_checker_that_finds_nothing_has_not_run(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """An addon that is missing would make every source clean."""
    monkeypatch.setattr(misra, "CHECKER", ("true",))
    monkeypatch.setattr(misra, "BUILD", tmp_path)
    with pytest.raises(StageFailed, match="did not run"):
        misra.misra(lambda _command: None)
