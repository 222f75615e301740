# SPDX-License-Identifier: MIT
"""Rule: a dump with offsets, whoever wrote it, gives back its bytes; what the dump lacks is told."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from forms import CLIENT, ROBOT, hexdump_c, joined, od, read, rows, shown, words, xxd

# An odd number of bytes, so that the last word of each kind is short.
ODD = ROBOT + b"\xfa"


def xxd_e(data: bytes) -> str:
    lines = []
    for at, part in rows(data):
        groups = [part[n : n + 4][::-1].hex() for n in range(0, len(part), 4)]
        lines.append(
            f"{at:08x}: " + " ".join(f"{group:>8}" for group in groups).ljust(35) + f"  {shown(part)}"
        )
    return "\n".join(lines) + "\n"


def xxd_b(data: bytes) -> str:
    return "".join(
        f"{at:08x}: {' '.join(f'{b:08b}' for b in part):<53}  {shown(part)}\n" for at, part in rows(data, 6)
    )


def hexdump_x(data: bytes) -> str:
    lines = [
        f"{at:07x}    " + words(part, 2, lambda w: f"{w:04x}").replace(" ", "    ") for at, part in rows(data)
    ]
    return "\n".join([*lines, f"{len(data):07x}"]) + "\n"


def wireshark(data: bytes) -> str:
    return "".join(f"{at:04x}   {part.hex(' '):<47}   {shown(part)}\n" for at, part in rows(data))


DUMPS = {
    "hexdump -C": hexdump_c(ODD),
    "hexdump": od(ODD, "07x", 2, "04x"),
    "hexdump -x": hexdump_x(ODD),
    "hexdump -b": od(ODD, "07x", 1, "03o"),
    "xxd": xxd(ODD),
    "xxd -g 1": xxd(ODD, 1),
    "xxd -g 4": xxd(ODD, 4),
    "xxd -g 8": xxd(ODD, 8),
    "xxd -u": xxd(ODD).replace("fafb", "FAFB"),
    "xxd -c 32": xxd(ODD, 2, 32),
    "xxd -c 7": xxd(ODD, 2, 7),
    "xxd -e": xxd_e(ODD),
    "xxd -b": xxd_b(ODD),
    "od": od(ODD, "07o", 2, "06o"),
    "od -b": od(ODD, "07o", 1, "03o"),
    "od -x": od(ODD, "07o", 2, "04x"),
    "od -t x1": od(ODD),
    "od -A x -t x1": od(ODD, "06x"),
    "od -A d -t x1": od(ODD, "07d"),
    "od -t x4": od(ODD, "07o", 4, "08x"),
    "od -t x8": od(ODD, "07o", 8, "016x"),
    "Wireshark's copy": wireshark(ODD),
    "with a comment": "# of Monday\n\n" + hexdump_c(ODD),
    "carriage returns": hexdump_c(ODD).replace("\n", "\r\n"),
}


@pytest.mark.parametrize("name", DUMPS)
def test_every_dump_gives_its_bytes(name: str, tmp_path: Path) -> None:
    log = read(tmp_path / "a.txt", DUMPS[name])
    chunks = list(log)
    assert (log.format.name, log.damage) == ("hexdump", [])
    assert joined(chunks, "r2c") == ODD


@pytest.mark.parametrize("name", ["hexdump -C", "xxd", "od -t x1"])
def test_a_client_is_told_from_a_robot(name: str, tmp_path: Path) -> None:
    make = {"hexdump -C": hexdump_c, "xxd": xxd, "od -t x1": od}[name]
    assert joined(list(read(tmp_path / "a.txt", make(CLIENT))), "c2r") == CLIENT


def squeezed(text: str) -> str:
    """As without -v: lines like the one before become one asterisk."""
    out: list[str] = []
    last = None
    for line in text.splitlines():
        content = line.partition(" ")[2]
        if content and content == last:
            if out[-1] != "*":
                out.append("*")
        else:
            out.append(line)
        last = content
    return "\n".join(out) + "\n"


@pytest.mark.parametrize("make", [hexdump_c, od, lambda data: od(data, "07o", 2, "06o")])
@pytest.mark.parametrize("count", [33, 160, 70_000])
def test_an_asterisk_stands_for_the_lines_it_replaces(
    make: Callable[[bytes], str], count: int, tmp_path: Path
) -> None:
    data = ROBOT + bytes(count) + ROBOT + b"\x01" * 64
    text = squeezed(make(data))
    assert "\n*\n" in text
    log = read(tmp_path / "a.txt", text)
    assert (joined(list(log), "r2c"), log.damage) == (data, [])


def test_a_lost_line_is_told_with_its_bytes(tmp_path: Path) -> None:
    lines = hexdump_c(ROBOT).splitlines(keepends=True)
    log = read(tmp_path / "a.txt", "".join(lines[:5] + lines[6:]))
    assert joined(list(log), "r2c") == ROBOT[:80] + ROBOT[96:]
    assert [entry.what for entry in log.damage] == ["16 bytes are missing before offset 0x60"]


def test_a_line_that_is_none_is_told(tmp_path: Path) -> None:
    lines = hexdump_c(ROBOT).splitlines(keepends=True)
    log = read(tmp_path / "a.txt", "".join([*lines[:5], "hello\n", *lines[5:]]))
    assert joined(list(log), "r2c") == ROBOT
    assert [tuple(entry) for entry in log.damage] == [("line 6", "no line of a dump")]


def test_an_offset_beyond_all_reason_fills_nothing(tmp_path: Path) -> None:
    lines = hexdump_c(ROBOT).splitlines(keepends=True)[:-1]
    log = read(tmp_path / "a.txt", "".join([*lines, "*\n", "ffffffff0000  fa\n"]))
    assert len(joined(list(log), "r2c")) <= len(ROBOT) + 1
    assert "are missing" in log.damage[0].what


def test_a_mark_of_utf_8_before_carriage_returns_costs_no_line(tmp_path: Path) -> None:
    text = "\ufeff" + hexdump_c(ODD).replace("\n", "\r\n")
    log = read(tmp_path / "a.txt", text)
    assert (joined(list(log), "r2c"), log.damage) == (ODD, [])


PREAMBLE = (
    "\n"
    + "=" * 67
    + "\nFollow: tcp,hex\nFilter: tcp.stream eq 0\nNode 0: 10.0.0.2:8101\nNode 1: 10.0.0.1:4000\n"
)


def tshark(data: bytes, indent: str, start: int = 0) -> list[str]:
    """A message of one side as `tshark -z follow,tcp,hex` has it: two spaces before the characters, one within."""
    lines = []
    for at, part in rows(data):
        left, right = part[:8].hex(" "), part[8:].hex(" ")
        text = " ".join(filter(None, (shown(part[:8]), shown(part[8:]))))
        lines.append(f"{indent}{start + at:08X}  {left + '  ' + right:<48}  {text}")
    return lines


def followed(first: bytes, second: bytes, preamble: str) -> str:
    lines: list[str] = []
    for at in range(0, max(len(first), len(second)), 100):
        lines += tshark(first[at : at + 100], "", at)
        lines += tshark(second[at : at + 100], "\t", at)
    return preamble + "\n".join(lines) + "\n" + ("=" * 67 + "\n" if preamble else "")


@pytest.mark.parametrize("preamble", [PREAMBLE, ""])
@pytest.mark.parametrize(
    ("first", "second"), [(CLIENT, ROBOT), (ROBOT, CLIENT), (ROBOT, b""), (CLIENT, b""), (b"", ROBOT)]
)
def test_follow_stream_of_tshark(preamble: str, first: bytes, second: bytes, tmp_path: Path) -> None:
    log = read(tmp_path / "a.txt", followed(first, second, preamble))
    chunks = list(log)
    expected = {joined(chunks, "c2r"), joined(chunks, "r2c")}
    assert expected == {first, second}
    assert joined(chunks, "r2c") == (ROBOT if ROBOT in (first, second) else b"")
    assert log.damage == []


def test_the_other_side_may_begin_late(tmp_path: Path) -> None:
    robot = ROBOT * 4
    lines = [*tshark(robot, ""), *tshark(CLIENT, "\t"), *tshark(ROBOT, "", len(robot))]
    chunks = list(read(tmp_path / "a.txt", "\n".join(lines) + "\n"))
    assert (joined(chunks, "c2r"), joined(chunks, "r2c")) == (CLIENT, robot + ROBOT)


def test_both_directions_of_wiresharks_follow_stream(tmp_path: Path) -> None:
    def dump(data: bytes, indent: str) -> list[str]:
        return [
            f"{indent}{at:08X}  {part[:8].hex(' '):<23}  {part[8:].hex(' '):<23}   {shown(part)}"
            for at, part in rows(data)
        ]

    text = "\n".join([*dump(CLIENT, ""), *dump(ROBOT, "    ")]) + "\n"
    log = read(tmp_path / "a.txt", text)
    chunks = list(log)
    assert (joined(chunks, "c2r"), joined(chunks, "r2c"), log.damage) == (CLIENT, ROBOT, [])
