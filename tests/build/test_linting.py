# SPDX-License-Identifier: MIT
"""Rule: lint passes over nothing but what it found clean with the same eyes; mypy sees every file once."""

from __future__ import annotations

from pathlib import Path

import pytest
from devtool import linting
from devtool.linting import apart, tidy_stamp

FILES = {
    ".clang-tidy": "Checks: '*'\n",
    "requirements.lock": "clang-tidy==19\n",
    "a.c": '#include "a.h"\nint a(void) { return A; }\n',
    "a.h": "#define A 1\n",
}


@pytest.fixture
def tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "build/debug").mkdir(parents=True)
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(linting, "ROOT", tmp_path)
    monkeypatch.setattr(linting, "BUILD", tmp_path / "build")
    monkeypatch.setattr(linting, "LOCK", tmp_path / "requirements.lock")
    return tmp_path


def stamp(tree: Path, *flags: str) -> Path:
    source = tree / "a.c"
    depends = ["-MD", "-MT", "x/a.o", "-MF", "x/a.d"]
    commands = {str(source): ["cc", *flags, *depends, "-o", "x/a.o", "-c", str(source)]}
    return tidy_stamp(commands, Path("a.c"))


def test_the_same_text_is_looked_at_once(tree: Path) -> None:
    assert stamp(tree) == stamp(tree)
    assert stamp(tree).parent == tree / "build/tidy"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.c", FILES["a.c"] + "// NOLINT\n"),
        ("a.h", "#define A 2\n"),
        ("a.h", "// NOLINTBEGIN\n" + FILES["a.h"]),
        ("a.h", FILES["a.h"] + "#define NOT_USED(x) x + 1\n"),
        (".clang-tidy", "Checks: '-*'\n"),
        ("requirements.lock", "clang-tidy==20\n"),
    ],
)
def test_whatever_clang_tidy_sees_counts(tree: Path, name: str, text: str) -> None:
    before = stamp(tree)
    (tree / name).write_text(text)
    assert stamp(tree) != before


def test_the_settings_count(tree: Path) -> None:
    (tree / "a.c").write_text("#ifdef B\nint b;\n#endif\nint a;\n")
    assert stamp(tree) != stamp(tree, "-DB")


def test_how_it_is_looked_at_counts(tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = stamp(tree)
    assert stamp(tree, "-Wshadow") != before, "it changes no text"
    monkeypatch.setattr(linting, "VENV", tree / "another")
    assert stamp(tree) != before


def test_what_is_not_compiled_is_looked_at_each_time(tree: Path) -> None:
    assert tidy_stamp({}, Path("a.c")) != tidy_stamp({}, Path("a.c"))
    (tree / "a.h").unlink()
    assert stamp(tree) != stamp(tree)


def test_files_of_one_name_are_apart_and_none_is_lost() -> None:
    files = [Path(name) for name in ("a/x.py", "a/y.py", "b/x.py", "c/x.py", "c/z.py")]
    groups = apart(files)
    assert sorted(path for group in groups for path in group) == files
    assert len(groups) == 3
    for group in groups:
        assert len({path.name for path in group}) == len(group)
