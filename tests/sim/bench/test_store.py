# SPDX-License-Identifier: MIT
"""Rule: a result that was written is never lost, run again or mixed with those of another build."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from bench.missions import record

from hil_sim.bench.store import META, RESULTS, Store
from hil_sim.errors import SimError

META_A = {"core": "a", "split": "tune"}
ONE, TWO, THREE = (f"argus/tune/office/{seed}/off" for seed in (1, 2, 3))


def fill(folder: Path, *names: str) -> None:
    with Store(folder, META_A, resume=False) as store:
        for name in names:
            store.add(record(name))


def test_what_is_written_is_there_again(tmp_path: Path) -> None:
    fill(tmp_path, ONE, TWO)
    with Store(tmp_path, META_A, resume=True) as store:
        assert store.records == {name: record(name) for name in (ONE, TWO)}
        assert (store.done(ONE), store.done(THREE)) == (True, False)


@pytest.mark.parametrize("cut", [1, 5, 200])
def test_a_torn_last_line_costs_that_mission_only(tmp_path: Path, cut: int) -> None:
    fill(tmp_path, ONE, TWO)
    path = tmp_path / RESULTS
    path.write_bytes(path.read_bytes()[:-cut])
    with Store(tmp_path, META_A, resume=True) as store:
        assert (store.done(ONE), store.done(TWO)) == (True, False)
        store.add(record(TWO))
    lines = path.read_text(encoding="utf-8").splitlines()
    assert [json.loads(line)["id"] for line in lines] == [ONE, TWO]


def test_a_damaged_line_before_the_last_is_named(tmp_path: Path) -> None:
    fill(tmp_path, ONE, TWO, THREE)
    path = tmp_path / RESULTS
    lines = path.read_text(encoding="utf-8").splitlines()
    path.write_text("\n".join([lines[0], lines[1][:40], lines[2], ""]), encoding="utf-8")
    with pytest.raises(SimError, match=f"{RESULTS}:2: "):
        Store(tmp_path, META_A, resume=True)


def test_a_failed_mission_is_not_done_and_a_done_one_stays(tmp_path: Path) -> None:
    with Store(tmp_path, META_A, resume=False) as store:
        store.add(record(ONE, error="it broke"))
        assert not store.done(ONE)
        store.add(record(ONE, t_s=1.0))
        store.add(record(ONE, t_s=2.0))
    with Store(tmp_path, META_A, resume=True) as store:
        assert store.done(ONE)
        assert store.records[ONE]["t_s"] == 1.0


def test_results_are_not_overwritten_unless_asked_for(tmp_path: Path) -> None:
    fill(tmp_path, ONE)
    with pytest.raises(SimError, match="--resume"):
        Store(tmp_path, META_A, resume=False)
    with Store(tmp_path, META_A, resume=False, fresh=True) as store:
        assert not store.done(ONE)


def test_results_of_another_build_are_not_mixed(tmp_path: Path) -> None:
    fill(tmp_path, ONE)
    with pytest.raises(SimError, match="another build"):
        Store(tmp_path, META_A | {"core": "b"}, resume=True)
    with pytest.raises(SimError, match="another version of the bench"):
        Store(tmp_path, META_A | {"format": 3}, resume=True)
    (tmp_path / META).write_text("{", encoding="utf-8")
    with pytest.raises(SimError, match="damaged"):
        Store(tmp_path, META_A, resume=True)


def test_a_folder_that_cannot_be_made_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(SimError, match="--out"):
        Store(tmp_path / "file" / "out", META_A, resume=False)
