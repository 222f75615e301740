# SPDX-License-Identifier: MIT
"""What Argus is made of, and that it is made alike: `tools/dev sbom`, `tools/dev reproduce`."""

from __future__ import annotations

import argparse
import dataclasses
import datetime
import gzip
import hashlib
import importlib.metadata
import json
import os
import re
import shutil
import subprocess
import tempfile
import tomllib
import uuid
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from devtool.base import CORES, EXIT_USAGE, ROOT, VENV, Add, Run, Stop, say, shown
from devtool.commands import quietly
from devtool.packaging import DIST, release_time
from devtool.setup import LOCK, ensure
from devtool.stages import StageFailed
from hil_sim.version import version

PINNED: Final = re.compile(r"^([a-z0-9][a-z0-9._-]*)==([^ \\;]+)", re.MULTILINE)
NAME: Final = re.compile(r"[A-Za-z0-9._-]+")
IN_ALL: Final = "argus"
NCURSES, LIBC = "MIT-open-group", "LGPL-2.1-or-later"
DEBIAN: Final[Mapping[str, tuple[tuple[str, str], ...]]] = {
    "wheel": (("libncurses-dev", NCURSES), ("libc6-dev", LIBC)),
    "deb": (
        *(("libncurses6", NCURSES), ("libtinfo6", NCURSES), ("libc6", LIBC)),
        *(("python3", "PSF-2.0"), ("python3-numpy", "BSD-3-Clause"), ("python3-yaml", "MIT")),
        *(("python3-serial", "BSD-3-Clause"), ("python3-matplotlib", "PSF-2.0"), ("python3-rich", "MIT")),
    ),
    "image": (
        ("libnewlib-arm-none-eabi", "BSD-3-Clause"),
        ("gcc-arm-none-eabi", "GPL-3.0-with-GCC-exception"),
    ),
}
"""Debian's packages that each of our products links with, has linked in or depends on, and their licences by SPDX."""
KINDS: Final = tuple(DEBIAN)
DOCUMENTS: Final = Path("/usr/share/doc")
FIELD: Final = re.compile(r"^(Version|Homepage): (\S+)$", re.MULTILINE)
NEWEST: Final = re.compile(rb"^ -- .*>  (.+)$", re.MULTILINE)
BOARD: Final = "mps2-an386"
EPOCHS: Final = (1_600_000_000, 1_700_000_000)
"""When the two trees that are built say that they were written."""


@dataclasses.dataclass(frozen=True)
class Part:
    """One thing that a product is made of; what is not known of it is empty."""

    name: str
    version: str
    licence: str
    purl: str
    since: str
    home: str = ""

    def component(self) -> dict[str, Any]:
        """Return it as CycloneDX has it."""
        told: dict[str, Any] = {
            "type": "library",
            "name": self.name,
            "version": self.version,
            "purl": self.purl,
        }
        told["bom-ref"] = self.purl
        if self.licence:
            told["licenses"] = [{"license": {"name": self.licence}}]
        if self.home:
            told["externalReferences"] = [{"type": "website", "url": self.home}]
        return told


def output_of(*command: str) -> str:
    """Return what COMMAND prints; nothing where it fails or is not there."""
    try:
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    except OSError:
        return ""
    return done.stdout if done.returncode == 0 else ""


# What it is made of ---------------------------------------------------------------------------------------


def of_debian(name: str, licence: str) -> Part:
    """Return the Debian package NAME as installed here, else as apt has it; its age is that of its newest change."""
    installed_here = output_of("dpkg-query", "-W", "-f", "Version: ${Version}\nHomepage: ${Homepage}\n", name)
    number, home = version_and_home(
        installed_here or output_of("apt-cache", "show", "--no-all-versions", name)
    )
    changes = DOCUMENTS / name / "changelog.Debian.gz"
    newest = NEWEST.search(gzip.decompress(changes.read_bytes())) if changes.exists() else None
    since = day_of(newest[1].decode()) if newest else ""
    return Part(name, number, licence, f"pkg:deb/debian/{name}@{number}", since, home)


def version_and_home(told: str) -> tuple[str, str]:
    """Return both from what dpkg or apt tells of a package; empty where it does not."""
    fields = dict(FIELD.findall(told))
    return fields.get("Version", ""), fields.get("Homepage", "")


def day_of(mail_date: str) -> str:
    """Return the day of a date as mail has it."""
    return datetime.datetime.strptime(mail_date, "%a, %d %b %Y %H:%M:%S %z").date().isoformat()


def pinned() -> dict[str, str]:
    """Return the version of each Python package that the lock has."""
    return dict(PINNED.findall(LOCK.read_text(encoding="utf-8")))


