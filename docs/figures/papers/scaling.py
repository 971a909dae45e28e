# SPDX-License-Identifier: Apache-2.0
"""Measures how the cost of pictures grows with triangles, pixels and lights: the largest resident set, and processor seconds (user + system,
all cores) of whole runs of `penumbra render`. The load of the machine affects processor seconds less than elapsed time."""

import json
import os
import subprocess
import tempfile
from math import cos, floor, log10, pi, sin
from pathlib import Path

from chart import Chart, key
from drawing import Drawing
from experiment import ROOT, read_exr, rounded

TERRAIN = ((100, 50), (178, 89), (316, 158), (562, 281), (1000, 500), (1789, 894), (3200, 1600), (3606, 1803))
SIDES = (256, 512, 1024, 2048, (3840, 2160))
LIGHTS = (1, 2, 4, 8, 16, 32, 64)
SAMPLES = 256


def run(runner, scene, size, runs):
    """Returns the medians of processor seconds and of the largest resident set in MiB. The latter is the program's own number:
    the system's number for a child process starts at the size of the process that started it."""
    seconds, resident = [], []
    width, height = size if isinstance(size, tuple) else (size, size)
    with tempfile.TemporaryDirectory() as folder:
        path, out, stats = (Path(folder) / name for name in ("scene.json", "out.exr", "stats.json"))
        path.write_text(json.dumps(scene), encoding="utf-8")
        args = ["--quiet", "render", path, "-o", out, "--stats", stats, "--size", f"{width}x{height}", "--method", "edge-scatter",
                "--light-samples", str(SAMPLES)]
        for _ in range(runs):
            process = subprocess.Popen([runner.program, *args])
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            if process.returncode:
                raise RuntimeError(f"penumbra render ends with {process.returncode}")
            seconds.append(usage.ru_utime + usage.ru_stime)
            resident.append(json.loads(stats.read_text(encoding="utf-8"))["memory"]["peakResident"] / 2**20)
    return sorted(seconds)[runs // 2], sorted(resident)[runs // 2]


def penumbra_share(runner, scene, size):
    """Returns the share of pixels with 0 < V < 1, in a picture of this size ("256x256")."""
    with tempfile.TemporaryDirectory() as folder:
        path, out = Path(folder) / "scene.json", Path(folder) / "out.exr"
        path.write_text(json.dumps(scene), encoding="utf-8")
        subprocess.run([runner.program, "--quiet", "render", path, "-o", out, "--size", size, "--method", "edge-scatter"],
                       check=True)
        values = read_exr(out)[0]["V"]
    return sum(0 < v < 1 for v in values) / len(values)


def shipped(name):
    return json.loads((ROOT / "scenes" / f"{name}.json").read_text(encoding="utf-8"))


def machine():
    """Returns the system's name of the processor, and the number of threads."""
    with open("/proc/cpuinfo", encoding="utf-8") as info:
        model = next(line.split(":")[1].strip() for line in info if line.startswith("model name"))
    return f"{model}, {os.cpu_count()} threads"


def measure_triangles(runner):
    """Returns rows of triangles, processor seconds and MiB. The first, a terrain of two triangles, shows the fixed cost of a picture."""
    rows = []
    for cells in ((1, 1), *TERRAIN):
        scene = shipped("terrain-1m")
        scene["meshes"][0]["shape"]["cells"] = list(cells)
        triangles = 2 * cells[0] * cells[1]
        seconds, resident = run(runner, scene, 256, 3 if triangles < 2e6 else 1)
        rows.append([triangles, rounded(seconds), rounded(resident)])
        print("triangles", rows[-1], flush=True)
    runner.device = machine()
    runner.commands.append(f"penumbra render terrain-1m with other cells, 256x256, edge-scatter, {SAMPLES} light samples")
    return {"of": f"terrain, 256² pixels, {SAMPLES} light samples", "rows": rows}


def measure_pixels(runner):
    """Returns rows of pixels, pixels in penumbra, processor seconds and MiB. The first, with 16² pixels, shows the fixed cost of a picture."""
    scene = shipped("bunny")
    sizes = {}
    for side in (16, *SIDES):
        pixels = side[0] * side[1] if isinstance(side, tuple) else side * side
        sizes[pixels] = run(runner, scene, side, 3 if pixels < 2e6 else 1)
        print("pixels", pixels, *sizes[pixels], flush=True)
    # These runs come last: the system counts the memory that this script holds when it starts a program as the program's own.
    share, wide = penumbra_share(runner, scene, "256x256"), penumbra_share(runner, scene, "480x270")
    shares = [wide if pixels == 3840 * 2160 else share for pixels in sizes]
    rows = [[pixels, round(part * pixels), rounded(seconds), rounded(resident)]
            for part, (pixels, (seconds, resident)) in zip(shares, sizes.items())]
    runner.device = machine()
    runner.commands.append(f"penumbra render scenes/bunny.json, edge-scatter, {SAMPLES} light samples")
    return {"of": f"bunny, {SAMPLES} light samples; {100 * share:.1f} % of the pixels in penumbra, at 4K {100 * wide:.1f} %", "rows": rows}


def measure_lights(runner):
    """Returns rows of lights, processor seconds and MiB. The lights are squares in a circle above the bunny of the default scene, each
    as large as this scene's light."""
    rows = []
    for count in LIGHTS:
        scene = shipped("bunny")
        light = scene["lights"][0]
        scene["lights"] = []
        for i in range(count):
            angle = 2 * pi * i / count
            place = [3 * cos(angle), 5, 3 * sin(angle)]
            scene["lights"].append({**light, "name": f"light {i}", "rectangle": {"center": place, "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}})
        seconds, resident = run(runner, scene, 256, 3 if count < 32 else 1)
        rows.append([count, rounded(seconds), rounded(resident)])
        print("lights", rows[-1], flush=True)
    runner.device = machine()
    runner.commands.append(f"penumbra render bunny with 1 to 64 lights, 256x256, edge-scatter, {SAMPLES} light samples")
    return {"of": f"bunny, 256² pixels, {SAMPLES} light samples, lights of half size 0.5 in a circle", "rows": rows}


def step_for(values):
    """Returns a round number of which four times is above the largest value."""
    least = 1.05 * max(values) / 4
    power = 10 ** floor(log10(least))
    return next(k * power for k in (1, 2, 2.5, 5, 10) if k * power >= least)


def two_charts(title, text, xs, left, right, x_label, ticks, names=None):
    """Draws two charts. `left`, `right`: a title, and curves, each a name and points."""
    d = Drawing(900, 350, title, text)
    for i, (heading, curves) in enumerate((left, right)):
        step = step_for([y for _, points in curves for _, y in points])
        chart = Chart(d, (62 + 440 * i, 46, 370, 200), xs, (0, 4 * step), heading, x_label, "", log_x=True, x_ticks=ticks, x_names=names,
                      y_ticks=[step * k for k in range(5)])
        for style, (_, points) in enumerate(curves):
            chart.curve(points, style)
        if len(curves) > 1:
            key(d, (80 + 440 * i, 304), [(style, name) for style, (name, _) in enumerate(curves)], step=150)
    d.text((62, 334), text, 11.5)
    return d.finish()


def draw_triangles(data):
    (_, seconds, resident), *rows = data["rows"]
    return two_charts("Cost against triangles", data["of"] + "; less what a terrain of two triangles takes", (8e3, 1.6e7),
                      ("processor microseconds per triangle", [("", [(t, 1e6 * (s - seconds) / t) for t, s, _ in rows])]),
                      ("resident bytes a triangle", [("", [(t, 2**20 * (m - resident) / t) for t, _, m in rows])]),
                      "triangles", (1e4, 1e5, 1e6, 1e7), ("10⁴", "10⁵", "10⁶", "10⁷"))


def draw_pixels(data):
    (_, _, seconds, resident), *rows = data["rows"]
    return two_charts("Cost against pixels", data["of"] + "; less what 16² pixels take", (5e4, 1e7),
                      ("microseconds of a processor", [("a pixel", [(p, 1e6 * (s - seconds) / p) for p, _, s, _ in rows]),
                                                       ("a pixel in penumbra", [(p, 1e6 * (s - seconds) / q) for p, q, s, _ in rows])]),
                      ("resident bytes a pixel", [("a pixel", [(p, 2**20 * (m - resident) / p) for p, _, _, m in rows])]),
                      "pixels", (65536, 262144, 1048576, 4194304, 8294400), ("256²", "512²", "1024²", "2048²", "4K"))


def draw_lights(data):
    rows = data["rows"]
    one = rows[0]
    return two_charts("Cost against lights", data["of"] + "; what each light after the first adds", (1.8, 70),
                      ("milliseconds of a processor a light", [("", [(n, 1e3 * (s - one[1]) / (n - 1)) for n, s, _ in rows[1:]])]),
                      ("resident MiB a light", [("", [(n, max(m - one[2], 0) / (n - 1)) for n, _, m in rows[1:]])]),
                      "lights", LIGHTS[1:], [str(n) for n in LIGHTS[1:]])


def table(heads, rows):
    lines = [heads, ["---:"] * len(heads), *rows]
    return "\n".join(f"| {' | '.join(row)} |" for row in lines)


def triangle_table(data):
    (_, seconds, resident), *rows = data["rows"]
    return table(["triangles", "processor seconds", "MiB resident", "microseconds a triangle", "bytes a triangle"],
                 [[f"{t:,}", f"{s:.2f}", f"{m:.0f}", f"{1e6 * (s - seconds) / t:.2f}", f"{2**20 * (m - resident) / t:.0f}"] for t, s, m in rows])


def pixel_table(data):
    (_, _, seconds, resident), *rows = data["rows"]
    return table(["pixels", "in penumbra", "processor seconds", "MiB resident", "microseconds a pixel", "bytes a pixel"],
                 [[f"{p:,}", f"{q:,}", f"{s:.2f}", f"{m:.0f}", f"{1e6 * (s - seconds) / p:.2f}", f"{2**20 * (m - resident) / p:.0f}"] for p, q, s, m in rows])


def light_table(data):
    (_, seconds, resident), *rows = data["rows"]
    return table(["lights", "processor seconds", "MiB resident", "milliseconds a light", "MiB a light"],
                 [[f"{n}", f"{s:.2f}", f"{m:.0f}", f"{1e3 * (s - seconds) / (n - 1):.0f}", f"{max(m - resident, 0) / (n - 1):.1f}"] for n, s, m in rows])


TABLES = {"scaling-triangles": triangle_table, "scaling-pixels": pixel_table, "scaling-lights": light_table}
FIGURES = {"scaling-triangles": (measure_triangles, draw_triangles), "scaling-pixels": (measure_pixels, draw_pixels),
           "scaling-lights": (measure_lights, draw_lights)}
