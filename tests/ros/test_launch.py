# SPDX-License-Identifier: MIT
"""Rule: ros2 itself takes our launch files, parameter files, lifecycle and services, as docs/ros.md says.

PyPI has no ros2 program. It is that of a ROS 2 installation, or made of ROS2_SOURCES=FOLDER with clones of
ros2/launch, launch_ros, ros2cli and rosidl_runtime_py, which are Python alone.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from harness import ROOT
from robots import emulated, free_port, minded

MODULES = (
    "launch/launch",
    "launch/launch_xml",
    "launch/launch_yaml",
    "launch_ros/launch_ros",
    "launch_ros/ros2launch",
    "rosidl_runtime_py",
    *(f"ros2cli/{name}" for name in ("ros2cli", "ros2pkg", "ros2node", "ros2param", "ros2interface")),
    *(f"ros2cli/{name}" for name in ("ros2lifecycle", "ros2service", "ros2topic")),
)
NEEDED = (
    "osrf-pycommon",
    "lark",
    "psutil",
    "argcomplete",
    "netifaces",
    "importlib-metadata",
    "packaging",
    "pyyaml",
)
STAND_IN = "class LoadNode:\n    Request = Response = object\n"
"""launch_ros imports composition_interfaces, which PyPI has not; our launch files compose nothing."""
RUN = "import sys; from ros2cli.cli import main; sys.argv[0] = 'ros2'; sys.exit(main())"
LIMIT_S = 90.0


class Ros2:
    """The program ros2 and the environment that it runs in."""

    def __init__(self, words: list[str], environment: dict[str, str]) -> None:
        self.words = words
        self.environment = environment

    def start(self, line: str) -> subprocess.Popen[str]:
        """Start a line of the page that begins with ros2."""
        words = [*self.words, *shlex.split(line)[1:]]
        pipe = subprocess.PIPE
        return subprocess.Popen(
            words, cwd=ROOT, env=self.environment, stdout=pipe, stderr=subprocess.STDOUT, text=True
        )

    def says(self, line: str) -> str:
        """What a line prints that ends by itself."""
        child = self.start(line)
        said, _ = child.communicate(timeout=LIMIT_S)
        assert child.returncode == 0, said
        return said

    @contextmanager
    def running(self, line: str) -> Iterator[None]:
        """A line while it runs, ended as by Ctrl-C."""
        child = self.start(line)
        try:
            yield
        finally:
            child.send_signal(signal.SIGINT)
            said, _ = child.communicate(timeout=LIMIT_S)
        assert "process has finished cleanly" in said, said

    def until(self, line: str, wanted: str) -> None:
        """Ask until the answer is the wanted one; a node comes up in its own time."""
        end = time.monotonic() + LIMIT_S
        said = ""
        while wanted not in said:
            assert time.monotonic() < end, said
            child = self.start(line)
            said, _ = child.communicate(timeout=LIMIT_S)


@pytest.fixture(scope="module")
def ros2(tmp_path_factory: pytest.TempPathFactory) -> Ros2:
    """The program, from an installation or from sources."""
    own = {**os.environ, "PATH": f"{Path(sys.prefix) / 'bin'}:{os.environ['PATH']}", "PYTHONUNBUFFERED": "1"}
    installed = shutil.which("ros2")
    if installed:
        return Ros2([installed], own)
    sources = os.environ.get("ROS2_SOURCES")
    if not sources:
        pytest.skip("no ros2 here; ROS2_SOURCES=FOLDER with clones of it makes one (docs/ros.md)")
    folder = tmp_path_factory.mktemp("ros2")
    pip = [
        sys.executable,
        "-m",
        "pip",
        "install",
        "-q",
        "--no-deps",
        "--no-build-isolation",
        "--target",
        str(folder),
    ]
    copies = shutil.copytree(sources, folder / "sources", ignore=shutil.ignore_patterns(".git", "test"))
    subprocess.run([*pip, *NEEDED, *(str(copies / name) for name in MODULES)], check=True)
    stand_in = folder / "composition_interfaces"
    stand_in.mkdir(exist_ok=True)
    (stand_in / "__init__.py").touch()
    (stand_in / "srv.py").write_text(STAND_IN)
    own |= {
        "PYTHONPATH": str(folder),
        "AMENT_PREFIX_PATH": f"{folder}:{sys.prefix}",
        "ROS_LOG_DIR": str(folder / "log"),
    }
    return Ros2([sys.executable, "-c", RUN], own)


def lines_of_the_page() -> list[str]:
    """What docs/ros.md tells to type with ros2, but for Nav2's own launch file."""
    blocks = re.findall(r"```sh\n(.*?)```", (ROOT / "docs/ros.md").read_text(), re.S)
    lines = [line for block in blocks for line in block.splitlines() if line.startswith("ros2 ")]
    return [line for line in lines if "nav2_bringup" not in line]


def test_the_launch_file_of_the_guard(ros2: Ros2) -> None:
    (line,) = (line for line in lines_of_the_page() if "range_guard.launch.xml" in line)
    with ros2.running(line):
        ros2.until("ros2 param get /range_guard odometry --no-daemon", "String value is: odom")
        ros2.until("ros2 param get /range_guard no_echo --no-daemon", "String value is: max")
        ros2.until("ros2 lifecycle get /range_guard --no-daemon", "active")


def test_the_launch_file_of_the_robot_its_lifecycle_and_services(ros2: Ros2, tmp_path: Path) -> None:
    other = ("range_guard.launch.xml", "two_robots.launch.xml")
    lines = (line for line in lines_of_the_page() if not any(name in line for name in other))
    launch, *others = lines
    assert "argus.launch.xml" in launch
    assert [line.split()[1] for line in others] == ["lifecycle", "service"]
    sim, address = emulated(tmp_path, "--world", "demo")
    port = free_port()
    argusd, place = minded(tmp_path, address, "--passive", "--guard", f"tcp:127.0.0.1:{port}")
    launch = launch.replace("unix:/tmp/argus.sock", place).replace("8101", str(port))
    try:
        with ros2.running(launch):
            ros2.until("ros2 lifecycle get /argus --no-daemon", "active")
            said = ros2.says(others[1])
            assert "success=True" in said
            said = ros2.says(others[0])
            assert "Transitioning successful" in said
            ros2.until("ros2 lifecycle get /argus --no-daemon", "inactive")
    finally:
        argusd.end()
        sim.end()
