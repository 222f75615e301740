# SPDX-License-Identifier: MIT
"""Rule: a log that a stranger's tool or computer spoilt in a known way is read, and what was done to it is reported."""

from __future__ import annotations

import gzip
import io
import random
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import can
import pytest
from argus_tools.chunks import CLIENT_TO_ROBOT, ROBOT_TO_CLIENT, Chunk, ReadOptions
from argus_tools.formats import LogError, canlog, open_log
from argus_tools.formats.telnet import Telnet, is_telnet
from argus_tools.log.packets import packets
from argus_tools.timeline import nanoseconds
from forms import CLIENT, ROBOT, SIPS, frames
from logs import sip

IAC = b"\xff"


def read(path: Path, **options: Any) -> tuple[bytes, bytes, list[str]]:
    """What went either way, and what was reported."""
    log = open_log(str(path), **options)
    sides = {ROBOT_TO_CLIENT: b"", CLIENT_TO_ROBOT: b""}
    for chunk in log:
        sides[chunk.dir] += chunk.data
    return sides[ROBOT_TO_CLIENT], sides[CLIENT_TO_ROBOT], [damage.what for damage in log.damage]


def made(path: Path, data: bytes | str) -> Path:
    data = data.encode() if isinstance(data, str) else data
    path.write_bytes(gzip.compress(data) if path.suffix == ".gz" else data)
    return path


# Tables and lines of CAN frames --------------------------------------------------------------------------------

MDF = ",".join(
    f"CAN_DataFrame.{name}" for name in ("BusChannel", "ID", "IDE", "DLC", "DataLength", "DataBytes", "Dir")
)
CAN_FORMS: dict[str, Callable[[], str]] = {
    "id and bytes": lambda: (
        "ID,Data Bytes\n" + "".join(f"{f.can_id:08X},{f.data.hex(' ')}\n" for f in frames())
    ),
    "id and bytes, tabs": lambda: (
        "CAN ID\tData\n" + "".join(f"0x{f.can_id:X}\t{f.data.hex(' ')}\n" for f in frames())
    ),
    "id and bytes, no heading": lambda: "".join(f"{f.can_id:X};{f.data.hex(' ')}\n" for f in frames()),
    "id, colon, bytes": lambda: "".join(f"{f.can_id:08x}: {f.data.hex(' ')}\n" for f in frames()),
    "MDF": lambda: (
        f"timestamps,{MDF}\n"
        + "".join(
            f"{n / 100:.6f},1,0x{f.can_id:X},0,8,8,{f.data.hex(' ').upper()},Rx\n"
            for n, f in enumerate(frames())
        )
    ),
    "MDF, decimal": lambda: (
        f"timestamps,{MDF}\n"
        + "".join(
            f"{n / 100:.6f},1,{f.can_id},0,8,8,[{' '.join(map(str, f.data))}],Rx\n"
            for n, f in enumerate(frames())
        )
    ),
    "dated": lambda: "".join(
        f"2026-07-17T14:31:18.{n:03d} RX {f.can_id:X} 8 {f.data.hex(' ')}\n" for n, f in enumerate(frames())
    ),
    "dated, with bus and brackets": lambda: "".join(
        f"[2026-07-17 14:31:18.{n:03d}] can0 rx 0x{f.can_id:x} [8] {f.data.hex(' ')}\n"
        for n, f in enumerate(frames())
    ),
    "decoded by cantools, one line each": lambda: "".join(
        f"({f.t:.6f}) can0 {f.can_id:X}#{f.data.hex()} :: Unknown frame id {f.can_id} (0x{f.can_id:x})\n"
        for f in frames()
    ),
    "decoded by cantools, below": lambda: "".join(
        f"  can0  {f.can_id:X}   [8]  {f.data.hex(' ')} ::\nPart(\n    Number: {n},\n    Rest: 3\n)\n"
        for n, f in enumerate(frames())
    ),
}


@pytest.mark.parametrize("form", CAN_FORMS)
def test_frames_of_other_tools(form: str, tmp_path: Path) -> None:
    robot, client, told = read(made(tmp_path / "log.txt", CAN_FORMS[form]()))
    assert (robot, client) == (ROBOT, CLIENT)
    assert told == []


# Zeros and other text before the log ---------------------------------------------------------------------------


@pytest.mark.parametrize("zeros", [1, 4096, 200_000])
@pytest.mark.parametrize("suffix", [".log", ".log.gz"])
def test_zeros_before_text(zeros: int, suffix: str, tmp_path: Path) -> None:
    text = "".join(f"({f.t:.6f}) can0 {f.can_id:X}#{f.data.hex().upper()}\n" for f in frames())
    robot, client, told = read(made(tmp_path / f"x{suffix}", bytes(zeros) + text.encode()))
    assert (robot, client) == (ROBOT, CLIENT)
    assert len(told) == 1
    assert f"{zeros} zeros before the log" in told[0]


@pytest.mark.parametrize("zeros", [32, 16384, 70_000])
@pytest.mark.parametrize("side", [ROBOT, CLIENT], ids=["robot", "client"])
def test_zeros_before_bytes_show_no_direction(zeros: int, side: bytes, tmp_path: Path) -> None:
    robot, client, told = read(made(tmp_path / "x.bin", bytes(zeros) + side))
    assert (robot, client) == ((side, b"") if side == ROBOT else (b"", side))
    assert len(told) == 1
    first = next(iter(open_log(str(tmp_path / "x.bin"))))
    assert first.offset == zeros


def test_the_text_of_a_boot_before_bytes_shows_no_direction(tmp_path: Path) -> None:
    boot = b"U-Boot 2026.01\r\n" * 9000
    robot, client, _ = read(made(tmp_path / "x.bin", boot + ROBOT))
    assert robot.endswith(ROBOT)
    assert client == b""


