# SPDX-License-Identifier: MIT
"""The port of argus-foxglove: it reads who asks for the WebSocket, refuses web pages of others, and passes on the rest.

The server of the Foxglove SDK asks nobody who they are. So it listens where only this program finds it.
"""

from __future__ import annotations

import asyncio
import contextlib
import ipaddress
import re
import secrets
import socket
import sys
import threading
from collections.abc import Iterable, Mapping
from typing import Final

HEAD_MAX: Final = 16_384
HEAD_WITHIN_S: Final = 5.0
CONNECTIONS_MAX: Final = 64
FOXGLOVE: Final = ("https://app.foxglove.dev", "https://studio.foxglove.dev")
"""Where Foxglove's own page is from."""
_CHUNK: Final = 65_536
_HEADER: Final = re.compile(r"([!#$%&'*+.^_`|~0-9A-Za-z-]+):[ \t]*(.*?)[ \t]*")
_AUTHORITY: Final = re.compile(r"(\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9._-]+)(:\d{1,5})?")
_LOCAL_PAGE: Final = re.compile(r"https?://(localhost|127\.0\.0\.1|\[::1\])(:\d{1,5})?")
_OF_APP: Final = re.compile(r"file://|foxglove://[^\s]*")
"""Origins that only a program on this machine has; a page from a file has 'null', as a frame of any site may."""


def is_loopback(host: str) -> bool:
    """Whether a host is this machine only.

    >>> is_loopback("127.0.0.1"), is_loopback("0.0.0.0")
    (True, False)
    """
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def _is_address(host: str) -> bool:
    try:
        ipaddress.ip_address(host)
    except ValueError:
        return False
    return True


def headers_of(head: bytes) -> dict[str, str] | None:
    """Return the headers of a request by lower-case name; None where two readers could read it differently."""
    lines = head.decode("latin-1").removesuffix("\r\n\r\n").split("\r\n")
    if not re.fullmatch(r"GET [!-~]+ HTTP/1\.1", lines[0]):
        return None
    found: dict[str, str] = {}
    for line in lines[1:]:
        header = _HEADER.fullmatch(line)
        if header is None or "\n" in line or "\r" in line:
            return None
        name = header[1].lower()
        if name in ("host", "origin") and name in found:
            return None
        found[name] = header[2]
    return found


class Gate:
    """Who may come in."""

    def __init__(self, host: str, allowed: Iterable[str] = ()) -> None:
        """`host`: where it listens. `allowed`: origins of pages besides Foxglove's."""
        self._host = host.lower()
        self._origins = {origin.lower().rstrip("/") for origin in (*FOXGLOVE, *allowed)}

    def why_refused(self, headers: Mapping[str, str]) -> str:
        """Tell why a request may not come in; empty for one that may.

        A name that is led to this machine (DNS rebinding) shows in Host, a page of another site in Origin.
        """
        if headers.get("upgrade", "").lower() != "websocket":
            return "here is a WebSocket for Foxglove, and nothing else"
        if not self._is_ours(headers.get("host", "")):
            return "this server answers to its address and localhost only"
        if not self._may_look(headers.get("origin")):
            return "this page may not look on; argus-foxglove --allow-origin allows one"
        return ""

    def _is_ours(self, host: str) -> bool:
        found = _AUTHORITY.fullmatch(host)
        if found is None:
            return False
        name = found[1].strip("[]").lower()
        if is_loopback(name) or name == self._host:
            return True
        # Beyond loopback any address of the machine may do: an address is no name that could be led elsewhere.
        return _is_address(name) and not is_loopback(self._host)

    def _may_look(self, origin: str | None) -> bool:
        if origin is None:  # a program, not a page: a browser says the origin of each WebSocket
            return True
        origin = origin.lower()
        return bool(origin in self._origins or _LOCAL_PAGE.fullmatch(origin) or _OF_APP.fullmatch(origin))


def hidden_host() -> str:
    """Return an address of loopback that no page can guess: on Linux all of 127.0.0.0/8 is this machine."""
    if sys.platform != "linux":
        return "127.0.0.1"
    return ".".join(map(str, (127, *(1 + secrets.randbelow(254) for _ in range(3)))))


def listening(host: str, port: int) -> socket.socket:
    """Return a socket that listens on the first address of a host; OSError when there is none, or it is taken."""
    family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    return socket.create_server((address[0], int(address[1])), family=family)


class Front:
    """Listens in a thread of its own, and joins each caller that may come in to the server behind."""

    def __init__(self, host: str, port: int, gate: Gate) -> None:
        self._socket = listening(host, port)
        self.port = int(self._socket.getsockname()[1])
        self._gate = gate
        self._behind = ("", 0)
        self._loop = asyncio.new_event_loop()
        self._callers: set[asyncio.Task[None]] = set()
        self._thread = threading.Thread(target=self._run, name="foxglove-front", daemon=True)

    def start(self, host: str, port: int) -> None:
        """Pass on to the server at that address from now on."""
        self._behind = (host, port)
        self._thread.start()

    def stop(self) -> None:
        """End all connections."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._loop.stop)
            self._thread.join()
        self._socket.close()
        self._loop.close()

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._loop.run_until_complete(asyncio.start_server(self._meet, sock=self._socket, limit=HEAD_MAX))
        self._loop.run_forever()
        for task in asyncio.all_tasks(self._loop):
            task.cancel()
        self._loop.run_until_complete(self._gone())

    async def _gone(self) -> None:
        await asyncio.gather(*self._callers, return_exceptions=True)

    async def _meet(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None
        self._callers.add(task)
        try:
            with contextlib.suppress(OSError, asyncio.CancelledError):
                await self._serve(reader, writer)
        finally:
            self._callers.discard(task)
            writer.close()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        if len(self._callers) > 4 * CONNECTIONS_MAX:  # before they have said who they are
            return
        try:
            async with asyncio.timeout(HEAD_WITHIN_S):
                head = await reader.readuntil(b"\r\n\r\n")
        except (asyncio.IncompleteReadError, asyncio.LimitOverrunError, TimeoutError):
            return
        headers = headers_of(head)
        if headers is None:
            await _refuse(writer, "400 Bad Request", "that is no request for a WebSocket")
        elif why := self._gate.why_refused(headers):
            await _refuse(writer, "403 Forbidden", why)
        elif len(self._callers) > CONNECTIONS_MAX:
            await _refuse(writer, "503 Service Unavailable", "too many look on")
        else:
            await self._join(head, reader, writer)

    async def _join(self, head: bytes, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        far_reader, far_writer = await asyncio.open_connection(*self._behind)
        try:
            far_writer.write(head)
            both = [
                asyncio.create_task(_pipe(reader, far_writer)),
                asyncio.create_task(_pipe(far_reader, writer)),
            ]
            try:
                await asyncio.wait(both, return_when=asyncio.FIRST_COMPLETED)
            finally:
                for task in both:
                    task.cancel()
                await asyncio.gather(*both, return_exceptions=True)
        finally:
            far_writer.close()


async def _refuse(writer: asyncio.StreamWriter, status: str, why: str) -> None:
    body = f"{why}\n".encode()
    head = f"HTTP/1.1 {status}\r\nContent-Type: text/plain\r\nContent-Length: {len(body)}\r\nConnection: close\r\n\r\n"
    writer.write(head.encode() + body)
    await writer.drain()


async def _pipe(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    """Pass on until the end, no faster than it is taken."""
    while data := await reader.read(_CHUNK):
        writer.write(data)
        await writer.drain()
