#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Write what follows from tools/argus.dbc: its value tables (from the C headers) and the C code that packs frames."""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path
from typing import Any

import cantools.database
from cantools.database import Message
from cantools.database.can.signal import Signal
from cantools.database.errors import Error
from gen_docs import rows

ROOT = Path(__file__).resolve().parent.parent
DBC = Path("tools/argus.dbc")
HEADER = Path("hal/include/hal/gen_argus_dbc.h")
SOURCE = Path("hal/linux/gen_argus_dbc.c")
HEADERS = ROOT / "firmware"
ROBOTS = 8
STEP_TELEMETRY, STEP_OTHER = 16, 1  # how far the ids of two robots lie apart

EPILOG = """examples:
  tools/gen_dbc.py              renew the value tables of tools/argus.dbc and the generated C files
  tools/gen_dbc.py --check      exit 1 if one of them differs from what it is made from
  tools/gen_dbc.py --robot 3    print the DBC file for robot 3

exit codes: 0 done or current, 1 out of date, 2 the DBC file or a header cannot be read"""

# Value tables that are enumerations of the firmware: header, type, what to cut off, how argusd writes them.
ENUMS = {
    "Mode": ("include/argus/argus.h", "argus_mode_t", "ARGUS_MODE_", str.upper),
    "Mission": ("include/argus/argus.h", "argus_mission_t", "ARGUS_MISSION_", str.lower),
    "Wait": ("include/argus/argus.h", "argus_wait_t", "ARGUS_WAIT_", str.lower),
    "Failure": (
        "include/argus/argus.h",
        "argus_failure_t",
        "ARGUS_IS_",
        lambda name: "Is" + name.capitalize(),
    ),
    "Health": ("include/argus/argus.h", "argus_health_t", "ARGUS_", str.upper),
    "Level": ("include/argus/argus.h", "argus_level_t", "ARGUS_LEVEL_", str.upper),
}


class DbcError(Exception):
    """Something that the files cannot be made from; the message is one line."""


def enum_values(header: str, name: str) -> dict[int, str]:
    """Return the constants of a C enumeration by their values."""
    text = (HEADERS / header).read_text(encoding="utf-8")
    found = re.search(r"typedef enum \{([^{}]*)\} " + name + ";", text)
    if found is None:
        raise DbcError(f"firmware/{header}: no enumeration {name}; tell tools/gen_dbc.py where it is")
    values: dict[int, str] = {}
    following = 0
    for line in re.sub(r"//[^\n]*", "", found[1]).split(","):
        constant, _, value = line.strip().partition("=")
        if constant.strip():
            following = int(value, 0) if value.strip() else following
            values[following] = constant.strip()
            following += 1
    return values


def header_tables() -> dict[str, dict[int, str]]:
    """Return the value tables that come from the C headers."""
    tables = {
        table: {
            value: form(constant.removeprefix(prefix))
            for value, constant in enum_values(header, name).items()
        }
        for table, (header, name, prefix, form) in ENUMS.items()
    }
    tables["Event"] = {int(row[0]): row[1] for row in rows("include/argus/argus.h", "ARGUS_EVENT_TABLE")}
    kinds = rows("include/argus/argus.h", "ARGUS_FAULT_KIND_TABLE")
    tables["Fault"] = {0: "none"} | {int(row[1]): row[2] for row in kinds}
    return tables


def choices(values: dict[int, str]) -> str:
    """Return a value table as it stands in a DBC file."""
    return " ".join(f'{value} "{values[value]}"' for value in sorted(values, reverse=True)) + " ;"


def own_tables(text: str) -> dict[str, dict[int, str]]:
    """Return the value tables that stand in the DBC file itself."""
    return {
        name: {int(value): word for value, word in re.findall(r'(-?\d+) "([^"]*)"', body)}
        for name, body in re.findall(r"^VAL_TABLE_ (\w+) (.*) ;$", text, re.MULTILINE)
    }


