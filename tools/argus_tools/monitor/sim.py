# SPDX-License-Identifier: MIT
"""An emulated robot with argusd on it, as children of ours: started, ordered about, ended."""

from __future__ import annotations

import asyncio
import contextlib
import ctypes
import json
import os
import shutil
import signal
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from argus_tools.monitor.upstream import Address, Message
from hil_sim.program import ARGUSD_VARIABLE, NO_ARGUSD, find_argusd

BAUD: Final = 9600
START_WITHIN_S: Final = 60.0
ANSWER_WITHIN_S: Final = 5.0
END_WITHIN_S: Final = 6.0
_PR_SET_PDEATHSIG: Final = 1


class SimulationError(Exception):
    """The robot or its manager does not start, or ended; the message is one line."""


def argusd_of(given: str | None) -> str:
    """Return the argusd to run: the one GIVEN, else by the rule for all programs."""
    wanted = given or os.environ.get(ARGUSD_VARIABLE)
    found = shutil.which(given) if given else find_argusd()
    if found is None:
        raise SimulationError(
            f"no program '{wanted}'" if wanted else f"{NO_ARGUSD}, and name it with --argusd"
        )
    return found


def _end_with_parent() -> None:
    """Let the kernel end argusd when we are killed outright: it must not drive on unseen."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)


def _nobody() -> None:
    """Nobody wants to know."""


class Simulation:
    """argus-sim on a pseudo-terminal and argusd on that."""

    def __init__(self, sim_arguments: Sequence[str], argusd: str, argusd_arguments: Sequence[str]) -> None:
        self.broken: dict[str, str] = {}
        """The kind of fault of each sonar that is broken now, however it came to be."""
        self.changed: Callable[[], None] = _nobody
        """Called when another sonar is broken, or one no longer is."""
        self._sim_arguments = sim_arguments
        self._argusd_path = argusd
        self._argusd_arguments = argusd_arguments
        self._folder = Path(tempfile.mkdtemp(prefix="argus-monitor-"))
        self.address = Address(path=str(self._folder / "control"))
        self._sim: asyncio.subprocess.Process | None = None
        self._argusd: asyncio.subprocess.Process | None = None
        self._turn = asyncio.Lock()
        self._answers: asyncio.Queue[Message] = asyncio.Queue()
        self._listening: asyncio.Task[None] | None = None

    async def start(self) -> None:
        """Start both; SimulationError when one of them does not."""
        with (self._folder / "argus-sim.log").open("wb") as log:
            self._sim = await asyncio.create_subprocess_exec(
                *(sys.executable, "-m", "hil_sim.cli", "--orders", "--baud", str(BAUD)),
                *self._sim_arguments,
                stdin=asyncio.subprocess.PIPE,
                stdout=asyncio.subprocess.PIPE,
                stderr=log,
                process_group=0,
            )
        device = await self._first_line()
        self._listening = asyncio.create_task(self._listen())
        await self.order("watch")
        mode = () if "--passive" in self._argusd_arguments else ("--active",)
        arguments = ("--link", f"serial:{device}@{BAUD}", *mode, "--plain", "--control")
        with (self._folder / "argusd.log").open("wb") as log:
            self._argusd = await asyncio.create_subprocess_exec(
                self._argusd_path,
                *arguments,
                f"unix:{self.address.path}",
                *self._argusd_arguments,
                stdin=asyncio.subprocess.DEVNULL,
                stdout=asyncio.subprocess.DEVNULL,
                stderr=log,
                process_group=0,
                preexec_fn=_end_with_parent,
            )

    async def _first_line(self) -> str:
        assert self._sim is not None
        assert self._sim.stdout is not None
        try:
            async with asyncio.timeout(START_WITHIN_S):
                line = await self._sim.stdout.readline()
        except (TimeoutError, ValueError):
            line = b""
        if not line:
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(1.0):
                    await self._sim.wait()
            raise SimulationError(self._last_words("argus-sim"))
        return line.decode("utf-8", "replace").strip()

    async def _listen(self) -> None:
        """Take what the emulator says: answers to orders, and faults that begin and end by themselves."""
        assert self._sim is not None
        assert self._sim.stdout is not None
        with contextlib.suppress(OSError, ValueError):
            while line := await self._sim.stdout.readline():
                self._hear(json.loads(line))

    def _hear(self, message: Message) -> None:
        before, self.broken = self.broken, dict(message.get("broken", {}))
        if "order" in message:
            self._answers.put_nowait(message)
        if self.broken != before:
            self.changed()

    async def order(self, line: str) -> Message:
        """Give the emulator an order and return its answer."""
        async with self._turn:
            try:
                assert self._sim is not None
                assert self._sim.stdin is not None
                self._sim.stdin.write(line.encode() + b"\n")
                await self._sim.stdin.drain()
                async with asyncio.timeout(ANSWER_WITHIN_S):
                    return await self._answer_to(line)
            except (OSError, TimeoutError):
                return {"ok": False, "why": "refused", "say": "the emulator does not answer"}

    async def _answer_to(self, line: str) -> Message:
        """Return the answer to this order; one that came too late for an order before it is passed over."""
        while (answer := await self._answers.get()).get("order") != line:
            pass
        return answer

    async def ended(self) -> str:
        """Wait until one of them ends; return which, and its last words."""
        assert self._sim is not None
        assert self._argusd is not None
        waiting = {
            asyncio.create_task(self._sim.wait()): "argus-sim",
            asyncio.create_task(self._argusd.wait()): "argusd",
        }
        try:
            done, _ = await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
            return self._last_words(waiting[done.pop()])
        finally:
            for task in waiting:
                task.cancel()

    def _last_words(self, name: str) -> str:
        try:
            lines = (self._folder / f"{name}.log").read_text(errors="replace").strip().splitlines()
        except OSError:
            lines = []
        return f"{name} ended: {lines[-1].removeprefix(f'{name}: ') if lines else 'it said nothing'}"

    async def close(self) -> None:
        """End argusd first, so that it stops the robot, then the emulator."""
        if self._listening is not None:
            self._listening.cancel()
        for process in (self._argusd, self._sim):
            if process is not None and process.returncode is None:
                process.send_signal(signal.SIGTERM)
                try:
                    async with asyncio.timeout(END_WITHIN_S):
                        await process.wait()
                except TimeoutError:
                    process.kill()
                    await process.wait()
        shutil.rmtree(self._folder, ignore_errors=True)
