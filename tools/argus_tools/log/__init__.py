# SPDX-License-Identifier: MIT
"""`argus-log`: decodes, checks, converts, draws and replays logs of a robot's link; one module per subcommand."""
