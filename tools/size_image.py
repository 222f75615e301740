#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Flash, RAM and worst stack of a board's image, beside what they should be at most."""

from __future__ import annotations

import argparse
import dataclasses
import re
import subprocess
import sys
from pathlib import Path
from typing import Final

import size_stack

EPILOG: Final = """examples:
  tools/size_image.py build/mps2-an386
  tools/size_image.py build/stm32f405

exit codes: 0 measured, 1 the stack is too small or has no bound, 2 no image there"""
FLASH_AIM: Final = 128 * 1024
RAM_AIM: Final = 40 * 1024
IN_FLASH: Final = (".vectors", ".text", ".data")
IN_RAM: Final = (".stack", ".noinit", ".data", ".bss")
START: Final = "cortexm_start"
POINTED_AT: Final = ("slot_read", "slot_write")
"""What is called through a pointer in an image: the store's medium (hal/board/flash.c)."""
APART: Final = "copy.c*.ci"
"""The call graph of what is no part of the whole program (hal/cortexm/copy.c)."""
VECTORS: Final = "vectors"
EXCEPTION_BYTES: Final = 36
"""What the processor itself puts on the stack: 8 words, and one to align it (ARM DDI 0403, B1.5.7)."""
SECTION: Final = re.compile(r"^(\.\w+)\s+(\d+)\s+\d+", re.MULTILINE)


class NoImage(Exception):
    """The folder holds no image; the message says what to do."""


@dataclasses.dataclass(frozen=True)
class Sizes:
    """Bytes of an image."""

    flash: int
    ram: int
    stack: int
    worst: int
    path: tuple[str, ...]


def image_in(folder: Path) -> Path:
    """Return the image in FOLDER."""
    images = sorted(folder.glob("argus-*.elf"))
    if len(images) != 1:
        raise NoImage(f"{folder}: no image; run tools/dev firmware --board {folder.name}")
    return images[0]


def sections(image: Path) -> dict[str, int]:
    """Return the size of each section of IMAGE."""
    listing = subprocess.run(
        ["arm-none-eabi-size", "-A", "-d", str(image)], check=True, stdout=subprocess.PIPE, text=True
    ).stdout
    return {match[1]: int(match[2]) for match in SECTION.finditer(listing)}


def handlers(graph: size_stack.Graph, known: dict[str, size_stack.Depth]) -> int:
    """Return the stack of the deepest interrupt: functions that no other calls, but start-up and faults.

    All have one priority, so one runs at a time; faults take a stack of their own.
    """
    called = set().union(*graph.calls.values())
    alone = [n for n in graph.frames if n not in called and not size_stack.short(n).startswith("cortexm_")]
    return max((size_stack.deepest(graph, name, known).bytes for name in alone), default=0)


def measure(folder: Path) -> Sizes:
    """Measure the image in FOLDER."""
    image = image_in(folder)
    size = sections(image)
    graph = size_stack.Graph()
    for file in [*folder.glob("*.ltrans*.ci"), *folder.rglob(APART)]:
        graph.add(file.read_text(encoding="utf-8"))
    graph.point(POINTED_AT)
    starts = graph.named(START)
    if not starts:
        raise NoImage(f"{folder}: no call graph of the image; run tools/dev firmware --board {folder.name}")
    known: dict[str, size_stack.Depth] = {}
    depth = size_stack.deepest(graph, starts[0], known)
    return Sizes(
        flash=sum(size.get(name, 0) for name in IN_FLASH),
        ram=sum(size.get(name, 0) for name in IN_RAM),
        stack=size[".stack"],
        worst=depth.bytes + handlers(graph, known) + EXCEPTION_BYTES,
        path=tuple(f"{size_stack.short(name)} {graph.frames.get(name, 0)}" for name in depth.path),
    )


def told(size: int, aim: int) -> str:
    """Return SIZE in words, and whether the AIM is met."""
    return f"{size:6} bytes; the aim, {aim}, is {'met' if size <= aim else f'missed by {size - aim}'}"


def report(folder: Path) -> int:
    """Print the figures of the image in FOLDER and return the exit code."""
    sizes = measure(folder)
    print(f"flash  {told(sizes.flash, FLASH_AIM)}")
    print(f"RAM    {told(sizes.ram, RAM_AIM)}, with the stack")
    print(f"stack  {sizes.worst:6} bytes at worst, of {sizes.stack}, with one interrupt")
    print("       " + " > ".join(sizes.path))
    if sizes.worst > sizes.stack:
        print(f"size_image: {folder.name}: STACK_BYTES of its linker script is too small", file=sys.stderr)
        return 1
    return 0


def main(argv: list[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    parser = argparse.ArgumentParser(
        prog="tools/size_image.py",
        description=__doc__,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("folder", type=Path, help="build folder, for example build/mps2-an386")
    args = parser.parse_args(argv)
    try:
        return report(args.folder)
    except (NoImage, FileNotFoundError) as error:
        print(f"size_image: {error}", file=sys.stderr)
        return 2
    except size_stack.Unbounded as error:
        print(f"size_image: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
