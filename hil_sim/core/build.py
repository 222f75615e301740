# SPDX-License-Identifier: MIT
"""Compiles the fault manager into a shared library where none was built, from the source tree."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Final

from hil_sim.errors import InputError

_TREE: Final = Path(__file__).resolve().parents[2]
_SHIM: Final = "tools/core_shim.c"
_FLAGS: Final = ("-std=c11", "-O2", "-fPIC", "-shared")
_PATIENCE_S: Final = 300
HINT: Final = "set ARGUS_CORE to a libargus.so"


def sources() -> Path:
    """Return the source tree, which holds firmware/ and the shim."""
    if (_TREE / _SHIM).is_file() and (_TREE / "firmware").is_dir():
        return _TREE
    raise InputError(f"libargus.so is not built, and its sources are not here: {HINT}")


def build(cache: Path | None = None) -> Path:
    """Return a library made of the sources as they are, compiling it if that was not done before."""
    root = sources()
    files = sorted((root / "firmware").rglob("*.c"))
    headers = sorted((root / "firmware").rglob("*.h"))
    digest = hashlib.sha256(" ".join(_FLAGS).encode())
    for file in (*files, *headers, root / _SHIM):
        digest.update(file.relative_to(root).as_posix().encode() + b"\0" + file.read_bytes())
    folder = cache or root / "build" / "core"
    library = folder / f"libargus-{digest.hexdigest()[:16]}.so"
    if not library.exists():
        _compile(library, root, files)
    return library


def _compile(library: Path, root: Path, files: list[Path]) -> None:
    words = os.environ.get("CC", "").split() or [next(filter(shutil.which, ("cc", "gcc", "clang")), "cc")]
    if not shutil.which(words[0]):
        raise InputError(f"libargus.so is not built, and there is no C compiler: install gcc, or {HINT}")
    print(f"argus-log: compiling the fault manager, once, into {library}", file=sys.stderr)
    includes = [f"-I{root / 'firmware'}", f"-I{root / 'firmware/include'}"]
    try:
        library.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=library.parent) as folder:
            made = Path(folder) / library.name
            command = [*words, *_FLAGS, *includes, "-o", str(made), *map(str, files), str(root / _SHIM)]
            done = subprocess.run(command, capture_output=True, text=True, timeout=_PATIENCE_S, check=False)
            if done.returncode:
                lines = (line for line in done.stderr.splitlines() if "error" in line)
                first = next(lines, f"exit code {done.returncode}")
                raise InputError(f"the fault manager does not compile ({first}); {HINT}")
            made.replace(library)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise InputError(f"{library}: the fault manager cannot be compiled ({error}); {HINT}") from error
