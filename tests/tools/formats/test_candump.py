# SPDX-License-Identifier: MIT
"""Rule: of any bus traffic the candump reader gives the robot's messages, and tells by line what it lost of them."""

from __future__ import annotations

import io
import random
from pathlib import Path

import pytest
from argus_tools.chunks import Damage, Direction
from argus_tools.formats import Chunk, ReadOptions, formats, open_log
from argus_tools.log.packets import packets
from logs import command, decode, sip

SIP = sip(x=5, sonars=((0, 1000), (1, 2000)))


def line(payload: bytes, can_id: str = "648", t: float = 1.0, mark: str = "#", bus: str = "can0") -> str:
    return f"({t:.6f}) {bus} {can_id}{mark}{payload.hex().upper()}\n"


def message(data: bytes, can_id: str = "648", t: float = 1.0, bus: str = "can0") -> list[str]:
    """The frames of a message, without padding and flow control, made without the writer under test."""
    if len(data) < 8:
        return [line(bytes((len(data),)) + data, can_id, t, bus=bus)]
    frames = [(0x1000 | len(data)).to_bytes(2, "big") + data[:6]]
    frames += [bytes((0x20 | n & 15,)) + data[at : at + 7] for n, at in enumerate(range(6, len(data), 7), 1)]
    return [line(frame, can_id, t, bus=bus) for frame in frames]


def read(tmp_path: Path, *lines: str, robot: int | None = None) -> tuple[list[Chunk], list[Damage]]:
    path = tmp_path / "a.log"
    path.write_text("".join(lines))
    log = open_log(str(path), "candump", robot=robot)
    return list(log), log.damage


def sent(chunks: list[Chunk], direction: Direction = "r2c") -> bytes:
    return b"".join(chunk.data for chunk in chunks if chunk.dir == direction)


@pytest.mark.parametrize("robot", range(8))
def test_each_robot_has_its_pair_of_ids(robot: int, tmp_path: Path) -> None:
    lines = []
    for k in range(8):
        lines += message(command("VEL", k), f"{0x640 + k:03x}") + message(sip(x=k), f"{0x648 + k:03X}")
    chunks, damage = read(tmp_path, *lines, robot=robot)
    assert sent(chunks) == sip(x=robot)
    assert sent(chunks, "c2r") == command("VEL", robot)
    assert damage == []


def test_the_first_robot_is_taken_and_the_others_are_told_once(tmp_path: Path) -> None:
    lines = message(sip(x=1), "64A") + message(sip(x=2), "64D") * 3 + message(sip(x=3), "64A")
    chunks, damage = read(tmp_path, *lines)
    assert sent(chunks) == sip(x=1) + sip(x=3)
    begin = len(message(sip(x=1))) + 1
    assert damage == [
        Damage(f"line {begin}", "robot 5 is left out, as robot 2 came first; choose with --robot")
    ]


def test_one_bus_of_several_is_read(tmp_path: Path) -> None:
    lines = [text for pair in zip(message(SIP), message(SIP, bus="vcan1"), strict=True) for text in pair]
    chunks, damage = read(tmp_path, *lines)
    assert sent(chunks) == SIP
    assert [entry.place for entry in damage] == ["line 2"]
    assert "interface vcan1" in damage[0].what


def test_messages_of_both_directions_interleave(tmp_path: Path) -> None:
    robot, client = message(SIP), message(command("VEL", 1) + command("RVEL", 2), "640")
    lines = [
        robot[0],
        line(b"\x30\0\0", "640"),
        client[0],
        line(b"\x30\0\0"),
        robot[1],
        client[1],
        *robot[2:],
    ]
    lines += client[2:]
    chunks, damage = read(tmp_path, *lines)
    assert (sent(chunks), sent(chunks, "c2r"), damage) == (SIP, command("VEL", 1) + command("RVEL", 2), [])


