# SPDX-License-Identifier: MIT
"""What the readers of text share: whether bytes are text, without marks, its first lines, long lines in pieces."""

from __future__ import annotations

import re
from collections.abc import Iterator
from io import BufferedReader, RawIOBase
from itertools import islice
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from _typeshed import WriteableBuffer

BOM: Final = b"\xef\xbb\xbf"
PIECE_BYTES: Final = 1 << 14
_FIRST_LINES: Final = 64
_BEGINNING: Final = 1 << 8
_BLOCK: Final = 1 << 17
_LINE_MAX: Final = 1 << 14
# Control characters that no text has; ESC is of colours.
_BINARY: Final = re.compile(rb"[\x00-\x06\x0e-\x1a\x1c-\x1f\x7f]")
_WORD_END: Final = re.compile(rb"[\s,;](?=[^\s,;]*\Z)")
# What "follow stream" of tshark writes before the bytes, and behind them.
_FOLLOW: Final = re.compile(rb"={20,}\s*\Z|(?:Follow|Filter|Node [01]): ")
# What stands over the columns of a dump.
_OVER_COLUMNS: Final = re.compile(
    rb"\s*(?:(?:Offset|Address)\S*\s+)?00 01 02 03 04 05 06 07\b", re.IGNORECASE
)


def is_passed(line: bytes) -> bool:
    """Whether a line of text is a comment, or a line of headings that some tool writes round the bytes."""
    return line.startswith(b"#") or bool(_FOLLOW.match(line) or _OVER_COLUMNS.match(line))


def is_text(head: bytes) -> bool:
    """Whether these bytes can be text of ASCII, its extensions or UTF-8."""
    return not _BINARY.search(head)


def begins_as_text(head: bytes) -> bool:
    """Whether a file that begins so may be text; further on there may be zeros that a power cut left."""
    return is_text(head[:_BEGINNING])


def ends_in_returns(head: bytes) -> bool:
    """Whether the lines of a text end in a CR alone: more of these stand there than LFs."""
    return head.count(b"\r") - head.count(b"\r\n") > head.count(b"\n")


def with_line_feeds(text: bytes) -> bytes:
    """Return a text whose lines all end in LF."""
    return text.replace(b"\r\n", b"\n").replace(b"\r", b"\n")


COLOUR: Final = re.compile(
    rb"\x1b(?:\[[0-9;:?>=!]*[A-Za-z@]|[()][0-9A-Za-z]|[=>78MDE]|\][^\x07\x1b\r\n]{0,256}(?:\x07|\x1b\\))"
)
"""What a terminal takes for a colour, a place, a set of characters or a title, and no letter."""
_COLOUR_BEGUN: Final = re.compile(rb"\x1b(?:\[[0-9;:?>=!]*|[()]|\][^\x07\x1b\r\n]{0,256}\x1b?)?\Z")


def _without_marks(text: bytes) -> bytes:
    return text.replace(b"\n" + BOM, b"\n")


def unmarked(head: bytes) -> bytes:
    """Return the beginning of a file as `Unmarked` gives it; bytes that are no text stay as they are."""
    if not begins_as_text(head):
        return head
    text = COLOUR.sub(b"", with_line_feeds(head) if ends_in_returns(head) else head)
    return _without_marks(b"\n" + text)[1:]


class Rewritten(RawIOBase):
    """A stream of which each block is written anew."""

    def __init__(self, stream: BufferedReader) -> None:
        self._stream = stream
        self._ready = b""

    def readable(self) -> bool:
        """It is for reading only."""
        return True

    def readinto(self, buffer: WriteableBuffer, /) -> int:
        """Fill the buffer with what there is; 0 at the end."""
        while not self._ready:
            data = self._stream.read1(_BLOCK)
            self._ready = self._rewrite(data)
            if not data:
                break
        view = memoryview(buffer).cast("B")
        taken = self._ready[: len(view)]
        view[: len(taken)] = taken
        self._ready = self._ready[len(taken) :]
        return len(taken)

    def _rewrite(self, data: bytes) -> bytes:
        """Return what is sure by now; no data: the end, nothing may wait."""
        raise NotImplementedError


