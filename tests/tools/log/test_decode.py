# SPDX-License-Identifier: MIT
"""`argus-log decode --json` keeps its contract: names, units, ranges; bad files give one line and exit code 2."""

from __future__ import annotations

import csv
import gzip
import json
import random
import signal
import time
from pathlib import Path

import pytest
from argus_tools.formats import Chunk, open_log
from argus_tools.log.common import BULK_BYTES
from argus_tools.log.fields import Decoder
from argus_tools.log.packets import packets
from logs import CAPTURES, command, decode, jsonl, run, sip, start

from hil_sim.arcos import Command, EncoderPac, GyroPac, IoPac, SyncReply, frame

FILES = sorted(CAPTURES.glob("*.jsonl"))


def robot(tmp_path: Path, *sent: bytes) -> list[dict[str, object]]:
    path = tmp_path / "robot.jsonl"
    path.write_bytes(jsonl((float(n), "r2c", data) for n, data in enumerate(sent)))
    return decode(path)


def test_a_sip_in_units_for_people(tmp_path: Path) -> None:
    sent = sip(
        type=0x33, x=1500, y=0x10000 - 250, th=1024, left_vel=300, right_vel=-20, battery=127, stall_left=0x05,
        stall_right=0x42, flags=7, sonars=((2, 812), (3, 5000), (2, 790)), battery_x10=126,
    )  # fmt: skip
    row = robot(tmp_path, sent)[0]
    expected = {
        "t": 0.0, "offset": 0, "dir": "r2c", "type": "SIP", "ok": True, "x_mm": 1500, "y_mm": -250, "heading_deg": 90,
        "vel_left_mm_s": 300, "vel_right_mm_s": -20, "battery_v": 12.6, "stall_left": True, "stall_right": False,
        "bumpers_front": 0x42, "bumpers_rear": 0x04, "moving": True, "motors": True, "sonar": {"2": 790, "3": 5000},
        "fault_flags": 0,
    }  # fmt: skip
    assert {name: row[name] for name in expected} == expected
    assert "lat_vel" not in row


@pytest.mark.parametrize(
    ("th", "degrees"), [(0, 0), (2048, 180), (-2048, 180), (2049, -179.912109375), (-1024, -90)]
)
def test_headings_are_in_their_half_open_range(tmp_path: Path, th: int, degrees: float) -> None:
    assert robot(tmp_path, sip(th=th))[0]["heading_deg"] == degrees


def test_the_battery_is_taken_from_where_it_is(tmp_path: Path) -> None:
    assert robot(tmp_path, sip(battery=119, battery_x10=None))[0]["battery_v"] == 11.9


@pytest.mark.parametrize("bits", [15, 16])
def test_positions_are_unwrapped(tmp_path: Path, bits: int) -> None:
    mask = (1 << bits) - 1
    path = [*range(0, 100_000, 900), *range(100_000, -50_000, -900)]
    rows = robot(tmp_path, *(sip(x=x & mask, y=-x & mask) for x in path))
    assert [(row["x_mm"], row["y_mm"]) for row in rows] == [(x, -x) for x in path]


def test_the_unit_of_positions_is_that_of_the_subclass(tmp_path: Path) -> None:
    identity = frame(SyncReply(b"n", b"Pioneer", b"p3dx").data)
    assert robot(tmp_path, identity, sip(x=1000))[1]["x_mm"] == 485
    assert robot(tmp_path, sip(x=1000))[0]["x_mm"] == 1000
    assert decode(tmp_path / "robot.jsonl", "--subclass", "p3dx")[0]["x_mm"] == 485


def test_seto_begins_the_position_anew(tmp_path: Path) -> None:
    records = [(0.1 * n, "r2c", sip(x=x & 0x7FFF)) for n, x in enumerate(range(0, 40_001, 1000))]
    path = tmp_path / "a.jsonl"
    path.write_bytes(jsonl([*records, (9.0, "c2r", command("SETO")), (9.1, "r2c", sip(x=0))]))
    rows = decode(path)
    assert [row["x_mm"] for row in rows if row["type"] == "SIP"][-2:] == [40_000, 0]


