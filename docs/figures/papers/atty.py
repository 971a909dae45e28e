# SPDX-License-Identifier: Apache-2.0
"""Figures of L. Atty, N. Holzschuch, M. Lapierre, J.-M. Hasenfratz, C. Hansen, F. Sillion, *Soft shadow maps: efficient
sampling of light source visibility*, Computer Graphics Forum 25 (4), 2006: error and work of `soft-shadow-map`.

The paper's Buddha is not available; a ball takes its place. The measure of errors is the paper's (section 5.2.1)."""

from chart import Chart, image, key
from drawing import INK, Drawing
from experiment import ball, box, bunny, measures, picture, rounded, scene, square

ONE, TWO, CONTOUR, SUB = 0, 1, 2, 3
NAMES = ["one pass", "two passes", "contour", "packet, 2 × 2 sub-lights"]


def methods(size, receivers=128):
    return [f"soft-shadow-map:size={size}:receiverSize={receivers}",
            f"soft-shadow-map:size={size}:receiverSize={receivers}:passes=2"]


def plate(y=2.5, half=0.8, x=0.0):
    return square("plate", [x, y, 0], half)


def with_speck(y=2.5, half=0.8, x=0.0):
    """Returns a plate, and a speck off its corner that widens the map's window by a fraction of a texel. Without the speck the map,
    which fits the casters, would end at the plate's edges, and texel borders would fall on these edges at every size."""
    return [plate(y, half, x), square("speck", [x + half + 0.057 * half, y, half + 0.031 * half], 0.002)]


def s0_curves(runner, cases, size=128, beside=("contour:size={}:traversal=hierarchy",), receivers=128, pixels=48):
    """Measures, for each (x, scene), the paper's error of one and two passes, and of the methods in `beside`."""
    rows = []
    for x, world, of in cases:
        entries = methods(of or size, receivers) + [text.format(of or size) for text in beside]
        found = runner.compare(world, entries, size=pixels)
        rows.append([x] + [measures(found, entry)["s0"] for entry in entries])
    return rows


BODIES = {"plate": with_speck, "ball": lambda: [ball()], "bunny": lambda: [bunny()]}


def measure_resolution(runner):
    sizes = {"plate": [16, 17, 19, 22, 24, 27, 30, 32, 33, 36, 40, 45, 50, 57, 64, 72, 80, 96, 112, 128, 160, 192, 224, 256],
             "ball": [16, 24, 32, 48, 64, 96, 128, 192, 256], "bunny": [16, 24, 32, 48, 64, 96, 128, 192, 256]}
    beside = ("contour:size={}:traversal=hierarchy", "packet:size={}:sublights=2")
    return {body: s0_curves(runner, [(size, scene(make()), size) for size in sizes[body]], beside=beside)
            for body, make in BODIES.items()}


def draw_resolution(data):
    d = Drawing(900, 372, "Atty et al. 2006, figure 17: error of soft shadow maps against the resolution of the occluder map",
                "Three charts. Plate: one pass equals two, the error keeps falling, with spikes. Ball and bunny: the error of "
                "one pass and of two stays where it is beyond some 60 texels; contour and two by two sub-lights fall below it.")
    for i, (body, top) in enumerate((("plate", 0.08), ("ball", 0.08), ("bunny", 0.08))):
        chart = Chart(d, (50 + 290 * i, 50, 240, 220), (0, 260), (0, top), f"({'abc'[i]}) {body}", "texels on a side of the map",
                      "error", x_ticks=(0, 64, 128, 192, 256), y_ticks=(0, 0.02, 0.04, 0.06, 0.08))
        for style in (SUB, CONTOUR, ONE, TWO):
            chart.curve([(row[0], row[1 + style]) for row in data[body]], style)
    key(d, (50, 335), list(enumerate(NAMES)), 190)
    d.text((50, 360), "Light 1 wide. Mean |V − V exact| over the pixels in umbra or penumbra. Maps of contour and packet hold all receivers.", 11.5)
    return d.finish()


