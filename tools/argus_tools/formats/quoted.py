# SPDX-License-Identifier: MIT
"""Text that a mail program quoted: each line without the "> " before it."""

from __future__ import annotations

import re
from typing import Final

from argus_tools.formats.text import RewrittenLines, is_text

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


class Unquoted(RewrittenLines):
    """The lines of a stream without those marks."""

    def _rewrite_line(self, line: bytes, begins: bool) -> bytes:
        return _QUOTE.sub(b"", line, count=1) if begins and line.startswith(b">") else line
