# SPDX-License-Identifier: Apache-2.0
"""Figures of L. Bavoil, S. Callahan, C. Silva, *Robust soft shadow mapping with depth peeling*, University of Utah,
UUSCI-2006-028: layers, gap filling and midpoints. Strands of hair replace the paper's dandelion."""

from chart import Chart, image, key
from drawing import DARK, Drawing
from experiment import ball, box, measures, picture, scene, square
from yang import gap_casters

PEEL, DEEPEST, QUADS = 0, 1, 2


def hair():
    return {"name": "hair", "shape": {"type": "hair", "base": [0, 1.6, 0], "radius": 0.7, "length": 1.1, "width": 0.03, "bend": 0.8,
                                      "strands": 90, "segments": 6, "seed": 7}}


BODIES = {"plates": lambda: scene(gap_casters(), half=0.6), "ball": lambda: scene([ball()], half=1.0), "hair": lambda: scene([hair()], half=0.6)}


def measure_layers(runner):
    data = {}
    for body, make in BODIES.items():
        fills = ["backproject:size=64:fill=none", "backproject:size=64"]
        entries = [f"{variant}:layers={k}" for variant in ("backproject-peel:size=64:samples=0", "backproject-peel:size=64:samples=0:select=deepest",
                                                   "bitmask:size=64") for k in (1, 2, 3, 4)]
        found = runner.compare(make(), fills + entries, samples=256, size=40)
        keep = ("rmse", "bias", "leak")
        data[body] = {"fill": [measures(found, entry, keep) for entry in fills],
                      "layers": [[measures(found, entry, keep) for entry in entries[4 * variant:4 * variant + 4]] for variant in range(3)]}
    return data


def draw_layers(data):
    d = Drawing(900, 400, "Bavoil et al. 2006, figure 6: error against the number of layers",
                "Three charts. Between two plates the second layer removes the error. Under a ball the paper's choice of a layer makes it "
                "greater, the deepest layer does not. For hair layers help and filled gaps are darker than they should be.")
    for i, body in enumerate(data):
        chart = Chart(d, (50 + 290 * i, 50, 240, 230), (0.8, 4.2), (0, 0.28), f"({'abc'[i]}) {body}", "layers", "RMSE of V", x_ticks=(1, 2, 3, 4),
                      y_ticks=(0, 0.05, 0.1, 0.15, 0.2, 0.25))
        filled = data[body]["fill"][1]
        chart.level(filled["rmse"], DARK)
        chart.note(0.9, 0.238, f"dashed: gaps filled, bias {filled['bias']:+.3f}", DARK)
        for style in (QUADS, DEEPEST, PEEL):
            chart.curve([(k + 1, row["rmse"]) for k, row in enumerate(data[body]["layers"][style])], style)
        leaks = [f"{row['leak']:.2f}" for row in data[body]["layers"][PEEL]]
        chart.note(0.9, 0.26, "leak (paper's): " + ", ".join(leaks) if body != "hair" else "no umbra")
    key(d, (50, 345), [(PEEL, "peel, the deepest layer that hides light (paper)"), ], 290)
    key(d, (390, 345), [(DEEPEST, "peel, the deepest layer"), (QUADS, "bitmask, quads of all layers")], 200)
    d.text((50, 376), "Maps of 64 × 64, all texels. Leak: share of the exact umbra with V > 0.05. Light of half-size 0.6, for the ball 1.", 11.5)
    return d.finish()


def measure_gaps(runner):
    variants = [("no filling", "backproject:size=128:fill=none"), ("gaps filled", "backproject:size=128"),
            ("3 layers", "backproject-peel:size=128:samples=0")]
    data = {}
    for body in ("plates", "hair"):
        found = runner.compare(BODIES[body](), [entry for _, entry in variants], size=64)
        data[body] = [[name, picture(found, entry, 64), measures(found, entry, ("rmse", "bias"))] for name, entry in variants]
        data[body].append(["exact", picture(found, "truth", 64), None])
    return data


