# SPDX-License-Identifier: MIT
"""Emulator of Pioneer robots: world, body, sonar, faults, and the ARCOS server a client talks to."""
