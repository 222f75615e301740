# SPDX-License-Identifier: MIT
"""Rule: each of the 256 command numbers, in each form of argument, has its documented effect and no other."""

from __future__ import annotations

import doctest
import logging
import math
from collections.abc import Callable
from types import ModuleType
from typing import Any

import pytest
from doubles import FakeRing, Session, cmd, make_robot, sips

from hil_sim.arcos import (
    BAUD_OF_CODE,
    COMMAND,
    TIMING,
    TYPE,
    Command,
    ConfigPac,
    EncoderPac,
    IoPac,
    OtherPacket,
    SimStat,
    Sip,
    frame,
)
from hil_sim.conformance import client, sonar_checks
from hil_sim.robot.state import SettingsState
from hil_sim.server import commands
from hil_sim.server.commands import IGNORED, IGNORED_RANGES, NAME, WHY_IGNORED
from hil_sim.server.server import ArcosServer, State
from hil_sim.tables.robot import robot_table

FORMS = {
    "no argument": b"",
    "type only": b"\x3b",
    "one byte missing": b"\x3b\x02",
    "+1": b"\x3b\x01\x00",
    "+2": b"\x3b\x02\x00",
    "+300": b"\x3b\x2c\x01",
    "-45": b"\x1b\x2d\x00",
    "+0": b"\x3b\x00\x00",
    "raw word": b"\x3b\x03\xfb",
    "string": b"\x2b\x03\x01\x02\x03",
    "string and NUL": b"\x2b\x02\x09\x0a\x00",
    "empty string": b"\x2b\x00",
    "string cut": b"\x2b\x08\x01",
    "raw": bytes.fromhex("00e8030000 30f8ffff 5a000000"),
    "long": b"\x00" + bytes(range(180)),
}

MOTION = robot_table().motion

Snapshot = dict[str, Any]


def snapshot(server: ArcosServer) -> Snapshot:
    """All that a command can change, by name."""
    robot, ring = server.robot, server.robot.ring
    assert isinstance(ring, FakeRing)
    now = robot.drive.settings
    limits = {name: getattr(now, name) for name, *_ in SettingsState._fields_}
    settings = {f"set {name}": value for name, value in (limits | vars(now)).items() if name != "config"}
    parts: dict[str, tuple[Any, tuple[str, ...]]] = {
        "robot": (robot, ("anport", "digout", "battery_test_dv")),
        "speeds": (robot.drive, ("v", "w", "motors", "_move_mode", "_head_mode", "_vel2")),
        "set points": (robot.drive, ("_v_set", "_w_set", "_move_left", "_head_left", "_head_set")),
        "odometry": (robot.chassis, ("odo_x", "odo_y", "odo_th")),
    }
    return settings | {
        **{name.strip("_"): getattr(part, name) for part, names in parts.values() for name in names},
        "config": dict(robot.drive.settings.config),
        "pose": (robot.chassis.x, robot.chassis.y, robot.chassis.th),
        "state": server.state,
        "baud": server.baud,
        "arrays": tuple(ring.enabled),
        "cycle": ring.cycle_ms,
        "polled": tuple(map(tuple, ring.polled)),
        "streams": (server._encoders, server._io, server._sim_stat, server._joystick),
        "aux": tuple(port.wanted for port in server._aux.values()),
    }


def nothing(_c: Command, _s: Snapshot) -> Snapshot:
    return {}


def accel(up: str, down: str, top: str) -> Callable[[Command, Snapshot], Snapshot]:
    def effect(c: Command, _s: Snapshot) -> Snapshot:
        limit = min(float(abs(c.value)), float(MOTION[top]))
        return {} if c.value == 0 else {up if c.value > 0 else down: limit}

    return effect


def capped(field: str, top: str) -> Callable[[Command, Snapshot], Snapshot]:
    return lambda c, s: {field: min(float(abs(c.value)), float(MOTION[top]))}


def heading(c: Command, _s: Snapshot) -> Snapshot:
    return {"head_mode": True, "head_left": math.remainder(c.value, 360), "head_set": pytest.approx(c.value)}


def turn(c: Command, _s: Snapshot) -> Snapshot:
    short = math.remainder(c.value, 360)
    return {"head_mode": True, "head_left": short, "head_set": short}


