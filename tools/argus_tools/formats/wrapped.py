# SPDX-License-Identifier: MIT
"""A log inside of other text: behind what some program put before each line, or below prose; found and taken out."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from io import BufferedReader, BytesIO
from typing import Final, NamedTuple

from argus_tools.chunks import Damage, Format, LogError, ReadOptions
from argus_tools.formats.marks import marks_in
from argus_tools.formats.stamps import Times
from argus_tools.formats.text import RewrittenLines, begins_as_text, is_text
from hil_sim.arcos import Unframer

# So many bytes may stand before a line, with so many places where the line may begin.
_PREFIX_MOST: Final = 160
_PLACES_MOST: Final = 48
# So many lines show the same shape by no chance; a block shows what it is within so many.
_SHARE: Final = 8
_CLOSE: Final = 16
_ALIKE_MIN: Final = 3
# Fewer lines than that which are so long together show no shape, and take seconds to look into.
_LONG: Final = 1 << 12
_WINDOW: Final = 64
_STEP: Final = 32
# Prefixes are looked for in lines at these places of a file, in eighths: prose may stand above and below.
_EIGHTHS: Final = (0, 1, 2, 4, 6, 7)
_FEW_LINES: Final = (1, 2, 4)
_PART: Final = re.compile(rb"[0-9A-Za-z_\x80-\xff]+|[ \t]+|.", re.DOTALL)
_WORDS: Final = (rb"[0-9]+", rb"[A-Za-z_]+", rb"[0-9A-Za-z_\x80-\xff]+")
_WORD: Final = re.compile(rb"[0-9A-Za-z_\x80-\xff]")
_CLOCK: Final = re.compile(rb"\d\d:\d\d:\d\d")
_PLACE: Final = re.compile(rb"[ \t]+|[^0-9A-Za-z_\s\x80-\xff]")
# Records hold times and directions besides their bytes.
_RECORD: Final = b'"hex"'
# What takes any text with bytes in it, or any file: only such is looked into.
_WEAK: Final = ("bin", "hextext", "hexwords")
_CAN: Final = ("candump", "can-lines", "asc", "trc", "can-csv")
_WHOLE: Final = (*_CAN, "jsonl")
_STRONG: Final = (*_WHOLE, "frame-dump", "numdump", "hexdump")


class Wrap(NamedTuple):
    """What a log is inside of: which form it has, what stands before each line, and how many lines above it."""

    form: Format
    prefix: re.Pattern[bytes] | None
    above: int

    def told(self) -> list[Damage]:
        """Say what is left out above."""
        if not self.above:
            return []
        place = f"lines 1 to {self.above}" if self.above > 1 else "line 1"
        return [Damage(place, f"other text above the log ({self.form.name}), passed over")]

    def stream(self, stream: BufferedReader) -> Unwrapped:
        """Return the log itself; a line that is left out is blank, so that lines keep their numbers."""
        return Unwrapped(stream, self)


class Unwrapped(RewrittenLines):
    """The lines of a stream without what stands before them, and none of those above the log."""

    def __init__(self, stream: BufferedReader, wrap: Wrap) -> None:
        super().__init__(stream)
        self._above = wrap.above
        self._bare = _bare(wrap)

    def _rewrite_line(self, line: bytes, begins: bool) -> bytes:
        if self._above:
            ends = line.endswith(b"\n")
            self._above -= ends
            return b"\n" if ends else b""
        return self._bare(line) if begins else line


def _bare(wrap: Wrap) -> Callable[[bytes], bytes]:
    """Return what makes a line of the log of one of the file; one that has not the prefix stays as it is."""
    prefix, times = wrap.prefix, Times()
    if prefix is None:
        return lambda line: line
    keeps_time = wrap.form.name == "candump"

    def bare(line: bytes) -> bytes:
        match = prefix.match(line)
        if match is None:
            return line
        rest = line[match.end() :]
        # What candump prints without times gets those of the program that put some before it.
        if keeps_time and not rest.lstrip().startswith(b"(") and (t := _time(match[0], times)) is not None:
            return b"(%.6f) %s" % (t, rest.lstrip())
        return rest

    return bare


def _time(prefix: bytes, times: Times) -> float | None:
    """Return the first time in a prefix; a name or the number of a line may stand before it."""
    for at in (0, *(match.end() for match in _PLACE.finditer(prefix))):
        if stamp := times.take(prefix[at:]):
            return stamp.t
    return None


class _Found(NamedTuple):
    """What a way of reading gives: whole packets, bytes that are in none, and pieces with a time."""

    packets: int
    junk: int
    timed: int

    @property
    def rank(self) -> tuple[int, int]:
        """Of two ways the one that ranks higher is better."""
        return self.packets, -self.junk


def unwrapped(head: bytes, plain: Format, read: Sequence[Format], options: ReadOptions) -> Wrap | None:
    """Return what the log in a file is inside of; None if the file is better read as it is."""
    if (plain.is_read and plain.name not in _WEAK) or not begins_as_text(head):
        return None
    as_it_is = _found(head, plain, options)
    if as_it_is.packets and not as_it_is.junk and _RECORD not in head:
        return None
    lines = _whole_lines(head)
    if len(lines) < _ALIKE_MIN and len(head) > _LONG:
        return None
    best = _best(_wraps(lines, _of(read, _STRONG)), lines, options, plain, as_it_is)
    if best is None and plain.is_read:
        weak = _of(read, _WEAK[1:])
        ways = _blocks(lines, weak) if plain.name == "bin" else _behind(lines, weak)
        best = _best(ways, lines, options, plain, as_it_is)
    return best


def _of(read: Sequence[Format], names: Sequence[str]) -> list[Format]:
    return [form for form in read if form.name in names]


def _best(
    ways: Iterable[Wrap], lines: Sequence[bytes], options: ReadOptions, plain: Format, as_it_is: _Found
) -> Wrap | None:
    """Return the way that reads best, if any is better than to read the file as it is."""
    best: Wrap | None = None
    most = as_it_is
    for wrap in ways:
        found = _read_as(lines, wrap, options)
        if _is_better(found, most, wrap.form, plain if best is None else best.form):
            best, most = wrap, found
    return best


def _is_better(found: _Found, most: _Found, form: Format, before: Format) -> bool:
    """Whether a log reads better so. What keeps times and sides needs no more packets than bytes among words have.

    Where neither way gives any packet, a log that is recognised says more of itself than one that is not.
    """
    if form is before and found.rank == most.rank:
        return found.timed > most.timed
    if before.name in _STRONG or form.name in _WEAK or not before.is_read:
        return found.rank > most.rank and found.packets > 0
    if form.name in _WHOLE:
        return found.packets >= most.packets
    return found.rank > most.rank


def _whole_lines(head: bytes) -> list[bytes]:
    lines = head.splitlines(keepends=True)
    if len(lines) > _ALIKE_MIN and not lines[-1].endswith(b"\n"):
        lines.pop()
    return [line if is_text(line) else b"\n" for line in lines]


def _read_as(lines: Sequence[bytes], wrap: Wrap, options: ReadOptions) -> _Found:
    bare = _bare(wrap)
    return _found(b"".join(map(bare, lines[wrap.above :])), wrap.form, options)


def _found(text: bytes, form: Format, options: ReadOptions) -> _Found:
    """Read a text in this form."""
    unframers = {"r2c": Unframer(), "c2r": Unframer()}
    packets = timed = 0
    try:
        reader = form.reader(BufferedReader(BytesIO(text), len(text) + 1), replace(options))
        for chunk in reader if form.is_read else ():
            packets += sum(len(packet) > 1 for packet in unframers[chunk.dir].feed(chunk.data))
            timed += chunk.t is not None
    except LogError:
        pass
    return _Found(packets, sum(one.counters.junk_bytes for one in unframers.values()), timed)


def _wraps(lines: Sequence[bytes], read: Sequence[Format]) -> Iterator[Wrap]:
    """Yield what lines may be inside of, the likeliest first."""
    yield from _blocks(lines, read)
    yield from _behind(lines, read)


def _behind(lines: Sequence[bytes], read: Sequence[Format]) -> Iterator[Wrap]:
    """Yield what stands behind prefixes."""
    for shape in _shapes(lines):
        matched = _matched(lines, shape)
        if not _is_common(matched, lines):
            continue
        rest = b"".join(shape.sub(b"", lines[at], count=1) for at in matched[:_WINDOW])
        form = next((one for one in read if one.sniff(rest)), None)
        if form is not None and not (form.name in _WEAK and _says_more(lines[matched[0]], shape)):
            yield Wrap(form, shape, matched[0])


def _matched(lines: Sequence[bytes], shape: re.Pattern[bytes]) -> list[int]:
    """Return the lines that begin so, from where several do."""
    matched = [at for at, line in enumerate(lines) if shape.match(line)]
    return matched[_dense(matched) :]


def _says_more(line: bytes, shape: re.Pattern[bytes]) -> bool:
    """Whether a prefix holds a time or a side, which the forms of bytes read themselves."""
    match = shape.match(line)
    return match is not None and bool(marks_in(match[0]) or _time(match[0], Times()) is not None)


def _is_common(matched: Sequence[int], lines: Sequence[bytes]) -> bool:
    """Whether these are many of the lines from the first to the last: others may have written to the same journal."""
    if len(matched) < min(_ALIKE_MIN, len(lines)) or not matched:
        return False
    written = sum(bool(line.strip()) for line in lines[matched[0] : matched[-1] + 1])
    return _SHARE * len(matched) > written


def _dense(matched: Sequence[int]) -> int:
    """Return the first of these after which others follow at once: single lines of prose may look alike."""
    close = (at for at in range(len(matched) - 2) if matched[at + 2] - matched[at] <= _CLOSE)
    return next(close, 0)


def _shapes(lines: Sequence[bytes]) -> Iterator[re.Pattern[bytes]]:
    """Yield how what stands before a line may look: words, numbers and spaces may differ, signs may not."""
    written = [line for line in lines if line.strip()]
    seen = set()
    for eighth in _EIGHTHS:
        line = written[len(written) * eighth // 8] if written else b""
        for end in _places(line[:_PREFIX_MOST]):
            shape = _shape(line[:end])
            if shape not in seen:
                seen.add(shape)
                yield re.compile(shape)


def _shape(prefix: bytes) -> bytes:
    parts = _PART.findall(prefix)
    # Numbers are set to the right by spaces before them; the log's own line may begin with some.
    first = rb"[ \t]*" if parts[0].isspace() and len(parts) > 1 else _class(parts[0])
    if len(parts) == 1:
        return prefix if prefix.isspace() else first
    last = parts[-1] if len(parts[-1]) == 1 and parts[-1].isspace() else _class(parts[-1])
    return first + b"".join(map(_class, parts[1:-1])) + last


def _class(part: bytes) -> bytes:
    if part.isspace():
        return rb"[ \t]+"
    if not _WORD.match(part):
        # grep puts one behind the name and number of what it looks for, the other behind those of a line near it.
        return rb"[:-]" if part in (b":", b"-") else re.escape(part)
    return next(one for one in _WORDS if re.fullmatch(one, part))


def _places(line: bytes) -> list[int]:
    """Return where the log's own line may begin: behind a sign, a space, or all spaces, but within no time."""
    ends: set[int] = set()
    for match in _PLACE.finditer(line):
        ends |= {match.start() + 1, match.end()}
    for clock in _CLOCK.finditer(line):
        ends -= set(range(clock.start(), clock.end()))
    return sorted(ends)[:_PLACES_MOST]


def _blocks(lines: Sequence[bytes], read: Iterable[Format]) -> Iterator[Wrap]:
    """Yield the first block of each form below other text."""
    left = list(read)
    for start in range(_STEP, len(lines), _STEP):
        window = b"".join(lines[start : start + _WINDOW])
        for form in [one for one in left if one.sniff(window)]:
            left.remove(form)
            yield Wrap(form, None, _begin(lines, start, form))


def _begin(lines: Sequence[bytes], start: int, form: Format) -> int:
    """Return the first line that is of this form by itself, or with those behind it."""
    for count in _FEW_LINES:
        for at in range(start, min(start + _WINDOW, len(lines))):
            if lines[at].strip() and form.sniff(b"".join(lines[at : at + count])):
                return at
    return start
