# SPDX-License-Identifier: MIT
"""Rule: a client cannot tell a replayed log from a robot: handshake, CONFIG, and every packet at its time."""

from __future__ import annotations

import itertools
import os
import select
import socket
import termios
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from argus_tools.chunks import Chunk
from argus_tools.formats import open_log
from argus_tools.log.cli import main
from argus_tools.log.packets import Row, packets
from argus_tools.log.replay import Identity, Player, again
from bags import Drive, cloud, odometry, write
from forks import Forked
from logs import start

from hil_sim.arcos import COMMAND, ConfigPac, Sip, SyncEcho, SyncReply, Unframer, decode, frame

ROOT = Path(__file__).resolve().parents[3]
CAPTURE = ROOT / "tests/data/captures/m_p3dx.jsonl"
PATIENCE_S = 600.0


def rows(path: Path = CAPTURE) -> Iterator[Row]:
    return packets(open_log(str(path)))


def played(path: Path = CAPTURE) -> list[Row]:
    """What the robot of a log sends by itself."""
    answers = ("SYNC0", "SYNC1", "SYNC2", "CONFIGPAC")
    return [row for row in rows(path) if row.dir == "r2c" and row.type not in answers]


class Client:
    """Talks to a player in virtual time."""

    def __init__(self, player: Player) -> None:
        self.player = player
        self.now_ms = 0.0
        self.heard = Unframer()

    def send(self, *numbers: int) -> list[bytes]:
        for number in numbers:
            self.player.receive(frame(bytes((number,))), self.now_ms)
        return self.listen()

    def listen(self) -> list[bytes]:
        self.player.advance(self.now_ms)
        return [data for wire in self.player.outgoing() for data in self.heard.feed(wire)]

    def connect(self) -> SyncReply:
        first, second, third = self.send(0, 1, 2)
        assert (first, second) == (b"\0", b"\1")
        assert self.send(1) == []
        return SyncReply.decode(third)


def player(speed: float = 1.0, is_stepped: bool = False) -> Player:
    return Player(Identity(rows(), None), rows, speed, is_stepped)


def test_handshake_and_config_are_those_of_the_log() -> None:
    client = Client(player())
    logged = next(SyncReply.decode(row.data) for row in rows() if row.type == "SYNC2" and row.dir == "r2c")
    assert client.connect() == logged
    assert client.player.is_open
    assert client.send(COMMAND["PULSE"]) == []
    config = [data for data in client.send(COMMAND["CONFIG"]) if data[0] == 0x20]
    assert len(config) == 1
    assert ConfigPac.decode(config[0]).subtype == logged.subclass


@pytest.mark.parametrize("odd", [SyncEcho(2).data, b"\x02name without an end"])
def test_a_sync2_that_is_damaged_or_echoed_is_not_the_identity(odd: bytes) -> None:
    reply = SyncReply(b"name", b"Pioneer", b"p3at-sh")
    stream = b"".join(map(frame, (odd, reply.data, odd)))
    identity = Identity(packets([Chunk(0.0, "r2c", stream, 0)]), None)
    assert identity.reply == reply


def test_out_of_order_is_not_answered() -> None:
    client = Client(player())
    assert client.send(2, 1, COMMAND["CONFIG"]) == []
    assert client.send(0, 2) == [b"\0"]
    assert not client.player.is_open


@pytest.mark.parametrize("speed", [1.0, 10.0])
def test_every_packet_comes_at_its_time(speed: float) -> None:
    client = Client(player(speed))
    client.connect()
    want = played()
    got: list[tuple[float, bytes]] = []
    while not client.player.is_over:
        got += [(client.now_ms, data) for data in client.listen()]
        client.now_ms += 1.0
    assert [data for _, data in got] == [row.data for row in want]
    first = want[0].t
    for (at_ms, _), row in zip(got, want, strict=True):
        assert row.t is not None
        assert first is not None
        assert at_ms == pytest.approx((100 + (row.t - first) * 1000) / speed, abs=1.5), row


def test_steps() -> None:
    client = Client(player(is_stepped=True))
    client.connect()
    client.now_ms += 1e6
    assert client.listen() == []
    for count in (1, 1, 5):
        client.player.release(count)
        sips = [data for data in client.listen() if isinstance(decode(data), Sip)]
        assert len(sips) == count
    assert client.listen() == []


def test_a_loop_goes_on_at_the_same_pace() -> None:
    want = played()
    client = Client(Player(Identity(rows(), None), lambda: again(rows)))
    client.connect()
    got: list[float] = []
    while len(got) < 2 * len(want) + 5:
        got += [client.now_ms] * len(client.listen())
        client.now_ms += 1.0
    assert not client.player.is_over
    gaps = [later - earlier for earlier, later in itertools.pairwise(got)]
    assert max(gaps[: len(want) - 1]) == pytest.approx(max(gaps[len(want) : 2 * len(want) - 1]), abs=2)
    assert got[len(want)] - got[0] > 1000


def test_each_session_begins_anew() -> None:
    client = Client(player())
    firsts = []
    for _ in range(2):
        client.connect()
        client.now_ms += 500
        firsts.append(client.listen()[:3])
        assert len(firsts[-1]) == 3
        client.send(COMMAND["CLOSE"])
        client.now_ms += 500
        assert client.listen() == []
    assert firsts[0] == firsts[1]


