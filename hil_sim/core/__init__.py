# SPDX-License-Identifier: MIT
"""The fault manager itself, the C core, for Python: its library, how that is made, and how recordings are fed to it."""
