#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes docs/gallery.md and its pictures: the small Blender scenes of tests/blender/scenes.py, rendered by the add-on and by
Cycles, and the ratio of the two pictures. Needs Blender, numpy, and a built program and add-on.

  docs/gallery.py [build]          some minutes"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "docs/figures"), str(ROOT / "blender")]
from penumbra import exr  # noqa: E402
from png import write_png  # noqa: E402

# Relative difference with full colour: blue where Penumbra is darker by this, red where it is brighter.
RANGE = 0.1


def channels(path):
    picture = exr.read(path.read_bytes())
    found = {name.split(".", 1)[1]: values for name, values in picture.channels.items() if "." in name}
    return numpy.stack([found[f"Combined.{letter}"] for letter in "RGB"], axis=-1).astype(float), found["Combined.A"]


def for_eyes(colors, alpha, exposure):
    linear = numpy.clip(colors * exposure, 0, 1)
    shown = numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return (shown * alpha[..., None] + (1 - alpha[..., None])) * 255


def of_ratio(ours, theirs, alpha):
    """Returns colours of the ratio: white where both pictures are the same, or show no surface."""
    a, b = ours.sum(axis=-1), theirs.sum(axis=-1)
    off = numpy.clip(numpy.where(b > 0, a / numpy.maximum(b, 1e-30) - 1, (a > 0) * 1.0) / RANGE, -1, 1) * alpha
    shown = numpy.ones((*a.shape, 3)) * 255
    shown[..., 0] -= 255 * numpy.maximum(-off, 0)
    shown[..., 1] -= 255 * numpy.abs(off)
    shown[..., 2] -= 255 * numpy.maximum(off, 0)
    return shown


def write_pictures(out, name):
    ours, alpha = channels(out / f"{name}.penumbra.exr")
    both = [channels(out / f"{name}.cycles{seed}.exr")[0] for seed in (1, 2)]
    theirs = (both[0] + both[1]) / 2
    exposure = 0.9 / numpy.percentile(ours[alpha > 0].max(axis=-1), 95)
    gap = numpy.full((ours.shape[0], 4, 3), 255.0)
    parts = [for_eyes(ours, alpha, exposure), gap, for_eyes(theirs, alpha, exposure), gap, of_ratio(ours, theirs, alpha)]
    rows = numpy.concatenate(parts, axis=1).round().astype(numpy.uint8)
    write_png(ROOT / f"docs/images/gallery/{name}.png", [row.tobytes() for row in rows])


def sentence(row):
    if row["region"] == "umbra":
        cycles = f" in Penumbra; in Cycles {row['cycles']:.0e} of the brightest pixel" if row["cycles"] > 0 else " in either picture"
        return f"umbra, {row['pixels']} pixels: no light{cycles}"
    return f"{row['region']}, {row['pixels']} pixels: {row['ratio']:.5f} ± {row['error']:.5f}"


def main():
    build = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build").resolve()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([ROOT / "tests/blender/run.sh", "cycles.py", build / "penumbra-blender.zip", build / "penumbra", f"{folder}/work"],
                       check=True, env={**os.environ, "SCALE": "2"})
        out = Path(folder) / "work/out"
        results = json.loads((out / "results.json").read_text())
        (ROOT / "docs/images/gallery").mkdir(exist_ok=True)
        text = (ROOT / "docs/gallery.md").read_text()
        text = text[:text.index("## ")] if "## " in text else text
        for name, rows in results.items():
            write_pictures(out, name)
            title = name.replace("_", " ")
            text += f"## {title[0].upper() + title[1:]}\n"
            text += f"![{title}: Penumbra, Cycles, and their ratio](images/gallery/{name}.png)\n\n"
            text += "".join(f"- {sentence(row)}\n" for row in rows) + "\n"
    (ROOT / "docs/gallery.md").write_text(text.rstrip("\n") + "\n")


if __name__ == "__main__":
    main()
