# SPDX-License-Identifier: MIT
"""What argusd streams, read in a thread that connects again whenever the socket is lost or carries nothing."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Final

from argus_tools.control import Client, ControlError, Refused
from argus_tools.control.client import Message

_PAUSE_S: Final = 0.5
_POLL_S: Final = 0.25
_REPLY_S: Final = 2.0
_ROOM: Final = 1000
_SILENT_S: Final = 1.0
_SILENT_PERIODS: Final = 1.5


class Watcher:
    """Keeps each message of the streams with the number of its connection, and wakes its reader.

    connected: whether the socket stands now. `why_not`: why not, one line. A connection that carries nothing for
    longer than states come apart is lost: argusd hangs.
    """

    def __init__(self, place: str, token: str | None, period_ms: int, wake: Callable[[], None]) -> None:
        self._place, self._token, self._period_ms, self._wake = place, token, period_ms, wake
        self._silent_s = max(_SILENT_S, _SILENT_PERIODS * period_ms / 1000)
        self._kept: deque[tuple[int, Message]] = deque(maxlen=_ROOM)  # who does not read gets the newest
        self._ended = threading.Event()
        self.connected = False
        self.connection = 0
        self.why_not = "not tried yet"
        self._thread = threading.Thread(target=self._run, name="argusd", daemon=True)
        self._thread.start()

    def take(self) -> list[tuple[int, Message]]:
        """Return what came since the last call, each with the number of its connection: times of two do not compare."""
        found = []
        while self._kept:
            found.append(self._kept.popleft())
        return found

    def close(self) -> None:
        """End the thread."""
        self._ended.set()
        self._thread.join(2 * _REPLY_S)

    def _run(self) -> None:
        while not self._ended.is_set():
            try:
                with Client(self._place, self._token, timeout_s=_REPLY_S) as argus:
                    argus.watch("events", "state", "readings", period_ms=self._period_ms)
                    self.connection += 1
                    self.connected = True
                    self._follow(argus)
            except (ControlError, Refused, TimeoutError) as error:
                self.why_not = str(error)
            self.connected = False
            self._wake()
            self._ended.wait(_PAUSE_S)

    def _follow(self, argus: Client) -> None:
        heard_s = time.monotonic()
        while not self._ended.is_set():
            try:
                message = argus.message(_POLL_S)
            except TimeoutError:
                if time.monotonic() - heard_s > self._silent_s:
                    raise
                continue
            heard_s = time.monotonic()
            self._kept.append((self.connection, message))
            self._wake()
