# SPDX-License-Identifier: MIT
"""The site of the documents: `tools/dev docs` makes build/site/index.html. A warning is an error."""

import re
import tomllib
from pathlib import Path
from typing import Any

from pygments.lexers.special import TextLexer
from sphinx.application import Sphinx

ROOT = Path(__file__).resolve().parent.parent
HEADER = (ROOT / "firmware/include/argus/argus.h").read_text(encoding="utf-8")
VERSION = re.search(r'#define ARGUS_VERSION "([^"]+)"', HEADER)
assert VERSION is not None
PROJECT = ROOT / "pyproject.toml"
URLS = (
    tomllib.loads(PROJECT.read_text(encoding="utf-8"))["project"].get("urls", {}) if PROJECT.exists() else {}
)

project = "Argus"
author = "Argus contributors"
project_copyright = "Argus contributors, MIT licence"
release = version = VERSION[1]
extensions = ["myst_parser", "sphinx.ext.autodoc"]
root_doc = "docs/index"
include_patterns = ["*.md", "docs/*.md", "docs/*.rst", "findings/README.md", "tests/hil/README.md"]
exclude_patterns = [
    ".*",
    "build",
    "dist",
    "cmake",
    "examples",
    "firmware",
    "hal",
    "hil_sim",
    "tools",
    "zephyr",
    "light",
]
suppress_warnings = ["autosectionlabel.*"]
myst_heading_anchors = 4
myst_links_external_new_tab = False
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_default_options = {"members": True, "undoc-members": False}
html_theme = "furo"
html_title = f"Argus {release}"
html_show_sphinx = False
html_copy_source = False
html_theme_options: dict[str, Any] = {"navigation_with_keys": True}
if "Homepage" in URLS:
    html_theme_options |= {
        "source_repository": URLS["Homepage"],
        "source_branch": "main",
        "source_directory": "",
    }
html_css_files = ["site.css"]
html_static_path = ["site"]
pygments_style = "a11y-high-contrast-light"
pygments_dark_style = "a11y-high-contrast-dark"
HOME = '<!doctype html><html lang="en"><title>Argus</title><meta http-equiv="refresh" content="0; url=docs/index.html">'
HOME += '<p><a href="docs/index.html">Argus: the documents</a></p></html>\n'


ACCESSIBLE = {
    'class="caption" role="heading">': 'class="caption" role="heading" aria-level="2">',
    '<aside class="sidebar-drawer">': '<aside class="sidebar-drawer" aria-label="All pages">',
    '<aside class="toc-drawer">': '<aside class="toc-drawer" aria-label="On this page">',
    '<aside class="toc-drawer no-toc">': '<aside class="toc-drawer no-toc" aria-label="On this page">',
    "<pre>": '<pre tabindex="0">',
    '<div id="search-results"></div>': '<h1>Search</h1>\n<div id="search-results"></div>',
    '<div class="table-wrapper': '<div tabindex="0" class="table-wrapper',
}
"""What the theme leaves out: levels of headings, names of landmarks, and that keys scroll what is wide."""


def finish(app: Sphinx, problem: Exception | None) -> None:
    """Mend the pages, and lead from the top folder to the first one."""
    if problem is not None:
        return
    for page in Path(app.outdir).rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        for found, better in ACCESSIBLE.items():
            text = text.replace(found, better)
        page.write_text(text, encoding="utf-8")
    (Path(app.outdir) / "index.html").write_text(HOME, encoding="utf-8")


def without_folders(app: Sphinx, page: str, source: list[str]) -> None:
    """Leave the words of a link to a folder: a forge shows it, a site has no page of it."""
    here = (Path(app.srcdir) / page).parent

    def plain(found: re.Match[str]) -> str:
        return found[1] if (here / found[2]).is_dir() else found[0]

    source[0] = re.sub(r"\[([^\]\n]+)\]\(([^)\s#:]+)\)", plain, source[0])


def setup(app: Sphinx) -> dict[str, Any]:
    """Add what the documents need: our own notations are text."""
    for notation in ("faults", "map"):
        app.add_lexer(notation, TextLexer)
    app.connect("source-read", without_folders)
    app.connect("build-finished", finish)
    return {"parallel_read_safe": True}
