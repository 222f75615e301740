# SPDX-License-Identifier: MIT
"""Rule: a name on disk is its living owner's, who is told of; one that a dead program left is anybody's."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from test_cli import simulator

from hil_sim.claim import Claim
from hil_sim.cli.main import main
from hil_sim.errors import SimError

ROUNDS = 5
RIVALS = 6
RIVAL = """
import sys
from pathlib import Path
from hil_sim.claim import Claim
from hil_sim.errors import SimError
try:
    claim = Claim(Path(sys.argv[1]), "--link-name")
    print("mine", flush=True)
except SimError as error:
    print(error, flush=True)
sys.stdin.read()
"""


def test_a_second_emulator_does_not_take_the_name_of_a_living_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    link = tmp_path / "robot"
    with simulator("--world", "demo", "--link-name", str(link)) as (process, _):
        before = link.readlink()
        assert main(["--world", "demo", "--link-name", str(link)]) != 0
        said = capsys.readouterr().err
        assert f"process {process.pid} has it" in said, said
        assert link.readlink() == before
        process.send_signal(signal.SIGTERM)
        process.wait()
    assert list(tmp_path.iterdir()) == []


def test_what_a_dead_emulator_left_is_replaced(tmp_path: Path) -> None:
    link = tmp_path / "robot"
    with simulator("--world", "demo", "--link-name", str(link)) as (process, _):
        process.send_signal(signal.SIGKILL)
        process.wait()
    left = link.readlink()
    assert (tmp_path / "robot.lock").exists()
    with simulator("--world", "demo", "--link-name", str(link)) as (process, _):
        assert link.is_symlink()
        assert link.exists(), f"it still leads to {left}"
        process.send_signal(signal.SIGTERM)
        process.wait()
    assert list(tmp_path.iterdir()) == []


def test_of_rivals_at_once_one_gets_it_and_the_others_name_that_one(tmp_path: Path) -> None:
    for _ in range(ROUNDS):
        with contextlib.ExitStack() as stack:
            rivals = [
                stack.enter_context(
                    subprocess.Popen(
                        [sys.executable, "-c", RIVAL, str(tmp_path / "robot")],
                        stdin=subprocess.PIPE,
                        stdout=subprocess.PIPE,
                        text=True,
                    )
                )
                for _ in range(RIVALS)
            ]
            said = [rival.stdout.readline().strip() for rival in rivals if rival.stdout]
            winners = [rival.pid for rival, line in zip(rivals, said, strict=True) if line == "mine"]
            assert len(winners) == 1, said
            named = {int(number) for line in said for number in re.findall(r"process (\d+) has it", line)}
            assert named == set(winners), said


def test_a_claim_that_was_given_back_is_free(tmp_path: Path) -> None:
    path = tmp_path / "robot"
    first = Claim(path, "--link-name")
    with pytest.raises(SimError, match=f"process {os.getpid()} has it"):
        Claim(path, "--link-name")
    first.release()
    assert list(tmp_path.iterdir()) == []
    second = Claim(path, "--link-name")
    first.release()
    with pytest.raises(SimError, match="has it"):
        Claim(path, "--link-name")
    second.release()


def test_a_lock_that_is_a_symlink_is_not_followed(tmp_path: Path) -> None:
    target = tmp_path / "precious"
    (tmp_path / "robot.lock").symlink_to(target)
    with pytest.raises(SimError, match=r"robot\.lock"):
        Claim(tmp_path / "robot", "--link-name")
    assert not target.exists()
