# SPDX-License-Identifier: MIT
"""What the CAN tests share: raw frames, an ISO-TP end that misbehaves on demand, interfaces, the bits of a frame."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import json
import random
import select
import shutil
import signal
import socket
import struct
import subprocess
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import cantools.database
from cantools.database import Database
from harness import ARGUSD, PATIENCE_S, PYTHON, ROOT, HilFailure, wait_for

from hil_sim.arcos import Command, frame
from hil_sim.links.can import CanLink
from hil_sim.links.can_spec import PADDING, TO_HOST_ID, TO_ROBOT_ID

_FRAME: Final = struct.Struct("=IB3x8s")
_FD_FRAME: Final = struct.Struct("=IBB2x64s")
_STAMP: Final = struct.Struct("ll")
_SO_TIMESTAMP: Final = 29
_SIOCGIFFLAGS: Final = 0x8913
_SIOCSIFFLAGS: Final = 0x8914

PULSE: Final = frame(Command.none(0).data)
CONTINUE, WAIT, OVERFLOW = 0, 1, 2
DRIVE_WITHIN_S: Final = 300.0


@dataclass(frozen=True)
class Frame:
    """One data frame as a socket gives it."""

    id: int
    data: bytes
    t_s: float = 0.0
    fd: bool = False


class Raw:
    """A CAN_RAW socket: sends, and hears everything but itself."""

    def __init__(self, interface: str, ids: Iterable[int] = (), fd: bool = False) -> None:
        self._socket = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        filters = b"".join(struct.pack("=II", number, 0x7FF) for number in ids)
        if filters:
            self._socket.setsockopt(socket.SOL_CAN_RAW, socket.CAN_RAW_FILTER, filters)
        if fd:
            self._socket.setsockopt(socket.SOL_CAN_RAW, socket.CAN_RAW_FD_FRAMES, 1)
        self._socket.setsockopt(socket.SOL_SOCKET, _SO_TIMESTAMP, 1)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        self._socket.bind((interface,))

    def send(self, number: int, data: bytes, fd: bool = False) -> None:
        """Send a frame, a classic one or one of CAN FD."""
        content = (
            _FD_FRAME.pack(number, len(data), 0, data)
            if fd
            else _FRAME.pack(number, len(data), data.ljust(8, b"\0"))
        )
        try:
            self._socket.send(content)
        except OSError as error:
            # A socket tells once that its interface was down, though it is up again.
            if error.errno != errno.ENETDOWN:
                raise
            self._socket.send(content)

    def receive(self, timeout_s: float) -> Frame | None:
        """The next frame, or None."""
        if not select.select([self._socket], [], [], max(0.0, timeout_s))[0]:
            return None
        try:
            content, extra, _, _ = self._socket.recvmsg(72, 64)
        except OSError as error:
            if error.errno != errno.ENETDOWN:
                raise
            return None
        seconds, micros = next(_STAMP.unpack(data) for _, kind, data in extra if kind == _SO_TIMESTAMP)
        if len(content) == _FRAME.size:
            number, length, data = _FRAME.unpack(content)
            return Frame(number, data[:length], seconds + micros / 1e6)
        number, length, _, data = _FD_FRAME.unpack(content)
        return Frame(number, data[:length], seconds + micros / 1e6, fd=True)

    def wait(self, what: str, probe: Callable[[Frame], bool], timeout_s: float = PATIENCE_S) -> Frame:
        """The next frame for which `probe` is true."""
        until = time.monotonic() + timeout_s
        while (found := self.receive(until - time.monotonic())) is not None:
            if probe(found):
                return found
        raise HilFailure(f"not on the bus within {timeout_s:g} s: {what}")

    def drain(self) -> list[Frame]:
        """Everything that has come."""
        found = []
        while (one := self.receive(0.0)) is not None:
            found.append(one)
        return found

    def fileno(self) -> int:
        """The socket."""
        return self._socket.fileno()

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()


def first_frame(length: int, data: bytes) -> bytes:
    """Begin a message of `length` bytes with the first six of `data`."""
    return bytes((0x10 | length >> 8, length & 0xFF)) + data[:6]


def consecutive(number: int, data: bytes) -> bytes:
    """Frame `number` of a message, with up to seven bytes of it."""
    return (bytes((0x20 | number & 0xF,)) + data[:7]).ljust(8, bytes((PADDING,)))


def flow_control(status: int = CONTINUE, blocksize: int = 0, stmin: int = 0) -> bytes:
    """What a receiver answers to a first frame."""
    return bytes((0x30 | status, blocksize, stmin)).ljust(8, bytes((PADDING,)))


@dataclass
class Manners:
    """How an `End` behaves; the counts are used up."""

    answers: list[int | None] = field(default_factory=list)
    """Flow control statuses for the next first frames; None: say nothing. Empty: continue."""
    skip: int = 0
    """Consecutive frames to leave out."""
    wrong: int = 0
    """Consecutive frames to number wrongly."""


class End:
    """One end of an ISO-TP connection, made of raw frames, with the manners of a test."""

    def __init__(self, interface: str, tx_id: int, rx_id: int) -> None:
        self.raw = Raw(interface, [rx_id])
        self.tx_id = tx_id
        self.manners = Manners()
        self.heard: list[bytes] = []
        self._partial = bytearray()
        self._length = 0

    @classmethod
    def host(cls, interface: str, robot: int = 0) -> End:
        """The host's end."""
        return cls(interface, TO_ROBOT_ID + robot, TO_HOST_ID + robot)

    @classmethod
    def robot(cls, interface: str, robot: int = 0) -> End:
        """The robot's end."""
        return cls(interface, TO_HOST_ID + robot, TO_ROBOT_ID + robot)

    def _take(self, data: bytes) -> bytes | None:
        """Digest a frame; return its kind if it is a flow control, and note what became complete."""
        kind = data[0] >> 4
        if kind == 0:
            self.heard.append(data[1 : 1 + data[0]])
        elif kind == 1:
            self._length = (data[0] & 0xF) << 8 | data[1]
            self._partial = bytearray(data[2:])
            status = self.manners.answers.pop(0) if self.manners.answers else CONTINUE
            if status is not None:
                self.raw.send(self.tx_id, flow_control(status))
        elif kind == 2:
            self._partial += data[1:]
            if self._length and len(self._partial) >= self._length:
                self.heard.append(bytes(self._partial[: self._length]))
                self._length = 0
        else:
            return data
        return None

    def pump(self, seconds: float, until: Callable[[], bool] = lambda: False) -> None:
        """Take part in the traffic for a while."""
        end = time.monotonic() + seconds
        while not until() and (left := end - time.monotonic()) > 0:
            got = self.raw.receive(min(left, 0.05))
            if got is not None and got.data:
                self._take(got.data)

    def receive(self, timeout_s: float = PATIENCE_S) -> bytes:
        """The next message."""
        self.pump(timeout_s, lambda: bool(self.heard))
        if not self.heard:
            raise HilFailure(f"no message within {timeout_s:g} s")
        return self.heard.pop(0)

    def send(self, pdu: bytes, timeout_s: float = PATIENCE_S) -> bool:
        """Send a message with the manners asked for; False: the other end sent no flow control."""
        if len(pdu) <= 7:
            self.raw.send(self.tx_id, (bytes((len(pdu),)) + pdu).ljust(8, bytes((PADDING,))))
            return True
        self.raw.send(self.tx_id, first_frame(len(pdu), pdu))
        answer: list[bytes] = []

        def answered() -> bool:
            got = self.raw.receive(0.02)
            if got is not None and (control := self._take(got.data)) is not None:
                answer.append(control)
            return bool(answer)

        until = time.monotonic() + timeout_s
        while not answered():
            if time.monotonic() > until:
                return False
        number = 0
        for at in range(6, len(pdu), 7):
            number += 1
            if self.manners.skip:
                self.manners.skip -= 1
                continue
            off = 3 if self.manners.wrong else 0
            self.manners.wrong -= bool(self.manners.wrong)
            self.raw.send(self.tx_id, consecutive(number + off, pdu[at:]))
        return True

    def close(self) -> None:
        """Close the socket."""
        self.raw.close()


