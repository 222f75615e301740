# SPDX-License-Identifier: MIT
"""Rule: of a wheel the Debian tools take all but what is for wheels alone, and each program has its script."""

from __future__ import annotations

import os
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
from devtool.packaging import stage_tools  # noqa: E402

HELD = {
    "argus_tools/__init__.py": "",
    "argus_tools/argusd": "a program",
    "argus_tools/argusd-licences.txt": "words",
    "hil_sim/core/libargus.so": "a library",
    "argus-1.data/data/share/argus_ros/launch/argus.launch.xml": "<launch/>",
    "argus-1.dist-info/RECORD": "",
    "argus-1.dist-info/entry_points.txt": "[console_scripts]\nargusctl = argus_tools.control.cli:main\n",
}


def test_the_debian_tools_are_those_of_the_wheel_without_argusd(tmp_path: Path) -> None:
    wheel = tmp_path / "argus-1-py3-none-any.whl"
    with zipfile.ZipFile(wheel, "w") as archive:
        for name, text in HELD.items():
            archive.writestr(name, text)
    stage = tmp_path / "stage"
    stage_tools(wheel, stage)
    found = {path.relative_to(stage).as_posix() for path in stage.rglob("*") if path.is_file()}
    assert found == {
        "bin/argusctl",
        "lib/argus_tools/__init__.py",
        "lib/hil_sim/core/libargus.so",
        "share/argus_ros/launch/argus.launch.xml",
        "lib/argus-1.dist-info/INSTALLER",
        "lib/argus-1.dist-info/entry_points.txt",
    }
    assert os.access(stage / "bin/argusctl", os.X_OK)
    assert "from argus_tools.control.cli import main" in (stage / "bin/argusctl").read_text(encoding="utf-8")
