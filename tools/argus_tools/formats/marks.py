# SPDX-License-Identifier: MIT
"""Marks of direction that programs write before the bytes: which words they are, and which side each is of."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Final, NamedTuple

from argus_tools.chunks import CLIENT_TO_ROBOT, ROBOT_TO_CLIENT, Direction
from argus_tools.formats.bin import guess_direction

_TO_ROBOT: Final = (
    "TX", "TXD", "TRANSMIT", "TRANSMITTED", "SENT", "SEND", "SENDING", "WRITE", "WRITTEN", "WROTE", "OUT", "OUTGOING",
    "OUTPUT", "SND", "HOST", "C2R",
)  # fmt: skip
_FROM_ROBOT: Final = (
    "RX", "RXD", "RECV", "RECEIVE", "RECEIVED", "RECEIVING", "READ", "IN", "INCOMING", "INPUT", "RCV", "DEVICE", "R2C",
)  # fmt: skip
UNTOLD: Final = "no line says who sent it"
# What a Chinese terminal program writes, in UTF-8 and in GBK: sent, received.
_SENT: Final = ("\u53d1".encode(), "\u53d1".encode("gbk"))
_RECEIVED: Final = ("\u6536".encode(), "\u6536".encode("gbk"))
_ARROWS: Final = rb"-*>{1,3}|<{1,3}-*"
_WORDS: Final = "|".join(sorted((*_TO_ROBOT, *_FROM_ROBOT), key=len, reverse=True)).encode()
_OUT: Final = frozenset((*(word.encode() for word in _TO_ROBOT), *_SENT, b">", b">>", b">>>"))

# At the beginning of a line, with what parts it from the bytes.
_AT_ONCE: Final = re.compile(
    rb"[\[(<]?(?P<mark>" + _WORDS + rb"|" + _ARROWS + rb")[\])>]?[ \t]*[:=|-]?(?:[ \t]+|\Z)", re.IGNORECASE
)
# Anywhere before the bytes: a word alone, or the mark of a Chinese program.
_AMONG: Final = re.compile(
    rb"(?<![0-9A-Za-z])(?P<word>" + _WORDS + rb")(?![0-9A-Za-z])"
    rb"|(?<![^\s\[\](),;:|])(?P<arrow>" + _ARROWS + rb")(?![^\s\[\](),;:|])"
    rb"|(?P<sign>" + b"|".join((*_SENT, *_RECEIVED)) + rb")",
    re.IGNORECASE,
)


class Mark(NamedTuple):
    """A mark, as all of its kind are written, and where what it stands before begins."""

    name: bytes
    end: int
    is_word: bool = True


def _named(text: bytes) -> bytes:
    return text.upper().replace(b"-", b"")


def mark_at(text: bytes) -> Mark | None:
    """Return the mark that a text begins with."""
    match = _AT_ONCE.match(text)
    return Mark(_named(match["mark"]), match.end()) if match else None


def marks_in(text: bytes) -> list[Mark]:
    """Return the marks among other words, the last first; words before arrows, which may stand behind a name."""
    found = [Mark(_named(match[0]), match.end(), not match["arrow"]) for match in _AMONG.finditer(text)]
    return sorted(reversed(found), key=lambda mark: not mark.is_word)


def has_both_sides(names: Iterable[bytes]) -> bool:
    """Whether some of these marks are of what was sent, and some of what was received."""
    return len({name in _OUT for name in names if name}) > 1


def directions(samples: Mapping[bytes, bytes], asked: Direction | None) -> dict[bytes, Direction]:
    """Say which direction each mark is; what a client calls sent goes to the robot, if the bytes do not deny it.

    The empty mark is of what has none.
    """
    found: dict[bytes, Direction] = {b"": asked or guess_direction(b"".join(samples.values()))}
    marked = {name: data for name, data in samples.items() if name}
    turned = any(name in _OUT and guess_direction(data) == ROBOT_TO_CLIENT for name, data in marked.items())
    for name in marked:
        found[name] = CLIENT_TO_ROBOT if (name in _OUT) != turned else ROBOT_TO_CLIENT
    return found
