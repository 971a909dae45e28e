#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures tables of pages: errors against exact areas, counters, sizes of files, processor seconds.

  bench/page_tables.py [--build build] [--commit C] [NAME …]     measures the named tables (all tables if none is named) and writes bench/results/NAME.json
  bench/page_tables.py --scene NAME                              prints a scene of these tables that is not in scenes/

`bench/tables.py` then writes the pages. Errors, counters and sizes do not depend on machine and load. Uses only Python's standard library."""

import argparse
import json
import math
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "docs"))

import map_fits_pictures  # noqa: E402
import predicate_lines  # noqa: E402
import ray_tables  # noqa: E402
import scaling_tables  # noqa: E402
from measured_tables import Answer, Bench, Compared, Megabytes, ProcessorSeconds, Run, Table, head_commit, measure  # noqa: E402

AREAS = ("--reference", "edge-scatter:rows=exact")
SAME = ("--reference-samples", "same")
SIZE = "128x128"
FIVE = ("parallel-square", "contact", "fusion", "room", "bunny")
EIGHT = ("parallel-square", "contact", "broken", "fusion", "large-penumbra", "room", "self-shadow", "bunny")
VARIANTS = ("z-fail", "zp+", "cc", "split", "hierarchical", "tiles")
SPLITS = ("soft-volume", "soft-volume:split=2", "soft-volume:split=3")
ERRORS = "128 × 128 pixels; errors of V over judged pixels against exact areas (`edge-scatter:rows=exact`)."

RMSE, MEAN, LARGEST = ("error", "rmse"), ("error", "bias"), ("error", "max")


# Scenes that are not shipped

def shipped(name):
    return json.loads((ROOT / "scenes" / f"{name}.json").read_text(encoding="utf-8"))


def ball(half):
    """Returns scenes/papers/ball.json with a square light of this half-size."""
    scene = shipped("papers/ball")
    scene["lights"][0]["rectangle"] |= {"halfU": [half, 0, 0], "halfV": [0, 0, half]}
    return scene


def near_light():
    """Returns a scene of objects in front of a luminous panel that stands on the floor."""
    meshes = (("floor", [0, 0, 0.5], [2.5, 0, 0], [0, 0, -1.5]), ("board", [-0.6, 0.25, -0.7], [0.25, 0, 0.1], [0, 0.25, 0]),
              ("post", [0.15, 0.6, -0.75], [0.06, 0, 0], [0, 0.6, 0]), ("shelf", [0.8, 0.12, -0.65], [0.3, 0, 0], [0, 0.03, 0.2]))
    return {"format": "penumbra-scene/1", "size": [360, 270], "camera": {"eye": [0.3, 3, 1.3], "target": [0.1, 0, -0.2], "verticalFov": 38},
            "meshes": [{"name": name, "quad": {"center": center, "halfU": u, "halfV": v}} for name, center, u, v in meshes],
            "lights": [{"name": "panel", "rectangle": {"center": [0, 0.61, -1.01], "halfU": [1.2, 0, 0], "halfV": [0, 0.6, 0]}, "radiance": [6, 5.8, 5.4]}]}


