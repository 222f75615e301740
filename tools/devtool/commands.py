# SPDX-License-Identifier: MIT
"""What each command of tools/dev does, but for those that consist of stages."""

from __future__ import annotations

import argparse
import functools
import os
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from devtool.base import (
    BUILD,
    EXIT_USAGE,
    LOGS,
    ROOT,
    VENV,
    Command,
    Run,
    Stop,
    environment,
    run_visibly,
    say,
    shown,
)
from devtool.cmake import TO_RUN, build, presets
from devtool.setup import ensure
from devtool.stages import STAGE_LIMIT_S, StageFailed, logged_runner, tail_of
from hil_sim.arguments import offer

CACHES: Final = (".mypy_cache", ".ruff_cache", ".pytest_cache", ".hypothesis", "dist")


def quietly(what: str, action: Callable[[Run], None]) -> None:
    """Do ACTION with its output in a log, which is shown only when it fails."""
    say(what)
    LOGS.mkdir(parents=True, exist_ok=True)
    log = LOGS / "last.log"
    log.write_text("")
    try:
        action(logged_runner(log, False, STAGE_LIMIT_S))
    except StageFailed as error:
        print(tail_of(log), flush=True)
        raise Stop(f"{what}: {error} (log: {shown(log)})") from None


_ENDS: Final = 100
_JUDGE_DEMO: Final = f"""
import sys; from hil_sim.demo.cli import parser
try:
    parser().parse_args(sys.argv[1:])
except SystemExit as end:
    sys.exit({_ENDS} + int(end.code or 0))
"""


def leave_where_ended(python: str, arguments: Sequence[str]) -> None:
    """Leave with its exit code where the demonstration's arguments end it, as --help or a wrong one does."""
    judged = subprocess.run([python, "-c", _JUDGE_DEMO, *arguments], check=False, cwd=ROOT, env=environment())
    if judged.returncode >= _ENDS:
        sys.exit(judged.returncode - _ENDS)


def do_demo(args: argparse.Namespace) -> int:
    """Set up, build, and hand over to the demonstration; what ends it anyway does so before."""
    python = str(VENV / "bin/python")
    is_set_up = Path(python).exists()
    if is_set_up:
        leave_where_ended(python, args.rest)
    ensure(["release"])
    if not is_set_up:
        leave_where_ended(python, args.rest)
    quietly("building argusd", functools.partial(build, "release", targets=TO_RUN))
    say("starting the demonstration")
    os.execve(python, [python, "-m", "hil_sim.demo", *args.rest], environment())


def do_build(args: argparse.Namespace) -> int:
    """Build presets."""
    for preset in args.preset:
        if preset not in presets():
            raise Stop(f"no preset '{preset}'{offer(preset, presets())}", EXIT_USAGE)
    chosen = args.preset or ["release"]
    ensure(chosen)
    for preset in chosen:
        quietly(f"building {preset}", functools.partial(build, preset))
    return 0


def shell_environment() -> dict[str, str]:
    """Return the environment in which argusd, argus-sim, argus-log and the others are found by their names."""
    env = environment()
    env["PATH"] = os.pathsep.join([str(BUILD / "release"), str(VENV / "bin"), os.environ.get("PATH", "")])
    env["VIRTUAL_ENV"] = str(VENV)
    return env


def start_file(env: dict[str, str]) -> str:
    """Return what a shell reads after the user's own start file, which may set PATH anew."""
    places = shlex.quote(os.pathsep.join([str(BUILD / "release"), str(VENV / "bin")]))
    return f'PATH={places}:"$PATH"\nVIRTUAL_ENV={shlex.quote(env["VIRTUAL_ENV"])}\nexport PATH VIRTUAL_ENV\n'


