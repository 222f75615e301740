# SPDX-License-Identifier: MIT
"""Rule: programs at the control socket watch and order, none of them ever holds up the robot, and what is injected
is seen as such everywhere."""

from __future__ import annotations

import json
import os
import re
import shlex
import signal
import socket
import subprocess
import time
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

import pytest
from argus_tools.chunks import ReadOptions
from argus_tools.control import Client, ControlError, Refused
from argus_tools.formats.record import FORMAT
from harness import ARGUSD, PATIENCE_S, ROOT, Argusd, Bench, wait_for
from rules import assert_reached
from test_screen import Terminal
from worlds import hall

ARGUSCTL = ROOT / ".venv/bin/argusctl"
MONITOR = ROOT / ".venv/bin/argus-monitor"
DOCS = ROOT / "docs/control.md"
MONITOR_DOCS = ROOT / "docs/monitor.md"
TOKEN = "a-token-that-nobody-logs-0123"


def place_of(bench: Bench) -> str:
    return f"unix:{bench.path}/control.sock"


def start(bench: Bench, *more: str, **options: Any) -> Argusd:
    argusd = bench.argusd("--control", place_of(bench), *more, **options)
    argusd.wait("HEALTH_CHECK")
    return argusd


def ctl(bench: Bench, *words: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"ARGUS_CONTROL": place_of(bench)}
    return subprocess.run(
        [str(ARGUSCTL), *words],
        env=environment,
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )


def test_an_injected_fault_is_diagnosed_told_everywhere_and_ends(bench: Bench) -> None:
    tape = bench.path / "argusd.rec"
    sim = bench.sim(bench.world(**hall()))
    argusd = start(bench, "--inject", "--record", str(tape))
    done = ctl(bench, "fail", "sonar", "3", "off", "--for", "4s")
    assert (done.returncode, done.stderr) == (0, "")
    begun = argusd.wait("INJECTED", name="sonar/front/03", value=1)
    argusd.wait("SONAR_DISABLED", name="sonar/front/03")
    argusd.wait("STATUS", injected=["", "", "", "off"] + [""] * 12)
    ended = argusd.wait("INJECTED", name="sonar/front/03", value=0)
    assert 3.9 < ended["t"] - begun["t"] < 60.0  # a busy host looks late, never early
    after = argusd.wait("STATUS", after_t=ended["t"])
    assert after["health"][3] == "DISABLED"
    assert after["injected"][3] == "off", "what was found of it is not marked any more"
    assert not [r for r in sim.read() if r["type"] == "fault"], "the robot itself is whole"
    assert ctl(bench, "quit").returncode == 0
    assert argusd.wait_exit() == 0
    with tape.open("rb") as stream:
        reader = FORMAT.reader(stream, ReadOptions(name=str(tape)))
        assert list(reader)
    told = [what for _, what in reader.damage]
    assert len(told) == 2
    assert told[0].startswith("argusd injects 'off' into sonar 3 for 4 s")
    assert told[1].startswith("argusd injects nothing into sonar 3 any more")


def test_an_injected_fault_is_no_history_of_the_sonar(bench: Bench) -> None:
    bench.sim(bench.world(**hall()))
    state = ("--state", str(bench.path / "state"))
    argusd = start(bench, "--inject", *state)
    assert any("read, not written" in line for line in argusd.errors)
    assert ctl(bench, "fail", "sonar", "3", "off", "--for", "3s").returncode == 0
    argusd.wait("SONAR_DISABLED", name="sonar/front/03")
    argusd.end()
    later = start(bench, *state)
    later.wait("HEALTH_CHECK")
    assert not later.named("SONAR_PROBATION", "SONAR_DISABLED")


def test_without_inject_nothing_is_injected(bench: Bench) -> None:
    bench.sim(bench.world(**hall()))
    argusd = start(bench)
    done = ctl(bench, "fail", "sonar", "3", "off")
    assert done.returncode == 1
    assert done.stderr == "argusctl: injection is not armed; start argusd with --inject (refused)\n"
    assert not argusd.named("INJECTED")


