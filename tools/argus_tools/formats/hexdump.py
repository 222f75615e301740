# SPDX-License-Identifier: MIT
"""Dumps with an offset in each line, as hexdump, xxd, od and Wireshark write them, back to the bytes.

The base of the offsets, the width of the words and their byte order are found from the first lines.
"""

from __future__ import annotations

import re
from binascii import unhexlify
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BufferedReader
from itertools import pairwise
from typing import Final

from argus_tools.catalogue import HELP
from argus_tools.chunks import (
    Chunk,
    Damage,
    DamageList,
    Direction,
    Format,
    LogError,
    Offsets,
    ReadOptions,
    other_direction,
)
from argus_tools.formats.bin import guess_direction
from argus_tools.formats.marks import has_both_sides, mark_at
from argus_tools.formats.source import HEAD_BYTES
from argus_tools.formats.text import first_lines, is_passed, numbered_lines
from hil_sim.arcos import Unframer

HEADER: Final = b"\xfa\xfb"
# A line of asterisks stands for as many bytes as the offsets say; not for more than this.
_REPEATED_MAX: Final = 1 << 24
_PIECE: Final = 1 << 16
_LINE_MAX: Final = 4096
_LINE: Final = re.compile(rb"([ \t]*)([0-9A-Fa-f]{4,16})(:?)(?:[ \t]+(\S.*?))?\s*", re.DOTALL)
REPEATED: Final = b"*"
# Of a single line, shorter digits may be anything.
_OFFSET_MIN: Final = 6
# Where the characters of a line begin: Wireshark puts three spaces before them, the others a mark.
_COLUMN: Final = re.compile(rb"\s+[|>]|\s{3}|\t")
_MARK: Final = re.compile(rb"\s+[|>]")
# hexdump -x has gaps of its own between the words.
_WIDE: Final = re.compile(rb"[0-9A-Fa-f]+\s{4}\S")
# hexdump -C and "follow stream" of tshark have sixteen bytes in 48 columns, whatever stands behind them.
_SIXTEEN: Final = re.compile(rb"[0-9A-Fa-f]{2}(?: {1,2}[0-9A-Fa-f]{2}){0,15} *")
_SIXTEEN_WIDTH: Final = 48
_SIXTEEN_GAP: Final = re.compile(rb"[0-9A-Fa-f]{8}  (?! )")
# xxd puts them behind two spaces, in the same column in each line.
_XXD: Final = re.compile(rb"\s*[0-9A-Fa-f]+: \S+(?: \S+)*?  ")


_HEX: Final = 16
# The other direction may begin late.
_LINES_PLANNED: Final = 1 << 12


