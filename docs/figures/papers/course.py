# SPDX-License-Identifier: Apache-2.0
"""Figures of E. Eisemann, U. Assarsson, M. Schwarz, M. Wimmer, *Casting shadows in real time*, SIGGRAPH Asia 2009 courses: errors of
filters, micropatches, slices and the fusion of occluders, and the number of silhouette edges of meshes."""

import json
import subprocess
import tempfile
from math import exp, log, sqrt
from pathlib import Path

from chart import STYLES, Chart, image, key, mark
from drawing import DARK, INK, PALE, RED, Drawing
from experiment import ball, box, cross, measures, picture, rounded, scene, square

WIDTH = 96  # pixels of a row


def row_scene(casters, **more):
    return scene(casters, strip=12, **more)


def profile(found, entry):
    """Returns V along the middle row of a picture of WIDTH × 8 pixels."""
    return [rounded(v) for v in found[entry]["V"][4 * WIDTH:5 * WIDTH]]


def rows_of(runner, world, variants, **more):
    found = runner.compare(world, [entry for _, entry in variants], size=(WIDTH, 8), **more)
    return [["exact", profile(found, "truth")]] + [[name, profile(found, entry)] for name, entry in variants]


def draw_rows(d, box, rows, title, floor, colours=(None, 1, 0, 2), label="x on the floor"):
    chart = Chart(d, box, (-floor, floor), (0, 1.08), title, label, "V", x_ticks=(-2, -1, 0, 1, 2), y_ticks=(0, 0.25, 0.5, 0.75, 1))
    for (name, values), style in zip(rows, colours):
        points = [(0.98 * floor * (2 * (i + 0.5) / WIDTH - 1), v) for i, v in enumerate(values)]
        if style is None:
            chart.path(points, INK, 2.6)
        else:
            chart.path(points, STYLES[style][0], 1.5)
            for i in range(4 * style, WIDTH, 12):
                mark(d, chart.at(*points[i]), *STYLES[style], r=2.6)
    return chart


PCSS = "pcss:size=256:blockerSamples=256:filterSamples=256"
PCSS_VARIANTS = [("pcss", PCSS), ("backproject", "backproject:size=256"), ("contour", "contour:size=256:traversal=hierarchy")]


def measure_pcss(runner):
    wall = [box([-1.6, 2.05, 0], [0.05, 2, 2.4])]
    heights = [square("high", [-0.55, 3.8, 0], 0.5, 2.0), square("low", [0.75, 0.6, 0], 0.75, 2.0)]
    return {"wall": rows_of(runner, row_scene(wall, half=0.7), PCSS_VARIANTS),
            "heights": rows_of(runner, row_scene(heights, half=0.9), PCSS_VARIANTS)}


def draw_pcss(data):
    d = Drawing(900, 372, "Course notes, figures 5.3 and 5.4: false blockers of pcss, and one mean height for two blockers",
                "Two charts of V along a line on the floor, exact and by pcss, backproject and contour. Next to a tall wall pcss darkens lit points. "
                "Under plates at two heights its penumbra is that of one plate between them.")
    for i, (which, title) in enumerate((("wall", "(a) beside a wall 4 high at x = −1.6"), ("heights", "(b) below a plate at 3.8 and one at 0.6"))):
        draw_rows(d, (60 + 430 * i, 50, 370, 230), data[which], title, 2.5)
    d.line((60, 336), (82, 336), INK, 2.6)
    d.text((88, 340), "exact", 12)
    key(d, (170, 340), [(style, name) for style, (name, _) in zip((1, 0, 2), data["wall"][1:])], 130)
    d.text((560, 340), "Light at height 5, half-size 0.7 and 0.9; maps of 256 × 256.", 11.5)
    return d.finish()


