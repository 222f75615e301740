# SPDX-License-Identifier: MIT
"""Rule: what a program puts before each line, or people write above and below, changes nothing of what a log says."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import pytest
from argus_tools.formats import find_format, open_log
from argus_tools.formats.candump import FORMAT as CANDUMP_FORMAT
from forms import CLIENT, COMMANDS, ROBOT, SIPS, START_S, frames, hexdump_c, joined, od, read, xxd
from logs import CAPTURES, run

Before = Callable[[int], str]


def clock(form: str) -> Before:
    """A time each 10 ms in that form."""
    return lambda n: datetime.fromtimestamp(START_S + 0.01 * n, UTC).strftime(form)


CAN = {
    "candump -L": "".join(f"({f.t:.6f}) can0 {f.can_id:03X}#{f.data.hex().upper()}\n" for f in frames()),
    "no times": "".join(f"can0 {f.can_id:03X}#{f.data.hex().upper()}\n" for f in frames()),
    "cansend": "".join(f"{f.can_id:03X}#{f.data.hex('.').upper()}\n" for f in frames()),
    "screen": "".join(f"  can0  {f.can_id:03X}   [8]  {f.data.hex(' ').upper()}\n" for f in frames()),
    "python-can": "".join(
        f"Timestamp: {f.t:.6f}    ID: {f.can_id:04x}    S Rx    DL:  8    {f.data.hex(' ')}     Channel: can0\n"
        for f in frames()
    ),
    "SavvyCAN": "Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8\n"
    + "".join(f"{n},{f.can_id:08X},false,Rx,0,8,{f.data.hex(',')},\n" for n, f in enumerate(frames())),
    "ASC": "date Wed Nov 25 06:38:47.479 2026\nbase hex  timestamps absolute\ninternal events logged\n"
    + "".join(
        f"  {n / 100:.6f} 1  {f.can_id:X}  Rx  d 8 {f.data.hex(' ')}\n" for n, f in enumerate(frames())
    ),
    "TRC": ";$FILEVERSION=1.1\n;\n"
    + "".join(
        f"{n:>6}) {n:.1f}  Rx  {f.can_id:04X}  8  {f.data.hex(' ')}\n" for n, f in enumerate(frames(), 1)
    ),
}
SERIAL = {
    "JSON": "".join(f'{{"t": {n}.5, "dir": "r2c", "hex": "{sip.hex()}"}}\n' for n, sip in enumerate(SIPS)),
    "hexdump -C": hexdump_c(ROBOT),
    "xxd": xxd(ROBOT),
    "od": od(ROBOT),
    "od -t d1": od(ROBOT, "07o", 1, "5d"),
    "hexadecimal": "".join(f"{sip.hex(' ')}\n" for sip in SIPS),
}
TEXTS = {**CAN, **SERIAL}
BEFORE: dict[str, Before] = {
    "journalctl": clock("%b %d %H:%M:%S hall candump[123]: "),
    "journalctl -o short-precise": clock("%b %d %H:%M:%S.%f hall-pc.local candump[123]: "),
    "journalctl -o short-iso": clock("%Y-%m-%dT%H:%M:%S+0000 hall candump[123]: "),
    "journalctl -o short-iso, new": clock("%Y-%m-%dT%H:%M:%S+00:00 hall-3 candump[123]: "),
    "rsyslog": clock("%Y-%m-%dT%H:%M:%S.%f+01:00 hall candump[123]: "),
    "syslog, RFC 5424": clock("<30>1 %Y-%m-%dT%H:%M:%S.%fZ hall candump 123 - - "),
    "ts": clock("%b %d %H:%M:%S "),
    "ts -s": lambda n: f"00:00:{n // 100:02} ",
    "ts -i": lambda n: f"00:00:{int(n % 100 == 0):02} ",
    "ts %.s": lambda n: f"{START_S + 0.01 * n:.6f} ",
    "docker logs -t": clock("%Y-%m-%dT%H:%M:%S.%f789Z "),
    "docker compose logs": lambda n: "can-1  | ",
    "kubectl logs --prefix --timestamps": clock("[pod/argus-7d9f/can] %Y-%m-%dT%H:%M:%S.%f789Z "),
    "cat -n": lambda n: f"{n + 1:6}\t",
    "nl": lambda n: f"{n + 1:6}  ",
    "less -N": lambda n: f"{n + 1:7} ",
    "grep -n": lambda n: f"{n + 1}:",
    "grep -C": lambda n: f"can0.log{':' if n % 3 else '-'}{n + 1}{':' if n % 3 else '-'}",
    "diff": lambda n: "+",
    "grep -Hn": lambda n: f"can0.log:{n + 1}:",
    "a title in colours": lambda n: "\x1b]0;robot\x07\x1b(B\x1b[1;32m",
    "indented": lambda n: "    ",
    "a list of Markdown": lambda n: "- ",
    "a table of Markdown": lambda n: "| ",
}
ENDS: dict[str, Callable[[str], str]] = {
    "CRLF": lambda text: text.replace("\n", "\r\n"),
    "CR": lambda text: text.replace("\n", "\r"),
    "BOM": lambda text: "\ufeff" + text,
    "blank lines": lambda text: text.replace("\n", "\n\n"),
    "no last line end": lambda text: text.rstrip("\n"),
}
PROSE = (
    "The robot stops beside the door and one of its sonars reads far too much, see ticket 4711 of "
    "Nov 25 at 06:38 in hall B (battery 12.7 V, id 640, sonar 3)."
)
WORDS = PROSE.split()


def behind(before: Before, text: str) -> str:
    return "".join(before(n) + line for n, line in enumerate(text.splitlines(keepends=True)))


def prose(count: int) -> str:
    lines = (" ".join(WORDS[(3 * n + at) % len(WORDS)] for at in range(11)) for n in range(count))
    return "".join(f"{line}\n{'' if n % 7 else chr(10)}" for n, line in enumerate(lines)) + "\n"


def both(name: str) -> tuple[bytes, bytes]:
    return (ROBOT, CLIENT if name in CAN else b"")


@pytest.mark.tour(40, 120)
@pytest.mark.parametrize("before", BEFORE)
@pytest.mark.parametrize("name", TEXTS)
def test_a_prefix_in_each_line(name: str, before: str, tmp_path: Path) -> None:
    log = read(tmp_path / "a.txt", behind(BEFORE[before], TEXTS[name]))
    chunks = list(log)
    assert (joined(chunks, "r2c"), joined(chunks, "c2r")) == both(name)
    assert log.damage == []


@pytest.mark.tour(12, 24)
@pytest.mark.parametrize("end", ENDS)
@pytest.mark.parametrize("before", ["journalctl", "cat -n", "grep -n", "ts"])
@pytest.mark.parametrize("name", ["candump -L", "screen", "xxd"])
def test_any_end_of_lines_behind_a_prefix(name: str, before: str, end: str, tmp_path: Path) -> None:
    log = read(tmp_path / "a.txt", ENDS[end](behind(BEFORE[before], TEXTS[name])))
    chunks = list(log)
    assert (joined(chunks, "r2c"), joined(chunks, "c2r"), log.damage) == (*both(name), [])


@pytest.mark.parametrize("before", ["journalctl -o short-precise", "ts %.s", "docker logs -t", "rsyslog"])
@pytest.mark.parametrize("name", ["no times", "cansend", "screen"])
def test_frames_without_times_get_those_before_them(name: str, before: str, tmp_path: Path) -> None:
    chunks = list(read(tmp_path / "a.txt", behind(BEFORE[before], TEXTS[name])))
    times = [chunk.t for chunk in chunks]
    assert None not in times
    assert times[-1] - times[0] == pytest.approx(0.01 * (len(frames()) - 7), abs=0.1)  # type: ignore[operator]


@pytest.mark.parametrize("before", ["journalctl", "docker logs -t", "ts %.s", "cat -n"])
def test_the_log_s_own_times_count_more(before: str, tmp_path: Path) -> None:
    assert next(iter(read(tmp_path / "a.txt", behind(BEFORE[before], CAN["candump -L"])))).t == pytest.approx(
        START_S + 0.006, abs=1e-6
    )


@pytest.mark.parametrize(
    "before", ["journalctl", "cat -n", "grep -n", "docker logs -t", "kubectl logs --prefix --timestamps"]
)
def test_two_interfaces_behind_a_prefix(before: str, tmp_path: Path) -> None:
    lines = CAN["candump -L"].splitlines(keepends=True)
    text = "".join(line + line.replace("can0", "can1") for line in lines)
    log = read(tmp_path / "a.txt", behind(BEFORE[before], text))
    assert joined(list(log), "r2c") == ROBOT
    assert [(entry.place, "can1" in entry.what) for entry in log.damage] == [("line 2", True)]


@pytest.mark.parametrize("before", ["journalctl", "cat -n", "grep -n", "ts", "docker logs -t"])
def test_lines_of_others_and_a_cut_one_are_told_by_their_number(before: str, tmp_path: Path) -> None:
    text = behind(BEFORE[before], CAN["candump -L"])
    lines = text.splitlines(keepends=True)
    cut = "".join([*lines[:12], "-- Boot 4711 --\n", *lines[12:]]).rstrip("\n")[:-8]
    log = read(tmp_path / "a.txt", cut)
    assert joined(list(log), "r2c") == ROBOT
    assert "line 13" in [entry.place for entry in log.damage]


@pytest.mark.parametrize("others", [1, 3, 5])
@pytest.mark.parametrize("name", ["candump -L", "screen", "python-can", "xxd"])
def test_others_that_write_to_the_same_journal(name: str, others: int, tmp_path: Path) -> None:
    other = "Nov 25 06:38:47 hall kernel: [   12.345678] usb 1-1: new full-speed device\n" * others
    text = "".join(
        line + other for line in behind(BEFORE["journalctl"], TEXTS[name]).splitlines(keepends=True)
    )
    chunks = list(read(tmp_path / "a.txt", text))
    assert (joined(chunks, "r2c"), joined(chunks, "c2r")) == both(name)


@pytest.mark.parametrize("mark", ["{noformat}", "{code:java}", "```", "~~~", "<pre>"])
@pytest.mark.parametrize("name", ["candump -L", "screen", "SavvyCAN", "xxd"])
def test_marks_of_a_block(name: str, mark: str, tmp_path: Path) -> None:
    log = read(tmp_path / "a.txt", f"{mark}\n{TEXTS[name]}{mark}\n")
    chunks = list(log)
    assert (joined(chunks, "r2c"), joined(chunks, "c2r")) == both(name)


@pytest.mark.parametrize(
    "before", ["grep -n", "grep -C", "diff", "cat -n", "a table of Markdown", "docker compose logs"]
)
def test_a_prefix_without_times_takes_none_away(before: str, tmp_path: Path) -> None:
    chunks = list(read(tmp_path / "a.txt", behind(BEFORE[before], CAN["candump -L"])))
    assert [chunk.t for chunk in chunks if chunk.dir == "r2c"] == pytest.approx(
        [START_S + 0.1 * n + 0.006 for n in range(12)], abs=1e-5
    )


def test_a_prefix_that_is_missing_in_the_first_line(tmp_path: Path) -> None:
    text = behind(BEFORE["journalctl"], CAN["candump -L"])
    log = read(tmp_path / "a.txt", "-- Journal begins at Wed 2026-11-25 --\n" + text)
    assert joined(list(log), "r2c") == ROBOT
    assert [entry.place for entry in log.damage] == ["line 1"]


@pytest.mark.parametrize("count", [1, 40, 63, 100, 300])
@pytest.mark.parametrize("name", [name for name in TEXTS if name != "hexadecimal"])
def test_prose_above_and_below(name: str, count: int, tmp_path: Path) -> None:
    log = read(tmp_path / "a.txt", prose(count) + TEXTS[name] + "\n" + prose(20))
    chunks = list(log)
    assert (joined(chunks, "r2c"), joined(chunks, "c2r")) == both(name)
    if count > 64 and name != "hexadecimal":
        above = len(prose(count).splitlines())
        assert log.damage[0].place == f"lines 1 to {above}"
        assert "passed over" in log.damage[0].what
        assert all(entry.place > f"line {above}" for entry in log.damage[1:])


@pytest.mark.parametrize("count", [100, 200, 300, 400, 500])
def test_a_block_of_bytes_below_prose(count: int, tmp_path: Path) -> None:
    above = "He says that it fell silent, and that nobody was near it at that time.\n" * count
    log = read(tmp_path / "a.txt", above + "\n" + SERIAL["hexadecimal"] + "\nThanks\n")
    assert joined(list(log), "r2c") == ROBOT
    assert [entry.place for entry in log.damage] == [f"lines 1 to {count + 1}", f"line {count + 15}"]


@pytest.mark.parametrize(
    "before", ["cat -n", "indented", "grep -n", "journalctl", "kubectl logs --prefix --timestamps"]
)
@pytest.mark.parametrize("name", ["candump -L", "screen", "SavvyCAN", "xxd"])
def test_prose_above_a_prefix(name: str, before: str, tmp_path: Path) -> None:
    log = read(tmp_path / "a.txt", prose(150) + behind(BEFORE[before], TEXTS[name]) + "\n" + prose(9))
    chunks = list(log)
    assert (joined(chunks, "r2c"), joined(chunks, "c2r")) == both(name)
    assert log.damage[0].place == f"lines 1 to {len(prose(150).splitlines())}"


@pytest.mark.parametrize("count", [0, 200])
def test_the_same_through_a_pipe(count: int, tmp_path: Path) -> None:
    text = (prose(count) if count else "") + behind(BEFORE["journalctl"], CAN["candump -L"] * 20)
    (tmp_path / "a.txt").write_text(text)
    whole, piped = run("decode", tmp_path / "a.txt"), run("decode", "-", stdin=text.encode())
    assert (whole.returncode, piped.stdout) == (0, whole.stdout)


def test_sides_that_a_prefix_tells_are_kept(tmp_path: Path) -> None:
    pairs = zip(COMMANDS, SIPS, strict=True)
    text = "".join(f"TX: 0000: {c.hex(' ')}\nRX: 0000: {s.hex(' ')}\n" for c, s in pairs)
    chunks = list(read(tmp_path / "a.txt", text))
    assert (joined(chunks, "c2r"), joined(chunks, "r2c")) == (CLIENT, ROBOT)


def test_prose_alone_is_no_log(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text(prose(300))
    done = run("decode", tmp_path / "a.txt")
    assert (done.returncode, done.stdout, done.stderr.count(b"\n")) == (2, b"", 1)


def test_an_interface_whose_name_is_a_number_is_none_of_a_line() -> None:
    assert CANDUMP_FORMAT.sniff(b"0 648#06FAFB03000000CC\n1 648#06FAFB03000000CC\n0 648#06FAFB03000000CC\n")
    assert not CANDUMP_FORMAT.sniff(b"1\t648#06FAFB03000000CC\n2\t648#06FAFB03000000CC\n")


def test_a_capture_is_never_looked_into(tmp_path: Path) -> None:
    for path in sorted(CAPTURES.glob("*.jsonl"))[:4]:
        data = joined(list(open_log(str(path))), "r2c")
        for start in range(0, min(len(data), 1500), 101):
            (tmp_path / "a.bin").write_bytes(data[start:] + CAN["candump -L"].encode())
            log = open_log(str(tmp_path / "a.bin"))
            assert (find_format(data[start:]).name, log.format.name, log.damage) == ("bin", "bin", [])
