# SPDX-License-Identifier: MIT
"""Rule: the Wireshark dissector finds the packets that `argus-log` finds, with the same numbers, in any segments."""

from __future__ import annotations

import io
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest
from argus_tools.chunks import Chunk, Offsets, copy
from argus_tools.formats import ReadOptions, open_log
from argus_tools.formats.pcap import FORMAT
from argus_tools.log.packets import packets

from hil_sim.arcos import COMMAND, FLAG, Command, ConfigPac, Sip, SyncEcho, SyncReply, frame

ROOT = Path(__file__).resolve().parents[2]
DISSECTOR = ROOT / "tools/argus.lua"
# As root, Wireshark from 4.4 on loads no script and does not say so; so it runs as nobody. That one may not follow the
# paths, and gets both files open.
UNPRIVILEGED: dict[str, Any] = (
    {"user": 65534, "group": 65534, "extra_groups": []} if os.geteuid() == 0 else {}
)
CAPTURES = sorted((ROOT / "tests/data/captures").glob("*.jsonl"))


def write(path: Path, chunks: Iterable[Chunk]) -> Path:
    assert FORMAT.writer is not None
    stream = io.BytesIO()
    copy(chunks, FORMAT.writer(stream, ReadOptions()))
    path.write_bytes(stream.getvalue())
    return path


def tshark(path: Path, *arguments: str) -> str:
    program = shutil.which("tshark")
    assert program, "tshark is missing: tools/dev test installs it, or apt-get install tshark"
    with DISSECTOR.open("rb") as script, path.open("rb") as capture:
        command = [program, "-X", f"lua_script:/dev/fd/{script.fileno()}", "-r", "-", *arguments]
        done: subprocess.CompletedProcess[str] = subprocess.run(
            command,
            stdin=capture,
            capture_output=True,
            text=True,
            check=False,
            timeout=600,
            pass_fds=[script.fileno()],
            env=os.environ | {"HOME": "/nonexistent"},
            **UNPRIVILEGED,
        )
    assert done.returncode == 0, done.stderr
    assert "Lua" not in done.stderr, done.stderr
    assert "Lua Error" not in done.stdout
    return done.stdout


TRUTH = {"False": "0", "True": "1"}
"""As tshark writes them before 4.4, and since."""


def fields(path: Path, *names: str, where: str = "arcos") -> list[list[list[str]]]:
    """The values of some fields, for each frame."""
    wanted = [word for name in names for word in ("-e", name)]
    lines = tshark(path, "-Y", where, "-T", "fields", *wanted).splitlines()
    return [
        [[TRUTH.get(value, value) for value in part.split(",") if value] for part in line.split("\t")]
        for line in lines
    ]


def field(path: Path, name: str) -> list[str]:
    """All values of one field, in order."""
    return [value for (values,) in fields(path, name) for value in values]


def layers(path: Path) -> list[dict[str, Any]]:
    """Every packet of every frame as its fields."""
    found: list[dict[str, Any]] = []
    for one in json.loads(tshark(path, "-Y", "arcos", "-T", "json", "--no-duplicate-keys")):
        layer = one["_source"]["layers"]["arcos"]
        found += layer if isinstance(layer, list) else [layer]
    return found


def cut(chunks: Iterable[Chunk], size: int) -> list[Chunk]:
    """The same bytes in segments that heed no packet."""
    offsets = Offsets()
    return [
        offsets.chunk(chunk.t, chunk.dir, chunk.data[at : at + size])
        for chunk in chunks
        for at in range(0, len(chunk.data), size)
    ]


@pytest.mark.tour(3)
@pytest.mark.parametrize("path", CAPTURES, ids=lambda path: path.stem)
@pytest.mark.parametrize("size", [1 << 16, 7])
def test_the_packets_are_those_of_argus_log(path: Path, size: int, tmp_path: Path) -> None:
    chunks = list(open_log(str(path)))
    rows = [row for row in packets(chunks) if row.ok]
    pcap = write(tmp_path / "a.pcap", cut(chunks, size))
    robot, client = ([row.type for row in rows if row.dir == name] for name in ("r2c", "c2r"))
    found: dict[str, list[str]] = {"0": [], "1": []}
    for to_robot, names in fields(pcap, "arcos.to_robot", "arcos.name"):
        assert len(set(to_robot)) == bool(names), "a frame has one direction"
        for name in names:
            found[to_robot[0]].append(name)
    assert found == {"0": robot, "1": client}


