# SPDX-License-Identifier: Apache-2.0
"""Figures of docs/alias-free.md, hierarchical-penumbra.md, view-sample-planar.md, soft-irregular.md, and of variant=sintorn in
view-sample.md: view samples in lists of light pixels, pairs of boxes, footprints, wedges and left-sample maps."""

from math import atan2, cos, floor, hypot, pi, sin

from drawing import BLUE, DARK, FAINT, GREEN, INK, LIGHT, PALE, RED, Drawing, View
from geometry import SQUARE, clip_to, crosses, hull, inside, meet, rows_pattern


def surface(x):
    """Returns the height of a ground with a step."""
    return 0.0 if x < 4.6 else 0.9


def alias_free_figure():
    """Draws alias-free in a plane: light pixels are intervals of a line, casters segments."""
    lamp, line, count = (3.6, 6.2), -0.85, 12
    casters = [((1.5, 2.2), (2.9, 2.5)), ((4.3, 2.9), (5.1, 2.5))]
    samples = [(0.55 * i + 0.15, surface(0.55 * i + 0.15)) for i in range(15)]
    d = Drawing(860, 470, "View samples in lists of light pixels")
    d.text((20, 26), "Light pixels, each with a list of its view samples", 14, bold=True)
    view = View(d, (10, 40, 590, 420), (-1.2, 9.2), (-1.6, 6.5))

    def place(p):
        return meet(lamp, p, (0, line), (1, line))[0]

    places = [place(p) for p in samples]
    low, high = min(places), max(places)
    width = (high - low) / count

    def pixel(x):
        return min(max(floor((x - low) / width), 0), count - 1)

    lists = {}
    for i, x in enumerate(places):
        lists.setdefault(pixel(x), []).append(i)
    dark, tested, touched = set(), set(), set()
    for a, b in casters:
        ends = sorted((place(a), place(b)))
        for k in range(pixel(ends[0]), pixel(ends[1]) + 1):
            touched.add(k)
            for i in lists.get(k, []):
                tested.add(i)
                if crosses(lamp, samples[i], a, b):
                    dark.add(i)
    # The lists of the light pixels that footprints touch contain every view sample that a caster hides.
    assert dark == {i for i, p in enumerate(samples) if any(crosses(lamp, p, *c) for c in casters)}
    assert dark < tested and len(tested) < len(samples)
    for a, b in casters:
        view.polygon([a, b, (place(b), line), (place(a), line)], DARK, opacity=0.14)
        view.line(a, b, INK, 4)
    view.path([(-1, 0), (4.6, 0), (4.6, 0.9), (9, 0.9)], DARK, 2)
    for k in range(count):
        box = [(low + k * width, line), (low + (k + 1) * width, line), (low + (k + 1) * width, line - 0.32),
               (low + k * width, line - 0.32)]
        view.polygon(box, "#f6d9d5" if k in touched else "#ffffff", FAINT, 1)
        view.text((low + (k + 0.5) * width, line - 0.25), len(lists.get(k, [])), 12, anchor="middle")
    for i, p in enumerate(samples):
        view.line(p, (places[i], line), FAINT, 0.8, "2 3")
        view.dot(p, 4.2, DARK if i in dark else "#ffffff" if i in tested else LIGHT, stroke=INK)
    view.dot(lamp, 6, LIGHT, stroke=INK)
    view.text(lamp, "centre of the light", 12.5, (10, 4))
    x = 612
    d.legend((x, 90), [("dot", LIGHT, "view sample in no touched list"), ("ring", INK, "tested, in the light"),
                       ("dot", DARK, "tested, in shadow"), ("box", "#f6d9d5", "light pixel that a caster touches")])
    d.text((x, 190), "Numbers: the length of each", 12.5)
    d.text((x, 207), f"pixel's list. {len(tested)} of {len(samples)} view", 12.5)
    d.text((x, 224), f"samples are tested, {len(dark)} are", 12.5)
    d.text((x, 241), "in shadow.", 12.5)
    return d.finish()


def side(p, l, x):
    """Returns the side of x on which the line from p to l passes, in a plane: affine in p and in l."""
    return (l[0] - p[0]) * (x[1] - p[1]) - (l[1] - p[1]) * (x[0] - p[0])