def _stalled(place: str) -> socket.socket:
    """Return a connection that asks for everything and reads nothing."""
    sock = socket.socket(socket.AF_UNIX)
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    sock.connect(place.removeprefix("unix:"))
    topics = ["events", "state", "readings", "evidence"]
    sock.sendall(json.dumps({"do": "watch", "topics": topics, "period_ms": 50}).encode() + b"\n")
    return sock


def test_ten_stalled_readers_hold_up_nobody(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()))
    argusd = start(bench)
    with ExitStack() as stack:
        for _ in range(10):
            stack.enter_context(_stalled(place_of(bench)))
        client = stack.enter_context(Client(place_of(bench)))
        client.watch("readings", "state")
        client.take()
        client.order("goto", x_mm=900, y_mm=0)
        sips: list[int] = []
        missions: list[str] = []
        until = time.monotonic() + PATIENCE_S
        while "reached" not in missions and time.monotonic() < until:
            message = client.message(PATIENCE_S)
            assert "lost" not in message, "a reader that reads misses nothing"
            if "readings" in message:
                sips.append(message["readings"]["sip"])
            else:
                missions.append(message["mission"])
        assert "reached" in missions
        assert sips == sorted(set(sips)), "in order, each once"
        # Two that a busy host hands over in one turn are one line; a reader that held it up would cost most of them.
        assert len(sips) > 0.9 * (sips[-1] - sips[0])
        assert len(sips) > 50
        argusd.wait("GOAL_REACHED")
    assert_reached(sim, 900)


def test_one_at_a_time_orders_and_a_replay_moves_nothing(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()))
    argusd = start(bench)
    with Client(place_of(bench)) as first:
        first.take()
        done = ctl(bench, "turn", "40")
        assert (done.returncode, "(taken)" in done.stderr) == (1, True)
        assert ctl(bench, "stop").returncode == 0, "whoever may speak may stop it"
        # After a stop it checks at rest; argusctl waits until it takes an order to move.
        done = ctl(bench, "turn", "40", "--force")
        assert (done.returncode, done.stderr) == (0, "")
        turned_deg = sim.of("state")[-1]["heading_deg"]
        assert 25 < turned_deg < 55
        with pytest.raises(Refused) as refusal:
            first.order("turn", deg=90)
        assert refusal.value.why == "stale_grant"
        assert not argusd.named("OPERATOR", value=5)[1:], "one turn was ordered"


def test_a_turn_that_another_stops_is_no_success(bench: Bench) -> None:
    bench.sim(bench.world(**hall()))
    argusd = start(bench)
    words = [str(ARGUSCTL), "--socket", place_of(bench), "turn", "170"]
    with subprocess.Popen(words, stderr=subprocess.PIPE, text=True) as turning:
        argusd.wait("OPERATOR", value=5)
        assert ctl(bench, "stop").returncode == 0
        _, said = turning.communicate(timeout=PATIENCE_S)
    assert turning.returncode == 1
    assert said == "argusctl: another order stopped the robot before it was done (stopped)\n"


@pytest.fixture
def token_file(bench: Bench) -> Path:
    path = bench.path / "token"
    path.write_text(TOKEN + "\n")
    path.chmod(0o600)
    return path


def test_over_tcp_the_token_counts_and_is_told_to_nobody(bench: Bench, token_file: Path) -> None:
    tape = bench.path / "argusd.rec"
    bench.sim(bench.world(**hall()))
    argusd = bench.argusd(
        "--control", "tcp:127.0.0.1:0", "--control-token", str(token_file), "--record", str(tape)
    )
    argusd.wait("HEALTH_CHECK")
    said = wait_for(
        "it says where it listens", lambda: re.search(r"tcp:\S+", "\n".join(argusd.errors)), PATIENCE_S
    )
    assert said is not None
    place = said.group().rstrip(";")
    host, _, port = place.removeprefix("tcp:").rpartition(":")
    request = f"GET /?t={TOKEN} HTTP/1.1\r\nHost: localhost:{port}\r\nOrigin: http://a.example\r\n\r\n"
    with socket.create_connection((host, int(port))) as browser:
        browser.settimeout(PATIENCE_S)
        assert browser.recv(4096).startswith(b'{"control":1')
        browser.sendall(request.encode())
        with suppress(ConnectionResetError):
            assert browser.recv(4096) == b""
    with pytest.raises(ControlError, match="token"):
        Client(place)
    with pytest.raises(Refused, match="wrong"):
        Client(place, TOKEN + "x")
    with Client(place, TOKEN) as client:
        assert client.request("status")["state"]["online"] is True
        client.take()
        client.order("quit")
    assert argusd.wait_exit() == 0
    assert any("1 wrong token" in line for line in argusd.errors)
    assert TOKEN not in json.dumps(argusd.events) + "\n".join(argusd.errors)
    assert TOKEN.encode() not in tape.read_bytes()


