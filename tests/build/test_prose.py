# SPDX-License-Identifier: MIT
"""Rule: documents have no sentence of more than 40 words and no dead link; what newcomers read has an easy grade."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import prose  # noqa: E402


def test_the_documents_are_well() -> None:
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
