# SPDX-License-Identifier: MIT
"""Rule: into argus-foxglove come programs, Foxglove's page and those that were allowed; no page of another site, and
nobody under a name that was led to this machine."""

from __future__ import annotations

import contextlib
import doctest
import ipaddress
import socket
import threading
import time
from collections.abc import Iterator

import pytest
from argus_tools import foxglove_bridge, foxglove_front
from argus_tools.foxglove_bridge import parser
from argus_tools.foxglove_front import Front, Gate, headers_of, hidden_host

# A guard against what hangs, not a rule.
PATIENCE_S = 120.0
ANSWER = b"HTTP/1.1 101 Switching Protocols\r\n\r\n"


class Behind:
    """A server that keeps what it is sent, answers a request, and then says back what comes."""

    def __init__(self) -> None:
        self.socket = socket.create_server(("127.0.0.1", 0))
        self.heard: list[bytes] = []
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        while True:
            try:
                near, _ = self.socket.accept()
            except OSError:
                return
            threading.Thread(target=self._talk, args=(near,), daemon=True).start()

    def _talk(self, near: socket.socket) -> None:
        with near:
            self.heard.append(near.recv(65536))
            near.sendall(ANSWER)
            while data := near.recv(65536):
                near.sendall(data)


@pytest.fixture
def behind() -> Iterator[Behind]:
    made = Behind()
    yield made
    made.socket.close()


@pytest.fixture
def front(behind: Behind) -> Iterator[Front]:
    made = Front("127.0.0.1", 0, Gate("127.0.0.1", ["https://viewer.example"]))
    made.start(*behind.socket.getsockname())
    yield made
    made.stop()


def request(*headers: str, first: str = "GET / HTTP/1.1") -> bytes:
    """A request for a WebSocket, with these headers besides."""
    lines = [first, "Upgrade: websocket", "Connection: Upgrade", *headers]
    return "".join(f"{line}\r\n" for line in [*lines, ""]).encode("latin-1")


def asked(front: Front, data: bytes) -> bytes:
    """What the port says to a request until it has nothing more to say, or has let the caller in."""
    with socket.create_connection(("127.0.0.1", front.port), PATIENCE_S) as caller:
        caller.sendall(data)
        said = b""
        while not said.startswith(ANSWER) and (part := caller.recv(65536)):
            said += part
        return said


def test_the_examples_in_the_sources_are_true() -> None:
    for module in (foxglove_front, foxglove_bridge):
        result = doctest.testmod(module)
        assert result.attempted > 0
        assert result.failed == 0


@pytest.mark.parametrize(
    ("host", "allowed"),
    [
        ("127.0.0.1:8765", True),
        ("localhost:9000", True),
        ("LOCALHOST", True),
        ("[::1]:8765", True),
        ("127.0.0.1.evil.example:8765", False),
        ("localhost.evil.example", False),
        ("evil.example@127.0.0.1", False),
        ("evil.example", False),
        ("192.168.1.5:8765", False),
        ("", False),
    ],
)
def test_only_under_an_address_of_this_machine(host: str, allowed: bool) -> None:
    assert (Gate("127.0.0.1").why_refused({"upgrade": "websocket", "host": host}) == "") is allowed


@pytest.mark.parametrize(
    ("host", "allowed"),
    [
        ("192.168.1.5:8765", True),
        ("[fe80::1]:8765", True),
        ("127.0.0.1", True),
        ("robot.example", False),
        ("999.1.1.1", False),
    ],
)
def test_beyond_loopback_any_address_but_no_name(host: str, allowed: bool) -> None:
    assert (Gate("0.0.0.0").why_refused({"upgrade": "websocket", "host": host}) == "") is allowed


def test_the_name_that_it_was_told_to_serve_is_its_own() -> None:
    assert Gate("robot.example").why_refused({"upgrade": "websocket", "host": "Robot.Example:8765"}) == ""


@pytest.mark.parametrize(
    ("origin", "allowed"),
    [
        (None, True),
        ("https://app.foxglove.dev", True),
        ("https://studio.foxglove.dev", True),
        ("file://", True),
        ("foxglove://app", True),
        ("http://localhost:8080", True),
        ("https://localhost", True),
        ("http://127.0.0.1:3000", True),
        ("https://viewer.example", True),
        ("HTTPS://VIEWER.EXAMPLE", True),
        ("http://app.foxglove.dev", False),
        ("https://app.foxglove.dev.evil.example", False),
        ("https://app.foxglove.dev:444", False),
        ("https://evil.example", False),
        ("http://localhost.evil.example", False),
        ("http://localhost@evil.example", False),
        ("null", False),
        ("", False),
    ],
)
def test_only_pages_of_foxglove_of_this_machine_and_those_allowed(origin: str | None, allowed: bool) -> None:
    headers = {"upgrade": "websocket", "host": "localhost:8765"} | (
        {} if origin is None else {"origin": origin}
    )
    assert (Gate("127.0.0.1", ["https://viewer.example"]).why_refused(headers) == "") is allowed


