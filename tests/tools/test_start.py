# SPDX-License-Identifier: MIT
"""Rule: Ctrl-C ends a program of ours without a traceback, whenever it comes once `begun` has been called.

Before it run the interpreter, its `site` module and what pip writes for a script, all Python's own, which may show
a traceback; of ours two small modules, some 2 ms, which is tested below.
"""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Final

import pytest

ROOT: Final = Path(__file__).resolve().parents[2]
SCRIPTS: Final[dict[str, str]] = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))[
    "project"
]["scripts"]
LOG: Final = "docs/samples/two-failing-sonars.rec.gz"
WORDS: Final = {
    "argus-sim": ("--tcp", "127.0.0.1:0"),
    "argusd": ("--version",),
    "argus-conformance": ("--list",),
    "argus-log": ("faults", LOG),
    "argus-monitor": ("--connect", "tcp:127.0.0.1:1", "--port", "0"),
    "argusctl": ("--socket", "tcp:127.0.0.1:1", "status"),
    "argus-ros": ("--help",),
    "argus-range-guard": ("--help",),
    "argus-foxglove": ("--layout",),
    "argus-flash-check": ("--help",),
    "tools/dev": ("test", "--list"),
    "python -m hil_sim.demo": ("--help",),
    "python -m hil_sim.cli": ("--list-worlds",),
}
"""Something that each does without a robot."""
INTERRUPTED: Final = (-signal.SIGINT, 128 + signal.SIGINT)
MOMENTS_MS: Final = (0, 3, 10, 25, 50, 100, 170, 250, 400, 600, 900, 1200, 1500)

# A second process sends the signal, so long after the program has begun, which is when SIGINT is caught no more.
# The rest is what `pip` makes of a script, or the file or module itself.
BEGUN: Final = """
import os, runpy, signal, sys, time
when_s, way, what, *rest = sys.argv[1:]
parent = os.getpid()
if os.fork() == 0:
    os.dup2(os.open(os.devnull, os.O_RDWR), 1)
    os.dup2(1, 2)
    caught = 1 << signal.SIGINT - 1
    while caught & int(open(f"/proc/{parent}/status").read().partition("SigCgt:")[2].split()[0], 16):
        time.sleep(0.0003)
    time.sleep(float(when_s))
    if os.getppid() == parent:
        os.kill(parent, signal.SIGINT)
    os._exit(0)
sys.argv = [what, *rest]
if way == "script":
    module, _, function = what.partition(":")
    sys.exit(getattr(__import__(module, fromlist=[function]), function)())
if way == "module":
    runpy.run_module(what, run_name="__main__", alter_sys=True)
sys.path.insert(0, os.path.dirname(what))
runpy.run_path(what, run_name="__main__")
"""


def interrupted(name: str, after_ms: float) -> tuple[int, str]:
    """Start a program and interrupt it so long after its first line; return its exit code and what it complains of."""
    python, _, module = name.partition(" -m ")
    way = ("script", SCRIPTS[name]) if name in SCRIPTS else ("module", module) if module else ("file", name)
    del python
    done = subprocess.run(
        [sys.executable, "-c", BEGUN, str(after_ms / 1000), *way, *WORDS[name]],
        cwd=ROOT,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    return done.returncode, done.stderr


def test_each_program_is_tried() -> None:
    assert set(SCRIPTS) < set(WORDS)


@pytest.mark.parametrize("name", WORDS)
def test_an_interrupt_ends_it_without_a_traceback(name: str) -> None:
    seed = random.randrange(1 << 32)
    print(f"seed {seed}")
    rng = random.Random(seed)
    codes = []
    for moment in MOMENTS_MS:
        after_ms = moment * rng.uniform(0.7, 1.3)
        code, said = interrupted(name, after_ms)
        codes.append(code)
        for sign in ("Traceback", "Exception ignored", "Fatal", "KeyboardInterrupt"):
            assert sign not in said, (after_ms, code, said)
        if code not in INTERRUPTED and after_ms > 25:
            break  # it had ended by itself, or ends so when it serves
    assert set(codes) & set(INTERRUPTED), codes
    assert codes[-1] in (0, 1, 3, *INTERRUPTED), codes


def test_an_interrupt_that_is_ignored_stays_so() -> None:
    program = [sys.executable, "-c", BEGUN, "0.02", "script", SCRIPTS["argus-log"], "faults", LOG]
    nohup = ["sh", "-c", 'trap "" INT; exec "$@"', "sh"]
    done = subprocess.run([*nohup, *program], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 1, done.stderr
    assert "sonar" in done.stdout


def test_what_a_program_needs_to_begin_is_little() -> None:
    """The way to `begun`: what pip's script imports brings no module that takes its time."""
    loaded = "import sys; before = set(sys.modules); import {}; print(*sorted(set(sys.modules) - before))"
    for target in SCRIPTS.values():
        module = target.partition(":")[0]
        done = subprocess.run(
            [sys.executable, "-c", loaded.format(module)],
            capture_output=True,
            text=True,
            check=True,
            cwd=ROOT,
        )
        ours = {name for name in done.stdout.split() if name.startswith(("hil_sim", "argus"))}
        assert ours == {module, module.partition(".")[0], "hil_sim", "hil_sim.start"}
