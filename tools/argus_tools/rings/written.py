# SPDX-License-Identifier: MIT
"""In which order a bag's messages are read: by its clock, of one time as they were written.

Where a topic's times fall the clock was set back, and what it says of the order is not true: there all are read as
they were written. A bag in which one topic is written after the other has no such fall, and is read by its clock.
"""

from __future__ import annotations

import struct
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, BinaryIO, Final

import numpy as np
import numpy.typing as npt

from argus_tools.timeline import DISORDER_S

_DISORDER_NS: Final = round(DISORDER_S * 1e9)
_INDEX: Final = struct.Struct("<BQHI")
_ENTRY: Final = struct.Struct("<QQ")
_AT_ONCE: Final = 4096

Entries = npt.NDArray[np.int64]
"""Rows of time in ns, place of the chunk, place in it."""
Raw = tuple[Any, int, bytes]
"""A message as `rosbags` gives it: connection, time in ns, data."""


def falls(times: Iterable[tuple[Any, int]]) -> bool:
    """Whether the times of any topic fall, of pairs of a topic and a time in ns in the order in which they are written.

    >>> falls([("a", 0), ("a", 9_000_000_000), ("b", 0)]), falls([("a", 9_000_000_000), ("a", 0)])
    (False, True)
    """
    newest: dict[Any, int] = {}
    with suppress(Exception):  # of a damaged file, which is reported when its messages are read
        for topic, t_ns in times:
            if t_ns < newest.get(topic, t_ns) - _DISORDER_NS:
                return True
            newest[topic] = max(t_ns, newest.get(topic, t_ns))
    return False


def mcap_times(reader: Any, file: BinaryIO, topics: Iterable[str]) -> Iterator[tuple[int, int]]:
    """Yield channel and time of the messages of these topics, of each channel as they were written."""
    wanted, summary = set(topics), reader.get_summary()
    if summary is None or not summary.chunk_indexes:
        found = reader.iter_messages(wanted, log_time_order=False)
        yield from ((channel.id, message.log_time) for _, channel, message in found)
        return
    channels = {number for number, channel in summary.channels.items() if channel.topic in wanted}
    yield from _indexed(file, summary.chunk_indexes, channels)


def _indexed(file: BinaryIO, chunks: Iterable[Any], wanted: Collection[int]) -> Iterator[tuple[int, int]]:
    for chunk in sorted(chunks, key=lambda one: int(one.chunk_start_offset)):
        for channel, at in chunk.message_index_offsets.items():
            if channel not in wanted:
                continue
            file.seek(at)
            size = _INDEX.unpack(file.read(_INDEX.size))[-1]
            entries = _ENTRY.iter_unpack(file.read(size))
            yield from ((channel, t_ns) for t_ns, _ in sorted(entries, key=lambda entry: entry[1]))


def reader_of_bag1(path: Path) -> Any:
    """Return a reader of a ROS 1 bag that keeps where its messages are as numbers: 24 bytes a message, for 130."""
    from rosbags.rosbag1 import Reader

    class Compact(Reader):
        """Its index by connection, in parts as they are read; that of the reader stays empty."""

        def __init__(self, path: Path) -> None:
            super().__init__(path)
            self.parts: dict[int, list[Entries]] = {}

        def read_index_data(self, pos: int, _indexes: Any) -> None:
            """Read the index of one connection in one chunk."""
            here: Any = defaultdict(list)
            super().read_index_data(pos, here)
            for number, entries in here.items():
                part = np.array([(one.time, one.chunk_pos, one.offset) for one in entries], dtype=np.int64)
                self.parts.setdefault(number, []).append(part.reshape(-1, 3))

        def counted(self, number: int) -> int:
            """Return how many messages a connection has."""
            return sum(len(part) for part in self.parts.get(number, ()))

    return Compact(path)


def of_bag1(reader: Any, connections: Sequence[Any]) -> Iterator[Raw]:
    """Yield the messages of a ROS 1 bag."""
    own = [np.concatenate(reader.parts[one.id]) for one in connections if one.id in reader.parts]
    if not own:
        return
    entries = np.concatenate(own)
    order: npt.NDArray[np.intp]
    if any(_fall(one[np.lexsort((one[:, 2], one[:, 1])), 0]) for one in own):
        order = np.lexsort((entries[:, 2], entries[:, 1]))
    else:
        order = np.lexsort((entries[:, 2], entries[:, 1], entries[:, 0]))
    # The reader merges its connections' entries by time alone: it is given one of them, and merges nothing.
    reader.indexes = {one.id: () for one in reader.connections} | {
        connections[0].id: _entries(entries, order)
    }
    yield from reader.messages(connections)


def _fall(times: npt.NDArray[np.int64]) -> bool:
    """As `falls`, of one topic."""
    return bool((times < np.maximum.accumulate(times) - _DISORDER_NS).any())


def _entries(entries: Entries, order: npt.NDArray[np.intp]) -> Iterator[Any]:
    from rosbags.rosbag1.reader import IndexData

    for first in range(0, len(order), _AT_ONCE):
        yield from (IndexData(*row) for row in entries[order[first : first + _AT_ONCE]].tolist())


def of_bag2(reader: Any, connections: Sequence[Any]) -> Iterator[Raw]:
    """Yield the messages of a ROS 2 bag, of each of its files."""
    for storage in getattr(reader.storage, "storages", [reader.storage]):
        storage.messages = (_Database if hasattr(storage, "dbconn") else _Mcap)(storage).messages
    yield from reader.messages(connections)


class _Database:
    """The messages of an SQLite file, in place of the method of the reader."""

    def __init__(self, storage: Any) -> None:
        self._storage = storage

    def messages(self, connections: Sequence[Any], *_: object) -> Iterator[Raw]:
        """Yield the messages of these connections."""
        known = {one.id: one for one in connections}
        marks = ",".join("?" * len(known))
        where = f"FROM messages WHERE topic_id IN ({marks}) ORDER BY"
        ask = self._storage.dbconn.execute
        order = (
            "rowid"
            if falls(ask(f"SELECT topic_id, timestamp {where} rowid", tuple(known)))
            else "timestamp, rowid"
        )
        for number, t_ns, data in ask(f"SELECT topic_id, timestamp, data {where} {order}", tuple(known)):
            yield known[number], t_ns, data


class _Mcap:
    """The messages of an MCAP file, in place of the method of the reader, which is right but for falls."""

    def __init__(self, storage: Any) -> None:
        self._storage = storage
        self._by_time = type(storage).messages

    def messages(self, connections: Sequence[Any], *_: object) -> Iterator[Raw]:
        """Yield the messages of these connections."""
        from mcap.reader import make_reader

        known = {one.id: one for one in connections}
        topics = {one.topic for one in connections}
        with self._storage.path.open("rb") as file:
            reader = make_reader(file)
            if falls(mcap_times(reader, file, topics)):
                for _schema, channel, message in reader.iter_messages(topics, log_time_order=False):
                    if channel.id in known:
                        yield known[channel.id], message.log_time, message.data
                return
        yield from self._by_time(self._storage, connections)
