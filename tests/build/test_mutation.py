# SPDX-License-Identifier: MIT
"""Rule: a mutant differs from its file in one line, in code alone; it counts as killed only where a test fails."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import pytest
from devtool import mutation
from devtool.base import ROOT, Stop
from devtool.mutation import Mutant, changed, chosen, is_own, mutants_of, tell, text_of

CODE = """#include <a.h>
#define LIMIT 7 // so many
static const int table[] = {
    1, 2, 3};
// a < b
int f(int a, int b) {
    ARGUS_ASSERT(a < b);
    g(a);
    return a < b && b > 0 ? a + 1 : b;
}
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "one.c"
    path.write_text(CODE)
    return path


def test_each_differs_in_one_line_of_code(file: Path) -> None:
    found = mutants_of(file)
    assert {mutant.number for mutant in found} == {2, 8, 9}
    assert len(set(found)) == len(found)
    for mutant in found:
        lines = list(zip(CODE.splitlines(), text_of(mutant).splitlines(), strict=True))
        assert [number for number, (a, b) in enumerate(lines, 1) if a != b] == [mutant.number]


@pytest.mark.parametrize(
    ("line", "made"),
    [
        ("    return a < b;", ["    return a <= b;"]),
        ("    return a && b; // x < y", ["    return a || b; // x < y"]),
        ("#define LIMIT 7", ["#define LIMIT 8"]),
        ("    g(a);", ["    ;"]),
        ("    return !a;", ["    return a;"]),
        ("    return c ? a : b;", ["    return c ? b : a;"]),
        ("    i++;", ["    i--;", "    ;"]),
        ("    return uint8_t;", []),
    ],
)
def test_what_is_made_of_a_line(line: str, made: list[str]) -> None:
    assert list(changed(line)) == made


def test_a_seed_chooses_the_same_again_and_another_others() -> None:
    first = chosen(["firmware/arcos/sip.c"], 5, 1)
    assert first == chosen(["firmware/arcos/sip.c"], 5, 1)
    assert first != chosen(["firmware/arcos/sip.c"], 5, 2)
    assert len(first) == 5 < len(chosen(["firmware/arcos/sip.c"], 0, 1))
    with pytest.raises(Stop, match=r"no file of firmware/"):
        chosen(["hal/none.c"], 5, 1)


def test_which_tests_mirror_a_source() -> None:
    assert is_own("test_frame", "frame")
    assert is_own("test_frame_damage", "frame")
    assert not is_own("test_frames", "frame")


def test_only_a_test_that_fails_kills(file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mutation, "WORK", tmp_path / "work")
    monkeypatch.setattr(
        mutation, "made", lambda _file, source, target: bool(target.write_text(source.read_text()))
    )
    monkeypatch.setattr(mutation, "kills", lambda test, _object: test == "strict")
    mutant = next(one for one in mutants_of(file) if one.number == 9)
    assert mutation.fate(mutant, 1, ["lax", "strict"]) == "strict"
    assert mutation.fate(mutant, 1, ["lax"]) == ""
    assert mutation.fate(Mutant(file, 9, mutant.before, mutant.before), 1, ["strict"]) == "same"


def test_the_score_leaves_out_what_is_no_mutant(capsys: pytest.CaptureFixture[str]) -> None:
    where = ROOT / "firmware/a.c"
    fates = {
        Mutant(where, 1, "a", "b"): "t",
        Mutant(where, 2, "a", "c"): "",
        Mutant(where, 3, "a", "d"): "same",
    }
    tell(fates)
    said = capsys.readouterr().out
    assert "1 of    2 killed" in said
    assert "survived: firmware/a.c:2: a  ->  c" in said
    assert said.endswith("1 of 2 killed, 50.0 %\n")


def test_each_mutant_that_is_explained_is_one_and_has_a_reason() -> None:
    known = mutation.equivalent()
    for (name, before, after), reason in known.items():
        found = {mutation.key_of(mutant) for mutant in mutants_of(ROOT / name)}
        assert (name, before, after) in found, f"{name}: {before} -> {after} is no mutant of it"
        assert len(reason.split()) > 3


def test_who_is_explained_is_not_tried(
    file: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    mutant = next(one for one in mutants_of(file) if one.number == 9)
    monkeypatch.setattr(mutation, "equivalent", lambda: {mutation.key_of(mutant): "for the test"})
    monkeypatch.setattr(mutation, "chosen", lambda *_: mutants_of(file))
    monkeypatch.setattr(mutation, "DEBUG", file.parent)
    (file.parent / "build.ninja").touch()
    tried = list[Mutant]()

    def try_out(mutants: Sequence[Mutant], *_: object) -> dict[Mutant, str]:
        tried.extend(mutants)
        return {}

    monkeypatch.setattr(mutation, "fates_of", try_out)
    mutation.do_mutate(argparse.Namespace(file=[], sample=1, seed=1, jobs=1, widely=False))
    assert mutant not in tried
    assert len(tried) == len(mutants_of(file)) - 1
    assert "1 more are equivalent" in capsys.readouterr().out
