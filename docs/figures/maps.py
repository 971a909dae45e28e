# SPDX-License-Identifier: Apache-2.0
"""Figures of docs/shadow-map.md, pcss.md, accumulate.md. They are drawn from the side: a map is a row of texels, a caster a segment."""

from math import floor

from drawing import BLUE, DARK, FAINT, GREEN, INK, LIGHT, PALE, RED, Drawing, View
from geometry import clip, crosses


def nearest(casters, direction):
    """Returns the least height below the light's centre (0, 0) at which the ray along (direction, 1) meets a caster."""
    heights = []
    for (x0, z0), (x1, z1) in casters:
        # (x0 + t dx) = direction (z0 + t dz)
        dx, dz = x1 - x0, z1 - z0
        bottom = dx - direction * dz
        if bottom != 0:
            t = (direction * z0 - x0) / bottom
            if 0 <= t <= 1:
                heights.append(z0 + t * dz)
    return min(heights, default=float("inf"))


def shadow_map_figure():
    floor_z, bias, texels, span = 5.0, 0.5, 14, 0.72
    floor_ = ((-4.0, floor_z), (4.0, floor_z))
    casters = [floor_, ((-1.35, 2.6), (0.22, 2.9)), ((1.62, 3.9), (1.78, 3.9))]
    occluders = casters[1:]
    width = 2 * span / texels
    centers = [-span + width * (i + 0.5) for i in range(texels)]
    depths = [nearest(casters, m) for m in centers]

    d = Drawing(820, 440, "A shadow map from the side: texels, their depths, and the shadow that they give on the floor")
    d.text((20, 26), "A map from the light's centre: one depth per texel, and the shadow on the floor", 14, bold=True)
    view = View(d, (10, 40, 590, 390), (-3.9, 3.9), (-5.75, 0.3))
    for i in range(texels + 1):
        m = -span + width * i
        view.line((0, 0), (m * floor_z, -floor_z), PALE, 1)
        view.line((m, -0.93), (m, -1.07), INK, 1)
    view.line((-span, -1), (span, -1), INK, 1.5)
    view.text((-span, -1), f"the map: {texels} texels", 12.5, (-10, 4), anchor="end")
    for (x0, z0), (x1, z1) in occluders:
        view.line((x0, -z0), (x1, -z1), DARK, 5)
    for m, z in zip(centers, depths):
        view.dot((m * z, -z), 3.2, BLUE)
    view.dot((0, 0), 6, LIGHT, stroke=INK)
    view.text((0, 0), "centre of the light", 12.5, (10, 4))

    def lit(x):
        texel = floor((x / floor_z + span) / width)
        # The floor is level: its plane is at floor_z in every texel's middle, and its slope is 0.
        return depths[min(max(texel, 0), texels - 1)] >= floor_z - bias * width * floor_z

    def truth(x):
        return not any(crosses((0, 0), (x, floor_z), *caster) for caster in occluders)

    steps = 2800
    wrong = 0
    for row, (answer, y) in enumerate(((lit, -5.0), (truth, -5.32))):
        start = -span * floor_z
        x, current = start, answer(start + 1e-6)
        for i in range(1, steps + 1):
            at = start + 2 * span * floor_z * i / steps
            now = answer(at - span * floor_z / steps)
            wrong += row == 0 and now != truth(at - span * floor_z / steps)
            if now != current or i == steps:
                view.polygon([(x, y), (at, y), (at, y - 0.16), (x, y - 0.16)], LIGHT if current else DARK)
                x, current = at, now
    view.text((-3.6, -5.0), "map", 12.5, (-4, 12), anchor="end")
    view.text((-3.6, -5.32), "true", 12.5, (-4, 12), anchor="end")
    x = 615
    d.legend((x, 90), [("dot", BLUE, "depth of a texel: the first")])
    d.legend((x, 136), [("box", LIGHT, "lit"), ("box", DARK, "in shadow")])
    d.text((x + 22, 107), "surface that its middle sees", 12.5)
    d.text((x, 220), "Edges of the shadow are", 12.5)
    d.text((x, 237), "off by up to half a texel.", 12.5)
    d.text((x, 269), "The small caster lies between", 12.5)
    d.text((x, 286), "two texels' middles: missed.", 12.5)
    d.text((x, 318), f"{100 * wrong / steps:.1f} % of the floor is wrong.", 12.5, bold=True)
    return d.finish()


def pcss_case(blockers, p=(0.35, 5.0), half=1.0):
    """Returns what pcss computes from its map at p = (x, z), and the true V, both in the plane with very many taps."""
    x, z = p
    count = 4000
    lamp = [half * (2 * (i + 0.5) / count - 1) for i in range(count)]

    near = max(half, min(z for b in blockers for _, z in b))  # the nearest depth in the map

    def window(height):
        return [x / z + s * (1 / height - 1 / z) for s in lamp]

    found = [h for h in (nearest(blockers, m) for m in window(near)) if h < z]
    average = sum(found) / len(found)
    taps = window(average)
    visible = sum(nearest(blockers, m) >= z for m in taps) / count
    truth = sum(not any(crosses((s, 0), (x, z), *b) for b in blockers) for s in lamp) / count
    return average, (min(window(near)), max(window(near))), (min(taps), max(taps)), visible, truth


