# SPDX-License-Identifier: MIT
"""Rule: in a clean Debian the packages install, the service runs as its unit says, and a purge leaves no file."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import argus
import pytest
from packages_help import run

pytestmark = pytest.mark.skipif(
    "ARGUS_CHROOT" not in os.environ, reason="ARGUS_CHROOT= names no clean Debian to install in"
)
NAMES = "argusd argus-tools libargus0.1 libargus-dev"
ENVIRONMENT = {
    "PATH": "/usr/sbin:/usr/bin:/sbin:/bin",
    "DEBIAN_FRONTEND": "noninteractive",
    "LC_ALL": "C.UTF-8",
}
WANTS = "etc/systemd/system/multi-user.target.wants/argusd.service"
PATIENCE_S = 60.0
FOREIGN = ("proc", "sys", "dev", "packages")


class Debian:
    """A root file system, and commands in it with devices and processes; no mount stays behind."""

    def __init__(self, root: Path) -> None:
        self.root = root

    def words(self, line: str) -> list[str]:
        """The command that runs a line of shell in it."""
        root = shlex.quote(str(self.root))
        binds = " && ".join(f"mount --rbind /{name} {root}/{name}" for name in ("dev", "proc"))
        return [
            "unshare",
            "--mount",
            "sh",
            "-ec",
            f"{binds} && exec chroot {root} sh -ec {shlex.quote(line)}",
        ]

    def run(self, line: str) -> str:
        """Run a line that must succeed; return what it prints."""
        return run(*self.words(line), env=ENVIRONMENT, cwd="/")

    @contextmanager
    def running(self, line: str) -> Iterator[subprocess.Popen[bytes]]:
        """A program while the block lasts."""
        with subprocess.Popen(
            self.words(f"exec {line}"), env=ENVIRONMENT, cwd="/", stdin=subprocess.DEVNULL
        ) as child:
            try:
                yield child
            finally:
                child.terminate()

    def ours(self) -> set[str]:
        """Every file, link and folder in it that has our name."""
        top = [path for path in self.root.iterdir() if path.name not in FOREIGN]
        return {
            str(path.relative_to(self.root))
            for folder in top
            for path in (folder.rglob("*") if folder.is_dir() and not folder.is_symlink() else ())
            if "argus" in path.name
        }


@pytest.fixture(scope="module")
def debian(debs: dict[str, Path]) -> Debian:
    """The one that ARGUS_CHROOT names, made when it is not there; the packages are in /packages."""
    root = Path(os.environ["ARGUS_CHROOT"])
    if not root.exists():
        run("debootstrap", "--variant=minbase", "bookworm", root)
    shutil.rmtree(root / "packages", ignore_errors=True)
    (root / "packages").mkdir()
    for deb in debs.values():
        shutil.copy2(deb, root / "packages")
    return Debian(root)


def until(what: str, probe: object, limit_s: float = PATIENCE_S) -> None:
    """Wait until something holds."""
    end = time.monotonic() + limit_s
    while not probe():  # type: ignore[operator]
        assert time.monotonic() < end, f"not within {limit_s:g} s: {what}"
        time.sleep(0.2)


def unit_line(debian: Debian, link: str) -> str:
    """What systemd would start, as the unit and its settings say, as its user; systemd itself cannot run here."""
    unit = (debian.root / "usr/lib/systemd/system/argusd.service").read_text()
    start = re.search(r"^ExecStart=(.*)$", unit, re.MULTILINE)
    assert start
    for setting in ("User=argus", "Group=argus", "SupplementaryGroups=dialout", "StateDirectory=argus"):
        assert setting in unit
    defaults = (debian.root / "etc/default/argusd").read_text()
    options = re.search(r'^ARGUSD_OPTIONS="(.*)"$', defaults, re.MULTILINE)
    assert options
    words = start[1].replace("${ARGUSD_LINK}", link).replace("$ARGUSD_OPTIONS", options[1])
    return f"setpriv --reuid argus --regid argus --groups dialout --no-new-privs {words}"


def the_service_runs(debian: Debian) -> None:
    """An emulated robot of argus-tools, argusd as its unit starts it, and argusctl of root."""
    debian.run("install -d -o argus -g argus /var/lib/argus /run/argus")
    port = debian.root / "tmp/robot"
    with debian.running("argus-sim --link-name /tmp/robot --baud 115200"):
        until("the robot is there", port.is_symlink)
        debian.run("chgrp dialout $(readlink /tmp/robot); chmod g+rw $(readlink /tmp/robot)")
        with debian.running(unit_line(debian, "serial:/tmp/robot@115200")) as argusd:
            control = debian.root / "run/argus/control"
            until("the control socket is there", control.exists)
            until("the ring is checked", lambda: "IDLE" in debian.run("argusctl status --json"))
            said = debian.run("argusctl status --json")
            assert '"HEALTHY"' in said
            assert '"active":false' in said.replace(" ", "")
            argusd.terminate()
            assert argusd.wait(PATIENCE_S) == 0
        until("what it knows is kept", lambda: any((debian.root / "var/lib/argus").iterdir()))
    shutil.rmtree(debian.root / "run/argus")  # as systemd does when the service stops


OURS = "# written by the owner of the robot"
NEW = "# a setting of the next version"
CONFFILES = ("etc/argus/argusd.conf", "etc/default/argusd")


def an_upgrade_keeps_what_the_owner_wrote(debian: Debian) -> None:
    """A package of a later version, whose settings changed, over settings that were changed here, too."""
    for name in CONFFILES:
        debian.run(f"echo '{OURS}' >> /{name}")
    change = " && ".join(f"echo '{NEW}' >> /tmp/next/{name}" for name in CONFFILES)
    debian.run(
        "dpkg-deb -R /packages/argusd_*.deb /tmp/next"
        " && sed -i 's/^Version: .*/Version: 99.0/' /tmp/next/DEBIAN/control"
        f" && {change} && dpkg-deb --root-owner-group -b /tmp/next /tmp/next.deb && rm -r /tmp/next"
    )
    debian.run("dpkg --force-confdef --force-confold -i /tmp/next.deb && rm /tmp/next.deb")
    assert debian.run("dpkg-query -W -f '${Version} ${Status}' argusd") == "99.0 install ok installed"
    for name in CONFFILES:
        kept = (debian.root / name).read_text()
        assert OURS in kept
        assert NEW not in kept
        offered = debian.root / f"{name}.dpkg-dist"
        assert NEW in offered.read_text()
        assert OURS not in offered.read_text()
    assert debian.run("argusd --version").startswith("argusd ")


def test_installed_started_removed_and_purged(debian: Debian) -> None:
    debian.run("apt-get update && apt-get install -y --no-install-recommends systemd")
    assert debian.ours() == set()
    debian.run("apt-get install -y --no-install-recommends /packages/*.deb")
    assert "dialout" in debian.run("id argus")
    for name in ("argusd", "argus-sim", "argus-log", "argusctl", "argus-conformance"):
        assert name in debian.run(f"{name} --help")
    assert debian.run("python3 -c 'import argus; print(argus.__version__)'").strip() == argus.__version__
    assert debian.run(f"dpkg --audit; dpkg -V {NAMES}") == ""
    debian.run("systemctl enable argusd.service 2>&1")
    assert (debian.root / WANTS).is_symlink()
    the_service_runs(debian)
    an_upgrade_keeps_what_the_owner_wrote(debian)
    debian.run(f"apt-get remove -y {NAMES}")
    left = {name for name in debian.ours() if not name.startswith("var/lib/dpkg/")}
    offered = {f"{name}.dpkg-dist" for name in CONFFILES}
    kept = {"etc/argus", *CONFFILES, *offered, "var/lib/argus", WANTS}
    assert left == kept
    assert all(OURS in (debian.root / name).read_text() for name in CONFFILES)
    debian.run("apt-get purge -y argusd libargus0.1")  # the others left nothing, so apt knows them no more
    assert debian.ours() == set()