def vel2(c: Command, _s: Snapshot) -> Snapshot:
    left, right = (20 * part for part in c.bytes_pair)
    turn_deg_s = math.degrees((right - left) / MOTION["track_mm"])
    return {"vel2": True, "v_set": (left + right) / 2, "w_set": pytest.approx(turn_deg_s)}


def sonar(c: Command, s: Snapshot) -> Snapshot:
    array, on = abs(c.value) >> 1 & 7, bool(abs(c.value) & 1)
    arrays = list(s["arrays"])
    for k in (0, 1):
        arrays[k] = on if array in (0, k + 1) else arrays[k]
    return {"arrays": tuple(arrays)}


def digout(c: Command, s: Snapshot) -> Snapshot:
    word = c.value & 0xFFFF
    return {"digout": s["digout"] & ~(word >> 8) | word & word >> 8}


def cycle(c: Command, _s: Snapshot) -> Snapshot:
    good = TIMING["SONAR_CYCLE_MIN_MS"] <= c.value <= TIMING["SONAR_CYCLE_MAX_MS"]
    return {"cycle": c.value} if good else {}


def stream(place: int) -> Callable[[Command, Snapshot], Snapshot]:
    return lambda c, s: {"streams": tuple(c.value > 1 if k == place else s["streams"][k] for k in range(4))}


def aux(place: int) -> Callable[[Command, Snapshot], Snapshot]:
    def effect(c: Command, s: Snapshot) -> Snapshot:
        wanted = c.value if 0 <= c.value <= 200 else s["aux"][place]
        return {"aux": tuple(wanted if k == place else s["aux"][k] for k in range(3))}

    return effect


def parameter(field: str) -> Callable[[Command, Snapshot], Snapshot]:
    return lambda c, s: {"config": {field: c.value & 0xFFFF}}


def aux_baud(field: str) -> Callable[[Command, Snapshot], Snapshot]:
    return lambda c, s: {"config": {field: c.value}} if c.value in BAUD_OF_CODE else {}


def set_pose(c: Command, s: Snapshot) -> Snapshot:
    raw = c.argument
    if len(raw) < 13:
        return {}
    pose = tuple(int.from_bytes(raw[k : k + 4], "little", signed=True) for k in (1, 5, 9))
    return {"pose": pytest.approx(pose)}


EFFECT: dict[str, Callable[[Command, Snapshot], Snapshot]] = {
    "PULSE": nothing,
    "OPEN": nothing,
    "POLLING": lambda c, s: {"polled": (tuple(c.text),)},
    "ENABLE": lambda c, s: {"motors": c.value != 0},
    "SETA": accel("set accel", "set decel", "accel_top_mm_s2"),
    "SETV": capped("set v_max", "vel_top_mm_s"),
    "SETO": nothing,
    "MOVE": lambda c, s: {"move_mode": True, "move_left": float(c.value)},
    "ROTATE": lambda c, s: {"w_set": float(c.value)},
    "SETRV": capped("set rv_max", "rotvel_top_deg_s"),
    "VEL": lambda c, s: {"v_set": float(c.value)},
    "HEAD": heading,
    "DHEAD": turn,
    "JOYREQUEST": stream(3),
    "CONFIG": nothing,
    "ENCODER": stream(0),
    "RVEL": lambda c, s: {"w_set": float(c.value)},
    "DCHEAD": heading,
    "SETRA": accel("set raccel", "set rdecel", "rotaccel_top_deg_s2"),
    "SONAR": sonar,
    "STOP": nothing,
    "DIGOUT": digout,
    "VEL2": vel2,
    "ADSEL": lambda c, s: {"anport": c.value & 0xFF},
    "IOREQUEST": stream(1),
    "TTY2": nothing,
    "TTY3": nothing,
    "TTY4": nothing,
    "GETAUX": aux(0),
    "GETAUX2": aux(1),
    "GETAUX3": aux(2),
    "BUMPSTALL": lambda c, s: {"set bumpstall": c.value & 3},
    "JOYDRIVE": lambda c, s: {"set joydrive": c.value != 0},
    "SONAR_CYCLE": cycle,
    "HOSTBAUD": lambda c, s: {"baud": BAUD_OF_CODE.get(c.value, s["baud"])},
    "AUX1BAUD": aux_baud("aux1_baud"),
    "AUX2BAUD": aux_baud("aux2_baud"),
    "AUX3BAUD": aux_baud("aux3_baud"),
    "E_STOP": nothing,
    "E_STALL": lambda c, s: {"set estall": c.value != 0},
    "QSTOP": nothing,
    "ROTKP": parameter("rot_kp"),
    "ROTKV": parameter("rot_kv"),
    "ROTKI": parameter("rot_ki"),
    "TRANSKP": parameter("trans_kp"),
    "TRANSKV": parameter("trans_kv"),
    "TRANSKI": parameter("trans_ki"),
    "REVCOUNT": parameter("rev_count"),
    "DRIFTFACTOR": lambda c, s: {"config": {"drift_factor": c.value}},
    "TICKSMM": parameter("ticks_mm"),
    "SIM_SET_POSE": set_pose,
    "SIM_RESET": nothing,
    "SIM_STAT": stream(2),
    "BATTEST": lambda c, s: {"battery_test_dv": max(0, min(c.value, 255))},
}
ENDS_SESSION = ("CLOSE", "RESET")
ANSWER_ONCE = {"ENCODER": EncoderPac, "IOREQUEST": IoPac, "SIM_STAT": SimStat, "JOYREQUEST": OtherPacket}


