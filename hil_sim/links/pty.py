# SPDX-License-Identifier: MIT
"""A pseudo-terminal that behaves like a serial port: paced, garbled at the wrong rate, reopenable."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import random
import select
import struct
import termios
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final

from hil_sim.claim import Claim
from hil_sim.errors import LinkError, SimError
from hil_sim.links.base import BACKLOG_MS, Link
from hil_sim.links.wire import Wire

_RX_LIMIT: Final = 4096
_SPEEDS: Final = {
    getattr(termios, name): int(name[1:])
    for name in dir(termios)
    if name.startswith("B") and name[1:].isdigit() and name != "B0"
}
_SPEED_CODE: Final = {rate: code for code, rate in _SPEEDS.items()}


class PtyLink(Link):
    """A pseudo-terminal that behaves like a serial port: paced, garbled at the wrong rate, reopenable."""

    def __init__(self, baud: int, link_name: str | None = None, seed: int = 0) -> None:
        if baud not in _SPEED_CODE:
            raise SimError(f"--baud {baud}: not a serial rate; use 9600, 19200, 38400, 57600 or 115200")
        self._rng = random.Random(f"garble {seed}")
        self._tx = Wire(baud)
        self._rx = Wire(baud)
        self._baud = baud
        self._link = Path(link_name) if link_name else None
        self._claim: Claim | None = None
        self._master = -1
        self._keeper = -1
        self._path = ""
        self._present = False
        self._probe_ms = 0.0
        self._poll = select.poll()
        self.lost_bytes = 0
        self.lost_packets = 0

    def open(self) -> None:
        """Create the pseudo-terminal and its symlink; SimError where another program has that name."""
        if self._link:
            self._claim = Claim(self._link, "--link-name")
        try:
            self._open()
        except BaseException:
            self.close()
            raise

    def _open(self) -> None:
        try:
            self._master, self._keeper = os.openpty()
        except OSError as error:
            raise LinkError(
                f"no pseudo-terminal to be had ({error.strerror}); is /dev/pts mounted?"
            ) from error
        self._path = os.ttyname(self._keeper)
        os.set_blocking(self._master, False)
        self._poll.register(self._master, 0)
        self._make_raw()
        if self._link:
            self._make_symlink(self._link)

    @property
    def address(self) -> str:
        """The device path."""
        return self._path

    @property
    def present(self) -> bool:
        """Some client has the device open."""
        return self._present

    def _make_symlink(self, link: Path) -> None:
        if os.path.lexists(link) and not link.is_symlink():
            raise SimError(f"--link-name {link}: exists and is not a symlink; name another path")
        fresh = link.with_name(f".{link.name}.{os.getpid()}")
        try:
            fresh.symlink_to(self._path)
            fresh.replace(link)
        except OSError as error:
            raise SimError(
                f"--link-name {link}: {error.strerror}; name a path in a directory you can write"
            ) from error

    def _make_raw(self) -> None:
        """Make the client's side a fresh port: raw, at the robot's rate, so that simple clients just work."""
        iflag, oflag, cflag, lflag, _, _, control = termios.tcgetattr(self._keeper)
        iflag &= ~(
            termios.IGNBRK | termios.BRKINT | termios.PARMRK | termios.ISTRIP | termios.INLCR
            | termios.IGNCR | termios.ICRNL | termios.IXON
        )  # fmt: skip
        oflag &= ~termios.OPOST
        lflag &= ~(termios.ECHO | termios.ECHONL | termios.ICANON | termios.ISIG | termios.IEXTEN)
        cflag = cflag & ~(termios.CSIZE | termios.PARENB) | termios.CS8 | termios.CREAD | termios.CLOCAL
        control[termios.VMIN], control[termios.VTIME] = 1, 0
        speed = _SPEED_CODE[self._baud]
        termios.tcsetattr(self._keeper, termios.TCSANOW, [iflag, oflag, cflag, lflag, speed, speed, control])

    def _probe(self, now_ms: float) -> None:
        """See whether a client has the device open.

        The kernel tells (POLLHUP) only while no other program holds the client's side. So our own hold, which
        keeps the settings reachable, is let go for a moment. A client's exclusive mode would lock us out, and
        after its death all others: it is lifted and put back.
        """
        exclusive = self._let_go()
        hung_up = any(event & select.POLLHUP for _, event in self._poll.poll(0))
        with contextlib.suppress(OSError):
            self._keeper = os.open(self._path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        if exclusive and not hung_up and self._keeper >= 0:
            fcntl.ioctl(self._keeper, termios.TIOCEXCL)
        if hung_up and self._present:
            self._forget(now_ms)
        self._present = not hung_up
        self._probe_ms = now_ms + (100.0 if self._present else 20.0)

    def _forget(self, now_ms: float) -> None:
        """The client has gone: what it left unread must not greet the next one; a UART forgets it too."""
        self._drain_master(now_ms)
        if self._keeper >= 0:
            termios.tcflush(self._keeper, termios.TCIFLUSH)
            self._make_raw()

    def _let_go(self) -> bool:
        """Close our own hold of the client's side; tell whether a client had it in exclusive mode, which is lifted."""
        if self._keeper < 0:
            return False
        flag = fcntl.ioctl(self._keeper, _TIOCGEXCL, b"\0\0\0\0")
        exclusive = bool(struct.unpack("i", flag)[0] != 0)
        if exclusive:
            fcntl.ioctl(self._keeper, termios.TIOCNXCL)
        os.close(self._keeper)
        self._keeper = -1
        return exclusive

    def _client_baud(self) -> int:
        try:
            return _SPEEDS.get(termios.tcgetattr(self._master)[5], 0)
        except termios.error:
            return 0

    def _drain_master(self, now_ms: float) -> None:
        while self._rx.length < _RX_LIMIT:
            try:
                data = os.read(self._master, 1024)
            except (BlockingIOError, InterruptedError):
                return
            except OSError as error:
                if error.errno == errno.EIO:
                    return
                raise LinkError(f"{self._path}: {error.strerror}") from error
            if not data:
                return
            self._present = True
            self._rx.push(data, now_ms, self._client_baud())

    def receive(self, now_ms: float) -> Iterable[bytes]:
        """Yield what has come over the wire, as the robot hears it at its own rate."""
        self._drain_master(now_ms)
        for data, client_baud in self._rx.pop(now_ms):
            yield data if client_baud == self._baud else self._rng.randbytes(len(data))

    def send(self, packet: bytes, now_ms: float) -> None:
        """Put a packet on the wire."""
        if self._tx.backlog_ms > BACKLOG_MS:
            self.lost_packets += 1
            return
        self._tx.push(packet, now_ms)

    def transmit(self, now_ms: float) -> None:
        """Give the client the bytes whose last bit is through."""
        if now_ms >= self._probe_ms:
            self._probe(now_ms)
        for data, _ in self._tx.pop(now_ms):
            if not self._present:
                self._probe(now_ms)
            if not self._present:
                self.lost_bytes += len(data)
                continue
            if self._client_baud() != self._baud:
                data = self._rng.randbytes(len(data))
            try:
                self.lost_bytes += len(data) - os.write(self._master, data)
            except (BlockingIOError, InterruptedError):
                self.lost_bytes += len(data)
            except OSError as error:
                if error.errno != errno.EIO:
                    raise LinkError(f"{self._path}: {error.strerror}") from error
                self.lost_bytes += len(data)

    def set_baud(self, baud: int) -> None:
        """The robot's side changes to this rate, for bytes not yet begun too."""
        self._baud = self._tx.baud = self._rx.baud = baud

    def due_ms(self) -> float | None:
        """The next byte on the wire, or the next look for a client."""
        times = [time_ms for time_ms in (self._tx.due_ms(), self._rx.due_ms()) if time_ms is not None]
        return min([*times, self._probe_ms])

    def readers(self) -> list[Any]:
        """The master side, unless so much is held that the client has to wait."""
        return [self._master] if self._rx.length < _RX_LIMIT else []

    def close(self) -> None:
        """Remove the symlink, if it is still ours, and the device."""
        if self._link and self._path and self._link.is_symlink() and str(self._link.readlink()) == self._path:
            self._link.unlink()
        if self._claim:
            self._claim.release()
        for fd in (self._keeper, self._master):
            if fd >= 0:
                os.close(fd)
        self._keeper = self._master = -1
        self._path = ""


_TIOCGEXCL: Final = 0x80045440
