# SPDX-License-Identifier: MIT
"""Argus for ROS 2: a driver's view of argusd, and range_guard, the same repair for any ring of Range topics."""
