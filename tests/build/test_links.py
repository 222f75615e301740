# SPDX-License-Identifier: MIT
"""Rule: no document has a link to a file or a heading that is not there."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import links  # noqa: E402


def test_no_link_of_the_documents_is_dead(capsys: pytest.CaptureFixture[str]) -> None:
    assert links.main([]) == 0, capsys.readouterr().out


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
def test_dead_links(tmp_path: Path, link: str, found: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "other.md").write_text("# A heading, of `two`\n\n```\n# none\n```\n")
    page = tmp_path / "page.md"
    page.write_text(f"# Here\n\n[text]({link})\n\n```\n[not](one.md)\n```\n")
    assert list(links.dead_links(page)) == found
    assert links.main([str(page)]) == bool(found)
    assert all(line in capsys.readouterr().out for line in found)


def test_a_file_that_is_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        links.main(["/nowhere.md"])
    assert ended.value.code == 2
    assert "/nowhere.md" in capsys.readouterr().err
