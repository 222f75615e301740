# SPDX-License-Identifier: MIT
"""Rule: with `--quirks mobilesim` the answers are those recorded from the vendor's emulator."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import pytest
from doubles import Session, cmd, make_robot, sips

from hil_sim.arcos import (
    COMMAND,
    Command,
    ConfigPac,
    Packet,
    Sip,
    SyncEcho,
    SyncReply,
    Unframer,
    decode,
    frame,
)
from hil_sim.links.loop import Loop
from hil_sim.links.tcp import TcpLink
from hil_sim.server.mobilesim import OBEYED, MobileSimServer
from hil_sim.server.server import State

CAPTURES = Path(__file__).parents[1] / "data/captures"


def recorded(name: str, direction: str) -> list[bytes]:
    """The data of all packets of one direction of a recorded session."""
    unframer, found = Unframer(), []
    for line in (CAPTURES / f"{name}.jsonl").read_text().splitlines():
        record = json.loads(line)
        if record["dir"] == direction:
            found += unframer.feed(bytes.fromhex(record["hex"]), record["t"] * 1000)
    return found


def new(subclass: str = "p3dx") -> tuple[Session, MobileSimServer]:
    server = MobileSimServer(make_robot(bumpers=0), name="MobileSim", subclass=subclass)
    return Session(server), server


def connected(subclass: str = "p3dx-sh") -> tuple[Session, MobileSimServer]:
    session, server = new(subclass)
    session.connect()
    return session, server


def test_the_same_requests_get_the_same_answers_as_recorded() -> None:
    session, _ = new()
    asked = recorded("m_p3dx", "c2r")
    got: list[Packet] = []
    for data in asked:
        got += session.send(frame(data))
        got += session.run(100)
    theirs = [decode(data) for data in recorded("m_p3dx", "r2c")]

    def other(packets: list[Packet]) -> list[Packet]:
        return [packet for packet in packets if not isinstance(packet, Sip)]

    settings = ("rot_vel_max", "trans_vel_max", "rot_acc", "rot_decel", "trans_acc", "trans_decel")
    for mine, their in zip(other(got), other(theirs), strict=True):
        if isinstance(mine, ConfigPac) and isinstance(their, ConfigPac):
            # The speeds there are the model's in its world file.
            mine = dataclasses.replace(mine, **{name: getattr(their, name) for name in settings})
        assert mine == their
    ours, their_sip = sips(got)[-1], sips(theirs)[0]
    differ = {f.name for f in dataclasses.fields(Sip) if getattr(ours, f.name) != getattr(their_sip, f.name)}
    assert differ <= {"sonars", "battery", "battery_x10"}
    assert [number for number, _ in ours.sonars] == [number for number, _ in their_sip.sonars]


@pytest.mark.parametrize(
    "order", [["CLOSE"], ["OPEN", "CLOSE"], ["PULSE", "CLOSE"], ["OPEN", "PULSE", "CLOSE"]]
)
def test_syncs_in_any_order(order: list[str]) -> None:
    session, server = new()
    answers = session.send(*(cmd(name) for name in order))
    assert answers == [
        SyncReply(b"MobileSim", b"Pioneer", b"p3dx") if name == "CLOSE" else SyncEcho(COMMAND[name])
        for name in order
    ]
    assert server.state is State.CONNECTED


def test_sonar_is_on_from_sync2_and_sips_begin_at_open() -> None:
    session, server = new()
    session.send(cmd("CLOSE"))
    assert server.robot.sonar_on
    assert session.run(1000) == []
    session.send(cmd("OPEN"))
    packets = sips(session.run(1000))
    assert len(packets) == 10
    assert all(len(packet.sonars) == 16 and packet.flags & 0x1E == 0x1E for packet in packets)


def test_a_second_sync2_is_a_close_and_closes_the_connection() -> None:
    session, server = connected()
    assert not server.take_hang_up()
    session.send(cmd("CLOSE"))
    assert server.state is State.WAIT
    assert server.take_hang_up()
    assert not server.take_hang_up()


def test_motors_are_on_until_the_first_session_has_ended() -> None:
    session, server = new()
    session.connect(enable=False)
    assert server.robot.drive.motors
    session.send(cmd("CLOSE"))
    session.connect(enable=False)
    assert not server.robot.drive.motors


def test_type_is_always_stationary_and_the_watchdog_only_warns(caplog: pytest.LogCaptureFixture) -> None:
    session, server = connected()
    session.send(cmd("VEL", 200))
    packets = sips(session.run(6000, keep_alive=False))
    assert len(caplog.records) == 1
    assert {packet.type for packet in packets} == {0x32}
    assert server.robot.drive.v == 200


@pytest.mark.parametrize(("argument", "readings"), [(0, 0), (1, 16), (2, 16), (4, 16)])
def test_any_sonar_argument_but_0_is_all_on(argument: int, readings: int) -> None:
    session, _ = connected()
    session.send(cmd("SONAR", argument))
    packet = sips(session.run(100))[-1]
    assert len(packet.sonars) == readings
    assert packet.flags & 0x1E == (0x1E if readings else 0)


def test_what_it_ignores_has_no_effect() -> None:
    session, server = connected()
    for name in set(COMMAND) - set(OBEYED):
        assert session.send(cmd(name, 1)) == [], name
        assert session.send(frame(Command.string(COMMAND[name], b"\x01\x02").data)) == [], name
    assert server.baud == 9600
    assert len(sips(session.run(1000))) == 10


def test_heading_comes_in_whole_degrees_and_seto_may_place() -> None:
    session, _ = connected()
    session.send(frame(bytes((COMMAND["SETO"],)) + bytes.fromhex("3b e803 0cfe 5a00")))
    packet = sips(session.run(100))[-1]
    assert (packet.x, packet.y, packet.th) == (1000, -500 & 0xFFFF, 1024)
    session.send(cmd("SETO"), cmd("DHEAD", 1))
    units = {packet.th for packet in sips(session.run(2000))}
    assert units <= {0, round(4096 / 360)}


def test_a_tcp_connection_is_the_session_and_nobody_listens_meanwhile() -> None:
    import socket

    server = MobileSimServer(make_robot(), name="MobileSim")
    link = TcpLink("127.0.0.1", 0, deaf=True)
    link.open()
    loop = Loop(server, link)
    host, _, port = link.address.rpartition(":")

    def turns(client: socket.socket, *packets: bytes) -> bytes:
        for packet in packets:
            client.sendall(packet)
        heard = b""
        client.settimeout(0.02)
        for _ in range(10):
            loop.turn()
            try:
                heard += client.recv(4096)
            except TimeoutError:
                continue
        return heard

    try:
        for ending in ("CLOSE", None):
            client = socket.create_connection((host, int(port)))
            assert turns(client, cmd("CLOSE")) != b""
            assert server.state.value == "connected"
            with pytest.raises(ConnectionRefusedError):
                socket.create_connection((host, int(port)))
            if ending is None:
                client.close()
                loop.turn()
            else:
                turns(client, cmd(ending))
                assert client.recv(1) == b""
                client.close()
            assert server.state is State.WAIT
            loop.turn()
    finally:
        link.close()
