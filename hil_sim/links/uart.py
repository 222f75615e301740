# SPDX-License-Identifier: MIT
"""A real UART through pyserial."""

from __future__ import annotations

import errno
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final

from hil_sim.errors import LinkError
from hil_sim.links.base import Link

_ADAPTERS: Final = ("serial/by-id/*", "ttyUSB*", "ttyACM*")


def _adapters(folder: Path = Path("/dev")) -> str:
    found = [str(path) for pattern in _ADAPTERS for path in sorted(folder.glob(pattern))]
    return f"there is {', '.join(found)}" if found else "no serial adapter is there: is it plugged in?"


def _why(error: OSError | ValueError, device: str) -> str:
    """What is wrong, and what to do."""
    number = getattr(error, "errno", None)
    if number == errno.ENOENT:
        return f"no such file; {_adapters()}"
    if number == errno.EACCES:
        return "no permission; join the group that `ls -l` shows for it, often dialout, and log in anew"
    if number == errno.EISDIR or "configure port" in str(error):
        return "no serial port; name a device such as /dev/ttyUSB0"
    if number in (errno.EBUSY, errno.EAGAIN) or "lock port" in str(error):
        return f"another program has it open (fuser {device} names it); end that one"
    return f"{error}; check the device"


class SerialLink(Link):
    """A real UART through pyserial; the wire paces and garbles by itself."""

    def __init__(self, device: str, baud: int) -> None:
        self._device = device
        self._baud = baud
        self._port: Any = None

    def open(self) -> None:
        """Open the port for ourselves alone."""
        try:
            import serial
        except ImportError as error:
            raise LinkError("--serial needs pyserial; install it with: pip install pyserial") from error
        try:
            self._port = serial.Serial(self._device, self._baud, timeout=0, write_timeout=1, exclusive=True)
        except (OSError, ValueError) as error:
            raise LinkError(f"--serial {self._device}@{self._baud}: {_why(error, self._device)}") from error

    @property
    def address(self) -> str:
        """DEVICE@BAUD."""
        return f"{self._device}@{self._baud}"

    def receive(self, now_ms: float) -> Iterable[bytes]:  # noqa: ARG002 (Link's shape)
        """Yield what has arrived."""
        try:
            data = self._port.read(4096)
        except OSError as error:
            raise LinkError(f"{self._device}: lost ({error})") from error
        if data:
            yield bytes(data)

    def send(self, packet: bytes, now_ms: float) -> None:  # noqa: ARG002 (Link's shape)
        """Give the packet to the UART."""
        try:
            self._port.write(packet)
        except OSError as error:
            raise LinkError(f"{self._device}: lost ({error})") from error

    def transmit(self, now_ms: float) -> None:
        """Nothing to do: the UART has it."""

    def set_baud(self, baud: int) -> None:
        """Let the last packet out at the old rate, then change."""
        if self._port is not None and baud != self._port.baudrate:
            self._port.flush()
            self._port.baudrate = baud

    def readers(self) -> list[Any]:
        """The port."""
        return [self._port]

    def close(self) -> None:
        """Release the port."""
        if self._port is not None:
            self._port.close()
            self._port = None