@dataclass(frozen=True)
class _Words:
    """How one line's words are written: digits in each, their base, bytes of each."""

    digits: int
    base: int
    size: int

    def size_of(self, word: bytes) -> int:
        """xxd and hexdump -C end in a shorter word."""
        return self.size if len(word) == self.digits else max(1, len(word) // 2)

    def fits(self, words: list[bytes]) -> bool:
        """Whether these are such words; the last of a line may be short."""
        if not _DIGITS[self.base].fullmatch(b"".join(words)):
            return False
        if any(len(word) != self.digits for word in words[:-1]) or len(words[-1]) > self.digits:
            return False
        return self.base != _HEX or not len(words[-1]) & 1

    def count(self, words: list[bytes]) -> int:
        return sum(map(self.size_of, words))

    def decode(self, words: list[bytes], is_swapped: bool) -> bytes:
        size = self.size
        if self.base == _HEX and (not is_swapped or size == 1 or not words or len(words[-1]) == self.digits):
            # Most lines of most dumps.
            data = unhexlify(b"".join(words))
            if not is_swapped or size == 1:
                return data
            turned = bytearray(len(data))
            for at in range(size):
                turned[at::size] = data[size - 1 - at :: size]
            return bytes(turned)
        out = bytearray()
        for word in words:
            size = self.size_of(word)
            value = int(word, self.base) & ((1 << 8 * size) - 1)
            out += value.to_bytes(size, "little" if is_swapped else "big")
        return bytes(out)


_WORDS: Final = {2: _Words(2, 16, 1), 3: _Words(3, 8, 1), 4: _Words(4, 16, 2), 6: _Words(6, 8, 2),
                 8: _Words(8, 16, 4), 11: _Words(11, 8, 4), 16: _Words(16, 16, 8)}  # fmt: skip
_BITS: Final = _Words(8, 2, 1)
_DIGITS: Final = {
    2: re.compile(rb"[01]+"),
    8: re.compile(rb"[0-7]+"),
    10: re.compile(rb"[0-9]+"),
    16: re.compile(rb"[0-9A-Fa-f]+"),
}


@dataclass(frozen=True)
class _Line:
    indent: bytes
    offset: bytes
    words: list[bytes]


def _parse(line: bytes, column: int | None) -> _Line | None:
    """Take a line apart; `column` is where xxd's characters begin."""
    match = _LINE.fullmatch(line)
    if match is None:
        return None
    indent, offset, colon, rest = match.groups()
    if colon:
        words = line[match.end(3) : column].split()
    else:
        words = (
            _sixteen(line, match)
            or (_MARK if _WIDE.match(line) else _COLUMN).split(rest or b"", maxsplit=1)[0].split()
        )
    if not words:
        return _Line(indent, offset, words)
    if not _DIGITS[_HEX].fullmatch(b"".join(words)) or (
        len(words[-1]) & 1 and len(words[-1]) < len(words[0])
    ):
        return None
    # Of a line's words only the last may be short.
    if len(set(map(len, words[:-1]))) > 1 or len(words[-1]) > len(words[0]):
        return None
    return _Line(indent, offset, words)


def _sixteen(line: bytes, match: re.Match[bytes]) -> list[bytes]:
    """Return the bytes of a line that has them in fixed columns, with any characters behind."""
    rest = line[match.start(4) :] if match[4] else b""
    body, behind = rest[:_SIXTEEN_WIDTH], rest[_SIXTEEN_WIDTH:]
    if not behind.startswith(b"  ") or not _SIXTEEN_GAP.match(line, match.start(2)):
        return []
    return body.split() if _SIXTEEN.fullmatch(body) else []


@dataclass
class _Plan:
    """What the first lines tell of all of them."""

    words: _Words
    base: int
    is_swapped: bool
    samples: dict[bool, bytes]
    column: int | None

    @property
    def two_indents(self) -> bool:
        return len(self.samples) > 1

    def key(self, line: _Line) -> bool:
        """Which of two directions a line is of: the other side's lines are indented."""
        return bool(line.indent) and self.two_indents


def _plan(head: bytes) -> _Plan | None:
    texts = first_lines(head)
    column = next((match.end() for text in texts if (match := _XXD.match(text))), None)
    lines = [found for text in texts if (found := _parse(text, column))]
    full = [line for line in lines if line.words]
    if not full:
        return None
    words = _words(full)
    if words is None:
        return None
    full = [line for line in full if words.fits(line.words)]
    is_swapped = words.size > 1 and _is_swapped(words, full)
    samples = _samples(first_lines(head, _LINES_PLANNED), column, words, is_swapped)
    return _Plan(words, _base(lines, words), is_swapped, samples, column)


def _is_swapped(words: _Words, lines: list[_Line]) -> bool:
    """Whether these are more like a link's bytes with those of each word turned round."""
    natural, swapped = (
        likeness(b"".join(words.decode(line.words, turn) for line in lines)) for turn in (False, True)
    )
    return swapped > natural


def _samples(texts: list[bytes], column: int | None, words: _Words, is_swapped: bool) -> dict[bool, bytes]:
    """Return the bytes of these lines, apart for those that are indented where there are two kinds."""
    samples: dict[bytes, bytes] = {}
    for text in texts:
        line = _parse(text, column)
        if line and line.words and words.fits(line.words):
            samples[line.indent] = samples.get(line.indent, b"") + words.decode(line.words, is_swapped)
    if len(samples) == 2 and b"" in samples:
        return {bool(indent): data for indent, data in samples.items()}
    return {False: b"".join(samples.values())}


def likeness(data: bytes) -> tuple[int, int]:
    """How much these bytes are like a link's: whole packets, then headers."""
    return sum(1 for _ in Unframer().feed(data)), data.count(HEADER)


def _words(lines: list[_Line]) -> _Words | None:
    all_words = [word for line in lines for word in line.words]
    width = len(all_words[0])
    if width == _BITS.digits and all(_DIGITS[2].fullmatch(word) for word in all_words):
        return _BITS
    found = _WORDS.get(width)
    if found and all(_DIGITS[found.base].fullmatch(word) for word in all_words):
        return found
    return None


def _base(lines: list[_Line], words: _Words) -> int:
    """Find the base in which the offsets rise by the bytes of a line."""
    for base in (16, 8, 10):
        try:
            fits = [
                int(after.offset, base) - int(before.offset, base) == words.count(before.words)
                for before, after in pairwise(lines)
                if before.indent == after.indent and after.words
            ]
        except ValueError:
            continue
        if not fits or 2 * sum(fits) > len(fits):
            return base
    return 16


@dataclass
class DumpStream:
    """One direction; a line waits for the next one's offset, which says how many bytes are really in it."""

    direction: Direction
    expected: int | None = None
    held: bytes = b""
    full: bytes = b""
    is_repeated: bool = False
    damage: list[str] = field(default_factory=list)

    def take(self, offset: int, data: bytes) -> Iterator[bytes]:
        """Take the bytes of the next line; yield those of the line before."""
        if self.expected is not None:
            yield from self._release(offset)
        self.held = data
        if data:
            self.full = data
        self.is_repeated = False
        self.expected = offset + len(data)

    def finish(self) -> bytes:
        """Return the bytes of the last line."""
        data, self.held = self.held, b""
        return data

    def _release(self, offset: int) -> Iterator[bytes]:
        assert self.expected is not None
        begin = self.expected - len(self.held)
        if begin < offset < self.expected:
            # The last word was filled up.
            yield self.held[: offset - begin]
            return
        yield self.held
        missing = offset - self.expected
        if missing > 0 and self.is_repeated and missing <= _REPEATED_MAX:
            block = self.full * (_PIECE // len(self.full) or 1)
            for at in range(0, missing, len(block)):
                yield block[: missing - at]
        elif missing > 0:
            self.damage.append(f"{missing} bytes are missing before offset {offset:#x}")
        elif missing < 0 and offset:
            self.damage.append(f"the offsets go back from {self.expected:#x} to {offset:#x}")


class HexdumpReader:
    """Reads such a dump line by line; of Wireshark's "follow stream" the two indents are the two directions."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._options = options

    def __iter__(self) -> Iterator[Chunk]:
        plan = _plan(self._stream.peek(HEAD_BYTES))
        if plan is None:
            raise LogError(f"{self._options.name}: no dump with offsets, as hexdump -C, xxd or od write it")
        offsets = Offsets()
        streams = self._streams(plan)
        last = next(iter(streams.values()))
        for number, text in numbered_lines(self._stream, _LINE_MAX):
            if text.strip() == REPEATED:
                last.is_repeated = bool(last.full)
                continue
            line = _parse(text, plan.column)
            data = None if line is None else self._bytes(plan, line)
            if line is None or data is None:
                if text.strip() and not is_passed(text):
                    self.damage.append(Damage(f"line {number}", "no line of a dump"))
                continue
            last = streams[plan.key(line)]
            for part in last.take(int(line.offset, plan.base), data):
                if part:
                    yield offsets.chunk(None, last.direction, part)
            for what in last.damage:
                self.damage.append(Damage(f"line {number}", what))
            last.damage.clear()
        for stream in streams.values():
            if data := stream.finish():
                yield offsets.chunk(None, stream.direction, data)

    def _bytes(self, plan: _Plan, line: _Line) -> bytes | None:
        if line.words and not plan.words.fits(line.words):
            return None
        if not _DIGITS[plan.base].fullmatch(line.offset):
            return None
        return plan.words.decode(line.words, plan.is_swapped)

    def _streams(self, plan: _Plan) -> dict[bool, DumpStream]:
        outer = guess_direction(plan.samples[False])
        if plan.two_indents:
            return {False: DumpStream(outer), True: DumpStream(other_direction(outer))}
        return {False: DumpStream(self._options.direction or outer)}


def _sniff(head: bytes) -> bool:
    """Half of the first lines or more are of a dump, and their offsets rise by what stands in them."""
    plan = _plan(head)
    if plan is None:
        return False
    lines = first_lines(head)
    each = [_parse(line, plan.column) for line in lines]
    parsed = [found for found in each if found]
    if 2 * len(parsed) < len(lines):
        return False
    # Where lines between say whose the bytes are, both sides stand in one column.
    others = (mark_at(line.lstrip()) for line, found in zip(lines, each, strict=True) if not found)
    if has_both_sides(mark.name for mark in others if mark):
        return False
    pairs = [(a, b) for a, b in pairwise(parsed) if a.words and b.words and a.indent == b.indent]
    if not pairs:
        # A count of seconds since 1970 is as long, but does not begin so.
        return plan.column is not None or (
            len(parsed[0].offset) > _OFFSET_MIN and parsed[0].offset.startswith(b"0")
        )
    try:
        steps = [
            int(b.offset, plan.base) - int(a.offset, plan.base) == plan.words.count(a.words) for a, b in pairs
        ]
    except ValueError:
        return False
    return 2 * sum(steps) > len(steps)


FORMAT: Final = Format(
    name="hexdump",
    help=HELP["hexdump"],
    sniff=_sniff,
    reader=HexdumpReader,
)
