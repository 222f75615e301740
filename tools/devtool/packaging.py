# SPDX-License-Identifier: MIT
"""`tools/dev package`: wheel and .deb, each into dist/."""

from __future__ import annotations

import argparse
import configparser
import datetime
import email.utils
import functools
import os
import platform
import shutil
import subprocess
import zipfile
from collections.abc import Iterable
from pathlib import Path
from typing import Final

from devtool.base import BUILD, CORES, EXIT_USAGE, ROOT, VENV, Add, Run, Stop, say, shown
from devtool.commands import quietly
from devtool.setup import HEADER, alone, ensure
from devtool.stages import StageFailed, making

DIST: Final = ROOT / "dist"
WORK: Final = BUILD / "package"
HERE: Final = platform.machine()
ARM: Final = "aarch64"
ARCHITECTURES: Final = ("x86_64", ARM)
DEBIAN_OF: Final = {"x86_64": "amd64", ARM: "arm64"}
NEEDS: Final = ("dpkg-dev", "lintian", "systemd", *((ARM, "qemu-user") if HERE == "x86_64" else ()))
"""What the tests of the packages take."""
BROUGHT: Final = ("argusd", "argusd-licences.txt")
"""What only a wheel has among the tools."""
SCRIPT: Final = """\
#!/usr/bin/python3
import sys

from {module} import {function}

sys.exit({function}())
"""


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


def foreign_libraries(arch: str, run: Run) -> Path | None:
    """Unpack Debian's ncurses for ARCH into the build folder; None where apt has none.

    Nothing of the system is changed: apt looks at lists of its own.
    """
    place = WORK / f"libraries-{arch}"
    root = place / "root"
    if (root / "usr/include/curses.h").exists():
        return root
    if shutil.which("apt-get") is None or shutil.which("dpkg-deb") is None:
        return None
    for folder in ("state/lists/partial", "cache/archives/partial", "root"):
        (place / folder).mkdir(parents=True, exist_ok=True)
    (place / "status").touch()
    debian = DEBIAN_OF[arch]
    options = [
        *(f"-oAPT::Architecture={debian}", f"-oAPT::Architectures={debian}", "-oAPT::Sandbox::User=root"),
        *(f"-oDir::State={place / 'state'}", f"-oDir::State::status={place / 'status'}"),
        f"-oDir::Cache={place / 'cache'}",
    ]
    try:
        run(["apt-get", "-q", *options, "update"])
        run(["env", "-C", place, "apt-get", "-q", *options, "download", "libncurses-dev"])
        for package in sorted(place.glob("*.deb")):
            run(["dpkg-deb", "-x", package, root])
    except StageFailed:
        say(f"argusd in the wheel for {arch} has no screen: apt has no libncurses-dev for {debian} here")
        return None
    return root


def build_wheel(arch: str, run: Run, raw: Path) -> Path:
    """Build the wheel for ARCH in RAW, and tag it with the oldest system that it runs on; return that one."""
    shutil.rmtree(raw, ignore_errors=True)
    command: list[str | Path] = [
        VENV / "bin/python",
        "-m",
        "pip",
        "wheel",
        "--no-deps",
        "--no-build-isolation",
        "--config-settings=cmake.define.ARGUS_STATIC=ON",
    ]
    libraries = None if arch == HERE else foreign_libraries(arch, run)
    if arch == HERE or libraries is not None:
        command.append("--config-settings=cmake.define.ARGUS_TUI=ON")
    if libraries is not None:
        command.append(f"--config-settings=cmake.define.CMAKE_FIND_ROOT_PATH={libraries}")
    if arch != HERE:
        cross = [f"_PYTHON_HOST_PLATFORM=linux-{arch}", f"CMAKE_TOOLCHAIN_FILE={toolchain(arch)}"]
        command = ["env", *cross, *command]
    with alone():
        run([*command, "--wheel-dir", raw, ROOT])
        [built] = raw.glob("*.whl")
        run([VENV / "bin/python", "-m", "auditwheel", "repair", "--wheel-dir", raw / "tagged", built])
    [tagged] = (raw / "tagged").glob("*.whl")
    return tagged


def make_wheel(arch: str, run: Run) -> None:
    """Build the wheel for ARCH into dist/."""
    keep([build_wheel(arch, run, WORK / f"wheel-{arch}")])


def stage_tools(wheel: Path, stage: Path) -> None:
    """Unpack WHEEL as Debian has it: modules in lib/, programs for Debian's own Python in bin/, data in share/."""
    shutil.rmtree(stage, ignore_errors=True)
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(stage / "lib")
    [info] = (stage / "lib").glob("*.dist-info")
    for data in (stage / "lib").glob("*.data"):
        (data / "data/share").rename(stage / "share")
        shutil.rmtree(data)
    (info / "RECORD").unlink()  # pip's own: dpkg has its list
    for name in BROUGHT:  # a package of its own has it
        (stage / "lib/argus_tools" / name).unlink(missing_ok=True)
    (info / "INSTALLER").write_text("dpkg\n", encoding="utf-8")
    points = configparser.ConfigParser()
    points.read(info / "entry_points.txt", encoding="utf-8")
    (stage / "bin").mkdir()
    for name in BROUGHT:
        points.remove_option("console_scripts", name)
    for name, target in points["console_scripts"].items():
        module, _, function = target.partition(":")
        script = stage / "bin" / name
        script.write_text(SCRIPT.format(module=module, function=function), encoding="utf-8")
        script.chmod(0o755)


