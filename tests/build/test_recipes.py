# SPDX-License-Identifier: MIT
"""Rule: who follows a recipe of DESIGN has a policy, a robot, a profile or a kind of fault, and the unit tests hold."""

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


@pytest.mark.parametrize(
    ("key", "table"), [("policy", "ARGUS_POLICY_TABLE"), ("profile", "ARGUS_PROFILE_TABLE")]
)
def test_a_word_is_its_constant(key: str, table: str) -> None:
    """The order and the maximum come from the one table; the word of a row is still written beside its name."""
    words, high = setting(key)
    rows = gen_docs.rows("include/argus/argus.h", table)
    assert words == [row[0].lower().replace("_", "-") for row in rows]
    assert high == len(words) - 1 > 0


def test_robots_have_one_order() -> None:
    words, high = setting("robot")
    assert words == ["by-subclass", *(robot.name for robot in gen_tables.read_robots(ROOT))]
    assert high == len(words) - 1


def change(root: Path, path: Path, pattern: str, new: str) -> None:
    text, count = re.subn(pattern, new, text_of(root, path), count=1)
    assert count == 1, pattern
    (root / path).write_text(text, encoding="utf-8")


def run(root: Path, *words: str, **variables: str) -> str:
    environment = {**os.environ, "PYTHONPATH": f"{root}{os.pathsep}{root / 'tools'}", **variables}
    done = subprocess.run(words, check=False, capture_output=True, text=True, env=environment, cwd=root)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def grown(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the tree with a policy, a robot, a profile and a kind more, by the recipes of DESIGN, and its core."""
    root = tmp_path_factory.mktemp("grown") / "tree"
    kept = shutil.ignore_patterns(".*", "build", "dist", "findings", "__pycache__", "*.egg-info")
    shutil.copytree(ROOT, root, ignore=kept)
    if (ROOT / "build/_deps").exists():  # Unity need not be fetched again
        shutil.copytree(ROOT / "build/_deps", root / "build/_deps")
    # A policy and a profile: a row each.
    row = r"(    OR X\(ADAPTIVE, [^\n]*\))\n"
    change(root, HEADER, row, r'\1 \\\n    OR X(HASTY, "hasty", 0, 1, 1, 1, "stops cost nothing")\n')
    row = r"(    OR X\(ARGUS, [^\n]*\))\n"
    change(
        root, HEADER, row, r'\1 \\\n    OR X(BOLD, "bold", 1, 0, 1, "judges as the paper, drives as argus")\n'
    )
    # A robot: a table of ten lines.
    (root / ROBOTS / "p3dx-box.toml").write_text(VARIANT, encoding="utf-8")
    # A kind: a row, and what the emulator does.
    change(
        root, HEADER, r"(    X\(INTERMITTENT, 7, [^\n]*\))\n", r'\1 \\\n    X(DULL, 8, "dull", "reads 0")\n'
    )
    change(
        root, Path("hil_sim/faults/kinds.py"), r"SONAR_KINDS: Final = {\n", r'\g<0>    "dull": "reads 0",\n'
    )
    change(root, Path("hil_sim/faults/grammar.py"), r"_PARAMETERS: Final = {\n", r'\g<0>    "dull": (),\n')
    change(
        root,
        Path("hil_sim/faults/execute.py"),
        r'        if fault.kind == "silent":\n',
        r'        if fault.kind == "dull":\n            return 0\n\g<0>',
    )
    for tool in ("gen_tables", "gen_dbc", "gen_docs"):
        run(root, sys.executable, f"tools/{tool}.py")
    sources = [*sorted((root / "firmware").rglob("*.c")), root / "tools/core_shim.c"]
    words = ["-std=c11", "-O1", "-Wall", "-Werror", "-fPIC", "-shared", "-Ifirmware", "-Ifirmware/include"]
    run(root, "cc", *words, "-o", "libargus.so", *map(str, sources))
    return root


DRIVE = """
import sys
sys.meta_path = [finder for finder in sys.meta_path if "editable" not in type(finder).__module__]  # not the checkout
from hil_sim.sil import Mission, run
policy, robot, profile, fault = sys.argv[1:]
outcome = run(Mission("lab", ((3000.0, 0.0),), faults=(fault,), limit_s=20.0, robot=robot,
                      config={"policy": policy, "robot": robot, "profile": profile}))
print([event.name for event in outcome.events])
"""


@pytest.mark.soak
@pytest.mark.parametrize(
    "chosen",
    [
        ("hasty", "p3dx-sh", "argus", "off:3"),
        ("adaptive", "p3dx-box", "argus", "off:3"),
        ("adaptive", "p3dx-sh", "bold", "off:3"),
        ("adaptive", "p3dx-sh", "argus", "dull:3"),
    ],
    ids=["policy", "robot", "profile", "kind"],
)
def test_what_is_added_by_its_recipe_drives(grown: Path, chosen: tuple[str, ...]) -> None:
    assert "SESSION_OPEN" in run(
        grown, sys.executable, "-c", DRIVE, *chosen, ARGUS_CORE=str(grown / "libargus.so")
    )


UNITS = (
    "adjustment.test_plan",
    "knowledge.test_config",
    "robot.test_robot",
    "knowledge.test_words",
    "hal.board.test_config",
    "hal.linux.argusd.test_settings",
    "hal.linux.argusd.test_inject",
)


@pytest.mark.soak
def test_the_unit_tests_hold_of_what_is_added(grown: Path) -> None:
    run(
        grown,
        "cmake",
        "-S",
        ".",
        "-B",
        "build",
        "-G",
        "Ninja",
        "-DCMAKE_BUILD_TYPE=Debug",
        "-DARGUS_TESTS=ON",
    )
    run(grown, "cmake", "--build", "build", "-j", "2", "--target", "argusd", *UNITS)
    example = run(grown, str(grown / "build/argusd"), "--example-config")
    (grown / "docs/argusd.conf.example").write_text(example, encoding="utf-8")
    for unit in UNITS:
        run(grown, str(grown / "build/tests/unit" / unit))


@pytest.mark.soak
def test_what_is_added_is_in_what_is_generated(grown: Path) -> None:
    assert "`hasty`" in text_of(grown, Path("docs/driving.md"))
    assert '"dull"' in text_of(grown, Path("tools/argus.dbc"))
    assert "by-subclass|p3dx-sh|amigo-sh|p3at-sh|p3dx-box|" in text_of(grown, HEADER)


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
