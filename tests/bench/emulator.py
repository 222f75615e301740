# SPDX-License-Identifier: MIT
"""Measures the emulator: SIP jitter and processor time of ten robots served by one process."""

from __future__ import annotations

import argparse
import itertools
import os
import select
import socket
import statistics
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import ExitStack

from hil_sim.arcos import COMMAND, TYPE, Command, Unframer, frame

SIP_MS = 100.0


def _open(address: str, stack: ExitStack) -> int:
    """Open a client's side of a link; return its descriptor."""
    if address.startswith("/"):
        client = os.open(address, os.O_RDWR | os.O_NOCTTY)
        stack.callback(os.close, client)
        return client
    host, _, port = address.rpartition(":")
    connection = stack.enter_context(socket.create_connection((host, int(port))))
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return connection.fileno()


def _send(client: int, name: str, value: int | None = None) -> None:
    number = COMMAND[name]
    os.write(client, frame((Command(number) if value is None else Command.integer(number, value)).data))


def _handshake(client: int) -> None:
    for name in ("PULSE", "OPEN", "CLOSE"):
        _send(client, name)
        if not select.select([client], [], [], 10)[0] or not os.read(client, 4096):
            raise SystemExit("emulator: no answer to the handshake")
    for name, value in (("OPEN", 1), ("ENABLE", 1), ("VEL", 100), ("RVEL", 10)):
        _send(client, name, value)


def _arrivals(clients: Sequence[int], seconds: float) -> list[list[float]]:
    """When each client got each SIP, in ms."""
    unframers = {client: Unframer() for client in clients}
    times: dict[int, list[float]] = {client: [] for client in clients}
    end, pulse = time.monotonic() + seconds, 0.0
    while (now := time.monotonic()) < end:
        if now >= pulse:
            pulse = now + 0.5
            for client in clients:
                _send(client, "PULSE")
        for client in select.select(clients, [], [], 0.05)[0]:
            data, now_ms = os.read(client, 4096), time.monotonic() * 1000
            for packet in unframers[client].feed(data, now_ms):
                if TYPE["SIP_FIRST"] <= packet[0] <= TYPE["SIP_LAST"]:
                    times[client].append(now_ms)
    return list(times.values())


def _cpu_s(pid: int) -> float:
    with open(f"/proc/{pid}/stat", encoding="ascii") as file:  # noqa: PTH123 (one line of /proc)
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _report(robots: int, seconds: float, world: str, pty: bool) -> None:
    link = ["--baud", "115200"] if pty else ["--tcp", "0"]
    command = [sys.executable, "-m", "hil_sim.cli", "--robots", str(robots), "--world", world, *link]
    core = min(os.sched_getaffinity(0))
    with ExitStack() as stack:
        process = stack.enter_context(subprocess.Popen(command, stdout=subprocess.PIPE, text=True))
        stack.callback(process.terminate)
        os.sched_setaffinity(process.pid, {core})
        assert process.stdout is not None
        clients = [_open(process.stdout.readline().strip(), stack) for _ in range(robots)]
        for client in clients:
            _handshake(client)
        _arrivals(clients, 2.0)
        before = _cpu_s(process.pid)
        arrivals = _arrivals(clients, seconds)
        busy = (_cpu_s(process.pid) - before) / seconds
    gaps = [b - a for times in arrivals for a, b in itertools.pairwise(times)]
    # Against the best steady beat of each robot: a late SIP counts once, not twice.
    late = []
    for times in arrivals:
        phase = [t - k * SIP_MS for k, t in enumerate(times)]
        base = statistics.median(phase)
        late += [abs(p - base) for p in phase]
    late.sort()
    short = min(len(times) for times in arrivals) / (seconds * 1000 / SIP_MS)
    where = f"{'ptys' if pty else 'TCP'}, one core"
    print(f"{robots} robots on {where}, {seconds:g} s, world {world}, load {os.getloadavg()[0]:.2f}")
    print(f"  SIPs of the slowest robot {100 * short:6.1f} % of real time")
    print(f"  processor                 {100 * busy:6.1f} % of the core")
    p50, p99 = late[len(late) // 2], late[len(late) * 99 // 100]
    print(f"  SIP jitter                p50 {p50:.2f} ms, p99 {p99:.2f} ms, max {late[-1]:.2f} ms")
    print(f"  SIP to SIP                {min(gaps):.1f} to {max(gaps):.1f} ms")


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__, epilog="exit codes: 0 measured, 1 no emulator")
    parser.add_argument("--robots", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--world", default="lab")
    arguments = parser.parse_args()
    for pty in (False, True):
        _report(arguments.robots, arguments.seconds, arguments.world, pty)


if __name__ == "__main__":
    main()
