# SPDX-License-Identifier: MIT
"""Rings of ranges that come from no ARCOS link: messages of ROS, tables, and the packets that they become."""
