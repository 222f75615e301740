# SPDX-License-Identifier: MIT
"""Frames of a capture as text, as `tshark -x` and Wireshark's "as plain text" print them: each from offset 0 on."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from io import BufferedReader
from typing import Final, NamedTuple

from argus_tools.catalogue import HELP
from argus_tools.chunks import Chunk, Damage, DamageList, Format, ReadOptions
from argus_tools.formats.hexdump import HEADER
from argus_tools.formats.isotp import is_robot_id
from argus_tools.formats.source import HEAD_BYTES
from argus_tools.formats.tcp import IP_LINKS, parse
from argus_tools.formats.text import first_lines, numbered_lines
from argus_tools.formats.traffic import CAN_PROTOCOLS, COOKED, LINK_CAN, Captured, Traffic

_LINE_MAX: Final = 4096
_LINES_SNIFFED: Final = 1 << 10
_LINE: Final = re.compile(
    rb"([0-9A-Fa-f]{4,8}) {2,3}((?:[0-9A-Fa-f]{2} )*[0-9A-Fa-f]{2})(?: {2}.*)?\s*", re.DOTALL
)
# The summary of a frame, or its time among its details.
_TIME: Final = re.compile(rb"\s*\d+\s+(\d+\.\d+)\s|\s+Epoch (?:Arrival )?Time: (\d+\.\d+)")
# A frame that brings more than itself has a heading over each; what was put together of several is no frame.
_HEADING: Final = re.compile(rb"(\w.*) \(\d+ bytes?\):\s*")
_FRAME: Final = b"Frame"
_CAN_HEAD: Final = 8
_CAN_FRAMES: Final = (16, 72)
# In the order in which they are tried: what is most often captured first.
LINKS: Final = (1, LINK_CAN, *COOKED, *sorted(IP_LINKS - {1, *COOKED}))


class _Frame(NamedTuple):
    """One frame: the line where it begins, its time if that is told, and its bytes."""

    line: int
    t: float | None
    data: bytes


class _Frames:
    """Puts lines together to frames; counts what does not fit."""

    def __init__(self, damage: DamageList) -> None:
        self._damage = damage
        self._t: float | None = None
        self._data = b""
        self._line = 0
        self._is_frame = True

    def take(self, lines: Iterable[tuple[int, bytes]]) -> Iterator[_Frame]:
        """Yield the frames of the lines; the last one ends with them."""
        for number, text in lines:
            if match := _LINE.fullmatch(text):
                yield from self._bytes(number, int(match[1], 16), bytes.fromhex(match[2].decode()))
                continue
            if match := _TIME.match(text):
                yield from self._end()
                self._t = float(match[1] or match[2])
            elif match := _HEADING.fullmatch(text):
                yield from self._end()
                self._is_frame = match[1] == _FRAME
        yield from self._end()

    def _bytes(self, number: int, offset: int, data: bytes) -> Iterator[_Frame]:
        if not offset:
            yield from self._end()
            self._line = number
        elif offset != len(self._data):
            self._damage.append(
                Damage(f"line {number}", f"{offset:#x} is not where the frame before goes on")
            )
            return
        self._data += data

    def _end(self) -> Iterator[_Frame]:
        if self._data and self._is_frame:
            yield _Frame(self._line, self._t, self._data)
            self._t = None
        self._data = b""


def _is_can(data: bytes) -> bool:
    """Whether these can be a frame as SocketCAN has it."""
    if len(data) < _CAN_HEAD or any(data[6:_CAN_HEAD]):
        return False
    return len(data) in (_CAN_HEAD + data[4], *_CAN_FRAMES)


def _is_robots(data: bytes) -> bool:
    return is_robot_id(int.from_bytes(data[:4], "big"))


def fits_link(link: int, data: bytes) -> bool:
    """Whether these bytes can be a frame of that link type."""
    if link == LINK_CAN:
        return _is_can(data)
    if link in COOKED:
        head, kind_at, _ = COOKED[link]
        if int.from_bytes(data[kind_at : kind_at + 2], "big") in CAN_PROTOCOLS:
            return len(data) >= head + _CAN_HEAD
    return parse(link, data) is not None


def _link(head: bytes) -> int | None:
    """Say of which link type the frames are, None if these are no frames."""
    lines = enumerate(first_lines(head, _LINES_SNIFFED))
    frames = list(_Frames(DamageList()).take(lines))
    # Packets that are dumped one by one are no frames.
    if 2 * sum(frame.data.startswith(HEADER) for frame in frames) >= len(frames):
        return None
    fits = {link: sum(fits_link(link, frame.data) for frame in frames) for link in LINKS}
    best = max(fits, key=lambda link: fits[link])
    if best == LINK_CAN and len(frames) == 1 and not _is_robots(frames[0].data):
        return None
    return best if fits[best] else None


class FrameDumpReader:
    """Reads the frames one by one; what stands between them gives at most their times."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._options = options

    def __iter__(self) -> Iterator[Chunk]:
        head = self._stream.peek(HEAD_BYTES)
        link = _link(head)
        traffic = Traffic(self._options, self.damage)
        lines = numbered_lines(self._stream, _LINE_MAX)
        for number, frame in enumerate(_Frames(self.damage).take(lines), start=1):
            yield from traffic.take(Captured(frame.t, number, LINK_CAN if link is None else link, frame.data))
        yield from traffic.finish()


FORMAT: Final = Format(
    name="frame-dump",
    help=HELP["frame-dump"],
    sniff=lambda head: _link(head) is not None,
    reader=FrameDumpReader,
)
