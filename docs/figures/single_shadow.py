# SPDX-License-Identifier: Apache-2.0
"""Figures of docs/penumbra-map.md, smoothies.md, brabec-seidel.md, kirsch-doellner.md, parker.md, arvo.md, layer-rays.md."""

from math import pi, sqrt

from drawing import BLUE, DARK, FAINT, GREEN, INK, LIGHT, PALE, RED, Drawing, View

FLOOR, HEIGHT = 5.0, 2.5  # depths of the floor and of the edge below the light's centre
HALF = 0.6                # of the light
RADIUS = 2 * HALF / sqrt(pi)
REACH = RADIUS * (1 / HEIGHT - 1 / FLOOR) * FLOOR  # half a penumbra on the floor, as methods have it
TRUE = HALF * (1 / HEIGHT - 1 / FLOOR) * FLOOR


def clamped(t):
    return min(max(t, 0.0), 1.0)


def cubic(t):
    t = clamped(t)
    return t * t * (3 - 2 * t)


def exact(x):
    """Returns V of the floor at x below a half plane at x > 0."""
    return clamped(0.5 - x / (2 * TRUE))


def cone(x):
    if x > 0:
        return 0.0
    inverse = 1 / HEIGHT + x / FLOOR / RADIUS
    return 1.0 if inverse * FLOOR <= 1 else cubic((1 / inverse - HEIGHT) / (FLOOR - HEIGHT))


def outside(x):
    return 0.0 if x > 0 else cubic(-x / REACH)


CURVES = {
    "penumbra-map": (cone, "Cones and sheets open downward from the silhouette; a texel's depth in them gives *V*",
                     "outer half only; too dark near the hard shadow"),
    "smoothies": (outside, "Strips outside the silhouette, equally wide as seen from the light's centre",
                  "outer half only; the width is right for one height of the silhouette"),
    "parker": (outside, "Objects have soft edges: how closely does the ray to the light's centre pass?", "outer half alone"),
    "kirsch-doellner": (lambda x: clamped(1 - x / REACH) if x > 0 else 1.0, "How far inside the hard shadow is the receiver?", "inner half alone"),
    "brabec-seidel": (lambda x: clamped(0.5 - x / (2 * REACH)), "The nearest texel that would shade, or would not, gives the place of the border", "both halves"),
    "arvo": (lambda x: cubic(0.5 - x / (2 * REACH)), "The hard shadow's border grows over the picture, a pixel at a time, in and out", "both halves"),
}


def profile_figure(method):
    v, title, half = CURVES[method]
    d = Drawing(860, 440, f"{method} at an edge: a half plane under a light, and V along the floor",
                f"A half plane between a light and a floor. True V falls linearly over both sides of the hard shadow's border. {method}: {half}.")
    d.text((20, 26), title, 14, bold=True)
    view = View(d, (20, 45, 560, 220), (-1.6, 1.6), (-5.2, 0.3), stretch=True)
    view.line((-1.6, -FLOOR), (1.6, -FLOOR), DARK, 2)
    view.line((0, -HEIGHT), (1.6, -HEIGHT), DARK, 6)
    view.line((-HALF, 0), (HALF, 0), LIGHT, 7)
    for x, colour in ((-TRUE, FAINT), (TRUE, FAINT)):
        view.line((-HALF if x > 0 else HALF, 0), (x, -FLOOR), colour, 1.2, "4 3")
    view.line((0, 0), (0, -FLOOR), INK, 1.2)
    if method == "penumbra-map":
        view.polygon([(0, -HEIGHT), (-REACH, -FLOOR), (0, -FLOOR)], GREEN, opacity=0.25)
    elif method == "smoothies":
        width = RADIUS / HEIGHT * HEIGHT
        view.line((-width, -HEIGHT), (0, -HEIGHT), GREEN, 5)
    elif method == "parker":
        edge = REACH * HEIGHT / FLOOR
        view.line((-edge, -HEIGHT), (0, -HEIGHT), GREEN, 5)
    elif method == "kirsch-doellner":
        view.polygon([(0, -HEIGHT), (REACH, -FLOOR), (0, -FLOOR)], GREEN, opacity=0.25)
    else:
        view.polygon([(0, -HEIGHT), (-REACH, -FLOOR), (REACH, -FLOOR)], GREEN, opacity=0.25)
    box = View(d, (20, 300, 560, 110), (-1.6, 1.6), (-0.05, 1.05), stretch=True)
    xs = [-1.6 + 3.2 * i / 320 for i in range(321)]
    box.line((-1.6, 0), (1.6, 0), PALE, 1.5)
    box.line((-1.6, 1), (1.6, 1), PALE, 1.5)
    box.line((0, 0), (0, 1), FAINT, 1, "3 3")
    for colour, values in ((INK, [exact(x) for x in xs]), (RED, [v(x) for x in xs])):
        d.polygon([box.at((x, y)) for x, y in zip(xs, values)], None, colour, 2, closed=False)
    step = xs[1] - xs[0]
    off = sqrt(sum((v(x) - exact(x)) ** 2 for x in xs) * step / (2 * TRUE))
    dark = sum(v(x) < 0.05 for x in xs if x < TRUE + 1e-9) * step - sum(exact(x) < 0.05 for x in xs if x < TRUE + 1e-9) * step
    assert (dark > 0.5 * TRUE) == (method in ("penumbra-map", "smoothies", "parker"))
    d.text((20, 296), "*V* along the floor", 12.5, DARK)
    d.legend((605, 90), [("line", LIGHT, "the light"), ("line", DARK, "a half plane; the floor"), ("line", INK, "border of the hard shadow"),
                         ("dash", FAINT, "the true penumbra"), ("box", "#b9d7ba", "the penumbra by the method")])
    d.legend((605, 330), [("line", INK, "true *V*"), ("line", RED, method)])
    d.text((605, 380), half.partition(";")[0], 13, bold=True)
    d.text((605, 402), f"RMSE over the penumbra: {off:.2f}", 12.5)
    return d.finish()


