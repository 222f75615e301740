# SPDX-License-Identifier: MIT
"""Mutants of firmware/: each is one small defect seeded in one file; the unit tests must fail with it."""

from __future__ import annotations

import argparse
import concurrent.futures
import dataclasses
import json
import random
import re
import shlex
import subprocess
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from devtool.base import BUILD, CORES, EXIT_SETUP, EXIT_USAGE, ROOT, Add, Stop, say, shown

DEBUG: Final = BUILD / "debug"
WORK: Final = BUILD / "mutation"
UNIT: Final = ROOT / "tests/unit"
EXPLAINED: Final = ROOT / "tests/mutants.toml"
TEST_LIMIT_S: Final = 120.0
TOLD_EACH: Final = 20
"""A mutant that hangs is found, too: many times what a short test takes."""
SWAPS: Final = (
    (r" < ", " <= "),
    (r" <= ", " < "),
    (r" > ", " >= "),
    (r" >= ", " > "),
    (r" == ", " != "),
    (r" != ", " == "),
    (r" && ", " || "),
    (r" \|\| ", " && "),
    (r" \+ ", " - "),
    (r" - ", " + "),
    (r" \* (?=[a-z(0-9])", " / "),
    (r" / ", " * "),
    (r" \| ", " & "),
    (r" & ", " | "),
    (r"\+\+", "--"),
    (r"\btrue\b", "false"),
    (r"\bfalse\b", "true"),
    (r"!(?=[a-z(])", ""),
    (r" \? ([^:?;]+) : ([^:?;]+)(?=[;,)])", r" ? \2 : \1"),
)
NUMBER: Final = re.compile(r"(?<![\w.])(\d+)(?=u?\b(?!\.))")
LEFT_OUT: Final = re.compile(
    r"ARGUS_ASSERT|_Static_assert|^\s*(//|#(?!define))|^#define \w+\(|\\$|^[\s\d,{}-]+[,};]+$"
)
"""Checks, remarks, macros with arguments, and rows of numbers, each of which is within some tolerance."""
STATEMENT: Final = re.compile(
    r"^(\s+)(?!return|const|static|break|continue|int|uint|bool|argus_\w+_t\b)\S.*;$"
)


@dataclasses.dataclass(frozen=True)
class Mutant:
    """In the line NUMBER, from 1, of FILE stands AFTER in place of BEFORE."""

    file: Path
    number: int
    before: str
    after: str

    def __str__(self) -> str:
        return f"{shown(self.file)}:{self.number}: {self.before.strip()}  ->  {self.after.strip() or '(nothing)'}"


def changed(line: str) -> Iterator[str]:
    """Yield each line that a mutation makes of LINE; its comment is left alone."""
    code, mark, remark = line.partition(" //")
    for pattern, into in SWAPS:
        for match in re.finditer(pattern, code):
            yield code[: match.start()] + match.expand(into) + code[match.end() :] + mark + remark
    for match in NUMBER.finditer(code):
        yield code[: match.start()] + str(int(match[1]) + 1) + code[match.end() :] + mark + remark
    if STATEMENT.match(code) and code.count("(") == code.count(")"):
        yield re.sub(r"\S.*", ";", code, count=1) + mark + remark


def mutants_of(file: Path) -> list[Mutant]:
    """Return all mutants of FILE."""
    found = list[Mutant]()
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
        if not LEFT_OUT.search(line):
            found += [
                Mutant(file, number, line, after) for after in dict.fromkeys(changed(line)) if after != line
            ]
    return found


def equivalent() -> dict[tuple[str, str, str], str]:
    """Return the mutants that behave as the program does, and the reason of each."""
    rows = tomllib.loads(EXPLAINED.read_text(encoding="utf-8"))["equivalent"]
    return {(row["file"], row["before"], row["after"]): row["reason"] for row in rows}


def key_of(mutant: Mutant) -> tuple[str, str, str]:
    """Return how a mutant is named in the list of those that are explained."""
    return (shown(mutant.file), mutant.before.strip(), mutant.after.strip())


