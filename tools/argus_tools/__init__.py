# SPDX-License-Identifier: MIT
"""Tools around Argus: readers and viewers of what the fault manager reports."""
