# SPDX-License-Identifier: MIT
"""Rule: what cmake --install brings can be used from elsewhere, and uninstall takes all of it away."""

from __future__ import annotations

import fcntl
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples/embed"
FLEET = ROOT / "examples/fleet"
BUILD = ROOT / "build/release"
EXPECTED = {
    "include/argus/argus.h",
    "lib/libargus.a",
    "lib/libargus.so",
    "lib/cmake/argus/argusConfig.cmake",
    "lib/cmake/argus/argusConfigVersion.cmake",
    "lib/cmake/argus/argusTargets.cmake",
    "lib/pkgconfig/argus.pc",
    "lib/systemd/system/argusd.service",
    "bin/argusd",
    "share/argus/argus.dbc",
    "share/argus/argus.lua",
    "share/doc/argus/argusd.conf.example",
    "share/man/man1/argusd.1",
    "share/man/man1/argus-sim.1",
    "share/man/man1/argus-log.1",
    "share/man/man1/argusctl.1",
    "share/man/man1/argus-conformance.1",
    "share/man/man1/argus-monitor.1",
    "share/man/man1/argus-ros.1",
    "share/man/man1/argus-range-guard.1",
    "share/bash-completion/completions/argusd",
    "lib/udev/rules.d/60-argus.rules",
}


def run(*command: str | Path, **environment: str) -> str:
    env = {**os.environ, **environment}
    done = subprocess.run(
        [*map(str, command)], env=env, capture_output=True, text=True, check=False, timeout=300
    )
    assert done.returncode == 0, f"{command}:\n{done.stdout}{done.stderr}"
    return done.stdout


