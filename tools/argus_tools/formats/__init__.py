# SPDX-License-Identifier: MIT
"""Log formats: readers and writers in pairs over `Chunk`; one module per format, each with its `FORMAT`."""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Iterator
from functools import cache
from io import BufferedReader
from typing import Any, Final

from argus_tools.formats.base import (
    Chunk,
    Damage,
    DamageList,
    Direction,
    Format,
    LogError,
    Reader,
    ReadOptions,
    Writer,
)
from argus_tools.formats.source import BLOCK_BYTES, Source

__all__ = [
    "Chunk", "Damage", "Direction", "Format", "Log", "LogError", "ReadOptions", "Reader", "Writer",
    "find_format", "format_of_name", "formats", "open_log",
]  # fmt: skip

# In the order in which they are tried on a file; "bin" takes whatever no other format claims.
MODULES: Final = (
    "record", "pcapng", "pcap", "jsonl", "candump", "hexdump", "hextext", "bin",
)  # fmt: skip


@cache
def formats() -> dict[str, Format]:
    """Return all formats by name, in the order of detection."""
    found = {}
    for name in MODULES:
        if importlib.util.find_spec(f"argus_tools.formats.{name}"):
            module = importlib.import_module(f"argus_tools.formats.{name}")
            found[name] = module.FORMAT
    return found


def find_format(head: bytes) -> Format:
    """Return the first format that claims a file which begins with `head`."""
    return next(format_ for format_ in formats().values() if format_.sniff(head))


def format_of_name(path: str) -> Format | None:
    """Return the writable format that a file name asks for by its suffix, None if it asks for none."""
    name = path.removesuffix(".gz").lower()
    chosen = (f for f in formats().values() if f.writer and name.endswith(f.suffixes))
    return next(chosen, None)


class Log:
    """One opened log: iterate it for its chunks, look at `damage` for what could not be read.

    The format is detected from the contents unless `format_name` gives it. Raises LogError when there is
    nothing to read.
    """

    def __init__(
        self, path: str, format_name: str | None = None, options: ReadOptions | None = None, **source: Any
    ) -> None:
        self.options = options or ReadOptions()
        self.options.name = path
        self.source = Source(path, **source)
        if not self.source.head:
            what = self.source.damage[0].what if self.source.damage else "is empty"
            raise LogError(f"{path}: {what}")
        self.format = formats()[format_name] if format_name else find_format(self.source.head)
        stream: BufferedReader = BufferedReader(self.source, BLOCK_BYTES)
        self._reader = self.format.reader(stream, self.options)

    @property
    def damage(self) -> list[Damage]:
        """What was skipped so far, of the file and in it."""
        return self.source.damage + self._reader.damage

    @property
    def damage_lists(self) -> tuple[DamageList, DamageList]:
        """The two lists that `damage` is made of, which grow as the log is read."""
        return self.source.damage, self._reader.damage

    def __iter__(self) -> Iterator[Chunk]:
        return iter(self._reader)


def open_log(path: str, format_name: str | None = None, **options: Any) -> Log:
    """Open a log file, or standard input for "-"; `options` are those of ReadOptions.

    >>> sum(len(chunk.data) for chunk in open_log("tests/data/captures/m_p3dx.jsonl"))
    3232
    """
    return Log(path, format_name, ReadOptions(**options))
