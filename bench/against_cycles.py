#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Error against processor time and memory of Penumbra and of Blender's Cycles, whole processes from start to file.

    bench/against_cycles.py measure [BUILD [SCENE|PART …]]     renders and measures; writes bench/results/against-cycles.json after each row; takes an hour and a half
    bench/against_cycles.py memory [BUILD]      measures only the memory, for rows that lack it; takes some minutes
    bench/against_cycles.py page [--check]      docs/against-cycles.md, its charts, and the README's sentences, from that file

If scenes or parts are named, other rows are kept. `measure` needs Blender, the built program and the add-on (targets penumbra and penumbra_blender_addon).

Each scene (cycles/scenes.py) is rendered in parts:

centres      one view sample at each pixel's centre
antialiased  under a Blackman-Harris filter of 1.5 pixels, by 16 view samples a pixel of Penumbra
lens         as antialiased, through a thin lens: each of the 16 view samples looks through a different point of the lens
motion       one object moves while the shutter is open, at the pixels' centres, by 16 moments of Penumbra

by four processes: the program from the add-on's exchange file; Blender with the add-on; and Blender with
Cycles, direct light, at several light samples a pixel. They take turns, each several times; a time is the median of user and
system seconds of the process and its children; memory is the largest resident set of one process. The judge is Cycles: a crop
with the most penumbra (in motion: with the most changed pixels) is rendered with many samples under two seeds. An error is the root of the mean squared
difference from their mean, over the crop's mean; the judge's own noise, half the difference of the two seeds, is subtracted in
squares; smaller errors cannot be measured. The ratio of Penumbra's mean over the crop to the judge's is stored, too.

