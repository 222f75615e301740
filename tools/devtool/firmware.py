# SPDX-License-Identifier: MIT
"""Images of microcontrollers: builds and measures them, drives the demonstration in QEMU, flashes them."""

from __future__ import annotations

import argparse
import dataclasses
import functools
import os
import shutil
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from devtool.base import (
    BUILD,
    EXIT_SETUP,
    EXIT_USAGE,
    ROOT,
    VENV,
    Add,
    Command,
    Run,
    Stop,
    environment,
    line_of,
    run_visibly,
    say,
    shown,
)
from devtool.cmake import BOARDS, build
from devtool.commands import quietly
from devtool.setup import ensure

FLASHED: Final = ("stm32f405",)
PROBES: Final = ("stlink", "dfu", "serial")
BODY_AT: Final = "0x0800C000"
"""Where the program lies behind the vectors and the store (hal/stm32f405/stm32f405.ld)."""
VECTORS_AT: Final = "0x08000000"


def image_of(board: str, suffix: str) -> Path:
    """Return the image of BOARD in the form SUFFIX."""
    return BUILD / board / f"argus-{board}.{suffix}"


def build_image(board: str, config: str, run: Run) -> None:
    """Build the image of BOARD with the settings of the file CONFIG ("": none) compiled in, once they are checked."""
    if config:
        build("release", run)
        run([BUILD / "release/board_config", config])
    build(board, run, [f"ARGUS_CONFIG={config}"])


def checked_config(config: Path | None) -> str:
    """Return the whole path of CONFIG, which must exist, or "" when there is none."""
    if config is None:
        return ""
    if not config.is_file():
        raise Stop(f"{config}: no such file; argusd --example-config prints one", EXIT_USAGE)
    return str(config.resolve())


def do_firmware(args: argparse.Namespace) -> int:
    """Build the image of a board and tell its sizes."""
    config = checked_config(args.config)
    ensure([args.board, *(["release"] if config else [])])
    quietly(f"building the image for {args.board}", functools.partial(build_image, args.board, config))
    for suffix in ("elf", "hex", "bin"):
        say(shown(image_of(args.board, suffix)))
    run_visibly([sys.executable, "tools/size_image.py", BUILD / args.board])
    return 0


def do_hil(args: argparse.Namespace) -> int:
    """Build the image of a board and let it drive the demonstration in QEMU."""
    ensure(["release", args.board], ["qemu-arm"])
    quietly("building the emulator's parts", functools.partial(build, "release"))
    quietly(f"building the image for {args.board}", functools.partial(build_image, args.board, ""))
    say(f"starting the demonstration with the image of {args.board} in QEMU")
    python = str(VENV / "bin/python")
    command = [python, "-m", "hil_sim.demo", "--argusd", str(ROOT / "tools/qemu-board"), *args.rest]
    os.execve(python, command, environment() | {"ARGUS_BOARD": args.board})


@dataclasses.dataclass(frozen=True)
class Flasher:
    """A program that flashes: the Debian package that brings it, and its commands."""

    program: str
    package: str
    commands: Callable[[argparse.Namespace], list[Command]]


def by_openocd(args: argparse.Namespace) -> list[Command]:
    """Return the command for an ST-Link, through OpenOCD."""
    program = f"program {image_of(args.board, 'elf')} verify reset exit"
    return [["openocd", "-f", "interface/stlink.cfg", "-f", "target/stm32f4x.cfg", "-c", program]]


def by_st_flash(args: argparse.Namespace) -> list[Command]:
    """Return the command for an ST-Link, through the stlink tools."""
    return [["st-flash", "--reset", "--format", "ihex", "write", image_of(args.board, "hex")]]


