#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Write docs/requirements.md of tests/requirements.toml, after checking that each promise has tests which exist."""

from __future__ import annotations

import argparse
import dataclasses
import functools
import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import marked

ROOT: Final = Path(__file__).resolve().parent.parent
TABLE: Final = "tests/requirements.toml"
PAGE: Final = "docs/requirements.md"
PAPER: Final = "paper"
KEYS: Final = {"id", "source", "quote", "tests"}
PARTS: Final = {"rules": "DESIGN.md", "paper": PAPER, "readme": "README.md"}
"""Marks of the page, and the source of what stands there."""


@dataclasses.dataclass(frozen=True)
class Promise:
    """One thing that Argus promises: where that stands, in which words, and FILE or FILE::TEST of what holds it."""

    id: str
    source: str
    quote: str
    tests: tuple[str, ...]


def promises(path: Path) -> list[Promise]:
    """Read the table; ValueError, in one line, where a row is not whole."""
    rows = tomllib.loads(path.read_text(encoding="utf-8")).get("requirement", [])
    for row in rows:
        if set(row) != KEYS:
            raise ValueError(f"{path.name}: {row.get('id', 'a row')}: keys {sorted(KEYS ^ set(row))}")
    return [Promise(row["id"], row["source"], row["quote"], tuple(row["tests"])) for row in rows]


@functools.cache
def tests_of(path: Path) -> frozenset[str]:
    """Return the names of the tests in a C or Python file; none where there is no such file."""
    if not path.is_file():
        return frozenset()
    start = r"void" if path.suffix == ".c" else r"(?:async )?def"
    return frozenset(re.findall(rf"^{start} (test_\w+)\(", path.read_text(encoding="utf-8"), re.MULTILINE))


def by_name(root: Path, rule: str) -> Iterator[str]:
    """C tests that have a safety rule in their name, as test_s1_...; none of what is no such rule."""
    if re.fullmatch(r"S\d+", rule) is None:
        return
    for path in sorted((root / "tests/unit").rglob("test_*.c")):
        start = f"test_{rule.lower()}_"
        yield from (
            f"{path.relative_to(root)}::{name}" for name in sorted(tests_of(path)) if name.startswith(start)
        )


def all_tests(root: Path, promise: Promise) -> list[str]:
    """The tests of a promise: those of its row, then those that its name finds."""
    return [*promise.tests, *(name for name in by_name(root, promise.id) if name not in promise.tests)]


def plain(text: str) -> str:
    """A document without its markup, in one line."""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    return " ".join(re.sub(r"[*`]", "", text).split())


def rows_that_promise(document: str) -> Iterator[str]:
    """First cell of each row of README's tables that tell what Argus can: the rest of the row is its verdict."""
    for heading in ("symptom", "you want"):
        table = re.search(rf"^\| {heading} \|.*\n\|[-| ]+\n((?:\|.*\n)+)", document, re.MULTILINE)
        if table is None:
            raise ValueError(f"README.md has no table that begins with '| {heading} |'")
        yield from (plain(row.split("|")[1]) for row in table[1].splitlines())


def gaps(root: Path, table: list[Promise]) -> Iterator[str]:
    """What is missing, a line each."""
    texts = {name: plain((root / name).read_text(encoding="utf-8")) for name in ("DESIGN.md", "README.md")}
    ids = [promise.id for promise in table]
    yield from (f"{name}: twice" for name in sorted({name for name in ids if ids.count(name) > 1}))
    for promise in table:
        if promise.source != PAPER and plain(promise.quote) not in texts.get(promise.source, ""):
            yield f"{promise.id}: {promise.source} does not say: {promise.quote}"
        if not promise.tests:
            yield f"{promise.id}: no test"
        for test in promise.tests:
            name, _, function = test.partition("::")
            found = tests_of(root / name)
            if not found or (function and function not in found):
                yield f"{promise.id}: no such test: {test}"
    design = (root / "DESIGN.md").read_text(encoding="utf-8")
    for rule in re.findall(r"^\| (S\d+) \|", design, re.MULTILINE):
        if rule not in ids:
            yield f"DESIGN.md: {rule} has no row"
    quotes = [plain(promise.quote) for promise in table]
    readme = (root / "README.md").read_text(encoding="utf-8")
    for cell in rows_that_promise(readme):
        row = next(plain(line) for line in readme.splitlines() if plain(line).startswith(f"| {cell} |"))
        if not any(quote in row for quote in quotes):
            yield f"README.md: no row for: {cell}"


def listed(root: Path, promise: Promise) -> str:
    """The tests of a promise, each file once."""
    by_file: dict[str, list[str]] = {}
    for test in all_tests(root, promise):
        name, _, function = test.partition("::")
        by_file.setdefault(name, []).extend([function] if function else [])
    parts = []
    for name, functions in by_file.items():
        words = ", ".join(f"`{function.removeprefix('test_')}`" for function in functions)
        parts.append(f"[{name.removeprefix('tests/')}](../{name})" + (f": {words}" if words else ""))
    return "<br>".join(parts)


def part(root: Path, mark: str) -> str:
    """One table of the page."""
    rows = [promise for promise in promises(root / TABLE) if promise.source == PARTS[mark]]
    lines = ["| | promise | held by |", "|---|---|---|"]
    lines += [f"| {row.id} | {row.quote.replace('|', chr(92) + '|')} | {listed(root, row)} |" for row in rows]
    return "\n".join(lines)


def filled(root: Path, text: str) -> str:
    """The page with its tables made anew."""
    for mark in PARTS:
        text = marked.renewed(PAGE, text, mark, functools.partial(part, root, mark))
    return text


def main(argv: list[str] | None = None) -> int:
    """Write the page, or with --check compare; 1 where a promise lacks a test or the page is old."""
    parser = argparse.ArgumentParser(
        description=__doc__,
        epilog="example: tools/gen_requirements.py --check",
    )
    parser.add_argument(
        "--check", action="store_true", help="write nothing; exit 1 where the page is out of date"
    )
    args = parser.parse_args(argv)
    try:
        missing = list(gaps(ROOT, promises(ROOT / TABLE)))
    except (ValueError, OSError) as error:
        print(f"gen_requirements: {error}", file=sys.stderr)
        return 1
    for line in missing:
        print(f"{TABLE}: {line}", file=sys.stderr)
    if missing:
        return 1
    remedy = "tools/gen_requirements.py"
    return marked.update(ROOT, [PAGE], lambda _, text: filled(ROOT, text), args.check, remedy)


if __name__ == "__main__":
    sys.exit(main())