Cycles' error is proportional to one over the square root of its samples, and its time is a constant plus a time per sample. So the
seconds for any other error follow from two measured sample counts.
"""

import contextlib
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
from math import sqrt
from pathlib import Path

import numpy

from animated_glb import add_motion
from processes import processor, usage_of

ROOT = Path(__file__).resolve().parent.parent
HERE = ROOT / "bench/cycles"
RESULT = ROOT / "bench/results/against-cycles.json"
PAGE, README = ROOT / "docs/against-cycles.md", ROOT / "README.md"
CHARTS = {"against-cycles": ("centres", "antialiased"), "against-cycles-blur": ("lens", "motion")}
sys.path[:0] = [str(ROOT / "blender"), str(ROOT / "docs/figures"), str(ROOT / "docs/figures/papers")]

WIDTH, HEIGHT = 640, 480
CROP = 64, 48  # pixels
# Samples per pixel of Cycles, and of the judge for each of two seeds. A picture blurred by 16 samples has a larger
# error, which fewer samples suffice to measure.
CYCLES_SAMPLES = {"centres": (64, 256), "antialiased": (64, 256), "lens": (16, 64), "motion": (16, 64)}
JUDGE_SAMPLES = {"centres": 4096, "antialiased": 4096, "lens": 1024, "motion": 1024}
RUNS = 3
ERRORS = 0.03, 0.01, 0.002
NAMES = {"small": "small lamp", "large_penumbrae": "large penumbrae", "dense": "504k triangles", "four_lamps": "four lamps", "sky": "sky picture"}
PARTS = {"centres": "at pixels' centres", "antialiased": "antialiased, 16 view samples a pixel", "lens": "through a lens, 16 view samples a pixel",
         "motion": "in motion, 16 moments"}
BLURRED = "large_penumbrae", "dense", "four_lamps"  # the scenes of lens and motion
ROWS = [(part, scene) for part in PARTS for scene in (BLURRED if part in ("lens", "motion") else NAMES)]
FRAMES_A_SECOND = 24
# Blender's frame 1 is frame 12 of the file, the middle of a second of animation. Cycles takes the moment of a sample
# from a table of 256 entries, and thus exposes only the first 254 of 256 parts of the shutter's time. This was found by
# measurement: the mean brightness of Cycles and Penumbra differs by 0.2 % over the whole shutter time, but by 0.01 %
# over this part of it (large penumbrae, 64 moments). Penumbra's shutter is therefore open as long as that of Cycles.
SHUTTER = 0.5 * 254 / 256
FRAME = 12 - 0.25 + SHUTTER / 2


class Picture:
    """A file's beauty, and, if it has them, V and each pixel's position and normal (in Blender's axes). The first row
    is at the top."""

    def __init__(self, path):
        from penumbra import exr
        channels = exr.read(Path(path).read_bytes()).channels
        is_ours = "R" in channels
        layer = "" if is_ours else next(name for name in channels if name.endswith("Combined.R")).removesuffix("Combined.R")

        def of(prefix, letters):
            names = [layer + prefix + letter for letter in letters]
            return numpy.stack([channels[name] for name in names], axis=-1).astype(float) if names[0] in channels else None

        self.beauty = of("" if is_ours else "Combined.", "RGB")
        self.shown = [of(name, "XYZ") for name in (("P.", "N.") if is_ours else ("Position.", "Normal."))]
        if is_ours:
            self.shown = [numpy.stack([a[..., 0], -a[..., 2], a[..., 1]], axis=-1) for a in self.shown]
        self.v = channels.get("V")


def same_surface(ours, theirs):
    """Returns the pixels whose centres show the same point of the same surface in both pictures. At an edge, rounding
    decides which surface is shown."""
    near = [numpy.abs(a - b).max(axis=-1) for a, b in zip(ours, theirs)]
    return (near[0] < 2e-3) & (near[1] < 2e-3)


def crop_of_most(wanted):
    """Returns left column and top row of the crop with the largest number of True pixels."""
    total = numpy.pad(wanted.astype(float).cumsum(0).cumsum(1), ((1, 0), (1, 0)))
    w, h = CROP
    inside = total[h:, w:] - total[:-h, w:] - total[h:, :-w] + total[:-h, :-w]
    top, left = numpy.unravel_index(inside.argmax(), inside.shape)
    return int(left), int(top)


class Scene:
    """A scene's files, as written by scenes.py; `facts`: triangles, lens and moving object."""

    def __init__(self, name, facts, work, program, environment):
        self.name, self.facts, self.work, self.program, self.environment = name, facts, work, program, environment
        self.moving = work / f"{name}.moving.glb"
        shutil.copy(work / f"{name}.glb", self.moving)
        add_motion(self.moving, facts["mover"], [FRAMES_A_SECOND * step for step in facts["step"]])

    def blender(self, out, engine, part, samples=0, seed=1, crop=None):
        command = ["blender", "-b", self.work / f"{self.name}.blend", "--python-exit-code", "1", "-P", HERE / "render.py", "--",
                   out, engine, samples, part, seed, self.program]
        if crop is not None:
            (left, top), (w, h) = crop, CROP
            # Blender rounds a border down to pixels: a fortieth of a pixel is added, so rounding errors remove none.
            command += [(left + 0.025) / WIDTH, (left + w + 0.025) / WIDTH,
                        (HEIGHT - top - h + 0.025) / HEIGHT, (HEIGHT - top + 0.025) / HEIGHT]
        return usage_of(command, self.environment)

    def penumbra(self, out, part):
        scene = self.moving if part == "motion" else self.work / f"{self.name}.glb"
        command = [self.program, "render", scene, "-o", out, "--no-studio", "--size", f"{WIDTH}x{HEIGHT}"]
        if part == "motion":
            command += ["--fps", FRAMES_A_SECOND, "--frame", FRAME, "--motion-samples", 16, "--shutter", SHUTTER]
        elif part != "centres":
            command += ["--pixel-samples", 16, "--pixel-filter", "blackman-harris", "--filter-width", 1.5]
        if part == "lens":
            command += ["--aperture", self.facts["aperture"], "--focus-distance", self.facts["focus"]]
        return usage_of(command, self.environment)

    def run(self, engine, out, part):
        if engine == "penumbra":
            return self.penumbra(out, part)
        if engine == "add-on":
            return self.blender(out, "PENUMBRA", part)
        return self.blender(out, "CYCLES", part, engine.split()[1], 3)

    def picture(self, part):
        self.penumbra(self.work / "centre.exr", part)
        return Picture(self.work / "centre.exr")

    def measure(self, part):
        work, (w, h) = self.work, CROP
        centre = self.picture("centres")
        partly = (centre.v > 0) & (centre.v < 1)
        if part == "motion":
            v = self.picture("motion").v
            partly = (v > 0) & (v < 1) & (numpy.abs(v - centre.v) > 0.01)
        left, top = crop = crop_of_most(partly)
        inside = numpy.s_[top:top + h, left:left + w]
        judges = []
        for seed in (1, 2):
            self.blender(work / f"judge{seed}.exr", "CYCLES", part, JUDGE_SAMPLES[part], seed, crop)
            judges.append(Picture(work / f"judge{seed}.exr"))
            if judges[-1].beauty.shape[:2] != (h, w):
                raise SystemExit(f"{self.name}: Blender's crop is {judges[-1].beauty.shape}, not {h} x {w}")
        judged = numpy.full((h, w), True)
        if part in ("centres", "motion"):
            self.blender(work / "still.exr", "CYCLES", "centres", 1, 1, crop)
            judged = same_surface([a[inside] for a in centre.shown], Picture(work / "still.exr").shown)
        first, second = (one.beauty[judged] for one in judges)
        judge = (first + second) / 2
        noise = sqrt(numpy.mean((first - second) ** 2)) / 2

        entries = {}
        engines = ["penumbra", "add-on", *(f"cycles {samples}" for samples in CYCLES_SAMPLES[part])]
        for run in range(RUNS):
            for engine in engines:
                if engine == engines[-1] and run > 0:
                    continue  # one run is enough: it takes minutes, and varies little
                out = work / "picture.exr"
                out.unlink(missing_ok=True)
                usage = self.run(engine, out, part)
                entry = entries.setdefault(engine, {"entry": engine, "runs": [], "memories": []})
                entry["runs"].append(round(usage.seconds, 3))
                entry["memories"].append(round(usage.mebibytes))
                if run == 0:
                    part_of = Picture(out).beauty[inside][judged]
                    entry["error"] = sqrt(max(numpy.mean((part_of - judge) ** 2) - noise ** 2, 0)) / judge.mean()
                    entry["meanRatio"] = part_of.mean() / judge.mean()
                print(f"{self.name} {part}: {engine}: {usage.seconds:.2f} s, {usage.mebibytes:.0f} MiB, error {entry['error']:.5f}, "
                      f"mean over the judge's {entry['meanRatio']:.5f}", flush=True)
        for entry in entries.values():
            entry |= {"seconds": statistics.median(entry["runs"]), "mebibytes": statistics.median(entry.pop("memories"))}
        return {"scene": self.name, "part": part, "crop": [left, top, w, h], "judgedPixels": int(judged.sum()),
                "judgeSamples": 2 * JUDGE_SAMPLES[part], "leastError": noise / judge.mean(),
                "entries": list(entries.values())}


def state():
    """Commit, machine and Blender of a measurement."""
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short=8", "HEAD"], capture_output=True, text=True, check=True).stdout.strip()
    blender = subprocess.run(["blender", "--version"], capture_output=True, text=True, check=True).stdout.split("\n")[0]
    return {"commit": commit, "machine": processor(), "blender": blender}


@contextlib.contextmanager
def made(build, names):
    """Yields the scenes by name, written to a temporary folder."""
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        environment = {**os.environ, "BLENDER_USER_SCRIPTS": str(work / "scripts"), "BLENDER_USER_CONFIG": str(work / "config")}
        (work / "scripts").mkdir()
        usage_of(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "-P", HERE / "scenes.py", "--",
                  build / "penumbra-blender.zip", work, WIDTH, HEIGHT, *names], environment)
        yield {name: Scene(name, json.loads((work / f"{name}.json").read_text()), work, build / "penumbra", environment) for name in names}


