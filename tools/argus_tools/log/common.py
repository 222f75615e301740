# SPDX-License-Identifier: MIT
"""What the subcommands of `argus-log` share: opening a log, its packets, complaints, progress and the exit code."""

from __future__ import annotations

import argparse
import math
import os
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, NoReturn

from argus_tools.chunks import CLIENT_TO_ROBOT, EXPECTED, ROBOT_TO_CLIENT
from argus_tools.formats import Chunk, Log, LogError, ReadOptions, formats
from argus_tools.log.exits import EXIT_DAMAGE, EXIT_READ
from argus_tools.log.packets import Row, packets
from hil_sim.arguments import whole
from hil_sim.errors import SimError
from hil_sim.tables.ring import ring_file
from hil_sim.tables.robot import robot_table

DIRECTIONS: Final = (ROBOT_TO_CLIENT, CLIENT_TO_ROBOT)
# A file in which so much comes before the first packet is no log.
HOPELESS_BYTES: Final = 16 << 20
HOPELESS_ROWS: Final = 20_000
# So many places that cannot be read are told, of the others how many they are.
TOLD_MOST: Final = 10
BULK_BYTES: Final = 1 << 18
PROGRESS_BYTES: Final = 8 << 20


def seconds(text: str) -> tuple[bool, float]:
    """Parse a time: seconds as the log counts them, or +SECONDS after its beginning.

    >>> seconds("+2.5")
    (True, 2.5)
    """
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(
            f"'{text}' is no time: seconds, or +SECONDS after the log's beginning"
        )
    return text.startswith("+"), value


def sonar_numbers(text: str) -> list[int]:
    """Parse sonar numbers: "3", "0,7", "0-7".

    >>> sonar_numbers("0-2,7")
    [0, 1, 2, 7]
    """
    found: list[int] = []
    try:
        for part in text.split(","):
            first, _, last = part.partition("-")
            found += range(int(first), int(last or first) + 1)
    except ValueError:
        found = []
    if not found or min(found) < 0 or max(found) > 255:
        raise argparse.ArgumentTypeError(f"'{text}' is no list of sonars; for example 3 or 0,7 or 0-7")
    return found


def columns_of(text: str) -> list[tuple[str, str]]:
    """Parse --columns: names that are understood, each with the column that has another.

    >>> columns_of("t_ms=Zeit,sonar_0_cm=US vorn")
    [('t_ms', 'Zeit'), ('sonar_0_cm', 'US vorn')]
    """
    from argus_tools.rings.columns import is_understood

    pairs = [tuple(word.strip() for word in pair.partition("=")[::2]) for pair in text.split(",")]
    for meaning, name in pairs:
        if not name or not is_understood(meaning):
            raise argparse.ArgumentTypeError(
                f"'{meaning}={name}': give NAME=COLUMN, where NAME is t_s, x_m, y_m, heading_deg, speed_m_s, "
                "turn_deg_s, vel_left_m_s, vel_right_m_s or sonar_0_mm, with any unit at its end"
            )
    return [(meaning, name) for meaning, name in pairs]


def add_log_arguments(parser: argparse.ArgumentParser, follow: bool = False) -> None:
    """Add the arguments that say which log is read, and how."""
    parser.add_argument("log", metavar="LOG", help="the file, gzip or not; - is standard input")
    names = list(formats())
    parser.add_argument(
        "--format",
        choices=names,
        metavar="NAME",
        help=f"its format (default: seen from the contents): {', '.join(names)}",
    )
    parser.add_argument("--dir", choices=DIRECTIONS, help="read this direction only; of a .bin: what it is")
    parser.add_argument(
        "--port", type=whole(1, 65535, "number"), help="the robot's TCP port in a capture (default: found)"
    )
    parser.add_argument(
        "--robot", type=whole(0, 7, "number"), help="the robot's number on a CAN bus (default: the first)"
    )
    parser.add_argument(
        "--topic", metavar="NAME", help="of a bag: the ranges to read, or what their topics begin with"
    )
    parser.add_argument(
        "--columns",
        type=columns_of,
        action="extend",
        default=[],
        metavar="NAME=COLUMN,...",
        help="of a table or JSON: which columns stand for t_s, x_m, y_m, heading_deg, sonar_0_mm and so on",
    )
    parser.add_argument("--strict", action="store_true", help="exit with 1 if anything in the log is damaged")
    if follow:
        parser.add_argument("--follow", action="store_true", help="wait for more at the end, until Ctrl-C")


