# SPDX-License-Identifier: MIT
"""Rule: no module of hil_sim imports itself in a circle, none is long, no function tangled; rooms keep order."""

from __future__ import annotations

import ast
from pathlib import Path

import lizard

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "hil_sim"
LINES_MAX = 500
COMPLEXITY_MAX = 10
# From the bottom to the top: a room uses those before it only.
ROOMS = (
    ("arguments", "errors", "output", "program", "start", "version"),
    ("core", "native"),
    ("claim", "document", "tables"),
    ("arcos", "record"),
    ("world",),
    ("sonar", "laser"),
    ("faults",),
    ("robot",),
    ("server",),
    ("links", "scenario"),
    ("sil",),
    ("bench", "demo", "conformance"),
    ("experiment",),
    ("cli",),
    ("programs",),
)


def modules() -> dict[str, Path]:
    found = {}
    for path in FOLDER.rglob("*.py"):
        parts = ["hil_sim", *path.relative_to(FOLDER).with_suffix("").parts]
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports_of(name: str, path: Path, known: dict[str, Path]) -> set[str]:
    """Every module of ours that is named in an import, wherever it stands."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names if alias.name in known}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: imports are written in full"
            for alias in node.names:
                full = f"{node.module}.{alias.name}"
                found |= {full if full in known else str(node.module)} & known.keys()
    return found - {name}


def graph() -> dict[str, set[str]]:
    known = modules()
    return {name: imports_of(name, path, known) for name, path in known.items()}


def circles(edges: dict[str, set[str]]) -> set[str]:
    """What is left when everything that imports nothing left, or that nothing left imports, is taken away."""
    left = set(edges)
    while True:
        used = {target for name in left for target in edges[name] & left}
        keep = {name for name in left if edges[name] & left and name in used}
        if keep == left:
            return left
        left = keep


def room(module: str) -> str:
    return module.split(".")[1] if "." in module else ""


def test_circles_are_seen() -> None:
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}, "e": set()}) == {"a", "b", "c"}
    assert circles({"a": {"b"}, "b": set()}) == set()


def test_no_module_imports_itself_in_a_circle() -> None:
    edges = graph()
    assert len(edges) > 50
    found = circles(edges)
    assert not found, {name: sorted(edges[name] & found) for name in sorted(found)}


def test_a_room_uses_only_those_below_it() -> None:
    level = {name: k for k, names in enumerate(ROOMS) for name in names}
    for module, targets in graph().items():
        for target in targets:
            if room(module) and room(target) and room(module) != room(target):
                assert level[room(target)] < level[room(module)], f"{module} imports {target}"


def test_no_file_is_long() -> None:
    for path in sorted(p for p in FOLDER.rglob("*") if p.suffix in (".py", ".c")):
        count = len(path.read_text(encoding="utf-8").splitlines())
        assert count <= LINES_MAX, f"{path.relative_to(ROOT)}: {count} lines, at most {LINES_MAX}; split it"


def test_no_function_is_tangled() -> None:
    tangled = [
        f"{path.relative_to(ROOT)}:{one.start_line}: {one.name}: {one.cyclomatic_complexity}"
        for path in sorted(p for p in FOLDER.rglob("*") if p.suffix in (".py", ".c"))
        for one in lizard.analyze_file(str(path)).function_list
        if one.cyclomatic_complexity > COMPLEXITY_MAX
    ]
    assert not tangled, "\n".join(tangled)
