# SPDX-License-Identifier: MIT
"""The functions of libargus.so, with the types of what they return and take."""

from __future__ import annotations

import ctypes
from typing import Any, Final

FUNCTIONS: Final[dict[str, tuple[Any, tuple[Any, ...]]]] = {
    "argus_config_default": (None, (ctypes.c_void_p,)),
    "argus_link_up": (None, (ctypes.c_void_p, ctypes.c_uint32)),
    "argus_link_lost": (None, (ctypes.c_void_p, ctypes.c_uint32)),
    "argus_receive": (None, (ctypes.c_void_p, ctypes.c_uint32, ctypes.c_char_p, ctypes.c_size_t)),
    "argus_process": (ctypes.c_uint32, (ctypes.c_void_p, ctypes.c_uint32)),
    "argus_transmit": (ctypes.c_size_t, (ctypes.c_void_p, ctypes.c_char_p, ctypes.c_size_t)),
    "argus_name": (ctypes.c_char_p, (ctypes.c_int, ctypes.c_int)),
    "argus_shim_event_level": (ctypes.c_int, (ctypes.c_uint16,)),
    "argus_shim_core_size": (ctypes.c_size_t, ()),
    "argus_shim_config_size": (ctypes.c_size_t, ()),
    "argus_shim_config_key": (ctypes.c_char_p, (ctypes.c_uint32,)),
    "argus_shim_config_choices": (ctypes.c_char_p, (ctypes.c_uint32,)),
    "argus_shim_config_get": (ctypes.c_int32, (ctypes.c_void_p, ctypes.c_uint32)),
    "argus_shim_config_set": (None, (ctypes.c_void_p, ctypes.c_uint32, ctypes.c_int32)),
    "argus_shim_config_check": (ctypes.c_int32, (ctypes.c_void_p, ctypes.POINTER(ctypes.c_int32))),
    "argus_shim_ring_key": (ctypes.c_char_p, (ctypes.c_uint32,)),
    "argus_shim_ring_section": (ctypes.c_char_p, (ctypes.c_uint32,)),
    "argus_shim_ring_fault": (ctypes.c_char_p, (ctypes.c_int,)),
    "argus_shim_robot_size": (ctypes.c_size_t, ()),
    "argus_shim_set_ring": (
        None,
        (
            ctypes.c_void_p,
            ctypes.c_void_p,
            ctypes.c_char_p,
            ctypes.POINTER(ctypes.c_int32),
            ctypes.POINTER(ctypes.c_int32),
            ctypes.c_uint8,
            ctypes.POINTER(ctypes.c_int32),
            ctypes.c_uint8,
            ctypes.POINTER(ctypes.c_int32),
        ),
    ),
    "argus_shim_observe": (
        ctypes.c_bool,
        (
            ctypes.c_void_p,
            ctypes.c_uint32,
            ctypes.POINTER(ctypes.c_int32),
            ctypes.POINTER(ctypes.c_uint16),
            ctypes.c_uint8,
        ),
    ),
    "argus_shim_is_open": (ctypes.c_bool, (ctypes.c_void_p,)),
    "argus_shim_event": (ctypes.c_bool, (ctypes.c_void_p, ctypes.POINTER(ctypes.c_int32))),
    "argus_shim_event_field": (ctypes.c_char_p, (ctypes.c_uint32,)),
    "argus_shim_event_meaning": (ctypes.c_char_p, (ctypes.c_uint16,)),
    "argus_shim_status_field": (ctypes.c_char_p, (ctypes.c_uint32,)),
    "argus_set_course": (ctypes.c_bool, (ctypes.c_void_p, ctypes.POINTER(ctypes.c_int32), ctypes.c_uint16)),
    "argus_record_save": (ctypes.c_size_t, (ctypes.c_void_p, ctypes.c_char_p, ctypes.c_size_t)),
    "argus_record_load": (ctypes.c_bool, (ctypes.c_void_p, ctypes.c_char_p, ctypes.c_size_t)),
    "argus_shim_brief_size": (ctypes.c_size_t, ()),
    "argus_shim_brief": (None, (ctypes.c_void_p, ctypes.c_char_p)),
    "argus_shim_replay": (
        ctypes.c_size_t,
        (
            ctypes.c_void_p,
            ctypes.c_char_p,
            ctypes.c_char_p,
            ctypes.c_size_t,
            ctypes.c_char_p,
            ctypes.POINTER(ctypes.c_uint32),
            ctypes.c_size_t,
        ),
    ),
    "argus_shim_said_size": (ctypes.c_size_t, ()),
    "argus_shim_feed": (
        ctypes.c_size_t,
        (
            ctypes.c_void_p,
            ctypes.POINTER(ctypes.c_uint32),
            ctypes.c_char_p,
            ctypes.c_char_p,
            ctypes.c_size_t,
            ctypes.c_char_p,
            ctypes.POINTER(ctypes.c_uint32),
            ctypes.POINTER(ctypes.c_size_t),
        ),
    ),
    "argus_shim_sonar_field": (ctypes.c_char_p, (ctypes.c_uint32,)),
    "argus_shim_status": (
        None,
        (ctypes.c_void_p, ctypes.POINTER(ctypes.c_int64), ctypes.POINTER(ctypes.c_int64)),
    ),
}