def measure(build, wanted):
    """Measures the rows of these scenes and parts, and writes each as soon as it is measured."""
    unknown = set(wanted) - set(NAMES) - set(PARTS)
    if unknown:
        raise SystemExit(f"{', '.join(unknown)}: scenes are {', '.join(NAMES)}; parts are {', '.join(PARTS)}")
    scenes, parts = set(wanted) & set(NAMES) or set(NAMES), set(wanted) & set(PARTS) or set(PARTS)
    asked = [(part, scene) for part, scene in ROWS if part in parts and scene in scenes]
    with made(build, list(dict.fromkeys(scene for _, scene in asked))) as all_scenes:
        for part, scene in asked:
            now = state()
            row = all_scenes[scene].measure(part) | {"measured": {"commit": now["commit"], "machine": now["machine"], "threads": os.cpu_count(),
                                                                  "load": [round(x, 1) for x in os.getloadavg()]}}
            keep(row, all_scenes[scene].facts["triangles"], now)


def measure_memory(build):
    """Adds the largest resident set to rows that lack it, by one run of each entry, except Cycles with many samples,
    which needs as much memory as with few."""
    data = json.loads(RESULT.read_text())
    asked = [row for row in data["rows"] if not any("mebibytes" in entry for entry in row["entries"])]
    with made(build, list(dict.fromkeys(row["scene"] for row in asked))) as all_scenes:
        for row in asked:
            scene = all_scenes[row["scene"]]
            for entry in row["entries"]:
                if entry["entry"] == f"cycles {max(CYCLES_SAMPLES[row['part']])}":
                    continue
                entry["mebibytes"] = round(scene.run(entry["entry"], scene.work / "picture.exr", row["part"]).mebibytes)
                print(f"{row['scene']} {row['part']}: {entry['entry']}: {entry['mebibytes']} MiB", flush=True)
            row["memoryMeasured"] = {"commit": state()["commit"]}
            RESULT.write_text(json.dumps(data, indent=1) + "\n")


