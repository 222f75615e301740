# SPDX-License-Identifier: MIT
"""Files that people take for logs and that are not read: each is told by its name, with the command that helps."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from io import BufferedReader
from itertools import pairwise
from typing import Final

from argus_tools.chunks import (
    EXPECTED,
    Chunk,
    DamageList,
    Format,
    LogError,
    Reader,
    ReadOptions,
    begins,
    remedy,
)
from argus_tools.formats import base64lines
from argus_tools.formats.hexdump import FORMAT as HEXDUMP
from argus_tools.formats.source import HEAD_BYTES
from argus_tools.formats.text import first_lines
from hil_sim.arcos import Unframer

_HEADER: Final = b"\xfa\xfb"
_RECORD: Final = "record the link itself: argusd --record drive.rec"
_CANDUMP: Final = "record the bus itself: candump -L can0 > can0.log"
# Packets of two bytes or more that follow each other with all high bits gone.
_SEVEN_BIT_PACKETS: Final = 3
_SNIFFED: Final = 1 << 14
_FIELDS: Final = re.compile(rb"\d+\.\d{9}[\t,;](.*)")
_FIELD_ID: Final = re.compile(rb"\d{3,5}|0x[0-9A-Fa-f]{1,8}")
_FIELD_BYTES: Final = re.compile(rb"(?:[0-9A-Fa-f]{2}:?){6,}")
_ONLY_DIGITS: Final = re.compile(rb"(?:[0-9A-Fa-f]{1,2}[ \r\n]+)+[0-9A-Fa-f]{0,2}\s*")
_CUT_END: Final = re.compile(rb"(?<![0-9A-Fa-f])[0-9A-Fa-f]\Z")
_CUT_BEGIN: Final = re.compile(rb"[0-9A-Fa-f](?![0-9A-Fa-f])")


@dataclass(frozen=True)
class _Other:
    """One such kind: how it is recognised, what it is, and what to do; FILE stands for the file's name."""

    name: str
    sniff: Callable[[bytes], object]
    what: str
    # Or what says it of the file's beginning.
    remedy: str | Callable[[bytes], str]


def _unlike_hexdump(pattern: bytes) -> Callable[[bytes], bool]:
    """Recognise a dump of another kind, whose words may look like hexadecimal ones."""
    is_like = _lines(pattern, 2)
    return lambda head: is_like(head) and not HEXDUMP.sniff(head)


def _lines(pattern: bytes, least: int = 1) -> Callable[[bytes], bool]:
    """Recognise text by so many of its first lines."""
    match = re.compile(pattern).match
    return lambda head: sum(bool(match(line)) for line in first_lines(head)) >= least


def _is_fields(head: bytes) -> bool:
    """A time with nine digits, then columns of which one tells several ports or ids, and one has the bytes."""
    kinds: set[bytes] = set()
    has_bytes = False
    for line in first_lines(head):
        if match := _FIELDS.fullmatch(line):
            columns = re.split(rb"[\t,;]", match[1])
            kinds |= {column for column in columns if _FIELD_ID.fullmatch(column)}
            has_bytes |= any(_FIELD_BYTES.fullmatch(column) for column in columns)
    return has_bytes and len(kinds) > 1


def _is_wrapped(head: bytes) -> bool:
    """Digits in pairs, of which some are parted by the end of a line; put together they are packets."""
    text = head[:_SNIFFED]
    lines = text.splitlines()
    if not _ONLY_DIGITS.fullmatch(text) or not any(
        _CUT_END.search(line) and _CUT_BEGIN.match(after) for line, after in pairwise(lines)
    ):
        return False
    digits = b"".join(b"".join(lines).split())
    return any(True for _ in Unframer().feed(bytes.fromhex(digits[: len(digits) & ~1].decode())))


def _is_seven_bit(head: bytes) -> bool:
    """A chain of packets whose header lost its high bits, as a line of seven bits or a terminal makes it."""
    if _HEADER in head or not re.search(rb"[\x00-\x06]", head):
        return False
    return _chain(head, bytes(byte & 0x7F for byte in _HEADER))


def _is_gzip(head: bytes) -> bool:
    """Gzip inside of gzip: the outer one is unzipped already."""
    return head.startswith(b"\x1f\x8b\x08")