def test_a_log_without_times_is_a_sip_each_cycle() -> None:
    def untimed() -> Iterator[Row]:
        return packets(Chunk(None, chunk.dir, chunk.data, chunk.offset) for chunk in open_log(str(CAPTURE)))

    client = Client(Player(Identity(untimed(), None), untimed))
    client.connect()
    client.now_ms += 1000.5
    sips = [data for data in client.listen() if isinstance(decode(data), Sip)]
    assert len(sips) == 10


def test_damage_is_played_as_it_was(tmp_path: Path) -> None:
    path = ROOT / "tests/data/captures/p10_badck.jsonl"
    it = Player(Identity(rows(path), None), lambda: rows(path), 1000.0)
    client = Client(it)
    client.connect()
    client.now_ms += 1e6
    it.advance(client.now_ms)
    assert b"".join(it.outgoing()) == b"".join(row.wire for row in played(path))


def test_a_bag_is_played_as_the_sips_of_its_robot(tmp_path: Path) -> None:
    drive = Drive(seconds=5.0)
    sent = [
        one
        for t, place, heading, ranges in drive.steps
        for one in (odometry(t, place, heading), cloud(t, ranges))
    ]
    path = write(tmp_path / "drive.bag", sent)
    client = Client(Player(Identity(rows(path), None), lambda: rows(path), 1.0, False))
    assert client.connect().subclass == b"p3dx-sh"
    heard = []
    while not client.player.is_over:
        client.now_ms += 10
        heard += client.listen()
    assert heard == [row.data for row in played(path)]
    assert len(heard) >= 45
    read = {sonar: mm for data in heard for sonar, mm in Sip.decode(data).sonars}
    assert set(read) == set(range(8))
    assert all(abs(read[k] - drive.steps[-1][3][k]) <= 60 for k in read), "the last reading of each"


def replaying(*arguments: str) -> Forked:
    return start("replay", CAPTURE, *arguments)


def address(process: Forked) -> str:
    assert process.stdout is not None
    assert select.select([process.stdout], [], [], PATIENCE_S)[0]
    return process.stdout.readline().decode().strip()


def hear(fd: int, heard: Unframer, count: int) -> list[bytes]:
    found: list[bytes] = []
    until = time.monotonic() + PATIENCE_S
    while len(found) < count:
        assert select.select([fd], [], [], max(0.0, until - time.monotonic()))[0], found
        data = os.read(fd, 4096)
        assert data, found
        found += heard.feed(data)
    return found


def converse(fd: int) -> None:
    heard = Unframer()
    for number in range(3):
        os.write(fd, frame(bytes((number,))))
        assert hear(fd, heard, 1)[0][0] == number
    os.write(fd, frame(b"\x01"))
    want = [row.data for row in played()]
    assert hear(fd, heard, len(want)) == want


def test_over_tcp() -> None:
    process = replaying("--tcp", "0", "--speed", "50")
    host, _, port = address(process).rpartition(":")
    with socket.create_connection((host, int(port)), PATIENCE_S) as client:
        converse(client.fileno())
        out, err = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 0, err
    assert b"the session is open" in err
    assert b"the log is over" in err
    assert out == b""


def test_keys_let_sips_through() -> None:
    process = replaying("--tcp", "0", "--step")
    host, _, port = address(process).rpartition(":")
    assert process.stdin is not None
    with socket.create_connection((host, int(port)), PATIENCE_S) as client:
        heard = Unframer()
        for number in range(3):
            client.sendall(frame(bytes((number,))))
            hear(client.fileno(), heard, 1)
        client.sendall(frame(b"\x01"))
        assert not select.select([client], [], [], 0.5)[0]
        process.stdin.write(b"\n2\n")
        process.stdin.flush()
        want = [row.data for row in played() if row.type == "SIP"]
        assert hear(client.fileno(), heard, 3) == want[:3]
        assert not select.select([client], [], [], 0.5)[0]
        _, err = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 0
    assert b"ended: 3 packets, 3 SIPs" in err


def test_over_a_pty_and_its_name_is_removed(tmp_path: Path) -> None:
    name = tmp_path / "robot"
    process = replaying("--link-name", str(name), "--baud", "115200", "--speed", "2")
    assert address(process).startswith("/dev/")
    fd = os.open(name, os.O_RDWR | os.O_NOCTTY)
    settings = termios.tcgetattr(fd)
    assert settings[5] == termios.B115200
    converse(fd)
    _, err = process.communicate(timeout=PATIENCE_S)
    os.close(fd)
    assert process.returncode == 0, err
    assert not name.is_symlink()


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["-"], "give a file, not standard input"),
        (["/no/such/file"], "cannot be opened"),
        ([str(CAPTURE), "--tcp", "0", "--baud", "9600"], "leave them out with --tcp"),
    ],
)
def test_refusals(arguments: list[str], part: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["replay", *arguments]) == 2
    error = capsys.readouterr().err
    assert part in error
    assert error.count("\n") == 1