def pcss_figure():
    cases = [("All blockers in one plane", [((-3.0, 2.5), (0.12, 2.5))]),
             ("Blockers at two heights", [((-3.0, 1.4), (0.2, 1.4)), ((0.6, 3.8), (3.0, 3.8))])]
    p = (0.35, 5.0)
    d = Drawing(860, 470, "pcss from the side: search window, mean blocker, filter window")
    for i, (title, blockers) in enumerate(cases):
        average, search, taps, visible, truth = pcss_case(blockers)
        x0 = 20 + 420 * i
        d.text((x0, 26), title, 14, bold=True)
        view = View(d, (x0, 40, 390, 340), (-2.3, 2.3), (-5.3, 0.45), stretch=True)
        cone = clip(clip([(0, 0), (search[0] * 5, -5), (search[1] * 5, -5)], (1, 0), 2.3), (-1, 0), 2.3)
        view.polygon(cone, GREEN, opacity=0.12)
        view.polygon([(0, 0), (taps[0] * 5, -5), (taps[1] * 5, -5)], BLUE, opacity=0.2)
        view.line((-2.3, -5), (2.3, -5), DARK, 2)
        view.line((-1, 0), (1, 0), LIGHT, 6)
        for (a, za), (b, zb) in blockers:
            view.line((max(a, -2.3), -za), (min(b, 2.3), -zb), DARK, 5)
        view.line((-2.3, -average), (2.3, -average), RED, 1.5, "6 4")
        view.text((-2.3, -average), "mean blocker", 12, (2, -5), fill=RED)
        for s in (-1, 1):
            view.line((s, 0), (p[0], -p[1]), FAINT, 1.2)
        view.dot((0, 0), 4)
        view.dot((p[0], -p[1]), 5)
        view.text((p[0], -p[1]), "*p*", 14, (0, 19), anchor="middle", bold=True)
        view.text((-1, 0), "light", 12.5, (-8, 4), anchor="end")
        d.text((x0, 404), f"*V* by pcss: {visible:.3f}", 14, GREEN if abs(visible - truth) < 0.002 else RED, bold=True)
        d.text((x0 + 170, 404), f"true *V*: {truth:.3f}", 14, bold=True)
    assert abs(pcss_case(cases[0][1])[3] - pcss_case(cases[0][1])[4]) < 0.002
    d.legend((20, 432), [("box", "#d9ecd9", "directions of the blocker search: the light's image at the near plane")])
    d.legend((20, 454), [("box", "#b9cfe4", "directions of the filter: the light's image at the mean blocker")])
    return d.finish()


def accumulate_figure():
    lamp_z, floor_z, count = 0.0, 5.0, 6
    occluder = ((-1.2, 2.6), (0.75, 2.6))
    points = [2 * (i + 0.5) / count - 1 for i in range(count)]
    d = Drawing(820, 500, "Hard shadows from several points of the light, and their mean")
    d.text((20, 26), "Six light samples, six hard shadows, and their mean", 14, bold=True)
    view = View(d, (20, 40, 540, 250), (-4.4, 4.4), (-5.1, 0.2), stretch=True)
    view.line((-1, 0), (1, 0), LIGHT, 6)
    view.line((occluder[0][0], -2.6), (occluder[1][0], -2.6), INK, 4)
    view.line((-4.3, -5), (4.3, -5), DARK, 2)

    def visible(s, x):
        return not crosses((s, lamp_z), (x, floor_z), *occluder)

    bars = View(d, (20, 300, 540, 70), (-4.4, 4.4), (0, count), stretch=True)
    for j, s in enumerate(points):
        ends = []
        for q in occluder:
            ends.append(s + (q[0] - s) * floor_z / q[1])
            view.line((s, 0), (ends[-1], -floor_z), BLUE if j == count - 1 else FAINT, 1.3 if j == count - 1 else 0.8)
        view.dot((s, 0), 3.5)
        y = j
        for a, b, colour in ((-4.3, ends[0], LIGHT), (ends[0], ends[1], DARK), (ends[1], 4.3, LIGHT)):
            bars.polygon([(a, y + 0.1), (b, y + 0.1), (b, y + 0.9), (a, y + 0.9)], colour)
        bars.text((4.4, y), f"*V*_{j}", 11, (6, -1))
    graph = View(d, (20, 390, 540, 90), (-4.4, 4.4), (-0.08, 1.08), stretch=True)
    for v in (0, 1):
        graph.line((-4.4, v), (4.4, v), PALE, 1)
        graph.text((-4.4, v), v, 12, (-4, 4), anchor="end")
    xs = [-4.3 + 8.6 * i / 1200 for i in range(1201)]
    dense = [2 * (i + 0.5) / 600 - 1 for i in range(600)]
    mean = [(x, sum(visible(s, x) for s in points) / count) for x in xs]
    truth = [(x, sum(visible(s, x) for s in dense) / 600) for x in xs[::8]]
    graph.path(truth, INK, 2)
    graph.path(mean, GREEN, 2)
    worst = max(abs(a[1] - b[1]) for a, b in zip(mean[::8], truth))
    x = 610
    d.text((x, 90), "Each light sample has a", 12.5)
    d.text((x, 107), "separate map; *V*_j is 0 or 1.", 12.5)
    d.legend((x, 330), [("box", LIGHT, "lit"), ("box", DARK, "in shadow")])
    d.legend((x, 420), [("line", GREEN, "mean of the six"), ("line", INK, "true *V*")])
    d.text((x, 474), f"off by up to {worst:.2f}", 12.5)
    return d.finish()


FIGURES = {"shadow-map": shadow_map_figure, "pcss": pcss_figure, "accumulate": accumulate_figure}
