# SPDX-License-Identifier: MIT
"""Rule: the tables of likelihoods are what the recorded drives give, and nothing is written into them by hand.

The counts are made up from the seed that a test prints; one test records two drives and counts for itself.
"""

from __future__ import annotations

import argparse
import ctypes
import dataclasses
import re
import shutil
import subprocess
import tomllib
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from hil_sim.bench import cli_passive, likelihoods
from hil_sim.bench.likelihoods import CLASSES, FILE, TABLES, VERDICTS, Tally
from hil_sim.cli.main import main
from hil_sim.errors import SimError
from hil_sim.sil import FaultTruth

CONTRADICTED, AGREED, UNSEEN = (VERDICTS.index(name) for name in ("CONTRADICTED", "AGREED", "UNSEEN"))
SIZE = len(VERDICTS)


def made(seed: int) -> Tally:
    print(f"seed {seed}")
    rng = np.random.default_rng(seed)
    tally = Tally()
    for table in TABLES:
        for name in CLASSES:
            tally.add(table, name, [rng.integers(0, 3000, (SIZE, SIZE))])
    return tally


def recorded(whole: bool) -> Callable[[argparse.Namespace], AbstractContextManager[tuple[list[Path], bool]]]:
    @contextmanager
    def there(arguments: argparse.Namespace) -> Iterator[tuple[list[Path], bool]]:
        yield [], whole

    return there


@pytest.mark.parametrize("seed", range(3))
def test_a_file_gives_its_counts_back(seed: int) -> None:
    tally = made(seed)
    again = likelihoods.from_toml(likelihoods.to_toml(tally, "some command"))
    for table in TABLES:
        for name in CLASSES:
            assert (again.counts[table][name] == tally.counts[table][name]).all()


def test_the_file_of_the_project_is_that_of_its_counts() -> None:
    likelihoods.from_toml(FILE.read_text(encoding="utf-8"))


def test_a_cell_that_was_changed_by_hand_is_refused() -> None:
    text = likelihoods.to_toml(made(4), "some command")
    head, _, tail = text.rpartition("-1")
    with pytest.raises(SimError, match="measure anew"):
        likelihoods.from_toml(f"{head}-2{tail}")


@pytest.mark.parametrize("text", ["", "[lag]\n", "[lag.count.healthy]\nrows = [[1]]\n"])
def test_a_file_that_lacks_something_is_refused(text: str) -> None:
    with pytest.raises(SimError, match="measure anew"):
        likelihoods.from_toml(text)


def test_what_comes_as_often_either_way_tells_nothing() -> None:
    counts = made(5).counts["lag"]["healthy"]
    assert not likelihoods.log_ratio(counts, counts).any()
    assert not likelihoods.log_ratio(counts, 10 * counts).any()


def test_what_comes_e_times_as_often_is_a_nat() -> None:
    other = np.full((SIZE, SIZE), 100_000, dtype=np.int64)
    one = other.copy()
    one[CONTRADICTED, AGREED] = round(100_000 * np.e)
    ratio = likelihoods.log_ratio(one, other)
    share = one[CONTRADICTED] / one[CONTRADICTED].sum() * SIZE
    assert ratio[CONTRADICTED, AGREED] == pytest.approx(100 * np.log(share[AGREED]), abs=1)
    assert (ratio[:, UNSEEN] == 0).all(), "no sonar looked there"
    assert (np.delete(ratio, CONTRADICTED, axis=0) == 0).all()


def test_a_row_that_hardly_came_tells_nothing() -> None:
    few = np.zeros((SIZE, SIZE), dtype=np.int64)
    few[CONTRADICTED, AGREED] = likelihoods.LEAST - 1
    many = np.full((SIZE, SIZE), 1000, dtype=np.int64)
    assert not likelihoods.log_ratio(few, many).any()


@pytest.mark.parametrize("seed", range(3))
def test_only_a_contradicted_ping_speaks_for_a_lag(seed: int) -> None:
    tally = made(seed)
    for over in ("healthy", "other"):
        assert (np.delete(likelihoods.cells(tally, "lag", over), CONTRADICTED, axis=0) <= 0).all()
        assert (likelihoods.cells(tally, "lag", over)[CONTRADICTED] > 0).any()


