# SPDX-License-Identifier: MIT
"""Scenario files, and the robot that one describes."""
