# SPDX-License-Identifier: MIT
"""Rule: sessions, commands and SIPs behave as the protocol reference says of a P3-DX, whatever arrives."""

from __future__ import annotations

import itertools
import random

import pytest
from doubles import FakeRing, Session, cmd, make_robot, sips

from hil_sim.arcos import (
    COMMAND,
    Command,
    ConfigPac,
    EncoderPac,
    IoPac,
    SimStat,
    Sip,
    SyncEcho,
    SyncReply,
    frame,
)
from hil_sim.server.server import ArcosServer, State

IDENTITY = SyncReply(b"P3DX_0001", b"Pioneer", b"p3dx-sh")


def is_open(server: ArcosServer) -> bool:
    return server.state is State.CONNECTED


def new(connect: bool = False) -> tuple[Session, ArcosServer]:
    server = ArcosServer(make_robot())
    session = Session(server)
    if connect:
        session.connect()
    return session, server


def test_handshake_step_by_step() -> None:
    session, server = new()
    assert session.run(1000, keep_alive=False) == []
    assert session.send(cmd("PULSE")) == [SyncEcho(0)]
    assert session.send(cmd("OPEN")) == [SyncEcho(1)]
    assert session.send(cmd("CLOSE")) == [IDENTITY]
    assert server.state is State.SYNCED
    assert session.run(1000, keep_alive=False) == []
    session.send(cmd("OPEN", 1))
    assert is_open(server)


def test_three_syncs_and_open_in_one_write() -> None:
    session, server = new()
    assert session.send(cmd("PULSE"), cmd("OPEN"), cmd("CLOSE"), cmd("OPEN")) == [
        SyncEcho(0),
        SyncEcho(1),
        IDENTITY,
    ]
    assert is_open(server)


def test_repeated_syncs_are_echoed_again() -> None:
    session, _ = new()
    assert session.send(cmd("PULSE"), cmd("PULSE")) == [SyncEcho(0)] * 2
    assert session.send(cmd("OPEN"), cmd("OPEN")) == [SyncEcho(1)] * 2
    assert session.send(cmd("CLOSE"), cmd("CLOSE")) == [IDENTITY] * 2
    assert session.send(cmd("PULSE")) == [SyncEcho(0)]


@pytest.mark.parametrize(
    "order", [["OPEN"], ["CLOSE"], ["PULSE", "CLOSE"], ["VEL"], ["PULSE", "CLOSE", "OPEN"]]
)
def test_wrong_order_is_ignored_and_starts_over(order: list[str]) -> None:
    session, server = new()
    answers = session.send(*(cmd(name) for name in order))
    assert answers == [SyncEcho(0)] * order.count("PULSE")
    assert server.state is State.WAIT
    session.connect()
    assert is_open(server)


def test_junk_and_bad_checksums_are_skipped() -> None:
    session, server = new()
    assert session.send(b"WMS2\r", cmd("PULSE")) == [SyncEcho(0)]
    bad = bytearray(cmd("OPEN"))
    bad[-1] ^= 1
    assert session.send(bytes(bad)) == []
    assert session.send(b"\xfa", cmd("OPEN"), b"\xfb\xfa") == [SyncEcho(1)]
    assert session.send(cmd("CLOSE")) == [IDENTITY]
    assert server.unframer.counters.bad_checksum == 1


def test_a_command_split_byte_by_byte_is_heard() -> None:
    session, server = new(connect=True)
    for byte in cmd("SETV", 123):
        session.send(bytes((byte,)))
        session.now_ms += 1
    assert server.robot.drive.settings.v_max == 123


def test_a_sip_each_100_ms_with_only_new_readings() -> None:
    session, _ = new(connect=True)
    times = []
    for _ in range(100):
        if sips(session.run(10)):
            times.append(session.now_ms)
    assert [b - a for a, b in itertools.pairwise(times)] == [100] * (len(times) - 1)
    counts = {len(packet.sonars) for packet in sips(session.packets)[1:]}
    assert counts == {4, 6}


def test_session_start_state() -> None:
    session, server = new()
    server.robot.chassis.odo_x = 500.0
    session.connect(enable=False)
    first = sips(session.run(150))[0]
    assert (first.type, first.x, first.y, first.th, first.flags) == (0x32, 0, 0, 0, 0x0006)
    session.send(cmd("ENABLE", 1))
    assert sips(session.run(150))[-1].flags == 0x0007


