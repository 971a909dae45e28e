#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Error and cost under domes: python3 bench/domes.py PROGRAM [--size PIXELS] [--runs N] [--peer build/embree_dome] [--out FILE.json]

Compares methods on scenes/skies/knot.json under each of its domes with the areas of `exact`: light samples by rays and by edges, maps for the suns of
a median cut, methods in screen space, and exact areas. Seconds are those of the shadow, wall time, the median of N runs: an idle
machine is needed.

With --peer, compares exact areas, and 256 light samples by the default method, with a plain program on Embree, on three scenes under a uniform dome and
under a picture. Seconds are processor seconds of the shadow: for Penumbra, those of the whole process minus those of the same process with a single ray per view sample, the
median of N runs. Embree's seconds for an error are interpolated between measured numbers of rays, or extrapolated from the last two.

Without --out a table is printed; FILE.json is one of bench/results/. Uses only Python's standard library."""

import argparse
import json
import math
import os
import resource
import shutil
import statistics
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
    """Returns the rows of methods that are compared in one run. ssao and hbao do not support pictures of the sky."""
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


PEER_SAMPLES = (16, 64, 256, 1024, 4096)
PEER_SCENES = (("knot", "skies/knot.json", {"dome": {}}), ("knot", "skies/knot.json", {"dome": {"image": "evening.hdr"}}),
               ("bunny", "bunny.json", {"dome": {}}), ("room", "room.json", {"dome": {"image": "evening.hdr"}}))
ENOUGH = (1e-2, 1e-3, 1e-4)  # relative RMSE at which the peer is compared with exact areas, which have none


def processor_seconds(words):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def peer_seconds(rows, error):
    """Returns seconds and rays that the peer needs for an error, interpolated linearly between logarithms, and whether
    this is extrapolated."""
    pairs = list(zip(rows, rows[1:], strict=False))
    below = [pair for pair in pairs if pair[1]["relative"] <= error]
    first, second = below[0] if below else pairs[-1]
    part = math.log(error / first["relative"]) / math.log(second["relative"] / first["relative"])
    return [math.exp(math.log(first[key]) + part * math.log(second[key] / first[key])) for key in ("processor", "samples")], not below


def beside_peer(given):
    """Yields the rows of one scene after the other: Penumbra's, then the peer's."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        shutil.copy(ROOT / "scenes" / "skies" / "evening.hdr", folder)
        for name, path, light in PEER_SCENES:
            scene = json.loads((ROOT / "scenes" / path).read_text(encoding="utf-8"))
            sky = "picture" if "image" in light["dome"] else "one radiance"
            scene["lights"] = [{"name": "sky", "radiance": [1, 1, 1], **light}]
            (folder / "scene.json").write_text(json.dumps(scene), encoding="utf-8")
            render = [given.program, "render", folder / "scene.json", "--size", f"{given.size}x{given.size}", "--quiet", "-o"]
            kinds = (("truth.exr", []), ("sampled.exr", ["--light-samples", "256"]), ("one.exr", ["--method", "raytrace", "--light-samples", "1"]))
            times = [[processor_seconds([*render, folder / out, *more]) for out, more in kinds] for _ in range(given.runs)]
            ours = [statistics.median(run[kind] - run[2] for run in times) for kind in (0, 1)]
            words = [given.peer, folder / "scene.json", folder / "truth.exr", folder / "sampled.exr", *map(str, PEER_SAMPLES)]
            sampled, *peer = map(json.loads, subprocess.run(words, check=True, capture_output=True, text=True).stdout.splitlines())
            for what, seconds, error in (*(("exact", ours[0], enough) for enough in ENOUGH), ("256 directions", ours[1], sampled["relative"])):
                (needed, rays), beyond = peer_seconds(peer, error)
                yield [name, sky, what, error, seconds, round(rays), needed, needed / seconds, "beyond" if beyond else "measured"]
            for row in peer:
                yield [name, sky, f"Embree, packets of {row['packet']}" if row["packet"] > 1 else "Embree, single rays", row["relative"], None, row["samples"], row["processor"], None, "measured"]


def rounded(value):
    return float(f"{value:.3g}") if isinstance(value, float) else value


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--size", type=int, default=48)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--peer", type=Path)
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    rows = []
    for row in beside_peer(given) if given.peer else measured(given):
        rows.append([rounded(value) for value in row])
        print(*rows[-1], flush=True)
    if not given.out:
        return
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short=8", "HEAD"], check=True, capture_output=True, text=True).stdout.strip()
    model = next((line.partition(":")[2].strip() for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("model name")), "a processor")
    result = {"title": "domes: errors and seconds of all methods", "commit": commit, "machine": f"{model}, {os.cpu_count()} threads, load {os.getloadavg()[1]:.0f}",
              "command": f"bench/domes.py build/penumbra --size {given.size} --runs {given.runs}",
              "conditions": f"`scenes/skies/knot.json`, {given.size} × {given.size} pixels; seconds of the shadow, medians of {given.runs} runs; RMSE of V over judged pixels against `exact`.",
              "columns": ["dome", "method", "light samples", "seconds", "RMSE of V"], "formats": [None, None, None, ".3f", ".1e"]}
    if given.peer:
        result |= {"title": "domes: areas and 256 directions beside Embree", "command": result["command"] + " --peer build/embree_dome",
                   "conditions": f"{given.size} × {given.size} pixels; processor seconds of the shadow, ours medians of {given.runs} runs; RMSE of V over its mean, against exact areas, which have none: "
                                 "their rows say what Embree needs where that error is enough.",
                   "columns": ["scene", "dome", "what", "relative RMSE", "our seconds", "rays a view sample", "Embree's seconds", "ratio", "Embree's are"],
                   "formats": [None, None, None, ".1e", ".3f", None, ".3f", ".2f", None]}
    fields = [f' "{key}": {json.dumps(value, ensure_ascii=False)}' for key, value in result.items()]
    listed = ",\n".join("  " + json.dumps(row) for row in rows)
    given.out.write_text("{\n" + ",\n".join(fields) + ',\n "rows": [\n' + listed + "\n ]\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
