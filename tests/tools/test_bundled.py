# SPDX-License-Identifier: MIT
"""Rule: the command argusd of a wheel becomes argusd, never itself; where there is none it names what to do."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def command(folder: Path) -> Path:
    """The script that pip writes into PATH."""
    script = folder / "argusd"
    script.write_text(
        f"#!{sys.executable} -S\nimport sys\nfrom argus_tools.bundled import main\nsys.exit(main())\n",
        encoding="utf-8",
    )
    script.chmod(0o755)
    return script


def program(folder: Path) -> Path:
    """Stands for argusd: prints who it is and what it was given."""
    made = folder / "argusd"
    folder.mkdir()
    made.write_text('#!/bin/sh\necho "$0: $*"\nexit 7\n', encoding="utf-8")
    made.chmod(0o755)
    return made


def copied(folder: Path) -> Path:
    """The sources in a folder without a build, which stands for a wheel's."""
    site = folder / "site"
    site.mkdir()
    for package in ("hil_sim", "argus_tools"):
        (site / package).mkdir()
        (site / package / "__init__.py").touch()
    (site / "hil_sim/program.py").write_bytes((ROOT / "hil_sim/program.py").read_bytes())
    (site / "argus_tools/bundled.py").write_bytes((ROOT / "tools/argus_tools/bundled.py").read_bytes())
    return site


@pytest.mark.parametrize("place", ["wheel", "path", "variable", "nowhere", "only itself by the variable"])
def test_it_becomes_argusd(place: str, tmp_path: Path) -> None:
    script = command(tmp_path)
    site = copied(tmp_path)
    env = {"PATH": f"{tmp_path}:/usr/bin:/bin", "PYTHONPATH": str(site)}
    if place == "wheel":
        (site / "argus_tools/argusd").write_bytes(program(tmp_path / "x").read_bytes())
        (site / "argus_tools/argusd").chmod(0o755)
    elif place == "path":
        env["PATH"] = f"{tmp_path}:{program(tmp_path / 'far').parent}:/usr/bin:/bin"
    elif place == "variable":
        env["ARGUS_ARGUSD"] = str(program(tmp_path / "named"))
    elif place != "nowhere":
        env["ARGUS_ARGUSD"] = str(script)
    done = subprocess.run(
        [script, "--check", "a b"], env=env, capture_output=True, text=True, timeout=120, check=False
    )
    if place in ("wheel", "path", "variable"):
        assert (done.returncode, done.stdout.endswith(": --check a b\n")) == (7, True), done
        assert os.fspath(script) not in done.stdout
    else:
        assert (done.returncode, len(done.stderr.splitlines())) == (127, 1), done
        assert ("tools/dev build release" in done.stderr) == (place == "nowhere")


def test_that_of_a_wheel_is_found_beside_its_sources(tmp_path: Path) -> None:
    site = copied(tmp_path)
    wheel = tmp_path / "installed/argus_tools"
    (tmp_path / "installed").mkdir()
    argusd = program(wheel)
    code = (
        f"import sysconfig; sysconfig.get_path = lambda name: {str(wheel.parent)!r}\n"
        "from hil_sim.program import find_argusd\nprint(find_argusd())"
    )
    env = {"PATH": "/usr/bin:/bin", "PYTHONPATH": str(site)}
    done = subprocess.run(
        [sys.executable, "-S", "-c", code], capture_output=True, text=True, env=env, cwd=site, check=True
    )
    assert done.stdout.strip() == str(argusd)
