# SPDX-License-Identifier: MIT
"""Rule: every C test function ends up in the generated runner; one that would not be run stops the build."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROJECT = """cmake_minimum_required(VERSION 3.25)
project(probe LANGUAGES NONE)
enable_testing()
foreach(name argus argus_hal argus_flags unity)
    add_library(${name} INTERFACE)
endforeach()
add_subdirectory(unit)
get_property(tests DIRECTORY unit PROPERTY TESTS)
list(JOIN tests " " tests)
message(STATUS "tests: ${tests}.")
"""


def configure(folder: Path, source: str) -> subprocess.CompletedProcess[str]:
    unit = folder / "unit"
    (unit / "arcos").mkdir(parents=True)
    shutil.copy(ROOT / "tests/unit/CMakeLists.txt", unit)
    (folder / "CMakeLists.txt").write_text(PROJECT)
    (unit / "arcos/test_probe.c").write_text(source)
    # No language is enabled, so generating fails in the end; the runner is written before that.
    command = ["cmake", "-S", str(folder), "-B", str(folder / "build")]
    return subprocess.run(command, check=False, capture_output=True, text=True)


def runner(folder: Path) -> str:
    return (folder / "build/unit/runner/arcos/test_probe.c").read_text()


def test_each_function_runs_once(tmp_path: Path) -> None:
    configure(tmp_path, "void test_a(void);\nvoid test_a(void) {\n}\n\nvoid test_b_2(void)\n{\n}\n")
    text = runner(tmp_path)
    assert f'#include "{tmp_path}/unit/arcos/test_probe.c"' in text
    assert text.count('UnityDefaultTestRun(test_a, "test_a"') == 1
    assert text.count('UnityDefaultTestRun(test_b_2, "test_b_2"') == 1
    assert "void setUp(void)\n{" in text
    assert "void tearDown(void)\n{" in text


def test_own_hooks_are_used(tmp_path: Path) -> None:
    configure(tmp_path, "void setUp(void) {\n}\n\nvoid test_a(void) {\n}\n")
    assert "void setUp(void)" not in runner(tmp_path)
    assert "void tearDown(void)\n{" in runner(tmp_path)


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("void test_a(void) {\n}\nstatic void test_b(void) {\n}\n", "would never run"),
        ("void test_a(void) {\n}\nvoid test_b() {\n}\n", "would never run"),
        ("void test_a(void) {\n}\nint test_b(int x) {\n    return x;\n}\n", "would never run"),
        ("void test_a(void) { // soaks\n}\n", "'soak' and 'wide' are known"),
        ("int helper(void) {\n    return 0;\n}\n", "no 'void test_name(void)'"),
    ],
)
def test_a_test_that_would_not_run_stops_the_build(tmp_path: Path, source: str, expected: str) -> None:
    done = configure(tmp_path, source)
    assert done.returncode != 0
    assert "arcos/test_probe.c" in done.stderr
    assert expected in " ".join(done.stderr.split())


def test_who_computes_for_long_is_run_apart(tmp_path: Path) -> None:
    configure(
        tmp_path,
        "void test_a(void);\nvoid test_a(void) { // soak\n}\n\nvoid test_b(void) {\n}\n"
        "void test_c(void) { // wide\n}\n",
    )
    lines = [line.strip() for line in runner(tmp_path).splitlines()]
    for name, kind in (("test_a", "soak"), ("test_b", "short"), ("test_c", "wide")):
        at = lines.index(f'UnityDefaultTestRun({name}, "{name}", __LINE__);')
        assert lines[at - 1] == f'if (unity_wants(argc, argv, "{kind}"))'


@pytest.mark.parametrize(
    ("source", "tests"),
    [
        ("void test_a(void) {\n}\n", "arcos.test_probe"),
        ("void test_a(void) { // soak\n}\n", "arcos.test_probe.soak"),
        ("void test_a(void) { // wide\n}\n", "arcos.test_probe.wide"),
        (
            "void test_a(void) { // soak\n}\nvoid test_b(void) {\n}\n",
            "arcos.test_probe arcos.test_probe.soak",
        ),
    ],
)
def test_each_kind_that_a_file_has_is_a_test_of_ctest(tmp_path: Path, source: str, tests: str) -> None:
    assert f"tests: {tests}.\n" in configure(tmp_path, source).stdout
