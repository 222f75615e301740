# SPDX-License-Identifier: MIT
"""A client of argusd's control socket that waits for each reply; what is streamed meanwhile is kept."""

from __future__ import annotations

import json
import os
import socket
import time
from collections import deque
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self

DEFAULT_PLACE: Final = "unix:/run/argus/control"
LINE_MAX: Final = 16384
VERSION: Final = 1

Message = dict[str, Any]


class ControlError(Exception):
    """The socket cannot be reached, or what is there does not speak this protocol; the message is one line."""


class Refused(Exception):
    """A request was refused; `why` is the code, the text a sentence."""

    def __init__(self, why: str, say: str) -> None:
        super().__init__(say)
        self.why = why


def default_place(robot: str = "") -> str:
    """Return where argusd is looked for: ARGUS_CONTROL, else where its unit listens, or that of one robot of more."""
    place = f"unix:/run/argus/{robot}/control" if robot else DEFAULT_PLACE
    return os.environ.get("ARGUS_CONTROL") or place


def read_token(path: Path) -> str:
    """Return the first line of a token file."""
    try:
        with path.open(encoding="utf-8") as file:
            return file.readline().strip()
    except (OSError, UnicodeDecodeError) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else "no text"
        raise ControlError(f"{path}: {reason}") from None


def _connect(place: str, timeout_s: float) -> socket.socket:
    scheme, _, rest = place.partition(":")
    if scheme == "unix" and rest:
        sock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        sock.settimeout(timeout_s)
        try:
            sock.connect(rest)
        except OSError:
            sock.close()
            raise
        return sock
    host, _, port = rest.rpartition(":")
    if scheme == "tcp" and host and port.isdigit() and int(port) < 65536:
        sock = socket.create_connection((host.strip("[]"), int(port)), timeout_s)
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return sock
    raise ControlError(f"{place}: give unix:PATH or tcp:HOST:PORT")


class Client:
    """A connection to argusd; a context manager.

    with Client("unix:/run/argus/control") as argus:
        print(argus.request("status")["state"]["mode"])
        argus.take()
        argus.order("turn", deg=90)
    """

    def __init__(self, place: str | None = None, token: str | None = None, timeout_s: float = 10.0) -> None:
        self.place = place or default_place()
        self._timeout_s = timeout_s
        self._streamed: deque[Message] = deque()
        self._rest = b""
        self._id = 0
        self._seq = 0
        self._grant: str | None = None
        try:
            self._socket = _connect(self.place, timeout_s)
        except OSError as problem:
            reason = problem.strerror or str(problem)
            raise ControlError(
                f"{self.place}: {reason}; is argusd running there with --control, as this user?"
            ) from None
        try:
            self._greet(token)
        except BaseException:
            self.close()
            raise

    def _greet(self, token: str | None) -> None:
        self.greeting = self._read(time.monotonic() + self._timeout_s)
        if self.greeting.get("control") != VERSION:
            raise ControlError(f"{self.place}: this is no control socket of version {VERSION}")
        if self.greeting.get("auth") == "token":
            if token is None:
                raise ControlError(f"{self.place}: a token is asked for; give --token FILE")
            self.request("hello", token=token)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """End the connection; a motion by hand that goes on is stopped by argusd."""
        self._socket.close()

    def fileno(self) -> int:
        """Return the socket's number, to wait on."""
        return self._socket.fileno()

    def _read(self, until: float) -> Message:
        while b"\n" not in self._rest:
            self._socket.settimeout(max(0.001, until - time.monotonic()))
            try:
                data = self._socket.recv(65536)
            except TimeoutError:
                raise TimeoutError(f"{self.place}: nothing was said in time") from None
            except OSError as problem:
                raise ControlError(f"{self.place}: {problem.strerror or problem}") from None
            if not data:
                raise ControlError(f"{self.place}: argusd has closed the connection")
            self._rest += data
            if len(self._rest) > 64 * LINE_MAX:
                raise ControlError(f"{self.place}: this is no control socket")
        line, _, self._rest = self._rest.partition(b"\n")
        try:
            message = json.loads(line)
        except ValueError:
            message = None
        if not isinstance(message, dict):
            raise ControlError(f"{self.place}: this is no control socket")
        return message

    def request(self, do: str, **members: Any) -> Message:
        """Send a request and return its reply; Refused when it is not ok."""
        self._id += 1
        line = json.dumps({"do": do, "id": self._id, **members}, separators=(",", ":")).encode() + b"\n"
        until = time.monotonic() + self._timeout_s
        try:
            self._socket.settimeout(self._timeout_s)
            self._socket.sendall(line)
        except OSError as problem:
            raise ControlError(f"{self.place}: {problem.strerror or problem}") from None
        while True:
            message = self._read(until)
            if "re" not in message:
                self._streamed.append(message)
            elif message["re"] == self._id:
                break
            elif message["re"] is None and message.get("ok") is False:
                break  # about the whole line, or all places are taken
        if not message.get("ok"):
            raise Refused(str(message.get("why", "refused")), str(message.get("say", "no reason is given")))
        return message

    def take(self, force: bool = False) -> None:
        """Take control; Refused with `taken` when another has it."""
        self._grant = str(self.request("take", force=force)["grant"])
        self._seq = 0

    def order(self, order: str, **members: Any) -> str | None:
        """Give an order, and return what is to be noted of it; control must have been taken, but for `stop`."""
        self._seq += 1
        entitled = {"grant": self._grant, "seq": self._seq} if self._grant is not None else {}
        note = self.request("order", order=order, **entitled, **members).get("say")
        return None if note is None else str(note)

    def watch(self, *topics: str, period_ms: int = 500) -> None:
        """Ask for streams; message() yields them."""
        self.request("watch", topics=list(topics), period_ms=period_ms)

    def message(self, timeout_s: float | None = None) -> Message:
        """Return the next message of a stream; TimeoutError when none comes in time (None: a year)."""
        if self._streamed:
            return self._streamed.popleft()
        return self._read(time.monotonic() + (3e7 if timeout_s is None else timeout_s))
