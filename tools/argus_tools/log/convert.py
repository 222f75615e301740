# SPDX-License-Identifier: MIT
"""`argus-log convert`: writes a log in another format."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from typing import Any, Final

from argus_tools.formats import Chunk, Format, LogError, ReadOptions, format_of_name, formats
from argus_tools.log.common import (
    Input,
    Times,
    add_log_arguments,
    add_robot_arguments,
    add_time_arguments,
    binary_output,
)
from argus_tools.log.decode import CSV_COLUMNS, csv_row
from argus_tools.log.fields import Decoder
from argus_tools.log.packets import Row
from hil_sim.arcos import TIMING

EXAMPLES: Final = """\
  argus-log convert drive.rec drive.mcap              to open in Foxglove
  argus-log convert drive.pcap drive.jsonl
  argus-log convert drive.jsonl robot.bin --dir r2c   the bytes of one direction
  argus-log convert drive.rec - --to-format csv | less
"""
TABLES: Final = ("csv", "mcap")
SIP_S: Final = TIMING["SIP_CYCLE_MS"] / 1000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_log_arguments(parser)
    writable = [name for name, format_ in formats().items() if format_.writer]
    parser.add_argument(
        "output", metavar="OUTPUT", help="the file to write; its ending says the format; - is stdout"
    )
    parser.add_argument("--to-format", choices=[*writable, *TABLES], help="the format to write")
    add_robot_arguments(parser)
    add_time_arguments(parser)


def run(args: argparse.Namespace) -> int:
    """Write the other format; return the exit code."""
    target = _target(args)
    source = Input(args)
    if args.output != "-" and args.log != "-" and _is_same_file(args.log, args.output):
        raise LogError(f"{args.output}: is the log itself; give another name")
    rows = clocked(source)
    times = Times(args.start, args.end)
    decoder = Decoder(args.subclass)
    kept = _kept(rows, times, decoder, args.log)
    first = next(kept, None)
    if first is None:
        raise LogError(f"{args.log}: no packet is between --from and --to")
    with binary_output(args.output) as stream:
        if target == "csv":
            count = _write_csv(stream, first, kept, decoder)
        elif target == "mcap":
            from argus_tools.log.mcap_out import write_mcap

            count = write_mcap(stream, first, kept, decoder)
        else:
            options = ReadOptions(direction=args.dir, port=args.port, robot=args.robot)
            count = _write_log(stream, formats()[target], options, first, kept)
    if args.output != "-":
        print(f"{args.output}: {count} packets ({target})", file=sys.stderr)
    return source.exit_code


def _target(args: argparse.Namespace) -> str:
    if args.to_format:
        return str(args.to_format)
    name = args.output.removesuffix(".gz").lower()
    for table in TABLES:
        if name.endswith("." + table):
            return table
    found = format_of_name(args.output)
    if found is None:
        raise LogError(f"{args.output}: no known ending; add --to-format, for example --to-format jsonl")
    return found.name


def _is_same_file(one: str, other: str) -> bool:
    from pathlib import Path

    return Path(other).exists() and Path(one).exists() and Path(one).samefile(other)


def clocked(source: Input, quiet: bool = False) -> Iterator[Row]:
    """Yield the rows; those of a log without times get one SIP cycle for each SIP, which is said unless `quiet`."""
    told = quiet
    sips = 0
    for row in source.selected():
        if row.t is not None:
            yield row
            continue
        if not told:
            told = True
            print(
                f"argus-log: {source.path}: keeps no times: one SIP each {SIP_S * 1000:.0f} ms is assumed",
                file=sys.stderr,
            )
        yield row._replace(t=round(sips * SIP_S, 3))
        sips += row.type == "SIP" and row.ok


def _kept(rows: Iterator[Row], times: Times, decoder: Decoder, path: str) -> Iterator[Row]:
    for row in rows:
        decoder.track(row)
        if times(row.t, path):
            yield row


def _write_csv(stream: Any, first: Row, rows: Iterator[Row], decoder: Decoder) -> int:
    stream.write((",".join(CSV_COLUMNS) + "\n").encode())
    stream.write((csv_row(decoder.fields(first)) + "\n").encode())
    count = 1
    for row in rows:
        stream.write((csv_row(decoder.fields(row)) + "\n").encode())
        count += 1
    return count


def _write_log(stream: Any, target: Format, options: ReadOptions, first: Row, rows: Iterator[Row]) -> int:
    assert target.writer is not None
    writer = target.writer(stream, options)
    writer.write(Chunk(first.t, first.dir, first.wire, first.offset))
    count = 1
    for row in rows:
        writer.write(Chunk(row.t, row.dir, row.wire, row.offset))
        count += 1
    writer.close()
    return count
