# SPDX-License-Identifier: MIT
"""Configures, builds and tests the presets of CMakePresets.json."""

from __future__ import annotations

import functools
import hashlib
import json
import shutil
from collections.abc import Sequence
from typing import Final

from devtool.base import BUILD, CORES, ROOT, Run
from devtool.setup import alone
from devtool.stages import making

PRESETS_FILE: Final = ROOT / "CMakePresets.json"
BOARDS: Final = ("mps2-an386", "stm32f405")
"""The presets that make an image of a microcontroller."""
ELSEWHERE: Final = ("blank", "mps2-tests", "stm32f405-tests", "big-endian")
"""Those whose programs run on another machine."""
TO_RUN: Final = ("argusd", "argus_shared", "argus_sim")
"""What is built to run the programs: no tests, which take most of the time."""
WITHOUT_ARGUSD: Final = ("m32", "cortex-m4", "coverage", "mcdc", "threads", *BOARDS, *ELSEWHERE)
SOAK: Final = "soak"
"""The label of the unit tests that compute for long; they are run once, in the release build."""
WAITING: Final = 2
"""So many programs of unit tests wait for a robot's clock for long."""
TOUR: Final = "tour"
"""The mark of tests in Python whose cases are many: most of them are left to the stages `soak` and `wide`."""
WIDE: Final = "wide"
"""The label of sweeps that take minutes of CPU; `tools/dev soak` runs them."""


@functools.cache
def presets() -> tuple[str, ...]:
    """Return the names of the presets that can be built."""
    content = json.loads(PRESETS_FILE.read_text(encoding="utf-8"))
    return tuple(one["name"] for one in content["buildPresets"])


def configure(preset: str, run: Run, compiler: str = "") -> None:
    """Configure PRESET if it is new, was configured elsewhere, or the presets or its own COMPILER changed."""
    folder = BUILD / preset
    cache, stamp = folder / "CMakeCache.txt", folder / "preset-digest"
    inputs = [PRESETS_FILE, ROOT / "cmake/cortex-m4.cmake", ROOT / "cmake/s390x.cmake"]
    recipe = hashlib.sha256(b"".join(path.read_bytes() for path in inputs) + compiler.encode()).hexdigest()
    if cache.exists() and f"CMAKE_HOME_DIRECTORY:INTERNAL={ROOT}\n" not in cache.read_text():
        shutil.rmtree(folder)
    if cache.exists() and (folder / "CMakeFiles").exists() and stamp.exists() and stamp.read_text() == recipe:
        return
    # A test of the screen that is left out because curses is missing would be a silent skip.
    extra = [] if preset in WITHOUT_ARGUSD else ["-DARGUS_ARGUSD=ON", "-DARGUS_TUI=ON"]
    extra += [f"-DCMAKE_C_COMPILER={compiler}"] if compiler else []
    run(["cmake", "--fresh", "--preset", preset, *extra])
    stamp.write_text(recipe)


def build(
    preset: str, run: Run, settings: Sequence[str] = (), compiler: str = "", targets: Sequence[str] = ()
) -> None:
    """Configure and build PRESET, or TARGETS of it; SETTINGS (NAME=VALUE) are kept until others are given."""
    with alone(), making():
        configure(preset, run, compiler)
        if settings:
            run(["cmake", BUILD / preset, *(f"-D{setting}" for setting in settings)])
        chosen = ["--target", *targets] if targets else []
        run(["cmake", "--build", "--preset", preset, "-j", str(CORES), *chosen])


def ctest(preset: str, run: Run, *options: str) -> None:
    """Run the unit tests of PRESET that OPTIONS choose; those of argusd mostly wait, and leave the cores to others."""
    run(["ctest", "--preset", preset, "-j", str(CORES + WAITING), *options])


def build_and_test(preset: str, run: Run, options: Sequence[str] = ("-LE", f"{SOAK}|{WIDE}")) -> None:
    """Build PRESET and run its C unit tests, but those that compute for long."""
    build(preset, run)
    ctest(preset, run, *options)
