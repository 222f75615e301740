# SPDX-License-Identifier: MIT
"""A board's image in QEMU, its two serial lines, and what can happen to it."""

from __future__ import annotations

import contextlib
import json
import os
import re
import select
import socket
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).resolve().parents[2]
MACHINES: Final = {"mps2-an386": "mps2-an386", "stm32f405": "netduinoplus2"}
CONSOLE_FIRST: Final = ("stm32f405",)
PATIENCE_S: Final = 60.0
"""How long something is waited for that comes within seconds where the host is not busy."""
SLOTS_AT, SLOTS_BYTES = 0x001FFFFC, 4 + 2 * 4096
"""The store of the MPS2 board (hal/mps2_an386/store.c), with the mark that it is in use."""
PC: Final = 15
UNDEFINED, TO_ITSELF = 0xDE00, 0xE7FE
"""Thumb: what no processor knows, and a branch without end."""


def image_of(board: str) -> Path:
    """Return the image of BOARD."""
    return ROOT / f"build/{board}/argus-{board}.elf"


def connected(path: Path) -> socket.socket:
    """Return a connection to the socket at PATH, as soon as somebody listens there."""
    until = time.monotonic() + PATIENCE_S
    while True:
        end = socket.socket(socket.AF_UNIX)
        try:
            end.connect(str(path))
        except OSError:
            end.close()
            if time.monotonic() > until:
                raise
            time.sleep(0.02)
        else:
            end.settimeout(PATIENCE_S)
            return end


def asked(end: socket.socket, packet: str) -> str:
    """Give PACKET of gdb's remote protocol, which stops the processor but for D, and return the answer.

    That the processor has stopped is said, too, in a packet of its own.
    """
    end.sendall(f"${packet}#{sum(packet.encode()) & 0xFF:02x}".encode())
    said = b""
    while True:
        said += end.recv(4096)
        answers = [match for match in re.findall(rb"\$([^#]*)#..", said) if not match.startswith(b"T")]
        if answers:
            end.sendall(b"+")
            return str(answers[0].decode())


class Machine:
    """The running image. Lines of the operator's UART are read as they come; what the robot gets is kept."""

    def __init__(self, board: str, folder: Path, extra: Sequence[str] = (), device: str = "") -> None:
        """Start the image of BOARD; its robot is at DEVICE, if that is given, else at a socket."""
        self.folder = folder
        ends = {name: folder / f"{name}.sock" for name in ("robot", "console", "gdb", "monitor")}
        command = [
            "qemu-system-arm",
            "-M",
            MACHINES[board],
            "-display",
            "none",
            "-kernel",
            str(image_of(board)),
        ]
        for name, path in ends.items():
            path.unlink(missing_ok=True)
            wait = "on" if name in ("robot", "console") else "off"
            place = f"socket,id={name},path={path},server=on,wait={wait}"
            command += ["-chardev", f"serial,id=robot,path={device}" if device and name == "robot" else place]
        order = ("console", "robot") if board in CONSOLE_FIRST else ("robot", "console")
        command += [word for name in order for word in ("-serial", f"chardev:{name}")]
        command += ["-gdb", "chardev:gdb", "-monitor", "chardev:monitor", *extra]
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL)
        self.ends = ends
        # QEMU waits for one after the other, in the order of the command.
        self.robot: socket.socket | None = None if device else connected(ends["robot"])
        self.console = connected(ends["console"])
        self.heard = b""
        self._rest = b""

    def close(self) -> None:
        """End it, as a power cut would."""
        self.process.kill()
        self.process.wait()
        for end in filter(None, (self.robot, self.console)):
            end.close()

    def lines(self, wait_s: float = 0.05) -> list[dict[str, Any]]:
        """Return the lines that have come, but for one that a restart has cut; what the robot got is in `heard`."""
        ready, _, _ = select.select([*filter(None, (self.robot,)), self.console], [], [], wait_s)
        if self.robot is not None and self.robot in ready:
            self.heard += self.robot.recv(1 << 16)
        if self.console not in ready:
            return []
        *whole, self._rest = (self._rest + self.console.recv(1 << 16)).split(b"\n")
        return [json.loads(line) for line in whole if line.endswith(b"}")]

    def wait_for(self, event: str, **wanted: Any) -> dict[str, Any]:
        """Return the next line about EVENT in which all WANTED values stand."""
        until = time.monotonic() + PATIENCE_S
        seen = []
        while time.monotonic() < until:
            for line in self.lines():
                seen.append(line.get("event"))
                if line.get("event") == event and all(
                    line.get(key) == value for key, value in wanted.items()
                ):
                    return line
        raise AssertionError(f"no {event} {wanted} within {PATIENCE_S:.0f} s, but {seen[-20:]}")

    def order(self, text: str) -> str:
        """Give an order; return its answer."""
        self.console.sendall(text.encode() + b"\n")
        return str(self.wait_for("ORDER", what=text)["text"])

    def monitor(self, command: str) -> None:
        """Give a command to QEMU's monitor and wait until it is done."""
        with connected(self.ends["monitor"]) as end:
            said = b""
            end.sendall(command.encode() + b"\n")
            while said.count(b"(qemu) ") < 2:
                said += end.recv(4096)

    def save_store(self) -> Path:
        """Write what the store's memory holds into a file."""
        path = self.folder / "store.bin"
        self.monitor(f'pmemsave {SLOTS_AT:#x} {SLOTS_BYTES} "{path}"')
        return path

    def patch(self, instruction: int) -> int:
        """Put a 16-bit INSTRUCTION where the processor goes on, which is awake or asleep; the address."""
        with connected(self.ends["gdb"]) as end:
            registers = asked(end, "g")
            address = int.from_bytes(bytes.fromhex(registers[PC * 8 : PC * 8 + 8]), "little")
            assert asked(end, f"M{address:x},2:{instruction.to_bytes(2, 'little').hex()}") == "OK"
            assert asked(end, "D") == "OK"
        return address


@contextlib.contextmanager
def running(board: str, folder: Path, *extra: str, device: str = "") -> Any:
    """Run the image of BOARD."""
    machine = Machine(board, folder, extra, device)
    try:
        yield machine
    finally:
        machine.close()


def digest_of(text: str, folder: Path) -> str:
    """Return the digest of settings, as the program that checks them on this machine has it."""
    path = folder / "board.ini"
    path.write_text(text, encoding="utf-8")
    checker = ROOT / "build/release/board_config"
    return subprocess.run([checker, path], check=True, capture_output=True, text=True).stdout.strip()


def noise(count: int) -> bytes:
    """Return bytes of chance, without the end of a line."""
    return os.urandom(count).replace(b"\n", b"").replace(b"\r", b"")
