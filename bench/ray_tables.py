# SPDX-License-Identifier: Apache-2.0
"""Tables of bench/README.md that compare exact methods with ray casters: runs of penumbra-bench on the shipped scenes. All of them take about 45 minutes on
two idle cores. Uses Python's standard library alone."""

import json
import re
import statistics
import time
from itertools import groupby

from measured_tables import ROOT, Table

SAMPLES = ("256", "1024", "4096")
RUNS = ("--runs", "3", "--budget", "4")
LIGHTS = ("disk", "ellipse", "polygon", "sphere", "sun")
AREA_SCENES = ("bunny", "thin", "room", "self-shadow", "large-penumbra", "textured-light", "fusion", "contact", "broken", "parallel-square")
HOW = "512 × 512 pixels, on the processor; medians of up to three runs in turns after one that is discarded."


def repeated(option, values):
    return tuple(word for value in values for word in (option, value))


def lines(bench, *options):
    """The lines of a run of penumbra-bench by their names, such as bunny/half=0.3/n=256/edge-scatter. Tables that ask for the same run share it."""
    if options not in bench.done:
        print("penumbra-bench", *options, flush=True)
        bench.done[options] = {line["name"]: line for line in bench.lines(*options)}
    return bench.done[options]


def shipped(bench):
    return lines(bench, "--all", *repeated("--light-samples", SAMPLES), "--peer", "nontrivial-rays", "--peer", "adaptive-rays", *RUNS)


def subjects(found):
    """Names without number of light samples and method, in their order."""
    return list(dict.fromkeys(name.partition("/n=")[0] for name in found))


def seconds(found, name):
    return found[name]["shadow"]["median"]


def over(found, subject, peer, method):
    """How many times longer the peer takes."""
    return seconds(found, f"{subject}/{peer}") / seconds(found, f"{subject}/{method}") if f"{subject}/{peer}" in found else None


def light_sample_rows(bench):
    found = shipped(bench)
    for half, subject in (("0.3", "bunny/half=0.3"), ("1", "bunny"), ("2", "bunny/half=2")):
        for count in SAMPLES:
            at = f"{subject}/n={count}"
            yield (half, int(count), seconds(found, f"{at}/edge-scatter"), *(over(found, at, f"{peer}-rays", "edge-scatter") for peer in ("plain", "nontrivial", "adaptive")),
                   seconds(found, f"{at}/view-sample"), *(over(found, at, f"{peer}-rays", "view-sample") for peer in ("plain", "nontrivial")))


def scene_rows(bench):
    found = shipped(bench)
    for subject in subjects(found):
        row = [subject]
        for at in (f"{subject}/n={count}" for count in SAMPLES):
            row += [seconds(found, f"{at}/edge-scatter"), over(found, at, "plain-rays", "edge-scatter"), over(found, at, "nontrivial-rays", "edge-scatter")]
        yield row


def pair_rows(bench):
    """Pairs on which a method differs from the oracle. Both methods decide exactly, so they must differ on the same number."""
    found, total = shipped(bench), [0, 0]
    for subject in subjects(found):
        row = [subject]
        for count in SAMPLES:
            line, other = (found[f"{subject}/n={count}/{method}"] for method in ("edge-scatter", "view-sample"))
            if (line["pairsAll"], line["pairsDiffering"]) != (other["pairsAll"], other["pairsDiffering"]):
                raise SystemExit(f"{line['name']} and {other['name']} differ from raytrace on different numbers of pairs")
            row += [line["pairsAll"], line["pairsDiffering"]]
            total = [total[0] + line["pairsAll"], total[1] + line["pairsDiffering"]]
        yield row
    yield ["all", *[None] * 4, *total]


def light_rows(bench):
    counts = repeated("--light-samples", SAMPLES)
    peers = ("--method", "edge-scatter", "--peer", "nontrivial-rays", *RUNS)
    runs = [("--scene", "bunny", *repeated("--light", LIGHTS)), ("--scene", "bunny", "--sample-pattern", "sobol"),
            ("--scene", "bunny", "--light", "disk", "--sample-pattern", "sobol"), ("--scene", "thin", *repeated("--light", ("disk", "sphere", "sun"))),
            ("--scene", "large-penumbra", "--light", "sphere")]
    for options in runs:
        found = lines(bench, *options, *counts, *peers)
        for subject in subjects(found):
            scene, *asked = subject.split("/")
            asked = dict(part.split("=") for part in asked)
            row = [scene, {"polygon": "hexagon"}.get(asked.get("light"), asked.get("light", "rectangle")), asked.get("pattern", "rows")]
            for count in SAMPLES:
                row += [over(found, f"{subject}/n={count}", f"{peer}-rays", "edge-scatter") for peer in ("plain", "nontrivial")]
            yield row


def area_rows(bench):
    of = ("--method", "edge-scatter:rows=exact", "--light-samples", "1024", "--peer", "adaptive-rays", *RUNS)
    flat = [scene for scene in AREA_SCENES if scene != "textured-light"]  # its picture needs a rectangle
    own = lines(bench, *repeated("--scene", AREA_SCENES), *of)
    turned = lines(bench, *repeated("--scene", flat), *repeated("--light", LIGHTS[:3]), *of)
    for scene in AREA_SCENES:
        row = [scene]
        for found, subject in ((own, scene), *((turned, f"{scene}/light={light}") for light in LIGHTS[:3])):
            at = f"{subject}/n=1024"
            row.append(1 / over(found, at, "adaptive-rays", "edge-scatter:rows=exact") if f"{at}/adaptive-rays" in found else None)
        yield row


