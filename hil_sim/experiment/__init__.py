# SPDX-License-Identifier: MIT
"""The experiments of the paper, done again, and those that it lacks: `argus-sim experiment`."""
