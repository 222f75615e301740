# SPDX-License-Identifier: MIT
"""Rule: the programs start as the launch files, parameter files and docs/ros.md say; bad input is told in one line."""

from __future__ import annotations

import doctest
import importlib.util
import re
import shlex
import signal
import subprocess
import sys
import time
import tomllib
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
import yaml
from argus_ros import parameters
from argus_ros.parameters import ARGUS, RANGE_GUARD
from harness import ROOT
from nodes import Bench
from rcl_interfaces.srv import GetParameters
from robots import emulated, free_port, minded
from sensor_msgs.msg import Range

BIN = Path(sys.prefix) / "bin"
PACKAGE = ROOT / "tools/argus_ros"
TABLES = {"argus": ARGUS, "range_guard": RANGE_GUARD}
EXIT_USAGE = 2


def run(*command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(BIN / command[0]), *command[1:]], capture_output=True, text=True, timeout=120, check=False
    )


@contextmanager
def running(command: list[str]) -> Iterator[None]:
    """A program while it runs, ended as by Ctrl-C."""
    process = subprocess.Popen([str(BIN / command[0]), *command[1:]], stderr=subprocess.PIPE, text=True)
    try:
        yield
    finally:
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
    assert process.returncode == 0, errors


def parameter(bench: Bench, node: str, name: str) -> object:
    client = bench.listener.create_client(GetParameters, f"{node}/get_parameters")
    assert bench.until(client.service_is_ready, 60), f"{node} does not come up"
    future = client.call_async(GetParameters.Request(names=[name]))
    assert bench.until(future.done, 60)
    return future.result().values[0].string_value


