# SPDX-License-Identifier: MIT
"""`argus-log decode`: every packet of a log as a table, JSON lines or CSV."""

from __future__ import annotations

import argparse
import csv
import io
import json
import sys
from collections.abc import Callable, Iterator
from typing import Any, Final

from argus_tools.log.common import (
    Input,
    Times,
    add_log_arguments,
    add_robot_arguments,
    add_time_arguments,
    sonar_numbers,
    use_colour,
)
from argus_tools.log.fields import Decoder
from argus_tools.log.packets import COMMAND_NAMES, JUNK, SESSION_NAMES, SYNC_NAMES, TYPE_NAMES, Row

EXAMPLES: Final = """\
  argus-log decode capture.bin                        a raw capture of one direction
  argus-log decode session.jsonl --type SIP --sonar 3 what sonar 3 said
  argus-log decode drive.pcap --dir c2r --from +10 --to +20
  argus-log decode --json live.rec --follow           as it grows; one JSON object per packet
"""
FLUSH_ROWS: Final = 256
FLUSH_CHARACTERS: Final = 4096
SONARS_IN_CSV: Final = 16
_COMMON: Final = ("t", "offset", "dir", "type", "ok")
_SIP_COLUMNS: Final = (
    "x_mm", "y_mm", "heading_deg", "vel_left_mm_s", "vel_right_mm_s", "battery_v", "stall_left", "stall_right",
    "bumpers_front", "bumpers_rear", "moving", "motors", "flags", "compass",
)  # fmt: skip
_TAIL_COLUMNS: Final = (
    "gripper", "anport", "analog", "digin", "digout", "battery_x10", "charge_state", "rotvel", "fault_flags",
    "lat_vel", "temperature", "charge_percent",
)  # fmt: skip
CSV_COLUMNS: Final = (
    *_COMMON,
    "arg",
    *_SIP_COLUMNS,
    *(f"sonar_{number}" for number in range(SONARS_IN_CSV)),
    *_TAIL_COLUMNS,
    "error",
    "other",
)
_HEADER: Final = f"{'t':>12}  {'offset':>8}  {'dir':3}  {'type':11}  content"
_RED, _PLAIN = "\033[31m", "\033[0m"


def _types(text: str) -> list[str]:
    known = {*COMMAND_NAMES, *TYPE_NAMES, *SESSION_NAMES, *SYNC_NAMES, JUNK}
    names = [name.strip().upper() for name in text.split(",")]
    for name in names:
        if name not in known:
            raise argparse.ArgumentTypeError(
                f"'{name}' is no packet type; for example SIP, CONFIGPAC, VEL, CMD_99"
            )
    return names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_log_arguments(parser, follow=True)
    output = parser.add_mutually_exclusive_group()
    output.add_argument("--json", action="store_true", help="one JSON object per packet")
    output.add_argument("--csv", action="store_true", help="comma-separated values with a header line")
    parser.add_argument("--type", type=_types, metavar="NAME,...", help="these packets only, as SIP,VEL")
    parser.add_argument("--sonar", type=sonar_numbers, metavar="N,...", help="SIPs with these sonars only")
    add_robot_arguments(parser)
    add_time_arguments(parser)


def run(args: argparse.Namespace) -> int:
    """Print the packets; return the exit code."""
    source = Input(args)
    decoder = Decoder(args.subclass)
    line_of: Callable[[Row], str]
    if args.sonar:
        line_of = _only_sonars(args, decoder)
    elif args.json:
        line_of = decoder.json
    else:
        line_of = _printer(args, decoder.fields)
    rows = source.selected()
    lines: Iterator[str]
    if args.type or args.sonar or args.start or args.end:
        rows = _filtered(args, rows, decoder)
        lines = (line_of(row) for row in rows)
    else:
        lines = decoder.json_lines(rows, source.is_live) if args.json else _lines(rows, decoder, line_of)
    header = _csv_line(CSV_COLUMNS) if args.csv else "" if args.json else _HEADER
    _write(header, lines, args.follow)
    return source.exit_code


def _lines(rows: Iterator[Row], decoder: Decoder, line_of: Callable[[Row], str]) -> Iterator[str]:
    track = decoder.track
    for row in rows:
        track(row)
        yield line_of(row)


def _write(header: str, lines: Iterator[str], at_once: bool) -> None:
    write = sys.stdout.write
    held: list[str] = []
    try:
        for line in lines:
            if header:
                held.append(header)
                header = ""
            held.append(line)
            if at_once or len(held) >= FLUSH_ROWS or len(line) >= FLUSH_CHARACTERS:
                held.append("")
                write("\n".join(held))
                held.clear()
                if at_once:
                    sys.stdout.flush()
    finally:
        if held:
            write("\n".join(held) + "\n")


