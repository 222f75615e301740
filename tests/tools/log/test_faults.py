# SPDX-License-Identifier: MIT
"""Rule: from a log alone the manager says what it would have said at the robot, whoever recorded it and however
it begins, ends or is damaged."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import argus
import pytest
from argus_tools.chunks import Chunk, Direction, Offsets, copy
from argus_tools.formats import ReadOptions, formats
from argus_tools.log.cli import main

from hil_sim.arcos import COMMAND, FLAG, Command, Sip, SyncEcho, SyncReply, frame

ROOT = Path(__file__).resolve().parents[3]
WALL_MM = 2000
DEAD_MM = 5000
SYNC = [SyncEcho(0).data, SyncEcho(1).data, SyncReply(b"n", b"Pioneer", b"p3dx-sh").data]


def sips(
    count: int, start: int = 0, dead: Iterable[int] = (), dead_at: int = 0, silent: Iterable[int] = ()
) -> list[bytes]:
    """SIPs as of a P3-DX: five readings each, all 16 sonars every 320 ms."""
    dead, silent = frozenset(dead), frozenset(silent)
    out = []
    for i in range(start, start + count):
        numbers = [n for k in range(5) if (n := (5 * i + k) % 16) not in silent or i < dead_at]
        readings = tuple((n, DEAD_MM if n in dead and i >= dead_at else WALL_MM + n) for n in numbers)
        out.append(frame(Sip(flags=1, battery=125, sonars=readings).data))
    return out


def timed(packets: Sequence[bytes], start_s: float = 0.0, step_s: float = 0.1) -> list[Chunk]:
    offsets = Offsets()
    return [offsets.chunk(start_s + step_s * i, "r2c", data) for i, data in enumerate(packets)]


def write(path: Path, chunks: list[Chunk], format_: str = "record") -> Path:
    writer = formats()[format_].writer
    assert writer is not None
    stream = io.BytesIO()
    copy(chunks, writer(stream, ReadOptions(direction="r2c")))
    path.write_bytes(stream.getvalue())
    return path


def faults(path: Path, capsys: pytest.CaptureFixture[str], *arguments: str) -> list[dict[str, Any]]:
    capsys.readouterr()
    words = arguments if "--profile" in arguments else (*arguments, "--profile", "paper")
    assert main(["faults", "--json", "--exit-zero", str(path), *words]) == 0
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert lines[-1]["event"] == "STATUS"
    return lines


def named(events: list[dict[str, Any]], name: str) -> list[dict[str, Any]]:
    return [event for event in events if event["event"] == name]


def test_a_healthy_log(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    events = faults(write(tmp_path / "a.rec", timed(sips(100), 1e9)), capsys)
    status = events[-1]
    assert status["health"] == ["HEALTHY"] * 16
    assert status["reading_mm"] == [WALL_MM + k for k in range(16)]
    assert status["sips"] >= 100
    assert max(event["level"] for event in events) == 0
    assert [len(named(events, name)) for name in ("LINK_UP", "SESSION_OPEN")] == [1, 1]
    assert all(1e9 <= event["t"] <= 1e9 + 10 for event in events)


@pytest.mark.parametrize(
    "before", [b"U-Boot 2020.04\r\nDRAM: 512 MiB\r\n", b"login: pi\n$ cat /dev/ttyS0\n" * 90]
)
def test_what_stands_before_the_first_packet_is_reported(
    before: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.bin"
    path.write_bytes(before + b"".join(sips(100)))
    status = faults(path, capsys)[-1]
    assert status["health"] == ["HEALTHY"] * 16
    assert (status["bad_checksums"], status["skipped_bytes"]) == (0, len(before))


@pytest.mark.parametrize("format_", ["record", "jsonl", "bin"])
def test_a_sonar_that_dies(format_: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    packets = sips(200, dead=[3], dead_at=120)
    chunks = timed(packets)
    events = faults(write(tmp_path / "a.log", chunks, format_), capsys, *(["--format", format_]))
    (disabled,) = named(events, "SONAR_DISABLED")
    assert (disabled["name"], disabled["value"], disabled["level"]) == ("sonar/front/03", 1, 2)
    first_at = next(i for i in range(120, 200) if 3 in {(5 * i + k) % 16 for k in range(5)})
    assert disabled["offset"] == chunks[first_at].offset
    assert disabled["t"] == (None if format_ == "bin" else pytest.approx(0.1 * first_at))
    assert disabled["state"] == events[-1]["failure"] == "IsMinor"
    assert [k for k, health in enumerate(events[-1]["health"]) if health == "DISABLED"] == [3]


@pytest.mark.parametrize("format_", ["record", "jsonl", "candump", "pcapng"])
@pytest.mark.parametrize("set_s", [0.0, 3600.0], ids=["right again", "set ahead"])
@pytest.mark.parametrize("stands_s", [12.0, 40.0])
def test_a_clock_that_stands_and_then_jumps_is_no_silence(
    stands_s: float, set_s: float, format_: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    begin_s, end_s = 5.0, 5.0 + stands_s
    chunks = [
        chunk._replace(
            t=begin_s if begin_s <= chunk.t < end_s else chunk.t + (set_s if chunk.t >= end_s else 0)
        )
        for chunk in timed(sips(600, dead=[3], dead_at=520))
        if chunk.t is not None
    ]
    events = faults(write(tmp_path / "a.log", chunks, format_), capsys)
    assert not [event["event"] for event in events if event["event"].startswith("LINK_") and event["level"]]
    (disabled,) = named(events, "SONAR_DISABLED")
    assert (disabled["name"], events[-1]["failure"]) == ("sonar/front/03", "IsMinor")
    assert disabled["t"] == pytest.approx(52.0 + set_s, abs=0.5)


def test_a_sonar_that_falls_silent(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    packets = sips(50)
    for i in range(50, 100):
        numbers = [(5 * i + k) % 16 for k in range(5)]
        packets.append(frame(Sip(flags=1, sonars=tuple((n, WALL_MM + n) for n in numbers if n != 4)).data))
    path = write(tmp_path / "a.rec", timed(packets))
    (disabled,) = named(faults(path, capsys), "SONAR_DISABLED")
    assert (disabled["name"], disabled["value"]) == ("sonar/front/04", 2)
    assert 5.0 + 1.1 < disabled["t"] < 5.0 + 1.5 + 0.4
    (later,) = named(faults(path, capsys, "--set", "stale_ms=3000"), "SONAR_DISABLED")
    assert later["t"] == pytest.approx(disabled["t"] + 1.5, abs=0.11)


def both(offsets: Offsets, t: float, direction: Direction, data: bytes) -> Chunk:
    return offsets.chunk(t, direction, frame(data))


def test_the_session_of_another_client_and_a_second_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    offsets, chunks, t = Offsets(), [], 100.0
    for _ in range(2):
        for sync in range(3):
            chunks.append(both(offsets, t, "c2r", bytes((sync,))))
            chunks.append(both(offsets, t + 0.01, "r2c", SYNC[sync]))
            t += 0.1
        chunks.append(both(offsets, t, "c2r", bytes((COMMAND["OPEN"],))))
        for data in sips(40):
            t += 0.1
            chunks.append(offsets.chunk(t, "r2c", data))
        chunks.append(both(offsets, t + 0.01, "c2r", bytes((COMMAND["CLOSE"],))))
        chunks.append(offsets.chunk(t + 0.1, "r2c", sips(1)[0]))
        t += 60
    events = faults(write(tmp_path / "a.rec", chunks), capsys)
    assert len(named(events, "SESSION_OPEN")) == 2
    assert named(events, "LINK_STALLED") == named(events, "LINK_LOST") == []
    assert named(events, "SUBCLASS_UNKNOWN") == []
    assert max(event["level"] for event in events) == 0


def test_a_gap_is_a_stall_and_a_long_one_a_new_session(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    short = timed(sips(30)) + timed(sips(30), 5.0)
    assert [e["event"] for e in faults(write(tmp_path / "a", short), capsys) if e["level"] == 1] == [
        "LINK_STALLED"
    ]
    events = faults(write(tmp_path / "b", timed(sips(30)) + timed(sips(30), 4000.0)), capsys)
    assert len(named(events, "LINK_LOST")) == 1
    assert len(named(events, "SESSION_OPEN")) == 2


def test_damage_reaches_the_core_and_its_count(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    packets = sips(60)
    packets[30] = packets[30][:-1] + bytes((packets[30][-1] ^ 1,))
    packets[40] += b"noise"
    path = write(tmp_path / "a.rec", timed(packets))
    status = faults(path, capsys)[-1]
    assert status["bad_checksums"] == 1
    assert status["skipped_bytes"] == len(packets[30]) + len(b"noise")
    assert main(["faults", "--strict", str(path)]) == 1


def test_an_unknown_subclass_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path / "a.rec", timed(sips(20)))
    assert named(faults(path, capsys), "SUBCLASS_UNKNOWN") == []
    assert len(named(faults(path, capsys, "--subclass", "seekur"), "SUBCLASS_UNKNOWN")) == 1


@pytest.mark.parametrize(
    "name", ["a_idle", "c_commands", "d_ram", "m_p3dx", "m_powerbot", "m_seekur", "p10_badck"]
)
def test_recorded_sessions_are_judged(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    events = faults(ROOT / f"tests/data/captures/{name}.jsonl", capsys)
    # A client that puts the arrays off and on begins anew.
    assert len(named(events, "SESSION_OPEN")) == (2 if name == "c_commands" else 1)
    assert named(events, "INVARIANT") == []
    if name == "a_idle":
        assert {e["name"] for e in named(events, "SONAR_DISABLED")} == {"sonar/front/05"}


def test_the_events_for_people(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path / "a.rec", timed(sips(100, dead=[3], dead_at=50)))
    assert main(["faults", "--events", "--profile", "paper", str(path)]) == 1
    out = capsys.readouterr().out
    assert "ERROR sonar/front/03 SONAR_DISABLED (off): not used any more\n" in out
    assert "\n    3  DISABLED  off       5000\n" in out
    assert "\nIsMinor; " in out
    assert "\033" not in out


def told(path: Path, capsys: pytest.CaptureFixture[str], *arguments: str) -> list[str]:
    """What is printed for people."""
    capsys.readouterr()
    assert main(["faults", "--exit-zero", str(path), *arguments]) == 0
    return capsys.readouterr().out.splitlines()


@pytest.mark.parametrize("format_", ["record", "jsonl", "bin"])
@pytest.mark.parametrize("count", [30, 100, 600])
def test_a_healthy_log_is_one_line(
    count: int, format_: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path / "a", timed(sips(count), 1e9), format_)
    (line,) = told(path, capsys, "--format", format_)
    assert line.startswith("nothing wrong: 16 of 16 sonars healthy in ")
    assert f" over {(count - 1) / 10:.0f} s" in line


def test_a_dead_sonar_is_a_line_with_its_time(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path / "a.rec", timed(sips(200, dead=[3], dead_at=120), 1e9))
    lines = told(path, capsys, "--profile", "paper")
    first_at = next(i for i in range(120, 200) if 3 in {(5 * i + k) % 16 for k in range(5)})
    assert lines[0] == f"sonar/front/03 disabled as off at +{first_at / 10:.1f} s"
    assert lines[-1].startswith("15 of 16 sonars healthy in ")
    assert len(lines) == 2
    in_bin = told(
        write(tmp_path / "a.bin", timed(sips(200, dead=[3], dead_at=120)), "bin"),
        capsys,
        "--profile",
        "paper",
    )
    assert in_bin[0].startswith("sonar/front/03 disabled as off at byte ")


@pytest.mark.parametrize("format_", ["record", "bin"])
@pytest.mark.parametrize("echo_at", [None, 0, 40, 99])
def test_one_that_heard_nothing_is_not_healthy_and_one_echo_ends_that(
    echo_at: int | None, format_: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    packets = sips(100, dead=[0, 13])
    if echo_at is not None:
        packets[echo_at] = frame(Sip(flags=1, battery=125, sonars=((13, 4999), (0, DEAD_MM))).data)
    path = write(tmp_path / "a", timed(packets), format_)
    lines = told(path, capsys, "--format", format_)
    silent = [0] if echo_at is not None else [0, 13]
    assert [line for line in lines if line.endswith("contradicts it: not judged")] == lines[:-1]
    assert [int(line.split()[0][-2:]) for line in lines[:-1]] == silent
    assert lines[-1].startswith(f"{16 - len(silent)} of 16 sonars healthy")
    health = faults(path, capsys, "--profile", "argus", "--format", format_)[-1]["health"]
    assert [number for number, state in enumerate(health) if state == "UNKNOWN"] == silent
    diagnosis = argus.diagnose(path, form=format_)
    assert (list(diagnosis.health), diagnosis.text) == (health, "\n".join(lines))


def test_where_nobody_hears_anything_no_sonar_is_judged(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    hall, summary = told(write(tmp_path / "a.rec", timed(sips(100, dead=range(16)))), capsys)
    assert hall.startswith("16 sonars (0, 1, 2, ")
    assert hall.endswith("not judged")
    assert summary.startswith("too little to judge a sonar by in 100 SIPs")


def test_sonars_that_fail_together_are_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    silent = [frame(Sip(flags=1, battery=125).data)] * 60
    lines = told(write(tmp_path / "a.rec", timed(sips(50) + silent)), capsys)
    assert len(lines) < 6
    assert any(line.startswith("16 sonars (0, 1, 2, ") and line.endswith(", all at once") for line in lines)


def test_what_is_not_about_a_sonar_is_told_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = told(write(tmp_path / "a.rec", timed(sips(30)) + timed(sips(30), 5.0)), capsys)
    assert lines[0].startswith("nothing wrong with the sonars: 16 of 16")
    assert lines[1].startswith("also: 1 x LINK_STALLED (")
    packets = sips(60)
    packets[30] = packets[30][:-1] + bytes((packets[30][-1] ^ 1,))
    (line,) = told(write(tmp_path / "b.rec", timed(packets)), capsys)
    assert "1 bad checksums" in line


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["--profile", "mine"], "profile = mine: give paper"),
        (["--set", "frob=1"], "frob: no such setting"),
        (["--set", "frob"], "write KEY=VALUE"),
        (["--set", "active=on"], "is passive"),
        (["--set", "stale_ms=1"], "stale_ms is out of its range"),
    ],
)
def test_wrong_arguments(
    arguments: list[str], part: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path / "a.rec", timed(sips(5)))
    assert main(["faults", str(path), *arguments]) == 2
    error = capsys.readouterr().err
    assert part in error
    assert error.count("\n") == 1


def test_a_log_without_sips(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path / "a.rec", [both(Offsets(), 1.0, "c2r", bytes((COMMAND["PULSE"],)))])
    assert main(["faults", str(path)]) == 2
    assert "holds no SIP" in capsys.readouterr().err


def switched(count: int, *changes: tuple[int, int], flagged: bool = True, dies_at: int = 9999) -> list[Chunk]:
    """SIPs of which each array gives readings while it is on; CHANGES are the SIP's number and what SONAR is sent."""
    offsets, firing = Offsets(), 0b11
    out: list[Chunk] = []
    for n in range(count):
        for argument in (argument for at, argument in changes if at == n):
            command = Command.integer(COMMAND["SONAR"], argument).data
            out.append(offsets.chunk(0.1 * n, "c2r", frame(command)))
            mask = {0: 0b11, 1: 0b01, 2: 0b10}[argument >> 1]
            firing = firing | mask if argument & 1 else firing & ~mask
        numbers = [number for k in range(5) if firing >> (number := (5 * n + k) % 16) // 8 & 1]
        dead = [3] if n >= dies_at else []
        readings = tuple((k, DEAD_MM if k in dead else WALL_MM + k) for k in numbers)
        flags = 1 | firing * FLAG["SONAR1"] * flagged
        out.append(offsets.chunk(0.1 * n, "r2c", frame(Sip(flags=flags, battery=125, sonars=readings).data)))
    return out


@pytest.mark.parametrize("flagged", [True, False])
@pytest.mark.parametrize(
    "changes",
    [((80, 0), (160, 1)), ((80, 0),), ((80, 4), (160, 5)), ((80, 2),)],
    ids=["all off and on", "all off", "rear off and on", "front off"],
)
def test_an_array_that_the_client_puts_off_is_not_silent(
    changes: tuple[tuple[int, int], ...], flagged: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = write(tmp_path / "a.jsonl", switched(240, *changes, flagged=flagged), "jsonl")
    for profile in ("paper", "argus"):
        events = faults(log, capsys, "--profile", profile)
        assert not named(events, "SONAR_SILENT")
        assert not named(events, "SONAR_DISABLED")


def test_what_the_flags_tell_needs_no_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    chunks = [chunk for chunk in switched(240, (80, 0), (160, 1)) if chunk.dir == "r2c"]
    events = faults(write(tmp_path / "a.jsonl", chunks, "jsonl"), capsys)
    assert not named(events, "SONAR_DISABLED")
    assert events[-1]["health"].count("HEALTHY") == 16


def test_a_sonar_that_dies_after_the_arrays_are_on_again_is_found(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    chunks = switched(400, (80, 0), (120, 1), dies_at=200)
    log = write(tmp_path / "a.jsonl", chunks, "jsonl")
    assert {event["name"] for event in named(faults(log, capsys), "SONAR_DISABLED")} == {"sonar/front/03"}


def test_what_was_given_up_before_the_arrays_were_off_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    chunks = timed(sips(200, dead=[3], dead_at=30))
    chunks += [
        chunk._replace(t=(chunk.t or 0) + 20) for chunk in switched(100, (0, 0), (20, 1), flagged=False)
    ]
    log = write(tmp_path / "a.jsonl", chunks, "jsonl")
    assert main(["faults", str(log), "--profile", "paper"]) == 1
    out = capsys.readouterr().out
    assert re.search(
        r"^sonar/front/03 disabled as \w+ at \+[\d.]+ s, in an earlier session$", out, re.MULTILINE
    )
    assert "nothing wrong" not in out
    sips_told = re.search(r"in (\d+) SIPs", out)
    assert sips_told is not None
    assert int(sips_told[1]) > 250


@pytest.mark.parametrize("first", [SyncEcho(2).data, b"\x02name without an end", b"\x02a\0b\0"])
@pytest.mark.parametrize("command", ["faults", "plot", "decode"])
def test_a_sync2_that_is_damaged_or_echoed_stops_nothing(
    command: str, first: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = tmp_path / "a.bin"
    log.write_bytes(b"".join(map(frame, [first, *SYNC])) + frame(first) + b"".join(sips(30)))
    picture = ["-o", str(tmp_path / "a.png")] if command == "plot" else []
    assert main([command, str(log), *picture]) == 0
    assert "data byte" not in capsys.readouterr().err


def test_a_sip_that_ends_before_its_readings_opens_no_session(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = sips(30)
    cut = frame(whole[0][3:-2][:21])
    log = write(tmp_path / "a.jsonl", timed([cut, *whole]), "jsonl")
    assert len(named(faults(log, capsys), "SESSION_OPEN")) == 1


@pytest.mark.parametrize("form", [[], ["--json"], ["--events"]], ids=["lines", "json", "events"])
@pytest.mark.parametrize(
    ("dead", "more", "code"),
    [([], [], 0), ([3], [], 1), ([3], ["--exit-zero"], 0), ([3], ["--strict"], 1), ([], ["--strict"], 0)],
)
def test_the_exit_code_is_1_where_faults_are_found(
    dead: list[int], more: list[str], code: int, form: list[str], tmp_path: Path
) -> None:
    path = write(tmp_path / "a.rec", timed(sips(150, dead=dead, dead_at=50)))
    assert main(["faults", "--profile", "paper", str(path), *form, *more]) == code


def damaged(count: int, every: int, silent: int) -> list[Chunk]:
    """SIPs of which one in `every` is spoilt, and from the 40th on none has this sonar."""
    chunks = []
    for number, chunk in enumerate(timed(sips(count, silent=[silent], dead_at=40))):
        data = bytearray(chunk.data)
        if number % every == 0:
            data[-1] ^= 0x55
        chunks.append(chunk._replace(data=bytes(data)))
    return chunks


@pytest.mark.parametrize("form", [[], ["--json"]], ids=["lines", "json"])
def test_of_a_damaged_log_no_sonar_is_given_out_as_silent(
    form: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path / "a.jsonl", damaged(400, 4, 3), "jsonl")
    capsys.readouterr()
    assert main(["faults", str(path), *form]) == 0
    out = capsys.readouterr().out
    assert "silent" not in out
    assert "SONAR_DISABLED" not in out
    if not form:
        assert "sonar/front/03 gave no reading where the log is damaged: no verdict of silence" in out


def test_of_a_log_with_little_damage_silence_is_a_verdict(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path / "a.jsonl", damaged(400, 50, 3), "jsonl")
    capsys.readouterr()
    assert main(["faults", str(path)]) == 1
    assert "sonar/front/03 disabled as silent" in capsys.readouterr().out
