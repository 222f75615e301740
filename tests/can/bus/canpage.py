# SPDX-License-Identifier: MIT
"""docs/can.md, and what its commands find on a machine that has the modules already."""

from __future__ import annotations

import re
from typing import Final

from harness import ROOT

PAGE: Final = (ROOT / "docs/can.md").read_text(encoding="utf-8")

# The page's `sudo` and `modprobe`, for one who is root already and has the modules. One that is built in and has
# no settings shows by what it offers.
PRELUDE: Final = """
sudo() { "$@"; }
is_there() { [ -e "/sys/module/$1" ] || grep -iqw "$1" /proc/net/protocols /proc/tty/ldiscs; }
modprobe() {
    shift
    for module; do is_there "$(echo "$module" | tr - _)" || { echo "no module $module"; return 1; }; done
}
"""


def blocks(kind: str) -> list[str]:
    """The commands of all blocks of one kind."""
    return re.findall(rf"^```{kind}\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
