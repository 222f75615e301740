# SPDX-License-Identifier: MIT
"""A wire between a client and a server of the robot's protocol that counts what passes, so that a loss shows."""

from __future__ import annotations

import bisect
import contextlib
import os
import pty
import select
import socket
import threading
import time
import tty
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from hil_sim.arcos import Unframer

_SIPS: Final = (0x32, 0x33)
_CHUNK: Final = 4096
_TICK_S: Final = 0.2
Open = Callable[[], contextlib.AbstractContextManager[int]]
"""Opens the server's side; gives its file descriptor."""


@contextmanager
def to_port(port: int) -> Iterator[int]:
    """A connection to a port of this machine."""
    with socket.create_connection(("127.0.0.1", port), 5) as server:
        server.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        server.settimeout(None)
        yield server.fileno()


@contextmanager
def to_terminal(path: Path | str) -> Iterator[int]:
    """The other side of a pty, as a program opens a serial line."""
    fd = os.open(path, os.O_RDWR | os.O_NOCTTY)
    try:
        tty.setraw(fd)
        yield fd
    finally:
        os.close(fd)


class Wire:
    """Passes one client at a time on to a server, and counts."""

    def __init__(self, open_server: Open, terminal: bool = False) -> None:
        """`terminal`: the client finds a pty, else a TCP port of this machine."""
        self._open_server = open_server
        self.sip_s: list[float] = []
        """When each SIP came from the server."""
        self.damaged = 0
        """Packets from the server with a wrong checksum or count, and bytes that belong to none."""
        self.commands = 0
        self.port, self.path = 0, ""
        self._ended = threading.Event()
        if terminal:
            self._master, slave = pty.openpty()
            tty.setraw(slave)
            self.path, self._slave = os.ttyname(slave), slave  # held open, or the master would hang up
        else:
            self._server = socket.create_server(("127.0.0.1", 0))
            self._server.settimeout(_TICK_S)
            self.port = int(self._server.getsockname()[1])
        self._thread = threading.Thread(target=self._at_terminal if terminal else self._at_port, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End it."""
        self._ended.set()
        self._thread.join()

    def _at_terminal(self) -> None:
        with contextlib.suppress(OSError), self._open_server() as server:
            self._pass(self._master, server)

    def _at_port(self) -> None:
        with self._server:
            while not self._ended.is_set():
                try:
                    client, _ = self._server.accept()
                except TimeoutError:
                    continue
                client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                client.settimeout(None)
                with client, contextlib.suppress(OSError), self._open_server() as server:
                    self._pass(client.fileno(), server)

    def _pass(self, client: int, server: int) -> None:
        said, asked = Unframer(), Unframer()
        while not self._ended.is_set():
            for end in select.select([client, server], [], [], _TICK_S)[0]:
                data = os.read(end, _CHUNK)
                if not data:
                    return
                now = time.monotonic()
                write(server if end == client else client, data)
                if end == client:
                    self.commands += len(asked.feed(data, now * 1000))
                    continue
                self.sip_s += [now for content in said.feed(data, now * 1000) if content[0] in _SIPS]
                seen = said.counters
                self.damaged = seen.bad_checksum + seen.bad_count + seen.junk_bytes


def write(fd: int, data: bytes) -> None:
    """Write all of it."""
    while data:
        data = data[os.write(fd, data) :]


def lost(robot_s: Sequence[float], client_s: Sequence[float]) -> int:
    """How many SIPs of the robot did not reach the client, from its first one to its last.

    >>> lost([1.0, 1.1, 1.2, 1.3], [1.101, 1.301])
    1
    """
    if not client_s:
        return len(robot_s)
    first, last = (bisect.bisect_right(robot_s, at) - 1 for at in (client_s[0], client_s[-1]))
    return last - first + 1 - len(client_s)