def test_a_killed_argusd_leaves_a_place_that_the_next_one_takes(bench: Bench) -> None:
    bench.sim(bench.world(**hall()))
    first = start(bench)
    first.process.kill()
    first.process.wait()
    with pytest.raises(ControlError, match="is argusd running there"):
        Client(place_of(bench))
    second = start(bench)
    second.wait("SESSION_OPEN")
    assert ctl(bench, "status").returncode == 0


def test_a_screen_is_attached_and_leaves(bench: Bench) -> None:
    bench.sim(bench.world(**hall()))
    argusd = start(bench, "--inject", active=False)
    terminal = Terminal(["--attach", place_of(bench)], "vt52", 80)
    try:
        terminal.wait_shown("IsNormal")
        terminal.wait_shown("HEALTHY")
        terminal.press("w")
        terminal.wait_shown("it is passive; order active first")
        terminal.press("nn")
        terminal.wait_shown("> sonar 2 is chosen")
        terminal.press(" ")
        terminal.wait_shown("PAUSED")
        with Client(place_of(bench)) as client:
            client.take(force=True)
            client.order("fail", sonar=5, kind="stuck", for_ms=60000)
            terminal.wait_shown("another connection has taken control")
            terminal.wait_shown("INJECTED FAULT")
        terminal.press("q")
        assert terminal.wait_exit() == 0
        assert terminal.is_as_before()
    finally:
        terminal.close()
    assert argusd.process.poll() is None


def test_a_screen_shows_that_argusd_hangs_and_that_it_goes_on(bench: Bench) -> None:
    bench.sim(bench.world(**hall()))
    argusd = start(bench, active=False)
    terminal = Terminal(["--attach", place_of(bench)], "vt52", 80)
    try:
        terminal.wait_shown("HEALTHY")
        argusd.process.send_signal(signal.SIGSTOP)
        terminal.wait_shown("NO NEWS")
        terminal.wait_shown("argusd reports nothing")
        argusd.process.send_signal(signal.SIGCONT)
        terminal.wait_shown("argusd reports again")
        terminal.wait_shown("online")
        # The screen is a process of its own: it shows as well that the one that feeds it hangs.
        terminal.process.send_signal(signal.SIGSTOP)
        terminal.wait_shown("NO NEWS")
        terminal.process.send_signal(signal.SIGCONT)
        terminal.wait_shown("online")
        terminal.press("q")
        assert terminal.wait_exit() == 0
    finally:
        argusd.process.send_signal(signal.SIGCONT)
        terminal.close()


@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGTERM])
def test_a_screen_waits_for_the_next_argusd(bench: Bench, end: signal.Signals) -> None:
    bench.sim(bench.world(**hall()))
    argusd = start(bench, active=False)
    terminal = Terminal(["--attach", place_of(bench)], "vt52", 80)
    try:
        terminal.wait_shown("HEALTHY")
        argusd.process.send_signal(end)
        terminal.wait_shown("NO NEWS")
        terminal.wait_shown("waiting for it, q leaves")
        terminal.press("w")
        terminal.wait_shown("there is no argusd to take this")
        argusd.process.wait()
        second = start(bench, active=False)
        second.wait("SESSION_OPEN")
        terminal.wait_shown("online")
        terminal.press("w")
        terminal.wait_shown("it is passive; order active first")
        terminal.press("q")
        assert terminal.wait_exit() == 0
        assert terminal.is_as_before()
    finally:
        terminal.close()


