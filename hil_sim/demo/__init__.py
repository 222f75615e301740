# SPDX-License-Identifier: MIT
"""The main job: Argus drives the emulated robot round a box while its sonars fail, and a judge compares with the truth."""
