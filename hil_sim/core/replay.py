# SPDX-License-Identifier: MIT
"""Feeds recorded packets of a robot to a fault manager, as fast as it takes them."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from pathlib import Path
from typing import Final, NamedTuple

from hil_sim.core.library import health_name, init_of, kind_name, load_library, settings

_CHANGES: Final = 4096
_FIELDS: Final = 4


class Change(NamedTuple):
    """A sonar's health or kind changed."""

    t_s: float
    sonar: int
    health: str
    kind: str


class Engine:
    """A libargus.so by its path: the present one, or a variant of it."""

    def __init__(self, path: Path) -> None:
        self._library = load_library(path)

    def replay(
        self, times_ms: bytes, lengths: bytes, packets: bytes, given: Mapping[str, int]
    ) -> list[Change]:
        """Return what a new manager with these settings makes of packets that come at these times.

        times_ms: 32 bits each, lengths: 16 bits each, in the byte order of this machine; packets: one after the other.
        """
        library, count = self._library, len(lengths) // 2
        core = (ctypes.c_uint64 * -(-library.argus_shim_core_size() // 8))()
        config = ctypes.create_string_buffer(library.argus_shim_config_size())
        library.argus_config_default(config)
        for key, value in given.items():
            library.argus_shim_config_set(config, settings()[key][0], value)
        init_of(library)(core, config, 0)
        room = _CHANGES
        rows = (ctypes.c_uint32 * (_FIELDS * room))()
        found = library.argus_shim_replay(core, times_ms, lengths, count, packets, rows, room)
        flat = list(rows[: _FIELDS * min(found, room)])
        if found > room:
            raise OverflowError(f"{found} changes of health, more than the {room} that are kept")
        return [
            Change(flat[i] / 1000, flat[i + 1], health_name(flat[i + 2]), kind_name(flat[i + 3]))
            for i in range(0, len(flat), _FIELDS)
        ]
