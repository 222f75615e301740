# SPDX-License-Identifier: MIT
"""Rule: what a mail quotes is read as what it is; a ">" that a terminal program writes stays a mark of direction."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from argus_tools.formats import open_log
from forms import CLIENT, COMMANDS, ROBOT, SIPS, frames, hexdump_c, joined, od, xxd

CANDUMP = "".join(f"({f.t:.6f}) can0 {f.can_id:03X}#{f.data.hex().upper()}\n" for f in frames())
TABLE = "Time,ID,Data\n" + "".join(f"{f.t:.6f},{f.can_id:X},{f.data.hex(' ')}\n" for f in frames())
FORMS: dict[str, tuple[str, str]] = {
    "xxd": (xxd(ROBOT), "hexdump"),
    "hexdump -C": (hexdump_c(ROBOT), "hexdump"),
    "od": (od(ROBOT), "hexdump"),
    "od -t d1": (od(ROBOT, "07o", 1, "5d"), "numdump"),
    "candump": (CANDUMP, "candump"),
    "table": (TABLE, "can-csv"),
    "a long one": (xxd(ROBOT * 300), "hexdump"),
}
QUOTES: dict[str, Callable[[str], str]] = {
    "once": lambda line: "> " + line,
    "without a space": lambda line: ">" + line,
    "twice": lambda line: ">> " + line,
    "apart": lambda line: "> > " + line,
    "carriage returns": lambda line: "> " + line.replace("\n", "\r\n"),
}


@pytest.mark.tour(9, 18)
@pytest.mark.parametrize("quote", QUOTES)
@pytest.mark.parametrize("name", FORMS)
def test_a_quoted_log_is_read(name: str, quote: str, tmp_path: Path) -> None:
    text, form = FORMS[name]
    (tmp_path / "a.txt").write_text("".join(map(QUOTES[quote], text.splitlines(keepends=True))), newline="")
    log = open_log(str(tmp_path / "a.txt"))
    chunks = list(log)
    assert (log.format.name, log.damage) == (form, [])
    assert joined(chunks, "r2c") == (ROBOT * 300 if name == "a long one" else ROBOT)
    assert joined(chunks, "c2r") == (CLIENT if name in ("candump", "table") else b"")


def test_what_the_mail_says_besides_is_told(tmp_path: Path) -> None:
    quoted = "".join("> " + line for line in xxd(ROBOT).splitlines(keepends=True))
    (tmp_path / "a.txt").write_text("\ufeffOn Monday somebody wrote:\n" + quoted + "Regards\n")
    log = open_log(str(tmp_path / "a.txt"))
    assert joined(list(log), "r2c") == ROBOT
    assert {entry.what for entry in log.damage} == {"no line of a dump"}


@pytest.mark.parametrize("marks", [("> ", "< "), (">> ", "<< ")])
def test_marks_of_direction_are_none_of_a_quotation(marks: tuple[str, str], tmp_path: Path) -> None:
    pairs = zip(COMMANDS, SIPS, strict=True)
    (tmp_path / "a.txt").write_text(
        "".join(f"{marks[0]}{c.hex(' ')}\n{marks[1]}{s.hex(' ')}\n" for c, s in pairs)
    )
    chunks = list(open_log(str(tmp_path / "a.txt")))
    assert (joined(chunks, "c2r"), joined(chunks, "r2c")) == (CLIENT, ROBOT)


def test_a_terminal_that_marks_each_line_as_sent(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("".join(f"> {command.hex(' ')}\n" for command in COMMANDS))
    log = open_log(str(tmp_path / "a.txt"))
    assert (joined(list(log), "c2r"), log.format.name) == (CLIENT, "hextext")