def hierarchical_figure():
    """Draws hierarchical-penumbra in a plane: light samples on one line, view samples on another, a caster between them; and the product of the two sets."""
    lights = [(-1.5 + 3.0 * (i + 0.5) / 16, 5.0) for i in range(16)]
    views = [(-4.0 + 8.0 * (i + 0.5) / 32, 0.0) for i in range(32)]
    caster = ((-0.4, 2.6), (2.1, 3.0))
    boxes, tested = [], set()

    def visit(l0, l1, v0, v1):
        """Visits the box [l0, l1) × [v0, v1). Both sets are on lines, so the first and last of each range are the box's corners."""
        corners = [(p, l) for p in (views[v0], views[v1 - 1]) for l in (lights[l0], lights[l1 - 1])]
        signs = [[side(p, l, x) > 0 for p, l in corners] for x in caster]
        if all(signs[0]) == any(signs[0]) and all(signs[1]) == any(signs[1]):
            boxes.append((l0, l1, v0, v1, "hidden" if signs[0][0] != signs[1][0] else "beside"))
            return
        if l1 - l0 <= 2 and v1 - v0 <= 2:
            boxes.append((l0, l1, v0, v1, "leaf"))
            tested.update((l, v) for l in range(l0, l1) for v in range(v0, v1))
            return
        if (v1 - v0) * 0.25 * 2.2 > (l1 - l0) * 0.1875 * 2.8:
            middle = (v0 + v1) // 2
            visit(l0, l1, v0, middle), visit(l0, l1, middle, v1)
        else:
            middle = (l0 + l1) // 2
            visit(l0, middle, v0, v1), visit(middle, l1, v0, v1)

    visit(0, 16, 0, 32)
    truth = {(l, v) for l in range(16) for v in range(32) if crosses(views[v], lights[l], *caster)}
    for l0, l1, v0, v1, what in boxes:
        own = {(l, v) for l in range(l0, l1) for v in range(v0, v1)}
        assert what == "leaf" or (own <= truth if what == "hidden" else not own & truth)
    assert sum((l1 - l0) * (v1 - v0) for l0, l1, v0, v1, _ in boxes) == 16 * 32
    d = Drawing(860, 430, "Pairs of boxes with a caster between them")
    d.text((20, 26), "Light samples, a caster, view samples", 14, bold=True)
    view = View(d, (10, 40, 380, 330), (-4.3, 4.3), (-0.6, 5.5))
    view.line(lights[0], lights[-1], LIGHT, 2)
    view.line((-4.2, 0), (4.2, 0), DARK, 2)
    view.line(*caster, INK, 4)
    for l in lights:
        view.dot(l, 2.6, LIGHT, stroke=INK, width=0.8)
    for p in views:
        view.dot(p, 2.6, "#ffffff", stroke=INK, width=0.8)
    l0, l1, v0, v1, _ = max((b for b in boxes if b[4] == "hidden"), key=lambda b: (b[1] - b[0]) * (b[3] - b[2]))
    view.polygon([lights[l0], lights[l1 - 1], views[v1 - 1], views[v0]], DARK, opacity=0.25)
    d.text((20, 400), "Shaded: the largest pair of boxes that it hides.", 12.5)
    d.text((410, 26), "All pairs, and the boxes decided as a whole", 14, bold=True)
    cell, left, top = 12.6, 420, 60
    fills = {"hidden": DARK, "beside": "#fdf3d8", "leaf": "#ffffff"}
    for l0, l1, v0, v1, what in boxes:
        d.polygon([(left + v0 * cell, top + l0 * cell), (left + v1 * cell, top + l0 * cell),
                   (left + v1 * cell, top + l1 * cell), (left + v0 * cell, top + l1 * cell)], fills[what], FAINT, 1)
    for l, v in tested:
        d.circle((left + (v + 0.5) * cell, top + (l + 0.5) * cell), 2.4, INK if (l, v) in truth else "#ffffff",
                 stroke=INK, width=0.8)
    d.text((left, top - 10), "view samples →, light samples ↓", 12.5)
    d.legend((left, top + 16 * cell + 30),
             [("box", DARK, "hidden, as a box"), ("box", "#fdf3d8", "not hidden, as a box"),
              ("dot", INK, "tested one by one: hidden"), ("ring", INK, "tested one by one: not hidden")])
    d.text((left, top + 16 * cell + 120), f"{len(tested)} of {16 * 32} pairs are tested one by one.", 12.5)
    return d.finish()


