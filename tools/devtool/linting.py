# SPDX-License-Identifier: MIT
"""The stages of `tools/dev format` and `tools/dev lint`."""

from __future__ import annotations

import concurrent.futures
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from devtool.base import CORES, ROOT, VENV, Run
from devtool.cmake import configure
from devtool.setup import alone
from devtool.stages import Stage

C_FOLDERS: Final = ("examples", "firmware", "hal", "hil_sim", "tests", "tools")
PROGRAMS: Final = ("tools/dev", "tools/qemu-board", "tools/with-can")
"""Written in Python without being named so."""


def c_files(*suffixes: str, folders: Sequence[str] = C_FOLDERS) -> list[Path]:
    """Return the C files of the project."""
    found = [path for folder in folders for path in (ROOT / folder).rglob("*") if path.suffix in suffixes]
    return sorted(path for path in found if "data" not in path.relative_to(ROOT).parts)


def format_c(check: bool) -> Callable[[Run], None]:
    """Return the action that runs clang-format over all C files."""

    def action(run: Run) -> None:
        mode = ["--dry-run", "-Werror"] if check else ["-i"]
        run([VENV / "bin/clang-format", *mode, *(path.relative_to(ROOT) for path in c_files(".c", ".h"))])

    return action


def format_python(check: bool) -> Callable[[Run], None]:
    """Return the action that runs ruff's formatter."""

    def action(run: Run) -> None:
        if not check:
            run([VENV / "bin/ruff", "check", "-q", "--select", "I", "--fix", "."])
        run([VENV / "bin/ruff", "format", *(["--check", "--diff"] if check else ["-q"]), "."])

    return action


def format_stages(check: bool) -> tuple[Stage, ...]:
    """Return the stages of `format`."""
    verb = "checking" if check else "writing"
    return (
        Stage("clang-format", f"{verb} the layout of C", format_c(check)),
        Stage("ruff-format", f"{verb} the layout of Python", format_python(check)),
    )


def clang_tidy(run: Run) -> None:
    """Run clang-tidy on every C file of firmware/, hal/, hil_sim/ and tools/."""
    with alone():
        configure("debug", run)
    files = [
        path.relative_to(ROOT) for path in c_files(".c", folders=("firmware", "hal", "hil_sim", "tools"))
    ]
    tidy: list[str | Path] = [
        VENV / "bin/clang-tidy",
        "-p",
        "build/debug",
        "--quiet",
        f"--extra-arg=-I{ROOT}/hal",
    ]
    batches = [files[start::CORES] for start in range(CORES) if files[start::CORES]]
    with concurrent.futures.ThreadPoolExecutor(CORES) as pool:
        failures = [job.exception() for job in [pool.submit(run, [*tidy, *batch]) for batch in batches]]
    for failure in failures:
        if failure is not None:
            raise failure


def mypy(run: Run) -> None:
    """Run mypy over everything written in Python."""
    run([VENV / "bin/mypy"])
    for program in PROGRAMS:
        run([VENV / "bin/mypy", program])
    # One folder at a time: two of them may hold test files of the same name.
    for folder in sorted({path.parent.relative_to(ROOT) for path in (ROOT / "tests").rglob("*.py")}):
        run([VENV / "bin/mypy", *sorted((ROOT / folder).glob("*.py"))])


LINT_STAGES: Final = (
    Stage("clang-tidy", "defects in firmware/, hal/, hil_sim/ and tools/", clang_tidy, ("debug",)),
    Stage(
        "complexity",
        "function length and complexity",
        lambda run: run([VENV / "bin/python", "tools/size_functions.py"]),
    ),
    Stage("ruff", "defects and docstrings in Python", lambda run: run([VENV / "bin/ruff", "check", "."])),
    Stage("mypy", "types in Python", mypy),
    Stage(
        "prose",
        "sentences, grade and links of the documents",
        lambda run: run([VENV / "bin/python", "tools/prose.py"]),
    ),
    Stage("spelling", "spelling everywhere", lambda run: run([VENV / "bin/codespell"])),
    Stage(
        "figures",
        "documents against the result files",
        lambda run: run([VENV / "bin/python", "tools/figures.py", "--check"]),
    ),
    Stage(
        "api",
        "every name of the public header is documented",
        lambda run: run(["doxygen", "docs/Doxyfile"]),
        needs=("doxygen",),
    ),
    Stage(
        "commits",
        "subjects of commits",
        lambda run: run([VENV / "bin/python", "tools/commits.py"]),
    ),
)
