# SPDX-License-Identifier: MIT
"""Rule: every command of tools/dev explains itself and refuses wrong arguments with exit code 2."""

from __future__ import annotations

import contextlib
import io
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from unittest import mock

import lizard
import pytest
from devtool import cli, cmake, system, testing
from devtool import commands as running

ROOT = Path(__file__).resolve().parents[2]
COMMANDS = (
    "demo", "shell", "test", "soak", "build", "format", "lint", "coverage", "size", "bench", "clean",
    "firmware", "hil", "flash", "docs",
)  # fmt: skip


def dev(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Run tools/dev as a program."""
    command = [sys.executable, str(ROOT / "tools/dev"), *arguments]
    return subprocess.run(command, check=False, capture_output=True, text=True, timeout=600)


def dev_here(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Run tools/dev in this process: as long as it starts nothing, it says the same."""
    with (
        contextlib.redirect_stdout(io.StringIO()) as out,
        contextlib.redirect_stderr(io.StringIO()) as err,
        mock.patch.object(cli, "leave_venv"),
    ):
        try:
            code = cli.main(arguments)
        except SystemExit as left:
            code = int(left.code or 0)
    return subprocess.CompletedProcess(arguments, code, out.getvalue(), err.getvalue())


def test_help_names_every_command() -> None:
    done = dev("--help")
    assert done.returncode == 0
    assert "examples:" in done.stdout
    for command in COMMANDS:
        assert re.search(rf"^    {command} ", done.stdout, re.MULTILINE), command


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_each_command(command: str) -> None:
    done = dev_here(command, "--help")
    assert done.returncode == 0
    assert "examples:" in done.stdout
    assert f"  tools/dev {command}" in done.stdout
    assert "exit codes:" in done.stdout


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ([], "required"),
        (["nonsense"], "invalid choice"),
        (["build", "nonsense"], "name one of debug, release"),
        (["test", "--only", "nonsense"], "name one of tables, release"),
        (["test", "--quick", "--only", "hil"], "name one of tables, release"),
        (["test", "--nonsense"], "unrecognized arguments"),
        (["firmware", "--board", "nonsense"], "invalid choice"),
        (["firmware", "--config", "/no/such/file"], "no such file"),
        (["flash", "--probe", "nonsense"], "invalid choice"),
        (["flash", "--probe", "serial", "--device", "/no/such"], "there is no such port"),
    ],
)
def test_wrong_arguments(arguments: list[str], expected: str) -> None:
    done = dev_here(*arguments)
    assert done.returncode == 2
    assert expected in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("command", ["test", "soak", "lint", "format"])
def test_list_prints_the_stages_and_does_nothing(command: str) -> None:
    done = dev_here(command, "--list")
    assert done.returncode == 0
    assert len(done.stdout.splitlines()) >= 2
    assert "dev:" not in done.stdout


def stages_of(*arguments: str) -> list[str]:
    return [line.split()[0] for line in dev_here(*arguments, "--list").stdout.splitlines()]


def test_what_a_stage_needs_is_known() -> None:
    """An unknown one would end the whole command before its first stage."""
    for stage in (*testing.TEST_STAGES, *testing.QUICK_STAGES, *testing.SOAK_STAGES):
        assert set(stage.needs) <= set(system.NEEDS), stage.name
        assert set(stage.presets) <= set(cmake.presets()), stage.name


def test_the_quick_stages_are_some_of_all() -> None:
    quick, everything = stages_of("test", "--quick"), stages_of("test")
    assert set(quick) < set(everything)
    assert not {"hil", "can", "soak", "wide"} & set(quick)
    assert set(stages_of("soak")) - set(everything) == {
        "wide",
        "fuzz",
        "mcdc",
        "coverage-hal",
        "misra",
        "valgrind",
        "reproduce",
    }


@pytest.fixture
def commands(monkeypatch: pytest.MonkeyPatch) -> dict[str, list[list[str]]]:
    """What each stage would run, builds left out."""
    found: dict[str, list[list[str]]] = {}
    for module in (cmake, testing):
        monkeypatch.setattr(module, "build", lambda preset, run, **_: None)
    for stage in {*testing.TEST_STAGES, *testing.SOAK_STAGES}:
        if stage.name not in {
            "hil",
            "can",
            "ros",
            "packages",
            "monitor",
            "docs",
            "coverage",
            "coverage-hal",
            "mcdc",
            "misra",
            "reproduce",
        }:
            runs: list[list[str]] = found.setdefault(stage.name, [])
            stage.action(lambda command, runs=runs: runs.append([str(word) for word in command]))  # type: ignore[misc]
    return found


def test_every_c_test_is_run_optimised(commands: dict[str, list[list[str]]]) -> None:
    """The fast ones in the stage of the release build, those that compute for long in those of their own."""
    for stage, choice in (
        ("release", ["-LE", "soak|wide"]),
        ("soak", ["-L", "soak"]),
        ("wide", ["-L", "wide"]),
    ):
        ctest = next(run for run in commands[stage] if run[0] == "ctest")
        assert ctest[1:3] == ["--preset", "release"]
        assert ctest[-2:] == choice


def test_every_python_test_is_run(commands: dict[str, list[list[str]]]) -> None:
    """Those that compute are in python, soak or wide, the others in hil, can or boards."""
    marks = {"python": "not soak and not wide", "soak": "soak and not wide", "wide": "wide"}
    of_stage = {"soak": ("mark.soak", "mark.tour"), "wide": ("mark.wide", "mark.tour")}
    for stage, mark in marks.items():
        (pytests,) = (run for run in commands[stage] if "pytest" in run)
        assert pytests[pytests.index("-m", 2) + 1] == mark
        folders = ("hil", "can", "target", "ros", "monitor", "packages", "docs")
        if stage == "python":
            assert "tests" in pytests
            ignored = {word for word in pytests if word.startswith("--ignore")}
            assert ignored == {f"--ignore=tests/{folder}" for folder in folders}
        else:
            paths = [path.relative_to(ROOT) for path in (ROOT / "tests").rglob("test_*.py")]
            own = [path for path in paths if path.parts[1] not in folders]
            listed = {word for word in pytests if word.startswith("tests/")}
            assert listed == {
                str(path)
                for path in own
                if any(mark in (ROOT / path).read_text() for mark in of_stage[stage])
            }


