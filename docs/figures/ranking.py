# SPDX-License-Identifier: Apache-2.0
"""Makes docs/ranking.md: every method on every scene under three sizes of its light, ranked, with the winner of each cell and the
reason. Only errors are ranked, not times, so that the load of the machine changes nothing.

  docs/figures/ranking.py measure [PROGRAM] [SCENE…]      measures the numbers missing in ranking.json (a minute per cell on two busy cores)

docs/figures/make.py writes the page from the kept numbers."""

import json
import re
import shutil
import subprocess
import sys
import tempfile
import time
from math import exp, log
from pathlib import Path
from statistics import median

ROOT = Path(__file__).resolve().parents[2]
KEPT, PAGE = Path(__file__).with_name("ranking.json"), ROOT / "docs" / "ranking.md"

SCENES = ["bunny", "contact", "fusion", "large-penumbra", "self-shadow", "thin", "parallel-square", "textured-light", "room", "broken"] + [
    f"papers/{name}" for name in ("ball", "bars", "fusion-half", "gap-open", "plate-over-plate", "slopes", "tower", "two-sheets")]
SIZES = [("small", 0.25), ("as shipped", 1.0), ("large", 2.0)]
PICTURE, TEXELS, SAMPLES = 72, 128, 64
# Variants that papers compare, in addition to each method with its default options.
VARIANTS = ["vssm:moments=lvsm", "vssm:moments=evsm", "vssm:moments=csm", "vssm:moments=esm", "backproject:layers=4", "bitmask:layers=4",
            "soft-volume:fusion=max", "soft-volume:fusion=product", "soft-volume:fusion=average", "soft-volume:fusion=vote"]
CLASSES = ["lit", "penumbra", "umbra", "cast", "self"]
NUMBERS = ["rmse", "bias", "over255", "banding", "flip", *CLASSES]


def scaled(light, factor):
    """Returns the light scaled about its middle."""
    light = json.loads(json.dumps(light))
    for shape in ("rectangle", "ellipse"):
        for side in ("halfU", "halfV"):
            if shape in light:
                light[shape][side] = [factor * x for x in light[shape][side]]
    for shape in ("disk", "sphere"):
        if shape in light:
            light[shape]["radius"] *= factor
    if "sun" in light:
        light["sun"]["angle"] *= factor
    return light


def short(number):
    return None if number is None else float(f"{number:.3g}")


def entries(program):
    """Returns all methods for planar lights except references, and the variants; maps have TEXELS per side."""
    table = json.loads(subprocess.run([program, "methods", "--json"], check=True, capture_output=True, text=True).stdout)
    table = table["methods"] if isinstance(table, dict) else table
    found = {}
    for method in table:
        if method["family"] == "reference" or "rectangle" not in method["lights"]:
            continue
        sized = any(option["name"] == "size" for option in method["options"])
        for entry in [method["name"], *(v for v in VARIANTS if v.split(":")[0] == method["name"])]:
            found[entry + (f":size={TEXELS}" if sized else "")] = method["family"]
    return found


def cell(program, folder, world, methods):
    """Returns {"pixels": {class: n}, "methods": {entry: numbers}}, without entries that do not support the light."""
    path, out = folder / "scene.json", folder / "out"
    path.write_text(json.dumps(world), encoding="utf-8")
    refused = {}
    while True:
        asked = [entry for entry in methods if entry not in refused]
        done = subprocess.run([program, "-q", "compare", path, "-o", out, "--methods", ",".join(asked), "--reference", "edge-scatter:rows=exact",
                               "--size", f"{PICTURE}x{PICTURE}", "--runs", "1", "--light-samples", str(SAMPLES), "--light", world["lights"][0]["name"]],
                              capture_output=True, text=True)
        if done.returncode == 0:
            break
        guilty = re.search(r"method ([\w-]+)", done.stderr)  # it cannot do this light
        if not guilty or not any(entry.split(":")[0] == guilty.group(1) for entry in asked):
            sys.exit(done.stderr)
        refused |= {entry: done.stderr for entry in asked if entry.split(":")[0] == guilty.group(1)}
    metrics = json.loads((out / "metrics.json").read_text(encoding="utf-8"))
    result = {"pixels": {}, "methods": {}}
    for one in metrics["methods"]:
        if one["failure"] is not None or one["error"] is None:
            continue
        result["pixels"] = {"judged": metrics["judgedPixels"], **{name: one["classes"][name]["pixels"] for name in CLASSES}}
        flip = one["eye"]["flip"]
        numbers = [one["error"]["rmse"], one["error"]["bias"], one["eye"]["over255"], one["eye"]["banding"], flip and flip["mean"],
                   *(one["classes"][name]["rmse"] for name in CLASSES)]
        result["methods"][one["entry"].replace(f":size={TEXELS}", "")] = [short(x) for x in numbers]
    return result


