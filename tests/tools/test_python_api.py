# SPDX-License-Identifier: MIT
"""Rule: `import argus` is what docs/python.md says, example by example, and says in one line what it cannot read."""

from __future__ import annotations

import doctest
import importlib
import re
import subprocess
import sys
from pathlib import Path
from types import FunctionType

import argus
import pytest
from argus_tools.log.cli import main as log_cli

from hil_sim.errors import missing_package

ROOT = Path(__file__).resolve().parents[2]
SAMPLE = ROOT / "docs/samples/two-failing-sonars.rec.gz"
MODULES = ("argus", "argus.protocol", "argus.sil", "argus.log", "argus.live", "argus.guard")


def test_the_examples_of_the_documentation(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    result = doctest.testfile(str(ROOT / "docs/python.md"), module_relative=False)
    assert result.attempted > 20
    assert result.failed == 0


@pytest.mark.parametrize("name", MODULES)
def test_what_is_public_is_there_and_documented(name: str) -> None:
    module = importlib.import_module(name)
    assert sorted(set(module.__all__)) == sorted(module.__all__)
    for public in module.__all__:
        found = getattr(module, public)
        assert not isinstance(found, type | FunctionType) or found.__doc__, (
            f"{name}.{public} has no docstring"
        )
    assert doctest.testmod(module).failed == 0


def test_the_version_is_that_of_the_header() -> None:
    header = (ROOT / "firmware/include/argus/argus.h").read_text(encoding="utf-8")
    written = re.search(r'^#define ARGUS_VERSION "(.+)"$', header, re.MULTILINE)
    assert written is not None
    assert argus.__version__ == written[1]


def test_a_direction_is_kept_and_none_is_both() -> None:
    both = list(argus.read(SAMPLE))
    client = list(argus.read(SAMPLE, direction="c2r"))
    assert {packet.dir for packet in both} == {"c2r", "r2c"}
    assert client == [packet for packet in both if packet.dir == "c2r"]


@pytest.mark.parametrize(
    ("content", "options", "part"),
    [
        (b"", {}, "is empty"),
        (b"dear diary\n" * 40, {}, "no ARCOS packet"),
        (b"\xfa\xfb\x03\x00\x00\x00", {"form": "tape"}, "no form 'tape'; name one of "),
    ],
)
def test_what_is_no_log_is_one_line(
    content: bytes, options: dict[str, str], part: str, tmp_path: Path
) -> None:
    path = tmp_path / "some.log"
    path.write_bytes(content)
    with pytest.raises(argus.LogError, match=part) as raised:
        list(argus.read(path, **options))  # type: ignore[arg-type]
    assert "\n" not in str(raised.value)


def test_a_log_without_readings_is_not_judged(tmp_path: Path) -> None:
    path = tmp_path / "sync.bin"
    path.write_bytes(argus.frame(b"\0") + argus.frame(b"\1"))
    with pytest.raises(argus.LogError, match="holds no SIP"):
        argus.diagnose(path)


def test_a_manager_that_reads_a_log_is_passive() -> None:
    with pytest.raises(argus.LogError, match="passive"):
        argus.diagnose(SAMPLE, config={"active": "on"})
    with pytest.raises(argus.LogError, match="no such setting"):
        argus.diagnose(SAMPLE, config={"no_such": 1})


def test_a_package_that_is_not_installed_is_named(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, "mcap", None)
        for module in ("data_stream", "opcode", "records"):
            patch.setitem(sys.modules, f"mcap.{module}", None)
        patch.delitem(sys.modules, "argus_tools.log.mcap_out", raising=False)
        assert log_cli(["convert", str(SAMPLE), str(tmp_path / "x.mcap")]) == 2
    assert capsys.readouterr().err == (
        "argus-log: this needs the Python package mcap, which is not installed: pip install mcap\n"
    )
    with pytest.raises(ModuleNotFoundError):
        missing_package(ModuleNotFoundError("No module named 'argus_tolls'", name="argus_tolls"))


def _example(name: str, *words: str) -> str:
    """Run an example; return what it prints. It must stand in docs/python.md, and so must that."""
    done = subprocess.run(
        [sys.executable, str(ROOT / f"examples/python/{name}.py"), *words],
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
        cwd=ROOT,
    )
    page = (ROOT / "docs/python.md").read_text(encoding="utf-8")
    assert done.stdout.strip() in page, f"{done.stdout}{done.stderr}"
    return done.stdout


def test_the_example_of_a_sweep() -> None:
    assert _example("sweep").count(" reached, 0 collisions") == 6


def test_the_example_of_a_bag(tmp_path: Path) -> None:
    bag = tmp_path / "drive.bag"
    subprocess.run(
        [sys.executable, str(ROOT / "docs/samples/drive_bag.py"), str(bag)], check=True, timeout=600
    )
    assert "sonar 5: DISABLED stuck" in _example("bag", str(bag))
