# SPDX-License-Identifier: MIT
"""The `argus-sim` command: one emulated robot on a pseudo-terminal, a TCP port, a real UART or a CAN bus."""

from __future__ import annotations

import io
import logging
import sys
from collections.abc import Callable, Sequence
from importlib.metadata import entry_points

from hil_sim.cli.arguments import parser
from hil_sim.cli.choose import scenario_of
from hil_sim.cli.serve import say, serve
from hil_sim.errors import SimError
from hil_sim.faults.grammar import fault_help
from hil_sim.output import guarded
from hil_sim.world.files import world_names


def _elsewhere(words: Sequence[str]) -> int | None:
    """Run what has a command line of its own; None: nothing of that was asked for."""
    if words[:1] == ["bench"]:
        from hil_sim.bench.cli import main as bench

        return bench(words[1:])
    if words[:1] == ["experiment"]:
        from hil_sim.experiment.cli import main as experiment

        return experiment(words[1:])
    if "--monitor" in words:
        return _program("argus-monitor")(["--sim", *(word for word in words if word != "--monitor")])
    return None


def _program(name: str) -> Callable[[Sequence[str]], int]:
    """Return another program as it is installed beside this one: the emulator itself needs none."""
    found = [point for point in entry_points(group="console_scripts") if point.name == name]
    if not found:
        raise SimError(f"{name} is not installed: pip install 'argus-p3dx[monitor]'")
    program: Callable[[Sequence[str]], int] = found[0].load()
    return program


def main(argv: Sequence[str] | None = None) -> int:
    """Run `argus-sim`; return its exit code."""
    words = list(sys.argv[1:] if argv is None else argv)
    return guarded("argus-sim", lambda: _run(words), SimError.exit_code, 0)


def _run(words: Sequence[str]) -> int:
    if isinstance(sys.stdout, io.TextIOWrapper):  # a name may have letters that the terminal has not
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        code = _elsewhere(words)
        if code is not None:
            return code
        arguments = parser().parse_args(words)
        if arguments.list_worlds:
            print("\n".join(world_names()))
        elif arguments.list_faults:
            print(fault_help())
        else:
            logging.basicConfig(format="argus-sim: %(message)s", stream=sys.stderr)
            if arguments.verbose > 1:
                logging.getLogger("argus.sim").setLevel(logging.DEBUG)
            serve(arguments, scenario_of(arguments))
    except SimError as error:
        say(str(error))
        return error.exit_code
    return 0
