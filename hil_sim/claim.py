# SPDX-License-Identifier: MIT
"""A name on disk belongs to one living program: a lock beside it, which dies with that (hal/linux/argusd/claim.c)."""

from __future__ import annotations

import fcntl
import os
from contextlib import suppress
from pathlib import Path
from typing import Final

from hil_sim.errors import SimError

_LOCKS: Final = Path("/proc/locks")
_TRIES: Final = 100
"""Each other program that ends just then costs one."""


def holder(fd: int) -> str:
    """Tell which program holds the lock of this open file, as far as the system does."""
    inode = os.fstat(fd).st_ino
    with suppress(OSError):
        for line in _LOCKS.read_text(encoding="ascii", errors="replace").splitlines():
            words = line.split()
            if (
                len(words) > 5
                and words[1] == "FLOCK"
                and words[5].endswith(f":{inode}")
                and int(words[4]) > 0
            ):
                with suppress(OSError):
                    name = (
                        Path(f"/proc/{words[4]}/comm").read_text(encoding="utf-8", errors="replace").strip()
                    )
                    return f"{name}, process {words[4]}"
                return f"process {words[4]}"
    return "another program"


class Claim:
    """The claim on a path. It is held until `release`, or until this process is dead."""

    def __init__(self, path: Path, option: str) -> None:
        """Claim it; SimError says who has it."""
        self._lock = path.with_name(f"{path.name}.lock")
        self._fd = -1
        for _ in range(_TRIES):
            if self._take(path, option):
                return
        raise SimError(f"{option} {path}: {self._lock.name} comes and goes; try again")

    def _take(self, path: Path, option: str) -> bool:
        """Lock the file that has the name; false: it lost the name meanwhile."""
        try:
            fd = os.open(self._lock, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW, 0o600)
        except OSError as error:
            raise SimError(
                f"{option} {path}: {self._lock.name}: {error.strerror}; name a path in a directory you can write"
            ) from error
        try:
            fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            who = holder(fd)
            os.close(fd)
            raise SimError(f"{option} {path}: {who} has it; end that one, or name another") from error
        with suppress(OSError):
            if os.path.samestat(os.fstat(fd), self._lock.lstat()):
                self._fd = fd
                return True
        os.close(fd)
        return False

    def release(self) -> None:
        """Give it back. The file goes while it is locked, so nobody else's is taken away."""
        if self._fd >= 0:
            with suppress(OSError):
                self._lock.unlink()
            os.close(self._fd)
            self._fd = -1