def gathered(chunks: Iterable[Chunk], size: int) -> list[Chunk]:
    """The same bytes, many packets in a segment: it ends when it is full or the other side speaks."""
    offsets = Offsets()
    found: list[Chunk] = []
    for chunk in chunks:
        if found and found[-1].dir == chunk.dir and len(found[-1].data) + len(chunk.data) <= size:
            found[-1] = found[-1]._replace(data=found[-1].data + chunk.data)
            offsets.at[chunk.dir] += len(chunk.data)
        else:
            found.append(offsets.chunk(chunk.t, chunk.dir, chunk.data))
    return found


@pytest.mark.tour(1)
@pytest.mark.parametrize("name", ["a_idle", "c_commands", "d_ram"])
def test_many_packets_in_a_segment_and_some_over_its_edge(name: str, tmp_path: Path) -> None:
    chunks = [chunk for chunk in open_log(str(CAPTURES[0].parent / f"{name}.jsonl")) if chunk.dir == "r2c"]
    rows = [row for row in packets(chunks) if row.ok]
    full = gathered(chunks, 1300)
    assert max(len(list(packets([chunk]))) for chunk in full) > 8
    over_edges = cut(gathered(chunks, 1 << 20), 1000)
    for segments in (full, over_edges):
        pcap = write(tmp_path / "a.pcap", segments)
        found = fields(pcap, "arcos.name", "arcos.sonar.range")
        assert [name for names, _ in found for name in names] == [row.type for row in rows]
        ranges = [
            str(int.from_bytes(row.data[at + 1 : at + 3], "little"))
            for row in rows
            if row.type == "SIP"
            for at in range(20, 20 + 3 * row.data[19], 3)
        ]
        assert [value for _, values in found for value in values] == ranges


SIP = Sip(
    type=0x33,
    x=0x7FF0,
    y=0x8005,
    th=-1024,
    left_vel=-120,
    right_vel=340,
    battery=127,
    stall_left=0b00000101,
    stall_right=0b00100000,
    control=-3,
    flags=FLAG["MOTORS"] | FLAG["ESTOP"],
    compass=9,
    sonars=((0, 1234), (3, 5000), (15, 321)),
    battery_x10=126,
    charge_state=2,
    rotvel=-55,
    fault_flags=7,
)


def conversation(subclass: bytes = b"p3dx-sh") -> list[Chunk]:
    offsets = Offsets()
    said: list[tuple[str, bytes]] = [
        ("c2r", bytes((0,))),
        ("r2c", SyncEcho(0).data),
        ("c2r", bytes((1,))),
        ("r2c", SyncEcho(1).data),
        ("c2r", bytes((2,))),
        ("r2c", SyncReply(b"Robot 7", b"Pioneer", subclass).data),
        ("c2r", bytes((COMMAND["OPEN"],))),
        ("r2c", SIP.data),
        ("c2r", Command.integer(COMMAND["VEL"], -200).data),
        ("c2r", Command.integer(COMMAND["HEAD"], 90).data),
        ("c2r", Command.string(COMMAND["POLLING"], b"\x01\x02").data),
        ("c2r", bytes((COMMAND["CONFIG"],))),
        ("r2c", ConfigPac().data),
        ("c2r", bytes((COMMAND["PULSE"],))),
        ("c2r", bytes((199, 0x3B, 5, 0))),
        ("c2r", bytes((COMMAND["CLOSE"],))),
        ("r2c", bytes((0xB0, 1, 2, 3))),
    ]
    return [
        offsets.chunk(0.1 * i, "r2c" if direction == "r2c" else "c2r", frame(data))
        for i, (direction, data) in enumerate(said)
    ]


def test_every_field_of_a_sip(tmp_path: Path) -> None:
    pcap = write(tmp_path / "a.pcap", conversation())
    (sip,) = (layer for layer in layers(pcap) if layer["arcos.name"] == "SIP")
    want = {
        "moving": "1", "x": "-16", "y": "5", "heading": "-90", "vel_left": "-120", "vel_right": "340",
        "battery": "12.7", "stall_left": "1", "stall_right": "0", "bumpers_rear": "0x02",
        "bumpers_front": "0x10", "control": "-3", "flags": "0x0021", "compass": "9", "sonars": "3",
        "battery_x10": "126", "charge_state": "2", "rotvel": "-55", "fault_flags": "7",
    }  # fmt: skip
    got = {name: sip[f"arcos.sip.{name}"] for name in want}
    numbers = {name for name in want if not want[name].startswith("0x")}
    assert {n: float(got[n]) for n in numbers} == pytest.approx({n: float(want[n]) for n in numbers})
    assert {n: int(got[n], 16) for n in want.keys() - numbers} == {
        n: int(want[n], 16) for n in want.keys() - numbers
    }
    flags = sip["arcos.sip.flags_tree"]
    assert [name for name, value in flags.items() if value == "1"] == [
        "arcos.sip.flag.motors",
        "arcos.sip.flag.estop",
    ]
    found = fields(pcap, *(f"arcos.sonar.s{number}" for number, _ in SIP.sonars))
    of_each = ([value for values in column for value in values] for column in zip(*found, strict=True))
    assert list(of_each) == [[str(range_mm)] for _, range_mm in SIP.sonars]


