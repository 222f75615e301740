# SPDX-License-Identifier: MIT
"""Measures what a guard port adds to the way of a SIP and of a command, beside a bare connection."""

from __future__ import annotations

import argparse
import select
import socket
import statistics
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

from hil_sim.arcos import COMMAND, Command, Sip, SyncEcho, SyncReply, Unframer, frame

ROOT: Final = Path(__file__).resolve().parents[2]
SIP_S: Final = 0.1
LIMIT_MS: Final = 1.0
SETTLE_SIPS: Final = 30
LINGER_S: Final = 1.0
"""Until the last ones have arrived."""
_NAME: Final = SyncReply(b"bench", b"Pioneer", b"p3dx-sh")
_SIP: Final = Sip(0x32, 0, 0, 0, 0, 0, 127, 0, 0, 0, 0x1F, 0, ())


@dataclass
class Way:
    """One way of packets: where they leave, where they arrive, and how long each took."""

    source: socket.socket
    sink: socket.socket
    unframer: Unframer = field(default_factory=Unframer)
    left: dict[int, float] = field(default_factory=dict)
    took_ms: list[float] = field(default_factory=list)
    lost: int = 0

    def send(self, number: int, packet: bytes) -> None:
        """Let one leave. Its number comes again after a while; who has it still by then is lost."""
        self.lost += number in self.left
        self.left[number] = time.perf_counter()
        self.source.sendall(packet)

    def arrived(self, number: int) -> None:
        """One has come."""
        if number in self.left:
            self.took_ms.append((time.perf_counter() - self.left.pop(number)) * 1000)


def pair(stack: ExitStack) -> tuple[socket.socket, socket.socket]:
    """Two ends of a TCP connection within this machine."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        near = stack.enter_context(socket.create_connection(server.getsockname()))
        far = stack.enter_context(server.accept()[0])
    for end in (near, far):
        end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return near, far


def free_port() -> int:
    """Return a port that nobody listens on."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        return int(server.getsockname()[1])


class FakeRobot:
    """The robot's side of argusd's link: answers the handshake, then says what it is told to."""

    def __init__(self, line: socket.socket) -> None:
        self.line = line
        self.unframer = Unframer()
        self.open = False
        self.grippers: list[int] = []

    def take(self) -> None:
        """Read and answer what argusd has sent."""
        for data in self.unframer.feed(self.line.recv(4096), time.monotonic() * 1000):
            command = Command.decode(data)
            if self.open:
                self.grippers += [command.value] if command.number == COMMAND["GRIPPER"] else []
            elif command.number == 2:
                self.line.sendall(frame(_NAME.data))
                self.open = True
            else:
                self.line.sendall(frame(SyncEcho(command.number).data))


def sip(number: int) -> bytes:
    """A SIP by whose number it is known again."""
    sonars = tuple((k, 2000) for k in range(number % 2 * 8, number % 2 * 8 + 8))
    return frame(replace(_SIP, analog=number % 256, sonars=sonars).data)


def handshake(client: socket.socket, robot: FakeRobot) -> None:
    """Open the guarded client's session while the robot goes on reporting."""
    for number in (0, 1, 2, 1):
        client.sendall(frame(Command(number).data))
        until = time.monotonic() + 0.3
        while (left := until - time.monotonic()) > 0:
            if robot.line in select.select([robot.line], [], [], left)[0]:
                robot.take()


