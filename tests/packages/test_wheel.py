# SPDX-License-Identifier: MIT
"""Rule: the wheel alone, in a clean environment, gives every command and example; the C core comes compiled with it."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import time
import tomllib
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path

import argus
import pytest
from packages_help import DIST, ROOT, run

EXAMPLE = """
import doctest, sys
import argus, argus.sil
from hil_sim.core import build as core_build
from hil_sim.core import library as core
from hil_sim import native

def refuse(*arguments):
    raise AssertionError("the core is compiled here")

core.build = refuse
assert core.library()._name.startswith(sys.prefix), core.library()._name
assert native.library()._name.startswith(sys.prefix), native.library()._name
result = doctest.testfile(sys.argv[1], module_relative=False)
assert result.attempted > 20 and not result.failed
print(argus.__version__)
"""


def entries(wheel: Path) -> dict[str, str]:
    """The console scripts that a wheel brings."""
    with zipfile.ZipFile(wheel) as archive:
        [name] = [name for name in archive.namelist() if name.endswith("/entry_points.txt")]
        text = archive.read(name).decode()
    return dict(re.findall(r"^(\S+) *= *(\S+)$", text, re.MULTILINE))


def test_it_holds_all_modules_and_data_and_nothing_else(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        held = {name for name in archive.namelist() if ".dist-info/" not in name and not name.endswith("/")}
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["scikit-build"]
    tracked = run("git", "ls-files", *settings["wheel"]["packages"]).splitlines()
    for_ros = {
        name.removeprefix("tools/") for name in tracked if re.match(r"tools/argus_ros/(launch|config)/", name)
    }
    expected = {name.removeprefix("tools/") for name in tracked} - for_ros
    share = {name.partition(".data/data/share/")[2] for name in held if ".data/" in name}
    assert share == {*for_ros, "argus_ros/package.xml", "ament_index/resource_index/packages/argus_ros"}
    held = {name for name in held if ".data/" not in name}
    assert held - expected == {
        "argus_tools/argusd",
        "argus_tools/argusd-licences.txt",
        "hil_sim/core/libargus.so",
        "hil_sim/sonar/libargus_sim.so",
    }
    missing = {name for name in expected - held if (ROOT / name).exists() or (ROOT / "tools" / name).exists()}
    assert not missing


def test_its_name_says_where_it_runs(wheel: Path) -> None:
    found = re.fullmatch(rf"argus_p3dx-{re.escape(argus.__version__)}-py3-none-(\S+)\.whl", wheel.name)
    assert found
    assert set(found[1].split(".")) == {
        f"manylinux2014_{os.uname().machine}",
        f"manylinux_2_17_{os.uname().machine}",
    }


def test_its_metadata_holds_the_readme(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        [name] = [name for name in archive.namelist() if name.endswith(".dist-info/METADATA")]
        told = archive.read(name).decode()
    assert "Description-Content-Type: text/markdown" in told
    assert (ROOT / "README.md").read_text(encoding="utf-8").strip() in told


def test_each_command_answers(wheel: Path, clean_venv: Path) -> None:
    names = entries(wheel)
    assert {"argus-sim", "argus-log"} <= set(names)
    for name in names:
        told = run(clean_venv / "bin" / name, "--help", cwd="/")
        assert told.startswith("argusd " if name == "argusd" else f"usage: {name}")
        assert "examples:" in told


def test_argusd_comes_along_and_needs_nothing_of_the_system(clean_venv: Path, tmp_path: Path) -> None:
    find = "from hil_sim.program import find_argusd; print(find_argusd())"
    env = {"PATH": "/usr/bin:/bin"}
    argusd = Path(run(clean_venv / "bin/python", "-I", "-c", find, cwd="/", env=env).strip())
    assert argusd.is_relative_to(clean_venv)
    assert "NEEDED" not in run("readelf", "-d", argusd)
    for program in (argusd, clean_venv / "bin/argusd"):
        assert run(program, "--version", cwd="/", env=env).strip() == f"argusd {argus.__version__}"
    robot = tmp_path / "robot"
    with subprocess.Popen([clean_venv / "bin/argus-sim", "--link-name", robot, "--baud", "115200"]) as sim:
        try:
            until = time.monotonic() + 60
            while not robot.is_symlink() and time.monotonic() < until:
                time.sleep(0.05)
            link = f"serial:{robot}@115200"
            command = [str(argusd), "--link", link, "--passive", "--plain", "--wait", "30"]
            with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=env) as child:
                assert child.stdout is not None
                assert any("SESSION_OPEN" in line for line in child.stdout), "it reaches the robot"
                child.terminate()
        finally:
            sim.terminate()


def test_ros_finds_the_launch_files(clean_venv: Path) -> None:
    """As ament does: the index names the package, its share folder holds the files, each with its parameters."""
    share = clean_venv / "share"
    assert (share / "ament_index/resource_index/packages/argus_ros").exists()
    assert ET.parse(share / "argus_ros/package.xml").findtext("version") == argus.__version__
    for name in ("argus", "range_guard"):
        launch = share / f"argus_ros/launch/{name}.launch.xml"
        [given] = [
            arg.get("default", "") for arg in ET.parse(launch).iter("arg") if arg.get("name") == "params"
        ]
        assert Path(given.replace("$(dirname)", str(launch.parent))).exists()


def test_the_layout_for_foxglove_comes_along(clean_venv: Path) -> None:
    told = run(clean_venv / "bin/argus-foxglove", "--layout", cwd="/")
    assert told == (ROOT / "tools/argus_tools/foxglove_layout.json").read_text(encoding="utf-8")


def test_the_examples_run_with_the_libraries_of_the_wheel(clean_venv: Path) -> None:
    env = {key: value for key, value in os.environ.items() if not key.startswith(("ARGUS_", "PYTHON"))}
    told = run(clean_venv / "bin/python", "-I", "-c", EXAMPLE, ROOT / "docs/python.md", env=env)
    assert told.splitlines()[-1] == argus.__version__


def test_a_log_is_judged_from_the_command_line(clean_venv: Path) -> None:
    sample = ROOT / "docs/samples/two-failing-sonars.rec.gz"
    told = run(
        clean_venv / "bin/argus-log", "faults", "--exit-zero", sample, cwd="/", env={"PATH": "/nonexistent"}
    )
    assert told.startswith("sonar/front/03 suspect")


@pytest.mark.skipif(
    not shutil.which("aarch64-linux-gnu-gcc") or not shutil.which("qemu-aarch64"),
    reason="gcc-aarch64-linux-gnu and qemu-user are not installed",
)
def test_the_wheel_for_aarch64_holds_libraries_and_argusd_that_run_there(tmp_path: Path) -> None:
    [wheel] = DIST.glob("argus_p3dx-*_aarch64.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path)
        library = tmp_path / "hil_sim/core/libargus.so"
    program = tmp_path / "embed"
    sources = [ROOT / "examples/embed/main.c", ROOT / "examples/embed/robot.c"]
    include = f"-I{ROOT / 'firmware/include'}"
    # By its soname, as the linker notes it.
    soname = re.search(r"SONAME.*\[(\S+)\]", run("readelf", "-d", library))
    assert soname
    argusd = tmp_path / "argus_tools/argusd"
    argusd.chmod(0o755)
    assert "NEEDED" not in run("readelf", "-d", argusd)
    assert run("qemu-aarch64", argusd, "--version").strip() == f"argusd {argus.__version__}"
    library.rename(tmp_path / soname[1])
    run("aarch64-linux-gnu-gcc", "-std=c11", include, *sources, tmp_path / soname[1], "-o", program)
    emulator = ["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu", "-E", f"LD_LIBRARY_PATH={tmp_path}"]
    done = subprocess.run([*emulator, str(program)], capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stderr
    assert re.search(r"SONAR_SILENT +sonar  3 ", done.stdout)
