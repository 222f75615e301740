#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fill the generated tables of tools/argus.lua from hil_sim/tables/arcos.toml and the layout of the CONFIGpac."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from hil_sim.arcos import ARGUMENT, COMMAND, FLAG, FRAME, SIP, TYPE, ConfigPac  # noqa: E402

LUA = ROOT / "tools/argus.lua"
_UNITS = (
    (r"_ms$", "ms"),
    (r"_dv$", "x 0.1 V"),
    (r"^ticks_mm$", "ticks/mm"),
    (r"^(rot_vel|joy_rvel)", "deg/s"),
    (r"^(trans_vel|joy_vel|lat_vel)", "mm/s"),
    (r"^rot_(acc|decel)", "deg/s^2"),
    (r"^(trans|lat)_(acc|decel)", "mm/s^2"),
)


def _unit(name: str) -> str:
    return next((unit for pattern, unit in _UNITS if re.search(pattern, name)), "")


def _names(numbers: Mapping[str, int]) -> str:
    lines = [
        f'    [{number}] = "{name}",'
        for name, number in sorted(numbers.items(), key=lambda item: item[1])
        if not name.endswith(("_FIRST", "_LAST"))
    ]
    return "{\n" + "\n".join(lines) + "\n}"


def _values(numbers: Mapping[str, int], wanted: Iterable[str]) -> str:
    return "{ " + ", ".join(f"{name} = {numbers[name]}" for name in wanted) + " }"


def tables() -> str:
    """Return the Lua text between the marks."""
    config = "\n".join(f'    {{ "{name}", "{kind}", "{_unit(name)}" }},' for name, kind in ConfigPac._SPEC)
    return "\n".join(
        (
            f"local COMMAND = {_names(COMMAND)}",
            f"local TYPE = {_names(TYPE)}",
            f"local FLAG = {_names(FLAG)}",
            f"local FRAME = {_values(FRAME, ('HEADER0', 'HEADER1', 'COUNT_MIN', 'OVERHEAD'))}",
            f"local ARGUMENT = {_values(ARGUMENT, ('POSITIVE', 'NEGATIVE', 'STRING'))}",
            f"local SIP = {_values(SIP, ('OLD_UNIT_UM', 'TURN', 'POSITION_BITS', 'STALL_BIT', 'BUMPER_MASK'))}",
            f"local CONFIG = {{ -- name, type, unit\n{config}\n}}",
        )
    )


def filled(text: str) -> str:
    """Return the dissector's text with its generated part renewed."""
    pattern = r"(-- tables: [^\n]*\n).*?(-- /tables\n)"
    return re.sub(pattern, lambda m: f"{m[1]}{tables()}\n{m[2]}", text, flags=re.DOTALL)


def main() -> int:
    """Write tools/argus.lua, or with --check compare it."""
    parser = argparse.ArgumentParser(description=__doc__, epilog="example: tools/gen_lua.py --check")
    parser.add_argument("--check", action="store_true", help="change nothing; exit 1 when it is out of date")
    arguments = parser.parse_args()
    old = LUA.read_text(encoding="utf-8")
    new = filled(old)
    if arguments.check:
        if new != old:
            print("tools/argus.lua is out of date: run tools/gen_lua.py", file=sys.stderr)
        return int(new != old)
    LUA.write_text(new, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
