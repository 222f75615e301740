# SPDX-License-Identifier: MIT
"""The main job: Argus drives the emulated robot round a box while sonars fail; a judge compares with the truth."""
