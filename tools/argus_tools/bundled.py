# SPDX-License-Identifier: MIT
"""The command `argusd` of a wheel: becomes the program that the wheel brings, or that of the build folder."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from hil_sim.program import ARGUSD_VARIABLE, NO_ARGUSD, find_argusd

EXIT_MISSING: Final = 127


def main(arguments: Sequence[str] | None = None) -> int:
    """Become argusd; return only when there is none."""
    own = Path(sys.argv[0]).resolve()
    found = find_argusd(but=own)
    if found is not None and Path(found).resolve() != own:
        os.execv(found, ["argusd", *(sys.argv[1:] if arguments is None else arguments)])
    named = os.environ.get(ARGUSD_VARIABLE)
    print(
        f"argusd: {ARGUSD_VARIABLE} names no other program: '{named}'" if named else NO_ARGUSD,
        file=sys.stderr,
    )
    return EXIT_MISSING


if __name__ == "__main__":
    sys.exit(main())