@pytest.mark.parametrize(
    "data",
    [
        request("Host: localhost", "Host: evil.example"),
        request("Host: localhost", "Origin: file://", "Origin: https://evil.example"),
        request("Host: localhost", " folded: x"),
        request("Host : evil.example", "Host: localhost"),
        request("Host: localhost\nHost: evil.example"),
        request("Host: localhost", first="POST / HTTP/1.1"),
        request("Host: localhost", first="GET / HTTP/1.0"),
        request("Host: localhost", first="nonsense"),
    ],
)
def test_what_can_be_read_in_two_ways_is_refused(front: Front, behind: Behind, data: bytes) -> None:
    assert headers_of(data) is None
    assert asked(front, data).startswith(b"HTTP/1.1 400 ")
    assert behind.heard == []


@pytest.mark.parametrize(
    "headers",
    [
        ("Host: evil.example:8765",),
        ("Host: localhost:8765", "Origin: https://evil.example"),
        ("Host: localhost:8765", "Origin: null"),
    ],
)
def test_another_site_gets_403_and_never_meets_the_server(
    front: Front, behind: Behind, headers: tuple[str, ...]
) -> None:
    said = asked(front, request(*headers))
    assert said.startswith(b"HTTP/1.1 403 Forbidden\r\n")
    assert b"Access-Control" not in said
    assert behind.heard == []


def test_what_asks_for_no_websocket_is_refused(front: Front, behind: Behind) -> None:
    said = asked(front, b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
    assert said.startswith(b"HTTP/1.1 403 ")
    assert behind.heard == []


def test_who_may_come_in_is_joined_to_the_server(front: Front, behind: Behind) -> None:
    data = request("Host: localhost:8765", "Origin: https://app.foxglove.dev")
    with socket.create_connection(("127.0.0.1", front.port), PATIENCE_S) as caller:
        caller.sendall(data)
        assert caller.recv(65536) == ANSWER
        assert behind.heard == [data]
        much = bytes(range(256)) * 8000
        sender = threading.Thread(target=caller.sendall, args=(much,))
        sender.start()
        said = b""
        while len(said) < len(much):
            said += caller.recv(65536)
        sender.join()
        assert said == much


def test_a_caller_that_says_too_much_or_nothing_is_hung_up_on(
    front: Front, behind: Behind, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(foxglove_front, "HEAD_WITHIN_S", 0.2)
    for data in (b"", b"GET / HT", b"GET / HTTP/1.1\r\nx: " + b"y" * 20_000):
        with socket.create_connection(("127.0.0.1", front.port), PATIENCE_S) as caller:
            caller.sendall(data)
            with contextlib.suppress(ConnectionResetError):
                assert caller.recv(100) == b""
    assert behind.heard == []


def test_too_many_are_turned_away(front: Front, behind: Behind, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(foxglove_front, "CONNECTIONS_MAX", 1)
    with socket.create_connection(("127.0.0.1", front.port), PATIENCE_S) as caller:
        caller.sendall(request("Host: localhost"))
        assert caller.recv(65536) == ANSWER
        assert asked(front, request("Host: localhost")).startswith(b"HTTP/1.1 503 ")
    until = time.monotonic() + PATIENCE_S
    while not asked(front, request("Host: localhost")).startswith(ANSWER):
        assert time.monotonic() < until, "the place of one who left is free again"


def test_the_end_hangs_up_on_all(behind: Behind) -> None:
    front = Front("127.0.0.1", 0, Gate("127.0.0.1"))
    front.start(*behind.socket.getsockname())
    with socket.create_connection(("127.0.0.1", front.port), PATIENCE_S) as caller:
        caller.sendall(request("Host: localhost"))
        assert caller.recv(65536) == ANSWER
        front.stop()
        assert caller.recv(100) == b""


def test_the_server_behind_is_where_no_page_finds_it() -> None:
    found = {hidden_host() for _ in range(50)}
    assert all(ipaddress.ip_address(host).is_loopback for host in found)
    assert len(found) > 40


@pytest.mark.parametrize("text", ["*", "null", "viewer.example", "https://a/b", "javascript:x", ""])
def test_an_origin_that_is_none_is_told(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        parser().parse_args(["--allow-origin", text])
    assert ended.value.code == 2
    assert "is no origin" in capsys.readouterr().err
