# SPDX-License-Identifier: MIT
"""Rule: the Renode platform of a board has its registers, interrupts and memories where the image looks for them.

Renode itself is not installed where the tests run.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

import pytest

ROOT: Final = Path(__file__).resolve().parents[2]
BOARD: Final = ROOT / "hal/stm32f405"
REPL: Final = (BOARD / "renode/stm32f405.repl").read_text(encoding="utf-8")
RESC: Final = (BOARD / "renode/stm32f405.resc").read_text(encoding="utf-8")
REGISTERS: Final = (BOARD / "registers.h").read_text(encoding="utf-8")
LINKER: Final = (BOARD / "stm32f405.ld").read_text(encoding="utf-8")
NAMES: Final = {
    "usart1": "USART1",
    "usart2": "USART2",
    "timer2": "TIM2",
    "iwdg": "IWDG",
    "rcc": "RCC",
    "gpioPortA": "GPIOA",
    "gpioPortB": "GPIOB",
    "flash_controller": "FLASH",
    "rng": "RNG",
    "can1": "CAN1",
}
UNITS: Final = {"K": 1024, "M": 1024 * 1024}


def entry(name: str) -> str:
    """Return what the platform says of the peripheral NAME."""
    found = re.search(rf"^{name}: .*?(?=^\w|\Z)", REPL, re.MULTILINE | re.DOTALL)
    assert found is not None, name
    return found[0]


@pytest.mark.parametrize("name", NAMES)
def test_a_peripheral_is_where_the_header_has_it(name: str) -> None:
    wanted = re.search(rf"#define STM32_{NAMES[name]} \(\(\w+ \*\)(0x\w+)u\)", REGISTERS)
    at = re.search(r"sysbus <?(0x\w+)", entry(name))
    assert wanted is not None
    assert at is not None
    assert int(at[1], 16) == int(wanted[1], 16)


def test_every_peripheral_of_the_header_is_in_the_platform() -> None:
    of_header = set(re.findall(r"#define STM32_(\w+) \(\(\w+ \*\)0x", REGISTERS))
    assert of_header == set(NAMES.values())


@pytest.mark.parametrize("name", ["usart1", "usart2"])
def test_an_interrupt_has_the_number_of_the_header(name: str) -> None:
    wanted = re.search(rf"#define STM32_IRQ_{NAMES[name]} (\d+)u", REGISTERS)
    found = re.search(r"-> nvic@(\d+)", entry(name))
    assert wanted is not None
    assert found is not None
    assert found[1] == wanted[1]


def memory_of_linker(name: str) -> tuple[int, int]:
    """Return where the memory NAME of the linker script begins and ends."""
    found = re.search(rf"{name} \(\w+\)\s*: ORIGIN = (0x\w+), LENGTH = (\d+)([KM])", LINKER)
    assert found is not None
    begin = int(found[1], 16)
    return begin, begin + int(found[2]) * UNITS[found[3]]


@pytest.mark.parametrize(("name", "parts"), [("flash", ("VECTORS", "FLASH")), ("sram", ("RAM",))])
def test_the_memories_hold_what_is_linked_into_them(name: str, parts: tuple[str, ...]) -> None:
    at, size = re.search(r"sysbus (0x\w+)", entry(name)), re.search(r"size: (0x\w+)", entry(name))
    assert at is not None
    assert size is not None
    begin = int(at[1], 16)
    for part in parts:
        low, high = memory_of_linker(part)
        assert begin <= low
        assert high <= begin + int(size[1], 16)


def test_the_script_names_what_there_is() -> None:
    assert (ROOT / re.findall(r"LoadPlatformDescription @(\S+)", RESC)[0]).is_file()
    assert "$elf?=@build/stm32f405/argus-stm32f405.elf" in RESC
    ends = dict(re.findall(r"connector Connect sysbus\.(\w+) (\w+)", RESC))
    assert ends == {"usart2": "robot", "usart1": "operator"}
    assert all(entry(uart) for uart in ends)
    vectors = re.findall(r"VectorTableOffset (0x\w+)", RESC)
    assert [int(at, 16) for at in vectors] == [memory_of_linker("VECTORS")[0]]