LIGHTS = [0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0]


def measure_light(runner):
    return {body: s0_curves(runner, [(half, scene(make(), half=half), None) for half in LIGHTS]) for body, make in BODIES.items()}


def draw_light(data):
    d = Drawing(900, 372, "Atty et al. 2006, figure 18: error against the size of the light",
                "Three charts. Plate: the error falls with the light and stays small. Ball and bunny: the error of one "
                "pass grows with the light, that of two passes too, at about half the height; contour lies below.")
    for i, body in enumerate(BODIES):
        chart = Chart(d, (50 + 290 * i, 50, 240, 220), (0, 1.04), (0, 0.1), f"({'abc'[i]}) {body}", "half the light's side", "error",
                      x_ticks=(0, 0.25, 0.5, 0.75, 1), y_ticks=(0, 0.02, 0.04, 0.06, 0.08, 0.1))
        for style in (CONTOUR, ONE, TWO):
            chart.curve([(row[0], row[1 + style]) for row in data[body]], style)
    key(d, (50, 335), list(enumerate(NAMES))[:3], 190)
    d.text((50, 360), "Maps of 128 × 128, the light 5 above the floor; ball of radius 1, bunny 2 high, plate 1.6 wide.", 11.5)
    return d.finish()


def listed(casters):
    return casters if isinstance(casters, list) else [casters]


def measure_place(runner):
    coarse = {"size": 64, "receivers": 96, "pixels": 36}
    sideways = {"ball": lambda x: ball(x=x), "box": lambda x: box([x, 1.5, 0], [0.4, 1, 0.4]), "plate": lambda x: with_speck(x=x)}
    deep = {"ball": 3, "box": 3.5, "plate": 2.5}
    across = {body: s0_curves(runner, [(x, scene(listed(make(x)), floor=3.0, center=(x * 5 / deep[body], 0)), None)
                                       for x in (0, 0.5, 1.0, 1.5, 2.0)], **coarse) for body, make in sideways.items()}
    upright = {"ball": (lambda y: ball(y=y, radius=0.6), (0.65, 1.4, 2.2, 3.0, 3.8)),
               "bunny": (lambda y: bunny(base=y, height=1.5), (0.02, 1.0, 2.0, 2.8)),
               "plate": (lambda y: with_speck(y=y, half=0.6), (0.05, 1.2, 2.4, 3.6, 4.4))}
    up = {body: s0_curves(runner, [(y, scene(listed(make(y))), None) for y in ys], **coarse) for body, (make, ys) in upright.items()}
    return {"across": across, "up": up}


def draw_place(data):
    d = Drawing(900, 660, "Atty et al. 2006, figures 19 and 20: error against the place of the caster",
                "Two rows of three charts. Moved sideways, the error of the ball is greatest under the light, that of the "
                "box least there. Moved up to the light the error of ball and bunny grows, that of the plate does not.")
    for row, (which, label, xs, ticks) in enumerate((("across", "moved sideways by", (0, 2.05), (0, 0.5, 1, 1.5, 2)),
                                                     ("up", "height over the floor", (0, 4.7), (0, 1, 2, 3, 4)))):
        for i, body in enumerate(data[which]):
            chart = Chart(d, (50 + 290 * i, 50 + 300 * row, 240, 210), xs, (0, 0.15), f"({'abcdef'[3 * row + i]}) {body}", label, "error",
                          x_ticks=ticks, y_ticks=(0, 0.05, 0.1, 0.15))
            for style in (CONTOUR, ONE, TWO):
                chart.curve([(r[0], r[1 + style]) for r in data[which][body]], style)
    key(d, (50, 622), list(enumerate(NAMES))[:3], 190)
    d.text((50, 646), "Maps of 64 × 64, light of half-size 0.5 at height 5. Height: of the ball's centre, the bunny's feet, the plate.", 11.5)
    return d.finish()