def expected_answer(command: Command) -> list[type]:
    name = NAME.get(command.number)
    if name == "CONFIG":
        return [ConfigPac]
    return [ANSWER_ONCE[name]] if name in ANSWER_ONCE and command.value == 1 else []


def test_every_known_command_is_either_obeyed_or_ignored_for_a_reason() -> None:
    server = ArcosServer(make_robot())
    obeyed = {NAME[number] for number in server._handlers}
    limits = {f"{name}_{end}" for name in IGNORED_RANGES for end in ("FIRST", "LAST")}
    assert obeyed == set(EFFECT) | set(ENDS_SESSION)
    assert obeyed.isdisjoint(IGNORED)
    assert obeyed | set(IGNORED) | limits == set(COMMAND)
    assert set(WHY_IGNORED).isdisjoint(server._handlers)


@pytest.mark.tour(64)
@pytest.mark.parametrize("number", range(256))
def test_each_form_of_argument(number: int) -> None:
    name = NAME.get(number, "")
    for form, argument in FORMS.items():
        where = f"command {number} {name}, {form}"
        server = ArcosServer(make_robot())
        session = Session(server)
        session.connect()
        before = snapshot(server)
        command = Command(number, argument)
        answer = session.send(frame(command.data))
        if name in ENDS_SESSION:
            assert server.state is State.WAIT, where
            session.connect()
        else:
            assert snapshot(server) == before | EFFECT.get(name, nothing)(command, before), where
            assert [type(packet) for packet in answer] == expected_answer(command), where
        session.packets.clear()
        assert len(sips(session.run(TIMING["SIP_CYCLE_MS"]))) == 1, where
        # At rest what follows still has its effect.
        session.send(cmd("SETV", 123))
        assert server.robot.drive.settings.v_max == 123, where


def test_commands_that_undo_motion() -> None:
    for name in ("STOP", "E_STOP", "QSTOP"):
        for form, argument in FORMS.items():
            server = ArcosServer(make_robot())
            session = Session(server)
            session.connect()
            session.send(cmd("VEL", 200), cmd("RVEL", 20))
            session.run(1500)
            assert server.robot.drive.v == 200
            session.send(frame(Command(COMMAND[name], argument).data))
            at_once = server.robot.drive.v == 0
            assert at_once == (name != "STOP"), f"{name}, {form}"
            session.run(1000)
            assert server.robot.drive.v == server.robot.drive.w == 0, f"{name}, {form}"
            assert server.robot.drive.motors


@pytest.mark.parametrize("argument", FORMS.values(), ids=list(FORMS))
def test_seto_in_each_form_clears_odometry(argument: bytes) -> None:
    server = ArcosServer(make_robot())
    session = Session(server)
    session.connect()
    session.send(cmd("MOVE", 100))
    session.run(3000)
    assert sips(session.packets)[-1].x == 100
    session.send(frame(Command(COMMAND["SETO"], argument).data))
    assert sips(session.run(100))[-1].x == 0