def test_arguments_of_commands(tmp_path: Path) -> None:
    path = tmp_path / "a.jsonl"
    sent = [
        command("VEL", -300), command("STOP"), frame(Command.string(15, b"hi").data), frame(bytes((99, 1))),
        frame(Command.pair(32, -5, 3).data),
    ]  # fmt: skip
    path.write_bytes(jsonl((None, "c2r", data) for data in sent))
    rows = decode(path)
    assert [(row["type"], row["arg"]) for row in rows[:4]] == [
        ("VEL", -300), ("STOP", None), ("SAY", "hi"), ("CMD_99", None),
    ]  # fmt: skip
    assert (rows[4]["type"], rows[4]["high"], rows[4]["low"]) == ("VEL2", -5, 3)
    assert [row["t"] for row in rows] == [None] * 5


def test_the_other_packets(tmp_path: Path) -> None:
    sent = (
        EncoderPac(-7, 9).data,
        IoPac().data,
        GyroPac(((512, 30),)).data,
        b"\xd0x",
        b"\xb8hi",
        b"\x90\x01",
    )
    rows = robot(tmp_path, *map(frame, sent))
    names = ["ENCODERPAC", "IOPAC", "GYROPAC", "PLAYLIST", "SERAUXPAC", "ENCODERPAC"]
    assert [row["type"] for row in rows] == names
    assert (rows[0]["left"], rows[0]["right"]) == (-7, 9)
    assert rows[2]["samples"] == [[512, 30]]
    assert (rows[4]["port"], rows[4]["text"]) == (2, "hi")
    assert [row["ok"] for row in rows] == [True] * 5 + [False]


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_the_quick_way_and_the_long_way_say_the_same(path: Path) -> None:
    decoder = Decoder()
    for row in packets(open_log(str(path))):
        decoder.track(row)
        assert decoder.json(row) == json.dumps(decoder.fields(row))


@pytest.mark.parametrize("seed", range(300))
def test_both_ways_on_random_sips(seed: int) -> None:
    rng = random.Random(seed)
    decoder = Decoder(rng.choice((None, "p3dx")))
    readings = [(rng.randrange(40), rng.randrange(65536)) for _ in range(rng.randrange(6))]
    data = sip(type=rng.choice((0x30, 0x32, 0x33)), x=rng.randrange(65536), sonars=tuple(readings))[3:-2]
    data = data[: rng.randrange(len(data) + 1)] + rng.randbytes(rng.randrange(30))
    for row in packets([open_chunk(frame(data or b"\x32"))]):
        decoder.track(row)
        assert decoder.json(row) == json.dumps(decoder.fields(row))


def open_chunk(data: bytes) -> Chunk:
    return Chunk(0.5, "r2c", data, 0)


def test_filters() -> None:
    path = CAPTURES / "d_ram.jsonl"
    assert {row["type"] for row in decode(path, "--type", "VEL,stop")} == {"VEL", "STOP"}
    assert {row["dir"] for row in decode(path, "--dir", "c2r")} == {"c2r"}
    times = [row["t"] for row in decode(path, "--from", "5", "--to", "+8")]
    assert min(times) >= 5
    assert max(times) <= 8.1
    rows = decode(path, "--sonar", "3,15")
    assert len(rows) == 234
    assert all(list(row["sonar"]) == ["3", "15"] for row in rows)


def test_a_filtered_position_is_the_same_as_the_whole_logs() -> None:
    path = CAPTURES / "d_ram.jsonl"
    whole = {row["offset"]: row["x_mm"] for row in decode(path, "--type", "SIP")}
    late = decode(path, "--type", "SIP", "--from", "15")
    assert {row["offset"]: row["x_mm"] for row in late}.items() <= whole.items()


def test_csv_has_every_reading() -> None:
    done = run("decode", "--csv", CAPTURES / "d_ram.jsonl")
    rows = list(csv.DictReader(done.stdout.decode().splitlines()))
    sips = [row for row in rows if row["type"] == "SIP"]
    objects = decode(CAPTURES / "d_ram.jsonl", "--type", "SIP")
    assert [int(row["sonar_3"]) for row in sips] == [row["sonar"]["3"] for row in objects]
    assert len(rows) == 303


