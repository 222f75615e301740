# SPDX-License-Identifier: MIT
"""The proofs of tests/proofs by CBMC: what each claims, within which bounds, and what makes it fail."""

from __future__ import annotations

import argparse
import concurrent.futures
import dataclasses
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

from devtool.base import (
    BUILD,
    CORES,
    EXIT_FAILED,
    EXIT_SETUP,
    EXIT_USAGE,
    ROOT,
    Add,
    Run,
    Stop,
    paint,
    say,
    shown,
)
from devtool.setup import alone
from devtool.stages import StageFailed, making
from devtool.system import apt_install
from hil_sim.arguments import offer

FOLDER: Final = ROOT / "tests/proofs"
WORK: Final = BUILD / "proofs"
LIMIT_S: Final = 1800.0
"""A guard against what hangs; the slowest takes a small part of it alone."""
FAILED_CODE: Final = 10
"""With which CBMC says that a claim does not hold."""
CHECKS: Final = (
    "--bounds-check",
    "--pointer-check",
    "--signed-overflow-check",
    "--div-by-zero-check",
    "--undefined-shift-check",
    "--unwinding-assertions",
)
DEFINES: Final = (
    "-DARGUS_SONARS=16",
    '-DARGUS_ASSERT(condition)=__CPROVER_assert((condition),"ARGUS_ASSERT")',
)


@dataclasses.dataclass(frozen=True)
class Mutant:
    """A defect to be seeded: in FILE the only BEFORE becomes AFTER."""

    file: str
    before: str
    after: str


@dataclasses.dataclass(frozen=True)
class Proof:
    """What the head of a harness states."""

    path: Path
    claim: str
    bounds: str
    sources: tuple[str, ...]
    unwind: int
    in_ci: bool
    mutants: tuple[Mutant, ...]

    @property
    def name(self) -> str:
        """Return the name by which it is asked for."""
        return self.path.stem


@dataclasses.dataclass(frozen=True)
class Outcome:
    """How CBMC ended: 0 proven, FAILED_CODE refuted, all else no answer."""

    code: int
    seconds: float
    text: str

    @property
    def checks(self) -> str:
        """Return how many checks were made."""
        found = re.search(r"^\*\* \d+ of (\d+) failed", self.text, re.MULTILINE)
        return found[1] if found else "?"


def fields_of(path: Path) -> dict[str, list[str]]:
    """Return the lines `// Word: text` of the head of PATH; the claim under an empty word."""
    fields = dict[str, list[str]]()
    for line in path.read_text(encoding="utf-8").splitlines()[1:]:
        if not line.startswith("// "):
            break
        word, colon, rest = line.removeprefix("// ").partition(": ")
        known = colon and word in ("Bounds", "Sources", "Unwind", "Ci", "Mutant")
        fields.setdefault(word if known else "", []).append(rest if known else line.removeprefix("// "))
    return fields


def mutant_of(path: Path, text: str) -> Mutant:
    """Return the mutant of a line `FILE | before | after`."""
    parts = text.split(" | ")
    if len(parts) != 3:
        raise Stop(f"{shown(path)}: a mutant is FILE | before | after", EXIT_USAGE)
    return Mutant(*parts)


def read_proof(path: Path) -> Proof:
    """Return the proof in PATH."""
    fields = fields_of(path)
    lacking = [word or "a claim" for word in ("", "Bounds", "Unwind", "Mutant") if word not in fields]
    if lacking:
        raise Stop(f"{shown(path)}: its head lacks {', '.join(lacking)}", EXIT_USAGE)
    return Proof(
        path=path,
        claim=" ".join(fields[""]),
        bounds=" ".join(fields["Bounds"]),
        sources=tuple(" ".join(fields.get("Sources", [])).split()),
        unwind=int(fields["Unwind"][0]),
        in_ci=fields.get("Ci") == ["yes"],
        mutants=tuple(mutant_of(path, text) for text in fields["Mutant"]),
    )


def all_proofs() -> list[Proof]:
    """Return all proofs, by name."""
    return [read_proof(path) for path in sorted(FOLDER.glob("*.c"))]


def chosen_proofs(names: Sequence[str], everything: bool) -> list[Proof]:
    """Return those of NAMES; without names all, or those that each test run makes."""
    proofs = all_proofs()
    known = {proof.name for proof in proofs}
    for name in names:
        if name not in known:
            raise Stop(f"no proof '{name}'{offer(name, sorted(known))}", EXIT_USAGE)
    return [proof for proof in proofs if (proof.name in names if names else everything or proof.in_ci)]


def lacking() -> str | None:
    """Install CBMC unless it is there; return why it cannot be had, None when it can."""
    if shutil.which("cbmc"):
        return None
    try:
        with alone():
            apt_install(["cbmc"])
    except Stop as error:
        return f"skipped: CBMC cannot be had here ({str(error).splitlines()[0]})"
    return None if shutil.which("cbmc") else "skipped: CBMC cannot be had here"


