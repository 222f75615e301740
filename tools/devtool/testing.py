# SPDX-License-Identifier: MIT
"""The stages of `tools/dev test`."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Final

from devtool.base import BUILD, CORES, ROOT, VENV, Command, Run
from devtool.browser import monitor_tests
from devtool.cmake import BOARDS, SOAK, TOUR, WIDE, build, build_and_test, ctest
from devtool.coverage import coverage_stage, hal_coverage_stage, mcdc_stage
from devtool.docs import site_tests
from devtool.misra import misra
from devtool.packaging import NEEDS as PACKAGE_NEEDS
from devtool.packaging import package_tests
from devtool.peers import SOURCES, peers
from devtool.proofs import proof_tests
from devtool.real_time import hil_workers, run_in_real_time
from devtool.ros import NEEDS as ROS_NEEDS
from devtool.ros import ros_tests
from devtool.stages import Stage, making
from devtool.supply import reproduce_stage

PYTEST: Final = (VENV / "bin/python", "-m", "pytest", "-q")
FUZZ_RUNS: Final = 1_000_000
IN_REAL_TIME: Final = ("tests/hil", "tests/can", "tests/target", "tests/monitor", "tests/ros")
BY_THEMSELVES: Final = (*IN_REAL_TIME, "tests/packages", "tests/docs")
COMPUTING: Final = ("tests", *(f"--ignore={folder}" for folder in BY_THEMSELVES))
# Some tests take a hundred times as long as others: a worker that has done its own takes over what another has
# before it. Some wait for a robot's clock or for a program: one worker more than cores uses that time.
SHARED_OUT: Final = ("-n", str(CORES + 1), "--dist", "worksteal")


def files_with(*marks: str) -> list[str]:
    """Return the files that have tests of MARKS: reading in all others takes longer than some of those tests."""
    wanted = re.compile(rf"mark\.({'|'.join(marks)})\b")
    files = [path.relative_to(ROOT) for path in sorted((ROOT / "tests").rglob("test_*.py"))]
    return [
        str(file)
        for file in files
        if not any(file.is_relative_to(folder) for folder in BY_THEMSELVES)
        and wanted.search((ROOT / file).read_text(encoding="utf-8"))
    ]


def ctest_stage(preset: str, what: str) -> Stage:
    """Return the stage that builds PRESET and runs its unit tests."""
    return Stage(preset, what, lambda run: build_and_test(preset, run), (preset,))


def sanitize_tests(run: Run) -> None:
    """Run the C unit tests under clang's sanitizers; those of what has threads under that of threads, too."""
    build_and_test("sanitize", run)
    build("threads", run, targets=THREADED)
    ctest("threads", run, "-R", f"^({'|'.join(THREADED)})$")


def python_tests(run: Run) -> None:
    """Run the Python tests that compute."""
    build("release", run)
    build("cortex-m4", run)
    run([*PYTEST, *COMPUTING, "-m", f"not {SOAK} and not {WIDE}", *SHARED_OUT])


THREADED: Final = ("hal.posix.test_recorder",)
"""What has threads: records are written by one of their own."""
VALGRIND: Final = """\
#!/bin/sh
exec valgrind --quiet --error-exitcode=99 --leak-check=full --errors-for-leak-kinds=definite --log-file={log} \\
    {argusd} "$@"
"""
"""argusd as the tests over ptys start it: the same process, its own output untouched."""


def soak_tests(run: Run) -> None:
    """Run what computes for long, in C and in Python: once, and optimised."""
    build("release", run)
    ctest("release", run, "-L", SOAK)
    run([*PYTEST, *files_with(SOAK, TOUR), "-m", f"{SOAK} and not {WIDE}", *SHARED_OUT])


def wide_tests(run: Run) -> None:
    """Run the sweeps over many seeds, and what computes for long in C under the sanitizers, too."""
    for preset in ("release", "sanitize"):
        build(preset, run)
    ctest("release", run, "-L", WIDE)
    ctest("sanitize", run, "-L", f"{SOAK}|{WIDE}")
    run([*PYTEST, *files_with(WIDE, TOUR), "-m", WIDE, *SHARED_OUT])


