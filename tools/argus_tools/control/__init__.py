# SPDX-License-Identifier: MIT
"""The control socket of argusd, for programs and for people (SPEC.md, Control socket)."""

from argus_tools.control.client import Client, ControlError, Refused

__all__ = ["Client", "ControlError", "Refused"]
