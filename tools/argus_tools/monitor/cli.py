# SPDX-License-Identifier: MIT
"""The command `argus-monitor`: a page in the browser that shows a robot and drives it."""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import io
import os
import re
import secrets
import signal
import stat
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from argus_tools.monitor import tui
from argus_tools.monitor.geometry import walls_of
from argus_tools.monitor.hub import Hub
from argus_tools.monitor.sim import Simulation, SimulationError, argusd_of
from argus_tools.monitor.upstream import Address, parse_address
from hil_sim.arguments import EXIT_USAGE, Parser
from hil_sim.cli.arguments import parser as sim_parser
from hil_sim.cli.choose import scenario_of
from hil_sim.errors import SimError
from hil_sim.output import EXIT_UNREAD, guarded, is_of_output
from hil_sim.version import add_version
from hil_sim.world.files import load_world

if TYPE_CHECKING:
    from argus_tools.monitor.server import Server

EXIT_START: Final = 3
PORT: Final = 8642
TOKEN_FORM: Final = re.compile(r"[!-~]{16,128}")
_OURS_ALONE: Final = ("orders", "tcp", "serial", "can", "baud", "list_worlds", "list_faults", "duration")
"""Options of argus-sim that cannot go with this program."""
_EXAMPLES: Final = """\
examples:
  argus-monitor --sim                                      an emulated robot, its manager and the page
  argus-monitor --sim --world office --fault off:3@12s     with what argus-sim takes
  argus-sim --monitor --world office                       the same
  argus-monitor --connect unix:/run/argus/control          the robot of an argusd that runs with --control
  argus-monitor --connect tcp:127.0.0.1:8100 --token FILE  over TCP; FILE holds the token of argusd
  argus-monitor --connect unix:/run/argus/control --tui    argusd's screen on this terminal, no page

The first line on standard output is the address to open in a browser, with the secret that lets it in after the #.
It listens on 127.0.0.1 only; from elsewhere: ssh -L 8642:127.0.0.1:8642 ROBOT

exit codes: 0 ended by a signal, 2 wrong argument or file, 3 the port is taken, or argusd or the robot ended
"""


class UsageError(Exception):
    """A wrong argument or file; the message is one line."""


class PortError(Exception):
    """The page has no port to listen on; the message is one line."""


def _port(text: str) -> int:
    if not text.isdigit() or int(text) > 65535:
        raise argparse.ArgumentTypeError(f"'{text}' is not a port of 0 to 65535")
    return int(text)


