# SPDX-License-Identifier: MIT
"""What argusd streams, read in a thread of its own that connects again whenever the socket is lost."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from typing import Final

from argus_tools.control import Client, ControlError, Refused
from argus_tools.control.client import Message

_PAUSE_S: Final = 1.0
_POLL_S: Final = 0.5
_ROOM: Final = 1000


class Watcher:
    """Puts each message of the streams into a queue, and wakes its reader.

    connected: whether the socket stands now. `why_not`: why not, one line.
    """

    def __init__(self, place: str, token: str | None, period_ms: int, wake: Callable[[], None]) -> None:
        self._place, self._token, self._period_ms, self._wake = place, token, period_ms, wake
        self._queue: queue.Queue[Message] = queue.Queue(_ROOM)
        self._ended = threading.Event()
        self.connected = False
        self.why_not = "not tried yet"
        self._thread = threading.Thread(target=self._run, name="argusd", daemon=True)
        self._thread.start()

    def take(self) -> list[Message]:
        """Return what came since the last call."""
        found = []
        while True:
            try:
                found.append(self._queue.get_nowait())
            except queue.Empty:
                return found

    def close(self) -> None:
        """End the thread."""
        self._ended.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._ended.is_set():
            try:
                with Client(self._place, self._token) as argus:
                    argus.watch("events", "state", "readings", period_ms=self._period_ms)
                    self.connected = True
                    self._follow(argus)
            except (ControlError, Refused, TimeoutError) as error:
                self.why_not = str(error)
            self.connected = False
            self._wake()
            self._ended.wait(_PAUSE_S)

    def _follow(self, argus: Client) -> None:
        while not self._ended.is_set():
            try:
                message = argus.message(_POLL_S)
            except TimeoutError:
                continue
            try:
                self._queue.put_nowait(message)
            except queue.Full:
                self._queue.get_nowait()  # who does not read gets the newest
                self._queue.put_nowait(message)
            self._wake()
