# SPDX-License-Identifier: MIT
"""Rule: a measured figure stands in a result file, and the documents say what that file says."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import figures  # noqa: E402


def test_the_documents_agree_with_the_files() -> None:
    command = [sys.executable, str(ROOT / "tools/figures.py"), "--check"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    copied = tmp_path / "figures"
    copied.mkdir()
    for path in figures.FOLDER.glob("*.json"):
        (copied / path.name).write_bytes(path.read_bytes())
    monkeypatch.setattr(figures, "FOLDER", copied)
    monkeypatch.setattr(figures, "ROOT", tmp_path)
    return copied


def test_another_figure_is_another_text(folder: Path) -> None:
    page = (ROOT / "README.md").read_text(encoding="utf-8")
    assert figures.filled("README.md", page) == page
    found = json.loads((folder / "journey.json").read_text())
    for row in found["rows"]:
        row["truly"]["hits"] = 987
    (folder / "journey.json").write_text(json.dumps(found))
    assert "987 of" in figures.filled("README.md", page)


@pytest.mark.parametrize("text", ["", "{", "[]", '{"rows": [{"driver": "argus"}]}'])
def test_a_damaged_file_is_named(folder: Path, text: str) -> None:
    (folder / "journey.json").write_text(text)
    with pytest.raises(SystemExit, match=r"journey\.json"):
        figures.filled("README.md", (ROOT / "README.md").read_text(encoding="utf-8"))


def test_a_page_without_the_part_is_named(folder: Path) -> None:
    assert folder.is_dir()
    with pytest.raises(SystemExit, match="no part journeys"):
        figures.filled("README.md", "# Argus\n")


def test_figures_entered_by_hand_have_a_day_and_a_command_and_are_shown() -> None:
    entries = figures.load("measured.json")
    shown = {
        make.args[0]
        for parts in figures.PARTS.values()
        for _, make in parts.values()
        if hasattr(make, "args")
    }
    assert set(entries) == shown
    for name, entry in entries.items():
        assert re.fullmatch(r"20\d\d-\d\d-\d\d", entry["date"]), name
        assert "command" in entry or "by" in entry["columns"], name
        assert entry["date"] in figures.measured(name, entries)


def test_a_row_with_a_cell_too_few_is_named(folder: Path) -> None:
    found = json.loads((folder / "measured.json").read_text())
    found["monitor"]["rows"][0].pop()
    (folder / "measured.json").write_text(json.dumps(found))
    with pytest.raises(SystemExit, match=r"measured\.json"):
        figures.filled("docs/monitor.md", (ROOT / "docs/monitor.md").read_text(encoding="utf-8"))


def test_another_pair_is_another_table_and_another_sum(folder: Path) -> None:
    found = json.loads((folder / "pairs.json").read_text())
    told = figures.pairs_told(found)
    assert (
        f"tells {sum(cell == 'yes' for row in found['paper'].values() for cell in row.values())} right"
        in told
    )
    found["paper"]["1"]["2"] = "convicts 5"
    assert "| 1 |  | convicts 5 |" in figures.pairs_paper(found)
    assert figures.pairs_told(found) != told
    found["argus"]["plain"]["pairs"] = {"yes": 28, "not found": 2}
    assert "| all pairs, seed 1 | 28 of 30 | 2 not found |" in figures.pairs_argus(found)


def test_a_picture_of_other_figures_is_out_of_date_and_drawn_anew(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder.parent / "docs/img").mkdir(parents=True)
    assert figures.draw_pictures(check=True) == 1
    assert figures.draw_pictures(check=False) == 0
    assert figures.draw_pictures(check=True) == 0
    capsys.readouterr()
    found = json.loads((folder / "journey.json").read_text())
    found["rows"][1]["truly"]["share"] = 0.5
    (folder / "journey.json").write_text(json.dumps(found))
    assert figures.draw_pictures(check=True) == 1
    assert "docs/img/journey.png: out of date" in capsys.readouterr().err
