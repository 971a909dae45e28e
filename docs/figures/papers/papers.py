# SPDX-License-Identifier: Apache-2.0
"""The papers' figures, and other figures of measured numbers. For each, a module has a function that measures it and one that draws it. NAME.json in this
folder has the measured numbers, NAME.svg the figure drawn from them; docs/figures/make.py draws, docs/figures/papers/measure.py measures."""

import json
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import atty  # noqa: E402
import bavoil  # noqa: E402
import course  # noqa: E402
import scaling  # noqa: E402
import schwaerzler  # noqa: E402
import times  # noqa: E402
import yang  # noqa: E402

FIGURES = {}
for module in (atty, schwaerzler, bavoil, yang, course, times, scaling):
    FIGURES |= module.FIGURES


def drawn(name):
    """Returns the figure as SVG, drawn from the kept numbers."""
    kept = json.loads((HERE / f"{name}.json").read_text(encoding="utf-8"))
    return FIGURES[name][1](kept["data"])


def stale(check):
    """Draws all figures. Returns complaints: missing numbers, files that belong to no figure and, with `check`, committed figures that differ."""
    complaints = []
    for name in FIGURES:
        path, numbers = HERE / f"{name}.svg", HERE / f"{name}.json"
        if not numbers.is_file():
            complaints.append(f"{numbers.name}: not there; docs/figures/papers/measure.py {name} measures it")
            continue
        text = drawn(name)
        if not check:
            path.write_text(text, encoding="utf-8")
        elif not path.is_file() or path.read_text(encoding="utf-8") != text:
            complaints.append(f"{path.name}: not what docs/figures/make.py draws of {numbers.name}; run it")
    known = {f"{name}{suffix}" for name in FIGURES for suffix in (".json", ".svg")}
    complaints += [f"{path.name}: belongs to no figure" for path in sorted(HERE.iterdir())
                   if path.suffix in (".json", ".svg") and path.name not in known]
    return complaints