def frame_rows(bench):
    scenes = ("bunny", "knot:100000", "sphere:1000000", "sphere:10000000")
    found = lines(bench, "--frame", *repeated("--scene", scenes), *repeated("--light-samples", SAMPLES), "--runs", "3")
    for at, group in groupby(found.values(), key=lambda line: line["name"].rpartition("/")[0]):
        embree, scatter, exact = group
        scene, count = re.fullmatch(r"frame/(.+)/n=(\d+)", at).groups()
        yield (scene, int(count), embree["frame"]["median"], scatter["frame"]["median"], scatter["timesFasterThanEmbree"], scatter["nextTimesFasterThanEmbree"],
               scatter["meshOverEmbreeBuild"], scatter["viewOverEmbreeRays"], exact["frame"]["median"], exact["timesFasterThanEmbree"], exact["nextTimesFasterThanEmbree"])


def program_rows(bench):
    """Whole processes: seconds from start to end, phases, and the largest resident set."""
    out, stats = bench.folder / "program.exr", bench.folder / "program.json"
    for what, options in (("exact areas", ()), ("256 light samples", ("--light-samples", "256")), ("4,096 light samples", ("--light-samples", "4096"))):
        runs = []
        for _ in range(5):
            begin = time.monotonic()
            bench.program("render", ROOT / "scenes" / "bunny.json", "--size", "1920x1080", "-o", out, "--stats", stats, *options)
            runs.append((time.monotonic() - begin, json.loads(stats.read_text(encoding="utf-8"))))
        phases = [[one["seconds"][phase] for _, one in runs] for phase in ("view", "evaluate", "beauty", "write")]
        yield (what, *map(statistics.median, ([elapsed for elapsed, _ in runs], *phases)), round(max(one["memory"]["peakResident"] for _, one in runs) / 2**20))


def sequence_rows(bench):
    for frames in (100, 5):
        line, = lines(bench, "--sequence", "--frames", str(frames)).values()
        yield frames, line["elapsedOverWork"]


def table(title, conditions, heads, formats, rows):
    return Table(title, conditions, heads, formats, lambda bench: list(rows(bench)))


QUOTIENT = "#.3g"
THREE = [f"{count}: {what}" for count in ("256", "1,024", "4,096") for what in ("plain", "nontr.")]

TABLES = {
    "light-samples": table("edge-scatter and view-sample against rays at growing numbers of light samples", f"{HOW} Quotients say how many times longer rays take.",
                           ("bunny, half light", "light samples", "edge-scatter, s", "plain rays / it", "nontrivial / it", "adaptive / it", "view-sample, s", "plain rays / it",
                            "nontrivial / it"), (None, None, ".4f", *[QUOTIENT] * 3, ".4f", *[QUOTIENT] * 2), light_sample_rows),
    "scenes": table("edge-scatter against rays on the shipped scenes", f"{HOW} Seconds of edge-scatter, then plain and nontrivial rays over it.",
                    ("scene", *(f"{count}: {what}" for count in ("256", "1,024", "4,096") for what in ("s", "plain", "nontr."))), (None, *[".4f", QUOTIENT, QUOTIENT] * 3), scene_rows),
    "pairs": table("pairs on which edge-scatter and view-sample differ from raytrace", "512 × 512 pixels; all pairs of a judged view sample and a light sample. "
                   "`penumbra compare --reference-samples same` decides the differing pairs exactly.",
                   ("scene", *(f"{count}: {what}" for count in ("256", "1,024", "4,096") for what in ("pairs", "differing"))), (None,) * 7, pair_rows),
    "lights": table("edge-scatter against rays under every kind of light", f"{HOW} Plain and nontrivial rays over edge-scatter.", ("scene", "light", "pattern", *THREE),
                    (None, None, None, *[QUOTIENT] * 6), light_rows),
    "areas": table("exact areas over adaptive rays", f"{HOW} Seconds of `rows=exact` over those of adaptive rays with 1,024 light samples.",
                   ("scene", "rectangle", "disk", "ellipse", "hexagon"), (None, *[".2f"] * 4), area_rows),
    "whole-frames": table("whole pictures from a scene in memory, beside a program on Embree", "512 × 512 pixels; medians of three runs in turns. *Next*: the frame after it, whose light has moved.",
                          ("scene", "light samples", "Embree s", "edge-scatter s", "faster", "next", "mesh/E", "view/E", "rows=exact s", "faster", "next"),
                          (None, None, ".3f", ".3f", *[QUOTIENT] * 4, ".3f", *[QUOTIENT] * 2), frame_rows),
    "whole-program": table("the whole program at 1920 × 1080", "`penumbra render scenes/bunny.json --size 1920x1080 -o FILE.exr --stats FILE.json`, start to end; medians of five runs.",
                           ("what", "seconds", "view", "evaluate", "beauty", "write", "largest resident set, MiB"), (None, *[".2f"] * 5, None), program_rows),
    "sequence": table("elapsed seconds of a sequence over those of its frames' phases", "knot:70000, 1920 × 1080 pixels, exact areas, once; with few frames the start weighs more.",
                      ("frames", "elapsed over work"), (None, ".3f"), sequence_rows),
}
