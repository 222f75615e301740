# SPDX-License-Identifier: MIT
"""Rule: the page's connection has an age: one that carries nothing, or never opens, is left within 2 s, another tried;
its address is beside the page; times are by the server's clock."""

from __future__ import annotations

import json
import shutil
import subprocess
from importlib import resources
from pathlib import Path
from typing import Any

import pytest

PAGE = """
import { Link } from "./link.mjs";
const made = [], told = [];
const [mode, base] = process.argv.slice(2);
globalThis.location = { hash: "#" + "s".repeat(32), pathname: "/", host: new URL(base).host };
globalThis.document = { baseURI: base };
globalThis.history = { replaceState() {} };
const kept = new Map();
globalThis.sessionStorage = { setItem: (k, v) => kept.set(k, v), getItem: (k) => kept.get(k), removeItem() {} };
globalThis.WebSocket = class extends EventTarget {
  static OPEN = 1;
  readyState = 0;
  constructor(url) {
    super();
    made.push({ url: String(url), at: performance.now() });
    if (mode !== "never opens") setTimeout(() => { this.readyState = 1; this.dispatchEvent(new Event("open")); }, 10);
  }
  send(text) {
    const said = JSON.parse(text);
    if (mode === "answers" && said.do === "clock") this.say({ re: said.id, ok: true, unix: Date.now() / 1000 + 3600 });
  }
  say(message) {
    setTimeout(() => this.dispatchEvent(Object.assign(new Event("message"), { data: JSON.stringify(message) })), 5);
  }
  close() {} // as to a dead peer: no event comes for long
};
const link = new Link(() => {}, (why) => told.push({ why, at: performance.now() }), () => {});
link.open();
setTimeout(() => {
  console.log(JSON.stringify({ made, told, ahead: link.now() - Date.now() }));
  process.exit(0);
}, 3500);
"""


def ran(folder: Path, mode: str, base: str = "http://127.0.0.1:8642/") -> dict[str, Any]:
    node = shutil.which("node")
    if node is None:
        pytest.skip("no node here")
    source = resources.files("argus_tools.monitor") / "static/link.js"
    (folder / "link.mjs").write_text(source.read_text())
    (folder / "page.mjs").write_text(PAGE)
    done = subprocess.run(
        [node, folder / "page.mjs", mode, base], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    found: dict[str, Any] = json.loads(done.stdout)
    return found


@pytest.mark.parametrize("mode", ["opens and says nothing", "never opens"])
def test_a_connection_that_carries_nothing_is_left_and_opened_again(tmp_path: Path, mode: str) -> None:
    found = ran(tmp_path, mode)
    assert found["told"][0]["at"] - found["made"][0]["at"] < 2500  # 2 s are the rule; a busy host takes some
    assert len(found["made"]) >= 2


def test_one_that_answers_is_kept_and_its_clock_counts(tmp_path: Path) -> None:
    found = ran(tmp_path, "answers")
    assert len(found["made"]) == 1
    assert found["told"] == []
    assert found["ahead"] == pytest.approx(3_600_000, abs=200)


@pytest.mark.parametrize(
    ("base", "url"),
    [
        ("http://127.0.0.1:8642/", "ws://127.0.0.1:8642/live"),
        ("https://robot.example/", "wss://robot.example/live"),
        ("https://robot.example/argus/one/", "wss://robot.example/argus/one/live"),
        ("https://robot.example:8443/argus/#x", "wss://robot.example:8443/argus/live"),
    ],
)
def test_its_address_is_beside_the_page(tmp_path: Path, base: str, url: str) -> None:
    assert ran(tmp_path, "answers", base)["made"][0]["url"] == url
