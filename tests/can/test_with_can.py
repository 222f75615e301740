# SPDX-License-Identifier: MIT
"""Rule: what tools/with-can runs sees two buses and nothing else, and is as if it were run here."""

from __future__ import annotations

import importlib.machinery
import importlib.util
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from harness import ARGUSD, ROOT, SIM

WITH_CAN = ROOT / "tools/with-can"
LIMIT_S = 600
GUEST = ("--guest",)


def with_can(*words: str | Path, **options: object) -> subprocess.CompletedProcess[str]:
    """Run it to its end."""
    command = [sys.executable, str(WITH_CAN), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=LIMIT_S, check=False, **options)  # type: ignore[call-overload, no-any-return]


def test_two_buses_and_no_other_network() -> None:
    done = with_can("ip", "-br", "link")
    assert done.returncode == 0, done.stderr
    links = {line.split()[0]: line for line in done.stdout.splitlines()}
    assert sorted(links) == ["lo", "vcan0", "vcan1"]
    assert all("UP" in line.split("<")[1] for line in links.values())


def test_output_status_folder_environment_and_files_pass(tmp_path: Path) -> None:
    script = 'echo "$PWD $WORD"; echo complaint >&2; echo kept >file; umask; exit 7'
    env = os.environ | {"WORD": "two words $x 'quoted'\nand a line"}
    done = with_can(*GUEST, "sh", "-c", script, cwd=tmp_path, env=env, umask=0o027)
    assert done.returncode == 7
    assert done.stdout == f"{tmp_path} two words $x 'quoted'\nand a line\n0027\n"
    assert done.stderr == "complaint\n"
    assert (tmp_path / "file").read_text() == "kept\n"


def test_much_output_arrives_whole() -> None:
    done = with_can(*GUEST, "seq", "1", "100000")
    assert done.stdout == "".join(f"{k}\n" for k in range(1, 100001))


def test_standard_input_is_empty() -> None:
    done = with_can("cat", input="not for you")
    assert (done.returncode, done.stdout) == (0, "")


def test_a_command_that_is_not_there() -> None:
    done = with_can(*GUEST, "no-such-command")
    assert done.returncode == 127
    assert "no-such-command" in done.stderr


@pytest.mark.parametrize("where", [(), GUEST], ids=["here", "guest"])
def test_timeout(where: tuple[str, ...]) -> None:
    done = with_can(*where, "--timeout", "0.5", "sleep", "60")
    assert done.returncode == 124


@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGTERM, 5), (signal.SIGINT, 6)], ids=["SIGTERM", "SIGINT"]
)
def test_signals_reach_the_command(number: int, status: int) -> None:
    script = 'trap "exit 5" TERM; trap "exit 6" INT; echo ready; while :; do sleep 0.1; done'
    command = [sys.executable, str(WITH_CAN), *GUEST, "bash", "-c", script]
    process = subprocess.Popen(command, stdout=subprocess.PIPE)
    assert process.stdout is not None
    assert process.stdout.readline() == b"ready\n"
    process.send_signal(number)
    assert process.wait(LIMIT_S) == status
    process.stdout.close()


