# SPDX-License-Identifier: MIT
"""Programs of ours in processes of their own, forked from one that has imported them: a start takes no half second.

What a test sees is what it sees of `subprocess`: real descriptors, signals and exit codes, the interpreter's own end.
The server is one process with one thread, so that a fork is safe whatever threads the test has.
"""

from __future__ import annotations

import atexit
import contextlib
import functools
import gc
import importlib
import io
import json
import os
import random
import selectors
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import IO, Any, Final, Self

MESSAGE_BYTES: Final = 1 << 18
CLOSED: Final = -1000
"""In place of a descriptor: the program has none there, as after `>&-` in a shell."""
ROOT: Final = Path(__file__).resolve().parents[2]


# ---- in the server ----------------------------------------------------------------------------------------------


class _Child(Exception):
    """Leaves the server's loop in the forked process, with what is to be run."""

    def __init__(self, request: dict[str, Any], fds: Sequence[int]) -> None:
        super().__init__()
        self.request, self.fds = request, fds


def _fork(client: socket.socket, request: dict[str, Any], fds: Sequence[int]) -> None:
    """Import what is asked for, so that the next need not, and fork."""
    for name in (request["module"], *request["preload"]):
        importlib.import_module(name)
    gc.freeze()
    pid = os.fork()
    if pid == 0:
        client.close()
        raise _Child(request, fds)
    for fd in fds:
        os.close(fd)
    client.send(json.dumps({"started": pid}).encode())


def _reap(client: socket.socket) -> None:
    """Tell the client of all that have ended."""
    with contextlib.suppress(ChildProcessError):
        while True:
            pid, status = os.waitpid(-1, os.WNOHANG)
            if pid == 0:
                return
            client.send(json.dumps({"ended": pid, "code": os.waitstatus_to_exitcode(status)}).encode())


def _serve(client: socket.socket) -> None:
    """Fork what the client asks for, until it is gone."""
    awake, wake = os.pipe()
    os.set_blocking(wake, False)
    signal.set_wakeup_fd(wake)
    signal.signal(signal.SIGCHLD, lambda number, frame: None)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with selectors.DefaultSelector() as ready:
            ready.register(client, selectors.EVENT_READ)
            ready.register(awake, selectors.EVENT_READ)
            while True:
                for key, _ in ready.select():
                    if key.fileobj is not client:
                        os.read(awake, 4096)
                        _reap(client)
                        continue
                    data, fds, _, _ = socket.recv_fds(client, MESSAGE_BYTES, 3)
                    if not data:
                        return
                    _fork(client, json.loads(data), fds)
    finally:
        signal.set_wakeup_fd(-1)
        os.close(awake)
        os.close(wake)


