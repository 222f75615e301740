# SPDX-License-Identifier: MIT
"""Rule: the site has every document, is searched, keeps nobody out (axe), fits a phone; a dead link fails its build."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from axe_core_python.selenium import Axe  # type: ignore[import-untyped]
from page_browser import ROOT, Browser, missing, wait_for

SITE = ROOT / "build/site"
PAGES = (
    "docs/index",
    "README",
    "DESIGN",
    "docs/python",
    "docs/events",
    "docs/api-python-live",
    "docs/argusd",
    "search",
)
VIEWS = [(width, height, dark) for width, height in ((1280, 860), (360, 740)) for dark in (False, True)]
DOCUMENTS = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")])
LISTS = ("CHANGELOG.md",)
"""Nothing but lines that are looked up: no picture tells what is in them."""


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    if missing():
        pytest.skip(f"not installed: {missing()}")
    made = Browser(tmp_path_factory.mktemp("profile"))
    yield made
    made.close()


def test_every_document_is_a_page() -> None:
    missing_pages = [
        path.name for path in DOCUMENTS if not (SITE / path.relative_to(ROOT).with_suffix(".html")).exists()
    ]
    assert missing_pages == []
    assert len(DOCUMENTS) > 30
    assert "docs/index.html" in (SITE / "index.html").read_text(encoding="utf-8")


def test_nothing_is_loaded_from_elsewhere() -> None:
    for page in SITE.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        assert re.findall(r"<(?:script|link)[^>]*(?:src|href)=\"https?://[^\"]*\"", text) == [], page


def test_the_references_name_what_is_public() -> None:
    for name in (
        "argus.live.connect",
        "argus.live.Robot.drive_to",
        "argus.log.diagnose",
        "argus.sil.Mission",
        "argus.ranges.Observer",
        "argus.protocol.Unframer",
    ):
        page = SITE / f"docs/api-python-{name.split('.')[1]}.html"
        assert f'id="{name}"' in page.read_text(encoding="utf-8")
    functions = (SITE / "docs/api-c.html").read_text(encoding="utf-8")
    header = (ROOT / "firmware/include/argus/argus.h").read_text(encoding="utf-8")
    named = re.findall(r"^[a-z][\w ]*[ *](argus_\w+)\(", header, re.MULTILINE)
    assert len(named) > 15
    assert [name for name in named if f"<h2>{name}<" not in functions] == []


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.stem)
def test_a_picture_stands_near_the_top(path: Path) -> None:
    text = re.sub(r"\[!\[.*?\]\(.*?\)\]\(.*?\)", "", path.read_text(encoding="utf-8"))  # badges are none
    before, found, after = text.partition("![")
    if path.name in LISTS:
        pytest.skip("a list")
    assert found, f"{path.name} has no picture"
    assert len(before.split()) <= 100
    words = after.partition("](")[0]
    assert len(words.split()) > 3, f"{path.name}: the picture has no words for those who do not see it"


def test_no_picture_is_left_to_the_forge() -> None:
    assert [path.name for path in DOCUMENTS if "```mermaid" in path.read_text(encoding="utf-8")] == []


def test_diagrams_are_those_of_their_table() -> None:
    done = subprocess.run(
        [sys.executable, "tools/gen_diagrams.py", "--check"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("[x](nowhere.md)", "nowhere.md"),
        ("[x](#no-such-heading)", "no-such-heading"),
        ("[x](other.md#none)", "none"),
        ("![x](img/none.png)", "none.png"),
    ],
)
def test_what_leads_nowhere_fails_the_build(line: str, problem: str, tmp_path: Path) -> None:
    (tmp_path / "docs/site").mkdir(parents=True)
    (tmp_path / "firmware/include/argus").mkdir(parents=True)
    shutil.copy(ROOT / "firmware/include/argus/argus.h", tmp_path / "firmware/include/argus")
    shutil.copy(ROOT / "docs/conf.py", tmp_path / "docs")
    (tmp_path / "docs/other.md").write_text("# Other\n", encoding="utf-8")
    (tmp_path / "docs/index.md").write_text(
        f"# Top\n\n```{{toctree}}\nother\n```\n\n{line}\n", encoding="utf-8"
    )
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-c", "docs", ".", "out"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert problem in done.stderr


@pytest.mark.parametrize(("width", "height", "dark"), VIEWS)
@pytest.mark.parametrize("page", PAGES)
def test_axe_finds_nothing(browser: Browser, page: str, width: int, height: int, dark: bool) -> None:
    browser.size(width, height)
    browser.dark(dark)
    browser.driver.get(f"file://{SITE}/{page}.html")
    assert browser.js("return document.documentElement.scrollWidth - innerWidth") <= 0
    found = Axe().run(browser.driver)
    told = [
        f"{rule['id']}: {rule['help']}: {node['target']} {node.get('failureSummary', '')}"
        for rule in found["violations"]
        for node in rule["nodes"][:3]
    ]
    assert told == []
    assert len(found["passes"]) > 10


@pytest.mark.parametrize(
    ("word", "page"), [("MOTORS_OFF", "events"), ("autonomic computing", "glossary"), ("drive_to", "python")]
)
def test_the_search_finds(browser: Browser, word: str, page: str) -> None:
    browser.driver.get(f"file://{SITE}/search.html?q={word}")
    script = "return [...document.querySelectorAll('#search-results li a')].map((a) => a.href)"
    # They come in one by one.
    wait_for(page, lambda: any(f"/docs/{page}.html" in link for link in browser.js(script)))


def test_the_example_of_a_data_frame() -> None:
    done = subprocess.run(
        [sys.executable, "examples/python/frame.py", "docs/samples/two-failing-sonars.rec.gz"],
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
        cwd=ROOT,
    )
    assert done.stdout.strip(), done.stderr
    assert done.stdout.strip() in (ROOT / "docs/python.md").read_text(encoding="utf-8")
