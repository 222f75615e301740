# SPDX-License-Identifier: MIT
"""Files that a run writes: the recording of its link, and the truth about it."""