def layer_rays_figure():
    d = Drawing(860, 430, "A ray through layers of a map, texel by texel",
                "Columns are texels of the map as the light's centre sees them. Two layers of depths; a wall joins neighbours that are near each other; a ray from p to a "
                "light sample passes each texel between two depths and is stopped by a piece or a wall.")
    d.text((20, 26), "Each texel is passed between two depths: a surface in between stops the ray", 14, bold=True)
    view = View(d, (20, 50, 560, 350), (-0.6, 0.6), (-5.4, 0.2), stretch=True)
    step = 0.1
    texels = [-0.5 + step * k for k in range(10)]  # left borders, as (x/z)
    first = [None, None, 2.6, 2.3, 2.2, 2.25, 2.5, None, None, None]
    second = [None, 3.2, 3.25, 3.3, 3.35, 3.4, 3.45, 3.5, None, None]
    for a in texels + [texels[-1] + step]:
        view.line((0, 0), (a, -5), PALE, 1)
    view.line((-0.6, -5), (0.6, -5), DARK, 2)
    pieces = []
    for layer in (first, second):
        for k, depth in enumerate(layer):
            if depth is None:
                continue
            a, b = texels[k] * depth / 5, (texels[k] + step) * depth / 5
            view.line((a, -depth), (b, -depth), DARK, 4)
            pieces.append((texels[k], depth))
            if k + 1 < len(layer) and layer[k + 1] is not None:
                border = texels[k] + step
                view.line((border * depth / 5, -depth), (border * layer[k + 1] / 5, -layer[k + 1]), BLUE, 2.5)
    p, stopped, past = (0.3, 5.0), (-0.2, 0.0), (0.2, 0.0)
    hits = []
    for s, colour in ((stopped, RED), (past, GREEN)):
        met = []
        for left, depth in pieces:
            x = p[0] + (s[0] - p[0]) * (1 - depth / p[1])
            if left <= x / depth * 5 <= left + step:
                met.append(depth)
        hits.append(bool(met))
        end = max(met) if met else 0.0
        view.line((p[0], -p[1]), (p[0] + (s[0] - p[0]) * (1 - end / p[1]), -end), colour, 2)
    assert hits == [True, False]
    view.line((-0.3, 0), (0.3, 0), LIGHT, 7)
    view.dot((p[0], -p[1]), 5)
    view.text((p[0], -p[1]), "*p*", 14, (8, 18), bold=True)
    d.legend((605, 90), [("line", LIGHT, "the light"), ("line", DARK, "texels of two layers"), ("line", BLUE, "walls between neighbours"), ("line", RED, "a ray that is stopped"),
                         ("line", GREEN, "a ray that is not"), ("line", PALE, "texels, from the light's centre")])
    return d.finish()


FIGURES = {**{method: (lambda method=method: profile_figure(method)) for method in CURVES}, "layer-rays": layer_rays_figure}