def text_of(mutant: Mutant) -> str:
    """Return the file with the mutant in it."""
    lines = mutant.file.read_text(encoding="utf-8").splitlines()
    lines[mutant.number - 1] = mutant.after
    return "\n".join(lines) + "\n"


def compile_command(file: Path) -> list[str]:
    """Return how FILE is compiled in build/debug, without the names of source and object."""
    for one in json.loads((DEBUG / "compile_commands.json").read_text(encoding="utf-8")):
        if one["file"] == str(file):
            words = shlex.split(one["command"])
            return [word for word in words[: words.index("-o")] if not word.startswith(("-W", "-g"))]
    raise Stop(f"{shown(file)} is not compiled in build/debug", EXIT_USAGE)


def made(file: Path, source: Path, target: Path) -> bool:
    """Compile SOURCE as FILE is compiled, optimised so that mutants that change nothing show; false: it is no C."""
    command = [*compile_command(file), "-O1", "-w", "-o", str(target), "-c", str(source)]
    return subprocess.run(command, cwd=DEBUG, capture_output=True, check=False).returncode == 0


def link_command(test: str, mutated: Path, program: Path) -> list[str]:
    """Return how TEST is linked with the object MUTATED before the library, into PROGRAM."""
    done = subprocess.run(
        ["ninja", "-C", str(DEBUG), "-t", "commands", f"tests/unit/{test}"],
        capture_output=True,
        text=True,
        check=True,
    )
    words = shlex.split(done.stdout.splitlines()[-1].removeprefix(": && ").removesuffix(" && :"))
    words[words.index("-o") + 1] = str(program)
    return [*words[: words.index("-o")], str(mutated), *words[words.index("-o") :]]


def tests_in(folder: str) -> list[Path]:
    """Return the unit tests of a folder of firmware/."""
    return sorted((UNIT / folder).glob("test_*.c"))


def tests_of(file: Path, widely: bool) -> list[str]:
    """Return the tests to ask, those that mirror FILE first, then those of its folder; WIDELY: then all of the core."""
    folder = file.parent.name
    paths = sorted(tests_in(folder), key=lambda path: not is_own(path.stem, file.stem))
    if widely:
        others = sorted(path.name for path in (ROOT / "firmware").iterdir() if path.name != folder)
        paths += [path for name in others for path in tests_in(name)]
    names = [f"{path.parent.name}.{path.stem}" for path in paths]
    return [name for name in names if (DEBUG / "tests/unit" / name).exists()]


def is_own(test: str, source: str) -> bool:
    """Tell whether a test of that stem mirrors the source."""
    return test == f"test_{source}" or test.startswith(f"test_{source}_")


def kills(test: str, mutated: Path) -> bool:
    """Link and run TEST with the object MUTATED; tell whether it fails."""
    program = mutated.with_suffix(f".{test}")
    linked = subprocess.run(link_command(test, mutated, program), cwd=DEBUG, capture_output=True, check=False)
    if linked.returncode:
        raise Stop(f"{test} is not linked: {linked.stderr.decode(errors='replace')[-300:]}")
    try:
        run = [str(program), "short"]
        return (
            subprocess.run(run, cwd=DEBUG, capture_output=True, timeout=TEST_LIMIT_S, check=False).returncode
            != 0
        )
    except subprocess.TimeoutExpired:
        return True
    finally:
        program.unlink(missing_ok=True)


def fate(mutant: Mutant, place: int, tests: Sequence[str]) -> str:
    """Return who killed MUTANT; `same` where it is the same program or none at all; empty: it survived."""
    folder = WORK / f"{mutant.file.stem}.{place}"
    folder.mkdir(parents=True, exist_ok=True)
    source, target, plain = folder / mutant.file.name, folder / "mutant.o", folder / "plain.o"
    source.write_text(mutant.file.read_text(encoding="utf-8"), encoding="utf-8")
    made(mutant.file, source, plain)
    source.write_text(text_of(mutant), encoding="utf-8")
    if not made(mutant.file, source, target) or target.read_bytes() == plain.read_bytes():
        return "same"
    return next((test for test in tests if kills(test, target)), "")


