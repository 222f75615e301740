# SPDX-License-Identifier: MIT
"""p2os, rosaria and Player: built and run in a Debian that has ROS 1, beside ours, with a client that wanders."""

from __future__ import annotations

import contextlib
import os
import re
import shlex
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Final

from peers.base import cache, copied, free_port, started, wait_port
from peers.guard import Client, Place

SOURCES: Final = ("P2OS_SOURCE", "ROSARIA_SOURCE", "PLAYER_SOURCE")
ROOT_VARIABLE: Final = "ROS1_ROOT"
DEVEL: Final = "/peers/devel"
PLAYER_CONFIG: Final = """driver
(
  name "p2os"
  provides ["odometry:::position2d:0" "sonar:0" "power:0"]
  use_tcp 1
  tcp_remote_host "127.0.0.1"
  tcp_remote_port {port}
)
"""
EXAMPLE: Final = "/peers/build-player/sonarobstacleavoid"
_LIBRARIES: Final = (
    "client_libs/libplayerc++",
    "client_libs/libplayerc",
    "libplayerinterface",
    "libplayercommon",
    "libplayerjpeg",
    "libplayerwkb",
)
FOR_PLAYER: Final = " ".join(
    [
        f"-I/peers/{tree}/{name}"
        for tree in ("player", "build-player")
        for name in ("", "client_libs", *_LIBRARIES)
    ]
    + [f"-L/peers/build-player/{name}" for name in _LIBRARIES]
    + ["-I/usr/include/tirpc -lplayerc++ -lplayerc -lplayerinterface -lplayercommon -lplayerjpeg -lplayerwkb"]
)
FLAGS: Final = "-include boost/bind.hpp -DBOOST_BIND_GLOBAL_PLACEHOLDERS"
"""What rosaria's sources take for granted of an older Boost."""
START_S: Final = 8.0


class Debian:
    """The root of a Debian 12 with the packages that docs/peers.md names; `/` is one, too."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.peers = root / "peers"
        self.peers.mkdir(exist_ok=True)
        hosts = root / "etc/hosts"
        if not hosts.exists():  # one of debootstrap's has none
            hosts.write_text("127.0.0.1 localhost\n")

    def words(self, line: str) -> list[str]:
        """The command that runs a line of shell there, with devices and processes, and leaves no mount behind."""
        root = shlex.quote(str(self.root))
        binds = " && ".join(f"mount --rbind /{name} {root}/{name}" for name in ("dev", "proc"))
        inside = f"exec chroot {root} sh -ec {shlex.quote(line)}"
        return [
            "unshare",
            "--mount",
            "sh",
            "-ec",
            inside if self.root == Path("/") else f"{binds} && {inside}",
        ]

    def run(self, line: str) -> None:
        """Run a line that must succeed."""
        subprocess.run(self.words(line), check=True)


def build_catkin(
    debian: Debian, key: str, source: Path, packages: Mapping[str, str], **variables: str
) -> None:
    """Build packages of catkin, each in the order given: name, and the targets that come before all."""
    folder = cache(key, source, debian.peers)
    for name, first in packages.items():
        [found] = [
            path.parent for path in folder.rglob("package.xml") if f"<name>{name}</name>" in path.read_text()
        ]
        at = f"/{found.relative_to(debian.root)}"
        environment = " ".join(f"{key}={shlex.quote(value)}" for key, value in variables.items())
        debian.run(
            f"mkdir -p /peers/build-{name} && cd /peers/build-{name} && "
            f"{environment} cmake {at} -DCATKIN_DEVEL_PREFIX={DEVEL} -DCMAKE_PREFIX_PATH={DEVEL} && "
            f"{environment} make {first} && {environment} make -j2"
        )


def drivers_of(folder: Path) -> list[str]:
    """The names of Player's drivers, from its sources."""
    texts = [path.read_text(encoding="latin-1") for path in (folder / "server").rglob("CMakeLists.txt")]
    return sorted({name for text in texts for name in re.findall(r"PLAYERDRIVER_OPTION *\( *(\w+)", text)})


