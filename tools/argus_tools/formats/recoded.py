# SPDX-License-Identifier: MIT
"""Bytes of a link that a program took for text and saved in another encoding: told, with what gets them back."""

from __future__ import annotations

import codecs
from collections.abc import Iterator
from io import BufferedReader
from typing import Final

from argus_tools.chunks import (
    EXPECTED,
    Chunk,
    Damage,
    DamageList,
    Format,
    LogError,
    Reader,
    ReadOptions,
    remedy,
)
from argus_tools.formats.hextext import bytes_of_lines
from argus_tools.formats.source import HEAD_BYTES
from argus_tools.formats.text import BOM, Rewritten, first_lines, is_text
from hil_sim.arcos import Unframer

_HEADER: Final = b"\xfa\xfb"
_BINARY: Final = "record as binary (raw) in the terminal program, or with argusd --record drive.rec"
# Python's and iconv's name of each code page that a terminal program may take the bytes for; iconv's Mac is another.
_PAGES: Final = (
    ("latin-1", "LATIN1"), ("cp1252", "CP1252"), ("cp437", "CP437"), ("cp850", "CP850"), ("mac_roman", None),
    ("cp1251", "CP1251"), ("koi8_r", "KOI8-R"), ("iso8859-15", "LATIN-9"), ("cp866", "CP866"),
)  # fmt: skip
_REPLACED: Final = "\ufffd".encode()
_REPLACED_MIN: Final = 2
_MARKS: Final = {codecs.BOM_UTF16_LE: "utf-16-le", codecs.BOM_UTF16_BE: "utf-16-be"}
_SAMPLE: Final = 1 << 14
# So many ends of lines in bytes that are no text are all behind a CR by no chance.
_ENDS_MIN: Final = 6


def crlf_damage(head: bytes) -> Damage | None:
    """Say that a transfer as text put a CR before each LF of these bytes; None if it did not."""
    ends = head.count(b"\n")
    if ends < _ENDS_MIN or is_text(head) or head.count(b"\r\n") != ends:
        return None
    what = (
        "recoded by a text transfer (LF became CRLF): undone, which gets most of it back; send it as binary"
    )
    return Damage("byte 0", what)


class Unreturned(Rewritten):
    """Bytes without the CR that a transfer as text put before each LF."""

    def __init__(self, stream: BufferedReader) -> None:
        super().__init__(stream)
        self._held = b""

    def _rewrite(self, data: bytes) -> bytes:
        """Return what is sure: a CR at the end of a block may have its LF in the next one."""
        text = self._held + data
        self._held = b"\r" if data and text.endswith(b"\r") else b""
        return text.removesuffix(self._held).replace(b"\r\n", b"\n")


def _utf16(head: bytes) -> str | None:
    """Return the byte order of UTF-16, by its mark or by the header of a packet in it."""
    if marked := _MARKS.get(head[:2]):
        return marked
    # Bytes of one side look like those of the other order beside a zero: the order with more zeros is right.
    for encoding in sorted(
        _MARKS.values(), key=lambda name: head[name == "utf-16-le" :: 2].count(0), reverse=True
    ):
        if any(_HEADER.decode(page).encode(encoding) in head for page, _ in _PAGES):
            return encoding
    # Text of ASCII has a zero in every second place.
    sample = head[: _SAMPLE & ~1]
    for encoding, high in (("utf-16-le", 1), ("utf-16-be", 0)):
        zeros, others = sample[high::2], sample[1 - high :: 2]
        if len(zeros) >= 16 and not any(zeros) and all(9 <= byte < 127 for byte in others):
            return encoding
    return None


def _has_utf8(head: bytes) -> bool:
    return any(_HEADER.decode(page).encode() in head for page, _ in _PAGES)


def _sniff(head: bytes) -> bool:
    # Two speeds of 250 and 251 mm/s look like the header in UTF-16, but then a real one is near.
    if _HEADER in head:
        return False
    if not (_utf16(head) or _has_utf8(head) or head.count(_REPLACED) >= _REPLACED_MIN):
        return False
    # The characters beside a dump may be any, but then the bytes are there, too.
    return not _has_packets(bytes_of_lines(first_lines(head)))


def _text(head: bytes, encoding: str) -> str | None:
    """Decode all but what is cut at the end; None if it is not of this encoding."""
    if head[:2] in _MARKS:
        head = head[2:]
    try:
        return codecs.getincrementaldecoder(encoding)("strict").decode(head)
    except UnicodeDecodeError:
        return None


def _has_packets(data: bytes) -> bool:
    return any(True for _ in Unframer().feed(data))


def _explain(options: ReadOptions, head: bytes) -> str:
    encoding = _utf16(head) or "utf-8"
    shown = "UTF-16" if head[:2] in _MARKS else encoding.upper().replace("-LE", "LE").replace("-BE", "BE")
    what = f"looks like a link's bytes saved as {shown} text"
    text = _text(head.removeprefix(BOM), encoding)
    if text is None or "\ufffd" in text:
        return f"{what}, which lost some; expected {EXPECTED}; {_BINARY}"
    for page, iconv in _PAGES:
        if iconv and _has_packets(_encoded(text, page)):
            back = f"iconv -f {shown} -t {iconv} FILE > drive.bin"
            if head.startswith(BOM):
                back = f"tail -c +{len(BOM) + 1} FILE | iconv -f {shown} -t {iconv} > drive.bin"
            return f"{what}; expected {EXPECTED}; {remedy(back, options)} gets them back; next time {_BINARY}"
    if encoding != "utf-8" and text.isascii():
        back = remedy(f"iconv -f {shown} -t UTF-8 FILE > drive.txt", options)
        return f"looks like {shown} text; expected {EXPECTED}; {back}"
    return f"{what}, and there is no way back that is sure; expected {EXPECTED}; {_BINARY}"


def _encoded(text: str, page: str) -> bytes:
    try:
        return text.encode(page)
    except UnicodeEncodeError:
        return b""


class RecodedReader(Reader):
    """Reads nothing: says what became of the bytes."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._options = options

    def __iter__(self) -> Iterator[Chunk]:
        why = _explain(self._options, self._stream.peek(HEAD_BYTES))
        raise LogError(f"{self._options.name}: {why}")


FORMATS: Final = (
    Format(
        name="recoded",
        help="bytes of a link saved as UTF-8 or UTF-16 text",
        sniff=_sniff,
        reader=RecodedReader,
        is_read=False,
    ),
)