@pytest.mark.parametrize(
    ("command", "word"),
    [
        (("argus-range-guard", "--ros-args", "-p", "dead:=hide"), "withhold or invalid or cover"),
        (("argus-range-guard", "--ros-args", "-p", "robot:=p9"), "name one of"),
        (("argus-range-guard", "--ros-args", "-p", "sonars:=[1, 2]"), "16 topics but 2 sonars"),
        (("argus-range-guard", "--ros-args", "-p", "suffix:=''"), "suffix is '': it is empty"),
        (("argus-range-guard", "--ros-args", "-p", "settings:=[speed=1]"), "no such setting"),
        (("argus-range-guard", "--ros-args", "-p", "settings:=[suspect_readings=5000]"), "suspect_readings"),
        (("argus-range-guard", "--ros-args", "-p", "topics:=[a, a]"), "give each topic once"),
        (("argus-range-guard", "--ros-args", "-p", "diagnostics_s:=0.0"), "'0.0': give 0.1 to 60"),
        (("argus-range-guard", "--ros-args", "-p", "topics:=['a b']"), "see --help"),
        (("argus-ros", "--ros-args", "-p", "diagnostics_s:=0.0"), "give 0.1 to 60"),
        (("argus-ros", "--ros-args", "-p", "period_ms:=0"), "give 50 to 1000"),
        (("argus-ros", "--ros-args", "-p", "max_turn_rad_s:=.nan"), "'nan': give 0 to 10"),
        (("argus-ros", "--ros-args", "-p", "max_speed_m_s:=-0.5"), "'-0.5': give 0 to 5"),
        (("argus-ros", "--ros-args", "-p", "cmd_vel_timeout_s:=.inf"), "'inf': give 0.1 to 10"),
        (("argus-ros", "--ros-args", "-p", "base_link_frame_id:=''"), "give a frame without blanks"),
        (("argus-range-guard", "topics"), "unknown argument 'topics'"),
        (("argus-ros", "--ros-args", "-p", "guard:=localhost"), "give HOST:PORT"),
        (("argus-ros", "--ros-args", "-p", "guard:=8101"), "expecting type 'STRING'"),
        (("argus-ros", "--ros-args", "-p", "control:=/tmp/a"), "give unix:PATH or tcp:HOST:PORT"),
        (("argus-ros", "--ros-args", "-p", "token_file:=/nonexistent"), "No such file"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(command: tuple[str, ...], word: str) -> None:
    done = run(*command)
    last = done.stderr.strip().splitlines()[-1]
    assert done.returncode == EXIT_USAGE
    assert word in last


@pytest.mark.parametrize("name", sorted(TABLES))
def test_the_parameter_files_have_every_parameter_at_its_default(name: str) -> None:
    given = yaml.safe_load((PACKAGE / f"config/{name}.yaml").read_text())["/**"]["ros__parameters"]
    assert given == {key: parameter.default for key, parameter in TABLES[name].items()}


@pytest.mark.parametrize("name", sorted(TABLES))
def test_the_documentation_has_every_parameter(name: str) -> None:
    text = (ROOT / "docs/ros.md").read_text()
    for key, parameter in TABLES[name].items():
        assert f"| `{key}` |" in text, key
        assert parameter.meaning in text, parameter.meaning
        if parameter.low is not None:
            assert f"{parameter.meaning} ({parameter.wanted()})" in text, key


def commands_of(launch: Path, **given: str) -> list[list[str]]:
    """What a launch file starts: its executables, with the arguments given, else their defaults."""
    root = ET.parse(launch).getroot()
    values = {argument.get("name", ""): argument.get("default", "") for argument in root.iter("arg")} | given
    found = []
    for executable in root.iter("executable"):
        text = executable.get("cmd", "")
        while "$(" in text:
            text = re.sub(r"\$\(var (\w+)\)", lambda match: values[match[1]], text)
            text = text.replace("$(dirname)", str(launch.parent))
        found.append(shlex.split(text))
    return found


def test_the_launch_file_of_the_guard_starts_it_in_a_namespace() -> None:
    (command,) = commands_of(PACKAGE / "launch/range_guard.launch.xml", namespace="/shop", odometry="odom")
    bench = Bench()
    with running(command):
        assert parameter(bench, "/shop/range_guard", "odometry") == "odom"
        assert bench.until(lambda: bool(bench.listener.count_subscribers("/shop/sonar/range_7")))
        assert bench.until(lambda: bool(bench.listener.count_publishers("/shop/sonar/range_7/guarded")))
    bench.close()


def test_the_launch_file_of_the_robot_starts_its_node(tmp_path: Path) -> None:
    sim, address = emulated(tmp_path, "--world", "demo")
    argusd, place = minded(tmp_path, address, "--passive")
    (command,) = commands_of(PACKAGE / "launch/argus.launch.xml", control=place, guard="127.0.0.1:9")
    bench = Bench()
    bench.listen(Range, "sonar/range_0")
    try:
        with running(command):
            assert bench.until(lambda: bool(bench.heard), 60)
            assert parameter(bench, "/argus", "control") == place
    finally:
        bench.close()
        argusd.end()
        sim.end()


def test_help_needs_no_ros() -> None:
    for program in ("argus-ros", "argus-range-guard"):
        done = run(program, "--help")
        assert (done.returncode, done.stderr) == (0, "")
        assert "examples:" in done.stdout
        table = {"argus-ros": ARGUS, "argus-range-guard": RANGE_GUARD}[program]
        assert [name for name in table if f"\n  {name}:=" not in done.stdout] == []
    assert doctest.testmod(parameters).failed == 0


def blocks_of_the_page() -> list[list[str]]:
    text = (ROOT / "docs/ros.md").read_text()
    return [block.splitlines() for block in re.findall(r"```sh\n(.*?)```", text, re.S)]


FOREIGN = ("pip", "python", "ros2")
"""Programs of the page that are not of this project: test_launch.py has ros2."""


def test_what_the_page_installs_and_makes_is_there() -> None:
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    lines = [line for block in blocks_of_the_page() for line in block if line.split()[0] in ("pip", "python")]
    named = {extra for line in lines for extra in re.findall(r"'\.\[(\w+)\]'", line)}
    assert named == {"ros", "foxglove"} <= extras.keys()
    (make,) = (line for line in lines if line.startswith("python "))
    # This environment was made so (tools/devtool/ros.py); once more it finds what it made.
    done = subprocess.run(
        [sys.executable, *shlex.split(make)[1:]], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert importlib.util.find_spec("tf2_msgs")


def run_beside_each_other(lines: list[str], ours: dict[str, str]) -> list[str]:
    """Run the commands of a block, and end them as by Ctrl-C; return which programs those were."""
    bench = Bench()
    bench.listen(Range, "sonar/range_0")
    started: list[subprocess.Popen[str]] = []
    programs = []
    for line in lines:
        for theirs, place in ours.items():
            line = line.replace(theirs, place)
        program, *arguments = shlex.split(line)
        path = ROOT / "build/release/argusd" if program == "argusd" else BIN / program
        started.append(subprocess.Popen([str(path), *arguments], stdout=subprocess.PIPE, text=True))
        programs.append(program)
        time.sleep(2.0 if len(lines) > 1 else 0.5)
    try:
        guards = programs.count("argus-range-guard")
        assert bench.until(lambda: bench.listener.count_publishers("/sonar/cloud_guarded") == guards, 60), (
            lines
        )
        if "argus-ros" in programs:
            assert bench.until(lambda: bool(bench.heard), 60), lines
        if "argus-foxglove" in programs:
            assert started[-1].stdout is not None
            assert started[-1].stdout.readline().startswith("ws://")
        assert [process.poll() for process in started] == [None] * len(lines), lines
    finally:
        for process in reversed(started):
            process.send_signal(signal.SIGINT)
            process.wait(60)
        bench.close()
    assert {process.returncode for process in started} <= {0}, lines
    return programs


def test_every_command_of_the_page_runs(tmp_path: Path) -> None:
    # As the page has them, one beside the other; for a robot's serial line, ports and places those of this test.
    sim, address = emulated(tmp_path, "--world", "demo")
    ours = {
        "serial:/dev/ttyUSB0@9600": f"tcp:{address}",
        "8101": str(free_port()),
        "8102": str(free_port()),
        "/tmp/argus.sock": str(tmp_path / "argus.sock"),
    }
    programs: list[str] = []
    for block in blocks_of_the_page():
        lines = [line for line in block if line.split()[0] not in FOREIGN]
        programs += run_beside_each_other(lines, ours)
    sim.end()
    assert {"argusd", "argus-sim", "argus-ros", "argus-range-guard", "argus-foxglove"} == set(programs)
