#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Processor seconds of whole processes, from start to file, user and system time of the process and of its children.

    bench/whole_processes.py small|lamps|dense|motion|antialiasing [BUILD]

Writes bench/results/NAME.json, of which bench/tables.py makes a table of bench/README.md or docs/pictures.md. `lamps` and `dense` need
Blender and the add-on (target penumbra_blender_addon). Compared programs run in turns. A number is the least of its runs, since other programs
on the machine only add to it, or the median where that is stated.

small   a picture of a box, 64 × 64: the cost of a process before its first pixel, by processes that do more and more of the work
lamps   200 and 1,000 lamps, 320 × 240, compared with Cycles with 32 samples per pixel
motion  an open shutter of 16 moments compared with a still picture, where one of two bodies moves
dense   504,080 triangles, 640 × 480: the program from the add-on's exchange file, and what Blender adds with the add-on
antialiasing  pictures of shipped scenes with one and with 16 view samples a pixel: processor seconds and memory
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from animated_glb import add_motion
from processes import processor, usage_of

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "bench/results"
BOX = {"format": "penumbra-scene/1", "size": [64, 64], "camera": {"eye": [3, 3, 4], "target": [0, 0.4, 0]},
       "meshes": [{"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [3, 0, 0], "halfV": [0, 0, -3]}},
                  {"name": "box", "shape": {"type": "box", "center": [0, 0.5, 0], "halfSize": [0.5, 0.5, 0.5]}}],
       "lights": [{"name": "key", "rectangle": {"center": [1.5, 3, 1], "halfU": [0.4, 0, 0], "halfV": [0, 0, 0.4]}, "radiance": [10, 10, 10]}]}


def processor_seconds(command, environment=None):
    return usage_of(command, environment).seconds


def in_turns(commands, runs, environment=None):
    """Runs these commands in turns and returns the least processor seconds of each."""
    least = [float("inf")] * len(commands)
    for _ in range(runs):
        for i, command in enumerate(commands):
            least[i] = min(least[i], processor_seconds(command, environment))
    return least


def save(name, title, conditions, columns, rows, formats):
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    data = {"title": title, "commit": commit, "machine": f"{processor()}, {os.cpu_count()} threads, load {os.getloadavg()[1]:.0f}",
            "command": f"bench/whole_processes.py {sys.argv[1]}", "conditions": conditions, "columns": columns, "formats": formats, "rows": rows}
    text = json.dumps({**data, "rows": None}, indent=1, ensure_ascii=False)
    text = text.replace('"rows": null', '"rows": [\n  ' + ",\n  ".join(json.dumps(row, ensure_ascii=False) for row in rows) + "\n ]")
    (RESULTS / f"{name}.json").write_text(text + "\n", encoding="utf-8")
    for row in rows:
        print(row)


def small(program, folder):
    runs = 40
    scene, out = folder / "box.json", folder / "box.exr"
    scene.write_text(json.dumps(BOX))
    render = [program, "render", scene, "-o", out]
    version, tiny, beauty, all_layers = in_turns([
        [program, "version"], [*render, "--size", "4x4", "--layers", "beauty"], [*render, "--layers", "beauty"], render], runs)
    rows = [["the process starts and ends (`penumbra version`): libraries are linked, tables are filled", version, version],
            ["reads the scene, makes hierarchies and threads, renders 4 × 4 pixels, writes R G B A", tiny, tiny - version],
            ["renders 64 × 64 pixels", beauty, beauty - tiny],
            ["writes all layers", all_layers, all_layers - beauty]]
    save("small-render", "a small picture, phase by phase", f"A floor and a box under a rectangle, 64 × 64 pixels, exact areas; least of {runs} runs in turns. Each line does what "
         "the one above does, and more.", ["what", "processor ms", "of it new"], [[what, 1000 * a, 1000 * b] for what, a, b in rows], [None, ".1f", ".1f"])


def make_scenes(build, folder, size, names):
    environment = {**os.environ, "BLENDER_USER_SCRIPTS": str(folder / "scripts"), "BLENDER_USER_CONFIG": str(folder / "config")}
    (folder / "scripts").mkdir()
    processor_seconds(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "-P", ROOT / "bench/cycles/scenes.py", "--",
                       build / "penumbra-blender.zip", folder, *size, *names], environment)
    return environment


def blender(program, scene, out, engine, samples):
    return ["blender", "-b", scene, "--python-exit-code", "1", "-P", ROOT / "bench/cycles/render.py", "--", out, engine, samples, "centres", 1, program]


def lamps(build, program, folder):
    runs, names = 1, ("lamps_200", "lamps_1000")
    environment = make_scenes(build, folder, (320, 240), names)
    rows = []
    for name in names:
        render = [program, "render", folder / f"{name}.glb", "-o", folder / "o.exr", "--no-studio", "--size", "320x240"]
        seconds = in_turns([[*render, "--layers", "beauty"], render, [*render, "--layers", "beauty", "--light-cutoff", "0.001"],
                            blender(program, folder / f"{name}.blend", folder / "c.exr", "CYCLES", 32)], runs, environment)
        rows.append([int(name.partition("_")[2]), *seconds])
    save("many-lamps", "hundreds of lamps, beside Cycles", "Point lamps, spot lamps and rectangles in turn over a floor with 64 blocks (770 triangles), 320 × 240 pixels, exact areas; "
         "in turns. Cycles: direct light alone, with Blender's start.",
         ["lamps", "R G B A", "V and light of each lamp, too", "R G B A, `--light-cutoff 0.001`", "Cycles, 32 samples a pixel"], rows, [None] + [".1f"] * 4)