def measure_pcf(runner):
    data = {"rows": []}
    for y in (4.5, 2.5, 0.5):
        world = row_scene([square("plate", [0, y, 0], 0.16 * (5 - y) + 0.2, 2.0)], half=0.4)
        data["rows"].append([y, rows_of(runner, world, [("pcf", "pcf:size=128:window=7")])])
    tilted = scene([], half=0.2, floor_casts=True)
    tilted["meshes"][0]["quad"]["halfU"] = [2.5 * 0.866, 1.25, 0]
    tilted["camera"] = {"eye": [0, 4, 4], "target": [0, 0, 0], "verticalFov": 30}
    variants = [("own depth", "pcf:size=128:window=7:bias=0:receiverPlane=off"), ("plane", "pcf:size=128:window=7")]
    found = runner.compare(tilted, [entry for _, entry in variants])
    for name, entry in variants:
        values = [round(49 * v) for v, r, a in zip(found[entry]["V"], found["truth"]["V"], found["truth"]["A"]) if a > 0 and r == 1]
        data[name] = [rounded(sum(v == k for v in values) / len(values)) for k in range(50)]
    return data


def draw_pcf(data):
    d = Drawing(900, 372, "Course notes, figures 4.2 and 4.3: percentage-closer filtering has one window for all, and shades tilted planes",
                "Left: V along a line below a plate at three heights; the exact penumbra narrows toward the floor, that of pcf does not. Right: how often each "
                "of the 50 values of a 7 by 7 window is found on a tilted, fully lit plane.")
    chart = Chart(d, (60, 50, 470, 230), (-2.5, 2.5), (0, 1.08), "(a) below a plate at heights 4.5, 2.5 and 0.5", "x on the floor", "V", x_ticks=(-2, -1, 0, 1, 2),
                  y_ticks=(0, 0.25, 0.5, 0.75, 1))
    for style, (_, rows) in enumerate(data["rows"]):
        xs = [0.98 * 2.5 * (2 * (i + 0.5) / WIDTH - 1) for i in range(WIDTH)]
        chart.path(list(zip(xs, rows[0][1])), STYLES[style][0], 2.4)
        chart.path(list(zip(xs, rows[1][1])), STYLES[style][0], 1.6, "5 3")
    for style, (y, _) in enumerate(data["rows"]):
        d.line((60 + 110 * style, 336), (82 + 110 * style, 336), STYLES[style][0], 2.4)
        d.text((88 + 110 * style, 340), f"height {y:g}", 12)
    d.text((400, 340), "full line: exact; dashed: pcf, 7 × 7 of 128 × 128 texels", 12)
    chart = Chart(d, (600, 50, 260, 230), (-1, 50), (0, 1.05), "(b) a lit plane, tilted by 30°", "texels of 49 that do not shade", "share of pixels",
                  x_ticks=(0, 21, 28, 49), y_ticks=(0, 0.25, 0.5, 0.75, 1))
    for k, share in enumerate(data["own depth"]):
        if share:
            chart.bar(k, share, 0.7, RED)
            if share > 0.05:
                chart.note(k, share, f"{share:.2f}", RED, "end" if k < 25 else "start", (-4 if k < 25 else 4, 6))
    for k, share in enumerate(data["plane"]):
        if share:
            chart.bar(k, share, 0.7, STYLES[0][0])
            chart.note(k, share, f"{share:.2f}", STYLES[0][0], "end", (0, -5))
    d.text((560, 358), "red: compared with p's own depth, no bias; blue: with p's plane", 12)
    return d.finish()


OCCLUDERS = [("patches", "backproject:size=64:fill=none"), ("patches, edges filled", "backproject:size=64"), ("patches, diagonal too", "backproject:size=64:fill=diagonal"),
             ("bitmask of patches", "bitmask:size=64:occluder=patch"), ("bitmask, patches filled", "bitmask:size=64:occluder=patch:fill=edges"), ("bitmask of quads", "bitmask:size=64"),
             ("bitmask of triangles too", "bitmask:size=64:occluder=triangle"), ("contour", "contour:size=64:traversal=hierarchy")]


