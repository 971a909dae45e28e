#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures ratios of time that the papers sell, one method's over another's, into results/time-ratios.json.

  bench/time_ratios.py [PROGRAM]           about half an hour on two busy cores
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

from experiment import ball, bunny, scene  # noqa: E402
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


def questions():
    """(paper, question, the paper's number, scene, size, options, methods): the ratio is the first method's time over the second's."""
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
            subprocess.run([program, "-q", "convert", scene_in(Path(name), world), "-o", to / f"{number}.glb"], check=True)


def scene_in(folder, world):
    if not isinstance(world, dict):
        return ROOT / world
    (folder / "scene.json").write_text(json.dumps(world), encoding="utf-8")
    return folder / "scene.json"


def measure_gpu(program, commit, scenes, result):
    device, cpu = name_of(program)
    rows = []
    for number, (paper, question, claimed, _, _, more, methods) in enumerate(questions()):
        with tempfile.TemporaryDirectory() as name:
            folder, file = Path(name), scenes / f"{number}.glb"
            turns = [[on_gpu(program, file, folder, method, 512, more) for method in methods] for _ in range(TURNS)]
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
            scene_file = scene_in(folder, world)
            # About a second of runs, so that a clock tick counts for nothing.
            runs = {method: max(1, min(20, round(1 / max(of_a_run(program, scene_file, folder, method, size, more, 1), 0.05)))) for method in methods}
            seconds = [[of_a_run(program, scene_file, folder, method, size, more, runs[method]) for method in methods] for _ in range(TURNS)]
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
