# SPDX-License-Identifier: MIT
"""Rule: the stage `peers` runs what sources are given for, and says what it skips; nothing of the vendor's is here."""

from __future__ import annotations

import os
import socket
import subprocess
from pathlib import Path

import pytest
from devtool import peers as stage
from devtool.base import Command as Words
from peers import base, runs, wander, wire

from hil_sim.arcos import COMMAND, Command, Sip, frame

ROOT = Path(__file__).resolve().parents[2]


def run_with(monkeypatch: pytest.MonkeyPatch, **given: str) -> tuple[str | None, list[list[str]]]:
    done: list[list[str]] = []
    monkeypatch.setattr(stage, "build", lambda preset, run: None)
    for name in stage.SOURCES:
        monkeypatch.delenv(name, raising=False)
    for name, value in given.items():
        monkeypatch.setenv(name, value)

    def run(command: Words) -> None:
        done.append([str(word) for word in command])

    return stage.peers(run), done


def test_without_sources_it_is_skipped_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    note, done = run_with(monkeypatch)
    assert note is not None
    assert all(f"{name}=FOLDER" in note for name in stage.SOURCES)
    assert not done


def test_what_is_given_is_run_and_the_rest_told(monkeypatch: pytest.MonkeyPatch) -> None:
    note, (words,) = run_with(monkeypatch, ARIA_SOURCE="/a")
    assert words[1:] == [str(ROOT / "tools/peers/runs.py"), "ARIA_SOURCE=/a"]
    assert note is not None
    assert "MOBILESIM_SOURCE=FOLDER" in note
    assert " ARIA_SOURCE" not in note
    note, (words,) = run_with(monkeypatch, **{name: f"/{name[0]}" for name in stage.SOURCES})
    assert words[2:] == [f"{name}=/{name[0]}" for name in stage.SOURCES]
    assert note is None


def test_mobilesim_alone_is_told_to_need_aria(capsys: pytest.CaptureFixture[str]) -> None:
    assert runs.main(["MOBILESIM_SOURCE=/nowhere"]) == 1
    assert "give ARIA_SOURCE= as well" in capsys.readouterr().out


def test_those_of_ros_1_are_told_to_need_a_debian(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("ROS1_ROOT", raising=False)
    assert runs.main(["ARIA_SOURCE=/nowhere", "P2OS_SOURCE=/nowhere"]) == 1
    assert "give ROS1_ROOT= as well" in capsys.readouterr().out


def test_a_sip_that_is_lost_on_the_wire_is_counted() -> None:
    robot = [k / 10 for k in range(50)]
    client = [at + 0.002 for at in robot[10:40]]
    assert wire.lost(robot, client) == 0
    assert wire.lost(robot, client[:5] + client[7:]) == 2
    assert wire.lost(robot, []) == len(robot)


@pytest.mark.parametrize("terminal", [False, True], ids=["port", "terminal"])
def test_a_wire_passes_all_and_counts_it(terminal: bool) -> None:
    packet = frame(Sip(0x32, 0, 0, 0, 0, 0, 127, 0, 0, 0, 0x1F, 0, ((3, 812),)).data)
    with socket.create_server(("127.0.0.1", 0)) as server:
        between = wire.Wire(lambda: wire.to_port(server.getsockname()[1]), terminal)
        with wire.to_terminal(between.path) if terminal else wire.to_port(between.port) as client:
            os.write(client, frame(Command.integer(COMMAND["VEL"], 200).data))
            robot, _ = server.accept()
            with robot:
                assert robot.recv(100) == frame(Command.integer(COMMAND["VEL"], 200).data)
                robot.sendall(b"noise" + packet * 2)
                heard = b""
                while len(heard) < 5 + 2 * len(packet):
                    heard += os.read(client, 100)
        between.close()
    assert heard == b"noise" + packet * 2
    assert (len(between.sip_s), between.damaged, between.commands) == (2, 5, 1)


def test_who_wanders_turns_from_what_is_near_and_stands_without_readings() -> None:
    driver = wander.Wander()
    assert driver.speeds() == (0.0, 0.0)
    driver.hear([5.0] * 16)
    assert driver.speeds() == (wander.SPEED_M_S, 0.0)
    driver.hear([5.0, 5.0, 5.0, 0.5, 0.7, 1.0, 1.0, 1.0])
    assert driver.speeds() == (0.0, wander.TURN_RAD_S)
    driver.hear([1.0, 1.0, 1.0, 0.7, 0.7, 1.0, 5.0, 5.0])
    assert driver.speeds() == (0.0, wander.TURN_RAD_S), "the turn goes on until the way is free"
    driver.hear([1.0] * 8)
    assert driver.speeds() == (wander.SPEED_M_S, 0.0)


def test_sources_are_built_in_a_copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    source = tmp_path / "source"
    source.mkdir()
    (source / "Makefile").write_text("all:\n")
    (source / "old.o").write_text("")
    copy = base.cache("aria", source)
    assert copy.is_relative_to(tmp_path / "cache")
    assert [path.name for path in copy.iterdir()] == ["Makefile"]


def test_nothing_of_the_vendors_is_kept_here() -> None:
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False).stdout
    assert not [name for name in listed.splitlines() if name.endswith((".cc", ".cpp", ".hh"))]