LAMP3 = [(-1.0, -0.7), (1.0, -0.7), (1.0, 0.7), (-1.0, 0.7)]
CASTER3 = [((-0.9, 0.3), 2.6), ((0.7, 0.9), 3.0), ((0.3, -0.8), 2.2)]
DEEP = 5.0


def footprint_points():
    """Projects the caster's corners from the light's corners (height 0) on the plane at depth DEEP."""
    return [(l[0] + (x[0] - l[0]) * DEEP / h, l[1] + (x[1] - l[1]) * DEEP / h) for x, h in CASTER3 for l in LAMP3]


def footprint_figure():
    """Draws the hull of Sintorn et al. in light pixels, and the box of Eisemann and Décoret."""
    points = footprint_points()
    outline = hull(points)
    xs, ys = [q[0] for q in points], [q[1] for q in points]
    d = Drawing(820, 440, "Footprints of a triangle on a receiver")
    d.text((20, 26), "Twelve points, their hull in light pixels, and their box", 14, bold=True)
    view = View(d, (10, 40, 560, 390), (min(xs) - 0.6, max(xs) + 0.6), (min(ys) - 0.6, max(ys) + 0.6))
    cell, touched = 0.5, 0
    for i in range(floor((min(xs) - 0.5) / cell), floor((max(xs) + 0.5) / cell) + 1):
        for j in range(floor((min(ys) - 0.5) / cell), floor((max(ys) + 0.5) / cell) + 1):
            square = [(i * cell, j * cell), ((i + 1) * cell, j * cell), ((i + 1) * cell, (j + 1) * cell),
                      (i * cell, (j + 1) * cell)]
            hit = len(clip_to(square, outline)) > 2
            touched += hit
            view.polygon(square, "#f6d9d5" if hit else None, PALE, 0.8)
    # The hull contains the projections of all points of the triangle from all points of the light.
    for i in range(7):
        for j in range(7):
            l = (-1 + i / 3, -0.7 + j * 0.7 / 3)
            a, b = i / 6, (1 - i / 6) * j / 6
            weights = (a, b, 1 - a - b)
            x = [sum(w * c[0][k] for w, c in zip(weights, CASTER3)) for k in (0, 1)]
            h = sum(w * c[1] for w, c in zip(weights, CASTER3))
            q = (l[0] + (x[0] - l[0]) * DEEP / h, l[1] + (x[1] - l[1]) * DEEP / h)
            assert inside(q, [(c[0] * 1.0001, c[1] * 1.0001) for c in outline])
    view.polygon([(min(xs), min(ys)), (max(xs), min(ys)), (max(xs), max(ys)), (min(xs), max(ys))], None, BLUE, 2, "6 4")
    view.polygon(outline, None, RED, 2)
    for k, l in enumerate(LAMP3):
        view.polygon(points[k::4], None, FAINT, 1)
    for q in points:
        view.dot(q, 3.4, INK)
    d.legend((600, 90), [("line", FAINT, "shadow from a light corner"), ("dot", INK, "corners of the shadows: 12"),
                         ("line", RED, "hull: Sintorn et al."), ("box", "#f6d9d5", "light pixels that it touches"),
                         ("dash", BLUE, "box: Eisemann, Décoret")])
    d.text((600, 205), f"{touched} light pixels", 12.5)
    return d.finish()


