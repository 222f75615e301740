# SPDX-License-Identifier: MIT
"""The `argusctl` command: asks, watches and orders argusd over its control socket."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final

from argus_tools.control.client import DEFAULT_PLACE, Client, ControlError, Message, Refused, read_token
from argus_tools.control.motion import BY_HAND, MOTION_S, RETRY_S, Motion, Patience
from argus_tools.control.words import event_line, evidence_line, readings_line, status_text
from hil_sim.arguments import Parser, whole
from hil_sim.faults.kinds import SONAR_KINDS
from hil_sim.output import guarded
from hil_sim.start import EXIT_INTERRUPTED
from hil_sim.version import add_version

EXIT_OK, EXIT_REFUSED, EXIT_UNWRITABLE, EXIT_UNREACHABLE = 0, 1, 2, 3
KINDS: Final = (*SONAR_KINDS, "delayed", "ok")
TOPICS: Final = ("events", "state", "readings", "evidence")
_SILENT_S: Final = 1.5
_SILENT_PERIODS: Final = 1.5
_MOTION_PERIOD_MS: Final = 100

_EPILOG: Final = f"""\
examples:
  argusctl status                          what robot, sonars and course do now
  argusctl events                          what happens, line by line
  argusctl watch readings --json           one JSON object for each packet of the robot
  argusctl active                          allow it to drive
  argusctl goto 1500,0                     drive there: mm ahead and to the left of the start; or 1.5m,0
  argusctl turn 90                         turn left, and wait until it stands
  argusctl stop                            stop and stay, whoever has control
  argusctl fail sonar 3 stuck --for 30s    a fault for a test; argusd must run with --inject
  argusctl fail sonar 3 ok                 ... and its end

