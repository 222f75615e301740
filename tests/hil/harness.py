# SPDX-License-Identifier: MIT
"""The test bench: argus-sim and argusd as processes on a pty, what both say, and a tap on the wire."""

from __future__ import annotations

import contextlib
import json
import os
import select
import selectors
import shlex
import signal
import socket
import struct
import subprocess
import sys
import termios
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any, Final, TypeVar

import serial
import yaml
from forks import Forked, start

from hil_sim.arcos import COMMAND, Command, Unframer
from hil_sim.demo.runner import make_punctual

ROOT: Final = Path(__file__).resolve().parents[2]
PYTHON: Final = ROOT / ".venv/bin/python"
SIM: Final = ROOT / ".venv/bin/argus-sim"
ARGUSD: Final = Path(os.environ.get("ARGUS_ARGUSD", ROOT / "build/release/argusd"))
BAUD: Final = 9600
SIP_S: Final = 0.1
REST_MM_S: Final = 1.0
REST_DEG_S: Final = 0.5
POLL_S: Final = 0.05

# A guard against what hangs, not a rule: what is waited for comes within seconds where the host is not busy.
PATIENCE_S: Final = 180.0

Record = dict[str, Any]
T = TypeVar("T")


class HilFailure(AssertionError):
    """Something did not happen in time, or a program ended that should not."""


def wait_for(what: str, probe: Callable[[], T], timeout_s: float) -> T:
    """Poll until `probe()` is true and return its value."""
    until = time.monotonic() + timeout_s
    while True:
        value = probe()
        if value:
            return value
        if time.monotonic() > until:
            raise HilFailure(f"not within {timeout_s:g} s: {what}")
        time.sleep(POLL_S)


def terminate(process: subprocess.Popen[bytes] | Forked, grace_s: float = 60.0) -> None:
    """End a process of ours, by force if it must be."""
    if process.poll() is None:
        process.send_signal(signal.SIGCONT)
        process.terminate()
        try:
            process.wait(grace_s)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


class Sim:
    """A running argus-sim and its truth record."""

    def __init__(self, arguments: Sequence[str], truth: Path, log: Path) -> None:
        self.command = [str(SIM), *arguments, "--truth", str(truth)]
        self.truth_path = truth
        self.log_path = log
        self.records: list[Record] = []
        self._rest = b""
        self._file: IO[bytes] | None = None
        with log.open("wb") as errors:
            self.process = start(
                "hil_sim.cli.main:main", *self.command[1:], stdout=subprocess.PIPE, stderr=errors
            )
        make_punctual(self.process.pid)
        self.address = self._first_line()

    def _first_line(self) -> str:
        assert self.process.stdout is not None
        with selectors.DefaultSelector() as ready:
            ready.register(self.process.stdout, selectors.EVENT_READ)
            if not ready.select(PATIENCE_S):
                raise HilFailure("argus-sim named no device")
        line = self.process.stdout.readline().decode().strip()
        if not line:
            self.process.wait()
            raise HilFailure(f"argus-sim ended: {self.log_path.read_text(errors='replace').strip()}")
        return line

    def read(self) -> list[Record]:
        """Take what has been written to the truth record since; return all of it."""
        if self._file is None:
            self._file = self.truth_path.open("rb")
        self._rest += self._file.read()
        *lines, self._rest = self._rest.split(b"\n")
        self.records += [json.loads(line) for line in lines]
        return self.records

    def of(self, kind: str, after_s: float = -1.0) -> list[Record]:
        """Records of one type, later than `after_s`."""
        return [r for r in self.read() if r["type"] == kind and r.get("t_s", 0.0) > after_s]

    @property
    def now(self) -> Record:
        """The last state written."""
        states = self.of("state")
        return states[-1] if states else {"t_s": 0.0, "x_mm": 0.0, "y_mm": 0.0, "v_mm_s": 0.0, "w_deg_s": 0.0}

    @property
    def t_s(self) -> float:
        """Robot time."""
        return float(self.now["t_s"])

    def robot_time(self, unix_s: float) -> float:
        """Robot time at a wall-clock time."""
        (clock,) = self.of("clock")
        return float(unix_s - clock["unix_s"] + clock["t_s"])

    def wait(self, what: str, probe: Callable[[Record], Any], timeout_s: float = PATIENCE_S) -> Record:
        """Wait for a state of which `probe(state)` is true; the timeout is in robot time."""
        until = self.t_s + timeout_s
        at = len(self.records)
        give_up = time.monotonic() + 2 * timeout_s + PATIENCE_S
        while True:
            self.read()
            for record in self.records[at:]:
                if record["type"] == "state" and probe(record):
                    return record
            at = len(self.records)
            if self.process.poll() is not None:
                raise HilFailure(f"argus-sim ended while waiting for: {what}")
            if self.t_s > until or time.monotonic() > give_up:
                raise HilFailure(f"not within {timeout_s:g} s of robot time: {what}")
            time.sleep(POLL_S)

    def wait_rest(self, timeout_s: float = PATIENCE_S) -> Record:
        """Wait until the robot stands."""
        return self.wait("the robot stands", is_at_rest, timeout_s)

    def assert_no_collision(self) -> None:
        """The true body met no solid."""
        hits = self.of("collision")
        assert not hits, f"collision: {hits[0]}"

    def end(self) -> None:
        """End it."""
        terminate(self.process)

    def kill(self) -> None:
        """End it as a power cut does."""
        self.process.kill()
        self.process.wait()


