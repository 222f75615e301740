# SPDX-License-Identifier: MIT
"""Rule: frames that tshark -x prints are read as the capture is from which they come, whatever the interface."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import pytest
from argus_tools.formats import LogError
from argus_tools.formats.tcp import Connection
from forms import CLIENT, COMMANDS, ROBOT, SIPS, START_S, frames, joined, read, rows, shown

Frames = list[tuple[float, bytes]]


def socketcan(can_id: int, data: bytes) -> bytes:
    return struct.pack(">IB3x", can_id, len(data)) + data


def can_frames(wrap: Callable[[bytes], bytes]) -> Frames:
    return [(frame.t, wrap(socketcan(frame.can_id, frame.data))) for frame in frames()]


def tcp_frames(wrap: Callable[[bytes], bytes]) -> Frames:
    """`wrap` gets a frame of Ethernet."""
    connection = Connection()
    out = [(START_S, wrap(data)) for data in connection.opening()]
    for n, (command, sip) in enumerate(zip(COMMANDS, SIPS, strict=True)):
        for direction, data in (("c2r", command), ("r2c", sip)):
            out += [(START_S + 0.1 * n, wrap(part)) for part in connection.frames(direction, data)]  # type: ignore[arg-type]
    return out


CAPTURES: dict[str, Frames] = {
    "SocketCAN": can_frames(lambda data: data),
    "CAN of any interface": can_frames(lambda data: struct.pack(">HHH8xH", 0, 280, 0, 0x000C) + data),
    "CAN of any interface, new": can_frames(
        lambda data: struct.pack(">HHIHBB8x", 0x000C, 0, 3, 280, 0, 0) + data
    ),
    "Ethernet": tcp_frames(lambda data: data),
    "IP of any interface": tcp_frames(lambda data: bytes(14) + data[12:]),
    "raw IP": tcp_frames(lambda data: data[14:]),
}


def block(data: bytes, gap: int = 2) -> str:
    return (
        "".join(f"{at:04x}{' ' * gap}{part.hex(' '):<47}   {shown(part)}\n" for at, part in rows(data)) + "\n"
    )


def details(number: int, t: float, data: bytes) -> str:
    return (
        f"Frame {number}: {len(data)} bytes on wire\n    Arrival Time: Nov 25, 2026 07:03:04.251102000 UTC\n"
        f"    Epoch Time: {t:.9f} seconds\n    Frame Number: {number}\nData (8 bytes)\n    Data: 06fafb03000000cc\n\n"
    )


PRINTS: dict[str, Callable[[int, float, bytes], str]] = {
    "tshark -x": lambda n, t, data: block(data),
    "tshark -P -x": lambda n, t, data: (
        f"{n:5}   {t - START_S:.6f}      →      CAN 16 ID: 1600\n\n" + block(data)
    ),
    "tshark -V -x": lambda n, t, data: details(n, t, data) + block(data),
    "copied from Wireshark": lambda n, t, data: block(data, 3),
    "with what was put together": lambda n, t, data: (
        f"Frame ({len(data)} bytes):\n{block(data)}Reassembled TCP (20 bytes):\n{block(bytes(20))}"
    ),
}


@pytest.mark.parametrize("how", PRINTS)
@pytest.mark.parametrize("name", CAPTURES)
def test_every_capture_is_read(name: str, how: str, tmp_path: Path) -> None:
    text = "".join(PRINTS[how](n, t, data) for n, (t, data) in enumerate(CAPTURES[name], start=1))
    log = read(tmp_path / "a.txt", text)
    chunks = list(log)
    assert (joined(chunks, "c2r"), joined(chunks, "r2c"), log.damage) == (CLIENT, ROBOT, [])
    assert log.format.name == "frame-dump"


@pytest.mark.parametrize(
    ("how", "start"), [("tshark -P -x", 0.0), ("tshark -V -x", START_S), ("tshark -x", None)]
)
def test_a_time_that_is_told_is_kept(how: str, start: float | None, tmp_path: Path) -> None:
    frames_of = enumerate(CAPTURES["Ethernet"], start=1)
    chunks = list(read(tmp_path / "a.txt", "".join(PRINTS[how](n, t, data) for n, (t, data) in frames_of)))
    times = [chunk.t for chunk in chunks if chunk.dir == "r2c"]
    expected = [None] * 12 if start is None else [start + 0.1 * n for n in range(12)]
    assert times == (expected if start is None else pytest.approx(expected, abs=1e-5))


def test_a_sample_of_one_frame(tmp_path: Path) -> None:
    log = read(tmp_path / "a.txt", block(socketcan(0x640, bytes.fromhex("06fafb03000000cc"))))
    assert joined(list(log), "c2r") == bytes.fromhex("fafb03000000")


def test_a_lost_line_of_a_frame_is_told(tmp_path: Path) -> None:
    lines = "".join(block(data) for _, data in CAPTURES["Ethernet"]).splitlines(keepends=True)
    log = read(tmp_path / "a.txt", "".join(lines[:1] + lines[2:]))
    list(log)
    assert "is not where the frame before goes on" in log.damage[0].what


def test_other_frames_are_told(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="no CAN frame is of a robot's link"):
        list(
            read(tmp_path / "a.txt", block(socketcan(0x640, bytes(8))).replace("06 40", "01 40") * 3 + "x\n")
        )
