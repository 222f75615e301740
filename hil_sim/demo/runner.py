# SPDX-License-Identifier: MIT
"""Runs one drive: the emulator on a pty and argusd on that pty, two processes, both recorded line by line."""

from __future__ import annotations

import contextlib
import json
import os
import selectors
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any, Final

from hil_sim.demo.judge import event_s, is_at_rest
from hil_sim.errors import SimError

BAUD: Final = 9600
POLL_S: Final = 0.03
_DEVICE_WITHIN_S: Final = 20.0
_SESSION_WITHIN_S: Final = 25.0
_AFTER_GOAL_S: Final = 1.0
_CLOSE_WITHIN_S: Final = 6.0
ENDING: Final = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
"""The signals that end a drive before its time; the children, in groups of their own, never get them."""


class CannotStart(SimError):
    """Something that the drive needs could not be started."""

    exit_code = 3


@dataclass(frozen=True)
class Setup:
    """What one drive is made of. `sim_arguments` never reach argusd; it gets the link, `course` and `config`."""

    out: Path
    argusd: Path
    sim_arguments: tuple[str, ...]
    course: Path
    config: Path
    timeout_s: float
    can: str = ""
    """The bus to drive over, as `argus-sim --can` has it; empty: a pty."""


@dataclass
class Recording:
    """Everything read so far from both programs, each line with the wall clock at which it was read (`wall_s`)."""

    truth: list[dict[str, Any]] = field(default_factory=list)
    events: list[dict[str, Any]] = field(default_factory=list)
    ended: str = ""
    opened_s: float | None = None
    robot_s: float = 0.0

    @property
    def journey_s(self) -> float:
        """Robot time since the session opened."""
        return 0.0 if self.opened_s is None else self.robot_s - self.opened_s


