# SPDX-License-Identifier: MIT
"""Lines of base64, alone or among others: which they are, and the command that gets the bytes out of them."""

from __future__ import annotations

import re
from base64 import b64decode
from binascii import Error as Base64Error
from collections.abc import Iterator
from functools import lru_cache
from itertools import groupby
from typing import Final, NamedTuple

from argus_tools.formats.source import HEAD_BYTES
from argus_tools.formats.text import begins_as_text
from hil_sim.arcos import Unframer

_DIGITS: Final = rb"[A-Za-z0-9+/_-]"
# A line of nothing else, but for a quotation; the last one of a block may be short. Or the last word of a line.
_ALONE: Final = re.compile(rb"[> \t]*(" + _DIGITS + rb"{2,}={0,2})\s*")
_LAST_WORD: Final = re.compile(rb".*[\s,:;\"'=|]\"?(" + _DIGITS + rb"{8,}={0,2})[\"']?,?\s*", re.DOTALL)
# A word of prose at the beginning of a block would shift all; whole groups of four digits do not.
_WAYS: Final = ((_ALONE, 1), (_ALONE, 4), (_LAST_WORD, 4))
_WEB: Final = rb"_-"
_BLOCK_MIN: Final = 16
# How what is worth to be saved begins: gzip, captures, and lines of candump.
_MARKS: Final = re.compile(
    rb"\x1f\x8b\x08|\xd4\xc3\xb2\xa1|\xa1\xb2\xc3\xd4|\x4d\x3c\xb2\xa1|\n\r\r\n|ARGUSREC|\(\d+\.\d+\) \S+ [0-9A-F]{3}#"
)


class Block(NamedTuple):
    """Lines of base64: the first and the last (None: up to the end), and what is to be done with them."""

    first: int
    last: int | None
    is_all: bool
    is_behind: bool
    is_of_web: bool

    def remedy(self) -> str:
        """Return the command that gets the bytes out of these lines."""
        if self.is_all and not self.is_of_web and not self.is_behind:
            return "base64 -di FILE > drive.bin"
        steps = [f"sed -n '{self.first},{self.last or '$'}p' FILE"]
        if self.is_of_web:
            steps.append("tr '_-' '/+'")
        if self.is_behind:
            steps.append("grep -oE '[A-Za-z0-9+/]{8,}={0,2}[^A-Za-z0-9+/=]*$'")
        return " | ".join([*steps, "base64 -di > drive.bin"])


def remedy_of(head: bytes) -> str:
    """Return the command for a text that holds base64."""
    block = find(head)
    return block.remedy() if block else "base64 -di FILE > drive.bin"


@lru_cache(maxsize=1)
def find(head: bytes) -> Block | None:
    """Return the lines of base64 in a text that hold bytes of a link, or a log of them."""
    if not begins_as_text(head):
        return None
    lines = head.splitlines()
    return next((block for way in _WAYS for block in _blocks(lines, *way, head)), None)


def _word(line: bytes, pattern: re.Pattern[bytes], unit: int) -> bytes:
    match = pattern.fullmatch(line)
    return match[1] if match and not len(match[1]) % unit else b""


def _blocks(lines: list[bytes], pattern: re.Pattern[bytes], unit: int, head: bytes) -> Iterator[Block]:
    found = [_word(line, pattern, unit) for line in lines]
    at = 0
    written = sum(bool(line.strip()) for line in lines)
    for is_one, group in groupby(found, key=bool):
        words = list(group)
        if is_one and _is_log(_decoded(words)):
            is_cut = at + len(words) == len(lines) and len(head) >= HEAD_BYTES
            is_of_web = any(byte in _WEB for word in words for byte in word)
            last = None if is_cut else at + len(words)
            yield Block(at + 1, last, len(words) == written, pattern is _LAST_WORD, is_of_web)
        at += len(words)


def _decoded(words: list[bytes]) -> bytes:
    """Decode words that go on from each other, or of which each is filled up for itself."""
    if sum(map(len, words)) < _BLOCK_MIN:
        return b""
    if any(word.endswith(b"=") for word in words[:-1]):
        return b"".join(map(_decode, words))
    return _decode(b"".join(words))


def _decode(word: bytes) -> bytes:
    try:
        return b64decode(word[: len(word) & ~3], altchars=b"-_" if re.search(rb"[-_]", word) else None)
    except Base64Error:
        return b""


def _is_log(data: bytes) -> bool:
    return bool(_MARKS.match(data)) or any(len(packet) > 1 for packet in Unframer().feed(data))