def measure(program, names):
    methods = entries(program)
    kept = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.is_file() else {"cells": {}}
    kept["families"] = {entry.replace(f":size={TEXELS}", ""): family for entry, family in methods.items()}
    kept["commit"] = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], check=True, capture_output=True,
                                    text=True).stdout.strip()
    for name in names or SCENES:  # what a cell has stays: delete its lines to measure them again
        world = json.loads((ROOT / "scenes" / f"{name}.json").read_text(encoding="utf-8"))
        for size, factor in SIZES:
            begin = time.monotonic()
            with tempfile.TemporaryDirectory() as folder:
                for picture in (ROOT / "scenes").glob("*.png"):
                    shutil.copy(picture, folder)
                lit = {**world, "lights": [scaled(world["lights"][0], factor)]}
                known = kept["cells"].setdefault(f"{name} {size}", {"pixels": {}, "methods": {}})
                missing = [entry for entry in methods if entry.replace(f":size={TEXELS}", "") not in known["methods"]]
                if missing:
                    found = cell(program, Path(folder), lit, missing)
                    known["pixels"] = found["pixels"] or known["pixels"]
                    known["methods"] |= found["methods"]
            print(name, size, f"{time.monotonic() - begin:.0f} s", flush=True)
        KEPT.write_text(written(kept), encoding="utf-8")


def written(kept):
    """Returns JSON with one line for each entry."""
    lines = []
    for name, found in kept["cells"].items():
        rows = ",\n".join(f"   {json.dumps(entry)}: {json.dumps(numbers)}" for entry, numbers in found["methods"].items())
        lines.append(f'  {json.dumps(name)}: {{"pixels": {json.dumps(found["pixels"])}, "methods": {{\n{rows}}}}}')
    head = json.dumps({"commit": kept["commit"], "families": kept["families"]}, indent=1).removesuffix("\n}")
    return head + ',\n "cells": {\n' + ",\n".join(lines) + "\n }\n}\n"


def rows_of(kept):
    """Returns {cell: {entry: {number: value}}}, without entries that have no numbers."""
    return {name: {entry: dict(zip(NUMBERS, numbers)) for entry, numbers in found["methods"].items() if numbers[0] is not None}
            for name, found in kept["cells"].items()}


def squares(numbers, pixels, name):
    return pixels[name] * (numbers[name] or 0.0) ** 2


def reason(cell, pixels, winner, rivals):
    """Returns where the winner is better than the next five: the class in which their mean squared error exceeds the winner's most,
    and this class's share of all such differences."""
    gains = {name: sum(squares(cell[r], pixels, name) for r in rivals) / len(rivals) - squares(cell[winner], pixels, name)
             for name in ("lit", "penumbra", "umbra")}
    whole = sum(max(gain, 0) for gain in gains.values())
    if whole == 0:
        return "a tie"
    name = max(gains, key=gains.get)
    sides = {side: sum(squares(cell[r], pixels, side) for r in rivals) / len(rivals) - squares(cell[winner], pixels, side)
             for side in ("cast", "self")}
    where = f"{name} {round(100 * max(gains[name], 0) / whole)} %"
    if name != "lit" and sides["self"] > 2 * max(sides["cast"], 0):
        where += ", on itself"
    elif name != "lit" and sides["cast"] > 2 * max(sides["self"], 0) and pixels["self"] > 0:
        where += ", cast on others"
    return where


def number(x):
    return "–" if x is None else f"{x:.4f}" if x < 0.9995 else f"{x:.2f}"


def best(cell, families, family, exact):
    """Returns the entries of a family, the least RMSE first, without those in `exact`."""
    return sorted((entry for entry in cell if families[entry] == family and entry not in exact), key=lambda e: (cell[e]["rmse"], e))


