# SPDX-License-Identifier: MIT
"""Rule: the stage `peers` runs what sources are given for, and says what it skips; nothing of the vendor's is here."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from devtool import peers as stage
from devtool import testing
from devtool.base import Command as Words
from devtool.base import Stop
from peers import base, ros, runs, wander, wire
from peers.guard import Client

from hil_sim.arcos import COMMAND, Command, Sip, frame

ROOT = Path(__file__).resolve().parents[2]


def run_with(monkeypatch: pytest.MonkeyPatch, **given: str) -> tuple[str | None, list[list[str]]]:
    done: list[list[str]] = []
    monkeypatch.setattr(stage, "build", lambda preset, run: None)
    for name in (*stage.SOURCES, "ROS1_ROOT"):
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


def sources(folder: Path) -> dict[str, str]:
    """A folder for each that has what such sources are known by."""
    for name, marks in stage.MARKS.items():
        mark = folder / name / marks[0]
        mark.parent.mkdir(parents=True)
        mark.touch()
    return {name: str(folder / name) for name in stage.SOURCES}


def test_what_is_given_is_run_and_the_rest_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = sources(tmp_path)
    note, (words,) = run_with(monkeypatch, ARIA_SOURCE=made["ARIA_SOURCE"])
    assert words[1:] == [str(ROOT / "tools/peers/runs.py"), f"ARIA_SOURCE={made['ARIA_SOURCE']}"]
    assert note is not None
    assert "MOBILESIM_SOURCE=FOLDER" in note
    assert " ARIA_SOURCE" not in note
    note, (words,) = run_with(monkeypatch, **made, ROS1_ROOT="/r")
    assert words[2:] == [f"{name}={made[name]}" for name in stage.SOURCES]
    assert note is None


@pytest.mark.parametrize("name", stage.SOURCES)
@pytest.mark.parametrize("kind", ["missing", "empty", "other", "file"])
def test_what_is_no_such_source_is_refused_before_anything_is_copied(
    name: str, kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "given"
    if kind == "file":
        folder.write_text("")
    elif kind != "missing":
        folder.mkdir()
    if kind == "other":
        (folder / "big").write_text("of somebody else")
        (folder / "Makefile").write_text("all:\n")
    monkeypatch.setattr(stage, "build", lambda preset, run: pytest.fail("built before the look"))
    monkeypatch.setenv(name, str(folder))
    for other in set(stage.SOURCES) - {name}:
        monkeypatch.delenv(other, raising=False)
    with pytest.raises(Stop) as refused:
        stage.peers(lambda command: pytest.fail(f"ran {command}"))
    why = "no such folder" if kind in ("missing", "file") else "is not there"
    assert str(refused.value).startswith(f"{name}={folder}: ")
    assert why in str(refused.value)


def test_a_debian_that_is_missing_is_told_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    note, _ = run_with(monkeypatch, **sources(tmp_path))
    assert note == "skipped what needs ROS1_ROOT=FOLDER (docs/peers.md)"


def test_the_help_of_the_stage_names_all_sources() -> None:
    (told,) = [entry.what for entry in testing.TEST_STAGES if entry.name == "peers"]
    assert all(f"{name}=" in told for name in stage.SOURCES)
    assert {*runs.NEEDS, "ARIA_SOURCE"} == {*stage.SOURCES}
    assert ros.ROOT_VARIABLE == stage.ROOT_VARIABLE


@pytest.mark.parametrize(
    ("given", "root", "lacks"),
    [
        (["MOBILESIM"], False, {"MOBILESIM": "ARIA_SOURCE="}),
        (["P2OS", "PLAYER"], False, {"P2OS": "ROS1_ROOT=", "PLAYER": "ROS1_ROOT="}),
        (["ROSARIA"], False, {"ROSARIA": "ARIA_SOURCE= and ROS1_ROOT="}),
        (["ROSARIA", "P2OS"], True, {"ROSARIA": "ARIA_SOURCE="}),
        (["ARIA", "ROSARIA", "P2OS", "PLAYER", "MOBILESIM"], True, {}),
    ],
)
def test_what_lacks_something_is_skipped_and_the_rest_is_run(
    given: list[str],
    root: bool,
    lacks: dict[str, str],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("ROS1_ROOT", raising=False)
    if root:
        (tmp_path / "etc").mkdir()
        monkeypatch.setenv("ROS1_ROOT", str(tmp_path))
    client = Client("it", lambda place: None)
    for name in ("at_robot", "by_guard", "aria_against_sim", "argusd_against_mobilesim"):
        monkeypatch.setattr(runs, name, lambda *words: base.Peer("it", "ours", True, "it drove"))
    for name in ("build_aria", "build_mobilesim"):
        monkeypatch.setattr(runs, name, lambda *folders: folders[0])
    built: list[str] = []

    def makes(name: str) -> Callable[..., Client]:
        def make(*words: object) -> Client:
            built.append(name)
            return client

        return make

    for name in ("p2os", "rosaria", "player"):
        monkeypatch.setattr(ros, name, makes(name))
    assert runs.main([f"{name}_SOURCE=/{name}" for name in given]) == 0
    said = capsys.readouterr().out
    assert said.count("skipped") == len(lacks)
    for name, needs in lacks.items():
        assert f"skipped {name}_SOURCE: give {needs} as well" in said
    of_ros = [name.lower() for name in ("P2OS", "ROSARIA", "PLAYER") if name in given]
    assert built == [name for name in of_ros if name.upper() not in lacks]


def test_one_that_fails_has_not_passed_and_keeps_no_other_from_running(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "etc").mkdir()
    monkeypatch.setenv("ROS1_ROOT", str(tmp_path))

    def fails(*words: object) -> Client:
        raise subprocess.CalledProcessError(2, ["make"])

    ran = []

    def by_guard(client: Client, *words: object) -> base.Peer:
        ran.append(client.name)
        return base.Peer(client.name, "argusd", True, "it drove")

    monkeypatch.setattr(ros, "p2os", fails)
    monkeypatch.setattr(ros, "player", lambda *words: Client("Player", lambda place: None))
    monkeypatch.setattr(runs, "build_aria", fails)
    monkeypatch.setattr(runs, "at_robot", fails)
    monkeypatch.setattr(runs, "by_guard", by_guard)
    assert runs.main([f"{name}_SOURCE=/{name}" for name in ("ARIA", "P2OS", "PLAYER")]) == 1
    said = capsys.readouterr().out
    assert "FAILED AriaCoda against its compiler" in said
    assert "FAILED p2os against its compiler" in said
    assert "FAILED Player against argus-sim, sonar 3 dead" in said
    assert ran == ["Player"]


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


def test_a_copy_that_was_cut_off_is_made_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    source = tmp_path / "source"
    source.mkdir()
    (source / "Makefile").write_text("all:\n")
    real = shutil.copytree

    def cut(*words: Any, **options: Any) -> None:
        real(*words, **options)
        raise KeyboardInterrupt

    monkeypatch.setattr(shutil, "copytree", cut)
    with pytest.raises(KeyboardInterrupt):
        base.cache("aria", source)
    assert not list(base.home().iterdir())
    monkeypatch.setattr(shutil, "copytree", real)
    assert (base.cache("aria", source) / "Makefile").exists()


def test_the_folder_of_a_client_has_a_name_of_ours(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "root/etc").mkdir(parents=True)
    debian = ros.Debian(tmp_path / "root")
    source = tmp_path / "build-p2os_driver"
    source.mkdir()
    for name in ("p2os_msgs", "p2os_driver"):
        (source / name).mkdir()
        (source / name / "package.xml").write_text(f"<name>{name}</name>")
    monkeypatch.setattr(ros.Debian, "run", lambda self, line: None)
    ros.p2os(debian, source)
    assert sorted(path.name for path in debian.peers.iterdir()) == ["p2os", "wander.py"]


def test_nothing_of_the_vendors_is_kept_here() -> None:
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False).stdout
    assert not [name for name in listed.splitlines() if name.endswith((".cc", ".cpp", ".hh"))]