def draw_gaps(data):
    d = Drawing(900, 530, "Bavoil et al. 2006, figures 1, 2 and 4: gaps that leak, gaps that are filled, and layers",
                "Two rows of four pictures of V: two plates, hair; no filling, gaps filled, three layers, exact. Light leaks through the "
                "large plate's shadow without filling; with filled gaps hair has too dark a shadow.")
    d.text((30, 28), "V on the floor, maps of 128 × 128; above a small plate over a large one, below hair", 14, bold=True)
    for row, body in enumerate(data):
        for i, (name, tile, error) in enumerate(data[body]):
            image(d, (30 + 215 * i, 40 + 245 * row), 195, tile, name,
                  "" if error is None else f"RMSE {error['rmse']:.3f}, bias {error['bias']:+.3f}")
    return d.finish()


BIASES = [0.0, 0.125, 0.5, 2.0, 8.0, 32.0, 128.0]


def measure_bias(runner):
    """Measures biases on a ball and a box on a floor. The floor casts, too, and the camera sees the shaded sides of both objects."""
    world = scene([ball(y=0.8, x=-0.9, radius=0.8, segments=32), box([1.0, 0.5, 0], [0.5, 0.5, 0.5])], half=0.5, floor_casts=True)
    world["camera"] = {"eye": [1.5, 4.2, 4.6], "target": [0, 0.4, 0], "verticalFov": 42}
    variants = ["backproject:size=128:fill=none:depth={}:bias={}", "bitmask:size=128:depth={}:bias={}"]
    entries = [variant.format("first", bias) for variant in variants for bias in BIASES]
    others = ["backproject:size=128:fill=none:depth=midpoint:bias=0", "backproject:size=128:fill=none:depth=dual:bias=0.5"]
    found = runner.compare(world, entries + others, size=40)
    keep = ("dark", "leak", "rmse")
    rows = [measures(found, entry, keep) for entry in entries]
    return {"patch": rows[:len(BIASES)], "quad": rows[len(BIASES):], "midpoint": measures(found, others[0], keep), "dual": measures(found, others[1], keep)}


def draw_bias(data):
    d = Drawing(900, 372, "Bavoil et al. 2006, figure 3: too little bias shades lit surfaces, too much moves the shadow",
                "Three charts against the bias: the share of lit pixels that are dark falls, that of the umbra that is lit rises, and RMSE has a "
                "minimum between. Midpoints without any bias come near to the best of them.")
    xs = [1 / 32] + BIASES[1:]
    names = ["0"] + [f"{bias:g}" if bias >= 0.5 else f"1/{round(1 / bias)}" for bias in BIASES[1:]]
    for i, (field, title) in enumerate((("dark", "(a) lit pixels with V < 0.95"), ("leak", "(b) umbra with V > 0.05"), ("rmse", "(c) RMSE of V"))):
        top = 1.25 * max(row[field] for variant in ("patch", "quad") for row in data[variant])
        chart = Chart(d, (60 + 285 * i, 50, 230, 220), (0.025, 170), (0, top), title, "bias, texels", "", log_x=True, x_ticks=xs, x_names=names)
        for k in range(1, 5):
            value = top * k / 5
            at = chart.at(0.025, value)
            d.text((at[0] - 5, at[1] + 4), f"{value:.3f}", 11, anchor="end")
        chart.level(data["midpoint"][field], DARK, text=f"midpoints: {data['midpoint'][field]:.3f}")
        chart.curve([(x, row[field]) for x, row in zip(xs, data["patch"])], 0)
        chart.curve([(x, row[field]) for x, row in zip(xs, data["quad"])], 1)
    key(d, (60, 335), [(0, "patches"), (1, "quads")], 110)
    d.text((300, 335), "A ball and a box on a floor that casts; map of 128 × 128, compared with the receiver's plane.", 11.5)
    return d.finish()


FIGURES = {
    "bavoil-layers": (measure_layers, draw_layers),
    "bavoil-gaps": (measure_gaps, draw_gaps),
    "bavoil-bias": (measure_bias, draw_bias),
}