def _is_follow_text(head: bytes) -> bool:
    """Characters instead of bytes; the line of headings is none of the lines otherwise."""
    return bool(re.search(rb"^(?:Follow: \w+,(?!hex|raw)\w|peers:\s*$)", head[:_SNIFFED], re.MULTILINE))


def _is_quoted_printable(head: bytes) -> bool:
    return bool(re.search(rb"=FA=FB(?:=[0-9A-F]{2}|[!-<>-~ ])", head[:_SNIFFED]))


def _chain(head: bytes, header: bytes) -> bool:
    """Whether packets with this header follow each other as their lengths say."""
    for match in re.finditer(re.escape(header), head[:_SNIFFED]):
        at, chain = match.start(), 0
        while head[at : at + 2] == header and at + 2 < len(head) and chain < _SEVEN_BIT_PACKETS:
            at, chain = at + 3 + head[at + 2], chain + 1
        if chain == _SEVEN_BIT_PACKETS:
            return True
    return False


def _is_questioned(head: bytes) -> bool:
    """Bytes above 127 that became question marks."""
    sample = head[:_SNIFFED]
    return not any(byte & 0x80 for byte in sample) and b"\0" in sample and _chain(head, b"??")


def _is_without_zeros(head: bytes) -> bool:
    """Headers without one whole packet, and not one of the zeros that each packet has."""
    sample = head[:_SNIFFED]
    if b"\0" in sample or sample.count(_HEADER) < _SEVEN_BIT_PACKETS:
        return False
    return not any(len(packet) > 1 for packet in Unframer().feed(sample))


def _is_pdml(head: bytes) -> bool:
    return bool(re.search(rb"^<p[ds]ml\b", head[:_SNIFFED], re.MULTILINE))


def _is_tar(head: bytes) -> bool:
    return head[257:262] == b"ustar"


