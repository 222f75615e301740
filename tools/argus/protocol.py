# SPDX-License-Identifier: MIT
"""ARCOS packets as typed values, in both directions; docs/arcos.md has examples.

>>> unframer = Unframer()
>>> [Command.decode(data).value for data in unframer.feed(bytes.fromhex("57 fa fb 06 0b 1b 2c 01 37 1c"))]
[-300]
"""

from hil_sim.arcos import (
    ARGUMENT,
    BAUD,
    COMMAND,
    FLAG,
    FRAME,
    SIP,
    TIMING,
    TYPE,
    Command,
    ConfigPac,
    EncoderPac,
    GyroPac,
    IoPac,
    OtherPacket,
    Packet,
    PacketError,
    SimLaser,
    SimStat,
    Sip,
    SyncEcho,
    SyncReply,
    Unframer,
    UnframerCounters,
    checksum,
    decode,
    frame,
)

__all__ = [
    "ARGUMENT",
    "BAUD",
    "COMMAND",
    "FLAG",
    "FRAME",
    "SIP",
    "TIMING",
    "TYPE",
    "Command",
    "ConfigPac",
    "EncoderPac",
    "GyroPac",
    "IoPac",
    "OtherPacket",
    "Packet",
    "PacketError",
    "SimLaser",
    "SimStat",
    "Sip",
    "SyncEcho",
    "SyncReply",
    "Unframer",
    "UnframerCounters",
    "checksum",
    "decode",
    "frame",
]
