#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures which methods swim: the movement that changes of a method's error add to shadows, in three short animations
of shipped scenes. Writes results/swimming.json.

  bench/swimming.py [PROGRAM]

Then bench/tables.py writes the table of docs/swimming.md. In one animation the light moves, in one the camera, in one a
body. Flicker and pops are those of `penumbra compare --frames` against exact areas (docs/definitions.md): they do not
depend on machine and load. Uses only Python's standard library."""

import json
import os
import platform
import subprocess
import sys
import tempfile
from pathlib import Path

from animated_glb import add_motion

ROOT = Path(__file__).resolve().parent.parent
RESULT = ROOT / "bench" / "results" / "swimming.json"
FRAMES, SIZE, MAP = 5, "64x48", "256"
STEP = 0.03  # scene units a frame
SWIMS, QUIET, OFTEN = 1 / 64, 1 / 256, 0.01


FPS = 24
# Description, scene, moving node, and its movement per frame.
SEQUENCES = (("the light moves (`contact`)", "contact", "key", (STEP, 0, 0.6 * STEP)), ("the camera moves (`fusion`)", "fusion", "camera", (STEP, 0.3 * STEP, 0)),
             ("a body rises (`contact`)", "contact", "ball, touches in a point", (0.6 * STEP, STEP, 0.3 * STEP)))


def animated(program, scene, moves, by, path):
    """Writes the scene as a GLB in which one node moves at constant speed, from its original place at frame 0."""
    subprocess.run([program, "--quiet", "convert", ROOT / "scenes" / f"{scene}.json", "-o", path], check=True)
    add_motion(path, moves, [FPS * x for x in by], place_at=0)


def entries(program):
    """Returns the names of all methods, with the same size of all maps."""
    methods = json.loads(subprocess.run([program, "methods", "--json"], check=True, capture_output=True, text=True).stdout)
    methods = methods["methods"] if isinstance(methods, dict) else methods
    for method in methods:
        if method["family"] == "reference" or "rectangle" not in method["lights"]:  # the scenes' light
            continue
        has_maps = method["family"] == "image" and any(option["name"] == "size" for option in method["options"])
        yield method["name"], method["name"] + (f":size={MAP}" if has_maps else "")


def measured(program, scene, moves, by, methods, folder):
    """Returns flicker, and the fraction of steps that pop, for each method."""
    animated(program, scene, moves, by, folder / "scene.glb")
    subprocess.run([program, "compare", folder / "scene.glb", "--frames", f"1-{FRAMES}", "--fps", str(FPS), "-o", folder / "out", "--methods", ",".join(methods),
                    "--reference", "exact", "--size", SIZE, "--light-samples", "64", "--runs", "1", "--quiet"], check=True, stdout=subprocess.DEVNULL)
    found = json.loads((folder / "out" / "metrics.json").read_text(encoding="utf-8"))["methods"]
    return [(method["flicker"], method["pops"]["share"] if isinstance(method["pops"], dict) else method["pops"]) if method.get("flicker") is not None else (None, None)
            for method in found]


def verdict(values):
    flicker, pops = [f for f, _ in values if f is not None], [p for _, p in values if p is not None]
    if not flicker:
        return "not measured"
    words = "swims" if max(flicker) >= SWIMS else "quiet" if max(flicker) < QUIET else "a little"
    return words + (", pops" if max(pops) >= OFTEN else "")


def main():
    program = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build" / "penumbra")
    names, methods = zip(*entries(program))
    columns = []
    for title, scene, moves, by in SEQUENCES:
        print(title, flush=True)
        with tempfile.TemporaryDirectory() as folder:
            columns.append(measured(program, scene, moves, by, methods, Path(folder)))
    rows = []
    for name, *values in zip(names, *columns):
        cells = [cell if cell is None else float(f"{cell:.4g}") for flicker, pops in values for cell in (flicker, None if pops is None else 100 * pops)]
        rows.append([f"[{name}]({name}.md)", *cells, verdict(values)])
    rows.sort(key=lambda row: max((cell for cell in row[1:-1:2] if cell is not None), default=9))
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], check=True, capture_output=True, text=True).stdout.strip()
    model = next((line.partition(":")[2].strip() for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines() if line.startswith("model name")), platform.processor())
    data = {"title": "which methods swim: flicker and pops in three animations", "commit": commit, "machine": f"{model}, {os.cpu_count()} threads, load {os.getloadavg()[1]:.0f}",
            "command": "bench/swimming.py",
            "conditions": f"{FRAMES} frames of {SIZE.replace('x', ' × ')} pixels, 64 light samples in rows, maps of {MAP}², all else by default, against exact areas; the light, "
                          f"the camera or a ball moves by about {STEP} a frame. Flicker is the RMSE of ΔV − ΔV of the exact area; pops is the share of these steps that are off by "
                          "more than 0.05, in percent.",
            "columns": ["method", *(head for title, *_ in SEQUENCES for head in (f"{title}: flicker", "pops, %")), "verdict"],
            "formats": [None, *([".4f", ".1f"] * len(SEQUENCES)), None], "rows": None}
    lines = ",\n  ".join(json.dumps(row, ensure_ascii=False) for row in rows)
    fields = [f' "{key}": ' + (f"[\n  {lines}\n ]" if key == "rows" else json.dumps(value, ensure_ascii=False)) for key, value in data.items()]
    RESULT.write_text("{\n" + ",\n".join(fields) + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
