#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the picture of docs/report.md: report_pictures.py PROGRAM, with chromium installed (packages.txt)."""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/browser"))
from browser import Browser  # noqa: E402

METHODS = "edge-scatter,accumulate:size=256,pcss,soft-volume,wedge-ramp"


def main():
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.argv[1], "compare", str(ROOT / "scenes/fusion.json"), "-o", folder, "--size", "384x384",
                        "--methods", METHODS, "--runs", "1", "--quiet"], check=True, stdout=subprocess.DEVNULL)
        with Browser() as browser:
            browser.open((pathlib.Path(folder) / "report.html").as_uri() +
                         "#look?layer=error&view=all&a=3&limit=0.5&zoom=1.7&x=185&y=215&pixel=206,226", 1280, 760)
            browser.wait("document.getElementById('viewer').dataset.drawn && document.getElementById('viewer').dataset.read")
            browser.photograph(ROOT / "docs/images/report.png")


if __name__ == "__main__":
    main()
