#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Error against processor time of Penumbra and of Blender's Cycles, whole processes from start to file.

    bench/against_cycles.py measure [BUILD [SCENE …]]     renders and measures; writes bench/results/against-cycles.json; an hour
    bench/against_cycles.py page [--check]      docs/against-cycles.md, its chart, and the README's sentences, from that file

With scenes named, rows of others stay as they are. `measure` needs Blender, the built program and the add-on (targets penumbra and penumbra_blender_addon).

Each scene (cycles/scenes.py) is rendered at its pixels' centres, and antialiased under a Blackman-Harris filter of 1.5 pixels, by
four processes: the program from the add-on's exchange file; Blender with the add-on; and Blender with Cycles, direct light, at
several light samples a pixel. They take turns, each several times; a time is the median of user and system seconds of
the process and its children. The judge is Cycles: a crop that holds the most penumbra is rendered with many samples under two
seeds. An error is the root of the mean squared difference from their mean, over the crop's mean; the judge's own noise, half the
difference of the two seeds, is taken off in squares, and is the least that can be told.

Cycles' error falls as one over the root of its samples, and its time is a constant and a share for each sample: so the
seconds for an error that was not measured follow from two measured counts.
"""

import json
import os
import platform
import re
import statistics
import subprocess
import sys
import tempfile
from math import sqrt
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parent.parent
HERE = ROOT / "bench/cycles"
RESULT = ROOT / "bench/results/against-cycles.json"
PAGE, CHART, README = ROOT / "docs/against-cycles.md", ROOT / "docs/images/against-cycles.svg", ROOT / "README.md"
sys.path[:0] = [str(ROOT / "blender"), str(ROOT / "docs/figures"), str(ROOT / "docs/figures/papers")]

WIDTH, HEIGHT = 640, 480
CROP = 64, 48  # pixels
CYCLES_SAMPLES = 64, 256
JUDGE_SAMPLES = 4096  # for each of two seeds
RUNS = 3
ERRORS = 0.03, 0.01, 0.002
NAMES = {"small": "small lamp", "large_penumbrae": "large penumbrae", "dense": "504k triangles", "four_lamps": "four lamps", "sky": "sky picture"}


def processor_seconds(command, environment, log):
    """Runs `command`; user and system seconds of the process and of all descendants that were waited for."""
    with open(log, "wb") as out:
        process = subprocess.Popen([str(part) for part in command], stdin=subprocess.DEVNULL, stdout=out, stderr=out, env=environment)
        _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}: exit code {process.returncode}\n{Path(log).read_text(errors='replace')[-2000:]}")
    return usage.ru_utime + usage.ru_stime


class Picture:
    """A file's beauty, and where it has them V and what each pixel shows (position, normal), as Blender has its axes. Rows
    from the top."""

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
    """Pixels whose centres show one point of one surface. At an edge it is decided by roundings which of two is shown."""
    near = [numpy.abs(a - b).max(axis=-1) for a, b in zip(ours, theirs)]
    return (near[0] < 2e-3) & (near[1] < 2e-3)


def crop_of_most_penumbra(v):
    """Left column and top row of the crop that holds the most pixels with 0 < V < 1."""
    partly = ((v > 0) & (v < 1)).astype(float)
    total = numpy.pad(partly.cumsum(0).cumsum(1), ((1, 0), (1, 0)))
    w, h = CROP
    inside = total[h:, w:] - total[:-h, w:] - total[h:, :-w] + total[:-h, :-w]
    top, left = numpy.unravel_index(inside.argmax(), inside.shape)
    return int(left), int(top)


class Scene:
    def __init__(self, name, work, program, environment):
        self.name, self.work, self.program, self.environment = name, work, program, environment
        self.log = work / "log"

    def blender(self, out, engine, samples=0, antialiased=False, seed=1, crop=None):
        command = ["blender", "-b", self.work / f"{self.name}.blend", "--python-exit-code", "1", "-P", HERE / "render.py", "--",
                   out, engine, samples, int(antialiased), seed, self.program]
        if crop is not None:
            (left, top), (w, h) = crop, CROP
            # Blender rounds a border down to pixels: a fortieth of a pixel more keeps rounding errors from taking one away.
            command += [(left + 0.025) / WIDTH, (left + w + 0.025) / WIDTH,
                        (HEIGHT - top - h + 0.025) / HEIGHT, (HEIGHT - top + 0.025) / HEIGHT]
        return processor_seconds(command, self.environment, self.log)

    def penumbra(self, out, antialiased):
        command = [self.program, "render", self.work / f"{self.name}.glb", "-o", out, "--no-studio", "--size", f"{WIDTH}x{HEIGHT}"]
        if antialiased:
            command += ["--pixel-samples", 16, "--pixel-filter", "blackman-harris", "--filter-width", 1.5]
        return processor_seconds(command, self.environment, self.log)

    def measure(self, antialiased):
        work, (w, h) = self.work, CROP
        self.penumbra(work / "centre.exr", False)
        centre = Picture(work / "centre.exr")
        left, top = crop = crop_of_most_penumbra(centre.v)
        inside = numpy.s_[top:top + h, left:left + w]
        judges = []
        for seed in (1, 2):
            self.blender(work / f"judge{seed}.exr", "CYCLES", JUDGE_SAMPLES, antialiased, seed, crop)
            judges.append(Picture(work / f"judge{seed}.exr"))
            if judges[-1].beauty.shape[:2] != (h, w):
                raise SystemExit(f"{self.name}: Blender's crop is {judges[-1].beauty.shape}, not {h} x {w}")
        judged = numpy.full((h, w), True)
        if not antialiased:
            judged = same_surface([a[inside] for a in centre.shown], judges[0].shown)
        first, second = (one.beauty[judged] for one in judges)
        judge = (first + second) / 2
        noise = sqrt(numpy.mean((first - second) ** 2)) / 2

        def error_of(path):
            part = Picture(path).beauty[inside][judged]
            return sqrt(max(numpy.mean((part - judge) ** 2) - noise ** 2, 0)) / judge.mean()

        seconds, errors = {}, {}
        for run in range(RUNS):
            for engine in ("penumbra", "add-on", *(f"cycles {samples}" for samples in CYCLES_SAMPLES)):
                if engine == f"cycles {CYCLES_SAMPLES[-1]}" and run > 0:
                    continue  # minutes; its share a sample is what is wanted, and is large against what varies
                out = work / "picture.exr"
                out.unlink(missing_ok=True)
                if engine == "penumbra":
                    time = self.penumbra(out, antialiased)
                elif engine == "add-on":
                    time = self.blender(out, "PENUMBRA", antialiased=antialiased)
                else:
                    time = self.blender(out, "CYCLES", engine.split()[1], antialiased, 3)
                seconds.setdefault(engine, []).append(round(time, 3))
                errors.setdefault(engine, error_of(out))
                print(f"{self.name} {'antialiased' if antialiased else 'centres'}: {engine}: {time:.2f} s, error {errors[engine]:.5f}", flush=True)
        return {"scene": self.name, "antialiased": antialiased, "crop": [left, top, w, h], "judgedPixels": int(judged.sum()), "leastError": noise / judge.mean(),
                "entries": [{"entry": engine, "seconds": statistics.median(times), "runs": times, "error": errors[engine]}
                            for engine, times in seconds.items()]}


def measure(build, names):
    git = lambda *arguments: subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True).stdout.strip()
    blender = subprocess.run(["blender", "--version"], capture_output=True, text=True, check=True).stdout.split("\n")[0]
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        environment = {**os.environ, "BLENDER_USER_SCRIPTS": str(work / "scripts"), "BLENDER_USER_CONFIG": str(work / "config")}
        (work / "scripts").mkdir()
        program = build / "penumbra"
        processor_seconds(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "-P", HERE / "scenes.py", "--",
                           build / "penumbra-blender.zip", work, WIDTH, HEIGHT, *names], environment, work / "log")
        triangles = {line.split()[1]: int(line.split()[2]) for line in (work / "log").read_text().splitlines() if line.startswith("scene: ")}
        rows = [Scene(name, work, program, environment).measure(antialiased) for name in names for antialiased in (False, True)]
    state = {"commit": git("rev-parse", "--short", "HEAD"), "machine": processor(), "threads": os.cpu_count(),
             "load": [round(x, 1) for x in os.getloadavg()]}
    data = {"title": "error against processor seconds, beside Cycles", "command": "bench/against_cycles.py measure", **state, "blender": blender,
            "size": [WIDTH, HEIGHT], "judgeSamples": 2 * JUDGE_SAMPLES, "triangles": triangles, "rows": rows}
    if set(names) != set(NAMES):
        kept = json.loads(RESULT.read_text())
        measured = {(row["scene"], row["antialiased"]): row | {"measured": state} for row in rows}
        old = {(row["scene"], row["antialiased"]): row for row in kept["rows"]}
        data = kept | {"triangles": kept["triangles"] | triangles,
                       "rows": [row for name in NAMES for antialiased in (False, True) if (row := (old | measured).get((name, antialiased)))]}
    RESULT.write_text(json.dumps(data, indent=1) + "\n")


def processor():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return platform.processor()


class Line:
    """Cycles' seconds and error over its samples, through two measured counts."""

    def __init__(self, row):
        entries = {entry["entry"]: entry for entry in row["entries"]}
        low, high = (entries[f"cycles {samples}"] for samples in CYCLES_SAMPLES)
        self.each = (high["seconds"] - low["seconds"]) / (CYCLES_SAMPLES[1] - CYCLES_SAMPLES[0])
        self.start = low["seconds"] - self.each * CYCLES_SAMPLES[0]
        self.most_error, self.least_seconds = low["error"], low["seconds"]  # measured
        # error = unit / sqrt(samples): the geometric mean of what both counts say of unit
        self.unit = sqrt(low["error"] * high["error"]) * (CYCLES_SAMPLES[0] * CYCLES_SAMPLES[1]) ** 0.25

    def seconds(self, error):
        return self.start + self.each * max(1, (self.unit / error) ** 2)

    def factor(self, error, ours):
        """Returns how many times as long as `ours` Cycles takes, as text: for more error than at the fewest measured samples a bound, since
        what a process costs without samples is a small difference of large times."""
        if error > self.most_error:
            return f"≤ {number(self.least_seconds / ours)}"
        return number(self.seconds(error) / ours)