def ranked(cells, entries, key):
    """Returns {entry: mean rank over all cells}, each rank among the entries with a number there; equal numbers share their ranks."""
    places = {entry: [] for entry in entries}
    for cell in cells.values():
        found = sorted((cell[e][key], e) for e in entries if e in cell and cell[e][key] is not None)
        for value, entry in found:
            less = sum(other < value for other, _ in found)
            same = sum(other == value for other, _ in found)
            places[entry].append(less + (same + 1) / 2)
    return {entry: sum(p) / len(p) for entry, p in places.items() if p}


def agreement(a, b):
    """Returns Spearman's rank correlation of two {entry: number}."""
    names = sorted(set(a) & set(b))
    rank = lambda of: {n: i for i, n in enumerate(sorted(names, key=lambda n: (of[n], n)))}  # noqa: E731
    ra, rb = rank(a), rank(b)
    n = len(names)
    return 1 - 6 * sum((ra[x] - rb[x]) ** 2 for x in names) / (n * (n * n - 1))


def tied(cell, order):
    """Returns the first entry, and those whose RMSE is the same in the displayed digits."""
    same = [entry for entry in order if number(cell[entry]["rmse"]) == number(cell[order[0]]["rmse"])]
    return ", ".join(f"`{entry}`" for entry in same[:3]) + (f" and {len(same) - 3} more" if len(same) > 3 else "")


def linked(entry):
    return f"[`{entry}`]({entry.split(':')[0]}.md)"


