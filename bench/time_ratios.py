#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures ratios of times that papers claim, one method's time divided by another's, and writes results/time-ratios.json.

  bench/time_ratios.py [PROGRAM]           about half an hour on two threads
  bench/time_ratios.py --only TEXT …       only the questions whose paper or text contains one of these texts
  bench/time_ratios.py --write-scenes FOLDER      the scenes as GLB files, for a machine without the packages that hold their meshes
  bench/time_ratios.py --gpu FOLDER FILE.json     on a GPU, from those scenes: into FILE.json

Then bench/tables.py writes the table of docs/figures.md. Questions that have a row are left out: delete a row to measure it again. A
row has its commit and the machine's load.

On a GPU a number is the clock's: `light` and `evaluate` as `compare` reports them, the median of five runs, and the sum of the passes'
milliseconds by the GPU's own clock. On a processor it is processor seconds per run (`light` and `evaluate`): those of a whole `penumbra compare` of one method with several runs minus
those with one run, divided by the number of further runs; minus the time that `compare` itself takes per run, such as for finding the view samples, which is measured
in the same manner with a method that always runs once. So times of starting, reading, compiling shaders and judging are not included, and other
running programs disturb these times less than they disturb wall-clock times. The methods of a question are measured in turns; a ratio is the median of each
turn's own."""

import argparse
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
    """Returns the scene of a lamp closely surrounded by boxes, which shade a floor and one another."""
    around = [(round(1.1 * cos(k * pi / 4), 3), round(1.1 * sin(k * pi / 4), 3)) for k in range(8)]
    bodies = [{"name": f"box {k}", "shape": {"type": "box", "center": [x, 0.5 + 0.2 * (k % 3), z], "halfSize": [0.15, 0.3, 0.15]}} for k, (x, z) in enumerate(around)]
    world = standing(bodies[0], 0.5)
    world["meshes"] += bodies[1:]
    world["lights"] = [{"name": "lamp", "sphere": {"center": [0, 0.8, 0], "radius": 0.3}}]
    return world


