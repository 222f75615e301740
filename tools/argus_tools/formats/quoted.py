# SPDX-License-Identifier: MIT
"""Text that a mail program quoted: each line without the "> " before it."""

from __future__ import annotations

import re
from io import BufferedReader
from typing import Final

from argus_tools.formats.text import Rewritten, is_text

_LINE_MAX: Final = 1 << 14
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


class Unquoted(Rewritten):
    """The lines of a stream without those marks."""

    def __init__(self, stream: BufferedReader) -> None:
        super().__init__(stream)
        self._line = b""
        self._begins = True

    def _rewrite(self, data: bytes) -> bytes:
        """Return whole lines without their marks; what is begun waits, unless it is long."""
        lines = (self._line + data).splitlines(keepends=True)
        waits = bool(lines) and bool(data) and not lines[-1].endswith(b"\n") and len(lines[-1]) < _LINE_MAX
        self._line = lines.pop() if waits else b""
        out = []
        for line in lines:
            out.append(_QUOTE.sub(b"", line, count=1) if self._begins and line.startswith(b">") else line)
            self._begins = line.endswith(b"\n")
        return b"".join(out)
