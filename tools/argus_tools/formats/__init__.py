# SPDX-License-Identifier: MIT
"""Log formats: readers and writers in pairs over `Chunk`; one module per format, each with its `FORMAT`."""

from __future__ import annotations

import importlib
import importlib.util
from functools import cache
from typing import Final

from argus_tools.formats.base import Chunk, Damage, Direction, Format, LogError, Reader, ReadOptions, Writer

__all__ = ["Chunk", "Damage", "Direction", "Format", "LogError", "ReadOptions", "Reader", "Writer", "formats"]

# In the order in which they are tried on a file; "bin" takes whatever no other format claims.
MODULES: Final = ("record", "pcapng", "pcap", "jsonl", "candump", "bin")


@cache
def formats() -> dict[str, Format]:
    """Return all formats by name, in the order of detection."""
    found = {}
    for name in MODULES:
        if importlib.util.find_spec(f"argus_tools.formats.{name}"):
            module = importlib.import_module(f"argus_tools.formats.{name}")
            found[name] = module.FORMAT
    return found
