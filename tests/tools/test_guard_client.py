# SPDX-License-Identifier: MIT
"""Rule: where no guard port answers, `argus.connect_guard` raises GuardError with one line that names the place."""

from __future__ import annotations

import socket
import threading

import argus
import pytest


@pytest.mark.parametrize("place", ["", "tcp:", "127.0.0.1:8101", "tcp:host:99999", "unix:/tmp/x"])
def test_a_place_that_is_none_is_named_with_the_forms(place: str) -> None:
    with pytest.raises(argus.GuardError, match=r"give tcp:HOST:PORT or serial:PATH\[@BAUD\]"):
        argus.connect_guard(place)


def test_nobody_there() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        place = f"tcp:127.0.0.1:{server.getsockname()[1]}"
    with pytest.raises(argus.GuardError) as raised:
        argus.connect_guard(place, timeout_s=0.2)
    assert place.removeprefix("tcp:") in str(raised.value)
    assert "\n" not in str(raised.value)
    with pytest.raises(argus.GuardError, match="/no/such/pty"):
        argus.connect_guard("serial:/no/such/pty")


def test_something_that_answers_as_no_robot() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        over = threading.Event()

        def greet() -> None:
            while not over.is_set():
                try:
                    peer, _ = server.accept()
                except OSError:
                    return
                with peer:
                    peer.sendall(b"220 mail ready\r\n")
                    over.wait(60.0)

        thread = threading.Thread(target=greet, daemon=True)
        thread.start()
        place = f"tcp:127.0.0.1:{server.getsockname()[1]}"
        with pytest.raises(argus.GuardError, match="no answer to SYNC0; is a guard port of argusd there"):
            argus.connect_guard(place, timeout_s=0.3)
        over.set()
