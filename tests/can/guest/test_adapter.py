# SPDX-License-Identifier: MIT
"""Rule: the commands of docs/can.md for adapters work; always in the guest, since slcan knows no other network."""

from __future__ import annotations

import os
import pty
import re
import select
import subprocess
import threading
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PAGE = (ROOT / "docs/can.md").read_text(encoding="utf-8")
LIMIT_S = 600

# The page's `sudo` and `modprobe`, for one who is root already and has the modules. One that is built in and has
# no settings shows by what it offers.
PRELUDE = """
sudo() { "$@"; }
is_there() { [ -e "/sys/module/$1" ] || grep -iqw "$1" /proc/net/protocols /proc/tty/ldiscs; }
modprobe() {
    shift
    for module; do is_there "$(echo "$module" | tr - _)" || { echo "no module $module"; return 1; }; done
}
"""


def block(kind: str) -> str:
    """The commands of the only block of one kind."""
    (text,) = re.findall(rf"^```{kind}\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    return str(text)


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
    text = block("sh slcan")
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
    text = block("sh adapter")
    adapter = FakeAdapter()
    try:
        text = text.replace(" restart-ms 100", "")  # which this driver has not
        done = run(f"slcand -S 115200 {adapter.path} can0\nsleep 0.3\n{text}")
        assert done.returncode == 0, done.stdout + done.stderr
        assert "bitrate 500000" in done.stdout
        assert b"S6\r" in adapter.heard
    finally:
        adapter.close()