def bars(half=0.026):
    return [square(f"bar{i}", [(i - 4) * 0.2, 2.5, 0], half, 1.2) for i in range(9)]


def slope():
    return {"name": "slope", "quad": {"center": [0, 2.5, 0], "halfU": [1, -1.2, 0], "halfV": [0.0, 0, -1]}}


def turned_slope():
    return {"name": "slope", "quad": {"center": [0, 2.5, 0], "halfU": [0.7, -1.2, 0.7], "halfV": [0.7, 0, -0.7]}}


def overlapping():
    """Returns two plates that are apart as seen from the light's centre, and one behind the other as seen from below their sides."""
    return [square("left", [-0.5, 3.4, 0], 0.42, 1.2), square("right", [0.55, 2.2, 0], 0.42, 1.2)]


GAP_SCENES = {"plate over plate": lambda: (scene([square("small", [0, 3.5, 0], 0.3), square("large", [0, 1.5, 0], 1.6)], half=0.6)),
              "slope": lambda: scene([slope()], half=0.6), "slope turned by 45°": lambda: scene([turned_slope()], half=0.6),
              "ball": lambda: scene([ball()], half=0.5), "bars 1 texel wide": lambda: scene(bars(0.02), half=0.4), "plates that overlap": lambda: scene(overlapping(), half=0.9)}


def measure_gaps(runner):
    data = {}
    for name, make in GAP_SCENES.items():
        found = runner.compare(make(), [entry for _, entry in OCCLUDERS], samples=256, size=40)
        data[name] = [measures(found, entry, ("rmse", "bias", "leak", "umbra")) for _, entry in OCCLUDERS]
    return data


def shade(value, worst):
    """Returns a pale colour: redder the brighter a value is than the truth, bluer the darker."""
    part = min(abs(value) / worst, 1)
    other = round(255 - 110 * part)
    return f"#ff{other:02x}{other:02x}" if value > 0 else f"#{other:02x}{other:02x}ff"


def draw_gaps(data):
    d = Drawing(900, 400, "Course notes, figure 5.8: gaps and overlaps of micropatches, quads and contours",
                "A table: eight kinds of occluders against six scenes; in each cell the mean error of V and the share of the umbra that leaks.")
    d.text((20, 28), "Mean error of V, + too bright, − too dark; below it the share of the umbra with V > 0.05", 14, bold=True)
    for c, name in enumerate(data):
        d.text((240 + 110 * c, 56), name, 10.5, anchor="middle", bold=True)
    for r, (name, _) in enumerate(OCCLUDERS):
        y = 66 + 38 * r
        d.text((16, y + 23), name, 12)
        for c, rows in enumerate(data.values()):
            x, cell = 187 + 110 * c, rows[r]
            d.polygon([(x, y), (x + 106, y), (x + 106, y + 35), (x, y + 35)], shade(cell["bias"], 0.08))
            d.text((x + 53, y + 15), f"{cell['bias']:+.4f}", 12, anchor="middle")
            d.text((x + 53, y + 30), f"leak {cell['leak']:.2f}" if cell["umbra"] else "no umbra", 11, DARK, anchor="middle")
    d.text((16, 388), "Maps of 64 × 64; bitmasks of 256 light samples; lights of half-size 0.4 to 0.9 at height 5.", 11.5)
    return d.finish()


FUSION = [("exact", None), ("occlusion textures", "occlusion-textures:slices=32"), ("backproject", "backproject:size=512"), ("bitmask of patches", "bitmask:size=512:occluder=patch"),
          ("contour", "contour:size=512:traversal=hierarchy"), ("soft-volume", "soft-volume"), ("pcss", PCSS)]
LAYOUTS = {"apart": (0.0, 0.8), "half overlapping": (-0.4, 0.4), "nested": (-0.8, 0.0)}


