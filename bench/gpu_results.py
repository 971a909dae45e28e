#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes bench/results/gpu-exact.json and gpu-methods.json from what gpu.sh measured on a machine with a GPU; bench/tables.py writes the
tables of docs/devices.md from these.

  bench/gpu_results.py GPU.json"""

import json
import sys
from pathlib import Path

RESULTS = Path(__file__).resolve().parent / "results"


def milliseconds_of_passes(run):
    return sum(one["milliseconds"] for one in run["passes"])


def entry_of(run):
    return ":".join([run["method"], *(f"{key}={value}" for key, value in run["options"].items())])


def exact_rows(gpu):
    """Yields rows of pictures by exact methods on the GPU, one process each."""
    for run in gpu["speed"]:
        if run["options"].get("engine") == "vulkan":
            width, height = run["size"]
            yield [run["method"], f"{width} × {height}", run["lightSamples"], 1000 * run["seconds"]["evaluate"], milliseconds_of_passes(run)]


def method_rows(gpu):
    """Yields rows of methods of `compare`, with columns for each size."""
    sizes = gpu["methods"]
    for runs in zip(*(one["methods"] for one in sizes)):
        row = [f"`{entry_of(runs[0])}`", runs[-1]["lights"][0]["error"]["rmse"]]
        for run in runs:
            row += [1000 * run["seconds"]["light"], 1000 * run["seconds"]["evaluate"], milliseconds_of_passes(run)]
        yield row


def write(name, fields, rows):
    text = json.dumps(fields, ensure_ascii=False, indent=1).removesuffix("\n}")
    lines = ",\n".join("  " + json.dumps([round(cell, 5) if isinstance(cell, float) else cell for cell in row], ensure_ascii=False) for row in rows)
    (RESULTS / name).write_text(text + ',\n "rows": [\n' + lines + "\n ]\n}\n", encoding="utf-8")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    gpu = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    device = gpu["devices"]["devices"][0]
    of = {"commit": gpu["commit"], "machine": f"{device['name']} ({device['driver']}), {gpu['processors']} processor threads"}
    exact, methods = list(exact_rows(gpu)), list(method_rows(gpu))
    scene = gpu["speed"][0]["scene"].partition(".")[0]
    if not gpu["methods"]:
        sys.exit(f"{sys.argv[1]}: no methods were compared, for want of time")
    write("gpu-exact.json", {"title": "exact methods on a GPU", **of,
                             "command": f"penumbra render scenes/{scene}.json --method METHOD:engine=vulkan --light-samples N --size WxH --stats FILE",
                             "conditions": f"Scene `{scene}`, engine=vulkan, one run of each in a process of its own.",
                             "columns": ["method", "size", "light samples", "evaluate, ms", "of it passes on the GPU, ms"], "formats": [None, None, None, ".0f", ".1f"]}, exact)
    compared = gpu["methods"][0]["methods"][0]
    columns = [f"{what}, ms, {one['methods'][0]['size'][0]} × {one['methods'][0]['size'][1]}" for one in gpu["methods"] for what in ("light", "evaluate", "passes")]
    write("gpu-methods.json", {"title": "methods of compare on a GPU", **of,
                               "command": "penumbra compare scenes/self-shadow.json --size WxH --reference edge-scatter:rows=exact --runs 3",
                               "conditions": f"Scene `{compared['scene'].partition('.')[0]}`, {compared['triangles']:,} triangles, 256 light samples where a method asks any; medians of "
                                             f"{compared['runs']} runs; RMSE against exact areas at the larger size.",
                               "columns": ["method", "RMSE", *columns], "formats": [None, ".4f"] + [".1f"] * len(columns)}, methods)


main()
