# SPDX-License-Identifier: MIT
"""Links to a client: a pseudo-terminal paced like a wire, TCP, a real UART; and the loop that serves one."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import random
import select
import socket
import struct
import termios
import time
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, Final

from hil_sim.arcos import TIMING
from hil_sim.errors import LinkError, SimError
from hil_sim.link_faults import LinkFaults
from hil_sim.record import Kind, Recorder
from hil_sim.server import ArcosServer

_BITS: Final = TIMING["BITS_PER_BYTE"]
_GRAIN_MS: Final = 4.0
"""Bytes on a wire are handed over at least this often, and at the end of what is being sent."""
BACKLOG_MS: Final = 200.0
"""A packet that would wait longer than this for the wire is not sent, as by a robot out of buffers."""
_RX_LIMIT: Final = 4096
_TX_LIMIT: Final = 65536
IDLE_MS: Final = 20.0
"""Time passes for a robot at least this often, so that several in one thread do not all do it when a SIP is due."""
_GAP_MS: Final = 500.0
"""A longer silence of the clock (the process was suspended, or starved) is taken out of the robot's time."""
LATE_MS: Final = 100.0
"""A turn that comes later than this after it was due is told: a SIP may have come a whole cycle late."""

_SPEEDS: Final = {
    getattr(termios, name): int(name[1:])
    for name in dir(termios)
    if name.startswith("B") and name[1:].isdigit() and name != "B0"
}
_SPEED_CODE: Final = {rate: code for code, rate in _SPEEDS.items()}


class Wire:
    """One direction of a serial line in virtual time: bytes go in at once, come out at 10 bit times each."""

    def __init__(self, baud: int) -> None:
        self.baud = baud
        self.length = 0
        self._runs: deque[tuple[bytearray, int, float]] = deque()
        self._free_ms = 0.0

    @property
    def byte_ms(self) -> float:
        """Time one byte takes."""
        return _BITS * 1000 / self.baud

    @property
    def backlog_ms(self) -> float:
        """Time the bytes inside still take."""
        return self.length * self.byte_ms

    def push(self, data: bytes, now_ms: float, tag: int = 0) -> None:
        """Put bytes on the line; `tag` comes out with them (the sender's rate)."""
        if data:
            self._runs.append((bytearray(data), tag, now_ms))
            self.length += len(data)

    def _next_ms(self) -> float:
        """When the first byte inside is complete."""
        return max(self._runs[0][2], self._free_ms) + self.byte_ms

    def pop(self, now_ms: float) -> list[tuple[bytes, int]]:
        """Return what has arrived by now, in runs of one tag."""
        out: list[tuple[bytes, int]] = []
        now_ms += 1e-6
        while self._runs and (first_ms := self._next_ms()) <= now_ms:
            run, tag, _ = self._runs[0]
            count = min(len(run), 1 + int((now_ms - first_ms) / self.byte_ms))
            out.append((bytes(run[:count]), tag))
            del run[:count]
            if not run:
                self._runs.popleft()
            self.length -= count
            self._free_ms = first_ms + (count - 1) * self.byte_ms
        return out

    def due_ms(self) -> float | None:
        """When `pop` is worth calling: a grain from the next byte, or when the run's last byte is through."""
        if not self._runs:
            return None
        first_ms = self._next_ms()
        return first_ms + min(_GRAIN_MS, (len(self._runs[0][0]) - 1) * self.byte_ms)


