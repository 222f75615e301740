# SPDX-License-Identifier: MIT
"""Rule: what Doxygen reads of the public header holds every comment and every row of its tables."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import api_filter  # noqa: E402
import gen_docs  # noqa: E402

HEADER = ROOT / "firmware/include/argus/argus.h"


def test_every_row_of_the_tables_is_a_name_with_its_meaning() -> None:
    done = subprocess.run(
        [sys.executable, str(ROOT / "tools/api_filter.py"), str(HEADER)],
        capture_output=True,
        text=True,
        check=True,
    )
    events = gen_docs.rows("include/argus/argus.h", "ARGUS_EVENT_TABLE")
    settings = gen_docs.rows("include/argus/argus.h", "ARGUS_CONFIG_TABLE")
    assert len(events) > 40
    assert len(settings) > 30
    assert [row[1] for row in events if f"ARGUS_EV_{row[1]} = {row[0]}," not in done.stdout] == []
    assert [row[0] for row in settings if f"    int32_t {row[0]};" not in done.stdout] == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("// Above.\nint a;", "/// Above.\nint a;"),
        ("    int a; // behind", "    int a; ///< behind"),
        ("    ONE, // behind", "    ONE, ///< behind"),
        ("    LAST // behind", "    LAST ///< behind"),
        (
            "    int a; // behind\n               // and on",
            "    int a; ///< behind\n               ///< and on",
        ),
        (
            "    int a; // behind\n    // above\n    int b;",
            "    int a; ///< behind\n    /// above\n    int b;",
        ),
        ('#define A "// no comment"', '#define A "// no comment"'),
    ],
)
def test_comments(text: str, expected: str) -> None:
    assert api_filter.filtered("include/argus/argus.h", text) == expected + "\n"


def test_the_header_is_a_file_that_doxygen_documents() -> None:
    """Without @file it leaves out every function; a section's title belongs to no name."""
    text = "// SPDX-License-Identifier: MIT\n// What it is.\n//\n// More.\n\n// Bounds ----------\n\n#define A 1 // one"
    expected = "/// @file\n/// What it is.\n///\n/// More.\n\n// Bounds ----------\n\n#define A 1 ///< one\n"
    assert api_filter.filtered("include/argus/argus.h", text) == expected


def test_the_makers_of_names_are_left_out() -> None:
    text = "#define ARGUS_EVENT_ENUM(number, name) (number),\n#undef ARGUS_EVENT_ENUM\nint a;"
    assert api_filter.filtered("include/argus/argus.h", text) == "int a;\n"
