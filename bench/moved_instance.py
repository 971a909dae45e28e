#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures pictures of a forest in which one tree moves, in a kept Renderer: processor seconds of the first picture, of
a repetition without changes, and of a picture after a move. The scenes are those of forest.py.

    bench/moved_instance.py MODULES FOLDER [TREES …] [--results FILE.json --machine TEXT --conditions TEXT]

MODULES: folder of the Python module, build/python. The first picture is measured once, the others are medians of five."""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import time
from math import cos, radians, sin

sys.dont_write_bytecode = True
import forest

MOVES, SIZE = 5, (128, 128)


def moved(places, number, step):
    """Returns the matrix of an instance that is moved along x by `step`."""
    one = places[number]
    turn, scale = radians(one["rotate"][1]), one["scale"]
    x, y, z = one["translate"]
    c, s = scale * cos(turn), scale * sin(turn)
    return [[c, 0, s, x + step], [0, scale, 0, y], [-s, 0, c, z], [0, 0, 0, 1]]


def measure(penumbra, folder, trees):
    scene = folder / f"forest-{trees}.json"
    described = forest.forest(trees)
    scene.write_text(json.dumps(described), encoding="utf-8")
    places = described["meshes"][1]["instances"]
    renderer = penumbra.Renderer(penumbra.load(scene))

    def seconds(work):
        begin = time.process_time()
        work()
        return time.process_time() - begin

    def render():
        renderer.render(SIZE, light_samples=64, instances="shared")

    def move_and_render(step):
        middle = trees // 2 + int(trees ** 0.5) // 2
        renderer.scene.set_transform(penumbra.Instance("trees", middle), moved(places, middle, step))
        render()

    first = seconds(render)
    again = statistics.median(seconds(render) for _ in range(MOVES))
    after = statistics.median(seconds(lambda step=step: move_and_render(0.1 * step)) for step in range(1, MOVES + 1))
    return [trees, forest.TRIANGLES * trees + 2, round(first, 2), round(again, 2), round(after, 2)]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("modules")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("trees", type=int, nargs="*", default=[1000, 10000])
    parser.add_argument("--results", type=pathlib.Path)
    parser.add_argument("--machine", default="")
    parser.add_argument("--conditions", default="")
    given = parser.parse_args()
    sys.path.insert(0, given.modules)
    import penumbra
    given.folder.mkdir(parents=True, exist_ok=True)
    forest.write_ply(given.folder / "tree.ply", *forest.tree())
    rows = []
    for trees in given.trees:
        rows.append(measure(penumbra, given.folder, trees))
        print(*rows[-1], flush=True)
    if given.results:
        commit = subprocess.run(["git", "rev-parse", "--short=8", "HEAD"], cwd=pathlib.Path(__file__).parent, check=True, capture_output=True, text=True).stdout.strip()
        given.results.write_text(json.dumps({
            "title": "a tree of a forest moves: processor seconds of pictures in a kept renderer", "commit": commit, "machine": given.machine,
            "command": f"bench/moved_instance.py build/python FOLDER {' '.join(map(str, given.trees))}",
            "conditions": f"{SIZE[0]} × {SIZE[1]} pixels, 64 light samples of a sun of 2°; processor seconds, of the first picture once, else medians of {MOVES}. {given.conditions}".strip(),
            "columns": ["trees", "triangles", "first picture", "the same again", "after a move"], "formats": [None, None, ".2f", ".2f", ".2f"], "rows": rows}, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