def keep(row, triangles, now):
    """Adds one row to the file of results, or replaces it."""
    data = json.loads(RESULT.read_text()) if RESULT.exists() else {"rows": [], "triangles": {}}
    rows = {(one["part"], one["scene"]): one for one in (*data["rows"], row)}
    data.pop("judgeSamples", None)
    data |= {"title": "error against processor seconds, beside Cycles", "command": "bench/against_cycles.py measure", **now, "size": [WIDTH, HEIGHT],
             "triangles": data["triangles"] | {row["scene"]: triangles}, "rows": [rows[at] for at in ROWS if at in rows]}
    RESULT.write_text(json.dumps(data, indent=1) + "\n")


class Line:
    """Cycles' seconds and error as functions of its samples, fitted to two measured sample counts."""

    def __init__(self, row):
        entries = {int(name.split()[1]): entry for entry in row["entries"] if (name := entry["entry"]).startswith("cycles")}
        (few, low), (many, high) = sorted(entries.items())
        self.counts, self.each = (few, many), (high["seconds"] - low["seconds"]) / (many - few)
        self.start = low["seconds"] - self.each * few
        self.most_error, self.least_seconds = low["error"], low["seconds"]  # measured
        # error = unit / sqrt(samples): the geometric mean of the two values of `unit`
        self.unit = sqrt(low["error"] * high["error"]) * (few * many) ** 0.25

    def seconds(self, error):
        return self.start + self.each * max(1, (self.unit / error) ** 2)

    def factor(self, error, ours):
        """Returns how many times as long as `ours` Cycles takes, as text. For errors larger than that at the fewest
        measured samples it is a bound, since the time of a process without samples is a small difference of large
        times."""
        if error > self.most_error:
            return f"≤ {number(self.least_seconds / ours)}"
        return number(self.seconds(error) / ours)


def number(value):
    return f"{value:.2f}" if value < 10 else f"{value:.1f}" if value < 100 else f"{value:,.0f}"


def at_own_error(row):
    """Returns how many times as long Cycles takes for the error of Penumbra's picture; a bound if that error is below
    the judge's noise."""
    ours = next(entry for entry in row["entries"] if entry["entry"] == "penumbra")
    bound = "" if ours["error"] > row["leastError"] else "≥ "
    return bound + Line(row).factor(max(ours["error"], row["leastError"]), ours["seconds"])


def memory(entries, name):
    return f"{entries[name]['mebibytes']:,.0f}" if "mebibytes" in entries.get(name, {}) else "–"


def table(rows):
    few, many = CYCLES_SAMPLES[rows[0]["part"]]
    yield (f"| scene | Penumbra, s | through the add-on | its error | Cycles {few}: error / s | Cycles {many}: error / s | times as long in Cycles: 3 %, 1 %, 0.2 % "
           "| to Penumbra's error | MiB: Penumbra, add-on, Cycles | commit, load |")
    yield "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
    for row in rows:
        entries = {entry["entry"]: entry for entry in row["entries"]}
        ours, line = entries["penumbra"], Line(row)
        own = f"{ours['error']:.5f}" if ours["error"] > row["leastError"] else f"≤ {row['leastError']:.5f}"
        cycles = " | ".join(f"{entries[f'cycles {samples}']['error']:.4f} / {number(entries[f'cycles {samples}']['seconds'])}" for samples in line.counts)
        # Both reach an error only if it is not below ours.
        factors = ", ".join(line.factor(error, ours["seconds"]) if error >= ours["error"] else "–" for error in ERRORS)
        through = number(entries["add-on"]["seconds"]) if "add-on" in entries else "–"
        memories = ", ".join(memory(entries, name) for name in ("penumbra", "add-on", f"cycles {few}"))
        yield (f"| {NAMES[row['scene']]} | {number(ours['seconds'])} | {through} | {own} | {cycles} | {factors} | {at_own_error(row)} | {memories} "
               f"| {row['measured']['commit']}, {row['measured']['load'][0]} |")


