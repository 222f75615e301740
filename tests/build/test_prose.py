# SPDX-License-Identifier: MIT
"""Rule: no sentence of a document or a comment has more than 40 words; documents have no dead link and stay short; what
newcomers read has an easy grade."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import comments  # noqa: E402
import prose  # noqa: E402


@pytest.mark.soak
def test_the_documents_and_the_comments_are_well() -> None:
    done = subprocess.run(
        [sys.executable, str(ROOT / "tools/prose.py")], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("One. Two! Three?", 3),
        ("No end: it goes on; and on", 1),
        ("Figures such as 0.5 and v1.2 end nothing.", 1),
        ("| a | b |\n|---|---|\n| One. Two. | three |", 5),
        ("```\nA block. Of code.\n```\nOne.", 1),
        ("<!-- part: generated -->\nOne. Two.\n<!-- /part -->\nThree.", 1),
    ],
)
def test_sentences_are_told_apart(text: str, expected: int) -> None:
    found = [part for passage in prose.passages(text) for part in prose.sentences(passage.text)]
    assert len(found) == expected, found


def test_a_long_sentence_is_told_with_its_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(prose, "ROOT", tmp_path)
    page = tmp_path / "page.md"
    page.write_text("# Title\n\nShort.\n\n" + "word " * 41 + "end.\n")
    assert list(prose.offences(page)) == [f"page.md:5: 42 words, at most 40: {('word ' * 14)[:70]}..."]
    page.write_text("# Title\n\n" + "word " * 39 + "end.\n")
    assert list(prose.offences(page)) == []


@pytest.mark.parametrize(
    ("link", "found"),
    [
        ("other.md", []),
        ("other.md#a-heading-of-two", []),
        ("#here", []),
        ("https://example.org/x", []),
        ("missing.md", ["3: no such file: missing.md"]),
        ("other.md#none", ["3: no such heading: other.md#none"]),
    ],
)
def test_dead_links(tmp_path: Path, link: str, found: list[str]) -> None:
    (tmp_path / "other.md").write_text("# A heading, of `two`\n\n```\n# none\n```\n")
    page = tmp_path / "page.md"
    page.write_text(f"# Here\n\n[text]({link})\n\n```\n[not](one.md)\n```\n")
    assert list(prose.dead_links(page, page.read_text())) == found


def test_the_grade_grows_with_words_and_syllables() -> None:
    easy = prose.grade("The cat sat. The dog ran. It was hot.")
    hard = prose.grade(
        "Considerable computational sophistication characterizes contemporary implementations of autonomous "
        "diagnostic architectures."
    )
    assert easy < 2 < 20 < hard


@pytest.mark.parametrize(
    ("word", "count"), [("sonar", 2), ("a", 1), ("evidence", 3), ("xqzrt", 1), ("argusd", 2)]
)
def test_syllables(word: str, count: int) -> None:
    assert prose.syllables(word) == count


@pytest.mark.parametrize(
    ("name", "text", "limit", "found"),
    [
        ("README.md", "Line.\n", 120, "README.md: 121 lines, at most 120"),
        ("DESIGN.md", "x", 15_360, "DESIGN.md: 15361 bytes, at most 15360"),
        ("DESIGN.md", "\N{EM DASH}", 5_120, "DESIGN.md: 15363 bytes, at most 15360"),
        ("docs.md", "Line.\n", 120, None),
    ],
)
def test_what_all_read_stays_short(name: str, text: str, limit: int, found: str | None) -> None:
    assert list(prose.too_big(name, text * limit)) == []
    assert list(prose.too_big(name, text * (limit + 1))) == ([found] if found else [])


def read(path: Path, source: str) -> list[tuple[int, str]]:
    path.write_text(source)
    return [(text.lines[0].number, text.words) for text in comments.texts(path)]


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("// One\n// two.\nint a;\n// Three.\n", [(1, "One two."), (4, "Three.")]),
        ("int a; // one\nint b; // two\n", [(1, "one"), (2, "two")]),
        ("int a; // one\n       // two\n", [(1, "one two")]),
        ("    // one\n// two\n", [(1, "one"), (2, "two")]),
        ("// one,\n// ... and two\n", [(1, "one,"), (2, "... and two")]),
        ("int a; // one,\nint b; // ... and two\n", [(1, "one,"), (2, "... and two")]),
        ("// One:\n//\n//     code();\n// two\n", [(1, "One:"), (4, "two")]),
        ("// One\n// a    b\n// two\n", [(1, "One"), (3, "two")]),
        ("// One ---------\n// NOLINTNEXTLINE(all)\n// SPDX-License-Identifier: MIT\n", []),
        (
            "/* One\n * two.\n *\n * Three. */\nint a; /* four */\n",
            [(1, "One two."), (4, "Three."), (5, "four")],
        ),
        ('char *s = "// no";\nint c = \'"\'; // yes\nchar *t = "\\\\"; // too\n', [(2, "yes"), (3, "too")]),
    ],
)
def test_comments_of_c(tmp_path: Path, source: str, expected: list[tuple[int, str]]) -> None:
    assert read(tmp_path / "a.c", source) == expected


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("#!/bin/python\n# SPDX-License-Identifier: MIT\n# One\n# two.\n", [(3, "One two.")]),
        ("a = '# no'  # one\nb = 2  # noqa: E501\n", [(1, "one")]),
        ('"""One\ntwo.\n\nThree.\n"""\n', [(1, "One two."), (4, "Three.")]),
        ('A = 1\n"""One."""\nB = """no"""\n', [(2, "One.")]),
        (
            'def f():\n    """One.\n\n    Two\n    three:\n\n        code()\n    """\n',
            [(2, "One."), (4, "Two three:")],
        ),
        ('"""One.\n\n>>> f(1)\n2\n>>> f(2)\n3\n\nTwo.\n"""\n', [(1, "One."), (8, "Two.")]),
        ('"""One.\n\n>>> f(1)\n2\n"""\n', [(1, "One.")]),
    ],
)
def test_comments_and_docstrings_of_python(
    tmp_path: Path, source: str, expected: list[tuple[int, str]]
) -> None:
    assert read(tmp_path / "a.py", source) == expected


def test_a_long_sentence_of_a_comment_is_told_with_its_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(prose, "ROOT", tmp_path)
    source = tmp_path / "a.h"
    words = "word " * 20
    source.write_text(f"int a;\n// Short. Short.\n// {words}\n// {words}end.\n")
    assert list(prose.offences(source)) == [f"a.h:3: 41 words, at most 40: {words[:70]}..."]
    source.write_text(f"// {words}\n// {'word ' * 19}end.\n")
    assert list(prose.offences(source)) == []


def test_the_sources_that_are_read(tmp_path: Path) -> None:
    for name in (
        "firmware/a.c",
        "hal/a/b.h",
        "hil_sim/a.py",
        "tools/dev",
        "tools/a.js",
        "tests/a.c",
        "firmware/a.md",
    ):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    found = [path.relative_to(tmp_path).as_posix() for path in comments.sources(tmp_path)]
    assert found == ["firmware/a.c", "hal/a/b.h", "hil_sim/a.py", "tools/dev"]
