#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Check the links of documents: a link to a file or a heading of the project that is not there is dead."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).resolve().parent.parent
CODE_BLOCK: Final = re.compile(r"```.*?```", re.DOTALL)
CODE: Final = re.compile(r"```.*?```|`[^`\n]*`", re.DOTALL)

EPILOG: Final = """examples:
  tools/links.py                  # every document
  tools/links.py README.md        # one of them

exit codes: 0 every link leads somewhere, 1 some do not, 2 bad arguments"""


def documents() -> list[Path]:
    """Return every document of the project."""
    folders = ("docs", "tests", "findings")
    return sorted(
        [*ROOT.glob("*.md"), *(page for folder in folders for page in (ROOT / folder).rglob("*.md"))]
    )


def _blank(found: re.Match[str]) -> str:
    """Return as many empty lines as the match has, so that line numbers stay."""
    return "\n" * found[0].count("\n")


def anchor(heading: str) -> str:
    """Return the fragment by which a heading is linked to, as forges make it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def anchors(path: Path) -> set[str]:
    """Return the fragments that a document has."""
    lines = CODE_BLOCK.sub("", path.read_text(encoding="utf-8")).splitlines()
    return {anchor(re.sub(r"[`*]", "", line.lstrip("#").strip())) for line in lines if line.startswith("#")}


def dead_links(path: Path) -> Iterator[str]:
    """Yield "LINE: what is wrong" for each dead link of a document; links to other sites are not followed."""
    text = CODE.sub(_blank, path.read_text(encoding="utf-8"))
    for number, line in enumerate(text.splitlines(), 1):
        for target in re.findall(r"\]\(([^)\s]+)\)", line):
            if re.match(r"[a-z]+:", target):
                continue
            file, _, fragment = target.partition("#")
            there = (path.parent / file).resolve() if file else path
            if not there.exists():
                yield f"{number}: no such file: {target}"
            elif fragment and there.suffix == ".md" and fragment not in anchors(there):
                yield f"{number}: no such heading: {target}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Check the documents that are named, or all."""
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE", help="documents; all if none")
    chosen = [path.resolve() for path in parser.parse_args(arguments).files] or documents()
    for path in chosen:
        if not path.is_file():
            parser.error(f"{path}: no such file")
    found = [f"{path}:{line}" for path in chosen for line in dead_links(path)]
    for line in found:
        print(line)
    print(f"{len(chosen)} documents, {len(found)} dead links")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
