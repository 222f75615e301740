# SPDX-License-Identifier: MIT
"""The stages of `tools/dev format` and `tools/dev lint`."""

from __future__ import annotations

import concurrent.futures
import functools
import hashlib
import json
import os
import re
import shlex
import subprocess
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final

from devtool.base import BUILD, CORES, ROOT, VENV, Run
from devtool.cmake import configure
from devtool.setup import LOCK, alone
from devtool.stages import Stage, StageFailed

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


def tidy_command() -> list[str | Path]:
    """Return the command that looks at the files named after it."""
    return [VENV / "bin/clang-tidy", "-p", "build/debug", "--quiet", f"--extra-arg=-I{ROOT}/hal"]


def clang_tidy(run: Run) -> None:
    """Run clang-tidy on every C file of firmware/, hal/, hil_sim/ and tools/."""
    with alone():
        configure("debug", run)
    files = [
        path.relative_to(ROOT) for path in c_files(".c", folders=("firmware", "hal", "hil_sim", "tools"))
    ]
    tidy = tidy_command()
    with concurrent.futures.ThreadPoolExecutor(CORES) as pool:
        stamps = dict(
            zip(files, pool.map(functools.partial(tidy_stamp, compile_commands()), files), strict=True)
        )
        todo = [path for path, stamp in stamps.items() if not stamp.exists()]
        jobs = {path: pool.submit(run, [*tidy, path]) for path in todo}
    for path, job in jobs.items():
        if job.exception() is None:
            stamps[path].parent.mkdir(exist_ok=True)
            stamps[path].touch()
    for job in jobs.values():
        job.result()


def compile_commands() -> dict[str, list[str]]:
    """Return how each C file is compiled, by its path."""
    found = json.loads((BUILD / "debug/compile_commands.json").read_text(encoding="utf-8"))
    return {one["file"]: shlex.split(one["command"]) for one in found}


def preprocessing(command: Sequence[str]) -> list[str]:
    """Return COMMAND as what prints the text that it compiles, comments and macros included, and writes no file."""
    kept, words = list[str](), iter(command)
    for word in words:
        if word in ("-o", "-MF", "-MT"):
            next(words)
        elif word not in ("-c", "-MD"):
            kept.append(word)
    return [*kept, "-E", "-C", "-dD", "-o", "-"] if kept else []


def tidy_stamp(commands: Mapping[str, list[str]], path: Path) -> Path:
    """Return the file that tells that PATH was found clean: its name is all that clang-tidy sees of it, and how.

    A file that is not compiled here, or does not compile, is looked at each time.
    """
    command = commands.get(str(ROOT / path), [])
    try:
        seen = subprocess.run(
            preprocessing(command), cwd=BUILD / "debug", capture_output=True, check=True
        ).stdout
    except (OSError, IndexError, subprocess.CalledProcessError):
        seen = os.urandom(16)
    digest = hashlib.sha256(LOCK.read_bytes() + (ROOT / ".clang-tidy").read_bytes())
    digest.update(shlex.join(map(str, [*tidy_command(), path, *command])).encode())
    digest.update((ROOT / path).read_bytes() + seen)
    return BUILD / "tidy" / digest.hexdigest()


HOSTED: Final = ("firmware", "hal/board", "hal/linux", "hal/posix")
"""Where the C is that is compiled for this machine."""
ANALYSED: Final = ("-Ifirmware", "-Ifirmware/include", "-Ihal", "-Ihal/include", "-Ihal/linux/argusd")


def analyser(run: Run) -> None:
    """Follow the paths through each C file: by gcc on its own, by cppcheck with all of them."""
    files = [path.relative_to(ROOT) for path in c_files(".c", folders=HOSTED)]
    compiler = ["gcc", "-std=gnu11", "-O1", "-fanalyzer", "-Werror", "-DARGUS_SONARS=32", "-DARGUS_ASSERTS"]
    with concurrent.futures.ThreadPoolExecutor(CORES) as pool:
        jobs = [pool.submit(run, [*compiler, *ANALYSED, "-c", path, "-o", os.devnull]) for path in files]
    for job in jobs:
        job.result()
    checker = ["cppcheck", "--quiet", "--std=c11", "--enable=warning,performance,portability"]
    checker += ["--inline-suppr", "--error-exitcode=1", f"-j{CORES}", "-DARGUS_SONARS=32"]
    run([*checker, *ANALYSED, "firmware", "hal"])


def mypy(run: Run) -> None:
    """Run mypy over everything written in Python."""
    run([VENV / "bin/mypy"])
    for program in PROGRAMS:
        run([VENV / "bin/mypy", program])
    for group in apart(sorted((ROOT / "tests").rglob("*.py"))):
        run([VENV / "bin/mypy", *group])


def apart(files: Sequence[Path]) -> list[list[Path]]:
    """Return FILES in as few groups as can be: mypy takes two of the same name, as test folders have, for one."""
    groups: list[dict[str, Path]] = []
    for path in files:
        for group in groups:
            if path.name not in group:
                group[path.name] = path
                break
        else:
            groups.append({path.name: path})
    return [list(group.values()) for group in groups]


HEADER: Final = ROOT / "firmware/include/argus/argus.h"
FUNCTION: Final = re.compile(r"^[a-z][\w ]*[ *](argus_\w+)\(", re.MULTILINE)


def api(run: Run) -> None:
    """Make the pages of the public header; each of its functions is on them."""
    run(["doxygen", "docs/Doxyfile"])
    pages = (BUILD / "api/argus_8h.html").read_text(encoding="utf-8")
    missing = sorted(
        name for name in FUNCTION.findall(HEADER.read_text(encoding="utf-8")) if f">{name}<" not in pages
    )
    if missing:
        raise StageFailed(f"the pages of argus.h leave out {', '.join(missing)}")


LINT_STAGES: Final = (
    Stage("clang-tidy", "defects in firmware/, hal/, hil_sim/ and tools/", clang_tidy, ("debug",)),
    Stage(
        "analyser",
        "paths through firmware/ and hal/ that gcc and cppcheck find wrong",
        analyser,
        needs=("cppcheck",),
    ),
    Stage(
        "complexity",
        "function length and complexity",
        lambda run: run([VENV / "bin/python", "tools/size_functions.py"]),
    ),
    Stage("ruff", "defects and docstrings in Python", lambda run: run([VENV / "bin/ruff", "check", "."])),
    Stage("mypy", "types in Python", mypy),
    Stage(
        "links",
        "links of documents",
        lambda run: run([VENV / "bin/python", "tools/links.py"]),
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
        api,
        needs=("doxygen",),
    ),
)
