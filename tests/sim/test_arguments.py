# SPDX-License-Identifier: MIT
"""Rule: a mistyped option, command or choice gets one line with what was meant; what is near nothing gets no guess."""

from __future__ import annotations

import argparse
import doctest
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from hil_sim import arguments
from hil_sim.arguments import Parser
from hil_sim.core.library import setting_value
from hil_sim.errors import InputError, SimError
from hil_sim.faults.grammar import parse_fault
from hil_sim.scenario.scenario import load_scenario
from hil_sim.tables.robot import robot_table
from hil_sim.world.files import load_world
from hil_sim.world.physics import parse_physics

ROOT = Path(__file__).resolve().parents[2]


def parser() -> Parser:
    made = Parser(prog="prog", allow_abbrev=False)
    made.add_argument("--fault")
    made.add_argument("--kind", choices=["silent", "stuck"])
    commands = made.add_subparsers(dest="command", parser_class=Parser)
    commands.add_parser("faults").add_argument("--json", action="store_true")
    commands.add_parser("plot")
    return made


@pytest.mark.parametrize(
    ("given", "meant"),
    [
        ("plot --fualt off:3", "--fault"),
        ("--fautl=off:3", "--fault"),
        ("faults --jsno", "--json"),
        ("faults x --jsno", "--json"),
        ("fautls", "faults"),
        ("--kind stuk", "stuck"),
        ("--faultoff:3", "--fault off:3"),
        ("faults --jsonlines", "--json lines"),
        ("--zzz", ""),
        ("--kind zzz", ""),
        ("zzz", ""),
    ],
)
def test_what_was_meant(given: str, meant: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as left:
        parser().parse_args(given.split())
    assert left.value.code == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert told.endswith(" --help\n")
    assert (f"did you mean {meant}? see" in told) == bool(meant)
    assert ("did you mean" in told) == bool(meant)


@pytest.mark.parametrize("text", ["-800,0", "-2m,-.5m", "-.5m,1m", "-90"])
def test_what_begins_as_a_negative_number_is_a_value(text: str) -> None:
    made = Parser(prog="prog")
    commands = made.add_subparsers(dest="command", parser_class=Parser)
    one = commands.add_parser("goto")
    one.add_argument("--force", action="store_true")
    one.add_argument("point", nargs="+")
    assert made.parse_args(["goto", text, "1,2", text]).point == [text, "1,2", text]
    assert made.parse_args(["goto", "--force", text]).force


def test_an_option_that_is_mistyped_where_one_must_be_given(capsys: pytest.CaptureFixture[str]) -> None:
    made = Parser(prog="prog", allow_abbrev=False)
    one_of = made.add_mutually_exclusive_group(required=True)
    one_of.add_argument("--sim", action="store_true")
    one_of.add_argument("--connect")
    for given, ending in (("--smi", "did you mean --sim?"), ("--zzz", "is required;"), ("", "is required;")):
        with pytest.raises(SystemExit):
            made.parse_args(given.split())
        assert capsys.readouterr().err.endswith(f"{ending} see prog --help\n")


@pytest.mark.parametrize(
    ("make", "meant"),
    [
        (lambda: load_world("ofice"), "office"),
        (lambda: robot_table("p3xd"), "p3dx-sh"),
        (lambda: parse_fault("of:3"), "off"),
        (lambda: parse_fault("wrong:3:scal=2"), "scale="),
        (lambda: parse_physics("rogh-day"), "rough-day"),
        (lambda: load_scenario("bad-dya"), "bad-day"),
        (lambda: setting_value("policyx", "fewest"), "policy"),
    ],
)
def test_a_name_that_is_mistyped_is_answered_so_too(make: Callable[[], object], meant: str) -> None:
    """Worlds, robots, faults, physics, scenarios, settings: one place asks what was meant."""
    with pytest.raises((SimError, InputError), match=f"did you mean {re.escape(meant)}\\?"):
        make()


def test_words_that_begin_another_command_line(capsys: pytest.CaptureFixture[str]) -> None:
    made = Parser(prog="prog")
    made.elsewhere = ("bench", "experiment")
    for given, ending in ((["benhc"], "did you mean bench?"), (["zzz"], "zzz;")):
        with pytest.raises(SystemExit):
            made.parse_args(given)
        assert capsys.readouterr().err.endswith(f"{ending} see prog --help\n")


def test_every_program_reports_so() -> None:
    folders = [ROOT / "hil_sim", *(ROOT / "tools" / name for name in ("argus_tools", "argus_ros", "devtool"))]
    plain = [
        path.relative_to(ROOT).as_posix()
        for folder in folders
        for path in folder.rglob("*.py")
        if "argparse.ArgumentParser(\n" in (text := path.read_text(encoding="utf-8"))
        or "ArgumentParser()" in text
    ]
    assert plain == []


def test_a_line_without_a_guess_ends_as_before(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        argparse.ArgumentParser.parse_args(parser(), ["--zzz"])
    assert capsys.readouterr().err == "prog: unrecognized arguments: --zzz; see prog --help\n"


def test_the_examples_in_the_sources_are_true() -> None:
    assert doctest.testmod(arguments).failed == 0
