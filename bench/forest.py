#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A forest of copies of one tree, and the cost of a picture of it:
python3 bench/forest.py PROGRAM FOLDER [TREES ...] [--size PIXELS] [--peer build/embree_forest --runs N]
                        [--results FILE.json --machine TEXT --conditions TEXT]

Writes FOLDER/tree.ply (20,000 triangles: a trunk, branches, and leaves of two triangles each), and for each number of
trees FOLDER/forest-N.json, a scene with N copies of it. Renders each scene and prints triangles, processor seconds,
seconds, and the largest resident set of the program and its children. With --peer, each scene is also rendered with 256
light samples, by PROGRAM and by the peer on Embree in turns; medians of --runs are printed. --results writes them for
bench/tables.py. Uses only Python's standard library; the scenes are the same bytes each time.
"""
import argparse
import json
import math
import os
import pathlib
import random
import statistics
import struct
import subprocess
import time

TRIANGLES = 20_000


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a)


def along(a, t, b):
    return tuple(x + t * y for x, y in zip(a, b))


def tube(vertices, faces, start, end, radii, sides):
    """Adds a truncated cone without ends."""
    axis = unit(along(end, -1, start))
    u = unit(cross(axis, (0.3, 0.1, 0.9)))
    v = cross(axis, u)
    first = len(vertices)
    for point, radius in ((start, radii[0]), (end, radii[1])):
        for i in range(sides):
            turn = 2 * math.pi * i / sides
            vertices.append(along(along(point, radius * math.cos(turn), u), radius * math.sin(turn), v))
    for i in range(sides):
        j = (i + 1) % sides
        a, b, c, d = first + i, first + j, first + sides + i, first + sides + j
        faces += [(a, b, d), (a, d, c)]


def tree(triangles=TRIANGLES, seed=7):
    """Returns vertices and triangles of a tree of height 10 at the origin."""
    chance = random.Random(seed)
    vertices, faces, twigs = [], [], []
    tube(vertices, faces, (0, 0, 0), (0, 9, 0), (0.35, 0.05), 12)
    for _ in range(80):
        height = chance.uniform(2.5, 9)
        turn, rise = chance.uniform(0, 2 * math.pi), chance.uniform(0.1, 0.7)
        length = 0.35 * (10.5 - height)
        direction = unit((math.cos(turn), rise, math.sin(turn)))
        start = (0, height, 0)
        tube(vertices, faces, start, along(start, length, direction), (0.06, 0.01), 6)
        twigs.append((start, direction, length))
    while len(faces) < triangles:
        start, direction, length = chance.choice(twigs)
        at = along(start, length * chance.uniform(0.25, 1.1), direction)
        at = tuple(x + chance.gauss(0, 0.25) for x in at)
        u = unit([chance.gauss(0, 1) for _ in range(3)])
        v = unit(cross(u, [chance.gauss(0, 1) for _ in range(3)]))
        first = len(vertices)
        for s, t in ((-1, 0), (0, -0.5), (1, 0), (0, 0.5)):
            vertices.append(along(along(at, 0.12 * s, u), 0.12 * t, v))
        faces += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return vertices, faces[:triangles]


def write_ply(path, vertices, faces):
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n"
            "property float x\nproperty float y\nproperty float z\n"
            f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    with open(path, "wb") as file:
        file.write(head.encode())
        for vertex in vertices:
            file.write(struct.pack("<3f", *vertex))
        for face in faces:
            file.write(struct.pack("<B3i", 3, *face))


def forest(trees, seed=11, size=512):
    """Returns the scene with that many copies of tree.ply, one in each cell of a square, seen from above the square's
    edge."""
    chance = random.Random(seed)
    side = math.ceil(math.sqrt(trees))
    cell, half = 8.0, 4.0 * side
    places = []
    for i in range(trees):
        x, z = (i % side + 0.5) * cell - half, (i // side + 0.5) * cell - half
        scale = round(chance.uniform(0.7, 1.2), 3)
        places.append({"scale": scale, "rotate": [0, round(chance.uniform(0, 360), 2), 0],
                       "translate": [round(x + chance.uniform(-2, 2), 3), 0, round(z + chance.uniform(-2, 2), 3)]})
    return {
        "format": "penumbra-scene/1",
        "size": [size, size],
        "camera": {"eye": [0, 6 + 0.3 * half, 1.2 * half + 12], "target": [0, 2, 0.2 * half], "verticalFov": 45},
        "lights": [{"name": "sun", "sun": {"direction": [-0.5, -1, -0.3], "angle": 2}, "irradiance": [3, 3, 3]}],
        "meshes": [
            {"name": "ground", "quad": {"center": [0, 0, 0], "halfU": [2 * half, 0, 0], "halfV": [0, 0, -2 * half]}},
            {"name": "trees", "file": "tree.ply", "instances": places, "color": [0.2, 0.5, 0.15]},
        ],
    }


def measure(command):
    """Runs a program and returns its processor seconds, its seconds and its largest resident set in bytes."""
    begin = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"{' '.join(map(str, command))}: {os.waitstatus_to_exitcode(status)}")
    return usage.ru_utime + usage.ru_stime, time.monotonic() - begin, usage.ru_maxrss * 1024


def write_results(path, rows, given):
    commit = subprocess.run(["git", "rev-parse", "--short=8", "HEAD"], cwd=pathlib.Path(__file__).parent, check=True,
                            capture_output=True, text=True).stdout.strip()
    sizes = " ".join(str(row[0]) for row in rows)
    peer = f" --peer {given.peer} --runs {given.runs}" if given.peer else ""
    path.write_text(json.dumps({
        "title": "memory and processor seconds of forests of one tree, stored once",
        "commit": commit,
        "machine": given.machine,
        "command": f"bench/forest.py build/penumbra FOLDER {sizes}{peer}",
        "conditions": given.conditions,
        "columns": ["trees", "triangles", "processor seconds", "resident, GiB", "parts", "triangles of the largest",
                    *(["the same with 256 light samples", "Embree with 256", "ratio"] if given.peer else [])],
        "rows": rows,
    }, indent=1) + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("trees", type=int, nargs="*", default=[100, 1000, 10000])
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--peer")
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--results", type=pathlib.Path)
    parser.add_argument("--machine", default="")
    parser.add_argument("--conditions", default="")
    given = parser.parse_args()
    folder = given.folder
    folder.mkdir(parents=True, exist_ok=True)
    write_ply(folder / "tree.ply", *tree())
    print("trees triangles processor_s wall_s resident_MiB")
    rows = []
    for trees in given.trees:
        scene, stats = folder / f"forest-{trees}.json", folder / f"forest-{trees}.stats.json"
        scene.write_text(json.dumps(forest(trees, size=given.size)), encoding="utf-8")
        runs, counted, peers = [], [], []
        for _ in range(given.runs):
            command = [given.program, "render", scene, "--png", folder / f"forest-{trees}.png", "--quiet", "-o"]
            runs.append(measure([*command, folder / f"forest-{trees}.exr", "--stats", stats]))
            if given.peer:
                counted.append(measure([*command, folder / f"forest-{trees}-counted.exr", "--light-samples", "256"])[0])
                peers.append(measure([given.peer, scene, str(given.size), "256"])[0])
        busy, wall, resident = (statistics.median(values) for values in zip(*runs))
        compared = [round(statistics.median(counted), 1), round(statistics.median(peers), 1),
                    round(statistics.median(ours / embree for ours, embree in zip(counted, peers)), 2)] if peers else []
        print(trees, TRIANGLES * trees + 2, f"{busy:.1f} {wall:.1f} {resident / 2**20:.0f}", *compared, flush=True)
        counters = json.loads(stats.read_text(encoding="utf-8"))["counters"]
        rows.append([trees, TRIANGLES * trees + 2, round(busy, 1), round(resident / 2**30, 2), counters.get("partsOfPicture", 1),
                     counters.get("trianglesOfLargestPart", TRIANGLES * trees + 2), *compared])
        if given.results:
            write_results(given.results, rows, given)


if __name__ == "__main__":
    main()