def pinned_since() -> dict[str, str]:
    """Return the day on which the version of each Python package came into the lock; nothing without a history."""
    found = {}
    for line in output_of("git", "blame", "--date=short", LOCK.name).splitlines():
        told = re.match(r".*?(\d{4}-\d\d-\d\d) +\d+\) (.*)$", line)
        name = PINNED.match(told[2]) if told else None
        if told and name:
            found[name[1]] = told[1]
    return found


def installed(name: str) -> importlib.metadata.Distribution | None:
    """Return the Python package NAME of .venv, if it is there."""
    places = [str(path) for path in (VENV / "lib").glob("python*/site-packages")]
    return next(iter(importlib.metadata.distributions(name=name, path=places)), None)


def licence_of(told: Mapping[str, Any]) -> str:
    """Return the licence that the metadata of a Python package tell of."""
    short = [told.get("License-Expression"), told.get("License")]
    for one in short:
        if one and "\n" not in one.strip() and len(one) < 60:
            return str(one).strip()
    return licence_by_class(told)


def licence_by_class(told: Mapping[str, Any]) -> str:
    """Return the licence by the classifiers of a Python package."""
    classes: Iterable[str] = told.get_all("Classifier") or [] if hasattr(told, "get_all") else []
    return next((one.split(" :: ")[-1] for one in classes if one.startswith("License :: ")), "")


def of_python(name: str, number: str, since: str) -> Part:
    """Return a Python package as it is installed here."""
    found = installed(name)
    told: Any = found.metadata if found else {}
    home = str(told.get("Home-page") or "")
    return Part(name, number, licence_of(told), f"pkg:pypi/{name}@{number}", since, home)


def needed(names: Iterable[str]) -> list[str]:
    """Return the Python packages of NAMES and what they need, in alphabetical order, as far as the lock has them."""
    locked, found, waiting = pinned(), set[str](), list(names)
    while waiting:
        name = waiting.pop().lower().replace("_", "-")
        if name in locked and name not in found:
            found.add(name)
            waiting += requirements_of(name)
    return sorted(found)


def requirements_of(name: str) -> Iterator[str]:
    """Yield what a Python package needs, its extras left out."""
    found = installed(name)
    for one in (found.requires if found else None) or []:
        match = NAME.match(one)
        if match and "extra ==" not in one:
            yield match[0]


def python_parts() -> list[Part]:
    """Return the Python packages that an installed wheel needs."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    names = [match[0] for one in project["dependencies"] if (match := NAME.match(one))]
    locked, since = pinned(), pinned_since()
    return [of_python(name, locked[name], since.get(name, "")) for name in needed(names)]


def parts_of(kind: str) -> list[Part]:
    """Return what the product KIND is made of besides Argus itself."""
    linked = [of_debian(name, licence) for name, licence in DEBIAN[kind]]
    return [*linked, *(python_parts() if kind == "wheel" else [])]


def bill(kind: str, parts: Sequence[Part], epoch: int) -> dict[str, Any]:
    """Return the bill of materials of the product KIND, as CycloneDX 1.5 has it; the same whenever it is made."""
    number = version()
    own = f"pkg:generic/{IN_ALL}-{kind}@{number}"
    told = {
        "metadata": {
            "timestamp": datetime.datetime.fromtimestamp(epoch, datetime.UTC).isoformat(),
            "component": {
                **{"type": "firmware" if kind == "image" else "application", "bom-ref": own},
                **{"name": f"{IN_ALL}-{kind}", "version": number},
                "licenses": [{"license": {"id": "MIT"}}],
            },
        },
        "components": [part.component() for part in parts],
        "dependencies": [{"ref": own, "dependsOn": [part.purl for part in parts]}],
    }
    serial = uuid.uuid5(uuid.NAMESPACE_URL, json.dumps(told, sort_keys=True))
    head = {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "serialNumber": f"urn:uuid:{serial}",
        "version": 1,
    }
    return head | told


def table(parts: Sequence[Part]) -> Iterator[str]:
    """Yield a line for each of PARTS: version, since when it has been that one, licence."""
    for part in parts:
        yield f"  {part.name:<26} {part.version or 'not here':<24} {part.since or '-':<11} {part.licence or '-'}"


def do_sbom(args: argparse.Namespace) -> int:
    """Write the bills of materials, and print what is in them."""
    DIST.mkdir(exist_ok=True)
    for kind in args.kind or KINDS:
        if kind not in KINDS:
            raise Stop(f"{kind}: there are {', '.join(KINDS)}", EXIT_USAGE)
        parts = parts_of(kind)
        path = DIST / f"{IN_ALL}-{kind}.cdx.json"
        path.write_text(json.dumps(bill(kind, parts, release_time()), indent=2) + "\n", encoding="utf-8")
        say(f"{shown(path)}: {len(parts)} parts")
        print("\n".join(table(parts)))
    return 0


# That it is made alike ------------------------------------------------------------------------------------


def sources() -> list[Path]:
    """Return what git knows of the tree, and what it does not ignore."""
    listed = output_of("git", "ls-files", "-z", "--cached", "--others", "--exclude-standard")
    if not listed:
        raise StageFailed("no history here: which files are sources git tells")
    return [Path(name) for name in listed.split("\0") if name and (ROOT / name).is_file()]


def copy_tree(into: Path, epoch: int) -> None:
    """Copy the sources INTO a folder; each says that it was written at EPOCH."""
    for path in sources():
        target = into / path
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / path, target)
        os.utime(target, (epoch, epoch))


def build_in(tree: Path, run: Run) -> dict[str, str]:
    """Build argusd, the image of a board and the packages in TREE, with no compiler cache; return each one's digest."""
    plain: list[str | Path] = ["env", "-C", tree, "CCACHE_DISABLE=1"]
    common = ("-DARGUS_TESTS=OFF", "-DCMAKE_C_COMPILER_LAUNCHER=")
    for preset, target in (("release", "argusd"), (BOARD, "argus_image")):
        run([*plain, "cmake", "--preset", preset, *common, "-DARGUS_BENCH=OFF"])
        run([*plain, "cmake", "--build", f"build/{preset}", "--target", target, "-j", str(CORES)])
    made = {
        **packages_in(tree, run),
        "argusd": tree / "build/release/argusd",
        "libargus.a": tree / "build/release/libargus.a",
        f"argus-{BOARD}.hex": tree / f"build/{BOARD}/argus-{BOARD}.hex",
        f"argus-{BOARD}.bin": tree / f"build/{BOARD}/argus-{BOARD}.bin",
        f"argus-{BOARD}.elf": tree / f"build/{BOARD}/argus-{BOARD}.elf",
    }
    return {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in made.items()}