def number(value):
    return f"{value:.2f}" if value < 10 else f"{value:.1f}" if value < 100 else f"{value:,.0f}"


def table(rows):
    yield "| scene | Penumbra | through the add-on | its error | Cycles 64: error / s | Cycles 256: error / s | 3 %, 1 %, 0.2 %: times as long in Cycles |"
    yield "| --- | --- | --- | --- | --- | --- | --- |"
    for row in rows:
        entries = {entry["entry"]: entry for entry in row["entries"]}
        ours, line = entries["penumbra"], Line(row)
        error = f"{ours['error']:.5f}" if ours["error"] > row["leastError"] else f"≤ {row['leastError']:.5f}"
        cycles = " | ".join(f"{entries[f'cycles {samples}']['error']:.4f} / {number(entries[f'cycles {samples}']['seconds'])}" for samples in CYCLES_SAMPLES)
        # An error below what ours has is nothing that both reach.
        factors = ", ".join(line.factor(error, ours["seconds"]) if error >= ours["error"] else "–" for error in ERRORS)
        later = f" ({row['measured']['commit']}, load {row['measured']['load'][0]})" if "measured" in row else ""
        yield f"| {NAMES[row['scene']]}{later} | {number(ours['seconds'])} | {number(entries['add-on']['seconds'])} | {error} | {cycles} | {factors} |"