def _filtered(args: argparse.Namespace, rows: Iterator[Row], decoder: Decoder) -> Iterator[Row]:
    times = Times(args.start, args.end)
    types = frozenset(args.type or ())
    for row in rows:
        decoder.track(row)
        is_inside = times(row.t, args.log)
        if types and row.type not in types:
            continue
        if args.sonar and not (row.type == "SIP" and row.ok):
            continue
        if is_inside and (not args.sonar or _has_sonar(row, args.sonar)):
            yield row


def _has_sonar(row: Row, wanted: list[int]) -> bool:
    data = row.data
    count = data[19] if len(data) > 19 else 0
    return any(number in wanted for number in data[20 : 20 + 3 * count : 3])


def _only_sonars(args: argparse.Namespace, decoder: Decoder) -> Callable[[Row], str]:
    wanted = frozenset(map(str, args.sonar))

    def fields(row: Row) -> dict[str, Any]:
        found = decoder.fields(row)
        if "sonar" in found:
            found["sonar"] = {number: mm for number, mm in found["sonar"].items() if number in wanted}
        return found

    return _printer(args, fields)


def _printer(args: argparse.Namespace, fields: Callable[[Row], dict[str, Any]]) -> Callable[[Row], str]:
    if args.json:
        return lambda row: json.dumps(fields(row))
    if args.csv:
        return lambda row: csv_row(fields(row))
    colour = use_colour()
    return lambda row: table_row(fields(row), colour)


def _csv_line(values: Any) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="").writerow(values)
    return text.getvalue()


def csv_row(fields: dict[str, Any]) -> str:
    """Return one packet as a line of CSV; what has no column of its own stands in the last, as JSON."""
    rest = dict(fields)
    sonar = rest.pop("sonar", {})
    values = []
    for column in CSV_COLUMNS[:-1]:
        if column.startswith("sonar_"):
            value = sonar.pop(column.removeprefix("sonar_"), None)
        elif column in _COMMON or "x_mm" in fields or column in ("arg", "error"):
            value = rest.pop(column, None)
        else:
            value = None
        values.append(int(value) if isinstance(value, bool) else value)
    if sonar:
        rest["sonar"] = sonar
    return _csv_line([*values, json.dumps(rest) if rest else ""])


def table_row(fields: dict[str, Any], colour: bool = False) -> str:
    """Return one packet as a line for people."""
    t = fields["t"]
    when = "-" if t is None else f"{t:.6f}"
    line = f"{when:>12}  {fields['offset']:>8}  {fields['dir']}  {fields['type']:11}  {_content(fields)}".rstrip()
    return line if fields["ok"] or not colour else _RED + line + _PLAIN


def _content(fields: dict[str, Any]) -> str:
    if not fields["ok"]:
        shown = " ".join(fields["hex"][at : at + 2] for at in range(0, min(len(fields["hex"]), 32), 2))
        more = " ..." if fields["bytes"] > 16 else ""
        return f"DAMAGED, {fields['bytes']} bytes: {fields['error']}: {shown}{more}"
    if "x_mm" in fields and "sonar" in fields:
        return _sip(fields)
    if "arg" in fields:
        if "high" in fields:
            return f"{fields['arg']} (high {fields['high']}, low {fields['low']})"
        if "hex" in fields:
            return f"{fields['arg']!r} [{fields['hex']}]"
        return "" if fields["arg"] is None else str(fields["arg"])
    return " ".join(f"{name}={value}" for name, value in fields.items() if name not in _COMMON)


def _sip(fields: dict[str, Any]) -> str:
    words = [
        f"x {fields['x_mm']:>6g} y {fields['y_mm']:>6g} th {fields['heading_deg']:>6.1f}",
        f"v {fields['vel_left_mm_s']:>4}/{fields['vel_right_mm_s']:<4}",
        f"{fields['battery_v']:.1f} V",
    ]
    names = {"motors": "motors", "moving": "moving", "stall_left": "STALL-L", "stall_right": "STALL-R"}
    words += [word for name, word in names.items() if fields[name]]
    words += [
        f"BUMPER-{side}:"
        + ",".join(str(bit) for bit in range(1, 8) if fields[f"bumpers_{side.lower()}"] >> bit & 1)
        for side in ("FRONT", "REAR")
        if fields[f"bumpers_{side.lower()}"]
    ]
    sonar = " ".join(f"{number}:{mm}" for number, mm in fields["sonar"].items())
    return "  ".join(words) + (f"  | {sonar}" if sonar else "")
