# SPDX-License-Identifier: MIT
"""Rule: what others build the library from names files that exist, and flags with which all of it compiles."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]


def version() -> str:
    header = (ROOT / "firmware/include/argus/argus.h").read_text(encoding="utf-8")
    match = re.search(r'^#define ARGUS_VERSION "(.+)"$', header, re.MULTILINE)
    assert match is not None
    return match[1]


@pytest.mark.soak
def test_platformio_library(tmp_path: Path) -> None:
    library = json.loads((ROOT / "library.json").read_text(encoding="utf-8"))
    build = library["build"]
    assert library["version"] == version()
    for name in (*library["export"]["include"], build["srcDir"], build["includeDir"]):
        assert (ROOT / name).exists(), name
    assert (ROOT / build["includeDir"] / library["headers"]).exists()
    sources = sorted((ROOT / build["srcDir"]).rglob("*.c"))
    assert len(sources) > 40
    done = subprocess.run(
        ["gcc", "-fsyntax-only", *build["flags"], f"-I{build['includeDir']}", *sources],
        cwd=ROOT,
        check=False,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr


def test_zephyr_module() -> None:
    module = yaml.safe_load((ROOT / "zephyr/module.yml").read_text(encoding="utf-8"))
    assert module["name"] == "argus"
    assert (ROOT / module["build"]["cmake"] / "CMakeLists.txt").exists()
    assert (ROOT / module["build"]["kconfig"]).exists()
    recipe = (ROOT / "zephyr/CMakeLists.txt").read_text(encoding="utf-8")
    for place in re.findall(r"\$\{CMAKE_CURRENT_LIST_DIR\}/([^)*\s]+)", recipe):
        assert (ROOT / "zephyr" / place).exists(), place
    options = re.findall(
        r"^config (\w+)", (ROOT / module["build"]["kconfig"]).read_text(encoding="utf-8"), re.MULTILINE
    )
    used = set(re.findall(r"CONFIG_(\w+)", recipe))
    assert used == set(options)
