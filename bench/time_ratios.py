#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures ratios of time that the papers sell, one method's over another's, into results/time-ratios.json.

  bench/time_ratios.py [PROGRAM]           about an hour on two busy cores
  bench/time_ratios.py PROGRAM --write-scenes FOLDER      the scenes as GLB files, for a machine without the packages that hold their meshes
  bench/time_ratios.py PROGRAM --gpu FOLDER FILE.json     on a GPU, from those scenes: into FILE.json

Then bench/tables.py writes the table of docs/figures.md. Questions that have a row are left out: delete a row to measure it again. A
row says of which commit it is.

On a GPU a number is the clock's: `light` and `evaluate` as `compare` reports them, the median of five runs, and the sum of the passes'
milliseconds by the GPU's own clock. Else it is processor seconds of a run (`light` and `evaluate`): those of a whole `penumbra compare` of one method with more runs less
those with one run, a run. So what a program needs to start, to read, to compile shaders and to judge is in neither, and other
programs at work disturb less than they do a clock. The methods of a question are measured in turns; a ratio is the median of each
turn's own."""

import json
import os
import resource
import subprocess
import sys
import tempfile
from math import cos, pi, sin
from pathlib import Path
from statistics import median

ROOT = Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / "docs" / "figures"), str(ROOT / "docs" / "figures" / "papers")]

from experiment import ball, bunny, cross, dot, scene  # noqa: E402
from schwaerzler import world_of  # noqa: E402

RESULT = ROOT / "bench" / "results" / "time-ratios.json"
TURNS = 3


def bunnies(count):
    """Returns `count` bunnies in rows of four above a floor, which the camera sees from the front."""
    world = scene([], half=0.5, light_y=6.0, floor=4.0, floor_casts=True)
    for k in range(count):
        one = bunny(height=1.2)
        one["name"] = f"bunny {k}"
        one["fit"]["base"] = [1.5 * (k % 4) - 0.75 * (min(count, 4) - 1), 0.02, 1.4 * (k // 4) - 0.7 * ((count - 1) // 4)]
        world["meshes"].append(one)
    world["camera"] = {"eye": [0, 3.5, 7], "target": [0, 0.4, 0], "verticalFov": 45}
    return world


def standing(body, half):
    world = scene([body], half=half, floor=2.5, floor_casts=True)
    world["camera"] = {"eye": [0, 2.2, 5], "target": [0, 0.8, 0], "verticalFov": 45}
    return world


def omni():
    """A lamp closely surrounded by boxes, which shade a floor and one another."""
    around = [(round(1.1 * cos(k * pi / 4), 3), round(1.1 * sin(k * pi / 4), 3)) for k in range(8)]
    bodies = [{"name": f"box {k}", "shape": {"type": "box", "center": [x, 0.5 + 0.2 * (k % 3), z], "halfSize": [0.15, 0.3, 0.15]}} for k, (x, z) in enumerate(around)]
    world = standing(bodies[0], 0.5)
    world["meshes"] += bodies[1:]
    world["lights"] = [{"name": "lamp", "sphere": {"center": [0, 0.8, 0], "radius": 0.3}}]
    return world


def bumpy_ball(rows=90, without_front=False):
    """A closed ball with bumps as a scene's mesh, radius about 1 and 2 above the floor, and the text of its file; `without_front` leaves out the
    triangles that face all of a light of half-size 0.5 and height 5."""
    def at(row, column):
        theta, phi = pi * row / rows, pi * column / rows
        r = 1 + 0.1 * sin(9 * theta) * sin(9 * phi) * sin(theta)
        return r * sin(theta) * cos(phi), 2 + r * cos(theta), -r * sin(theta) * sin(phi)

    def number(row, column):
        return 1 if row == 0 else 2 if row == rows else 3 + (row - 1) * 2 * rows + column % (2 * rows)

    corners = [at(0, 0), at(rows, 0)] + [at(row, column) for row in range(1, rows) for column in range(2 * rows)]
    triangles = []
    for row in range(rows):
        for column in range(2 * rows):
            a, b, c, d = (number(row + i, column + j) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)))
            triangles += [t for t in ((a, b, c), (a, c, d)) if len(set(t)) == 3]

    def faces_the_light(t):
        p, q, r = (corners[k - 1] for k in t)
        normal = cross([x - y for x, y in zip(q, p)], [x - y for x, y in zip(r, p)])
        return all(dot(normal, [x - y for x, y in zip((u, 5, v), p)]) > 0 for u in (-0.5, 0.5) for v in (-0.5, 0.5))

    kept = [t for t in triangles if not without_front or not faces_the_light(t)]
    text = "".join(f"v {x:.7g} {y:.7g} {z:.7g}\n" for x, y, z in corners) + "".join(f"f {a} {b} {c}\n" for a, b, c in kept)
    return {**scene([{"name": "ball", "file": "ball.obj"}]), "files": {"ball.obj": text}}


