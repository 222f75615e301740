# SPDX-License-Identifier: MIT
"""Injected faults: how they are written, and what they do to sonars, bumper and link."""
