# SPDX-License-Identifier: MIT
"""What `tshark -T json`, `-T jsonraw` and `-T ek` print: frames as JSON, of which the bytes are taken."""

from __future__ import annotations

import json
import re
import struct
from collections.abc import Iterator, Mapping
from contextlib import suppress
from io import BufferedReader
from typing import Any, Final

from argus_tools.catalogue import HELP
from argus_tools.chunks import (
    EXPECTED,
    Chunk,
    Damage,
    DamageList,
    Format,
    LogError,
    ReadOptions,
    remedy,
)
from argus_tools.formats.framedump import LINKS, fits_link
from argus_tools.formats.jsonl import LINE_MAX, Records
from argus_tools.formats.source import BLOCK_BYTES
from argus_tools.formats.stamps import Times
from argus_tools.formats.tcp import Segment, Streams
from argus_tools.formats.text import begins_as_text, numbered_lines
from argus_tools.formats.traffic import LINK_CAN, Captured, Traffic

_SNIFFED: Final = 1 << 12
_BEGIN: Final = re.compile(
    rb'"_index"\s*:\s*"packets-|"_source"\s*:\s*\{\s*"layers"|\{\s*"timestamp"\s*:\s*"\d+"\s*,\s*"layers"'
)
_LONG_ID, _REMOTE, _ERROR = 1 << 31, 1 << 30, 1 << 29
_FLAGS: Final = (("can.flags.xtd", _LONG_ID), ("can.flags.rtr", _REMOTE), ("can.flags.err", _ERROR))
_TRUE: Final = ("1", "true")
_NO_BYTES: Final = "what tshark prints as JSON, without the bytes"
_REMEDY: Final = "print them, too: tshark -r CAPTURE -T json -x, or give the capture that it was made from"


class _Fields:
    """The fields of one frame by their names, whether tshark writes them as `tcp.port` or as `tcp_tcp_port`."""

    def __init__(self, layers: Any) -> None:
        self._all: dict[str, str] = {}
        self._take("", layers)

    def _take(self, name: str, value: Any) -> None:
        """Keep the first value of each name; a list holds several, or the bytes and where they stand."""
        if isinstance(value, Mapping):
            for key, inner in value.items():
                self._take(str(key).replace("_", "."), inner)
        elif isinstance(value, list):
            if value:
                self._take(name, value[0])
        elif value is not None:
            self._all.setdefault(name, str(value))
            # "tcp.tcp.port" is "tcp.port".
            self._all.setdefault(name.partition(".")[2], str(value))

    def text(self, name: str) -> str:
        """The value of a field, empty if the frame has none."""
        return self._all.get(name, "")

    def number(self, name: str) -> int | None:
        """The value of a field as a number."""
        text = self.text(name)
        return int(text, 16 if text.startswith("0x") else 10) if text else None

    def data(self, name: str) -> bytes:
        """The value of a field that holds bytes."""
        return bytes.fromhex(self.text(name).replace(":", " "))


class TsharkJsonReader:
    """Reads the frames one by one; one without bytes that should have some is told."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream: BufferedReader = BufferedReader(Records(stream), BLOCK_BYTES)
        self._options = options
        self._traffic = Traffic(options, self.damage)
        self._streams = Streams(options, self.damage)
        self._has_bytes = False

    def __iter__(self) -> Iterator[Chunk]:
        number = 0
        for _, line in numbered_lines(self._stream, LINE_MAX):
            layers = self._layers(line, number)
            if layers is None:
                continue
            number += 1
            try:
                yield from self._frame(_Fields(layers), number)
            except (ValueError, RecursionError, struct.error) as error:
                self.damage.append(Damage(f"frame {number}", f"no frame ({str(error)[:60]})"))
        if not self._has_bytes:
            helps = remedy(_REMEDY, self._options)
            raise LogError(f"{self._options.name}: looks like {_NO_BYTES}; expected {EXPECTED}; {helps}")
        yield from self._streams.finish()
        if not self._streams.is_used:
            yield from self._traffic.finish()

    def _layers(self, line: bytes, number: int) -> Any:
        """Return what a record holds of a frame; None of what stands between the frames."""
        record: Any = None
        with suppress(ValueError, RecursionError):
            record = json.loads(line)
        if isinstance(record, dict):
            source = record.get("_source", record)
            return source.get("layers") if isinstance(source, dict) else None
        if line.strip():
            self.damage.append(Damage(f"frame {number + 1}", "no JSON record"))
        return None

    def _frame(self, fields: _Fields, number: int) -> Iterator[Chunk]:
        t = _time(fields)
        if raw := fields.data("frame.raw"):
            self._has_bytes = True
            link = next((link for link in LINKS if fits_link(link, raw)), None)
            if link is not None:
                yield from self._traffic.take(Captured(t, number, link, raw))
        elif fields.text("can.id"):
            yield from self._can(fields, t, number)
        elif fields.text("tcp.srcport"):
            yield from self._tcp(fields, t, number)

    def _can(self, fields: _Fields, t: float | None, number: int) -> Iterator[Chunk]:
        data = fields.data("data.data") or fields.data("can.data")
        size = fields.number("can.len")
        if size is not None and len(data) < size:
            self.damage.append(Damage(f"frame {number}", f"{len(data)} of a CAN frame's {size} bytes"))
            return
        self._has_bytes |= bool(data)
        can_id = fields.number("can.id") or 0
        for name, bit in _FLAGS:
            can_id |= bit * (fields.text(name).lower() in _TRUE)
        frame = struct.pack(">IB3x", can_id, len(data)) + data
        yield from self._traffic.take(
            Captured(t, number, LINK_CAN, frame, fields.text("frame.interface.name"))
        )

    def _tcp(self, fields: _Fields, t: float | None, number: int) -> Iterator[Chunk]:
        data = fields.data("tcp.payload")
        sequence = fields.number("tcp.seq.raw") or fields.number("tcp.seq")
        if data and sequence is None:
            raise ValueError("no tcp.seq")
        self._has_bytes |= bool(data)
        ends = [
            (
                (fields.text(f"ip.{end}") or fields.text(f"ipv6.{end}")).encode(),
                fields.number(f"tcp.{end}port") or 0,
            )
            for end in ("src", "dst")
        ]
        segment = Segment(ends[0], ends[1], sequence or 0, fields.number("tcp.flags") or 0, data)
        yield from self._streams.take(t, number, segment)


def _time(fields: _Fields) -> float | None:
    """Return a frame's time, which is seconds or a date."""
    for name in ("frame.time.epoch", "frame.time"):
        if stamp := Times().take(fields.text(name).encode()):
            return stamp.t
    return None


def _sniff(head: bytes) -> bool:
    return begins_as_text(head) and bool(_BEGIN.search(head[:_SNIFFED]))


FORMAT: Final = Format(
    name="tshark-json",
    help=HELP["tshark-json"],
    sniff=_sniff,
    reader=TsharkJsonReader,
)
