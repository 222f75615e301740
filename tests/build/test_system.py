# SPDX-License-Identifier: MIT
"""Rule: what a machine lacks is named as it is, with advice that works there: no sudo where there is none."""

from __future__ import annotations

import stat
from collections.abc import Callable
from pathlib import Path

import pytest
from devtool import system
from devtool.base import Stop

Make = Callable[[str, str], Path]


@pytest.fixture
def programs(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Make:
    """Makes a program; nothing else is in PATH."""
    folder = tmp_path / "bin"
    folder.mkdir()
    monkeypatch.setenv("PATH", str(folder))
    monkeypatch.setattr(system, "LOGS", tmp_path / "logs")

    def make(name: str, script: str) -> Path:
        path = folder / name
        path.write_text(f"#!/bin/sh\n{script}\n")
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        return path

    return make


@pytest.fixture
def headers(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """The folder of the headers, empty."""
    folder = tmp_path / "include"
    folder.mkdir()
    monkeypatch.setattr(system, "HEADERS", folder)
    return folder


def names(*needs: str) -> list[str]:
    return [need.name for need in system.missing_of(needs)]


def user(monkeypatch: pytest.MonkeyPatch, number: int) -> None:
    monkeypatch.setattr("os.geteuid", lambda: number)


def test_without_a_compiler_the_compiler_is_missing(programs: Make, headers: Path) -> None:
    assert names("gcc", "libc") == ["gcc"]
    assert system.packages_of(system.missing_of(["gcc", "libc"])) == ["gcc", "libc6-dev"]


def test_a_compiler_without_headers_lacks_the_headers(programs: Make, headers: Path) -> None:
    programs("gcc", "exit 1")
    assert names("gcc", "libc") == ["headers of the C library (libc6-dev)"]
    assert system.packages_of(system.missing_of(["gcc", "libc"])) == ["libc6-dev"]


def test_a_library_is_not_missing_because_nothing_can_be_built(programs: Make, headers: Path) -> None:
    assert names("curses") == ["curses"]
    (headers / "curses.h").touch()
    assert names("curses") == []
    programs("gcc", "exit 1")
    assert names("curses") == []


def test_a_library_that_cannot_be_linked_is_missing(programs: Make, headers: Path) -> None:
    (headers / "curses.h").touch()
    programs("gcc", 'case "$*" in *-lncursesw*) exit 1;; esac')
    assert names("gcc", "libc", "curses") == ["curses"]


@pytest.mark.parametrize(
    ("number", "sudo", "expected"),
    [
        (0, False, "run this:\n  apt-get update && apt-get install -y --no-install-recommends gcc cmake"),
        (0, True, "run this:\n  apt-get update && apt-get install -y --no-install-recommends gcc cmake"),
        (
            1000,
            True,
            "run this:\n  sudo apt-get update && sudo apt-get install -y --no-install-recommends gcc cmake",
        ),
        (
            1000,
            False,
            "run this:\n  su -c 'apt-get update && apt-get install -y --no-install-recommends gcc cmake'",
        ),
    ],
)
def test_the_advice_fits_the_machine(
    programs: Make, monkeypatch: pytest.MonkeyPatch, number: int, sudo: bool, expected: str
) -> None:
    programs("apt-get", "exit 1")
    programs("env", "exit 1")
    if sudo:
        programs("sudo", "exit 1")
    user(monkeypatch, number)
    with pytest.raises(Stop) as caught:
        system.apt_install(["gcc", "cmake"], lambda text: None)
    assert expected in str(caught.value)
    assert caught.value.code == 3


def test_without_apt_the_packages_are_named(programs: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    user(monkeypatch, 1000)
    with pytest.raises(Stop, match=r"package manager .*:\n  gcc cmake") as caught:
        system.apt_install(["gcc", "cmake"])
    assert "apt-get" not in str(caught.value)


def test_lists_are_renewed_where_a_package_is_not_found(
    programs: Make, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    user(monkeypatch, 0)
    did = tmp_path / "did"
    programs("env", 'while [ "$1" != apt-get ]; do shift; done; exec "$@"')
    programs("apt-get", f'echo "$2" >>{did}; [ "$2" = update ] || [ "$(wc -l <{did})" -gt 2 ]')
    programs("wc", 'count=0; while read -r line; do count=$((count + 1)); done; echo "$count"')
    said: list[str] = []
    system.apt_install(["gcc"], said.append)
    assert did.read_text().split() == ["install", "update", "install"]
    assert said == ["installing with apt-get: gcc"]


def test_what_only_shows_once_the_compiler_is_there_is_told(
    programs: Make, headers: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    asked: list[list[str]] = []

    def install(packages: list[str]) -> None:
        asked.append(packages)
        programs("gcc", "exit 1")

    monkeypatch.setattr(system, "apt_install", install)
    with pytest.raises(Stop, match=r"still missing after installing libc6-dev: headers of the C library"):
        system.ensure_system(["gcc", "libc"])
    assert asked == [["gcc", "libc6-dev"]]
    assert capsys.readouterr().out == "dev: missing: gcc\n"
