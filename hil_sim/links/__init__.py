# SPDX-License-Identifier: MIT
"""Links to a client, and the loop that serves it in real time."""
