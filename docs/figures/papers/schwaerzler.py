# SPDX-License-Identifier: Apache-2.0
"""Figures of M. Schwärzler, *Real-time soft shadows with adaptive light source sampling*: maps where they are needed.
The paper gives no value of epsilon; the figures show its effect."""

from math import cos, radians, sin

from chart import Chart, image, key
from drawing import DARK, Drawing
from experiment import ball, measures, picture, scene, square

EPSILONS = [0.003, 0.006, 0.012, 0.02, 0.03, 0.045, 0.07, 0.1, 0.15, 0.25]


def entry(epsilon, more=""):
    return f"adaptive-light:size=128:shareOf=pixels:epsilon={epsilon:g}{more}"


def world_of(body, half):
    """Returns a scene whose caster is close to the floor, so that penumbrae are narrow."""
    return scene([turned_plate(0.8) if body == "plate" else ball(y=1.1, radius=0.9)], half=half)


def turned_plate(y, half=0.9, turn=20):
    """Returns a plate that is turned, so that its edges are aligned neither with the light's points nor with texels."""
    c, s = half * cos(radians(turn)), half * sin(radians(turn))
    return {"name": "plate", "quad": {"center": [0, y, 0], "halfU": [c, 0, s], "halfV": [s, 0, -c]}}


CASES = [("plate", 0.1), ("plate", 0.5), ("plate", 1.5), ("ball", 0.5)]


def measure_maps(runner):
    data = {}
    for body, half in CASES:
        entries = [entry(epsilon) for epsilon in EPSILONS] + [entry(0)]
        found = runner.compare(world_of(body, half), entries + ["accumulate:size=128"], samples=128)
        data[f"{body}, {half:g}"] = {"adaptive": [[found[e]["counters"]["maps"], measures(found, e)["rmse"]] for e in entries],
                             "fixed": measures(found, "accumulate:size=128")["rmse"]}
    return data


def draw_maps(data):
    d = Drawing(900, 372, "Schwärzler, section 3.3: maps and error against epsilon",
                "Two charts for lights of three sizes. The number of maps falls from 81 to 4 as epsilon grows, sooner for small lights; "
                "the error falls with the number of maps, to a floor.")
    xs = EPSILONS
    chart = Chart(d, (60, 50, 350, 220), (0.0025, 0.3), (0, 90), "(a) maps of the light, of 81 at most", "epsilon, share of the pixels that may differ", "maps",
                  log_x=True, x_ticks=(0.003, 0.01, 0.03, 0.1, 0.3), y_ticks=(4, 14, 25, 50, 81))
    for style, half in enumerate(data):
        chart.curve([(x, maps) for x, (maps, _) in zip(xs, data[half]["adaptive"])], style)
    chart = Chart(d, (510, 50, 350, 220), (3.5, 140), (0.002, 0.3), "(b) error against maps", "maps", "RMSE of V", log_x=True, log_y=True,
                  x_ticks=(4, 9, 14, 25, 44, 81, 128), y_ticks=(0.003, 0.01, 0.03, 0.1, 0.3))
    for style, half in enumerate(data):
        points = sorted({tuple(point) for point in data[half]["adaptive"]})
        chart.curve(points, style)
        chart.curve([(128, data[half]["fixed"])], style, line=False)
    chart.note(128, min(data[half]["fixed"] for half in data), "128 fixed", DARK, "end", (6, 20))
    key(d, (60, 335), [(style, f"{case}") for style, case in enumerate(data)], 120)
    d.text((60, 360), "Caster and half the light's side; maps of 128 × 128. Markers at 128: as many fixed light samples (accumulate, without a filter).", 11.5)
    return d.finish()


def measure_pictures(runner):
    """Uses the largest epsilon of a geometric series that still gives 14 maps or more: the paper's figure 1 has 14 instead of 81."""
    world = world_of("plate", 0.35)
    row = [0.005 * 1.35 ** i for i in range(12)]
    found = runner.compare(world, [entry(epsilon) for epsilon in row], size=48)
    fit = max((epsilon for epsilon in row if found[entry(epsilon)]["counters"]["maps"] >= 14), default=row[0])
    variants = [("all corners", entry(0)), ("adaptive", entry(fit)), ("4 corners", entry(1)), ("adaptive, weights=area", entry(fit, ":weights=area"))]
    found = runner.compare(world, [e for _, e in variants], size=64)
    tiles = [[name, picture(found, e, 64), found[e]["counters"]["maps"], measures(found, e)["rmse"]] for name, e in variants]
    lines = []
    for y, half in ((0.8, 0.2), (2.2, 1.0)):
        world = scene([turned_plate(y)], half=half, half_z=0.002)
        for epsilon in (0, 0.02, 0.08):
            e = entry(epsilon, ":form=line:levels=6")
            found = runner.compare(world, [e], size=48)
            lines.append([half, epsilon, found[e]["counters"]["maps"], measures(found, e)["rmse"]])
    return {"epsilon": float(f"{fit:.4g}"), "tiles": tiles + [["exact", picture(found_truth(runner), "truth", 64), 0, 0.0]], "lines": lines}