def chart(data):
    """The curves are Cycles', each mark on them four times the samples of the one before; the marks apart are Penumbra's."""
    from chart import STYLES, Chart, key, mark
    from drawing import Drawing
    d = Drawing(980, 440, "Error against processor time: Penumbra and Cycles")
    xs, ys = (0.1, 1000), (1e-4, 0.3)
    for column, antialiased in enumerate((False, True)):
        title = "antialiased, 16 view samples a pixel" if antialiased else "at pixels' centres"
        plot = Chart(d, (70 + 470 * column, 40, 400, 300), xs, ys, title, "processor seconds of the whole process",
                     "" if antialiased else "error", True, True, (0.1, 1, 10, 100, 1000), (1e-4, 1e-3, 1e-2, 1e-1))
        for style, row in enumerate(row for row in data["rows"] if row["antialiased"] == antialiased):
            entries = {entry["entry"]: entry for entry in row["entries"]}
            line = Line(row)
            counts = [4 ** k for k in range(3, 9) if line.start + line.each * 4 ** k <= xs[1]]
            plot.curve([(line.start + line.each * count, line.unit / sqrt(count)) for count in counts], style)
            ours = entries["penumbra"]
            at = plot.at(max(ours["seconds"], xs[0]), max(ours["error"], row["leastError"], ys[0]))
            d.circle(at, 8, None, STYLES[style][0], 1.6)
            mark(d, at, *STYLES[style])
    key(d, (70, 405), list(enumerate(NAMES[row["scene"]] for row in data["rows"] if not row["antialiased"])), 180)
    d.text((70, 430), "Ringed: Penumbra. Curves: Cycles, 64 and 256 light samples a pixel, measured, and 1,024 … computed from these.", 12)
    return d.finish()