def connect(arguments: Sequence[str], stack: ExitStack) -> tuple[FakeRobot, socket.socket]:
    """Start argusd between a robot of ours and a client of ours; return both."""
    port = free_port()
    server = stack.enter_context(socket.create_server(("127.0.0.1", 0)))
    link = f"tcp:127.0.0.1:{server.getsockname()[1]}"
    words = [str(ROOT / "build/release/argusd"), "--link", link, "--guard", f"tcp:127.0.0.1:{port}", "--json"]
    child = stack.enter_context(
        subprocess.Popen([*words, *arguments], stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
    )
    stack.callback(child.terminate)
    robot = FakeRobot(stack.enter_context(server.accept()[0]))
    robot.line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    for number in range(SETTLE_SIPS):
        until = time.monotonic() + SIP_S
        while (left := until - time.monotonic()) > 0:
            if select.select([robot.line], [], [], left)[0]:
                robot.take()
        if robot.open:
            robot.line.sendall(sip(number))
    client = stack.enter_context(socket.create_connection(("127.0.0.1", port), 5))
    client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    handshake(client, robot)
    return robot, client


def take_sips(way: Way) -> None:
    """Read the SIPs at the end of a way."""
    for data in way.unframer.feed(way.sink.recv(4096), time.monotonic() * 1000):
        if data[0] in (0x32, 0x33):
            way.arrived(Sip.decode(data).analog or 0)


def take_commands(way: Way, robot: FakeRobot | None) -> None:
    """Read the commands at the end of a way."""
    if robot is not None:
        robot.take()
        while robot.grippers:
            way.arrived(robot.grippers.pop(0))
        return
    for data in way.unframer.feed(way.sink.recv(4096), time.monotonic() * 1000):
        way.arrived(Command.decode(data).value)


def measure(seconds: float, arguments: Sequence[str]) -> dict[str, Way]:
    """Send SIPs and commands by all ways in turn, for so long."""
    with ExitStack() as stack:
        robot, client = connect(arguments, stack)
        near, far = pair(stack)
        ways = {
            "SIP guarded": Way(robot.line, client),
            "SIP bare": Way(near, far),
            "command guarded": Way(client, robot.line),
            "command bare": Way(far, near),
        }
        end, due, number = time.monotonic() + seconds, time.monotonic(), 0
        while time.monotonic() < end + LINGER_S:
            if end > time.monotonic() >= due:
                due += SIP_S / len(ways)
                number += 1
                name = list(ways)[number % len(ways)]  # one after the other, so that none waits for another
                value = number // len(ways) % 250
                command = Command.integer(COMMAND["GRIPPER"], value).data
                ways[name].send(value, sip(value) if name.startswith("SIP") else frame(command))
            for sink in select.select(
                [client, far, robot.line, near], [], [], min(max(0, due - time.monotonic()), LINGER_S)
            )[0]:
                if sink in (client, far):
                    take_sips(ways["SIP guarded" if sink is client else "SIP bare"])
                else:
                    guarded = sink is robot.line
                    take_commands(
                        ways["command guarded" if guarded else "command bare"], robot if guarded else None
                    )
        for way in ways.values():
            way.lost += len(way.left)
    return ways


def main(argv: Sequence[str] | None = None) -> int:
    """Measure; 1 when the median of what the guard adds is above the limit, or a SIP was lost."""
    parser = argparse.ArgumentParser(
        description=__doc__,
        epilog="example: tests/bench/guardian.py --seconds 60 --readings cover",
    )
    parser.add_argument("--seconds", type=float, default=20.0, help="how long (default 20)")
    parser.add_argument("--readings", default="withhold", help="as --guard-readings (default withhold)")
    args = parser.parse_args(argv)
    ways = measure(args.seconds, ["--guard-readings", args.readings])
    for name, way in ways.items():
        ordered = sorted(way.took_ms)
        print(
            f"{name:16} {len(ordered):5} median {statistics.median(ordered):6.3f} ms, "
            f"99 % {ordered[int(len(ordered) * 0.99)]:6.3f} ms, worst {ordered[-1]:6.3f} ms, lost {way.lost}"
        )
    added = {
        kind: statistics.median(ways[f"{kind} guarded"].took_ms)
        - statistics.median(ways[f"{kind} bare"].took_ms)
        for kind in ("SIP", "command")
    }
    print(", ".join(f"{kind}: {ms:.3f} ms added" for kind, ms in added.items()))
    return int(max(added.values()) >= LIMIT_MS or sum(way.lost for way in ways.values()) > 0)


if __name__ == "__main__":
    sys.exit(main())
