# SPDX-License-Identifier: MIT
"""Rule: a client at a guard port finds the robot, drives it, hits nothing that a sonar sees, and is outlived safely."""

from __future__ import annotations

import contextlib
import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from runpy import run_path
from typing import Any, Final

import argus
import harness
import pytest
from harness import PATIENCE_S, ROOT, SIP_S, Argusd, Bench, is_at_rest, run_argusd, wait_for
from worlds import hall, hall_with_box

from hil_sim.arcos import COMMAND, Command, ConfigPac, EncoderPac, Sip, frame
from hil_sim.conformance.client import Client, Target, parse_target

SPEED_MM_S: Final = 300
NEAR_MM: Final = 700
TEXT: Final = (ROOT / "docs/guardian.md").read_text(encoding="utf-8")
PAGE_SAYS: Final = (
    Command.none(0), Command.none(1), Command.none(2), Command.none(COMMAND["OPEN"]),
    Command.integer(COMMAND["ENABLE"], 1), Command.integer(COMMAND["RVEL"], 30),
)  # fmt: skip
LOOKS: Final = 3
"""The sonar that the client of these tests goes by."""


def free_port() -> int:
    """Return a port that nobody listens on."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        return int(server.getsockname()[1])


def guarded(bench: Bench, *arguments: str, config: dict[str, Any] | None = None) -> tuple[Argusd, Target]:
    """Start argusd with a guard port; return where that is once the robot is checked."""
    port = free_port()
    words = ["--guard", f"tcp:127.0.0.1:{port}", *arguments]
    argusd = bench.argusd(*words, config={"profile": "argus", **(config or {})}, active=False)
    argusd.wait("HEALTH_CHECK")
    return argusd, parse_target(f"tcp:127.0.0.1:{port}")


@contextmanager
def session(target: Target, motors: bool = True) -> Iterator[Client]:
    """A client in a session."""
    client = Client(target, PATIENCE_S)
    try:
        client.start(motors=motors)
        yield client
    finally:
        client.close()


def drive_by_one_sonar(client: Client, seconds: float) -> None:
    """Ahead until the one sonar that it goes by reads something near, for so long by the robot's clock."""
    for _ in range(round(seconds / (5 * SIP_S))):
        client.command("VEL", SPEED_MM_S)
        for sip in client.sips(5):
            if any(number == LOOKS and reading < NEAR_MM for number, reading in sip.sonars):
                client.command("VEL", 0)
                client.sips(10)
                return


def test_the_robot_shows_itself_as_it_is(bench: Bench) -> None:
    bench.sim(bench.world(**hall()))
    argusd, target = guarded(bench)
    with session(target) as client:
        assert client.identity is not None
        assert client.identity.name.decode() == argusd.status["robot"]
        assert client.identity.subclass.decode() == argusd.status["subclass"]
        client.command("CONFIG", 1)
        assert isinstance(client.answer(ConfigPac), ConfigPac)
        client.command("ENCODER", 1)
        assert isinstance(client.answer(EncoderPac), EncoderPac)
        client.command("MOVE", 400)
        client.until("the way is driven", lambda sip: sip.x > 390, 60)
    argusd.wait("GUARD_CLOSED")
    assert not argusd.named("GUARD_SLOWED", "GUARD_HELD", "GUARD_REFUSED", "GUARD_LOST")


def test_with_its_sonar_dead_the_client_hits_the_box(bench: Bench) -> None:
    # What the guard is for: the same client at the robot itself.
    sim = bench.sim(bench.world(**hall_with_box(1700, LOOKS)), f"silent:{LOOKS}")
    with session(parse_target(f"serial:{bench.port}")) as client:
        drive_by_one_sonar(client, 10.0)
    assert sim.of("collision")


@pytest.mark.parametrize("readings", ["withhold", "cover"])
@pytest.mark.parametrize("fault", ["silent", "off"])
def test_with_the_guard_it_does_not(bench: Bench, fault: str, readings: str) -> None:
    sim = bench.sim(bench.world(**hall_with_box(1700, LOOKS)), f"{fault}:{LOOKS}")
    argusd, target = guarded(bench, "--guard-readings", readings)
    with session(target) as client:
        drive_by_one_sonar(client, 25.0)
        client.command("VEL", 0)
        sim.wait_rest()
    assert sim.now["x_mm"] > 600  # it was let on as far as the way is seen
    sim.assert_no_collision()
    assert argusd.named("GUARD_HELD", "GUARD_SLOWED", "GUARD_LOOKS")