def install(folder: Path) -> str:
    """Install into a folder and return the list of files; the build folder keeps the list that it had."""
    assert (BUILD / "argusd").exists(), "build it: tools/dev build release"
    manifest = BUILD / "install_manifest.txt"
    with (BUILD / "install.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        before = manifest.read_text() if manifest.exists() else None
        run("cmake", "--install", BUILD, "--prefix", folder)
        text = manifest.read_text()
        if before is None:
            manifest.unlink()
        else:
            manifest.write_text(before)
    return text


@pytest.fixture(scope="module")
def prefix(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A prefix with everything installed."""
    folder = tmp_path_factory.mktemp("prefix")
    install(folder)
    return folder


def files(folder: Path) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if not path.is_dir()}


def test_everything_is_brought(prefix: Path) -> None:
    # Some distributions have their libraries in lib64 or lib/TRIPLET.
    brought = {re.sub(r"^lib(64)?(/[a-z0-9_]+-linux-gnu)?/", "lib/", name) for name in files(prefix)}
    assert brought >= EXPECTED
    unit = (prefix / "lib/systemd/system/argusd.service").read_text()
    program = re.search(r"^ExecStart=(\S+) ", unit, re.MULTILINE)
    assert program
    assert Path(program[1]) == prefix / "bin/argusd"
    assert "@" not in program[1]
    assert run(prefix / "bin/argusd", "--version").startswith("argusd ")


def test_the_shared_library_has_a_version(prefix: Path) -> None:
    library = next(prefix.rglob("libargus.so"))
    told = run("readelf", "-d", library)
    name = re.search(r"SONAME.*\[(libargus\.so\.\d+\.\d+)\]", told)
    assert name
    assert (library.parent / name[1]).resolve() == library.resolve()


def test_the_example_is_built_against_it_and_runs(prefix: Path, tmp_path: Path) -> None:
    # A copy: nothing of this tree is to be found by chance.
    source = shutil.copytree(EXAMPLE, tmp_path / "embed")
    run("cmake", "-S", source, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", tmp_path / "build")
    lines = run(tmp_path / "build/embed").splitlines()
    assert any("SESSION_OPEN" in line for line in lines)
    assert any(re.search(r"SONAR_SILENT +sonar  3 ", line) for line in lines)
    assert any("SESSION_CLOSED" in line for line in lines)
    assert re.fullmatch(r"\d+ SIPs from Robot; sonar 3 is (DISABLED|STALE)", lines[-1])


def test_a_fleet_is_built_against_it_and_no_manager_disturbs_another(prefix: Path, tmp_path: Path) -> None:
    source = shutil.copytree(FLEET, tmp_path / "fleet")
    run("cmake", "-S", source, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", tmp_path / "build")
    told = run(tmp_path / "build/fleet", "60", "60")
    assert told.endswith("6 of 6 dead sonars named, and 0 healthy ones\n"), told


@pytest.mark.parametrize("words", [("0",), ("x",), ("100001",), ("1", "0"), ("1", "2", "3")])
def test_a_fleet_refuses_what_it_cannot_be(words: tuple[str, ...]) -> None:
    done = subprocess.run([BUILD / "fleet", *words], capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 2
    assert done.stderr.startswith("usage: fleet [ROBOTS [SECONDS]]"), done.stderr


def test_pkg_config_and_the_shared_library(prefix: Path, tmp_path: Path) -> None:
    if not shutil.which("pkg-config"):
        pytest.skip("pkg-config is not installed")
    path = str(next(prefix.rglob("argus.pc")).parent)
    flags = run("pkg-config", "--cflags", "--libs", "argus", PKG_CONFIG_PATH=path).split()
    assert run("pkg-config", "--modversion", "argus", PKG_CONFIG_PATH=path).strip()
    sources = [EXAMPLE / "main.c", EXAMPLE / "robot.c"]
    run("cc", "-std=c11", "-o", tmp_path / "embed", *sources, *flags)
    folder = str(next(prefix.rglob("libargus.so")).parent)
    assert "SESSION_OPEN" in run(tmp_path / "embed", LD_LIBRARY_PATH=folder)


def test_the_header_is_cxx_too(prefix: Path, tmp_path: Path) -> None:
    if not shutil.which("c++"):
        pytest.skip("no C++ compiler is installed")
    source = tmp_path / "try.cpp"
    source.write_text(
        "#include <argus/argus.h>\nstatic argus_storage_t storage;\n"
        "int main() { argus_config_t c; argus_config_default(&c);"
        " return argus_invariants_broken(argus_init(&storage, &c, 0)); }\n"
    )
    library = next(prefix.rglob("libargus.a"))
    made = tmp_path / "try"
    run(
        "c++", "-Wall", "-Wextra", "-Wpedantic", "-Werror", f"-I{prefix}/include", source, library, "-o", made
    )
    run(made)


ENUMS = """#include <argus/argus.h>
#include <string.h>
static struct { argus_status_t status; unsigned char beyond[256]; } s;
static struct { argus_suspicions_t suspicions; unsigned char beyond[256]; } d;
static argus_storage_t storage;
int main(void) {
    argus_config_t config;
    memset(&s, 0x5A, sizeof s);
    memset(&d, 0x5A, sizeof d);
    argus_config_default(&config);
    const argus_config_report_t report = argus_config_check(&config);
    argus_t *const argus = argus_init(&storage, &config, 0);
    argus_status(argus, &s.status);
    argus_suspicions(argus, &d.suspicions);
    for (int i = 0; i < 256; i++) {
        if (s.beyond[i] != 0x5A || d.beyond[i] != 0x5A) { return 1; }
    }
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const int health = s.status.health[i]; // of a P3-DX, until another one answers
        if (i < 16 ? health != ARGUS_UNKNOWN && health != ARGUS_STALE : health != ARGUS_ABSENT) { return 2; }
    }
    return report.fault == ARGUS_CONFIG_OK && report.key == -1 && s.status.mode == ARGUS_MODE_OFFLINE ? 0 : 3;
}
"""
"""A program that looks behind what the library writes into its structs."""


def compile_enums(prefix: Path, made: Path, *flags: str) -> subprocess.CompletedProcess[str]:
    source = made.with_suffix(".c")
    source.write_text(ENUMS)
    library = next(prefix.rglob("libargus.a"))
    command = ["cc", "-std=c11", f"-I{prefix}/include", *flags, str(source), str(library), "-o", str(made)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("flags", [(), ("-fshort-enums",), ("-O2", "-fshort-enums"), ("-DARGUS_SONARS=32",)])
def test_a_program_with_other_options_of_its_compiler_is_not_overwritten(
    prefix: Path, tmp_path: Path, flags: tuple[str, ...]
) -> None:
    done = compile_enums(prefix, tmp_path / "enums", *flags)
    assert done.returncode == 0, done.stderr
    assert subprocess.run([tmp_path / "enums"], check=False).returncode == 0


@pytest.mark.parametrize("sonars", [8, 16, 24])
def test_a_program_with_another_number_of_sonars_does_not_link(
    prefix: Path, tmp_path: Path, sonars: int
) -> None:
    done = compile_enums(prefix, tmp_path / "enums", f"-DARGUS_SONARS={sonars}")
    assert done.returncode != 0
    assert f"argus_init_for_{sonars}_sonars" in done.stderr


def test_no_public_struct_has_an_enumeration_in_it(prefix: Path) -> None:
    # Its width is the compiler's choice (-fshort-enums, as on bare ARM), and so would be the struct's.
    text = re.sub(r"//[^\n]*", "", (prefix / "include/argus/argus.h").read_text())
    enums = set(re.findall(r"typedef enum \{[^{}]*\} (\w+);", text))
    structs = re.findall(r"typedef (?:struct|union) \{([^{}]*)\} \w+;", text)
    assert len(enums) >= 15
    assert len(structs) >= 10
    assert [body for body in structs if enums & set(re.findall(r"\w+", body))] == []


def test_uninstall_takes_all_of_it_away(tmp_path: Path) -> None:
    prefix, manifest = tmp_path / "prefix", tmp_path / "install_manifest.txt"
    manifest.write_text(install(prefix))
    (prefix / "share/argus/mine").write_text("not ours")
    command = ("cmake", f"-DMANIFEST={manifest}", "-P", str(ROOT / "cmake/Uninstall.cmake"))
    run(*command)
    assert files(prefix) == {"share/argus/mine"}
    assert not (prefix / "include/argus").exists()
    again = subprocess.run(command, capture_output=True, text=True, check=False)
    assert again.returncode != 0
    assert "nothing was installed" in again.stderr
    assert "uninstall" in run("cmake", "--build", BUILD, "--target", "help")