def release_time() -> int:
    """Return the time that the packages say they are of, which makes them the same whenever they are made."""
    given = os.environ.get("SOURCE_DATE_EPOCH", "")
    if given.isdigit():
        return int(given)
    done = subprocess.run(
        ["git", "log", "-1", "--format=%ct"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    return int(done.stdout) if done.stdout.strip().isdigit() else int(HEADER.stat().st_mtime)


def maintainer() -> str:
    """Return who answers for the packages: whom Debian's own variables name, or nobody in particular."""
    name = os.environ.get("DEBFULLNAME", "Argus contributors")
    return f"{name} <{os.environ.get('DEBEMAIL', 'argus@users.noreply.argus.invalid')}>"


def debian_flags() -> list[str]:
    """Return the settings for CMake with which Debian compiles, all its hardening on."""
    env = {**os.environ, "DEB_BUILD_MAINT_OPTIONS": "hardening=+all"}
    flags = {}
    for name in ("CFLAGS", "CPPFLAGS", "LDFLAGS"):
        done = subprocess.run(
            ["dpkg-buildflags", "--get", name], env=env, cwd=ROOT, capture_output=True, text=True, check=True
        )
        flags[name] = done.stdout.strip()
    links = ("CMAKE_EXE_LINKER_FLAGS", "CMAKE_SHARED_LINKER_FLAGS")
    return [
        f"CMAKE_C_FLAGS={flags['CFLAGS']} {flags['CPPFLAGS']}",
        *(f"{link}={flags['LDFLAGS']}" for link in links),
    ]


def make_deb(run: Run) -> None:
    """Build the Debian packages, with the tools of the wheel that was made before."""
    raw = WORK / "deb"
    epoch = release_time()
    date = email.utils.format_datetime(datetime.datetime.fromtimestamp(epoch, datetime.UTC))
    settings = (
        *("CMAKE_BUILD_TYPE=Release", "CMAKE_C_FLAGS_RELEASE=-O2 -DNDEBUG", "CMAKE_INSTALL_PREFIX=/usr"),
        *("ARGUS_TESTS=OFF", "ARGUS_WERROR=OFF", "ARGUS_ARGUSD=ON", "ARGUS_TUI=ON"),
        *(f"ARGUS_DEB={raw / 'tools'}", f"ARGUS_DEB_DATE={date}", f"ARGUS_MAINTAINER={maintainer()}"),
        *debian_flags(),
    )
    with alone():
        shutil.rmtree(raw / "out", ignore_errors=True)
        [wheel] = (WORK / f"wheel-{HERE}").glob("*.whl")
        stage_tools(wheel, raw / "tools")
        libraries = map(str, sorted((raw / "tools").rglob("*.so")))
        run(["strip", "--strip-unneeded", "-R", ".comment", *libraries])
        run(["cmake", "-S", ROOT, "-B", raw, *(f"-D{setting}" for setting in settings)])
        run(["cmake", "--build", raw, "-j", str(CORES)])
        package: list[str | Path] = [
            "cpack",
            "-G",
            "DEB",
            "--config",
            raw / "CPackConfig.cmake",
            "-B",
            raw / "out",
        ]
        run(["env", f"SOURCE_DATE_EPOCH={epoch}", *package])
        keep((raw / "out").glob("*.deb"))


def keep(made: Iterable[Path]) -> None:
    """Put what was made into dist/, in place of an older one."""
    DIST.mkdir(exist_ok=True)
    for path in made:
        shutil.copy2(path, DIST / path.name)
        say(shown(DIST / path.name))


def make_all(run: Run) -> None:
    """Make what this machine installs: the wheel and the Debian packages."""
    make_wheel(HERE, run)
    make_deb(run)


def do_package(args: argparse.Namespace) -> int:
    """Make what is asked for."""
    if args.arch != HERE and args.kind != "wheel":
        raise Stop(f"--arch {args.arch}: only the wheel is built for another machine than this", EXIT_USAGE)
    needs = needs_of(args.arch) if args.kind == "wheel" else ["dpkg-dev"]
    ensure([], needs)
    quietly(f"building the wheel, {args.arch}", functools.partial(make_wheel, args.arch))
    if args.kind == "deb":
        quietly("building the Debian packages", make_deb)
    return 0


def package_tests(run: Run) -> str | None:
    """Make all packages anew, and test them; tell which tests the machine kept from running."""
    shutil.rmtree(DIST, ignore_errors=True)
    with making():
        make_wheel(HERE, run)
        if HERE != ARM and toolchain(ARM).exists():
            make_wheel(ARM, run)
        make_deb(run)
    run([VENV / "bin/python", "-m", "pytest", "-q", "tests/packages"])
    chroot = os.environ.get("ARGUS_CHROOT")
    return None if chroot else "not installed in a clean Debian: ARGUS_CHROOT= names none"


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