def defect(name):
    """Returns a scene of one broken mesh with this defect, from the shape generator, on a floor under a square
    light."""
    return {"format": "penumbra-scene/1", "size": [192, 144], "camera": {"eye": [-1.6, 2.2, 2.6], "target": [0.15, 0.45, 0], "verticalFov": 40},
            "meshes": [{"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [3, 0, 0], "halfV": [0, 0, -3]}},
                       {"name": "part", "shape": {"type": "broken", "defects": [name], "size": 4, "center": [0, 0.6, 0], "halfExtent": 0.5}}],
            "lights": [{"name": "key", "rectangle": {"center": [-1.5, 4, 0.5], "halfU": [0.4, 0, 0], "halfV": [0, 0, 0.4]}}]}


def lamps():
    """Returns scenes/bunny.json with 24 small lamps, six by four, in place of one."""
    scene = shipped("bunny")
    scene["lights"] = [{"name": f"lamp {6 * row + column}", "radiance": [22, 21, 19],
                        "rectangle": {"center": [column - 2, 5, row - 1], "halfU": [0.1, 0, 0], "halfV": [0, 0, 0.1]}}
                       for row in range(4) for column in range(6)]
    return scene


def boards():
    """Returns boards over a floor that face the eye of the scene of map fits; farther boards are larger."""
    quads = [([x * (6 - z) * 0.22, 0.2 + 0.02 * k, z], [(6 - z) * 0.1, 0, (6 - z) * 0.1], [0, (6 - z) * 0.15, 0])
             for k, z in enumerate((3, 1.5, -1, -4, -8, -14, -22, -34)) for x in (-1, 1)]
    quads.append(([0, -4, -20], [20, 0, 0], [0, 0, -30]))
    return [{"name": f"board {k}", "quad": {"center": center, "halfU": u, "halfV": v}} for k, (center, u, v) in enumerate(quads)]


def tilted(meshes, degrees, towards):
    """Returns a scene with the camera of the scene of map fits, and a lamp 40 from the point 12 in front of the eye.
    Its rays are at an angle to the view, and come from behind the eye, or go towards it."""
    scene = map_fits_pictures.scene()
    eye, target = scene["camera"]["eye"], scene["camera"]["target"]
    length = math.dist(eye, target)
    forward = [(b - a) / length for a, b in zip(eye, target)]
    upward = [0, -forward[2], forward[1]]
    along, across = math.cos(math.radians(degrees)) * (-1 if towards else 1), math.sin(math.radians(degrees))
    ray = [along * f - across * u for f, u in zip(forward, upward)]
    center = [e + 12 * f - 40 * r for e, f, r in zip(eye, forward, ray)]
    scene["lights"][0]["rectangle"] = {"center": center, "halfU": [0.001, 0, 0], "halfV": [0, 0.001 * ray[2], -0.001 * ray[1]]}
    return scene | {"meshes": meshes or scene["meshes"]}


TILTS = [(degrees, towards) for towards in (False, True) for degrees in ((60, 30, 15) if towards else (90, 60, 30, 15))]
DEFECTS = ("none", "inside-out", "flipped-patch", "duplicate-face", "opposite-face", "doubled-box", "unmerged", "t-junction", "crack", "gap", "lost-gap", "collinear",
           "repeated-vertex", "needle", "lid", "hollow", "hole", "holes", "fin", "spikes", "shared-edge", "bowtie", "crossing-sheets", "loose-triangles")
HALVES = (0.1, 0.25, 0.5, 1)
SCENES = {"near-light": near_light, "lamps": lamps, "map-fits": map_fits_pictures.scene,
          **{f"{name}-{degrees}{'-towards' * towards}": lambda meshes=meshes, tilt=(degrees, towards): tilted(meshes(), *tilt)
             for name, meshes in (("floor", list), ("boards", boards)) for degrees, towards in TILTS},
          **{f"ball-{half}": lambda half=half: ball(half) for half in (*HALVES, 0.3, 2)}, **{f"defect-{name}": lambda name=name: defect(name) for name in DEFECTS}}


# Columns: head, method, requested figure, format

def rmse(head, entry):
    return head, entry, RMSE, ".4f"


def largest(head, entry):
    return head, entry, LARGEST, ".2f"


def mean(head, entry):
    return head, entry, MEAN, "+.4f"


def count(head, entry, name):
    return head, entry, ("counters", name), None


def errors(head, entry):
    return rmse(f"{head}: RMSE", entry), largest("largest error", entry)


def wedge_columns(entry):
    return (count("silhouette edges", entry, "silhouetteEdges"), count("wedges on screen", entry, "wedgesOnScreen"), count("fragments", entry, "fragments"),
            rmse("RMSE", entry), largest("largest error", entry))


def variants(name):
    return tuple(count(f"`{variant}`", f"hard-volume:variant={variant}", name) for variant in VARIANTS)


def by_scene(title, conditions, scenes, columns, size=SIZE, light_samples=None, *, reference=AREAS, names=None, merged=False):
    """Returns a table with a row for each scene."""
    runs = {scene: Run(scene, size, reference, light_samples) for scene in scenes}
    return Table(title, conditions, ("scene", *(head for head, *_ in columns)), (None, *(form for *_, form in columns)),
                 tuple(((names or {}).get(scene, scene), *(Compared(run, entry, of) for _, entry, of, _ in columns)) for scene, run in runs.items()), merged)


def by_entry(title, conditions, heads, rows, columns):
    """Returns a table with a row for each (labels, run, method); columns are (head, requested figure, format)."""
    return Table(title, conditions, (*heads, *(head for head, *_ in columns)), (*(None for _ in heads), *(form for *_, form in columns)),
                 tuple((*labels, *(Compared(run, entry, of) for _, of, _ in columns)) for labels, run, entry in rows))


ERROR_COLUMNS = (("RMSE", RMSE, ".4f"), ("mean error", MEAN, "+.4f"), ("largest error", LARGEST, ".2f"))
UMBRA_COLUMNS = (("RMSE", RMSE, ".4f"), ("mean error", MEAN, "+.4f"), ("umbra: mean error", ("lights", 0, "classes", "umbra", "bias"), "+.4f"),
                 ("largest", ("lights", 0, "classes", "umbra", "max"), ".2f"))


def code(entry):
    return f"`{entry}`"


def entries_of(run_of, entries):
    return [((code(entry),), run_of, entry) for entry in entries]


# Tables that are used by one page each and need more than a line

def aliasing(method, name):
    return method["counters"][name] / method["counters"]["aliasingPixels"]


def map_fits():
    run = Run("map-fits", None, ("--reference", "raytrace"), 16)
    rows = []
    for fit, size in map_fits_pictures.ROWS:
        rows.append(((code(fit), f"{size}²"), run, f"shadow-map:size={size}:fit={fit}:aliasing=count"))
    return by_entry("map fits: the aliasing error m", "A floor of 24 × 48 with plates above it, 192 × 144 pixels; 1,024 rays a pixel judge V.", ("`fit`", "each map"), rows,
                    (("maps", ("counters", "mapFaces"), None), ("mean m", lambda m: aliasing(m, "aliasingThousandths") / 1000, ".2f"),
                     ("largest", lambda m: m["counters"]["aliasingWorstThousandths"] / 1000, ".1f"), ("m > 1, %", lambda m: 100 * aliasing(m, "undersampledPixels"), ".0f"),
                     ("storage factor", lambda m: aliasing(m, "neededTexels"), ".1f"), ("RMSE of V", RMSE, ".4f")))


def tilted_views():
    rows = [((name, f"{degrees}°", "towards the eye" if towards else "across" if degrees == 90 else "from behind"),
             Run(f"{name}-{degrees}{'-towards' * towards}", None, ("--reference", "raytrace"), 16)) for name in ("floor", "boards") for degrees, towards in TILTS]
    columns = [(f"`{fit}`: {head}" if head == "mean m" else head, f"shadow-map:size=256:fit={fit}:aliasing=count", of, form)
               for fit in ("view", "lispsm", "psm")
               for head, of, form in (("mean m", lambda m: aliasing(m, "aliasingThousandths") / 1000, ".2f"),
                                      ("largest", lambda m: m["counters"]["aliasingWorstThousandths"] / 1000, ".1f"))]
    return Table("map fits: the aliasing error m of tilted views", "The scene of map fits and boards that face its eye, 192 × 144 pixels, maps of 256²; the lamp's rays at an angle γ "
                 "to the view.", ("scene", "γ", "light", *(head for head, *_ in columns)), (None, None, None, *(form for *_, form in columns)),
                 tuple((*labels, *(Compared(run, entry, of) for _, entry, of, _ in columns)) for labels, run in rows))


def change_by(cause):
    """Returns a function for the change by one cause, rounded to the table's four digits, so that a change printed as 0
    has no sign."""
    def of(method):
        change = method["errorBudget"][cause]
        return None if change is None else round(change, 4) + 0.0

    return of


def budget(title, entries, causes, light_samples=None):
    run = Run("fusion", "48x48", ("--reference", "exact"), light_samples, more=("--error-budget",))
    return by_entry(title, "`scenes/fusion.json`, 48 × 48 pixels, judged by exact areas. Empty: no repair was run.", ("entry",), entries_of(run, entries),
                    (("RMSE", ("errorBudgetRuns", "rmse"), ".4f"), *((cause, change_by(cause), "+.4f") for cause in causes),
                     ("all but the view", ("errorBudgetRuns", "allButView", "rmse"), ".4f"), ("remainder", ("errorBudget", "remainder"), ".4f")))


def beauty():
    samples, relative = (16, 64, 256, 1024), ("beautyError", "relativeRmse")
    cases = (("raytrace", "rows"), ("raytrace", "jittered"), ("soft-volume", "rows"))
    rows = tuple((scene, f"`{method}`" + (f", {pattern}" if method == "raytrace" else ""),
                  *(Compared(Run(scene, "256x192", AREAS, n, pattern), method, relative) for n in samples))
                 for scene in ("near-light", "contact", "parallel-square") for method, pattern in cases)
    return Table("errors of the beauty at four numbers of light samples", "256 × 192 pixels; √(mean e²) over the mean luminance, over all judged pixels, against exact areas "
                 "(`edge-scatter:rows=exact`). `near-light` is the pictures' scene.", ("scene", "method", *map(str, samples)), (None, None, *(".4f" for _ in samples)), rows)


def adaptive_light():
    rows = []
    for half in (0.1, 0.5, 1, 2):
        run, entry = Run(f"ball-{half}", SIZE, AREAS, 128), "adaptive-light:size=256:shareOf=map:epsilon=0.0018"
        rows.append((f"{half}", Compared(run, entry, ("counters", "maps")), Compared(run, entry, RMSE), Compared(run, f"{entry}:weights=area", RMSE),
                     Compared(run, "accumulate:size=256", RMSE)))
    return Table("adaptive-light under lights of four sizes", "`scenes/papers/ball.json` under a light of half-size s, 128 × 128 pixels, maps of 256², `shareOf=map:epsilon=0.0018`; "
                 "errors of V over judged pixels against exact areas.", ("s", "maps", "RMSE", "`weights=area`: RMSE", "128 fixed maps (`accumulate`): RMSE"),
                 (None, None, ".4f", ".4f", ".4f"), tuple(rows))


def deep_penumbra():
    run = Run("fusion", "256x256", AREAS, 64)
    rows = [((str(size), bound), run, f"deep-penumbra:size={size}:bound={bound}") for size, bound in
            ((64, "0.01"), (128, "0.01"), (256, "0"), (256, "0.01"), (256, "0.1"), (256, "0.5"), (512, "0.01"))]
    rows += [((str(size), "`accumulate`"), run, f"accumulate:size={size}") for size in (256, 512)]
    return by_entry("deep-penumbra: size and bound", "`scenes/fusion.json`, 256 × 256 pixels, 64 light samples; errors of V over judged pixels against exact areas.",
                    ("size", "bound"), rows, (("RMSE", RMSE, ".4f"), ("off by more than 0.05, %", lambda m: 100 * m["error"]["over05"], ".1f"),
                                              ("steps", lambda m: m["counters"].get("steps"), None)))


def defect_pairs():
    run = {name: Run(f"defect-{name}", None, SAME, 64) for name in DEFECTS}
    few = {name: Run(f"defect-{name}", None, SAME, 16) for name in DEFECTS}
    differing = ("pairsDiffering",)
    rows = tuple((code(name), *(Compared(run[name], entry, differing) for entry in ("view-sample", "edge-scatter", "depth-complexity", "depth-complexity:variant=laine")),
                  Compared(few[name], "depth-complexity:variant=forest", differing), Compared(run[name], "accumulate", differing), Compared(run[name], "accumulate", ("pairsAll",)),
                  *(Compared(run[name], entry, RMSE) for entry in ("accumulate", "pcss", "shadow-map"))) for name in DEFECTS)
    return Table("pairs that methods decide differently on broken meshes", "192 × 144 pixels, 64 light samples (`forest`: 16, a quarter of the pairs), maps of 1024²; against rays to the "
                 "same light samples. Parts with the same figures share a row.",
                 ("part", "`view-sample`", "`edge-scatter`", "`depth-complexity`", "`laine`", "`forest`", "`accumulate`", "of pairs", "its RMSE", "`pcss`: RMSE", "`shadow-map`: RMSE"),
                 (*(None for _ in range(8)), ".4f", ".4f", ".4f"), rows, merged=True)


def validated(scene, construction, of):
    return Answer(("wedges", f"scene:{scene}", "--validate", "--from", "centre", "--construction", construction, "--json"), of)


def wedge_ratios():
    def of(scene, construction, key):
        return validated(scene, construction, lambda answer: answer["tightness"][key])

    return Table("cross-sections of wedges over those of penumbrae", "`penumbra wedges SCENE --from centre --validate`: areas on planes that are half, once and twice as far beyond the "
                 "edge as the light is on the other side.", ("scene", "wedges", "original: median", "p99", "largest", "tight: largest"), (None, None, ".2f", ".2f", ".2f", ".4f"),
                 tuple((scene, validated(scene, "original", lambda answer: answer["counts"]["wedge"]),
                        *(of(scene, "original", key) for key in ("median", "p99", "max")), of(scene, "tight", "max"))
                       for scene in ("parallel-square", "broken", "contact", "fusion", "thin")))


def coverage():
    def of(scene, path):
        def figure(answer):
            answer = answer["coverage"]
            if path == ("maxAgainstExact",) and not answer["singleLayer"]:
                return None
            for key in path:
                answer = answer[key]
            return answer

        return validated(scene, "original", figure)

    paths = (("samples",), ("singleLayer",), ("maxAgainstTriangles",), ("maxAgainstExact",), ("centreDifference", "mean"), ("centreDifference", "max"))
    return Table("silhouettes' sums beside triangles and exact areas", "`penumbra wedges SCENE --validate`; for `textured-light`, weights take the place of areas.",
                 ("scene", "samples", "single layer", "receiver − triangles", "receiver − exact", "centre − receiver: mean", "largest"),
                 (None, None, None, ".0e", ".0e", ".4f", ".3f"),
                 tuple((scene, *(of(scene, path) for path in paths)) for scene in ("parallel-square", "contact", "broken", "bunny", "fusion", "large-penumbra", "room", "self-shadow",
                                                                                   "thin", "textured-light", "terrain-1m")))


def coverage_solids():
    def rows(bench):
        lines = bench.printed("wedges_test", "CoverageErrors.Of*", r"^(sphere|cube below|cube beside), light of half-size ([\d.]+): (\d+) samples, mean ([\d.]+), max ([\d.]+);")
        names = {"sphere": "a sphere of radius 0.5 below the light", "cube beside": "a cube of half-size 0.5 beside it", "cube below": "the same right below it"}
        return [(names[solid], f"{half:g}", *rest) for solid, half, *rest in sorted(lines, key=lambda line: list(names).index(line[0]))]

    return Table("errors by the centre's silhouettes under convex solids", "A solid about 1 above a floor, the light 4 above it; |V − exact| over 32 × 32 points of the floor, of those that "
                 "see a part of the light.", ("solid", "light's half-size", "points", "mean", "largest"), (None, None, None, ".4f", ".3f"), rows)


def radiance_samples():
    def rows(bench):
        return [(str(count), *rest) for count, *rest in bench.printed(
            "compare_test", "RadianceNearLight.CellsBeat*", r"^ *(\d+): V ([\d.]+), rows: points ([\d.]+) cells ([\d.]+), jittered: points ([\d.]+) scaled ([\d.]+)")]

    return Table("irradiance near a light: cells, samples and V", "The pictures' scene, 96 × 72 pixels; √(mean e²) over the mean, over view samples that see a part of the light, against `exact`.",
                 ("light samples", "V · F_L (1.4), V from that many", "rows, plain sum (1.3)", "rows, cells", "jittered, plain sum (1.3)", "jittered, scaled"), (None, *(".4f",) * 5), rows)


def own_depth():
    def rows(bench):
        means = {}
        for method, tilt, mean in bench.printed("maps_test", "ReceiverPlane.OffATiltedPlane*", r"^([\w:=-]+), (\d+) degrees, own depth: V ([\d.]+) in the mean"):
            means.setdefault(method, {})[tilt] = mean
        return [(code(method), of[30], of[60]) for method, of in means.items()]

    return Table("the receiver's own depth: a plane that shades itself", "A tilted plane with nothing above it, `receiverPlane=off` and no bias; V in the mean.", ("method", "30°", "60°"),
                 (None, ".2f", ".2f"), rows)


def deep_penumbra_bounds():
    def rows(bench):
        return [(f"{bound:g}", steps, worst) for bound, steps, _, worst in
                bench.printed("maps_test", "DeepPenumbra.CompressedSteps*", r"^bound ([\d.]+): (\d+) steps of (\d+), off by ([\d.]+)")]

    return Table("deep-penumbra: steps that are kept", "A small scene of a test, 24² texels, 64 light samples, 8,836 events.", ("bound", "steps", "largest error"), (None, None, ".4f"), rows)


def cropped_edges():
    def rows(bench):
        return bench.printed("volumes_test", "Scenes/EdgeCropFull.*",
                             r"^([\w-]+) 256x256: \d+ judged view samples; edges each: ([\d.]+) in the shaft, ([\d.]+) cropped, ([\d.]+) silhouettes")

    return Table("edges that a view sample is given", "256 × 256 pixels, blocks of 8 × 8, the scene's first light; edges for each judged view sample.",
                 ("scene", "in the shaft", "cropped", "silhouettes"), (None, ".1f", ".1f", ".1f"), rows)


def edge_search():
    searches = ("hierarchy", "kd-tree", "hemicube")
    slow = {("bunny", "hemicube"), ("self-shadow", "hemicube")}

    def figure(scene, search, of):
        return None if (scene, search) in slow else Compared(Run(scene, "256x256", SAME, 16), f"depth-complexity:engine=native:search={search}", of)

    def candidates(method):
        return method["counters"]["candidateEdges"] / 1e6

    return Table("candidates of three searches for edges", "256 × 256 pixels, 16 light samples, the scenes' own lights; candidate edges of all view samples, in millions, and what the structures hold. "
                 "Empty: not run, since the hemicube takes minutes there.",
                 ("scene", "wedges", "hierarchy", "kd-tree", "hemicube", "entries: kd-tree", "hemicube"), (None, None, ".3g", ".3g", ".3g", None, None),
                 tuple((scene, figure(scene, "kd-tree", ("counters", "wedges")), *(figure(scene, search, candidates) for search in searches),
                        *(figure(scene, search, ("counters", "searchEntries")) for search in searches[1:]))
                       for scene in ("broken", "bunny", "contact", "fusion", "parallel-square", "room", "self-shadow", "textured-light", "thin")))


def wedges_a_frame():
    def rows(bench):
        lines = {tuple(line["name"].split("/")[1:]): line for line in bench.lines("--wedges-per-frame")}
        for (where, triangles), line in lines.items():
            if where == "device":
                yield [f"{line['triangles']:,}", line["edges"], *(1000 * lines[place, triangles]["seconds"]["median"] for place in ("device", "host")), line["hostRatio"]]

    return Table("silhouettes and wedges of a moving light, device beside host", "`penumbra-bench --wedges-per-frame`: a light on a circle over a knot, everything built anew in each frame; milliseconds "
                 "a frame, medians of five runs in turns.", ("triangles", "silhouettes a frame", "device", "host", "host / device"), (None, None, ".3g", ".3g", ".2g"), lambda bench: list(rows(bench)))


def wedge_construction():
    def rows(bench):
        return [(line["name"].split("/")[2], line["seconds"]["median"], line["itemsPerSecond"])
                for line in bench.lines("--cpu", "--triangles", "5000", "--edges", "100000", "--runs", "3") if "/wedges/" in line["name"]]

    return Table("construction of wedges", "`penumbra-bench --cpu --edges 100000`: 100,000 edges of a knot under a square light, every plane proved; medians of three.",
                 ("construction", "seconds", "wedges a second"), (None, ".3g", ",.0f"), rows)


def self_test():
    keys = ("pass", "compared", "differing", "largest", "allowed", "verdict", "against")

    def rows(bench):
        return [[check[key] if check[key] != 0 or key in ("compared", "differing") else None for key in keys] for check in bench.answer(("devices", "--self-test", "--json"))["checks"]]

    return Table("the self-test on llvmpipe", "`penumbra devices --self-test` with Mesa 22.3.6 (LLVM 15.0.6, 256 bits), Vulkan and OpenGL. Empty: 0.", keys, (None, None, None, ".1e", ".1e", None, None), rows)


def file_sizes():
    kinds = (("all layers, with those on request", "--layers", "*,*_light,*_V"), ("default",), ("`--half`", "--half"), ("`--half --compression dwaa`", "--half", "--compression", "dwaa"),
             ("`--layers beauty --half --compression dwaa`", "--layers", "beauty", "--half", "--compression", "dwaa"))
    return Table("sizes of EXR files", "1920 × 1080 pixels, exact areas; megabytes (10⁶ bytes).", ("options", "`bunny`, one lamp", "the same with 24 lamps"), (None, ".2f", ".2f"),
                 tuple((name, *(Megabytes(scene, ("--size", "1920x1080", *options)) for scene in ("bunny", "lamps"))) for name, *options in kinds))


def seconds(title, scenes, entries, options, conditions):
    return Table(title, f"{conditions} User and system time of the whole `penumbra render`, least of three.", ("scene", *map(code, entries)), (None, *(".2f" for _ in entries)),
                 tuple((scene, *(ProcessorSeconds(scene, entry, options) for entry in entries)) for scene in scenes))


TABLES = {
    "plateaus": by_scene("plateaus: errors beside wedge-ramp and hard shadows", ERRORS, FIVE,
                         (rmse("RMSE", "plateaus"), largest("largest error", "plateaus"), rmse("wedge-ramp: RMSE", "wedge-ramp"), rmse("hard-volume: RMSE", "hard-volume"))),
    "alias-free": by_scene("alias-free: errors of a hard shadow", ERRORS, FIVE,
                           (rmse("`alias-free`: RMSE", "alias-free"), rmse("`hard-volume`", "hard-volume"), rmse("`shadow-map`", "shadow-map"),
                            rmse("`edge-scatter`, 256 light samples", "edge-scatter"))),
    "wedge-ramp": by_scene("wedge-ramp: wedges, fragments and errors", ERRORS, FIVE,
                           (*wedge_columns("wedge-ramp"), rmse("soft-volume: RMSE", "soft-volume"), rmse("hard-volume: RMSE", "hard-volume"))),
    "soft-volume": by_scene("soft-volume: wedges, fragments and errors", ERRORS, FIVE, wedge_columns("soft-volume")),
    "soft-volume-blend": by_scene("soft-volume-blend: wedges, fragments and errors", ERRORS, FIVE,
                                  (*wedge_columns("soft-volume-blend"), rmse("soft-volume: RMSE", "soft-volume"), rmse("hard-volume: RMSE", "hard-volume"))),
    "wedge-fragments": by_scene("fragments of soft-volume's wedges", "128 × 128 pixels. A fragment is a pixel of a wedge's footprint.", FIVE,
                                tuple(count(head, entry, "fragments") for head, entry in (("`tests=none`", "soft-volume:tests=none"), ("`z`", "soft-volume:tests=z"), ("`both`", "soft-volume"),
                                                                                          ("`both`, tight", "soft-volume:construction=tight")))),
    "soft-irregular": by_scene("soft-irregular: errors, with leaks and with layers", ERRORS, ("contact", "fusion", "room"),
                               (rmse("RMSE", "soft-irregular"), mean("mean error", "soft-irregular"), largest("largest error", "soft-irregular"),
                                rmse("`umbra=layers`: RMSE", "soft-irregular:umbra=layers"), largest("largest error", "soft-irregular:umbra=layers"))),
    "hard-volume-fragments": by_scene("fragments of hard-volume's variants", "512 × 512 pixels. A fragment is a pixel of the box that a face of a volume covers.",
                                      ("fusion", "room", "thin", "bunny"), variants("fragments"), "512x512"),
    "hard-volume-updates": by_scene("changes of counts by hard-volume's variants", "512 × 512 pixels. A change is what a stencil would be written for.",
                                    ("fusion", "room", "thin", "bunny"), variants("countUpdates"), "512x512"),
    "hard-volume-culled": by_scene("what hard-volume's variants leave out", "512 × 512 pixels.", ("fusion", "room", "thin", "bunny"),
                                   (count("`cc`: volumes", "hard-volume:variant=cc", "volumes"), count("culled", "hard-volume:variant=cc", "culledVolumes"),
                                    count("cut", "hard-volume:variant=cc", "clampedVolumes"), count("`hierarchical`: triangles", "hard-volume:variant=hierarchical", "volumes"),
                                    count("culled", "hard-volume:variant=hierarchical", "culledVolumes"), count("`tiles`: tiles", "hard-volume:variant=tiles", "tiles"),
                                    count("whole", "hard-volume:variant=tiles", "wholeTiles")), "512x512"),
    "soft-volume-split": by_scene("soft-volume: errors with a split light", ERRORS, EIGHT,
                                  (*(column for entry, head in zip(SPLITS, ("`split=1`", "`split=2`", "`split=3`")) for column in errors(head, entry)),
                                   rmse("`coverage=table`: RMSE", "soft-volume:coverage=table"), rmse("hard-volume: RMSE", "hard-volume"))),
    "layer-rays": by_scene("layer-rays beside other methods of one map", "64 × 64 pixels, 64 light samples, maps of 1024²; RMSE of V over judged pixels against exact areas (`edge-scatter:rows=exact`).",
                           ("bunny", "contact", "fusion"),
                           tuple(rmse(f"`{entry}`", entry) for entry in ("layer-rays:layers=1", "layer-rays:layers=4", "bitmask", "contour", "backproject", "shadow-map")), "64x64", 64),
    "hierarchical-penumbra": by_scene("errors of 256 light samples, and of view-sample-planar's table",
                                      "128 × 128 pixels, 256 light samples in rows; errors of V over judged pixels against exact areas (`edge-scatter:rows=exact`).",
                                      ("broken", "contact", "fusion", "parallel-square", "thin"),
                                      (*errors("`hierarchical-penumbra`", "hierarchical-penumbra"), *errors("`view-sample:variant=sintorn`", "view-sample:variant=sintorn"),
                                       *errors("`view-sample-planar:lookup=nearest`", "view-sample-planar:lookup=nearest")), SIZE, 256),
    "depth-complexity-forest": by_scene("errors of depth-complexity's silhouettes from the light's centre",
                                        "256 × 256 pixels, 16 light samples in rows; errors of V over judged pixels against exact areas (`edge-scatter:rows=exact`). Every bit of "
                                        "`depth-complexity` is right: its errors are those of 16 light samples.",
                                        ("parallel-square", "contact", "broken", "fusion", "large-penumbra", "room", "self-shadow", "thin", "bunny"),
                                        (count("silhouette edges", "depth-complexity:variant=forest", "silhouetteEdges"), *errors("`variant=forest`", "depth-complexity:variant=forest"),
                                         mean("mean error", "depth-complexity:variant=forest"), *errors("`depth-complexity`", "depth-complexity"),
                                         *(count(f"pixels that overflow {bits} bits", f"depth-complexity:variant=forest:counter-bits={bits}", "overflowPixels") for bits in (16, 8, 6))),
                                        "256x256", 16),
    "accuracy": by_entry("methods on the default scene", "`scenes/bunny.json`, 512 × 512 pixels, 256 light samples; against rays to the same light samples. Empty: the method gives V "
                         "alone and has no pairs.", ("method",),
                         entries_of(Run("bunny", "512x512", SAME, 256), (
                             "edge-scatter", "view-sample", "depth-complexity", "edge-scatter:rows=exact", "soft-volume-blend", "soft-volume", "hard-volume", "wedge-ramp", "accumulate",
                             "occlusion-textures", "vssm", "pcss", "pcf", "convolution", "shadow-map")),
                         (("RMSE of V", RMSE, ".4f"), ("largest error", LARGEST, ".2f"), ("wrong pairs", lambda m: m.get("pairsDiffering"), None),
                          ("of", lambda m: m.get("pairsAll"), None))),
    "map-fits": map_fits(),
    "map-fits-tilted": tilted_views(),
    "error-budget": budget("parts of the errors of image-based methods", ("backproject:size=64", "bitmask:size=64:occluder=patch", "contour:size=64", "pcss:size=64"),
                           ("resolution", "view", "layers", "fusion", "gaps", "bias")),
    "radiance": beauty(),
    "backproject": by_entry("backproject: ways to fill gaps", ERRORS, ("scene", "method"),
                            [((scene.rpartition("/")[2], code(entry)), Run(scene, SIZE, AREAS), entry)
                             for scene, sizes in (("papers/plate-over-plate", (64,)), ("papers/ball", (32, 128))) for size in sizes
                             for entry in (f"backproject:size={size}:fill={fill}" for fill in ("none", "edges", "diagonal", "shared"))], UMBRA_COLUMNS),
    "backproject-peel": by_entry("backproject-peel: layers and samples", ERRORS, ("scene", "method"),
                                 [((scene.rpartition("/")[2], code(entry)), Run(scene, SIZE, AREAS), entry) for scene, entries in (
                                     ("papers/plate-over-plate", ("backproject-peel:size=64:layers=1:samples=0", "backproject-peel:size=64:layers=2:samples=0")),
                                     ("papers/ball", tuple(f"backproject-peel:size=128:layers=3:samples={samples}{select}" for select in ("", ":select=deepest") for samples in (0, 121))))
                                  for entry in entries], UMBRA_COLUMNS),
    "bitmask": by_entry("bitmask: occluders and layers", "128 × 128 pixels, 256 light samples; against rays to the same light samples.", ("light's half-size", "method"),
                        [((half, code(entry)), Run(f"ball-{half}", SIZE, SAME, 256), entry) for half in ("0.3", "1")
                         for entry in (f"bitmask:size=48:occluder={occluder}:layers={layers}" for occluder in ("quad", "triangle", "patch") for layers in (1, 3))],
                        (("wrong pairs", ("pairsDiffering",), None), ("of", ("pairsAll",), None), ("RMSE", RMSE, ".4f"), ("mean error", MEAN, "+.4f"))),
    "packet": by_entry("packet: parts of the light", ERRORS, ("method",),
                       entries_of(Run("papers/ball", SIZE, AREAS), ("contour:size=128", "packet:size=128", "packet:size=128:sublights=2", "packet:size=128:sublights=4",
                                                                    "backproject-peel:size=128:layers=4")), ERROR_COLUMNS),
    "soft-shadow-map": by_entry("soft-shadow-map: one pass and two", "`scenes/papers/ball.json` under lights of four half-sizes, 128 × 128 pixels; errors of V against exact areas, over judged "
                                "pixels on which the ball's shadow falls.", ("light's half-size", "passes"),
                                [((f"{half}", str(passes)), Run(f"ball-{half}", SIZE, AREAS), f"soft-shadow-map:passes={passes}") for half in HALVES for passes in (1, 2)],
                                (("RMSE", ("lights", 0, "classes", "cast", "rmse"), ".4f"), ("mean error", ("lights", 0, "classes", "cast", "bias"), "+.4f"),
                                 ("largest error", ("lights", 0, "classes", "cast", "max"), ".2f"), ("umbra: pixels", ("lights", 0, "classes", "umbra", "pixels"), None),
                                 ("mean error there", ("lights", 0, "classes", "umbra", "bias"), "+.4f"))),
    "adaptive-light": adaptive_light(),
    "deep-penumbra": deep_penumbra(),
    "defects-pairs": defect_pairs(),
    "defects-volumes": by_scene("shadow volumes on broken meshes", "192 × 144 pixels; errors of V over judged pixels against exact areas. Parts with the same figures share a row.",
                                tuple(f"defect-{name}" for name in DEFECTS), tuple(column for entry in ("soft-volume", "soft-volume-blend", "wedge-ramp", "hard-volume")
                                                                                   for column in errors(code(entry), entry)),
                                None, names={f"defect-{name}": code(name) for name in DEFECTS}, merged=True),
    "textured-lights": by_entry("errors under a textured light", "`scenes/textured-light.json`, 256 × 256 pixels; errors of V over judged pixels against exact areas.", ("light samples", "method"),
                                [((str(n), code(entry)), Run("textured-light", "256x256", AREAS, n), entry) for entry in ("view-sample", "accumulate", "pcss")
                                 for n in {"view-sample": (64, 256, 1024, 4096), "accumulate": (64, 256), "pcss": (256,)}[entry]], (("RMSE", RMSE, ".4f"), ("largest error", LARGEST, ".3f"))),
    "layer-rays-maps": by_entry("layer-rays: layers and maps", "`scenes/papers/ball.json`, 128 × 128 pixels, 256 light samples; errors of V over judged pixels against exact areas.",
                                ("method",), entries_of(Run("papers/ball", SIZE, AREAS, 256), (*(f"layer-rays:size={size}:layers=1:gap=0" for size in (32, 96, 288)),
                                                                                               *(f"layer-rays:size={size}:layers=2" for size in (32, 96, 288)))),
                                ERROR_COLUMNS),
    "view-sample-planar": by_scene("view-sample-planar: pairs that a nearest texel decides wrongly", "256 × 256 pixels, 256 light samples in rows; against rays to the same light samples.",
                                   ("contact", "fusion", "bunny", "thin"),
                                   tuple(column for entry, head in (("view-sample-planar:lookup=nearest", "`map=128`"), ("view-sample-planar:lookup=nearest:map=512", "`map=512`"))
                                         for column in ((f"{head}: wrong pairs", entry, ("pairsDiffering",), None), rmse("RMSE of V", entry), largest("largest error", entry)))
                                   + (("of pairs", "view-sample-planar:lookup=nearest", ("pairsAll",), None),), "256x256", 256, reference=SAME),
    "hierarchical-penumbra-seconds": seconds("processor seconds of methods with the same bits", ("contact", "thin"),
                                             ("hierarchical-penumbra", "view-sample:variant=sintorn", "view-sample-planar", "view-sample:engine=native", "raytrace"),
                                             ("--size", "256x256", "--light-samples", "256"), "256 × 256 pixels, 256 light samples."),
    "depth-complexity-crop": cropped_edges(),
    "depth-complexity-search": edge_search(),
    "wedges": wedge_ratios(),
    "wedges-per-frame": wedges_a_frame(),
    "wedges-construction": wedge_construction(),
    "coverage": coverage(),
    "coverage-solids": coverage_solids(),
    "radiance-samples": radiance_samples(),
    "shadow-map-own-depth": own_depth(),
    "deep-penumbra-bounds": deep_penumbra_bounds(),
    "predicates": predicate_lines.TABLE,
    **ray_tables.TABLES,
    **scaling_tables.TABLES,
    "self-test": self_test(),
    "file-sizes": file_sizes(),
    "soft-irregular-seconds": seconds("processor seconds of soft-irregular and of others", ("contact", "fusion", "large-penumbra", "room"),
                                      ("soft-irregular", "soft-irregular:umbra=layers", "soft-volume", "edge-scatter:rows=samples", "edge-scatter:rows=exact"),
                                      ("--size", "512x512"), "512 × 512 pixels; `rows=samples` with 256 light samples."),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument("--commit", help="commit that the program was built from, where that is not the one checked out")
    parser.add_argument("--scene", choices=SCENES, metavar="NAME", help="print this scene")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(TABLES))
    asked = parser.parse_args()
    if asked.scene:
        print(json.dumps(SCENES[asked.scene](), indent=1))
        return
    if unknown := set(asked.names) - TABLES.keys():
        parser.error(f"no table {', '.join(sorted(unknown))}; what there is: {', '.join(TABLES)}")
    with tempfile.TemporaryDirectory() as folder:
        measure({name: TABLES[name] for name in asked.names or TABLES}, Bench(asked.build / "penumbra", Path(folder), SCENES), asked.commit or head_commit())


if __name__ == "__main__":
    main()