def test_a_wall_ahead_and_one_behind(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()))
    argusd, target = guarded(bench)
    with session(target) as client:
        for speed in (600, -400):
            argusd.events.clear()
            for _ in range(90):
                client.command("VEL", speed)
                client.sips(2)
            argusd.wait("GUARD_HELD", value=1)
            assert is_at_rest(sim.now)
    sim.assert_no_collision()


def turned_deg(sim: harness.Sim, start_deg: float) -> float:
    """By how much the robot has truly turned."""
    return abs((float(sim.now["heading_deg"]) - start_deg + 180) % 360 - 180)


@pytest.mark.parametrize("command", ["DHEAD", "RVEL"])
@pytest.mark.parametrize("step", [1, 2, 10])
def test_no_step_turns_it_into_a_wall_beside_it(bench: Bench, command: str, step: int) -> None:
    # Half of the body is 190 to 212 mm: the wall stands some 52 mm beside it.
    sim = bench.sim(bench.world(**hall(half_width_mm=264)))
    argusd, target = guarded(bench)
    with session(target) as client:
        client.sips(5)
        start_deg = float(sim.now["heading_deg"])
        for _ in range(40):
            client.command(command, step)
            client.hear(0.25)
        assert turned_deg(sim, start_deg) <= 2.0
    sim.assert_no_collision()
    assert argusd.named("GUARD_TURN_HELD")


def test_no_flood_costs_a_sip(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall(length_mm=9000)))
    argusd, target = guarded(bench)
    with session(target) as client:
        client.command("VEL", 200)
        sim.wait("it drives", lambda state: state["v_mm_s"] > 190)
        floods = ("CONFIG", "PULSE", "TICKSMM", "DHEAD", "GETAUX", "DIGOUT", "VEL")
        burst = b"".join(frame(Command.integer(COMMAND[name], 1).data) for name in floods) * 10
        heard: list[float] = []
        until_s = sim.t_s + 5.0
        while sim.t_s < until_s:
            client.send(burst)
            heard += [packet.t_s for packet in client.hear(0.02) if isinstance(packet.packet, Sip)]
        assert len(heard) >= 48
        client.command("STOP")
        client.until("it stands", lambda sip: sip.left_vel <= 5, 50)
    assert argusd.named("GUARD_DROPPED")
    assert argusd.named("GUARD_REFUSED", value=COMMAND["TICKSMM"])
    assert not argusd.named("LINK_STALLED", "LINK_LOST")
    assert argusd.named("STATUS")[-1]["bad_checksums"] == 0


def test_a_client_that_is_killed_in_motion(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall(length_mm=9000)))
    argusd, target = guarded(bench)
    script = (
        "import sys; from hil_sim.conformance.client import Client, parse_target\n"
        "client = Client(parse_target(sys.argv[1]), 180.0); client.start(motors=True)\n"
        "while True: client.command('VEL', 300); client.sips(3)\n"
    )
    target_text = f"tcp:{target.host}:{target.port}"
    child = subprocess.Popen([sys.executable, "-c", script, target_text], cwd=ROOT)
    try:
        sim.wait("it drives", lambda state: state["v_mm_s"] > 290)
    finally:
        child.send_signal(signal.SIGKILL)
        child.wait()
    killed_s = sim.robot_time(time.time())
    lost = argusd.wait("GUARD_LOST")
    assert lost["value"] == 1
    rest = sim.wait_rest()
    # 300 mm/s at 600 mm/s2 take 0.5 s; the robot's own watchdog would have waited for 2.
    assert rest["t_s"] - killed_s < 2.0


def test_a_client_that_goes_silent(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall(length_mm=9000)))
    argusd, target = guarded(bench)
    with session(target) as client:
        client.command("VEL", 300)
        sim.wait("it drives", lambda state: state["v_mm_s"] > 290)
        client.pulses = False
        lost = argusd.wait("GUARD_LOST")
        assert lost["value"] == 2
        sim.wait_rest()
        client.sips(10)  # which still come
        client.pulses = True
        client.hear(2.0)
        assert is_at_rest(sim.now)  # nothing moves before it says so