def questions():
    """(paper, question, the paper's number, scene, size, options, methods): the ratio is the first method's time over the second's, in a
    scene of its own if there are two."""
    for body, world in (("bunny", standing(bunny(), 0.5)), ("ball", standing(ball(y=1.2), 0.5))):
        yield ("Atty et al., 3.5", f"`soft-shadow-map` with two passes over one, map 128², {body}", "1.6 to 1.8", world, 256, [],
               ("soft-shadow-map:passes=2:size=128", "soft-shadow-map:passes=1:size=128"))
    one_pass = "soft-shadow-map:passes=1:size="
    for less, more, claimed in ((1, 8, "8: linear in the polygons"), (1, 2, "2: linear in the polygons")):
        yield ("Atty et al., fig. 21", f"`soft-shadow-map`, map 128²: {more} bunnies ({70 * more}k triangles) over {less} ({70 * less}k)", claimed,
               (bunnies(more), bunnies(less)), 256, [], (one_pass + "128", one_pass + "128"))
    for size, claimed in ((256, "4: linear in the map's pixels"), (512, "16: linear in the map's pixels")):
        yield ("Atty et al., fig. 22", f"`soft-shadow-map`, 24k triangles, a ball: map {size}² over 128²", claimed,
               scene([ball(segments=156)]), 256, [], (f"{one_pass}{size}", one_pass + "128"))
    for size in (64, 128, 256):
        yield ("Atty et al., fig. 24 (a)", f"`soft-shadow-map`, map {size}², a ball: light of half-size 1 over 0.1", "above 1",
               (scene([ball()], half=1), scene([ball()], half=0.1)), 256, [], (f"{one_pass}{size}", f"{one_pass}{size}"))
    for count in (1, 2, 4, 8):
        yield ("Atty et al., fig. 25", f"`soft-shadow-map` (two passes, 210²) over `soft-volume`, {count} bunn{'y' if count == 1 else 'ies'}, {70 * count}k triangles",
               "falls with the polygons, below 1", bunnies(count), 256, [],
               ("soft-shadow-map:passes=2:size=210", "soft-volume"))
    for half in (0.1, 0.5, 1.5):
        yield ("Schwärzler, section 4", f"`adaptive-light` over `accumulate`, 128 light samples, maps of 512², plate close to the floor, light of half-size {half:g}",
               "0.18 to 0.5, at worst 1.5", world_of("plate", half), 256, ["--light-samples", "128"],
               ("adaptive-light:size=512", "accumulate:size=512"))
    # Four layers are as many maps as 2 × 2 sub-lights.
    for other, claimed in (("contour:size=512", "0.33"), ("bitmask:size=512:layers=4", "0.19"), ("backproject-peel:size=512:layers=4", "0.21")):
        yield ("Yang et al., fig. 11", f"`packet` with 2 × 2 sub-lights over `{other}`, map 512², bunny, light of half-size 1", claimed, standing(bunny(), 1), 96, [],
               ("packet:sublights=2:size=512", other))
    yield ("Yang et al., fig. 11", "`packet` with 4 × 4 sub-lights over 2 × 2, map 512², bunny, light of half-size 1", "3.7", standing(bunny(), 1), 96, [],
           ("packet:sublights=4:size=512", "packet:sublights=2:size=512"))
    yield ("Yang et al., fig. 1 (c)", "`packet` over `contour`, map 512², a spherical lamp closely surrounded by boxes", "0.05", omni(), 96, [],
           ("packet:size=512", "contour:size=512"))
    yield ("Yang et al., fig. 1 (b)", "`packet` over `contour`, map 512², `scenes/textured-light.json`, a window of nine panes", "0.1", "scenes/textured-light.json", 96, [],
           ("packet:size=512", "contour:size=512"))
    for size in (96, 384):
        yield ("Yang et al., fig. 12", f"`packet` without hierarchy, packets of 8 × 8 over 2 × 2, map 512², bunny, {size}² pixels", "falls as pictures grow",
               standing(bunny(), 0.5), size, [], ("packet:hierarchy=off:packet=8x8:size=512", "packet:hierarchy=off:packet=2x2:size=512"))
    for layers in (2, 3):
        yield ("Bavoil et al., fig. 6", f"`backproject-peel` with {layers} layers over 1, bunny on the floor, map 512²", "1.42 to 1.54 with 3", standing(bunny(), 0.5), 128, [],
               (f"backproject-peel:size=512:layers={layers}", "backproject-peel:size=512:layers=1"))
    for size in (4096, 5792):
        yield ("course notes, 3.2.5", f"`alias-free` over `shadow-map` of {size}², bunny, 512² pixels", "0.33 of an 8192² map", standing(bunny(), 0.1), 512, [],
               ("alias-free", f"shadow-map:size={size}"))
    yield ("course notes, 4.2.4", "`vssm:moments=csm` over `moments=esm`, map 1024², bunny", "2 to 3", standing(bunny(), 0.5), 256, [],
           ("vssm:moments=csm:size=1024", "vssm:moments=esm:size=1024"))
    yield ("course notes, 5.3.2.3", "`soft-volume` by table over by arc cosines, a ball", "above 1", standing(ball(y=1.2), 0.5), 512, [],
           ("soft-volume:coverage=table", "soft-volume"))
    yield ("course notes, 5.3.3.2", "`view-sample` without the triangles that face all of the light over all of them, a bumpy ball of 32k triangles", "0.5",
           (bumpy_ball(without_front=True), bumpy_ball()), 256, ["--light-samples", "256"], ("view-sample", "view-sample"))


