# SPDX-License-Identifier: MIT
"""Rule: arrows between Python packages go one way: products rest on the emulator, and no package is in a circle."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

import pytest
from graphs import Graph, circles

ROOT = Path(__file__).resolve().parents[2]
ORDER = ("hil_sim", "argus_tools", "argus", "argus_ros", "devtool", "peers")
"""Each imports of itself and of those before it; argus and argus_ros nothing of each other."""
HOMES = {name: ROOT if name == "hil_sim" else ROOT / "tools" for name in ORDER}


def modules(homes: dict[str, Path]) -> dict[str, Path]:
    """Return each module of some packages by its dotted name."""
    found: dict[str, Path] = {}
    for name, home in homes.items():
        for path in sorted((home / name).rglob("*.py")):
            parts = path.relative_to(home).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imported(name: str, path: Path) -> set[str]:
    """Return the dotted names that a module imports anywhere in it, within functions, too, and by their names."""
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            base = ".".join([*above, *([node.module] if node.module else [])])
            found |= {f"{base}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
            function = (
                node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            )
            if function in ("import_module", "__import__", "run_module"):
                found.add(str(node.args[0].value))
    return found


def arrows(homes: dict[str, Path]) -> Graph:
    """Return for each module those of the same packages that it imports."""
    known = modules(homes)

    def module_of(name: str) -> str:
        while name and name not in known:
            name = name.rpartition(".")[0]
        return name

    return {
        name: {module_of(target) for target in imported(name, path)} - {"", name}
        for name, path in known.items()
    }


@cache
def ours() -> Graph:
    """Return the arrows between our own modules."""
    return arrows(HOMES)


def by_package(graph: Graph, homes: dict[str, Path]) -> Graph:
    """Return the arrows between folders: a module belongs to its folder, a folder's `__init__` to the folder."""
    known = modules(homes)

    def package(name: str) -> str:
        return name if known[name].name == "__init__.py" else name.rpartition(".")[0]

    found: Graph = {}
    for name, targets in graph.items():
        found.setdefault(package(name), set()).update(
            {package(target) for target in targets} - {package(name)}
        )
    return found


def test_no_package_is_in_a_circle() -> None:
    assert [sorted(circle) for circle in circles(by_package(ours(), HOMES))] == []


@pytest.mark.parametrize("package", ORDER)
def test_a_package_imports_none_above_it(package: str) -> None:
    allowed = set(ORDER[: ORDER.index(package) + 1]) - ({"argus"} if package == "argus_ros" else set())
    upwards = {
        f"{name} -> {target}"
        for name, targets in ours().items()
        for target in targets
        if name.split(".")[0] == package and target.split(".")[0] not in allowed
    }
    assert sorted(upwards) == []


def test_the_arrows_are_found() -> None:
    # A graph without arrows has no circles: those that the tools rest on are seen.
    seen = by_package(ours(), HOMES)
    assert {"hil_sim.arcos", "hil_sim.core"} <= set().union(*seen.values())
    assert "hil_sim.core" in seen["hil_sim.sil"]


def test_a_circle_is_found_however_it_is_imported(tmp_path: Path) -> None:
    files = {
        "low/__init__.py": "",
        "low/one.py": "def late():\n    from high import two\n    return two\n",
        "high/__init__.py": "",
        "high/two.py": "import low.one\n",
        "high/deep/__init__.py": "from .. import two\n",
        "high/deep/three.py": "from importlib import import_module\nimport_module('low.one')\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    homes = {"low": tmp_path, "high": tmp_path}
    graph = arrows(homes)
    assert graph["low.one"] == {"high.two"}
    assert graph["high.deep"] == {"high.two"}
    assert "low.one" in graph["high.deep.three"]
    assert circles(by_package(graph, homes)) == {frozenset({"low", "high"})}