def test_bytes_that_show_no_direction_are_told(tmp_path: Path) -> None:
    _, _, told = read(made(tmp_path / "x.bin", bytes.fromhex("fafb03000000") * 3))
    assert any("nothing shows whose bytes" in what for what in told)


def test_nothing_but_zeros(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="zeros"):
        open_log(str(made(tmp_path / "x.log", bytes(5000))))


# Telnet -----------------------------------------------------------------------------------------------------------

NEGOTIATION = bytes.fromhex("fffb00fffd00fffb03fffa2c6aff0102fff0")


def through_telnet(data: bytes, seed: int) -> bytes:
    """What a telnet server makes of bytes: each FF doubled, and now and then a command between."""
    rng = random.Random(seed)
    out = [NEGOTIATION]
    for byte in data:
        if rng.random() < 0.002:
            out.append(bytes.fromhex("fff1"))
        out.append(bytes((byte,)) * (1 + (byte == 0xFF)))
    return b"".join(out)


FULL = b"".join(sip(x=65535, y=255 * (n & 3), sonars=((0, 255), (1, 65535))) for n in range(80))


@pytest.mark.parametrize("seed", range(4))
def test_telnet_is_undone_and_told(seed: int, tmp_path: Path) -> None:
    robot, _, told = read(made(tmp_path / "x.bin.gz", through_telnet(FULL, seed)))
    assert robot == FULL, seed
    assert len(told) == 1
    assert "telnet" in told[0]
    assert "accepter: tcp" in told[0]


@pytest.mark.parametrize("seed", range(8))
def test_telnet_in_pieces(seed: int) -> None:
    rng = random.Random(seed)
    data, telnet, out = through_telnet(FULL, seed), Telnet(), b""
    at = 0
    while at < len(data):
        size = rng.choice((1, 2, 3, 50))
        out += telnet.feed(data[at : at + size])
        at += size
    assert out == FULL, seed


def test_a_plain_link_with_doubled_bytes_is_none_of_telnet(tmp_path: Path) -> None:
    assert not is_telnet([FULL, CLIENT])
    robot, _, told = read(made(tmp_path / "x.bin", FULL))
    assert (robot, told) == (FULL, [])


# A transfer as text ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("size", [1, 3000])
def test_returns_before_line_feeds_are_taken_out(size: int, tmp_path: Path) -> None:
    data = b"".join(sip(x=n, sonars=((10, 2570), (1, 1000 + n % 9))) for n in range(size))
    if data.count(b"\n") < 6:
        data *= 12
    robot, _, told = read(made(tmp_path / "x.bin", data.replace(b"\n", b"\r\n")))
    assert robot == data
    assert len(told) == 1
    assert "LF became CRLF" in told[0]


# Readers that do not get on ----------------------------------------------------------------------------------------


class Endless:
    """Reads on for ever, and gives nothing."""

    def __init__(self, file: Any) -> None:
        self._file = file

    def __iter__(self) -> Iterator[can.Message]:
        for n in range(3):
            yield can.Message(
                arbitration_id=0x648, data=b"\x06\xfa\xfb\x03\x00\x00\x00", is_extended_id=False, timestamp=n
            )
        while True:
            self._file.read(16)


class Computing(Endless):
    """Computes for ever without even a read."""

    def __iter__(self) -> Iterator[can.Message]:
        yield from (message for _, message in zip(range(3), super().__iter__(), strict=False))
        while True:
            pass


@pytest.mark.parametrize("reader", [Endless, Computing])
def test_a_reader_that_makes_no_progress_is_ended(
    reader: type[Endless], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(can, "BLFReader", reader)
    monkeypatch.setattr(canlog._Guard, "STUCK_S", 0.5)
    found = canlog.BlfReader(io.BufferedReader(io.BytesIO(b"LOGG")), ReadOptions())
    chunks = list(found)
    assert [chunk.data[:2] for chunk in chunks] == [b"\xfa\xfb"] * 3
    assert len(found.damage) == 1
    assert "damaged here" in found.damage[0].what


def test_a_slow_listener_is_no_reader_without_progress(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(can, "BLFReader", Three)
    monkeypatch.setattr(canlog._Guard, "STUCK_S", 0.05)
    found = canlog.BlfReader(io.BufferedReader(io.BytesIO(b"LOGG")), ReadOptions())
    count = 0
    for _ in found:
        count += 1
        sum(n * n for n in range(1_000_000))
    assert (count, list(found.damage)) == (3, [])


class Three(Endless):
    """Gives three messages and ends."""

    def __iter__(self) -> Iterator[can.Message]:
        yield from (message for _, message in zip(range(3), super().__iter__(), strict=False))


# Times ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(3))
def test_nanoseconds_are_those_of_the_digits(seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(200):
        micros = rng.randrange(1_500_000_000_000_000, 1_900_000_000_000_000)
        assert nanoseconds(micros / 1e6) == micros * 1000, (seed, micros)
    assert nanoseconds(-1.0) == 0


def test_damage_has_the_time_of_its_own_bytes() -> None:
    good, bad = sip(x=1), bytearray(sip(x=2))
    bad[-1] ^= 1
    chunks = [
        Chunk(10.0, ROBOT_TO_CLIENT, good, 0),
        Chunk(20.0, ROBOT_TO_CLIENT, bytes(bad), len(good)),
        Chunk(90.0, ROBOT_TO_CLIENT, good, len(good) + len(bad)),
    ]
    for at_once in (True, False):
        assert [(row.t, row.ok) for row in packets(chunks, at_once)] == [
            (10.0, True),
            (20.0, False),
            (90.0, True),
        ]


def test_the_session_is_not_empty() -> None:
    assert len(SIPS) == 12