def scenes_of(world):
    """Both methods' scenes."""
    return world if isinstance(world, tuple) else (world, world)


def processor_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def of_a_run(program, scene_file, folder, method, size, more, runs):
    def whole(count):
        return processor_seconds([program, "-q", "compare", scene_file, "-o", folder / "out", "--methods", method, "--size", f"{size}x{size}",
                                  "--reference-samples", "1", "--sample-pixels", "1", "--runs", str(count), *more])
    return (whole(1 + runs) - whole(1)) / runs


def on_gpu(program, scene_file, folder, method, size, more):
    """Seconds of the method, all and of its passes, as the program reports them."""
    subprocess.run([program, "-q", "compare", scene_file, "-o", folder / "out", "--methods", method, "--size", f"{size}x{size}", "--reference-samples", "1",
                    "--sample-pixels", "1", "--runs", "5", *more], check=True, stdout=subprocess.DEVNULL)
    ran = json.loads((folder / "out" / "metrics.json").read_text(encoding="utf-8"))["methods"][0]
    return ran["seconds"]["shadow"], sum(one["milliseconds"] for one in ran["passes"]) / 1000


def of_turns(seconds):
    """The median ratio, the least to the largest, and both medians, of pairs of seconds."""
    if any(second == 0 for _, second in seconds):
        return "–", "–", "no time"  # passes of methods that have none
    ratios = sorted(first / second for first, second in seconds)
    first, second = (median(turn[k] for turn in seconds) for k in range(2))
    return f"{median(ratios):.2f}", f"{ratios[0]:.2f} to {ratios[-1]:.2f}", f"{first:.2g} over {second:.2g}"


def name_of(program):
    device = json.loads(subprocess.run([program, "devices", "--json"], check=True, capture_output=True, text=True).stdout)["devices"][0]["name"]
    cpu = next(line.partition(":")[2].strip() for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines() if line.startswith("model name"))
    return device, cpu


