# SPDX-License-Identifier: MIT
"""Rule: a build for 8, 16, 24 or 32 sonars drives robots with fewer and with more; those beyond are left out."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SUPPORT = ROOT / "tests/unit/support"
HAS = {"p3dx-sh": 16, "p3at-sh": 16, "amigo-sh": 8, "peoplebot-sh": 32}


@pytest.mark.soak
# Each compiles all of firmware/: the least and the most show what leaves an array, and every other test has 16.
@pytest.mark.parametrize(
    ("most", "sanitized"),
    [(8, False), (32, True), *(pytest.param(most, True, marks=pytest.mark.wide) for most in (16, 24))],
)
def test_robots_of_every_size_in_builds_of_every_size(most: int, sanitized: bool, tmp_path: Path) -> None:
    program = tmp_path / "sonars"
    sources = [str(path) for path in sorted((ROOT / "firmware").rglob("*.c"))]
    command = [
        "cc",
        "-std=gnu11",
        "-O0",
        "-Wall",
        "-Wextra",
        "-Werror",
        f"-DARGUS_SONARS={most}",
        "-DARGUS_ASSERTS",
    ]
    if sanitized:
        command += ["-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
    command += [f"-I{ROOT / 'firmware'}", f"-I{ROOT / 'firmware/include'}", f"-I{SUPPORT}"]
    command += [str(ROOT / "tests/core/sonars.c"), str(SUPPORT / "robot.c"), *sources, "-lm"]
    subprocess.run([*command, "-o", str(program)], check=True, timeout=600)
    done = subprocess.run([str(program)], check=True, capture_output=True, text=True, timeout=600)
    rows = [line.split() for line in done.stdout.splitlines()]
    assert [row[0] for row in rows] == list(HAS)
    for name, *figures in rows:
        managed, reached, healthy, disabled, absent, right, beyond, broken = map(int, figures)
        assert managed == min(HAS[name], most), name
        assert reached == 1, name
        assert (healthy, disabled, right) == (managed - 1, 1, 1), name
        assert absent == most - managed, name
        assert beyond == (HAS[name] > most), name
        assert broken == 0, name
