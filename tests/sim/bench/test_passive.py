# SPDX-License-Identifier: MIT
"""Rule: a recorded drive-by is judged as if the fault manager were listening now, and a rule of the evidence that is
taken out is really out."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from hil_sim.bench import ablate, cli_passive, passive, variants
from hil_sim.bench.drive import DriveBy, record
from hil_sim.bench.passive import SETTINGS, judge_changes
from hil_sim.bench.plan import mission_of, parse_id
from hil_sim.bench.stream import Stream, load_stream, stream_path
from hil_sim.bench.work import core_digest
from hil_sim.cli.main import main
from hil_sim.core.build import sources
from hil_sim.core.library import library
from hil_sim.core.replay import Change, Engine
from hil_sim.errors import SimError

CASE = "argus/tune/lab/1/stuck"


def engine() -> Engine:
    return Engine(Path(str(library()._name)))


@pytest.fixture(scope="module")
def stream() -> Stream:
    return record(parse_id(CASE))


def bench(*words: str) -> int:
    try:
        return main(["bench", *words])
    except SystemExit as left:
        return int(left.code or 0)


def test_a_replay_is_what_the_manager_did_when_it_listened() -> None:
    mission = mission_of(parse_id(CASE))
    sil = DriveBy(
        type(mission)(
            mission.world,
            (),
            faults=mission.faults,
            seed=mission.seed,
            config={**mission.config, "active": "off"},
            limit_s=60.0,
            stop_at_goal=False,
        ),
        mission.course,
    )
    sil.run()
    recorded = sil.stream(parse_id(CASE))
    changes = engine().replay(
        recorded.times_ms.tobytes(), recorded.lengths.tobytes(), recorded.data, SETTINGS
    )
    then = sorted(
        (int(t * 1000), k, *rest) for k, rows in enumerate(sil.health) for t, *rest in rows if t > 0
    )
    now = sorted((round(c.t_s * 1000), *c[1:]) for c in changes if c.t_s > 0)
    assert now == then
    assert any(change.health == "SUSPECT" for change in changes), "nothing was said: nothing was compared"


def test_a_stream_comes_back_from_its_file(stream: Stream, tmp_path: Path) -> None:
    path = stream_path(tmp_path, CASE)
    stream.save(path)
    again = load_stream(path)
    assert (again.truth, again.data, again.id) == (stream.truth, stream.data, CASE)
    assert (again.readings == stream.readings).all()
    path.write_bytes(path.read_bytes()[:-100])
    with pytest.raises(SimError, match="remove it to record it anew"):
        load_stream(path)


def test_what_is_found_and_what_is_false(stream: Stream) -> None:
    truth = stream.truth[0]
    other = (truth.sonar + 1) % 16
    assert truth.first_visible_s is not None
    found_s = truth.first_visible_s + 2.0
    verdict = judge_changes(
        stream,
        [
            Change(1.0, other, "HEALTHY", ""),
            Change(5.0, other, "SUSPECT", ""),
            Change(6.0, other, "SUSPECT", "slow"),
            Change(7.0, other, "DISABLED", "slow"),
            Change(found_s - 1, truth.sonar, "SUSPECT", "slow"),
            Change(found_s, truth.sonar, "SUSPECT", "stuck"),
        ],
    )
    assert verdict.names == [(6.0, other, "slow")]
    assert verdict.disables == [(7.0, other, "slow")]
    assert verdict.findings[0].latency_s == pytest.approx(2.0)
    assert verdict.findings[0].in_time
    assert verdict.findings[0].named_right
    silent = judge_changes(stream, [])
    assert silent.findings[0].latency_s is None
    assert not silent.findings[0].in_time


def test_every_rule_and_constant_has_its_place() -> None:
    folder = sources() / variants.AWARENESS
    every = {**variants.rules(), **variants.constants()}
    assert len(every) > 50
    for variant in every.values():
        texts: dict[str, str] = {}
        for edit in variant.edits:
            before = texts.get(edit.file, (folder / edit.file).read_text(encoding="utf-8"))
            texts[edit.file] = edit.apply(before)
            assert texts[edit.file] != before, variant.name


def test_a_rule_that_is_gone_is_an_error() -> None:
    edit = variants.Edit("evidence.c", r"^(nothing)$", "")
    with pytest.raises(SimError, match=r"rules\.toml"):
        edit.apply("something")


@pytest.mark.soak
def test_a_rule_on_three_streams(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ("--worlds", "lab", "--seeds", "1", "--kinds", "stuck,garbage,wrong", "--jobs", "1")
    kept = ("--streams", str(tmp_path / "streams"))
    assert bench("ablate", *words, *kept, "--only", "stuck", "--out", str(tmp_path)) == 0
    assert "| `stuck` |" in capsys.readouterr().out
    rows = {row["name"]: row for row in json.loads((tmp_path / "ablation.json").read_text(encoding="utf-8"))}
    assert rows["stuck"]["changed"] > 0, "without its test nothing changed"
    assert rows["stuck"]["lost"] == 1
    assert bench("drive-by", *words, *kept, "--json", str(tmp_path / "f.json")) == 0
    figures = json.loads((tmp_path / "f.json").read_text(encoding="utf-8"))
    assert figures["found"]["stuck"]["in_time"]["hits"] == 1
    assert figures["core"] == core_digest()


def test_worth() -> None:
    assert ablate.sign_test(0, 0) == 1.0
    assert ablate.sign_test(0, 5) == ablate.sign_test(5, 0) == 0.0625
    right = passive.Finding("off", "room", 1.0, "off", True)
    missed = passive.Finding("off", "room", None, "", False)
    whole = [passive.Verdict(str(i), False, 0.1, [right]) for i in range(8)]
    without = [passive.Verdict(str(i), False, 0.1, [missed], [(1.0, 2, "off")]) for i in range(8)]
    variant = variants.Variant("x", "it does", ())
    worth = ablate.compare(variant, whole, without)
    assert (worth.lost, worth.won, worth.ever, worth.names) == (8, 0, 8, 8)
    assert worth.earns
    assert not ablate.compare(variant, without, whole).earns


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["drive-by", "--kinds", "pair"], "one fault at most"),
        (["drive-by", "--physics", "moon"], "moon"),
        (["ablate", "--only", "nothing"], "--only nothing: matches nothing"),
        (["ablate", "--seeds", "3-1"], "is no range of seeds"),
    ],
)
def test_wrong_arguments_give_one_line(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert bench(*words) == 2
    err = capsys.readouterr().err
    assert said in err
    assert err.count("\n") == 1


def test_constants_are_chosen_by_name() -> None:
    options = cli_passive.ablate_parser().parse_args(["--constants", "--only", "ARGUS_OFFSET_N*"])
    names = [variant.name for variant in cli_passive.chosen(options)]
    assert names
    assert all(name.startswith("ARGUS_OFFSET_N") for name in names)
