# SPDX-License-Identifier: MIT
"""Rule: hexadecimal text of any terminal program is read, with its times and directions; what is none is told."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import pytest
from forms import CLIENT, COMMANDS, ROBOT, SIPS, START_S, joined, read, shown


def lines(data: bytes, width: int = 24) -> list[bytes]:
    return [data[at : at + width] for at in range(0, len(data), width)]


def in_lines(form: Callable[[bytes], str]) -> str:
    return "".join(form(part) + "\n" for part in lines(ROBOT))


PLAIN = {
    "spaces": in_lines(lambda part: part.hex(" ").upper()),
    "lower case": in_lines(lambda part: part.hex(" ")),
    "space at the end": in_lines(lambda part: part.hex(" ") + " "),
    "dashes": in_lines(lambda part: part.hex("-")),
    "colons": in_lines(lambda part: part.hex(":")),
    "xxd -p": in_lines(bytes.hex),
    "xxd -p without ends of lines": ROBOT.hex(),
    "one long line": ROBOT.hex(" ") * 40,
    "C": in_lines(lambda part: ", ".join(f"0x{byte:02X}" for byte in part) + ","),
    "backslashes": in_lines(lambda part: "".join(f"\\x{byte:02x}" for byte in part)),
    "h": in_lines(lambda part: " ".join(f"{byte:02X}h" for byte in part)),
    "characters behind": in_lines(lambda part: f"{part.hex(' '):<72}  {shown(part)}"),
    "characters behind a bar": in_lines(lambda part: f"{part.hex(' ')} | {shown(part)}"),
    "characters behind a tab": in_lines(lambda part: f"{part.hex(' ')}\t{shown(part)}"),
    "od -A n": in_lines(lambda part: " " + part.hex(" ")),
    "hexdump -e": "".join(f"{byte:02X} " for byte in ROBOT),
    "a byte in a line": "".join(f"{byte:02x}\n" for byte in ROBOT),
    "gap in the middle": in_lines(lambda part: f"{part[:8].hex(' ')}  {part[8:].hex(' ')}"),
    "interceptty": "".join(f"< 0x{byte:02x} ({chr(byte) if 32 <= byte < 127 else '.'})\n" for byte in ROBOT),
    "comment": "# of Monday\n" + in_lines(lambda part: part.hex(" ")),
}


@pytest.mark.parametrize("name", PLAIN)
def test_every_way_of_writing_bytes(name: str, tmp_path: Path) -> None:
    log = read(tmp_path / "a.txt", PLAIN[name])
    chunks = list(log)
    data = joined(chunks, "r2c")
    assert (log.format.name, log.damage) == ("hextext", [])
    assert data == (ROBOT * 40 if name == "one long line" else ROBOT)
    assert {chunk.t for chunk in chunks} == {None}


@pytest.mark.parametrize("head", ["", "Time [s],Value,Parity Error,Framing Error\n"])
def test_a_byte_and_its_time_of_a_logic_analyser(head: str, tmp_path: Path) -> None:
    end = ",," if head else ""
    text = head + "".join(f"{n / 1000:.6f},0x{byte:02X}{end}\n" for n, byte in enumerate(ROBOT))
    log = read(tmp_path / "a.csv", text)
    chunks = list(log)
    assert joined(chunks, "r2c") == ROBOT
    assert chunks[-1].t == pytest.approx((len(ROBOT) - 1) / 1000)
    assert len(log.damage) == bool(head)


def clock(t: float, form: str) -> str:
    return datetime.fromtimestamp(t, UTC).strftime(form)


DAY_S = START_S % 86400
# Of a date without a year: since the beginning of one.
YEAR_S = START_S - datetime(2026, 1, 1, tzinfo=UTC).timestamp()
MILLIS = 1e-3
STAMPS: dict[str, tuple[Callable[[float], str], float, float]] = {
    "grabserial": (lambda t: f"[{t - START_S:.6f} 0.002000]", 0.0, 1e-6),
    "grabserial -T": (lambda t: f"[{clock(t, '%H:%M:%S.%f')} 0.002000]", DAY_S, 1e-5),
    "tio": (lambda t: f"[{clock(t, '%H:%M:%S.%f')[:-3]}]", DAY_S, MILLIS),
    "tio ISO": (lambda t: f"[{clock(t, '%Y-%m-%dT%H:%M:%S.%f')[:-3]}]", START_S, MILLIS),
    "tio ISO with zone": (lambda t: f"[{clock(t, '%Y-%m-%dT%H:%M:%S.%f')[:-3]}+00:00]", START_S, MILLIS),
    "tio ISO of another zone": (
        lambda t: f"[{clock(t + 7200, '%Y-%m-%dT%H:%M:%S.%f')[:-3]}+0200]",
        START_S,
        MILLIS,
    ),
    "seconds since 1970": (lambda t: f"({t:.6f})", START_S, 1e-5),
    "seconds and a colon": (lambda t: f"{t - START_S:.3f}:", 0.0, MILLIS),
    "date and time": (lambda t: clock(t, "%Y-%m-%d %H:%M:%S.%f"), START_S, 1e-5),
    "German date": (lambda t: clock(t, "%d.%m.%Y %H:%M:%S,%f")[:-3], START_S, MILLIS),
    "American date": (lambda t: clock(t, "%m/%d/%Y %I:%M:%S.%f %p"), START_S, 1e-5),
    "time and an arrow": (lambda t: clock(t, "%H:%M:%S.%f") + " >", DAY_S, 1e-5),
    "whole seconds": (lambda t: clock(t, "%H:%M:%S") + " |", DAY_S, 1.0),
    "ts of moreutils": (lambda t: clock(t, "%b %d %H:%M:%S"), YEAR_S, 1.0),
    "syslog before the tenth": (lambda t: clock(t - 20 * 86400, "%b %e %H:%M:%S"), YEAR_S - 20 * 86400, 1.0),
    "ts with fractions": (lambda t: clock(t, "%b %d %H:%M:%S.%f"), YEAR_S, 1e-5),
    "logcat": (lambda t: clock(t, "%m-%d %H:%M:%S.%f")[:-3], YEAR_S, MILLIS),
    "ctime": (lambda t: clock(t, "%a %b %d %H:%M:%S %Y"), START_S, 1.0),
    "ctime in brackets": (lambda t: clock(t, "[%a %b %d %H:%M:%S %Y]"), START_S, 1.0),
    "date": (lambda t: clock(t, "%a %d %b %Y %I:%M:%S %p UTC"), START_S, 1.0),
    "day, month, year": (lambda t: clock(t, "%d %b %Y %H:%M:%S"), START_S, 1.0),
    "of a web server": (lambda t: clock(t - 3600, "[%d/%b/%Y:%H:%M:%S -0100]"), START_S, 1.0),
    "ISO, Z": (lambda t: clock(t, "%Y-%m-%dT%H:%M:%S.%fZ"), START_S, 1e-5),
    "ISO, zone apart": (lambda t: clock(t + 3600, "%Y-%m-%d %H:%M:%S.%f +0100"), START_S, 1e-5),
    "ISO, hours of the zone": (lambda t: clock(t + 3600, "%Y-%m-%dT%H:%M:%S.%f+01"), START_S, 1e-5),
    "ISO, basic": (lambda t: clock(t, "%Y%m%dT%H%M%S.%fZ"), START_S, 1e-5),
    "UTC": (lambda t: clock(t, "%Y-%m-%d %H:%M:%S.%f UTC"), START_S, 1e-5),
    "slashes": (lambda t: clock(t, "%Y/%m/%d %H:%M:%S.%f"), START_S, 1e-5),
    "year of two digits": (lambda t: clock(t, "%d.%m.%y %H:%M:%S"), START_S, 1.0),
    "dmesg": (lambda t: f"[{t - START_S:13.6f}]", 0.0, 1e-6),
    "seconds since 1970 in whole": (lambda t: f"{int(t)}", START_S, 1.0),
    "milliseconds since 1970": (lambda t: f"{int(t * 1000)}", START_S, MILLIS),
    "microseconds since 1970": (lambda t: f"[{int(t * 1e6)}]", START_S, 1e-5),
}


@pytest.mark.parametrize("name", STAMPS)
def test_every_time_before_the_bytes(name: str, tmp_path: Path) -> None:
    stamp, start, near = STAMPS[name]
    times = [START_S + 0.1 * n for n in range(len(SIPS))]
    text = "".join(f"{stamp(t)} {data.hex(' ').upper()}\n" for t, data in zip(times, SIPS, strict=True))
    log = read(tmp_path / "a.txt", text)
    chunks = list(log)
    assert (log.format.name, log.damage, b"".join(c.data for c in chunks)) == ("hextext", [], ROBOT)
    assert [chunk.t for chunk in chunks] == pytest.approx([start + 0.1 * n for n in range(12)], abs=near)


@pytest.mark.parametrize("name", STAMPS)
@pytest.mark.parametrize("form", [lambda data: data.hex(" ").upper(), bytes.hex])
def test_a_sample_of_one_line(name: str, form: Callable[[bytes], str], tmp_path: Path) -> None:
    stamp, start, near = STAMPS[name]
    (chunk,) = read(tmp_path / "a.txt", f"{stamp(START_S)} {form(SIPS[0])}\n")
    assert chunk.data == SIPS[0]
    assert chunk.t == pytest.approx(start, abs=near)


def test_a_date_without_a_year_goes_on_at_new_year(tmp_path: Path) -> None:
    stamps = ["Dec 31 23:59:59", "Jan  1 00:00:01", "Jan  2 00:00:01"]
    text = "".join(f"{at} {data.hex(' ')}\n" for at, data in zip(stamps, SIPS, strict=False))
    times = [chunk.t for chunk in read(tmp_path / "a.txt", text)]
    assert [round(t - (times[0] or 0)) for t in times if t] == [0, 2, 86402]


def test_the_last_of_february_is_a_day(tmp_path: Path) -> None:
    stamps = ["Feb 28 23:59:59", "Feb 29 00:00:00", "Feb 29 23:59:59", "Mar  1 00:00:00"]
    text = "".join(f"{at} {data.hex(' ')}\n" for at, data in zip(stamps, SIPS, strict=False))
    times = [chunk.t for chunk in read(tmp_path / "a.txt", text)]
    assert [round(t - (times[0] or 0)) for t in times if t] == [0, 1, 86400, 86401]


NUMBERS = {
    "decimal": lambda part: " ".join(map(str, part)),
    "decimal, filled up": lambda part: " ".join(f"{byte:03d}" for byte in part),
    "decimal, commas": lambda part: ", ".join(map(str, part)) + ",",
    "decimal, semicolons": lambda part: ";".join(map(str, part)),
    "decimal, signed": lambda part: "".join(f"{byte - 256 * (byte > 127):5d}" for byte in part),
    "octal": lambda part: " " + " ".join(f"{byte:03o}" for byte in part),
}


@pytest.mark.parametrize("stamp", ["", "07:03:04.500 ", "Nov 25 07:03:04 "])
@pytest.mark.parametrize("name", NUMBERS)
def test_bytes_in_other_numbers(name: str, stamp: str, tmp_path: Path) -> None:
    log = read(tmp_path / "a.txt", in_lines(lambda part: stamp + NUMBERS[name](part)))
    chunks = list(log)
    assert (joined(chunks, "r2c"), log.damage, log.format.name) == (ROBOT, [], "hextext")
    assert (chunks[0].t is None) == (not stamp)


def test_a_number_above_a_byte_is_told(tmp_path: Path) -> None:
    line = " ".join(map(str, ROBOT))
    log = read(tmp_path / "a.txt", f"{line}\n250 251 300\n{line}\n")
    assert joined(list(log), "r2c") == ROBOT * 2
    assert [entry.place for entry in log.damage] == ["line 2"]


@pytest.mark.parametrize("indented", ["client", "robot"])
@pytest.mark.parametrize(
    "preamble", ["", "=" * 67 + "\nFollow: tcp,raw\nFilter: tcp.stream eq 0\nNode 0: a:1\n"]
)
def test_follow_stream_of_tshark_in_raw_form(indented: str, preamble: str, tmp_path: Path) -> None:
    pairs = zip(COMMANDS, SIPS, strict=True)
    marks = ("\t", "") if indented == "client" else ("", "\t")
    text = preamble + "".join(f"{marks[0]}{c.hex()}\n{marks[1]}{s.hex()}\n" for c, s in pairs)
    log = read(tmp_path / "a.txt", text)
    chunks = list(log)
    assert (joined(chunks, "c2r"), joined(chunks, "r2c"), log.damage) == (CLIENT, ROBOT, [])


@pytest.mark.parametrize("robot", [0, 1])
def test_follow_stream_of_wireshark_as_arrays_of_c(robot: int, tmp_path: Path) -> None:
    text = ""
    for n, pair in enumerate(zip(COMMANDS, SIPS, strict=True)):
        for side, data in zip((1 - robot, robot), pair, strict=True):
            body = ", \n".join(", ".join(f"0x{byte:02x}" for byte in part) for part in lines(data, 8))
            text += f"char peer{side}_{n}[] = {{ /* Packet {n} */\n{body} }};\n"
    log = read(tmp_path / "a.txt", text)
    chunks = list(log)
    assert (joined(chunks, "c2r"), joined(chunks, "r2c"), log.damage) == (CLIENT, ROBOT, [])


def test_a_clock_without_a_date_goes_on_at_midnight(tmp_path: Path) -> None:
    clocks = ["23:59:59.900", "00:00:00.000", "00:00:00.100"]
    text = "".join(f"[{at}] {data.hex(' ')}\n" for at, data in zip(clocks, SIPS, strict=False))
    times = [chunk.t for chunk in read(tmp_path / "a.txt", text)]
    assert times == pytest.approx([86399.9, 86400.0, 86400.1])


MARKS = {
    "TX RX": ("TX: ", "RX: "),
    "brackets": ("[TX] - ", "[RX] - "),
    "words": ("Sent: ", "Received: "),
    "arrows": ("-> ", "<- "),
    "angles": (">> ", "<< "),
    "lower case": ("out ", "in "),
    "who listens at the robot": ("RX ", "TX "),
}


@pytest.mark.parametrize("name", MARKS)
@pytest.mark.parametrize("stamp", ["", "12:30:00.500 "])
def test_marks_tell_the_directions(name: str, stamp: str, tmp_path: Path) -> None:
    to_robot, from_robot = MARKS[name]
    text = "".join(
        f"{stamp}{to_robot}{command.hex(' ')}\n{stamp}{from_robot}{sip.hex(' ')}\n"
        for command, sip in zip(COMMANDS, SIPS, strict=True)
    )
    log = read(tmp_path / "a.txt", text)
    chunks = list(log)
    assert (joined(chunks, "c2r"), joined(chunks, "r2c"), log.damage) == (CLIENT, ROBOT, [])


def test_socat_tells_time_and_direction_in_lines_of_their_own(tmp_path: Path) -> None:
    text = ""
    for n, (command, sip) in enumerate(zip(COMMANDS, SIPS, strict=True)):
        for mark, data in ((">", command), ("<", sip)):
            text += f"{mark} 2026/11/25 06:38:{n:02d}.000250  length={len(data)} from=0 to={len(data) - 1}\n"
            text += "".join(f" {part.hex(' ')}\n" for part in lines(data, 16)) + "--\n"
    log = read(tmp_path / "a.txt", text)
    chunks = list(log)
    assert (joined(chunks, "c2r"), joined(chunks, "r2c"), log.damage) == (CLIENT, ROBOT, [])


@pytest.mark.parametrize(
    ("line", "part"),
    [
        ("connected to the robot", "no hexadecimal bytes"),
        ("*", "with -v"),
        ("FA FB 0", "no hexadecimal bytes"),
        ("FA FG 03", "no hexadecimal bytes"),
        ("0xFA 0xFBB", "no hexadecimal bytes"),
        ("[06:38:47.5] FA FG 03", "no hexadecimal bytes"),
        ("[06:38:47.5] Connected", "no hexadecimal bytes"),
    ],
)
def test_what_is_none_is_told_by_its_line(line: str, part: str, tmp_path: Path) -> None:
    log = read(tmp_path / "a.txt", f"{ROBOT.hex(' ')}\n{line}\n{ROBOT.hex(' ')}\n")
    assert joined(list(log), "r2c") == ROBOT * 2
    assert [(entry.place, part in entry.what) for entry in log.damage] == [("line 2", True)]


@pytest.mark.parametrize(
    "text", ["hello\nworld\n", "be\n", "one two three\n" * 50, "a,b,c\n1,2,3\n", "face it\n" * 9]
)
def test_words_are_no_bytes(text: str, tmp_path: Path) -> None:
    assert read(tmp_path / "a.txt", text).format.name == "bin"


def test_the_direction_that_is_given_holds(tmp_path: Path) -> None:
    assert joined(list(read(tmp_path / "a.txt", ROBOT.hex(" "), direction="c2r")), "c2r") == ROBOT