class Lines:
    """Splits what arrives in a file descriptor into whole lines."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._rest = b""

    def read(self) -> list[bytes]:
        """Return the complete lines that are there now; empty at the end of a file, too."""
        while True:
            try:
                data = os.read(self._descriptor, 1 << 16)
            except BlockingIOError:
                break
            self._rest += data
            if not data:
                break
        *lines, self._rest = self._rest.split(b"\n")
        return lines


def _parse(line: bytes, whose: str) -> dict[str, Any]:
    try:
        record = json.loads(line)
    except ValueError:
        record = None
    if not isinstance(record, dict):
        raise SimError(f"{whose} wrote a line that is no JSON object: {line[:80]!r}")
    return record


def _last_line(path: Path) -> str:
    with contextlib.suppress(OSError):
        lines = path.read_text(encoding="utf-8", errors="replace").strip().splitlines()
        if lines:
            return lines[-1]
    return "it said nothing"


def make_punctual(pid: int) -> None:
    """Let a program that lives in real time go before others; only where that is allowed, as to root, as a rule."""
    with contextlib.suppress(OSError, AttributeError):
        os.setpriority(os.PRIO_PROCESS, pid, -10)
    with contextlib.suppress(OSError, AttributeError):
        os.sched_setscheduler(pid, os.SCHED_RR | os.SCHED_RESET_ON_FORK, os.sched_param(1))


class Child:
    """A process of ours, in a process group of its own so that Ctrl-C reaches only us and we end it in order."""

    def __init__(self, name: str, arguments: Sequence[str | Path], log: Path) -> None:
        self.name = name
        self.log = log
        words = [str(argument) for argument in arguments]
        try:
            with log.open("wb") as errors:
                self.process = subprocess.Popen(
                    words,
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.PIPE,
                    stderr=errors,
                    process_group=0,
                )
        except OSError as error:
            raise CannotStart(
                f"{name}: {words[0]}: {error.strerror}; build it with tools/dev build release"
            ) from None
        make_punctual(self.process.pid)

    @property
    def output(self) -> IO[bytes]:
        """Its standard output."""
        assert self.process.stdout is not None
        return self.process.stdout

    def why_ended(self) -> str:
        """One line on how it ended."""
        return f"{self.name} ended with code {self.process.returncode}: {_last_line(self.log)}"

    def end(self) -> bool:
        """Ask it to end, and insist when it does not; True when it ended by itself."""
        if self.process.poll() is not None:
            return True
        self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(_CLOSE_WITHIN_S)
            return True
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            return False


class Run:
    """One drive from the start of both programs to the end of both."""

    def __init__(self, setup: Setup, watch: Callable[[Recording], None]) -> None:
        self.setup = setup
        self.watch = watch
        self.recording = Recording()
        self.children: list[Child] = []
        self.notes: list[str] = []
        self._selector = selectors.DefaultSelector()
        self._goal_s: float | None = None

    # ---- starting ----------------------------------------------------------------------------------------

    def _start_sim(self) -> str:
        program = Path(sys.executable).with_name("argus-sim")
        link = ["--can", self.setup.can] if self.setup.can else ["--baud", str(BAUD)]
        arguments: list[str | Path] = [program, *link, "--truth", self.setup.out / "truth.jsonl"]
        arguments += self.setup.sim_arguments
        sim = Child("argus-sim", arguments, self.setup.out / "argus-sim.log")
        self.children.append(sim)
        os.set_blocking(sim.output.fileno(), False)
        lines, until = Lines(sim.output.fileno()), time.monotonic() + _DEVICE_WITHIN_S
        while time.monotonic() < until:
            got = lines.read()
            if got:
                return got[0].decode()
            if sim.process.poll() is not None:
                raise CannotStart(sim.why_ended())
            time.sleep(POLL_S)
        raise CannotStart(f"argus-sim named no device within {_DEVICE_WITHIN_S:.0f} s: {_last_line(sim.log)}")

    def _start_argusd(self, device: str) -> Child:
        setup = self.setup
        link = f"can:{device}" if setup.can else f"serial:{device}@{BAUD}"
        arguments: list[str | Path] = [setup.argusd, "--link", link, "--active", "--json"]
        arguments += ["--course", setup.course, "--config", setup.config]
        argusd = Child("argusd", arguments, setup.out / "argusd.log")
        self.children.append(argusd)
        os.set_blocking(argusd.output.fileno(), False)
        self._selector.register(argusd.output, selectors.EVENT_READ)
        return argusd

    # ---- driving -----------------------------------------------------------------------------------------

    def _take_events(self, lines: Lines, keep: IO[str]) -> None:
        for line in lines.read():
            event = _parse(line, "argusd") | {"wall_s": time.monotonic()}
            self.recording.events.append(event)
            keep.write(json.dumps(event, separators=(",", ":")) + "\n")
            if event.get("event") == "GOAL_REACHED" and self._goal_s is None:
                self._goal_s = event_s(event)
            elif event.get("event") == "MISSION_FAILED":
                self.recording.ended = "argusd gave the course up"

    def _take_truth(self, lines: Lines) -> None:
        recording = self.recording
        for line in lines.read():
            record = _parse(line, "argus-sim") | {"wall_s": time.monotonic()}
            recording.truth.append(record)
            recording.robot_s = max(recording.robot_s, float(record.get("t_s", 0.0)))
            if (
                record.get("type") == "session"
                and record.get("state") == "open"
                and recording.opened_s is None
            ):
                recording.opened_s = float(record["t_s"])

    def _has_ended(self, started: float, goal_seen: float | None) -> bool:
        recording = self.recording
        for child in self.children:
            if child.process.poll() is not None:
                self._note_end_of(child, goal_seen)
        if not recording.ended:
            now = time.monotonic()
            if goal_seen is not None and now - goal_seen > _AFTER_GOAL_S and self._stands():
                recording.ended = "goal reached"
            elif recording.opened_s is None and now - started > _SESSION_WITHIN_S:
                raise CannotStart(
                    f"argusd opened no session within {_SESSION_WITHIN_S:.0f} s; see {self.setup.out}"
                )
            elif recording.journey_s > self.setup.timeout_s:
                recording.ended = f"no goal within {self.setup.timeout_s:.0f} s of robot time"
        return bool(recording.ended)

    def _note_end_of(self, child: Child, goal_seen: float | None) -> None:
        arrived = child.name == "argusd" and child.process.returncode == 0 and goal_seen is not None
        self.recording.ended = "goal reached" if arrived else child.why_ended()
        if self.recording.opened_s is None:
            raise CannotStart(child.why_ended())

    def _stands(self) -> bool:
        states = [record for record in self.recording.truth[-200:] if record.get("type") == "state"]
        return bool(states) and is_at_rest(states[-1])

    def _drive(self, argusd: Child) -> None:
        with (
            (self.setup.out / "truth.jsonl").open("rb") as truth_file,
            (self.setup.out / "events.jsonl").open("w", encoding="utf-8", buffering=1) as keep,
        ):
            events, truth = Lines(argusd.output.fileno()), Lines(truth_file.fileno())
            started, goal_seen = time.monotonic(), None
            while True:
                self._selector.select(POLL_S)
                self._take_events(events, keep)
                self._take_truth(truth)
                if self._goal_s is not None and goal_seen is None:
                    goal_seen = time.monotonic()
                self.watch(self.recording)
                if self._has_ended(started, goal_seen):
                    break
            self.close()
            self._take_events(events, keep)
            self._take_truth(truth)

    def __call__(self) -> Recording:
        """Drive; both programs have ended when this returns or raises."""
        try:
            device = self._start_sim()
            self._drive(self._start_argusd(device))
        finally:
            self.close()
            self._selector.close()
        return self.recording

    def close(self) -> None:
        """End argusd first, so that it stops the robot and closes its session, then the emulator.

        An impatient second Ctrl-C would leave one behind, so signals are ignored until then: 2 x 6 s at most.
        """
        before = {number: signal.signal(number, signal.SIG_IGN) for number in ENDING}
        try:
            for child in reversed(self.children):
                if not child.end():
                    late = f"did not end within {_CLOSE_WITHIN_S:.0f} s and was killed"
                    self.notes.append(f"{child.name} {late}")
            self.children.clear()
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
