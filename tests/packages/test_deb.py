# SPDX-License-Identifier: MIT
"""Rule: the Debian packages hold what they say, their scripts and unit are sound, and the service tells how it does."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import argus
import pytest
from packages_help import ROOT, run

PACKAGES = {"argusd", "argus-tools", "libargus0.1", "libargus-dev"}
EXPECTED = {
    "etc/argus/argusd.conf",
    "etc/default/argusd",
    "usr/bin/argusd",
    "usr/bin/argus-sim",
    "usr/bin/argus-log",
    "usr/include/argus/argus.h",
    "usr/lib/python3/dist-packages/argus/__init__.py",
    "usr/lib/python3/dist-packages/hil_sim/core/libargus.so",
    "usr/lib/systemd/system/argusd.service",
    "usr/lib/udev/rules.d/60-argus.rules",
    "usr/share/argus/argus.dbc",
    "usr/share/bash-completion/completions/argusd",
    "usr/share/bash-completion/completions/argus-sim",
    "usr/share/man/man1/argusd.1.gz",
    "usr/share/man/man1/argus-log.1.gz",
    "usr/share/man/man1/argus-ros.1.gz",
    "usr/share/man/man1/argus-range-guard.1.gz",
    "usr/lib/python3/dist-packages/argus_tools/foxglove_layout.json",
    "usr/share/ament_index/resource_index/packages/argus_ros",
    "usr/share/argus_ros/config/argus.yaml",
    "usr/share/argus_ros/launch/argus.launch.xml",
    "usr/share/argus_ros/launch/two_robots.launch.xml",
    "usr/share/argus_ros/package.xml",
    *(f"usr/share/doc/{name}/copyright" for name in PACKAGES),
}
EXPOSURE_MAX = 2.5
PATIENCE_S = 60.0
WATCHDOG_S = 1.0


def field(deb: Path, name: str) -> str:
    """A field of a package."""
    return run("dpkg-deb", "-f", deb, name).strip()


def scripts(deb: Path, folder: Path) -> Path:
    """The folder with the control files of a package."""
    run("dpkg-deb", "-e", deb, folder)
    return folder


def unit_of(unpacked: Path) -> str:
    """The text of the unit."""
    return (unpacked / "usr/lib/systemd/system/argusd.service").read_text()


def test_the_packages_and_their_files(debs: dict[str, Path], unpacked: Path) -> None:
    assert set(debs) == PACKAGES
    held = {path.relative_to(unpacked).as_posix() for path in unpacked.rglob("*") if not path.is_dir()}
    assert held >= EXPECTED
    ours = "usr/lib/python3/dist-packages/argus_tools/argusd"
    assert not [name for name in held if name.startswith(ours)], "argusd is a package of its own"
    assert not [name for name in held if "__pycache__" in name or name.startswith("usr/local")]
    for deb in debs.values():
        assert field(deb, "Version") == argus.__version__
        assert "root/root" in run("dpkg-deb", "-c", deb).splitlines()[0]
    assert "libncurses" in field(debs["argusd"], "Depends")
    assert field(debs["libargus-dev"], "Depends") == f"libargus0.1 (= {argus.__version__})"


def test_what_the_operator_may_change_is_kept(debs: dict[str, Path], unpacked: Path, tmp_path: Path) -> None:
    kept = (scripts(debs["argusd"], tmp_path / "control") / "conffiles").read_text().split()
    assert {f"/{name}" for name in EXPECTED if name.startswith("etc/")} == set(kept)
    # Every setting as a remark, so that a link at another rate contradicts none.
    example = run(unpacked / "usr/bin/argusd", "--example-config")
    held = (unpacked / "etc/argus/argusd.conf").read_text()
    assert re.sub(r"^#(?=[a-z])", "", held, flags=re.MULTILINE) == example
    assert not re.search(r"^[a-z]", held, re.MULTILINE)
    assert 'ARGUSD_OPTIONS="--config /etc/argus/argusd.conf"' in (unpacked / "etc/default/argusd").read_text()


def test_the_scripts_are_of_a_plain_shell(debs: dict[str, Path], tmp_path: Path) -> None:
    found = 0
    for name, deb in debs.items():
        for script in scripts(deb, tmp_path / name).iterdir():
            if script.name in ("postinst", "prerm", "postrm"):
                assert os.access(script, os.X_OK)
                run("sh", "-n", script)
                found += 1
    assert found >= 5


def test_commands_of_the_tools_are_debian_s_python(unpacked: Path) -> None:
    for name in ("argus-sim", "argus-log", "argus-conformance"):
        assert (unpacked / "usr/bin" / name).read_text().startswith("#!/usr/bin/python3\n")


def test_completion_knows_the_options(unpacked: Path) -> None:
    completion = unpacked / "usr/share/bash-completion/completions/argusd"
    ask = (
        f"source {completion}; COMP_WORDS=(argusd --link can:can0 --rob); COMP_CWORD=3; _argus argusd;"
        ' echo "${COMPREPLY[@]}"; COMP_WORDS=(argusd --robot p3); COMP_CWORD=2; _argus argusd; echo "${COMPREPLY[@]}"'
    )
    env = {"PATH": f"{unpacked / 'usr/bin'}:/usr/bin:/bin"}
    assert run("bash", "-c", ask, env=env).splitlines() == ["--robot", "p3at-sh p3dx-sh"]


def test_each_command_that_has_a_completion_is_named_in_it(unpacked: Path) -> None:
    folder = unpacked / "usr/share/bash-completion/completions"
    for path in folder.iterdir():
        done = run("bash", "-c", f"source {path}; complete -p {path.name}")
        assert "-F _argus" in done, path.name


@pytest.mark.skipif(not shutil.which("lintian"), reason="lintian is not installed")
def test_lintian_finds_nothing(debs: dict[str, Path]) -> None:
    assert run("lintian", "--allow-root", "--fail-on", "warning", *debs.values()) == ""


@pytest.mark.skipif(not shutil.which("systemd-analyze"), reason="systemd is not installed")
def test_the_unit_is_sound_and_little_exposed(unpacked: Path, tmp_path: Path) -> None:
    unit = tmp_path / "argusd.service"
    # The programs and users that it names are those of a machine where it is installed.
    program = str(unpacked / "usr/bin/argusd")
    text = unit_of(unpacked).replace("ExecStart=/usr/bin/argusd", f"ExecStart={program}")
    assert program in text
    unit.write_text(text)
    told = run(
        "systemd-analyze",
        "verify",
        "--man=no",
        unit,
        stderr=subprocess.STDOUT,
        capture_output=False,
        stdout=-1,
    )
    assert "argusd.service" not in told
    told = run("systemd-analyze", "security", "--offline=yes", "--no-pager", unit)
    exposure = re.search(r"Overall exposure level for argusd\.service: ([\d.]+)", told)
    assert exposure
    assert float(exposure[1]) <= EXPOSURE_MAX


@contextlib.contextmanager
def started(words: list[str], **options: object) -> Iterator[subprocess.Popen[bytes]]:
    """A program that ends with the block."""
    with subprocess.Popen(words, stdout=subprocess.DEVNULL, **options) as child:  # type: ignore[call-overload]
        try:
            yield child
        finally:
            with contextlib.suppress(ProcessLookupError):
                child.kill()


def wait_for(manager: socket.socket, wanted: str) -> list[str]:
    """What systemd is told until it is told what is wanted."""
    told: list[str] = []
    until = time.monotonic() + PATIENCE_S
    while time.monotonic() < until:
        told.append(manager.recv(4096).decode())
        if re.fullmatch(wanted, told[-1]):
            return told
    raise AssertionError(f"{wanted} is not told: {told}")


def test_the_service_tells_how_it_does(unpacked: Path, tmp_path: Path) -> None:
    start = re.search(r"^ExecStart=/usr/bin/argusd (.*)$", unit_of(unpacked), re.MULTILINE)
    assert start
    assert "Type=notify\n" in unit_of(unpacked)
    port = str(tmp_path / "robot")
    words = start[1].replace("/var/lib/argus", str(tmp_path)).replace("/run/argus", str(tmp_path))
    words = words.replace("${ARGUSD_LINK}", f"serial:{port}@115200").replace(
        "$ARGUSD_OPTIONS", f"--config {unpacked}/etc/argus/argusd.conf"
    )
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind(str(tmp_path / "notify"))
        manager.settimeout(PATIENCE_S)
        env = {
            **os.environ,
            "NOTIFY_SOCKET": str(tmp_path / "notify"),
            "WATCHDOG_USEC": str(round(WATCHDOG_S * 1e6)),
        }
        with started([str(unpacked / "usr/bin/argusd"), *words.split()], env=env) as argusd:
            # Up without a robot; what it waits for is told, and that it lives.
            assert wait_for(manager, "READY=1") == ["READY=1"]
            wait_for(manager, rf"STATUS={re.escape(port)}: .*")
            wait_for(manager, "WATCHDOG=1")
            robot = [str(ROOT / ".venv/bin/argus-sim"), "--link-name", port, "--baud", "115200"]
            with started(robot):
                wait_for(manager, r"STATUS=.*p3dx-sh.*16 of 16 sonars healthy, passive, mission none")
                begun = time.monotonic()
                for _ in range(4):
                    wait_for(manager, "WATCHDOG=1")
                # Each half of the time; a busy host may be late, but is never early.
                assert time.monotonic() - begun > 3 * WATCHDOG_S / 2 * 0.9
                argusd.send_signal(signal.SIGTERM)
                wait_for(manager, "STOPPING=1")
                assert argusd.wait(PATIENCE_S) == 0