def test_the_table_shows_damage_and_goes_on() -> None:
    lines = run("decode", CAPTURES / "p10_badck.jsonl").stdout.decode().splitlines()
    assert sum("DAMAGED" in line for line in lines) == 3
    assert "CLOSE" in lines[-2]
    assert run("decode", "--strict", CAPTURES / "p10_badck.jsonl").returncode == 1
    assert run("decode", "--strict", CAPTURES / "a_idle.jsonl").returncode == 0


def test_records_without_hex_are_passed_over_and_torn_lines_are_told(tmp_path: Path) -> None:
    path = tmp_path / "a.jsonl"
    path.write_bytes(jsonl([(0.0, "r2c", sip())]) + b'{"t": 1, "dir": "ev"}\n{"t": 2, "dir": "r2c", "he')
    done = run("decode", "--json", path)
    assert (done.returncode, len(done.stdout.splitlines())) == (0, 1)
    assert b"line 3" in done.stderr
    assert run("decode", "--strict", path).returncode == 1


def unusable(tmp_path: Path) -> dict[str, Path]:
    made = {"empty": b"", "cut-gzip": gzip.compress(sip())[:8],
            "random": random.Random(1).randbytes(10_000_000), "text": b"hello\n" * 50,
            "elf": b"\x7fELF" + bytes(200_000), "no-link": b'{"a": 1}\n'}  # fmt: skip
    paths = {name: tmp_path / name for name in made}
    for name, data in made.items():
        paths[name].write_bytes(data)
    return {**paths, "folder": tmp_path, "missing": tmp_path / "nothing"}


@pytest.mark.parametrize(
    "kind", ["empty", "cut-gzip", "random", "text", "elf", "no-link", "folder", "missing"]
)
def test_what_is_no_log_gives_one_line_and_2(tmp_path: Path, kind: str) -> None:
    done = run("decode", "--json", unusable(tmp_path)[kind])
    lines = done.stderr.decode().splitlines()
    assert (done.returncode, done.stdout) == (2, b"")
    assert len(lines) == 1, lines


@pytest.mark.parametrize(
    "arguments",
    [["--type", "SPI"], ["--sonar", "x"], ["--from", "soon"], ["--format", "pdf"], ["--dir", "up"]],
)
def test_a_wrong_argument_gives_one_line_and_2(arguments: list[str]) -> None:
    done = run("decode", CAPTURES / "a_idle.jsonl", *arguments)
    assert (done.returncode, len(done.stderr.splitlines())) == (2, 1)


def test_standard_input_and_gzip() -> None:
    path = CAPTURES / "a_idle.jsonl"
    assert decode("-", stdin=gzip.compress(path.read_bytes())) == decode(path)


def test_a_cut_gzip_gives_what_is_there(tmp_path: Path) -> None:
    path = tmp_path / "a.jsonl.gz"
    path.write_bytes(gzip.compress((CAPTURES / "c_commands.jsonl").read_bytes())[:-5000])
    done = run("decode", "--json", path)
    assert done.returncode == 0
    assert len(done.stdout.splitlines()) > 100
    assert b"gzip" in done.stderr


def test_a_wrong_checksum_of_gzip_is_told_behind_all_that_was_read(tmp_path: Path) -> None:
    path = tmp_path / "a.jsonl.gz"
    whole = gzip.compress((CAPTURES / "c_commands.jsonl").read_bytes())
    path.write_bytes(whole[:-8] + b"12345678")
    done = run("decode", "--json", path)
    assert done.returncode == 0
    assert done.stdout == run("decode", "--json", CAPTURES / "c_commands.jsonl").stdout
    assert b"the gzip file is damaged" in done.stderr


def test_follow_shows_what_is_appended(tmp_path: Path) -> None:
    path = tmp_path / "live.jsonl"
    path.write_bytes(jsonl([(0.0, "r2c", sip(x=1))]))
    with start("decode", "--json", "--follow", path) as process:
        assert process.stdout is not None
        assert json.loads(process.stdout.readline())["x_mm"] == 1
        with path.open("ab") as file:
            file.write(jsonl([(1.0, "r2c", sip(x=2))])[:30])
            file.flush()
            time.sleep(0.2)
            file.write(jsonl([(1.0, "r2c", sip(x=2))])[30:])
        assert json.loads(process.stdout.readline())["x_mm"] == 2
        process.send_signal(signal.SIGINT)
        assert process.wait(600) == 0


