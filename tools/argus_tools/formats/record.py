# SPDX-License-Identifier: MIT
"""Recordings made by argusd --record and argus-sim --record (SPEC.md, Recording)."""

from __future__ import annotations

from collections.abc import Iterator
from io import BufferedReader
from typing import BinaryIO, Final

from argus_tools.catalogue import HELP
from argus_tools.chunks import (
    CLIENT_TO_ROBOT,
    ROBOT_TO_CLIENT,
    Chunk,
    Damage,
    DamageList,
    Direction,
    Format,
    LogError,
    Offsets,
    ReadOptions,
)
from hil_sim.faults.kinds import KIND_NAME
from hil_sim.record.recording import (
    CLOCK_US,
    MAGIC,
    PAYLOAD_MAX,
    VERSION,
    Decoder,
    Kind,
    Record,
    Timeline,
    encode,
    encode_clock,
    encode_start,
    is_recording,
)

_PIECE: Final = 65536
_DIRECTION: Final[dict[int, Direction]] = {
    int(Kind.FROM_ROBOT): ROBOT_TO_CLIENT,
    int(Kind.TO_ROBOT): CLIENT_TO_ROBOT,
}
_KIND: Final = {direction: kind for kind, direction in _DIRECTION.items()}


def injected(payload: bytes) -> str:
    """Say what argusd did to a sonar from here on.

    >>> injected(bytes([3, 3]) + (30000).to_bytes(4, "little"))
    "argusd injects 'stuck' into sonar 3 for 30 s: from here on its readings are made up"
    """
    if len(payload) != 6 or (payload[1] != 0 and payload[1] not in KIND_NAME):
        return "argusd injects a fault of an unknown kind: readings from here on are made up"
    if payload[1] == 0:
        return f"argusd injects nothing into sonar {payload[0]} any more: its readings are its own again"
    for_s = int.from_bytes(payload[2:], "little") / 1000
    kind = KIND_NAME[payload[1]]
    return f"argusd injects '{kind}' into sonar {payload[0]} for {for_s:g} s: from here on its readings are made up"


class RecordReader:
    """Reads a recording; `t` is in seconds since 1970."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._name = options.name
        self._decoder = Decoder()
        self._timeline = Timeline()
        self._offsets = Offsets()

    def __iter__(self) -> Iterator[Chunk]:
        while data := self._stream.read1(_PIECE):
            yield from self._chunks(self._decoder.feed(data))
        yield from self._chunks(self._decoder.finish())
        self._tell_gaps()

    def _chunks(self, records: Iterator[Record]) -> Iterator[Chunk]:
        for record in records:
            t = self._timeline.at(record)
            if self._decoder.gaps:
                self._tell_gaps()
            if direction := _DIRECTION.get(record.kind):
                yield self._offsets.chunk(t, direction, record.payload)
            elif record.kind == Kind.LOST:
                lost = int.from_bytes(record.payload, "little")
                what = f"the recorder's disk was full: {lost} bytes of the link are missing"
                self.damage.append(Damage(f"byte {record.place}", what))
            elif record.kind == Kind.INJECTED:
                self.damage.append(Damage(f"byte {record.place}", injected(record.payload)))
            elif record.kind == Kind.HEADER:
                self._check_version(record)

    def _check_version(self, record: Record) -> None:
        version = record.payload[len(MAGIC) : len(MAGIC) + 1]
        if version and version[0] != VERSION:
            raise LogError(
                f"{self._name}: byte {record.place}: a recording of version {version[0]}; "
                f"this program reads version {VERSION}, take a newer one"
            )

    def _tell_gaps(self) -> None:
        for gap in self._decoder.gaps:
            what = "cut off here" if gap.at_end else "no record"
            self.damage.append(Damage(f"byte {gap.place}", f"{what}, {gap.length} bytes skipped"))
        self._decoder.gaps.clear()


class RecordWriter:
    """Writes a recording whose two clocks are both `t`; what has no time is at 0."""

    def __init__(self, stream: BinaryIO, _options: ReadOptions) -> None:
        self._stream = stream
        self._clock_us: int | None = None

    def write(self, chunk: Chunk) -> None:
        """Append one chunk."""
        us = round((chunk.t or 0.0) * 1e6)
        if self._clock_us is None:
            self._stream.write(encode_start("argus-log", us, us))
            self._clock_us = us
        if not 0 <= us - self._clock_us < CLOCK_US:
            self._stream.write(encode_clock(us, us))
            self._clock_us = us
        for at in range(0, len(chunk.data), PAYLOAD_MAX):
            self._stream.write(encode(_KIND[chunk.dir], us, chunk.data[at : at + PAYLOAD_MAX]))

    def close(self) -> None:
        """A recording has no end of its own; an empty one still has a beginning."""
        if self._clock_us is None:
            self._stream.write(encode_start("argus-log", 0, 0))


FORMAT: Final = Format(
    name="record",
    help=HELP["record"],
    sniff=is_recording,
    reader=RecordReader,
    writer=RecordWriter,
    suffixes=(".rec", ".argus"),
)
