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
from typing import NoReturn

from hil_sim.bench.progress import Progress
from hil_sim.bench.store import Record, Store
from hil_sim.core.library import LIBRARY_VARIABLE, library


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


def _terminated(number: int, frame: object) -> NoReturn:
    del number, frame
    raise KeyboardInterrupt


def keep(records: Iterable[Record], store: Store, total: int, todo: int) -> bool:
    """Store records as they come and tell how far it is; False when interrupted.

    total: all missions of the bench, todo: those without a result yet.
    """
    if not todo:
        return True
    progress = Progress(total, total - todo, sys.stderr)
    before = signal.signal(signal.SIGTERM, _terminated)
    try:
        for record in records:
            store.add(record)
            progress.add(record)
    except KeyboardInterrupt:
        return False
    finally:
        signal.signal(signal.SIGTERM, before)
        progress.close()
    return True