def test_an_aux_port_gives_what_was_asked_for_once_it_has_come() -> None:
    server = ArcosServer(make_robot())
    session = Session(server)
    session.connect()
    pairs = (("GETAUX", "SERAUXPAC"), ("GETAUX2", "SERAUX2PAC"), ("GETAUX3", "SERAUX3PAC"))
    for port, (name, kind) in enumerate(pairs, 1):
        assert session.send(cmd(name, 4)) == []
        server.aux_receive(port, b"abc")
        assert session.run(50) == []
        server.aux_receive(port, b"def")
        got = session.run(50)
        assert OtherPacket(TYPE[kind], b"abcd") in got
        assert session.send(cmd(name, 2)) == [OtherPacket(TYPE[kind], b"ef")]
        server.aux_receive(port, b"old")
        session.send(cmd(name, 0))
        assert session.send(cmd(name, 1)) == []


def test_a_loopback_plug_returns_what_tty_sends() -> None:
    server = ArcosServer(make_robot(), aux_loopback=True)
    session = Session(server)
    session.connect()
    for out, ask, kind in (("TTY2", "GETAUX", "SERAUXPAC"), ("TTY3", "GETAUX2", "SERAUX2PAC"),
                           ("TTY4", "GETAUX3", "SERAUX3PAC")):  # fmt: skip
        assert session.send(frame(Command.string(COMMAND[out], b"hello", nul=True).data)) == []
        assert session.send(cmd(ask, 5)) == [OtherPacket(TYPE[kind], b"hello")]


def test_joystick_packets_come_just_before_the_sip() -> None:
    server = ArcosServer(make_robot())
    session = Session(server)
    session.connect()
    session.send(cmd("JOYREQUEST", 2))
    kinds = [packet.data[0] for packet in session.run(300)]
    assert kinds == [TYPE["JOYSTICKPAC"], TYPE["SIP_STATIONARY"]] * 3
    session.send(cmd("JOYREQUEST", 0))
    assert all(isinstance(packet, Sip) for packet in session.run(300))


@pytest.mark.parametrize("cycle_ms", [20, 50, 200])
def test_the_sip_cycle_is_the_one_the_configpac_names(cycle_ms: int) -> None:
    server = ArcosServer(make_robot(), sip_cycle_ms=cycle_ms)
    session = Session(server)
    session.connect()
    packet = session.send(cmd("CONFIG"))[0]
    assert isinstance(packet, ConfigPac)
    assert packet.sip_cycle_ms == cycle_ms
    assert len(sips(session.run(2000))) == 2000 // cycle_ms


def test_what_is_obeyed_and_what_is_ignored_is_logged_at_debug_level(
    caplog: pytest.LogCaptureFixture,
) -> None:
    server = ArcosServer(make_robot())
    session = Session(server)
    session.connect()
    with caplog.at_level(logging.INFO, "argus.sim"):
        session.send(cmd("GYRO", 1))
        assert caplog.text == ""
    with caplog.at_level(logging.DEBUG, "argus.sim"):
        session.send(cmd("VEL", -30), cmd("GYRO", 1), frame(b"\xc7"), cmd("ENABLE", 0))
    lines = [record.getMessage().split(" s: ")[1] for record in caplog.records]
    assert lines == [
        "VEL (11) -30",
        "GYRO (58) 1: ignored, no gyro",
        "unknown (199): ignored, no such command",
        "ENABLE (4) 0",
    ]


def test_rear_bumpers_show_in_the_low_byte_and_stall_backwards() -> None:
    robot = make_robot(rear_bumpers=5)
    robot.chassis.contact_rear = 0b000110
    server = ArcosServer(robot)
    session = Session(server)
    session.connect()
    packet = sips(session.run(100))[-1]
    assert (packet.stall_left, packet.stall_right) == (0b000110, 0)
    session.send(cmd("VEL", -100))
    packet = sips(session.run(300))[-1]
    assert packet.left_stalled
    assert robot.drive.v == 0
    session.send(cmd("BUMPSTALL", 1))
    session.run(300)
    assert robot.drive.v < 0
    config = session.send(cmd("CONFIG"))[0]
    assert isinstance(config, ConfigPac)
    assert config.rear_bumps == 5


def test_the_old_subclass_counts_in_its_own_unit() -> None:
    server = ArcosServer(make_robot(), subclass="p3dx")
    session = Session(server)
    session.connect()
    session.send(cmd("MOVE", 485))
    assert sips(session.run(4000))[-1].x == 1000


@pytest.mark.parametrize("module", [commands, sonar_checks, client], ids=lambda module: module.__name__)
def test_examples_in_the_docs_are_true(module: ModuleType) -> None:
    result = doctest.testmod(module)
    assert result.attempted > 0
    assert result.failed == 0
