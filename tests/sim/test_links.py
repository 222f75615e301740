# SPDX-License-Identifier: MIT
"""Rule: bytes cross a link in order, at the wire's pace, lost or garbled only where a real line would lose or
garble them; clients come and go."""

from __future__ import annotations

import contextlib
import os
import random
import socket
import termios
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from doubles import Port, cmd, connect, make_robot, sips

from hil_sim.arcos import Packet, Unframer, decode
from hil_sim.errors import LinkError, SimError
from hil_sim.faults.kinds import LinkFault
from hil_sim.faults.link import LinkFaults
from hil_sim.links.base import Link
from hil_sim.links.loop import IDLE_MS, LATE_MS, Loop
from hil_sim.links.pty import PtyLink
from hil_sim.links.tcp import TcpLink
from hil_sim.links.uart import SerialLink
from hil_sim.links.wire import Wire
from hil_sim.server.server import ArcosServer, State


@contextlib.contextmanager
def served(link: Link, server: ArcosServer, faults: LinkFaults | None = None) -> Iterator[Loop]:
    link.open()
    loop = Loop(server, link, faults)
    done = threading.Event()
    failures: list[BaseException] = []

    def work() -> None:
        try:
            loop.run(done.is_set)
        except BaseException as error:
            failures.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    try:
        yield loop
    finally:
        done.set()
        thread.join()
        link.close()
        if failures:
            raise failures[0]


def new_server() -> ArcosServer:
    return ArcosServer(make_robot())


# ---- virtual time


@pytest.mark.parametrize("baud", [9600, 38400, 115200])
def test_wire_takes_ten_bit_times_a_byte(baud: int) -> None:
    wire = Wire(baud)
    byte_ms = 10_000 / baud
    wire.push(bytes(range(100)), 50.0)
    assert wire.pop(50 + byte_ms * 0.99) == []
    assert wire.pop(50 + byte_ms) == [(b"\0", 0)]
    assert wire.pop(50 + byte_ms * 50.5) == [(bytes(range(1, 50)), 0)]
    assert wire.pop(50 + byte_ms * 99.9)[0][0][-1] == 98
    assert wire.pop(50 + byte_ms * 100) == [(b"\x63", 0)]
    wire.push(b"ab", 50 + byte_ms * 100.5)
    assert wire.pop(50 + byte_ms * 101.4) == []
    assert wire.pop(1e9) == [(b"ab", 0)]


def test_wire_keeps_order_and_rate_over_random_traffic() -> None:
    for seed in range(50):
        rng = random.Random(seed)
        wire, now, sent, got, work_ms = Wire(9600), 0.0, b"", b"", 0.0
        for _ in range(200):
            now += rng.uniform(0, 30)
            data = rng.randbytes(rng.choice((0, 1, 5, 60)))
            work_ms = max(work_ms, now) + len(data) * wire.byte_ms if data else work_ms
            sent += data
            wire.push(data, now, tag=rng.randrange(2))
            got += b"".join(piece for piece, _ in wire.pop(now))
            assert sent.startswith(got), f"seed {seed}"
            assert len(sent) - len(got) == wire.length
            assert (wire.length == 0) == (work_ms <= now + 1e-6), f"seed {seed}"
        assert wire.pop(1e9) is not None
        assert wire.length == 0


def test_link_faults_do_what_they_say() -> None:
    records: list[tuple[bool, str]] = []
    faults = LinkFaults(
        [
            LinkFault("", "cut", 1000, 2000),
            LinkFault("", "delay", 3000, 4000, delay_ms=70),
            LinkFault("", "corrupt", 5000, 6000, direction="to_robot"),
            LinkFault("", "drop", 7000, None, probability=0.5),
        ],
        log=lambda _, fields: records.append((fields["on"], fields["kind"])),
    )
    data = bytes(range(50))

    def through(now_ms: float, direction: str = "to_client") -> list[bytes]:
        faults.update(now_ms)
        faults.push(data, now_ms, direction)
        return faults.pop(now_ms, direction)

    assert through(0) == [data]
    assert through(999) == [data]
    assert through(1000) == []
    assert through(1999, "to_robot") == []
    assert through(2000) == [data]
    assert through(3000) == []
    assert faults.due_ms() == 3070
    assert faults.pop(3069, "to_client") == []
    assert faults.pop(3070, "to_client") == [data]
    assert through(5000) == [data]
    damaged = through(5000, "to_robot")[0]
    assert len(damaged) == 50
    assert sum(a != b for a, b in zip(damaged, data, strict=True)) == 1
    kept = sum(len(through(8000)) for _ in range(1000))
    assert 400 < kept < 600
    assert records == [(True, "cut"), (False, "cut"), (True, "delay"), (False, "delay"), (True, "corrupt"),
                       (False, "corrupt"), (True, "drop")]  # fmt: skip


