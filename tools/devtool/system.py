# SPDX-License-Identifier: MIT
"""What the machine must have: how each thing is seen, and the packages that bring it."""

from __future__ import annotations

import dataclasses
import functools
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from devtool.base import EXIT_SETUP, LOGS, Stop, quiet_ok, say

MAIN: Final = "int main(void) { return 0; }\n"
# gcc-N-multilib, unlike gcc-multilib, stands beside cross compilers; it lacks asm/, that of 64 bit serves.
M32_FLAGS: Final = ("-m32", "-idirafter", "/usr/include/x86_64-linux-gnu")
M32_PROBE: Final = "#include <errno.h>\n#include <stdio.h>\n#include <linux/serial.h>\n" + MAIN
HEADERS: Final = Path("/usr/include")


def compiles(source: str, *flags: str, compiler: str = "gcc") -> bool:
    """Tell whether COMPILER builds a program from SOURCE with FLAGS; stands for 'the package is installed'."""
    try:
        done = subprocess.run(
            [compiler, "-xc", "-", "-o", "/dev/null", *flags],
            input=source.encode(),
            capture_output=True,
            check=False,
        )
    except OSError:
        return False
    return done.returncode == 0


def has_gcc() -> bool:
    """Tell whether there is a compiler, whatever it lacks."""
    return shutil.which("gcc") is not None


def has_libc() -> bool:
    """Tell whether programs of the C library can be built; without a compiler that is unknown."""
    return not has_gcc() or compiles("#include <stdio.h>\n" + MAIN)


def has_library(header: str, flag: str) -> bool:
    """Tell whether HEADER and the library of FLAG are there; where nothing can be built, HEADER stands for both."""
    if has_gcc() and has_libc():
        return compiles(f"#include <{header}>\n" + MAIN, flag)
    return (HEADERS / header).exists()


def base_python() -> str:
    """Return the interpreter outside of any virtual environment, by the one name that is no link."""
    return os.path.realpath(getattr(sys, "_base_executable", None) or sys.executable)


def gcc_major() -> str:
    """Return the major version of gcc, which names its multilib package."""
    done = subprocess.run(["gcc", "-dumpversion"], capture_output=True, text=True, check=False)
    return done.stdout.strip().split(".")[0]


@dataclasses.dataclass(frozen=True)
class Need:
    """One thing a machine must have: how to see it, and the packages that bring it."""

    name: str
    present: Callable[[], bool]
    packages: Callable[[], list[str]]


def command_need(command: str, package: str) -> Need:
    """Need COMMAND in PATH."""
    return Need(command, lambda: shutil.which(command) is not None, lambda: [package])


PYTHON_H_PROBE: Final = """
import pathlib, sys, sysconfig
sys.exit(not pathlib.Path(sysconfig.get_path("include"), "Python.h").exists())
"""

NEEDS: Final = {
    "gcc": Need("gcc", has_gcc, lambda: ["gcc", "libc6-dev"]),
    "libc": Need("headers of the C library (libc6-dev)", has_libc, lambda: ["libc6-dev"]),
    "cmake": command_need("cmake", "cmake"),
    "generator": Need(
        "ninja or make", lambda: bool(shutil.which("ninja") or shutil.which("make")), lambda: ["ninja-build"]
    ),
    "venv": Need(
        "venv of python3",
        lambda: quiet_ok([base_python(), "-c", "import ensurepip, venv"]),
        lambda: ["python3-venv"],
    ),
    "curses": Need(
        "curses", functools.partial(has_library, "curses.h", "-lncursesw"), lambda: ["libncurses-dev"]
    ),
    "m32": Need(
        "gcc -m32",
        lambda: compiles(M32_PROBE, *M32_FLAGS),
        lambda: [f"gcc-{gcc_major()}-multilib", "libc6-dev-i386"],
    ),
    "cortex-m4": Need(
        "gcc for Cortex-M",
        lambda: quiet_ok(
            ["arm-none-eabi-gcc", "--specs=nosys.specs", "-xc", "-E", "-include", "string.h", "/dev/null"]
        ),
        lambda: ["gcc-arm-none-eabi", "libnewlib-arm-none-eabi"],
    ),
    "qemu-arm": command_need("qemu-system-arm", "qemu-system-arm"),
    "s390x": Need(
        "gcc for s390x",
        lambda: quiet_ok(["s390x-linux-gnu-gcc", "-xc", "-E", "-include", "string.h", "/dev/null"]),
        lambda: ["gcc-s390x-linux-gnu", "libc6-dev-s390x-cross"],
    ),
    "aarch64": Need(
        "gcc for aarch64",
        lambda: quiet_ok(["aarch64-linux-gnu-gcc", "-xc", "-E", "-include", "string.h", "/dev/null"]),
        lambda: ["gcc-aarch64-linux-gnu", "libc6-dev-arm64-cross"],
    ),
    "qemu-user": command_need("qemu-s390x", "qemu-user"),
    "clang": Need(
        "clang with its sanitizers",
        lambda: compiles(MAIN, "-fsanitize=address,undefined", compiler="clang"),
        lambda: ["clang", "libclang-rt-dev"],
    ),
    "tshark": command_need("tshark", "tshark"),
    "g++": command_need("g++", "g++"),
    "python-dev": Need(
        "headers of python3",
        lambda: quiet_ok([base_python(), "-c", PYTHON_H_PROBE]),
        lambda: ["python3-dev"],
    ),
    "groff": command_need("groff", "groff-base"),
    "pkg-config": command_need("pkg-config", "pkg-config"),
    "dpkg-dev": command_need("dpkg-shlibdeps", "dpkg-dev"),
    "lintian": command_need("lintian", "lintian"),
    "systemd": command_need("systemd-analyze", "systemd"),
    "can-utils": command_need("candump", "can-utils"),
    "doxygen": command_need("doxygen", "doxygen"),
    "cppcheck": command_need("cppcheck", "cppcheck"),
    "valgrind": command_need("valgrind", "valgrind"),
}
BASIC_NEEDS: Final = ("gcc", "libc", "cmake", "generator", "venv", "curses")
PRESET_NEEDS: Final = {
    "m32": ("m32",),
    "cortex-m4": ("cortex-m4",),
    "mps2-an386": ("cortex-m4",),
    "stm32f405": ("cortex-m4",),
    "blank": ("cortex-m4",),
    "mps2-tests": ("cortex-m4", "qemu-arm"),
    "stm32f405-tests": ("cortex-m4", "qemu-arm"),
    "big-endian": ("s390x", "qemu-user"),
    "sanitize": ("clang",),
}


