# SPDX-License-Identifier: MIT
"""Generated examples are the same in every run, so a red build repeats; HYPOTHESIS_PROFILE=default roams."""

from __future__ import annotations

import os

from hypothesis import settings

settings.register_profile("repeatable", derandomize=True, print_blob=True)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeatable"))
