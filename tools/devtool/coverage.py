# SPDX-License-Identifier: MIT
"""What the C unit tests reach of the sources: `tools/dev coverage`, the stages `coverage` and `mcdc`, their floors."""

from __future__ import annotations

import argparse
import dataclasses
import functools
import json
import re
import shutil
import subprocess
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from devtool.base import BUILD, CORES, ROOT, VENV, Command, Run, Stop, say, shown
from devtool.cmake import SOAK, WIDE, build, ctest
from devtool.commands import quietly
from devtool.real_time import hil_workers, run_in_real_time
from devtool.setup import ensure
from devtool.stages import StageFailed

FLOORS: Final = ROOT / "tests/coverage.toml"
OF_FIRMWARE: Final = ("-L", "^short$", "-E", "^(hal|fuzz)\\.")
"""The tests that count: a rule of the core is attacked by a test of its own, not met by chance in a long drive."""
PROGRAMS_OF: Final = (("argus.dir",), ("argus.dir", "argus_hal.dir", "argusd_parts.dir", "argusd.dir"))
"""The counted objects of firmware/ alone, and with hal/: other programs compile the same sources a second time."""
CLANGS: Final = (*(f"clang-{number}" for number in range(25, 17, -1)), "clang")
OLDEST_CLANG: Final = 18
MEASURES: Final = ("lines", "branches", "mcdc")
BUILT_IN: Final = "build/mcdc/"
"""What llvm-cov puts before the names of sources, which the build makes relative to the tree."""
NO_CLANG: Final = (
    f"no clang {OLDEST_CLANG} or later here: MC/DC is not measured (Debian 12: apt install clang-19)"
)


@dataclasses.dataclass(frozen=True)
class Reached:
    """What is reached of how much."""

    covered: int = 0
    total: int = 0

    def __add__(self, other: Reached) -> Reached:
        return Reached(self.covered + other.covered, self.total + other.total)

    @property
    def percent(self) -> float:
        """The share that is reached; of nothing, all."""
        return 100.0 * self.covered / self.total if self.total else 100.0

    def __str__(self) -> str:
        return f"{self.percent:6.2f} % {self.covered:6} of {self.total:6}"


@dataclasses.dataclass(frozen=True)
class File:
    """What is reached of one source: lines, branches, and by clang what each condition decides by itself."""

    name: str
    lines: Reached
    branches: Reached
    mcdc: Reached = Reached()

    @property
    def missed(self) -> int:
        """Branches and lines that no test takes."""
        return sum(one.total - one.covered for one in (self.lines, self.branches, self.mcdc))


def file_of_gcovr(one: Mapping[str, Any]) -> File:
    """Return what gcovr's summary tells of a file."""
    return File(
        one["filename"],
        Reached(one["line_covered"], one["line_total"]),
        Reached(one["branch_covered"], one["branch_total"]),
    )


def file_of_llvm(one: Mapping[str, Any]) -> File:
    """Return what llvm-cov's export tells of a file."""
    parts = [Reached(one["summary"][part]["covered"], one["summary"][part]["count"]) for part in MEASURES]
    return File(one["filename"].removeprefix(BUILT_IN), *parts)


def total_of(files: Iterable[File]) -> File:
    """Return the sum of FILES."""
    found = list(files)
    parts = [sum((getattr(file, measure) for file in found), Reached()) for measure in MEASURES]
    return File("all", *parts)


def table(files: Sequence[File]) -> Iterator[str]:
    """Yield a line for each of FILES of which something is missed, the worst first, and their sum."""
    measures = [measure for measure in MEASURES if total_of(files).__dict__[measure].total]
    yield "  ".join(f"{measure:<25}" for measure in measures)
    worst = sorted((file for file in files if file.missed), key=lambda file: (-file.missed, file.name))
    for file in (*worst, total_of(files)):
        yield "  ".join([*(f"{getattr(file, measure)!s:<25}" for measure in measures), file.name])