def page(kept):
    families, cells = kept["families"], rows_of(kept)
    pixels = {name: found["pixels"] for name, found in kept["cells"].items()}
    # Methods that decide every pair, or compute the area, exactly: in every cell they have only the error of the light samples, or none.
    exact = {e for e in families if families[e] == "geometry" and
             all(e not in cell or cell[e]["rmse"] <= 1.1 * cell["edge-scatter"]["rmse"] + 1e-4 for cell in cells.values())}
    images = [e for e in families if families[e] == "image"]
    volumes = [e for e in families if families[e] == "geometry" and e not in exact]
    out = [f"""# Which method where: a ranking

This page says which method is nearest to the truth on which scene. `docs/figures/ranking.py` generates it from `docs/figures/ranking.json`; do not edit it.

It ranks {len(families)} entries in {len(cells)} cells: a cell is a scene of the table below (from `scenes/` and `scenes/papers/`) under its first light at a quarter of its size, as
shipped, or at twice its size. Pictures have {PICTURE} × {PICTURE} pixels, maps {TEXELS} texels a side, lights {SAMPLES} samples in rows; all other options have their defaults. Exact areas
judge (`edge-scatter:rows=exact`). **Errors alone are ranked**: the RMSE of V over judged pixels ([definitions](definitions.md)), the same bits on every run. Seconds depend on the machine,
and are on other pages ([bench](../bench/README.md), [figures](figures.md), [sweep](sweep.md)).

*Exact* methods have no place in the ranking: """ + ", ".join(linked(e) for e in sorted(exact)) + f""". They decide each pair of view sample and light
sample rightly, or so nearly that only the sampling error of their {SAMPLES} light samples remains: RMSE {number(min(c['edge-scatter']['rmse'] for c in cells.values()))} to {number(max(c['edge-scatter']['rmse'] for c in cells.values()))},
{number(median(c['edge-scatter']['rmse'] for c in cells.values()))} in the median.
"""]
    out.append("## Who wins each cell, and why\n\nThe image-based method with the least error, and the geometry-based method with the least error that is not exact. *Why*: the "
               "pixels in which the next five of the family lose most against the winner (lit, penumbra or umbra; and whether the shadow "
               "lies on another object or on the caster itself, where one of these is more than twice the other).\n")
    out.append("| scene | light | image | RMSE | next | why | geometry, not exact | RMSE | why |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    wins = {}
    for name, cell in cells.items():
        scene, _, size = name.partition(" ")
        columns = [f"`{scene}`", size]
        for family, with_next in (("image", True), ("geometry", False)):
            order = best(cell, families, family, exact)
            if not order:  # no method of the family can do the light
                columns += ["–"] * (4 if with_next else 3)
                continue
            winner = order[0]
            for entry in order:
                if number(cell[entry]["rmse"]) == number(cell[winner]["rmse"]):
                    wins[entry] = wins.get(entry, 0) + 1
            columns += [tied(cell, order), number(cell[winner]["rmse"])]
            behind = [entry for entry in order if number(cell[entry]["rmse"]) != number(cell[winner]["rmse"])][:5]
            if with_next:
                columns.append(f"`{behind[0]}` {number(cell[behind[0]]['rmse'])}" if behind else "–")
            columns.append(reason(cell, pixels[name], winner, behind) if behind else "a tie" if len(order) > 1 else "alone")
        out.append("| " + " | ".join(columns) + " |")
    for title, entries in (("Image-based methods", images), ("Geometry-based methods that are not exact", volumes)):
        by_rmse, by_flip = ranked(cells, entries, "rmse"), ranked(cells, entries, "flip")
        out.append(f"\n## {title}\n\nSorted by the mean place over all cells. *Cells*: the number of cells that the method could do. *Factor*: the geometric mean of its RMSE over that of the best method of "
                   "the family in the same cell, both at least 0.001. *Wins*: ties count for all. *Eye*: the mean share of pixels off by more than 1/255; *banding*: "
                   "steps between neighbours that the truth does not have; *FLIP*: the mean place by FLIP. Least and worst: the RMSE and its cell.\n")
        out.append("| method | place | wins | cells | median RMSE | factor | eye | banding | FLIP | least | worst |\n"
                   "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")
        least = {name: min(cell[e]["rmse"] for e in entries if e in cell) for name, cell in cells.items()}
        for entry in sorted(by_rmse, key=lambda e: (by_rmse[e], e)):
            done = {name: cell[entry] for name, cell in cells.items() if entry in cell}
            factors = [log(max(n["rmse"], 1e-3) / max(least[name], 1e-3)) for name, n in done.items()]
            mean = lambda key: sum(n[key] or 0 for n in done.values()) / len(done)  # noqa: E731
            low, high = (f(done, key=lambda name: done[name]["rmse"]) for f in (min, max))
            out.append(f"| {linked(entry)} | {by_rmse[entry]:.1f} | {wins.get(entry, 0)} | {len(done)} | {number(median(n['rmse'] for n in done.values()))} | "
                       f"{exp(sum(factors) / len(factors)):.2f} | {100 * mean('over255'):.0f} % | {number(mean('banding'))} | {by_flip[entry]:.1f} | "
                       f"{number(done[low]['rmse'])} {low} | {number(done[high]['rmse'])} {high} |")
        out.append(f"\nPlaces by FLIP and by RMSE agree by {agreement(by_rmse, by_flip):.2f} (Spearman's rank correlation).")
    out.append("\n## By class of pixel\n\nThe three least mean RMSE over all cells where there are such pixels, among methods that did all cells of their family.\n")
    out.append("| pixels | image | geometry, not exact |\n| --- | --- | --- |")
    for name in CLASSES:
        columns = []
        for entries in (images, volumes):
            means = {}
            for entry in entries:
                values = [cell[entry][name] for cell in cells.values() if entry in cell and cell[entry][name] is not None]
                most = max(sum(e in cell for cell in cells.values()) for e in entries)
                if values and sum(entry in cell for cell in cells.values()) == most:
                    means[entry] = sum(values) / len(values)
            columns.append(", ".join(f"`{e}` {number(means[e])}" for e in sorted(means, key=lambda e: (means[e], e))[:3]))
        out.append(f"| {name} | {columns[0]} | {columns[1]} |")
    out.append("\n## By the light's size\n\nMean RMSE of the best three image-based methods at each size, over all scenes.\n\n| light | image |\n| --- | --- |")
    for size, _ in SIZES:
        of_size = {name: cell for name, cell in cells.items() if name.partition(" ")[2] == size}
        full = [e for e in images if all(e in cell for cell in of_size.values())]
        means = {e: sum(cell[e]["rmse"] for cell in of_size.values()) / len(of_size) for e in full}
        out.append(f"| {size} | " + ", ".join(f"`{e}` {number(means[e])}" for e in sorted(means, key=lambda e: (means[e], e))[:3]) + " |")
    return "\n".join(out) + "\n"


def stale(check):
    """Writes the page; with `check`, returns a complaint if the committed page differs."""
    text = page(json.loads(KEPT.read_text(encoding="utf-8")))
    if not check:
        PAGE.write_text(text, encoding="utf-8")
    elif not PAGE.is_file() or PAGE.read_text(encoding="utf-8") != text:
        return ["ranking.md: not what docs/figures/ranking.py makes of ranking.json; run docs/figures/make.py"]
    return []


if __name__ == "__main__":
    if sys.argv[1:2] != ["measure"]:
        sys.exit(__doc__)
    measure(Path(sys.argv[2] if len(sys.argv) > 2 else ROOT / "build/penumbra").resolve(), sys.argv[3:])