def chosen(files: Sequence[str], sample: int, seed: int) -> list[Mutant]:
    """Return SAMPLE mutants of each of FILES, or of all; 0: each mutant."""
    paths = [ROOT / name for name in files] or sorted((ROOT / "firmware").rglob("*.c"))
    found = list[Mutant]()
    for path in paths:
        if not path.exists() or not path.is_relative_to(ROOT / "firmware"):
            raise Stop(f"{shown(path)}: no file of firmware/", EXIT_USAGE)
        mutants = mutants_of(path)
        few = random.Random(f"{seed}:{path.name}").sample(mutants, min(sample, len(mutants)))
        found += few if sample else mutants
    return found


def tell(fates: dict[Mutant, str]) -> None:
    """Print the score of each file and who survived."""
    judged = {mutant: bool(fate) for mutant, fate in fates.items() if fate != "same"}
    for file in dict.fromkeys(mutant.file for mutant in fates):
        own = [killed for mutant, killed in judged.items() if mutant.file == file]
        print(f"  {shown(file):<40} {sum(own):4} of {len(own):4} killed")
    for mutant, killed in judged.items():
        if not killed:
            print(f"  survived: {mutant}")
    killed_in_all = sum(judged.values())
    share = 100 * killed_in_all / len(judged) if judged else 0.0
    print(f"  {killed_in_all} of {len(judged)} killed, {share:.1f} %")


def fates_of(mutants: Sequence[Mutant], widely: bool, jobs: int) -> dict[Mutant, str]:
    """Return who killed each; tell how far it is. Interrupted, it ends with the mutants at work."""
    pool = concurrent.futures.ThreadPoolExecutor(jobs)
    try:
        waiting = {
            pool.submit(fate, mutant, place, tests_of(mutant.file, widely)): mutant
            for place, mutant in enumerate(mutants)
        }
        for count, _ in enumerate(concurrent.futures.as_completed(waiting), 1):
            if count % TOLD_EACH == 0:
                say(f"{count} of {len(mutants)} mutants tried")
        return {mutant: job.result() for job, mutant in waiting.items()}
    finally:
        pool.shutdown(cancel_futures=True)


def do_mutate(args: argparse.Namespace) -> int:
    """Seed mutants and score the tests."""
    if not (DEBUG / "build.ninja").exists():
        raise Stop(
            "build/debug is not built by ninja: tools/dev build debug, with ninja installed", EXIT_SETUP
        )
    if args.sample < 0 or args.jobs < 1:
        raise Stop("--sample is 0 or more, --jobs 1 or more", EXIT_USAGE)
    mutants = chosen(args.file, args.sample, args.seed)
    known = equivalent()
    explained = [mutant for mutant in mutants if key_of(mutant) in known]
    mutants = [mutant for mutant in mutants if key_of(mutant) not in known]
    say(
        f"{len(mutants)} mutants, seed {args.seed}; {len(explained)} more are equivalent ({shown(EXPLAINED)})"
    )
    tell(fates_of(mutants, args.widely, args.jobs))
    return 0


def add_commands(add: Add) -> None:
    """Add the command."""
    mutate = add(
        "mutate",
        do_mutate,
        "seed small defects in files of firmware/, and count those that the unit tests of build/debug find",
        "mutate firmware/knowledge/angle.c --sample 20\nmutate --sample 3 --seed 7\nmutate --widely",
    )
    mutate.add_argument(
        "--sample",
        type=int,
        default=10,
        metavar="N",
        help="so many of each file (default: 10); 0: each that there is",
    )
    mutate.add_argument("--seed", type=int, default=1, metavar="S", help="which of them (default: 1)")
    mutate.add_argument(
        "--widely", action="store_true", help="ask the tests of all folders where its own pass"
    )
    mutate.add_argument(
        "--jobs", type=int, default=CORES, metavar="N", help="at the same time (default: cores)"
    )
    mutate.add_argument("file", metavar="FILE", nargs="*", help="file of firmware/ (default: all)")
