# SPDX-License-Identifier: MIT
"""Rule: each finding stands alone, is pinned, compares what it sees, and has a row in the table with its version."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "findings"
SCRIPTS = sorted(FOLDER.glob("*.sh"))
HEAD = ("Version", "Expected", "Behaviour", "Hurts")
ROW = re.compile(r"^\| \[([\w-]+)\]\(([\w-]+\.sh)\) \| ([^|]+) \| ([^|]+) \| ([^|]+) \|$", re.MULTILINE)
PACKAGES = re.compile(r"(pip install|npm install|apt-get -qq -s install)((?:[^&>|]|\\\n)*)")
UNPINNED = {"binutils", "binutils-arm-none-eabi", "qemu-system-arm"}
"""Their version in Debian has the revision of one processor in it; the head tells the release."""


def head(script: Path) -> dict[str, str]:
    """Return what the comment at the top of a finding tells."""
    comment = script.read_text().split("set -eu", 1)[0]
    words = " ".join(line.removeprefix("#").strip() for line in comment.splitlines())
    found = re.split(rf"\b({'|'.join(HEAD)}): ", words)
    return {key: text.strip() for key, text in zip(found[1::2], found[2::2], strict=True)}


def test_the_table_has_each_finding_and_no_other() -> None:
    rows = ROW.findall((FOLDER / "README.md").read_text())
    assert sorted(name for _, name, *_ in rows) == [script.name for script in SCRIPTS]
    assert [name for name, file, *_ in rows if file != f"{name}.sh"] == []


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_the_table_tells_what_the_script_tells(script: Path) -> None:
    rows = {
        name: (version, behaviour)
        for name, _, version, behaviour, _ in ROW.findall((FOLDER / "README.md").read_text())
    }
    version, behaviour = rows[script.stem]
    title = " ".join(
        line.removeprefix("# ") for line in script.read_text().split("\n#\n", 1)[0].splitlines()[2:]
    )
    assert head(script)["Version"] == version + "."
    assert title == behaviour + "."


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_finding_is_whole(script: Path) -> None:
    text = script.read_text()
    assert script.stat().st_mode & 0o111, "it can be run"
    assert tuple(head(script)) == HEAD
    assert re.search(
        r'^set -eu\nfolder=\$\(mktemp -d\)\ntrap \'rm -rf "\$folder"\' EXIT\n', text, re.MULTILINE
    )
    assert "\ndiff expected seen ||" in text
    assert f"CHANGED: {script.stem}" in text
    assert "PASS: " in text.splitlines()[-1]
    subprocess.run(["sh", "-n", script], check=True)


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_each_package_is_pinned(script: Path) -> None:
    loose = [
        f"{command}: {package}"
        for command, packages in PACKAGES.findall(script.read_text())
        for package in packages.replace("\\\n", " ").split()
        if not package.startswith("-")
        and not re.search(r"[\w.]=+\d|.@\d", package)
        and package not in UNPINNED
    ]
    assert loose == []
