# SPDX-License-Identifier: MIT
"""Rule: argus.dbc, the C code made from it, cantools and the firmware's own names say the same of every frame."""

from __future__ import annotations

import ctypes
import math
import random
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import cantools.database
import forks
import pytest
from cantools.database.can import Database, Message

ROOT = Path(__file__).resolve().parents[2]
DBC = Path("tools/argus.dbc")
HEADER = Path("hal/include/hal/gen_argus_dbc.h")
SOURCE = Path("hal/linux/gen_argus_dbc.c")
SEED = 20260521
TYPES = {
    "uint8_t": ctypes.c_uint8,
    "uint16_t": ctypes.c_uint16,
    "int8_t": ctypes.c_int8,
    "int32_t": ctypes.c_int32,
}

sys.path.insert(0, str(ROOT / "tools"))
import gen_dbc  # noqa: E402


def generate(root: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return forks.run_text("gen_dbc:main", "--root", root, *arguments)


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    for path in (DBC, HEADER, SOURCE):
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / path, tmp_path / path)
    return tmp_path


@pytest.fixture(scope="module")
def database() -> Database:
    loaded = cantools.database.load_file(ROOT / DBC)
    assert isinstance(loaded, Database)
    return loaded


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    built = tmp_path_factory.mktemp("dbc") / "dbc.so"
    flags = ["-std=c11", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-shared", "-fPIC"]
    command = ["gcc", *flags, "-I", str(ROOT / "hal/include"), "-o", str(built), str(ROOT / SOURCE)]
    subprocess.run(command, check=True)
    return ctypes.CDLL(str(built))


def test_checked_in_files_are_current() -> None:
    done = generate(ROOT, "--check")
    assert done.returncode == 0, done.stderr


def test_check_sees_a_change(tree: Path) -> None:
    assert generate(tree, "--check").returncode == 0
    text = (tree / DBC).read_text()
    (tree / DBC).write_text(
        text.replace("SG_ Nonce : 48|16", "SG_ Nonce : 40|16").replace(
            "SG_ Uptime : 32|16", "SG_ Uptime : 32|8"
        )
    )
    done = generate(tree, "--check")
    assert done.returncode == 1
    assert "gen_argus_dbc.c is out of date: run tools/gen_dbc.py" in done.stderr
    assert generate(tree).returncode == 0
    assert generate(tree, "--check").returncode == 0


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("SG_ Nonce : 48|16@1+", "SG_ Nonce : 55|16@0+", "ArgusHeartbeat.Nonce: must be little-endian"),
        ("SG_ Uptime : 32|16@1+ (1,0)", "SG_ Uptime : 32|16@1+ (0.5,0)", "ArgusHeartbeat.Uptime: must be"),
        ("SG_ Rotation0 : 16|8@1-", "SG_ Rotation0 : 16|7@1-", "a signed signal must have 8, 16 or 32 bits"),
        ("BO_ 512 ArgusCommand: 8", "BO_ 512 ArgusCommand: 9", "only plain 8-byte messages"),
        ("SG_ S08_Injected : 6|1", "SG_ S08_Injected : 7|1", "share a C type, but not their layout"),
        ("BO_ 1280 ArgusHeartbeat: 8 ARGUS", "BO_ 1280 ArgusHeartbeat 8 ARGUS", "tools/argus.dbc: "),
    ],
)
def test_what_cannot_be_generated_is_refused(tree: Path, old: str, new: str, expected: str) -> None:
    text = (tree / DBC).read_text()
    assert old in text
    (tree / DBC).write_text(text.replace(old, new))
    done = generate(tree)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert expected in done.stderr


def test_a_missing_file_is_one_line(tmp_path: Path) -> None:
    done = generate(tmp_path)
    assert done.returncode == 2
    assert done.stderr == "gen_dbc: tools/argus.dbc: no such file; restore it from version control\n"


def struct_of(message: Message) -> type[ctypes.Structure]:
    """Return the C struct that the header declares for a message, by its own text."""
    kind = gen_dbc.struct_name(message)
    text = (ROOT / HEADER).read_text()
    body = text[: text.index(f"}} {kind};")].rsplit("typedef struct {", 1)[1]
    fields: list[tuple[str, Any]] = []
    for line in body.strip().splitlines():
        c_type, name = line.split(";")[0].split()
        base: Any = TYPES[c_type]
        if "[" in name:
            name, size = name.rstrip("]").split("[")
            base = base * int(size)
        fields.append((name, base))
    return type(kind, (ctypes.Structure,), {"_fields_": fields})


def put(struct: ctypes.Structure, name: str, index: int | None, value: int) -> None:
    if index is None:
        setattr(struct, name, value)
    else:
        getattr(struct, name)[index] = value