def test_units_and_the_summary(tmp_path: Path) -> None:
    pcap = write(tmp_path / "a.pcap", conversation())
    text = tshark(pcap, "-V", "-Y", "arcos")
    for line in (
        "Left wheel: -120 mm/s",
        "Heading: -90 deg",
        "X: -16 mm",
        "Battery: 12.7 V",
        "Sonar 3: 5000 mm",
        "Argument: -200 mm/s",
        "Argument: 90 deg",
        "Command: VEL (11)",
        "watchdog ms: 2000 ms",
        "Subclass: p3dx-sh",
    ):
        assert f" {line}\n" in text, line
    summary = tshark(pcap, "-Y", "arcos")
    assert "> VEL -200 mm/s\n" in summary
    assert "< SIP x -16 y 5 th -90.0, 3 readings\n" in summary
    assert "> CMD_199 5\n" in summary


def test_filters(tmp_path: Path) -> None:
    pcap = write(tmp_path / "a.pcap", conversation())
    wanted = (
        ("arcos.sonar.s3 == 5000", 1),
        ("arcos.sonar.s4", 0),
        ("arcos.sip.flag.estop == 1", 1),
        ("arcos.sip.vel_right > 300 && arcos.sip.battery < 13", 1),
        ("arcos.command == 11 && arcos.arg < 0", 1),
        ('arcos.name == "OPEN"', 1),
        ('arcos.config.subtype == "p3dx-sh"', 1),
        ("arcos.checksum_ok == 0", 0),
    )
    told = tshark(pcap, "-q", "-z", ",".join(["io,stat,0", *(where for where, _ in wanted)]))
    (row,) = (line for line in told.splitlines() if "<>" in line)
    frames = [int(cell) for cell in row.split("|")[2::2] if cell.strip()]  # each is followed by its bytes
    assert dict(zip((where for where, _ in wanted), frames, strict=True)) == dict(wanted)


def test_the_older_subclass_has_its_own_unit(tmp_path: Path) -> None:
    pcap = write(tmp_path / "a.pcap", conversation(b"p3dx"))
    assert [float(value) for value in field(pcap, "arcos.sip.x")] == [pytest.approx(-16 * 0.485)]


def test_damage_is_marked_and_passed_over(tmp_path: Path) -> None:
    offsets = Offsets()
    good, bad = frame(SIP.data), bytearray(frame(SIP.data))
    bad[10] ^= 0xFF
    stream = good + bytes(bad) + b"garbage" + good
    pcap = write(
        tmp_path / "a.pcap",
        [offsets.chunk(0.0, "r2c", stream[at : at + 40]) for at in range(0, len(stream), 40)],
    )
    assert field(pcap, "arcos.name") == ["SIP", "SIP"]
    damaged = "".join(field(pcap, "arcos.damaged")).replace(":", "")
    assert damaged == (bytes(bad) + b"garbage").hex()
    assert "Damaged packet" in tshark(pcap, "-V", "-Y", "arcos.bad")


def test_noise_is_survived(tmp_path: Path) -> None:
    import random

    offsets, rng = Offsets(), random.Random(1)
    chunks = []
    for _ in range(300):
        data = bytes(rng.choice((0xFA, 0xFB, 3, 0x32, 0x20, 2, rng.randrange(256))) for _ in range(50))
        chunks.append(offsets.chunk(0.0, rng.choice(("r2c", "c2r")), data))
    short = [frame(bytes((kind,)) + bytes(size)) for kind in (0x32, 0x20, 2, 11) for size in range(30)]
    chunks += [offsets.chunk(0.0, "r2c", data) for data in short]
    chunks += [offsets.chunk(0.0, "c2r", data) for data in short]
    tshark(write(tmp_path / "a.pcap", chunks), "-V")


def test_tables_are_those_of_the_protocol() -> None:
    command = [sys.executable, str(ROOT / "tools/gen_lua.py"), "--check"]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
