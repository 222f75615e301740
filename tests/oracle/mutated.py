# SPDX-License-Identifier: MIT
"""Fault managers with one safety rule broken, built in a scratch folder: what the monitor must find."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).resolve().parents[2]
_FLAGS: Final = ("-std=c11", "-O1", "-fPIC", "-w")


@dataclass(frozen=True)
class Mutant:
    """A pattern in a file of firmware/ becomes another text.

    mission: of watch_missions.py, that shows it. rules: of the monitor, one of which must find it.
    """

    name: str
    mission: str
    rules: frozenset[int]
    edits: tuple[tuple[str, str, str], ...]


def compiler() -> list[str]:
    """Return the words of the C compiler."""
    return shlex.split(os.environ.get("CC", "")) or [next(filter(shutil.which, ("cc", "gcc", "clang")), "cc")]


def mutate(mutant: Mutant, folder: Path) -> Path:
    """Copy firmware/ to a folder, break it there, and return the copy; ValueError where a pattern has no one place."""
    copy = folder / mutant.name / "firmware"
    shutil.copytree(ROOT / "firmware", copy)
    for name, pattern, text in mutant.edits:
        file = copy / name
        changed, count = re.subn(pattern, text, file.read_text(encoding="utf-8"))
        if count != 1:
            raise ValueError(f"{mutant.name}: '{pattern}' is {count} times in firmware/{name}")
        file.write_text(changed, encoding="utf-8")
    return copy


class Workshop:
    """Compiles all of firmware/ once, and of a mutant what it changes."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._sources = sorted((ROOT / "firmware").rglob("*.c"))
        plain = folder / "plain"
        plain.mkdir(parents=True)
        self._objects = {file: plain / f"{n}.o" for n, file in enumerate(self._sources)}
        self._shim = plain / "shim.o"
        self._compile(ROOT / "firmware", ROOT / "tools/core_shim.c", self._shim)
        for file, made in self._objects.items():
            self._compile(ROOT / "firmware", file, made)

    def _compile(self, firmware: Path, source: Path, made: Path) -> None:
        words = [*compiler(), *_FLAGS, f"-I{firmware}", f"-I{firmware / 'include'}"]
        subprocess.run([*words, "-c", "-o", str(made), str(source)], check=True)

    def build(self, mutant: Mutant | None = None) -> Path:
        """Return the libargus.so of a mutant, or of the fault manager as it is."""
        objects = dict(self._objects)
        library = self.folder / f"{mutant.name if mutant else 'as-it-is'}.so"
        if mutant is not None:
            copy = mutate(mutant, self.folder)
            for name, _, _ in mutant.edits:
                made = copy / f"{Path(name).stem}.mutant.o"
                self._compile(copy, copy / name, made)
                objects[ROOT / "firmware" / name] = made
        parts = [*map(str, objects.values()), str(self._shim)]
        subprocess.run([*compiler(), "-shared", "-o", str(library), *parts], check=True)
        return library
