# SPDX-License-Identifier: MIT
"""Rule: a measured figure stands in a result file, and the documents say what that file says."""

from __future__ import annotations

import json
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
