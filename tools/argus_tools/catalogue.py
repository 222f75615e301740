# SPDX-License-Identifier: MIT
"""The formats of logs that are read, in the order of their detection, and what each is; loads none of them."""

from typing import Final

HELP: Final = {
    "record": "recording by argusd --record or argus-sim --record",
    "pcapng": "pcapng of the TCP or CAN link (Wireshark)",
    "pcap": "pcap of the TCP or CAN link (tcpdump)",
    "bag1": "ROS 1 bag",
    "bag2": "ROS 2 bag: its folder",
    "bag2-db3": "SQLite file of a ROS 2 bag",
    "mcap": "MCAP of ROS 2, of argus-log convert or the Foxglove bridge",
    "blf": "BLF of Vector's tools",
    "asc": "ASC of Vector's tools",
    "trc": "TRC of PEAK's tools (PCAN-View)",
    "tshark-json": "frames as JSON: tshark -T json, -T jsonraw, -T ek",
    "range-csv": "a table with columns as t_s, x_m, y_m, heading_deg, sonar_0_mm",
    "range-json": "JSON lines or an array with the same keys",
    "jsonl": 'JSON records {"t", "dir", "hex"}, in lines or an array',
    "candump": "candump of the ISO-TP link: -L, or as on the screen, plain or with -t",
    "can-lines": "CAN frames as python-can, BUSMASTER, CRTD and dated logs print them",
    "can-csv": "CSV of CAN frames: SavvyCAN, PCAN, python-can and others with headings",
    "frame-dump": "frames as text: tshark -x, Wireshark's plain text with bytes",
    "numdump": "dump with offsets in decimal numbers or characters: od -t d1, u2, c, hexdump -c, -d",
    "hexdump": "dump with offsets: hexdump, xxd, od, Wireshark's",
    "hexwords": "bytes among other words: logs of programs, brackets, literals of Python, lists of numbers",
    "hextext": "hexadecimal, decimal or octal text of a terminal program, with or without times",
    "bin": "raw bytes of one direction, no times",
}
