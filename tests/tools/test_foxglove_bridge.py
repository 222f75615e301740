# SPDX-License-Identifier: MIT
"""Rule: what argus-foxglove tells the user to import comes with the program, and needs neither robot nor Foxglove."""

from __future__ import annotations

import json
import re
from importlib import resources

import pytest
from argus_tools.foxglove_bridge import main, parser


def test_the_layout_is_printed_as_it_is_shipped(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--layout"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert out == (resources.files("argus_tools") / "foxglove_layout.json").read_text(encoding="utf-8")
    assert {"configById", "layout"} <= json.loads(out).keys()


def test_help_names_no_file_of_the_sources() -> None:
    told = parser().format_help()
    assert "--layout" in told
    assert not re.search(r"\bdocs/", told)
