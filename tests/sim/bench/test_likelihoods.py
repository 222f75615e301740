# SPDX-License-Identifier: MIT
"""Rule: the tables of likelihoods are what the recorded drives give, and nothing is written into them by hand.

The counts are made up from the seed that a test prints; one test records two drives and counts for itself.
"""

from __future__ import annotations

import numpy as np
import pytest

from hil_sim.bench import likelihoods
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