def apt_prefix() -> list[str] | None:
    """Return what to put before apt-get here, or None when it may not be run."""
    if shutil.which("apt-get") is None:
        return None
    if os.geteuid() == 0:
        return []
    return ["sudo", "-n"] if quiet_ok(["sudo", "-n", "true"]) else None


def as_root(command: str) -> str:
    """Return COMMAND as somebody here has to type it so that root runs it: with sudo only where there is one."""
    if os.geteuid() == 0:
        return command
    if shutil.which("sudo"):
        return f"sudo {command}"
    return f"su -c '{command}'"


def by_hand(packages: Sequence[str]) -> str:
    """Return the lines that tell a person how to install PACKAGES."""
    names = " ".join(packages)
    if shutil.which("apt-get") is None:
        return f"install these with this machine's package manager (the names are Debian's):\n  {names}"
    update, install = "apt-get update", f"apt-get install -y --no-install-recommends {names}"
    if os.geteuid() != 0 and shutil.which("sudo") is None:
        return f"run this:\n  {as_root(f'{update} && {install}')}"
    return f"run this:\n  {as_root(update)} && {as_root(install)}"


def apt_install(packages: Sequence[str], tell: Callable[[str], None] = say) -> None:
    """Install PACKAGES, or stop with the command that does; TELL says what is done."""
    prefix = apt_prefix()
    if prefix is None:
        raise Stop(f"packages are missing; {by_hand(packages)}\nthen again what you ran", EXIT_SETUP)
    tell(f"installing with apt-get: {' '.join(packages)}")
    LOGS.mkdir(parents=True, exist_ok=True)
    log = LOGS / "apt.log"
    apt = [*prefix, "env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-q"]
    install = [*apt, "install", "-y", "--no-install-recommends", *packages]
    with log.open("w") as file:

        def attempt(command: list[str]) -> bool:
            file.flush()
            done = subprocess.run(
                command, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT, check=False
            )
            return done.returncode == 0

        if not attempt(install):
            attempt([*apt, "update"])
            if not attempt(install):
                raise Stop(f"apt-get failed, see {log}; else {by_hand(packages)}", EXIT_SETUP)


def missing_of(needs: Sequence[str]) -> list[Need]:
    """Return those of NEEDS that this machine has not got."""
    return [NEEDS[key] for key in dict.fromkeys(needs) if not NEEDS[key].present()]


def packages_of(needs: Sequence[Need]) -> list[str]:
    """Return the packages of NEEDS, each once."""
    return list(dict.fromkeys(package for need in needs for package in need.packages()))


def ensure_system(needs: Sequence[str]) -> None:
    """Install what is missing of NEEDS."""
    missing = missing_of(needs)
    if not missing:
        return
    say(f"missing: {', '.join(need.name for need in missing)}")
    apt_install(packages_of(missing))
    # All of them again: without a compiler some could not be seen before.
    still = missing_of(needs)
    if still:
        names = ", ".join(need.name for need in still)
        raise Stop(f"still missing after installing {' '.join(packages_of(still))}: {names}", EXIT_SETUP)