def test_a_second_client_is_turned_away(bench: Bench) -> None:
    bench.sim(bench.world(**hall()))
    name = bench.path / "guard"
    argusd, target = guarded(bench, "--guard", f"pty:{name}")
    with session(target, motors=False) as client:
        with socket.create_connection((target.host, target.port), PATIENCE_S) as second:
            second.settimeout(PATIENCE_S)
            assert second.recv(10) == b""
        wait_for("it is said", lambda: any("turned away" in line for line in argusd.errors), PATIENCE_S)
        client.sips(5)
    argusd.wait("GUARD_CLOSED")
    argusd.events.clear()
    with session(parse_target(f"serial:{name}")) as client:  # the other port, the first one gone
        client.sips(5)
        assert client.identity is not None
    argusd.wait("GUARD_CLOSED")
    argusd.end()
    assert not name.is_symlink()


@pytest.mark.parametrize(
    "greeting",
    [
        b"POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://evil.example\r\n\r\n",
        b"GET / HTTP/1.1\r\nUpgrade: websocket\r\n\r\n",
        b"\x16\x03\x01\x02\x00\x01\x00",
        b"\x00",
    ],
    ids=["post", "websocket", "tls", "nul"],
)
def test_a_web_page_cannot_take_the_robot(bench: Bench, greeting: bytes) -> None:
    """A page may send packets of ARCOS as the body of a request to any port of this machine."""
    sim = bench.sim(bench.world(**hall()))
    argusd, target = guarded(bench, "--active", "--goal", "2000,0")
    argusd.wait("SESSION_OPEN")
    sim.wait("it drives by itself", lambda state: state["v_mm_s"] > 100)
    body = b"".join(frame(command.data) for command in PAGE_SAYS)
    with socket.create_connection((target.host, target.port), PATIENCE_S) as page:
        page.settimeout(PATIENCE_S)
        with contextlib.suppress(ConnectionError):
            page.sendall(greeting + body)
            assert page.recv(100) == b""
    wait_for("it is said", lambda: any("not ARCOS" in line for line in argusd.errors), PATIENCE_S)
    argusd.wait("GOAL_REACHED")
    assert not argusd.named("GUARD_OPEN", "GUARD_DRIVES", "PASSIVE")
    assert argusd.wait_exit() == 0


def test_a_pty_that_is_closed_stops_the_robot(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall(length_mm=9000)))
    name = bench.path / "guard"
    argusd, _ = guarded(bench, "--guard", f"pty:{name}")
    client = Client(parse_target(f"serial:{name}"), PATIENCE_S)
    client.start(motors=True)
    client.command("VEL", 300)
    sim.wait("it drives", lambda state: state["v_mm_s"] > 200)
    client.in_session = False  # without a word
    client.close()
    assert argusd.wait("GUARD_LOST")["value"] == 1
    sim.wait_rest()


def test_every_sip_and_no_other_reaches_the_client(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()))
    argusd, target = guarded(bench)
    with session(target) as client:
        heard = [sip.x for sip in client.sips(100)]
        assert len(heard) == 100
        assert client.damaged == 0
        statuses = argusd.named("STATUS")
        assert statuses[-1]["bad_checksums"] == 0
    assert sim.process.poll() is None


def test_no_packet_is_lost_by_the_measure_of_the_page() -> None:
    # For some seconds what docs/guardian.md tells of half an hour; how late they are is not asked on a busy host.
    found = run_path(str(ROOT / "tests/bench/guardian.py"))["measure"](4.0, ["--guard-readings", "cover"])
    for name, way in found.items():
        assert way.lost == 0, name
        assert len(way.took_ms) >= 35, name


