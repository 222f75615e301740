# SPDX-License-Identifier: MIT
"""Bytes that stand among other words: in logs of programs, in brackets, as literals of Python, as lists of numbers."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from io import BufferedReader
from typing import Final, NamedTuple

from argus_tools.catalogue import HELP
from argus_tools.chunks import (
    ROBOT_TO_CLIENT,
    Chunk,
    Damage,
    DamageList,
    Direction,
    Format,
    Offsets,
    ReadOptions,
)
from argus_tools.formats.bin import guess_direction
from argus_tools.formats.hextext import bytes_of_lines
from argus_tools.formats.marks import UNTOLD, directions, has_both_sides, marks_in
from argus_tools.formats.source import HEAD_BYTES
from argus_tools.formats.stamps import Times
from argus_tools.formats.text import first_lines, pieces
from hil_sim.arcos import Unframer

_PACKETS: Final = 2
"""So many whole packets with the right checksum are no chance."""
_FEW_LINES: Final = 3
_BYTE_MAX: Final = 255
_LINES: Final = 1 << 12
# What some draw between columns, and in the middle of one.
_FRAME: Final = re.compile(rb"\xe2[\x94\x95].")
_MIDDLE: Final = re.compile(rb" *\xe2\x94\x8a *")
_LITERAL: Final = re.compile(rb"""b(?:'(?:[^'\\]|\\.)*'|"(?:[^"\\]|\\.)*")""")
_BRACKETED: Final = re.compile(rb"(?:\[|<|\(|\{)(?:0[xX])?([0-9A-Fa-f]{2})(?:\]|>|\)|\})")
_PREFIXED: Final = re.compile(rb"(?<![0-9A-Za-z])0[xX]([0-9A-Fa-f]{1,2})(?![0-9A-Za-z])")
_DECIMAL: Final = re.compile(rb"\((\d{3})\)")
_RUN: Final = re.compile(rb"(?<![0-9A-Za-z.])[0-9A-Fa-f]{2}(?:[,:;-]?[ ]{0,2}[0-9A-Fa-f]{2})*(?![0-9A-Za-z])")
# A time is no run of bytes, and none that one stands before.
_CLOCK: Final = re.compile(rb"(?<![0-9A-Fa-f:.-])\d\d:\d\d:\d\d(?:[.,]\d{1,9})?(?![0-9A-Fa-f:.-])")
_NUMBERS: Final = re.compile(rb"\[\s*\d{1,3}(?:(?:\s*,\s*|\s+)\d{1,3})+\s*\]")
_NO_DIGITS: Final = b" ,:;-"
# What a literal and a list begin with, as far as they can be read.
_LITERAL_BEGUN: Final = re.compile(
    rb"""(?<![0-9A-Za-z_])b(?:'(?:[^'\\]|\\x[0-9A-Fa-f]{2}|\\[^x])*|"(?:[^"\\]|\\x[0-9A-Fa-f]{2}|\\[^x])*)"""
)
_NUMBERS_BEGUN: Final = re.compile(rb"\[\s*\d{1,3}(?:\s*,\s*\d{1,3})*(?=\s*,)")
_BRACKET_BEGUN: Final = re.compile(rb"[\[<({](?:0[xX]?)?[0-9A-Fa-f]{0,2}\Z")
CARRIED_MOST: Final = 1 << 20
"""Bytes of a literal or a list that a line may go on with: all of it is held."""
_GUESSED: Final = f"{UNTOLD}; each is taken by its packets, and short ones may be of the other side"
_OPEN: Final = "a literal or a list that holds no bytes, or does not end"


def _literal(text: bytes) -> bytes | None:
    try:
        return bytes(ast.literal_eval(text.decode("latin-1")))
    except (SyntaxError, ValueError):
        return None


def _literals(line: bytes) -> list[bytes | None]:
    return [_literal(text) for text in _LITERAL.findall(line)]


