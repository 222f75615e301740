# SPDX-License-Identifier: MIT
"""Worlds: what is solid in them, what moves in them, and the robot's body among it."""