def fuzz_tests(run: Run) -> None:
    """Run the fuzz target with libFuzzer on inputs that grow from its corpus; one that breaks a rule is kept."""
    build("sanitize", run)
    folder = BUILD / "fuzz"
    inputs = folder / "inputs"
    inputs.mkdir(parents=True, exist_ok=True)
    for line in (ROOT / "tests/fuzz/corpus.txt").read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            word = line.split()[0]
            (inputs / word[:40]).write_bytes(bytes.fromhex(word))
    with making():
        run(["cmake", "--build", BUILD / "sanitize", "--target", "fuzz_drive", "-j", str(CORES)])
    run(
        [
            BUILD / "sanitize/fuzz_drive",
            "-entropic=0",
            "-max_len=64",
            f"-runs={FUZZ_RUNS}",
            f"-fork={CORES}",
            f"-artifact_prefix={folder}/",
            inputs,
        ]
    )


def hil_tests(run: Run) -> str | None:
    """Run the tests over real ptys; they mostly sleep, so there are more of them at once than cores."""
    build("release", run)
    pytest: Command = [*PYTEST, "--dist", "load", "--maxschedchunk", "1"]
    return run_in_real_time(run, pytest, ["tests/hil"], hil_workers(), BUILD / "hil/host-late.json")


def valgrind_tests(run: Run) -> None:
    """Let argusd drive over a pty and TCP under valgrind: an error, or a byte lost, is its exit code."""
    build("release", run)
    folder = BUILD / "valgrind"
    folder.mkdir(exist_ok=True)
    wrapper = folder / "argusd"
    wrapper.write_text(
        VALGRIND.format(log=folder / "%p.log", argusd=BUILD / "release/argusd"), encoding="utf-8"
    )
    wrapper.chmod(0o755)
    run(["env", f"ARGUS_ARGUSD={wrapper}", *PYTEST, "tests/hil/test_start.py", "-k", "later"])


def can_tests(run: Run) -> str | None:
    """Run the tests on a real CAN bus: those of what provides it, then, in one boot, those that use it."""
    build("release", run)
    with_can: list[str | Path] = [sys.executable, ROOT / "tools/with-can", "--timeout", "0"]
    with making():
        run([*with_can, "--prepare"])
    run([*PYTEST, "tests/can/test_with_can.py", "-n", "3"])
    run([*with_can, "--guest", *PYTEST, "tests/can/guest"])
    # A worker for each file: they wait for one another's robots no more than those of tests/hil do.
    on_bus: Command = [*with_can, *PYTEST, "--dist", "loadfile"]
    return run_in_real_time(run, on_bus, ["tests/can/bus"], 7, BUILD / "can/host-late.json")


def cortex_m4(run: Run) -> None:
    """Build for Cortex-M4 and check its sizes."""
    build("cortex-m4", run)
    run([sys.executable, "tools/size.py", "build/cortex-m4"])


def boards(run: Run) -> None:
    """Build the images of all boards, and let QEMU run them, unit tests on them, and recorded missions."""
    for preset in ("release", *BOARDS):
        build(preset, run)
    build("blank", run)
    for board in BOARDS:
        run([sys.executable, "tools/size_image.py", BUILD / board])
        build_and_test(f"{board.split('-')[0]}-tests", run)
    run([VENV / "bin/python", "tools/board_time.py", "--check"])
    run([*PYTEST, "tests/target", "-n", "3"])


def tables(run: Run) -> None:
    """Compare what is generated with what it is generated from."""
    for generator in ("gen_tables", "gen_docs", "gen_requirements"):
        run([sys.executable, f"tools/{generator}.py", "--check"])


