#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes PNG pictures of methods' errors. The strips of README.md (geometry, image) show V of each method, and below it the error of V;
each strip is from one comparison, and they are written to docs/images/methods/. The error maps of the methods' pages (pages) show V, and
to the right of it the error of V at judged pixels, on a scene where the error is visible; they are written to docs/images/errors/. The
reference has exact areas. Needs only Python's standard library.

  docs/method_pictures.py [--program build/penumbra] [geometry] [image] [pages | PAGE…]          minutes each"""

import argparse
import json
import subprocess
import sys
import tempfile
from math import sqrt
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "docs" / "figures"))
sys.path.insert(0, str(ROOT / "docs" / "figures" / "papers"))

from compared import error_rows, visibility_rows  # noqa: E402
from experiment import TRUTH, Runner, measures  # noqa: E402
from png import write_png  # noqa: E402

SCENE = "scenes/fusion.json"
# For each strip: pixels per side; side of the square of pixels that are averaged into one; light samples; entries of `compare`.
STRIPS = {
    "geometry": (320, 2, 256, ["edge-scatter", "edge-scatter:rows=exact", "view-sample", "depth-complexity", "soft-volume",
                          "soft-volume-blend", "wedge-ramp", "hard-volume", "pcss", "accumulate", "shadow-map", "raytrace"]),
    "image": (128, 1, 64, ["pcf:size=256", "vssm:size=256", "convolution:size=256", "occlusion-textures:size=256", "soft-shadow-map:receiverSize=128",
                       "backproject:size=128", "backproject-peel:size=128", "bitmask:size=128", "contour:size=128:traversal=hierarchy",
                       "packet:size=128:sublights=2", "adaptive-light:size=128", "layered-attenuation:size=128", "deep-penumbra:size=128", "layer-rays:size=128",
                       "penumbra-map:size=256", "smoothies:size=256", "parker:size=256", "brabec-seidel:size=256", "kirsch-doellner:size=256", "arvo:size=256", "silhouette-map:size=256", "forward-map:size=256"]),
}
# Page: scene, light samples, one or two entries. The page `exact` is missing, since it describes the reference.
PAGES = {
    "edge-scatter": ("large-penumbra", 64, ["edge-scatter", TRUTH]),
    "view-sample": ("thin", 64, ["view-sample"]),
    "depth-complexity": ("large-penumbra", 16, ["depth-complexity", "depth-complexity:variant=forest"]),
    "view-sample-planar": ("thin", 256, ["view-sample-planar:lookup=nearest:map=32"]),
    "hierarchical-penumbra": ("contact", 64, ["hierarchical-penumbra"]),
    "alias-free": ("contact", 64, ["alias-free"]),
    "hard-volume": ("room", 64, ["hard-volume"]),
    "wedge-ramp": ("bunny", 64, ["wedge-ramp"]),
    "soft-volume": ("fusion", 64, ["soft-volume", "soft-volume:split=3"]),
    "plateaus": ("fusion", 64, ["plateaus"]),
    "hybrid-volume": ("thin", 64, ["hybrid-volume:size=256"]),
    "soft-volume-fusion": ("fusion", 64, ["soft-volume:fusion=max", "soft-volume:fusion=product", "soft-volume:fusion=average", "soft-volume:fusion=vote"]),
    "soft-volume-published": ("papers/centred", 64, ["soft-volume:as=published", "soft-volume", "soft-volume:fusion=vote"]),
    "soft-volume-blend": ("large-penumbra", 64, ["soft-volume-blend"]),
    "soft-irregular": ("fusion", 64, ["soft-irregular", "soft-irregular:umbra=layers"]),
    "raytrace": ("bunny", 64, ["raytrace"]),
    "shadow-map": ("contact", 64, ["shadow-map:size=256"]),
    "silhouette-map": ("contact", 64, ["silhouette-map:size=256"]),
    "forward-map": ("contact", 64, ["forward-map:size=256"]),
    "pcf": ("contact", 64, ["pcf:size=256"]),
    "pcss": ("papers/fusion-half", 64, ["pcss"]),
    "vssm": ("papers/two-sheets", 64, ["vssm", "vssm:moments=esm"]),
    "penumbra-map": ("papers/ball", 64, ["penumbra-map"]),
    "smoothies": ("papers/ball", 64, ["smoothies"]),
    "brabec-seidel": ("bunny", 64, ["brabec-seidel", "brabec-seidel:ids=off"]),
    "kirsch-doellner": ("papers/ball", 64, ["kirsch-doellner"]),
    "parker": ("papers/ball", 64, ["parker"]),
    "arvo": ("papers/ball", 64, ["arvo"]),
    "layer-rays": ("papers/gap-closed", 256, ["layer-rays:size=256:layers=1", "layer-rays:size=256:layers=2"]),
    "convolution": ("papers/tower", 64, ["convolution"]),
    "occlusion-textures": ("contact", 64, ["occlusion-textures:size=512"]),
    "ssao": ("skies/knot", 64, ["ssao"]),
    "hbao": ("skies/knot", 64, ["hbao"]),
    "accumulate": ("contact", 64, ["accumulate:size=128"]),
    "soft-shadow-map": ("papers/ball", 64, ["soft-shadow-map", "soft-shadow-map:passes=2"]),
    "backproject": ("papers/plate-over-plate", 64, ["backproject:size=128:fill=none", "backproject:size=128"]),
    "backproject-peel": ("papers/ball", 64, ["backproject-peel:size=128"]),
    "bitmask": ("papers/bars", 256, ["bitmask:size=256", "bitmask:size=256:occluder=patch"]),
    "contour": ("papers/gap-open", 64, ["contour:size=256"]),
    "contour-texture": ("textured-light", 64, ["contour:size=256", "packet:size=256:sublights=2"]),
    "packet": ("papers/ball", 64, ["packet:size=256", "packet:size=256:sublights=2"]),
    "adaptive-light": ("papers/ball", 64, ["adaptive-light:size=256"]),
    "layered-attenuation": ("contact", 36, ["layered-attenuation:size=128"]),
    "deep-penumbra": ("contact", 36, ["deep-penumbra:size=128", "deep-penumbra:size=128:bound=0.2"]),
}
LIGHTS = {"skies/knot": ["--light", "around"]}  # for scenes with several lights: selects the first
PAGE_SIZE, PAGE_LIMIT = 144, 0.5  # pixels per side; the error with the deepest colour
SIZES = {"papers/centred": 145}  # pixels per side for scenes that need a middle row and column
# Colours of compare/error_picture.cpp.
BACKGROUND = (96, 104, 116)
TOO_BRIGHT = ((255, 255, 255), (188, 218, 236), (90, 163, 206), (33, 102, 172), (5, 40, 90))
TOO_DARK = ((255, 255, 255), (253, 208, 180), (240, 130, 95), (190, 35, 45), (95, 0, 25))
LEFT, TOP, RIGHT, BOTTOM = 0.05, 0.125, 0.925, 0.90625  # the part of a strip's pictures that is shown


def part(rows, factor):
    """Returns the shown part. Each of its pixels is the mean of factor² pixels, of their displayed colours, not of light."""
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
        metrics = json.loads((out / "metrics.json").read_text(encoding="utf-8"))
        pictures = {name: (visibility_rows(out, name), error_rows(out, name)) for name in methods}
    images = ROOT / "docs" / "images" / "methods"
    images.mkdir(exist_ok=True)
    for name, result in zip(methods, metrics["methods"]):
        visibility, error = (part(rows, factor) for rows in pictures[name])
        gap = [b"\xff" * len(error[0])] * 4
        path = images / (file_name(name) + ".png")
        write_png(path, visibility + gap + error)
        e = result["error"]
        print(f"{name}: RMSE {e['rmse']:.4f}, largest {e['max']:.2f}, {path.stat().st_size} bytes")


def error_color(error):
    arm = TOO_BRIGHT if error > 0 else TOO_DARK
    depth = 4 * sqrt(min(1, abs(error) / PAGE_LIMIT))
    first = min(int(depth), 3)
    return tuple(round(a + (b - a) * (depth - first)) for a, b in zip(arm[first], arm[first + 1]))


def render_pages(program, pages):
    """Makes the pictures of pages. Pages with the same scene and light samples share a run."""
    runs = {}
    for page in pages:
        runs.setdefault(PAGES[page][:2], []).append(page)
    for (scene, samples), together in runs.items():
        entries = [entry for page in together for entry in PAGES[page][2]]
        found = Runner(program).compare(f"scenes/{scene}.json", entries, size=SIZES.get(scene, PAGE_SIZE), samples=samples, more=LIGHTS.get(scene, []))
        found[TRUTH] = found["truth"]
        for page in together:
            print(f"{page}: scenes/{scene}.json, {samples} light samples, {write_page(page, found)} bytes")
            for entry in PAGES[page][2]:
                error = measures(found, entry, ("rmse", "bias"))
                print(f"  {entry}: RMSE {error['rmse']:.4f}, mean error {error['bias']:+.4f}", flush=True)


def write_page(page, found):
    """Writes V of each entry, and to the right of it the error of V."""
    size = SIZES.get(PAGES[page][0], PAGE_SIZE)
    rows = [b""] * size
    for k, entry in enumerate(PAGES[page][2]):
        greys, errors = [], []
        for v, truth, a, judged in zip(found[entry]["V"], *(found[TRUTH][name] for name in ("V", "A", "judged"))):
            greys.append((round(255 * min(max(v, 0), 1)),) * 3 if a else BACKGROUND)
            errors.append(error_color(v - truth) if judged else BACKGROUND)
        for y in range(size):
            line = slice(y * size, (y + 1) * size)
            rows[y] += b"\xff" * (24 if k else 0) + b"".join(map(bytes, greys[line])) + b"\xff" * 12 + b"".join(map(bytes, errors[line]))
    path = ROOT / "docs" / "images" / "errors" / f"{page}.png"
    path.parent.mkdir(exist_ok=True)
    write_png(path, rows)
    return path.stat().st_size


def file_name(entry):
    """Returns the method's name, with those of its options that affect more than resolution and time."""
    parts = [text for text in entry.split(":") if not text.startswith(("size=", "receiverSize=", "traversal="))]
    return "-".join(parts).replace("=", "-")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", nargs="*", choices=[[], *STRIPS, "pages", *PAGES], metavar="WHAT")
    parser.add_argument("--program", type=Path, default=ROOT / "build" / "penumbra")
    args = parser.parse_args()
    wanted = args.what or [*STRIPS, "pages"]
    for what in STRIPS:
        if what in wanted:
            render(args.program.resolve(), *STRIPS[what])
    render_pages(args.program, [page for page in PAGES if page in wanted or "pages" in wanted])


main()
