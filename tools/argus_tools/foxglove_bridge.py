# SPDX-License-Identifier: MIT
"""`argus-foxglove`: what argusd knows, live in Foxglove: a client of the control socket that serves a WebSocket."""

from __future__ import annotations

import argparse
import re
import sys
import time
from collections.abc import Callable, Sequence
from importlib import resources
from pathlib import Path
from typing import Any, Final

from argus_tools.control import Client, ControlError, Refused
from argus_tools.control.client import default_place, read_token
from argus_tools.foxglove import (
    BEAMS,
    ERROR,
    EVENTS,
    INFO,
    ODOMETRY,
    RING,
    SCHEMAS,
    STATE,
    TF,
    TOPICS,
    WARNING,
    places,
    sonar_topic,
    sonars_of,
    stamp_of,
)
from argus_tools.foxglove_front import FOXGLOVE, Front, Gate, hidden_host, is_loopback
from hil_sim.arguments import Parser
from hil_sim.faults.values import value_words
from hil_sim.output import EXIT_UNREAD, guarded
from hil_sim.version import add_version

EXIT_USAGE, EXIT_LINK = 2, 3
PORT: Final = 8765
_PAUSE_S: Final = 1.0
_LEVELS: Final = (INFO, WARNING, ERROR, WARNING)
_MOTORS_BIT: Final = 1
_MOVING_MM_S: Final = 5
_REPLY_S: Final = 2.0
_SILENT_S: Final = 1.0
_SILENT_PERIODS: Final = 1.5
_DELETE_ALL: Final = 1
_NO_RING: Final[dict[str, Any]] = {
    "mode": "OFFLINE",
    "mission": "none",
    "failure": "IsNormal",
    "active": False,
    "online": False,
    "trusted": 0,
    "health": [],
    "fault": [],
    "injected": [],
    "plan_deg": [],
}

Put = Callable[[str, str, int, dict[str, Any]], None]
"""Topic, name of the schema, time, message."""

EPILOG: Final = """\
examples:
  argus-foxglove                                        argusd at its usual place, port 8765
  argus-foxglove --control unix:/tmp/argus.sock
  argus-foxglove --control tcp:127.0.0.1:8102 --token FILE --port 9000
  argus-foxglove --layout > argus-layout.json           a layout for Foxglove, to import there

In Foxglove: open a connection to ws://localhost:8765, then import the layout.
It only shows: nothing that comes over the WebSocket reaches the robot. It lets in programs, Foxglove's own page, and
pages of localhost; not those of other sites, unless --allow-origin names them.
"""


def layout() -> str:
    """Return the layout that shows all topics in Foxglove."""
    return (resources.files("argus_tools") / "foxglove_layout.json").read_text(encoding="utf-8")


