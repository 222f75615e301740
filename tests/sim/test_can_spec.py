# SPDX-License-Identifier: MIT
"""Rule: a CAN link is written as for argusd, with tx and rx from the robot's end; else one line says what is wrong."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from hil_sim.cli.main import main
from hil_sim.errors import SimError
from hil_sim.links import can_spec
from hil_sim.links.can import PACKET_MAX, is_packet
from hil_sim.links.can_spec import CanSpec, parse_spec

ROOT = Path(__file__).resolve().parents[2]


def test_defaults() -> None:
    spec = parse_spec("can0")
    assert (spec.tx_id, spec.rx_id, spec.pad) == (0x648, 0x640, 0xCC)
    assert (spec.stmin, spec.bs, spec.fd, spec.stack) == (0, 0, False, "auto")


def test_every_key() -> None:
    spec = parse_spec("vcan1,robot=3,tx=0x7FF,rx=5,pad=0x00,stmin=127,bs=255,fd,stack=user")
    assert spec == CanSpec("vcan1", 3, 0x7FF, 5, 0, 127, 255, True, "user")
    assert parse_spec("vcan1,pad=none").pad is None
    assert parse_spec("vcan1,robot=7").tx_id == 0x64F


@pytest.mark.parametrize(
    "text", ["can0", "can0,robot=7", "can0,tx=0x100,rx=0x101", "can0,robot=2,rx=0x20,fd", "can0,fd"]
)
def test_what_is_printed_is_for_the_other_end(text: str) -> None:
    """Read as argusd reads it, its defaults the other way round, it is the same pair of ids."""
    spec = parse_spec(text)
    words = dict(word.partition("=")[::2] for word in spec.for_client.split(",")[1:])
    robot = int(words.get("robot", "0"))
    assert int(words.get("tx", hex(can_spec.TO_ROBOT_ID + robot)), 16) == spec.rx_id
    assert int(words.get("rx", hex(can_spec.TO_HOST_ID + robot)), 16) == spec.tx_id
    assert ("fd" in words) == spec.fd


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "cannot be the name of an interface"),
        ("a/b", "cannot be the name of an interface"),
        ("an-interface-too-long", "cannot be the name of an interface"),
        ("can0,robot=8", "robot=8: give a number from 0 to 7"),
        ("can0,tx=0x800", "tx=0x800: give a number from 0 to 2047"),
        ("can0,rx=", "rx=: give a number"),
        ("can0,pad=256", "pad=256"),
        ("can0,stmin=-1", "stmin=-1: give a number from 0 to 127"),
        ("can0,bs=1e3", "bs=1e3"),
        ("can0,bs=010", "bs=010"),
        ("can0,speed=5", "'speed=5' is no option"),
        ("can0,,fd", "'' is no option"),
        ("can0,stack=mine", "there are auto, kernel, user"),
        ("can0,tx=0x640", "tx and rx are both 0x640"),
    ],
)
def test_wrong_text_is_refused_in_one_line(
    text: str, expected: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SimError, match=re.escape(expected)):
        parse_spec(text)
    with pytest.raises(SystemExit) as ended:
        main(["--can", text])
    assert ended.value.code == 2
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_robots_count_up_to_the_last_number() -> None:
    spec = parse_spec("can0,robot=5,tx=0x10,rx=0x20")
    last = spec.of_robot(2)
    assert (last.robot, last.tx_id, last.rx_id) == (7, 0x12, 0x22)
    with pytest.raises(SimError, match="begin lower"):
        spec.of_robot(3)


def test_options_of_a_pty_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--can", "can0", "--baud", "9600"]) == 2
    assert "leave them out with --can" in capsys.readouterr().err


def test_numbers_are_those_of_argusd() -> None:
    """The defaults are typed in both programs; they must not differ."""
    header = (ROOT / "hal/include/hal/can_spec.h").read_text(encoding="utf-8")
    defined = dict(re.findall(r"#define (HAL_CAN_\w+) (\w+)", header))
    pairs = {
        "HAL_CAN_TO_ROBOT_ID": can_spec.TO_ROBOT_ID,
        "HAL_CAN_TO_HOST_ID": can_spec.TO_HOST_ID,
        "HAL_CAN_PADDING": can_spec.PADDING,
        "HAL_CAN_ID_MAX": can_spec.ID_MAX,
    }
    assert {name: int(defined[name].rstrip("u"), 16) for name in pairs} == pairs
    isotp = (ROOT / "hal/include/hal/isotp.h").read_text(encoding="utf-8")
    assert f"#define HAL_ISOTP_PDU_MAX {PACKET_MAX} " in isotp
    generated = (ROOT / "hal/include/hal/gen_argus_dbc.h").read_text(encoding="utf-8")
    assert re.search(rf"HAL_DBC_ROBOTS {can_spec.ROBOTS_MAX}u?\b", generated)


@pytest.mark.parametrize(
    ("pdu", "expected"),
    [
        (b"\xfa\xfb\x03\x00\x00\x00", True),
        (b"\xfa\xfb\xff" + bytes(255), True),
        (b"\xfa\xfb\x03\x00\x00", False),
        (b"\xfa\xfb\x03\x00\x00\x00\x00", False),
        (b"\xfb\xfa\x03\x00\x00\x00", False),
        (b"\xfa\xfb", False),
        (b"", False),
    ],
)
def test_one_packet_is_one_message(pdu: bytes, expected: bool) -> None:
    assert is_packet(pdu) == expected