def is_at_rest(state: Record) -> bool:
    """The robot of a state record stands."""
    return bool(abs(state["v_mm_s"]) <= REST_MM_S and abs(state["w_deg_s"]) <= REST_DEG_S)


def is_translating(state: Record) -> bool:
    """The robot of a state record drives ahead or back."""
    return abs(float(state["v_mm_s"])) > 5.0


def way_mm(a: Record, b: Record) -> float:
    """Straight line between two states."""
    return float(((a["x_mm"] - b["x_mm"]) ** 2 + (a["y_mm"] - b["y_mm"]) ** 2) ** 0.5)


class Argusd:
    """A running argusd and the events that it wrote, each with a wall clock (`unix`)."""

    def __init__(self, arguments: Sequence[str]) -> None:
        self.command = [str(ARGUSD), *arguments]
        self.events: list[Record] = []
        self.errors: list[str] = []
        self.process = subprocess.Popen(
            self.command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        make_punctual(self.process.pid)
        self.started_unix_s = time.time()
        self._threads = [
            threading.Thread(target=self._read, args=(self.process.stdout, self._event), daemon=True),
            threading.Thread(target=self._read, args=(self.process.stderr, self.errors.append), daemon=True),
        ]
        for thread in self._threads:
            thread.start()

    @staticmethod
    def _read(pipe: IO[bytes], take: Callable[[str], None]) -> None:
        for line in pipe:
            take(line.decode("utf-8", "replace").rstrip("\n"))

    def _event(self, line: str) -> None:
        try:
            event = json.loads(line)
        except ValueError:
            event = {"event": "NO_JSON", "line": line}
        event.setdefault("unix", time.time())
        self.events.append(event)

    def named(self, *names: str, **want: Any) -> list[Record]:
        """Events so far with one of the names whose fields equal `want`."""
        return [
            e for e in self.events
            if e["event"] in names and all(e.get(key) == value for key, value in want.items())
        ]  # fmt: skip

    @property
    def status(self) -> Record:
        """The last STATUS, empty before the first."""
        known = self.named("STATUS")
        return known[-1] if known else {}

    def wait(
        self,
        *names: str,
        timeout_s: float = PATIENCE_S,
        after_t: float = -1.0,
        after: Record | None = None,
        **want: Any,
    ) -> Record:
        """Wait for an event not earlier than `after_t` (argusd's clock) that is told later than the event `after`."""
        told = 0 if after is None else 1 + next(i for i, e in enumerate(self.events) if e is after)

        def probe() -> Record | None:
            later = {id(e) for e in self.events[told:]}
            found = [e for e in self.named(*names, **want) if e.get("t", 0.0) >= after_t and id(e) in later]
            if not found and self.process.poll() is not None and not any(t.is_alive() for t in self._threads):
                raise HilFailure(
                    f"argusd ended with {self.process.returncode} while waiting for {names} {want or ''}: "
                    f"{self.errors[-1:]}"
                )
            return found[0] if found else None

        return wait_for(f"event {' or '.join(names)} {want or ''}", probe, timeout_s) or {}

    def wait_exit(self, timeout_s: float = PATIENCE_S) -> int:
        """Wait until it has ended and all it said is read; return its exit code."""
        try:
            code = self.process.wait(timeout_s)
        except subprocess.TimeoutExpired:
            raise HilFailure(f"argusd did not end within {timeout_s:g} s") from None
        for thread in self._threads:
            thread.join(PATIENCE_S)
        return code

    def unix(self, event: Record) -> float:
        """Wall clock of an event, by argusd's own clock."""
        known = [e for e in self.named("STATUS") if "t" in e]
        if not known:
            return float(event["unix"])
        return float(event["t"] + min(e["unix"] - e["t"] for e in known))

    def signal(self, number: int) -> float:
        """Send a signal; return the wall clock."""
        now = time.time()
        self.process.send_signal(number)
        return now

    def end(self) -> None:
        """End it."""
        terminate(self.process)


@dataclass
class Heard:
    """One packet on the wire; `to_robot` tells the direction."""

    unix_s: float
    to_robot: bool
    data: bytes

    @property
    def name(self) -> str:
        """Name of the command, for packets to the robot."""
        return _COMMAND_NAME.get(self.data[0], str(self.data[0]))

    @property
    def value(self) -> int:
        """Integer argument of the command."""
        return Command.decode(self.data).value


_COMMAND_NAME: Final = {number: name for name, number in COMMAND.items() if not name.startswith("SIM")}


class Tap:
    """A cable to argus-sim that can be listened to and cut: a pty of its own, pumped to the robot's."""

    def __init__(self, device: str) -> None:
        self.heard: list[Heard] = []
        self.connected = True
        self._robot = serial.Serial(device, BAUD, timeout=0, exclusive=False)
        self._master, self._slave = os.openpty()
        self.address = os.ttyname(self._slave)
        attributes = termios.tcgetattr(self._slave)
        attributes[0] = attributes[1] = attributes[3] = 0
        termios.tcsetattr(self._slave, termios.TCSANOW, attributes)
        self._frames = {True: Unframer(), False: Unframer()}
        self._stop_r, self._stop_w = os.pipe()
        self._thread = threading.Thread(target=self._pump, daemon=True)
        self._thread.start()

    def _pump(self) -> None:
        with selectors.DefaultSelector() as ready:
            ready.register(self._master, selectors.EVENT_READ, True)
            ready.register(self._robot.fileno(), selectors.EVENT_READ, False)
            ready.register(self._stop_r, selectors.EVENT_READ, None)
            while True:
                for key, _ in ready.select():
                    if key.data is None:
                        return
                    self._carry(key.fd, to_robot=key.data)

    def _carry(self, source: int, *, to_robot: bool) -> None:
        try:
            data = os.read(source, 4096)
        except BlockingIOError:  # said to be ready, then flushed at the other end before it was read
            return
        if not self.connected:
            return
        now = time.time()
        self.heard += [Heard(now, to_robot, bytes(p)) for p in self._frames[to_robot].feed(data, now * 1000)]
        sink = self._robot.fileno() if to_robot else self._master
        while data:
            if select.select([self._stop_r], [sink], [])[0]:
                return
            with contextlib.suppress(BlockingIOError):
                data = data[os.write(sink, data) :]

    def commands(self, after_unix_s: float = 0.0) -> list[Heard]:
        """What argusd sent, oldest first."""
        return [h for h in self.heard if h.to_robot and h.unix_s > after_unix_s]

    def close(self) -> None:
        """Take the cable away."""
        os.write(self._stop_w, b"x")
        self._thread.join(PATIENCE_S)
        self._robot.close()
        for fd in (self._master, self._slave, self._stop_r, self._stop_w):
            with contextlib.suppress(OSError):
                os.close(fd)


@dataclass
class Bench:
    """Everything that one test started; ended, whatever happens, by `close`."""

    path: Path
    name: str
    sims: list[Sim] = field(default_factory=list)
    daemons: list[Argusd] = field(default_factory=list)
    taps: list[Tap] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    records: bool = False  # the link of each argusd is recorded, in these files
    recordings: list[Path] = field(default_factory=list)
    configs: list[dict[str, Any]] = field(default_factory=list)

    def sim(
        self, world: str, *faults: str, seed: int = 1, link: Sequence[str] | None = None,
        crosstalk: float = 0.0,
        extra: Sequence[str] = (),
    ) -> Sim:  # fmt: skip
        """Start an emulator with the faults given, on a pty behind `self.port` unless told otherwise."""
        n = len(self.sims)
        arguments = ["--world", world, "--seed", str(seed), "--crosstalk", str(crosstalk)]
        for fault in faults:
            arguments += ["--fault", fault]
        arguments += ["--link-name", str(self.port)] if link is None else list(link)
        sim = Sim([*arguments, *extra], self.path / f"truth{n}.jsonl", self.path / f"sim{n}.log")
        self.sims.append(sim)
        return sim

    @property
    def port(self) -> Path:
        """The stable name of the emulator's pty."""
        return self.path / "robot"

    def argusd(
        self,
        *arguments: str,
        link: str | None = None,
        config: dict[str, Any] | None = None,
        active: bool = True,
    ) -> Argusd:
        """Start argusd on the emulator's pty by the paper's rules, active, unless told otherwise."""
        words = ["--link", link or f"serial:{self.port}@{BAUD}", "--json", *arguments]
        if active:
            words.append("--active")
        settings = {"profile": "paper", **(config or {})}
        file = self.path / f"argusd{len(self.daemons)}.conf"
        file.write_text("".join(f"{key} = {value}\n" for key, value in settings.items()))
        words += ["--config", str(file)]
        recording = self.path / f"link{len(self.daemons)}.rec"
        if self.records:
            words += ["--record", str(recording)]
        daemon = Argusd(words)
        self.daemons.append(daemon)
        self.recordings.append(recording)
        robot = {"robot": words[words.index("--robot") + 1]} if "--robot" in words else {}
        self.configs.append(settings | robot)
        return daemon

    def tap(self) -> Tap:
        """Put a cable that can be cut before the emulator's pty."""
        tap = Tap(str(self.port))
        self.taps.append(tap)
        return tap

    def world(self, **content: Any) -> str:
        """Write a world file; return its path."""
        file = self.path / "world.yaml"
        file.write_text(yaml.safe_dump(content))
        return str(file)

    def dump(self) -> str:
        """How to make the failure again, and what happened last."""
        lines = [f"files: {self.path}", *self.notes]
        commands = [sim.command for sim in self.sims] + [daemon.command for daemon in self.daemons]
        lines += ["run: " + shlex.join(command) for command in commands]
        for sim in self.sims:
            with contextlib.suppress(Exception):
                sim.read()
                lines += _sim_lines(sim)
        for daemon in self.daemons:
            lines += _daemon_lines(daemon)
        for tap in self.taps:
            lines.append("last on the wire: " + " ".join(h.name for h in tap.commands()[-20:]))
        return "\n".join(lines)

    def close(self) -> None:
        """End all that was started, argusd first so that it stops the robot."""
        for daemon in self.daemons:
            daemon.end()
        for tap in self.taps:
            tap.close()
        self.taps.clear()
        for sim in self.sims:
            sim.end()


def _sim_lines(sim: Sim) -> Iterator[str]:
    rare = [r for r in sim.records if r["type"] not in ("meta", "state", "sonar", "clock", "late")]
    yield f"truth at {sim.t_s:.1f} s: {json.dumps({k: v for k, v in sim.now.items() if k != 'energy_j'})}"
    yield from (f"  truth {json.dumps(record)}" for record in rare[-15:])
    if late := [record["late_ms"] for record in sim.of("late")]:
        yield f"the host was late with {len(late)} turns of the robot, at most {max(late):.0f} ms"
    if log := sim.log_path.read_text(errors="replace").strip():
        yield f"argus-sim says: {log[-500:]}"


def _daemon_lines(daemon: Argusd) -> Iterator[str]:
    yield f"argusd: exit {daemon.process.poll()}, mode {daemon.status.get('mode')}"
    first = daemon.events[0]["unix"] if daemon.events else 0.0
    for e in [e for e in daemon.events if e["event"] != "STATUS"][-40:]:
        yield (
            f"  {e.get('t', -1):8.3f} ({e['unix'] - first:7.2f}) {e['event']} {e.get('name', '')} "
            f"{e.get('value', '')} {e.get('state', e.get('line', ''))}"
        )
    yield from (f"argusd says: {line}" for line in daemon.errors[-5:])


@contextlib.contextmanager
def turning_away(way: str, port: int = 0) -> Iterator[tuple[int, list[float]]]:
    """Serve a port as a busy server does; `way`: it closes, resets, or speaks and closes. Gives port and times."""
    taken: list[float] = []
    with socket.create_server(("127.0.0.1", port)) as listener:

        def serve() -> None:
            with contextlib.suppress(OSError):
                while True:
                    client, _ = listener.accept()
                    taken.append(time.monotonic())
                    if way == "resets":
                        client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                    elif way == "speaks":
                        client.sendall(b"Port already in use\r\n")
                    client.close()

        thread = threading.Thread(target=serve, daemon=True)
        thread.start()
        try:
            yield int(listener.getsockname()[1]), taken
        finally:
            listener.shutdown(socket.SHUT_RDWR)
            thread.join(PATIENCE_S)


def run_argusd(*arguments: str, timeout_s: float = 600.0) -> subprocess.CompletedProcess[str]:
    """Run argusd to its end."""
    return subprocess.run(
        [str(ARGUSD), *arguments], capture_output=True, text=True, timeout=timeout_s, check=False
    )


def run_python(*arguments: str, timeout_s: float) -> subprocess.CompletedProcess[str]:
    """Run a Python program of ours to its end."""
    command = [str(PYTHON) if PYTHON.exists() else sys.executable, *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=timeout_s, check=False, cwd=ROOT)