def bumpy_ball(rows=90, without_front=False):
    """Returns a scene with a closed bumpy ball of radius about 1, centred 2 above the floor, and the text of its mesh
    file. `without_front` leaves out the triangles that face all of a light of half-size 0.5 at height 5."""
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
    """Yields (paper, question, the paper's number, scene, size, options, methods). The ratio is the first method's time
    divided by the second's; if there are two scenes, each method has its own."""
    for body, world in (("bunny", standing(bunny(), 0.5)), ("ball", standing(ball(y=1.2), 0.5))):
        yield ("Atty et al., 3.5", f"`soft-shadow-map` with two passes over one, map 128², {body}", "1.6 to 1.8", world, 256, [],
               ("soft-shadow-map:passes=2:size=128", "soft-shadow-map:passes=1:size=128"))
    one_pass = "soft-shadow-map:passes=1:size="
    for less, more, claimed in ((1, 8, "8: linear in the polygons"), (1, 2, "2: linear in the polygons")):
        yield ("Atty et al., fig. 21", f"`soft-shadow-map`, map 128²: {more} bunnies ({70 * more}k triangles) over {less} ({70 * less}k)", claimed,
               (bunnies(more), bunnies(less)), 256, [], (one_pass + "128", one_pass + "128"))
    for size, claimed in ((128, "4: linear in the map's pixels"), (64, "16: linear in the map's pixels")):
        yield ("Atty et al., fig. 22", f"`soft-shadow-map`, 24k triangles, a ball: map 256² over {size}²", claimed,
               scene([ball(segments=156)]), 256, [], (one_pass + "256", f"{one_pass}{size}"))
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
    # The method that the paper compares with (Guennebaud et al. 2007) visits every cell of a kernel: minutes per run
    # with maps of 512².
    yield ("Yang et al., fig. 11", "`packet` with 2 × 2 sub-lights over flat `contour`, map 128², bunny, light of half-size 1, 96² pixels", "0.33", standing(bunny(), 1), 96, [],
           ("packet:sublights=2:size=128", "contour:size=128:traversal=flat"))
    # Four layers are the same number of maps as 2 × 2 sub-lights.
    for other, claimed in (("bitmask:size=512:layers=4", "0.19"), ("backproject-peel:size=512:layers=4", "0.21")):
        yield ("Yang et al., fig. 11", f"`packet` with 2 × 2 sub-lights over `{other}`, map 512², bunny, light of half-size 1", claimed, standing(bunny(), 1), 96, [],
               ("packet:sublights=2:size=512", other))
    yield ("Yang et al., fig. 11", "`packet` with 4 × 4 sub-lights over 2 × 2, map 512², bunny, light of half-size 1", "3.7", standing(bunny(), 1), 96, [],
           ("packet:sublights=4:size=512", "packet:sublights=2:size=512"))
    flat = "contour:size=64:traversal=flat"  # maps of 512² would take minutes per run
    yield ("Yang et al., fig. 1 (c)", "`packet` over flat `contour`, map 64², a spherical lamp closely surrounded by boxes, 48² pixels", "0.05", omni(), 48, [],
           ("packet:size=64", flat))
    yield ("Yang et al., fig. 1 (b)", "`packet` over flat `contour`, map 64², `scenes/textured-light.json`, a window of nine panes, 48² pixels", "0.1", "scenes/textured-light.json", 48,
           [], ("packet:size=64", flat))
    for size in (96, 384):
        yield ("Yang et al., fig. 12", f"`packet` without hierarchy, packets of 8 × 8 over 2 × 2, map 128², bunny, {size}² pixels", "falls as pictures grow",
               standing(bunny(), 0.5), size, [], ("packet:hierarchy=off:packet=8x8:size=128", "packet:hierarchy=off:packet=2x2:size=128"))
    for layers in (2, 3):
        yield ("Bavoil et al., fig. 6", f"`backproject-peel` with {layers} layers over 1, bunny on the floor, map 512²", "1.42 to 1.54 with 3", standing(bunny(), 0.5), 128, [],
               (f"backproject-peel:size=512:layers={layers}", "backproject-peel:size=512:layers=1"))
    for size in (4096, 5792):
        yield ("course notes, 3.2.5", f"`alias-free` over `shadow-map` of {size}², bunny, 512² pixels", "0.33 of an 8192² map", standing(bunny(), 0.1), 512, [],
               ("alias-free", f"shadow-map:size={size}"))
    yield ("course notes, 4.2.4", "`vssm:moments=csm` over `moments=esm`, map 1024², bunny", "2 to 3", standing(bunny(), 0.5), 256, [],
           ("vssm:moments=csm:size=1024", "vssm:moments=esm:size=1024"))
    yield ("course notes, 5.3.2.3", "`soft-volume` with the table over `soft-volume` with arc cosines, a ball", "above 1", standing(ball(y=1.2), 0.5), 512, [],
           ("soft-volume:coverage=table", "soft-volume"))
    yield ("course notes, 5.3.3.2", "`view-sample` without the triangles that face all of the light, over `view-sample` with all triangles, a bumpy ball of 32k triangles", "0.5",
           (bumpy_ball(without_front=True), bumpy_ball()), 256, ["--light-samples", "256"], ("view-sample", "view-sample"))


def scenes_of(world):
    """Returns the scenes of the first and the second method."""
    return world if isinstance(world, tuple) else (world, world)


def compare(program, scene_file, folder, method, size, runs, more):
    """Runs `penumbra compare` of one method. Returns its processor seconds and the method's part of metrics.json."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([program, "-q", "compare", scene_file, "-o", folder / "out", "--methods", method, "--size", f"{size}x{size}", "--reference-samples", "1",
                    "--sample-pixels", "1", "--runs", str(runs), *more], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    ran = json.loads((folder / "out" / "metrics.json").read_text(encoding="utf-8"))["methods"][0]
    if ran["failure"] is not None:
        sys.exit(f"{method}: {ran['failure']}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, ran


def of_a_run(runs, *asked):
    """Returns the processor seconds of one run: the difference between 1 + `runs` runs and one run, divided by
    `runs`."""
    def whole(count):
        program, scene_file, folder, method, size, more = asked
        return compare(program, scene_file, folder, method, size, count, more)[0]
    return (whole(1 + runs) - whole(1)) / runs


def how_many_runs(program, scene_file, folder, method, size, more):
    """Returns the number of runs that take about two seconds, so that differences between processes hardly matter; 1
    for slow methods."""
    def whole(count):
        return compare(program, scene_file, folder, method, size, count, more)[0]
    one = whole(1)
    return 1 if one > 10 else max(1, min(50, round(2 / max((whole(6) - one) / 5, 0.01))))


def of_no_run(program, scene_file, folder, _, size, more):
    """Returns the processor seconds that `compare` spends per run on anything but the method: measured with a reference
    of areas, which runs only once whatever --runs is."""
    return max(0, of_a_run(20, program, scene_file, folder, "exact", size, more))


def on_gpu(program, scene_file, folder, method, size, more):
    """Returns the method's seconds, in total and of its passes, as reported by the program."""
    ran = compare(program, scene_file, folder, method, size, 5, more)[1]
    return ran["seconds"]["shadow"], sum(one["milliseconds"] for one in ran["passes"]) / 1000


