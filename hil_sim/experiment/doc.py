# SPDX-License-Identifier: MIT
"""Writes what experiments found into the page about them, between its marks."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from hil_sim.errors import SimError


def fill(path: Path, parts: Mapping[str, str]) -> None:
    """Replace what stands between `<!-- NAME: ... -->` and `<!-- /NAME -->`; SimError when a mark is missing."""
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise SimError(f"{path}: cannot read it ({error.strerror}); name the page to fill") from error
    for name, part in parts.items():
        pattern = rf"(<!-- {re.escape(name)}\b[^\n]*-->\n).*?(<!-- /{re.escape(name)} -->)"
        text, count = re.subn(pattern, lambda m, p=part: m[1] + p + m[2], text, flags=re.DOTALL)  # type: ignore[misc]
        if count != 1:
            raise SimError(f"{path}: the marks of '{name}' are there {count} times; write them once")
    path.write_text(text, encoding="utf-8")
