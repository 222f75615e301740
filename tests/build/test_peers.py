# SPDX-License-Identifier: MIT
"""Rule: the stage `peers` runs what sources are given for, and says what it skips; nothing of the vendor's is here."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from devtool import peer_runs, peers
from devtool.base import Command

ROOT = Path(__file__).resolve().parents[2]


def run_with(monkeypatch: pytest.MonkeyPatch, **given: str) -> tuple[str | None, list[list[str]]]:
    done: list[list[str]] = []
    monkeypatch.setattr(peers, "build", lambda preset, run: None)
    for name in peers.SOURCES:
        monkeypatch.delenv(name, raising=False)
    for name, value in given.items():
        monkeypatch.setenv(name, value)

    def run(command: Command) -> None:
        done.append([str(word) for word in command])

    return peers.peers(run), done


def test_without_sources_it_is_skipped_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    note, done = run_with(monkeypatch)
    assert note is not None
    assert "ARIA_SOURCE=FOLDER and MOBILESIM_SOURCE=FOLDER" in note
    assert not done


def test_what_is_given_is_run_and_the_rest_told(monkeypatch: pytest.MonkeyPatch) -> None:
    note, (words,) = run_with(monkeypatch, ARIA_SOURCE="/a")
    assert words[1:] == [str(ROOT / "tools/devtool/peer_runs.py"), "ARIA_SOURCE=/a"]
    assert note is not None
    assert "MOBILESIM_SOURCE=FOLDER" in note
    assert "ARIA_SOURCE" not in note
    note, (words,) = run_with(monkeypatch, ARIA_SOURCE="/a", MOBILESIM_SOURCE="/m")
    assert words[2:] == ["ARIA_SOURCE=/a", "MOBILESIM_SOURCE=/m"]
    assert note is None


def test_mobilesim_alone_is_told_to_need_aria(capsys: pytest.CaptureFixture[str]) -> None:
    assert peer_runs.main(["MOBILESIM_SOURCE=/nowhere"]) == 1
    assert "give ARIA_SOURCE= as well" in capsys.readouterr().out


def test_sources_are_built_in_a_copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    source = tmp_path / "source"
    source.mkdir()
    (source / "Makefile").write_text("all:\n")
    (source / "old.o").write_text("")
    copy = peer_runs.cache("aria", source)
    assert copy.is_relative_to(tmp_path / "cache")
    assert [path.name for path in copy.iterdir()] == ["Makefile"]


def test_nothing_of_the_vendors_is_kept_here() -> None:
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False).stdout
    assert not [name for name in listed.splitlines() if name.endswith((".cc", ".cpp", ".hh"))]
