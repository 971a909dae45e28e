#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the picture of docs/map-fits.md: map_fits_pictures.py PROGRAM. The scene is a long floor with plates above it, a camera near the floor's end,
and a light so small that its shadows are hard. For each fit the picture shows V's error, and 1/m, the inverse of the aliasing error.
bench/page_tables.py makes the table from the same scene. Needs only Python's standard library."""
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "docs/figures"))
from compared import error_rows, visibility_rows  # noqa: E402
from png import write_png  # noqa: E402

# Fits, each with its texels per side, chosen so that all have about the same total number of texels.
ROWS = [("receivers", 256), ("view", 256), ("cascades", 128), ("lispsm", 256), ("tsm", 256), ("psm", 256), ("logpsm", 256),
        ("tiles", 64), ("faces", 114)]
COLUMNS = 3


def scene():
    meshes = [{"name": "floor", "color": [0.7, 0.7, 0.7],
               "quad": {"center": [0, 0, -20], "halfU": [12, 0, 0], "halfV": [0, 0, -24]}}]
    for z in (2, -1, -4, -8, -14, -22, -34):
        for x in (-3, 0.3, 3.1):
            k = len(meshes)
            meshes.append({"name": f"plate {k}", "color": [0.7, 0.6, 0.4],
                           "quad": {"center": [x + 0.05 * k, 0.8, z], "halfU": [0.4, 0, 0.1], "halfV": [0.05, 0, -0.4]}})
    return {"format": "penumbra-scene/1", "size": [192, 144], "meshes": meshes,
            "camera": {"eye": [0, 1.6, 6], "target": [0, 0.2, 0], "verticalFov": 45},
            "lights": [{"name": "lamp", "radiance": [1e8, 1e8, 1e8],
                        "rectangle": {"center": [0, 30, -10], "halfU": [0.001, 0, 0], "halfV": [0, 0, 0.001]}}]}


def run(program, folder, aliasing):
    """Returns a picture of each fit: V's error, or V."""
    entries = [f"shadow-map:size={size}:fit={fit}:aliasing={aliasing}" for fit, size in ROWS]
    (folder / "scene.json").write_text(json.dumps(scene()))
    out = folder / aliasing
    subprocess.run([program, "-q", "compare", folder / "scene.json", "-o", out, "--methods", ",".join(entries), "--runs", "1",
                    "--light-samples", "16"], check=True, stdout=subprocess.DEVNULL)
    rows_of = error_rows if aliasing == "count" else visibility_rows
    return {entry: rows_of(out, entry) for entry in entries}


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        errors, shown = run(sys.argv[1], folder, "count"), run(sys.argv[1], folder, "show")
        pictures = []
        for (fit, size) in ROWS:
            entry = f"shadow-map:size={size}:fit={fit}:aliasing="
            error, inverse = errors[f"{entry}count"], shown[f"{entry}show"]
            pictures.append(error + [b"\xff" * len(error[0])] * 3 + inverse)
        rows = []
        for first in range(0, len(pictures), COLUMNS):
            for lines in zip(*pictures[first:first + COLUMNS]):
                rows.append((b"\xff" * 12).join(lines))
            rows += [b"\xff" * len(rows[0])] * 8
        write_png(ROOT / "docs/images/map-fits.png", rows)


if __name__ == "__main__":
    main()
