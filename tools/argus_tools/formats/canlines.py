# SPDX-License-Identifier: MIT
"""Lines of one CAN frame each, as other programs than candump print them: python-can, BUSMASTER, CRTD."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from io import BufferedReader
from typing import Final

from argus_tools.chunks import Chunk, Damage, DamageList, Format, ReadOptions
from argus_tools.formats.isotp import CanLink
from argus_tools.formats.text import first_lines

_LINE_MAX: Final = 4096
_LONG_DIGITS: Final = 4
_BYTES: Final = r"(?P<data>(?:[0-9A-Fa-f]{2}(?:\s+|$))*)"


@dataclass(frozen=True)
class _Kind:
    """One program's lines: groups t or h, m, s and f, then id, data and, where they are told, long, size and bus."""

    name: str
    line: re.Pattern[str]
    frame: re.Pattern[str]


# `line` matches also what has no data; `frame` what has.
_KINDS: Final = (
    _Kind(
        "python-can",
        re.compile(r"\s*Timestamp:\s+\d+\.\d+\s+ID:\s+[0-9a-f]+\s"),
        re.compile(
            r"\s*Timestamp:\s+(?P<t>\d+\.\d+)\s+ID:\s+(?P<id>[0-9a-f]+)\s+(?P<long>[SX])\s+(?:[RT]x\s+)?(?:F\s*)?(?:BS|EI|\s)*"
            r"DL:\s+(?P<size>\d+)\s+" + _BYTES + r"(?:'.*'\s*)?(?:Channel:\s*(?P<bus>\S+))?\s*$"
        ),
    ),
    _Kind(
        "BUSMASTER",
        re.compile(r"\d\d?:\d\d:\d\d:\d{4}\s+[RT]x\s+\d+\s+0x"),
        re.compile(
            r"(?P<h>\d\d?):(?P<m>\d\d):(?P<s>\d\d):(?P<f>\d{4})\s+[RT]x\s+(?P<bus>\d+)\s+0x(?P<id>[0-9A-Fa-f]+)\s+"
            r"(?P<long>[sx])\s+(?P<size>\d+)\s+" + _BYTES + "$"
        ),
    ),
    _Kind(
        "CRTD",
        re.compile(r"\d+\.\d+\s+\d?[RT](?:11|29)\s"),
        re.compile(
            r"(?P<t>\d+\.\d+)\s+(?P<bus>\d?)[RT](?P<long>11|29)\s+(?P<id>[0-9A-Fa-f]+)(?:\s+|$)"
            + _BYTES
            + "$"
        ),
    ),
)
_LONG: Final = ("X", "x", "29")
# What else such a program writes between its frames.
_PASSED: Final = re.compile(r"\s*(?:#|\*\*\*|\d+\.\d+\s+\d?C)")


class CanLinesReader:
    """Reads the lines of the program that the first of them is of."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._link = CanLink(options, self.damage, "line")

    @property
    def place(self) -> str:
        """Where in the file the last chunk ends."""
        return self._link.place

    def __iter__(self) -> Iterator[Chunk]:
        kind: _Kind | None = None
        number = 0
        while line := self._stream.readline(_LINE_MAX):
            number += 1
            text = line.decode("latin-1").rstrip()
            kind = kind or next((one for one in _KINDS if one.line.match(text)), None)
            match = kind.frame.match(text) if kind else None
            if match is None:
                self._complain(kind, text, number)
                continue
            can_id, is_long = int(match["id"], 16), match["long"] in _LONG
            direction = self._link.direction(match.groupdict().get("bus") or "", can_id, is_long, number)
            if direction is None:
                continue
            data = bytes.fromhex(match["data"])
            size = int(match.groupdict().get("size") or len(data))
            if len(data) != size:
                self.damage.append(Damage(f"line {number}", f"{len(data)} of a frame's {size} bytes"))
                continue
            yield from self._link.take(_seconds(match), direction, data, number)
        yield from self._link.finish()

    def _complain(self, kind: _Kind | None, text: str, number: int) -> None:
        if (
            text
            and not _PASSED.match(text)
            and not (kind and kind.line.match(text) and _is_without_data(text))
        ):
            self.damage.append(Damage(f"line {number}", f"no line of {kind.name if kind else 'CAN frames'}"))


def _is_without_data(text: str) -> bool:
    """Remote and error frames are passed over."""
    return bool(re.search(r"\s(?:R|E|sr|xr|er)\s", text))


def _seconds(match: re.Match[str]) -> float:
    groups = match.groupdict()
    if groups.get("t"):
        return float(groups["t"])
    return int(groups["h"]) * 3600 + int(groups["m"]) * 60 + int(groups["s"]) + int(groups["f"]) / 10_000


def _sniff(head: bytes) -> bool:
    lines = [line.decode("latin-1") for line in first_lines(head)]
    return any(kind.line.match(line) for kind in _KINDS for line in lines)


FORMAT: Final = Format(
    name="can-lines",
    help="CAN frames as python-can, BUSMASTER and CRTD print them",
    sniff=_sniff,
    reader=CanLinesReader,
)
