# SPDX-License-Identifier: MIT
"""An emulated robot on TCP, argusd beside it, for tests of what runs in real time."""

from __future__ import annotations

import socket
import sys
from pathlib import Path

import harness
from harness import Argusd, Sim

harness.SIM = Path(sys.prefix) / "bin/argus-sim"  # type: ignore[misc]


def emulated(folder: Path, *arguments: str) -> tuple[Sim, str]:
    """Start argus-sim; return it and its address, HOST:PORT."""
    given = ("--tcp", "127.0.0.1:0", "--crosstalk", "0", *arguments)
    sim = Sim(given, folder / "truth.jsonl", folder / "sim.log")
    return sim, sim.address.removeprefix("tcp:")


def minded(folder: Path, address: str, *arguments: str) -> tuple[Argusd, str]:
    """Start argusd on a robot; return it and its control socket."""
    socket = folder / "argus.sock"
    given = ["--link", f"tcp:{address}", "--json", "--wait", "60", "--control", f"unix:{socket}", *arguments]
    argusd = Argusd(given)
    harness.wait_for("the control socket", socket.exists, 60)
    return argusd, f"unix:{socket}"


def free_port() -> int:
    """Return a port that nobody listens on."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