def shell_command(shell: str, env: dict[str, str]) -> list[str]:
    """Return how a SHELL is started so that PATH holds behind its start file; ENV gets what that takes."""
    folder = BUILD / "shell"
    folder.mkdir(parents=True, exist_ok=True)
    name = Path(shell).name
    if name == "bash":
        file = folder / "bashrc"
        file.write_text(f"[ ! -r ~/.bashrc ] || . ~/.bashrc\n{start_file(env)}", encoding="utf-8")
        return [shell, "--rcfile", str(file)]
    if name == "zsh":
        own = shlex.quote(env.get("ZDOTDIR", "") or str(Path.home()))
        text = f"ZDOTDIR={own}\n[ ! -r {own}/.zshrc ] || . {own}/.zshrc\n{start_file(env)}"
        (folder / ".zshrc").write_text(text, encoding="utf-8")
        env["ZDOTDIR"] = str(folder)
    return [shell]


def do_shell(args: argparse.Namespace) -> int:
    """Set up, build, and become a shell, or the command given, that finds what was built."""
    ensure(["release"])
    quietly("building argusd", functools.partial(build, "release", targets=TO_RUN))
    env = shell_environment()
    command = args.rest or shell_command(os.environ.get("SHELL") or "/bin/sh", env)
    if not args.rest:
        say("argusd, argus-sim, argus-log and python are in PATH; leave with exit")
    try:
        os.execvpe(command[0], command, env)
    except OSError as error:
        raise Stop(f"{command[0]}: {error.strerror}", EXIT_USAGE) from None


def do_size(_args: argparse.Namespace) -> int:
    """Measure the firmware on Cortex-M4."""
    ensure(["cortex-m4"])
    quietly("building for Cortex-M4", functools.partial(build, "cortex-m4"))
    run_visibly([sys.executable, "tools/size.py", "build/cortex-m4"])
    return 0


def do_api(_args: argparse.Namespace) -> int:
    """Make the pages of the public header."""
    ensure([], ["doxygen"])
    BUILD.mkdir(exist_ok=True)
    run_visibly(["doxygen", "docs/Doxyfile"])
    say(f"every name of argus/argus.h: {shown(BUILD / 'api/index.html')}")
    return 0


def do_figures(args: argparse.Namespace) -> int:
    """Write the figures of the result files into the documents, or compare them."""
    ensure([])
    check = ["--check"] if args.check else []
    run_visibly([VENV / "bin/python", "tools/figures.py", *check])
    return 0


def benchmarks() -> dict[str, Command]:
    """Return the benchmarks that there are, by name."""
    built = [path for path in (BUILD / "release").glob("bench_*") if os.access(path, os.X_OK)]
    programs: dict[str, Command] = {path.name.removeprefix("bench_"): [path] for path in built}
    programs |= {path.stem: [VENV / "bin/python", path] for path in (ROOT / "tests/bench").glob("*.py")}
    if "can" in programs:
        programs["can"] = [ROOT / "tools/with-can", *programs["can"]]
    return programs


def do_bench(args: argparse.Namespace) -> int:
    """Run the benchmarks."""
    known = sorted({path.stem for path in (ROOT / "tests/bench").iterdir() if path.suffix in (".c", ".py")})
    for name in args.name:
        if name not in known:
            raise Stop(f"no benchmark '{name}'{offer(name, known)}", EXIT_USAGE)
    ensure(["release"])
    quietly("building the benchmarks", functools.partial(build, "release"))
    programs = benchmarks()
    # That on the bus is run when it is asked for: it may have to make a guest kernel first.
    usual = ["can"] if args.can else sorted(set(programs) - {"can"})
    for name in sorted(args.name or usual):
        say(f"running {name}")
        run_visibly(programs[name])
    return 0


def made_paths(everything: bool) -> list[Path]:
    """Return what was made; downloads and .venv only if EVERYTHING is asked for."""
    made = [ROOT / name for name in CACHES]
    if BUILD.exists():
        made += [path for path in BUILD.iterdir() if everything or path.name != "_deps"]
    if everything:
        made += [BUILD, VENV]
    for top in ("hil_sim", "tests", "tools"):
        made += (ROOT / top).rglob("__pycache__")
    return made


def do_clean(args: argparse.Namespace) -> int:
    """Remove what was made."""
    for path in made_paths(args.all):
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)
    say(
        "removed build results and caches"
        + (", downloads and .venv" if args.all else "; kept downloads and .venv")
    )
    return 0
