# SPDX-License-Identifier: Apache-2.0
"""Figure of error against time of every method, by penumbra-bench: on the default scene and on the one with the widest penumbrae."""

import json
import subprocess
import tempfile
from pathlib import Path

from chart import Chart
from drawing import BLUE, DARK, GREEN, INK, RED, Drawing
from experiment import TRUTH, rounded

SCENES = ("bunny", "large-penumbra")
GEOMETRY = [TRUTH, "edge-scatter", "view-sample", "view-sample:variant=sintorn", "view-sample-planar", "hierarchical-penumbra", "depth-complexity",
            "depth-complexity:variant=laine", "soft-volume", "soft-volume:fusion=product", "soft-volume:fusion=vote", "soft-volume-blend", "soft-irregular", "wedge-ramp",
            "plateaus", "hard-volume", "hard-volume:variant=zp+", "hard-volume:variant=cc", "hard-volume:variant=split", "hard-volume:variant=hierarchical",
            "alias-free", "hybrid-volume"]
IMAGE = ["shadow-map", "pcf", "pcss", "vssm", "convolution", "occlusion-textures", "soft-shadow-map", "backproject", "backproject-peel",
         "bitmask", "contour", "packet", "accumulate", "adaptive-light", "layered-attenuation", "deep-penumbra",
         "penumbra-map", "smoothies", "parker", "brabec-seidel", "kirsch-doellner", "arvo", "silhouette-map", "forward-map", "layer-rays"]
RAYS = ["plain-rays", "raytrace"]
SIZE, SAMPLES, JUDGED = 128, 256, 1000


def measure(runner):
    """Measures, for each scene, rows of method, seconds of `light`, seconds of `evaluate`, and RMSE against exact areas. Methods that refuse
    the scene are left out."""
    data = {"of": f"{SIZE}² pixels, {SAMPLES} light samples, every option as it is by default; RMSE over {JUDGED} view samples in penumbra"}
    for scene in SCENES:
        args = ["--scene", scene, "--size", str(SIZE), "--light-samples", str(SAMPLES), "--peer", "none", "--reference", "exact", "--sample-pixels",
                str(JUDGED), "--runs", "3", "--budget", "1"]
        for entry in GEOMETRY + IMAGE:
            args += ["--method", entry]
        runner.commands.append("penumbra-bench " + " ".join(args))
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "lines"
            subprocess.run([runner.program.with_name("penumbra-bench"), *args, "--json", path], check=True, stdout=subprocess.DEVNULL)
            lines = {line["method"]: line for line in map(json.loads, path.read_text(encoding="utf-8").splitlines())}
        data[scene] = [[entry, rounded(lines[entry]["light"]["median"]), rounded(lines[entry]["evaluate"]["median"]),
                        rounded(lines[entry]["errorToReference"]["rmse"])] for entry in GEOMETRY + IMAGE + RAYS if entry in lines]
        runner.device = " and ".join(sorted({line["device"] for line in lines.values()}))
    print(table(data))
    return data


def table(data):
    """Returns the table of bench/README.md."""
    scenes = [name for name in data if name != "of"]
    numbers = {(name, row[0]): row for name in scenes for row in data[name]}
    lines = ["| method | " + " | ".join(f"{name}: s | RMSE" for name in scenes) + " |", "| --- |" + " ---: | ---: |" * len(scenes)]
    for entry in GEOMETRY + IMAGE + RAYS:
        if not any((name, entry) in numbers for name in scenes):
            continue  # younger than the measurement
        cells = []
        for name in scenes:
            row = numbers.get((name, entry))
            cells += [f"{row[1] + row[2]:.2g}", f"{row[3]:.4f}"] if row else ["–", "–"]
        lines.append(f"| `{entry}` | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def short(entry):
    return entry.removeprefix("edge-scatter:") if entry == TRUTH else entry.replace("variant=", "")


def draw(data):
    of, data = data["of"], {name: rows for name, rows in data.items() if name != "of"}
    tall = 110 + 16.4 * max(map(len, data.values()))
    d = Drawing(900, round(46 + tall * len(data)), "Error against time of all methods",
                "A chart for each scene: seconds of a changed light against the root mean square error of V. Filters are fast and wrong, "
                "backprojection is slower and nearer, methods with a map a light sample are slowest; exact edges are fast and right.")
    seconds = [light + evaluate for rows in data.values() for _, light, evaluate, _ in rows]
    ends = (0.8 * min(seconds), 1.3 * max(seconds))
    ticks = [t for t in (0.001, 0.01, 0.1, 1, 10, 100) if ends[0] <= t <= ends[1]]
    low, high = 1e-3, 0.6
    for k, (name, rows) in enumerate(data.items()):
        top = 46 + tall * k
        chart = Chart(d, (56, top, 520, tall - 100), ends, (low, high), f"scenes/{name}.json", "seconds when the light has changed", "RMSE of V", log_x=True,
                      log_y=True, x_ticks=ticks, y_ticks=[0.001, 0.01, 0.1])
        d.text((606, top - 10), "seconds; RMSE of V", 12, bold=True)
        for i, (entry, light, evaluate, error) in enumerate(rows):
            colour = RED if entry in GEOMETRY else BLUE if entry in IMAGE else GREEN
            at = chart.at(light + evaluate, min(max(error, low), high))
            d.circle(at, 8, "#ffffff", colour, 1.5)
            d.text((at[0], at[1] + 4), str(i + 1), 10, INK, "middle")
            y = top + 8 + 16.4 * i
            d.text((622, y), str(i + 1), 11, colour, "end")
            d.text((628, y), short(entry), 11, DARK)
            d.text((826, y), f"{light + evaluate:.2g}", 11, DARK, "end")
            d.text((884, y), f"{error:.4f}" if error else "0", 11, DARK, "end")
    d.text((56, 34 + tall * len(data)), f"{of}. Errors below 0.001 are drawn there.", 11.5)
    return d.finish()


FIGURES = {"times": (measure, draw)}