def measure_fusion(runner):
    """Measures two plates that each hide 0.4 of the light from the floor's middle. The light is 2 wide at height 5; the plates are at 3 and 2."""
    data = {}
    for name, (first, last) in LAYOUTS.items():
        a, b = (-0.8 * 3 / 5, 0.0), (first * 2 / 5, last * 2 / 5)
        casters = [square("upper", [(a[0] + a[1]) / 2, 3, 0], (a[1] - a[0]) / 2, 1.5), square("lower", [(b[0] + b[1]) / 2, 2, 0], (b[1] - b[0]) / 2, 1.5)]
        variants = [entry for _, entry in FUSION if entry]
        found = runner.compare(scene(casters, half=1.0, floor=0.05, eye=0.01), variants, size=(3, 3), samples=1024)
        data[name] = [rounded(found[entry or "truth"]["V"][4]) for _, entry in FUSION]
    return data


def draw_fusion(data):
    d = Drawing(900, 372, "Course notes, figure 1.6 and section 5.2.5: how methods join what two occluders hide",
                "A chart with three groups. Two plates hide 0.4 of the light each: apart, half overlapping, nested. Exact V is 0.2, 0.4, 0.6; a product of both is "
                "0.36 always, sums are 0.2, a maximum is 0.6.")
    chart = Chart(d, (60, 50, 800, 220), (-0.5, 2.5), (0, 0.8), "V at one point below two plates that hide 0.4 of the light each", "", "V", x_ticks=(0, 1, 2),
                  x_names=list(data), y_ticks=(0, 0.2, 0.4, 0.6, 0.8))
    chart.level(0.36, DARK)
    chart.note(-0.48, 0.36, "product: 0.36", DARK, offset=(0, -5))
    for group, values in enumerate(data.values()):
        for i, value in enumerate(values):
            x = group + (i - 3) * 0.115
            chart.bar(x, value, 0.045, INK if i == 0 else STYLES[i - 1][0])
            chart.note(x, value, f"{value:.2f}", anchor="middle", offset=(0, -4))
    for i, (name, _) in enumerate(FUSION):
        mark(d, (66 + 122 * i, 325), INK if i == 0 else STYLES[i - 1][0], "square", 5)
        d.text((76 + 122 * i, 329), name, 11)
    d.text((60, 358), "Only in the first scene are the plates apart as seen from the light's centre; in the others a single map lacks the hidden part of the lower one.", 11.5)
    return d.finish()


SLICES = [1, 2, 4, 8, 16, 32]


def measure_slices(runner):
    data = {}
    for name, casters in (("ball", [ball()]), ("box", [box([0, 1.5, 0], [0.4, 1, 0.4])]), ("bars", bars())):
        variants = [f"occlusion-textures:size=256:slices={k}" for k in SLICES] + ["convolution:size=256"]
        found = runner.compare(scene(casters, half=0.6), variants)
        data[name] = [measures(found, variant, ("rmse", "bias")) for variant in variants]
    return data


def draw_slices(data):
    d = Drawing(900, 372, "Course notes, section 5.2.5: occlusion textures with 1 to 32 slices",
                "Two charts for three bodies: RMSE and mean error against the number of slices, and of convolution, which has one plane.")
    for i, (field, title, ys, ticks) in enumerate((("rmse", "(a) RMSE of V", (0, 0.3), (0, 0.1, 0.2, 0.3)), ("bias", "(b) mean error of V", (-0.12, 0.12), (-0.1, -0.05, 0, 0.05, 0.1)))):
        chart = Chart(d, (70 + 430 * i, 50, 350, 230), (0.9, 75), ys, title, "slices", "", log_x=True, x_ticks=SLICES + [60], x_names=[str(k) for k in SLICES] + ["conv."], y_ticks=ticks)
        for style, rows in enumerate(data.values()):
            chart.curve(list(zip(SLICES, (row[field] for row in rows))), style)
            chart.curve([(60, rows[-1][field])], style, line=False)
    key(d, (70, 340), list(enumerate(data)), 90)
    d.text((400, 340), "Pictures of 256 × 256 texels, light of half-size 0.6. The notes advise 4 to 16 slices.", 11.5)
    return d.finish()


