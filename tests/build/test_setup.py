# SPDX-License-Identifier: MIT
"""Rule: one set-up or build at a time in a folder, and who waits is told for whom."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from devtool import setup
from devtool.base import Stop

ROOT = Path(__file__).resolve().parents[2]
HOLDER = """
import sys
sys.path.insert(0, sys.argv[1])
from pathlib import Path
from devtool import setup
setup.BUILD = Path(sys.argv[2])
sys.argv[1:] = ["build", "two words"]
with setup.alone():
    print("held", flush=True)
    sys.stdin.readline()
"""


def start(build: Path) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", HOLDER, str(ROOT / "tools"), str(build)]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def test_who_waits_is_told_for_whom(tmp_path: Path) -> None:
    with start(tmp_path) as first:
        assert first.stdout is not None
        assert first.stdout.readline() == "held\n"
        with start(tmp_path) as second:
            assert second.stdout is not None
            said = second.stdout.readline()
            assert said == (
                f"dev: waiting for another tools/dev in this folder: process {first.pid}, "
                "tools/dev build 'two words'\n"
            )
            first.communicate("\n")
            assert second.stdout.readline() == "held\n"
            second.communicate("\n")


def test_what_one_that_was_killed_left_is_not_believed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with start(tmp_path) as killed:
        assert killed.stdout is not None
        killed.stdout.readline()
        killed.kill()
    assert str(killed.pid) in (tmp_path / ".dev-lock").read_text()
    monkeypatch.setattr(setup, "BUILD", tmp_path)
    with setup.alone():
        assert str(killed.pid) not in (tmp_path / ".dev-lock").read_text()
    assert (tmp_path / ".dev-lock").read_text() == ""
    assert capsys.readouterr().out == ""


def test_a_fresh_environment_is_made_first(tmp_path: Path) -> None:
    fresh, again = setup.install_steps(True), setup.install_steps(False)
    assert fresh[1:] == again
    assert list(fresh[0])[1:3] == ["-m", "venv"]
    assert all("pip" in step for step in again)


def test_a_step_that_fails_shows_the_end_of_its_log(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(setup, "LOGS", tmp_path)
    script = "for i in range(9): print('line', i)\nraise SystemExit(1)"
    with pytest.raises(Stop, match=r"failed; the end of .*:\n  line 4\n(?s:.*)line 8$") as caught:
        setup.run_steps([[sys.executable, "-c", script]], tmp_path / "python.log")
    assert caught.value.code == 3
    assert "line 3" not in str(caught.value)
