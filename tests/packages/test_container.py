# SPDX-License-Identifier: MIT
"""Rule: the recipe of the container has no known flaw, copies all that its build reads, and runs as no root."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from packages_help import ROOT, run

RECIPE = (ROOT / "Containerfile").read_text(encoding="utf-8")
HADOLINT = ROOT / ".venv/bin/hadolint"


@pytest.mark.skipif(not HADOLINT.exists(), reason="hadolint has no wheel for this machine")
def test_the_linter_finds_nothing() -> None:
    assert run(HADOLINT, ROOT / "Containerfile") == ""


def test_it_runs_as_no_root_and_is_asked_how_it_does() -> None:
    last = RECIPE[RECIPE.rindex("\nFROM ") :]
    user = re.search(r"^USER (\d+)$", last, re.MULTILINE)
    assert user
    assert int(user[1]) > 0
    assert f"--uid {user[1]} " in last
    assert "HEALTHCHECK" in last


def test_what_it_copies_is_all_that_its_build_reads(tmp_path: Path) -> None:
    build = RECIPE[: RECIPE.rindex("\nFROM ")]
    for line in re.findall(r"^COPY (?!--)(.+)$", build, re.MULTILINE):
        *sources, target = line.split()
        for name in sources:
            source, place = ROOT / name, tmp_path / "src" / target
            if source.is_dir():
                shutil.copytree(source, place)
            else:
                place = place / source.name if target.endswith("/") else place
                place.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(source, place)
    options = re.findall(r"-D\S+", build)
    assert "-DARGUS_ARGUSD=ON" in options
    run("cmake", "-S", tmp_path / "src", "-B", tmp_path / "build", *options, cwd=tmp_path)
    assert "argusd" in run("cmake", "--build", tmp_path / "build", "--target", "help")