def test_other_frames_are_passed_over(tmp_path: Path) -> None:
    noise = [
        line(b"\x02ab", "00000648"), line(b"\x02ab", "18DA4806"), "(1.0) can0 648#R\n", "(1.0) can0 648#R8\n",
        line(b"\x02ab", "500"), line(bytes(64), "123", mark="##1"), "(1.0) can0 20000004#0004000000000000\n", "\n",
        line(b"\x02ab", "63F"), line(b"\x02ab", "650"),
    ]  # fmt: skip
    frames = message(SIP)
    chunks, damage = read(tmp_path, *noise, frames[0], *noise, *frames[1:], *noise)
    assert (sent(chunks), damage) == (SIP, [])


@pytest.mark.parametrize("suffix", [" R", " T", ""])
@pytest.mark.parametrize("dotted", [False, True])
def test_marks_and_dots_of_other_candumps(suffix: str, dotted: bool, tmp_path: Path) -> None:
    lines = []
    for text in message(SIP):
        head, _, digits = text.strip().partition("#")
        shown = ".".join(digits[at : at + 2] for at in range(0, len(digits), 2)) if dotted else digits
        lines.append(f"{head}#{shown}{suffix}\n")
    assert sent(read(tmp_path, *lines)[0]) == SIP


def test_can_fd(tmp_path: Path) -> None:
    # One frame with an escaped length; a first frame of 64 bytes with one more; the escaped 32-bit length.
    short, long = sip(sonars=((3, 333),)), b"".join(sip(x=n) for n in range(5))
    lines = [line((b"\0" + bytes((len(short),)) + short).ljust(64, b"\xcc"), mark="##1")]
    for head in ((0x1000 | len(long)).to_bytes(2, "big"), b"\x10\0" + len(long).to_bytes(4, "big")):
        first = 64 - len(head)
        lines.append(line(head + long[:first], mark="##0"))
        for n, at in enumerate(range(first, len(long), 63), 1):
            lines.append(line((bytes((0x20 | n,)) + long[at : at + 63]).ljust(64, b"\xcc"), mark="##3"))
    chunks, damage = read(tmp_path, *lines)
    assert ([chunk.data for chunk in chunks], damage) == ([short, long, long], [])


def test_the_32_bit_length_on_classic_can(tmp_path: Path) -> None:
    data = SIP
    lines = [line(b"\x10\0" + len(data).to_bytes(4, "big") + data[:2])]
    lines += [
        line(bytes((0x20 | n & 15,)) + data[at : at + 7]) for n, at in enumerate(range(2, len(data), 7), 1)
    ]
    assert read(tmp_path, *lines) == ([Chunk(1.0, "r2c", data, 0)], [])


@pytest.mark.parametrize("lost", range(1, len(message(SIP))))
def test_a_lost_frame_costs_its_message_alone(lost: int, tmp_path: Path) -> None:
    frames = message(SIP, t=2.0)
    before, after = message(sip(x=1), t=1.0), message(sip(x=3), t=3.0)
    chunks, damage = read(tmp_path, *before, *frames[:lost], *frames[lost + 1 :], *after)
    rows = list(packets(chunks))
    assert [row.data for row in rows if row.ok] == [sip(x=1)[3:-2], sip(x=3)[3:-2]]
    assert next(row.type for row in rows if not row.ok) == "SIP"
    why = "lacks a frame" if lost < len(frames) - 1 else "is broken off"
    assert damage == [
        Damage(
            f"line {len(before) + 1}",
            f"an ISO-TP message {why}: {6 + 7 * (lost - 1)} of {len(SIP)} bytes came",
        )
    ]


def test_frames_out_of_order_or_twice(tmp_path: Path) -> None:
    frames = message(SIP)
    for wrong in ([frames[0], frames[2], frames[1], *frames[3:]], [*frames[:3], frames[2], *frames[3:]]):
        chunks, damage = read(tmp_path, *wrong, *message(sip(x=9)))
        assert [row.data for row in packets(chunks) if row.ok] == [sip(x=9)[3:-2]]
        assert len(damage) == 1
        assert "lacks a frame" in damage[0].what