def left_samples_figure():
    """Draws one texel of a left-sample map: a bundle of lines."""
    samples = [x for row in rows_pattern(8, 8) for x in row]
    angles, distances, radius = 24, 16, max(hypot(*x) for x in samples)
    line = (0.83, 0.35)  # angle and distance
    i = floor((line[0] + pi) / (2 * pi) * angles)
    k = floor((line[1] + radius) / (2 * radius) * distances)
    from_angle, to_angle = i * 2 * pi / angles - pi, (i + 1) * 2 * pi / angles - pi
    low, high = k * 2 * radius / distances - radius, (k + 1) * 2 * radius / distances - radius

    def along(angle, x):
        return cos(angle) * x[0] + sin(angle) * x[1]

    def extent(x):
        values = [along(from_angle, x), along(to_angle, x)]
        phi = atan2(x[1], x[0])
        values += [s * hypot(*x) for s, at in ((1, phi), (-1, phi - pi), (-1, phi + pi)) if from_angle <= at <= to_angle]
        return min(values), max(values)

    kinds = []
    for x in samples:
        least, most = extent(x)
        kinds.append("all" if least > high else "none" if most <= low else "some")
        left = along(line[0], x) > line[1]
        assert kinds[-1] == "some" or left == (kinds[-1] == "all")
    d = Drawing(760, 420, "One texel of a left-sample map")
    d.text((20, 26), "All lines of one texel (angle, distance), and the light samples to their left", 14, bold=True)
    view = View(d, (10, 40, 380, 370), (-1.25, 1.25), (-1.25, 1.25))
    view.polygon(SQUARE, "#fff7df", LIGHT, 2)
    for s in range(5):
        for t in (low, high):
            angle = from_angle + (to_angle - from_angle) * s / 4
            foot = (t * cos(angle), t * sin(angle))
            a, b = ((foot[0] + u * -sin(angle), foot[1] + u * cos(angle)) for u in (-3, 3))
            ends = clip_line(a, b)
            if ends:
                view.line(*ends, FAINT, 0.8)
    angle, t = line
    foot = (t * cos(angle), t * sin(angle))
    ends = clip_line(*((foot[0] + u * -sin(angle), foot[1] + u * cos(angle)) for u in (-3, 3)))
    view.line(*ends, RED, 2)
    colors = {"all": GREEN, "some": "#ffffff", "none": PALE}
    for x, kind in zip(samples, kinds):
        view.dot(x, 4.4, colors[kind], stroke=INK, width=0.9)
    d.legend((420, 100), [("line", RED, "the line that is looked up"), ("line", FAINT, "other lines of the same texel"),
                          ("dot", GREEN, "left of all lines"), ("ring", INK, "left of some lines: decided exactly"),
                          ("box", PALE, "left of no line")])
    d.text((420, 220), f"{kinds.count('all')} + {kinds.count('some')} of {len(samples)} light samples,", 12.5)
    d.text((420, 237), f"{angles} angles, {distances} distances", 12.5)
    return d.finish()


def clip_line(a, b, size=1.2):
    """Returns the part of a segment in [−size, size]²."""
    low, high = 0.0, 1.0
    for k in (0, 1):
        change = b[k] - a[k]
        if abs(change) < 1e-12:
            if abs(a[k]) > size:
                return None
            continue
        ends = sorted(((-size - a[k]) / change, (size - a[k]) / change))
        low, high = max(low, ends[0]), min(high, ends[1])
    if low >= high:
        return None
    return tuple((a[0] + u * (b[0] - a[0]), a[1] + u * (b[1] - a[1])) for u in (low, high))