def found_truth(runner):
    return runner.compare(world_of("plate", 0.35), [], size=64)


def draw_pictures(data):
    d = Drawing(900, 330, "Schwärzler, figures 1 and 7: 81 maps, fewer where they are enough, and the truth",
                "Five pictures of V below a plate: 81 corner maps, adaptively chosen ones, four corners with visible steps, adaptive ones with each "
                "cell's share of the light, exact. Below them numbers for a linear light.")
    d.text((20, 28), "V on the floor below a plate, light of half-size 0.35", 14, bold=True)
    for i, (name, tile, maps, error) in enumerate(data["tiles"]):
        image(d, (20 + 174 * i, 40), 162, tile, name, f"{maps} maps, RMSE {error:.4f}" if maps else "")
    text = []
    for half in dict.fromkeys(row[0] for row in data["lines"]):
        rows = [row for row in data["lines"] if row[0] == half]
        text.append(f"line of half-length {half:g}: " + "; ".join(f"{maps} maps, RMSE {error:.4f}" for _, _, maps, error in rows))
    d.text((20, 268), "Linear light (figure 7), epsilon 0, 0.02 and 0.08 of the pixels:", 12, bold=True)
    for i, line in enumerate(text):
        d.text((20, 288 + 18 * i), line, 12)
    return d.finish()


TILT_EPSILONS = [0.02, 0.04, 0.08]


def measure_tilt(runner):
    """Measures a receiver that is turned below a fixed plate; the camera turns with the receiver."""
    rows = []
    for tilt in (0, 15, 30, 45, 60):
        c, s = cos(radians(tilt)), sin(radians(tilt))
        world = scene([square("plate", [0, 2.5, 0], 0.6, receivesShadow=False)], half=0.3)
        world["meshes"][0]["quad"] = {"center": [0, -3 * s, 0], "halfU": [4 * c, -4 * s, 0], "halfV": [0, 0, -4]}
        world["camera"] = {"eye": [7 * s, 7 * c, 3], "target": [0, -2 * s, 0], "verticalFov": 60}
        entries = [f"adaptive-light:size=64:shareOf=pixels:epsilon={epsilon:g}:gamma=0.1" for epsilon in TILT_EPSILONS]
        found = runner.compare(world, entries, size=64)
        penumbra = sum(0 < r < 1 and a > 0 for r, a in zip(found["truth"]["V"], found["truth"]["A"]))
        rows.append([tilt, penumbra] + [found[e]["counters"]["maps"] for e in entries])
    return {"rows": rows}


def draw_tilt(data):
    d = Drawing(900, 300, "Schwärzler, figure 4: a tilted receiver has a wider penumbra and needs more maps",
                "Two charts against the tilt of the floor: pixels in penumbra and maps, of 81 at most.")
    rows = data["rows"]
    chart = Chart(d, (60, 50, 350, 180), (-2, 62), (0, 90), "maps, of 81 at most", "tilt of the receiver, degrees", "maps", x_ticks=(0, 15, 30, 45, 60),
                  y_ticks=(4, 25, 50, 81))
    for style in range(len(TILT_EPSILONS)):
        chart.curve([(row[0], row[2 + style]) for row in rows], style)
    top = 1.2 * max(row[1] for row in rows)
    chart = Chart(d, (510, 50, 350, 180), (-2, 62), (0, top), "pixels in penumbra", "tilt of the receiver, degrees", "", x_ticks=(0, 15, 30, 45, 60))
    chart.curve([(row[0], row[1]) for row in rows], 4)
    for row in rows:
        chart.note(row[0], row[1], row[1], anchor="middle", offset=(0, -9))
    key(d, (60, 286), [(style, f"epsilon {epsilon:g}") for style, epsilon in enumerate(TILT_EPSILONS)], 110)
    d.text((400, 286), "A plate above a receiver that is turned; 64 × 64 pixels and maps of 64 × 64, gamma 0.1.", 11.5)
    return d.finish()


FIGURES = {
    "schwaerzler-maps": (measure_maps, draw_maps),
    "schwaerzler-pictures": (measure_pictures, draw_pictures),
    "schwaerzler-tilt": (measure_tilt, draw_tilt),
}