def test_a_log_that_begins_or_ends_in_a_message(tmp_path: Path) -> None:
    frames = message(SIP)
    chunks, damage = read(tmp_path, *frames[2:], *message(sip(x=1)), *frames[:3])
    assert [row.data for row in packets(chunks) if row.ok] == [sip(x=1)[3:-2]]
    last = len(frames) - 2 + len(message(sip(x=1))) + 1
    assert [entry.place for entry in damage] == ["line 1", f"line {last}"]
    assert "beginning is missing" in damage[0].what
    assert "has no end" in damage[1].what


@pytest.mark.parametrize(
    ("payload", "part"),
    [
        (b"\x09abcdefg", "single frame of a wrong length"),
        (b"\x00abc", "single frame of a wrong length"),
        (b"\x05ab", "single frame of a wrong length"),
        (b"\x10\x05abcdef", "first frame of a wrong length"),
        (b"\x10\x20abc", "first frame of a wrong length"),
        (b"\x10\0\xff\xff\xff\xffab", "first frame of a wrong length"),
        (b"\x40abc", "no ISO-TP frame"),
    ],
)
def test_frames_that_are_none(payload: bytes, part: str, tmp_path: Path) -> None:
    chunks, damage = read(tmp_path, *message(sip(x=1)), line(payload), *message(sip(x=2)))
    assert sent(chunks) == sip(x=1) + sip(x=2)
    assert [(entry.place, part in entry.what) for entry in damage] == [
        (f"line {len(message(sip(x=1))) + 1}", True)
    ]


def test_lines_that_are_none(tmp_path: Path) -> None:
    chunks, damage = read(tmp_path, *message(SIP), "(x) can0\n", "(1.0) can0 648#0\n", *message(SIP))
    first = len(message(SIP)) + 1
    assert sent(chunks) == SIP * 2
    assert damage == [
        Damage(f"line {first}", "no line of candump"),
        Damage(f"line {first + 1}", "an odd number of hexadecimal digits"),
    ]


@pytest.mark.parametrize("seed", range(20))
def test_what_is_written_is_read(seed: int, tmp_path: Path) -> None:
    rng = random.Random(seed)
    ways: tuple[Direction, ...] = ("r2c", "c2r")
    chunks = [Chunk(float(n), rng.choice(ways), rng.randbytes(rng.randrange(1, 4096)), 0) for n in range(30)]
    stream = io.BytesIO()
    make = formats()["candump"].writer
    assert make is not None
    writer = make(stream, ReadOptions(robot=seed % 8))
    for chunk in chunks:
        writer.write(chunk)
    back, damage = read(tmp_path, stream.getvalue().decode())
    assert [chunk[:3] for chunk in back] == [chunk[:3] for chunk in chunks]
    assert damage == []


def test_a_broken_message_is_a_row_that_is_not_ok(tmp_path: Path) -> None:
    path = tmp_path / "a.log"
    frames = message(SIP)
    path.write_text("".join([*message(sip(x=1)), *frames[:3], *frames[4:], *message(sip(x=2))]))
    rows = decode(path)
    assert [(row["type"], row["ok"]) for row in rows] == [("SIP", True), ("SIP", False), ("SIP", True)]
    assert rows[1]["offset"] == len(sip(x=1))


@pytest.mark.parametrize("before", ["can0 ", "vcan0robot  ", "", "  can0  "])
@pytest.mark.parametrize("separator", ["", "."])
def test_frames_without_times_as_cansend_takes_them(before: str, separator: str, tmp_path: Path) -> None:
    lines = []
    for text in message(SIP):
        digits = text.strip().partition("#")[2]
        shown = separator.join(digits[at : at + 2] for at in range(0, len(digits), 2))
        lines.append(f"{before}648#{shown}\n")
    chunks, damage = read(tmp_path, *lines)
    assert (sent(chunks), damage, {chunk.t for chunk in chunks}) == (SIP, [], {None})
