#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Error and cost of all methods under domes: python3 bench/domes.py PROGRAM [--size PIXELS] [--runs N] [--out FILE.json]

Compares the methods on scenes/skies/knot.json under each of its domes with the areas of `exact`: light samples by rays and by edges, suns of
a median cut by maps, the picture's own depths, and exact areas. Seconds are those of the shadow, wall time, the median of N runs: an idle
machine is needed. Without --out a table is printed; FILE.json is one of bench/results/. Uses Python's standard library alone."""

import argparse
import json
import os
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DOMES = ("around", "above", "evening")
COUNTED = ("raytrace", "edge-scatter", "view-sample", "depth-complexity")
SAMPLES = (64, 256, 1024, 4096)
MAPS = tuple(f"{method}:suns={suns}:size=256" for suns in (16, 64) for method in ("shadow-map", "pcss", "vssm"))
SCREEN = ("ssao", "hbao")
AREAS = "edge-scatter:rows=exact"


def rows_of(program, folder, dome, methods, samples, given):
    """Rows of methods that one run compares. ssao and hbao know no pictures of the sky."""
    out = Path(folder) / "compared"
    subprocess.run([program, "compare", ROOT / "scenes" / "skies" / "knot.json", "--light", dome, "--methods", ",".join(methods), "--reference", "exact",
                    "--size", f"{given.size}x{given.size}", "--runs", str(given.runs), "-o", out, "--quiet", *(["--light-samples", str(samples)] if samples else [])],
                   check=True, stdout=subprocess.DEVNULL)
    entries = json.loads((out / "metrics.json").read_text(encoding="utf-8"))["methods"]
    return [[dome, method, samples, entry["seconds"]["shadow"], entry["error"]["rmse"]] for method, entry in zip(methods, entries, strict=True)]


def measured(given):
    with tempfile.TemporaryDirectory() as folder:
        for dome in DOMES:
            yield from rows_of(given.program, folder, dome, (AREAS, *MAPS, *(SCREEN if dome != "evening" else ())), None, given)
            for samples in SAMPLES:
                yield from rows_of(given.program, folder, dome, COUNTED if samples <= 1024 else COUNTED[:1], samples, given)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--size", type=int, default=48)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    rows = []
    for row in measured(given):
        rows.append([*row[:3], float(f"{row[3]:.3g}"), float(f"{row[4]:.2g}")])
        print(*rows[-1], flush=True)
    if not given.out:
        return
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short=8", "HEAD"], check=True, capture_output=True, text=True).stdout.strip()
    model = next((line.partition(":")[2].strip() for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("model name")), "a processor")
    result = {"title": "domes: errors and seconds of all methods", "commit": commit, "machine": f"{model}, {os.cpu_count()} threads, load {os.getloadavg()[1]:.0f}",
              "command": f"bench/domes.py build/penumbra --size {given.size} --runs {given.runs}",
              "conditions": f"`scenes/skies/knot.json`, {given.size} × {given.size} pixels; seconds of the shadow, medians of {given.runs} runs; RMSE of V over judged pixels against `exact`.",
              "columns": ["dome", "method", "light samples", "seconds", "RMSE of V"], "formats": [None, None, None, ".3f", ".1e"]}
    fields = [f' "{key}": {json.dumps(value, ensure_ascii=False)}' for key, value in result.items()]
    listed = ",\n".join("  " + json.dumps(row) for row in rows)
    given.out.write_text("{\n" + ",\n".join(fields) + ',\n "rows": [\n' + listed + "\n ]\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