class Translator:
    """Makes messages for Foxglove of what the control socket streams."""

    def __init__(self, put: Put) -> None:
        self._put = put
        self._sonars = sonars_of("")
        self._health: list[str] = []
        self._fault: list[str] = []
        self._ring: dict[str, Any] = dict(_NO_RING)

    def expire(self, t_ns: int) -> None:
        """Take back what is shown: nothing is known of the robot any more."""
        ring = self._ring | {"online": False, "trusted": 0, "health": ["STALE"] * len(self._health)}
        self._put(RING, "argus.Ring", t_ns, ring)
        self._delete_beams(t_ns)

    def _delete_beams(self, t_ns: int) -> None:
        deletion = {"timestamp": stamp_of(t_ns), "type": _DELETE_ALL, "id": ""}
        self._put(BEAMS, "foxglove.SceneUpdate", t_ns, {"deletions": [deletion], "entities": []})

    def take(self, message: dict[str, Any], t_ns: int) -> None:
        """Take one object of a stream."""
        if "readings" in message:
            self._readings(message["readings"], t_ns)
        elif message.get("event") == "STATUS":
            self._state(message, t_ns)
        elif "event" in message:
            self._event(message, t_ns)

    def _readings(self, readings: dict[str, Any], t_ns: int) -> None:
        seen = {
            k: (mm, age_ms)
            for k, (mm, age_ms) in enumerate(zip(readings["mm"], readings["age_ms"], strict=True))
            if age_ms >= 0
        }
        for k, (mm, age_ms) in seen.items():
            reading = {**self._sonars.reading(k, mm), "age_ms": age_ms}
            if k < len(self._health):
                reading |= {"health": self._health[k], "fault": self._fault[k]}
            self._put(sonar_topic(k), "argus.SonarRange", t_ns, reading)
        ranges = {k: mm for k, (mm, _) in seen.items()}
        scene = self._sonars.beams(stamp_of(t_ns), ranges, self._health, self._fault)
        self._put(BEAMS, "foxglove.SceneUpdate", t_ns, scene)

    def _state(self, state: dict[str, Any], t_ns: int) -> None:
        self._sonars = sonars_of(str(state.get("subclass") or ""))
        self._health, self._fault = state["health"], state["kind"]
        heading_deg = state["heading_cdeg"] / 100
        place, transform = places(state["x_mm"], state["y_mm"], heading_deg)
        self._put(ODOMETRY, "foxglove.PoseInFrame", t_ns, place)
        self._put(TF, "foxglove.FrameTransform", t_ns, transform)
        same = (
            "x_mm",
            "y_mm",
            "vel_left_mm_s",
            "vel_right_mm_s",
            "bumpers_front",
            "bumpers_rear",
            "flags",
        )
        moving = max(abs(state["vel_left_mm_s"]), abs(state["vel_right_mm_s"])) > _MOVING_MM_S
        robot = {key: state[key] for key in same} | {
            "heading_deg": heading_deg,
            "battery_v": state["battery_dv"] / 10,
            "moving": moving,
            "motors": bool(state["flags"] & _MOTORS_BIT),
        }
        self._put(STATE, "argus.RobotState", t_ns, robot)
        if self._ring["online"] and not state["online"]:
            self._delete_beams(t_ns)
        self._ring = {
            "mode": state["mode"],
            "mission": state["mission"],
            "failure": state["state"],
            "active": bool(state["active"]),
            "online": bool(state["online"]),
            "trusted": sum(not kind for kind in self._fault),
            "health": self._health,
            "fault": self._fault,
            "injected": state.get("injected", []),
            "plan_deg": state["plan_deg"],
        }
        self._put(RING, "argus.Ring", t_ns, self._ring)

    def _event(self, event: dict[str, Any], t_ns: int) -> None:
        level = _LEVELS[min(int(event["level"]), len(_LEVELS) - 1)]
        words = f"{event['event']} {event['name']}{value_words(event['event'], event['value'])}"
        log = {"level": level, "message": words, "name": event["name"], "file": "", "line": 0}
        self._put(EVENTS, "foxglove.Log", t_ns, log)


class Server:
    """The WebSocket server, with a channel for each topic from the start: a viewer misses no first message.

    That of the SDK lets everybody in, so it listens where nobody looks for it, behind a port that asks who comes.
    """

    def __init__(self, host: str, port: int, origins: Sequence[str] = ()) -> None:
        try:
            import foxglove
        except ImportError as error:
            raise ControlError(f"{error}: pip install 'argus-p3dx[foxglove]'") from error
        self._foxglove = foxglove
        self._channels = {topic: self._channel(topic, schema) for topic, schema in TOPICS.items()}
        try:
            self._front = Front(host, port, Gate(host, origins))
        except OSError as error:
            raise ControlError(f"{host}:{port} cannot be served: {error.strerror or error}") from error
        hidden = hidden_host()
        try:
            self._server = foxglove.start_server(name="argus", host=hidden, port=0)
        except Exception as error:  # the library names no class for it
            self._front.stop()
            raise ControlError(f"{hidden} cannot be served: {error}") from error
        self._front.start(hidden, int(self._server.port))

    def _channel(self, topic: str, schema: str) -> Any:
        return self._foxglove.Channel(topic, schema=SCHEMAS[schema], message_encoding="json")

    @property
    def port(self) -> int:
        """The port that is served."""
        return self._front.port

    def put(self, topic: str, schema: str, t_ns: int, message: dict[str, Any]) -> None:
        """Send one message to all viewers."""
        stamp = {"timestamp": stamp_of(t_ns)} if "timestamp" in SCHEMAS[schema]["properties"] else {}
        if topic not in self._channels:  # of a sonar beyond those of a P3-DX
            self._channels[topic] = self._channel(topic, schema)
        self._channels[topic].log({**stamp, **message}, log_time=t_ns)

    def stop(self) -> None:
        """End all connections."""
        self._front.stop()
        self._server.stop()