def add_robot_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that say whose log it is."""
    robot = parser.add_mutually_exclusive_group()
    robot.add_argument(
        "--subclass", metavar="NAME", help="robot's subclass (default: as it says, or p3dx-sh)"
    )
    robot.add_argument(
        "--ring", dest="subclass", type=_own_ring, metavar="FILE.toml", help="a ring and body of your own"
    )


def _own_ring(text: str) -> str:
    try:
        return robot_table(ring_file(text)).subclass
    except (SimError, LogError) as error:
        raise argparse.ArgumentTypeError(str(error)) from None


class Input:
    """An opened log as the arguments ask for it; iterate `rows` once, then ask for `exit_code`.

    quiet: what was found out of it was reported before, when it was read for another purpose.
    """

    def __init__(self, args: argparse.Namespace, path: str | None = None, quiet: bool = False) -> None:
        self.path = path or args.log
        self.damaged = 0
        self._strict = bool(getattr(args, "strict", False))
        self._told = 0
        self._dir = getattr(args, "dir", None)
        options = ReadOptions(
            direction=self._dir,
            port=args.port,
            robot=args.robot,
            topic=args.topic,
            subclass=getattr(args, "subclass", None),
            columns=tuple(getattr(args, "columns", ())),
            tell=(lambda _: None) if quiet else self._remark,
        )
        self._progress = _Progress(self.path)
        follow = getattr(args, "follow", False)
        self.log = Log(
            self.path,
            args.format,
            options,
            follow=follow,
            on_progress=self._progress.update,
        )
        self._progress.total = self.log.source.total
        # Whether what was read is wanted before more comes; nor is a short file worth the loading of numpy.
        self.is_live = follow or self.log.source.total < BULK_BYTES

    def chunks(self) -> Iterator[Chunk]:
        """Yield the log's chunks, and tell on standard error what cannot be read."""
        damage, in_source = self.log.damage_lists
        try:
            for chunk in self.log:
                if self._told < TOLD_MOST and len(damage) + len(in_source) != self._told:
                    self._tell()
                yield chunk
            self._tell()
            more = damage.total + in_source.total - self._told
            if more:
                print(f"argus-log: {self.path}: and {more} places more", file=sys.stderr)
        finally:
            self._progress.close()

    def rows(self) -> Iterator[Row]:
        """Yield the packets and the damage; a log without any packet raises LogError."""
        waiting: list[Row] = []
        size = 0
        rows = packets(self.chunks(), self.is_live)
        for row in rows:
            if row.ok:
                break
            waiting.append(row)
            size += len(row.data)
            if size > HOPELESS_BYTES or len(waiting) > HOPELESS_ROWS:
                raise LogError(
                    f"{self.path}: no ARCOS packet in the first {size} bytes: not a log of a robot's link"
                )
        else:
            self._complain_empty(size)
        for early in waiting:
            self.damaged += 1
            yield early
        yield row
        for row in rows:
            if not row[4]:
                self.damaged += 1
            yield row

    def selected(self) -> Iterator[Row]:
        """Yield the rows of the direction asked for."""
        if self._dir is None or self.log.format.name == "bin":
            return self.rows()
        return (row for row in self.rows() if row.dir == self._dir)

    @property
    def exit_code(self) -> int:
        """0, or 1 if damage was met and --strict is given."""
        return EXIT_DAMAGE if self._strict and (self.damaged or self.log.damage) else EXIT_READ

    def _complain_empty(self, size: int) -> NoReturn:
        form = self.log.format
        if form.name == "bin":
            raise LogError(
                f"{self.path}: no ARCOS packet in {size} bytes, and not of a form that is known; expected {EXPECTED}"
            )
        if size:
            raise LogError(
                f"{self.path}: no ARCOS packet in the {size} bytes that it holds as {form.help}; "
                "--format chooses another form"
            )
        port = "; is --port needed?" if form.name in ("pcap", "pcapng") else ""
        raise LogError(f"{self.path}: holds no bytes of a robot's link (read as {form.help}){port}")

    def _remark(self, what: str) -> None:
        print(f"argus-log: {self.path}: {what}", file=sys.stderr)

    def _tell(self) -> None:
        damage = self.log.damage[:TOLD_MOST]
        for place, what in damage[self._told :]:
            print(f"argus-log: {self.path}: {place}: {what}", file=sys.stderr)
        self._told = len(damage)


