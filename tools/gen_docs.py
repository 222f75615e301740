#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fill the generated tables of SPEC.md from the C headers that define them."""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
HEADERS = ROOT / "firmware" / "include" / "argus"


def rows(header: str, macro: str) -> list[list[str]]:
    """Arguments of every X(...) of an X-macro table, strings without their quotes."""
    text = (HEADERS / header).read_text(encoding="utf-8")
    start = text.index(f"#define {macro}(X)")
    body = re.match(r"(?:[^\n]*\\\n)*[^\n]*\n", text[start:])
    assert body is not None
    joined = body[0].replace("\\\n", " ")
    found = re.findall(r"X\(((?:[^()\"]|\"[^\"]*\")*)\)", joined.split("(X)", 1)[1])
    return [[part.strip().strip('"') for part in re.findall(r'"[^"]*"|[^,]+', row)] for row in found]


def _cell(parts: list[str]) -> str:
    return ", ".join(parts).replace("|", "\\|")


def events() -> str:
    """Return the event catalogue as a Markdown table."""
    lines = ["| id | event | level | about | meaning |", "|---|---|---|---|---|"]
    for number, name, level, subject, *meaning in rows("events.h", "ARGUS_EVENT_TABLE"):
        lines.append(f"| {number} | {name} | {level} | {subject} | {_cell(meaning)} |")
    return "\n".join(lines)


def config() -> str:
    """Return the settings as a Markdown table."""
    lines = ["| key | default | range | unit | meaning |", "|---|---|---|---|---|"]
    for key, default, low, high, unit, choices, *meaning in rows("config.h", "ARGUS_CONFIG_TABLE"):
        named = choices.split("|") if choices else []
        shown = named[int(default)] if named else default
        span = ", ".join(named) if named else f"{low} .. {high}"
        lines.append(f"| {key} | {shown} | {span} | {unit} | {_cell(meaning)} |")
    return "\n".join(lines)


def filled(text: str) -> str:
    """Return SPEC.md's text with its generated parts renewed."""
    for mark, table in (("events", events()), ("config", config())):
        pattern = rf"(<!-- {mark}: [^\n]*-->\n).*?(<!-- /{mark} -->)"
        text = re.sub(pattern, lambda m, t=table: f"{m[1]}{t}\n{m[2]}", text, flags=re.DOTALL)  # type: ignore[misc]
    return text


def main() -> int:
    """Write SPEC.md, or with --check compare it."""
    parser = argparse.ArgumentParser(description=__doc__, epilog="example: tools/gen_docs.py --check")
    parser.add_argument(
        "--check", action="store_true", help="change nothing; exit 1 when SPEC.md is out of date"
    )
    arguments = parser.parse_args()
    path = ROOT / "SPEC.md"
    old = path.read_text(encoding="utf-8")
    new = filled(old)
    if arguments.check:
        if new != old:
            print("SPEC.md is out of date: run tools/gen_docs.py", file=sys.stderr)
        return int(new != old)
    path.write_text(new, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