def get(struct: ctypes.Structure, name: str, index: int | None) -> int:
    value = getattr(struct, name)
    return int(value if index is None else value[index])


def samples(message: Message, generator: random.Random) -> dict[str, int]:
    """Return a value for each signal; the ends of its range come often."""
    values = {}
    for signal in message.signals:
        low, high = int(signal.minimum or 0), int(signal.maximum or 0)
        values[signal.name] = generator.choice([low, high, generator.randint(low, high)])
    return values


def test_packing_is_that_of_cantools(database: Database, library: ctypes.CDLL) -> None:
    generator = random.Random(SEED)
    sent = [message for message in database.messages if message.senders == ["ARGUS"]]
    assert len(sent) == 15
    for message in sent:
        struct = struct_of(message)()
        pack = getattr(library, gen_dbc.struct_name(message).removesuffix("_t") + "_pack")
        for _ in range(200):
            values = samples(message, generator)
            for signal, name, index in gen_dbc.members(message):
                put(struct, name, index, values[signal.name])
            data = ctypes.create_string_buffer(8)
            pack(data, ctypes.byref(struct))
            assert data.raw == database.encode_message(message.name, values), (SEED, message.name, values)


def test_unpacking_is_that_of_cantools(database: Database, library: ctypes.CDLL) -> None:
    generator = random.Random(SEED)
    message = database.get_message_by_name("ArgusCommand")
    struct = struct_of(message)()
    for _ in range(500):
        data = generator.randbytes(8)
        library.hal_dbc_command_unpack(ctypes.byref(struct), data)
        decoded = database.decode_message(message.frame_id, data, decode_choices=False)
        assert isinstance(decoded, dict)
        for signal, name, index in gen_dbc.members(message):
            assert get(struct, name, index) == decoded[signal.name], (SEED, data.hex())


def test_ids_are_those_of_the_design(database: Database) -> None:
    ids = {message.name: message.frame_id for message in database.messages}
    assert ids["ArgusHeartbeat"] == 0x500
    assert sorted(ids.values()) == [0x080, 0x200, *range(0x500, 0x50E)]
    assert [ids["ArgusEmergency"], ids["ArgusCommand"], ids["ArgusPlan"]] == [0x080, 0x200, 0x507]


@pytest.mark.parametrize("robot", range(8))
def test_every_robot_has_ids_of_its_own(robot: int) -> None:
    loaded = cantools.database.load_string(
        generate(ROOT, "--robot", str(robot)).stdout, database_format="dbc"
    )
    assert isinstance(loaded, Database)
    ids = sorted(message.frame_id for message in loaded.messages)
    assert ids == [0x080 + robot, 0x200 + robot, *range(0x500 + 16 * robot, 0x50E + 16 * robot)]
    names = {message.name for message in loaded.messages}
    assert (f"Argus{robot}Heartbeat" if robot else "ArgusHeartbeat") in names
    heartbeat = loaded.get_message_by_frame_id(0x500 + 16 * robot)
    assert heartbeat.get_signal_by_name("Mode").choices
    assert heartbeat.comment


def test_every_signal_that_people_read_is_described(database: Database) -> None:
    for message in database.messages:
        assert message.comment, message.name
        assert message.receivers
    by_name = {m.name: m for m in database.messages}
    for signal in (
        by_name["ArgusHeartbeat"].signals
        + by_name["ArgusEmergency"].signals
        + by_name["ArgusCommand"].signals
    ):
        assert signal.comment, signal.name
    for name in ("ArgusReadings00", "ArgusReadings12"):
        units = [signal.unit for signal in by_name[name].signals if signal.name.endswith("Range")]
        assert units == ["mm"] * 4


def constants() -> dict[str, int]:
    """Return the times and limits that the C code keeps."""
    text = (ROOT / "hal/include/hal/can_telemetry.h").read_text()
    return {name: int(value) for name, value in re.findall(r"#define HAL_TELEMETRY_(\w+) (\d+)u", text)}


def test_times_in_the_comments_are_those_of_the_code(database: Database) -> None:
    has = constants()
    assert {m.cycle_time for m in database.messages if m.frame_id >= 0x500} == {has["PERIOD_MS"]} == {1000}
    said = {message.name: str(message.comment) for message in database.messages}
    assert f"on a change, at most each {has['CHANGE_MS']} ms" in said["ArgusHealthFront"]
    assert f"on a change, at most each {has['CHANGE_MS']} ms" in said["ArgusPlan"]
    readings = f"at most each {has['READING_MS']} ms; {has['ALL_MS']} ms with a server that lists all"
    assert readings in said["ArgusReadings00"]
    assert f"({has['EDGE_BURST']} in a row, then one each {has['EDGE_MS']} ms)" in said["ArgusEmergency"]
    assert f"at most {has['NONCE_MS'] // 1000} s old" in said["ArgusCommand"]