def summary(rows):
    """Yields the lines of a table: how many times as long Cycles takes to Penumbra's error, one column per part, and
    the largest memory of each."""
    yield f"| scene | {' | '.join(PARTS)} | MiB: Penumbra, Cycles |"
    yield "| --- |" + " --- |" * (len(PARTS) + 1)
    found = {(row["scene"], row["part"]): row for row in rows}
    for scene, name in NAMES.items():
        cells = [at_own_error(found[scene, part]) if (scene, part) in found else "–" for part in PARTS]
        most = [max((entry["mebibytes"] for (at, _), row in found.items() if at == scene for entry in row["entries"]
                     if entry["entry"].startswith(kind) and "mebibytes" in entry), default=None) for kind in ("penumbra", "cycles")]
        yield f"| {name} | {' | '.join(cells)} | {', '.join('–' if one is None else f'{one:,.0f}' for one in most)} |"


def chart(data, parts):
    """Draws Cycles' curves, with four times as many samples at each mark as at the previous one, and Penumbra's
    separate marks."""
    from chart import STYLES, Chart, key, mark
    from drawing import Drawing
    d = Drawing(980, 440, "Error against processor time: Penumbra and Cycles")
    xs, ys = (0.1, 1000), (1e-4, 0.3)
    shown = []
    for column, part in enumerate(parts):
        plot = Chart(d, (70 + 470 * column, 40, 400, 300), xs, ys, PARTS[part], "processor seconds of the whole process",
                     "" if column else "error", True, True, (0.1, 1, 10, 100, 1000), (1e-4, 1e-3, 1e-2, 1e-1))
        for row in data["rows"]:
            if row["part"] != part:
                continue
            style = list(NAMES).index(row["scene"])
            shown.append(style)
            line, count, points = Line(row), Line(row).counts[0], []
            while line.start + line.each * count <= xs[1]:
                points.append((line.start + line.each * count, line.unit / sqrt(count)))
                count *= 4
            plot.curve(points, style)
            ours = next(entry for entry in row["entries"] if entry["entry"] == "penumbra")
            at = plot.at(max(ours["seconds"], xs[0]), max(ours["error"], row["leastError"], ys[0]))
            d.circle(at, 8, None, STYLES[style][0], 1.6)
            mark(d, at, *STYLES[style])
    key(d, (70, 405), [(style, NAMES[list(NAMES)[style]]) for style in sorted(set(shown))], 180)
    d.text((70, 430), "Ringed: Penumbra. Curves: Cycles; from mark to mark four times the light samples, through two counts that were measured.", 12)
    return d.finish()