def measure_variance(runner):
    """Measures two sheets, Δ apart, D above the floor; the lower one covers everything."""
    rows = []
    for share in (0.25, 0.5, 1.0, 2.0, 4.0):  # D / Δ
        total = 3.0
        delta = total / (1 + share)
        casters = [square("upper", [-1.25, total, 0], 1.25, 2.5), square("lower", [0, total - delta, 0], 2.5)]
        world = row_scene(casters, half=0.3)
        entries = ["vssm:size=256:subdivision=none", "vssm:size=256:moments=csm", "vssm:size=256:moments=esm"]
        found = runner.compare(world, entries, size=(WIDTH, 8))
        rows.append([share] + [rounded(max(v for v, r in zip(found[e]["V"], found["truth"]["V"]) if r == 0)) for e in entries])
    return {"rows": rows}


def draw_variance(data):
    d = Drawing(900, 340, "Course notes, figures 4.4 and 4.5: where variance shadow maps leak",
                "A chart of the brightest pixel in an umbra below two sheets against the ratio of their distances: variance shadow maps follow "
                "the closed form, convolution shadow maps leak up to 0.0035, exponential ones do not leak.")
    chart = Chart(d, (60, 50, 480, 220), (0.2, 5), (0, 0.5), "brightest V in the umbra below two sheets", "D / Δ", "V", log_x=True, x_ticks=(0.25, 0.5, 1, 2, 4),
                  y_ticks=(0, 0.1, 0.2, 0.3, 0.4, 0.5))
    chart.path([(x, 1 / (1 + 2 * x) ** 2) for x in (0.2 * 25 ** (i / 60) for i in range(61))], DARK, 2, "6 4")
    for style in (0, 1, 2):
        chart.curve([(row[0], row[1 + style]) for row in data["rows"]], style)
    d.line((570, 96), (592, 96), DARK, 2, "6 4")
    d.text((598, 100), "1 / (1 + 2 D/Δ)², the bound's worst window", 12)
    key(d, (570, 124), [(0, "vssm, subdivision=none"), (1, "moments=csm, 16 terms"), (2, "moments=esm")])
    d.text((570, 200), "Δ between the sheets, D from the lower one to", 12)
    d.text((570, 217), "the floor; the lower sheet covers the whole light,", 12)
    d.text((570, 234), "so V is 0 everywhere.", 12)
    return d.finish()


def measure_levels(runner):
    data = {}
    for name, make in (("ball", lambda: scene([ball()], half=0.5)), ("bars", lambda: scene([square(f"bar{i}", [(i - 2) * 0.5, 2.5, 0], 0.06, 1.2) for i in range(5)], half=0.4))):
        variants = [f"bitmask:size=128:occluder={kind}:level={level}" for kind in ("patch", "quad", "rect") for level in range(5)]
        found = runner.compare(make(), variants, samples=1024)
        data[name] = [[measures(found, variant, ("rmse", "bias")) for variant in variants[5 * k:5 * k + 5]] for k in range(3)]
    return data


def draw_levels(data):
    d = Drawing(900, 372, "Course notes, figure 5.11: coarser micropatches",
                "Two charts: mean error of V against the level, for patches, quads and rectangles. Patches grow darker from level to level, rectangles less.")
    for i, (name, title) in enumerate((("ball", "(a) ball"), ("bars", "(b) bars 6 texels wide"))):
        low = min(0.0, *(row["bias"] for rows in data[name] for row in rows)) * 1.15
        high = max(0.02, *(row["bias"] for rows in data[name] for row in rows)) * 1.6
        chart = Chart(d, (70 + 430 * i, 50, 350, 230), (-0.2, 4.2), (low, high), title, "level: blocks of 2^level texels a side", "mean error of V", x_ticks=range(5))
        step = 0.05 if high - low < 0.4 else 0.2
        for value in [k * step for k in range(int(low / step), int(high / step) + 1)]:
            at = chart.at(-0.2, value)
            d.line(at, (at[0] + 350, at[1]), PALE, 1)
            d.text((at[0] - 5, at[1] + 4), f"{value:.2f}", 11, anchor="end")
        for style, rows in enumerate(data[name]):
            chart.curve([(level, row["bias"]) for level, row in enumerate(rows)], style)
    key(d, (70, 340), [(0, "patches"), (1, "quads"), (2, "rectangles of blocks")], 100)
    d.text((470, 340), "bitmask, 1,024 light samples, map of 128 × 128", 11.5)
    return d.finish()


