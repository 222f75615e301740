# SPDX-License-Identifier: MIT
"""Rule: installed from the built wheel the nodes do what they do from the sources: they take orders, drive the robot,
repair ranges, and where they end, killed or shut down, the robot stands."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import harness
import pytest
from argus_tools.rings.motion import Motion
from diagnostic_msgs.msg import DiagnosticArray
from drives import Told
from geometry_msgs.msg import Twist, TwistStamped
from harness import ROOT
from lifecycle_msgs.msg import Transition
from nodes import Bench, Driver
from robots import emulated, free_port, minded
from sensor_msgs.msg import PointCloud2, Range
from test_programs import commands_of
from test_states import change

WHEEL = Path(f"{sys.prefix}-wheel")
MOVING_MM_S = 20
PATIENCE_S = 300.0


@pytest.fixture(scope="module", autouse=True)
def _made() -> None:
    if not WHEEL.exists():
        pytest.skip("no environment with the wheel: tools/dev test --only ros makes it")


def environment() -> dict[str, str]:
    """What a shell has in which that environment is activated: nothing of ours."""
    ours = ("PYTHONPATH", "LD_LIBRARY_PATH", "_ROS_WHEELS_BOOTSTRAP_COMPLETE", "VIRTUAL_ENV")
    kept = {key: value for key, value in os.environ.items() if key not in ours}
    return kept | {"PATH": f"{WHEEL / 'bin'}:{kept['PATH']}", "VIRTUAL_ENV": str(WHEEL)}


@contextmanager
def running(command: list[str], folder: Path, end: signal.Signals = signal.SIGINT) -> Iterator[Any]:
    """An installed program while it runs; ended by a signal it ends in order."""
    process = subprocess.Popen(
        [str(WHEEL / "bin" / command[0]), *command[1:]],
        cwd=folder,
        env=environment(),
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        yield process
    finally:
        if process.poll() is None:
            process.send_signal(end)
        _, errors = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == (-end if end == signal.SIGKILL else 0), errors


def said(code: str, folder: Path) -> str:
    command = [str(WHEEL / "bin/python"), "-c", code]
    return subprocess.check_output(command, cwd=folder, env=environment(), text=True).strip()


def test_it_has_nothing_of_these_sources(tmp_path: Path) -> None:
    code = (
        "import argus_ros, hil_sim, hil_sim.core.library as c; "
        "print(argus_ros.__file__, hil_sim.__file__, c.__file__)"
    )
    places = said(code, tmp_path).split()
    assert len(places) == 3
    assert all(Path(place).is_relative_to(WHEEL) for place in places), places
    done = subprocess.run(
        [WHEEL / "bin/python", "-m", "pip", "check"],
        env=environment(),
        capture_output=True,
        text=True,
        check=False,
    )
    assert "argus-p3dx" not in done.stdout, done.stdout


class Installed:
    """An emulated robot, argusd of the wheel with its guard port, and who sends cmd_vel."""

    def __init__(self, folder: Path, kind: Any = Twist) -> None:
        self.folder, self.kind = folder, kind
        self.sim, address = emulated(folder, "--world", "hall")
        self.port = free_port()
        guard = f"tcp:127.0.0.1:{self.port}"
        self.argusd, self.place = minded(folder, address, "--passive", "--guard", guard)
        self.bench = Bench()
        self.bench.listen(Range, "sonar/range_0")
        self.bench.listen(DiagnosticArray, "/diagnostics")
        self.publisher = self.bench.listener.create_publisher(kind, "cmd_vel", 1)

    @property
    def command(self) -> list[str]:
        given = (f"control:={self.place}", f"guard:=127.0.0.1:{self.port}")
        return ["argus-ros", "--ros-args", *(word for one in given for word in ("-p", one))]

    def publish(self) -> None:
        message = self.kind()
        twist = message if self.kind is Twist else message.twist
        twist.linear.x = 0.2
        if self.kind is not Twist:
            message.header.stamp = self.bench.listener.get_clock().now().to_msg()
        self.publisher.publish(message)

    def order(self, seconds: float) -> float:
        """Order 0.2 m/s for a while; return the greatest true speed meanwhile."""
        begin, end = self.sim.t_s, time.monotonic() + seconds
        while time.monotonic() < end:
            self.publish()
            self.bench.until(lambda: False, 0.1)
        return max((abs(state["v_mm_s"]) for state in self.sim.of("state", begin)), default=0.0)

    def drive(self) -> None:
        """Order it until it moves; the guard port lets a robot that has heard nothing yet go at 100 mm/s."""
        end = time.monotonic() + PATIENCE_S
        while abs(self.sim.now["v_mm_s"]) < 3 * MOVING_MM_S:
            assert time.monotonic() < end, "it does not move"
            self.order(0.5)

    def assert_stands(self) -> None:
        self.sim.wait_rest()
        assert self.order(2.0) <= MOVING_MM_S

    def close(self) -> None:
        self.bench.close()
        self.argusd.end()
        self.sim.end()


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    (argusd,) = WHEEL.glob("lib/python3*/site-packages/argus_tools/argusd")
    monkeypatch.setattr(harness, "ARGUSD", argusd)
    made: list[Installed] = []

    def make(kind: Any = Twist) -> Installed:
        made.append(Installed(tmp_path, kind))
        return made[-1]

    yield make
    for one in made:
        one.close()


def test_it_drives_and_stands_behind_shutdown(installed: Any, tmp_path: Path) -> None:
    robot = installed(TwistStamped)
    with running(robot.command, tmp_path):
        assert robot.bench.until(
            lambda: {t for t, _ in robot.bench.heard} == {"sonar/range_0", "/diagnostics"}, PATIENCE_S
        )
        robot.drive()
        robot.sim.wait_rest()  # nobody sends any more
        robot.drive()
        change(robot.bench, "argus", Transition.TRANSITION_ACTIVE_SHUTDOWN)
        robot.assert_stands()
        robot.bench.take()
        assert not robot.bench.until(lambda: bool(robot.bench.heard), 2.0), "a finalized node publishes"


@pytest.mark.parametrize("end", [signal.SIGTERM, signal.SIGKILL])
def test_a_program_that_ends_lets_it_stand(installed: Any, end: signal.Signals, tmp_path: Path) -> None:
    robot = installed()
    with running(robot.command, tmp_path, end):
        robot.drive()
    robot.assert_stands()


def test_the_guard_repairs_what_a_driver_says(tmp_path: Path) -> None:
    driver = Driver()
    bench = Bench(driver)
    for number in (2, 3):
        bench.listen(Range, f"sonar/range_{number}/guarded")
    bench.listen(PointCloud2, "sonar/cloud_guarded")
    bench.listen(DiagnosticArray, "/diagnostics")
    begin = time.monotonic()

    def tell() -> None:
        """A tenth of a second of a robot that drives along a wall; sonar 3 always says the same."""
        t_s = time.monotonic() - begin
        motion = Motion(0.2 * t_s, 0.0, 0.0, 0.2, 0.0)
        driver.tell_pose(Told(t_s, motion, ()))
        driver.tell(Told(t_s, motion, tuple((k, 0.0 if k == 3 else 1 + (k + t_s) % 0.03) for k in range(16))))
        bench.until(lambda: False, 0.1)

    def named() -> bool:
        tell()
        statuses = [s for topic, m in bench.heard if topic == "/diagnostics" for s in m.status]
        return any(s.name == "range_guard: sonar/front/03" and "stuck" in s.message for s in statuses)

    with running(["argus-range-guard", "--ros-args", "-p", "no_echo:=max"], tmp_path):
        assert bench.until(named, PATIENCE_S)
        bench.take()
        for _ in range(20):
            tell()
        heard = {topic for topic, _ in bench.take()}
        assert {"sonar/range_2/guarded", "sonar/cloud_guarded"} <= heard
        assert "sonar/range_3/guarded" not in heard
    bench.close()
    driver.destroy_node()


def test_its_launch_and_parameter_files_start_two_robots(installed: Any, tmp_path: Path) -> None:
    share = WHEEL / "share/argus_ros"
    for kind in ("launch", "config"):
        ours = sorted((ROOT / "tools/argus_ros" / kind).iterdir())
        assert [path.name for path in ours] == sorted(path.name for path in (share / kind).iterdir())
    robot = installed()
    given = {"control_1": robot.place, "guard_1": f"127.0.0.1:{robot.port}", "guard_2": "127.0.0.1:9"}
    robot.publisher = robot.bench.listener.create_publisher(Twist, "/robot1/cmd_vel", 1)
    other = robot.bench.listener.create_publisher(Twist, "/robot2/cmd_vel", 1)
    with ExitStack() as programs:
        for command in commands_of(share / "launch/two_robots.launch.xml", **given):
            programs.enter_context(running(command, tmp_path))
        assert robot.bench.until(lambda: bool(other.get_subscription_count()), PATIENCE_S)
        twist = Twist()
        twist.linear.x = 0.2
        for _ in range(20):  # orders for the other move nothing here
            other.publish(twist)
            robot.bench.until(lambda: False, 0.1)
        assert abs(robot.sim.now["v_mm_s"]) <= MOVING_MM_S
        robot.drive()
    robot.assert_stands()
