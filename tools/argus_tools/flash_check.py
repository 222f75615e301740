# SPDX-License-Identifier: MIT
"""`argus-flash-check`: looks through the operator's UART of a board whether what was flashed runs as it should."""

from __future__ import annotations

import argparse
import dataclasses
import errno
import json
import os
import sys
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Final

import serial
from serial.tools import list_ports

from hil_sim.arguments import EXIT_USAGE, Parser, whole
from hil_sim.output import EXIT_UNREAD, guarded
from hil_sim.start import EXIT_INTERRUPTED
from hil_sim.version import add_version

EXIT_CHECKS, EXIT_LINE = 1, 3
BAUD: Final = 115_200
STACK_LEAST: Final = 256
ARCOS_HEADER: Final = b"\xfa\xfb"
LIFE_ENDED_BADLY: Final = ("watchdog", "fault", "brownout")
LINE_MOST: Final = 4096
_POLL_S: Final = 0.1
_DRAIN_MOST_S: Final = 1.0
_SHOWN: Final = 60

EPILOG: Final = """\
examples:
  argus-flash-check /dev/ttyUSB0
  argus-flash-check /dev/ttyUSB0 --board stm32f405 --config 5f15a1a5
  argus-flash-check /dev/ttyUSB0 --robot            a robot, or argus-sim, is at the other UART
  argus-flash-check /dev/ttyUSB0 --listen           gives no order: press the reset button yourself

The board is ordered to restart, which it refuses while the robot moves. A board as it is flashed is passive: it
moves nothing. `build/release/board_config board.ini` prints the digest of a settings file.

exit codes: 0 all is well, 1 a check has failed, 2 wrong arguments, 3 the line cannot be opened or says nothing,
130 interrupted
"""


class LineError(Exception):
    """There is nothing to check; the message says why."""


@dataclasses.dataclass(frozen=True)
class Check:
    """What was looked at, whether it is as it should be, and what was found."""

    name: str
    good: bool
    found: str


def here() -> str:
    """Return which serial ports this machine has, as the end of a message."""
    found = sorted(port.device for port in list_ports.comports())
    return f"; here are {', '.join(found)}" if found else "; no serial port is plugged in here"


class Console:
    """The operator's UART of a board: lines of JSON, orders as text."""

    def __init__(self, device: str, baud: int) -> None:
        """Open DEVICE."""
        try:
            self._port = serial.serial_for_url(device, baudrate=baud, timeout=_POLL_S, exclusive=True)
        except (serial.SerialException, ValueError, OSError) as error:
            is_missing = getattr(error, "errno", None) == errno.ENOENT
            why = f"{os.strerror(errno.ENOENT)}{here()}" if is_missing else str(error)
            raise LineError(f"{device}: {why}") from None
        self._rest = b""
        self._values: deque[dict[str, Any]] = deque()
        self.heard = b""
        """What came first, in case it is no line of a board."""

    def close(self) -> None:
        """Close it."""
        self._port.close()

    def order(self, text: str) -> None:
        """Give an order; what an earlier one has left open is ended before."""
        try:
            self._port.write(b"\n" + text.encode() + b"\n")
        except (serial.SerialException, OSError) as error:
            raise LineError(f"the line is gone: {error}") from None

    def drain(self) -> None:
        """Pass over what came until now, on its way in an adapter included: it answers no order to come."""
        until = time.monotonic() + _DRAIN_MOST_S
        while self._take() and time.monotonic() < until:
            pass
        self._values.clear()
        self._rest = b""

    def _take(self) -> bool:
        """Read what has come, if anything; a line that is no object with an event, or is cut, is passed over."""
        try:
            data = self._port.read(max(1, self._port.in_waiting))
        except (serial.SerialException, OSError) as error:
            raise LineError(f"the line is gone: {error}") from None
        self.heard = (self.heard + data)[:LINE_MOST]
        *lines, rest = (self._rest + data).split(b"\n")
        self._rest = rest[-LINE_MOST:]
        for line in lines:
            try:
                value = json.loads(line)
            except (ValueError, RecursionError):
                continue
            if isinstance(value, dict) and isinstance(value.get("event"), str):
                self._values.append(value)
        return bool(data)

    def next(self) -> dict[str, Any] | None:
        """Return the next object that has come, None if there is none yet."""
        if not self._values:
            self._take()
        return self._values.popleft() if self._values else None


Wanted = Callable[[dict[str, Any]], bool]


def wait_for(console: Console, wanted: Wanted, wait_s: float) -> dict[str, Any] | None:
    """Return the next object that is WANTED, None if it does not come within WAIT_S."""
    until = time.monotonic() + wait_s
    while time.monotonic() < until:
        value = console.next()
        if value is not None and wanted(value):
            return value
    return None


def is_start_or_refusal(value: dict[str, Any]) -> bool:
    """Return whether VALUE says that the board starts, or that it will not."""
    refused = value["event"] == "ORDER" and value.get("what") == "restart" and value.get("text") != "ok"
    return value["event"] == "START" or refused


