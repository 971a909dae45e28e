#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The picture and the tables of docs/error-budget.md: error_budget_pictures.py PROGRAM, with chromium installed
(packages.txt); with --tables the tables alone."""
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/browser"))
from browser import Browser  # noqa: E402

METHODS = "backproject:size=64,bitmask:size=64:occluder=patch,contour:size=64,pcss:size=64"
CAUSES = ["resolution", "view", "layers", "fusion", "gaps", "bias"]
GEOMETRY = ("soft-volume,soft-volume:split=2,soft-volume-blend,soft-irregular,wedge-ramp,plateaus,hard-volume,depth-complexity:variant=forest,"
            "view-sample-planar:lookup=nearest:map=16,edge-scatter")
OF_GEOMETRY = ["resolution", "view", "layers", "fusion", "samples", "falloff"]


def change_text(change):
    if change is None:
        return "–"
    return f"{change:+.4f}".replace("-", "−") if abs(change) >= 5e-5 else "0"


def measure(folder, methods, causes, *more):
    """Prints a row for each method."""
    subprocess.run([sys.argv[1], "compare", str(ROOT / "scenes/fusion.json"), "-o", folder, "--size", "48x48",
                    "--methods", methods, "--runs", "1", "--quiet", "--error-budget", "--reference", "exact", *more],
                   check=True, stdout=subprocess.DEVNULL)
    for method in json.loads((pathlib.Path(folder) / "metrics.json").read_text())["methods"]:
        budget, runs = method["errorBudget"], method["errorBudgetRuns"]
        cells = [change_text(budget[cause]) for cause in causes]
        one_view = f"{runs['allButView']['rmse']:.4f}" if runs["allButView"] else "–"
        print(f"| `{method['entry']}` | {runs['rmse']:.4f} | {' | '.join(cells)} | {one_view} | {budget['remainder']:.4f} |", flush=True)


def main():
    with tempfile.TemporaryDirectory() as folder:
        measure(folder, GEOMETRY, OF_GEOMETRY, "--light-samples", "16")
        measure(folder, METHODS, CAUSES)
        if "--tables" in sys.argv:
            return
        with Browser() as browser:
            browser.open((pathlib.Path(folder) / "report.html").as_uri() + "#error-budget", 1280, 900)
            browser.ask("document.getElementById('error-budget').scrollIntoView({behavior: 'instant'})")
            browser.photograph(ROOT / "docs/images/error-budget.png")


if __name__ == "__main__":
    main()