@pytest.mark.parametrize("way", ["rotated", "emptied"])
def test_follow_goes_on_when_the_file_begins_anew(way: str, tmp_path: Path) -> None:
    path = tmp_path / "live.jsonl"
    path.write_bytes(jsonl([(0.0, "r2c", sip(x=1)), (0.1, "r2c", sip(x=2))]))
    with start("decode", "--json", "--follow", path) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        assert [json.loads(process.stdout.readline())["x_mm"] for _ in range(2)] == [1, 2]
        if way == "rotated":
            path.rename(tmp_path / "live.jsonl.1")
            time.sleep(0.2)
        path.write_bytes(jsonl([(1.0, "r2c", sip(x=3))]))
        assert json.loads(process.stdout.readline())["x_mm"] == 3
        process.send_signal(signal.SIGINT)
        assert process.wait(600) == 0
        assert (b"was replaced" if way == "rotated" else b"became shorter") in process.stderr.read()


def random_session(rng: random.Random) -> list[Chunk]:
    """SIPs of any layout among commands and answers, some of which change what positions mean."""
    chunks = []
    answers = [
        SyncReply(b"n", b"Pioneer", b"p3dx").data,
        SyncReply(b"n", b"Pioneer", b"p3dx-sh").data,
        b"\xb0x",
    ]
    layouts = [[rng.randrange(20) for _ in range(rng.randrange(6))] for _ in range(4)]
    x = 0
    for n in range(rng.randrange(1, 400)):
        t = None if rng.random() < 0.1 else n / 10
        action = rng.random()
        if action < 0.02:
            chunks.append(Chunk(t, "c2r", command(rng.choice(("SETO", "PULSE", "STOP"))), n))
        elif action < 0.03:
            chunks.append(Chunk(t, "r2c", frame(rng.choice(answers)), n))
        elif action < 0.04:
            chunks.append(Chunk(t, "r2c", frame(b"\x33" + rng.randbytes(rng.randrange(40))), n))
        elif action < 0.05:
            chunks.append(Chunk(t, "r2c", rng.randbytes(5), n))
        else:
            x = rng.choice((x, x + 7, rng.randrange(1 << 16))) & 0xFFFF
            readings = tuple((number, rng.randrange(1 << 16)) for number in rng.choice(layouts))
            data = sip(
                type=rng.choice((0x32, 0x33)), x=x, y=rng.randrange(1 << 16), th=rng.randrange(-2048, 2049),
                left_vel=rng.randrange(-900, 900), flags=rng.choice((1, 7)), sonars=readings,
                battery_x10=rng.choice((None, 126)),
            )  # fmt: skip
            chunks.append(Chunk(t, "r2c", data, n))
    return chunks


@pytest.mark.tour(30, 60)
@pytest.mark.parametrize("seed", range(150))
def test_many_at_once_are_the_same_lines(seed: int) -> None:
    chunks = random_session(random.Random(seed))
    decoder, expected = Decoder(), []
    for row in packets(chunks):
        decoder.track(row)
        expected.append(json.dumps(decoder.fields(row)))
    found = "\n".join(Decoder().json_lines(packets(chunks, at_once=False), at_once=False))
    assert found.split("\n") == expected


def test_a_long_file_gives_the_lines_of_its_parts(tmp_path: Path) -> None:
    whole = (CAPTURES / "d_ram.jsonl").read_bytes()
    path = tmp_path / "long.jsonl"
    path.write_bytes(whole * 6)
    decoder = Decoder()
    lines = []
    for row in packets(open_log(str(path))):
        decoder.track(row)
        lines.append(json.dumps(decoder.fields(row)))
    assert path.stat().st_size > BULK_BYTES
    assert run("decode", "--json", path).stdout.decode().splitlines() == lines


def test_ten_places_are_told_and_then_how_many_more(tmp_path: Path) -> None:
    path = tmp_path / "a.jsonl"
    good = jsonl([(1.0, "r2c", sip())])
    for damaged in (9, 10, 11, 2000):
        path.write_bytes(good + b"no record\n" * damaged + good)
        lines = run("decode", path).stderr.decode().splitlines()
        assert len(lines) == min(damaged, 10) + (damaged > 10)
        assert lines[0].endswith("line 2: no JSON record")
        if damaged > 10:
            assert lines[-1].endswith(f"and {damaged - 10} places more")
