# SPDX-License-Identifier: MIT
"""Sonars: when they fire and what they hear."""
