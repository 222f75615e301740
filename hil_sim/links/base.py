# SPDX-License-Identifier: MIT
"""What every link to a client does."""

from __future__ import annotations

import contextlib
import select
from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import Any, Final

BACKLOG_MS: Final = 200.0
"""A packet that would wait longer than this for the wire is not sent, as by a robot out of buffers."""


class Link(ABC):
    """A way to a client. All methods return at once but `wait`."""

    @abstractmethod
    def open(self) -> None:
        """Make the link ready for a client."""

    @abstractmethod
    def receive(self, now_ms: float) -> Iterable[bytes]:
        """Yield runs of bytes that have arrived; call `set_baud` between runs if they change the rate."""

    @abstractmethod
    def send(self, packet: bytes, now_ms: float) -> None:
        """Take a packet to send; it may be lost if no client listens."""

    @abstractmethod
    def transmit(self, now_ms: float) -> None:
        """Hand over what is due."""

    def set_baud(self, baud: int) -> None:  # noqa: B027 (only a wire has a rate)
        """The robot's side changes to this rate."""

    def due_ms(self) -> float | None:
        """When the link next needs a call though nothing arrives."""
        return None

    def take_lost(self) -> bool:
        """Tell once that the connection to the client was lost; a wire cannot."""
        return False

    def hang_up(self) -> None:  # noqa: B027 (only a connection can be closed)
        """Close the connection to the client, not the link."""

    def summary(self) -> str:
        """What went wrong, for a report; empty on a link that cannot tell."""
        return ""

    @abstractmethod
    def readers(self) -> list[Any]:
        """What to wait on for input."""

    def wait(self, timeout_ms: float) -> None:
        """Sleep until input or the timeout."""
        with contextlib.suppress(InterruptedError):
            select.select(self.readers(), [], [], max(0.0, timeout_ms) / 1000)

    @property
    @abstractmethod
    def address(self) -> str:
        """What a client is to open."""

    @abstractmethod
    def close(self) -> None:
        """Release everything; further calls are no-ops."""
