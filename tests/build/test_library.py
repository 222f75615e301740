# SPDX-License-Identifier: MIT
"""Rule: firmware keeps no state, computes no floats, calls only memcpy, memset, memcmp, in layers."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILDS = {"release": "", "cortex-m4": "arm-none-eabi-"}
MEMORY = {"memcpy", "memmove", "memset", "memcmp"}  # GCC asks them of a freestanding C library
# What compilers call on their own account: 64-bit division and shifts where the machine has none, bit counts,
# and the hardening that some distributions switch on by default.
COMPILER = {
    "cortex-m4": {
        "__aeabi_ldivmod",
        "__aeabi_uldivmod",
        "__aeabi_lmul",
        "__aeabi_llsl",
        "__aeabi_llsr",
        "__aeabi_lasr",
        "__popcountsi2",
        "__gnu_thumb1_case_uqi",
    },
    "release": {"__stack_chk_fail", "__memcpy_chk", "__memset_chk", "_GLOBAL_OFFSET_TABLE_", "__popcountdi2"},
}
FLOAT = re.compile(r"\b(?:float|double|_Complex|math\.h|float\.h|fenv\.h)\b")
NO_CODE = re.compile(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'", re.DOTALL)


def library(preset: str) -> Path:
    path = ROOT / "build" / preset / "libargus.a"
    assert path.exists(), f"{path} is missing: run tools/dev build release cortex-m4"
    return path


def binutil(preset: str, name: str, *arguments: str) -> str:
    command = [BUILDS[preset] + name, *arguments, str(library(preset))]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


@pytest.mark.parametrize("preset", BUILDS)
def test_data_and_bss_are_empty(preset: str) -> None:
    rows = [line.split() for line in binutil(preset, "size", "-B", "-d").splitlines()[1:]]
    assert rows, "the library is empty"
    stateful = [(row[5], f"data {row[1]}", f"bss {row[2]}") for row in rows if row[1] != "0" or row[2] != "0"]
    # A const table of pointers counts as data, since the loader writes its addresses: use arrays of char.
    assert stateful == []


@pytest.mark.parametrize("preset", BUILDS)
def test_undefined_symbols(preset: str) -> None:
    defined: set[str] = set()
    wanted: set[str] = set()
    for line in binutil(preset, "nm").splitlines():
        match = re.fullmatch(r"(?:[0-9a-f]+| +) ?([A-Za-z]) (\S+)", line)
        if match:
            (wanted if match[1] in "Uvw" else defined).add(match[2])
    assert f"argus_init_for_{16 if BUILDS[preset] else 32}_sonars" in defined
    assert wanted - defined - MEMORY - COMPILER[preset] == set()


def test_sources_name_no_floating_point() -> None:
    # The symbol test above sees arithmetic (soft float calls); this one sees constants that were folded.
    found = []
    for path in sorted((ROOT / "firmware").rglob("*.[ch]")):
        code = NO_CODE.sub(lambda match: "\n" * match[0].count("\n"), path.read_text(encoding="utf-8"))
        for number, line in enumerate(code.splitlines(), 1):
            if FLOAT.search(line) or re.search(r"\b\d+\.\d*\b|\b\.\d+", line):
                found.append(f"{path.relative_to(ROOT)}:{number}: {line.strip()}")
    assert found == []


_INCLUDE = re.compile(r'^#include "([\w/]+\.h)"', re.MULTILINE)


def test_programs_see_the_public_header_only() -> None:
    # --auto-baud speaks to a robot before there is a manager, injection alters SIPs before the manager has them:
    # the wire part is usable alone. A guard port knows the first byte of a packet.
    allowed = {(f"hal/linux/argusd/{name}.c", "arcos/frame.h") for name in ("guards", "probe", "inject")}
    rooms = {path.name for path in (ROOT / "firmware").iterdir()}
    found = {
        (path.relative_to(ROOT).as_posix(), name)
        for path in (ROOT / "hal").rglob("*.[ch]")
        for name in _INCLUDE.findall(path.read_text(encoding="utf-8"))
        if name.split("/")[0] in rooms or name.split("/")[0] == "argus"
    }
    assert {pair for pair in found if pair[1] != "argus/argus.h"} == allowed


def test_no_file_of_hal_includes_itself_by_way_of_others() -> None:
    # A header and the source of its name beside it are one node: what one of them needs, both need.
    files = sorted((ROOT / "hal").rglob("*.[ch]"))
    needs: dict[Path, set[Path]] = {}
    for path in files:
        wanted = needs.setdefault(path.with_suffix(""), set())
        for name in _INCLUDE.findall(path.read_text(encoding="utf-8")):
            fitting = [other.with_suffix("") for other in files if other.as_posix().endswith("/" + name)]
            beside = [other for other in fitting if other.parent == path.parent]
            wanted.update(beside or fitting)
        wanted.discard(path.with_suffix(""))
    while leaves := [name for name, wanted in needs.items() if not wanted & needs.keys()]:
        for name in leaves:
            del needs[name]
    assert sorted(needs) == []


def test_layers_point_one_way() -> None:
    order = [
        "argus",
        "arcos",
        "robot",
        "knowledge",
        "paper",
        "awareness",
        "analysis",
        "adjustment",
        "task",
        "behaviour",
        "supervisor",
        "guardian",
    ]
    firmware = ROOT / "firmware"
    assert {path.parent.name for path in firmware.glob("*/*.c")} <= set(order)
    found = []
    for path in sorted(firmware.rglob("*.[ch]")):
        for folder, name in re.findall(r'#include "(\w+)/(\w+\.h)"', path.read_text(encoding="utf-8")):
            if order.index(folder) > order.index(path.parent.name):
                found.append(f"{path.relative_to(ROOT)} includes {folder}/{name} of a later layer")
    assert found == []
