# SPDX-License-Identifier: MIT
"""Rule: bad input gets one line and exit code 2, what cannot start one line and 3, and nothing is left running."""

from __future__ import annotations

import asyncio
import os
import pty
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import IO

import forks
import pytest
from argus_tools.monitor import cli, tui
from argus_tools.monitor.cli import main, read_token
from argus_tools.monitor.sim import Simulation, SimulationError, argusd_of

from hil_sim.cli.main import main as sim_main

ROOT = Path(__file__).resolve().parents[3]
TOKEN = "0123456789abcdef"


@pytest.fixture
def token_file(tmp_path: Path) -> Path:
    path = tmp_path / "token"
    path.write_text(f"{TOKEN}\n")
    path.chmod(0o600)
    return path


def one_line(capsys: pytest.CaptureFixture[str]) -> str:
    out, err = capsys.readouterr()
    assert out == ""
    (line,) = err.strip().splitlines()
    return line


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--connect", "nonsense"], "'nonsense' is not unix:PATH or tcp:HOST:PORT"),
        (["--connect", "unix:/x", "--world", "lab"], "unknown option '--world'"),
        (["--connect", "unix:/x", "--argusd", "/bin/true"], "--argusd goes with --sim or --tui"),
        (["--connect", "unix:/x", "--argusd-option=-v"], "--argusd-option goes with --sim"),
        (["--connect", "unix:/x", "--tui"], "--port does not go with --tui"),
        (["--connect", "unix:/x", "--token", "/does/not/exist"], "/does/not/exist: No such file"),
        (["--sim", "--tcp", "8101"], "--tcp does not go with --sim"),
        (["--sim", "--list-worlds"], "--list-worlds does not go with --sim"),
        (["--sim", "--robots", "2"], "one page shows one robot"),
        (["--sim", "--world", "atlantis"], "no world 'atlantis'"),
        (["--sim", "--fault", "off:99"], "is no sonar"),
    ],
)
def test_wrong_arguments(words: list[str], says: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*words, "--port", "0"]) == 2
    assert says in one_line(capsys)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ([], "--tui needs a terminal"),
        (["--argusd", "/bin/true"], "--tui needs a terminal"),
        (["--page-token", "/x"], "--page-token does not go with --tui"),
    ],
)
def test_wrong_arguments_of_the_screen(
    words: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["--connect", "unix:/x", "--tui", *words]) == 2
    assert says in one_line(capsys)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ([], "one of the arguments --connect --sim is required"),
        (["--sim", "--connect", "unix:/x"], "not allowed with"),
        (["--sim", "--port", "70000"], "'70000' is not a port"),
        (["--sim", "--speed", "3"], "unrecognized arguments: --speed"),
    ],
)
def test_arguments_that_no_parser_takes(
    words: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(words)
    assert ended.value.code == 2
    assert says in one_line(capsys)


def test_argus_sim_leads_here(capsys: pytest.CaptureFixture[str]) -> None:
    assert sim_main(["--monitor", "--world", "atlantis"]) == 2
    assert one_line(capsys).startswith("argus-monitor: no world 'atlantis'")


def test_a_token_is_read_from_a_file_that_is_ours_alone(token_file: Path) -> None:
    assert read_token(str(token_file)) == TOKEN


@pytest.mark.parametrize("mode", [0o640, 0o604, 0o620])
def test_a_token_that_others_may_read_is_refused(token_file: Path, mode: int) -> None:
    token_file.chmod(mode)
    with pytest.raises(cli.UsageError, match="chmod 600"):
        read_token(str(token_file))


@pytest.mark.parametrize("content", ["", "short\n", f"{'x' * 129}\n", "with blanks in it, many\n"])
def test_what_is_no_token_is_refused(token_file: Path, content: str) -> None:
    token_file.write_text(content)
    with pytest.raises(cli.UsageError, match="is no token"):
        read_token(str(token_file))


def test_a_port_that_is_taken(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        assert main(["--connect", "unix:/x", "--port", str(port)]) == 3
    assert f"port {port}" in one_line(capsys)


def test_an_argusd_that_is_not_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--sim", "--port", "0", "--argusd", str(tmp_path / "none")]) == 3
    assert f"no program '{tmp_path / 'none'}'" in one_line(capsys)


def fake_argusd(folder: Path, script: str) -> Path:
    argusd = folder / "argusd"
    argusd.write_text(f"#!/bin/sh\n{script}\n")
    argusd.chmod(0o755)
    return argusd


def start(folder: Path, stdout: IO[bytes], *words: str | Path) -> forks.Forked:
    """Start argus-monitor with its temporary files in a folder."""
    env = {"PYTHONPATH": f"{ROOT}:{ROOT / 'tools'}", "PATH": "/usr/bin:/bin", "TMPDIR": str(folder)}
    preload = ("argus_tools.monitor.server", "argus_tools.monitor.sim", "argus_tools.monitor.tui")
    return forks.start(
        "argus_tools.monitor.cli:main",
        *words,
        stdout=stdout,
        stderr=subprocess.PIPE,
        cwd=ROOT,
        env=env,
        preload=preload,
    )


@pytest.mark.parametrize("shown", [["--port", "0"], ["--tui"]], ids=["page", "screen"])
def test_an_argusd_that_ends_at_once_ends_all(shown: list[str], tmp_path: Path) -> None:
    argusd = fake_argusd(tmp_path, "echo 'argusd: no such day' >&2\nexit 2")
    terminal, ours = pty.openpty()
    with (
        os.fdopen(terminal),
        os.fdopen(ours, "rb") as stdout,
        start(tmp_path, stdout, "--sim", *shown, "--argusd", argusd) as monitor,
    ):
        _, said = monitor.communicate(timeout=300)
    assert monitor.returncode == 3
    assert said.decode().strip().splitlines() == ["argus-monitor: argusd ended: no such day"]
    assert [path.name for path in tmp_path.iterdir()] == ["argusd"], "the folder of the socket is removed"


def test_an_argusd_without_a_control_socket(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tui, "CONTROL_WITHIN_S", 0.2)
    argusd = fake_argusd(tmp_path, "exec sleep 60")

    async def beside() -> None:
        simulation = Simulation(["--world", "hall"], str(argusd), [])
        try:
            await tui.beside(simulation, str(argusd))
        finally:
            await simulation.close()

    with pytest.raises(SimulationError, match="argusd opened no control socket"):
        asyncio.run(beside())


SCREEN = """
[ "$1" != --attach ] || { echo $$ > "$TMPDIR/shown"; exec sleep 60; }
while [ "$1" != --control ]; do shift; done
: > "${2#unix:}"
exec sleep 60"""


@pytest.mark.tour(1)
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_a_simulation_with_its_screen(number: signal.Signals, tmp_path: Path) -> None:
    argusd, mark = fake_argusd(tmp_path, SCREEN), tmp_path / "shown"
    terminal, ours = pty.openpty()
    with (
        os.fdopen(terminal),
        os.fdopen(ours, "rb") as stdout,
        start(tmp_path, stdout, "--sim", "--tui", "--argusd", argusd) as child,
    ):
        until = time.monotonic() + 120
        while not (mark.exists() and mark.read_text()):
            assert time.monotonic() < until
            assert child.poll() is None
            time.sleep(0.05)
        child.send_signal(number)
        _, said = child.communicate(timeout=120)
    assert (child.returncode, said) == (0, b"")
    with pytest.raises(ProcessLookupError):
        os.kill(int(mark.read_text()), 0)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["argusd", "shown"]


def test_an_argusd_that_cannot_be_run_is_no_matter_of_the_port(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    argusd = tmp_path / "argusd"
    argusd.write_bytes(b"\x7fELF of another machine")
    argusd.chmod(0o755)
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    assert main(["--connect", "unix:/x", "--tui", "--argusd", str(argusd)]) == 3
    assert one_line(capsys) == "argus-monitor: Exec format error"


def test_argusd_is_found_by_option_variable_and_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program = tmp_path / "argusd"
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    assert argusd_of(str(program)) == str(program)
    monkeypatch.setenv("ARGUS_ARGUSD", str(program))
    assert argusd_of(None) == str(program)
    monkeypatch.setenv("ARGUS_ARGUSD", str(tmp_path / "none"))
    with pytest.raises(SimulationError, match="no program"):
        argusd_of(None)
    monkeypatch.delenv("ARGUS_ARGUSD")
    brought = tmp_path / "argus_tools/argusd"
    monkeypatch.setattr("hil_sim.program._NEAR", (tmp_path / "elsewhere", brought))
    monkeypatch.setenv("PATH", str(tmp_path))
    assert argusd_of(None) == str(program), "a wheel may have none"
    brought.parent.mkdir()
    shutil.copy(program, brought)
    assert argusd_of(None) == str(brought), "that of the wheel is of the same version as the page"


def test_where_no_argusd_is_it_says_how_to_get_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("ARGUS_ARGUSD", raising=False)
    monkeypatch.setattr("hil_sim.program._NEAR", (tmp_path / "none",))
    monkeypatch.setenv("PATH", str(tmp_path))
    assert main(["--sim", "--port", "0"]) == 3
    said = one_line(capsys)
    assert "Debian package argusd" in said
    assert "tools/dev build release" in said
    assert "--argusd" in said


def test_without_aiohttp_it_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "aiohttp", None)
    monkeypatch.delitem(sys.modules, "argus_tools.monitor.server", raising=False)
    assert main(["--connect", "unix:/x", "--port", "0"]) == 3
    assert "argus-p3dx[monitor]" in one_line(capsys)
