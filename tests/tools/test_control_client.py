# SPDX-License-Identifier: MIT
"""Rule: the client of the control socket keeps replies and streams apart, and what is no argusd is one clear line."""

from __future__ import annotations

import doctest
import json
import socket
import threading
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest
from argus_tools.control import Client, ControlError, Refused, cli, words
from argus_tools.formats import record

GREETING = {"control": 1, "argus": "0.1.0", "auth": "none"}


@pytest.mark.parametrize("module", [cli, words, record])
def test_the_examples_in_the_sources_are_true(module: ModuleType) -> None:
    result = doctest.testmod(module)
    assert result.attempted > 0
    assert result.failed == 0


def serve(folder: Path, talk: Callable[[socket.socket], None]) -> str:
    """Let TALK speak to the first who connects; return the place."""
    path = folder / "s"
    listening = socket.socket(socket.AF_UNIX)
    listening.bind(str(path))
    listening.listen()

    def run() -> None:
        near, _ = listening.accept()
        with near, listening:
            talk(near)

    threading.Thread(target=run, daemon=True).start()
    return f"unix:{path}"


def lines(*messages: object) -> bytes:
    return b"".join(json.dumps(message).encode() + b"\n" for message in messages)


def test_what_is_streamed_before_a_reply_is_kept(tmp_path: Path) -> None:
    def talk(near: socket.socket) -> None:
        near.sendall(lines(GREETING))
        near.recv(4096)
        near.sendall(
            lines({"event": "A"}, {"re": 99, "ok": True}, {"re": 1, "ok": True, "x": 5}, {"event": "B"})
        )
        near.recv(4096)

    with Client(serve(tmp_path, talk)) as client:
        assert client.request("status")["x"] == 5
        assert [client.message(10)["event"] for _ in range(2)] == ["A", "B"]


def test_a_refusal_has_its_code_and_sentence(tmp_path: Path) -> None:
    def talk(near: socket.socket) -> None:
        near.sendall(lines(GREETING))
        near.recv(4096)
        near.sendall(lines({"re": 1, "ok": False, "why": "taken", "say": "another has it"}))

    with Client(serve(tmp_path, talk)) as client, pytest.raises(Refused, match="another has it") as refusal:
        client.take()
    assert refusal.value.why == "taken"


@pytest.mark.parametrize(
    ("first", "part"),
    [
        (b"SSH-2.0-x\n", "this is no control socket"),
        (lines({"control": 2}), "no control socket of version 1"),
        (lines({**GREETING, "auth": "token"}), "a token is asked for"),
        (b"", "has closed the connection"),
        (b"x" * 2_000_000, "this is no control socket"),
    ],
)
def test_what_is_no_argusd_is_told(tmp_path: Path, first: bytes, part: str) -> None:
    def talk(near: socket.socket) -> None:
        try:
            near.sendall(first)
        except OSError:
            return

    with pytest.raises(ControlError, match=part) as problem:
        Client(serve(tmp_path, talk))
    assert "\n" not in str(problem.value)


@pytest.mark.parametrize("place", ["", "unix:", "tcp:127.0.0.1", "tcp:127.0.0.1:99999", "http://x"])
def test_a_place_that_cannot_be_is_told(place: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ARGUS_CONTROL", raising=False)
    if place:
        with pytest.raises(ControlError, match="give unix:PATH or tcp:HOST:PORT"):
            Client(place)
    else:
        with pytest.raises(ControlError, match="unix:/run/argus/control"):
            Client(place)