def renewed(text: str) -> str:
    """Return the DBC file with its value tables renewed and given to the signals."""
    tables = own_tables(text) | header_tables()
    lines = [line for line in text.splitlines() if not line.startswith(("VAL_TABLE_ ", "VAL_ "))]
    nodes = next(number for number, line in enumerate(lines) if line.startswith("BU_:"))
    given = []
    frame = ""
    for line in lines:
        if line.startswith("BO_ "):
            frame = line.split()[1]
        elif line.startswith(" SG_ "):
            signal = line.split()[1]
            table = re.sub(r"^S\d\d_", "", signal)
            if table in tables:
                given.append(f"VAL_ {frame} {signal} {choices(tables[table])}")
    heads = [f"VAL_TABLE_ {name} {choices(tables[name])}" for name in sorted(tables)]
    return "\n".join([*lines[: nodes + 1], *heads, *lines[nodes + 1 :], *given]) + "\n"


def for_robot(text: str, robot: int) -> str:
    """Return the DBC file with the ids and names of robot ROBOT."""

    def other(found: re.Match[str]) -> str:
        frame = int(found[2])
        return f"{found[1]}{frame + robot * (STEP_TELEMETRY if frame >= 0x500 else STEP_OTHER)} "

    text = re.sub(r"^((?:BO_|CM_ BO_|CM_ SG_|VAL_|BA_ \"\w+\" BO_) )(\d+) ", other, text, flags=re.MULTILINE)
    text = text.replace("Ids are those of robot 0. Robot k", f"Ids are those of robot {robot}. Robot k")
    return re.sub(r"^(BO_ \d+ )Argus", rf"\g<1>Argus{robot}", text, flags=re.MULTILINE) if robot else text


# C ------------------------------------------------------------------------------------------------------------


def snake(name: str) -> str:
    """Return CamelCase as lower_case."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()


def c_type(signal: Signal) -> str:
    """Return the smallest C type that holds the signal's values."""
    bits = next(size for size in (8, 16, 32) if size >= signal.length)
    return f"{'' if signal.is_signed else 'u'}int{bits}_t"


def field(signal: Signal) -> tuple[str, int | None]:
    """Return the member of a signal: its name, and its index when several signals are one array."""
    sonar = re.fullmatch(r"S(\d\d)_(\w+)", signal.name)
    if sonar is not None:
        return snake(sonar[2]), int(sonar[1])
    counted = re.fullmatch(r"([A-Za-z]+)(\d)", signal.name)
    if counted is not None:
        return snake(counted[1]), int(counted[2])
    return snake(signal.name), None


def members(message: Message) -> list[tuple[Signal, str, int | None]]:
    """Return signals, member names and indices from 0."""
    found = [(signal, *field(signal)) for signal in message.signals]
    first: dict[str, int] = {}
    for _, name, index in found:
        if index is not None:
            first[name] = min(index, first.get(name, index))
    return [(signal, name, None if index is None else index - first[name]) for signal, name, index in found]


def base_name(message: Message) -> str:
    """Return the message's name without what all have in common."""
    return snake(message.name.removeprefix("Argus"))


def struct_name(message: Message) -> str:
    """Return the type of a message; messages of one layout share it."""
    return "hal_dbc_" + re.sub(r"(_front|_rear|\d\d)$", "", base_name(message)) + "_t"


def layout(message: Message) -> list[tuple[str, int | None, int, int, bool]]:
    """Return what two messages must have in common to share their code."""
    return [(name, index, s.start, s.length, s.is_signed) for s, name, index in members(message)]


def struct_lines(message: Message) -> list[str]:
    """Return the struct of a message."""
    counts: dict[str, int] = {}
    kinds: dict[str, str] = {}
    units: dict[str, str] = {}
    for signal, name, index in members(message):
        counts[name] = max(counts.get(name, 0), 0 if index is None else index + 1)
        kinds[name] = c_type(signal)
        units[name] = f" // {signal.unit}" if signal.unit else ""
    lines = ["", "typedef struct {"]
    for name, count in counts.items():
        lines.append(f"    {kinds[name]} {name}{f'[{count}]' if count else ''};{units[name]}")
    return [*lines, f"}} {struct_name(message)};"]