def test_a_shell_finds_what_was_built() -> None:
    done = dev("shell", "sh", "-c", "command -v argusd; command -v argus-sim; exit 7")
    assert done.returncode == 7, done.stderr
    assert done.stdout.splitlines()[-2:] == [
        str(ROOT / "build/release/argusd"),
        str(ROOT / ".venv/bin/argus-sim"),
    ]


def test_a_shell_finds_it_behind_a_start_file_that_sets_path(tmp_path: Path) -> None:
    (tmp_path / ".bashrc").write_text("PATH=/usr/bin:/bin\nseen=yes\n", encoding="utf-8")
    env = running.shell_environment() | {"HOME": str(tmp_path)}
    done = subprocess.run(
        [*running.shell_command("/bin/bash", env), "-i"],
        input='command -v argus-sim\necho "$seen $PATH"\n',
        env=env,
        capture_output=True,
        text=True,
        check=False,
    )
    found, last = done.stdout.splitlines()[-2:]
    assert found == str(ROOT / ".venv/bin/argus-sim"), done.stderr
    assert last.startswith(f"yes {ROOT}/build/release:{ROOT}/.venv/bin:")


def test_in_the_shell_dev_neither_runs_on_venv_nor_makes_it_anew() -> None:
    stamp = ROOT / ".venv/argus-recipe"
    before = stamp.stat()
    done = dev("shell", "tools/dev", "shell", "true")
    assert done.returncode == 0, done.stderr
    assert ".venv" not in done.stdout
    assert stamp.stat().st_mtime_ns == before.st_mtime_ns
    program = (
        "import sys; sys.argv[0] = 'x'; from devtool.setup import leave_venv; leave_venv(); print(sys.prefix)"
    )
    command = [str(ROOT / ".venv/bin/python"), "-c", program]
    env = os.environ | {"PYTHONPATH": str(ROOT / "tools")}
    done = subprocess.run(command, env=env, capture_output=True, text=True, check=True)
    assert done.stdout.strip() != str(ROOT / ".venv")


def test_a_shell_that_is_not_there() -> None:
    done = dev("shell", "no-such-command")
    assert (done.returncode, done.stderr) == (2, "dev: no-such-command: No such file or directory\n")


def test_the_modules_are_small_and_need_nothing_but_python() -> None:
    # What all command lines share.
    shared = [ROOT / "hil_sim" / name for name in ("arguments.py", "output.py", "start.py", "version.py")]
    for path in (*sorted((ROOT / "tools/devtool").glob("*.py")), *shared):
        text = path.read_text(encoding="utf-8")
        assert len(text.splitlines()) <= 500, path
        for name in re.findall(r"^(?:from|import) (hil_sim\.\w+|\w+)", text, re.MULTILINE):
            of_all = ("arguments", "output", "start", "version")
            ours = name in ("devtool", *(f"hil_sim.{module}" for module in of_all))
            assert name in sys.stdlib_module_names or ours, f"{path}: {name}"
        for one in lizard.analyze_file(str(path)).function_list:
            assert one.cyclomatic_complexity <= 10, f"{path}:{one.start_line}: {one.name}"


@pytest.mark.soak
def test_a_tour_leaves_most_cases_to_soak_and_wide(tmp_path: Path) -> None:
    """Each case is in one stage, none in no stage; those of each are from all over."""
    shutil.copy(ROOT / "tests/conftest.py", tmp_path)
    tours = ((12, "3"), (7, "2"), (2, "5"), (8, "2, 4"))
    (tmp_path / "test_it.py").write_text(
        "import pytest\n"
        + "".join(
            f"@pytest.mark.tour({counts})\n"
            f"@pytest.mark.parametrize('n', range({cases}))\n"
            f"def test_{cases}(n):\n    pass\n"
            for cases, counts in tours
        )
    )
    chosen = []
    for choice in ("not soak and not wide", "soak", "wide"):
        command = [
            sys.executable,
            "-m",
            "pytest",
            "-q",
            "--collect-only",
            "-p",
            "no:cacheprovider",
            "-m",
            choice,
        ]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        found = re.findall(r"test_(\d+)\[(\d+)\]", done.stdout)
        chosen.append({(int(cases), int(n)) for cases, n in found})
    assert chosen[0] == {(12, 0), (12, 4), (12, 8), (7, 0), (7, 3), (2, 0), (2, 1), (8, 0), (8, 4)}
    assert chosen[2] == {(8, 1), (8, 3), (8, 5), (8, 7)}
    assert chosen[1] == {(cases, n) for cases, _ in tours for n in range(cases)} - chosen[0] - chosen[2]


@pytest.mark.parametrize(
    ("arguments", "code"), [(("--seed", "abc"), 2), (("--nonsense",), 2), (("--", "--help"), 0)]
)
def test_what_ends_the_demo_ends_it_before_anything_is_built(
    arguments: tuple[str, ...], code: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    def never(*_: object) -> None:
        raise AssertionError("nothing is built")

    monkeypatch.setattr(running, "ensure", never)
    monkeypatch.setattr(running, "quietly", never)
    assert dev_here("demo", *arguments).returncode == code