def dense(build, program, folder):
    runs = 3
    environment = make_scenes(build, folder, (640, 480), ["dense"])
    scene = folder / "dense.blend"
    render = [program, "render", folder / "dense.glb", "-o", folder / "o.exr", "--no-studio", "--size", "640x480"]
    start, alone, added = in_turns([["blender", "-b", scene, "--python-exit-code", "1", "--python-expr", "import bpy"], render,
                                    blender(program, scene, folder / "b.exr", "PENUMBRA", 0)], runs, environment)
    rows = [["the program, GLB to EXR with all layers", alone], ["Blender opens its file, and ends", start],
            ["Blender with the add-on renders and saves", added], ["of it the add-on's own part: export, exchange, passes back", added - start - alone]]
    save("dense-start-to-file", "504,080 triangles from start to file", f"A terrain and a bumpy ball under a disk, 640 × 480 pixels, exact areas; least of {runs} runs in turns.",
         ["what", "processor seconds"], rows, [None, ".2f"])


def motion(program, folder):
    runs, rows = 3, []
    body = {"name": "body", "shape": {"type": "box", "center": [0.4, 0, 0.4], "halfSize": [0.2, 0.2, 0.2]}}
    for name in ("bunny", "large-penumbra", "contact"):
        scene = json.loads((ROOT / "scenes" / f"{name}.json").read_text())
        scene["meshes"].append(body)
        (folder / "scene.json").write_text(json.dumps(scene))
        glb = folder / f"{name}.glb"
        processor_seconds([program, "convert", folder / "scene.json", "-o", glb, "--quiet"])
        add_motion(glb, "body", [0.8, 0, 0.8])
        stats = folder / "stats.json"
        picture = [program, "render", glb, "-o", folder / "o.exr", "--frame", "12", "--shutter", "0.5", "--size", "512x512", "--quiet"]
        blurred = [*picture, "--motion-samples", "16", "--stats", stats]
        still, open_shutter = in_turns([picture, blurred], runs)
        counters = json.loads(stats.read_text())["counters"]
        asked = 15 * 512 * 512  # view samples of the moments after the first
        rows.append([name, still, open_shutter, open_shutter / still, 100 * counters.get("viewSamplesStill", 0) / asked])
    save("motion", "an open shutter beside a still picture", f"A scene of the project and a small box that moves, 512 × 512 pixels, one view sample a pixel, exact areas; least of {runs} runs in turns. "
         "Of the view samples at the other 15 moments, those that kept their answer (the background is among the others).",
         ["scene", "one moment, processor s", "16 moments", "times", "view samples that kept their answer, %"], rows, [None, ".2f", ".2f", ".1f", ".0f"])


def four_lamps(folder):
    """Returns scenes/contact.json with three more rectangle lights of different heights and sizes."""
    scene = json.loads((ROOT / "scenes/contact.json").read_text(encoding="utf-8"))
    for name, center, half in (("rim", [2.5, 3, -1.5], 0.3), ("fill", [-3, 2.5, 2], 0.8), ("top", [0, 5, 0], 0.15)):
        scene["lights"].append({"name": name, "radiance": [20, 20, 20],
                                "rectangle": {"center": center, "halfU": [half, 0, 0], "halfV": [0, 0, half]}})
    path = folder / "four-lamps.json"
    path.write_text(json.dumps(scene), encoding="utf-8")
    return path


def antialiasing(program, folder):
    runs = 3
    four = four_lamps(folder)
    shipped = (("bunny", 512), ("room", 512), ("contact", 512), ("large-penumbra", 384), ("terrain-1m", 512))
    pictures = [(f"`{name}`", ROOT / f"scenes/{name}.json", side, side) for name, side in shipped]
    pictures += [("`contact`, four lamps", four, 512, 512), ("`contact`, four lamps", four, 1920, 1080)]
    sixteen = ["--pixel-samples", 16, "--pixel-filter", "blackman-harris"]

    rows = []
    for name, scene, width, height in pictures:
        render = [program, "render", scene, "-o", folder / "o.exr", "--size", f"{width}x{height}", "--quiet"]
        single, several = [], []
        for _ in range(runs):
            single.append(usage_of(render))
            several.append(usage_of([*render, *sixteen]))
        one, some = (statistics.median(usage.seconds for usage in usages) for usages in (single, several))
        memory, larger = (statistics.median(usage.mebibytes for usage in usages) for usages in (single, several))
        every = processor_seconds([*render, *sixteen, "--pixel-tolerance", 0]) if width == height else None
        rows.append([name, f"{width} × {height}", one, some, some / one, every and every / one, round(memory), round(larger), larger / memory])
        print(rows[-1], flush=True)
    save("antialiasing", "one and 16 view samples a pixel: processor seconds and memory",
         f"Exact areas, `blackman-harris`; user and system seconds and largest resident set of whole processes, medians of {runs} runs in turns. "
         "Factors are over one view sample a pixel; *all evaluated* is `--pixel-tolerance 0`, once.",
         ["scene", "pixels", "s: 1 a pixel", "16", "factor", "all evaluated", "MiB: 1 a pixel", "16", "factor"], rows,
         [None, None, ".2f", ".2f", ".1f", ".1f", None, None, ".1f"])


def main():
    of_program, of_build = {"small": small, "motion": motion, "antialiasing": antialiasing}, {"lamps": lamps, "dense": dense}
    if not sys.argv[1:] or sys.argv[1] not in of_program | of_build:
        sys.exit(__doc__)
    build = Path(sys.argv[2] if len(sys.argv) > 2 else ROOT / "build").resolve()
    with tempfile.TemporaryDirectory() as folder:
        if sys.argv[1] in of_program:
            of_program[sys.argv[1]](build / "penumbra", Path(folder))
        else:
            of_build[sys.argv[1]](build, build / "penumbra", Path(folder))


main()