def measure_layers(runner):
    """Measures a ball, and below it a plate that is hidden from the light's centre."""
    casters = [ball(y=3.0, radius=0.8), square("hidden", [0, 1.2, 0], 0.8)]
    variants = [f"bitmask:size=64:layers={k}" for k in (1, 2, 3, 4)]
    found = runner.compare(scene(casters, half=0.8), variants, samples=256)
    return {"rows": [measures(found, variant, ("rmse", "bias")) for variant in variants],
            "tiles": [picture(found, variants[0], 48), picture(found, variants[3], 48), picture(found, "truth", 48)]}


def draw_layers(data):
    d = Drawing(900, 290, "Course notes, figure 1.8: surfaces missing from one layer as seen from the light's centre",
                "Three pictures of V on the floor: one layer, four layers, exact. With one layer half of the shadow is missing.")
    d.text((30, 28), "V below a ball and a plate that hides behind it", 14, bold=True)
    for i, (name, tile) in enumerate(zip(("1 layer", "4 layers", "exact"), data["tiles"])):
        row = data["rows"][0 if i == 0 else 3]
        image(d, (30 + 215 * i, 40), 190, tile, name, "" if i == 2 else f"RMSE {row['rmse']:.4f}, bias {row['bias']:+.4f}")
    for i, row in enumerate(data["rows"]):
        d.text((690, 90 + 20 * i), f"{i + 1} layer{'s' if i else ''}: RMSE {row['rmse']:.4f}", 12)
    d.text((690, 180), "Quads of every layer, joined", 11.5)
    d.text((690, 196), "in bitmasks of 256 samples;", 11.5)
    d.text((690, 212), "map of 64 × 64.", 11.5)
    return d.finish()


BALLS = (8, 32, 128, 512)  # segments
MODELS = {"asteroid, low": "asteroid-low.3ds", "horse": "horse.3ds", "cat": "cat.3ds", "asteroid, high": "asteroid-high.3ds", "bunny": "bunny.obj"}


def silhouettes(runner, body):
    """Returns the number of triangles of a body about 2 high around (0, 2, 0), and its mean number of silhouette edges, over six lights
    on the axes of an icosahedron, each 5 away and facing the body."""
    world = scene([body])
    del world["meshes"][0]  # the floor
    golden = (1 + sqrt(5)) / 2
    world["lights"] = []
    for k, axis in enumerate([(0, 1, golden), (0, -1, golden), (1, golden, 0), (-1, golden, 0), (golden, 0, 1), (golden, 0, -1)]):
        away = [x / sqrt(1 + golden**2) for x in axis]
        side = [x / sqrt(away[0]**2 + away[1]**2) for x in (away[1], -away[0], 0)]
        world["lights"].append({"name": f"light {k}", "rectangle": {"center": [5 * away[0], 2 + 5 * away[1], 5 * away[2]], "halfU": [0.05 * x for x in side],
                                                                    "halfV": [0.05 * x for x in cross(side, away)]}})
    args = ["--methods", "soft-volume", "--reference-samples", "1", "--sample-pixels", "1", "--runs", "1", "--size", "8x8"]
    command = "penumbra compare SCENE -o OUT " + " ".join(args)
    if command not in runner.commands:
        runner.commands.append(command)
    with tempfile.TemporaryDirectory() as folder:
        path, out = Path(folder) / "scene.json", Path(folder) / "out"
        path.write_text(json.dumps(world), encoding="utf-8")
        subprocess.run([runner.program, "-q", "compare", path, "-o", out, *args], check=True, stdout=subprocess.DEVNULL)
        entry = json.loads((out / "metrics.json").read_text(encoding="utf-8"))["methods"][0]
    assert entry["failure"] is None, entry["failure"]
    runner.device = entry["device"]
    return [entry["triangles"], rounded(entry["counters"]["silhouetteEdges"] / len(world["lights"]))]


