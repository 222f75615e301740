# SPDX-License-Identifier: MIT
"""Rule: on a terminal argusd draws, answers keys and gives the terminal back; where it cannot draw it writes lines."""

from __future__ import annotations

import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import termios
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from harness import ARGUSD, BAUD, PATIENCE_S, Bench, wait_for
from worlds import hall

ROWS = 24


class Vt52:
    """The picture on a VT52, a terminal of few sequences: a curses program says only what changes."""

    def __init__(self, columns: int) -> None:
        self.grid = [[" "] * columns for _ in range(ROWS)]
        self.row = self.column = 0
        self._rest = ""

    def feed(self, text: str) -> None:
        """Take what was written."""
        text, self._rest = self._rest + text, ""
        at = 0
        while at < len(text):
            if text[at] != "\x1b":
                self._put(text[at])
                at += 1
                continue
            size = 4 if text[at + 1 : at + 2] == "Y" else 2
            if at + size > len(text):
                self._rest = text[at:]
                return
            self._do(text[at + 1 : at + size])
            at += size

    def _put(self, character: str) -> None:
        if character == "\r":
            self.column = 0
        elif character == "\n":
            self._down()
        elif character == "\b":
            self.column = max(0, self.column - 1)
        elif character == "\t":
            self.column = min(len(self.grid[0]) - 1, (self.column // 8 + 1) * 8)
        elif character >= " ":
            self.grid[self.row][min(self.column, len(self.grid[0]) - 1)] = character
            self.column += 1

    def _down(self) -> None:
        if self.row + 1 == ROWS:
            self.grid = [*self.grid[1:], [" "] * len(self.grid[0])]
        else:
            self.row += 1

    def _do(self, sequence: str) -> None:
        if sequence[0] == "Y":
            self.row, self.column = ord(sequence[1]) - 32, ord(sequence[2]) - 32
        elif sequence == "H":
            self.row = self.column = 0
        elif sequence in "JK":
            self.grid[self.row][self.column :] = [" "] * (len(self.grid[0]) - self.column)
            for row in range(self.row + 1, ROWS if sequence == "J" else 0):
                self.grid[row] = [" "] * len(self.grid[0])
        elif sequence in "ABCD":
            down, right = {"A": (-1, 0), "B": (1, 0), "C": (0, 1), "D": (0, -1)}[sequence]
            self.row, self.column = self.row + down, self.column + right
        elif sequence == "I":
            self.grid = [[" "] * len(self.grid[0]), *self.grid[:-1]] if self.row == 0 else self.grid
            self.row = max(0, self.row - 1)

    @property
    def text(self) -> str:
        """The lines."""
        return "\n".join("".join(row).rstrip() for row in self.grid)


class Terminal:
    """argusd on a terminal of a given kind and width."""

    def __init__(self, arguments: Sequence[str], kind: str, columns: int, program: Path = ARGUSD) -> None:
        self._master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        self.before = termios.tcgetattr(slave)
        self._slave = slave
        environment = {key: value for key, value in os.environ.items() if key not in {"COLUMNS", "LINES"}}
        self.process = subprocess.Popen(
            [str(program), *arguments],
            stdin=slave, stdout=slave, stderr=slave, env=environment | {"TERM": kind}, start_new_session=True,
        )  # fmt: skip
        self.screen = Vt52(columns)
        self._text = ""

    @property
    def text(self) -> str:
        """All that was written so far."""
        while select.select([self._master], [], [], 0)[0]:
            piece = os.read(self._master, 65536).decode("latin-1")
            self.screen.feed(piece)
            self._text += piece
        return self._text

    def wait(self, part: str) -> None:
        """Wait until a text was written as it is."""
        wait_for(f"'{part}' among the lines", lambda: re.search(part, self.text), PATIENCE_S)

    def wait_shown(self, part: str) -> None:
        """Wait until a text is on the screen."""
        wait_for(f"'{part}' on the screen", lambda: self.text and part in self.screen.text, PATIENCE_S)

    def press(self, keys: str) -> None:
        """Press keys."""
        os.write(self._master, keys.encode())

    def resize(self, rows: int, columns: int) -> None:
        """Make the window smaller, as its user does."""
        fcntl.ioctl(self._slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        os.killpg(self.process.pid, signal.SIGWINCH)

    def wait_exit(self) -> int:
        """Wait for its end, reading on."""
        wait_for("argusd ends", lambda: self.text is not None and self.process.poll() is not None, PATIENCE_S)
        return int(self.process.returncode)

    def is_as_before(self) -> bool:
        """The terminal has its modes back."""
        return termios.tcgetattr(self._slave) == self.before

    def close(self) -> None:
        """End what is left."""
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        os.close(self._slave)
        os.close(self._master)


@pytest.fixture
def terminals() -> Iterator[list[Terminal]]:
    """Terminals of a test, closed with it."""
    opened: list[Terminal] = []
    yield opened
    for terminal in opened:
        terminal.close()


@pytest.mark.parametrize("columns", [80, 40])
def test_keys_are_answered_and_the_terminal_comes_back(
    bench: Bench, terminals: list[Terminal], columns: int
) -> None:
    bench.sim(bench.world(**hall()))
    terminal = Terminal(["--link", f"serial:{bench.port}@{BAUD}"], "vt52", columns)
    terminals.append(terminal)
    terminal.wait_shown("IsNormal")
    terminal.wait_shown("HEALTHY")
    for key, answer in {
        "w": "one step ahead: not while passive",
        "z": "> no such key",
        "n": "> n: sonar 1 is",
        " ": "stop, and stay",
    }.items():
        terminal.press(key)
        terminal.wait_shown(answer)
    terminal.wait_shown("PAUSED")
    terminal.press("?")
    terminal.wait_shown("test the chosen sonar")
    assert "PAUSED" in terminal.screen.text
    terminal.press("q")
    assert terminal.wait_exit() == 0
    assert re.search(r"SUMMARY mission none; IsNormal; no sonar out of use", terminal.text)
    assert terminal.is_as_before()


def test_a_window_that_is_resized_is_no_key(bench: Bench, terminals: list[Terminal]) -> None:
    bench.sim(bench.world(**hall()))
    terminal = Terminal(["--link", f"serial:{bench.port}@{BAUD}"], "vt52", 80)
    terminals.append(terminal)
    terminal.wait_shown("HEALTHY")
    terminal.wait_shown("15  ")
    for columns in (60, 70, 50):
        terminal.resize(ROWS, columns)
    terminal.wait_shown("space stop  g go  p passive  ? keys  q quit")
    terminal.press("n")
    terminal.wait_shown("> n: sonar 1 is")
    assert "no such key" not in terminal.text
    terminal.press("q")
    assert terminal.wait_exit() == 0


@pytest.mark.parametrize("kind", ["dumb", "no-such-terminal"])
def test_a_terminal_that_cannot_be_drawn_on_gets_lines(
    bench: Bench, terminals: list[Terminal], kind: str
) -> None:
    bench.sim(bench.world(**hall()))
    terminal = Terminal(["--link", f"serial:{bench.port}@{BAUD}"], kind, 80)
    terminals.append(terminal)
    terminal.wait("no screen can be drawn on this terminal")
    terminal.wait(r"session +SESSION_OPEN")
    terminal.process.terminate()
    assert terminal.wait_exit() == 0
    assert terminal.text.rstrip().splitlines()[-1].split()[1] == "SUMMARY"
    assert "\x1b" not in terminal.text
