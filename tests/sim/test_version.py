# SPDX-License-Identifier: MIT
"""Rule: each program prints with --version the version that the header defines, and nothing else."""

from __future__ import annotations

import importlib
import re
from pathlib import Path
from typing import Final

import pytest

HEADER: Final = Path(__file__).resolve().parents[2] / "firmware/include/argus/argus.h"
PROGRAMS: Final = {
    "argus-sim": "hil_sim.cli.main",
    "argus-conformance": "hil_sim.conformance.cli",
    "argus-log": "argus_tools.log.cli",
    "argusctl": "argus_tools.control.cli",
    "argus-monitor": "argus_tools.monitor.cli",
    "argus-foxglove": "argus_tools.foxglove_bridge",
    "argus-flash-check": "argus_tools.flash_check",
}


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_version_is_that_of_the_header(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    defined = re.search(r'#define ARGUS_VERSION "(.+)"', HEADER.read_text())
    assert defined
    with pytest.raises(SystemExit) as left:
        importlib.import_module(PROGRAMS[name]).main(["--version"])
    assert left.value.code == 0
    assert capsys.readouterr().out == f"{name} {defined[1]}\n"
