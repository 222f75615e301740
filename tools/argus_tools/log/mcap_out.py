# SPDX-License-Identifier: MIT
"""A log as MCAP of ROS 2 messages: the SIPs, where the robot is, points that the sonars hear, and all other packets.

The records of many SIPs are made together, as columns; the file's frame is that of the `mcap` package.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Any, Final, NamedTuple
from zlib import crc32

import numpy as np
import zstandard
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, ChunkIndex, DataEnd, Footer, Header, Schema, Statistics

from argus_tools.log.bulk import SIP_HEAD, Array
from argus_tools.log.fields import HEADINGS, Decoder
from argus_tools.log.packets import Row
from argus_tools.log.ros2_columns import filled
from argus_tools.ros2_messages import (
    CLOUD,
    DEFINITIONS,
    ERROR,
    INFO,
    LOG,
    SIP,
    STATE,
    TRANSFORMS,
    log_record,
)
from argus_tools.timeline import nanoseconds
from hil_sim.arcos import Sip
from hil_sim.tables.robot import DEFAULT_ROBOT, robot_table

TOPICS: Final = {"/sip": SIP, "/tf": TRANSFORMS, "/sonar/points": CLOUD, "/events": LOG}
_CHANNELS: Final = {kind: n for n, kind in enumerate(TOPICS.values(), 1)}
_MAGIC: Final = b"\x89MCAP0\r\n"
_ROWS_IN_CHUNK: Final = 2048
_LINE_MAX: Final = 0xFFFFFFFF
_MICRO, _NANO_IN_MICRO = 1_000_000, 1000
_CACHE_MAX: Final = 4096
# Where velocities are in a SIP's data; what is left of the state changes seldom.
_VELOCITIES: Final = {"vel_left_mm_s": 7, "vel_right_mm_s": 9}
_SELDOM: Final = tuple(name for name, _ in STATE if name not in _VELOCITIES)
_HEADINGS: Final = np.array(HEADINGS)


class _Place(NamedTuple):
    """A row, and where the robot was."""

    row: Row
    x_mm: float
    y_mm: float


def times_ns(times: list[float]) -> Array:
    """Return times in nanoseconds as their digits say them.

    >>> times_ns([1795590184.251103, 0.1234567891]).tolist()
    [1795590184251103000, 123456789]
    """
    given = np.array(times)
    micro = np.rint(given * _MICRO)
    found: Array = micro.astype(np.int64) * _NANO_IN_MICRO
    for at in np.flatnonzero((micro / _MICRO != given) | (given < 0)).tolist():
        found[at] = nanoseconds(times[at])
    return found


class _File:
    """The frame of the file: what stands before, between and behind the messages."""

    def __init__(self, stream: Any) -> None:
        self._stream = stream
        self._at = 0
        self._builder = RecordBuilder()
        self._chunks: list[ChunkIndex] = []
        self._counts = dict.fromkeys(_CHANNELS.values(), 0)
        self._crc = 0
        self._compress = zstandard.ZstdCompressor(level=3).compress
        self._write(_MAGIC)
        Header(profile="ros2", library="argus-log").write(self._builder)
        self._write(self._built())

    def _write(self, data: bytes) -> None:
        self._stream.write(data)
        self._at += len(data)

    def _built(self) -> bytes:
        return bytes(self._builder.end())  # type: ignore[no-untyped-call]

    def _describe(self) -> bytes:
        for kind, number in _CHANNELS.items():
            Schema(data=DEFINITIONS[kind].encode(), encoding="ros2msg", id=number, name=kind).write(
                self._builder
            )
        for topic, kind in TOPICS.items():
            number = _CHANNELS[kind]
            Channel(id=number, topic=topic, message_encoding="cdr", metadata={}, schema_id=number).write(
                self._builder
            )
        return self._built()

    def put(self, records: list[bytes], index: dict[int, tuple[Array, Array]]) -> None:
        """Write a chunk. index: of each channel the times of its messages and where in the records they are."""
        described = self._describe()
        data = described + b"".join(records)
        packed = self._compress(data)
        low = min(int(times.min()) for times, _ in index.values())
        high = max(int(times.max()) for times, _ in index.values())
        Chunk(
            compression="zstd",
            data=packed,
            message_start_time=low,
            message_end_time=high,
            uncompressed_crc=crc32(data),
            uncompressed_size=len(data),
        ).write(self._builder)
        start = self._at
        self._write(self._built())
        length = self._at - start
        offsets: dict[int, int] = {}
        for channel, (times, places) in index.items():
            offsets[channel] = self._at
            self._counts[channel] += len(times)
            entries = np.empty((len(times), 2), "<u8")
            entries[:, 0], entries[:, 1] = times, places + len(described)
            self._write(_message_index(channel, entries.tobytes()))
        self._chunks.append(
            ChunkIndex(
                chunk_length=length,
                chunk_start_offset=start,
                compression="zstd",
                compressed_size=len(packed),
                message_end_time=high,
                message_index_length=self._at - start - length,
                message_index_offsets=offsets,
                message_start_time=low,
                uncompressed_size=len(data),
            )
        )

    def close(self) -> None:
        """Write the summary."""
        DataEnd(data_section_crc=0).write(self._builder)
        self._write(self._built())
        start = self._at
        self._write(self._describe())
        Statistics(
            attachment_count=0,
            channel_count=len(TOPICS),
            channel_message_counts={channel: n for channel, n in self._counts.items() if n},
            chunk_count=len(self._chunks),
            message_count=sum(self._counts.values()),
            message_end_time=max((chunk.message_end_time for chunk in self._chunks), default=0),
            message_start_time=min((chunk.message_start_time for chunk in self._chunks), default=0),
            metadata_count=0,
            schema_count=len(TOPICS),
        ).write(self._builder)
        for chunk in self._chunks:
            chunk.write(self._builder)
        self._write(self._built())
        Footer(summary_start=start, summary_offset_start=0, summary_crc=0).write(self._builder)
        self._write(self._built())
        self._write(_MAGIC)


def _message_index(channel: int, entries: bytes) -> bytes:
    body = channel.to_bytes(2, "little") + len(entries).to_bytes(4, "little") + entries
    return bytes((Opcode.MESSAGE_INDEX,)) + len(body).to_bytes(8, "little") + body


class _Sips:
    """Makes the records of SIPs."""

    def __init__(self, decoder: Decoder) -> None:
        self._decoder = decoder
        self._states: dict[bytes, tuple[Any, ...]] = {}
        table = robot_table(DEFAULT_ROBOT)
        self._no_echo_mm = table.no_echo_mm
        self._mounts = np.full((256, 4), np.nan)
        for number, mount in enumerate(table.mounts):
            heading = np.radians(mount.heading_deg)
            self._mounts[number] = mount.x_mm, mount.y_mm, np.cos(heading), np.sin(heading)

    def records(self, places: list[_Place], t_ns: Array, readings: int) -> tuple[Array, Array, Array]:
        """Return the records of SIPs with so many readings each, of each kind of message, a row for each SIP."""
        data = [place.row.data for place in places]
        head = np.frombuffer(b"".join(one[: SIP_HEAD + 3 * readings] for one in data), np.uint8)
        head = head.reshape(len(data), -1)
        th = head[:, 5].astype(np.int64) | head[:, 6].astype(np.int64) << 8
        heading = _HEADINGS[th & (len(HEADINGS) - 1)]
        sonar = head[:, SIP_HEAD::3]
        ranges = (
            head[:, SIP_HEAD + 1 :: 3].astype(np.uint16) | head[:, SIP_HEAD + 2 :: 3].astype(np.uint16) << 8
        )
        x_mm, y_mm = np.array([(place.x_mm, place.y_mm) for place in places], float).T
        columns = {"x_mm": x_mm, "y_mm": y_mm, "heading_deg": heading}
        states = zip(*map(self._state, data), strict=True)
        columns |= {name: np.array(values) for name, values in zip(_SELDOM, states, strict=True)}
        for name, at in _VELOCITIES.items():
            columns[name] = np.ascontiguousarray(head[:, at : at + 2]).view("<i2")[:, 0]
        if readings:
            columns |= {"sonar": sonar, "range_mm": ranges}
        sips = filled(SIP, _CHANNELS[SIP], t_ns, readings, columns)
        return sips, self._transforms(t_ns, x_mm, y_mm, heading), self._points(t_ns, sonar, ranges)

    def _state(self, data: bytes) -> tuple[Any, ...]:
        """Return what changes seldom from SIP to SIP, in the order of _SELDOM."""
        key = data[:1] + data[11:19] + data[20 + 3 * data[19] :]
        found = self._states.get(key)
        if found is None:
            fields = self._decoder.sip_fields(Sip.decode(data))
            found = tuple(fields[name] for name in _SELDOM)
            if len(self._states) >= _CACHE_MAX:
                self._states.clear()
            self._states[key] = found
        return found

    @staticmethod
    def _transforms(t_ns: Array, x_mm: Array, y_mm: Array, heading: Array) -> Array:
        half = np.radians(heading) / 2
        # As precise as a picture needs it: the digits behind make half of the file.
        columns = {
            name: values.astype(np.float32)
            for name, values in (
                ("x_m", x_mm / 1000), ("y_m", y_mm / 1000), ("qz", np.sin(half)), ("qw", np.cos(half)),
            )
        }  # fmt: skip
        return filled(TRANSFORMS, _CHANNELS[TRANSFORMS], t_ns, 0, columns)

    def _points(self, t_ns: Array, sonar: Array, ranges: Array) -> Array:
        readings = sonar.shape[1]
        if not readings:
            return filled(CLOUD, _CHANNELS[CLOUD], t_ns, 0, {})
        mounts = self._mounts[sonar]
        range_mm = np.where(ranges < self._no_echo_mm, ranges, np.nan)
        points = np.zeros((len(t_ns), readings, 3), np.float32)
        points[:, :, 0] = (mounts[:, :, 0] + range_mm * mounts[:, :, 2]) / 1000
        points[:, :, 1] = (mounts[:, :, 1] + range_mm * mounts[:, :, 3]) / 1000
        return filled(CLOUD, _CHANNELS[CLOUD], t_ns, readings, {"points": points.reshape(len(t_ns), -1)})


def _is_readable(data: bytes) -> bool:
    return len(data) >= SIP_HEAD and len(data) >= SIP_HEAD + 3 * data[SIP_HEAD - 1]


def _rows_of(records: Array) -> list[bytes]:
    found: list[bytes] = records.view(f"V{records.dtype.itemsize}").tolist()
    return found


class _Batch:
    """The records of rows that follow each other, and where each is."""

    def __init__(self, sips: _Sips, decoder: Decoder) -> None:
        self._sips, self._decoder = sips, decoder

    def write(self, file: _File, places: list[_Place]) -> None:
        """Write the rows as one chunk."""
        t_ns = times_ns([place.row.t or 0.0 for place in places])
        records = [b""] * len(places)
        # Of each row the sizes of its records before the second and the third.
        inner = np.zeros((2, len(places)), np.int64)
        groups: dict[int, list[int]] = {}
        others: list[int] = []
        for n, (row, _, _) in enumerate(places):
            data = row.data
            if row.type == "SIP" and row.ok and _is_readable(data):
                groups.setdefault(data[SIP_HEAD - 1], []).append(n)
            else:
                others.append(n)
        for readings, members in groups.items():
            made = self._sips.records([places[n] for n in members], t_ns[members], readings)
            inner[:, members] = np.cumsum([made[0].dtype.itemsize, made[1].dtype.itemsize])[:, None]
            for n, *parts in zip(members, *map(_rows_of, made), strict=True):
                records[n] = b"".join(parts)
        for n in others:
            records[n] = self._event(places[n].row, int(t_ns[n]))
        ends = np.cumsum([len(record) for record in records])
        begins = ends - [len(record) for record in records]
        chosen = np.array(sorted(itertools.chain(*groups.values())), np.intp)
        index = {}
        if len(chosen):
            for kind, add in ((SIP, 0), (TRANSFORMS, inner[0, chosen]), (CLOUD, inner[1, chosen])):
                index[_CHANNELS[kind]] = t_ns[chosen], begins[chosen] + add
        if others:
            index[_CHANNELS[LOG]] = t_ns[others], begins[others]
        file.put(records, index)

    def _event(self, row: Row, t_ns: int) -> bytes:
        level, message = self._words(row)
        line = min(row.offset, _LINE_MAX)
        return log_record(_CHANNELS[LOG], t_ns, level, row.dir, message, line)

    def _words(self, row: Row) -> tuple[int, str]:
        if not row.ok:
            return ERROR, f"{row.type} damaged: {row.error}"
        body = self._decoder.json_detail(row)
        return INFO, f"{row.type} {body}"


def write_mcap(stream: Any, first: Row, rows: Iterator[Row], decoder: Decoder) -> int:
    """Write the rows, which the decoder has tracked; return how many there were."""
    file = _File(stream)
    batch = _Batch(_Sips(decoder), decoder)
    count = 0
    places = (_Place(row, decoder.x_mm, decoder.y_mm) for row in itertools.chain((first,), rows))
    while some := list(itertools.islice(places, _ROWS_IN_CHUNK)):
        batch.write(file, some)
        count += len(some)
    file.close()
    return count
