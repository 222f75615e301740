#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Check the subjects of commits: at most 72 characters, no full stop at the end, what changed in plain words."""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).resolve().parent.parent
LONGEST: Final = 72
SINCE: Final = "2026-11-25T16:30:00Z"
"""Earlier subjects are as they are."""

EPILOG: Final = """examples:
  tools/commits.py                          # every commit since the rule holds
  tools/commits.py --message .git/COMMIT_EDITMSG     # as a commit-msg hook

exit codes: 0 all is well, 1 a subject breaks the rule, 2 bad arguments"""


def offence(subject: str) -> str | None:
    """Return what is wrong with a subject."""
    if len(subject) > LONGEST:
        return f"{len(subject)} characters, at most {LONGEST}"
    if not subject.strip():
        return "empty"
    return "ends with a full stop" if subject.endswith(".") else None


def subjects() -> list[tuple[str, str]] | None:
    """Return hash and subject of each commit since the rule holds; None where there is no history."""
    command = ["git", "-C", str(ROOT), "log", f"--since={SINCE}", "--no-merges", "--format=%h%x09%s"]
    try:
        found = subprocess.run(command, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return None
    if found.returncode != 0:
        return None
    return [(line.partition("\t")[0], line.partition("\t")[2]) for line in found.stdout.splitlines()]


def main() -> int:
    """Check the history, or one message."""
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--message", type=Path, metavar="FILE", help="check the message in FILE alone")
    given = parser.parse_args()
    if given.message:
        try:
            lines = given.message.read_text(encoding="utf-8").splitlines()
        except OSError as error:
            parser.error(f"{given.message}: {error.strerror}")
        checked: list[tuple[str, str]] | None = [("message", lines[0] if lines else "")]
    else:
        checked = subjects()
    if checked is None:
        print("no history here: nothing to check")
        return 0
    found = [(name, subject, said) for name, subject in checked if (said := offence(subject))]
    for name, subject, said in found:
        print(f"{name}: {said}: {subject}")
    print(f"{len(checked)} subjects, {len(found)} to mend")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
