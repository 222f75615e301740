# SPDX-License-Identifier: MIT
"""Rule: a wait of a test is a guard against what hangs, a minute at least; none asserts that a busy host is quick."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FILES = [path for path in sorted((ROOT / "tests").rglob("*.py")) if "bench" not in path.parts[-3:-1]]
LEAST_S = 60.0
POLL_S = 0.5
"""What is shorter is a turn of a loop that goes on waiting."""
NAMED = {"timeout", "timeout_s", "within_s"}
CALLED = {
    "communicate", "create_connection", "join", "settimeout", "wait", "wait_exit", "wait_for", "wait_rest",
}  # fmt: skip
VIRTUAL = {"Mission", "sil"}
"""Their seconds are those of a robot that is computed, not waited for."""
KNOWN = {
    "tests/ros/test_range_guard.py: monitor_of(timeout_s=2.0)": "a setting of the node that is imitated",
    "tests/ros/test_range_guard.py: watch(timeout_s=2.0)": "likewise",
    "tests/can/bus/canbus.py: wait(20)": "milliseconds: a turn of the robot's loop",
    "tests/target/test_board.py: wait(10)": "a turn of a loop: the next one disturbs the board again",
    "tests/can/bus/test_argusd_link.py: assert_survives(timeout=1)": "a count of errors of this name",
}


def number(node: ast.expr | None) -> float | None:
    """Return what a literal says."""
    return (
        float(node.value)
        if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)) and node.value is not True
        else None
    )


def short(value: float | None) -> bool:
    """Whether a wait is neither a turn of a loop nor a guard."""
    return value is not None and POLL_S < value < LEAST_S


def name_of(node: ast.expr) -> str:
    return node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")


def owner_of(node: ast.expr) -> str:
    return getattr(node.value, "id", "") if isinstance(node, ast.Attribute) else getattr(node, "id", "")


def clock(node: ast.expr) -> bool:
    """Whether an expression asks for the time of this machine."""
    return any(
        isinstance(part, ast.Call) and ast.unparse(part.func) in ("time.monotonic", "time.perf_counter")
        for part in ast.walk(node)
    )


def of_call(node: ast.Call) -> Iterator[str]:
    """The short waits of a call."""
    name = name_of(node.func)
    if owner_of(node.func) in VIRTUAL:
        return
    for keyword in node.keywords:
        if keyword.arg in NAMED and short(value := number(keyword.value)):
            yield f"{name}({keyword.arg}={ast.unparse(keyword.value)})"
    for argument in node.args if name in CALLED else ():
        if short(value := number(argument)):
            yield f"{name}({value:g})"


def of_definition(node: ast.FunctionDef | ast.AsyncFunctionDef) -> Iterator[str]:
    """The short waits that a function takes by itself."""
    positional = [*node.args.posonlyargs, *node.args.args]
    given = [*positional[len(positional) - len(node.args.defaults) :], *node.args.kwonlyargs]
    for argument, default in zip(given, [*node.args.defaults, *node.args.kw_defaults], strict=True):
        if default is not None and argument.arg in NAMED and short(number(default)):
            yield f"{node.name}({argument.arg}={ast.unparse(default)})"


def of_assertion(node: ast.Assert) -> Iterator[str]:
    """Assertions that less than a minute has gone by on the clock of this machine."""
    test = node.test
    if isinstance(test, ast.Compare) and isinstance(test.ops[0], (ast.Lt, ast.LtE)) and clock(test.left):
        limit = number(test.comparators[0])
        if limit is not None and limit < LEAST_S:
            yield f"assert {ast.unparse(test)}"


def wanted_in_vain(tree: ast.Module) -> set[ast.AST]:
    """What stands below `with pytest.raises`: a wait that is to end in vain may be short."""
    return {
        part
        for node in ast.walk(tree)
        if isinstance(node, ast.With) and any("raises(" in ast.unparse(item) for item in node.items)
        for part in ast.walk(node)
    }


def short_waits(source: str) -> list[str]:
    """Return the waits in a test file that a busy host may not keep."""
    found: list[str] = []
    tree = ast.parse(source)
    wanted = wanted_in_vain(tree)
    for node in ast.walk(tree):
        if node in wanted:
            continue
        if isinstance(node, ast.Call):
            found += of_call(node)
        elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            found += of_definition(node)
        elif isinstance(node, ast.Assert):
            found += of_assertion(node)
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add) and clock(node.left):
            found += [ast.unparse(node)] if short(number(node.right)) else []
    return found


def test_no_wait_is_shorter_than_a_busy_host_needs() -> None:
    found = {
        f"{path.relative_to(ROOT).as_posix()}: {wait}"
        for path in FILES
        for wait in short_waits(path.read_text(encoding="utf-8"))
    }
    assert sorted(found - set(KNOWN)) == []
    assert sorted(set(KNOWN) - found) == [], "not so any more: take it from the list"


@pytest.mark.parametrize(
    ("source", "count"),
    [
        ("wait_for('it', lambda: x, 10)", 1),
        ("wait_for('it', lambda: x, PATIENCE_S)", 0),
        ("child.communicate(timeout=30)", 1),
        ("child.communicate(timeout=90)", 0),
        ("stop.wait(0.02)", 0),
        ("sil.wait(1.0)", 0),
        ("with pytest.raises(TimeoutError):\n    robot.drive(timeout_s=1.0)", 0),
        ("def until(self, what, within_s: float = 20.0): ...", 1),
        ("assert time.monotonic() - begun < 2.5", 1),
        ("assert time.monotonic() - begun > 2.5", 0),
        ("end = time.monotonic() + 5", 1),
        ("end = time.monotonic() + 120", 0),
    ],
)
def test_a_short_wait_is_found(source: str, count: int) -> None:
    assert len(short_waits(source)) == count
