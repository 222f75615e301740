# SPDX-License-Identifier: MIT
"""Recordings of messages: ROS bags by `rosbags`, own MCAP by `mcap`. Both give topics, then messages by time.

What a damaged file makes these libraries raise is of many kinds, SQLite's, zstd's and lz4's among them: all is caught.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final, NamedTuple, Protocol

from argus_tools.chunks import LogError
from argus_tools.rings.written import falls, mcap_times, of_bag1, of_bag2, reader_of_bag1
from argus_tools.ros2_messages import SIP, read_sip

_NANO: Final = 1_000_000_000
SONAR_ARRAY: Final = "p2os_msgs/msg/SonarArray"
_SONAR_ARRAY: Final = "std_msgs/Header header\nint32 ranges_count\nfloat64[] ranges\n"


@dataclass(frozen=True)
class Topic:
    """One topic: its type as ROS 2 writes it, and how many messages it has."""

    name: str
    type: str
    count: int


class Message(NamedTuple):
    """One message: its topic and type, the recorder's time in s, and its fields as attributes."""

    topic: str
    type: str
    t: float
    body: Any


class Broken(Exception):
    """What ends a recording early; the text says what it is."""


class Recording(Protocol):
    """A recording that was opened."""

    topics: list[Topic]

    def messages(self, topics: Iterable[str]) -> Iterator[Message]:
        """Yield the messages of these topics; Broken where the rest cannot be read."""

    def close(self) -> None:
        """Close the file."""


class Bag:
    """A ROS 1 or ROS 2 bag. Each connection has the message definition that the bag has for it."""

    def __init__(self, path: Path, is_first: bool, name: str) -> None:
        self._is_first = is_first
        self._stores: dict[tuple[str, str], Any] = {}
        try:
            self._reader = reader_of_bag1(path) if is_first else _reader_of_bag2(path)
            self._reader.open()
        except Exception as error:
            raise LogError(f"{name}: a bag that cannot be read: {_what(error)}") from error
        counts: dict[tuple[str, str], int] = {}
        for connection in self._reader.connections:
            key = (connection.topic, connection.msgtype)
            counts[key] = counts.get(key, 0) + (
                self._reader.counted(connection.id) if is_first else connection.msgcount
            )
        self.topics = [Topic(topic, kind, count) for (topic, kind), count in counts.items()]

    def messages(self, topics: Iterable[str]) -> Iterator[Message]:
        """Yield the messages of these topics, in the order of the bag's clock, if that does not fall."""
        wanted = set(topics)
        chosen = [one for one in self._reader.connections if one.topic in wanted]
        if not chosen:
            return
        try:
            given = of_bag1(self._reader, chosen) if self._is_first else of_bag2(self._reader, chosen)
            for connection, t_ns, raw in given:
                kind = connection.msgtype
                store = self._store(kind, connection.msgdef)
                take = store.deserialize_ros1 if self._is_first else store.deserialize_cdr
                yield Message(connection.topic, kind, t_ns / _NANO, take(raw, kind))
        except Exception as error:
            raise Broken(_what(error)) from error

    def _store(self, kind: str, definition: Any) -> Any:
        from rosbags.interfaces import MessageDefinitionFormat
        from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore

        key = (kind, definition.data)
        if key not in self._stores:
            if definition.format == MessageDefinitionFormat.MSG:
                store = get_typestore(Stores.EMPTY)
                store.register(get_types_from_msg(definition.data, kind))
            elif definition.format == MessageDefinitionFormat.IDL:
                store = get_typestore(Stores.EMPTY)
                for text in definition.data.split("=" * 80 + "\n"):
                    store.register(
                        get_types_from_idl(text.partition("\n")[2] if text.startswith("IDL: ") else text)
                    )
            else:
                store = get_typestore(Stores.ROS2_JAZZY)
                if kind == SONAR_ARRAY:
                    store.register(get_types_from_msg(_SONAR_ARRAY, kind))
            self._stores[key] = store
        return self._stores[key]

    def close(self) -> None:
        """Close the bag."""
        with suppress(Exception):
            self._reader.close()


class OwnMcap:
    """An MCAP with SIPs, as `argus-log convert` writes it, or of JSON messages, as of the Foxglove bridge."""

    def __init__(self, path: Path, name: str) -> None:
        from mcap.reader import make_reader

        self._file = path.open("rb")
        try:
            self._reader = make_reader(self._file)
            summary = self._reader.get_summary()
        except Exception as error:
            self._file.close()
            raise LogError(f"{name}: an MCAP file that cannot be read: {_what(error)}") from error
        if summary is None or summary.statistics is None:
            raise LogError(
                f"{name}: an MCAP file without an index, as of a recorder that was killed: mcap recover FILE"
            )
        counts = summary.statistics.channel_message_counts
        self.topics = [
            Topic(channel.topic, summary.schemas[channel.schema_id].name, counts.get(number, 0))
            for number, channel in summary.channels.items()
            if channel.schema_id in summary.schemas
            and (channel.message_encoding == "json" or summary.schemas[channel.schema_id].name == SIP)
        ]

    def messages(self, topics: Iterable[str]) -> Iterator[Message]:
        """Yield the messages of these topics by their log time, if that does not fall."""
        wanted = list(topics)
        try:
            by_time = not falls(mcap_times(self._reader, self._file, wanted))
            for schema, channel, message in self._reader.iter_messages(wanted, log_time_order=by_time):
                if schema is not None and schema.name == SIP:
                    fields = SimpleNamespace(**read_sip(message.data))
                    yield Message(channel.topic, schema.name, message.log_time / _NANO, fields)
                elif schema is not None and channel.message_encoding == "json":
                    body = json.loads(message.data, object_hook=lambda fields: SimpleNamespace(**fields))
                    yield Message(channel.topic, schema.name, message.log_time / _NANO, body)
        except Exception as error:
            raise Broken(_what(error)) from error

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def _reader_of_bag2(path: Path) -> Any:
    from rosbags.rosbag2 import Reader

    return Reader(path)


def _what(error: BaseException) -> str:
    return (str(error) or type(error).__name__).splitlines()[0][:160]
