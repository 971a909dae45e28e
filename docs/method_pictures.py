#!/usr/bin/env python3
"""The strips of methods in README.md: for each method V, and below it how far V is off, one PNG each in
docs/images/methods/. Runs one comparison a strip against exact areas and takes the pictures out of its report. Python's standard
library is all that it needs.

  docs/method_pictures.py [--program build/penumbra] [geometry] [image]          minutes: exact areas at every pixel"""

import argparse
import base64
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "docs" / "figures"))

from png import read_png, write_png  # noqa: E402

SCENE = "scenes/fusion.json"
# Pixels on a side; how many of them, squared, become one; light samples; what is rendered.
STRIPS = {
    "geometry": (320, 2, 256, ["edge-scatter", "edge-scatter:rows=exact", "view-sample", "depth-complexity", "soft-volume",
                          "soft-volume-blend", "wedge-ramp", "hard-volume", "pcss", "accumulate", "shadow-map", "raytrace"]),
    "image": (128, 1, 64, ["pcf:size=256", "vssm:size=256", "convolution:size=256", "occlusion-textures:size=256", "soft-shadow-map:receiverSize=128",
                       "backproject:size=128", "backproject-peel:size=128", "bitmask:size=128", "contour:size=128:traversal=hierarchy",
                       "packet:size=128:sublights=2", "adaptive-light:size=128", "layered-attenuation:size=128", "deep-penumbra:size=128"]),
}
LEFT, TOP, RIGHT, BOTTOM = 0.05, 0.125, 0.925, 0.90625  # the part of the picture in which something happens


def part(rows, factor):
    """The part, each pixel the mean of factor² (of what is shown, not of light)."""
    size, out = len(rows), []
    for y in range(round(TOP * size), round(BOTTOM * size), factor):
        line = bytearray()
        for x in range(round(LEFT * size), round(RIGHT * size), factor):
            for k in range(3):
                values = [rows[y + j][3 * (x + i) + k] for j in range(factor) for i in range(factor)]
                line.append((sum(values) + len(values) // 2) // len(values))
        out.append(bytes(line))
    return out


def render(program, size, factor, samples, methods):
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        subprocess.run([program, "-q", "compare", ROOT / SCENE, "-o", out, "--methods", ",".join(methods), "--reference",
                        "exact", "--runs", "1", "--light-samples", str(samples), "--size", f"{size}x{size}"], check=True, stdout=subprocess.DEVNULL)
        report = (out / "report.html").read_text(encoding="utf-8")
        metrics = json.loads((out / "metrics.json").read_text(encoding="utf-8"))
    pictures = {}
    for alt, data in re.findall(r'<img alt="([^"]*)"[^>]*src="data:image/png;base64,([^"]*)"', report):
        pictures[alt.partition(": ")[0]] = read_png(base64.b64decode(data))
    images = ROOT / "docs" / "images" / "methods"
    images.mkdir(exist_ok=True)
    for name, result in zip(methods, metrics["methods"]):
        error = part(pictures[f"Signed error of V by {name}"], factor)
        gap = [b"\xff" * len(error[0])] * 4
        path = images / (file_name(name) + ".png")
        write_png(path, part(pictures[f"V by {name}"], factor) + gap + error)
        e = result["error"]
        print(f"{name}: RMSE {e['rmse']:.4f}, largest {e['max']:.2f}, {path.stat().st_size} bytes")


def file_name(entry):
    """The method's name, with those of its options that change more than resolution and time."""
    parts = [text for text in entry.split(":") if not text.startswith(("size=", "receiverSize=", "traversal="))]
    return "-".join(parts).replace("=", "-")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("strips", nargs="*", choices=[[], *STRIPS], metavar="STRIP")
    parser.add_argument("--program", type=Path, default=ROOT / "build" / "penumbra")
    args = parser.parse_args()
    for strip in args.strips or STRIPS:
        render(args.program.resolve(), *STRIPS[strip])


main()