def measure_work(runner):
    def entry(size, receivers, passes=1):
        return f"soft-shadow-map:size={size}:receiverSize={receivers}:passes={passes}"

    data = {"triangles": [], "map": [], "light": []}
    for segments in (8, 16, 32, 64, 128, 256):
        one, two = entry(128, 96), entry(128, 96, 2)
        found = runner.compare(scene([ball(segments=segments)]), [one, two])
        c, e = found[one]["counters"], found[two]["counters"]
        data["triangles"].append([2 * segments * (segments // 2 - 1), c["patches"], c["fragments"], e["patches"], e["fragments"]])
    for size in (32, 64, 128, 256):
        found = runner.compare(scene([ball()]), [entry(size, size), entry(size, 96)])
        data["map"].append([size, found[entry(size, size)]["counters"]["fragments"], found[entry(size, 96)]["counters"]["fragments"]])
    for half in (0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0):
        sizes = [24, 64, 192]
        found = runner.compare(scene([ball()], half=half), [entry(size, 96) for size in sizes])
        data["light"].append([half, found[entry(64, 96)]["counters"]["fragments"]] +
                             [measures(found, entry(size, 96))["s0"] for size in sizes])
    return data


def draw_work(data):
    d = Drawing(900, 660, "Atty et al. 2006, figures 21 to 24: the counted cost of soft shadow maps, and small maps for large lights",
                "Four charts. Pairs of texels do not depend on triangles; they grow with the fourth power of both maps' "
                "resolution, with the second of one alone, and with the light; under large lights a map of 24 texels has the error of one of 192.")
    top = max(row[4] for row in data["triangles"])
    chart = Chart(d, (70, 50, 340, 210), (40, 1e5), (0, 1.2 * top), "(a) triangles of the ball (figure 21)", "triangles", "pairs of texels, millions",
                  log_x=True, x_ticks=(100, 1000, 10000, 100000), y_ticks=())
    for value in range(0, int(1.2 * top / 1e6) + 1):
        at = chart.at(40, value * 1e6)
        d.text((at[0] - 5, at[1] + 4), value, 11, anchor="end")
    chart.curve([(row[0], row[2]) for row in data["triangles"]], ONE)
    chart.curve([(row[0], row[4]) for row in data["triangles"]], TWO)
    chart.note(3000, data["triangles"][-1][2], "one pass", offset=(0, 20))
    chart.note(3000, data["triangles"][-1][4], "two passes", offset=(0, -12))
    chart = Chart(d, (520, 50, 340, 210), (28, 300), (1e4, 1e9), "(b) both maps' resolution (figure 22)", "texels on a side", "pairs of texels",
                  log_x=True, log_y=True, x_ticks=(32, 64, 128, 256), y_ticks=(1e4, 1e5, 1e6, 1e7, 1e8, 1e9))
    chart.curve([(row[0], row[1]) for row in data["map"]], ONE)
    chart.curve([(row[0], row[2]) for row in data["map"]], CONTOUR)
    growth = [b[1] / a[1] for a, b in zip(data["map"], data["map"][1:])]
    alone = [b[2] / a[2] for a, b in zip(data["map"], data["map"][1:])]
    chart.note(64, 3e8, "both maps: × " + ", ".join(f"{g:.1f}" for g in growth) + " a doubling")
    chart.note(64, 2e4, "occluder map alone: × " + ", ".join(f"{g:.1f}" for g in alone))
    chart = Chart(d, (70, 360, 340, 210), (0, 1.04), (0, 1.2 * max(row[1] for row in data["light"])), "(c) size of the light (figure 24a)",
                  "half the light's side", "pairs of texels, 64 × 64 occluder texels", x_ticks=(0, 0.25, 0.5, 0.75, 1), y_ticks=())
    chart.curve([(row[0], row[1]) for row in data["light"]], ONE)
    for row in data["light"][1::2]:
        chart.note(row[0], row[1], f"{row[1] / 1e6:.2f} million", offset=(-6, -9), anchor="end" if row[0] > 0.2 else "start")
    chart = Chart(d, (520, 360, 340, 210), (0, 1.04), (0, 0.1), "(d) error by resolution (figures 23, 24b)", "half the light's side",
                  "error", x_ticks=(0, 0.25, 0.5, 0.75, 1), y_ticks=(0, 0.02, 0.04, 0.06, 0.08, 0.1))
    for style, column in ((ONE, 2), (TWO, 3), (CONTOUR, 4)):
        chart.curve([(row[0], row[column]) for row in data["light"]], style)
    key(d, (560, 632), [(ONE, "24 × 24"), (TWO, "64 × 64"), (CONTOUR, "192 × 192")], 105)
    d.text((50, 632), "A ball under a light at height 5. (a): 128 × 128 and 96 × 96 receiver texels.", 11.5)
    return d.finish()


def measure_blend(runner):
    """Measures sums in 16 and 32 bits. As seen from the floor, the light is 53 texels wide at 128 × 128 and 213 at 512 × 512."""
    world = scene([plate(y=2.5, half=1.2)], half=1.0)
    entries = {"128, fp16": "soft-shadow-map:size=128:receiverSize=96:precision=fp16",
               "512, fp16": "soft-shadow-map:size=512:receiverSize=96:precision=fp16",
               "512, fp32": "soft-shadow-map:size=512:receiverSize=96"}
    found = runner.compare(world, list(entries.values()))
    tiles = [[name, picture(found, entry, 48), measures(found, entry)["s0"],
              rounded(min(found[entry]["V"]))] for name, entry in entries.items()]
    return {"tiles": tiles + [["exact", picture(found, "truth", 48), 0.0, rounded(min(found["truth"]["V"]))]]}


def draw_blend(data):
    d = Drawing(900, 290, "Atty et al. 2006, figure 14: sums of 16-bit floats stop short when the map is fine",
                "Four pictures of V on the floor below a plate. With 128 texels in 16 bits and with 512 in 32 bits the "
                "shadow is like the exact one; with 512 texels in 16 bits it is far too bright.")
    d.text((30, 30), "V on the floor below a plate: blending in 16 bits and in 32", 14, bold=True)
    for i, (name, data64, s0, least) in enumerate(data["tiles"]):
        caption = name if name == "exact" else name.replace(", ", " × " + name.split(",")[0] + ", ")
        image(d, (30 + 215 * i, 45), 190, data64, caption, f"darkest pixel V = {least:g}" + ("" if name == "exact" else f", error {s0:.3f}"))
    return d.finish()


def measure_passes(runner):
    entries = methods(128) + ["contour:size=192:traversal=hierarchy"]
    found = runner.compare(scene([bunny()], half=0.7), entries, size=64)
    rows = [["one pass", entries[0]], ["two passes", entries[1]], ["contour", entries[2]]]
    return {"tiles": [[name, picture(found, entry, 64), measures(found, entry)["s0"]] for name, entry in rows] +
            [["exact", picture(found, "truth", 64), 0.0]]}


def draw_passes(data):
    d = Drawing(900, 290, "Atty et al. 2006, figures 11 and 16: one pass, two passes, and the truth",
                "Four pictures of V on the floor below the bunny. One pass leaves light in the umbra, two passes close it, and "
                "contour comes nearest to the exact picture.")
    d.text((30, 30), "V on the floor below the bunny (light of half-size 0.7 at height 5)", 14, bold=True)
    for i, (name, data64, s0) in enumerate(data["tiles"]):
        image(d, (30 + 215 * i, 45), 190, data64, name, "" if name == "exact" else f"error {s0:.3f}")
    return d.finish()


FIGURES = {
    "atty-resolution": (measure_resolution, draw_resolution),
    "atty-light": (measure_light, draw_light),
    "atty-place": (measure_place, draw_place),
    "atty-work": (measure_work, draw_work),
    "atty-blend": (measure_blend, draw_blend),
    "atty-passes": (measure_passes, draw_passes),
}
