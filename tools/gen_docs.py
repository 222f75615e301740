#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fill the generated parts of the documents from the C headers and the DBC file that define them."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import gen_pages  # noqa: E402
import marked  # noqa: E402

from hil_sim.faults.values import UNITS  # noqa: E402

HEADERS = ROOT / "firmware"


def rows(header: str, macro: str) -> list[list[str]]:
    """Arguments of every X(...) of an X-macro table, or of the tables that it is made of, strings without quotes.

    A cell that stands for the words of another table, or for its last row, is these words, or that number.
    """
    text = (HEADERS / header).read_text(encoding="utf-8")
    start = re.search(rf"#define {macro}\(X\b[^)]*\)", text)
    assert start is not None, macro
    body = re.match(r"(?:[^\n]*\\\n)*[^\n]*\n", text[start.end() :])
    assert body is not None
    parts = re.findall(r"\b(\w+_TABLE)\(X\)", body[0])
    if parts:
        return [row for part in parts for row in rows(header, part)]
    joined = re.sub(r'"\s+"', "", body[0].replace("\\\n", " "))  # a string may go on on the next line
    found = re.findall(r"X\(((?:[^()\"]|\"[^\"]*\")*)\)", joined)
    cells = [re.findall(r'\s*("[^"]*"|[^,]+)', row) for row in found]
    return [[_meant(text, header, part.strip().strip('"')) for part in row] for row in cells]


def _meant(text: str, header: str, cell: str) -> str:
    """Return a cell as it is, or what it stands for: the words of a table with a bar between them, or the last row."""
    stands = re.fullmatch(r"(ARGUS_\w+)_(WORDS|LAST)", cell)
    if stands is None:
        return cell
    if written := re.search(rf'^#define {cell} "?([\w|-]+)"?(?: //.*)?$', text, re.MULTILINE):
        return written[1]
    table = rows(header, f"{stands[1]}_TABLE")
    return "|".join(row[1] for row in table) if stands[2] == "WORDS" else str(len(table) - 1)


def _cell(parts: list[str]) -> str:
    return ", ".join(parts).replace("|", "\\|")


def events() -> str:
    """Return the event catalogue as a Markdown table."""
    lines = ["| id | event | level | about | meaning |", "|---|---|---|---|---|"]
    for number, name, level, subject, *meaning in rows("include/argus/argus.h", "ARGUS_EVENT_TABLE"):
        lines.append(f"| {number} | {name} | {level} | {subject} | {_cell(meaning)} |")
    return "\n".join(lines)


def config() -> str:
    """Return the settings as a Markdown table."""
    lines = ["| key | default | range | unit | meaning |", "|---|---|---|---|---|"]
    for key, default, low, high, unit, choices, *meaning in rows(
        "include/argus/argus.h", "ARGUS_CONFIG_TABLE"
    ):
        follows = choices == "auto"  # a number that follows the robot unless it is given
        named = choices.split("|") if choices and not follows else []
        shown = named[int(default)] if named else choices if follows else default
        span = ", ".join(named) if named else f"{low} .. {high}"
        lines.append(f"| {key} | {shown} | {span} | {unit} | {_cell(meaning)} |")
    return "\n".join(lines)


# A frame, its signals, and what is said about them, as they stand in a DBC file.
_FRAME = re.compile(r"^BO_ (\d+) (\w+): (\d+) (\w+)\n((?: SG_ [^\n]*\n)+)", re.MULTILINE)
_SIGNAL = re.compile(r' SG_ (\w+) : (\d+)\|(\d+)@1([+-]) \(1,0\) \[[^\]]*\] "([^"]*)"')
_NUMBERED = re.compile(r"(S)\d\d(_\w+)|([A-Za-z]+)\d")


def _series(signals: list[tuple[str, ...]]) -> list[list[tuple[str, ...]]]:
    """Put signals together that differ in a number only: one for each sonar, one for each rotation."""
    found: dict[str, list[tuple[str, ...]]] = {}
    for signal in signals:
        numbered = _NUMBERED.fullmatch(signal[0])
        stem = "".join(part or "" for part in numbered.groups()) if numbered else signal[0]
        found.setdefault(stem, []).append(signal)
    return list(found.values())


def _bits(series: list[tuple[str, ...]]) -> str:
    starts = [int(signal[1]) for signal in series]
    length = int(series[0][2])
    if len(starts) == 1:
        return f"{starts[0]}" if length == 1 else f"{starts[0]} .. {starts[0] + length - 1}"
    return f"{starts[0]}, {starts[1]} .. {starts[-1]}; {length} each"


def _values(text: str, frame: str, name: str) -> str:
    given = re.search(rf"^VAL_ {frame} {name} (.*) ;$", text, re.MULTILINE)
    pairs = re.findall(r'(\d+) "([^"]*)"', given[1]) if given else []
    if len(pairs) > 16:
        return "see [Events](#events)"
    return ", ".join(f"{value} {word}" for value, word in reversed(pairs))