def test_delayed_data_keeps_its_order_when_the_delay_ends() -> None:
    faults = LinkFaults([LinkFault("", "delay", 0, 100, delay_ms=500)])
    faults.push(b"1", 99, "to_client")
    faults.push(b"2", 101, "to_client")
    assert faults.pop(598, "to_client") == []
    assert faults.pop(600, "to_client") == [b"1", b"2"]


class NoLink(Link):
    """A link without anybody."""

    def __init__(self) -> None:
        self.sent: list[bytes] = []
        self.inbox: list[bytes] = []

    def open(self) -> None:
        pass

    def close(self) -> None:
        pass

    def transmit(self, now_ms: float) -> None:
        pass

    def receive(self, now_ms: float) -> list[bytes]:
        out, self.inbox = self.inbox, []
        return out

    def send(self, packet: bytes, now_ms: float) -> None:
        self.sent.append(packet)

    def readers(self) -> list[object]:
        return []

    @property
    def address(self) -> str:
        return "nowhere"


def test_a_suspended_loop_does_not_make_up_for_lost_time() -> None:
    clock = [5000.0]
    link, server = NoLink(), new_server()
    loop = Loop(server, link, clock_ms=lambda: clock[0])
    link.inbox = [cmd("PULSE"), cmd("OPEN"), cmd("CLOSE"), cmd("OPEN", 1)]
    for _ in range(20):
        clock[0] += 50
        loop.turn()
    link.sent.clear()
    clock[0] += 3_600_000
    loop.turn()
    assert len(link.sent) == 5
    assert loop.skipped_ms == pytest.approx(3_600_000 - 500)
    clock[0] += 100
    loop.turn()
    assert len(link.sent) == 6


@dataclass
class LateLoop:
    """A loop on a clock of the test, with the `late` records it wrote."""

    clock_ms: float = 5000.0
    told: list[tuple[str, float, float]] = field(default_factory=list)

    def __post_init__(self) -> None:
        def log(kind: str, fields: dict[str, Any]) -> None:
            if kind == "late":
                self.told.append((kind, fields["t_s"], fields["late_ms"]))

        server = ArcosServer(make_robot(), log=log)
        self.loop = Loop(server, NoLink(), clock_ms=lambda: self.clock_ms)

    def turn_after(self, ms: float) -> None:
        self.clock_ms += ms
        self.loop.turn()


def test_a_turn_is_late_by_what_it_came_after_its_due_and_told_from_one_sip_on() -> None:
    late = LateLoop()
    late.turn_after(400)
    assert late.loop.late_max_ms == 0, "nothing was due before the first turn"
    late.turn_after(IDLE_MS)
    late.turn_after(IDLE_MS + LATE_MS)
    assert (late.loop.late_turns, late.told) == (0, [])
    assert late.loop.late_max_ms == LATE_MS
    late.turn_after(IDLE_MS + 150)
    late.turn_after(IDLE_MS + 120)
    assert late.loop.late_turns == 2
    assert late.loop.late_max_ms == 150
    assert [ms for _, _, ms in late.told] == [150, 120]
    assert late.told[0][1] == pytest.approx(0.4 + 3 * IDLE_MS / 1000 + 0.1 + 0.15)


def test_a_turn_that_input_brings_forward_is_not_late() -> None:
    late = LateLoop()
    late.turn_after(0)
    for _ in range(200):
        late.turn_after(1)
    assert (late.loop.late_turns, late.loop.late_max_ms) == (0, 0)


