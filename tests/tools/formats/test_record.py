# SPDX-License-Identifier: MIT
"""Rule: a recording gives back what was written; what is broken or missing in it is told with its place."""

from __future__ import annotations

import io

import pytest
from argus_tools.chunks import Chunk, Damage, LogError, ReadOptions, copy
from argus_tools.formats.record import FORMAT, RecordReader

from hil_sim.record.recording import MAGIC, Kind, encode, encode_clock, encode_start

CHUNKS = [
    Chunk(0.0, "c2r", b"\xfa\xfb\x03\x00\x00\x00", 0),
    Chunk(0.167913, "r2c", b"\xfa\xfb\x03\x00\x00\x00", 0),
    Chunk(5000.25, "r2c", bytes(300), 6),
    Chunk(5000.25, "c2r", b"\xa5\xc3\x01", 6),
]


def written(chunks: list[Chunk]) -> bytes:
    stream = io.BytesIO()
    assert FORMAT.writer is not None
    copy(chunks, FORMAT.writer(stream, ReadOptions()))
    return stream.getvalue()


def reader(data: bytes) -> RecordReader:
    return RecordReader(io.BufferedReader(io.BytesIO(data)), ReadOptions(name="x.rec"))


def test_round_trip() -> None:
    data = written(CHUNKS)
    assert FORMAT.sniff(data)
    back = reader(data)
    assert list(back) == CHUNKS
    assert back.damage == []


def test_nothing_is_a_recording_too() -> None:
    assert FORMAT.sniff(written([]))
    assert list(reader(written([]))) == []


def test_a_long_chunk_is_parted() -> None:
    chunks = list(reader(written([Chunk(1.0, "r2c", bytes(10_000), 0)])))
    assert [chunk.offset for chunk in chunks] == [0, 4096, 8192]
    assert sum(len(chunk.data) for chunk in chunks) == 10_000


def test_unix_time_keeps_its_microseconds() -> None:
    (chunk,) = reader(written([Chunk(1_700_000_000.123456, "r2c", b"x", 0)]))
    assert chunk.t == pytest.approx(1_700_000_000.123456, abs=1e-6)


def test_other_files_are_not_taken_for_one() -> None:
    for data in (b"", b"\xa5\xc3", b"\xfa\xfb\x03\x00\x00\x00", MAGIC):
        assert not FORMAT.sniff(data)


def test_damage_has_its_place() -> None:
    start = encode_start("test", 0, 0)
    lost = encode(Kind.LOST, 0, (77).to_bytes(4, "little"))
    data = (
        start
        + b"junk"
        + lost
        + encode(9, 0, b"of the future")
        + encode(Kind.TO_ROBOT, 0, b"x")
        + b"\xa5\xc3\x01"
    )
    back = reader(data)
    assert [chunk.data for chunk in back] == [b"x"]
    assert back.damage == [
        Damage(f"byte {len(start)}", "no record, 4 bytes skipped"),
        Damage(
            f"byte {len(start) + 4}",
            "the recorder's disk was full: 77 bytes of the link are missing",
        ),
        Damage(f"byte {len(data) - 3}", "cut off here, 3 bytes skipped"),
    ]


def test_a_newer_version_is_refused() -> None:
    data = encode(Kind.HEADER, 0, MAGIC + b"\x02") + encode_clock(0, 0)
    with pytest.raises(LogError, match=r"x\.rec: byte 0: a recording of version 2"):
        list(reader(data))