def can() -> str:
    """Return the CAN frames and their signals as Markdown tables."""
    text = (ROOT / "tools/argus.dbc").read_text(encoding="utf-8")
    comments = dict(re.findall(r'^CM_ ((?:BO_|SG_) \d+(?: \w+)?) "([^"]*)";$', text, re.MULTILINE))
    frames = ["| id | frame | sent by | when |", "|---|---|---|---|"]
    signals = ["| frame | bits | signal | unit, values | meaning |", "|---|---|---|---|---|"]
    for frame, name, _, sender, body in _FRAME.findall(text):
        step = "16 k" if int(frame) >= 0x500 else "k"
        said = _cell([comments.get(f"BO_ {frame}", "")])
        frames.append(f"| 0x{int(frame):03X} + {step} | {name} | {sender} | {said} |")
        for series in _series(_SIGNAL.findall(body)):
            first, last = series[0], series[-1]
            shown = first[0] if first is last else f"{first[0]} .. {last[0]}"
            unit = first[4] or _values(text, frame, first[0]) or ("signed" if first[3] == "-" else "")
            if first[4] and (words := _values(text, frame, first[0])):
                unit = f"{first[4]}; {words}"
            meaning = comments.get(f"SG_ {frame} {first[0]}", "")
            if meaning:  # else the frame is laid out as one before it
                signals.append(
                    f"| {name} | {_bits(series)} | {shown} | {_cell([unit])} | {_cell([meaning])} |"
                )
    return "\n".join([*frames, "", *signals])


def rules() -> str:
    """Return the rules of each profile, and of diagnosis = off, as a Markdown table."""
    groups = ("PAPER", "EVIDENCE", "BEYOND")
    columns = [
        (f"`{word}`", dict(zip(groups, has, strict=False)))
        for _, word, *has in rows("include/argus/argus.h", "ARGUS_PROFILE_TABLE")
    ]
    columns.append(("`diagnosis = off`", {"BEYOND": "1"}))
    lines = [
        f"| rule | {' | '.join(name for name, _ in columns)} | meaning |",
        "|---" * (len(columns) + 2) + "|",
    ]
    for _, rule, group, value, *meaning in rows("knowledge/profile.h", "ARGUS_RULE_TABLE"):
        runs = [value if has.get(group) == "1" else "0" for _, has in columns]
        lines.append(f"| {rule} | {' | '.join(runs)} | {_cell(meaning)} |")
    return "\n".join(lines)


def numbers() -> str:
    """Return the numbers of the evidence that were set by hand, group by group."""
    header = "awareness/numbers.h"
    text = (HEADERS / header).read_text(encoding="utf-8")
    lines = []
    for title, macro in re.findall(
        r"^// (.+)\n#define (ARGUS_(?!NUMBER_)\w+_TABLE)\(X\)", text, re.MULTILINE
    ):
        lines += [
            f"**{title}**",
            "",
            "| name | value | from | what | another value, or without |",
            "|---|---|---|---|---|",
        ]
        for name, value, unit, source, what, trial in rows(header, macro):
            shown = value if unit == "-" else f"{value} {unit}"
            lines.append(f"| `{name}` | {shown} | {source} | {_cell([what])} | {_cell([trial])} |")
        lines.append("")
    return "\n".join(lines).strip()


def policies() -> str:
    """Return the planners as a Markdown table."""
    lines = [
        "| policy | who may look | cost of a stop | of a degree | what it finds |",
        "|---|---|---|---|---|",
    ]
    for _, name, walks, ring, stop, degree, *meaning in rows("include/argus/argus.h", "ARGUS_POLICY_TABLE"):
        who = "every living sonar" if ring == "1" else "those that face forward"
        costs = "- | -" if walks == "1" else f"{stop} | {degree}"
        lines.append(f"| `{name}` | {who} | {costs} | {_cell(meaning)} |")
    return "\n".join(lines)


def health() -> str:
    """Return what may happen to a sonar as a Markdown table."""
    states = {"U": "UNKNOWN", "H": "HEALTHY", "S": "SUSPECT", "D": "DISABLED", "P": "PROBATION"}
    states |= {"T": "STALE", "A": "ABSENT"}
    lines = ["| change | from | to | event | meaning |", "|---|---|---|---|---|"]
    for name, before, after, event, *meaning in rows("knowledge/health.h", "ARGUS_CHANGE_TABLE"):
        known = ", ".join(states[letter] for letter in before)
        said = "" if event == "NONE" else event
        lines.append(f"| {name} | {known} | {after} | {said} | {_cell(meaning)} |")
    return "\n".join(lines)


