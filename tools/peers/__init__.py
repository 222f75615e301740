# SPDX-License-Identifier: MIT
"""Programs of others that drive this robot, run beside Argus: `tools/dev test --only peers` does; needs .venv."""