def _bracketed(line: bytes) -> list[bytes | None]:
    return [bytes.fromhex(b"".join(_BRACKETED.findall(line)).decode())]


def _prefixed(line: bytes) -> list[bytes | None]:
    return [bytes(int(digits, 16) for digits in _PREFIXED.findall(line))]


def _decimal(line: bytes) -> list[bytes | None]:
    values = [int(digits) for digits in _DECIMAL.findall(line)]
    return [bytes(values) if max(values, default=0) <= _BYTE_MAX else None]


def _run(line: bytes) -> list[bytes | None]:
    """The last run that is not much shorter than the longest: times and addresses stand before, and are short."""
    if stamp := Times().take(line.lstrip()):
        line = stamp.rest
    found = [
        run.translate(None, _NO_DIGITS)
        for run in _RUN.findall(_FRAME.sub(b"|", _MIDDLE.sub(b" ", _CLOCK.sub(b"|", line))))
    ]
    long = [run for run in found if 2 * len(run) >= max(map(len, found))]
    return [bytes.fromhex(long[-1].decode())] if long else []


def _list(text: bytes) -> bytes | None:
    values = [int(number) for number in re.findall(rb"\d+", text)]
    return bytes(values) if max(values) <= _BYTE_MAX else None


def _numbers(line: bytes) -> list[bytes | None]:
    return [_list(text) for text in _NUMBERS.findall(line)]


class _Way(NamedTuple):
    """A way in which bytes stand in a line."""

    take: Callable[[bytes], list[bytes | None]]
    """Returns what is there; None is of what looks like it and holds no bytes."""
    whole: re.Pattern[bytes] | None = None
    begun: re.Pattern[bytes] | None = None
    """What a cut line may leave open; it begins behind all that is whole."""
    tells: bool = False
    """A line with such a beginning should hold bytes."""

    def open_in(self, line: bytes) -> re.Match[bytes] | None:
        """Return what is not whole."""
        if self.whole is None or self.begun is None:
            return None
        ends = [found.end() for found in self.whole.finditer(line)]
        return self.begun.search(line, ends[-1] if ends else 0)

    def closed(self, line: bytes) -> bytes:
        """Return a line that is cut with an end to what the cut has left open."""
        found = self.open_in(line)
        if found is None or not self.tells:
            return line
        return line[: found.end()] + (b"]" if found[0].startswith(b"[") else found[0][1:2])


_BY_RUNS: Final = _Way(_run)
_WAYS: Final = (
    _Way(_literals, _LITERAL, _LITERAL_BEGUN, tells=True),
    _Way(_bracketed, _BRACKETED, _BRACKET_BEGUN),
    _Way(_decimal),
    _Way(_prefixed),
    _BY_RUNS,
    _Way(_numbers, _NUMBERS, _NUMBERS_BEGUN, tells=True),
)


def _joined(parts: Iterable[bytes | None]) -> bytes:
    return b"".join(part for part in parts if part is not None)


def _holds_packets(data: bytes, least: int = _PACKETS) -> bool:
    return sum(len(packet) > 1 for packet in Unframer().feed(data)) >= least


def _way(lines: Sequence[bytes]) -> _Way | None:
    """In which of these ways the lines hold packets, if in any; the last one may be cut."""
    return next((way for way in _WAYS if _holds_packets(_bytes_of(lines, way), _least(lines))), None)


def _least(lines: Sequence[bytes]) -> int:
    """How many packets tell: of a sample of a line or two there is no more than one."""
    return 1 if len(lines) <= _FEW_LINES else _PACKETS


def _bytes_of(lines: Sequence[bytes], way: _Way) -> bytes:
    return b"".join(_joined(_taken(line, way).parts) for line in _closed(lines, way))


def _closed(lines: Sequence[bytes], way: _Way) -> list[bytes]:
    """Return the lines, the last of which may be cut."""
    return [*lines[:-1], *map(way.closed, lines[-1:])]


