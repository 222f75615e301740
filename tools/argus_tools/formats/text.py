# SPDX-License-Identifier: MIT
"""What the readers of text share: whether bytes are text, its first lines, and long lines in pieces."""

from __future__ import annotations

import re
from collections.abc import Iterator
from io import BufferedReader
from typing import Final

BOM: Final = b"\xef\xbb\xbf"
PIECE_BYTES: Final = 1 << 14
_FIRST_LINES: Final = 64
_BEGINNING: Final = 1 << 8
# Control characters that no text has; ESC is of colours.
_BINARY: Final = re.compile(rb"[\x00-\x06\x0e-\x1a\x1c-\x1f\x7f]")
_WORD_END: Final = re.compile(rb"[\s,;](?=[^\s,;]*\Z)")
# What "follow stream" of tshark writes before the bytes, and behind them.
_FOLLOW: Final = re.compile(rb"={20,}\s*\Z|(?:Follow|Filter|Node [01]): ")


def is_passed(line: bytes) -> bool:
    """Whether a line of text is a comment, or a line of headings that some tool writes round the bytes."""
    return line.startswith(b"#") or bool(_FOLLOW.match(line))


def is_text(head: bytes) -> bool:
    """Whether these bytes can be text of ASCII, its extensions or UTF-8."""
    return not _BINARY.search(head)


def first_lines(head: bytes, count: int = _FIRST_LINES) -> list[bytes]:
    """Return the first lines of text that are neither blank nor comments (#); none if it is no text."""
    if not is_text(head[:_BEGINNING]):
        return []
    lines = head.removeprefix(BOM).splitlines()
    # Further on there may be zeros that a power cut left.
    return [line for line in lines[: 4 * count] if line.strip() and not is_passed(line) and is_text(line)][
        :count
    ]


def numbered_lines(stream: BufferedReader, most: int) -> Iterator[tuple[int, bytes]]:
    """Yield number from 1 and bytes of each line, without the BOM of the first; at most MOST bytes are one line."""
    for number, line in enumerate(iter(lambda: stream.readline(most), b""), start=1):
        yield number, line.removeprefix(BOM) if number == 1 else line


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