def _origin(text: str) -> str:
    found = re.fullmatch(r"(https?://[a-z0-9.:\[\]_-]+)/?", text.lower())
    if found is None:
        raise argparse.ArgumentTypeError(f"'{text}' is no origin: give https://HOST or https://HOST:PORT")
    return found[1]


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    result = Parser(
        prog="argus-monitor",
        description="Show a robot, its sonars and their faults on a page in the browser, and drive it from there.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    where = result.add_mutually_exclusive_group(required=True)
    where.add_argument(
        "--connect",
        metavar="ADDRESS",
        help="the control socket of argusd: unix:PATH or tcp:HOST:PORT, as its option --control says",
    )
    where.add_argument(
        "--sim",
        action="store_true",
        help="start an emulated robot and argusd; takes the options of argus-sim as well (argus-sim --help)",
    )
    result.add_argument(
        "--token", metavar="FILE", help="the file with the token that argusd asks for on TCP (mode 0600)"
    )
    result.add_argument(
        "--argusd",
        metavar="PROGRAM",
        help="with --sim or --tui: the argusd to run (default: the one built, of the wheel, or in PATH)",
    )
    result.add_argument(
        "--argusd-option",
        metavar="OPTION",
        action="append",
        default=[],
        help="with --sim: passed on to argusd, e.g. --argusd-option=--profile=paper; repeatable",
    )
    result.add_argument(
        "--port", type=_port, metavar="N", help=f"of the page (default {PORT}; 0: any free one)"
    )
    result.add_argument(
        "--page-token",
        metavar="FILE",
        help="take the page's secret from FILE (mode 0600) instead of making one; it is then not printed",
    )
    result.add_argument(
        "--allow-origin",
        metavar="ORIGIN",
        type=_origin,
        action="append",
        default=[],
        help="where a proxy serves the page, as https://HOST[:PORT]; repeatable (docs/monitor.md)",
    )
    result.add_argument(
        "--tui",
        action="store_true",
        help="no page: show argusd's screen on this terminal (argusd --attach), until q",
    )
    add_version(result)
    return result


def read_token(name: str) -> str:
    """Return the token in a file that nobody else may read; UsageError says what is wrong with it."""
    try:
        with Path(name).open(encoding="utf-8") as file:
            mode = os.fstat(file.fileno()).st_mode
            line = file.readline(256).strip()
    except (OSError, UnicodeError) as error:
        raise UsageError(f"{name}: {getattr(error, 'strerror', None) or 'it is no text'}") from None
    if not stat.S_ISREG(mode) or mode & 0o077:
        raise UsageError(f"{name}: others may read it; chmod 600 {name}")
    if not TOKEN_FORM.fullmatch(line):
        raise UsageError(
            f"{name}: its first line is no token of 16 to 128 printable characters without blanks"
        )
    return line


def _simulation(arguments: argparse.Namespace, words: Sequence[str]) -> tuple[Simulation, dict[str, Any]]:
    """Return what is to be started, and what the page is told of its world."""
    sim = sim_parser().parse_args(list(words))
    for name in _OURS_ALONE:
        if getattr(sim, name):
            raise UsageError(f"--{name.replace('_', '-')} does not go with --sim; leave it out")
    if sim.robots > 1:
        raise UsageError("--robots does not go with --sim: one page shows one robot")
    try:
        scenario = scenario_of(sim)
        world = load_world(scenario.world)
    except SimError as error:
        raise UsageError(str(error)) from None
    made = Simulation(words, argusd_of(arguments.argusd), arguments.argusd_option)
    return made, {"world": world.name, "walls": walls_of(world, scenario.start or world.start)}


def _address(arguments: argparse.Namespace) -> Address:
    try:
        address = parse_address(arguments.connect)
    except ValueError as error:
        raise UsageError(str(error)) from None
    token = read_token(arguments.token) if arguments.token else ""
    return Address(address.path, address.host, address.port, token)


async def _until_ended(simulation: Simulation | None, caught: asyncio.Event) -> str:
    """Wait for a signal, or for the end of what we started; return why it ended, empty for a signal."""

    async def asked() -> str:
        await caught.wait()
        return ""

    waiting = [asyncio.create_task(asked())]
    if simulation is not None:
        waiting.append(asyncio.create_task(simulation.ended()))
    done, rest = await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
    for task in rest:
        task.cancel()
    return "" if waiting[0] in done else done.pop().result()


def _caught() -> asyncio.Event:
    """Return what is set when a signal asks us to end."""
    caught = asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        asyncio.get_running_loop().add_signal_handler(number, caught.set)
    return caught


async def _run_screen(arguments: argparse.Namespace, words: Sequence[str]) -> int:
    caught = _caught()
    simulation, _ = _simulation(arguments, words)
    try:
        shown = asyncio.create_task(tui.beside(simulation, arguments.argusd))
        asked = asyncio.create_task(caught.wait())
        await asyncio.wait([shown, asked], return_when=asyncio.FIRST_COMPLETED)
        asked.cancel()
        if shown.done():
            return shown.result()
        shown.cancel()
        await asyncio.wait([shown])
        return 0
    finally:
        await simulation.close()


def _show_screen(arguments: argparse.Namespace, words: Sequence[str]) -> int:
    """Show argusd's screen; with --connect this process goes on as that screen."""
    if not sys.stdout.isatty():
        raise UsageError("--tui needs a terminal")
    if arguments.sim:
        return asyncio.run(_run_screen(arguments, words))
    tui.become(tui.screen(arguments.argusd, str(_address(arguments)), arguments.token))
    return EXIT_START


async def _listen(server: Server, port: int) -> int:
    try:
        return await server.start(port)
    except OSError as error:
        raise PortError(f"port {port}: {error.strerror}; choose another with --port") from None


async def _run(arguments: argparse.Namespace, words: Sequence[str], page_token: str) -> None:
    from argus_tools.monitor.server import Server

    caught = _caught()
    simulation, about = _simulation(arguments, words) if arguments.sim else (None, {})
    async with contextlib.AsyncExitStack() as stack:
        if simulation is not None:
            stack.push_async_callback(simulation.close)
        hub = Hub(
            simulation.address if simulation else _address(arguments),
            simulation,
            **about,
        )
        if simulation is None:
            hub.told = lambda why: print(f"argus-monitor: {why}", file=sys.stderr, flush=True)
        server = Server(hub, page_token, arguments.allow_origin)
        stack.push_async_callback(server.stop)
        port = await _listen(server, PORT if arguments.port is None else arguments.port)
        if simulation is not None:
            await simulation.start()
        watching = asyncio.create_task(hub.run())
        stack.callback(watching.cancel)
        secret = "" if arguments.page_token else f"#{page_token}"
        print(f"http://127.0.0.1:{port}/{secret}", flush=True)
        why = await _until_ended(simulation, caught)
        if why:
            raise SimulationError(why)


def _check_together(arguments: argparse.Namespace) -> None:
    """Refuse what would be passed over."""
    if not arguments.sim and arguments.argusd_option:
        raise UsageError("--argusd-option goes with --sim")
    if not arguments.sim and not arguments.tui and arguments.argusd:
        raise UsageError("--argusd goes with --sim or --tui")
    if arguments.tui and arguments.port is not None:
        raise UsageError("--port does not go with --tui: there is no page; leave it out")
    if arguments.tui and arguments.page_token:
        raise UsageError("--page-token does not go with --tui: there is no page; leave it out")


def main(argv: Sequence[str] | None = None) -> int:
    """Run `argus-monitor`; return its exit code."""
    return guarded("argus-monitor", lambda: _main(argv), EXIT_USAGE, EXIT_UNREAD)


def _main(argv: Sequence[str] | None) -> int:
    arguments, words = parser().parse_known_args(sys.argv[1:] if argv is None else list(argv))
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(line_buffering=True)
    code = EXIT_USAGE
    try:
        if words and not arguments.sim:
            raise UsageError(f"unknown option '{words[0]}'; see argus-monitor --help")
        _check_together(arguments)
        if arguments.tui:
            return _show_screen(arguments, words)
        page_token = read_token(arguments.page_token) if arguments.page_token else secrets.token_urlsafe(24)
        asyncio.run(_run(arguments, words, page_token))
        return 0
    except UsageError as error:
        why = str(error)
    except (SimulationError, PortError) as error:
        why, code = str(error), EXIT_START
    except ModuleNotFoundError as error:
        if error.name != "aiohttp":
            raise
        why, code = "aiohttp is missing; install argus-p3dx[monitor]", EXIT_START
    except OSError as error:
        if isinstance(error, BrokenPipeError) or is_of_output(error):
            raise
        why, code = ": ".join(map(str, filter(None, (error.filename, error.strerror or error)))), EXIT_START
    print(f"argus-monitor: {why}", file=sys.stderr)
    return code


if __name__ == "__main__":
    sys.exit(main())
