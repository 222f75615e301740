# SPDX-License-Identifier: MIT
"""`tools/dev package`: wheel and .deb, each into dist/."""

from __future__ import annotations

import argparse
import functools
import platform
import shutil
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Final

from devtool.base import BUILD, CORES, EXIT_USAGE, ROOT, VENV, Run, Stop, say, shown
from devtool.commands import quietly
from devtool.setup import alone, ensure

DIST: Final = ROOT / "dist"
WORK: Final = BUILD / "package"
HERE: Final = platform.machine()
ARCHITECTURES: Final = ("x86_64", "aarch64")


def toolchain(arch: str) -> Path:
    """Return the toolchain file that builds for ARCH elsewhere."""
    return ROOT / f"cmake/{arch}.cmake"


def needs_of(arch: str) -> list[str]:
    """Return what a machine must have to build for ARCH."""
    if arch == HERE:
        return []
    if not toolchain(arch).exists():
        raise Stop(f"nothing here builds for {arch} on {HERE}: build on such a machine", EXIT_USAGE)
    return [arch]


def make_wheel(arch: str, run: Run) -> None:
    """Build the wheel for ARCH, and tag it with the oldest system that it runs on."""
    raw = WORK / f"wheel-{arch}"
    shutil.rmtree(raw, ignore_errors=True)
    command: list[str | Path] = [
        VENV / "bin/python",
        "-m",
        "pip",
        "wheel",
        "--no-deps",
        "--no-build-isolation",
    ]
    if arch != HERE:
        cross = [f"_PYTHON_HOST_PLATFORM=linux-{arch}", f"CMAKE_TOOLCHAIN_FILE={toolchain(arch)}"]
        command = ["env", *cross, *command]
    with alone():
        run([*command, "--wheel-dir", raw, ROOT])
        [built] = raw.glob("*.whl")
        run([VENV / "bin/python", "-m", "auditwheel", "repair", "--wheel-dir", raw / "tagged", built])
        keep((raw / "tagged").glob("*.whl"))


def make_deb(run: Run) -> None:
    """Build the Debian packages."""
    raw = WORK / "deb"
    shutil.rmtree(raw / "out", ignore_errors=True)
    settings = ("CMAKE_BUILD_TYPE=Release", "CMAKE_INSTALL_PREFIX=/usr", "ARGUS_TESTS=OFF", "ARGUS_ARGUSD=ON")
    with alone():
        run(["cmake", "-S", ROOT, "-B", raw, *(f"-D{setting}" for setting in settings), "-DARGUS_TUI=ON"])
        run(["cmake", "--build", raw, "-j", str(CORES)])
        run(["cpack", "-G", "DEB", "--config", raw / "CPackConfig.cmake", "-B", raw / "out"])
        keep((raw / "out").glob("*.deb"))


def keep(made: Iterable[Path]) -> None:
    """Put what was made into dist/, in place of an older one."""
    DIST.mkdir(exist_ok=True)
    for path in made:
        shutil.copy2(path, DIST / path.name)
        say(shown(DIST / path.name))


def do_package(args: argparse.Namespace) -> int:
    """Make what is asked for."""
    if args.arch != HERE and args.kind != "wheel":
        raise Stop(f"--arch {args.arch}: only the wheel is built for another machine than this", EXIT_USAGE)
    needs = needs_of(args.arch) if args.kind == "wheel" else ["dpkg-dev"]
    ensure([], needs)
    make = functools.partial(make_wheel, args.arch) if args.kind == "wheel" else make_deb
    quietly(f"building: {args.kind}, {args.arch}", make)
    return 0


Add = Callable[[str, Callable[[argparse.Namespace], int], str, str], argparse.ArgumentParser]


def add_commands(add: Add) -> None:
    """Add the command that packages."""
    package = add(
        "package",
        do_package,
        "make what is installed elsewhere, in dist/: a Python wheel, or Debian packages",
        "package wheel\npackage wheel --arch aarch64\npackage deb",
    )
    package.add_argument(
        "kind",
        choices=("wheel", "deb"),
        help="wheel: emulator, tools and compiled core for Python; deb: argusd with its unit, and the tools",
    )
    package.add_argument(
        "--arch", choices=ARCHITECTURES, default=HERE, help="processor of the wheel (default: this machine's)"
    )
