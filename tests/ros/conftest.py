# SPDX-License-Identifier: MIT
"""ROS for the tests: on this machine only, in a domain of this process's own."""

from __future__ import annotations

import gc
import os
from collections.abc import Iterator

import pytest

pytest.importorskip("rclpy", reason="the packages of ROS (extra [ros]) are not here")

import rclpy

os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
os.environ["ROS_DOMAIN_ID"] = str(1 + os.getpid() % 99)


@pytest.fixture(autouse=True)
def ros() -> Iterator[None]:
    """A participant for each test. Nodes refer to themselves, so that only a collection ends their participant: until
    then its services answer beside those of the next test, or count as servers that DDS cannot match."""
    rclpy.init()
    yield
    rclpy.try_shutdown()
    gc.collect()