def prototypes(message: Message) -> tuple[str, str]:
    """Return the declarations of a layout's pack and unpack function."""
    kind = struct_name(message)
    stem = kind.removesuffix("_t")
    return (
        f"void {stem}_pack(uint8_t data[HAL_DBC_LENGTH], const {kind} *from)",
        f"void {stem}_unpack({kind} *to, const uint8_t data[HAL_DBC_LENGTH])",
    )


def is_sent(message: Message) -> bool:
    """Tell whether argusd sends the message."""
    return message.senders == ["ARGUS"]


def member(name: str, index: int | None) -> str:
    """Return a member as C writes it."""
    return name if index is None else f"{name}[{index}]"


def pack_lines(message: Message) -> list[str]:
    """Return the function that packs a message."""
    lines = ["", prototypes(message)[0] + " {", "    uint64_t bits = 0;"]
    for signal, name, index in members(message):
        value = f"from->{member(name, index)}"
        if signal.is_signed:
            lines.append(f"    bits |= (uint64_t)(u{c_type(signal)}){value} << {signal.start};")
            continue
        # A type that can hold more than the signal: what is beyond its range reads as its greatest value.
        holds = (1 << int(re.sub(r"\D", "", c_type(signal)))) - 1
        high = min(int(signal.maximum or 0), (1 << signal.length) - 1)
        limited = f"at_most({value}, {high}u)" if holds > high else f"(uint64_t){value}"
        lines.append(f"    bits |= {limited} << {signal.start};")
    return [*lines, "    store(data, bits);", "}"]


def unpack_lines(message: Message) -> list[str]:
    """Return the function that unpacks a message."""
    lines = ["", prototypes(message)[1] + " {", "    const uint64_t bits = load(data);"]
    for signal, name, index in members(message):
        assert not signal.is_signed
        mask = (1 << signal.length) - 1
        lines.append(
            f"    to->{member(name, index)} = ({c_type(signal)})((bits >> {signal.start}) & 0x{mask:X}u);"
        )
    return [*lines, "}"]


def layouts(database: Any) -> list[Message]:
    """Return one message of each layout."""
    found: dict[str, Message] = {}
    for message in database.messages:
        known = found.setdefault(struct_name(message), message)
        if layout(known) != layout(message):
            raise DbcError(f"{DBC}: {known.name} and {message.name} share a C type, but not their layout")
    return list(found.values())


def check(database: Any) -> None:
    """Refuse what the generated code cannot do."""
    for message in database.messages:
        if message.length != 8 or message.is_extended_frame or message.is_multiplexed():
            raise DbcError(
                f"{DBC}: {message.name}: only plain 8-byte messages with 11-bit ids can be generated"
            )
        for signal in message.signals:
            if signal.byte_order != "little_endian" or signal.scale != 1 or signal.offset != 0:
                raise DbcError(
                    f"{DBC}: {message.name}.{signal.name}: must be little-endian and unscaled (1,0)"
                )
            if signal.is_signed and signal.length not in (8, 16, 32):
                raise DbcError(
                    f"{DBC}: {message.name}.{signal.name}: a signed signal must have 8, 16 or 32 bits"
                )


HEAD = """// SPDX-License-Identifier: MIT
// {what} Generated by tools/gen_dbc.py from tools/argus.dbc: do not edit.
"""