def of_turns(seconds):
    """Returns, for pairs of seconds, the median ratio, the range of ratios, and both medians, as texts."""
    if any(second == 0 for _, second in seconds):
        return "–", "–", "no time"  # times of passes, of a method without passes
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
    """Writes a scene, and the files that it names, to a folder."""
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


def measure(program, commit, only, turns):
    asked = list(questions())
    rows = {row[1]: row for row in json.loads(RESULT.read_text(encoding="utf-8"))["rows"]} if RESULT.is_file() else {}
    device, cpu = name_of(program)
    for paper, question, claimed, world, size, more, methods in asked:
        if question in rows or (only and not any(text in f"{paper}: {question}" for text in only)):
            continue
        loads = [os.getloadavg()[0]]
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            asked_of = [(program, scene_in(folder / str(k), one), folder, method, size, more) for k, (one, method) in enumerate(zip(scenes_of(world), methods))]
            runs = [how_many_runs(*one) for one in asked_of]
            none = [of_no_run(*one) for one in asked_of] if isinstance(world, tuple) else [of_no_run(*asked_of[0])] * 2
            seconds = []
            for _ in range(turns):
                seconds.append([of_a_run(count, *one) - less for one, count, less in zip(asked_of, runs, none)])
                loads.append(os.getloadavg()[0])
        here, between, medians = of_turns(seconds)
        load = " to ".join(dict.fromkeys(f"{end:.0f}" for end in (min(loads), max(loads))))
        rows[question] = [paper, question, claimed, here, between + ("" if turns == TURNS else f" ({turns} turns)"), medians, load, commit]
        print(" | ".join(rows[question]), flush=True)
        kept = [rows[one[1]] for one in asked if one[1] in rows]
        write(RESULT, {"commit": " and ".join(dict.fromkeys(row[-1] for row in kept)), "machine": f"{device} on {cpu}, 2 threads that other programs used as well",
                       "command": "bench/time_ratios.py",
                       "conditions": f"Processor seconds of a run, `light` and `evaluate`, medians of {TURNS} turns; the column of turns says how far turns differ.",
                       "columns": ["paper", "question", "the paper's", "here", "turns", "seconds", "load", "commit"]}, kept)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", type=Path, default=ROOT / "build" / "penumbra")
    parser.add_argument("--only", metavar="TEXT", nargs="+", help="questions whose paper or words have one of these texts")
    parser.add_argument("--turns", type=int, default=TURNS, help="how often the methods of a question take turns")
    parser.add_argument("--commit", help="commit that the program was built from, where that is not the one checked out")
    parser.add_argument("--write-scenes", metavar="FOLDER", type=Path)
    parser.add_argument("--gpu", metavar=("FOLDER", "FILE.json"), nargs=2, type=Path)
    given = parser.parse_args()
    program = given.program.resolve()
    if given.write_scenes:
        return write_scenes(program, given.write_scenes)
    git = ["git", "-C", ROOT, "rev-parse", "--short=8", "HEAD"]
    commit = given.commit or subprocess.run(git, check=False, capture_output=True, text=True).stdout.strip() or "not known"
    if given.gpu:
        return measure_gpu(program, commit, *given.gpu)
    return measure(program, commit, given.only, given.turns)


main()
