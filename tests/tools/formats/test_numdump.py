# SPDX-License-Identifier: MIT
"""Rule: a dump in decimal numbers or characters gives back its bytes, as each of them is clear; no dump is a crash."""

from __future__ import annotations

import random
import subprocess
from pathlib import Path

import pytest
from argus_tools.formats import LogError, open_log
from forms import CLIENT, ROBOT, joined, read, rows

ODD = ROBOT + b"\xfa"
ESCAPES = {0: r"\0", 7: r"\a", 8: r"\b", 9: r"\t", 10: r"\n", 11: r"\v", 12: r"\f", 13: r"\r"}
TEXT = bytes(range(256)) + b"P3DX Pioneer  end "


def numbers(data: bytes, size: int, is_signed: bool, width: int, address: str = "07o") -> str:
    lines = []
    for at, part in rows(data):
        padded = part + bytes(-len(part) % size)
        words = (
            int.from_bytes(padded[n : n + size], "little", signed=is_signed)
            for n in range(0, len(padded), size)
        )
        lines.append(f"{at:{address}}" + "".join(f"{word:>{width}}" for word in words))
    return "\n".join([*lines, f"{len(data):{address}}"]) + "\n"


def character(byte: int) -> str:
    return ESCAPES.get(byte) or (chr(byte) if 32 <= byte < 127 else f"{byte:03o}")


def characters(data: bytes, address: str = "07o") -> str:
    lines = [f"{at:{address}}" + "".join(f"{character(b):>4}" for b in part) for at, part in rows(data)]
    return "\n".join([*lines, f"{len(data):{address}}"]) + "\n"


DUMPS = {
    "od -t d1": numbers(ODD, 1, True, 5),
    "od -t u1": numbers(ODD, 1, False, 4),
    "od -t d2": numbers(ODD, 2, True, 7),
    "od -t u2": numbers(ODD, 2, False, 6),
    "od -t d4": numbers(ODD, 4, True, 12),
    "od -t u8": numbers(ODD, 8, False, 21),
    "od -A x -t d1": numbers(ODD, 1, True, 5, "06x"),
    "od -A d -t u1": numbers(ODD, 1, False, 4, "07d"),
    "od -c": characters(ODD),
    "od -A d -c": characters(ODD, "07d"),
    "hexdump -c": characters(ODD, "07x"),
    "carriage returns": "\ufeff" + numbers(ODD, 1, True, 5).replace("\n", "\r\n"),
    "a comment": "# of Monday\n" + characters(ODD),
}


@pytest.mark.parametrize("name", DUMPS)
def test_every_dump_gives_its_bytes(name: str, tmp_path: Path) -> None:
    log = read(tmp_path / "a.txt", DUMPS[name])
    chunks = list(log)
    assert (log.format.name, log.damage) == ("numdump", [])
    assert joined(chunks, "r2c") == ODD


@pytest.mark.parametrize("kind", ["d1", "u1", "o1", "x1", "x2", "d2", "u2", "d4", "c", "o2", "x8"])
@pytest.mark.parametrize("data", [ODD, CLIENT * 20, ROBOT + TEXT], ids=["robot", "client", "all bytes"])
def test_what_od_itself_prints(kind: str, data: bytes, tmp_path: Path) -> None:
    text = subprocess.run(["od", "-v", "-t", kind], input=data, capture_output=True, check=True).stdout
    log = read(tmp_path / "a.txt", text.decode())
    chunks = list(log)
    assert joined(chunks, "r2c") + joined(chunks, "c2r") == data
    assert log.damage == []


@pytest.mark.parametrize("kind", ["d1", "u2", "c"])
def test_an_asterisk_stands_for_the_lines_it_replaces(kind: str, tmp_path: Path) -> None:
    data = ROBOT + bytes(160) + ROBOT
    text = subprocess.run(["od", "-t", kind], input=data, capture_output=True, check=True).stdout.decode()
    assert "\n*\n" in text
    log = read(tmp_path / "a.txt", text)
    assert (joined(list(log), "r2c"), log.damage) == (data, [])


@pytest.mark.parametrize("line", ["hello", "0000100  999 1 2", "0000100 - 1 2", "zzz  -6 -5"])
def test_a_line_that_is_none_is_told(line: str, tmp_path: Path) -> None:
    lines = DUMPS["od -t d1"].splitlines()
    log = read(tmp_path / "a.txt", "\n".join([*lines[:4], line, *lines[4:]]) + "\n")
    assert joined(list(log), "r2c") == ODD
    assert [entry.place for entry in log.damage] == ["line 5"]


@pytest.mark.tour(40, 80)
@pytest.mark.parametrize("name", DUMPS)
@pytest.mark.parametrize("seed", range(20))
def test_random_damage_is_no_crash(name: str, seed: int, tmp_path: Path) -> None:
    rng = random.Random(f"{name} {seed}")
    data = bytearray(DUMPS[name].encode())
    for _ in range(rng.randrange(1, 12)):
        at = rng.randrange(len(data))
        data[at : at + rng.randrange(20)] = rng.choice(
            (b"", b"\n", b"*\n", b"-", b"9" * 30, b"\xff", b" -6 ", b"\0")
        )
    path = tmp_path / "a.txt"
    path.write_bytes(data or b"x")
    try:
        assert all(isinstance(chunk.data, bytes) for chunk in open_log(str(path)))
    except LogError as error:
        if len(str(error).splitlines()) != 1:
            raise