PAGE_TEXT = """# Error against time, beside Cycles

Whole processes, from start to file: Penumbra's program, Blender with Penumbra's add-on, and Blender with Cycles (direct light, no
denoising). The tables and the charts are generated from `bench/results/against-cycles.json`, which `bench/against_cycles.py measure`
writes; that script's head says how errors, times and memory are taken.

![error against processor seconds](images/against-cycles.svg)

How many times as long Cycles takes to reach the error of Penumbra's picture, at pixels' centres, antialiased, through a lens and in motion, and the most memory that
each took in these pictures ("≥": Penumbra's error is below what the judge can tell; "≤": Cycles' fewest samples have less error; "–": not measured):

{summary}

{machine}, {blender}, {size[0]} × {size[1]} pixels; each row has the commit of the program and the load of the machine at its end. Under the sky picture
Penumbra takes 256 directions, the add-on's own choice. Times are processor seconds (user and system, medians of {runs}; one run of Cycles'
larger count), so another process on the machine changes them less than the clock. Memory is the largest resident set of one process: Blender with the add-on has the program
as its child, and the larger of the two counts. Rows at pixels' centres and antialiased that have an older commit got their memory at {memory_commit}. The error is relative RMSE over a crop of {crop[2]} × {crop[3]} pixels full of penumbra, against Cycles with
8,192 samples a pixel (lens and motion: 2,048); "≤": below the judge's own noise. *Times as long* extrapolates Cycles' error by one over
the root of its samples, to more samples than the fewer measured ones only ("≤" for less); "–": an error that Penumbra's picture does not reach.

## At pixels' centres

{centres}

## Antialiased

Blackman-Harris filter of 1.5 pixels; Penumbra takes 16 view samples a pixel (`--pixel-samples 16 --pixel-filter blackman-harris`).

{antialiased}

## Through a lens

![error against processor seconds through a lens and in motion](images/against-cycles-blur.svg)

As antialiased, through a thin lens at f/0.25 that is sharp at 5.5 m: the scenes are metres wide, and at f/2 they would be sharp all over. The program gets
`--aperture` and `--focus-distance`; the add-on takes both from Blender's camera. Each of 16 view samples has its own point of the lens and is evaluated: nothing
is interpolated, and what is out of focus is noisy.

{lens}

## In motion

One object moves by a quarter of a metre while the shutter is open, at even speed, seen at pixels' centres; the crop is where most shadow moves. The program
takes 16 moments (`--motion-samples 16`) of an exchange file to which an animation was added; the add-on lets Blender evaluate as many moments ([how](blender.md#motion-blur)). Cycles
exposes 254 of 256 parts of the shutter time that it is given, counted from the start (found by measuring), and Penumbra's shutter is open for the same time.

{motion}
"""


BLOCK = re.compile(r"(<!-- results/against-cycles\.json -->\n).*?(<!-- end -->)", re.S)


def at_one_percent(rows):
    """Returns how many times as long Cycles takes for an error of 1 %, for each scene whose picture by Penumbra reaches
    it, without bounds ("≤")."""
    for row in rows:
        ours = next(entry for entry in row["entries"] if entry["entry"] == "penumbra")
        times = Line(row).factor(0.01, ours["seconds"])
        if ours["error"] <= 0.01 and not times.startswith("≤"):
            yield row["scene"], float(times.replace(",", ""))


def readme_sentences(data):
    centres, filtered = (dict(at_one_percent([row for row in data["rows"] if row["part"] == part])) for part in ("centres", "antialiased"))
    lamps = max(times for scene, times in centres.items() if scene != "sky")
    return (f"![error against processor seconds, Penumbra and Cycles](docs/images/against-cycles.svg)\n\n"
            f"At an error of 1 % and without antialiasing, Cycles takes up to {lamps:.0f} times the processor time under lamps, and {centres['sky']:.0f} times under the "
            f"picture of a sky. With 16\nview samples a pixel it takes {min(filtered.values()):.1f} to {max(filtered.values()):.0f} times as much "
            "([scenes, errors, times, memory](docs/against-cycles.md)).\n")


def page(check):
    data = json.loads(RESULT.read_text())
    memory_commit = ", ".join(dict.fromkeys(row["memoryMeasured"]["commit"] for row in data["rows"] if "memoryMeasured" in row))
    text = PAGE_TEXT.format(**data, runs=RUNS, memory_commit=memory_commit, crop=data["rows"][0]["crop"], summary="\n".join(summary(data["rows"])), **{
        part: "\n".join(table([row for row in data["rows"] if row["part"] == part])) for part in PARTS})
    stale = False
    readme, blocks = BLOCK.subn(lambda found: found[1] + readme_sentences(data) + found[2], README.read_text())
    if blocks != 1:
        raise SystemExit(f"README.md has {blocks} blocks of results/against-cycles.json")
    charts = [(ROOT / f"docs/images/{name}.svg", chart(data, parts)) for name, parts in CHARTS.items()]
    for path, content in ((PAGE, text), *charts, (README, readme)):
        if not check:
            path.write_text(content)
        elif not path.exists() or path.read_text() != content:
            print(f"{path.relative_to(ROOT)} is not what bench/against_cycles.py page writes")
            stale = True
    return int(stale)


def main():
    command, *rest = sys.argv[1:] or [""]
    if command == "measure":
        measure(Path(rest[0] if rest else ROOT / "build").resolve(), rest[1:] or list(NAMES))
    elif command == "memory":
        measure_memory(Path(rest[0] if rest else ROOT / "build").resolve())
    elif command == "page":
        raise SystemExit(page("--check" in rest))
    else:
        raise SystemExit(__doc__)


if __name__ == "__main__":
    main()
