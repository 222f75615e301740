# SPDX-License-Identifier: MIT
"""The ARCOS server: sessions and commands, as the robot and as the vendor's emulator answer them."""
