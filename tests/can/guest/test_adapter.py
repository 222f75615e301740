# SPDX-License-Identifier: MIT
"""Rule: the commands of docs/can.md for adapters work; always in the guest, since slcan knows no other network."""

from __future__ import annotations

import os
import pty
import select
import subprocess
import threading

from canpage import PRELUDE, blocks

LIMIT_S = 600


def run(script: str) -> subprocess.CompletedProcess[str]:
    """Run a script of the page."""
    return subprocess.run(
        ["bash", "-ec", PRELUDE + script], capture_output=True, text=True, timeout=LIMIT_S, check=False
    )


class FakeAdapter:
    """The far end of a serial line that swallows what slcand says."""

    def __init__(self) -> None:
        self._master, self._slave = pty.openpty()
        self.path = os.ttyname(self._slave)
        self.heard = b""
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        while not self._stop.is_set():
            if select.select([self._master], [], [], 0.1)[0]:
                self.heard += os.read(self._master, 256)

    def close(self) -> None:
        """Take it away."""
        self._stop.set()
        self._thread.join()
        os.close(self._master)
        os.close(self._slave)


def test_an_slcan_adapter() -> None:
    (text,) = blocks("sh slcan")
    adapter = FakeAdapter()
    try:
        script = (
            text.replace("/dev/ttyACM0", adapter.path)
            + "ip -br link show slcan0; cansend slcan0 123#11\nsleep 0.5"
        )
        done = run(script)
        assert done.returncode == 0, done.stdout + done.stderr
        assert "UP" in done.stdout
        assert b"S6\r" in adapter.heard, "the bit rate was not set"
        assert b"t123111\r" in adapter.heard
    finally:
        adapter.close()


def test_the_commands_for_an_adapter() -> None:
    """On a serial-line adapter, the one kind that needs no hardware; ip sets its bit rate, too."""
    (text,) = blocks("sh adapter")
    adapter = FakeAdapter()
    try:
        text = text.replace(" restart-ms 100", "")  # which this driver has not
        done = run(f"slcand -S 115200 {adapter.path} can0\nsleep 0.3\n{text}")
        assert done.returncode == 0, done.stdout + done.stderr
        assert "bitrate 500000" in done.stdout
        assert b"S6\r" in adapter.heard
    finally:
        adapter.close()
