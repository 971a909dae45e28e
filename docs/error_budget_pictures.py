#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the picture of docs/error-budget.md: error_budget_pictures.py PROGRAM, with chromium installed (packages.txt). bench/page_tables.py makes
the page's tables from the same runs."""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/browser"))
from browser import Browser  # noqa: E402

METHODS = "backproject:size=64,bitmask:size=64:occluder=patch,contour:size=64,pcss:size=64"


def main():
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.argv[1], "compare", str(ROOT / "scenes/fusion.json"), "-o", folder, "--size", "48x48", "--methods", METHODS, "--runs", "1", "--quiet",
                        "--error-budget", "--reference", "exact"], check=True, stdout=subprocess.DEVNULL)
        with Browser() as browser:
            browser.open((pathlib.Path(folder) / "report.html").as_uri() + "#error-budget", 1280, 900)
            browser.ask("document.getElementById('error-budget').scrollIntoView({behavior: 'instant'})")
            browser.photograph(ROOT / "docs/images/error-budget.png")


if __name__ == "__main__":
    main()