def test_a_silence_that_is_taken_out_of_the_robots_time_is_late_in_full() -> None:
    late = LateLoop()
    late.turn_after(0)
    late.turn_after(IDLE_MS + 900)
    assert late.loop.skipped_ms == pytest.approx(IDLE_MS + 900 - 500)
    assert [ms for _, _, ms in late.told] == [900]
    late.turn_after(IDLE_MS)
    assert late.loop.late_turns == 1, "what was skipped was counted once more"


def test_who_was_suspended_on_purpose_was_not_late() -> None:
    late = LateLoop()
    late.turn_after(0)
    for ms in (300, 501, 3_600_000):
        late.loop.resumed()
        late.turn_after(ms)
    assert late.loop.skipped_ms == pytest.approx(1 + 3_600_000 - 500)
    assert (late.loop.late_turns, late.told, late.loop.late_max_ms) == (0, [], 0)
    late.turn_after(IDLE_MS + 500)
    assert late.loop.late_turns == 1


def test_the_loop_sleeps_no_longer_than_the_next_sip() -> None:
    clock = [0.0]
    link, server = NoLink(), new_server()
    loop = Loop(server, link, clock_ms=lambda: clock[0])
    assert loop.turn() == IDLE_MS
    link.inbox = [cmd("PULSE"), cmd("OPEN"), cmd("CLOSE"), cmd("OPEN", 1)]
    loop.turn()
    clock[0] = 50
    assert loop.turn() == IDLE_MS
    clock[0] = 93
    assert loop.turn() == pytest.approx(7)


# ---- real devices


def test_pty_session_at_9600_baud(tmp_path: Path) -> None:
    link, server = PtyLink(9600, str(tmp_path / "robot")), new_server()
    with served(link, server):
        assert os.path.realpath(tmp_path / "robot") == link.address
        port = Port(str(tmp_path / "robot"))
        connect(port)
        port.send(cmd("ENABLE", 1))
        got = sips(port.read(10, 12))
        assert len(got) >= 10
        assert port.unframer.counters.bad_checksum == 0
        assert got[-1].flags == 7
        port.close()
    assert not os.path.lexists(tmp_path / "robot")


def test_pty_garbles_while_the_rates_differ_and_follows_hostbaud() -> None:
    link, server = PtyLink(9600), new_server()
    with served(link, server):
        port = Port(link.address, termios.B38400)
        port.send(cmd("PULSE") * 20)
        assert port.read(0.5) == []
        port.speed(termios.B9600)
        port.read(0.3)
        connect(port)
        assert port.read(5, 2)
        port.send(cmd("HOSTBAUD", 2))
        time.sleep(0.05)
        port.speed(termios.B38400)
        port.read(0.3)
        bad = port.unframer.counters.bad_checksum
        assert len(sips(port.read(5, 5))) == 5
        assert port.unframer.counters.bad_checksum == bad
        assert server.baud == 38400
        port.send(cmd("CLOSE"))
        time.sleep(0.2)
        assert server.state is State.WAIT
        assert server.baud == 9600
        port.close()


def test_pty_survives_clients_that_leave_and_gives_them_nothing_stale() -> None:
    link, server = PtyLink(9600), new_server()
    with served(link, server):
        port = Port(link.address)
        connect(port)
        port.read(5, 2)
        port.close()
        time.sleep(1.0)
        assert not link.present
        assert link.lost_bytes > 100
        opened_at = server.sips
        port = Port(link.address)
        got = sips(port.read(5, 4))
        assert len(got) == 4
        assert server.sips - opened_at <= 6, "a SIP from before the reopening was delivered"
        port.close()


def test_pty_is_not_left_exclusive_by_a_dead_client() -> None:
    import fcntl

    link, server = PtyLink(9600), new_server()
    with served(link, server):
        port = Port(link.address)
        fcntl.ioctl(port.fd, termios.TIOCEXCL)
        connect(port)
        time.sleep(0.4)
        assert int.from_bytes(fcntl.ioctl(port.fd, 0x80045440, b"\0" * 4), "little") == 1
        port.close()
        time.sleep(0.4)
        port = Port(link.address)
        assert int.from_bytes(fcntl.ioctl(port.fd, 0x80045440, b"\0" * 4), "little") == 0
        port.close()