def silence(console: Console) -> LineError:
    """Return why no board was heard, by what was."""
    if not console.heard:
        return LineError("nothing came: is the board supplied, and its TX at the adapter's RX?")
    if ARCOS_HEADER in console.heard:
        return LineError("these are packets for the robot: this is the board's other UART")
    if b'"event"' in console.heard:
        return LineError("the board runs but did not start anew: press its reset button")
    shown = console.heard[:_SHOWN].decode("ascii", "backslashreplace")
    return LineError(f"no line of a board came, but '{shown}': is the baud rate right?")


def found_start(console: Console, listen: bool, wait_s: float) -> dict[str, Any]:
    """Return START."""
    if not listen:
        console.drain()
        console.order("restart")
    start = wait_for(console, is_start_or_refusal, wait_s)
    if start is None:
        raise silence(console)
    if start["event"] != "START":
        raise LineError(f"the board refuses to restart: {start.get('text')}")
    return start


def checks_of_start(start: dict[str, Any], args: argparse.Namespace) -> Iterator[Check]:
    """Yield what START shows."""
    for name in ("board", "version", "config"):
        wanted, found = getattr(args, name), str(start.get(name))
        said = found if wanted in (None, found) else f"{found}, not {wanted}"
        yield Check(name, wanted in (None, found) and name in start, said)
    settings = str(start.get("settings"))
    yield Check("settings", settings in ("built", "stored"), settings)
    reset, place = str(start.get("reset")), [f"{key} {start.get(key)}" for key in ("pc", "lr", "cause")]
    bad = reset in LIFE_ENDED_BADLY
    yield Check("reset", not bad and "reset" in start, ", ".join([reset, *place]) if bad else reset)
    yield Check("invariant", start.get("invariant") == 0, str(start.get("invariant")))


def checks_of_status(status: dict[str, Any] | None, args: argparse.Namespace) -> Iterator[Check]:
    """Yield what STATUS shows."""
    if status is None:
        yield Check("status", False, f"none within {args.wait} s")
        return
    left = status.get("stack_left")
    known = isinstance(left, int) and not isinstance(left, bool)
    yield Check("stack", known and int(left or 0) >= args.stack, f"{left} bytes were never used")
    lost = status.get("lines_lost")
    yield Check("lines", lost == 0, f"{lost} lost")
    if args.robot:
        robot = status.get("robot") or "no robot"
        yield Check("robot", status.get("online") is True, f"{robot}, {status.get('sips')} packets")


def looks(console: Console, args: argparse.Namespace) -> Iterator[Check]:
    """Yield one check after the other."""
    yield from checks_of_start(found_start(console, args.listen, args.wait), args)
    link = wait_for(console, lambda value: value["event"] == "LINK_UP", args.wait)
    yield Check("link", link is not None, "up" if link else f"not up within {args.wait} s")
    if args.robot:
        status = wait_for(
            console, lambda value: value["event"] == "STATUS" and value.get("online") is True, args.wait
        )
    else:
        status = wait_for(console, lambda value: value["event"] == "STATUS", args.wait)
    yield from checks_of_status(status, args)


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    result = Parser(
        prog="argus-flash-check",
        description=__doc__.split(": ", 1)[1].capitalize() if __doc__ else None,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    result.add_argument("device", metavar="DEVICE", nargs="?", help="the operator's UART, as /dev/ttyUSB0")
    result.add_argument(
        "--baud", type=whole(300, 4_000_000), default=BAUD, metavar="N", help=f"default: {BAUD}"
    )
    result.add_argument("--board", metavar="NAME", help="what START must say: mps2-an386 or stm32f405")
    result.add_argument("--firmware", dest="version", metavar="V", help="... its version")
    result.add_argument("--config", metavar="DIGEST", help="... the digest of its settings")
    result.add_argument("--robot", action="store_true", help="a robot must answer at the other UART")
    result.add_argument("--listen", action="store_true", help="order no restart, wait for one")
    result.add_argument(
        "--stack",
        type=whole(0, 1 << 20),
        default=STACK_LEAST,
        metavar="BYTES",
        help="that must never have been used (default: %(default)s)",
    )
    result.add_argument(
        "--wait",
        type=whole(1, 3600),
        default=15,
        metavar="S",
        help="for each answer (default: %(default)s s)",
    )
    add_version(result)
    return result


def run(args: argparse.Namespace) -> int:
    """Check the board at a line and return the exit code."""
    console = Console(args.device, args.baud)
    failed = 0
    try:
        for check in looks(console, args):
            print(f"{'ok  ' if check.good else 'FAIL'} {check.name:9} {check.found}", flush=True)
            failed += not check.good
    finally:
        console.close()
    print("all is well" if not failed else f"{failed} of these are not as they should be")
    return EXIT_CHECKS if failed else 0


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    return guarded("argus-flash-check", lambda: _main(argv), EXIT_USAGE, EXIT_UNREAD)


def _main(argv: Sequence[str] | None) -> int:
    args = parser().parse_args(argv)
    if args.device is None:
        parser().error(f"name the operator's UART, as /dev/ttyUSB0{here()}")
    try:
        return run(args)
    except LineError as error:
        print(f"argus-flash-check: {error}", file=sys.stderr)
        return EXIT_LINE
    except KeyboardInterrupt:
        print("argus-flash-check: interrupted", file=sys.stderr)
        return EXIT_INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
