# SPDX-License-Identifier: MIT
"""`argus-log diff`: where two logs differ, packet by packet, in each direction."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from typing import Any, Final, NamedTuple

from argus_tools.formats import Direction, LogError
from argus_tools.log.common import DIRECTIONS, Input, add_log_arguments, use_colour
from argus_tools.log.decode import table_row
from argus_tools.log.exits import EXIT_DAMAGE, EXIT_READ
from argus_tools.log.fields import Decoder
from argus_tools.log.packets import Row

EXAMPLES: Final = """\
  argus-log diff before.rec after.pcap                contents, whatever the two formats are
  argus-log diff a.jsonl b.jsonl --dir c2r --tolerance 0.05
"""
# How far apart the two logs may be before they are taken as having nothing in common there.
WINDOW: Final = 256
_IGNORED: Final = ("t", "offset", "dir", "type", "ok")


class Difference(NamedTuple):
    """A packet that only one log has, or one that has other contents in the other."""

    ours: Row | None
    theirs: Row | None


class _Side:
    """The packets of one direction of one log, with as many read ahead as the comparison needs."""

    def __init__(self, rows: Iterator[Row]) -> None:
        self._rows = rows
        self.ahead: list[Row] = []

    def fill(self, count: int) -> list[Row]:
        while len(self.ahead) < count and (row := next(self._rows, None)):
            self.ahead.append(row)
        return self.ahead


def _is_same(ours: Row, theirs: Row, tolerance: float | None) -> bool:
    if ours.ok != theirs.ok or ours.type != theirs.type or ours.data != theirs.data:
        return False
    return tolerance is None or ours.t is None or theirs.t is None or abs(ours.t - theirs.t) <= tolerance


def _meeting(ours: list[Row], theirs: list[Row]) -> tuple[int, int]:
    """Return how much to skip on both sides until the packets match again."""
    positions: dict[tuple[str, bytes], list[int]] = {}
    for at, row in enumerate(theirs):
        positions.setdefault((row.type, row.data), []).append(at)
    best = (len(ours), len(theirs))
    for at, row in enumerate(ours):
        if at >= sum(best):
            break
        found = positions.get((row.type, row.data))
        if found and at + found[0] < sum(best):
            best = (at, found[0])
    return best


def differences(
    ours: Iterator[Row], theirs: Iterator[Row], tolerance: float | None = None
) -> Iterator[Difference]:
    """Yield the differences of two sequences of packets, in their order."""
    left, right = _Side(ours), _Side(theirs)
    while True:
        a, b = left.fill(1), right.fill(1)
        if not a or not b:
            break
        if _is_same(a[0], b[0], tolerance):
            del a[0], b[0]
            continue
        skip_a, skip_b = _meeting(left.fill(WINDOW), right.fill(WINDOW))
        if skip_a == skip_b == 0:
            skip_a = skip_b = 1
        common = min(skip_a, skip_b)
        for at in range(common):
            yield Difference(a[at], b[at])
        for row in a[common:skip_a]:
            yield Difference(row, None)
        for row in b[common:skip_b]:
            yield Difference(None, row)
        del a[:skip_a], b[:skip_b]
    while a := left.fill(1):
        yield Difference(a.pop(0), None)
    while b := right.fill(1):
        yield Difference(None, b.pop(0))


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_log_arguments(parser)
    parser.add_argument("other", metavar="OTHER", help="the log to compare with")
    parser.add_argument("--tolerance", type=float, metavar="S", help="compare times, too, to so many seconds")
    parser.add_argument(
        "--limit", type=int, default=0, metavar="N", help="stop after N differences (default: all)"
    )
    parser.epilog = (parser.epilog or "").replace(
        "0 read, 1 damage found (with --strict)", "0 equal, 1 they differ"
    )


def run(args: argparse.Namespace) -> int:
    """Print the differences; return 1 if there are any."""
    if args.log == args.other == "-":
        raise LogError("only one of the two logs can be standard input")
    if args.log == "-" or args.other == "-":
        raise LogError("diff reads each log once per direction: save standard input to a file first")
    colour = use_colour()
    total = compared = 0
    for direction in [args.dir] if args.dir else DIRECTIONS:
        ours, theirs = (_rows(args, path, direction) for path in (args.log, args.other))
        counted = _Counter(ours)
        for difference in differences(counted.rows(), theirs, args.tolerance):
            for line in _lines(difference, colour):
                print(line)
            total += 1
            if args.limit and total >= args.limit:
                print(f"stopped after {total} differences")
                return EXIT_DAMAGE
        compared += counted.count
    print(f"{total} differences in {compared} packets" if total else f"equal: {compared} packets")
    return EXIT_DAMAGE if total else EXIT_READ


class _Counter:
    def __init__(self, rows: Iterator[Row]) -> None:
        self._rows = rows
        self.count = 0

    def rows(self) -> Iterator[Row]:
        for row in self._rows:
            self.count += 1
            yield row


def _rows(args: argparse.Namespace, path: str, direction: Direction) -> Iterator[Row]:
    wanted = argparse.Namespace(**{**vars(args), "dir": None})
    return (row for row in Input(wanted, path).rows() if row.dir == direction)


def _fields(row: Row) -> dict[str, Any]:
    decoder = Decoder()
    decoder.track(row)
    return decoder.fields(row)


def _lines(difference: Difference, colour: bool) -> Iterator[str]:
    red, green, plain = ("\033[31m", "\033[32m", "\033[0m") if colour else ("", "", "")
    ours, theirs = difference
    if ours is None or theirs is None or ours.type != theirs.type or not (ours.ok and theirs.ok):
        if ours:
            yield f"{red}- {table_row(_fields(ours))}{plain}"
        if theirs:
            yield f"{green}+ {table_row(_fields(theirs))}{plain}"
        return
    old, new = _fields(ours), _fields(theirs)
    changed = [name for name in {**old, **new} if name not in _IGNORED and old.get(name) != new.get(name)]
    if ours.t != theirs.t and ours.data == theirs.data:
        changed.append("t")
    words = []
    for name in changed:
        if name == "sonar":
            numbers = sorted({*old["sonar"], *new["sonar"]}, key=int)
            words += [
                f"sonar {n}: {old['sonar'].get(n, '-')} -> {new['sonar'].get(n, '-')}"
                for n in numbers
                if old["sonar"].get(n) != new["sonar"].get(n)
            ]
        else:
            words.append(f"{name}: {old.get(name, '-')} -> {new.get(name, '-')}")
    when = "-" if ours.t is None else f"{ours.t:.6f}"
    place = f"offset {ours.offset} / {theirs.offset}"
    yield f"~ {when:>12}  {ours.dir}  {ours.type}  {place}: {'; '.join(words) or 'order of the bytes'}"
