# SPDX-License-Identifier: MIT
"""Rule: the commands in docs/can.md do what the page says, in its order, from a machine without a bus on."""

from __future__ import annotations

import os
import pty
import re
import select
import shutil
import subprocess
import time
from pathlib import Path

import pytest
from canbus import load_dbc
from canpage import PAGE, PRELUDE, blocks
from harness import ARGUSD, ROOT

LIMIT_S = 600


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """A folder in which the page's relative paths lead where they should."""
    for name in (".venv", "tools"):
        (tmp_path / name).symlink_to(ROOT / name)
    (tmp_path / "build/release").mkdir(parents=True)
    (tmp_path / "build/release/argusd").symlink_to(ARGUSD)
    return tmp_path


def run(script: str, place: Path) -> subprocess.CompletedProcess[str]:
    """Run a script on a machine of its own: no bus yet, and nothing is left of it."""
    words = [
        "unshare",
        "--net",
        "--pid",
        "--fork",
        "--kill-child",
        "--mount-proc",
        "bash",
        "-ec",
        PRELUDE + script,
    ]
    return subprocess.run(words, cwd=place, capture_output=True, text=True, timeout=LIMIT_S, check=False)


def test_the_page_from_top_to_bottom(place: Path) -> None:
    found = blocks("sh")
    assert len(found) >= 5
    script = "".join(f"echo '== {number}'\n{text}" for number, text in enumerate(found))
    done = run(script, place)
    assert done.returncode == 0, f"{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    said = re.split(r"^== \d+\n", done.stdout, flags=re.MULTILINE)[1:]
    assert "P3DX_0001" in said[1]
    assert "FA FB 03 00 00 00" in said[2]
    health = said[3].splitlines()
    assert sum("501" in line for line in health[:3]) == 3
    assert any("ArgusHealthFront" in line and "S03_Health: DISABLED" in line for line in health)
    assert any("ArgusHeartbeat" in line for line in health)
    assert sum(" SIP " in line for line in said[4].splitlines()) >= 2
    assert "Taken: 1" in said[5]
    assert "Refused: 0" in said[5]


def test_the_monitor_draws_its_page(place: Path) -> None:
    """What needs a terminal, on one."""
    (command,) = (line for text in blocks("console") for line in text.splitlines() if "monitor" in line)
    number = load_dbc().get_message_by_name("ArgusHeartbeat").frame_id
    feed = f"(for i in $(seq 400); do cansend vcan0 {number:03X}#0300000000000000; sleep 0.1; done) &\n"
    script = PRELUDE + blocks("sh")[0] + feed + f"timeout 50 {command} || true"
    master, slave = pty.openpty()
    words = ["unshare", "--net", "--pid", "--fork", "--kill-child", "--mount-proc", "bash", "-ec", script]
    env = os.environ | {"TERM": "xterm", "LINES": "40", "COLUMNS": "120"}
    process = subprocess.Popen(words, cwd=place, stdin=slave, stdout=slave, stderr=slave, env=env)
    os.close(slave)
    seen, until = b"", time.monotonic() + LIMIT_S
    while process.poll() is None and time.monotonic() < until and b"ArgusHeartbeat" not in seen:
        if select.select([master], [], [], 0.2)[0]:
            try:
                seen += os.read(master, 4096)
            except OSError:
                break
    process.kill()
    process.wait()
    os.close(master)
    assert b"ArgusHeartbeat" in seen, seen[-500:]


def test_every_console_command_is_there() -> None:
    """What is not run exists at least."""
    for text in blocks("console"):
        for line in text.splitlines():
            program = line.split()[0]
            assert shutil.which(program) or (ROOT / program).exists(), line


def test_the_table_of_frames_is_that_of_the_dbc() -> None:
    names = {message.name for message in load_dbc().messages}
    shown = set(re.findall(r"`(Argus\w+)`", PAGE))
    assert shown <= names
    # Rows of several frames name the first.
    assert {re.sub(r"\d\d$", "", name) for name in names - shown} <= {"ArgusHealth", "ArgusReadings"}
    assert {"ArgusHealth16", "ArgusReadings00", "ArgusReadings16"} <= shown
