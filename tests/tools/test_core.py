# SPDX-License-Identifier: MIT
"""Rule: libargus.so exports the public header, at most 22 functions, and its shim; the manager behaves as in C."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from argus_tools.chunks import LogError

from hil_sim.arcos import COMMAND, ConfigPac, Sip, SyncEcho, SyncReply, Unframer, frame
from hil_sim.core import build as core_build
from hil_sim.core import library as core
from hil_sim.core.library import Core, library, setting_value, settings, sonars_of

ROOT = Path(__file__).resolve().parents[2]
HEADER = ROOT / "firmware/include/argus/argus.h"
SHIM = ROOT / "tools/core_shim.c"
MOST_FUNCTIONS = 22


def declared(*files: Path) -> set[str]:
    text = "\n".join(re.sub(r"//.*", "", file.read_text()) for file in files)
    text = re.sub(r"^static inline .*?^}", "", text, flags=re.DOTALL | re.MULTILINE)  # in no library
    names = set(re.findall(r"\b(argus_\w+)\s*[(\[]", text))
    return {
        f"{name}_for_{sonars_of(library())}_sonars" if f"#define {name} ARGUS_TAG" in text else name
        for name in names
    }


def test_exports_the_public_header_and_the_shim() -> None:
    path = library()._name
    done = subprocess.run(["nm", "-D", "--defined-only", path], capture_output=True, text=True, check=True)
    exported = {line.split()[-1] for line in done.stdout.splitlines()}
    public = declared(HEADER)
    assert len(public) <= MOST_FUNCTIONS, sorted(public)
    assert exported == public | {name for name in declared(SHIM) if name.startswith("argus_shim_")}
    assert f"argus_init_for_{sonars_of(library())}_sonars" in exported


def test_names_are_numbered_as_in_the_header() -> None:
    body = re.search(r"typedef enum \{([^{}]*)\} argus_name_of_t;", HEADER.read_text())
    assert body
    assert re.findall(r"ARGUS_NAME_(\w+)", re.sub(r"//.*", "", body[1])) == [
        name.name for name in core._Names
    ]
    assert core.kind_name(7) == "intermittent"
    assert core.health_name(6) == "ABSENT"
    assert core.health_name(7) == "?"


def test_settings_are_those_of_the_table() -> None:
    table = HEADER.read_text()
    auto = int(re.findall(r"#define ARGUS_AUTO (\d+)", table)[0])
    rows = re.findall(r"X\((\w+), (\d+|ARGUS_AUTO), \d+, \w+,", table)
    assert [(key, value[1]) for key, value in settings().items()] == [
        (key, auto if text == "ARGUS_AUTO" else int(text)) for key, text in rows
    ]
    assert setting_value("policy", "fewest") == 1
    assert setting_value("stale_ms", "2000") == 2000
    for key, text, part in (
        ("frob", "1", "no such setting"),
        ("policy", "best", "give paper or fewest or least-turn or ring or adaptive"),
        ("stale_ms", "soon", "whole number"),
    ):
        with pytest.raises(LogError, match=part):
            setting_value(key, text)


def test_settings_that_do_not_hold_are_refused() -> None:
    with pytest.raises(LogError, match="stale_ms is out of its range"):
        Core(0, {"stale_ms": 1})
    with pytest.raises(LogError, match="unsafe"):
        Core(0, {"speed_mm_s": 700})


def test_a_library_that_is_none_is_one_line(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv(core.LIBRARY_VARIABLE, str(tmp_path / "no.so"))
    with pytest.raises(LogError, match=r"no\.so does not exist: unset it"):
        core._load()
    (tmp_path / "no.so").write_text("no library")
    with pytest.raises(LogError, match="build it again"):
        core._load()


@pytest.mark.soak
def test_without_a_library_it_is_compiled_once(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv(core.LIBRARY_VARIABLE, raising=False)
    monkeypatch.setattr(core, "_PLACES", ())
    monkeypatch.setattr(core, "build", lambda: core_build.build(tmp_path / "core"))
    assert core._load().argus_shim_core_size() == library().argus_shim_core_size()
    assert capfd.readouterr().err.count("compiling the fault manager") == 1
    core._load()
    assert capfd.readouterr().err == ""
    assert len(list((tmp_path / "core").iterdir())) == 1


@pytest.mark.parametrize(
    ("compiler", "part"), [("/no/such/cc", "install gcc, or set ARGUS_CORE"), ("false", "does not compile")]
)
def test_without_a_compiler_it_is_one_line(
    compiler: str, part: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("CC", compiler)
    with pytest.raises(LogError, match=part) as raised:
        core_build.build(tmp_path)
    assert "\n" not in str(raised.value)
    assert list(tmp_path.iterdir()) == []


def test_without_sources_it_is_one_line(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(core_build, "_TREE", tmp_path)
    with pytest.raises(LogError, match="sources are not here: set ARGUS_CORE"):
        core_build.build()


def run_session(active: bool) -> tuple[Core, list[str], list[int]]:
    """Two seconds with a robot whose sonars all see 2 m; the clock wraps."""
    start = (1 << 32) - 700
    manager = Core(start, {"active": int(active)})
    robot, commands, said = Unframer(), [], []
    manager.link_up(start)
    is_open = False
    for now in range(start, start + 3000, 10):
        manager.process(now)
        if is_open and (now - start) % 100 == 0:
            readings = tuple((k, 2000 + k) for k in range(16))
            manager.receive(now, frame(Sip(flags=1, sonars=readings, battery_x10=125).data))
        for packet in manager.transmit():
            for data in robot.feed(packet):
                commands.append(data[0])
                if data[0] == COMMAND["CONFIG"]:
                    manager.receive(now, frame(ConfigPac().data))
                elif data[0] == 2:
                    manager.receive(now, frame(SyncReply(b"n", b"Pioneer", b"p3dx-sh").data))
                elif data[0] < 2 and not is_open:
                    is_open = commands[-2:] == [2, 1]
                    if not is_open:
                        manager.receive(now, frame(SyncEcho(data[0]).data))
        said += [event.event for event in manager.events()]
    return manager, said, commands


def test_a_session_through_the_library() -> None:
    manager, said, commands = run_session(active=True)
    assert manager.is_open
    assert said.index("LINK_UP") < said.index("SESSION_OPEN") < said.index("HEALTH_CHECK")
    status = manager.status()
    assert status["reading_mm"] == [2000 + k for k in range(16)]
    assert set(status["health"]) == {"HEALTHY"}
    assert set(status["kind"]) == {""}
    assert status["failure"] == "IsNormal"
    assert status["sips"] > 10
    assert status["battery_dv"] == 125
    assert COMMAND["ENABLE"] in commands
    assert COMMAND["ENABLE"] not in run_session(active=False)[2]


def test_events_carry_what_the_catalogue_says() -> None:
    manager = Core(5)
    manager.link_up(5)
    (event,) = manager.events()
    assert (event.t_ms, event.id, event.sonar, event.state) == (5, 10, None, "IsNormal")
    assert (event.event, event.level, event.level_name, event.name) == ("LINK_UP", 0, "OK", "link")
    assert event.meaning == "the transport is open"
    assert not event.has_value
    dead = event._replace(id=30, sonar=11)
    assert (dead.event, dead.level_name, dead.name) == ("SONAR_DEAD", "ERROR", "sonar/rear/11")
    assert dead.has_value


def test_two_managers_know_nothing_of_each_other() -> None:
    one, other = Core(0), Core(0)
    one.link_up(0)
    assert len(list(one.events())) == 1
    assert list(other.events()) == []