def reflexes() -> str:
    """Return the reflexes in their order as a Markdown table."""
    lines = ["| reflex | ends the SIP's reflexes | what it sees and does |", "|---|---|---|"]
    for name, last, *meaning in rows("behaviour/reflexes.h", "ARGUS_REFLEX_TABLE"):
        lines.append(f"| {name} | {'yes' if last == '1' else 'no'} | {_cell(meaning)} |")
    return "\n".join(lines)


def modes() -> str:
    """Return the modes as a Markdown table."""
    flags = {"ARGUS_MAY_TURN": "turns", "ARGUS_MAY_TRANSLATE": "drives", "ARGUS_MAY_BREAK_OFF": "broken off"}
    lines = ["| mode | may | ends by itself | meaning |", "|---|---|---|---|"]
    for name, may, limit, after, *meaning in rows("behaviour/mode.h", "ARGUS_MODE_TABLE"):
        shown = ", ".join(word for flag, word in flags.items() if flag in may)
        end = "" if limit == "0" else f"after {limit} ms: {after}"
        lines.append(f"| {name} | {shown} | {end} | {_cell(meaning)} |")
    return "\n".join(lines)


def machine() -> str:
    """Return the ways between the modes as a Markdown table."""
    lines = ["| from | to | when |", "|---|---|---|"]
    for before, after, *when in rows("behaviour/mode.h", "ARGUS_WAY_TABLE"):
        lines.append(f"| {before} | {after} | {_cell(when)} |")
    return "\n".join(lines)


_FORMS = {
    "ANY": "any",
    "INT": "-32767 .. 32767",
    "WORD": "16 bits",
    "STRING": "as many characters as it tells",
}


def _command(first: str, last: str) -> str:
    stem = first.removesuffix("_FIRST")
    return first if first == last else f"all of {stem}" if stem != first else f"{first} to {last}"


def admitted() -> str:
    """Return what a client of a guard port may say as a Markdown table, alike ones in one row."""
    alike: dict[tuple[str, str], list[str]] = {}
    for first, last, _, form, _, *meaning in rows("guardian/admit.h", "ARGUS_CLIENT_TABLE"):
        alike.setdefault((_FORMS[form], _cell(meaning)), []).append(_command(first, last))
    lines = ["| command | argument | what becomes of it |", "| --- | --- | --- |"]
    lines += [f"| {', '.join(names)} | {form} | {meaning} |" for (form, meaning), names in alike.items()]
    return "\n".join(lines)


def example(name: str) -> Callable[[], str]:
    """Return what shows an example in Python, without its licence."""

    def shown() -> str:
        text = (ROOT / f"examples/python/{name}.py").read_text(encoding="utf-8")
        return f"```python\n{text.partition(chr(10))[2].strip()}\n```"

    return shown


def catalogue() -> str:
    """Return the events with what to do."""
    return gen_pages.catalogue(rows("include/argus/argus.h", "ARGUS_EVENT_TABLE"))


def functions() -> str:
    """Return the reference of the C functions."""
    return gen_pages.functions((HEADERS / "include/argus/argus.h").read_text(encoding="utf-8"))


def values() -> str:
    """Return the unit of the value of each event that has one, "" where it is a bare number."""
    lines = []
    for _, name, _, _, *meaning in rows("include/argus/argus.h", "ARGUS_EVENT_TABLE"):
        _, is_there, words = "".join(meaning).partition("value: ")
        unit = next((unit for unit in UNITS if re.search(rf"(^| ){unit}($|[ ,])", words)), "")
        if is_there:
            lines.append(f"{name} {unit}".rstrip())
    return "\n".join(lines)


EXAMPLES = ("drive", "frame", "sweep", "bag", "monitor", "guard")
PARTS = {
    "SPEC.md": {"events": events, "config": config, "can": can},
    "DESIGN.md": {"machine": machine},
    "docs/manager.md": {"modes": modes, "reflexes": reflexes, "rules": rules, "health": health},
    "docs/driving.md": {"policies": policies},
    "docs/guardian.md": {"admitted": admitted},
    "docs/evidence.md": {"numbers": numbers},
    "hil_sim/faults/values.py": {"values": values},
    "docs/events.md": {"catalogue": catalogue},
    "docs/api-c.md": {"functions": functions},
    "docs/python.md": {name: example(name) for name in EXAMPLES},
}


def filled(name: str, text: str) -> str:
    """Return the text of a document with its generated parts renewed."""
    for mark, part in PARTS[name].items():
        text = marked.renewed(name, text, mark, part)
    return text


def main() -> int:
    """Write the documents, or with --check compare them."""
    parser = argparse.ArgumentParser(description=__doc__, epilog="example: tools/gen_docs.py --check")
    parser.add_argument(
        "--check", action="store_true", help="change nothing; exit 1 when a document is out of date"
    )
    arguments = parser.parse_args()
    return marked.update(ROOT, PARTS, filled, arguments.check, "tools/gen_docs.py")


if __name__ == "__main__":
    sys.exit(main())
