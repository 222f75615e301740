# SPDX-License-Identifier: MIT
"""A TCP port, one client at a time."""

from __future__ import annotations

import errno
import socket
from collections.abc import Iterable
from typing import Any, Final

from hil_sim.errors import LinkError
from hil_sim.links.base import Link

_TX_LIMIT: Final = 65536


_REASONS: Final = {
    errno.EADDRINUSE: "another program listens there (ss -ltnp names it); end it or choose another port",
    errno.EACCES: "ports below 1024 are for root; choose a higher one",
    errno.EADDRNOTAVAIL: "no address of this machine; leave the host out, or give one that `ip address` shows",
}


def _why(error: OSError | OverflowError) -> str:
    """What is wrong, and what to do."""
    if isinstance(error, socket.gaierror):
        return "no such host; leave it out, or give a name or address of this machine"
    if isinstance(error, OSError) and error.errno in _REASONS:
        return _REASONS[error.errno]
    return f"{getattr(error, 'strerror', None) or error}; choose another host or port"


class TcpLink(Link):
    """A TCP port, one client at a time: a second one is turned away, or finds no listener (`deaf`)."""

    def __init__(self, host: str, port: int, deaf: bool = False) -> None:
        self._deaf = deaf
        self._lost = False
        self._host = host
        self._port = port
        self._listener: socket.socket | None = None
        self._client: socket.socket | None = None
        self._pending = bytearray()

    def open(self) -> None:
        """Listen."""
        self._listen()

    def _listen(self) -> None:
        try:
            family = socket.getaddrinfo(self._host, self._port, type=socket.SOCK_STREAM)[0][0]
            listener = socket.create_server((self._host, self._port), family=family, backlog=1)
        except (OSError, OverflowError) as error:
            raise LinkError(f"--tcp {self._host}:{self._port}: {_why(error)}") from error
        listener.setblocking(False)
        self._listener = listener
        self._port = listener.getsockname()[1]

    @property
    def address(self) -> str:
        """HOST:PORT."""
        return f"{self._host}:{self._port}"

    def _accept(self) -> None:
        if self._listener is None:
            self._listen()
        assert self._listener is not None
        try:
            client, _ = self._listener.accept()
        except OSError:
            return
        if self._client is not None:
            client.close()
            return
        client.setblocking(False)
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._client = client
        self._pending.clear()
        if self._deaf:
            self._listener.close()
            self._listener = None

    def _drop_client(self) -> None:
        if self._client is not None:
            self._client.close()
            self._client = None
            self._lost = True

    def take_lost(self) -> bool:
        """Tell once that the connection to the client was lost."""
        lost, self._lost = self._lost, False
        return lost

    def hang_up(self) -> None:
        """Close the connection to the client; the next one may come at once."""
        self._drop_client()
        if self._listener is None:
            self._listen()

    def receive(self, now_ms: float) -> Iterable[bytes]:  # noqa: ARG002 (Link's shape)
        """Yield what has arrived."""
        while self._client is not None:
            try:
                data = self._client.recv(4096)
            except (BlockingIOError, InterruptedError):
                break
            except OSError:
                data = b""
            if not data:
                self._drop_client()
                break
            yield data
        if self._client is None or self._listener is not None:
            self._accept()

    def send(self, packet: bytes, now_ms: float) -> None:  # noqa: ARG002 (Link's shape)
        """Send, or drop if no client is connected."""
        if self._client is not None:
            self._pending += packet

    def transmit(self, now_ms: float) -> None:  # noqa: ARG002 (Link's shape)
        """Write what the socket takes; a client that reads nothing for long is dropped."""
        if self._client is None or not self._pending:
            return
        try:
            del self._pending[: self._client.send(self._pending)]
        except (BlockingIOError, InterruptedError):
            if len(self._pending) > _TX_LIMIT:
                self._drop_client()
        except OSError:
            self._drop_client()

    def readers(self) -> list[Any]:
        """The listener and the client."""
        return [item for item in (self._listener, self._client) if item is not None]

    def close(self) -> None:
        """Close both sockets."""
        self._drop_client()
        if self._listener is not None:
            self._listener.close()
            self._listener = None
