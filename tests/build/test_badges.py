# SPDX-License-Identifier: MIT
"""Rule: what a badge of the README says is what the project's files say."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BADGE = re.compile(r"\[!\[([^\]]+)\]\(https://img\.shields\.io/badge/(\w+)-([\w.+]+)-blue\)\]\(([^)]+)\)")


def badges() -> dict[str, str]:
    found = BADGE.findall((ROOT / "README.md").read_text(encoding="utf-8"))
    assert all((ROOT / file).is_file() for _, _, _, file in found)
    return {name: value for _, name, value, _ in found}


def one(file: str, pattern: str) -> str:
    found = re.search(pattern, (ROOT / file).read_text(encoding="utf-8"), re.MULTILINE)
    assert found is not None, (file, pattern)
    return found[1]


def test_badges_are_true() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert badges() == {
        "version": one("firmware/include/argus/argus.h", r"^#define ARGUS_VERSION \"([\d.]+)\""),
        "licence": one("LICENSE", r"^(\w+) License"),
        "C": one("CMakeLists.txt", r"CMAKE_C_STANDARD (\d+)"),
        "python": project["requires-python"].removeprefix(">=") + "+",
    }
    assert project["license"]["text"] == badges()["licence"]
