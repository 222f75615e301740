# SPDX-License-Identifier: MIT
"""Rule: what others build the library from builds: it compiles as they are told to, and a program links with it."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]


def version() -> str:
    header = (ROOT / "firmware/include/argus/argus.h").read_text(encoding="utf-8")
    match = re.search(r'^#define ARGUS_VERSION "(.+)"$', header, re.MULTILINE)
    assert match is not None
    return match[1]


EMBED = ("examples/embed/main.c", "examples/embed/robot.c")
ZEPHYR = """
cmake_minimum_required(VERSION 3.25)
project(stand_in C)
# What these functions of Zephyr do, as its documentation tells: a library of the module's own, and what all others see.
add_library(zephyr_interface INTERFACE)
function(zephyr_library_named name)
    add_library(${name} STATIC)
    target_link_libraries(${name} PRIVATE zephyr_interface)
    set(ZEPHYR_CURRENT_LIBRARY ${name} PARENT_SCOPE)
endfunction()
function(zephyr_library_sources)
    target_sources(${ZEPHYR_CURRENT_LIBRARY} PRIVATE ${ARGN})
endfunction()
function(zephyr_library_include_directories)
    target_include_directories(${ZEPHYR_CURRENT_LIBRARY} PRIVATE ${ARGN})
endfunction()
function(zephyr_include_directories)
    target_include_directories(zephyr_interface INTERFACE ${ARGN})
endfunction()
function(zephyr_compile_definitions)
    target_compile_definitions(zephyr_interface INTERFACE ${ARGN})
endfunction()
set(CONFIG_ARGUS y)
set(CONFIG_ARGUS_SONARS @SONARS@)
add_subdirectory(@MODULE@ argus)
add_executable(app @EMBED@)
target_link_libraries(app PRIVATE zephyr_interface argus)
"""


def built(*command: object) -> None:
    """Run a command that builds something."""
    done = subprocess.run(
        [str(word) for word in command], cwd=ROOT, check=False, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr


def runs(program: Path) -> None:
    """The example finds what fails on its robot."""
    done = subprocess.run([program], check=False, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert re.search(r"SONAR_SILENT +sonar  3 ", done.stdout)


@pytest.mark.soak
def test_platformio_library(tmp_path: Path) -> None:
    library = json.loads((ROOT / "library.json").read_text(encoding="utf-8"))
    build = library["build"]
    assert library["version"] == version()
    for name in (*library["export"]["include"], build["srcDir"], build["includeDir"]):
        assert (ROOT / name).exists(), name
    assert (ROOT / build["includeDir"] / library["headers"]).exists()
    sources = sorted((ROOT / build["srcDir"]).rglob("*.c"))
    assert len(sources) > 40
    include = f"-I{build['includeDir']}"
    built("gcc", *build["flags"], include, "-O1", *sources, *EMBED, "-o", tmp_path / "app")
    runs(tmp_path / "app")


@pytest.mark.soak
def test_zephyr_module(tmp_path: Path) -> None:
    module = yaml.safe_load((ROOT / "zephyr/module.yml").read_text(encoding="utf-8"))
    assert module["name"] == "argus"
    kconfig = (ROOT / module["build"]["kconfig"]).read_text(encoding="utf-8")
    options = set(re.findall(r"^config (\w+)", kconfig, re.MULTILINE))
    recipe = ROOT / module["build"]["cmake"]
    assert (
        set(re.findall(r"CONFIG_(\w+)", (recipe / "CMakeLists.txt").read_text(encoding="utf-8"))) == options
    )
    (sonars,) = re.findall(r"config ARGUS_SONARS\n(?:\t.*\n)*?\tdefault (\d+)", kconfig)
    given = {"SONARS": sonars, "MODULE": str(recipe), "EMBED": " ".join(str(ROOT / name) for name in EMBED)}
    text = re.sub(r"@(\w+)@", lambda found: given[found[1]], ZEPHYR)
    (tmp_path / "CMakeLists.txt").write_text(text, encoding="utf-8")
    built("cmake", "-S", tmp_path, "-B", tmp_path / "build", "-DCMAKE_BUILD_TYPE=Release")
    built("cmake", "--build", tmp_path / "build", "-j", "2")
    runs(tmp_path / "build/app")
