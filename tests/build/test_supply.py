# SPDX-License-Identifier: MIT
"""Rule: a bill of materials names each part with version, licence and age, and two builds that differ are found."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from devtool import supply
from devtool.base import ROOT
from devtool.setup import HEADER
from devtool.stages import StageFailed
from devtool.supply import Part, bill, compare, needed, pinned, python_parts

from hil_sim.version import version

PART = Part("inih", "58-1", "BSD-3-Clause", "pkg:deb/debian/inih@58-1", "2024-01-02", "https://inih.invalid/")


@pytest.mark.parametrize("kind", supply.KINDS)
def test_a_bill_is_cyclonedx_and_the_same_whenever_it_is_made(kind: str) -> None:
    told = bill(kind, [PART], 1_700_000_000)
    assert told == bill(kind, [PART], 1_700_000_000)
    assert (told["bomFormat"], told["specVersion"]) == ("CycloneDX", "1.5")
    assert told["metadata"]["timestamp"] == "2023-11-14T22:13:20+00:00"
    own = told["metadata"]["component"]
    assert own["version"] == version()
    refs = {own["bom-ref"], *(one["bom-ref"] for one in told["components"])}
    assert {one["ref"] for one in told["dependencies"]} <= refs
    assert set(told["dependencies"][0]["dependsOn"]) <= refs
    assert json.loads(json.dumps(told)) == told


def test_another_part_is_another_bill() -> None:
    other = Part("inih", "59-1", "BSD-3-Clause", "pkg:deb/debian/inih@59-1", "")
    assert bill("deb", [PART], 1)["serialNumber"] != bill("deb", [other], 1)["serialNumber"]


def test_each_python_package_of_the_wheel_is_pinned_and_has_a_licence() -> None:
    parts = python_parts()
    assert {"numpy", "pyserial", "mcap"} <= {part.name for part in parts}
    for part in parts:
        assert part.version == pinned()[part.name]
        assert part.licence, f"{part.name}: its metadata tell of no licence"
        assert part.purl == f"pkg:pypi/{part.name}@{part.version}"


def test_the_debian_bill_has_what_its_packages_depend_on_and_nothing_of_pip() -> None:
    text = (ROOT / "cmake/Deb.cmake").read_text(encoding="utf-8")
    found = re.search(r'TOOLS_PACKAGE_DEPENDS\s+"([^"]+)"', text)
    assert found
    wanted = {one.split()[0] for one in found[1].split(", ")}
    parts = supply.parts_of("deb")
    assert {part.name for part in parts if part.name.startswith("python3")} == wanted
    assert all(part.purl.startswith("pkg:deb/debian/") for part in parts)


def test_a_package_is_told_as_dpkg_and_apt_do() -> None:
    told = (
        "Package: python3-rich\nVersion: 13.3.1-1\nDescription: Version: 9\nHomepage: https://rich.invalid/\n"
    )
    assert supply.version_and_home(told) == ("13.3.1-1", "https://rich.invalid/")
    assert supply.version_and_home("Version: 1:2\nHomepage: \n") == ("1:2", "")
    assert supply.version_and_home("") == ("", "")


def test_what_a_package_needs_comes_along_and_nothing_else() -> None:
    assert "python-dateutil" in needed(["matplotlib"])
    assert "pytest" not in needed(["matplotlib"])
    assert needed(["no-such-package"]) == []


def test_a_tree_is_copied_with_a_time_of_its_own(tmp_path: Path) -> None:
    supply.copy_tree(tmp_path / "a", 1_600_000_000)
    copied = tmp_path / "a/firmware/include/argus/argus.h"
    assert copied.stat().st_mtime == 1_600_000_000
    assert copied.read_bytes() == HEADER.read_bytes()
    assert not (tmp_path / "a/build").exists()


def test_a_build_that_differs_is_told_by_its_name() -> None:
    assert "argusd aaaa" in compare({"argusd": "a" * 64}, {"argusd": "a" * 64})
    with pytest.raises(StageFailed, match=r"not the same: argusd"):
        compare({"argusd": "a", "x": "c"}, {"argusd": "b", "x": "c"})
