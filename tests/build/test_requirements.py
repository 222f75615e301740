# SPDX-License-Identifier: MIT
"""Rule: each safety rule, each row of README and each thing the paper asks for has tests, and a gap is found."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import gen_requirements  # noqa: E402

S1 = '[[requirement]]\nid = "S1"\nsource = "DESIGN.md"\nquote = "never blind"\ntests = ["tests/unit/test_a.c"]\n'
WRONG = '[[requirement]]\nid = "wrong"\nsource = "README.md"\nquote = "too far"\ntests = ["tests/test_b.py::test_far"]\n'
GUARD = (
    '[[requirement]]\nid = "guard"\nsource = "README.md"\nquote = "a guard"\ntests = ["tests/test_b.py"]\n'
)
GOOD = S1 + WRONG + GUARD


def made(folder: Path, table: str = GOOD, readme_row: str = "", design_row: str = "") -> list[str]:
    """The gaps of a small project."""
    (folder / "tests/unit").mkdir(parents=True)
    (folder / "DESIGN.md").write_text(f"| | rule |\n|---|---|\n| S1 | never *blind* |\n{design_row}")
    (folder / "README.md").write_text(
        "| symptom | verdict |\n|---|---|\n| `too far` | wrong |\n"
        f"{readme_row}\n| you want | take |\n|---|---|\n| a [guard](g.md) | it |\n"
    )
    (folder / "tests/unit/test_a.c").write_text("void test_s1_is_kept(void) {\n}\n")
    (folder / "tests/test_b.py").write_text("def test_far() -> None:\n    pass\n")
    path = folder / "tests/requirements.toml"
    path.write_text(table)
    return list(gen_requirements.gaps(folder, gen_requirements.promises(path)))


def test_nothing_is_missing_and_the_page_is_what_the_table_says(capsys: pytest.CaptureFixture[str]) -> None:
    assert gen_requirements.main(["--check"]) == 0, capsys.readouterr().err


def test_a_whole_table_has_no_gap(tmp_path: Path) -> None:
    assert made(tmp_path) == []


@pytest.mark.parametrize(
    ("table", "readme_row", "design_row", "gap"),
    [
        (GOOD.replace('"tests/unit/test_a.c"', ""), "", "", "S1: no test"),
        (GOOD.replace("test_a.c", "test_z.c"), "", "", "S1: no such test: tests/unit/test_z.c"),
        (
            GOOD.replace("::test_far", "::test_near"),
            "",
            "",
            "wrong: no such test: tests/test_b.py::test_near",
        ),
        (GOOD.replace("never blind", "always blind"), "", "", "S1: DESIGN.md does not say: always blind"),
        (GOOD + S1, "", "", "S1: twice"),
        (GOOD, "", "| S2 | stops |\n", "DESIGN.md: S2 has no row"),
        (GOOD, "| too near | wrong |\n", "", "README.md: no row for: too near"),
    ],
)
def test_each_gap_is_found(tmp_path: Path, table: str, readme_row: str, design_row: str, gap: str) -> None:
    assert gap in made(tmp_path, table, readme_row, design_row)


def test_a_row_that_is_not_whole_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="S1: keys"):
        made(tmp_path, GOOD.replace('quote = "never blind"\n', "", 1))


def test_a_test_that_bears_the_rule_in_its_name_is_added(tmp_path: Path) -> None:
    made(tmp_path)
    assert list(gen_requirements.by_name(tmp_path, "S1")) == ["tests/unit/test_a.c::test_s1_is_kept"]


def test_what_is_no_rule_gets_no_test_by_its_name(tmp_path: Path) -> None:
    made(tmp_path)
    (tmp_path / "tests/unit/test_a.c").write_text("void test_guard_is_off_by_default(void) {\n}\n")
    assert list(gen_requirements.by_name(tmp_path, "guard")) == []


def test_an_old_page_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("README.md", "DESIGN.md", "docs/requirements.md"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    shutil.copytree(ROOT / "tests", tmp_path / "tests", ignore=shutil.ignore_patterns("*.gz", "__pycache__"))
    monkeypatch.setattr(gen_requirements, "ROOT", tmp_path)
    page = tmp_path / "docs/requirements.md"
    page.write_text(page.read_text().replace("| S4 |", "| S4, or not |"))
    assert gen_requirements.main(["--check"]) == 1
    assert gen_requirements.main([]) == 0
    assert gen_requirements.main(["--check"]) == 0
