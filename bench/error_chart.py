#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws error against time from the lines that penumbra-bench --json FILE --reference METHOD wrote: RMSE of V against the seconds of `shadow`, both on
logarithmic axes, with one panel per subject and one curve per contestant, through its numbers of light samples.

  bench/error_chart.py FILE.jsonl OUT.svg

All panels have the same axes. An error of 0 cannot be shown on such an axis: the chart states how many points are left out."""

import json
import sys
from math import ceil, floor, log10
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / "docs" / "figures"), str(ROOT / "docs" / "figures" / "papers")]

from chart import STYLES, Chart, mark  # noqa: E402
from drawing import Drawing  # noqa: E402

PANEL, PLOT, ACROSS = (420, 340), (340, 250), 3  # pixels of a panel and of the plot in it; panels side by side
LEFT, TOP, LEGEND = 62, 40, 18


def plain(text):
    """Returns a name as text for a Drawing, with `_` and `*` shown literally."""
    return text.replace("*", "∗").replace("_", "\\_")


def read_lines(path):
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines() if line.strip()]


def gathered(lines):
    """Returns {subject: {contestant: [(light samples, seconds, RMSE)]}}, the references, and the number of points left
    out."""
    panels, references, left_out = {}, [], 0
    for line in lines:
        error = line.get("errorToReference")
        if error is None:
            continue
        if error["reference"] not in references:
            references.append(error["reference"])
        curve = panels.setdefault(line["scene"], {}).setdefault(line["method"], [])
        if error["rmse"] > 0 and line["shadow"]["median"] > 0:
            curve.append((line["samples"], line["shadow"]["median"], error["rmse"]))
        else:
            left_out += 1
    return panels, references, left_out


def decades(values):
    low, high = floor(log10(min(values))), ceil(log10(max(values)))
    return [10.0 ** exponent for exponent in range(low, max(high, low + 1) + 1)]


def dash_of(i):
    return None if i < len(STYLES) else "5 3" if i < 2 * len(STYLES) else "2 2"


def chart(lines):
    panels, references, left_out = gathered(lines)
    points = [point for curves in panels.values() for curve in curves.values() for point in curve]
    if not points:
        sys.exit("error_chart.py: no line has an error above 0 against a reference; penumbra-bench --reference exact writes such lines")
    contestants = list(dict.fromkeys(name for curves in panels.values() for name in curves))
    columns = min(max(len(panels), 2), ACROSS)
    head = 56 + LEGEND * len(contestants)
    d = Drawing(columns * PANEL[0], head + -(-len(panels) // columns) * PANEL[1], "Error against time")
    d.text((LEFT, 24), plain(f"RMSE of V to {', '.join(references)}; numbers are light samples"), 14, bold=True)
    if left_out:
        d.text((LEFT, 42), f"{left_out} points without error are not shown", 12)
    for i, name in enumerate(contestants):
        colour, marker = STYLES[i % len(STYLES)]
        y = 62 + LEGEND * i
        d.line((LEFT, y), (LEFT + 28, y), colour, 2, dash_of(i))
        mark(d, (LEFT + 14, y), colour, marker)
        d.text((LEFT + 36, y + 4), plain(name), 12)
    xs, ys = decades([point[1] for point in points]), decades([point[2] for point in points])
    for k, (subject, curves) in enumerate(panels.items()):
        box = (k % columns * PANEL[0] + LEFT, head + k // columns * PANEL[1] + TOP, *PLOT)
        panel = Chart(d, box, (xs[0], xs[-1]), (ys[0], ys[-1]), plain(subject), "seconds", "RMSE of V", True, True, xs, ys)
        for name, curve in curves.items():
            i = contestants.index(name)
            panel.curve([point[1:] for point in sorted(curve)], i % len(STYLES), dash_of(i))
            if i == 0 or name == "plain-rays":  # the numbers of all curves would overlap
                for samples, seconds, rmse in curve:
                    panel.note(seconds, rmse, str(samples), offset=(5, -4))
    return d.finish()


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    Path(sys.argv[2]).write_text(chart(read_lines(Path(sys.argv[1]))), encoding="utf-8")


if __name__ == "__main__":
    main()