def _become(request: dict[str, Any], fds: Sequence[int]) -> None:
    """Be a fresh process, as far as a program can tell."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    # Under nohup it is ignored, and would be in the program, too.
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    for number, fd in enumerate(fds):
        os.dup2(fd, number)
        os.close(fd)
    os.chdir(request["cwd"])
    os.environ.clear()
    os.environ.update(request["env"])
    time.tzset()
    random.seed()
    sys.stdin = io.TextIOWrapper(io.BufferedReader(io.FileIO(0, closefd=False)), "utf-8")
    for name, number in (("stdout", 1), ("stderr", 2)):
        raw = io.FileIO(number, "w", closefd=False)
        errors = "backslashreplace" if name == "stderr" else "strict"
        line_buffering = name == "stderr" or os.isatty(number)
        stream = io.TextIOWrapper(io.BufferedWriter(raw), "utf-8", errors, line_buffering=line_buffering)
        setattr(sys, name, stream)
        setattr(sys, f"__{name}__", stream)
    for number in request["closed"]:
        os.close(number)
        name = ("stdin", "stdout", "stderr")[number]
        setattr(sys, name, None)
        setattr(sys, f"__{name}__", None)
    sys.argv = request["argv"]


def _main() -> int:
    """Serve; the forked process comes out here and ends as every program does."""
    client = socket.socket(fileno=int(sys.argv[1]))
    try:
        with client:
            _serve(client)
    except _Child as child:
        request, fds = child.request, child.fds
    else:
        return 0
    _become(request, fds)
    result = getattr(importlib.import_module(request["module"]), request["function"])()
    return int(result or 0)


# ---- in the test ------------------------------------------------------------------------------------------------


class Forked:
    """A running program: the part of subprocess.Popen that tests use."""

    def __init__(self, server: Server, args: Sequence[str], ours: Sequence[IO[bytes] | None]) -> None:
        self._server = server
        self.args = list(args)
        self.pid = 0
        self.returncode: int | None = None
        self.stdin, self.stdout, self.stderr = ours

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        if error != (None, None, None):
            self.kill()
        for pipe in (self.stdin, self.stdout, self.stderr):
            if pipe is not None:
                pipe.close()
        self.wait()

    def poll(self) -> int | None:
        """Return the exit code, None while it runs."""
        self._server.hear(0)
        return self.returncode

    def wait(self, timeout: float | None = None) -> int:
        """Wait until it has ended; return the exit code."""
        until = None if timeout is None else time.monotonic() + timeout
        while self.poll() is None:
            left = 1.0 if until is None else until - time.monotonic()
            if left <= 0:
                raise subprocess.TimeoutExpired(self.args, timeout or 0.0)
            self._server.hear(min(left, 1.0))
        assert self.returncode is not None
        return self.returncode

    def send_signal(self, number: int) -> None:
        """Send a signal unless it has ended."""
        if self.poll() is None:
            os.kill(self.pid, number)

    def terminate(self) -> None:
        """Send SIGTERM."""
        self.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        """Send SIGKILL."""
        self.send_signal(signal.SIGKILL)

    def communicate(self, given: bytes | None = None, timeout: float | None = None) -> tuple[bytes, bytes]:
        """Give it its input, take all of its output, and wait for its end."""
        taken: list[bytes] = [b"", b""]

        def take(index: int, pipe: IO[bytes]) -> None:
            taken[index] = pipe.read()
            pipe.close()

        def give(pipe: IO[bytes]) -> None:
            with contextlib.suppress(BrokenPipeError), pipe:
                pipe.write(given or b"")

        jobs = [
            threading.Thread(target=take, args=(index, pipe), daemon=True)
            for index, pipe in enumerate((self.stdout, self.stderr))
            if pipe is not None
        ]
        if self.stdin is not None:
            jobs.append(threading.Thread(target=give, args=(self.stdin,), daemon=True))
        for job in jobs:
            job.start()
        self.wait(timeout)
        for job in jobs:
            job.join(timeout)
        return taken[0], taken[1]


class Server:
    """The process that forks, and what it tells of those that it forked."""

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._running: dict[int, Forked] = {}
        self._socket, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        for end in (self._socket, theirs):
            end.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 2 * MESSAGE_BYTES)
        env = {**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{ROOT / 'tools'}"}
        with theirs:
            command = [sys.executable, "-P", str(Path(__file__).resolve()), str(theirs.fileno())]
            self._process = subprocess.Popen(command, env=env, pass_fds=[theirs.fileno()])
        atexit.register(self.close)

    def close(self) -> None:
        """End the server; its time is counted as ours then."""
        self._socket.close()
        self._process.wait()

    def hear(self, timeout_s: float) -> None:
        """Take what the server has to tell, waiting for TIMEOUT_S at most."""
        with self._lock, selectors.DefaultSelector() as ready:
            ready.register(self._socket, selectors.EVENT_READ)
            while ready.select(timeout_s):
                self._take()
                timeout_s = 0

    def _take(self) -> int:
        """Take one message; return the process it tells of."""
        data = self._socket.recv(MESSAGE_BYTES)
        assert data, "the server of tests/tools/forks.py died"
        told = json.loads(data)
        if "ended" in told:
            self._running.pop(told["ended"]).returncode = told["code"]
            return 0
        return int(told["started"])

    def start(self, forked: Forked, request: dict[str, Any], fds: Sequence[int]) -> None:
        """Have it forked."""
        with self._lock:
            socket.send_fds(self._socket, [json.dumps(request).encode()], fds)
            while not forked.pid:
                forked.pid = self._take()
            self._running[forked.pid] = forked


@functools.cache
def _server(owner: int) -> Server:
    """Return the server of process OWNER: one that was forked from us makes its own."""
    del owner
    return Server()


def start(
    target: str,
    *arguments: str | Path,
    stdin: int | None = None,
    stdout: int | IO[bytes] | None = None,
    stderr: int | IO[bytes] | None = None,
    env: Mapping[str, str] | None = None,
    cwd: Path | None = None,
    preload: Sequence[str] = (),
) -> Forked:
    """Run TARGET, "module:function", as a program; the rest is as in subprocess.Popen, but without STDIN it has none.

    PRELOAD names what the program imports late.
    """
    module, _, function = target.partition(":")
    theirs: list[int] = []
    close: list[int] = []
    ours: list[IO[bytes] | None] = []
    asked = (subprocess.DEVNULL if stdin is None else stdin, stdout, stderr)
    for number, given in enumerate(asked):
        mine: IO[bytes] | None = None
        if given == subprocess.PIPE:
            read, write = os.pipe()
            theirs.append(read if number == 0 else write)
            mine = os.fdopen(write, "wb") if number == 0 else os.fdopen(read, "rb")
            close.append(theirs[-1])
        elif given in (subprocess.DEVNULL, CLOSED):
            theirs.append(os.open(os.devnull, os.O_RDWR))
            close.append(theirs[-1])
        elif given == subprocess.STDOUT:
            theirs.append(theirs[1])
        elif given is None:
            theirs.append(number)
        else:
            theirs.append(given if isinstance(given, int) else given.fileno())
        ours.append(mine)
    program = module.partition(".")[0]
    argv = [program, *map(str, arguments)]
    environment = dict(os.environ if env is None else env)
    request = {
        "module": module,
        "function": function,
        "argv": argv,
        "env": environment,
        "cwd": str(cwd or Path.cwd()),
        "preload": list(preload),
        "closed": [number for number, given in enumerate(asked) if given == CLOSED],
    }
    server = _server(os.getpid())
    forked = Forked(server, argv, ours)
    try:
        server.start(forked, request, theirs)
    finally:
        for fd in close:
            os.close(fd)
    return forked


def run(
    target: str,
    *arguments: str | Path,
    given: bytes | None = None,
    timeout: float = 600.0,
    env: Mapping[str, str] | None = None,
    cwd: Path | None = None,
    preload: Sequence[str] = (),
) -> subprocess.CompletedProcess[bytes]:
    """Run TARGET to its end with GIVEN as its input; return what it said and its exit code."""
    stdin = subprocess.DEVNULL if given is None else subprocess.PIPE
    pipe = subprocess.PIPE
    forked = start(
        target, *arguments, stdin=stdin, stdout=pipe, stderr=pipe, env=env, cwd=cwd, preload=preload
    )
    try:
        out, err = forked.communicate(given, timeout)
    except subprocess.TimeoutExpired:
        forked.kill()
        raise
    return subprocess.CompletedProcess(forked.args, forked.wait(), out, err)


def run_text(
    target: str, *arguments: str | Path, env: Mapping[str, str] | None = None, cwd: Path | None = None
) -> subprocess.CompletedProcess[str]:
    """Run TARGET to its end; return what it said as text."""
    done = run(target, *arguments, env=env, cwd=cwd)
    return subprocess.CompletedProcess(done.args, done.returncode, done.stdout.decode(), done.stderr.decode())


if __name__ == "__main__":
    sys.exit(_main())