def packages_in(tree: Path, run: Run) -> dict[str, Path]:
    """Build wheel and Debian packages in TREE with this tree's tools; nothing where Debian's are not here."""
    if shutil.which("dpkg-buildflags") is None:
        say("wheel and Debian packages are not built twice: dpkg-dev is not here")
        return {}
    (tree / VENV.name).symlink_to(VENV)
    plain = ("env", "-C", tree, "CCACHE_DISABLE=1", f"SOURCE_DATE_EPOCH={EPOCHS[0]}", "PYTHONPATH=tools:.")
    make = "from devtool import commands, packaging; commands.quietly('packages', packaging.make_all)"
    run([*plain, f"{VENV.name}/bin/python", "-c", make])
    return {path.name: path for path in sorted((tree / DIST.name).iterdir())}


def compare(first: Mapping[str, str], second: Mapping[str, str]) -> str:
    """Return what was built twice alike; a stage fails where something was not."""
    differ = [name for name in first if first[name] != second.get(name)]
    if differ:
        raise StageFailed(f"built twice, not the same: {', '.join(differ)}")
    return "the same twice: " + ", ".join(f"{name} {digest[:12]}" for name, digest in first.items())


def reproduce_stage(run: Run) -> str:
    """Build in two folders, of sources of two times, and compare."""
    with tempfile.TemporaryDirectory(prefix="argus-") as place:
        trees = [Path(place) / name for name in ("a", "somewhere/quite/else")]
        for tree, epoch in zip(trees, EPOCHS, strict=True):
            copy_tree(tree, epoch)  # both before either is built: nobody's edit comes in between
        digests = [build_in(tree, run) for tree in trees]
    return compare(*digests)


def do_reproduce(_args: argparse.Namespace) -> int:
    """Build twice and tell the digests."""
    ensure(["release", BOARD], ["dpkg-dev"])
    told = list[str]()
    quietly(
        "building argusd, the image and the packages in two folders",
        lambda run: told.append(reproduce_stage(run)),
    )
    say(told[0])
    return 0


def add_commands(add: Add) -> None:
    """Add the commands."""
    sbom = add(
        "sbom",
        do_sbom,
        "write what a product is made of, dist/argus-*.cdx.json (CycloneDX), and print versions, ages, licences",
        "sbom\nsbom image",
    )
    sbom.add_argument("kind", metavar="KIND", nargs="*", help=f"of {', '.join(KINDS)} (default: all)")
    add(
        "reproduce",
        do_reproduce,
        "build argusd, a board's image and the packages in two folders, of sources of two times, and compare",
        "reproduce",
    )