def test_a_stream_of_an_argusd_that_hangs_has_no_states_and_says_why(bench: Bench) -> None:
    bench.sim(bench.world(**hall()))
    argusd = start(bench, active=False)
    attached = subprocess.Popen(
        [str(ARGUSD), "--attach", place_of(bench), "--json", "--status", "200"],
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    watching = subprocess.Popen(
        [str(ARGUSCTL), "--socket", place_of(bench), "watch", "readings"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    try:
        assert attached.stdout is not None
        assert attached.stderr is not None
        assert watching.stderr is not None
        assert watching.stdout is not None
        assert attached.stdout.readline()
        assert watching.stdout.readline()
        argusd.process.send_signal(signal.SIGSTOP)
        assert "reports nothing" in attached.stderr.readline()
        assert "reports nothing" in watching.stderr.readline()
        argusd.process.send_signal(signal.SIGCONT)
        assert "reports again" in attached.stderr.readline()
        assert "reports again" in watching.stderr.readline()
        attached.send_signal(signal.SIGINT)
        lines = [json.loads(line) for line in attached.communicate(timeout=60)[0].splitlines()]
        times = [line["t"] for line in lines if line["event"] == "STATUS"]
        repeated = max(times.count(t) for t in times)
        assert repeated <= 10, "of the last state before the silence there are a few, not one for each period"
    finally:
        argusd.process.send_signal(signal.SIGCONT)
        for process in (attached, watching):
            process.kill()
            process.communicate()


def test_the_monitor_shows_that_screen_in_the_place_of_its_page(bench: Bench) -> None:
    bench.sim(bench.world(**hall()))
    argusd = start(bench, active=False)
    (line,) = re.findall(r"^    argus-monitor (.* --tui)$", MONITOR_DOCS.read_text(), re.MULTILINE)
    for words in (line.replace("unix:/tmp/argus.sock", place_of(bench)), "--sim --world hall --tui"):
        terminal = Terminal(shlex.split(words), "vt52", 80, MONITOR)
        try:
            terminal.wait_shown("IsNormal")
            terminal.wait_shown("HEALTHY")
            terminal.press("q")
            assert terminal.wait_exit() == 0
            assert terminal.is_as_before()
        finally:
            terminal.close()
    assert argusd.process.poll() is None


def test_a_signal_to_the_monitor_gives_the_terminal_back() -> None:
    terminal = Terminal(["--sim", "--world", "hall", "--tui"], "vt52", 80, MONITOR)
    try:
        terminal.wait_shown("IsNormal")
        terminal.process.send_signal(signal.SIGTERM)
        assert terminal.wait_exit() == 0
        assert terminal.is_as_before()
    finally:
        terminal.close()


def test_wrong_words_are_refused_in_one_line(bench: Bench) -> None:
    for words, part in {
        ("fail", "sonar", "3", "sad"): "invalid choice: 'sad'",
        ("fail", "sonar", "99", "off"): "not a whole number from 0 to 31",
        ("fail", "sonar", "3", "off", "--for", "1h"): "is no time from 1s to 600s",
        ("turn", "200"): "not a whole number from -180 to 180",
        ("goto", "1"): "is no point",
        (): "required",
    }.items():
        done = ctl(bench, *words)
        assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
        assert part in done.stderr
    done = ctl(bench, "status")
    assert (done.returncode, done.stdout) == (3, "")
    assert done.stderr.count("\n") == 1


def test_the_commands_of_the_manual_work(bench: Bench, token_file: Path) -> None:
    blocks = re.findall(r"(?:^    .*\n)+", DOCS.read_text(), re.MULTILINE)
    commands = [line.strip() for line in blocks[1].splitlines()]
    assert commands[0].startswith("export ARGUS_CONTROL=")
    assert len(commands) > 8
    bench.sim(bench.world(**hall()))
    first = shlex.split(blocks[0].strip())
    argusd = bench.argusd(*(place_of(bench) if word.startswith("unix:") else word for word in first[3:]))
    argusd.wait("HEALTH_CHECK")
    for command in commands[1:]:
        words = shlex.split(command)
        assert words[0] == "argusctl"
        done = ctl(bench, *words[1:])
        end_s = time.monotonic() + PATIENCE_S
        while "busy" in done.stderr and time.monotonic() < end_s:  # a person types slower than a robot brakes
            time.sleep(0.2)
            done = ctl(bench, *words[1:])
        assert (done.returncode, done.stderr) == (0, ""), command
    assert argusd.wait_exit() == 0
    other = [line.strip() for block in blocks[2:] for line in block.splitlines()]
    assert "argusctl fail sonar 3 stuck --for 30s" in other
    for words in (shlex.split(line) for line in other if line.startswith("argusctl")):
        assert ctl(bench, *words[1:]).returncode in (1, 3), "understood, but argusd is gone"


def block_with(word: str) -> list[str]:
    """The commands of the manual's block that has a word."""
    (block,) = (
        found for found in re.findall(r"(?:^    .*\n)+", DOCS.read_text(), re.MULTILINE) if word in found
    )
    return [line.strip() for line in block.splitlines()]


def test_the_commands_of_the_manual_with_a_token_work(bench: Bench) -> None:
    make, serve, ask = block_with("--control-token")
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = str(probe.getsockname()[1])
    subprocess.run(["sh", "-c", make], cwd=bench.path, check=True)
    bench.sim(bench.world(**hall()))
    words = [str(bench.path / "token") if word == "token" else word for word in shlex.split(serve)]
    assert words[:3] == ["argusd", "--link", "tcp:localhost"]
    argusd = bench.argusd(*(word.replace("8200", port) for word in words[3:]), active=False)
    argusd.wait("HEALTH_CHECK")
    program, *words = shlex.split(ask.replace("8200", port))
    assert program == "argusctl"
    done = subprocess.run(
        [str(ARGUSCTL), *words],
        cwd=bench.path,
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert "IDLE" in done.stdout
    token = (bench.path / "token").read_text().strip()
    assert not any(token in str(event) for event in argusd.events)
    assert not any(token in line for line in argusd.errors)


def test_the_program_of_the_manual_and_its_screen_work(bench: Bench) -> None:
    (program,) = re.findall(r"```python\n(.*?)```", DOCS.read_text(), re.DOTALL)
    bench.sim(bench.world(**hall()))
    start(bench)
    done = subprocess.run(
        [str(ROOT / ".venv/bin/python"), "-c", program.replace("unix:/tmp/argus.sock", place_of(bench))],
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("IDLE\n")
    name, *words = shlex.split(block_with("--attach")[0].replace("unix:/tmp/argus.sock", place_of(bench)))
    assert name == "argusd"
    terminal = Terminal(words, "vt52", 80)
    try:
        terminal.wait_shown("IsNormal")
        terminal.press("q")
        assert terminal.wait_exit() == 0
    finally:
        terminal.close()


def test_nothing_listens_beyond_this_machine(bench: Bench) -> None:
    # All ports that argusd can open, as the manuals have them; the kernel says where each listens.
    bench.sim(bench.world(**hall()))
    with ExitStack() as probes:
        found = [probes.enter_context(socket.create_server(("127.0.0.1", 0))) for _ in range(2)]
        control, guard = (probe.getsockname()[1] for probe in found)
    secret = bench.path / "secret"
    secret.write_text(f"{TOKEN}\n")
    secret.chmod(0o600)
    words = ["--control", f"tcp:localhost:{control}", "--control-token", str(secret)]
    argusd = bench.argusd(*words, "--guard", f"tcp:localhost:{guard}", active=False)
    argusd.wait("HEALTH_CHECK")
    rows = [
        line.split()
        for name in ("tcp", "tcp6")
        for line in Path(f"/proc/net/{name}").read_text().splitlines()[1:]
    ]
    at = {int(row[1].split(":")[1], 16): row[1].split(":")[0] for row in rows if row[3] == "0A"}
    loopback = {"0100007F", "00000000000000000000000001000000"}
    assert {at[control], at[guard]} <= loopback
    sockets = {str(link.readlink()) for link in Path(f"/proc/{argusd.process.pid}/fd").iterdir()}
    ours = {row[9] for row in rows if row[3] == "0A" and f"socket:[{row[9]}]" in sockets}
    assert len(ours) == 2, "and it listens nowhere else"
