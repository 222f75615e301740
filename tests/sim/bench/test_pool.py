# SPDX-License-Identifier: MIT
"""Rule: wherever the missions run, each is run to one record, whatever dies, and the records are the same."""

from __future__ import annotations

import importlib
import multiprocessing
import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from bench.missions import DEADLY, deadly

from hil_sim.bench import pool
from hil_sim.bench.cli import main
from hil_sim.bench.plan import make_cases, parse_id
from hil_sim.bench.store import RESULTS, read_results
from hil_sim.bench.work import core_digest, work, world_files
from hil_sim.world.files import WORLD_DIR

IDS = [case.id for case in make_cases(["argus"], "tune", ["lab"], range(1, 3), ["garbage", "pair"])]

distributed: Any = importlib.import_module("distributed")
pytestmark = pytest.mark.soak

Records = dict[str, dict[str, Any]]


def timeless(records: Records) -> Records:
    """Return the records without the only field that tells of the machine."""
    return {
        name: {key: value for key, value in record.items() if key != "wall_s"}
        for name, record in records.items()
    }


@pytest.fixture(scope="module")
def alone() -> Records:
    """What one process makes of the missions."""
    records = {record["id"]: record for record in pool.run_here(IDS, 1)}
    assert [record["error"] for record in records.values()] == [None] * len(IDS)
    return timeless(records)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of the scheduler of three worker processes."""
    folder = str(tmp_path_factory.mktemp("dask"))
    with distributed.LocalCluster(
        n_workers=3, threads_per_worker=1, processes=True, dashboard_address=None, local_directory=folder
    ) as made:
        yield made.scheduler_address


# ---- this machine -----------------------------------------------------------------------------------------------


def test_a_worker_killed_in_between_costs_nothing(alone: Records) -> None:
    records: list[dict[str, Any]] = []
    for record in pool.run_here(IDS, 2):
        if not records:
            next(iter(multiprocessing.active_children())).kill()
        records.append(record)
    assert sorted(record["id"] for record in records) == sorted(IDS)
    assert timeless({record["id"]: record for record in records}) == alone


def test_only_the_mission_that_kills_its_process_fails() -> None:
    assert DEADLY in IDS
    records = {record["id"]: record for record in pool.run_here(IDS, 2, deadly)}
    assert sorted(records) == sorted(IDS)
    assert [name for name, record in records.items() if record["error"]] == [DEADLY]
    assert "died" in records[DEADLY]["error"]


def test_no_process_is_left() -> None:
    running = pool.run_here(IDS, 2)
    next(running)
    before = multiprocessing.active_children()
    assert before
    running.close()  # type: ignore[attr-defined]
    assert not [child for child in before if child.is_alive()]


# ---- a cluster --------------------------------------------------------------------------------------------------


def test_a_cluster_with_a_worker_killed_gives_the_same_records(cluster: str, alone: Records) -> None:
    records: list[dict[str, Any]] = []
    with distributed.Client(cluster, set_as_default=False) as client:
        pids = sorted(client.run(os.getpid).values())
        assert len(set(pids)) == 3
        assert os.getpid() not in pids
        for record in pool.run_cluster(IDS, cluster, {}, core_digest()):
            if not records:
                os.kill(pids[0], signal.SIGKILL)
            records.append(record)
    assert sorted(record["id"] for record in records) == sorted(IDS)
    assert timeless({record["id"]: record for record in records}) == alone


def test_the_command_runs_on_a_cluster_and_resumes(
    cluster: str, alone: Records, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    words = [
        "bench",
        "diagnosis",
        "--worlds",
        "lab",
        "--kinds",
        "pair",
        "--profiles",
        "argus",
        "--no-plots",
    ]
    words += ["--seeds", "1-2", "--scheduler", cluster, "--out", str(tmp_path)]
    from hil_sim.cli.main import main as argus_sim

    assert argus_sim(words) == 0, capfd.readouterr().err
    path = tmp_path / RESULTS
    whole = path.read_bytes()
    wanted = [name for name in IDS if parse_id(name).kind == "pair"]
    assert len(wanted) == 2
    assert timeless(read_results(path)[0]) == {name: alone[name] for name in wanted}

    lines = whole.splitlines(keepends=True)
    path.write_bytes(b"".join(lines[:-1]))
    assert argus_sim([*words, "--resume"]) == 0
    assert path.read_bytes().startswith(b"".join(lines[:-1]))
    assert len(path.read_bytes().splitlines()) == len(lines)
    assert timeless(read_results(path)[0]) == {name: alone[name] for name in wanted}


def test_a_worker_with_another_fault_manager_is_told(cluster: str) -> None:
    (record,) = pool.run_cluster(IDS[:1], cluster, {}, "0" * 64)
    assert record["id"] == IDS[0]
    assert "another build" in record["error"]


def test_nobody_at_the_address_gives_one_line(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(pool, "CONNECT_S", 0.5)
    words = ["diagnosis", "--scheduler", "tcp://127.0.0.1:1", "--worlds", "lab", "--seeds", "1"]
    assert main([*words, "--out", str(tmp_path)]) == 1
    err = capfd.readouterr().err
    assert "argus-sim: --scheduler tcp://127.0.0.1:1: nobody answers" in err
    assert "Traceback" not in err


def test_a_world_file_goes_along_to_a_machine_without_it(tmp_path: Path) -> None:
    text = (WORLD_DIR / "lab.yaml").read_bytes()
    here = tmp_path / "here.yaml"
    here.write_bytes(text)
    case = parse_id(f"argus/tune/{here}/1/off")
    files = world_files([case])
    record = work(case.id)
    here.unlink()
    again = work(case.id, files)
    assert record["error"] is None
    assert timeless({"": again}) == timeless({"": record})
