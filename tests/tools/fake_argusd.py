# SPDX-License-Identifier: MIT
"""A control socket as SPEC.md has it, with a recorded drive behind it instead of a robot."""

from __future__ import annotations

import asyncio
import contextlib
import json
import secrets
from pathlib import Path
from typing import Any, Final

STREAM: Final = Path(__file__).resolve().parents[1] / "data/control/stream.jsonl"
Message = dict[str, Any]


def recorded() -> list[Message]:
    """Return the lines of the drive: readings, evidence, state and events as argusd sent them."""
    lines = STREAM.read_text(encoding="utf-8").splitlines()[1:]
    return [json.loads(line) for line in lines]


class FakeArgusd:
    """Serves any number of clients; keeps the rules of control and notes every order."""

    def __init__(self, path: Path, token: str = "", greeting: Message | None = None) -> None:
        self.path = path
        self.token = token
        self.greeting = greeting or {"control": 1, "argus": "0.1.0", "auth": "token" if token else "none"}
        self.orders: list[Message] = []
        self.stopped_for_lost_controller = 0
        self.grant = ""
        self.mute = False
        self._holder: asyncio.StreamWriter | None = None
        self._seq = -1
        self._by_hand = False
        self._watching: set[asyncio.StreamWriter] = set()
        self._clients: set[asyncio.StreamWriter] = set()
        self._server: asyncio.Server | None = None

    async def start(self) -> None:
        self._server = await asyncio.start_unix_server(self._serve, self.path)

    async def stop(self) -> None:
        assert self._server is not None
        self._server.close()
        for client in list(self._clients):
            client.close()
        await asyncio.sleep(0)
        self.path.unlink(missing_ok=True)

    def tell(self, message: Message) -> None:
        """Send a line to whoever watches."""
        for client in self._watching:
            _send(client, message)

    @property
    def watchers(self) -> int:
        return len(self._watching)

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._clients.add(writer)
        _send(writer, self.greeting)
        authentic = not self.token
        with contextlib.suppress(ConnectionError):
            while line := await reader.readline():
                request = json.loads(line)
                if self.mute:
                    continue
                if request["do"] == "hello":
                    authentic = authentic or request.get("token") == self.token
                    answer: Message = {"ok": True} if authentic else _no("auth", "the token is wrong")
                else:
                    answer = self._answer(request, writer) if authentic else _no("auth", "say hello first")
                _send(writer, {"re": request.get("id"), **answer})
        self._gone(writer)

    def _gone(self, writer: asyncio.StreamWriter) -> None:
        self._clients.discard(writer)
        self._watching.discard(writer)
        if writer is self._holder:
            self.stopped_for_lost_controller += self._by_hand
            self._holder, self.grant = None, ""
        writer.close()

    def _answer(self, request: Message, writer: asyncio.StreamWriter) -> Message:
        if request["do"] == "watch":
            self._watching.add(writer)
            return {"ok": True}
        if request["do"] == "take":
            return self._take(request, writer)
        if request["do"] == "order":
            return self._order(request, writer)
        return _no("unknown", "no such request")

    def _take(self, request: Message, writer: asyncio.StreamWriter) -> Message:
        if self._holder not in (None, writer):
            if not request.get("force"):
                return _no("taken", "another connection has control")
            assert self._holder is not None
            _send(self._holder, {"lost": "control"})
        self._holder, self.grant, self._seq, self._by_hand = writer, secrets.token_hex(16), -1, False
        return {"ok": True, "grant": self.grant}

    def _order(self, request: Message, writer: asyncio.StreamWriter) -> Message:
        if request["order"] != "stop":
            if writer is not self._holder:
                return _no("stale_grant" if "grant" in request else "not_in_control", "you have no control")
            if request.get("grant") != self.grant:
                return _no("stale_grant", "another grant")
            if request["seq"] <= self._seq:
                return _no("replayed", "seq does not grow")
            self._seq = request["seq"]
            self._by_hand = request["order"] in ("step", "turn")
        self.orders.append({k: v for k, v in request.items() if k not in ("do", "id", "grant", "seq")})
        return {"ok": True}


def _no(why: str, say: str) -> Message:
    return {"ok": False, "why": why, "say": say}


def _send(writer: asyncio.StreamWriter, message: Message) -> None:
    if not writer.is_closing():
        writer.write(json.dumps(message).encode() + b"\n")