def follow(place: str, token: str | None, put: Put, period_ms: int) -> None:
    """Translate what one connection brings, until it ends or carries nothing; then what is shown is taken back."""
    translator = Translator(put)
    silent_s = max(_SILENT_S, _SILENT_PERIODS * period_ms / 1000)
    try:
        with Client(place, token, timeout_s=_REPLY_S) as argus:
            print(f"argus-foxglove: {place}: connected", file=sys.stderr, flush=True)
            argus.watch("events", "state", "readings", period_ms=period_ms)
            while True:
                translator.take(argus.message(silent_s), time.time_ns())
    finally:
        translator.expire(time.time_ns())  # again with each try: who comes later is to see it, too


def run(args: argparse.Namespace) -> int:
    """Serve until the end; argusd may come and go."""
    token = read_token(args.token) if args.token else None
    server = Server(args.host, args.port, args.allow_origin)
    host = f"[{args.host}]" if ":" in args.host else args.host
    print(f"ws://{host}:{server.port}", flush=True)
    told = ""
    try:
        while True:
            try:
                follow(args.control, token, server.put, args.period)
            except (ControlError, Refused, TimeoutError) as error:
                if str(error) != told:
                    print(f"argus-foxglove: {error}", file=sys.stderr, flush=True)
                told = str(error)
            time.sleep(_PAUSE_S)
    except KeyboardInterrupt:
        return 0
    finally:
        server.stop()


def origin(text: str) -> str:
    """Return the origin of a page.

    >>> origin("https://viewer.example:8443/")
    'https://viewer.example:8443'
    """
    found = re.fullmatch(r"(https?://[A-Za-z0-9.:\[\]_-]+)/?", text)
    if found is None:
        raise argparse.ArgumentTypeError(f"'{text}' is no origin: give https://HOST or https://HOST:PORT")
    return found[1]


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    made = Parser(
        prog="argus-foxglove",
        description="Show live in Foxglove what argusd knows.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog=EPILOG,
    )
    made.add_argument(
        "--control",
        default=default_place(),
        metavar="PLACE",
        help="argusd's control socket, unix:PATH or tcp:HOST:PORT (default: %(default)s)",
    )
    made.add_argument("--layout", action="store_true", help="print a layout to import in Foxglove, and end")
    made.add_argument("--token", type=Path, metavar="FILE", help="file with the token of a tcp: socket")
    made.add_argument("--host", default="127.0.0.1", help="address to serve on (default: %(default)s)")
    made.add_argument(
        "--port", type=int, default=PORT, help="port to serve on, 0: any (default: %(default)s)"
    )
    made.add_argument(
        "--beyond-loopback", action="store_true", help="allow a --host that other machines can reach"
    )
    made.add_argument(
        "--allow-origin",
        action="append",
        default=[],
        type=origin,
        metavar="ORIGIN",
        help="let pages of this origin look on too, as https://HOST[:PORT]; repeatable "
        f"(always: {FOXGLOVE[0]}, pages of localhost, programs)",
    )
    made.add_argument(
        "--period", type=int, default=100, metavar="MS", help="between two states, 50 to 1000 (default: 100)"
    )
    add_version(made)
    return made


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the program."""
    return guarded("argus-foxglove", lambda: _main(arguments), EXIT_USAGE, EXIT_UNREAD)


def _main(arguments: Sequence[str] | None) -> int:
    args = parser().parse_args(arguments)
    if args.layout:
        sys.stdout.write(layout())
        return 0
    if not 0 <= args.port <= 65535:
        parser().error(f"--port {args.port}: give 0 to 65535")
    if not 50 <= args.period <= 1000:
        parser().error(f"--period {args.period}: give 50 to 1000")
    if not args.beyond_loopback and not is_loopback(args.host):
        parser().error(f"--host {args.host}: others could look on; --beyond-loopback allows it")
    try:
        return run(args)
    except KeyboardInterrupt:  # before or behind what run() guards
        return 0
    except ControlError as error:
        print(f"argus-foxglove: {error}", file=sys.stderr)
        return EXIT_LINK


if __name__ == "__main__":
    raise SystemExit(main())
