# SPDX-License-Identifier: MIT
"""Rule: the demo's judge is content with any seed and with faults that the README does not use."""

from __future__ import annotations

import json
import shlex
import signal
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import pytest
from harness import ARGUSD, PATIENCE_S, PYTHON, ROOT, HilFailure

DEFAULT = "off:3,wrong:6"
LONGEST_S = 1200.0


def command(out: Path, seed: int, faults: str, profile: str, world: str | None) -> list[str]:
    """The demo as a user calls it; None: in the world that it drives through by itself."""
    words = [str(PYTHON), "-m", "hil_sim.demo", "--json", "--seed", str(seed)]
    words += ["--out", str(out), "--argusd", str(ARGUSD)]
    words += [] if faults == DEFAULT else ["--fail", faults]
    words += [] if world is None else ["--world", world]
    return words if profile == "argus" else [*words, "--profile", profile]


@contextmanager
def started(commands: Sequence[list[str]], folder: Path) -> Iterator[list[subprocess.Popen[bytes]]]:
    """Run drives side by side; they mostly wait. Whatever happens, none is left behind."""
    drives: list[subprocess.Popen[bytes]] = []
    try:
        for k, words in enumerate(commands):
            with (folder / f"{k}.json").open("wb") as out, (folder / f"{k}.err").open("wb") as err:
                drives.append(
                    subprocess.Popen(words, stdout=out, stderr=err, stdin=subprocess.DEVNULL, cwd=ROOT)
                )
        yield drives
    finally:
        for drive in drives:
            if drive.poll() is None:
                drive.send_signal(signal.SIGINT)
        for drive in drives:
            try:
                drive.wait(PATIENCE_S)
            except subprocess.TimeoutExpired:
                drive.kill()
                drive.wait()


def complaint(words: list[str], code: int, stem: Path) -> str:
    """Why a drive failed, and how to make it again."""
    said = stem.with_suffix(".json").read_text(encoding="utf-8")
    try:
        rules = json.loads(said).get("rules", said)
    except ValueError:
        rules = said
    err = stem.with_suffix(".err").read_text(encoding="utf-8", errors="replace")[-600:]
    return f"exit {code}: {shlex.join(words)}\n  rules: {rules}\n  said: {err}"


def judge(drives: Sequence[tuple[int, str]], folder: Path, profile: str, world: str | None = None) -> None:
    """Run the demo for each seed and faults at once; all must end with 0."""
    commands = [
        command(folder / f"drive{k}", seed, faults, profile, world) for k, (seed, faults) in enumerate(drives)
    ]
    with started(commands, folder) as running:
        for words, drive in zip(commands, running, strict=True):
            try:
                drive.wait(LONGEST_S)
            except subprocess.TimeoutExpired:
                raise HilFailure(f"not over within {LONGEST_S:.0f} s: {shlex.join(words)}") from None
    complaints = [
        complaint(words, drive.returncode, folder / str(k))
        for k, (words, drive) in enumerate(zip(commands, running, strict=True))
        if drive.returncode != 0
    ]
    assert not complaints, "\n".join(complaints)


@pytest.mark.long
def test_five_seeds(tmp_path: Path) -> None:
    judge([(seed, DEFAULT) for seed in range(1, 6)], tmp_path, "argus")


@pytest.mark.long
def test_pairs_that_the_paper_cannot_tell(tmp_path: Path) -> None:
    judge([(1, pair) for pair in ("off:5,wrong:3", "off:3,wrong:5")], tmp_path, "argus", "demo")


@pytest.mark.long
def test_the_paper(tmp_path: Path) -> None:
    pairs = (DEFAULT, "off:2,wrong:3", "off:5,wrong:4")
    judge([(1, pair) for pair in pairs], tmp_path, "paper", "demo")
