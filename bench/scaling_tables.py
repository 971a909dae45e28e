# SPDX-License-Identifier: Apache-2.0
"""Tables of docs/scaling.md and docs/domes.md: processor seconds, memory and counters of whole runs of `penumbra
render`. Uses only Python's standard library."""

import json
import os
from pathlib import Path

from measured_tables import Table

ROOT = Path(__file__).resolve().parent.parent


def shipped(name):
    return json.loads((ROOT / "scenes" / f"{name}.json").read_text(encoding="utf-8"))


def terrain(cells):
    scene = shipped("terrain-1m")
    scene["meshes"][0]["shape"]["cells"] = list(cells)
    return scene


def run(bench, scene, size, *options):
    """Returns processor seconds, and the content of stats.json."""
    path, stats = bench.folder / "scaling.json", bench.folder / "stats.json"
    path.write_text(json.dumps(scene), encoding="utf-8")
    before = os.times()
    bench.program("render", path, "-o", bench.folder / "scaling.exr", "--size", size, "--stats", stats, *options)
    after = os.times()
    seconds = after.children_user + after.children_system - before.children_user - before.children_system
    return seconds, json.loads(stats.read_text(encoding="utf-8"))


SAMPLES = ("--method", "edge-scatter", "--light-samples", "256")


def memory_rows(bench):
    rows = []
    for cells in ((100, 50), (1000, 500), (3200, 1600)):
        triangles = 2 * cells[0] * cells[1]
        memory = run(bench, terrain(cells), "256x256", *SAMPLES)[1]["memory"]
        rows.append((triangles, *(memory[part] / triangles for part in ("scene", "sceneFloats", "method")), memory["peakResident"] / triangles))
    return rows


def dome_rows(bench):
    rows = []
    for name in ("bunny", "room"):
        scene = shipped(name) | {"lights": [{"name": "sky", "dome": {}, "radiance": [1, 1, 1]}]}
        seconds, stats = min((run(bench, scene, "512x512", "--method", "raytrace", "--light-samples", "256") for _ in range(3)), key=lambda one: one[0])
        counters = stats["counters"]
        rows.append((name, counters["rays"] + counters["commonPairs"] + counters["shortRays"], counters["commonPairs"], counters["rays"], seconds))
    return rows


TABLES = {
    "domes-rays": Table("rays to a dome that blocks of pixels make needless", "`scenes/NAME.json` under a dome of one radiance alone, 512 × 512 pixels, 256 directions by `raytrace`; processor "
                        "seconds of the whole process, the least of three runs.", ("scene", "pairs above the horizon", "decided for a block", "rays traced", "processor seconds"),
                        (None, None, None, None, ".2f"), dome_rows),
    "scaling-memory": Table("bytes of memory a triangle", "`scenes/terrain-1m.json` with other numbers of cells, 256 × 256 pixels, `edge-scatter`, 256 light samples; `memory` of `--stats` "
                            "over the number of triangles.", ("triangles", "`scene`", "`sceneFloats`", "`method`", "`peakResident`"), (None, ".0f", ".0f", ".0f", ".0f"), memory_rows),
}