def soft_irregular_figure():
    """Draws soft-irregular in a plane: the light is a segment, casters are segments, an edge is a caster's end, areas are lengths."""
    half, centre, line, count = 1.0, (3.6, 6.2), -0.75, 16
    ends = [(centre[0] - half, centre[1]), (centre[0] + half, centre[1])]
    casters = [((2.3, 3.5), (4.2, 3.7)), ((3.3, 1.7), (5.3, 1.6))]
    samples = [(-0.7 + 0.5 * i, 0.0) for i in range(20)]

    def far(l, x):
        return meet(l, x, (0, line), (1, line))[0]

    def on_light(p, x):
        """Returns the place on the light where p sees x; the light is −1 … 1."""
        return (meet(p, x, *ends)[0] - centre[0]) / half

    def beyond(place):
        """Returns the share of the light beyond an edge, on the side away from the light's centre."""
        return max(0, 1 - abs(place)) / 2

    def visible(p, layers, some=None):
        """Returns V = 1 − H − Σ k A. `some`: the sum is over these edges only."""
        hidden = [min(on_light(p, a), on_light(p, b)) < 0 < max(on_light(p, a), on_light(p, b)) for a, b in casters]
        value = 1 - (sum(hidden) if layers else any(hidden))
        for (a, b), over in zip(casters, hidden):
            places = sorted((on_light(p, x), x) for x in (a, b))
            for place, x in places:
                if some is not None and x not in some:
                    continue
                # An edge gives light back if its caster lies toward the light's centre, and takes light away otherwise.
                gives = over or (place > 0) == (place == places[1][0])
                value += beyond(place) if gives else -beyond(place)
        return min(1, max(0, value))

    def truth(p):
        spans = sorted(sorted(min(1, max(-1, on_light(p, x))) for x in caster) for caster in casters)
        (a, b), (c, e) = spans
        return 1 - (b - a + e - c - max(0, min(b, e) - max(a, c))) / 2

    d = Drawing(860, 616, "An irregular shadow map and wedges over lists of light pixels")
    d.text((20, 26), "Wedges of the centre's silhouettes over lists of view samples", 14, bold=True)
    view = View(d, (10, 40, 590, 400), (-1.2, 9.2), (-1.35, 6.5))
    places = [far(centre, p) for p in samples]
    low, high = min(places), max(places)
    width = (high - low) / count

    def pixel(x):
        return min(max(floor((x - low) / width), 0), count - 1)

    kept = {i: set() for i in range(len(samples))}
    edge = casters[0][1]
    touched, tested = set(), set()
    for caster in casters:
        for x in caster:
            a, b = sorted(far(l, x) for l in ends)
            for k in range(pixel(a), pixel(b) + 1):
                for i, p in enumerate(samples):
                    if pixel(places[i]) == k:
                        if x == edge:
                            touched.add(k)
                            tested.add(i)
                        if beyond(on_light(p, x)) > 0:
                            kept[i].add(x)
    # The lists under the footprints contain every view sample whose V an edge changes.
    for i, p in enumerate(samples):
        assert abs(visible(p, True) - visible(p, True, kept[i])) < 1e-12
    view.polygon([edge, (far(ends[1], edge), line), (far(ends[0], edge), line)], RED, opacity=0.16)
    for a, b in casters:
        view.polygon([a, b, (far(centre, b), line), (far(centre, a), line)], DARK, opacity=0.12)
        view.line(a, b, INK, 4)
        for x in (a, b):
            view.dot(x, 3.5, RED if x == edge else "#ffffff", stroke=INK)
    view.line((-1.1, 0), (9.1, 0), DARK, 2)
    for k in range(count):
        box = [(low + k * width, line), (low + (k + 1) * width, line), (low + (k + 1) * width, line - 0.3),
               (low + k * width, line - 0.3)]
        view.polygon(box, "#f6d9d5" if k in touched else "#ffffff", FAINT, 1)
    umbra = [any(crosses(centre, p, *caster) for caster in casters) for p in samples]
    for i, p in enumerate(samples):
        view.line(p, (places[i], line), FAINT, 0.8, "2 3")
        view.dot(p, 4.2, DARK if umbra[i] else LIGHT, stroke=RED if edge in kept[i] else INK)
    view.line(*ends, LIGHT, 7)
    view.dot(centre, 4, "#ffffff", stroke=INK)
    view.text(ends[1], "light, and its centre", 12.5, (10, 4))
    x = 612
    d.legend((x, 90), [("dot", LIGHT, "sees the light's centre"), ("dot", DARK, "in the umbra of the centre"),
                       ("ring", RED, "sees the red edge"), ("box", "#f2d3cf", "its wedge, and light pixels that"), ("box", "#ffffff", "this touches")])
    found = sum(edge in edges for edges in kept.values())
    d.text((x, 206), f"{len(tested)} of {len(samples)} view samples are", 12.5)
    d.text((x, 223), f"tested, and {found} see the red edge", 12.5)
    d.text((x, 240), "in front of the light.", 12.5)
    left, top, across, tall = 60, 470, 500, 130
    xs = [-1 + 10 * i / 400 for i in range(401)]

    def at(px, v):
        return (view.at((px, 0))[0], top + tall * (1 - v))

    assert max(abs(visible((px, 0.0), False) - truth((px, 0.0))) for px in xs if px < 1.2) < 1e-9
    for v in (0, 0.5, 1):
        d.line((left, top + tall * (1 - v)), (left + across + 20, top + tall * (1 - v)), PALE, 1)
        d.text((left - 6, top + tall * (1 - v) + 4), f"{v:g}", 11, anchor="end")
    for colour, dash, of in ((INK, None, truth), (RED, None, lambda p: visible(p, False)), (BLUE, "5 3", lambda p: visible(p, True))):
        d.polygon([at(px, of((px, 0.0))) for px in xs], None, colour, 2, dash, closed=False)
    d.legend((x, 500), [("line", INK, "*V* along the floor, exact"), ("line", RED, "umbra=map: leaks"), ("dash", BLUE, "umbra=layers: too dark")])
    return d.finish()


FIGURES = {"soft-irregular": soft_irregular_figure, "alias-free": alias_free_figure, "hierarchical-penumbra": hierarchical_figure,
           "footprints": footprint_figure, "left-samples": left_samples_figure}