def by_dfu(args: argparse.Namespace) -> list[Command]:
    """Return the commands for the boot loader over USB: the vectors last, so that a half of it never starts.

    The sectors of the store lie between the two and are not touched.
    """
    usb: Command = ["dfu-util", "-a", "0", "-d", "0483:df11"]
    return [
        [*usb, "-s", BODY_AT, "-D", image_of(args.board, "body.bin")],
        [*usb, "-s", f"{VECTORS_AT}:leave", "-D", image_of(args.board, "vectors.bin")],
    ]


def by_serial(args: argparse.Namespace) -> list[Command]:
    """Return the command for the boot loader over the operator's UART."""
    return [["stm32flash", "-b", "115200", "-w", image_of(args.board, "hex"), "-v", "-g", "0", args.device]]


FLASHERS: Final = {
    "stlink": (Flasher("openocd", "openocd", by_openocd), Flasher("st-flash", "stlink-tools", by_st_flash)),
    "dfu": (Flasher("dfu-util", "dfu-util", by_dfu),),
    "serial": (Flasher("stm32flash", "stm32flash", by_serial),),
}


def chosen_flasher(probe: str, dry_run: bool) -> Flasher:
    """Return the first program for PROBE that is here; for a DRY_RUN the first of all will do."""
    flashers = FLASHERS[probe]
    for flasher in flashers:
        if shutil.which(flasher.program):
            return flasher
    if dry_run:
        return flashers[0]
    names = " or ".join(f"{one.program} (apt-get install {one.package})" for one in flashers)
    raise Stop(f"probe {probe} needs {names}", EXIT_SETUP)


def do_flash(args: argparse.Namespace) -> int:
    """Build the image of a board and write it into the board's flash."""
    config = checked_config(args.config)
    if args.probe == "serial" and not args.dry_run and not Path(args.device).exists():
        raise Stop(f"--device {args.device}: there is no such port; name the one of the board", EXIT_USAGE)
    flasher = chosen_flasher(args.probe, args.dry_run)
    ensure([args.board, *(["release"] if config else [])])
    quietly(f"building the image for {args.board}", functools.partial(build_image, args.board, config))
    for command in flasher.commands(args):
        if args.dry_run:
            print(line_of(command))
        else:
            say(line_of(command))
            run_visibly(command)
    return 0


def add_board(parser: argparse.ArgumentParser, boards: Sequence[str]) -> None:
    """Add the option that chooses a board."""
    parser.add_argument("--board", choices=boards, default=boards[0], help="default: %(default)s")


def add_config(parser: argparse.ArgumentParser) -> None:
    """Add the option that compiles settings in."""
    parser.add_argument(
        "--config", type=Path, metavar="FILE", help="settings to compile in, an INI file as argusd's"
    )


def add_commands(add: Add) -> None:
    """Add the commands about boards."""
    firmware = add(
        "firmware",
        do_firmware,
        "build the image of a microcontroller and print its flash, RAM and worst stack",
        "firmware --board mps2-an386\nfirmware --board stm32f405 --config board.ini",
    )
    add_board(firmware, BOARDS)
    add_config(firmware)
    hil = add(
        "hil",
        do_hil,
        "let the image of a microcontroller drive the demonstration in QEMU; passes its arguments on",
        "hil --board mps2-an386\nhil --board mps2-an386 -- --seed 7 --fail off:3,wrong:6",
    )
    add_board(hil, BOARDS)
    hil.add_argument("rest", metavar="ARGUMENT", nargs="*", help="argument of the demonstration, after --")
    flash = add(
        "flash",
        do_flash,
        "build the image of a microcontroller and write it into its flash",
        "flash --board stm32f405 --probe stlink\nflash --probe dfu --dry-run\n"
        "flash --probe serial --device /dev/ttyUSB0",
    )
    add_board(flash, FLASHED)
    add_config(flash)
    flash.add_argument("--probe", choices=PROBES, default=PROBES[0], help="default: %(default)s")
    flash.add_argument("--device", default="/dev/ttyUSB0", help="of probe serial (default: %(default)s)")
    flash.add_argument("--dry-run", action="store_true", help="print the commands and flash nothing")