# the robot's link -------------------------------------------------------------------------------------------


def packet(size: int) -> bytes:
    """An ARCOS packet of that size."""
    return frame(random.Random(size).randbytes(size - 5))


class Served:
    """A link in a thread, as the emulator's loop calls it."""

    def __init__(self, link: CanLink) -> None:
        self.link = link
        self.got: list[bytes] = []
        self._out: deque[bytes] = deque()
        self._lock = threading.Lock()
        self._loop = Background(self._step)

    def _step(self) -> None:
        self.link.wait(20)
        now_ms = time.monotonic() * 1000
        self.got += list(self.link.receive(now_ms))
        while self._out:
            self.link.send(self._out.popleft(), now_ms)
        self.link.transmit(now_ms)

    def send(self, data: bytes) -> None:
        """Have the link send a packet."""
        self._out.append(data)

    def wait_packet(self, data: bytes) -> None:
        """Wait until the link has taken this packet."""
        wait_for(f"{len(data)} bytes at the robot, not only {self.got}", lambda: data in self.got, PATIENCE_S)

    def wait_error(self, name: str) -> None:
        """Wait until that error is counted."""
        wait_for(
            f"error {name}, not only {dict(self.link.errors)}", lambda: self.link.errors[name], PATIENCE_S
        )

    def end(self) -> None:
        """End the thread and the link."""
        self._loop.end()
        self.link.close()