@pytest.mark.parametrize("argument", [None, 1])
def test_close_ends_everything(argument: int | None) -> None:
    session, server = new(connect=True)
    robot = server.robot
    session.send(
        cmd("SETV", 200), cmd("SETA", 900), cmd("SONAR_CYCLE", 20), cmd("HOSTBAUD", 2), cmd("ENCODER", 2)
    )
    session.send(cmd("BUMPSTALL", 0), cmd("VEL", 200))
    session.run(1000)
    assert server.baud == 38400
    assert robot.drive.v == 200
    session.send(cmd("CLOSE", argument))
    assert session.run(2000, keep_alive=False) == []
    assert server.state is State.WAIT
    assert server.baud == 9600
    assert robot.drive.v == 0
    assert not robot.drive.motors
    assert not robot.sonar_on
    assert robot.drive.settings.v_max == 750
    assert robot.drive.settings.accel == 300
    assert robot.drive.settings.bumpstall == 3
    assert isinstance(robot.ring, FakeRing)
    assert robot.ring.cycle_ms == 40
    session.connect()
    assert not [packet for packet in session.run(500) if isinstance(packet, EncoderPac)]


def test_reset_is_a_power_cycle() -> None:
    session, server = new(connect=True)
    session.send(cmd("SETV", 200), cmd("RESET"))
    assert server.state is State.WAIT
    assert server.robot.drive.settings.v_max == 750


def test_syncs_while_connected_are_pulse_and_open() -> None:
    session, server = new(connect=True)
    assert session.send(cmd("PULSE")) == []
    assert session.send(cmd("OPEN")) == []
    assert is_open(server)
    session.send(cmd("CLOSE"))
    assert session.send(cmd("PULSE")) == [SyncEcho(0)]


def test_sips_go_on_after_the_watchdog() -> None:
    session, server = new(connect=True)
    session.send(cmd("VEL", 200))
    got = sips(session.run(10_000, keep_alive=False))
    assert len(got) == 100
    assert server.robot.drive.v == 0
    assert got[-1].type == 0x32
    session.send(cmd("PULSE"))
    session.run(2000)
    assert server.robot.drive.v == 200


def test_any_packet_even_an_unknown_one_feeds_the_watchdog() -> None:
    session, server = new(connect=True)
    session.send(cmd("VEL", 200))
    for number in (199, 62, 15, 255, 14, 46):
        session.run(1900, keep_alive=False)
        session.send(frame(bytes((number,))))
    assert server.robot.drive.v == 200


def test_config_shows_what_was_set() -> None:
    session, server = new(connect=True)
    packet = session.send(cmd("CONFIG", 1))[0]
    assert isinstance(packet, ConfigPac)
    assert (packet.front_bumps, packet.trans_vel_max, packet.trans_vel_top) == (5, 750, 1500)
    session.send(cmd("SETV", 200), cmd("SETRA", -50), cmd("TICKSMM", 131), cmd("DRIFTFACTOR", -3))
    packet = session.send(cmd("CONFIG"))[0]
    assert isinstance(packet, ConfigPac)
    assert (packet.trans_vel_max, packet.rot_decel, packet.ticks_mm, packet.drift_factor) == (
        200,
        50,
        131,
        -3,
    )
    assert is_open(server)


def test_requests_once_streamed_and_stopped() -> None:
    session, _ = new(connect=True)
    for name, kind in (("ENCODER", EncoderPac), ("IOREQUEST", IoPac), ("SIM_STAT", SimStat)):
        assert [type(packet) for packet in session.send(cmd(name, 1))] == [kind]
        session.send(cmd(name, 2))
        got = session.run(500)
        assert [type(packet) for packet in got if not isinstance(packet, Sip)] == [kind] * 5
        assert isinstance(got[0], Sip)
        session.send(cmd(name, 0))
        assert len(sips(session.run(500))) == len(session.packets[-5:])


