# SPDX-License-Identifier: MIT
"""Rule: a command that is advised can be typed here: sudo stands in it only where there is one and it is needed."""

from __future__ import annotations

import errno
import os
import shutil

import pytest

from hil_sim.links.can_spec import CanSpec, parse_spec
from hil_sim.links.root import as_root

ROOT, USER = 0, 1000


@pytest.mark.parametrize(
    ("uid", "sudo", "typed"),
    [
        (ROOT, None, "modprobe x"),
        (ROOT, "/usr/bin/sudo", "modprobe x"),
        (USER, "/usr/bin/sudo", "sudo modprobe x"),
        (USER, None, "su -c 'modprobe x'"),
    ],
)
def test_sudo_stands_where_it_helps(
    uid: int, sudo: str | None, typed: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: uid)
    monkeypatch.setattr(shutil, "which", lambda name: sudo)
    assert as_root("modprobe x") == typed


def test_each_command_of_a_chain_has_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: USER)
    monkeypatch.setattr(shutil, "which", lambda name: "/usr/bin/sudo")
    assert as_root("a && b") == "sudo a && sudo b"


@pytest.mark.parametrize("number", [errno.EAFNOSUPPORT, errno.EPROTONOSUPPORT, errno.ENODEV])
@pytest.mark.parametrize("interface", ["vcan9", "can9"])
def test_no_reason_of_a_can_link_has_a_sudo_that_is_not_there(
    number: int, interface: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    can = pytest.importorskip("hil_sim.links.can")
    monkeypatch.setattr(os, "geteuid", lambda: USER)
    monkeypatch.setattr(shutil, "which", lambda name: None)
    spec: CanSpec = parse_spec(interface)
    assert "sudo" not in can.explain(spec, can.Fault(number, "x"))
