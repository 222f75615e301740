# SPDX-License-Identifier: MIT
"""Work in a process of its own, beside what waits for robots: it has the cores while no robot asks for them."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Final, TypeVar

T = TypeVar("T")
YIELDING: Final = 10
FORK: Final = multiprocessing.get_context("fork")
"""What is done beside is what this process knows: functions are handed over as they are."""

_aside = False


def yield_cores(session: int) -> None:
    """Let SESSION, just begun, have the cores after all others where this process stands aside.

    Linux may share cores among sessions first and look at niceness within one only (see sched(7), autogroups).
    """
    if _aside:
        with suppress(OSError):
            Path(f"/proc/{session}/autogroup").write_text(str(YIELDING), encoding="ascii")


def _stand_aside(work: Callable[[], T], to: Connection) -> None:
    """Do WORK behind all others, and hand over what it returns. Ctrl-C reaches both; who began this ends it."""
    global _aside
    _aside = True
    signal.signal(signal.SIGINT, lambda _number, _frame: None)
    os.nice(YIELDING)
    to.send(work())


@contextmanager
def beside(work: Callable[[], T]) -> Iterator[Callable[[], T]]:
    """Do WORK meanwhile; what is yielded waits for what it returns. It is ended when this is left by an error.

    Raises:
        EOFError: from what is yielded, if the work ended without a result.
    """
    here, there = FORK.Pipe(duplex=False)
    process = FORK.Process(target=_stand_aside, args=(work, there))
    process.start()
    there.close()
    try:
        yield here.recv
    except BaseException:
        process.terminate()
        raise
    finally:
        process.join()
        here.close()
