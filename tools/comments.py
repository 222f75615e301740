# SPDX-License-Identifier: MIT
"""What the comments of C and Python and the docstrings of Python say, as running text with its lines.

Comments on lines that follow each other at one column are one text. What is not prose ends it: an empty line, a line
indented like code, a row of a table, a rule of dashes. A comment that goes on with `...` stands alone.
"""

from __future__ import annotations

import ast
import bisect
import dataclasses
import io
import re
import tokenize
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

FOLDERS: Final = ("firmware", "hal", "hil_sim", "tools")
PROGRAMS: Final = ("tools/dev", "tools/qemu-board", "tools/with-can")
"""Written in Python without being named so."""

C_TOKEN: Final = re.compile(
    r""" "(?:\\.|[^"\\\n])*" | '(?:\\.|[^'\\\n])*' | //[^\n]* | /\*.*?\*/ """, re.DOTALL | re.VERBOSE
)
CODE_LIKE: Final = re.compile(r"^(?: {3}|\t)|\S {2,}\S|^ ?\||-{6}|^ ?(?:NOLINT|noqa|type:|SPDX-)")
"""Indented, or with columns, a table's bar, a rule, or a word to a tool."""
EXAMPLE: Final = re.compile(r"^ *>>> .*?(?:\n *(?=\n)|\Z)", re.DOTALL | re.MULTILINE)
"""What a docstring shows as typed at an interpreter, with the answers, up to an empty line."""


@dataclasses.dataclass(frozen=True)
class Line:
    """A line of a comment or docstring, without the marks that make it one."""

    number: int
    column: int
    text: str
    alone: bool
    """No code is left of it."""


@dataclasses.dataclass(frozen=True)
class Text:
    """Lines that are read as one."""

    lines: tuple[Line, ...]

    @property
    def words(self) -> str:
        """All of it on one line."""
        return " ".join(line.text.strip() for line in self.lines)

    def line_of(self, offset: int) -> int:
        """Return the number of the line that has the character at OFFSET of `words`."""
        starts, at = list[int](), 0
        for line in self.lines:
            starts.append(at)
            at += len(line.text.strip()) + 1
        return self.lines[bisect.bisect_right(starts, offset) - 1].number


def sources(root: Path) -> list[Path]:
    """Return the files below ROOT whose comments are read."""
    found = [
        path
        for folder in FOLDERS
        for path in (root / folder).rglob("*")
        if path.suffix in {".c", ".h", ".py"}
    ]
    return sorted([*found, *(root / name for name in PROGRAMS if (root / name).exists())])


def texts(path: Path) -> Iterator[Text]:
    """Yield what the comments and docstrings of a file say."""
    source = path.read_text(encoding="utf-8")
    if path.suffix in {".c", ".h"}:
        yield from _joined(_c_lines(source))
    else:
        yield from _joined(_python_comments(source))
        for docstring in _docstrings(source):
            yield from _joined(docstring)


def _joined(lines: Iterable[Line]) -> Iterator[Text]:
    """Yield LINES as texts: each goes on with the line below it, at the same column."""
    held: list[Line] = []
    for line in lines:
        prose = line.text.strip() != "" and not CODE_LIKE.search(line.text)
        follows = (
            bool(held)
            and line.alone
            and line.number == held[-1].number + 1
            and line.column == held[-1].column
        )
        if held and not (prose and follows and not line.text.lstrip().startswith("...")):
            yield Text(tuple(held))
            held = []
        if prose:
            held.append(line)
    if held:
        yield Text(tuple(held))


def _c_lines(source: str) -> Iterator[Line]:
    """Yield the lines of the comments of a C source."""
    for token in C_TOKEN.finditer(source):
        if token[0][0] != "/":
            continue
        number = source.count("\n", 0, token.start()) + 1
        begin = source.rfind("\n", 0, token.start()) + 1
        column, alone = token.start() - begin, not source[begin : token.start()].strip()
        if token[0].startswith("//"):
            yield Line(number, column, token[0][2:], alone)
            continue
        for index, text in enumerate(token[0][2:-2].split("\n")):
            inside = re.sub(r"^\s*\*(?=\s|$)", "", text) if index else text
            yield Line(number + index, column, inside, alone or index > 0)


def _python_comments(source: str) -> Iterator[Line]:
    """Yield the comments of a Python source."""
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT and not token.string.startswith("#!"):
            number, column = token.start
            yield Line(number, column, token.string[1:], not token.line[:column].strip())


def _docstrings(source: str) -> Iterator[list[Line]]:
    """Yield the lines of each docstring of a Python source, those below constants and fields included."""
    for node in ast.walk(ast.parse(source)):
        if not (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)):
            continue
        value = node.value.value
        if isinstance(value, str):
            indent = " " * node.col_offset
            lines = [line.removeprefix(indent) for line in EXAMPLE.sub(_blank, value).split("\n")]
            yield [Line(node.lineno + k, node.col_offset, line, alone=True) for k, line in enumerate(lines)]


def _blank(found: re.Match[str]) -> str:
    """Return as many empty lines as the match has, so that line numbers stay."""
    return "\n" * found[0].count("\n")
