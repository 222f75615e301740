# SPDX-License-Identifier: MIT
"""Every format gives back the bytes and times written to it, is recognised, and tells of damage."""

from __future__ import annotations

import io
import random
import struct
from pathlib import Path
from typing import Any

import pytest
from argus_tools.chunks import Damage
from argus_tools.formats import Chunk, LogError, ReadOptions, formats, open_log
from argus_tools.formats.tcp import SEGMENT_BYTES, Connection, Streams, parse
from logs import CAPTURES, capture_bytes, sip

FILES = sorted(path.stem for path in CAPTURES.glob("*.jsonl"))
BOTH_WAYS = sorted(name for name, form in formats().items() if form.writer and name != "bin")


def written(name: str, chunks: list[Chunk], **options: Any) -> bytes:
    stream = io.BytesIO()
    make = formats()[name].writer
    assert make is not None
    writer = make(stream, ReadOptions(**options))
    for chunk in chunks:
        writer.write(chunk)
    writer.close()
    return stream.getvalue()


def read(path: Path, data: bytes, **options: Any) -> tuple[list[Chunk], list[Damage]]:
    path.write_bytes(data)
    log = open_log(str(path), **options)
    return list(log), log.damage


def joined(chunks: list[Chunk], direction: str) -> bytes:
    return b"".join(chunk.data for chunk in chunks if chunk.dir == direction)


@pytest.mark.parametrize("name", BOTH_WAYS)
@pytest.mark.parametrize("capture", FILES)
def test_both_directions_come_back(tmp_path: Path, name: str, capture: str) -> None:
    chunks = list(open_log(str(CAPTURES / f"{capture}.jsonl")))
    back, damage = read(tmp_path / "log", written(name, chunks))
    assert damage == []
    for direction in ("r2c", "c2r"):
        assert joined(back, direction) == capture_bytes(CAPTURES / f"{capture}.jsonl", direction)
    assert [chunk.t for chunk in back] == pytest.approx([chunk.t for chunk in chunks], abs=2e-6)
    assert all(
        chunk.offset == sum(len(c.data) for c in back[:n] if c.dir == chunk.dir)
        for n, chunk in enumerate(back)
    )


@pytest.mark.parametrize("direction", ["r2c", "c2r"])
@pytest.mark.parametrize("capture", FILES)
def test_a_bin_is_read_with_its_direction(tmp_path: Path, capture: str, direction: str) -> None:
    chunks = list(open_log(str(CAPTURES / f"{capture}.jsonl")))
    data = written("bin", chunks, direction=direction)
    back, _ = read(tmp_path / "log", data)
    assert {chunk.dir for chunk in back} == {direction}
    assert joined(back, direction) == data == joined(chunks, direction)


def test_a_bin_holds_one_direction() -> None:
    with pytest.raises(LogError, match="--dir"):
        written("bin", [Chunk(0.0, "r2c", b"a", 0), Chunk(0.0, "c2r", b"b", 0)])


@pytest.mark.parametrize("name", [*BOTH_WAYS, "bin"])
def test_each_format_is_recognised(tmp_path: Path, name: str) -> None:
    data = written(name, [Chunk(5.0, "r2c", sip(), 0)])
    (tmp_path / "log").write_bytes(data)
    assert open_log(str(tmp_path / "log")).format.name == name


@pytest.mark.parametrize("name", BOTH_WAYS)
@pytest.mark.parametrize("seed", range(30))
def test_a_cut_file_gives_what_comes_before_the_cut(tmp_path: Path, name: str, seed: int) -> None:
    rng = random.Random(f"{name} {seed}")
    chunks = [Chunk(float(n), "r2c", sip(x=n), n * len(sip())) for n in range(20)]
    data = written(name, chunks)
    end = rng.randrange(1, len(data))
    (tmp_path / "log").write_bytes(data[:end])
    try:
        back = list(open_log(str(tmp_path / "log"), name))
    except LogError:
        assert end < 64
        return
    whole = joined(chunks, "r2c")
    assert whole.startswith(joined(back, "r2c"))
    assert len(joined(back, "r2c")) >= len(whole) * (end / len(data)) - 300


@pytest.mark.parametrize("name", [*BOTH_WAYS, "bin"])
@pytest.mark.parametrize("seed", range(40))
def test_random_damage_is_no_crash(tmp_path: Path, name: str, seed: int) -> None:
    rng = random.Random(f"{name} {seed}")
    data = bytearray(written(name, [Chunk(float(n), "r2c", sip(x=n), 0) for n in range(20)]))
    for _ in range(rng.randrange(1, 8)):
        data[rng.randrange(len(data))] = rng.randrange(256)
    (tmp_path / "log").write_bytes(data)
    try:
        log = open_log(str(tmp_path / "log"), name)
        assert all(isinstance(chunk.data, bytes) for chunk in log)
    except LogError as error:
        lines = str(error).splitlines()
        if len(lines) != 1:
            raise


@pytest.mark.parametrize("name", BOTH_WAYS)
def test_long_chunks_are_split_and_come_back(tmp_path: Path, name: str) -> None:
    data = sip() + random.Random(1).randbytes(10_000)
    back, damage = read(tmp_path / "log", written(name, [Chunk(0.0, "c2r", data, 0)]), format_name=name)
    assert (joined(back, "c2r"), damage) == (data, [])


def frames() -> list[bytes]:
    connection = Connection()
    made = connection.opening()
    for n in range(6):
        made += connection.frames("r2c", sip(x=n))
    return made


def followed(captured: list[bytes], **options: Any) -> tuple[bytes, list[Damage]]:
    streams = Streams(ReadOptions(**options), [])
    chunks: list[Chunk] = []
    for number, frame in enumerate(captured):
        segment = parse(1, frame)
        assert segment is not None
        chunks += streams.take(float(number), number, segment)
    chunks += streams.finish()
    return joined(chunks, "r2c"), streams.damage


def test_tcp_is_put_in_order_and_repeated_segments_count_once() -> None:
    whole = b"".join(sip(x=n) for n in range(6))
    captured = frames()
    assert followed(captured) == (whole, [])
    assert followed([*captured[:4], captured[5], captured[4], captured[5], *captured[6:]]) == (whole, [])


def test_a_segment_that_was_not_captured_is_told() -> None:
    captured = frames()
    data, damage = followed([*captured[:4], *captured[5:]])
    assert data == b"".join(sip(x=n) for n in (0, 2, 3, 4, 5))
    assert f"{len(sip())} bytes" in damage[0].what


def test_a_capture_without_its_beginning_knows_the_robot() -> None:
    data, damage = followed(frames()[3:])
    assert (data, damage) == (b"".join(sip(x=n) for n in range(6)), [])


def test_pcap_of_either_byte_order_and_nanoseconds(tmp_path: Path) -> None:
    captured = frames()
    for order, magic, unit in (("<", 0xA1B2C3D4, 10**6), (">", 0xA1B2C3D4, 10**6), (">", 0xA1B23C4D, 10**9)):
        data = struct.pack(order + "IHHiIII", magic, 2, 4, 0, 0, 65535, 1)
        for number, frame in enumerate(captured):
            data += struct.pack(order + "IIII", number, unit // 2, len(frame), len(frame)) + frame
        back, damage = read(tmp_path / "log", data)
        assert (len(back), back[0].t, damage) == (6, 3.5, [])


def test_segments_are_no_longer_than_a_network_carries() -> None:
    assert max(map(len, Connection().frames("r2c", bytes(5000)))) <= SEGMENT_BYTES + 54