_OTHERS: Final = (
    _Other(
        "mf4",
        begins(b"MDF     ", b"UnFinMF "),
        "an MDF measurement (.mf4)",
        "python -m can.logconvert FILE drive.log (with pip install asammdf), or export its frames as BLF or ASC, or "
        + _CANDUMP,
    ),
    _Other(
        "sqlite",
        begins(b"SQLite format 3\0"),
        "an SQLite database, as python-can's logger writes one (.db)",
        "python -m can.logconvert FILE drive.asc",
    ),
    _Other(
        "rosbag",
        begins(b"#ROSBAG V"),
        "a ROS bag of a version before 2.0",
        "rosbag fix FILE new.bag && argus-log decode new.bag",
    ),
    _Other("gzip", _is_gzip, "a gzip file in a gzip file", "gzip -dc FILE | argus-log decode -"),
    _Other("zip", begins(b"PK\x03\x04"), "a ZIP archive", "unzip -p FILE | argus-log decode -"),
    _Other("xz", begins(b"\xfd7zXZ\0"), "an xz file", "xz -dc FILE | argus-log decode -"),
    _Other("bzip2", begins(b"BZh"), "a bzip2 file", "bzip2 -dc FILE | argus-log decode -"),
    _Other("zstd", begins(b"\x28\xb5\x2f\xfd"), "a zstd file", "zstd -dc FILE | argus-log decode -"),
    _Other("lz4", begins(b"\x04\x22\x4d\x18"), "an lz4 file", "lz4 -dc FILE | argus-log decode -"),
    _Other("7z", begins(b"7z\xbc\xaf\x27\x1c"), "a 7z archive", "7z e -so FILE | argus-log decode -"),
    _Other("tar", _is_tar, "a tar archive", "tar -xOf FILE | argus-log decode -"),
    _Other("elf", begins(b"\x7fELF"), "a program", "give the log, not the program"),
    _Other("pdf", begins(b"%PDF-"), "a PDF document", "give the log itself"),
    _Other("picture", begins(b"\x89PNG\r\n", b"\xff\xd8\xff", b"GIF8"), "a picture", "give the log itself"),
    _Other(
        "pdml",
        _is_pdml,
        "what tshark -T pdml or -T psml prints",
        "give the capture that it was made from, or tshark -r CAPTURE -T json -x",
    ),
    _Other(
        "html",
        _lines(rb"\s*<(?:!DOCTYPE|html|\?xml)"),
        "a web page or XML",
        "save the file itself, not the page that shows it",
    ),
    _Other(
        "netmon",
        begins(b"GMBU", b"RTSS"),
        "a capture of Microsoft Network Monitor",
        "editcap -F pcapng FILE drive.pcapng",
    ),
    _Other("snoop", begins(b"snoop\0\0\0"), "a snoop capture", "editcap -F pcapng FILE drive.pcapng"),
    _Other("btsnoop", begins(b"btsnoop\0"), "a Bluetooth capture", _RECORD),
    _Other(
        "pcap-modified",
        begins(b"\xa1\xb2\xcd\x34", b"\x34\xcd\xb2\xa1", b"\xa1\xb2\x34\xcd"),
        "a pcap of a modified kind",
        "editcap -F pcapng FILE drive.pcapng",
    ),
    _Other(
        "tcpdump-hex",
        _lines(rb"\t0x[0-9a-f]{4}:  (?:[0-9a-f]{2,4} ?)+"),
        "what tcpdump -x prints on the screen",
        "capture into a file: tcpdump -i any -w robot.pcap tcp port 8101",
    ),
    _Other(
        "tcpdump-text",
        _lines(rb"(?:\d\d:\d\d:\d\d\.\d+ )?(?:\S+ +(?:In|Out) +)?IP6? \S+ > \S+: "),
        "what tcpdump prints on the screen, without the bytes",
        "capture into a file: tcpdump -i any -w robot.pcap tcp port 8101",
    ),
    _Other(
        "tshark-text",
        _lines(rb" *\d+ +\d+\.\d+ +(?:\S+ +)?(?:\xe2\x86\x92|->) +(?:\S+ +)?[A-Z]"),
        "what tshark prints on the screen, without the bytes",
        "tshark -i can0 -w can0.pcapng",
    ),
    _Other(
        "follow-text",
        _is_follow_text,
        'what "follow stream" prints as characters or YAML',
        "take the bytes: tshark -r CAPTURE -q -z follow,tcp,hex,0, or give the capture itself",
    ),
    _Other(
        "tshark-details",
        _lines(rb"Frame \d+: \d+ bytes? on wire"),
        "what tshark -V prints, without the frames' bytes",
        "print them, too: tshark -r CAPTURE -V -x, or capture into a file: tshark -i any -w robot.pcapng",
    ),
    _Other(
        "container-json",
        _lines(rb'\{\s*"log"\s*:\s*"'),
        "the log of a container as Docker keeps it",
        "jq -j .log FILE > drive.txt",
    ),
    _Other(
        "journal-json",
        _lines(rb'\{\s*"(?:MESSAGE|_[A-Z_]+)"\s*:'),
        "the journal as JSON",
        "jq -r .MESSAGE FILE > drive.txt",
    ),
    _Other(
        "journal-export",
        _lines(rb"__CURSOR=s="),
        "the journal in its export format",
        "sed -n s/^MESSAGE=//p FILE > drive.txt",
    ),
    _Other(
        "isotpdump",
        _lines(rb" *\S+ +[0-9A-Fa-f]{3,8} +\[\d\] +\[(?:SF|FF|CF|FC)\]", 2),
        "what isotpdump prints",
        _CANDUMP,
    ),
    _Other("uuencode", _lines(rb"begin [0-7]{3,4} \S"), "uuencoded", "uudecode -o drive.bin FILE"),
    _Other(
        "cat-v",
        _lines(rb".*M-zM-\{"),
        "what cat -v or less shows of a robot's link",
        _RECORD,
    ),
    _Other(
        "strace",
        _lines(rb"(?:\[pid +\d+\] |\d+ +)?(?:[\d:.]+ )?(?:read|write|recvfrom|sendto|openat)\(\d*.*\) += "),
        "what strace prints",
        _RECORD,
    ),
    _Other(
        "cansniffer", _lines(rb"(?:\x1b\[\S*)?\d\d (?:delta +ID +data|ms)"), "what cansniffer shows", _CANDUMP
    ),
    _Other(
        "slcan",
        _lines(rb"[tTrR][0-9A-Fa-f]{3,8}[0-8][0-9A-Fa-f]*(?:\r|$)", 2),
        "what an slcan adapter sends",
        "let slcand make an interface of it, then " + _CANDUMP,
    ),
    _Other(
        "intel-hex",
        _lines(rb":[0-9A-Fa-f]{10,}\s*$", 2),
        "Intel HEX",
        "objcopy -I ihex -O binary FILE drive.bin",
    ),
    _Other(
        "s-record",
        _lines(rb"S[0-9][0-9A-Fa-f]{8,}\s*$", 2),
        "Motorola S-records",
        "objcopy -I srec -O binary FILE drive.bin",
    ),
    _Other(
        "named-dump",
        _unlike_hexdump(
            rb"[0-7]{7}(?: +(?:\S|nul|soh|stx|etx|eot|enq|ack|bel|bs|ht|nl|vt|ff|cr|so|si|dle|dc[1-4]|nak|syn|etb"
            rb"|can|em|sub|esc|fs|gs|rs|us|sp|del))+\s*$",
        ),
        "what od -a prints, without the highest bit of each byte",
        "dump the log itself as numbers: od -v -t x1 LOG",
    ),
    _Other(
        "decimal-dump",
        _unlike_hexdump(rb"[0-9A-Fa-f]{7}(?: +-?[0-9.]{1,30}(?:e[+-]\d+)?)+\s*$"),
        "a dump in numbers that are no bytes",
        "dump the log itself as bytes: od -v -t x1 LOG",
    ),
    _Other(
        "decoded-table",
        _lines(rb" +t +offset +dir +type +content"),
        "what argus-log decode prints",
        "give the log that it was made from",
    ),
    _Other(
        "decoded-csv",
        _lines(rb"t,offset,dir,type,ok,"),
        "the CSV of argus-log",
        "give the log that it was made from",
    ),
    _Other(
        "tshark-fields",
        _is_fields,
        "what tshark -T fields prints, which does not tell whose the bytes are",
        "give the capture that it was made from, or tshark -i any -w robot.pcapng",
    ),
    _Other(
        "wrapped",
        _is_wrapped,
        "bytes in lines that are wrapped inside of a byte",
        r"tr -d '\r\n' < FILE > drive.txt",
    ),
    _Other("base64", base64lines.find, "base64 of a robot's link", base64lines.remedy_of),
    _Other(
        "quoted-printable",
        _is_quoted_printable,
        "quoted-printable text of a mail",
        "python3 -m quopri -d FILE > drive.bin",
    ),
    _Other(
        "questioned",
        _is_questioned,
        "a robot's link whose bytes above 127 became question marks, which loses them",
        "save as binary (raw) in the terminal program, or " + _RECORD,
    ),
    _Other(
        "without-zeros",
        _is_without_zeros,
        "a robot's link without its zeros, which a terminal or a paste leaves out",
        "save as binary (raw) in the terminal program, or " + _RECORD,
    ),
    _Other(
        "seven-bit",
        _is_seven_bit,
        "a robot's link without the highest bit of each byte, which is lost",
        "set the terminal program and the port to 8 data bits and save as binary",
    ),
)


class _Refusal(Reader):
    """Reads nothing: says what the file is."""

    def __init__(self, stream: BufferedReader, options: ReadOptions, other: _Other) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._options = options
        self._other = other

    def __iter__(self) -> Iterator[Chunk]:
        helps = self._other.remedy
        helps = remedy(
            helps if isinstance(helps, str) else helps(self._stream.peek(HEAD_BYTES)), self._options
        )
        raise LogError(f"{self._options.name}: looks like {self._other.what}; expected {EXPECTED}; {helps}")


def _format(other: _Other) -> Format:
    def reader(stream: BufferedReader, options: ReadOptions) -> Reader:
        return _Refusal(stream, options, other)

    def sniff(head: bytes) -> bool:
        return bool(other.sniff(head))

    return Format(name=other.name, help=other.what, sniff=sniff, reader=reader, is_read=False)


FORMATS: Final = tuple(map(_format, _OTHERS))