# interfaces -------------------------------------------------------------------------------------------------


def ip(*words: str) -> None:
    """Run ip; the tests have a network of their own, and are root in it."""
    subprocess.run(["ip", *words], check=True, capture_output=True, text=True)


def set_up(name: str, up: bool) -> None:
    """Take an interface up or down, faster than ip can be started."""
    with socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW) as control:
        request = struct.pack("16sh14x", name.encode(), 0)
        (flags,) = struct.unpack("16xh14x", fcntl.ioctl(control, _SIOCGIFFLAGS, request))
        flags = flags | 1 if up else flags & ~1
        fcntl.ioctl(control, _SIOCSIFFLAGS, struct.pack("16sh14x", name.encode(), flags))


def tc(*words: str) -> None:
    """Run tc."""
    done = subprocess.run(["tc", *words], check=False, capture_output=True, text=True)
    if done.returncode:
        raise HilFailure(f"tc {' '.join(words)}: {done.stderr.strip()}")


@contextlib.contextmanager
def interface(name: str, *options: str) -> Iterator[str]:
    """An interface of a test's own, up."""
    ip("link", "add", name, *options, "type", "vcan")
    ip("link", "set", name, "up")
    try:
        yield name
    finally:
        with contextlib.suppress(subprocess.CalledProcessError):
            ip("link", "del", name)


class Dump:
    """candump -L of an interface into a file."""

    def __init__(self, interface: str, file: Path) -> None:
        program = shutil.which("candump")
        if program is None:
            raise HilFailure("candump is missing: run tools/dev test --only can, which installs can-utils")
        self.file = file
        self._out = file.open("wb")
        self._process = subprocess.Popen(
            [program, "-L", interface], stdin=subprocess.DEVNULL, stdout=self._out, stderr=subprocess.PIPE
        )
        wait_for(
            "candump listens",
            lambda: Path("/proc/net/can/rcvlist_all").read_text().count(interface),
            PATIENCE_S,
        )

    def end(self) -> list[str]:
        """End it and return the lines."""
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)
            self._process.wait(PATIENCE_S)
            self._out.close()
        return self.file.read_text().splitlines()


def parse_dump(lines: Iterable[str]) -> list[Frame]:
    """Read the lines of candump -L."""
    frames = []
    for line in lines:
        stamp, _, text = line.split()
        number, _, data = text.partition("#")
        is_fd = data.startswith("#")
        content = bytes.fromhex(data[2:] if is_fd else data)
        frames.append(Frame(int(number, 16), content, float(stamp.strip("()")), is_fd))
    return frames