class _Taken(NamedTuple):
    """What is in a line: the mark of direction next to the bytes, empty if there is none, and the bytes."""

    mark: bytes
    parts: list[bytes | None]


def _taken(line: bytes, way: _Way) -> _Taken:
    """Take the bytes behind the last mark that some stand behind, else those of the whole line."""
    marks = marks_in(line)
    for mark in marks:
        parts = way.take(line[mark.end :])
        if _joined(parts):
            return _Taken(mark.name, parts)
    parts = way.take(line)
    return _Taken(marks[0].name if marks and not _joined(parts) else b"", parts)


def _directions(lines: Sequence[bytes], way: _Way, asked: Direction | None) -> dict[bytes, Direction] | None:
    """Say which direction each mark is; None if the lines do not tell two sides apart."""
    samples: dict[bytes, bytes] = {}
    mark = b""
    for line in _closed(lines, way):
        taken = _taken(line, way)
        mark = taken.mark or mark
        if data := _joined(taken.parts):
            samples[mark] = samples.get(mark, b"") + data
    return directions(samples, asked) if has_both_sides(samples) else None


def _lines(stream: BufferedReader, way: _Way) -> Iterator[tuple[int, bytes]]:
    """Yield line number and bytes; what a piece of a long line leaves open goes on with the next."""
    held, is_comment = b"", False
    number = 0
    for number, text, begins in pieces(stream):
        is_comment = text.startswith(b"#") if begins else is_comment
        if is_comment:
            continue
        text, held = held + text, b""
        found = None if text.endswith(b"\n") else way.open_in(text)
        if found is not None and len(text) - found.start() <= CARRIED_MOST:
            text, held = text[: found.start()], text[found.start() :]
        yield number, text
    if held:
        yield number, held


class HexwordsReader:
    """Takes the bytes out of each line, and the time at its beginning; what else stands there is passed over."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self.place = ""
        self._stream = stream
        self._direction = options.direction
        self._usual: Direction = ROBOT_TO_CLIENT
        self._is_told = False

    def __iter__(self) -> Iterator[Chunk]:
        offsets, times = Offsets(), Times()
        t: float | None = None
        head = first_lines(self._stream.peek(HEAD_BYTES), _LINES)
        way = _way(head) or _BY_RUNS
        self._usual = self._direction or guess_direction(_bytes_of(head, way))
        known = _directions(head, way, self._direction)
        mark = b""
        for number, line in _lines(self._stream, way):
            if stamp := times.take(line.lstrip()):
                t = stamp.t
            taken = _taken(line, way)
            mark = taken.mark or mark
            if data := self._bytes(number, line, way, taken.parts):
                direction = known.get(mark, known[b""]) if known else self._guess(number, data)
                self.place = f"line {number}"
                yield offsets.chunk(t, direction, data)

    def _guess(self, number: int, data: bytes) -> Direction:
        """Say whose packets these are; tell once that nothing else says it."""
        if self._direction is not None or not _holds_packets(data, 1):
            return self._usual
        direction = guess_direction(data)
        if direction != self._usual and not self._is_told:
            self._is_told = True
            self.damage.append(Damage(f"line {number}", _GUESSED))
        return direction

    def _bytes(self, number: int, line: bytes, way: _Way, parts: list[bytes | None]) -> bytes:
        """Return the bytes of a line; tell of what looks like some and holds none."""
        if None in parts or (way.tells and not parts and way.open_in(line)):
            self.damage.append(Damage(f"line {number}", _OPEN))
        return _joined(parts)


def _sniff(head: bytes) -> bool:
    lines = first_lines(head, _LINES)
    if not lines or _holds_packets(bytes_of_lines(lines), _least(lines)):
        return False
    return _way(lines) is not None


FORMAT: Final = Format(
    name="hexwords",
    help=HELP["hexwords"],
    sniff=_sniff,
    reader=HexwordsReader,
)
