# SPDX-License-Identifier: MIT
"""The numbers of the protocol, by section of tables/arcos.toml."""

from __future__ import annotations

from typing import Final

from hil_sim.tables import section

COMMAND: Final = section("arcos", "command")
TYPE: Final = section("arcos", "type")
ARGUMENT: Final = section("arcos", "argument")
FLAG: Final = section("arcos", "flags")
FRAME: Final = section("arcos", "frame")
TIMING: Final = section("arcos", "timing")
SIP: Final = section("arcos", "sip")
DEFAULT: Final = section("arcos", "default")
HOSTBAUD: Final = section("arcos", "hostbaud")
BUMPSTALL: Final = section("arcos", "bumpstall")
BAUD: Final = section("arcos", "baud")
BAUD_OF_CODE: Final = {code: BAUD[name] for name, code in HOSTBAUD.items()}