def test_sonar_argument_is_a_bit_field() -> None:
    session, server = new(connect=True)
    for argument, flags in ((0, 0), (1, 6), (2, 4), (4, 0), (3, 2), (5, 6), (7, 6), (0, 0), (9, 0), (-1, 6)):
        session.send(cmd("SONAR", argument))
        packet = sips(session.run(200))[-1]
        assert packet.flags & 0x1E == flags, f"SONAR {argument}"
        assert {number // 8 for number, _ in packet.sonars} == {k for k in (0, 1) if flags >> 1 & 1 << k}
    assert server.robot.ring.enabled[2:] == [False, False]


def test_polling_and_cycle_reach_the_ring() -> None:
    session, server = new(connect=True)
    ring = server.robot.ring
    assert isinstance(ring, FakeRing)
    session.send(frame(Command.string(COMMAND["POLLING"], b"\x02\x04\x02").data))
    session.send(frame(Command.string(COMMAND["POLLING"], b"", nul=True).data))
    assert ring.polled == [[2, 4, 2], []]
    for value, cycle in ((20, 20), (1, 20), (121, 20), (2, 2), (120, 120)):
        session.send(cmd("SONAR_CYCLE", value))
        assert ring.cycle_ms == cycle


def test_motion_commands_reach_the_robot() -> None:
    session, server = new(connect=True)
    session.send(cmd("SETV", 300), cmd("SETRV", 50), cmd("MOVE", 250), cmd("HEAD", 30))
    session.run(4000)
    assert server.robot.chassis.odo_th == pytest.approx(30)
    session.send(frame(Command.pair(COMMAND["VEL2"], -5, 3).data))
    session.run(2000)
    packet = sips(session.packets)[-1]
    assert (packet.left_vel, packet.right_vel) == (-100, 60)
    session.send(cmd("STOP"))
    session.run(3000)
    assert sips(session.packets)[-1].type == 0x32
    session.send(cmd("ROTATE", -20))
    session.run(1000)
    assert sips(session.packets)[-1].rotvel == -200
    session.send(cmd("E_STOP", 1))
    assert sips(session.run(100))[-1].rotvel == 0


def test_battest_digout_and_adsel_show_in_the_sip() -> None:
    session, _ = new(connect=True)
    session.send(cmd("BATTEST", 105), cmd("DIGOUT", 0x0F05), cmd("ADSEL", 3))
    packet = sips(session.run(100))[-1]
    assert (packet.battery, packet.battery_x10, packet.digout, packet.anport) == (105, 105, 5, 3)
    session.send(cmd("BATTEST", 0))
    assert sips(session.run(100))[-1].battery == 127


def test_simulator_commands_move_the_truth_only() -> None:
    session, server = new(connect=True)
    data = bytes.fromhex("E0 00 E8 03 00 00 30 F8 FF FF 5A 00 00 00")
    session.send(frame(data))
    pose = server.robot.pose
    assert (pose.x_mm, pose.y_mm, pose.heading_deg) == (1000, -2000, 90)
    assert sips(session.run(100))[-1].x == 0
    answer = session.send(cmd("SIM_STAT", 1))[0]
    assert isinstance(answer, SimStat)
    assert (answer.x_mm, answer.y_mm, answer.th_deg) == (1000, -2000, 90)
    session.send(cmd("SIM_RESET"))
    assert server.robot.pose.x_mm == 0
    session.send(frame(data[:5]))
    assert server.robot.pose.x_mm == 0


def test_no_bytes_break_the_server() -> None:
    for seed in range(30):
        rng = random.Random(seed)
        session, server = new(connect=bool(seed % 2))
        for _ in range(200):
            kind = rng.randrange(3)
            if kind == 0:
                session.send(rng.randbytes(rng.randrange(1, 300)))
            else:
                number = rng.choice([n for n in range(256) if n not in (COMMAND["CLOSE"], COMMAND["RESET"])])
                session.send(frame(bytes((number,)) + rng.randbytes(rng.randrange(0, 40 * kind))))
            session.run(rng.choice((0, 10, 130)))
        session.run(3000, keep_alive=False)
        session.packets.clear()
        session.send(cmd("PULSE"), cmd("CLOSE", 1), cmd("PULSE"))
        session.connect()
        assert is_open(server), f"seed {seed}"
        assert len(sips(session.run(1000))) == 10, f"seed {seed}"
