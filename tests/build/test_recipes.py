# SPDX-License-Identifier: MIT
"""Rule: constants, words, maxima and rows of a choice agree; who follows the recipe of DESIGN has a policy or a robot."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
HEADER = Path("firmware/include/argus/argus.h")
PLAN = Path("firmware/adjustment/plan.h")
ROBOTS = Path("hil_sim/tables/robots")
sys.path.insert(0, str(ROOT / "tools"))

import gen_docs  # noqa: E402
import gen_tables  # noqa: E402

VARIANT = """# SPDX-License-Identifier: MIT
# A P3-DX that carries a box.
inherits = "p3dx-sh"

[identity]
subclass = "p3dx-box"

[body]
front_mm = 260
corners_mm = [[260, 212.5], [-301, 212.5], [-301, -212.5], [260, -212.5]]
"""


def text_of(root: Path, path: Path) -> str:
    return (root / path).read_text(encoding="utf-8")


def setting(key: str) -> tuple[list[str], int]:
    """Return the words of a setting and its maximum."""
    for name, _, _, high, _, choices, *_ in gen_docs.rows("include/argus/argus.h", "ARGUS_CONFIG_TABLE"):
        if name == key:
            return choices.split("|"), int(high)
    raise AssertionError(key)


def constants(prefix: str) -> list[str]:
    """Return the constants of an enumeration, or of defines, in order, as words: LEAST_TURN is least-turn."""
    found = re.findall(
        rf"^(?:    |#define ){prefix}_(\w+)(?:,| +//|\n| \d+ )", text_of(ROOT, HEADER), re.MULTILINE
    )
    return [name.lower().replace("_", "-") for name in found]


def test_policies_have_one_order() -> None:
    words, high = setting("policy")
    rows = gen_docs.rows("adjustment/plan.h", "ARGUS_POLICY_TABLE")
    assert words == constants("ARGUS_POLICY")
    assert words == [row[1] for row in rows]
    assert words == [row[0].lower().replace("_", "-") for row in rows]
    assert high == len(words) - 1


def test_profiles_have_one_order() -> None:
    words, high = setting("profile")
    assert words == constants("ARGUS_PROFILE")
    assert high == len(words) - 1


def test_robots_have_one_order() -> None:
    words, high = setting("robot")
    assert words == ["by-subclass", *(robot.name for robot in gen_tables.read_robots(ROOT))]
    assert high == len(words) - 1


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    for folder in ("firmware", "hil_sim", "tools"):
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=shutil.ignore_patterns("__pycache__"))
    return tmp_path


def change(root: Path, path: Path, pattern: str, new: str) -> None:
    text, count = re.subn(pattern, new, text_of(root, path), count=1)
    assert count == 1, pattern
    (root / path).write_text(text, encoding="utf-8")


def generate(root: Path) -> None:
    words = [sys.executable, str(ROOT / "tools/gen_tables.py"), "--root", str(root)]
    subprocess.run(words, check=True, capture_output=True)


def built(root: Path) -> Path:
    """Compile the core of a tree as libargus.so."""
    library = root / "libargus.so"
    sources = [*sorted((root / "firmware").rglob("*.c")), root / "tools/core_shim.c"]
    words = ["cc", "-std=c11", "-O1", "-Wall", "-Werror", "-fPIC", "-shared", f"-I{root / 'firmware'}"]
    words += [f"-I{root / 'firmware/include'}", "-o", str(library), *map(str, sources)]
    done = subprocess.run(words, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return library


DRIVE = """
import sys
sys.meta_path = [finder for finder in sys.meta_path if "editable" not in type(finder).__module__]  # not the checkout
from hil_sim.sil import Mission, run
outcome = run(Mission("lab", ((3000.0, 0.0),), faults=("off:3",), limit_s=20.0, robot=sys.argv[2],
                      config={"policy": sys.argv[1], "robot": sys.argv[2]}))
print([event.name for event in outcome.events])
"""


def drive(root: Path, policy: str, robot: str) -> str:
    """Drive a mission by the emulator and the core of a tree; return the names of its events."""
    environment = {
        **os.environ,
        "ARGUS_CORE": str(built(root)),
        "PYTHONPATH": f"{root}{os.pathsep}{root / 'tools'}",
    }
    words = [sys.executable, "-c", DRIVE, policy, robot]
    done = subprocess.run(words, check=False, capture_output=True, text=True, env=environment, cwd=root)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.soak
def test_a_policy_is_added_by_its_recipe(tree: Path) -> None:
    row = r"(    X\(ADAPTIVE, [^\n]*\))\n"
    change(tree, PLAN, row, r'\1 \\\n    X(HASTY, "hasty", 0, 1, 1, 1, "stops cost nothing")\n')
    change(
        tree,
        HEADER,
        r"    ARGUS_POLICY_ADAPTIVE( [^\n]*)\n",
        r"    ARGUS_POLICY_ADAPTIVE,\1\n    ARGUS_POLICY_HASTY\n",
    )
    change(tree, HEADER, r"X\(policy, 4, 0, 4,", "X(policy, 4, 0, 5,")
    change(tree, HEADER, r"\|ring\|adaptive", "|ring|adaptive|hasty")
    assert "SESSION_OPEN" in drive(tree, "hasty", "p3dx-sh")


@pytest.mark.soak
def test_a_robot_of_ten_lines_is_added_by_its_recipe(tree: Path) -> None:
    (tree / ROBOTS / "p3dx-box.toml").write_text(VARIANT, encoding="utf-8")
    generate(tree)
    change(tree, HEADER, r"X\(robot, 0, 0, 4,", "X(robot, 0, 0, 5,")
    change(tree, HEADER, r"\|p3at-sh\|", "|p3at-sh|p3dx-box|")
    assert "SESSION_OPEN" in drive(tree, "adaptive", "p3dx-box")


def test_a_robot_that_inherits_from_itself_is_refused(tmp_path: Path) -> None:
    for name, other in (("a", "b"), ("b", "a")):
        (tmp_path / ROBOTS).mkdir(parents=True, exist_ok=True)
        (tmp_path / ROBOTS / f"{name}.toml").write_text(f'inherits = "{other}"\n', encoding="utf-8")
    with pytest.raises(gen_tables.TableError, match="inherits from itself"):
        gen_tables.load(tmp_path, "robots/a")


def test_a_robot_that_inherits_nothing_known_is_refused(tmp_path: Path) -> None:
    (tmp_path / ROBOTS).mkdir(parents=True)
    (tmp_path / ROBOTS / "a.toml").write_text('inherits = "none"\n', encoding="utf-8")
    with pytest.raises(gen_tables.TableError, match="no such table"):
        gen_tables.load(tmp_path, "robots/a")


def test_a_variant_differs_in_what_it_says_alone(tmp_path: Path) -> None:
    shutil.copytree(ROOT / ROBOTS, tmp_path / ROBOTS)
    (tmp_path / ROBOTS / "p3dx-box.toml").write_text(VARIANT, encoding="utf-8")
    one, other = gen_tables.load(tmp_path, "robots/p3dx-sh"), gen_tables.load(tmp_path, "robots/p3dx-box")
    assert other.keys() == one.keys()
    changed = {(part, key) for part in one for key in one[part] if one[part][key] != other[part][key]}
    assert changed == {
        ("identity", "subclass"),
        *(("body", key) for key in ("front_mm", "corners_mm")),
    }
