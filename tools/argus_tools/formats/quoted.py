# SPDX-License-Identifier: MIT
"""Text that a mail program quoted: each line without the "> " before it."""

from __future__ import annotations

import re
from io import BufferedReader, RawIOBase
from typing import TYPE_CHECKING, Final

from argus_tools.formats.text import is_text

if TYPE_CHECKING:
    from _typeshed import WriteableBuffer

_LINE_MAX: Final = 1 << 14
_BLOCK: Final = 1 << 17
_QUOTE: Final = re.compile(rb"(?:[ ]?>)+[ ]?")


def unquoted(head: bytes) -> bytes | None:
    """Return the beginning of a file without the marks of a quotation; None if most of its lines have none."""
    if not is_text(head):
        return None
    lines = head.splitlines(keepends=True)
    written = [line for line in lines if line.strip()]
    marked = sum(line.startswith(b">") for line in written)
    if not marked or 2 * marked <= len(written):
        return None
    return b"".join(_QUOTE.sub(b"", line, count=1) if line.startswith(b">") else line for line in lines)


class Unquoted(RawIOBase):
    """The lines of a stream without those marks."""

    def __init__(self, stream: BufferedReader) -> None:
        self._stream = stream
        self._ready = b""
        self._line = b""
        self._begins = True

    def readable(self) -> bool:
        """It is for reading only."""
        return True

    def readinto(self, buffer: WriteableBuffer, /) -> int:
        """Fill the buffer with what there is; 0 at the end."""
        while not self._ready:
            data = self._stream.read1(_BLOCK)
            self._ready = self._unquoted(self._line + data, is_end=not data)
            if not data:
                break
        view = memoryview(buffer).cast("B")
        taken = self._ready[: len(view)]
        view[: len(taken)] = taken
        self._ready = self._ready[len(taken) :]
        return len(taken)

    def _unquoted(self, data: bytes, is_end: bool) -> bytes:
        """Return whole lines without their marks; what is begun waits, unless it is long."""
        lines = data.splitlines(keepends=True)
        waits = bool(lines) and not is_end and not lines[-1].endswith(b"\n") and len(lines[-1]) < _LINE_MAX
        self._line = lines.pop() if waits else b""
        out = []
        for line in lines:
            out.append(_QUOTE.sub(b"", line, count=1) if self._begins and line.startswith(b">") else line)
            self._begins = line.endswith(b"\n")
        return b"".join(out)