def below(files: Sequence[File], floors: Mapping[str, float]) -> list[str]:
    """Return what lies below FLOORS: of all files together, and of each by itself."""
    total = total_of(files)
    found = [
        f"{measure} of all: {reached.percent:.2f} % of at least {floors[measure]} %"
        for measure in MEASURES
        if (reached := getattr(total, measure)).total and reached.percent < floors[measure]
    ]
    least = floors["branches_of_a_file"]
    found += [
        f"branches of {file.name}: {file.branches.percent:.2f} % of at least {least} %"
        for file in files
        if file.branches.percent < least
    ]
    return found


def floors() -> dict[str, float]:
    """Return the least that must be reached, in percent."""
    return {name: float(value) for name, value in tomllib.loads(FLOORS.read_text(encoding="utf-8")).items()}


def judge(files: Sequence[File]) -> str:
    """Return what is reached in one line; a stage fails where that is too little, or where nothing was measured."""
    if not files:
        raise StageFailed("nothing was measured")
    lacking = below(files, floors())
    if lacking:
        raise StageFailed("; ".join([*lacking, "see tools/dev coverage"]))
    total = total_of(files)
    reached = {measure: getattr(total, measure) for measure in MEASURES}
    return (
        f"firmware/: {', '.join(f'{name} {one.percent:.2f} %' for name, one in reached.items() if one.total)}"
    )


def forget(preset: str) -> None:
    """Remove the counts of earlier runs, and of sources that are gone."""
    for pattern in ("*.gcda", "*.profraw"):
        for stale in (BUILD / preset).rglob(pattern):
            stale.unlink()


def by_gcc(run: Run, preset: str, *folders: str, pages: bool) -> list[File]:
    """Return what the counts of PRESET show of the sources in FOLDERS; with a PAGE for each in html/, if wanted."""
    folder = BUILD / preset
    summary, html = folder / "coverage.json", folder / "html/index.html"
    html.parent.mkdir(exist_ok=True)
    filters = [word for name in folders for word in ("--filter", f"{name}/")]
    where: list[str | Path] = ["--root", ROOT, "--object-directory", folder, *filters, f"-j{CORES}"]
    shown_as: list[str | Path] = ["--html-details", html] if pages else []
    libraries = [
        path for path in sorted(folder.glob("CMakeFiles/*.dir")) if path.name in PROGRAMS_OF["hal" in folders]
    ]
    run([VENV / "bin/gcovr", *where, "--json-summary", summary, *shown_as, *libraries])
    return [file_of_gcovr(one) for one in json.loads(summary.read_text(encoding="utf-8"))["files"]]


def run_gcc(run: Run, pages: bool = False) -> list[File]:
    """Build and run the tests of firmware/ by gcc, and return what they reach."""
    build("coverage", run)
    forget("coverage")
    ctest("coverage", run, *OF_FIRMWARE)
    return by_gcc(run, "coverage", "firmware", pages=pages)


def version_of(compiler: str) -> int:
    """Return the major version of COMPILER, 0 where there is none."""
    path = shutil.which(compiler)
    if path is None:
        return 0
    done = subprocess.run([path, "--version"], capture_output=True, text=True, check=False)
    found = re.search(r"clang version (\d+)", done.stdout)
    return int(found[1]) if found else 0


@functools.cache
def modern_clang() -> tuple[str, int] | None:
    """Return a clang that counts MC/DC and can be asked for it, and its version; None where there is none."""
    for compiler in CLANGS:
        number = version_of(compiler)
        if number >= OLDEST_CLANG and shutil.which(f"llvm-cov-{number}"):
            return compiler, number
    return None