TABLES: Final = Stage("tables", "generated headers and documents agree with what they are made of", tables)
RELEASE: Final = ctest_stage("release", "C unit tests, optimised")
CORTEX_M4: Final = Stage(
    "cortex-m4", "firmware for Cortex-M4: builds, sizes, stack, no recursion", cortex_m4, ("cortex-m4",)
)
PYTHON: Final = Stage(
    "python",
    "Python tests that need no robot",
    python_tests,
    ("release", "cortex-m4"),
    ("tshark", "groff", "pkg-config", "g++"),
)
SOAKING: Final = Stage(SOAK, "C and Python tests that compute for long", soak_tests, ("release",))
SOAK_STAGES: Final = (
    SOAKING,
    Stage(
        WIDE,
        "sweeps over many seeds, and the long C tests under the sanitizers",
        wide_tests,
        ("release", "sanitize"),
    ),
    Stage(
        "mcdc",
        "what each condition of firmware/ decides by itself in the C unit tests, where clang can count it",
        mcdc_stage,
    ),
    Stage(
        "coverage-hal",
        "lines of hal/ and argusd that their tests reach, those over ptys included, against tests/coverage.toml",
        hal_coverage_stage,
        ("coverage-hal", "release"),
        real_time=True,
    ),
    Stage(
        "misra",
        "rules of MISRA C:2012 that firmware/ breaks, against the deviations of docs/misra.md",
        misra,
        needs=("cppcheck",),
    ),
    Stage(
        "valgrind",
        "argusd and an emulated robot over a pty and TCP, under valgrind",
        valgrind_tests,
        ("release",),
        needs=("valgrind",),
    ),
    Stage(
        "reproduce",
        "argusd and a board's image, built in two folders of sources of two times: the same bytes",
        reproduce_stage,
        ("release", "mps2-an386"),
    ),
    Stage(
        "fuzz",
        "manager, guard port and robot under the monitor of S1 to S8, a million inputs",
        fuzz_tests,
        ("sanitize",),
    ),
)
QUICK_STAGES: Final = (TABLES, RELEASE, CORTEX_M4, PYTHON)
TEST_STAGES: Final = (
    TABLES,
    RELEASE,
    Stage("hil", "argusd against the emulated robot over ptys", hil_tests, ("release",), real_time=True),
    Stage(
        "sanitize",
        "C unit tests, built by clang with its address and undefined-behaviour sanitizers, and that of threads",
        sanitize_tests,
        ("sanitize", "threads"),
    ),
    ctest_stage("m32", "C unit tests, 32 bit"),
    Stage(
        "coverage",
        "lines and branches of firmware/ that its C unit tests reach, against tests/coverage.toml",
        coverage_stage,
        ("coverage",),
    ),
    CORTEX_M4,
    PYTHON,
    Stage(
        "boards",
        "images of microcontrollers, and unit tests on them, in QEMU",
        boards,
        ("release", *BOARDS),
        ("qemu-arm",),
    ),
    Stage(
        "big-endian",
        "C unit tests on a big-endian processor, in QEMU",
        lambda run: build_and_test("big-endian", run),
        ("big-endian",),
    ),
    Stage(
        "can",
        "the same over CAN buses, in a guest kernel if need be",
        can_tests,
        ("release",),
        ("can-utils",),
        real_time=True,
    ),
    Stage("ros", "nodes of ROS 2, where its packages can be had", ros_tests, ("release",), ROS_NEEDS, True),
    Stage("packages", "wheels and Debian packages, installed", package_tests, (), PACKAGE_NEEDS),
    Stage(
        "monitor",
        "the page of argus-monitor in a real Chromium, where one can be had",
        monitor_tests,
        ("release",),
        real_time=True,
    ),
    Stage("docs", "the site of the documents, where its generator can be had", site_tests),
    Stage("proofs", "what CBMC proves of the firmware, where it can be had", proof_tests),
    SOAKING,
    Stage(
        "peers",
        f"the vendor's programs against ours, where {', '.join(f'{name}=' for name in SOURCES)} are given",
        peers,
    ),
)
