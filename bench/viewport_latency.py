#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures how fast Blender's 3D view responds in Rendered shading, with Penumbra and with Cycles: pictures per second while the view turns or
a lamp moves, and the time from the last move until the error against a converged picture of Cycles is below 5, 2 and 1 %.

  bench/viewport_latency.py [SCENE …] [--build BUILD] [--seconds S] [--rest S] [--runs N] [--out FILE.json] [--work FOLDER]

SCENE: of bench/cycles/scenes.py. Needs Blender, Xvfb, the program and the add-on (targets penumbra and penumbra_blender_addon). A
Blender with a window on a separate virtual screen, drawn by the processor, runs bench/cycles/viewport.py, which defines what counts as a
picture. Without --out a table is printed; FILE.json is one of bench/results/."""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
NAMES = {"small": "small lamp", "large_penumbrae": "large penumbrae", "dense": "504k triangles", "four_lamps": "four lamps"}
MOVES = {"view": "the view turns", "lamp": "a lamp moves"}
ENGINES = {("PENUMBRA", True): "Penumbra", ("CYCLES", True): "Cycles", ("CYCLES", False): "Cycles, not adaptive"}


def run(command, log, **named):
    with open(log, "wb") as out:
        if subprocess.run([str(part) for part in command], stdin=subprocess.DEVNULL, stdout=out, stderr=out, **named).returncode != 0:
            sys.exit(f"{' '.join(map(str, command))} failed:\n{log.read_text(errors='replace')[-3000:]}")


def measure(build, scene, work, asked):
    """Returns all drags of one scene, as written by bench/cycles/viewport.py, and the machine's load before and
    after."""
    kept = work / "measured.json"
    if kept.exists():
        return json.loads(kept.read_text())
    before = os.getloadavg()[0]
    work.mkdir(parents=True)
    (work / "scripts").mkdir()
    run(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "-P", ROOT / "bench/cycles/scenes.py", "--",
         build / "penumbra-blender.zip", work, 640, 480, scene], work / "scenes.log",
        env={**os.environ, "BLENDER_USER_SCRIPTS": str(work / "scripts"), "BLENDER_USER_CONFIG": str(work / "config")})
    run([ROOT / "tests/blender/run.sh", "../../bench/cycles/viewport.py", build / "penumbra-blender.zip", build / "penumbra", work / "view",
         work / f"{scene}.blend", asked.seconds, asked.rest, asked.runs], work / "view.log", env={**os.environ, "WINDOW": "1"})
    measured = {**json.loads((work / "view/out/drags.json").read_text()), "loads": [before, os.getloadavg()[0]]}
    kept.write_text(json.dumps(measured))
    return measured


def reached(drag, error):
    """Returns the wall and processor seconds after which pictures stay below this error; None if they never do."""
    found = None
    for when, used, at in drag["after"]:
        if at >= error:
            found = None
        elif found is None:
            found = when, used
    return found


def both(pairs):
    """Returns the medians of wall and processor seconds, as text."""
    return " / ".join(f"{statistics.median(values):.2f}" for values in zip(*pairs))


def cell(drags, error, rest):
    found = [reached(drag, error) for drag in drags]
    if None not in found:
        return both(found)
    last = max(drag["after"][-1][0] for drag in drags)
    return "never" if last < 0.8 * rest else f"not in {rest:g} s"  # never: no new picture came for the rest of the time


def rows_of(scene, measured, rest):
    for (engine, adaptive), name in ENGINES.items():
        for what, moves in MOVES.items():
            drags = [drag for drag in measured["drags"] if (drag["engine"], drag["what"]) == (engine, what)
                     and (engine == "PENUMBRA" or drag["adaptive"] == adaptive)]
            if not drags:
                continue
            pictures = statistics.median(drag["pictures"] / drag["seconds"] for drag in drags)
            exact = both([(drag["final"], drag["after"][-1][1]) for drag in drags]) if engine == "PENUMBRA" else ""
            processor = statistics.median(drag["processor"] / drag["pictures"] for drag in drags)
            error = statistics.median(drag["after"][-1][2] for drag in drags)
            yield [f"{NAMES[scene]}, {moves}: {name}", float(pictures), 1000 * processor,
                   *(cell(drags, one, rest) for one in measured["errors"]), exact, 100 * error]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", default=["large_penumbrae", "dense"], metavar="SCENE", help=", ".join(NAMES))
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument("--seconds", type=float, default=6, help="of a drag")
    parser.add_argument("--rest", type=float, default=40, help="seconds that Cycles is given after the last move")
    parser.add_argument("--runs", type=int, default=3, help="of Penumbra; of Cycles it is one")
    parser.add_argument("--out", type=Path)
    parser.add_argument("--work", type=Path, help="is kept; a scene that was measured there is not measured again")
    asked = parser.parse_args()
    if unknown := set(asked.scenes) - NAMES.keys():
        parser.error(f"no scene {', '.join(sorted(unknown))}; what there is: {', '.join(NAMES)}")
    loads, rows, sizes, least = [], [], set(), []
    with tempfile.TemporaryDirectory() as folder:
        for scene in asked.scenes:
            work = (asked.work or Path(folder)).resolve() / scene
            measured = measure(asked.build.resolve(), scene, work, asked)
            rows += rows_of(scene, measured, asked.rest)
            sizes.add("{} × {}".format(*measured["size"]))
            least.append(measured["least"])
            loads += measured["loads"]
    columns = ["scene, what moves, engine", "pictures a second", "processor ms a picture",
               *(f"to {100 * error:g} %: s / processor s" for error in measured["errors"]), "to the exact picture: s / processor s",
               "error of the last picture, %"]
    formats = [None, ".1f", ".0f", None, None, None, None, ".2f"]
    for row in rows:
        print(" | ".join(f"{value:{form}}" if form else value for value, form in zip(row, formats)))
    if asked.out:
        write(asked, loads, columns, formats, rows, ", ".join(sizes), max(least))


def said(command):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, check=True).stdout.partition("\n")[0]


def write(asked, loads, columns, formats, rows, size, least):
    model = next((line.partition(":")[2].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "a processor")
    result = {
        "title": "Blender's 3D view: answers of Penumbra and of Cycles", "commit": said(["git", "-C", ROOT, "rev-parse", "--short=8", "HEAD"]),
        "machine": f"{model}, {os.cpu_count()} threads that also draw the window (llvmpipe), load {min(loads):.0f} to {max(loads):.0f}",
        "command": f"bench/viewport_latency.py {' '.join(asked.scenes)} --seconds {asked.seconds:g} --rest {asked.rest:g} --runs {asked.runs}",
        "conditions": f"{said(['blender', '--version'])}, a view of {size} pixels; medians of {asked.runs} drags of {asked.seconds:g} s (one of Cycles), "
                      "with sixty moves a second at most. Times are from the last move until a picture below this relative RMSE has been drawn; "
                      "processor seconds are of Blender and of the add-on's child, all threads. The judge is Cycles' own converged crop of "
                      f"64 × 48 pixels full of penumbra (8,192 samples a pixel; {100 * least:.2f} % is the least that can be told). Cycles: "
                      "direct light, its viewport's default of 1,024 samples, adaptive (the default) or not, no denoising, pixels' centres "
                      f"as Penumbra; watched until 1 % or for {asked.rest:g} s; never: the crop had long stopped changing "
                      "by then. Pixels whose neighbours show other planes do not count.",
        "columns": columns, "formats": formats}
    parts = [f' "{key}": {json.dumps(value, ensure_ascii=False)}' for key, value in result.items()]
    rounded = [[round(value, 3) if isinstance(value, float) else value for value in row] for row in rows]
    lines = ",\n".join("  " + json.dumps(row, ensure_ascii=False) for row in rounded)
    asked.out.write_text("{\n" + ",\n".join(parts) + ',\n "rows": [\n' + lines + "\n ]\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
