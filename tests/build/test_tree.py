# SPDX-License-Identifier: MIT
"""Rule: sources carry their licence build from any folder, and every C test has a source that it tests."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("firmware", "hal", "hil_sim", "tests", "tools", "cmake", "examples", "findings", ".ci", ".github")
SOURCES = {".c", ".h", ".py", ".cmake", ".toml", ".yaml", ".yml", ".sh"}
BINARY = {".png", ".gz", ".bin", ".log", ".pyc"}
# Split, so that this file does not hold what it looks for.
PLACES = re.compile("|".join(["/" + "work/", "/" + "home/[a-z]", "/" + "root/", r"\.\./" + "shared"]))
REGISTRIES = re.compile("|".join(["pypi" + r"\.org", "python" + "hosted", "npm" + "js", "crates" + r"\.io"]))


def texts() -> Iterator[tuple[Path, str]]:
    """Return path and text of every file that a person wrote."""
    tops = [
        path
        for path in ROOT.iterdir()
        if path.is_file() and path.suffix not in BINARY and path.name != ".git"
    ]
    below = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*") if path.is_file()]
    for path in sorted(tops + below):
        relative = path.relative_to(ROOT)
        if (
            path.suffix in BINARY
            or "__pycache__" in relative.parts
            or relative.parts[:2] == ("tests", "data")
        ):
            continue
        yield relative, path.read_text(encoding="utf-8")


def test_no_path_of_one_machine_and_no_registry() -> None:
    found = [
        f"{path}:{number}: {line.strip()[:100]}"
        for path, text in texts()
        for number, line in enumerate(text.splitlines(), 1)
        if PLACES.search(line) or REGISTRIES.search(line)
    ]
    assert found == []


def test_every_source_names_its_licence() -> None:
    found = [
        str(path)
        for path, text in texts()
        if (path.suffix in SOURCES or path.name in {"dev", "run", "CMakeLists.txt"})
        and "SPDX-License-Identifier: MIT" not in "\n".join(text.splitlines()[:3])
    ]
    assert found == []


def test_unit_tests_mirror_the_sources() -> None:
    unit = ROOT / "tests/unit"
    found = []
    for path in sorted(unit.rglob("test_*.c")):
        mirrored = path.relative_to(unit).with_name(path.name.removeprefix("test_"))
        # One source may have several test files: test_frame_damage.c also belongs to frame.c.
        stem = mirrored.stem
        candidates = [stem[:end] for end in range(len(stem), 0, -1) if end == len(stem) or stem[end] == "_"]
        folders = (ROOT, ROOT / "firmware", ROOT / "hal")
        if not any(
            (top / mirrored.with_name(name + ".c")).exists() for top in folders for name in candidates
        ):
            found.append(f"{path.relative_to(ROOT)}: no {mirrored}")
    assert found == []
