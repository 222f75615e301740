# SPDX-License-Identifier: MIT
"""The parts of tools/dev; Python's standard library is all they need, since they make everything else."""
