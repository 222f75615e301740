# SPDX-License-Identifier: MIT
"""The command `argusd` of a wheel: becomes the program that the wheel brings, or that of the build folder."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path
from typing import Final

BESIDE: Final = Path(__file__).resolve().parent / "argusd"
BUILT: Final = Path(__file__).resolve().parents[2] / "build/release/argusd"
EXIT_MISSING: Final = 127


def elsewhere() -> str | None:
    """Return an argusd of PATH that is not this command."""
    own = Path(sys.argv[0]).resolve()
    for folder in os.get_exec_path():
        found = shutil.which("argusd", path=folder)
        if found is not None and Path(found).resolve() != own:
            return found
    return None


def main() -> int:
    """Become argusd; return only when there is none."""
    found = next((str(path) for path in (BUILT, BESIDE) if os.access(path, os.X_OK)), None) or elsewhere()
    if found is not None:
        os.execv(found, ["argusd", *sys.argv[1:]])
    print(
        "argusd: this wheel brings none; install the Debian package argusd, or build it in the sources "
        "(tools/dev build release)",
        file=sys.stderr,
    )
    return EXIT_MISSING


if __name__ == "__main__":
    sys.exit(main())
