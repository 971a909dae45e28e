#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the figures of docs/ into docs/images/. Each is computed here, from a few points and the formula that its page
explains. Also writes the papers' figures into papers/, from the measured numbers that are kept there. Needs only Python's
standard library.

  docs/figures/make.py            writes all of them
  docs/figures/make.py --check    exits 1 if a committed figure is not what this script draws, or if a page refers to a
                                  picture or a page that does not exist"""

import re
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parent / "papers"))

import disks  # noqa: E402
import family  # noqa: E402
import filters  # noqa: E402
import lists  # noqa: E402
import maps  # noqa: E402
import pairs  # noqa: E402
import papers  # noqa: E402
import ranking  # noqa: E402
import rooms  # noqa: E402
import scatter  # noqa: E402
import single_shadow  # noqa: E402
import texels  # noqa: E402
import volumes  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent.parent
IMAGES = ROOT / "docs" / "images"


def stale_figures(check):
    stale = []
    for module in (scatter, pairs, disks, volumes, maps, filters, single_shadow, texels, family, lists, rooms):
        for name, draw in module.FIGURES.items():
            path, text = IMAGES / f"{name}.svg", draw()
            if not check:
                path.write_text(text, encoding="utf-8")
            elif not path.is_file() or path.read_text(encoding="utf-8") != text:
                stale.append(f"{path.name}: not what docs/figures/make.py draws; run it")
    return stale + papers.stale(check) + ranking.stale(check)


def anchor_of(heading):
    """Makes an anchor as GitHub does: lower case, spaces to hyphens, punctuation left out."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def broken_links():
    broken = []
    pages = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *ROOT.glob("*/README.md"), *ROOT.glob("*/*/README.md")]
    for page in sorted(path for path in pages if "build" not in path.relative_to(ROOT).parts):
        for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
            name, _, anchor = target.partition("#")
            if "://" in target:
                continue
            path = page.parent / name if name else page
            if not path.exists():
                broken.append(f"{page.relative_to(ROOT)}: {target} is not there")
            elif anchor and path.suffix == ".md":
                headings = re.findall(r"^#+ (.*)$", path.read_text(encoding="utf-8"), re.MULTILINE)
                if anchor not in map(anchor_of, headings):
                    broken.append(f"{page.relative_to(ROOT)}: {target}: no such heading")
    return broken


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__)
    complaints = stale_figures(check) + (broken_links() if check else [])
    if complaints:
        sys.exit("\n".join(complaints))


main()
