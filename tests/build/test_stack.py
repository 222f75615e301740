# SPDX-License-Identifier: MIT
"""Rule: the stack figure is the deepest chain of calls, and whatever makes it unbounded is refused."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def node(name: str, size: int, kind: str = "static") -> str:
    return (
        f'node: {{ title: "{name}" label: "{name}\\nx.c:1:1\\n{size} bytes ({kind})\\n0 dynamic objects" }}\n'
    )


def outside(name: str) -> str:
    return f'node: {{ title: "{name}" label: "{name}\\nstring.h:1:1" shape : ellipse }}\n'


def edge(source: str, target: str) -> str:
    return f'edge: {{ sourcename: "{source}" targetname: "{target}" label: "x.c:1:1" }}\n'


def measure(folder: Path, *files: str) -> subprocess.CompletedProcess[str]:
    for number, text in enumerate(files):
        (folder / f"{number}.ci").write_text(text)
    command = [sys.executable, str(ROOT / "tools/size_stack.py"), str(folder)]
    return subprocess.run(command, check=False, capture_output=True, text=True)


def test_deepest_chain_crosses_files(tmp_path: Path) -> None:
    first = (
        node("top", 8)
        + node("x.c:left", 100)
        + edge("top", "x.c:left")
        + edge("top", "right")
        + edge("top", "memcpy")
    )
    second = node("right", 60) + node("leaf", 50) + edge("right", "leaf") + outside("memcpy")
    done = measure(tmp_path, first, second)
    assert done.returncode == 0
    assert "118 top" in done.stdout
    assert "deepest: top 8 > right 60 > leaf 50" in done.stdout
    assert "counted as 0: memcpy" in done.stdout


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (node("a", 8) + node("b", 8) + edge("a", "b") + edge("b", "a"), "recursion: a > b > a"),
        (node("a", 8) + edge("a", "a"), "recursion: a > a"),
        (node("x.c:unused", 8) + edge("x.c:unused", "x.c:unused"), "recursion: unused > unused"),
        (node("a", 8) + edge("a", "__indirect_call"), "a calls through a pointer"),
        (node("a", 8, "dynamic"), "a has a frame of no fixed size"),
        (node("a", 8, "dynamic,bounded"), "a has a frame of no fixed size"),
    ],
)
def test_unbounded_is_refused(tmp_path: Path, text: str, expected: str) -> None:
    done = measure(tmp_path, text)
    assert done.returncode == 1
    assert expected in done.stderr


def test_no_call_graph_is_an_error(tmp_path: Path) -> None:
    assert measure(tmp_path).returncode == 2


def test_real_compiler_output_is_understood(tmp_path: Path) -> None:
    source = tmp_path / "probe.c"
    source.write_text(
        "int deep(volatile char *p);\n"
        "static __attribute__((noinline)) int inner(void) { volatile char a[200]; return deep(a); }\n"
        "int outer(void);\nint outer(void) { volatile char b[100]; b[0] = 1; return inner() + b[0]; }\n"
    )
    flags = ["-O1", "-fcallgraph-info=su,da", "-fno-stack-protector", "-c"]
    subprocess.run(["gcc", *flags, str(source), "-o", str(tmp_path / "probe.o")], check=True, cwd=tmp_path)
    done = measure(tmp_path)
    assert done.returncode == 0, done.stderr
    total = int(done.stdout.split()[0])
    assert 300 <= total < 500
    assert "outer" in done.stdout
    assert "inner" in done.stdout
