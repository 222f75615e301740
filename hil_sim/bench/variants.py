# SPDX-License-Identifier: MIT
"""Variants of the fault manager: one rule of the evidence taken out, or one of its constants changed."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from hil_sim.core.build import sources
from hil_sim.errors import InputError, SimError

RULES: Final = Path(__file__).with_name("rules.toml")
AWARENESS: Final = Path("firmware/awareness")
_FLAGS: Final = ("-std=c11", "-O2", "-fPIC", "-w")
_NUMBERS: Final = "numbers.h"
_ROW: Final = re.compile(r'^    X\((?P<name>\w+), (?P<value>\d+), "[^"]*", (?P<source>\w+),', re.MULTILINE)
_LEAST: Final = 3
"""Half or twice a smaller number is another rule, or the size of a memory."""


@dataclass(frozen=True)
class Edit:
    """In a file of the firmware a pattern becomes another text, once."""

    file: str
    pattern: str
    text: str

    def apply(self, source: str) -> str:
        """Return the source with the edit made; SimError when it has no place for it."""
        changed, count = re.subn(
            self.pattern, lambda match: match.expand(r"\g<1>") + self.text, source, count=1
        )
        if count != 1:
            raise SimError(f"{AWARENESS / self.file}: nothing matches {self.pattern}; correct {RULES.name}")
        return changed


@dataclass(frozen=True)
class Variant:
    """A changed fault manager. says: what is changed, in words."""

    name: str
    says: str
    edits: tuple[Edit, ...]


def _without(file: str, function: str, body: str) -> Edit:
    head = rf"(?ms)^((?:static )?[a-z][\w ]*?[ *]+{re.escape(function)}\([^;{{]*?\) \{{\n).*?^\}}\n"
    return Edit(file, head, f"    {body.strip()}\n}}\n")


def rules() -> dict[str, Variant]:
    """Return the fault managers that lack one rule each, by the name of the rule."""
    table: Mapping[str, Mapping[str, object]] = tomllib.loads(RULES.read_text(encoding="utf-8"))
    found = {}
    for name, row in table.items():
        edits = row["edits"]
        assert isinstance(edits, list)
        found[name] = Variant(name, str(row["says"]), tuple(_without(**edit) for edit in edits))
    return found


def _rows() -> list[re.Match[str]]:
    """The rows of single numbers in the table of the evidence."""
    return list(_ROW.finditer((sources() / AWARENESS / _NUMBERS).read_text(encoding="utf-8")))


def constants() -> dict[str, Variant]:
    """Return the fault managers with one hand-set number halved or doubled, by its name and the factor."""
    found = {}
    for row in _rows():
        name, value = f"ARGUS_{row['name']}", int(row["value"])
        if value < _LEAST or row["source"] == "size":
            continue
        for label, changed in (("/2", value // 2), ("*2", 2 * value)):
            edit = Edit(_NUMBERS, rf"(?m)^(    X\({row['name']}, )\d+", str(changed))
            found[f"{name}{label}"] = Variant(f"{name}{label}", f"{value} becomes {changed}", (edit,))
    return found


def hand_set() -> tuple[int, int]:
    """Return how many numbers the table of the evidence has, and the lines of its sources."""
    texts = [path.read_text(encoding="utf-8") for path in sorted((sources() / AWARENESS).glob("*.[ch]"))]
    return len(_rows()), sum(text.count("\n") for text in texts)


def _compiler() -> list[str]:
    return shlex.split(os.environ.get("CC", "")) or [next(filter(shutil.which, ("cc", "gcc", "clang")), "cc")]


def must_build() -> None:
    """SimError when variants cannot be built here: better said before hours of recording."""
    try:
        sources()
    except InputError:
        raise SimError("the sources of the fault manager are not here; run it in a checkout") from None
    if shutil.which(_compiler()[0]) is None:
        raise SimError(f"no C compiler ({_compiler()[0]}); install gcc, or set CC")


class Workshop:
    """Builds variants in a folder: what a variant does not change is compiled once."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.root = sources()
        self._compiler = _compiler()
        self._sources = [*sorted((self.root / "firmware").rglob("*.c")), self.root / "tools/core_shim.c"]

    def _run(self, words: Sequence[str]) -> None:
        try:
            done = subprocess.run([*self._compiler, *words], capture_output=True, text=True, check=False)
        except OSError as error:
            raise SimError(f"no C compiler ({error}); install gcc, or set CC") from error
        if done.returncode:
            lines = (line for line in done.stderr.splitlines() if "error" in line)
            raise SimError(f"a variant does not compile: {next(lines, done.stderr.strip())}")

    def _compile(self, source: Path, made: Path, root: Path) -> None:
        self._run([*_FLAGS, f"-I{root}", f"-I{root / 'include'}", "-c", str(source), "-o", str(made)])

    def _object(self, source: Path) -> Path:
        return self.folder / "whole" / f"{source.parent.name}-{source.stem}.o"

    def whole(self) -> Path:
        """Build the fault manager as it is; return its library. To be called first, and once."""
        (self.folder / "whole").mkdir(parents=True, exist_ok=True)
        for source in self._sources:
            self._compile(source, self._object(source), self.root / "firmware")
        return self._link("whole", {})

    def build(self, variant: Variant) -> Path:
        """Build a variant; return its library."""
        folder = self.folder / re.sub(r"\W", "_", variant.name)
        tree = folder / "firmware"
        shutil.copytree(self.root / "firmware", tree, dirs_exist_ok=True)
        for edit in variant.edits:
            path = tree / AWARENESS.name / edit.file
            path.write_text(edit.apply(path.read_text(encoding="utf-8")), encoding="utf-8")
        headers = any(edit.file.endswith(".h") for edit in variant.edits)
        changed = {self.root / AWARENESS / edit.file for edit in variant.edits}
        made = {}
        for source in self._sources if headers else sorted(changed):
            made[source] = folder / self._object(source).name
            inside = self.root / "firmware" in source.parents
            copy = tree / source.relative_to(self.root / "firmware") if inside else source
            self._compile(copy, made[source], tree)
        library = self._link(folder.name, made)
        shutil.rmtree(tree)
        return library

    def _link(self, name: str, made: Mapping[Path, Path]) -> Path:
        library = self.folder / name / "libargus.so"
        objects = [str(made.get(source, self._object(source))) for source in self._sources]
        self._run(["-shared", "-o", str(library), *objects])
        return library
