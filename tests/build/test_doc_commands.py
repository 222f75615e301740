# SPDX-License-Identifier: MIT
"""Rule: each option that a document gives to a program of ours is one that the program has."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Final, NamedTuple

import forks
import pytest

ROOT: Final = Path(__file__).resolve().parents[2]
PAST: Final = {"CHANGELOG", "experiments-log"}
DOCUMENTS: Final = sorted(
    path for path in (*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")) if path.stem not in PAST
)
PROGRAMS: Final = {path.stem for path in (ROOT / "docs/man").glob("*.1")}
CODE: Final = re.compile(r"^```\w*\n(.*?)^```|^ {4}(.*?)$|`([^`\n]+)`", re.MULTILINE | re.DOTALL)
OPTION: Final = re.compile(r"(--[a-z][a-z-]*)(?:=.*)?")
# What has options of its own that no manual page lists.
GROUPS: Final = {"bench", "experiment"}


class Command(NamedTuple):
    """A program, what stands for its group of options, and the options given."""

    program: str
    group: tuple[str, ...]
    options: tuple[str, ...]


def commands(text: str) -> Iterator[Command]:
    """Yield the commands in the code of a document."""
    for match in CODE.finditer(text):
        for line in (match[1] or match[2] or match[3] or "").splitlines():
            for part in re.split(r"[|;&]+", line.partition(" #")[0]):
                words = [word.strip("\"'`,()") for word in part.split()]
                names = [word.rpartition("/")[2] for word in words]
                at = next((n for n, name in enumerate(names[:3]) if name in PROGRAMS), None)
                if at is None:
                    continue
                words = words[at + 1 :]
                if "--ros-args" in words:
                    words = words[: words.index("--ros-args")]
                is_group = len(words) > 1 and words[0] in GROUPS and not words[1].startswith("-")
                group = tuple(words[: 1 + (words[0] == "bench")]) if is_group else ()
                given = tuple(found[1] for word in words if (found := OPTION.fullmatch(word)))
                yield Command(names[at], group, given)


@cache
def told(program: str, group: tuple[str, ...]) -> str:
    """What the program says of its options."""
    page = (ROOT / f"docs/man/{program}.1").read_text(encoding="utf-8").replace("\\-", "-")
    if group:
        done = forks.run_text("hil_sim.cli.main:main", *group, "--help")
        assert done.returncode == 0, done.stderr
        return done.stdout
    # `argus-sim --monitor` hands over what it does not know.
    return page if program != "argus-sim" else page + told("argus-monitor", ())


def has(command: Command, option: str) -> bool:
    return re.search(rf"(?<![\w-]){option}(?![\w-])", told(command.program, command.group)) is not None


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.stem)
def test_options_in_documents_are_those_of_the_programs(path: Path) -> None:
    found = commands(path.read_text(encoding="utf-8"))
    wrong = [(command, option) for command in found for option in command.options if not has(command, option)]
    assert not wrong


def test_commands_are_found_wherever_they_stand() -> None:
    text = (
        "`argusd --chekc`\n\n    .venv/bin/argus-log faults --exit-zero x # --no\n\n"
        "```sh\na | argusctl --socket x\nargus-sim bench laser --seeds 1\n```\n"
    )
    assert list(commands(text)) == [
        Command("argusd", (), ("--chekc",)),
        Command("argus-log", (), ("--exit-zero",)),
        Command("argusctl", (), ("--socket",)),
        Command("argus-sim", ("bench", "laser"), ("--seeds",)),
    ]
    assert sum(len(list(commands(path.read_text(encoding="utf-8")))) for path in DOCUMENTS) > 200
