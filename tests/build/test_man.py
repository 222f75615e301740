# SPDX-License-Identifier: MIT
"""Rule: the manual pages are what the programs say of themselves: every option of --help, and no other."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted((ROOT / "docs/man").glob("*.1"))
OPTION = re.compile(r"(?<![\w-])--?[a-z][a-z-]*")

sys.path.insert(0, str(ROOT / "tools"))
import gen_man  # noqa: E402


def test_pages_are_current() -> None:
    command = [sys.executable, str(ROOT / "tools/gen_man.py"), "--check"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("page", gen_man.PAGES, ids=lambda page: page.name)
def test_options_of_help_are_in_the_page_and_no_other(page: gen_man.Page) -> None:
    told = gen_man.help_of(page.command)
    commands = re.findall(r"^    (\w+) {2,}", "\n".join(told), re.MULTILINE) if page.has_commands else []
    for command in commands:
        told += gen_man.help_of((*page.command, command))
    text = (ROOT / f"docs/man/{page.name}.1").read_text(encoding="utf-8").replace("\\-", "-")
    declared = {
        word for line in told if line.startswith("  -") for word in OPTION.findall(line.split("   ")[0])
    }
    tagged = {
        word for line in re.findall(r"^\.B (-.*)$", text, re.MULTILINE) for word in OPTION.findall(line)
    }
    assert declared
    assert tagged == declared


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_pages_are_sound(page: Path) -> None:
    if not shutil.which("groff"):
        pytest.skip("groff is not installed")
    done = subprocess.run(
        ["groff", "-man", "-ww", "-Tascii", "-rLL=110n", str(page)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0
    assert done.stderr == ""
    assert {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXAMPLES", "SEE ALSO"} <= set(
        re.findall(r'^\.SH "?([A-Z ]+?)"?$', page.read_text(encoding="utf-8"), re.MULTILINE)
    )
