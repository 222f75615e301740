# SPDX-License-Identifier: MIT
"""Rule: whatever a YAML file holds, it gives values that know their line, or one line `file:line: ...`; never another
exception, never a hang."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from hil_sim.document import MAX_VALUES, Item, read_document, read_text
from hil_sim.errors import SimError

READERS: dict[str, Callable[[Item], object]] = {
    "mapping": lambda item: item.mapping(("a", "b")),
    "named": Item.named,
    "items": Item.items,
    "text": Item.text,
    "number": Item.number,
    "integer": lambda item: item.integer(0, 9),
    "flag": Item.flag,
    "numbers": lambda item: item.numbers(2, 3),
    "convert": lambda item: item.convert(str.upper),
}


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("document") / "any.yaml"


def assert_one_line(error: SimError, path: Path) -> None:
    text = str(error)
    assert text.startswith(f"{path}:"), text
    assert text.isprintable(), text
    assert len(text) < 600, text
    assert error.exit_code == 2


def everything(item: Item, path: Path) -> None:
    """Ask each value of a document for everything; the answer is a value or a line."""
    for reader in READERS.values():
        try:
            reader(item)
        except SimError as error:
            assert_one_line(error, path)
    assert item.line >= 1
    inner = item.value
    for part in inner.values() if isinstance(inner, dict) else inner if isinstance(inner, list) else []:
        everything(part, path)


yamlish = st.lists(
    st.sampled_from(
        [
            "a: ",
            "b: ",
            "- ",
            "\n",
            "  ",
            "[",
            "]",
            "{",
            "}",
            ", ",
            ": ",
            "&x ",
            "*x",
            "!!bool ",
            "!!int ",
            "!!float ",
            "!!timestamp ",
            "!!binary ",
            "!!set ",
            "!!python/name:os.system ",
            "!!null ",
            '"',
            "'",
            "|",
            ">",
            "%YAML 1",
            "\\UFFFFFFFF",
            "\\0",
            "1e999",
            ".nan",
            "-.inf",
            "0x" + "f" * 5000,
            "9" * 400,
            "1:30",
            "yes",
            "<<",
            "?",
            "---",
            "...",
            "\t",
            "#",
            "\u2028",
            "\x85",
            "2020-99-99",
            "=",
            "~",
        ]
    ),
    max_size=30,
).map("".join)


@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@example("a: !!bool perhaps")
@example("a: !!timestamp never")
@example("a: !!int ''")
@example("a: 0x" + "f" * 6000)
@example("a: " + "9" * 400)
@example("%YAML " + "9" * 5000 + ".1\n---\na: 1")
@example('a: "\\UFFFFFFFF"')
@example('a: "\\U00110000"')
@example('"a\\nb": 1')
@example('a: "\\ud800"')
@example("a: &x [*x]")
@example("[" * 3000)
@example("*x" + "f" * 6000)
@example("? [a]\n: 1")
@given(yamlish | st.text())
def test_any_text_gives_values_or_one_line(file: Path, text: str) -> None:
    file.write_text(text, encoding="utf-8", errors="surrogatepass")
    try:
        item = read_document(file)
    except SimError as error:
        assert_one_line(error, file)
        return
    everything(item, file)


@settings(max_examples=200, deadline=None)
@given(st.binary(max_size=200))
def test_any_bytes_give_values_or_one_line(file: Path, data: bytes) -> None:
    file.write_bytes(data)
    try:
        everything(read_document(file), file)
    except SimError as error:
        assert_one_line(error, file)


def test_aliases_that_stand_for_billions_of_values_are_refused_at_once(tmp_path: Path) -> None:
    lines = ["a: &a [x, x, x, x, x, x, x, x, x]"]
    lines += [f"{c}: &{c} [{', '.join(['*' + chr(ord(c) - 1)] * 9)}]" for c in "bcdefghij"]
    path = tmp_path / "laughs.yaml"
    path.write_text("\n".join(lines))
    with pytest.raises(SimError, match=f"laughs.yaml:[0-9]+: more than {MAX_VALUES} values"):
        read_document(path)


def test_nothing_in_a_document_is_run(tmp_path: Path) -> None:
    mark = tmp_path / "ran"
    path = tmp_path / "evil.yaml"
    path.write_text(f"a: !!python/object/apply:os.system ['touch {mark}']\nb: !!python/name:os.system ''\n")
    with pytest.raises(SimError):
        read_document(path).mapping(("a", "b"))["a"].text()
    assert not mark.exists()


def test_every_value_knows_its_line(tmp_path: Path) -> None:
    path = tmp_path / "lines.yaml"
    path.write_text("# one\na: 1\nb:\n  - x\n  - [1,\n     2]\nc: {d: 3}\nd:\n  5\n")
    top = read_document(path).mapping("abcd")
    assert top["a"].line == 2
    assert [item.line for item in top["b"].items()] == [4, 5]
    assert [item.line for item in top["b"].items()[1].items()] == [5, 6]
    assert top["c"].named()["d"].line == 7
    assert top["d"].line == 8, "a scalar is told by its key"


@pytest.mark.parametrize(
    ("text", "line", "what"),
    [
        ("a: 1\na: 2\n", 2, "given twice"),
        ("a: 1\nq: 2\n", 2, "unknown key 'q'; name one of a, b"),
        ("- 1\n", 1, "expected a mapping"),
        ("", 1, "empty"),
        ("# nothing\n", 1, "empty"),
        ("a: 1\nb: [1, 2\n", 3, "not valid YAML"),
        ("a: *x\n", 1, "undefined alias"),
        ("a: 1\n---\na: 2\n", 2, "another document"),
    ],
)
def test_mistakes_are_reported_where_they_are(tmp_path: Path, text: str, line: int, what: str) -> None:
    path = tmp_path / "bad.yaml"
    path.write_text(text)
    with pytest.raises(SimError, match=what) as caught:
        read_document(path).mapping(("a", "b"))
    assert str(caught.value).startswith(f"{path}:{line}: ")


@pytest.mark.parametrize(
    ("text", "reader"),
    [
        ("true", "number"),
        ("'1'", "number"),
        (".nan", "number"),
        (".inf", "number"),
        ("1000001", "number"),
        ("10", "integer"),
        ("-1", "integer"),
        ("1.0", "integer"),
        ("true", "integer"),
        ("1", "flag"),
        ("'yes'", "flag"),
        ("1", "text"),
        ("[1]", "numbers"),
        ("[1, 2, 3, 4]", "numbers"),
        ("[1, x]", "numbers"),
        ("1", "numbers"),
        ("{a: 1}", "items"),
        ("[a]", "named"),
    ],
)
def test_wrong_types_and_values_are_refused(tmp_path: Path, text: str, reader: str) -> None:
    path = tmp_path / "bad.yaml"
    path.write_text(f"a:\n  {text}\n")
    with pytest.raises(SimError) as caught:
        READERS[reader](read_document(path).mapping("a")["a"])
    assert_one_line(caught.value, path)


@pytest.mark.parametrize("name", ["missing.yaml", ".", "x" * 300 + ".yaml", "nul\0.yaml", "\ud800.yaml"])
def test_files_that_cannot_be_read_are_one_line(tmp_path: Path, name: str) -> None:
    with pytest.raises(SimError) as caught:
        read_text(tmp_path / name)
    assert str(caught.value).isprintable()
    assert "check" in str(caught.value)


def test_what_is_not_utf8_is_said(tmp_path: Path) -> None:
    path = tmp_path / "latin.yaml"
    path.write_bytes(b"about: caf\xe9\n")
    with pytest.raises(SimError, match=r"not UTF-8 text \(byte 10\); save it as UTF-8"):
        read_text(path)


def test_a_readers_complaint_gets_file_and_line_once(tmp_path: Path) -> None:
    path = tmp_path / "c.yaml"
    path.write_text("a: 1\nb: word\n")

    def refuse(text: str) -> None:
        raise SimError(f"'{text}' is wrong")

    with pytest.raises(SimError) as caught:
        read_document(path).mapping("ab")["b"].convert(refuse)
    assert str(caught.value) == f"{path}:2: 'word' is wrong"
