# SPDX-License-Identifier: MIT
"""Rule: the numbers and packets that SPEC.md and docs/arcos.md quote are those of the tables and of the code."""

from __future__ import annotations

import doctest
import re
from pathlib import Path

import pytest

from hil_sim.arcos import ARGUMENT, BAUD, COMMAND, FLAG, FRAME, SIP, TIMING, TYPE, Command, Unframer, frame

ROOT = Path(__file__).resolve().parents[2]
SPEC = (ROOT / "SPEC.md").read_text(encoding="utf-8")


def section(title: str) -> str:
    """The text under a heading."""
    found = re.search(rf"^## {title}\n(.*?)(?=^## |\Z)", SPEC, re.M | re.S)
    assert found, f"SPEC.md has no section {title}"
    return found[1]


def rows(title: str) -> list[list[str]]:
    """The cells of every table row under a heading."""
    lines = [line for line in section(title).splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_command_numbers_are_those_of_the_table() -> None:
    quoted: dict[str, int] = {}
    for cells in rows("Commands") + rows("Other packets"):
        if re.fullmatch(r"\d+( \d+)*", cells[0]):
            numbers, names = cells[0].split(), cells[1].split()
            assert len(numbers) == len(names), cells
            quoted |= zip(names, map(int, numbers), strict=True)
    assert len(quoted) >= 20
    assert quoted == {name: COMMAND[name] for name in quoted}


def test_every_command_that_the_firmware_sends_is_in_the_spec() -> None:
    used: set[str] = set()
    for path in sorted((ROOT / "firmware").rglob("*.c")):
        used |= set(re.findall(r"ARCOS_CMD_([A-Z_0-9]+)", path.read_text(encoding="utf-8")))
    listed = re.search(r"We never send these.*?```\n(.*?)```", section("Commands"), re.DOTALL)
    assert listed
    never_sent = set(re.findall(r"([A-Z_0-9]+) \d+", listed[1]))  # known: to a STOP, and to a guard port
    names = {name for cells in rows("Commands") if len(cells) > 1 for name in cells[1].split()}
    assert used - never_sent <= names


def test_packet_types_are_those_of_the_table() -> None:
    of = {
        "ENCODERpac": "ENCODERPAC",
        "IOpac": "IOPAC",
        "GYROpac": "GYROPAC",
        "SIMSTAT": "SIMSTAT",
        "laser log": "LASERLOG",
    }
    found = {cells[1]: cells[0] for cells in rows("Other packets") if cells[0].startswith("0x")}
    for title, name in of.items():
        assert int(found[title], 16) == TYPE[name], title
    assert (
        f"Types 0x{TYPE['SIP_STATIONARY']:02X} (at rest) and 0x{TYPE['SIP_MOVING']:02X} (moving)"
        in section("SIP")
    )
    assert f"Type 0x{TYPE['CONFIGPAC']:02X}," in section("CONFIGpac")


@pytest.mark.parametrize(
    ("field", "names"),
    [
        ("position x, y", ("X", "Y")), ("heading", ("TH",)), ("wheel speeds L, R", ("L_VEL", "R_VEL")),
        ("battery", ("BATTERY",)), ("rear", ("STALL_LEFT",)), ("front", ("STALL_RIGHT",)), ("control", ("CONTROL",)),
        ("flags", ("FLAGS",)), ("compass", ("COMPASS",)), ("n", ("SONAR_COUNT",)), ("type", ("TYPE",)),
    ],
)  # fmt: skip
def test_sip_offsets_are_those_of_the_table(field: str, names: tuple[str, ...]) -> None:
    quoted = next(cells[0] for cells in rows("SIP") if len(cells) > 1 and cells[1] == field)
    assert [int(number) for number in quoted.split(",")] == [SIP[f"OFFSET_{name}"] for name in names]


def test_sip_offsets_behind_the_readings_are_those_of_the_table() -> None:
    quoted = {cells[1]: int(cells[0].split()[0]) for cells in rows("SIP") if cells[0].endswith("+ 3n")}
    names = {"GRIPPER": "gripper, analog port, analog, digital in, digital out", "BATTERYX10": "battery",
             "CHARGESTATE": "charge state", "ROTVEL": "rotation", "FAULTFLAGS": "fault flags"}  # fmt: skip
    for name, field in names.items():
        assert quoted[field] == SIP["OFFSET_SONAR"] + SIP[f"AFTER_SONAR_{name}"], field


def test_flags_are_those_of_the_table() -> None:
    text = next(cells[3] for cells in rows("SIP") if len(cells) > 3 and cells[1] == "flags")
    assert text == "0 motors, 1..4 sonar arrays, 5 stop button, 6 E-stall, 10 charger"
    bits = {
        name: FLAG[name].bit_length() - 1
        for name in ("MOTORS", "SONAR1", "SONAR4", "ESTOP", "ESTALL", "CHARGER")
    }
    assert bits == {"MOTORS": 0, "SONAR1": 1, "SONAR4": 4, "ESTOP": 5, "ESTALL": 6, "CHARGER": 10}


def test_packets_printed_are_good_and_named_rightly() -> None:
    packets = re.findall(r"(\w+) ?(-?\d+)? \(?`((?:[0-9A-F]{2} ?){6,})`", SPEC)
    assert len(packets) >= 6
    for name, value, wire in packets:
        data = Unframer().feed(bytes.fromhex(wire))
        assert len(data) == 1, wire
        number = int(name[-1]) if name.startswith("SYNC") else COMMAND[name]
        command = Command.integer(number, int(value)) if value else Command(number)
        assert frame(command.data) == bytes.fromhex(wire), f"{name} {value}"


def test_the_rules_of_framing_quote_the_table() -> None:
    text = section("Framing")
    assert f"0x{FRAME['HEADER0']:02X}" in text
    assert f"0x{FRAME['HEADER1']:02X}" in text
    assert f"{FRAME['COUNT_MIN']}..{FRAME['COUNT_MAX']}" in text
    assert f"more than\n{FRAME['SEND_TOTAL_MAX']} bytes in a packet" in text
    assert f"less than 0\n     or more than {FRAME['RESYNC_SIP_TAIL_MAX']} bytes" in text
    assert f"COUNT above {FRAME['RESYNC_CONFIG_COUNT_MAX']}, or after {FRAME['RESYNC_QUIET_MS']} ms" in text
    assert f"COUNT above {FRAME['RESYNC_OTHER_COUNT_MAX']}, or after {FRAME['RESYNC_QUIET_MS']} ms" in text
    assert f"at {BAUD['B9600']} baud plus {FRAME['RESYNC_EXTRA_MS']} ms" in text
    forms = [f"{ARGUMENT[name]:02X}" for name in ("POSITIVE", "NEGATIVE", "STRING")]
    for form in forms:
        assert f"`CMD {form} " in section("Commands")
    assert f"{TIMING['SONAR_CYCLE_MIN_MS']}..{TIMING['SONAR_CYCLE_MAX_MS']}" in section("Commands")


def test_the_examples_of_the_python_module_hold() -> None:
    result = doctest.testfile(str(ROOT / "docs/arcos.md"), module_relative=False)
    assert result.attempted >= 15
    assert result.failed == 0
