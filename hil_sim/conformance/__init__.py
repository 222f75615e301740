# SPDX-License-Identifier: MIT
"""Black-box checks of an ARCOS server, robot or emulator: `argus-conformance`."""
