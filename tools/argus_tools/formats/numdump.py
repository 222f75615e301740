# SPDX-License-Identifier: MIT
"""Dumps with offsets whose words are no digits in fixed width: decimal numbers of od and hexdump -d, and characters.

What `od -c` and `hexdump -c` print is clear for each byte; what `od -a` prints is not, as it leaves out the high bit.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from io import BufferedReader
from itertools import pairwise
from typing import Final, NamedTuple

from argus_tools.catalogue import HELP
from argus_tools.chunks import Chunk, Damage, DamageList, Format, LogError, Offsets, ReadOptions
from argus_tools.formats.bin import guess_direction
from argus_tools.formats.hexdump import REPEATED, DumpStream, likeness
from argus_tools.formats.source import HEAD_BYTES
from argus_tools.formats.text import first_lines, is_passed, numbered_lines

_LINE_MAX: Final = 4096
_LINE: Final = re.compile(rb"[ \t]*([0-9A-Fa-f]{6,16})(?:[ \t]([^\r\n]*))?\s*")
_NUMBERS: Final = re.compile(rb"(?:\s*-?\d{1,20}(?=\s|\Z))+\s*")
_CELL: Final = 4
_LAST_CELLS: Final = 16
_ESCAPES: Final = {b"\\0": 0, b"\\a": 7, b"\\b": 8, b"\\t": 9, b"\\n": 10, b"\\v": 11, b"\\f": 12, b"\\r": 13}
_OCTAL: Final = re.compile(rb"[0-3][0-7]{2}")
_SIZES: Final = (1, 2, 4, 8)
_BASES: Final = (8, 16, 10)
# Words that are all as wide as these are of hexdump.py.
_FIXED: Final = (2, 3, 4, 6, 8, 11, 16)
_SPACE: Final = 32


class _Row(NamedTuple):
    """One line: its offset as it stands there, and its words as numbers."""

    offset: bytes
    values: tuple[int, ...]


def _numbers(text: bytes) -> tuple[int, ...] | None:
    return tuple(map(int, text.split())) if _NUMBERS.fullmatch(text) else None


def _character(cell: bytes) -> int | None:
    mark = cell.lstrip(b" ")
    if not mark:
        return _SPACE
    if _OCTAL.fullmatch(mark):
        return int(mark, 8)
    if len(mark) == 1 and mark.isascii():
        return mark[0]
    return _ESCAPES.get(mark)


def _characters(text: bytes) -> tuple[int, ...] | None:
    # The first space of a cell stands between the offset and the text.
    text = b" " + text
    if len(text) > _CELL * _LAST_CELLS + 1:
        return None
    # A mail may have lost the spaces at the end.
    text = text[: _CELL * _LAST_CELLS].ljust(-(-len(text) // _CELL) * _CELL)
    values = [_character(text[at : at + _CELL]) for at in range(0, len(text), _CELL)]
    return None if None in values else tuple(value for value in values if value is not None)


def _row(line: bytes, take: Callable[[bytes], tuple[int, ...] | None]) -> _Row | None:
    match = _LINE.fullmatch(line)
    if match is None:
        return None
    if not (match[2] or b"").strip():
        return _Row(match[1], ())
    values = take(match[2])
    return None if values is None else _Row(match[1], values)


@dataclass(frozen=True)
class _Plan:
    """What the first lines tell of all of them."""

    take: Callable[[bytes], tuple[int, ...] | None]
    size: int
    base: int
    is_swapped: bool = True

    def data(self, row: _Row) -> bytes | None:
        """Return a row's bytes; None if a number has more."""
        order = "little" if self.is_swapped else "big"
        most = 1 << 8 * self.size
        if not all(-most // 2 <= value < most for value in row.values):
            return None
        return b"".join((value % most).to_bytes(self.size, order) for value in row.values)  # type: ignore[arg-type]

    def offset(self, row: _Row) -> int | None:
        """Return where a row stands; None if that is no number of the base."""
        try:
            return int(row.offset, self.base)
        except ValueError:
            return None


def _rows(lines: list[bytes], take: Callable[[bytes], tuple[int, ...] | None]) -> list[_Row]:
    return [row for line in lines if (row := _row(line, take))]


def _steps(rows: list[_Row], plan: _Plan) -> int:
    """How often the next offset is where a line's bytes end."""
    count = 0
    for before, after in pairwise(rows):
        begin, end = plan.offset(before), plan.offset(after)
        if begin is not None and end is not None and plan.data(before):
            full = len(before.values) * plan.size
            # The last number may be filled up.
            count += begin < end <= begin + full and end - begin > full - plan.size
    return count


def _is_fixed(lines: list[bytes]) -> bool:
    words = [word for line in lines for word in line.split()[1:]]
    return len({*map(len, words)}) == 1 and len(words[0]) in _FIXED


def _plan(head: bytes) -> _Plan | None:
    lines = first_lines(head)
    if not lines or _is_fixed(lines):
        return None
    for take, sizes in ((_numbers, _SIZES), (_characters, (1,))):
        rows = _rows(lines, take)
        if 2 * len(rows) < len(lines) or not any(row.values for row in rows):
            continue
        plans = [_Plan(take, size, base) for size in sizes for base in _BASES]
        best = max(plans, key=lambda plan: _steps(rows, plan))
        if 2 * _steps(rows, best) > len(rows) - 1:
            return _turned(best, rows)
    return None


def _turned(plan: _Plan, rows: list[_Row]) -> _Plan:
    """Choose the order of bytes in which these are more like a link's."""
    other = _Plan(plan.take, plan.size, plan.base, is_swapped=False)
    here, there = (likeness(_joined(one, rows)) for one in (plan, other))
    return other if there > here else plan


def _joined(plan: _Plan, rows: list[_Row]) -> bytes:
    return b"".join(plan.data(row) or b"" for row in rows)


class NumDumpReader:
    """Reads such a dump line by line."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._options = options

    def __iter__(self) -> Iterator[Chunk]:
        head = self._stream.peek(HEAD_BYTES)
        plan = _plan(head)
        if plan is None:
            raise LogError(f"{self._options.name}: no dump with offsets, as od or hexdump write it")
        sample = _joined(plan, _rows(first_lines(head, _LINE_MAX), plan.take))
        stream = DumpStream(self._options.direction or guess_direction(sample))
        offsets = Offsets()
        for number, text in numbered_lines(self._stream, _LINE_MAX):
            if text.strip() == REPEATED:
                stream.is_repeated = bool(stream.full)
                continue
            for part in self._take(text, number, plan, stream):
                yield offsets.chunk(None, stream.direction, part)
        if data := stream.finish():
            yield offsets.chunk(None, stream.direction, data)

    def _take(self, text: bytes, number: int, plan: _Plan, stream: DumpStream) -> Iterator[bytes]:
        row = _row(text, plan.take)
        at = plan.offset(row) if row else None
        data = plan.data(row) if row else None
        if at is None or data is None:
            if text.strip() and not is_passed(text):
                self.damage.append(Damage(f"line {number}", "no line of a dump"))
            return
        yield from (part for part in stream.take(at, data) if part)
        for what in stream.damage:
            self.damage.append(Damage(f"line {number}", what))
        stream.damage.clear()


FORMAT: Final = Format(
    name="numdump",
    help=HELP["numdump"],
    sniff=lambda head: _plan(head) is not None,
    reader=NumDumpReader,
)
