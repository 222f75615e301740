# SPDX-License-Identifier: MIT
"""Rule: flashing writes the image where the linker put it, never over the store, and says what it needs."""

from __future__ import annotations

import subprocess
import sys

import pytest
from machine import ROOT

STORE = range(0x08004000, 0x0800C000)


def flash(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(ROOT / "tools/dev"), "flash", *arguments]
    return subprocess.run(command, check=False, capture_output=True, text=True, timeout=600)


@pytest.mark.parametrize(
    ("probe", "programs"),
    [("stlink", ("openocd", "st-flash")), ("dfu", ("dfu-util",)), ("serial", ("stm32flash",))],
)
def test_a_dry_run_shows_the_commands(probe: str, programs: tuple[str, ...]) -> None:
    done = flash("--probe", probe, "--device", "/dev/ttyUSB7", "--dry-run")
    assert done.returncode == 0, done.stderr
    commands = [line for line in done.stdout.splitlines() if not line.startswith("dev: ")]
    assert commands
    for command in commands:
        assert command.startswith(programs)
    if probe == "serial":
        assert commands[0].endswith(" /dev/ttyUSB7")


def hex_addresses() -> list[int]:
    """Return the first address of each record of data in the HEX file."""
    upper, addresses = 0, []
    for line in (ROOT / "build/stm32f405/argus-stm32f405.hex").read_text(encoding="ascii").splitlines():
        kind, address, data = int(line[7:9], 16), int(line[3:7], 16), line[9:-2]
        if kind == 4:
            upper = int(data, 16) << 16
        elif kind == 0:
            addresses.append(upper + address)
    return addresses


def test_the_store_is_not_written() -> None:
    addresses = hex_addresses()
    assert min(addresses) == 0x08000000
    assert not [address for address in addresses if address in STORE]


def test_the_parts_for_dfu_are_the_image() -> None:
    folder = ROOT / "build/stm32f405"
    whole = (folder / "argus-stm32f405.bin").read_bytes()
    vectors = (folder / "argus-stm32f405.vectors.bin").read_bytes()
    body = (folder / "argus-stm32f405.body.bin").read_bytes()
    assert whole == vectors.ljust(0xC000, b"\xff") + body