class _Progress:
    """A bar on standard error for a long file, when it is a terminal and the output is not."""

    def __init__(self, path: str) -> None:
        self.total = 0
        self._path = path
        self._bar: Any = None
        is_capable = sys.stderr.isatty() and os.environ.get("TERM") != "dumb"
        self._wanted = is_capable and not sys.stdout.isatty() and path != "-"

    def update(self, consumed: int) -> None:
        """Show how much of the file was read."""
        if not self._wanted or self.total < PROGRESS_BYTES:
            return
        if self._bar is None:
            from rich.console import Console
            from rich.progress import BarColumn, DownloadColumn, Progress, TextColumn, TimeRemainingColumn

            columns = (TextColumn("{task.description}"), BarColumn(), DownloadColumn(), TimeRemainingColumn())
            self._bar = Progress(*columns, console=Console(stderr=True), transient=True)
            self._bar.add_task(os.path.basename(self._path), total=self.total)  # noqa: PTH119
            self._bar.start()
        self._bar.update(self._bar.task_ids[0], completed=consumed)

    def close(self) -> None:
        """Take the bar away."""
        if self._bar is not None:
            self._bar.stop()
            self._bar = None
        self._wanted = False


class Times:
    """Time filter of rows; times with a plus count from the first packet that has one."""

    def __init__(self, start: tuple[bool, float] | None, end: tuple[bool, float] | None) -> None:
        self._bounds = (start, end)
        self._first: float | None = None
        self.is_open = start is None and end is None

    def __call__(self, t: float | None, path: str = "the log") -> bool:
        """Whether a packet of this time is inside."""
        if self.is_open:
            return True
        if t is None:
            raise LogError(f"{path}: keeps no times, so --from and --to cannot be used")
        if self._first is None:
            self._first = t
        start, end = (
            None if bound is None else bound[1] + (self._first if bound[0] else 0.0) for bound in self._bounds
        )
        return (start is None or t >= start) and (end is None or t <= end)


def add_time_arguments(parser: argparse.ArgumentParser) -> None:
    """Add --from and --to."""
    hint = "seconds as in the log, or +SECONDS after its beginning"
    parser.add_argument(
        "--from", dest="start", metavar="T", type=seconds, help=f"leave out what is before; {hint}"
    )
    parser.add_argument(
        "--to", dest="end", metavar="T", type=seconds, help="leave out what is behind; as --from"
    )


def use_colour() -> bool:
    """Whether standard output is a terminal that wants colour."""
    return sys.stdout.isatty() and "NO_COLOR" not in os.environ and os.environ.get("TERM") != "dumb"


def show_table(rows: Iterable[Iterable[Any]], right: frozenset[int] = frozenset()) -> str:
    """Return rows of cells as aligned lines; columns in `right` are aligned to the right."""
    cells = [["" if cell is None else str(cell) for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    return "\n".join(
        "  ".join(
            cell.rjust(width) if at in right else cell.ljust(width)
            for at, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in cells
    )


@contextmanager
def binary_output(path: str) -> Iterator[Any]:
    """Open a file to be written, or standard output for "-"; gzip if its name ends so."""
    if path == "-":
        yield sys.stdout.buffer
        sys.stdout.buffer.flush()
        return
    import gzip

    try:
        file: Any = gzip.open(path, "wb") if path.endswith(".gz") else open(path, "wb")  # noqa: PTH123, SIM115
    except OSError as error:
        raise LogError(f"{path}: cannot be written: {error.strerror}") from error
    try:
        with file:
            yield file
    except BrokenPipeError:
        raise
    except (OSError, LogError) as error:
        # Half a file would look like a whole one.
        if Path(path).is_file():
            Path(path).unlink()
        if isinstance(error, LogError):
            raise
        raise LogError(f"{path}: cannot be written: {error.strerror}") from error