def measure_silhouettes(runner):
    return {"balls": [[f"ball of {count} segments", *silhouettes(runner, ball(segments=count))] for count in BALLS],
            "models": [[name, *silhouettes(runner, {"name": "model", "package": {"name": "glmark2-data", "file": f"models/{file}"}, "fit": {"height": 2.0, "base": [0, 1, 0]}})]
                       for name, file in MODELS.items()]}


def power_of(rows):
    """Returns c and e of the curve c n^e nearest to the rows, by least squares of the logarithms."""
    logs = [(log(n), log(edges)) for _, n, edges in rows]
    mean_n, mean_edges = (sum(pair[k] for pair in logs) / len(logs) for k in range(2))
    e = sum((n - mean_n) * (edges - mean_edges) for n, edges in logs) / sum((n - mean_n)**2 for n, _ in logs)
    return exp(mean_edges - e * mean_n), e


def draw_silhouettes(data):
    d = Drawing(900, 372, "Course notes, section 5.3.4: silhouette edges against triangles",
                "A chart with two logarithmic axes. For balls of more and more segments, silhouette edges grow with the square root of the triangles; for five models they grow "
                "with nearly the number of triangles. Silhouette edges are always far fewer than triangles.")
    chart = Chart(d, (70, 50, 520, 250), (30, 5e5), (5, 4e4), "silhouette edges, mean over six lights", "triangles n", "", log_x=True, log_y=True, x_ticks=(100, 1000, 10000, 100000),
                  x_names=("100", "1,000", "10,000", "100,000"), y_ticks=(10, 100, 1000, 10000))
    ends = (40, 4e5)
    chart.path([(n, n**0.8) for n in ends], INK, 1.5, "6 4")
    fits = [power_of(rows) for rows in data.values()]
    for style, (rows, (c, e)) in enumerate(zip(data.values(), fits)):
        chart.path([(n, c * n**e) for n in ends], STYLES[style][0], 1.5)
        chart.curve([row[1:] for row in rows], style, line=False)
    d.line((625, 66), (647, 66), INK, 1.5, "6 4")
    d.text((653, 70), "n^0.8, the notes' exponent", 12)
    for style, (name, (c, e)) in enumerate(zip(("a ball, cut finer", "five models"), fits)):
        key(d, (625, 94 + 24 * style), [(style, f"{name}: {c:.2f} n^{e:.2f}")])
    for i, (name, n, edges) in enumerate(data["balls"] + data["models"]):
        d.text((625, 154 + 18 * i), name, 11.5)
        d.text((815, 154 + 18 * i), f"{n:,}", 11.5, anchor="end")
        d.text((880, 154 + 18 * i), f"{edges:,.0f}" if edges >= 100 else f"{edges:.1f}", 11.5, anchor="end")
    d.text((70, 358), "Lights of half-size 0.05, 5 from the middle of bodies 2 high, on six axes of an icosahedron.", 11.5)
    return d.finish()


FIGURES = {
    "course-fusion": (measure_fusion, draw_fusion),
    "course-layers": (measure_layers, draw_layers),
    "course-pcf": (measure_pcf, draw_pcf),
    "course-variance": (measure_variance, draw_variance),
    "course-pcss": (measure_pcss, draw_pcss),
    "course-gaps": (measure_gaps, draw_gaps),
    "course-levels": (measure_levels, draw_levels),
    "course-slices": (measure_slices, draw_slices),
    "course-silhouettes": (measure_silhouettes, draw_silhouettes),
}
