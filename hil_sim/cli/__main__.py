# SPDX-License-Identifier: MIT
"""`python -m hil_sim.cli` is `argus-sim`."""

import sys

from hil_sim.cli.main import main

sys.exit(main())