class RewrittenLines(Rewritten):
    """A stream of which each line is written anew."""

    def __init__(self, stream: BufferedReader) -> None:
        super().__init__(stream)
        self._line = b""
        self._begins = True

    def _rewrite(self, data: bytes) -> bytes:
        """Return whole lines; what is begun waits, unless it is long."""
        lines = (self._line + data).splitlines(keepends=True)
        waits = bool(lines) and bool(data) and not lines[-1].endswith(b"\n") and len(lines[-1]) < _LINE_MAX
        self._line = lines.pop() if waits else b""
        return b"".join(map(self._part, lines))

    def _part(self, line: bytes) -> bytes:
        begins, self._begins = self._begins, line.endswith(b"\n")
        return self._rewrite_line(line, begins)

    def _rewrite_line(self, line: bytes, begins: bool) -> bytes:
        """Return a line, or part of a long one; `begins`: it is the beginning of one."""
        raise NotImplementedError


class LineFeeds(Rewritten):
    """A text whose lines end in a CR alone, with an LF instead."""

    def __init__(self, stream: BufferedReader) -> None:
        super().__init__(stream)
        self._held = b""

    def _rewrite(self, data: bytes) -> bytes:
        """Return what is sure: a CR at the end of a block may have its LF in the next one."""
        text = self._held + data
        self._held = b"\r" if data and text.endswith(b"\r") else b""
        return with_line_feeds(text.removesuffix(self._held) if self._held else text)


class Colourless(Rewritten):
    """A text without what a terminal takes for colours."""

    def __init__(self, stream: BufferedReader) -> None:
        super().__init__(stream)
        self._held = b""

    def _rewrite(self, data: bytes) -> bytes:
        """Return what is sure: the end of a block may be the beginning of a colour."""
        text = self._held + data
        begun = _COLOUR_BEGUN.search(text) if data else None
        self._held = begun[0] if begun else b""
        return COLOUR.sub(b"", text[: begun.start()] if begun else text)


class Unmarked(Rewritten):
    """A text without its mark, and without those that stand before a line where files were joined."""

    def __init__(self, stream: BufferedReader) -> None:
        super().__init__(stream)
        self._held = b"\n"

    def _rewrite(self, data: bytes) -> bytes:
        """Return what is sure: `_held` begins with what was given out last, and may go on as a mark begins."""
        text = _without_marks(self._held + data)
        waits = next((n for n in (2, 1) if data and text.endswith(b"\n" + BOM[:n])), 0)
        self._held = text[-1 - waits :]
        return text[1 : len(text) - waits]


def first_lines(head: bytes, count: int = _FIRST_LINES) -> list[bytes]:
    """Return the first lines of text that are neither blank nor comments (#); none if it is no text."""
    if not begins_as_text(head):
        return []
    lines = (line for line in head.splitlines() if line.strip() and not is_passed(line) and is_text(line))
    return list(islice(lines, count))


def numbered_lines(stream: BufferedReader, most: int) -> Iterator[tuple[int, bytes]]:
    """Yield number from 1 and bytes of each line; at most MOST bytes are one line."""
    return enumerate(iter(lambda: stream.readline(most), b""), start=1)


def pieces(stream: BufferedReader) -> Iterator[tuple[int, bytes, bool]]:
    """Yield line number, bytes and whether a line begins there; a long line comes in pieces, cut between words."""
    number, held, begins = 1, b"", True
    while line := stream.readline(PIECE_BYTES):
        line, held = held + line, b""
        ends = line.endswith(b"\n")
        if not ends and len(line) >= PIECE_BYTES:
            space = _WORD_END.search(line, len(line) - 64)
            # Without any space they are digits in pairs.
            cut = space.end() if space else len(line) & ~1
            line, held = line[:cut], line[cut:]
        yield number, line, begins
        begins = ends
        number += ends
    if held:
        yield number, held, begins
