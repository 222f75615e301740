# SPDX-License-Identifier: MIT
"""Rule: bad input gets one line and exit code 2, what cannot start one line and 3, and nothing is left running."""

from __future__ import annotations

import socket
import subprocess
import sys
from pathlib import Path

import pytest
from argus_tools.monitor import cli
from argus_tools.monitor.cli import main, read_token
from argus_tools.monitor.sim import SimulationError, find_argusd

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
        (["--connect", "unix:/x", "--argusd", "/bin/true"], "--argusd goes with --sim"),
        (["--connect", "unix:/x", "--token", "/does/not/exist"], "/does/not/exist: No such file"),
        (["--connect", "unix:/x", "--tui"], "--tui needs a terminal"),
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


def test_an_argusd_that_ends_at_once_ends_all(tmp_path: Path) -> None:
    argusd = tmp_path / "argusd"
    argusd.write_text("#!/bin/sh\necho 'argusd: no such day' >&2\nexit 2\n")
    argusd.chmod(0o755)
    command = [
        sys.executable,
        "-m",
        "argus_tools.monitor.cli",
        "--sim",
        "--port",
        "0",
        "--argusd",
        str(argusd),
    ]
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        timeout=300,
        cwd=ROOT,
        env={"PYTHONPATH": f"{ROOT}:{ROOT / 'tools'}", "PATH": "/usr/bin:/bin", "TMPDIR": str(tmp_path)},
        check=False,
    )
    assert done.returncode == 3
    assert done.stderr.strip().splitlines() == ["argus-monitor: argusd ended: no such day"]
    assert [path.name for path in tmp_path.iterdir()] == ["argusd"], "the folder of the socket is removed"


def test_argusd_is_found_by_option_variable_and_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program = tmp_path / "argusd"
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    assert find_argusd(str(program)) == str(program)
    monkeypatch.setenv("ARGUS_ARGUSD", str(program))
    assert find_argusd(None) == str(program)
    monkeypatch.setenv("ARGUS_ARGUSD", str(tmp_path / "none"))
    with pytest.raises(SimulationError, match="no program"):
        find_argusd(None)
    monkeypatch.delenv("ARGUS_ARGUSD")
    monkeypatch.setattr("argus_tools.monitor.sim._ROOT", tmp_path / "elsewhere")
    monkeypatch.setenv("PATH", str(tmp_path))
    assert find_argusd(None) == str(program)


def test_without_aiohttp_it_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "aiohttp", None)
    monkeypatch.delitem(sys.modules, "argus_tools.monitor.server", raising=False)
    assert main(["--connect", "unix:/x", "--port", "0"]) == 3
    assert "argus-p3dx[monitor]" in one_line(capsys)
