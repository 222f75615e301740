# SPDX-License-Identifier: MIT
"""From the chunks of a log to its packets, each with its place and name, and what stands between them."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from struct import Struct
from typing import Final, NamedTuple

from argus_tools.chunks import CLIENT_TO_ROBOT, ROBOT_TO_CLIENT, Chunk, Direction
from hil_sim.arcos import COMMAND, FRAME, TYPE, Unframer, checksum

HEADER: Final = bytes((FRAME["HEADER0"], FRAME["HEADER1"]))
JUNK: Final = "JUNK"
SYNC_NAMES: Final = ("SYNC0", "SYNC1", "SYNC2")
SESSION_NAMES: Final = ("PULSE", "OPEN", "CLOSE")
SIP_TYPES: Final = range(TYPE["SIP_FIRST"], TYPE["SIP_LAST"] + 1)
_OVERHEAD: Final = FRAME["OVERHEAD"]
_COUNT_MIN: Final = FRAME["COUNT_MIN"]
_WORDS: Final = tuple(Struct(f">{words}H").unpack_from for words in range(128))
# Junk is reported in parts of this size, so that no amount of it is held in memory.
_GAP_MAX: Final = 1 << 16
# So many bytes are scanned together; after damage few, doubling as long as there is no more of it.
_WINDOW_MAX: Final = 1 << 16
_WINDOW_MIN: Final = 1 << 10
_BATCH_MAX: Final = 2048
# This many PULSEs or SYNC0s in a row, and nothing else, are not waited behind any longer.
_UNDECIDED_MAX: Final = 16
# SIPs that may still come after a CLOSE before it is taken as not obeyed.
_SIPS_AFTER_CLOSE: Final = 5

COMMAND_NAMES: Final = tuple(
    {number: name for name, number in COMMAND.items() if not name.endswith(("_FIRST", "_LAST"))}.get(
        number, f"CMD_{number}"
    )
    for number in range(256)
)
_NAMED_TYPES: Final = {
    **{TYPE[name]: name for name in SYNC_NAMES},
    **{TYPE[name]: name for name in ("CONFIGPAC", "ENCODERPAC", "IOPAC", "GYROPAC", "PLAYLIST", "SIMSTAT")},
    **{TYPE[name]: name for name in ("SIMLASER", "SIMLASER2")},
    **{TYPE[name]: "SERAUXPAC" for name in ("SERAUXPAC", "SERAUX2PAC", "SERAUX3PAC")},
    **dict.fromkeys(SIP_TYPES, "SIP"),
}
TYPE_NAMES: Final = tuple(_NAMED_TYPES.get(number, f"TYPE_{number}") for number in range(256))


class Row(NamedTuple):
    """One packet, or a stretch of bytes that is none (`ok` false).

    `data` is the packet's data part, from its command or type byte on; of damage, all its bytes.
    `error` says what is wrong with it.
    """

    t: float | None
    offset: int
    dir: Direction
    type: str
    ok: bool
    data: bytes
    error: str = ""

    @property
    def wire(self) -> bytes:
        """The bytes as they were sent."""
        if not self.ok:
            return self.data
        return HEADER + bytes((len(self.data) + 2,)) + self.data + checksum(self.data).to_bytes(2, "big")


def packet_name(direction: Direction, number: int) -> str:
    """Return what a packet is called once the session is open."""
    if direction == ROBOT_TO_CLIENT:
        return TYPE_NAMES[number]
    return SESSION_NAMES[number] if number < len(SESSION_NAMES) else COMMAND_NAMES[number]


class _Tracer(Unframer):
    """An Unframer that also knows where its packets began."""

    def __init__(self, offset: int) -> None:
        super().__init__()
        self._base = offset
        self.starts: list[int] = []

    def reach(self, data: bytes, at: int) -> int:
        """Return how far in the data the next decision looks, if they go on at `at`; as `feed` does it."""
        held = len(self._held)
        start = at
        if not held:
            start = data.find(HEADER[0], at)
            if start < 0 or start - at > _GAP_MAX:
                return min(at + _GAP_MAX, len(data))
        front = bytes(self._held[:3]) + data[start : start + max(0, 3 - held)]
        return len(data) if len(front) < 3 else start + front[2] + _OVERHEAD - held

    def _take(self) -> bytes:
        self.starts.append(self._base + self.counters.junk_bytes)
        data = super()._take()
        self._base += len(data) + 2 + _OVERHEAD
        return data


class Scanner:
    """Finds the packets in one direction, exactly those that the robot's and Argus' own parsers find.

    Whole packets that follow each other are taken at once. From the first byte that is something else, bytes go
    through the Unframer until the next such packet.
    """

    def __init__(self, direction: Direction) -> None:
        self.direction = direction
        self._names = tuple(packet_name(direction, number) for number in range(256))
        self._tracer: _Tracer | None = None
        self._gap = bytearray()
        self._gap_at = 0
        self._pieces: list[tuple[int, float | None]] = []
        self._cut: list[Chunk] = []
        self._window = _WINDOW_MAX

    def feed(self, chunk: Chunk) -> list[Row]:
        """Take the next bytes; return what they complete."""
        rows: list[Row] = []
        t, direction, buffer, offset = chunk
        at, size = 0, len(buffer)
        names = self._names
        new = tuple.__new__
        while at < size:
            if self._tracer is not None:
                at = self._recover(rows, chunk, at)
                continue
            # Written out, as most packets of most logs pass here.
            while size - at >= 6 and buffer[at] == 0xFA and buffer[at + 1] == 0xFB:
                count = buffer[at + 2]
                end = at + count + 3
                if end > size or count < 3:
                    break
                words = count >> 1
                total = sum(_WORDS[words](buffer, at + 3))
                if count & 1:
                    # The odd byte and the checksum's high byte made up the last word.
                    last = buffer[end - 3]
                    sent = buffer[end - 2] << 8 | buffer[end - 1]
                    good = (total - (last << 8 | sent >> 8)) & 0xFFFF ^ last == sent
                else:
                    sent = buffer[end - 2] << 8 | buffer[end - 1]
                    good = (total - sent) & 0xFFFF == sent
                if not good:
                    break
                data = buffer[at + 3 : end - 2]
                rows.append(new(Row, (t, offset + at, direction, names[data[0]], True, data, "")))
                at = end
            if at < size:
                self._tracer = _Tracer(offset + at)
                self._gap_at = offset + at
        return rows

    def feed_many(self, chunks: Sequence[Chunk]) -> tuple[list[Row], list[int]]:
        """Take several chunks at once; return the rows, and for each the number of the chunk that completes it.

        A packet that they cut off waits for the next call, so `feed` may not be used beside this.
        """
        kept = len(self._cut)
        given = [*self._cut, *chunks]
        self._cut = []
        rows: list[Row] = []
        completed_by: list[int] = []
        number = at = 0
        while number < len(given):
            if self._tracer is None:
                number, at = self._take_whole(given, number, at, rows, completed_by)
                continue
            chunk = given[number]
            while self._tracer is not None and at < len(chunk.data):
                at = self._recover(rows, chunk, at)
            completed_by += [number] * (len(rows) - len(completed_by))
            if at >= len(chunk.data):
                number, at = number + 1, 0
        return rows, [max(0, number - kept) for number in completed_by] if kept else completed_by

    def _take_whole(
        self, given: list[Chunk], number: int, at: int, rows: list[Row], completed_by: list[int]
    ) -> tuple[int, int]:
        """Take the packets that follow each other from byte `at` of a chunk on; return where to go on."""
        from argus_tools.log.bulk import leading_packets

        parts = self._gather(given, number, at)
        buffer = b"".join(parts)
        starts, end = leading_packets(buffer)
        edges = list(itertools.accumulate(map(len, parts)))
        names, direction, new = self._names, self.direction, tuple.__new__
        k = 0
        stops = [*starts[1:], end]
        if starts and not at and edges == stops:
            # Each chunk is one packet, as most recorders write them.
            for t, _, whole, place in itertools.islice(given, number, number + len(parts)):
                rows.append(new(Row, (t, place, direction, names[whole[3]], True, whole[3:-2], "")))
            completed_by += range(number, number + len(parts))
            starts = []
        t, _, _, base = given[number]
        base += at
        edge = edges[0]
        for start, stop in zip(starts, stops, strict=False):
            while edge <= start:
                k += 1
                t, _, _, base = given[number + k]
                base -= edge
                edge = edges[k]
            place = base + start
            while edge < stop:
                k += 1
                t, _, _, base = given[number + k]
                base -= edge
                edge = edges[k]
            data = buffer[start + 3 : stop - 2]
            rows.append(new(Row, (t, place, direction, names[data[0]], True, data, "")))
            completed_by.append(number + k)
        self._window = min(2 * self._window, _WINDOW_MAX)
        while k < len(parts) and edges[k] <= end:
            k += 1
        if k == len(parts):
            last = len(parts) - 1
            used = len(parts[last]) + (at if last == 0 else 0)
            is_used_up = used == len(given[number + last].data)
            return (number + k, 0) if is_used_up else (number + last, used)
        at = end - (edges[k] - len(parts[k])) + (at if k == 0 else 0)
        number += k
        if not self._is_cut(buffer[end:]):
            self._window = _WINDOW_MIN
            self._gap_at = given[number].offset + at
            self._tracer = _Tracer(self._gap_at)
        elif len(buffer) - end == sum(len(chunk.data) for chunk in given[number:]) - at:
            t, direction, data, offset = given[number]
            rest = [Chunk(t, direction, data[at:], offset + at), *given[number + 1 :]]
            self._cut = [chunk for chunk in rest if chunk.data]
            return len(given), 0
        return number, at

    def _gather(self, given: list[Chunk], number: int, at: int) -> list[bytes]:
        """Return as many bytes as are to be scanned together, as parts of the chunks from there on."""
        left = self._window
        if left == _WINDOW_MAX and not at:
            return [chunk[2] for chunk in itertools.islice(given, number, None)]
        parts: list[bytes] = []
        for chunk in itertools.islice(given, number, None):
            part = chunk[2][at : at + left]
            parts.append(part)
            at = 0
            left -= len(part)
            if left <= 0:
                break
        return parts

    @staticmethod
    def _is_cut(rest: bytes) -> bool:
        """Whether this is the beginning of a packet whose end has not come, and no other could be inside."""
        if not HEADER.startswith(rest[:2]) or not rest or HEADER in rest[1:]:
            return False
        return len(rest) < 3 or (rest[2] >= _COUNT_MIN and len(rest) < rest[2] + _OVERHEAD)

    def finish(self) -> list[Row]:
        """Return what is left when no byte will follow."""
        rows: list[Row] = []
        for chunk in self._cut:
            rows += self.feed(chunk)
        self._cut = []
        if self._tracer is not None:
            t = self._pieces[-1][1] if self._pieces else None
            self._collect(rows, t, self._tracer.poll(1e12))
            self._flush(rows, len(self._gap))
            self._tracer = None
        return rows

    def _recover(self, rows: list[Row], chunk: Chunk, at: int) -> int:
        tracer = self._tracer
        assert tracer is not None
        piece = chunk.data[at : tracer.reach(chunk.data, at)]
        if not self._pieces or self._pieces[-1][1] != chunk.t:
            self._pieces.append((chunk.offset + at, chunk.t))
        self._gap += piece
        self._collect(rows, chunk.t, tracer.feed(piece))
        if not tracer.pending and not self._gap:
            self._tracer = None
            self._pieces.clear()
        elif len(self._gap) >= _GAP_MAX:
            self._flush(rows, len(self._gap) - tracer.pending)
        return at + len(piece)

    def _collect(self, rows: list[Row], t: float | None, packets: list[bytes]) -> None:
        tracer = self._tracer
        assert tracer is not None
        for data, start in zip(packets, tracer.starts, strict=True):
            self._flush(rows, start - self._gap_at)
            rows.append(Row(t, start, self.direction, self._names[data[0]], True, data))
            size = len(data) + 2 + _OVERHEAD
            del self._gap[:size]
            self._gap_at += size
        tracer.starts.clear()

    def _time_at(self, offset: int) -> float | None:
        """Return the time of the chunk that a byte came with; earlier bytes are not asked for again."""
        while len(self._pieces) > 1 and self._pieces[1][0] <= offset:
            del self._pieces[0]
        return self._pieces[0][1]

    def _flush(self, rows: list[Row], size: int) -> None:
        """Report the first bytes of the gap as damage."""
        gap = bytes(self._gap[:size])
        at = 0
        while at < len(gap):
            end = self._damage_end(gap, at)
            name, error = self._explain(gap[at:end])
            place = self._gap_at + at
            rows.append(Row(self._time_at(place), place, self.direction, name, False, gap[at:end], error))
            at = end
        del self._gap[:size]
        self._gap_at += size

    @staticmethod
    def _damage_end(gap: bytes, at: int) -> int:
        following = gap.find(HEADER, at + 1)
        end = len(gap) if following < 0 else following
        if gap.startswith(HEADER, at) and at + 2 < len(gap) and gap[at + 2] >= _COUNT_MIN:
            end = min(end, at + gap[at + 2] + _OVERHEAD)
        return end

    def _explain(self, part: bytes) -> tuple[str, str]:
        if not part.startswith(HEADER):
            return JUNK, f"{len(part)} bytes that belong to no packet"
        if len(part) < 4:
            return JUNK, f"a header and {len(part) - 2} bytes of a packet"
        name = self._names[part[3]]
        total = part[2] + _OVERHEAD
        if part[2] < _COUNT_MIN:
            return name, f"COUNT is {part[2]}, below {_COUNT_MIN}"
        if len(part) < total:
            return name, f"{len(part)} of {total} bytes"
        computed = checksum(part[3:-2])
        return name, f"checksum is {int.from_bytes(part[-2:], 'big'):04x}, not {computed:04x}"


class Session:
    """Tells SYNC0, SYNC1, SYNC2 from PULSE, OPEN, CLOSE, which have the same numbers.

    Where the packets so far leave it open, as for a first 0, the packet waits for the next one that settles it.
    """

    def __init__(self) -> None:
        self.state = "unknown"  # or "waiting", "synced" (SYNC2 seen), "open"
        self.undecided: list[Row] = []
        self._sips_waiting = 0

    def take(self, row: Row) -> list[Row]:
        """Return the rows that are settled now, in their order."""
        if not row.ok:
            if not self.undecided:
                return [row]
            self.undecided.append(row)
            return [] if len(self.undecided) <= _UNDECIDED_MAX else self._settle(self._is_unanswered())
        number = row.data[0]
        if row.dir == ROBOT_TO_CLIENT:
            return self._from_robot(row, number)
        return self._from_client(row, number)

    def finish(self) -> list[Row]:
        """Return what still waits: 0 that was never answered is SYNC0, unless the session was open."""
        return self._settle(self._is_unanswered())

    def _is_unanswered(self) -> bool:
        first = next((row.data[0] for row in self.undecided if row.ok), None)
        return self.state != "open" and first == TYPE["SYNC0"]

    def _from_robot(self, row: Row, number: int) -> list[Row]:
        if number < len(SYNC_NAMES):
            rows = self._settle(True)
            self.state = "synced" if number == TYPE["SYNC2"] else "waiting"
            return [*rows, row]
        rows = self._settle(False)
        if self.state == "unknown":
            self.state = "open"
        elif self.state == "waiting" and number in SIP_TYPES:
            self._sips_waiting += 1
            if self._sips_waiting > _SIPS_AFTER_CLOSE:
                self.state = "open"
        rows.append(row)
        return rows

    def _from_client(self, row: Row, number: int) -> list[Row]:
        if number >= len(SYNC_NAMES):
            rows = self._settle(False)
            if self.state == "unknown":
                self.state = "open"
            rows.append(row)
            return rows
        if self.state == "synced" and number == COMMAND["OPEN"]:
            self.state = "open"
            return [row]
        if self.state in ("waiting", "synced"):
            return [self._sync(row, number)]
        last = next((r.data[0] for r in reversed(self.undecided) if r.ok), None)
        if last is not None and number == last + 1:
            return [*self._settle(True), self._sync(row, number)]
        rows = []
        if last is not None and number != last:
            rows = self._settle(last == TYPE["SYNC2"] and number == COMMAND["OPEN"])
            return rows + self._from_client(row, number)
        if number != TYPE["SYNC0"] and self.state == "open" and last is None:
            return [self._close(row, number)]
        self.undecided.append(row)
        if len(self.undecided) > _UNDECIDED_MAX:
            rows += self._settle(self._is_unanswered())
        return rows

    def _close(self, row: Row, number: int) -> Row:
        if number == COMMAND["CLOSE"]:
            self.state, self._sips_waiting = "waiting", 0
        return row

    def _sync(self, row: Row, number: int) -> Row:
        self.state, self._sips_waiting = ("synced" if number == TYPE["SYNC2"] else "waiting"), 0
        return row._replace(type=SYNC_NAMES[number])

    def _settle(self, is_sync: bool) -> list[Row]:
        rows, self.undecided = self.undecided, []
        if not rows:
            return rows
        named = []
        for row in rows:
            if not row.ok:
                named.append(row)
            elif is_sync:
                named.append(self._sync(row, row.data[0]))
            else:
                self.state = "open"
                named.append(self._close(row, row.data[0]))
        return named


def packets(chunks: Iterable[Chunk], at_once: bool = True) -> Iterator[Row]:
    """Yield the packets of a log in their order, named, and the damage between them as rows with `ok` false.

    Without `at_once` many chunks are read before the first row comes, which is faster.
    """
    scanners: dict[Direction, Scanner] = {name: Scanner(name) for name in (ROBOT_TO_CLIENT, CLIENT_TO_ROBOT)}
    session = Session()
    for rows in _scan_each(chunks, scanners) if at_once else _scan_many(chunks, scanners):
        for row in rows:
            # Inside a session with nothing undecided a SIP settles nothing: most rows of most logs.
            if row[3] == "SIP" and session.state == "open" and not session.undecided:
                yield row
            else:
                yield from session.take(row)
    for scanner in scanners.values():
        for row in scanner.finish():
            yield from session.take(row)
    yield from session.finish()


def _scan_each(chunks: Iterable[Chunk], scanners: dict[Direction, Scanner]) -> Iterator[list[Row]]:
    for chunk in chunks:
        yield scanners[chunk[1]].feed(chunk)


def _scan_many(chunks: Iterable[Chunk], scanners: dict[Direction, Scanner]) -> Iterator[list[Row]]:
    for batch in _batches(chunks):
        from_robot = [n for n, chunk in enumerate(batch) if chunk[1] == ROBOT_TO_CLIENT]
        if len(from_robot) in (0, len(batch)):
            yield scanners[batch[0][1]].feed_many(batch)[0]
            continue
        from_client = [n for n, chunk in enumerate(batch) if chunk[1] == CLIENT_TO_ROBOT]
        rows: list[Row] = []
        order: list[int] = []
        for direction, chosen in ((ROBOT_TO_CLIENT, from_robot), (CLIENT_TO_ROBOT, from_client)):
            found, completed_by = scanners[direction].feed_many([batch[n] for n in chosen])
            rows += found
            order += [chosen[n] for n in completed_by]
        yield [rows[at] for at in sorted(range(len(rows)), key=order.__getitem__)]


def _batches(chunks: Iterable[Chunk]) -> Iterator[list[Chunk]]:
    """Yield the chunks in lists, each of about as many bytes as are scanned together."""
    chunks = iter(chunks)
    count = 1
    while batch := list(itertools.islice(chunks, count)):
        yield batch
        size = 1 + sum(len(chunk[2]) for chunk in batch) // len(batch)
        count = min(2 * count, 1 + _WINDOW_MAX // size, _BATCH_MAX)
