# SPDX-License-Identifier: MIT
"""Where argusd is: one rule for every program in Python that starts it."""

from __future__ import annotations

import os
import shutil
import sysconfig
from pathlib import Path
from typing import Final

ARGUSD_VARIABLE: Final = "ARGUS_ARGUSD"
NO_ARGUSD: Final = (
    "argusd is not found: install the Debian package argusd, or build it in the sources "
    "(tools/dev build release)"
)
_ROOT: Final = Path(__file__).resolve().parents[1]
_WHEEL: Final = "argus_tools/argusd"
_NEAR: Final = (_ROOT / "build/release/argusd", _ROOT / _WHEEL, Path(sysconfig.get_path("purelib"), _WHEEL))
"""Where the sources build it, and where a wheel has it, also one that is installed while its sources are at hand: that
of the same version goes before another of PATH."""


def find_argusd(but: Path | None = None) -> str | None:
    """Return that of ARGUS_ARGUSD, else of the build folder, of the wheel, or of PATH, not `but` itself."""
    wanted = os.environ.get(ARGUSD_VARIABLE)
    if wanted:
        return shutil.which(wanted)
    near = next((str(path) for path in _NEAR if os.access(path, os.X_OK)), None)
    return near or next(filter(None, (_in(folder, but) for folder in os.get_exec_path())), None)


def _in(folder: str, but: Path | None) -> str | None:
    found = shutil.which("argusd", path=folder)
    return None if found is None or Path(found).resolve() == but else found
