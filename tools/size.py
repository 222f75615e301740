#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Size of libargus.a in one build folder: text, data and bss per object, RAM per instance, worst stack."""

from __future__ import annotations

import argparse
import json
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

import size_stack

EPILOG = """examples:
  tools/size.py build/cortex-m4
  tools/size.py build/release          (no stack: that build has no call graphs)

exit codes: 0 measured, 1 the library has data or bss, or its stack has no bound, 2 no build there"""

SYMBOL = re.compile(r"^\d+ (\d+) \S size_of_(\w+)$", re.MULTILINE)
SIZED_TYPES = ("argus_t", "argus_storage_t", "argus_config_t")


class NoBuild(Exception):
    """The folder holds no finished build; the message says what to do."""


def compile_command(folder: Path) -> tuple[Path, list[str]]:
    """Return working folder and command of one firmware object, without its source and output."""
    database = folder / "compile_commands.json"
    if not database.exists() or not (folder / "libargus.a").exists():
        raise NoBuild(f"{folder}: no finished build; run tools/dev build {folder.name}")
    for entry in json.loads(database.read_text(encoding="utf-8")):
        if "/firmware/" in entry["file"]:
            command = shlex.split(entry["command"])
            cut = command.index("-o")
            kept = [word for word in command[:cut] if not word.startswith(("-fcallgraph", "-fstack-usage"))]
            return Path(entry["directory"]), kept
    raise NoBuild(f"{database}: no firmware source; run tools/dev build {folder.name}")


def tool(command: list[str], name: str) -> str:
    """Return the binutils program NAME that belongs to the compiler of COMMAND."""
    prefix = re.match(r"(.*-)?(?:gcc|cc|clang)[^/]*$", Path(command[0]).name)
    return (prefix[1] or "" if prefix else "") + name


def output(command: list[str], cwd: Path | None = None) -> str:
    """Return what COMMAND prints."""
    return subprocess.run(command, cwd=cwd, check=True, stdout=subprocess.PIPE, text=True).stdout


def object_sizes(size: str, library: Path) -> list[tuple[str, int, int, int]]:
    """Return (object, text, data, bss) of each member of LIBRARY."""
    rows = []
    for line in output([size, "-B", "-d", str(library)]).splitlines()[1:]:
        text, data, bss, _, _, name = line.split(maxsplit=5)
        rows.append((name.split(" ")[0], int(text), int(data), int(bss)))
    return sorted(rows)


def type_sizes(folder: Path, names: tuple[str, ...]) -> dict[str, int]:
    """Return sizeof each type of NAMES, found by compiling one array of that many bytes for the target."""
    cwd, command = compile_command(folder)
    source = '#include "supervisor/manager.h"\n' + "".join(f"char size_of_{n}[sizeof({n})];\n" for n in names)
    with tempfile.TemporaryDirectory() as temporary:
        file = Path(temporary, "sizes.c")
        file.write_text(source, encoding="utf-8")
        result = str(file.with_suffix(".o"))
        output([*command, "-fno-common", "-o", result, "-c", str(file)], cwd)
        symbols = output([tool(command, "nm"), "-S", "--radix=d", result])
    found = {match[2]: match[1] for match in SYMBOL.finditer(symbols)}
    return {name: int(found[name]) for name in names}


def print_report(folder: Path) -> int:
    """Print all sizes of the build in FOLDER and return the exit code."""
    _, command = compile_command(folder)
    rows = object_sizes(tool(command, "size"), folder / "libargus.a")
    total = [sum(column) for column in ([r[1] for r in rows], [r[2] for r in rows], [r[3] for r in rows])]
    print(f"{'text':>7} {'data':>5} {'bss':>5}  object")
    for name, text, data, bss in rows:
        print(f"{text:7} {data:5} {bss:5}  {name}")
    print(f"{total[0]:7} {total[1]:5} {total[2]:5}  libargus.a")
    for name, size in type_sizes(folder, SIZED_TYPES).items():
        print(f"{size:7} bytes of RAM  {name}")
    code = 0
    if total[1] or total[2]:
        print("size: the library has data or bss, so state outside of argus_t", file=sys.stderr)
        code = 1
    if not list(folder.rglob("*.ci")):
        print("no call graphs in this build, so no stack")
        return code
    print("stack, bytes, of the public functions that need most")
    sys.stdout.flush()
    return max(code, size_stack.main([str(folder)]))


def main(argv: list[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    parser = argparse.ArgumentParser(
        prog="tools/size.py",
        description=__doc__,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("folder", type=Path, help="build folder, for example build/cortex-m4")
    args = parser.parse_args(argv)
    try:
        return print_report(args.folder)
    except NoBuild as error:
        print(f"size: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
