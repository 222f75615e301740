# SPDX-License-Identifier: MIT
"""Rule: what a program writes before the bytes is no part of them: marks of direction are obeyed, offsets, counts and
the column of characters are left out; where nothing tells the two sides apart, that is said."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from argus_tools.chunks import Direction
from argus_tools.formats import LogError, open_log
from argus_tools.formats.marks import directions, has_both_sides, mark_at, marks_in
from forms import CLIENT, COMMANDS, ROBOT, SIPS, joined, rows, shown
from logs import command

# A PULSE says nothing of its direction by itself.
PULSE = command("PULSE")
FROM_ROBOT: Direction = "r2c"
TO_ROBOT: Direction = "c2r"
SIDES = [
    row
    for pair in zip(SIPS, COMMANDS, strict=True)
    for row in ((FROM_ROBOT, pair[0]), (TO_ROBOT, pair[1]), (TO_ROBOT, PULSE))
]
SENT = b"".join(data for direction, data in SIDES if direction == "c2r")
NAMES = [
    ("RX", "TX"), ("rx", "tx"), ("Received", "Sent"), ("READ", "WRITE"), ("<<<", ">>>"), ("<", ">"), ("<--", "-->"),
    ("in", "out"), ("Incoming", "Outgoing"), ("IRP_MJ_READ", "IRP_MJ_WRITE"), ("r2c", "c2r"),
    ("\u6536\u2190", "\u53d1\u2192"),
]  # fmt: skip
BODIES: dict[str, Callable[[bytes], str]] = {
    "digits": lambda data: data.hex(" ").upper(),
    "Python": repr,
    "list": lambda data: str(list(data)),
    "brackets": lambda data: "".join(f"[{byte:02X}]" for byte in data),
    "decimal brackets": lambda data: "".join(f"({byte:03d})" for byte in data),
    "prefixed": lambda data: " ".join(f"0x{byte:X}" for byte in data),
}
HEADS = [
    "{mark} {body}", "{mark}: {body}", "12:00:01.250 DEBUG serial: {mark} {body}", "1795577927.479,{mark},{body}",
    "7\t0.00012\tterm.exe\t{mark}\tSerial0\tLength 6: {body}", "[12:00:01.250] [{mark}] {body}",
    "1250-1390 uart-1: {mark}: {body}",
]  # fmt: skip


def check(path: Path, text: str, client: bytes = SENT) -> None:
    path.write_text(text, encoding="utf-8", newline="")
    log = open_log(str(path))
    chunks = list(log)
    assert (joined(chunks, "r2c"), joined(chunks, "c2r")) == (ROBOT, client)
    assert not log.damage


@pytest.mark.tour(80, 200)
@pytest.mark.parametrize("head", HEADS)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("names", NAMES, ids=lambda names: names[1])
def test_marks_are_obeyed_whatever_the_bytes_look_like(
    names: tuple[str, str], body: str, head: str, tmp_path: Path
) -> None:
    marks = dict(zip(("r2c", "c2r"), names, strict=True))
    lines = (head.format(mark=marks[direction], body=BODIES[body](data)) for direction, data in SIDES)
    check(tmp_path / "a.txt", "".join(line + "\n" for line in lines))


def dumped(form: Callable[[str, int, bytes], str], cumulative: bool = False) -> str:
    """Each chunk as lines of sixteen bytes; FORM gets its direction, the offset and the bytes."""
    at = {"r2c": 0, "c2r": 0}
    out = []
    for direction, data in SIDES:
        begin = at[direction] if cumulative else 0
        out += [form(direction, begin + offset, part) for offset, part in rows(data)]
        at[direction] += len(data)
    return "\n".join(out) + "\n"


def headed(head: Callable[[str], str], line: Callable[[int, bytes], str]) -> str:
    """A line that says whose the lines below are."""
    return "".join(
        head(direction) + "\n" + "".join(line(at, part) + "\n" for at, part in rows(data))
        for direction, data in SIDES
    )


def arrow(direction: str) -> str:
    return "<" if direction == "r2c" else ">"


def word(direction: str) -> str:
    return "RX" if direction == "r2c" else "TX"


def columns(data: bytes) -> str:
    return f"{data[:8].hex(' '):<23}  {data[8:].hex(' '):<23}"


BOTH = {
    "netcat -o": dumped(lambda d, at, part: f"{arrow(d)} {at:08x} {part.hex(' '):<48}# {shown(part)}", True),
    "netcat -o, each anew": dumped(lambda d, at, part: f"{arrow(d)} {at:08x} {part.hex(' '):<48}# {shown(part)}"),
    "pyserial spy": dumped(
        lambda d, at, part: f"000000.010 {word(d)}   {at:04X}  {columns(part).upper()}  {shown(part)}"
    ),
    "kernel": dumped(lambda d, at, part: f"[   12.025997] {word(d)}: {at:08x}: {part.hex(' '):<47}  {shown(part)}"),
    "PuTTY": headed(
        lambda d: ("Incoming" if d == "r2c" else "Outgoing") + " raw data at 2026-11-25 12:00:00",
        lambda at, part: f"  {at:08x}  {part.hex(' '):<49} {shown(part)}",
    ),
    "hexdump of each": headed(
        lambda d: "<<< received data" if d == "r2c" else ">>> sent data",
        lambda at, part: f"{at:08x}  {columns(part)}  |{shown(part)}|",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", BOTH)
def test_offsets_are_no_bytes_where_marks_stand_beside_them(name: str, tmp_path: Path) -> None:
    text = BOTH[name].replace("<<< received data", "<<< data").replace(">>> sent data", ">>> data")
    check(tmp_path / "a.txt", text)


def dump(form: Callable[[int, bytes], str], head: str = "") -> str:
    return head + "".join(form(at, part) + "\n" for at, part in rows(ROBOT))


def each(form: Callable[[int, bytes], str]) -> str:
    return "".join(form(n, sip) + "\n" for n, sip in enumerate(SIPS))


ONE = {
    "two spaces": dump(lambda at, part: f"{at:08X}  {part.hex(' ').upper():<47}  {shown(part)}"),
    "one space": dump(lambda at, part: f"{at:08X} {part.hex(' ').upper():<47} {shown(part)}"),
    "four digits": dump(lambda at, part: f"{at:04X}  {part.hex(' ').upper():<47}  {shown(part)}"),
    "HxD": dump(
        lambda at, part: f"{at:08X}  {part.hex(' ').upper():<47}  {shown(part)}",
        "Offset(h) 00 01 02 03 04 05 06 07 08 09 0A 0B 0C 0D 0E 0F\n\n",
    ),
    "Format-Hex": dump(
        lambda at, part: f"{at:08X}   {part.hex(' ').upper():<47}  {shown(part)}",
        "\n           00 01 02 03 04 05 06 07 08 09 0A 0B 0C 0D 0E 0F\n\n",
    ),
    "0x": dump(lambda at, part: f"0x{at:04X}: {part.hex(' ').upper():<47}  {shown(part)}"),
    "h": dump(lambda at, part: f"{at:08X}h: {part.hex(' ').upper():<47} ; {shown(part)}"),
    "brackets": dump(lambda at, part: f"[{at:04x}]   {part.hex(' ').upper():<47}   {shown(part)}"),
    "segment": dump(lambda at, part: f"0B3F:{at:04X}  {part.hex(' ').upper():<47}   {shown(part)}"),
    "decimal offsets": dump(
        lambda at, part: f"{at:6d}: {part[:8].hex(' ').upper()} - {part[8:].hex(' ').upper()} ".replace(
            "-  ", "- "
        )
    ),
    "code page": dump(
        lambda at, part: (
            f"{at:08X}  {part.hex(' ').upper():<47}  "
            + "".join(chr(byte) if 32 <= byte < 127 or byte >= 0xA1 else "." for byte in part)
        )
    ),
    "hexdump of each": each(
        lambda n, sip: "\n".join(f"{at:08x}  {columns(part)}  |{shown(part)}|" for at, part in rows(sip))
    ),
    "milliseconds": each(lambda n, sip: f"{17 + 103 * n}: {sip.hex(' ')}"),
    "line numbers": each(lambda n, sip: f"{n + 1:>6}: {sip.hex(' ')}"),
    "a byte in a line, with times": "".join(
        f"{900 * n}-{900 * n + 870} uart-1: RX: {byte:02X}\n" for n, byte in enumerate(ROBOT)
    ),
    "tabs": dump(lambda _, part: part.hex("\t").upper()),
    "tab and characters": dump(lambda _, part: f"{part.hex(' ')}\t{shown(part)}"),
    "without leading zeros": each(lambda _, sip: " ".join(f"{byte:x}" for byte in sip)),
    "a byte in a line, without leading zeros": "".join(f"{byte:X}\n" for byte in ROBOT),
    "0x without leading zeros": each(lambda _, sip: " ".join(f"0x{byte:x}" for byte in sip)),
    "bits": each(lambda _, sip: " ".join(f"{byte:08b}" for byte in sip)),
    "list of hex": each(lambda _, sip: str([hex(byte) for byte in sip])),
    "list without commas": each(lambda _, sip: str(list(sip)).replace(",", "")),
    "colours": each(lambda n, sip: f"\x1b[90m[12:00:{n % 60:02d}.250]\x1b[0m \x1b[32m{sip.hex(' ')}\x1b[0m"),
    "a colour for each byte": each(lambda _, sip: "".join(f"\x1b[33m{byte:02x}\x1b[0m " for byte in sip)),
}


@pytest.mark.parametrize("name", ONE)
def test_every_byte_is_read_once_and_nothing_else(name: str, tmp_path: Path) -> None:
    check(tmp_path / "a.txt", ONE[name], client=b"")


@pytest.mark.parametrize("body", ["digits", "Python"])
def test_it_is_said_where_nothing_tells_the_sides_apart(body: str, tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("".join(f"{BODIES[body](data)}\n" for _, data in SIDES))
    log = open_log(str(path))
    list(log)
    assert len(log.damage) == 1
    assert "no line says who sent it" in log.damage[0].what
    log = open_log(str(path), direction="r2c")
    list(log)
    assert not log.damage


def test_a_robot_alone_needs_no_mark(tmp_path: Path) -> None:
    check(tmp_path / "a.txt", "".join(f"{sip!r}\n" for sip in SIPS), client=b"")


@pytest.mark.parametrize("width", [79, 80])
def test_lines_that_are_wrapped_inside_of_a_byte_are_named(width: int, tmp_path: Path) -> None:
    text = ROBOT.hex(" ")
    path = tmp_path / "a.txt"
    path.write_text("\r\n".join(text[at : at + width] for at in range(0, len(text), width)))
    with pytest.raises(LogError, match=r"wrapped inside of a byte; .*tr -d"):
        list(open_log(str(path)))


def test_marks_by_themselves() -> None:
    first = mark_at(b"[RX] - fa fb")
    assert first is not None
    assert first.name == b"RX"
    assert mark_at(b"RXfa") is None
    assert mark_at(b"inside fa fb") is None
    assert [mark.name for mark in marks_in(b"Host   --> (250)")] == [b"HOST", b">"]
    assert not marks_in(b"<Buffer fa fb>")
    assert has_both_sides((b"RX", b"TX"))
    assert not has_both_sides((b"RX", b"", b"<"))


def test_a_program_at_the_robot_calls_sent_what_comes_from_it() -> None:
    found: dict[bytes, Direction] = directions({b"TX": ROBOT, b"RX": CLIENT}, None)
    assert (found[b"TX"], found[b"RX"]) == ("r2c", "c2r")


@pytest.mark.parametrize("behind", ["0h  12h", "| 0h |", "$0h\\t0h  .", "0x0h  0h"])
def test_letters_beside_digits_are_no_crash(behind: str, tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("".join(f"RX: {sip!r} {behind}\n" for sip in SIPS))
    assert joined(open_log(str(path)), "r2c") == ROBOT


def test_a_line_without_an_end_takes_no_time_of_its_square(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text(" ".join(f"{byte:08b}" for byte in ROBOT * 20))
    assert joined(open_log(str(path)), "r2c") == ROBOT * 20
