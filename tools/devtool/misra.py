# SPDX-License-Identifier: MIT
"""The stage `misra`: what cppcheck's addon finds in firmware/, against the deviations of docs/misra.md."""

from __future__ import annotations

import collections
import re
import subprocess
from collections.abc import Iterable, Mapping
from typing import Final

from devtool.base import BUILD, CORES, ROOT, Run
from devtool.stages import StageFailed

PAGE: Final = ROOT / "docs/misra.md"
ROW: Final = re.compile(r"^\| (\d+\.\d+) \|[^|]*\| ([^|]*) \| ([^|]*\w[^|]*) \|$", re.MULTILINE)
HIT: Final = re.compile(r"^firmware/([\w/.]+):(\d+):misra-c2012-(\d+\.\d+)$")
EVERYWHERE: Final = "all"
SHOWN: Final = 10
CHECKER: Final = ("cppcheck", "--quiet", "--std=c11", "--addon=misra", "--inline-suppr", f"-j{CORES}")
LAYOUT: Final = "--template={file}:{line}:{id}"
SEEN: Final = ("-DARGUS_SONARS=32", "-Ifirmware", "-Ifirmware/include", "firmware")

Hit = tuple[str, int, str]
"""File below firmware/, line, rule."""


def deviations(text: str) -> dict[str, frozenset[str]]:
    """Return the rules that the page TEXT lists with a reason, and the files where each may be broken."""
    return {rule: frozenset(where.split()) for rule, where, _reason in ROW.findall(text)}


def hits_of(lines: Iterable[str]) -> list[Hit]:
    """Return each hit in the LINES of the checker once: it reports a header for each file that includes it."""
    found = (HIT.match(line.strip()) for line in lines)
    return sorted({(hit[1], int(hit[2]), hit[3]) for hit in found if hit})


def beyond(hits: Iterable[Hit], allowed: Mapping[str, frozenset[str]]) -> list[str]:
    """Return the HITS that no deviation allows."""
    return [
        f"firmware/{file}:{line}: rule {rule}"
        for file, line, rule in hits
        if not {file, EVERYWHERE} & allowed.get(rule, frozenset())
    ]


def by_rule(hits: Iterable[Hit]) -> str:
    """Return how often each rule was hit, the most frequent first."""
    counts = collections.Counter(rule for _file, _line, rule in hits)
    return ", ".join(f"{rule}: {count}" for rule, count in counts.most_common())


def misra(run: Run) -> str:
    """Run the checker, and fail on what docs/misra.md does not list."""
    del run
    done = subprocess.run([*CHECKER, LAYOUT, *SEEN], cwd=ROOT, capture_output=True, text=True, check=False)
    lines = (done.stdout + done.stderr).splitlines()
    hits = hits_of(lines)
    (BUILD / "misra.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    if not hits:
        raise StageFailed(
            f"cppcheck found nothing at all (exit code {done.returncode}): its addon did not run"
        )
    found = beyond(hits, deviations(PAGE.read_text(encoding="utf-8")))
    if found:
        more = f" and {len(found) - SHOWN} more in build/misra.txt" if len(found) > SHOWN else ""
        raise StageFailed("; ".join(found[:SHOWN]) + more)
    return f"{len(hits)} hits, each of a listed deviation (docs/misra.md): {by_rule(hits)}"
