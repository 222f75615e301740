# SPDX-License-Identifier: MIT
"""Rule: from a log alone the manager says what it would have said at the robot, whoever recorded it and however
it begins, ends or is damaged."""

from __future__ import annotations

import io
import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import pytest
from argus_tools.formats import ReadOptions, formats
from argus_tools.formats.base import Chunk, Direction, Offsets, copy
from argus_tools.log.cli import main

from hil_sim.arcos import COMMAND, Sip, SyncEcho, SyncReply, frame

ROOT = Path(__file__).resolve().parents[3]
WALL_MM = 2000
DEAD_MM = 5000
SYNC = [SyncEcho(0).data, SyncEcho(1).data, SyncReply(b"n", b"Pioneer", b"p3dx-sh").data]


def sips(count: int, start: int = 0, dead: Iterable[int] = (), dead_at: int = 0) -> list[bytes]:
    """SIPs as of a P3-DX: five readings each, all 16 sonars every 320 ms."""
    dead = frozenset(dead)
    out = []
    for i in range(start, start + count):
        numbers = [(5 * i + k) % 16 for k in range(5)]
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
    assert main(["faults", "--json", str(path), *words]) == 0
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
    assert len(named(events, "SESSION_OPEN")) == 1
    assert named(events, "INVARIANT") == []
    if name == "a_idle":
        assert {e["name"] for e in named(events, "SONAR_DISABLED")} == {"sonar/front/05"}


def test_the_events_for_people(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path / "a.rec", timed(sips(100, dead=[3], dead_at=50)))
    assert main(["faults", "--events", "--profile", "paper", str(path)]) == 0
    out = capsys.readouterr().out
    assert "ERROR sonar/front/03 SONAR_DISABLED (off): not used any more\n" in out
    assert "\n    3  DISABLED  off       5000\n" in out
    assert "\nIsMinor; " in out
    assert "\033" not in out


def told(path: Path, capsys: pytest.CaptureFixture[str], *arguments: str) -> list[str]:
    """What is printed for people."""
    capsys.readouterr()
    assert main(["faults", str(path), *arguments]) == 0
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
