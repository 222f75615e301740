# SPDX-License-Identifier: MIT
"""Rule: `import argus` and `argus-log --help` load nothing that they do not use, so they are there at once."""

from __future__ import annotations

import json
import subprocess
import sys

import argus
import pytest
from argus_tools.catalogue import HELP
from argus_tools.formats import formats
from argus_tools.log.cli import COMMANDS

HEAVY = ("numpy", "matplotlib", "rich", "asyncio", "hil_sim.arcos", "argus_tools.formats", "yaml", "ctypes")
LOADED = (
    "import sys, json; print(json.dumps([one for one in {heavy} if one in sys.modules]), file=sys.stderr)"
)


def loaded_by(code: str) -> list[str]:
    """Return which of the heavy modules a fresh interpreter has after the code."""
    script = f"{code}\n{LOADED.format(heavy=HEAVY)}"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    found: list[str] = json.loads(done.stderr)
    return found


def test_import_argus_loads_none_of_its_modules() -> None:
    assert loaded_by("import argus") == []


def test_a_name_of_argus_loads_what_it_needs() -> None:
    assert "hil_sim.arcos" in loaded_by("import argus; argus.Sip")


@pytest.mark.parametrize("words", [["--help"], ["-h"]])
def test_help_of_argus_log_loads_no_format_and_no_command(words: list[str]) -> None:
    code = f"from argus_tools.log.cli import main\ntry: main({words})\nexcept SystemExit: pass"
    assert loaded_by(code) == []


def test_all_names_of_argus_are_there_and_no_others() -> None:
    assert all(getattr(argus, name) is not None for name in argus.__all__)
    assert set(argus.__all__) <= set(dir(argus))
    with pytest.raises(AttributeError, match="nothing_of_it"):
        _ = argus.nothing_of_it


def test_the_catalogue_has_the_formats_in_their_order() -> None:
    assert {name: form.help for name, form in formats().items()} == HELP
    assert list(formats()) == list(HELP)


@pytest.mark.parametrize("name", COMMANDS)
def test_each_command_has_its_own_help(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    from argus_tools.log.cli import main

    with pytest.raises(SystemExit):
        main([name, "--help"])
    shown = capsys.readouterr().out
    assert COMMANDS[name][1:] in " ".join(shown.split())
    assert "examples:" in shown
