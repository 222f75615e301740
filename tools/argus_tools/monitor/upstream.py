# SPDX-License-Identifier: MIT
"""A client of argusd's control socket: requests with their replies, and the streams between them."""

from __future__ import annotations

import asyncio
import contextlib
import json
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

Message = dict[str, Any]
LINE_MAX: Final = 1 << 16
"""Four times what argusd sends at most; a longer line is no line of its."""
REPLY_WITHIN_S: Final = 5.0
_TCP: Final = re.compile(r"tcp:(\[[0-9a-fA-F:]+\]|[^:\[\]]+):(\d{1,5})")


class UpstreamError(Exception):
    """argusd is not there, or is not what answers; the message is one line."""


@dataclass(frozen=True)
class Address:
    """Where argusd listens: the path of a socket, or a host and a port with the token that it asks for."""

    path: str = ""
    host: str = ""
    port: int = 0
    token: str = ""

    def __str__(self) -> str:
        return f"unix:{self.path}" if self.path else f"tcp:{self.host}:{self.port}"


def parse_address(text: str, token: str = "") -> Address:
    """Read unix:PATH or tcp:HOST:PORT; ValueError says what is wrong.

    >>> parse_address("tcp:[::1]:8100").port
    8100
    """
    if text.startswith("unix:") and len(text) > 5:
        return Address(path=text[5:], token=token)
    found = _TCP.fullmatch(text)
    if found is None or not 0 < int(found[2]) < 65536:
        raise ValueError(f"'{text}' is not unix:PATH or tcp:HOST:PORT")
    return Address(host=found[1].strip("[]"), port=int(found[2]), token=token)


class Upstream:
    """One connection. What is no reply goes to `told`; `closed` is set when the other end is gone."""

    def __init__(
        self,
        reader: asyncio.StreamReader,
        writer: asyncio.StreamWriter,
        told: Callable[[Message], None],
        within_s: float,
    ) -> None:
        self._within_s = within_s
        self._reader = reader
        self._writer = writer
        self._told = told
        self._asked: dict[int, asyncio.Future[Message]] = {}
        self._last = 0
        self._task: asyncio.Task[None] | None = None
        self.closed = asyncio.Event()

    @classmethod
    async def open(
        cls, address: Address, told: Callable[[Message], None], within_s: float = REPLY_WITHIN_S
    ) -> Upstream:
        """Connect, check who answers and say the token; UpstreamError when any of it fails."""
        try:
            async with asyncio.timeout(within_s):
                if address.path:
                    reader, writer = await asyncio.open_unix_connection(address.path, limit=LINE_MAX)
                else:
                    reader, writer = await asyncio.open_connection(address.host, address.port, limit=LINE_MAX)
        except (OSError, TimeoutError) as error:
            reason = getattr(error, "strerror", None) or "no answer"
            raise UpstreamError(f"{address}: {reason}") from None
        made = cls(reader, writer, told, within_s)
        try:
            await made._greet(address)
        except BaseException:
            await made.close()
            raise
        return made

    async def _greet(self, address: Address) -> None:
        try:
            async with asyncio.timeout(self._within_s):
                greeting = _object(await self._reader.readline())
        except (OSError, ValueError, TimeoutError):
            greeting = {}
        if greeting.get("control") != 1:
            raise UpstreamError(f"{address}: whoever answers is no argusd with control socket version 1")
        if greeting.get("auth") == "token" and not address.token:
            raise UpstreamError(f"{address}: a token is asked for; give --token FILE")
        self._task = asyncio.create_task(self._read())
        if greeting.get("auth") == "token":
            answer = await self.ask("hello", token=address.token)
            if not answer.get("ok"):
                raise UpstreamError(f"{address}: argusd does not take this token")

    async def ask(self, request: str, **members: Any) -> Message:
        """Send a request and return its reply; UpstreamError when none comes."""
        self._last += 1
        number = self._last
        waiting: asyncio.Future[Message] = asyncio.get_running_loop().create_future()
        self._asked[number] = waiting
        try:
            if self.closed.is_set():
                raise UpstreamError("argusd has closed the connection")
            line = json.dumps({"do": request, "id": number, **members}, separators=(",", ":"))
            self._writer.write(line.encode() + b"\n")
            async with asyncio.timeout(self._within_s):
                await self._writer.drain()
                return await waiting
        except (OSError, TimeoutError):
            raise UpstreamError("argusd does not answer") from None
        finally:
            self._asked.pop(number, None)

    async def _read(self) -> None:
        try:
            while line := await self._reader.readline():
                message = _object(line)
                if "re" not in message:
                    self._told(message)
                elif (waiting := self._asked.get(message["re"])) and not waiting.done():
                    waiting.set_result(message)
        except (OSError, ValueError):
            pass  # a broken connection, or no line of argusd's: either way it is over
        finally:
            self.closed.set()
            for waiting in self._asked.values():
                if not waiting.done():
                    waiting.set_exception(UpstreamError("argusd has closed the connection"))

    async def close(self) -> None:
        """Hang up."""
        self._writer.close()
        if self._task is not None:
            self._task.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._task
        self.closed.set()
        with contextlib.suppress(OSError):
            await self._writer.wait_closed()


def _object(line: bytes) -> Message:
    found = json.loads(line)
    if not isinstance(found, dict):
        raise ValueError("no object")
    return found
