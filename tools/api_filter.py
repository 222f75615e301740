#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Filter of Doxygen: print a public header with its comments and X-macro tables as Doxygen reads them.

The header is written for people: plain comments, and tables from which enumerations and structures are made. Here a
comment becomes one of Doxygen, and a table is expanded, each name with its meaning.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path
from typing import Final

sys.path.insert(0, str(Path(__file__).resolve().parent))
import gen_docs

EPILOG: Final = """examples:
  tools/api_filter.py firmware/include/argus/argus.h
  tools/dev api                                       # the pages that come of it

exit codes: 0 done, 2 bad arguments"""


def settings(header: str) -> list[str]:
    """Return the fields of the settings."""
    found = []
    for key, default, low, high, unit, choices, *meaning in gen_docs.rows(header, "ARGUS_CONFIG_TABLE"):
        numbers = choices in ("", "auto")
        span = f"{low} to {high} {unit}".rstrip() if numbers else choices.replace("|", ", ")
        found += [f"    /// {', '.join(meaning)}; {span}, default {default}.", f"    int32_t {key};"]
    return found


def about(header: str) -> list[str]:
    """Return the enumerators of what events are about."""
    return [f"    ARGUS_ABOUT_{row[0]}," for row in gen_docs.rows(header, "ARGUS_ABOUT_TABLE")]


def events(header: str) -> list[str]:
    """Return the enumerators of the events."""
    found = []
    for number, name, level, subject, *meaning in gen_docs.rows(header, "ARGUS_EVENT_TABLE"):
        found += [
            f"    /// {', '.join(meaning)}. Level {level}, about: {subject}.",
            f"    ARGUS_EV_{name} = {number},",
        ]
    return found


def profiles(header: str) -> list[str]:
    """Return the enumerators of the profiles."""
    found = []
    for name, word, _, _, _, *meaning in gen_docs.rows(header, "ARGUS_PROFILE_TABLE"):
        found += [f"    /// `{word}`: {', '.join(meaning)}.", f"    ARGUS_PROFILE_{name},"]
    return found


def policies(header: str) -> list[str]:
    """Return the enumerators of the planners."""
    found = []
    for name, word, _, _, _, _, *meaning in gen_docs.rows(header, "ARGUS_POLICY_TABLE"):
        found += [f"    /// `{word}`: {', '.join(meaning)}.", f"    ARGUS_POLICY_{name},"]
    return found


def kinds(header: str) -> list[str]:
    """Return the enumerators of the kinds of faults."""
    found = []
    for name, number, word, *meaning in gen_docs.rows(header, "ARGUS_FAULT_KIND_TABLE"):
        found += [f"    /// `{word}`: {', '.join(meaning)}.", f"    ARGUS_KIND_{name} = {number},"]
    return found


TABLES: Final = {
    "ARGUS_CONFIG_TABLE": settings,
    "ARGUS_ABOUT_TABLE": about,
    "ARGUS_CORE_EVENT_TABLE": events,
    "ARGUS_FAULT_KIND_TABLE": kinds,
    "ARGUS_PROFILE_TABLE": profiles,
    "ARGUS_POLICY_TABLE": policies,
}
FIRST_PAGE: Final = """
/** @mainpage The public header
 *
 * How to use it, and every name: @ref argus.h
 */
"""
LICENCE: Final = "// SPDX-License-Identifier:"
"""The first line; behind it stands what the header is."""
RULER: Final = re.compile(r"^// .*-{9,}$")
"""The title of a section, which says nothing of the name below it."""
HELPER: Final = re.compile(r"^#(define ARGUS_\w*(FIELD|ENUM|CONSTANT)\(|undef )")
"""What makes one row of a table into a name: of no use to a reader of the pages."""
PLAIN: Final = re.compile(r"^(\s*)//(?= |$)")
BEHIND: Final = re.compile(r"^(\s*[^/\s][^\"]*?[;,{)\w]) +// ")


def filtered(header: str, text: str) -> str:
    """Return the text of a header, which lies below firmware/, as Doxygen reads it."""
    lines: list[str] = []
    behind = False
    for line in text.splitlines():
        if line.startswith(LICENCE):
            lines.append("/// @file")
            continue
        if RULER.match(line):
            lines.append(line)
            continue
        if HELPER.match(line) or line.startswith("// clang-format"):
            continue
        used = re.match(r"\s*(ARGUS_\w+_TABLE)\(\w+(?:, )?\)( ARGUS_\w+_TABLE\(\w+\))*$", line)
        if used and used[1] in TABLES:
            lines += TABLES[used[1]](header)
            continue
        if BEHIND.match(line):
            lines.append(BEHIND.sub(r"\1 ///< ", line))
            behind = True
            continue
        # What follows a comment behind a name, on lines of its own further right, goes on with it.
        going_on = behind and re.match(r"^\s{12,}// ", line)
        lines.append(PLAIN.sub(r"\1///<" if going_on else r"\1///", line))
        behind = bool(going_on)
    return "\n".join(lines) + "\n"


def main() -> int:
    """Print one header."""
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("header", type=Path, help="a header below firmware/")
    path = parser.parse_args().header.resolve()
    try:
        text = path.read_text(encoding="utf-8")
        name = path.relative_to(gen_docs.HEADERS).as_posix()
    except (OSError, ValueError) as error:
        parser.error(f"{path}: {error}")
    sys.stdout.write(filtered(name, text) + FIRST_PAGE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
