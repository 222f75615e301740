# SPDX-License-Identifier: MIT
"""Rule: wherever the missions run, each is run to a record, whatever dies, and the records are the same."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from distributed import Client, LocalCluster

from hil_sim.bench import pool
from hil_sim.bench.cli import main
from hil_sim.bench.store import read_results
from hil_sim.bench.work import core_digest, work, world_files
from hil_sim.bench.plan import make_cases, parse_id
from hil_sim.errors import LinkError
from hil_sim.world import builtin_path  # noqa: F401

IDS = [case.id for case in make_cases(["argus"], "tune", ["lab"], range(1, 5), ["off", "garbage", "pair"])]
DEADLY = "argus/tune/lab/1/off"
