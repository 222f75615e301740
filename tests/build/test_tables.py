# SPDX-License-Identifier: MIT
"""Rule: generated headers are those of the tables; a bad table is refused with one line and exit code 2."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
HEADERS = {
    "gen_sizes.h": Path("firmware/robot"),
    "gen_robots.c": Path("firmware/robot"),
    "gen_arcos.h": Path("firmware/arcos"),
    "argus.h": Path("firmware/include/argus"),
}
TABLES = Path("hil_sim/tables")


def generate(root: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(ROOT / "tools/gen_tables.py"), "--root", str(root), *arguments]
    return subprocess.run(command, check=False, capture_output=True, text=True)


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    for folder in HEADERS.values():
        (tmp_path / folder).mkdir(parents=True, exist_ok=True)
    shutil.copytree(ROOT / TABLES, tmp_path / TABLES)
    header = HEADERS["argus.h"] / "argus.h"  # of which a part is generated
    words = '#define ARGUS_ROBOT_WORDS "'
    text = (ROOT / header).read_text(encoding="utf-8")
    assert text.count(words) == 1
    (tmp_path / header).write_text(text.replace(words, words + "none|"), encoding="utf-8")
    return tmp_path


def test_checked_in_headers_are_current(tree: Path) -> None:
    assert generate(tree).returncode == 0
    for name, folder in HEADERS.items():
        assert (ROOT / folder / name).read_text() == (tree / folder / name).read_text(), (
            "run tools/gen_tables.py"
        )


def test_check_sees_every_changed_number(tree: Path) -> None:
    generate(tree)
    assert generate(tree, "--check").returncode == 0
    table = tree / TABLES / "robots/p3dx-sh.toml"
    front = tomllib.loads(table.read_text())["body"]["front_mm"]
    text = table.read_text()
    changed = text.replace(f"front_mm = {front}", f"front_mm = {front + 1}")
    assert changed != text
    table.write_text(changed)
    done = generate(tree, "--check")
    assert done.returncode == 1
    assert "gen_robots.c" in done.stderr
    assert "gen_arcos.h" not in done.stderr


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("robots/p3dx-sh", "[body\n", "p3dx-sh.toml: not valid TOML"),
        ("robots/p3dx-sh", "[body]\nfront_mm = 1\n", "no [[sonar.pose]] entries"),
        (
            "robots/p3dx-sh",
            "[[sonar.pose]]\nnumber = 1\nx_mm = 1\ny_mm = 1\nheading_deg = 1\narray = 0\n",
            "number must be 0",
        ),
        (
            "robots/p3dx-sh",
            "[[sonar.pose]]\nnumber = 0\nx_mm = 1.5\ny_mm = 1\nheading_deg = 1\n",
            "x_mm must be an integer",
        ),
        ("robots/amigo-sh", ("forward = [1, 2, 3, 4]", "forward = [4, 3, 2, 1]"), "bearings must fall"),
        (
            "robots/amigo-sh",
            ("forward = [1, 2, 3, 4]", "forward = [1, 2, 3, 40]"),
            "forward must name 2 to 6",
        ),
        ("robots/amigo-sh", ('subclass = "amigo-sh"', 'subclass = "amigo"'), "must be the file's name"),
        ("robots/amigo-sh", ('role = "abeam"', 'role = "beside"'), "role must be one of"),
        ("robots/p3at-sh", ("heading_deg = 30\n", "heading_deg = 31\n"), "24 different turns at most"),
        ("arcos", "[command]\nPULSE = 0\n", "section [type] is missing"),
        ("arcos", None, "no such table"),
    ],
)
def test_bad_table_is_refused(
    tree: Path, name: str, text: str | tuple[str, str] | None, expected: str
) -> None:
    table = tree / TABLES / f"{name}.toml"
    if isinstance(text, tuple):
        text = table.read_text().replace(*text)
    table.unlink()
    if text is not None:
        table.write_text(text)
    done = generate(tree)
    assert done.returncode == 2
    lines = done.stderr.splitlines()
    assert len(lines) == 1
    assert expected in lines[0]
    assert f"{name}.toml" in lines[0]


def test_tables_of_spec_are_those_of_the_headers() -> None:
    command = [sys.executable, str(ROOT / "tools/gen_docs.py"), "--check"]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
