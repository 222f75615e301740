# SPDX-License-Identifier: MIT
"""Emulator of a Pioneer P3-DX: world, body, sonar, faults, and the ARCOS server a client talks to."""
