# SPDX-License-Identifier: MIT
"""ARCOS packets as typed values: framing, checksum, resynchronisation, and every packet in both directions.

>>> frame(Command.integer(COMMAND["VEL"], -300).data).hex(" ")
'fa fb 06 0b 1b 2c 01 37 1c'
>>> packets = Unframer().feed(bytes.fromhex("57 4d fa fb 06 0b 1b 2c 01 37 1c"))
>>> Command.decode(packets[0]).value
-300
"""

from hil_sim.arcos.command import Command
from hil_sim.arcos.configpac import ConfigPac
from hil_sim.arcos.fields import PacketError
from hil_sim.arcos.framing import Unframer, UnframerCounters, checksum, frame
from hil_sim.arcos.numbers import (
    ARGUMENT,
    BAUD,
    BAUD_OF_CODE,
    BUMPSTALL,
    COMMAND,
    DEFAULT,
    FLAG,
    FRAME,
    HOSTBAUD,
    SIP,
    TIMING,
    TYPE,
)
from hil_sim.arcos.packets import (
    EncoderPac,
    GyroPac,
    IoPac,
    OtherPacket,
    Packet,
    SimLaser,
    SimStat,
    SyncEcho,
    SyncReply,
    decode,
)
from hil_sim.arcos.sip import Sip

__all__ = [
    "ARGUMENT",
    "BAUD",
    "BAUD_OF_CODE",
    "BUMPSTALL",
    "COMMAND",
    "DEFAULT",
    "FLAG",
    "FRAME",
    "HOSTBAUD",
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
