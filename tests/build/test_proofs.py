# SPDX-License-Identifier: MIT
"""Rule: each proof states its claim, its bounds and a defect that makes it fail; without CBMC the stage skips aloud;
what CBMC says is neither lost nor taken for more than it is."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from devtool import proofs
from devtool.base import ROOT, Stop
from devtool.proofs import Outcome, Proof, all_proofs, chosen_proofs, command_of, read_proof

HEAD = """// SPDX-License-Identifier: MIT
// Nothing overflows,
// ever.
// Bounds: each byte
// Sources: a.c b.c
// Unwind: 7
// Ci: yes
// Mutant: a.c | x < 1 | x <= 1
#include "proof.h"
"""


def test_each_states_what_it_must_and_its_mutants_can_be_seeded() -> None:
    found = all_proofs()
    assert len(found) >= 8
    for proof in found:
        assert proof.claim.endswith("."), proof.name
        assert "void proof(void)" in proof.path.read_text(encoding="utf-8"), proof.name
        assert all((ROOT / name).exists() for name in proof.sources), proof.name
        assert proof.mutants, proof.name
        for mutant in proof.mutants:
            assert (ROOT / mutant.file).read_text(encoding="utf-8").count(mutant.before) == 1, mutant
            assert mutant.before != mutant.after


def proof_of(tmp_path: Path, text: str = HEAD) -> Proof:
    path = tmp_path / "one.c"
    path.write_text(text, encoding="utf-8")
    return read_proof(path)


def test_a_head_is_read(tmp_path: Path) -> None:
    proof = proof_of(tmp_path)
    assert (proof.name, proof.claim, proof.bounds) == ("one", "Nothing overflows, ever.", "each byte")
    assert (proof.sources, proof.unwind, proof.in_ci) == (("a.c", "b.c"), 7, True)
    assert proof.mutants == (proofs.Mutant("a.c", "x < 1", "x <= 1"),)


@pytest.mark.parametrize("word", ["Bounds", "Unwind", "Mutant"])
def test_a_head_that_lacks_something_is_refused(tmp_path: Path, word: str) -> None:
    with pytest.raises(Stop, match=f"lacks {word}"):
        proof_of(tmp_path, re.sub(rf"^// {word}: .*\n", "", HEAD, flags=re.MULTILINE))


def test_a_name_that_is_none_names_those_there_are() -> None:
    with pytest.raises(Stop, match=r"no proof 'none'; name one of .*clock_wrap"):
        chosen_proofs(["none"], False)
    assert [proof.name for proof in chosen_proofs(["clock_wrap"], False)] == ["clock_wrap"]
    few, all_of_them = chosen_proofs([], False), chosen_proofs([], True)
    assert 0 < len(few) <= len(all_of_them) == len(all_proofs())


def test_loops_are_claimed_to_end_and_checks_are_on(tmp_path: Path) -> None:
    [proof] = chosen_proofs(["sip_decode"], False)
    command = command_of(proof)
    assert {"--unwinding-assertions", "--bounds-check", "--signed-overflow-check"} <= set(command)
    (tmp_path / "firmware/arcos").mkdir(parents=True)
    (tmp_path / "firmware/arcos/sip.c").write_text("")
    assert str(tmp_path / "firmware/arcos/sip.c") in command_of(proof, tmp_path)


@pytest.mark.parametrize(
    ("code", "mutant", "good"),
    [(0, None, True), (10, None, False), (6, None, False), (10, 0, True), (0, 0, False), (6, 0, False)],
)
def test_only_a_proof_is_one_and_only_a_refutation_kills(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: int, mutant: int | None, good: bool
) -> None:
    monkeypatch.setattr(proofs, "WORK", tmp_path)
    monkeypatch.setattr(proofs, "run_cbmc", lambda _command: Outcome(code, 1.0, "** 3 of 17 failed\n"))
    [proof] = chosen_proofs(["clock_wrap"], False)
    ended, line = proofs.judge(proof, mutant)
    assert ended is good
    assert " 17 checks" in line
    assert ("FAILED" in line) is not good


def test_a_machine_without_it_skips_aloud(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_packages: object) -> None:
        raise Stop("no such package\nat all", 3)

    monkeypatch.setattr(shutil, "which", lambda _name: None)
    monkeypatch.setattr(proofs, "apt_install", refuse)
    assert proofs.proof_tests(lambda _command: pytest.fail("nothing is run")) == (
        "skipped: CBMC cannot be had here (no such package)"
    )