class Link(ABC):
    """A way to a client. All methods return at once but `wait`."""

    @abstractmethod
    def open(self) -> None:
        """Make the link ready for a client."""

    @abstractmethod
    def receive(self, now_ms: float) -> Iterable[bytes]:
        """Yield runs of bytes that have arrived; call `set_baud` between runs if they change the rate."""

    @abstractmethod
    def send(self, packet: bytes, now_ms: float) -> None:
        """Take a packet to send; it may be lost if nobody listens."""

    @abstractmethod
    def transmit(self, now_ms: float) -> None:
        """Hand over what is due."""

    def set_baud(self, baud: int) -> None:  # noqa: B027 (only a wire has a rate)
        """The robot's side changes to this rate."""

    def due_ms(self) -> float | None:
        """When the link next needs a call though nothing arrives."""
        return None

    def take_lost(self) -> bool:
        """Tell once that the connection to the client was lost; a wire cannot."""
        return False

    def hang_up(self) -> None:  # noqa: B027 (only a connection can be closed)
        """Close the connection to the client, not the link."""

    def summary(self) -> str:
        """What went wrong, for a report; empty on a link that cannot tell."""
        return ""

    @abstractmethod
    def readers(self) -> list[Any]:
        """What to wait on for input."""

    def wait(self, timeout_ms: float) -> None:
        """Sleep until input or the timeout."""
        with contextlib.suppress(InterruptedError):
            select.select(self.readers(), [], [], max(0.0, timeout_ms) / 1000)

    @property
    @abstractmethod
    def address(self) -> str:
        """What a client is to open."""

    @abstractmethod
    def close(self) -> None:
        """Release everything; further calls are no-ops."""


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
        self._master = -1
        self._keeper = -1
        self._path = ""
        self._present = False
        self._probe_ms = 0.0
        self._poll = select.poll()
        self.lost_bytes = 0
        self.lost_packets = 0

    def open(self) -> None:
        """Create the pseudo-terminal and its symlink."""
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

        The kernel tells (POLLHUP) only while nobody else holds the client's side, so our own hold, which
        keeps the settings reachable, is let go for a moment. A client's exclusive mode would lock us out (and
        everyone, after the client's death): it is lifted and put back.
        """
        exclusive = False
        if self._keeper >= 0:
            flag = fcntl.ioctl(self._keeper, _TIOCGEXCL, b"\0\0\0\0")
            exclusive = struct.unpack("i", flag)[0] != 0
            if exclusive:
                fcntl.ioctl(self._keeper, termios.TIOCNXCL)
            os.close(self._keeper)
            self._keeper = -1
        hung_up = any(event & select.POLLHUP for _, event in self._poll.poll(0))
        with contextlib.suppress(OSError):
            self._keeper = os.open(self._path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        if exclusive and not hung_up and self._keeper >= 0:
            fcntl.ioctl(self._keeper, termios.TIOCEXCL)
        if hung_up and self._present:
            self._drain_master(now_ms)
        if hung_up and self._present and self._keeper >= 0:
            # What nobody will read must not greet the next client; a UART forgets it too.
            termios.tcflush(self._keeper, termios.TCIFLUSH)
            self._make_raw()
        self._present = not hung_up
        self._probe_ms = now_ms + (100.0 if self._present else 20.0)

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
        for fd in (self._keeper, self._master):
            if fd >= 0:
                os.close(fd)
        self._keeper = self._master = -1
        self._path = ""


_TIOCGEXCL: Final = 0x80045440


class TcpLink(Link):
    """A TCP port, one client at a time: a second one is turned away, or finds nobody listening (`deaf`)."""

    def __init__(self, host: str, port: int, deaf: bool = False) -> None:
        self._deaf = deaf
        self._lost = False
        self._host = host
        self._port = port
        self._listener: socket.socket | None = None
        self._client: socket.socket | None = None
        self._pending = bytearray()

    def open(self) -> None:
        """Listen."""
        self._listen()

    def _listen(self) -> None:
        try:
            family = socket.getaddrinfo(self._host, self._port, type=socket.SOCK_STREAM)[0][0]
            listener = socket.create_server((self._host, self._port), family=family, backlog=1)
        except (OSError, OverflowError) as error:
            reason = getattr(error, "strerror", None) or error
            raise LinkError(
                f"--tcp {self._host}:{self._port}: {reason}; choose another host or port"
            ) from error
        listener.setblocking(False)
        self._listener = listener
        self._port = listener.getsockname()[1]

    @property
    def address(self) -> str:
        """HOST:PORT."""
        return f"{self._host}:{self._port}"

    def _accept(self) -> None:
        if self._listener is None:
            self._listen()
        assert self._listener is not None
        try:
            client, _ = self._listener.accept()
        except OSError:
            return
        if self._client is not None:
            client.close()
            return
        client.setblocking(False)
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._client = client
        self._pending.clear()
        if self._deaf:
            self._listener.close()
            self._listener = None

    def _drop_client(self) -> None:
        if self._client is not None:
            self._client.close()
            self._client = None
            self._lost = True

    def take_lost(self) -> bool:
        """Tell once that the connection to the client was lost."""
        lost, self._lost = self._lost, False
        return lost

    def hang_up(self) -> None:
        """Close the connection to the client; the next one may come at once."""
        self._drop_client()
        if self._listener is None:
            self._listen()

    def receive(self, now_ms: float) -> Iterable[bytes]:  # noqa: ARG002 (Link's shape)
        """Yield what has arrived."""
        while self._client is not None:
            try:
                data = self._client.recv(4096)
            except (BlockingIOError, InterruptedError):
                break
            except OSError:
                data = b""
            if not data:
                self._drop_client()
                break
            yield data
        if self._client is None or self._listener is not None:
            self._accept()

    def send(self, packet: bytes, now_ms: float) -> None:  # noqa: ARG002 (Link's shape)
        """Send, or drop if nobody is connected."""
        if self._client is not None:
            self._pending += packet

    def transmit(self, now_ms: float) -> None:  # noqa: ARG002 (Link's shape)
        """Write what the socket takes; a client that reads nothing for long is dropped."""
        if self._client is None or not self._pending:
            return
        try:
            del self._pending[: self._client.send(self._pending)]
        except (BlockingIOError, InterruptedError):
            if len(self._pending) > _TX_LIMIT:
                self._drop_client()
        except OSError:
            self._drop_client()

    def readers(self) -> list[Any]:
        """The listener and the client."""
        return [item for item in (self._listener, self._client) if item is not None]

    def close(self) -> None:
        """Close both sockets."""
        self._drop_client()
        if self._listener is not None:
            self._listener.close()
            self._listener = None


class SerialLink(Link):
    """A real UART through pyserial; the wire paces and garbles by itself."""

    def __init__(self, device: str, baud: int) -> None:
        self._device = device
        self._baud = baud
        self._port: Any = None

    def open(self) -> None:
        """Open the port for ourselves alone."""
        try:
            import serial
        except ImportError as error:
            raise LinkError("--serial needs pyserial; install it with: pip install pyserial") from error
        try:
            self._port = serial.Serial(self._device, self._baud, timeout=0, write_timeout=1, exclusive=True)
        except (OSError, ValueError) as error:
            raise LinkError(
                f"--serial {self._device}@{self._baud}: {error}; check the device and its rights"
            ) from error

    @property
    def address(self) -> str:
        """DEVICE@BAUD."""
        return f"{self._device}@{self._baud}"

    def receive(self, now_ms: float) -> Iterable[bytes]:  # noqa: ARG002 (Link's shape)
        """Yield what has arrived."""
        try:
            data = self._port.read(4096)
        except OSError as error:
            raise LinkError(f"{self._device}: lost ({error})") from error
        if data:
            yield bytes(data)

    def send(self, packet: bytes, now_ms: float) -> None:  # noqa: ARG002 (Link's shape)
        """Give the packet to the UART."""
        try:
            self._port.write(packet)
        except OSError as error:
            raise LinkError(f"{self._device}: lost ({error})") from error

    def transmit(self, now_ms: float) -> None:
        """Nothing to do: the UART has it."""

    def set_baud(self, baud: int) -> None:
        """Let the last packet out at the old rate, then change."""
        if self._port is not None and baud != self._port.baudrate:
            self._port.flush()
            self._port.baudrate = baud

    def readers(self) -> list[Any]:
        """The port."""
        return [self._port]

    def close(self) -> None:
        """Release the port."""
        if self._port is not None:
            self._port.close()
            self._port = None


def _now_ms() -> float:
    return time.monotonic() * 1000


class Loop:
    """Serves one robot on one link in real time, in one thread."""

    def __init__(
        self,
        server: ArcosServer,
        link: Link,
        faults: LinkFaults | None = None,
        clock_ms: Callable[[], float] = _now_ms,
        recorder: Recorder | None = None,
    ) -> None:
        """`recorder`: gets what is on the link, so after the faults towards the client, before the others."""
        self.server = server
        self.link = link
        self.faults = faults
        self.recorder = recorder
        self._clock_ms = clock_ms
        self._origin_ms = clock_ms() - server.robot.now_ms
        self._last_ms = float(server.robot.now_ms)
        self._baud = server.baud
        self._due_ms: float | None = None
        self._suspended = False
        self.skipped_ms = 0.0
        self.late_max_ms = 0.0
        self.late_turns = 0

    def now_ms(self) -> float:
        """Robot time: the monotonic clock less the time this process was suspended."""
        now = self._clock_ms() - self._origin_ms
        gap = now - self._last_ms
        if gap > _GAP_MS:
            self._origin_ms += gap - _GAP_MS
            self.skipped_ms += gap - _GAP_MS
            now = self._last_ms + _GAP_MS
        self._last_ms = now
        return now

    def turn(self) -> float:
        """Do what is due; return how long the loop may then sleep, in ms."""
        now = self._begin_turn()
        server, link, faults = self.server, self.link, self.faults
        if faults is not None:
            faults.update(now)
        for data in link.receive(now):
            if self.recorder is not None:
                self.recorder.note(Kind.TO_ROBOT, data)
            self._hear(data, now)
        if link.take_lost():
            server.client_gone()
        if faults is not None:
            for data in faults.pop(now, "to_robot"):
                self._to_server(data, now)
        server.advance(now)
        self._follow_baud()
        for packet in server.outgoing():
            if faults is None:
                self._send(packet, now)
            else:
                faults.push(packet, now, "to_client")
        if faults is not None:
            for packet in faults.pop(now, "to_client"):
                self._send(packet, now)
        link.transmit(now)
        if server.take_hang_up():
            link.hang_up()
        rest_ms = self._rest_ms(now)
        self._due_ms = now + rest_ms
        return rest_ms

    def resumed(self) -> None:
        """Tell that this process was suspended on purpose (SIGCONT says so): the next turn is not late."""
        self._suspended = True

    def _begin_turn(self) -> float:
        """Return robot time, and account how late the host is with this turn."""
        skipped_ms = self.skipped_ms
        now = self.now_ms()
        suspended, self._suspended = self._suspended, False
        if self._due_ms is None or suspended:
            return now
        late_ms = now + self.skipped_ms - skipped_ms - self._due_ms
        self.late_max_ms = max(self.late_max_ms, late_ms)
        if late_ms > LATE_MS:
            self.late_turns += 1
            if self.server.log is not None:
                self.server.log("late", {"t_s": now / 1000, "late_ms": round(late_ms, 1)})
        return now

    def _send(self, packet: bytes, now: float) -> None:
        self.link.send(packet, now)
        if self.recorder is not None:
            self.recorder.note(Kind.FROM_ROBOT, packet)

    def _hear(self, data: bytes, now: float) -> None:
        if self.faults is None:
            self._to_server(data, now)
        else:
            self.faults.push(data, now, "to_robot")

    def _to_server(self, data: bytes, now: float) -> None:
        self.server.receive(data, now)
        self._follow_baud()

    def _follow_baud(self) -> None:
        if self.server.baud != self._baud:
            self._baud = self.server.baud
            self.link.set_baud(self._baud)

    def _rest_ms(self, now: float) -> float:
        times = [now + IDLE_MS, self.server.next_due_ms, self.link.due_ms()]
        if self.faults is not None:
            times.append(self.faults.due_ms())
        return max(0.0, min(t for t in times if t is not None) - now)

    def run(self, stop: Callable[[], bool], duration_ms: float | None = None) -> None:
        """Serve until `stop()` or for `duration_ms` of robot time."""
        while not stop() and (duration_ms is None or self._last_ms < duration_ms):
            self.link.wait(self.turn())


class Fleet:
    """Serves several robots, each on its own link, in one thread."""

    def __init__(self, loops: Sequence[Loop], clock_ms: Callable[[], float] = _now_ms) -> None:
        self.loops = list(loops)
        self._clock_ms = clock_ms
        self._due_ms = [0.0] * len(self.loops)

    def turn(self) -> float:
        """Do what is due; return how long all may then sleep, in ms."""
        for k, loop in enumerate(self.loops):
            now = self._clock_ms()
            if self._due_ms[k] <= now:
                self._due_ms[k] = now + loop.turn()
        return min(self._due_ms) - self._clock_ms()

    def wait(self, timeout_ms: float) -> None:
        """Sleep until input or the timeout; who has input is due."""
        owner = {reader: k for k, loop in enumerate(self.loops) for reader in loop.link.readers()}
        with contextlib.suppress(InterruptedError):
            ready, _, _ = select.select(list(owner), [], [], max(0.0, timeout_ms) / 1000)
            for reader in ready:
                self._due_ms[owner[reader]] = 0.0

    def run(self, stop: Callable[[], bool], duration_ms: float | None = None) -> None:
        """Serve until `stop()` or for `duration_ms`."""
        start_ms = self._clock_ms()
        while not stop() and (duration_ms is None or self._clock_ms() - start_ms < duration_ms):
            self.wait(self.turn())
