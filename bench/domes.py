#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Error and cost of domes, areas beside rays: python3 bench/domes.py PROGRAM [SIDE]

Renders scenes/skies/knot.json under each of its domes, at SIDE x SIDE pixels (default 48): as areas, and with raytrace (Embree) for 64 to 4096 light samples, which are stratified and in
proportion to the picture's luminance. Prints rows of bench/results/domes.json: scene, dome, method, light samples,
processor seconds of the whole process less those of the same process with one light sample, and the RMSE of V against
the areas of `exact`. Uses Python's standard library alone."""

import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SAMPLES = (64, 256, 1024, 4096)
SUBJECTS = (("skies/knot", "around", ()), ("skies/knot", "above", ()), ("skies/knot", "evening", ()))


def run(arguments):
    """Processor seconds of the program and the processes that it starts."""
    child = subprocess.Popen(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(arguments)}: status {status}")
    return usage.ru_utime + usage.ru_stime


def entry(program, folder, subject, method, samples):
    """The process of one method, and its picture's file."""
    scene, light, more = subject
    out = Path(folder) / "out.exr"
    arguments = [program, "render", str(ROOT / "scenes" / f"{scene}.json"), *more, "--light", light, "--method", method, "--size", f"{SIDE}x{SIDE}", "-o", str(out)]
    return run(arguments + (["--light-samples", str(samples)] if samples else []))


def errors(program, folder, subject):
    """RMSE of V against `exact`, by the number of light samples; 0: areas by edge-scatter."""
    scene, light, more = subject
    out = Path(folder) / "compared"
    found = {}
    for samples in (0, *SAMPLES):
        method = "raytrace" if samples else "edge-scatter:rows=exact"
        arguments = [program, "compare", str(ROOT / "scenes" / f"{scene}.json"), *more, "--light", light, "--methods", method, "--reference", "exact", "--size", f"{SIDE}x{SIDE}",
                     "-o", str(out), *(["--light-samples", str(samples)] if samples else [])]
        run(arguments)
        found[samples] = json.loads((out / "metrics.json").read_text(encoding="utf-8"))["methods"][0]["error"]["rmse"]
    return found


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        for subject in SUBJECTS:
            scene, light, _ = subject
            found = errors(program, folder, subject)
            idle = entry(program, folder, subject, "raytrace", 1)
            for samples in (*SAMPLES, 0):
                method = "raytrace" if samples else "edge-scatter:rows=exact"
                seconds = entry(program, folder, subject, method, samples) - idle
                print(json.dumps([scene, light, method.partition(":")[0] if samples else "areas", samples or None, round(seconds, 2), float(f"{found[samples]:.1e}")]) + ",", flush=True)


SIDE = int(sys.argv[2]) if len(sys.argv) > 2 else 48
if __name__ == "__main__":
    if len(sys.argv) < 2 or not math.isfinite(SIDE):
        sys.exit(__doc__)
    main()