PAGE_TEXT = """# Error against time, beside Cycles

Whole processes, from start to file: Penumbra's program, Blender with Penumbra's add-on, and Blender with Cycles (direct light, no
denoising). The tables and the chart are generated from `bench/results/against-cycles.json`, which `bench/against_cycles.py measure`
writes; that script's head says how errors and times are taken.

![error against processor seconds](images/against-cycles.svg)

Commit {commit}, {machine}, {threads} threads, load {load[0]} at the end, {blender}, {size[0]} × {size[1]} pixels; a scene that was
measured later has its own commit and load. Under the sky picture Penumbra asks 256 directions, as its add-on does by itself. Times are
processor seconds (user and system, medians of {runs}), so another process on the machine changes them less than the clock. The error is
relative RMSE over a crop of {crop[2]} × {crop[3]} pixels full of penumbra, against Cycles with {judgeSamples} samples a pixel; "≤": below the
judge's own noise. The last column extrapolates Cycles' error by one over the root of its samples, to more samples than 64 only ("≤" for fewer);
"–": an error that Penumbra's picture does not reach.

## At pixels' centres

{centres}

## Antialiased

Blackman-Harris filter of 1.5 pixels; Penumbra takes 16 view samples a pixel (`--pixel-samples 16 --pixel-filter blackman-harris`).

{antialiased}
"""


BLOCK = re.compile(r"(<!-- results/against-cycles\.json -->\n).*?(<!-- end -->)", re.S)


def at_one_percent(rows):
    """How many times as long Cycles takes for an error of 1 %, for each scene whose picture by Penumbra reaches it. Bounds ("≤") are left out."""
    for row in rows:
        ours = next(entry for entry in row["entries"] if entry["entry"] == "penumbra")
        times = Line(row).factor(0.01, ours["seconds"])
        if ours["error"] <= 0.01 and not times.startswith("≤"):
            yield row["scene"], float(times.replace(",", ""))


def readme_sentences(data):
    centres, filtered = (dict(at_one_percent([row for row in data["rows"] if row["antialiased"] == antialiased])) for antialiased in (False, True))
    lamps = max(times for scene, times in centres.items() if scene != "sky")
    return (f"At an error of 1 % and without antialiasing, Cycles takes up to {lamps:.0f} times the processor time under lamps, and {centres['sky']:.0f} times under the "
            f"picture of a sky. With 16\nview samples a pixel it takes {min(filtered.values()):.1f} to {max(filtered.values()):.0f} times as much "
            "([scenes, errors and times](docs/against-cycles.md)).\n")


def page(check):
    data = json.loads(RESULT.read_text())
    text = PAGE_TEXT.format(**data, runs=RUNS, crop=data["rows"][0]["crop"], **{
        name: "\n".join(table([row for row in data["rows"] if row["antialiased"] == antialiased]))
        for name, antialiased in (("centres", False), ("antialiased", True))})
    stale = False
    readme, blocks = BLOCK.subn(lambda found: found[1] + readme_sentences(data) + found[2], README.read_text())
    if blocks != 1:
        raise SystemExit(f"README.md has {blocks} blocks of results/against-cycles.json")
    for path, content in ((PAGE, text), (CHART, chart(data)), (README, readme)):
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
    elif command == "page":
        raise SystemExit(page("--check" in rest))
    else:
        raise SystemExit(__doc__)


if __name__ == "__main__":
    main()