def test_it_listens_where_it_may(tmp_path: Path) -> None:
    far = run_argusd("--link", "tcp:127.0.0.1:1", "--guard", "tcp:0.0.0.0:18999", "--wait", "1")
    assert far.returncode == 3  # no robot: the guard is not asked yet
    taken = tmp_path / "file"
    taken.write_text("mine")
    with socket.create_server(("127.0.0.1", 0)) as robot:
        link = f"tcp:127.0.0.1:{robot.getsockname()[1]}"
        for guard, code, say in (
            ("tcp:0.0.0.0:18999", 2, "--guard-beyond-loopback"),
            (f"pty:{taken}", 3, "it stays"),
            (f"pty:{tmp_path}/no/such", 3, "No such file"),
            (f"tcp:127.0.0.1:{robot.getsockname()[1]}", 3, "in use"),
        ):
            done = run_argusd("--link", link, "--guard", guard)
            assert (done.returncode, say in done.stderr) == (code, True), done.stderr
    assert taken.read_text() == "mine"


def test_the_commands_of_the_page(tmp_path: Path) -> None:
    (script,) = re.findall(r"```sh\n(.*?)```", TEXT, re.DOTALL)
    for port in ("8201", "8202"):
        script = script.replace(port, str(free_port()))
    path = os.pathsep.join([str(ROOT / ".venv/bin"), str(ROOT / "build/release"), os.environ["PATH"]])
    done = subprocess.run(
        ["bash", "-c", f"set -m\n{script}"],
        cwd=tmp_path,
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    events = [json.loads(line)["event"] for line in (tmp_path / "events.jsonl").read_text().splitlines()]
    assert "GUARD_OPEN" in events, done.stderr
    assert re.search(r"pass\s+handshake/three-syncs", done.stdout), done.stdout
    assert re.search(r"pass\s+packets/config", done.stdout), done.stdout


def test_the_first_command_of_the_page(bench: Bench) -> None:
    (line,) = re.findall(r"^    argusd (.*)$", TEXT, re.MULTILINE)
    bench.sim(bench.world(**hall()))
    name = bench.path / "ports"
    name.mkdir()
    known = {"/dev/ttyUSB0": str(bench.port), "8101": str(free_port()), "/run/argus": str(name)}
    for word, there in known.items():
        assert word in line
        line = line.replace(word, there)
    argusd = Argusd([*line.split(), "--json"])
    bench.daemons.append(argusd)
    argusd.wait("HEALTH_CHECK")
    for target in (f"tcp:127.0.0.1:{known['8101']}", f"serial:{name}/robot"):
        with session(parse_target(target), motors=False) as client:
            client.sips(5)


def test_every_event_of_the_guard_is_on_the_page() -> None:
    header = (ROOT / "firmware/include/argus/argus.h").read_text(encoding="utf-8")
    names = set(re.findall(r"X\(\d+, (GUARD_\w+),", header))
    assert len(names) == 12
    assert names - set(re.findall(r"GUARD_\w+", TEXT)) <= {"GUARD_OPEN", "GUARD_CLOSED"}


def test_the_python_client_of_the_page_drives_and_meets_nothing(bench: Bench) -> None:
    sim = bench.sim("box-ahead")
    _, target = guarded(bench)
    place = f"tcp:{target.host}:{target.port}"
    words = [sys.executable, str(ROOT / "examples/python/guard.py"), place]
    done = subprocess.run(words, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    assert done.returncode == 0, done.stderr
    assert "P3DX_0001 Pioneer p3dx-sh" in done.stdout
    assert "bumped: False" in done.stdout
    assert "turned, and stands: 0 mm/s" in done.stdout
    assert sim.of("collision") == []
    assert sim.now["x_mm"] > 200  # it did drive


def test_a_python_client_that_leaves_stops_the_robot_and_a_second_one_is_turned_away(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()))
    _, target = guarded(bench)
    place = f"tcp:{target.host}:{target.port}"
    with argus.connect_guard(place) as robot:
        assert robot.configuration().sip_cycle_ms == 100
        robot.drive(200, turn_deg_s=5)
        for _ in robot.sips(3.0):
            pass
        assert sim.now["v_mm_s"] > 50
        with pytest.raises(argus.GuardError, match="no other client at it"):
            argus.connect_guard(place, timeout_s=1.0)
        assert robot.sip().left_vel > 0  # it is the first one's still
    wait_for("it stands", lambda: is_at_rest(sim.now), PATIENCE_S)
