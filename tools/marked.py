# SPDX-License-Identifier: MIT
"""The parts of a document that a tool writes: what stands between <!-- NAME: ... --> and <!-- /NAME -->."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable
from pathlib import Path


def renewed(document: str, text: str, mark: str, make: Callable[[], str]) -> str:
    """Return the text of a document with one part made anew; leave with a line when it has no such part."""
    pattern = rf"(<!-- {mark}: [^\n]*-->\n).*?(<!-- /{mark} -->)"
    if not re.search(pattern, text, flags=re.DOTALL):
        sys.exit(f"{document} has no part {mark}: put <!-- {mark}: --> and <!-- /{mark} --> where it belongs")
    table = make()
    return re.sub(pattern, lambda found: f"{found[1]}{table}\n{found[2]}", text, flags=re.DOTALL)


def update(
    root: Path, names: Iterable[str], filled: Callable[[str, str], str], check: bool, remedy: str
) -> int:
    """Write the documents below `root` as `filled` makes them, or with `check` compare; 1: one is out of date."""
    stale = []
    for name in names:
        path = root / name
        old = path.read_text(encoding="utf-8")
        new = filled(name, old)
        if new != old:
            stale.append(name)
            if not check:
                path.write_text(new, encoding="utf-8")
    if check and stale:
        print(f"{', '.join(stale)}: out of date, run {remedy}", file=sys.stderr)
    return int(check and bool(stale))
