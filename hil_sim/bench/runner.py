# SPDX-License-Identifier: MIT
"""What all benches run by: one and the same fault manager for every process, and results kept as they come."""

from __future__ import annotations

import hashlib
import os
import shutil
import signal
import sys
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from hil_sim.bench.progress import Progress
from hil_sim.bench.store import Record, Store
from hil_sim.core.library import LIBRARY_VARIABLE, library
from hil_sim.sil.loop import Loop


@contextmanager
def fixed_core() -> Iterator[str]:
    """Give every process one and the same fault manager, even if it is built again meanwhile; yield its digest."""
    path = Path(str(library()._name))
    with tempfile.TemporaryDirectory(prefix="argus-core-") as folder:
        copy = Path(folder) / path.name
        shutil.copyfile(path, copy)
        before = os.environ.get(LIBRARY_VARIABLE)
        os.environ[LIBRARY_VARIABLE] = str(copy)
        try:
            yield hashlib.sha256(copy.read_bytes()).hexdigest()
        finally:
            if before is None:
                os.environ.pop(LIBRARY_VARIABLE)
            else:
                os.environ[LIBRARY_VARIABLE] = before


class _Interrupt:
    """Ends a bench, at once or, where C is at work on a mission, behind it: what C calls must not raise, and what is
    raised before the first line of such a call is lost."""

    def __init__(self) -> None:
        self.came = False

    def __call__(self, number: int, frame: FrameType | None) -> None:
        del number
        self.came = True
        while frame is not None and frame.f_code is not Loop.run.__code__:
            frame = frame.f_back
        if frame is None:
            raise KeyboardInterrupt

    @contextmanager
    def watched(self) -> Iterator[None]:
        """Take Ctrl-C and SIGTERM."""
        before = [(number, signal.signal(number, self)) for number in (signal.SIGINT, signal.SIGTERM)]
        try:
            yield
        finally:
            for number, handler in before:
                signal.signal(number, handler)


def keep(records: Iterable[Record], store: Store, total: int, todo: int) -> bool:
    """Store records as they come and tell how far it is; False when interrupted.

    total: all missions of the bench, todo: those without a result yet.
    """
    if not todo:
        return True
    progress = Progress(total, total - todo, sys.stderr)
    interrupt = _Interrupt()
    try:
        with interrupt.watched():
            for record in records:
                store.add(record)
                progress.add(record)
                if interrupt.came:
                    return False
    except KeyboardInterrupt:
        return False
    finally:
        progress.close()
    return True