def command_of(proof: Proof, overlay: Path | None = None) -> list[str]:
    """Return how CBMC is called; what OVERLAY holds stands for the file of the same name in the tree."""
    tops = [overlay, ROOT] if overlay else [ROOT]
    sources = [next(top / name for top in tops if (top / name).exists()) for name in proof.sources]
    includes = [FOLDER, *(top / f"firmware{sub}" for top in tops for sub in ("", "/include"))]
    return [
        "cbmc",
        *map(str, (proof.path, *sources)),
        "--function",
        "proof",
        *(f"-I{folder}" for folder in includes),
        *DEFINES,
        *CHECKS,
        "--slice-formula",
        "--unwind",
        str(proof.unwind),
    ]


def run_cbmc(command: Sequence[str]) -> Outcome:
    """Run COMMAND, its text in the outcome."""
    start = time.monotonic()
    try:
        done = subprocess.run(
            command,
            cwd=ROOT,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            timeout=LIMIT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return Outcome(-1, time.monotonic() - start, f"not done after {LIMIT_S:.0f} s")
    return Outcome(done.returncode, time.monotonic() - start, done.stdout)


def overlay_of(proof: Proof, number: int) -> Path:
    """Write the file of a mutant below a folder of its own, and return that."""
    mutant = proof.mutants[number]
    text = (ROOT / mutant.file).read_text(encoding="utf-8")
    if text.count(mutant.before) != 1:
        raise Stop(
            f"{shown(proof.path)}: '{mutant.before}' stands {text.count(mutant.before)} times in {mutant.file}"
        )
    overlay = WORK / "mutants" / f"{proof.name}.{number}"
    file = overlay / mutant.file
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text.replace(mutant.before, mutant.after), encoding="utf-8")
    return overlay


def judge(proof: Proof, number: int | None) -> tuple[bool, str]:
    """Prove, or try to prove with a mutant seeded; return whether that ended as it should, and a line about it."""
    overlay = None if number is None else overlay_of(proof, number)
    outcome = run_cbmc(command_of(proof, overlay))
    name = proof.name if number is None else f"{proof.name}.{number}"
    log = WORK / f"{name}.log"
    log.write_text(outcome.text, encoding="utf-8")
    good = outcome.code == (0 if number is None else FAILED_CODE)
    what = proof.claim
    if number is not None:
        mutant = proof.mutants[number]
        what = f"{mutant.file}: {mutant.before} -> {mutant.after}"
    word = paint("ok    ", "32") if good else paint("FAILED", "31")
    line = f"  {name:<24} {word} {outcome.seconds:7.1f} s {outcome.checks:>6} checks  {what}"
    return good, line if good else f"{line} (log: {shown(log)})"


def prove(proofs: Iterable[Proof], mutants: bool) -> int:
    """Make PROOFS, or see each of their MUTANTS fail; return how many did not end so."""
    WORK.mkdir(parents=True, exist_ok=True)
    jobs: list[tuple[Proof, int | None]] = [
        (proof, number) for proof in proofs for number in (range(len(proof.mutants)) if mutants else [None])
    ]
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(CORES) as pool:
        for good, line in pool.map(lambda job: judge(*job), jobs):
            print(line, flush=True)
            failed += not good
    return failed


def do_prove(args: argparse.Namespace) -> int:
    """List or make proofs."""
    proofs = chosen_proofs(args.name, args.all or args.list)
    if args.list:
        for proof in proofs:
            print(
                f"{proof.name:<24} {proof.claim}\n{'':<24} {proof.bounds}; loops up to {proof.unwind - 1} times"
            )
        return 0
    if not shutil.which("cbmc"):
        raise Stop("CBMC is not there: apt-get install cbmc (Debian 13, Ubuntu 24.04)", EXIT_SETUP)
    start = time.monotonic()
    failed = prove(proofs, args.mutants)
    made = sum(len(proof.mutants) for proof in proofs) if args.mutants else len(proofs)
    kind = "mutants seen to fail" if args.mutants else "proofs"
    say(f"{made - failed} of {made} {kind} in {time.monotonic() - start:.0f} s")
    return EXIT_FAILED if failed else 0


def proof_tests(run: Run) -> str | None:
    """Make the proofs that each test run makes, where CBMC can be had."""
    with making():
        why = lacking()
    if why is None:
        try:
            run([sys.executable, ROOT / "tools/dev", "prove"])
        except StageFailed as error:
            raise StageFailed(f"{error}; tools/dev prove NAME makes one of them") from None
    return why


def add_commands(add: Add) -> None:
    """Add the command."""
    prover = add(
        "prove",
        do_prove,
        "prove with CBMC what tests/proofs claims: by default what each test run proves",
        "prove\nprove --list\nprove sip_decode\nprove --all --mutants",
    )
    prover.add_argument("--list", action="store_true", help="print what is claimed, within which bounds")
    prover.add_argument("--all", action="store_true", help="those that take minutes, too")
    prover.add_argument(
        "--mutants",
        action="store_true",
        help="seed the defects that the proofs state: each must make its proof fail",
    )
    prover.add_argument("name", metavar="NAME", nargs="*", help="proof to make")