def write(path, fields, rows):
    data = {"title": "ratios of time that the papers print, measured again", **fields}
    text = json.dumps(data, ensure_ascii=False, indent=1).removesuffix("\n}")
    lines = ",\n".join("  " + json.dumps(row, ensure_ascii=False) for row in rows)
    path.write_text(text + ',\n "rows": [\n' + lines + "\n ]\n}\n", encoding="utf-8")


def write_scenes(program, to):
    to.mkdir(parents=True, exist_ok=True)
    for number, (_, _, _, world, _, _, _) in enumerate(questions()):
        with tempfile.TemporaryDirectory() as name:
            for k, one in enumerate(scenes_of(world)):
                subprocess.run([program, "-q", "convert", scene_in(Path(name), one), "-o", to / f"{number}-{k}.glb"], check=True)


def scene_in(folder, world):
    """Writes a scene, and the files that it names, into a folder."""
    if not isinstance(world, dict):
        return ROOT / world
    folder.mkdir(exist_ok=True)
    for name, text in world.get("files", {}).items():
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "scene.json").write_text(json.dumps({key: value for key, value in world.items() if key != "files"}), encoding="utf-8")
    return folder / "scene.json"


def measure_gpu(program, commit, scenes, result):
    device, cpu = name_of(program)
    rows = []
    for number, (paper, question, claimed, _, _, more, methods) in enumerate(questions()):
        with tempfile.TemporaryDirectory() as name:
            turns = [[on_gpu(program, scenes / f"{number}-{k}.glb", Path(name), method, 512, more) for k, method in enumerate(methods)] for _ in range(TURNS)]
        whole, passes = (of_turns([[method[k] for method in turn] for turn in turns]) for k in range(2))
        rows.append([paper, question, claimed, whole[0], passes[0], passes[1], whole[2], passes[2]])
        print(" | ".join(rows[-1]), flush=True)
        write(result, {"commit": commit, "machine": f"{device}, {os.cpu_count()} threads of {cpu}", "command": "bench/time_ratios.py build/penumbra --gpu scenes OUT.json",
                       "conditions": f"Medians of {TURNS} turns of five runs each at 512² pixels, by the clock: `light` and `evaluate`, and of it the passes on the GPU.",
                       "columns": ["paper", "question", "the paper's", "here", "passes alone", "their turns", "seconds", "seconds of passes"]}, rows)


def measure(program, commit):
    asked = list(questions())
    rows = {row[1]: row for row in json.loads(RESULT.read_text(encoding="utf-8"))["rows"]} if RESULT.is_file() else {}
    device, cpu = name_of(program)
    for paper, question, claimed, world, size, more, methods in asked:
        if question in rows:
            continue
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            asked_of = [(scene_in(folder / str(k), one), folder, method, size, more) for k, (one, method) in enumerate(zip(scenes_of(world), methods))]
            # About a second of runs, so that a clock tick counts for nothing.
            runs = [max(1, min(20, round(1 / max(of_a_run(program, *one, 1), 0.05)))) for one in asked_of]
            seconds = [[of_a_run(program, *one, count) for one, count in zip(asked_of, runs)] for _ in range(TURNS)]
        rows[question] = [paper, question, claimed, *of_turns(seconds), commit]
        print(" | ".join(rows[question]), flush=True)
        write(RESULT, {"commit": commit, "machine": f"{device} on {cpu}, 2 threads that other programs used as well", "command": "bench/time_ratios.py",
                       "conditions": f"Processor seconds of a run, `light` and `evaluate`, medians of {TURNS} turns.",
                       "columns": ["paper", "question", "the paper's", "here", "turns", "seconds", "commit"]}, [rows[one[1]] for one in asked if one[1] in rows])


def main():
    program = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build" / "penumbra").resolve()
    if sys.argv[2:3] == ["--write-scenes"]:
        return write_scenes(program, Path(sys.argv[3]))
    git = ["git", "-C", ROOT]
    commit = subprocess.run([*git, "rev-parse", "--short", "HEAD"], check=False, capture_output=True, text=True).stdout.strip() or "not known"
    if sys.argv[2:3] == ["--gpu"]:
        return measure_gpu(program, commit, Path(sys.argv[3]), Path(sys.argv[4]))
    return measure(program, commit)


main()
