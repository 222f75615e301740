# SPDX-License-Identifier: MIT
"""Rule: the manual pages are what the programs say of themselves: every option of --help, and no other."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import forks
import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted((ROOT / "docs/man").glob("*.1"))
OPTION = re.compile(r"(?<![\w-])--?[a-z][a-z-]*")

sys.path.insert(0, str(ROOT / "tools"))
import gen_man  # noqa: E402


def help_of(command: tuple[str, ...]) -> list[str]:
    """What gen_man.help_of returns; a program in Python is forked from one that has imported it."""
    if command[0] != sys.executable:
        return gen_man.help_of(command)
    module = {"hil_sim.cli": "hil_sim.cli.main"}.get(command[2], command[2])
    env = {**os.environ, "COLUMNS": gen_man.WIDE}
    done = forks.run_text(f"{module}:main", *command[3:], "--help", env=env)
    assert done.returncode == 0, done.stderr
    return gen_man.lines_of(done.stdout)


def test_pages_are_current(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    assert help_of(gen_man.PAGES[1].command) == gen_man.help_of(gen_man.PAGES[1].command)
    programs = gen_man.help_of

    def of_any(command: tuple[str, ...]) -> list[str]:
        return help_of(command) if command[0] == sys.executable else programs(command)

    monkeypatch.setattr(gen_man, "help_of", of_any)
    assert gen_man.main(["--check"]) == 0, capsys.readouterr().err


@pytest.mark.parametrize("page", gen_man.PAGES, ids=lambda page: page.name)
def test_options_of_help_are_in_the_page_and_no_other(page: gen_man.Page) -> None:
    told = help_of(page.command)
    commands = re.findall(r"^    (\w+) {2,}", "\n".join(told), re.MULTILINE) if page.has_commands else []
    for command in commands:
        told += help_of((*page.command, command))
    text = (ROOT / f"docs/man/{page.name}.1").read_text(encoding="utf-8").replace("\\-", "-")
    declared = {
        word
        for line in told
        if line.startswith("  -")
        for word in OPTION.findall(line.strip().split("  ")[0])
    }
    tagged = {
        word for line in re.findall(r"^\.B (-.*)$", text, re.MULTILINE) for word in OPTION.findall(line)
    }
    assert declared
    assert tagged == declared


def test_each_program_that_is_installed_has_a_page() -> None:
    scripts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["scripts"]
    assert {path.stem for path in PAGES} == {"argusd", *scripts}
    excused = [path for path in (ROOT / "cmake/deb").iterdir() if path.suffix == ".lintian-overrides"]
    assert [path.name for path in excused if "no-manual-page" in path.read_text(encoding="utf-8")] == []


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


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.stem)
def test_a_heading_is_no_sentence(page: Path) -> None:
    """A paragraph that ends in a heading's words on the same line would become one."""
    headings = re.findall(r'^\.S[HS] "?([^"\n]+)"?$', page.read_text(encoding="utf-8"), re.MULTILINE)
    assert headings
    assert [heading for heading in headings if "." in heading or len(heading) > 60] == []