def guests(marker: Path) -> list[int]:
    """Processes of the guest whose files are in that folder."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                line = (entry / "cmdline").read_bytes()
            except OSError:
                continue
            if str(marker).encode() in line and b"linux.uml" in line:
                found.append(int(entry.name))
    return found


def test_nothing_is_left_when_it_is_killed(tmp_path: Path) -> None:
    command = [sys.executable, str(WITH_CAN), *GUEST, "sh", "-c", "echo ready; sleep 60"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, env=os.environ | {"TMPDIR": str(tmp_path)})
    assert process.stdout is not None
    assert process.stdout.readline() == b"ready\n"
    assert guests(tmp_path)
    process.kill()
    process.wait()
    process.stdout.close()
    until = time.monotonic() + LIMIT_S
    while guests(tmp_path) or any(tmp_path.iterdir()):
        assert time.monotonic() < until, f"{guests(tmp_path)} {[*tmp_path.iterdir()]}"
        time.sleep(0.1)


def test_two_at_once_do_not_meet() -> None:
    """What one sends, the other does not hear."""
    listen = [sys.executable, str(WITH_CAN), "timeout", "3", "candump", "-n", "1", "vcan0"]
    listener = subprocess.Popen(listen, stdout=subprocess.PIPE)
    done = with_can("sh", "-c", "for i in 1 2 3 4 5 6 7 8; do cansend vcan0 123#00; sleep 0.3; done")
    assert done.returncode == 0, done.stderr
    out, _ = listener.communicate(timeout=LIMIT_S)
    assert out == b""


def test_a_kernel_that_has_can_needs_no_guest() -> None:
    """The guest is such a kernel: with-can in with-can does not start another guest."""
    script = f"cansend vcan0 1#; exec {sys.executable} {WITH_CAN} ip -br link"
    done = with_can(*GUEST, "sh", "-c", script)
    assert done.returncode == 0, done.stderr
    assert [line.split()[0] for line in done.stdout.splitlines() if "<" in line] == ["lo", "vcan0", "vcan1"]


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ([], "no COMMAND"),
        (["--timeout", "soon", "true"], "'soon' is not a number of seconds"),
        (["--memory", "1", "true"], "'1' is not 64 to 65536"),
        (["--nonsense", "true"], "with-can"),
        (["--prepare", "true"], "--prepare takes no COMMAND"),
    ],
)
def test_wrong_arguments(arguments: list[str], expected: str) -> None:
    done = with_can(*arguments)
    assert done.returncode == 2
    assert expected in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_help_has_examples() -> None:
    done = with_can("--help")
    assert done.returncode == 0
    assert "examples:" in done.stdout
    assert "exit codes:" in done.stdout


def test_a_cache_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "argus").write_text("in the way")
    done = with_can(*GUEST, "true", env=os.environ | {"XDG_CACHE_HOME": str(tmp_path)})
    assert done.returncode == 3
    assert "set XDG_CACHE_HOME" in done.stderr


# a kernel with CAN, but without ISO-TP ----------------------------------------------------------------------


def test_argusd_names_the_module_that_is_missing_and_the_command() -> None:
    done = with_can("--without-isotp", ARGUSD, "--link", "can:vcan0", "--check")
    assert done.returncode == 3, done.stderr
    assert "can-isotp" in done.stderr
    assert "modprobe can-isotp" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1


def test_argus_sim_names_the_module_or_does_without_it() -> None:
    script = f"{SIM} --can vcan0,stack=kernel; echo $?; {SIM} --can vcan0 --duration 1; echo $?"
    done = with_can("--without-isotp", "sh", "-c", script)
    assert done.stdout.split() == ["1", "vcan0", "0"], done.stderr
    first, second = (line for line in done.stderr.strip().splitlines() if "the host was late" not in line)
    assert "module can-isotp" in first
    assert "load it: modprobe can-isotp" in first, "it is root there"
    assert "stack in user space" in second


def test_the_nodes_of_the_guest_are_its_own() -> None:
    """Its lines are no files in the host's /dev, which may have no such nodes."""
    before = sorted(Path("/dev").iterdir())
    done = with_can(
        *GUEST, "sh", "-c", "grep ' /dev ' /proc/mounts | cut -d' ' -f3; [ -c /dev/ttyS2 ] && echo is"
    )
    assert done.stdout.split() == ["devtmpfs", "is"], done.stderr
    assert sorted(Path("/dev").iterdir()) == before


@pytest.mark.parametrize("built", ["as now", "otherwise", "by an older with-can"])
def test_a_kernel_of_our_own_that_was_built_otherwise_is_built_anew(tmp_path: Path, built: str) -> None:
    loader = importlib.machinery.SourceFileLoader("with_can", str(WITH_CAN))
    spec = importlib.util.spec_from_loader("with_can", loader)
    assert spec is not None
    script = importlib.util.module_from_spec(spec)
    loader.exec_module(script)
    (tmp_path / "kernel/usr/lib/uml").mkdir(parents=True)
    (tmp_path / "can-isotp.ko").touch()
    if built != "by an older with-can":
        options = script.own_options() if built == "as now" else "CONFIG_IPV6_SIT=y\n"
        (tmp_path / "kernel/options").write_text(options)
    assert script.is_whole(tmp_path) == (built == "as now")