def run_clang(run: Run, compiler: str, number: int) -> list[File]:
    """Build and run the tests of firmware/ by COMPILER, and return what they reach, MC/DC included."""
    folder = BUILD / "mcdc"
    build("mcdc", run, compiler=compiler)
    forget("mcdc")
    counts = folder / "counts"
    counts.mkdir(exist_ok=True)
    run(
        [
            "env",
            f"LLVM_PROFILE_FILE={counts}/%p.profraw",
            "ctest",
            "--preset",
            "mcdc",
            f"-j{CORES}",
            *OF_FIRMWARE,
        ]
    )
    merged, exported = folder / "all.profdata", folder / "coverage.json"
    run([f"llvm-profdata-{number}", "merge", "-o", merged, *sorted(counts.glob("*.profraw"))])
    tests = sorted(
        path for path in (folder / "tests/unit").iterdir() if re.match(r"[a-z]+\.test_\w+$", path.name)
    )
    objects = [word for test in tests for word in ("-object", test)]
    cover = [f"llvm-cov-{number}", "export", "-summary-only", f"-instr-profile={merged}", *objects]
    with exported.open("w") as file:
        done = subprocess.run([str(word) for word in cover], cwd=ROOT, stdout=file, check=False)
    if done.returncode:
        raise StageFailed(f"llvm-cov-{number}: exit code {done.returncode}")
    found = json.loads(exported.read_text(encoding="utf-8"))["data"][0]["files"]
    return [file for file in map(file_of_llvm, found) if file.name.startswith("firmware/")]


def coverage_stage(run: Run) -> str:
    """Measure lines and branches of firmware/ and hold them to their floors."""
    return judge(run_gcc(run))


def mcdc_stage(run: Run) -> str:
    """Measure MC/DC of firmware/ and hold it to its floor, where a compiler can."""
    found = modern_clang()
    if found is None:
        return NO_CLANG
    only_mcdc = [File(file.name, Reached(), Reached(), file.mcdc) for file in run_clang(run, *found)]
    return judge(only_mcdc)  # lines and branches have floors as gcc counts them


def run_hil(run: Run) -> list[File]:
    """Run all C unit tests and the tests over ptys with an argusd that counts, and return what they reach."""
    build("coverage-hal", run)
    build("release", run)
    forget("coverage-hal")
    ctest("coverage-hal", run, "-LE", f"{SOAK}|{WIDE}")
    argusd = f"ARGUS_ARGUSD={BUILD / 'coverage-hal/argusd'}"
    pytest: Command = ["env", argusd, VENV / "bin/python", "-m", "pytest", "-q", "--dist", "load"]
    run_in_real_time(run, pytest, ["tests/hil"], hil_workers(), BUILD / "hil/host-late.json")
    return by_gcc(run, "coverage-hal", "firmware", "hal", pages=True)


def judge_hal(files: Sequence[File]) -> str:
    """Return what is reached of the lines of hal/; a stage fails where that is too little, or nothing was measured."""
    lines = total_of(file for file in files if file.name.startswith("hal/")).lines
    if not lines.total:
        raise StageFailed("nothing was measured")
    least = floors()["hal_lines"]
    if lines.percent < least:
        raise StageFailed(
            f"lines of hal/: {lines.percent:.2f} % of at least {least} %; see tools/dev coverage --hil"
        )
    return f"hal/: lines {lines.percent:.2f} %"


def hal_coverage_stage(run: Run) -> str:
    """Measure the lines of hal/, with the tests over ptys, and hold them to their floor."""
    return judge_hal(run_hil(run))


def do_coverage(args: argparse.Namespace) -> int:
    """Measure what the unit tests reach, file by file."""
    found = modern_clang() if args.mcdc else None
    if args.mcdc and found is None:
        raise Stop(NO_CLANG)
    ensure(["coverage"])
    files: list[File] = []

    def measure(run: Run) -> None:
        files.extend(
            run_hil(run) if args.hil else run_clang(run, *found) if found else run_gcc(run, pages=True)
        )

    quietly("building and running the C unit tests", measure)
    if not files:
        raise Stop("nothing was measured: see build/logs/last.log")
    print("\n".join(table(files)))
    if not found:
        say(
            f"line by line: {shown(BUILD / ('coverage-hal' if args.hil else 'coverage') / 'html/index.html')}"
        )
    return 0