The socket is --socket, else the environment's ARGUS_CONTROL, else {DEFAULT_PLACE}.
exit codes: 0 done, 1 argusd refuses, or another stopped the step or turn, 2 wrong argument, or output
that cannot be written, 3 argusd cannot be reached, 130 Ctrl-C"""


def duration_ms(text: str) -> int:
    """Parse a duration.

    >>> duration_ms("30s"), duration_ms("2min"), duration_ms("1500ms"), duration_ms("5")
    (30000, 120000, 1500, 5000)
    """
    for unit, factor in (("ms", 1), ("min", 60_000), ("s", 1000), ("", 1000)):
        if text.endswith(unit):
            try:
                value = round(float(text.removesuffix(unit)) * factor)
            except (ValueError, OverflowError):
                break
            if 1000 <= value <= 600_000:
                return value
            break
    raise argparse.ArgumentTypeError(f"'{text}' is no time from 1s to 600s, as 30s or 2min")


def point(text: str) -> tuple[int, int]:
    """Parse X,Y in mm, or with a unit.

    >>> point("1500,-20"), point("2m,0"), point("1.5m,-20cm")
    ((1500, -20), (2000, 0), (1500, -200))
    """
    try:
        x, y = (_length_mm(part.strip()) for part in text.split(","))
    except (ValueError, OverflowError):
        raise argparse.ArgumentTypeError(
            f"'{text}' is no point: give X,Y in whole mm, or with a unit as 2m,0"
        ) from None
    return x, y


def _length_mm(text: str) -> int:
    for unit, factor in (("mm", 1), ("cm", 10), ("m", 1000)):
        if text.endswith(unit):
            return round(float(text.removesuffix(unit)) * factor)
    return int(text)


def show_status(client: Client, args: argparse.Namespace) -> int:
    """Print one state."""
    state = client.request("status")["state"]
    print(json.dumps(state) if args.json else status_text(state))
    return EXIT_OK


def _line_of(message: Message, as_json: bool) -> str:
    if as_json:
        return json.dumps(message)
    if "lost" in message:
        return f"-- {message.get('count', '')} lines were lost: this reader is too slow".replace("  ", " ")
    if "readings" in message:
        return readings_line(message["readings"])
    if "evidence" in message:
        return evidence_line(message["evidence"])
    if message.get("event") == "STATUS":
        return status_text(message)
    return event_line(message) if "event" in message else json.dumps(message)


class _Heard:
    """Takes streamed messages; when none comes, somebody is told on standard error, and when they come again.

    States have to be among the topics: they come in any case, so that without them nothing is heard of argusd.
    """

    def __init__(self, client: Client, period_ms: int) -> None:
        self._client = client
        self._silent_s = max(_SILENT_S, _SILENT_PERIODS * period_ms / 1000)

    def next(self, timeout_s: float | None = None) -> Message:
        """Return the next message; TimeoutError when none comes in time (None: however long it takes)."""
        try:
            return self._client.message(self._silent_s)
        except TimeoutError:
            self._tell("argusd reports nothing")
        message = self._client.message(
            timeout_s if timeout_s is None else max(0.0, timeout_s - self._silent_s)
        )
        self._tell("argusd reports again")
        return message

    @staticmethod
    def _tell(words: str) -> None:
        print(f"argusctl: {words}", file=sys.stderr, flush=True)


def watch(client: Client, args: argparse.Namespace) -> int:
    """Print what is streamed until argusd ends."""
    wants_state = "state" in args.topics
    client.watch(*args.topics, *(() if wants_state else ("state",)), period_ms=args.period)
    heard = _Heard(client, args.period)
    while True:
        try:
            message = heard.next()
        except ControlError:
            return EXIT_OK
        if wants_state or message.get("event") != "STATUS":
            print(_line_of(message, args.json), flush=True)


def _move(client: Client, order: str, members: Message) -> None:
    """Order a motion by hand and wait until it is over; going away before would stop it."""
    client.watch("events", "state", period_ms=_MOTION_PERIOD_MS)
    _order_once_checked(client, order, members)
    motion, heard = Motion(order), _Heard(client, _MOTION_PERIOD_MS)
    while not motion.is_over(heard.next(MOTION_S)):
        pass


def _order_once_checked(client: Client, name: str, members: Message) -> None:
    """Order a motion; a check of the sonars, as after each stop, is waited for."""
    patience = Patience()
    while True:
        try:
            client.order(name, **members)
        except Refused as refusal:
            if not patience.bears(refusal):
                raise
            time.sleep(RETRY_S)
        else:
            return


def _order(
    name: str, members: Callable[[argparse.Namespace], Message]
) -> Callable[[Client, argparse.Namespace], int]:
    def act(client: Client, args: argparse.Namespace) -> int:
        if name != "stop":
            client.take(force=args.force)
        if name in BY_HAND:
            _move(client, name, members(args))
        else:
            note = client.order(name, **members(args))
            if note is not None:
                print(f"argusctl: {note}", file=sys.stderr)
        return EXIT_OK

    return act


def _nothing(_: argparse.Namespace) -> Message:
    return {}


def _of_sonar(args: argparse.Namespace) -> Message:
    return {"sonar": args.sonar}


def _fault(args: argparse.Namespace) -> Message:
    if args.kind == "ok":
        return {"sonar": args.sonar, "kind": "ok"}
    return {"sonar": args.sonar, "kind": args.kind, "for_ms": args.time}


Act = Callable[[Client, argparse.Namespace], int]


class Commands:
    """Declares the subcommands."""

    def __init__(self, parser: argparse.ArgumentParser) -> None:
        self._parsers = parser.add_subparsers(metavar="COMMAND", required=True, parser_class=Parser)

    def add(self, name: str, summary: str, act: Act) -> argparse.ArgumentParser:
        """Declare one."""
        parser = self._parsers.add_parser(
            name, help=summary, description=summary[0].upper() + summary[1:] + "."
        )
        parser.set_defaults(act=act)
        return parser

    def order(
        self, name: str, summary: str, members: Callable[[argparse.Namespace], Message] = _nothing
    ) -> argparse.ArgumentParser:
        """Declare one that orders something."""
        parser = self.add(name, summary, _order(name, members))
        parser.add_argument("--force", action="store_true", help="take control from whoever has it")
        return parser


def _add_watching(commands: Commands) -> None:
    parser = commands.add("status", "tell the state once", show_status)
    parser.add_argument("--json", action="store_true", help="as one JSON object")
    parser = commands.add("events", "tell what happens, a line each, until argusd ends", watch)
    parser.add_argument("--json", action="store_true", help="as JSON objects")
    parser.set_defaults(topics=["events"], period=500)
    parser = commands.add("watch", "stream what is asked for, until argusd ends", watch)
    parser.add_argument("topics", nargs="+", choices=TOPICS, metavar="TOPIC", help=", ".join(TOPICS))
    parser.add_argument(
        "--period",
        type=whole(50, 10000),
        default=500,
        metavar="MS",
        help="of state and evidence (default 500)",
    )
    parser.add_argument("--json", action="store_true", help="as JSON objects")


def _add_driving(commands: Commands) -> None:
    commands.order("stop", "stop, and stay: the course is paused; needs no control")
    commands.order("go", "go on with the course")
    commands.order("active", "allow it to drive")
    commands.order("passive", "stop, then only report")
    commands.order("recheck", "check all sonars again")
    parser = commands.order("step", "one step, and wait until it stands", lambda args: {"way": args.way})
    parser.add_argument("way", choices=("ahead", "back"))
    parser = commands.order(
        "turn", "turn on the spot, and wait until it stands", lambda args: {"deg": args.deg}
    )
    parser.add_argument("deg", type=whole(-180, 180), metavar="DEG", help="degrees, positive to the left")
    parser = commands.order(
        "goto", "drive to a point", lambda args: {"x_mm": args.point[0], "y_mm": args.point[1]}
    )
    parser.add_argument(
        "point",
        type=point,
        metavar="X,Y",
        help="mm ahead and left of where it was connected, or with a unit: 2m,0",
    )
    parser = commands.order(
        "course", "drive through points", lambda args: {"points": [list(p) for p in args.points]}
    )
    parser.add_argument("points", type=point, nargs="+", metavar="X,Y", help="1 to 64 of them, mm")
    commands.order("quit", "stop the robot, close its session, end argusd")


def _add_sonars(commands: Commands) -> None:
    for name, summary in (
        ("retest", "forget the evidence against a sonar and look at it again"),
        ("pin", "keep a sonar's health as it is"),
        ("unpin", "let the evidence decide again"),
        ("out", "take a sonar out of use, pinned"),
    ):
        parser = commands.order(name, summary, _of_sonar)
        parser.add_argument("sonar", type=whole(0, 31), metavar="N", help="number of the sonar, from 0")
    parser = commands.order("fail", "make a sonar fail for a while, for a test (argusd --inject)", _fault)
    parser.add_argument("what", choices=("sonar",), help="what is to fail")
    parser.add_argument("sonar", type=whole(0, 31), metavar="N", help="number of the sonar, from 0")
    parser.add_argument("kind", choices=KINDS, metavar="KIND", help=", ".join(KINDS))
    parser.add_argument(
        "--for",
        dest="time",
        type=duration_ms,
        default=30_000,
        metavar="TIME",
        help="1s to 600s (default 30s)",
    )


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the whole command line."""
    parser = Parser(
        prog="argusctl",
        description="Asks, watches and orders a running argusd (argusd --control).",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--socket", metavar="PLACE", help="unix:PATH or tcp:HOST:PORT")
    parser.add_argument(
        "--token", metavar="FILE", type=Path, help="file with the token, where one is asked for"
    )
    add_version(parser)
    commands = Commands(parser)
    _add_watching(commands)
    _add_driving(commands)
    _add_sonars(commands)
    return parser


def _run(args: argparse.Namespace) -> int:
    token = read_token(args.token) if args.token else None
    with Client(args.socket, token) as client:
        act: Any = args.act
        return int(act(client, args))


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command; return its exit code."""
    return guarded("argusctl", lambda: _main(argv), EXIT_UNWRITABLE, EXIT_OK)


def _main(argv: Sequence[str] | None) -> int:
    args = make_parser().parse_args(argv)
    try:
        return _run(args)
    except Refused as refusal:
        print(f"argusctl: {refusal} ({refusal.why})", file=sys.stderr)
        return EXIT_REFUSED
    except (ControlError, TimeoutError) as problem:
        print(f"argusctl: {problem}", file=sys.stderr)
        return EXIT_UNREACHABLE
    except KeyboardInterrupt:
        return EXIT_INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