# bits -------------------------------------------------------------------------------------------------------


def crc15(bits: str) -> int:
    """CRC of a classic frame, over its bits from start-of-frame to the last data bit."""
    crc = 0
    for bit in bits:
        feedback = int(bit) ^ crc >> 14
        crc = crc << 1 & 0x7FFF
        if feedback:
            crc ^= 0x4599
    return crc


def stuffed_bits(one: Frame) -> int:
    """Bits that a classic 11-bit frame takes on the wire: stuffing as it is, and the 3 bits between frames."""
    head = f"0{one.id:011b}000{len(one.data):04b}" + "".join(f"{byte:08b}" for byte in one.data)
    text = head + f"{crc15(head):015b}"
    count, run, last = 0, 0, ""
    for bit in text:
        run = run + 1 if bit == last else 1
        last = bit
        count += 1
        if run == 5:
            # The bit put in is the opposite one, and begins the next run.
            count, run, last = count + 1, 1, "1" if bit == "0" else "0"
    return count + 1 + 2 + 7 + 3  # CRC delimiter, acknowledge, end of frame, intermission


def worst_bits(one: Frame) -> int:
    """The most bits that a frame of that length can take, whatever is in it."""
    body = 34 + 8 * len(one.data)
    return body + (body - 1) // 4 + 10 + 3


# processes --------------------------------------------------------------------------------------------------


@contextlib.contextmanager
def running(*words: str) -> Iterator[subprocess.Popen[bytes]]:
    """A program that is ended at the end."""
    process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    try:
        yield process
    finally:
        process.terminate()
        process.wait(PATIENCE_S)


class Background:
    """Something done again and again in a thread until told to stop."""

    def __init__(self, step: Callable[[], None]) -> None:
        self._stop = threading.Event()
        self._step = step
        self.error: BaseException | None = None
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        try:
            while not self._stop.is_set():
                self._step()
        except BaseException as error:
            self.error = error

    def end(self) -> None:
        """Stop it; raise what it raised."""
        self._stop.set()
        self._thread.join(PATIENCE_S)
        if self.error is not None:
            raise self.error


class Drive:
    """The demonstration over CAN, in the background, with a candump beside it."""

    interface = "vdrive"

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.dump_file = folder / "drive.log"
        ip("link", "add", self.interface, "type", "vcan")
        ip("link", "set", self.interface, "up")
        self._dump = Dump(self.interface, self.dump_file)
        words = [str(PYTHON), "-m", "hil_sim.demo", "--json", "--world", "demo", "--can", self.interface]
        with (folder / "verdict.json").open("wb") as out, (folder / "errors").open("wb") as err:
            self._process = subprocess.Popen(
                [*words, "--out", str(folder), "--argusd", str(ARGUSD)],
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=err,
                cwd=ROOT,
            )

    def verdict(self) -> tuple[int, str]:
        """Exit code and what it said, after its end."""
        code = self._process.wait(DRIVE_WITHIN_S)
        return code, (self.folder / "verdict.json").read_text()

    def errors(self) -> str:
        """What went to standard error."""
        return (self.folder / "errors").read_text(errors="replace")[-1000:]

    def frames(self) -> list[Frame]:
        """Everything that was on the bus."""
        self.verdict()
        return parse_dump(self._dump.end())

    def events(self) -> list[dict[str, Any]]:
        """What argusd said."""
        self.verdict()
        return [json.loads(line) for line in (self.folder / "events.jsonl").read_text().splitlines()]

    def end(self) -> None:
        """End all of it."""
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)
            try:
                self._process.wait(PATIENCE_S)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        self._dump.end()
        ip("link", "del", self.interface)


def load_dbc() -> Database:
    """The description of the telemetry."""
    database = cantools.database.load_file(ROOT / "tools/argus.dbc")
    assert isinstance(database, Database)
    return database