def worst_bits(length: int) -> int:
    """Return the most bits a classic frame takes, a stuffed bit after each four and the spacing included."""
    return 47 + 8 * length + (34 + 8 * length - 1) // 4


def isotp_frames(size: int) -> int:
    """Return how many frames carry a PDU, flow control included."""
    return 1 if size <= 7 else 2 + math.ceil((size - 6) / 7)


def test_bus_load_in_the_specification_adds_up() -> None:
    has = constants()
    spec = (ROOT / "SPEC.md").read_text().split("### Bus load")[1]
    found = re.findall(r"^\| (.*?) \| ([\d.,]+) \| ([\d,]+) \| ([\d.]+) % \|$", spec, re.MULTILINE)
    rows = {what.split(":")[0].split(",")[0].strip("*"): float(rate) for what, rate, _, _ in found}
    for what, rate, bits, share in found:
        assert int(bits.replace(",", "")) == pytest.approx(float(rate) * worst_bits(8), abs=8), what
        assert float(share) == pytest.approx(float(rate) * worst_bits(8) / 5000, abs=0.006), what
    wanted = {
        "SIP of 6 readings": 10 * isotp_frames(55),
        "a command of 9 bytes (MOVE) per SIP": 10 * isotp_frames(9),
        "readings": 4 * 1000 / has["READING_MS"],
        "health": 2 * 1000 / has["CHANGE_MS"],
        "plan": 1000 / has["CHANGE_MS"],
        "emergency": 1000 / has["EDGE_MS"],
        "heartbeat": 2,
    }
    for what, rate in wanted.items():
        assert rows[what] == pytest.approx(rate, abs=0.05), what
    parts = list(wanted)
    assert rows["ARCOS"] == pytest.approx(sum(rows[what] for what in parts[:2]))
    assert rows["telemetry"] == pytest.approx(sum(rows[what] for what in parts[2:]))
    assert rows["all"] == pytest.approx(rows["ARCOS"] + rows["telemetry"])
    assert rows["telemetry"] * worst_bits(8) < 0.02 * 500_000
    assert rows["all"] * worst_bits(8) < 0.06 * 500_000
    all_sixteen = 10 * (isotp_frames(85) + isotp_frames(9))
    slower = rows["telemetry"] - rows["readings"] + 4 * 1000 / has["ALL_MS"]
    assert f"{all_sixteen * worst_bits(8):,} bit/s for ARCOS" in spec
    assert f"{(all_sixteen + slower) * worst_bits(8):,.0f} bit/s" in spec
    assert (all_sixteen + slower) * worst_bits(8) < 0.06 * 500_000
    upper = (
        sum(wanted[what] for what in parts[2:]) + 4 * 1000 / has["READING_MS"] + 2 * 1000 / has["CHANGE_MS"]
    )
    assert f"{upper * worst_bits(8):,.0f} bit/s or {upper * worst_bits(8) / 5000:.2f} % of telemetry" in spec


# What argusd writes in its own lines: the same words as in the frames.
WORDS = {
    ("ArgusHeartbeat", "Mode"): "ARGUS_NAME_MODE",
    ("ArgusHeartbeat", "Wait"): "ARGUS_NAME_WAIT",
    ("ArgusHeartbeat", "Mission"): "ARGUS_NAME_MISSION",
    ("ArgusHeartbeat", "Failure"): "ARGUS_NAME_FAILURE",
    ("ArgusHealthFront", "S00_Health"): "ARGUS_NAME_HEALTH",
    ("ArgusHealthFront", "S00_Fault"): "ARGUS_NAME_KIND",
    ("ArgusEmergency", "Level"): "ARGUS_NAME_LEVEL",
    ("ArgusEmergency", "Event"): "ARGUS_NAME_EVENT",
}


@pytest.mark.parametrize(("message", "signal"), WORDS)
def test_words_are_those_of_argusd(database: Database, message: str, signal: str) -> None:
    built = ROOT / "build/release/libargus.so"
    assert built.exists(), "build it: tools/dev build release"
    name_of = ctypes.CDLL(str(built)).argus_name
    name_of.restype = ctypes.c_char_p
    tables = {
        name: value for value, name in gen_dbc.enum_values("include/argus/argus.h", "argus_name_of_t").items()
    }
    table = tables[WORDS[message, signal]]
    choices = database.get_message_by_name(message).get_signal_by_name(signal).choices
    assert choices
    for value, word in choices.items():
        assert (name_of(table, value).decode() or "none") == str(word)  # argusd leaves no fault empty
