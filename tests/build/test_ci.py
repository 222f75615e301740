# SPDX-License-Identifier: MIT
"""Rule: .ci/run runs all of its steps whatever fails, tells which failed, and fails with them; in the nightly runs
what computes for long and nothing else, and no push ends it. Every action is pinned by the hash of its commit."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PINNED = re.compile(r"[\w.-]+(/[\w.-]+)+@[0-9a-f]{40}")


@pytest.mark.parametrize(
    ("failing", "code", "said"),
    [
        ("", 0, ""),
        ("test", 1, "ci: failed: test\n"),
        ("lint", 1, "ci: failed: lint\n"),
        ("test lint", 1, "ci: failed: test lint\n"),
    ],
)
def test_all_steps_run(tmp_path: Path, failing: str, code: int, said: str) -> None:
    for folder in (".ci", "tools"):
        (tmp_path / folder).mkdir()
    shutil.copy(ROOT / ".ci/run", tmp_path / ".ci/run")
    dev = tmp_path / "tools/dev"
    dev.write_text(f'#!/bin/sh\necho "$@"\nfor name in {failing}; do [ "$name" != "$1" ] || exit 3; done\n')
    dev.chmod(0o755)
    done = subprocess.run([tmp_path / ".ci/run"], cwd="/", capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr, done.returncode) == ("test\nlint\n", said, code)


def test_the_nightly_is_apart_from_what_a_push_starts() -> None:
    text = (ROOT / ".github/workflows/ci.yml").read_text(encoding="utf-8")
    head, _, tail = text.partition("\njobs:\n")
    assert re.search(r"^  group: .*\$\{\{ github\.event_name \}\}", head, re.MULTILINE)
    jobs = re.split(r"^  (\w+):\n", tail, flags=re.MULTILINE)[1:]
    conditions = {
        name: re.findall(r"^    if: (.*)$", body, re.MULTILINE)
        for name, body in zip(jobs[::2], jobs[1::2], strict=True)
    }
    nightly = conditions.pop("soak")
    assert nightly == ["github.event_name == 'schedule'"]
    assert conditions
    assert all(found == ["github.event_name != 'schedule'"] for found in conditions.values()), conditions


def unpinned(text: str) -> list[str]:
    """Return the actions that a workflow uses by a name that may come to mean something else."""
    used = re.findall(r"^ *(?:- )?uses: *(\S+)", text, re.MULTILINE)
    return [one for one in used if not one.startswith("./") and not PINNED.fullmatch(one)]


def test_every_action_is_pinned_by_the_hash_of_its_commit() -> None:
    files = sorted((ROOT / ".github").rglob("*.y*ml"))
    texts = {path.name: path.read_text(encoding="utf-8") for path in files}
    assert any("uses:" in text for text in texts.values())
    assert {name: unpinned(text) for name, text in texts.items() if unpinned(text)} == {}


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("      - uses: actions/checkout@11bd71901bbe5b1630ceea73d27597364c9af683 # v4.2.2", []),
        ("        uses: a/b/c@11bd71901bbe5b1630ceea73d27597364c9af683", []),
        ("      - uses: ./.github/actions/own", []),
        ("      - uses: actions/checkout@v4", ["actions/checkout@v4"]),
        ("      - uses: actions/checkout", ["actions/checkout"]),
        ("        uses: a/b@11bd719 # v4.2.2", ["a/b@11bd719"]),
    ],
)
def test_a_name_that_may_move_is_found(line: str, found: list[str]) -> None:
    assert unpinned(f"jobs:\n{line}\n") == found
