# SPDX-License-Identifier: MIT
"""Rule: argus-sim prints the address alone, serves it, cleans up when told to end, and refuses bad input in
one line with exit code 2."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import forks
import pytest
from doubles import Port, cmd, connect, make_robot, sips

from hil_sim.arcos import ConfigPac, Packet, Sip, Unframer, decode
from hil_sim.cli.arguments import parser
from hil_sim.cli.choose import scenario_of
from hil_sim.cli.main import main
from hil_sim.cli.serve import _lateness
from hil_sim.links.loop import Loop
from hil_sim.links.tcp import TcpLink
from hil_sim.record.truth import TruthRecord
from hil_sim.robot.report import sip
from hil_sim.scenario.build import build_robot
from hil_sim.scenario.scenario import Scenario, scenario_names
from hil_sim.server.server import ArcosServer
from hil_sim.world.files import load_world, world_names

ROOT = Path(__file__).parents[2]
WORLD = "demo"
ARGUS_SIM = "hil_sim.cli.main:main"


def command(*arguments: str) -> list[str]:
    return [sys.executable, "-m", "hil_sim.cli", *arguments]


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    return forks.run_text(ARGUS_SIM, *arguments, cwd=ROOT)


@contextlib.contextmanager
def simulator(*arguments: str) -> Iterator[tuple[forks.Forked, str]]:
    pipe = subprocess.PIPE
    with forks.start(ARGUS_SIM, *arguments, cwd=ROOT, stdout=pipe, stderr=pipe) as process:
        try:
            yield process, line_of(process)
        finally:
            process.kill()


def line_of(process: forks.Forked) -> str:
    """The next line of its output."""
    assert process.stdout is not None
    return process.stdout.readline().decode().strip()


def code_of(arguments: list[str]) -> int:
    """Run argus-sim in this process; return its exit code."""
    try:
        return main(arguments)
    except SystemExit as error:
        return int(error.code or 0)


def end(process: forks.Forked, number: int) -> tuple[int, str, str]:
    process.send_signal(number)
    out, error = (said.decode() for said in process.communicate(timeout=600))
    said = [line for line in error.splitlines(keepends=True) if "the host was late" not in line]
    return process.wait(), out, "".join(said)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_robot_on_a_pty_with_link_name_and_truth(tmp_path: Path, number: int) -> None:
    link, truth = tmp_path / "robot", tmp_path / "truth.jsonl"
    with simulator("--world", WORLD, "--link-name", str(link), "--truth", str(truth)) as (process, path):
        assert str(link.readlink()) == path
        port = Port(str(link))
        connect(port)
        port.send(cmd("ENABLE", 1))
        port.send(cmd("VEL", 100))
        got = sips(port.read(20, 15))
        port.send(cmd("CLOSE", 1))
        port.read(0.5)
        port.close()
        assert len(got) >= 15
        assert got[-1].type == 0x33
        assert {n for packet in got for n, _ in packet.sonars} == set(range(16))
        code, out, error = end(process, number)
    assert (code, out, error) == (0, "", "")
    assert not os.path.lexists(link)
    records = [json.loads(line) for line in truth.read_text().splitlines()]
    assert records[0]["type"] == "meta"
    assert records[0]["world"] == WORLD
    kinds = {record["type"] for record in records}
    assert {"state", "sonar", "session"} <= kinds
    assert [r["state"] for r in records if r["type"] == "session"] == ["open", "closed"]
    states = [record for record in records if record["type"] == "state"]
    assert [round(b["t_s"] - a["t_s"], 3) for a, b in itertools.pairwise(states)] == [0.1] * (len(states) - 1)
    assert max(state["x_mm"] for state in states) > 50
    assert states[-1]["energy_j"]["total"] > states[0]["energy_j"]["total"]


def test_a_robot_on_tcp_shows_its_injected_faults(tmp_path: Path) -> None:
    truth = tmp_path / "truth.jsonl"
    faults = ["--fault", "off:3", "--fault", "bumper:2@0.5s-90s"]
    with simulator("--world", WORLD, "--tcp", "0", *faults, "--truth", str(truth)) as (process, address):
        host, _, number = address.rpartition(":")
        client = socket.create_connection((host, int(number)), timeout=600)
        unframer = Unframer()
        got: list[Packet] = []
        client.sendall(cmd("PULSE") + cmd("OPEN") + cmd("CLOSE") + cmd("OPEN"))
        while len(sips(got)) < 12:
            data = client.recv(4096)
            assert data
            got += [decode(item) for item in unframer.feed(data)]
        client.close()
        assert end(process, signal.SIGTERM)[0] == 0
    packets: list[Sip] = sips(got)
    third = [value for packet in packets for n, value in packet.sonars if n == 3]
    assert third
    assert set(third) == {5000}
    assert packets[-1].front_bumpers == 0b100
    records = [json.loads(line) for line in truth.read_text().splitlines()]
    begun = [(r["kind"], r["sonars"], r["active"]) for r in records if r["type"] == "fault"]
    assert ("off", [3], True) in begun
    assert ("bumper", [], True) in begun
    assert {r["fault"] for r in records if r["type"] == "sonar" and r["sonar"] == 3} == {"off"}


def test_the_duration_ends_it() -> None:
    started = time.monotonic()
    result = run("--world", WORLD, "--duration", "0.5", "-v")
    assert result.returncode == 0
    assert time.monotonic() - started > 0.5
    assert result.stdout.startswith("/dev/")
    assert result.stdout.count("\n") == 1
    assert "0 collisions" in result.stderr


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["--baud", "1234"], "9600"),
        (["--baud", "x"], "9600"),
        (["--world", "nowhere"], "nowhere"),
        (["--world", "missing.map"], "missing.map"),
        (["--scenario", "missing.yaml"], "missing.yaml"),
        (["--start", "1"], "X,Y,DEG"),
        (["--start", "a,b,c"], "X,Y,DEG"),
        (["--start", "nan,0,0"], "X,Y,DEG"),
        (
            ["--world", WORLD, "--start", "1e9,0,0", "--truth", "/nonexistent/dir/file"],
            "/nonexistent/dir/file",
        ),
        (["--start", "1,2,3,4"], "X,Y,DEG"),
        (["--start", "-1,x"], "X,Y,DEG"),
        (["--scenario", "nowhere"], "bad-day, box-ahead, demo"),
        (["--world", WORLD, "--truth", "/dev/full"], "make room"),
        (["--tcp", "http"], "PORT"),
        (["--tcp", "99999"], "PORT"),
        (["--serial", "/dev/ttyUSB0"], "DEV@BAUD"),
        (["--serial", "/dev/ttyUSB0@77"], "DEV@BAUD"),
        (["--tcp", "8101", "--serial", "/dev/x@9600"], "not allowed"),
        (["--world", WORLD, "--tcp", "0", "--link-name", "/tmp/x"], "--link-name"),
        (["--bumpers", "3"], "--bumpers"),
        (["--seed", "-1"], "--seed"),
        (["--fault", "explode:3"], "explode"),
        (["--fault", "off:99"], "99"),
        (["--crosstalk", "2"], "0 to 1"),
        (["--duration", "0"], "above 0"),
        (["--name", "x" * 21], "--name"),
        (["--subclass", "\u2603"], "--subclass"),
        (["--speed", "2"], "--speed"),
        (["--world", WORLD, "--link-name", "/nonexistent/dir/robot"], "--link-name"),
    ],
    ids=lambda value: " ".join(value)[:30] if isinstance(value, list) else None,
)
def test_bad_arguments_are_one_line_and_exit_2(
    arguments: list[str], word: str, capsys: pytest.CaptureFixture[str]
) -> None:
    if "--duration" not in arguments:
        arguments = [*arguments, "--duration", "0.1"]
    assert code_of(arguments) == 2
    out, error = capsys.readouterr()
    assert out == ""
    assert error.count("\n") == 1, error
    assert word in error


def test_links_that_cannot_be_opened_exit_1(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as busy:
        assert code_of(["--world", WORLD, "--tcp", str(busy.getsockname()[1])]) == 1
    assert code_of(["--world", WORLD, "--serial", "/dev/nonexistent@9600"]) == 1
    out, error = capsys.readouterr()
    assert out == ""
    assert error.count("\n") == 2
    assert "another program listens there" in error
    assert "/dev/nonexistent@9600: no such file; " in error


@pytest.mark.parametrize(
    ("device", "said"),
    [("/dev/null", "no serial port"), ("/dev", "no serial port"), ("/etc/passwd", "no serial port")],
)
def test_what_is_no_uart_is_told(device: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert code_of(["--world", WORLD, "--serial", f"{device}@9600"]) == 1
    assert said in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "start"),
    [
        (["--start", "-500,300"], [-500, 300, 0]),
        (["--start", "-500,-300,-90"], [-500, -300, -90]),
        (["--start=-500,300,45"], [-500, 300, 45]),
        (["--start", "-.5,1"], [-0.5, 1, 0]),
        (["--start", "200,-100"], [200, -100, 0]),
    ],
)
def test_a_start_may_be_negative(words: list[str], start: list[float], tmp_path: Path) -> None:
    truth = tmp_path / "truth"
    assert code_of(["--world", "hall", *words, "--truth", str(truth), "--duration", "0.1"]) == 0
    assert json.loads(truth.read_text().splitlines()[0])["start"] == start


@pytest.mark.parametrize(
    ("words", "robot"),
    [
        (["--subclass", "amigo-sh"], "amigo-sh"),
        (["--subclass", "p3at-sh"], "p3at-sh"),
        (["--subclass", "peoplebot-sh", "--scenario", "demo"], "peoplebot-sh"),
        (["--subclass", "amigo-sh", "--robot", "p3dx-sh"], "p3dx-sh"),
        (["--subclass", "powerbot-sh"], "p3dx-sh"),
        (["--subclass", "p3dx"], "p3dx-sh"),
    ],
)
def test_a_known_subclass_is_that_robot_unless_another_is_asked_for(words: list[str], robot: str) -> None:
    scenario = scenario_of(parser().parse_args(words))
    assert scenario.robot == robot


def test_an_amigobot_by_its_subclass_has_its_own_sonars_and_name(tmp_path: Path) -> None:
    truth = tmp_path / "truth"
    words = ["--world", "hall", "--subclass", "amigo-sh", "--truth", str(truth), "--duration", "0.1"]
    assert code_of(words) == 0
    assert json.loads(truth.read_text().splitlines()[0])["robot"] == "amigo-sh"


def test_an_option_without_its_name_says_which_there_are(capsys: pytest.CaptureFixture[str]) -> None:
    for option, names in (("--scenario", scenario_names()), ("--world", world_names())):
        assert code_of([option]) == 2
        line = capsys.readouterr().err
        assert "expected one argument: " + ", ".join(names) in line
        assert line.count("\n") == 1
    assert code_of(["--help"]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert all(name in told for name in scenario_names())


@pytest.mark.parametrize("start", ["99999,0", "-99999,0,90", "0,1e6", "0,-20000", "1e9,1e9,0"])
def test_a_start_outside_of_the_world_is_refused(start: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert code_of(["--world", WORLD, f"--start={start}", "--duration", "0.1"]) == 2
    assert f"outside of world {WORLD} (x " in capsys.readouterr().err


def test_a_disk_that_fills_up_is_told_once_and_the_robot_goes_on(tmp_path: Path) -> None:
    said: list[str] = []
    record = TruthRecord(tmp_path / "truth", {"seed": 1}, said.append)
    record("state", {"t_s": 0.1})
    os.dup2(os.open("/dev/full", os.O_WRONLY), record.fileno())
    for _ in range(3):
        record("state", {"t_s": 0.2})
    record.close()
    assert len(said) == 1
    assert "the truth record ends here (No space left on device); the robot goes on" in said[0]
    assert [json.loads(line)["type"] for line in (tmp_path / "truth").read_text().splitlines()] == [
        "meta",
        "state",
    ]


@pytest.mark.parametrize(
    "words", [["--help"], ["--list-worlds"], ["--list-faults"], ["--world", "demo"], ["bench"]]
)
def test_a_terminal_that_has_ascii_only(words: list[str]) -> None:
    environment = {
        "PATH": os.environ["PATH"],
        "LANG": "C",
        "LC_ALL": "C",
        "PYTHONUTF8": "0",
        "PYTHONIOENCODING": "ascii",
    }
    words = [*words, "--duration", "0.1"] if words[0] == "--world" else words
    done = subprocess.run(
        command(*words), cwd=ROOT, capture_output=True, env=environment, check=False, timeout=600
    )
    assert b"Traceback" not in done.stderr
    assert done.returncode == (2 if words == ["bench"] else 0), done.stderr


def test_help_and_lists() -> None:
    help_text = run("--help").stdout
    assert "examples:" in help_text
    assert "exit codes:" in help_text
    assert WORLD in run("--list-worlds").stdout.split()
    assert "intermittent" in run("--list-faults").stdout


def test_a_start_inside_a_solid_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    x1, y1, x2, y2 = load_world(WORLD).segments[0]
    middle = f"--start={(x1 + x2) / 2:.0f},{(y1 + y2) / 2:.0f},0"
    assert code_of(["--world", WORLD, middle, "--duration", "0.1"]) == 2
    assert "choose another start" in capsys.readouterr().err


def test_the_same_seed_gives_the_same_noise(tmp_path: Path) -> None:
    def readings(seed: int) -> list[tuple[int, int]]:
        world = load_world(WORLD)
        robot = build_robot(Scenario(world=WORLD, seed=seed), world, world.start, None)
        robot.open()
        got: list[tuple[int, int]] = []
        for _ in range(20):
            robot.advance(100)
            got += sip(robot).sonars
        return got

    assert readings(5) == readings(5)
    assert readings(5) != readings(6)


def config_of(port: Port) -> ConfigPac:
    """The answer to CONFIG, however many SIPs a busy host lets pile up before it."""
    for _ in range(20):
        for packet in port.read(1, 8):
            if isinstance(packet, ConfigPac):
                return packet
    pytest.fail("no CONFIGpac within 20 s")


def test_several_robots_each_on_its_own_pty_with_its_own_name_and_seed(tmp_path: Path) -> None:
    link, truth = tmp_path / "robot", tmp_path / "truth.jsonl"
    arguments = (
        "--world",
        WORLD,
        "--robots",
        "3",
        "--link-name",
        str(link),
        "--truth",
        str(truth),
        "--seed",
        "7",
    )
    with simulator(*arguments) as (process, first):
        paths = [first] + [line_of(process) for _ in range(2)]
        links = [tmp_path / name for name in ("robot", "robot-2", "robot-3")]
        assert [str(item.readlink()) for item in links] == paths
        ports = [Port(path) for path in paths]
        names = []
        for port in ports:
            connect(port)
            port.send(cmd("CONFIG"))
            names.append(config_of(port).name)
        for port in ports:
            port.close()
        assert names == [b"P3DX_0001", b"P3DX_0002", b"P3DX_0003"]
        code, _, error = end(process, signal.SIGTERM)
        assert (code, error) == (0, "")
    seeds = [
        json.loads((tmp_path / f"truth{k}.jsonl").read_text().splitlines()[0])["seed"]
        for k in ("", "-2", "-3")
    ]
    assert seeds == [7, 8, 9]
    assert not link.is_symlink()


def test_several_robots_on_consecutive_ports() -> None:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        base = min(probe.getsockname()[1], 65000)
    with simulator("--world", WORLD, "--robots", "2", "--tcp", str(base)) as (process, first):
        if not first:
            pytest.skip("a port was taken by somebody else meanwhile")
        second = line_of(process)
        assert [first, second] == [f"127.0.0.1:{base}", f"127.0.0.1:{base + 1}"]
        for address in (first, second):
            host, _, port = address.rpartition(":")
            with socket.create_connection((host, int(port)), 120) as client:
                client.sendall(cmd("PULSE"))
                assert client.recv(64) == cmd("PULSE")


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["--robots", "0"], "from 1 to 64"),
        (["--robots", "2", "--serial", "/dev/null@9600"], "one UART serves one robot"),
        (["--robots", "3", "--tcp", "65534"], "no port left for robot 3"),
        (["--sip-cycle", "15"], "steps of 10"),
        (["--quirks", "nonsense"], "invalid choice"),
    ],
)
def test_wrong_arguments_of_several_robots(arguments: list[str], expected: str) -> None:
    done = run(*arguments)
    assert done.returncode == 2
    assert expected in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_commands_are_told_at_vv() -> None:
    with simulator("--world", WORLD, "-vv") as (process, path):
        port = Port(path)
        connect(port)
        port.send(cmd("BATTERYINFO", 1))
        port.read(5, 3)
        port.close()
        _, _, error = end(process, signal.SIGTERM)
    assert "BATTERYINFO (62) 1: ignored, no battery controller" in error


def test_a_host_that_was_late_is_told_in_one_line() -> None:
    def loop(turns: int, worst_ms: float) -> Loop:
        result = Loop(ArcosServer(make_robot()), TcpLink("127.0.0.1", 0))
        result.late_turns, result.late_max_ms = turns, worst_ms
        return result

    assert _lateness([loop(0, 99.0), loop(0, 3.0)]) == ""
    assert _lateness([loop(1, 101.2)]) == (
        "the host was late: 1 turn by more than 100 ms, at most 101 ms; timing in this run means nothing exact"
    )
    assert "17 turns by more than 100 ms, at most 562 ms" in _lateness([loop(5, 120.0), loop(12, 562.3)])


@pytest.mark.soak
def test_a_suspended_emulator_does_not_call_its_host_late(tmp_path: Path) -> None:
    truth = tmp_path / "truth.jsonl"
    with simulator("--world", WORLD, "--truth", str(truth)) as (process, _):
        for number in (signal.SIGSTOP, signal.SIGCONT):
            time.sleep(3.0 if number == signal.SIGCONT else 1.0)
            process.send_signal(number)
        time.sleep(0.5)
        end(process, signal.SIGTERM)
    records = [json.loads(line) for line in truth.read_text().splitlines()]
    assert [r for r in records if r["type"] == "late" and r["late_ms"] > 2500] == []
