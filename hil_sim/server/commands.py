# SPDX-License-Identifier: MIT
"""What a robot without accessories makes of each command number: its name, or why it has no effect."""

from __future__ import annotations

from typing import Final

from hil_sim.arcos import COMMAND, Command

IGNORED: Final[dict[str, str]] = {
    "SAY": "the buzzer is not emulated",
    "SETRVDIR": "not in this firmware",
    "IMUREQUEST": "no inertial unit",
    "TIMER": "not in this firmware",
    "GRIPPER": "no gripper",
    "KICK": "no gripper",
    "GRIPPERVAL": "no gripper",
    "GRIPREQUEST": "no gripper",
    "GYROCALCW": "no gyro",
    "GYROCALCCW": "no gyro",
    "PTUPOS": "no pan-tilt unit",
    "TCM2": "no compass",
    "MOVINGBLINK": "no light",
    "GYRO": "no gyro",
    "LCDWRITE": "no display",
    "BATTERYINFO": "no battery controller",
    "CALCOMP": "no compass",
    "CHARGE": "no docking charger",
    "SOUND": "no sound board",
    "PLAYLIST": "no sound board",
    "SOUNDTOG": "no sound board",
    "LATVEL": "two wheels do not move sideways",
    "LATACCEL": "two wheels do not move sideways",
    "RECENTERWHEELS": "two wheels do not steer",
    "ACCELINFO": "no accelerometer",
    "TORQUEINFO": "no torque sensor",
    "DIGTEMPTEST": "no temperature sensor",
    "ANALOGTEMPTEST": "no temperature sensor",
    "SIM_MODEL_CONFIG": "the model is chosen at the start",
    "SIM_LRF_ENABLE": "no laser",
    "SIM_LRF_SET_FOV_START": "no laser",
    "SIM_LRF_SET_FOV_END": "no laser",
    "SIM_LRF_SET_RES": "no laser",
    "SIM_CTRL": "the world is chosen at the start",
    "SIM_MESSAGE": "nobody to show it to",
    "SIM_EXIT": "a client does not end the emulator",
    "MAINTENANCE": "there is no firmware to load",
}
"""Commands that have a name and no effect, and what the robot lacks for one."""

IGNORED_RANGES: Final[dict[str, str]] = {
    "ARM": "no arm",
    "POWER": "no switched power",
    "POWER2": "no switched power",
    "LX": "a command of newer bases",
    "LX2": "a command of newer bases",
}
"""The same for ranges of numbers, NAME_FIRST to NAME_LAST in the table."""


def _names() -> tuple[dict[int, str], dict[int, str]]:
    names = {number: name for name, number in COMMAND.items()}
    reasons = {COMMAND[name]: reason for name, reason in IGNORED.items()}
    for name, reason in IGNORED_RANGES.items():
        for number in range(COMMAND[f"{name}_FIRST"], COMMAND[f"{name}_LAST"] + 1):
            names[number], reasons[number] = name, reason
    return names, reasons


NAME, WHY_IGNORED = _names()
"""By number: the names of all known commands, and the reasons of those without effect."""


def describe(command: Command) -> str:
    """Return a command in words for the log.

    >>> describe(Command.integer(COMMAND["VEL"], -300))
    'VEL (11) -300'
    >>> describe(Command(199))
    'unknown (199)'
    """
    text = f"{NAME.get(command.number, 'unknown')} ({command.number})"
    if not command.argument:
        return text
    return f"{text} {command.value if len(command.argument) == 3 else command.argument.hex(' ')}"
