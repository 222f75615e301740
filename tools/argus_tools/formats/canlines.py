# SPDX-License-Identifier: MIT
"""Lines of one CAN frame each, as other programs than candump print them: python-can, BUSMASTER, CRTD and others."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from io import BufferedReader
from typing import Final

from argus_tools.catalogue import HELP
from argus_tools.chunks import Chunk, Damage, DamageList, Format, ReadOptions
from argus_tools.formats.isotp import CanLink
from argus_tools.formats.stamps import Times
from argus_tools.formats.text import first_lines
from argus_tools.timeline import DAY_S, Wrapping

_LINE_MAX: Final = 4096
_SHORT_ID_MAX: Final = 0x7FF
_BYTES: Final = r"(?P<data>(?:[0-9A-Fa-f]{2}(?:\s+|$))*)"


# A time with a date or of the day, which the stamps understand; on which side a frame was seen, and its id.
_STAMPED: Final = r"\s*[\[(]?(?P<stamp>(?:\d{4}[-/.]\d\d[-/.]\d\d[T ,]+)?\d\d?:\d\d:\d\d[^\s,;\])]*)[\])]?"
_SIDED: Final = r"(?:\w{1,8}[,;\s]\s*)?[RTrt][Xx][,;\s]\s*(?:0x)?(?P<id>[0-9A-Fa-f]{3,8})(?P<long>x?)"
# A robot's id, and nothing before it.
_PLAIN: Final = r"\s*(?:0x)?0{0,5}(?P<id>64[0-9A-Fa-f])(?P<long>)h?"
_LISTED: Final = r"(?P<data>(?:(?:0x)?[0-9A-Fa-f]{2}(?:[\s,;]+|$))*)"


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
        re.compile(r"\s*Timestamp:\s+-?\d+\.\d+\s+ID:\s+[0-9a-f]+\s"),
        re.compile(
            r"\s*Timestamp:\s+(?P<t>-?\d+\.\d+)\s+ID:\s+(?P<id>[0-9a-f]+)\s+(?P<long>[SX])\s+(?:[RT]x\s+)?(?:F\s*)?(?:BS|EI|\s)*"
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
        re.compile(r"-?\d+\.\d+\s+\d?[RT](?:11|29)\s"),
        re.compile(
            r"(?P<t>-?\d+\.\d+)\s+(?P<bus>\d?)[RT](?P<long>11|29)\s+(?P<id>[0-9A-Fa-f]+)(?:\s+|$)"
            + _BYTES
            + "$"
        ),
    ),
    _Kind(
        "a dated CAN log",
        re.compile(_STAMPED + r"[,;\s]\s*" + _SIDED + r"[,;\s]"),
        re.compile(
            _STAMPED
            + r"[,;\s]\s*"
            + _SIDED
            + r"[,;\s]\s*(?:(?P<size>\d{1,2})[,;\s]\s*|\[(?P<length>\d{1,2})\]\s*)?"
            + _LISTED
            + "$"
        ),
    ),
    _Kind(
        "CAN ids with bytes",
        re.compile(_PLAIN + r"\s*[,;:\s]\s*(?:[0-9A-Fa-f]{2}[\s,;]+){2,7}[0-9A-Fa-f]{2}\s*$"),
        re.compile(_PLAIN + r"\s*[,;:\s]\s*" + _LISTED + "$"),
    ),
)
_LONG: Final = ("X", "x", "29")  # an id of more than 11 bits needs no mark
# What else such a program writes between its frames.
_PASSED: Final = re.compile(r"\s*(?:#|\*\*\*|-?\d+\.\d+\s+\d?C)")


class CanLinesReader:
    """Reads the lines of the program that the first of them is of."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._link = CanLink(options, self.damage, "line")
        self._times = Times()

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
            can_id, is_long = (
                int(match["id"], 16),
                match["long"] in _LONG or int(match["id"], 16) > _SHORT_ID_MAX,
            )
            direction = self._link.direction(match.groupdict().get("bus") or "", can_id, is_long, number)
            if direction is None:
                continue
            data = bytes.fromhex(re.sub("0x|[,;]", " ", match["data"]))
            groups = match.groupdict()
            size = int(groups.get("size") or groups.get("length") or len(data))
            if len(data) != size:
                self.damage.append(Damage(f"line {number}", f"{len(data)} of a frame's {size} bytes"))
                continue
            yield from self._link.take(self._seconds(match), direction, data, number)
        yield from self._link.finish()

    def _seconds(self, match: re.Match[str]) -> float | None:
        groups = match.groupdict()
        if groups.get("t"):
            return float(groups["t"])
        if groups.get("stamp"):
            stamp = self._times.take(groups["stamp"].encode("latin-1") + b" ")
            return stamp.t if stamp else None
        return _of_day(groups) if groups.get("h") else None

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


def _of_day(groups: dict[str, str]) -> float:
    t = int(groups["h"]) * 3600 + int(groups["m"]) * 60 + int(groups["s"]) + int(groups["f"]) / 10_000
    return Wrapping(t, DAY_S)


def _sniff(head: bytes) -> bool:
    lines = [line.decode("latin-1") for line in first_lines(head)]
    if any(kind.line.match(line) for kind in _KINDS[:-1] for line in lines):
        return True
    # The plainest of all has no heading, which would be that of a table.
    return bool(lines) and bool(_KINDS[-1].line.match(lines[0]))


FORMAT: Final = Format(
    name="can-lines",
    help=HELP["can-lines"],
    sniff=_sniff,
    reader=CanLinesReader,
)
