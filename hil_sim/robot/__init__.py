# SPDX-License-Identifier: MIT
"""The robot: its drive, its body's way through the world, its battery, and what its packets say."""
