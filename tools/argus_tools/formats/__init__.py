# SPDX-License-Identifier: MIT
"""Log formats: readers and writers in pairs over `Chunk`; one module per format, each with its `FORMAT`."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from functools import cache
from io import BufferedReader
from typing import Any, Final

from argus_tools.chunks import (
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
from argus_tools.formats.quoted import Unquoted, unquoted
from argus_tools.formats.recoded import Unreturned, crlf_damage
from argus_tools.formats.source import BLOCK_BYTES, HEAD_BYTES, Source
from argus_tools.formats.telnet import Untelneted
from argus_tools.formats.text import (
    COLOUR,
    Colourless,
    LineFeeds,
    Unmarked,
    begins_as_text,
    ends_in_returns,
    is_text,
    unmarked,
)
from argus_tools.formats.wrapped import Wrap, unwrapped
from argus_tools.timeline import Timeline

__all__ = [
    "Chunk", "Damage", "Direction", "Format", "Log", "LogError", "ReadOptions", "Reader", "Writer",
    "find_format", "format_of_name", "formats", "forms", "open_log",
]  # fmt: skip

# Of text that comes through a pipe so much is waited for before it is taken for raw bytes: prose may stand above a log.
_TEXT_HEAD_BYTES: Final = HEAD_BYTES
_LINES_MIN, _LIVE_BYTES = 3, 1 << 12

# In the order in which they are tried on a file: first what begins with a mark of its own, then text.
# Hexadecimal text may hold anything, so it comes after. "bin" takes whatever no other form claims. Each
# module has a FORMAT, or FORMATS where several are alike.
MODULES: Final = (
    "record", "pcapng", "pcap", "bag", "canlog", "recoded", "tsharkjson", "columns", "jsonl", "candump",
    "canlines", "cancsv", "framedump", "numdump", "others", "hexdump", "hexwords", "hextext", "bin",
)  # fmt: skip


@cache
def forms() -> tuple[Format, ...]:
    """Return all forms that are recognised, read or not, in the order of detection."""
    found: list[Format] = []
    for name in MODULES:
        module = importlib.import_module(f"argus_tools.formats.{name}")
        found += getattr(module, "FORMATS", None) or (module.FORMAT,)
    return tuple(found)


def formats() -> dict[str, Format]:
    """Return the formats that are read, by name, in the order of detection."""
    return {form.name: form for form in forms() if form.is_read}


def find_format(head: bytes) -> Format:
    """Return the first form that claims a file which begins with `head`; a mark before text is none of it."""
    text = unmarked(head)
    return next(form for form in forms() if form.sniff(text))


def is_recognised(head: bytes) -> bool:
    """Whether no more of a file is needed to say what it is; raw bytes are known by what is no text."""
    form = find_format(head)
    if form.name != "bin" or not is_text(head) or len(head) >= _TEXT_HEAD_BYTES:
        return True
    # A live log behind a prefix is not kept waiting.
    few = head.count(b"\n") >= _LINES_MIN and len(head) <= _LIVE_BYTES
    return few and unwrapped(unmarked(head), form, list(formats().values()), ReadOptions()) is not None


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
        is_enough = (lambda _: True) if format_name or self.options.columns else is_recognised
        self.source = Source(path, is_enough=is_enough, **source)
        self.options.is_zipped = self.source.is_zipped
        self.options.skipped = self.source.skipped
        if not self.source.head:
            what = self.source.damage[0].what if self.source.damage else "is empty"
            raise LogError(f"{path}: {what}")
        if self.options.columns and not format_name:
            is_json = self.source.head.lstrip()[:1] in (b"{", b"[")
            format_name = "range-json" if is_json else "range-csv"
        returned = crlf_damage(self.source.head)
        head = self.source.head.replace(b"\r\n", b"\n") if returned else self.source.head
        self.format = formats()[format_name] if format_name else find_format(head)
        stream = self._cleaned() if format_name else self._opened()
        if returned:
            self.source.damage.correct(returned)
            stream = BufferedReader(Unreturned(stream), BLOCK_BYTES)
        self._reader = self.format.reader(stream, self.options)

    def _opened(self) -> BufferedReader:
        """Return the log's text without what it is inside of, if it is; its form is that of what is inside."""
        inner = self._quoted()
        wrap = None if inner else self._wrapped()
        self.format = wrap.form if wrap else inner or self.format
        stream = self._cleaned()
        if inner:
            return BufferedReader(Unquoted(stream), BLOCK_BYTES)
        if wrap is None:
            return stream
        for told in wrap.told():
            self.source.damage.append(told)
        return BufferedReader(wrap.stream(stream), BLOCK_BYTES)

    def _cleaned(self) -> BufferedReader:
        """Return the file's bytes; those of a text with LF at its ends of lines, without colours and marks."""
        stream: BufferedReader = BufferedReader(self.source, BLOCK_BYTES)
        if self.format.name == "bin" or not begins_as_text(self.source.head):
            return stream
        if ends_in_returns(self.source.head):
            stream = BufferedReader(LineFeeds(stream), BLOCK_BYTES)
        if COLOUR.search(self.source.head):
            stream = BufferedReader(Colourless(stream), BLOCK_BYTES)
        return BufferedReader(Unmarked(stream), BLOCK_BYTES)

    def _quoted(self) -> Format | None:
        """Return the form of what a mail quotes; a ">" alone may also be a terminal program's mark of direction."""
        head = unquoted(unmarked(self.source.head))
        if head is None:
            return None
        inner = find_format(head)
        return None if inner.name in ("bin", "hextext", "hexwords", self.format.name) else inner

    def _wrapped(self) -> Wrap | None:
        """Return what the log is inside of, if it is."""
        read = list(formats().values())
        return unwrapped(unmarked(self.source.head), self.format, read, self.options)

    @property
    def damage(self) -> list[Damage]:
        """What was skipped so far, of the file and in it."""
        return self.source.damage + self._reader.damage

    @property
    def damage_lists(self) -> tuple[DamageList, DamageList]:
        """The two lists that `damage` is made of, which grow as the log is read."""
        return self.source.damage, self._reader.damage

    def __iter__(self) -> Iterator[Chunk]:
        reader, damage = self._reader, self._reader.damage
        # What is live is not held up for a look at it.
        is_whole = self.source.is_regular and not self.source.is_followed
        chunks = Untelneted(reader, damage) if is_whole else reader
        return iter(Timeline(chunks, damage, self.source.is_followed))


def open_log(path: str, format_name: str | None = None, **options: Any) -> Log:
    """Open a log file, or standard input for "-"; `options` are those of ReadOptions.

    >>> sum(len(chunk.data) for chunk in open_log("tests/data/captures/m_p3dx.jsonl"))
    3232
    """
    return Log(path, format_name, ReadOptions(**options))
