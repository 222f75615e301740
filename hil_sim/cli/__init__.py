# SPDX-License-Identifier: MIT
"""The `argus-sim` command."""