def build_player(debian: Debian, source: Path) -> None:
    """Build Player's server with its driver p2os alone, its C++ library and the example that avoids by sonar."""
    folder = cache("player", source, debian.peers)
    off = " ".join(f"-DENABLE_DRIVER_{name.upper()}=OFF" for name in drivers_of(folder) if name != "p2os")
    debian.run(
        "mkdir -p /peers/build-player && cd /peers/build-player && "
        f"cmake /peers/player {off} -DBUILD_PLAYERCC=ON -DBUILD_PLAYERCC_BOOST=OFF -DBUILD_UTILS=OFF "
        "-DPLAYER_BUILD_TESTS=OFF -DBUILD_PYTHONC_BINDINGS=OFF -DCMAKE_CXX_FLAGS=-std=gnu++14 && "
        "make -j2 playerc++ player && "
        f"g++ -std=gnu++14 -o {EXAMPLE} /peers/player/examples/libplayerc++/sonarobstacleavoid.cc {FOR_PLAYER}"
    )


@contextmanager
def ros_master(debian: Debian) -> Iterator[str]:
    """A master of ROS 1; the start of a line that finds it and what was built."""
    port = free_port()
    line = f"export ROS_MASTER_URI=http://127.0.0.1:{port} ROS_IP=127.0.0.1 HOME=/tmp"
    line += f" PYTHONPATH={DEVEL}/lib/python3/dist-packages"
    with started(debian.words(f"{line}; exec rosmaster --core -p {port}")):
        wait_port(port)
        yield line


def wander(debian: Debian, driver: str, node: str) -> Client:
    """A driver of ROS 1 with a node of ours that wanders by its sonars."""
    shutil.copy2(Path(__file__).with_name("wander.py"), debian.peers)

    def run(place: Place) -> None:
        with ros_master(debian) as line, started(debian.words(f"{line}; exec {node.format(at=place)}")):
            time.sleep(START_S)
            words = debian.words(f"{line}; exec python3 /peers/wander.py {driver} {place.seconds}")
            subprocess.run(words, check=True, timeout=place.seconds + 60)

    return Client(f"{driver}, wander.py", run, terminal=driver == "p2os")


def player(debian: Debian, source: Path) -> Client:
    """Build Player; return its server with its driver p2os, and its example that avoids by sonar."""
    build_player(debian, source)

    def run(place: Place) -> None:
        port = free_port()
        config = debian.peers / f"player-{port}.cfg"
        config.write_text(PLAYER_CONFIG.format(port=place.port))
        paths = "export LD_LIBRARY_PATH=$(find /peers/build-player/ -name 'lib*.so' -printf '%h:')"
        server = f"{paths}; exec /peers/build-player/server/player -p {port} /peers/{config.name}"
        client = f"{paths}; exec timeout {place.seconds} {EXAMPLE} -p {port}"
        try:
            with started(debian.words(server)):
                wait_port(port)
                with contextlib.suppress(subprocess.TimeoutExpired):
                    subprocess.run(debian.words(client), check=False, timeout=place.seconds + 60)
        finally:
            config.unlink()

    return Client("Player, sonarobstacleavoid", run)


def p2os(debian: Debian, source: Path) -> Client:
    """Build p2os; return it with what drives it."""
    build_catkin(debian, "p2os", source, {"p2os_msgs": "all", "p2os_driver": "all"})
    node = f"{DEVEL}/lib/p2os_driver/p2os_driver _port:={{at.path}} _use_sonar:=true _pulse:=1.0"
    return wander(debian, "p2os", node)


def rosaria(debian: Debian, source: Path, aria: Path) -> Client:
    """Build rosaria with the ARIA built before; return it with what drives it."""
    copied(aria, debian.peers / "aria", "obj", "docs")
    first = "rosaria_generate_messages rosaria_gencfg"
    build_catkin(debian, "rosaria", source, {"rosaria": first}, ARIA="/peers/aria", CXXFLAGS=FLAGS)
    node = f"env LD_LIBRARY_PATH=/peers/aria/lib {DEVEL}/lib/rosaria/RosAria _port:=127.0.0.1:{{at.port}}"
    return wander(debian, "rosaria", node)


def clients(given: Mapping[str, Path], debian: Debian, aria: Path | None) -> dict[str, Callable[[], Client]]:
    """By its name, what builds each client that is given."""
    found: dict[str, Callable[[], Client]] = {}
    if "P2OS_SOURCE" in given:
        found["p2os"] = partial(p2os, debian, given["P2OS_SOURCE"])
    if "ROSARIA_SOURCE" in given and aria is not None:
        found["rosaria"] = partial(rosaria, debian, given["ROSARIA_SOURCE"], aria)
    if "PLAYER_SOURCE" in given:
        found["Player"] = partial(player, debian, given["PLAYER_SOURCE"])
    return found


def debian() -> Debian:
    """The Debian with ROS 1 that the environment names."""
    return Debian(Path(os.environ[ROOT_VARIABLE]))
