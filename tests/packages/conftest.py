# SPDX-License-Identifier: MIT
"""What is tested here: the wheel and the Debian packages, as `tools/dev package` makes them, once for all tests."""

from __future__ import annotations

import os
import shutil
import venv
from pathlib import Path

import pytest
from packages_help import DIST, run


@pytest.fixture(scope="session")
def wheel() -> Path:
    """The wheel for this machine."""
    [found] = DIST.glob(f"argus_p3dx-*manylinux*_{os.uname().machine}.whl")
    return found


@pytest.fixture(scope="session")
def debs() -> dict[str, Path]:
    """The Debian packages by name."""
    found = {path.name.split("_")[0]: path for path in DIST.glob("*.deb")}
    assert found, "make them: tools/dev package deb"
    return found


@pytest.fixture(scope="session")
def clean_venv(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A virtual environment that holds the wheel and what it asks for, and nothing of this tree."""
    folder = tmp_path_factory.mktemp("venv")
    venv.create(folder, with_pip=True)
    run(folder / "bin/python", "-m", "pip", "install", "-q", "--disable-pip-version-check", wheel, cwd=folder)
    return folder


@pytest.fixture(scope="session")
def unpacked(debs: dict[str, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """All Debian packages unpacked into one folder."""
    if shutil.which("dpkg-deb") is None:
        pytest.skip("dpkg-deb is not installed")
    folder = tmp_path_factory.mktemp("debs")
    for deb in debs.values():
        run("dpkg-deb", "-x", deb, folder)
    return folder