def c_header(text: str, database: Any) -> str:
    """Return the generated header."""
    lines = [HEAD.format(what="The CAN frames of Argus as C structs.").rstrip("\n")]
    lines += ["#ifndef HAL_GEN_ARGUS_DBC_H", "#define HAL_GEN_ARGUS_DBC_H", "", "#include <stdint.h>", ""]
    lines += ["#define HAL_DBC_LENGTH 8 // of every frame", f"#define HAL_DBC_ROBOTS {ROBOTS}", ""]
    lines.append("// Ids of robot 0, and how far those of the next robot lie from them.")
    for message in database.messages:
        lines.append(f"#define HAL_DBC_{base_name(message).upper()}_ID 0x{message.frame_id:03X}u")
    lines += [
        f"#define HAL_DBC_STEP_TELEMETRY {STEP_TELEMETRY}u",
        f"#define HAL_DBC_STEP_OTHER {STEP_OTHER}u",
    ]
    own = {name: table for name, table in own_tables(text).items() if name not in header_tables()}
    for name in sorted(own):
        lines.append("")
        for value, word in sorted(own[name].items()):
            constant = re.sub(r"\W", "_", f"HAL_DBC_{snake(name)}_{word}").upper()
            lines.append(f"#define {constant} {value}u")
    for message in layouts(database):
        lines += struct_lines(message)
    lines += ["", "// Values beyond a signal's range are packed as its greatest value."]
    lines += [prototypes(m)[0 if is_sent(m) else 1] + ";" for m in layouts(database)]
    return "\n".join([*lines, "", "#endif"]) + "\n"


def c_source(database: Any) -> str:
    """Return the generated source."""
    lines = [HEAD.format(what="Packs the CAN frames of Argus.").rstrip("\n")]
    lines.append("""#include "hal/gen_argus_dbc.h"

static uint64_t at_most(uint32_t value, uint32_t limit) {
    return value < limit ? value : limit;
}

static void store(uint8_t data[HAL_DBC_LENGTH], uint64_t bits) {
    for (unsigned i = 0; i < HAL_DBC_LENGTH; i++) {
        data[i] = (uint8_t)(bits >> (8u * i));
    }
}

static uint64_t load(const uint8_t data[HAL_DBC_LENGTH]) {
    uint64_t bits = 0;
    for (unsigned i = 0; i < HAL_DBC_LENGTH; i++) {
        bits |= (uint64_t)data[i] << (8u * i);
    }
    return bits;
}""")
    for message in layouts(database):
        lines += pack_lines(message) if is_sent(message) else unpack_lines(message)
    return "\n".join(lines) + "\n"


def made(root: Path) -> dict[Path, str]:
    """Return path and text of every file that is to be made."""
    try:
        text = renewed((root / DBC).read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise DbcError(f"{DBC}: no such file; restore it from version control") from None
    try:
        database = cantools.database.load_string(text, database_format="dbc")
    except (Error, ValueError) as error:
        raise DbcError(f"{DBC}: {' '.join(str(error).split())}") from None
    check(database)
    return {DBC: text, HEADER: c_header(text, database), SOURCE: c_source(database)}


def is_current(path: Path, text: str) -> bool:
    """Tell whether the file at PATH holds TEXT."""
    return path.exists() and path.read_text(encoding="utf-8") == text


def main() -> int:
    """Write the files, compare them, or print one."""
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--check", action="store_true", help="change nothing; exit 1 when a file is out of date"
    )
    parser.add_argument("--robot", type=int, choices=range(ROBOTS), help="print the DBC file for this robot")
    parser.add_argument("--root", type=Path, default=ROOT, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    try:
        files = made(arguments.root)
    except DbcError as error:
        print(f"gen_dbc: {error}", file=sys.stderr)
        return 2
    if arguments.robot is not None:
        sys.stdout.write(for_robot(files[DBC], arguments.robot))
        return 0
    stale = [path for path, text in files.items() if not is_current(arguments.root / path, text)]
    if arguments.check:
        for path in stale:
            print(f"{path} is out of date: run tools/gen_dbc.py", file=sys.stderr)
        return int(bool(stale))
    for path in stale:
        (arguments.root / path).write_text(files[path], encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