def test_shares_that_differ_are_said() -> None:
    tally = made(6)
    assert not likelihoods.differences(tally, tally)
    turned = Tally()
    for table in TABLES:
        for name in CLASSES:
            turned.add(table, name, [tally.counts[table][name] ** 3 // 10**6])
    assert likelihoods.differences(tally, turned)


@pytest.mark.parametrize(
    ("text", "lags", "offsets"),
    [
        ("slow:3:n=5", [4], []),
        ("wrong:3:angle=15", [], [3, 4]),
        ("wrong:3:angle=-25", [], [0]),
        ("off:3", [], []),
    ],
)
def test_a_fault_is_of_its_hypotheses(text: str, lags: list[int], offsets: list[int]) -> None:
    truth = FaultTruth(text.split(":", maxsplit=1)[0], 3, text, 1.0, 0.0)
    assert likelihoods.right_lags(truth) == lags
    assert likelihoods.right_offsets(truth) == offsets


@pytest.mark.soak
def test_a_small_run_bears_the_tables_out() -> None:
    assert (
        main(
            ["bench", "likelihoods", "--check", "--worlds", "office", "--seeds", "1", "--kinds", "slow,wrong"]
        )
        == 0
    )


@pytest.mark.parametrize("words", [["--write", "--check"], ["--kinds", "pair"], ["--seeds", "x"]])
def test_wrong_words_are_refused(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    try:
        code = main(["bench", "likelihoods", *words])
    except SystemExit as left:
        code = int(left.code or 0)
    assert code == 2
    assert capsys.readouterr().err


ROOT = Path(__file__).resolve().parents[3]


@pytest.mark.parametrize(
    ("file", "number"),
    [
        ("numbers.h", ""),
        ("numbers.h", r"X\(LEAST_LAG, "),
        ("numbers.h", r"X\(LAGS, "),
        ("numbers.h", r"X\(OFFSETS, "),
        ("crosscheck.c", "SAME, "),
    ],
)
def test_counts_of_another_size_are_not_compiled(file: str, number: str, tmp_path: Path) -> None:
    tree = tmp_path / "firmware"
    shutil.copytree(ROOT / "firmware", tree)
    source = tree / "awareness/crosscheck.c"
    for edit in likelihoods.OBSERVED.edits:
        source.write_text(edit.apply(source.read_text()))
    changed = tree / "awareness" / file
    text = re.sub(
        f"({number})([0-9]+|(?=SAYINGS))",
        "\\g<1>1\\g<2>" if file == "numbers.h" else "SAME, A_NEW_ONE, ",
        changed.read_text(),
        count=1,
    )
    changed.write_text(text if number else changed.read_text())
    words = ["cc", "-std=c11", "-w", "-fsyntax-only", f"-I{tree}", f"-I{tree / 'include'}", str(source)]
    said = subprocess.run(words, capture_output=True, text=True, check=False).stderr
    assert ("static assertion failed" in said) == bool(number), said


def test_a_fault_that_shows_from_the_start_is_counted_from_there() -> None:
    truth = dataclasses.replace(FaultTruth("off", 3, "off:3", 0.0, 0.0), first_visible_s=0.0)
    observer = likelihoods.Observer.__new__(likelihoods.Observer)
    shape = (2, likelihoods.HYPOTHESES, SIZE, SIZE)
    observer._observed = (ctypes.c_int32 * int(np.prod(shape)))()
    observer._sonar, observer._from_ms, observer._to_ms = (
        ctypes.c_int32(),
        ctypes.c_uint32(),
        ctypes.c_uint32(),
    )
    observer._engine = SimpleNamespace(replay=lambda *_: None)  # type: ignore[assignment]
    none = np.zeros(0, dtype=np.uint32)
    stream = SimpleNamespace(truth=(truth,), end_s=60.0, times_ms=none, lengths=none, data=b"")
    observer.count(stream)  # type: ignore[arg-type]
    assert (observer._from_ms.value, observer._to_ms.value) == (0, 60_000)


def test_the_command_is_that_of_the_arguments_and_names_no_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    written: list[str] = []
    monkeypatch.setattr(cli_passive, "_recorded", recorded(whole=True))
    monkeypatch.setattr(likelihoods, "observe", lambda paths: made(7))
    monkeypatch.setattr(cli_passive, "_write", lambda path, text: written.append(text))
    words = [
        f"--streams={tmp_path}",
        "--write",
        "--jobs=1",
        "--kinds",
        "slow,off",
        "--worlds",
        f"{tmp_path}/a,gen-*",
    ]
    assert cli_passive.likelihoods([*words, "--physics=rough-day"]) == 0
    assert tomllib.loads(written[0])["command"] == (
        "argus-sim bench likelihoods --worlds 'a,gen-*' --seeds 1-2 --kinds slow,off --physics rough-day"
    )
    likelihoods.from_toml(written[0])


def test_nothing_is_written_when_a_mission_failed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    written: list[Path] = []
    monkeypatch.setattr(cli_passive, "_recorded", recorded(whole=False))
    monkeypatch.setattr(likelihoods, "observe", lambda paths: made(8))
    monkeypatch.setattr(cli_passive, "_write", lambda path, text: written.append(path))
    assert cli_passive.likelihoods(["--write"]) == 1
    assert not written
    assert "likelihoods.toml stays as it is" in capsys.readouterr().err


@pytest.mark.parametrize("mode", [[], ["--write"], ["--check"]])
@pytest.mark.parametrize("missing", ["sources", "compiler"])
def test_what_it_is_built_with_is_asked_for_before_anything_is_recorded(
    mode: list[str], missing: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(cli_passive, "_recorded", lambda arguments: pytest.fail("it records"))
    if missing == "sources":
        monkeypatch.setattr("hil_sim.core.build._TREE", ROOT / "nowhere")
    else:
        monkeypatch.setenv("CC", "/no/such/compiler")
    assert main(["bench", "likelihoods", *mode]) == 2
    error = capsys.readouterr().err
    assert ("run it in a checkout" if missing == "sources" else "no C compiler") in error
    assert error.count("\n") == 1
