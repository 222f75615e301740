# SPDX-License-Identifier: MIT
"""A real UART through pyserial."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from hil_sim.errors import LinkError
from hil_sim.links.base import Link


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
            raise LinkError(
                f"--serial {self._device}@{self._baud}: {error}; check the device and its rights"
            ) from error

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
