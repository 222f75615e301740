# SPDX-License-Identifier: MIT
"""Benches: thousands of seeded missions of the firmware in simulated worlds, judged and put into figures."""