def test_pty_without_reader_neither_blocks_nor_breaks() -> None:
    link, server = PtyLink(115200), ArcosServer(make_robot(), flash_baud=115200)
    with served(link, server):
        port = Port(link.address)
        connect(port)
        time.sleep(1.0)
        before = server.sips
        time.sleep(0.5)
        assert server.sips > before
        port.close()


def test_pty_link_name_replaces_a_symlink_but_nothing_else(tmp_path: Path) -> None:
    name = tmp_path / "robot"
    name.symlink_to("/dev/pts/nowhere")
    link = PtyLink(9600, str(name))
    link.open()
    assert str(name.readlink()) == link.address
    name.unlink()
    name.symlink_to("/dev/null")
    link.close()
    assert str(name.readlink()) == "/dev/null", "a symlink that is no longer ours was removed"
    name.unlink()
    name.write_text("precious")
    link = PtyLink(9600, str(name))
    with pytest.raises(SimError, match="is not a symlink"):
        link.open()
    link.close()
    assert name.read_text() == "precious"


def test_tcp_session_one_client_at_a_time_and_reconnection() -> None:
    link, server = TcpLink("127.0.0.1", 0), new_server()
    link.open()
    host, _, number = link.address.rpartition(":")
    address = (host, int(number))
    link.open = lambda: None  # type: ignore[method-assign]
    with served(link, server):
        client = socket.create_connection(address, timeout=600)
        unframer = Unframer()

        def read(count: int) -> list[Packet]:
            got: list[Packet] = []
            while len(got) < count:
                data = client.recv(4096)
                assert data, "the server hung up"
                got += [decode(item) for item in unframer.feed(data)]
            return got

        for name in ("PULSE", "OPEN", "CLOSE"):
            client.sendall(cmd(name))
            read(1)
        client.sendall(cmd("OPEN", 1))
        assert len(sips(read(3))) >= 3
        second = socket.create_connection(address, timeout=600)
        assert second.recv(10) == b""
        second.close()
        assert sips(read(2))
        client.close()
        time.sleep(0.3)
        client = socket.create_connection(address, timeout=600)
        unframer.clear()
        assert len(sips(read(2))) >= 2
        client.sendall(cmd("CLOSE", 1))
        time.sleep(0.2)
        assert server.state is State.WAIT
        client.close()


def test_a_busy_tcp_port_is_one_clear_line() -> None:
    with socket.create_server(("127.0.0.1", 0)) as busy:
        link = TcpLink("127.0.0.1", busy.getsockname()[1])
        with pytest.raises(LinkError, match="choose another"):
            link.open()


def test_a_cut_link_passes_nothing_and_comes_back() -> None:
    link, server = PtyLink(9600), new_server()
    faults = LinkFaults([LinkFault("", "cut", 1500, 2500)])
    with served(link, server, faults) as loop:
        port = Port(link.address)
        connect(port)
        seen: list[float] = []
        while server.robot.now_ms < 3500 and loop.skipped_ms == 0:
            if port.read(0.5, 1):
                seen.append(server.robot.now_ms)
        port.close()
    assert any(at < 1500 for at in seen)
    assert any(at > 2500 for at in seen)
    assert not [at for at in seen if 1700 < at < 2500]


def test_a_serial_port_is_served_and_follows_hostbaud() -> None:
    master, slave = os.openpty()
    path = os.ttyname(slave)
    link, server = SerialLink(path, 9600), new_server()
    try:
        with served(link, server):
            port = Port.__new__(Port)
            port.fd, port.unframer = master, Unframer()
            connect(port)
            assert len(sips(port.read(5, 3))) >= 3
            assert termios.tcgetattr(slave)[5] == termios.B9600
            port.send(cmd("HOSTBAUD", 4))
            port.read(0.3)
            assert termios.tcgetattr(slave)[5] == termios.B115200
            port.send(cmd("CLOSE"))
            port.read(0.3)
            assert termios.tcgetattr(slave)[5] == termios.B9600
    finally:
        os.close(slave)
        os.close(master)
