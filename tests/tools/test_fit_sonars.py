# SPDX-License-Identifier: MIT
"""Rule: tools/fit_sonars.py finds in recordings what was put into them, and refuses what tells nothing."""

from __future__ import annotations

import json
import math
import random
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
from bags import START, TABLE, cloud, write

ROOT = Path(__file__).resolve().parents[2]
SEED = 45
STEP_MM = 3.43


def fit(*words: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, str(ROOT / "tools/fit_sonars.py"), *map(str, words)],
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )


def still_bag(path: Path) -> Path:
    """A ring at rest, each value held for three messages: sonars 0 to 3 quiet, 4 to 7 half the time a step late."""
    rng, sent, held = random.Random(SEED), [], [1000.0 + 100 * k for k in range(TABLE.sonars)]
    for n in range(240):
        for k in range(8):
            if (n + k) % 3 == 0:
                late = STEP_MM if k >= 4 and rng.random() < 0.3 else 0.0
                held[k] = round(1000.0 + 100 * k + late)
        sent.append(cloud(START + n * 0.1067, list(held)))
    return write(path, sent)


def stops(path: Path, missed: dict[int, float]) -> Path:
    """Stops before a wall all round at 2 m; each sonar misses it as often as `missed` says."""
    rng, rows = random.Random(SEED), []
    for _ in range(80):
        points = []
        for k, mount in enumerate(TABLE.mounts[:8]):
            far, turn = (5000.0 if rng.random() < missed[k] else 2000.0), math.radians(mount.heading_deg)
            x, y = mount.x_mm + far * math.cos(turn), mount.y_mm + far * math.sin(turn)
            points.append([x / 1000, y / 1000])
        rows.append({"sonar": points, "scan": [2.0] * 512, "pose": [0, 0, 0]})
    path.write_text(json.dumps(rows), encoding="utf-8")
    return path


def table_of(found: subprocess.CompletedProcess[str]) -> dict[str, Any]:
    assert found.returncode == 0, found.stderr
    return tomllib.loads(found.stdout)


def test_it_finds_what_was_put_in(tmp_path: Path) -> None:
    missed = {k: 0.1 * k for k in range(8)}
    before = (ROOT / "hil_sim/tables/recorded.toml").read_bytes()
    table = table_of(
        fit("--bags", still_bag(tmp_path / "a.bag"), "--stops", stops(tmp_path / "s.json", missed))
    )
    rest = table["rest"]
    assert rest["step_mm"] == pytest.approx(STEP_MM, abs=0.6), f"seed {SEED}"
    assert rest["jitter_mm"] == [0] * 8
    assert rest["late"][:4] == [0] * 4
    assert all(0.1 < late < 0.5 for late in rest["late"][4:])
    assert rest["firings"] > 8 * 60
    for found, want in zip(table["silence"]["by_sonar"], missed.values(), strict=True):
        assert found == pytest.approx(want, abs=4 * math.sqrt(max(want, 0.02) / 80)), f"seed {SEED}"
    assert (ROOT / "hil_sim/tables/recorded.toml").read_bytes() == before, "without --write it writes nothing"


def test_the_committed_table_has_what_the_emulator_draws_from() -> None:
    table = tomllib.loads((ROOT / "hil_sim/tables/recorded.toml").read_text(encoding="utf-8"))
    assert all(0 <= share <= 1 for share in [*table["rest"]["late"], *table["silence"]["by_sonar"]])
    assert max(table["silence"]["by_sonar"]) > 6 * min(table["silence"]["by_sonar"])
    assert 3.3 < table["rest"]["step_mm"] < 3.6


@pytest.mark.parametrize(
    ("text", "says"), [("[]", "laser"), ("{", "property name"), ('[{"scan": []}]', "sonar")]
)
def test_what_tells_nothing_is_refused(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "s.json"
    path.write_text(text, encoding="utf-8")
    found = fit("--bags", still_bag(tmp_path / "a.bag"), "--stops", path)
    assert (found.returncode, found.stdout) == (2, "")
    assert found.stderr.startswith("fit_sonars: ")
    assert says in found.stderr
    assert len(found.stderr.splitlines()) == 1
    assert fit("--bags", tmp_path / "none.bag").returncode == 2
    assert fit().returncode == 2
