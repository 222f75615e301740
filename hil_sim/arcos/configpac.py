# SPDX-License-Identifier: MIT
"""The robot's configuration packet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Final, Self

from hil_sim.arcos.fields import pack_tail, unpack_tail
from hil_sim.arcos.numbers import DEFAULT, TIMING, TYPE
from hil_sim.tables.robot import robot_table

_ROBOT: Final = robot_table()
_MOTION: Final = _ROBOT.motion


@dataclass(frozen=True)
class ConfigPac:
    """The robot's configuration, by default that of a P3-DX; fields that a shorter packet lacks are None."""

    robot_type: bytes | None = _ROBOT.robot_class.encode()
    subtype: bytes | None = _ROBOT.subclass.encode()
    serial_number: bytes | None = _ROBOT.serial.encode()
    four_motors: int | None = 0
    rot_vel_top: int | None = _MOTION["rotvel_top_deg_s"]
    trans_vel_top: int | None = _MOTION["vel_top_mm_s"]
    rot_acc_top: int | None = _MOTION["rotaccel_top_deg_s2"]
    trans_acc_top: int | None = _MOTION["accel_top_mm_s2"]
    pwm_max: int | None = DEFAULT["PWMMAX"]
    name: bytes | None = _ROBOT.name.encode()
    sip_cycle_ms: int | None = TIMING["SIP_CYCLE_MS"]
    host_baud: int | None = DEFAULT["HOSTBAUD"]
    aux1_baud: int | None = 0
    gripper: int | None = 0
    front_sonar: int | None = 1
    rear_sonar: int | None = 1
    low_battery_dv: int | None = DEFAULT["LOWBATTERY_DV"]
    rev_count: int | None = _MOTION["rev_count"]
    watchdog_ms: int | None = TIMING["WATCHDOG_MS"]
    p2mpacs: int | None = 0
    stall_val: int | None = DEFAULT["STALLVAL"]
    stall_count_ms: int | None = DEFAULT["STALLCOUNT_MS"]
    joy_vel: int | None = DEFAULT["JOYVEL_MM_S"]
    joy_rvel: int | None = DEFAULT["JOYRVEL_DEG_S"]
    rot_vel_max: int | None = _MOTION["rotvel_max_deg_s"]
    trans_vel_max: int | None = _MOTION["vel_max_mm_s"]
    rot_acc: int | None = _MOTION["rotaccel_deg_s2"]
    rot_decel: int | None = _MOTION["rotdecel_deg_s2"]
    rot_kp: int | None = DEFAULT["ROTKP"]
    rot_kv: int | None = DEFAULT["ROTKV"]
    rot_ki: int | None = DEFAULT["ROTKI"]
    trans_acc: int | None = _MOTION["accel_mm_s2"]
    trans_decel: int | None = _MOTION["decel_mm_s2"]
    trans_kp: int | None = DEFAULT["TRANSKP"]
    trans_kv: int | None = DEFAULT["TRANSKV"]
    trans_ki: int | None = DEFAULT["TRANSKI"]
    front_bumps: int | None = 0
    rear_bumps: int | None = 0
    charger: int | None = 0
    sonar_cycle_ms: int | None = _ROBOT.cycle_ms
    auto_baud: int | None = DEFAULT["AUTOBAUD"]
    has_gyro: int | None = DEFAULT["HASGYRO"]
    drift_factor: int | None = 0
    aux2_baud: int | None = 0
    aux3_baud: int | None = 0
    ticks_mm: int | None = _MOTION["ticks_per_mm"]
    shutdown_dv: int | None = DEFAULT["SHUTDOWN_DV"]
    version: bytes | None = b"2.6"
    gyro_cw: int | None = 0
    gyro_ccw: int | None = 0
    kinematics_delay_ms: int | None = 0
    lat_vel_top: int | None = None
    lat_acc_top: int | None = None
    lat_vel_max: int | None = None
    lat_acc: int | None = None
    lat_decel: int | None = None
    charge_threshold: int | None = None
    rest: bytes = b""

    _SPEC: ClassVar[tuple[tuple[str, str], ...]] = (
        ("robot_type", "str"), ("subtype", "str"), ("serial_number", "str"), ("four_motors", "B"),
        ("rot_vel_top", "H"), ("trans_vel_top", "H"), ("rot_acc_top", "H"), ("trans_acc_top", "H"),
        ("pwm_max", "H"), ("name", "str"), ("sip_cycle_ms", "B"), ("host_baud", "B"), ("aux1_baud", "B"),
        ("gripper", "H"), ("front_sonar", "H"), ("rear_sonar", "B"), ("low_battery_dv", "H"),
        ("rev_count", "H"), ("watchdog_ms", "H"), ("p2mpacs", "B"), ("stall_val", "H"),
        ("stall_count_ms", "H"), ("joy_vel", "H"), ("joy_rvel", "H"), ("rot_vel_max", "H"),
        ("trans_vel_max", "H"), ("rot_acc", "H"), ("rot_decel", "H"), ("rot_kp", "H"), ("rot_kv", "H"),
        ("rot_ki", "H"), ("trans_acc", "H"), ("trans_decel", "H"), ("trans_kp", "H"), ("trans_kv", "H"),
        ("trans_ki", "H"), ("front_bumps", "B"), ("rear_bumps", "B"), ("charger", "B"),
        ("sonar_cycle_ms", "B"), ("auto_baud", "B"), ("has_gyro", "B"), ("drift_factor", "h"),
        ("aux2_baud", "B"), ("aux3_baud", "B"), ("ticks_mm", "H"), ("shutdown_dv", "H"), ("version", "str"),
        ("gyro_cw", "H"), ("gyro_ccw", "H"), ("kinematics_delay_ms", "B"), ("lat_vel_top", "H"),
        ("lat_acc_top", "H"), ("lat_vel_max", "H"), ("lat_acc", "H"), ("lat_decel", "H"),
        ("charge_threshold", "H"),
    )  # fmt: skip

    @property
    def data(self) -> bytes:
        """The data part of the packet."""
        return bytes((TYPE["CONFIGPAC"],)) + pack_tail(self._SPEC, self) + self.rest

    @classmethod
    def decode(cls, data: bytes) -> Self:
        """Read a CONFIGpac of any length."""
        values, at = unpack_tail(cls._SPEC, data, 1)
        return cls(**values, rest=data[at:])
