# SPDX-License-Identifier: MIT
"""A laser beside the sonars, or alone: its scans, what may be wrong with them, and how well that is found."""
