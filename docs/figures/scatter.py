# SPDX-License-Identifier: Apache-2.0
"""Figures of docs/edge-scatter.md: changes and running sums; block, shaft and cone; open light samples."""

from math import atan2, ceil, cos, degrees, hypot, pi, sin

from drawing import BLUE, DARK, FAINT, GREEN, INK, LIGHT, PALE, RED, Drawing, View, arc
from geometry import (SQUARE, Light, add, area, clip_to, counter_clockwise, dot, hull, inside, mix, mul,
                      multiplicities, rows_pattern, sub)

P = (0.0, 0.0, 0.0)
LAMP = Light((0, 0, 6), (-2, 0, 0), (0, 1.2, 0))  # as seen from P, u runs to the right and v upward


def seen_at(s, t, share):
    """Returns the point on the segment from P to the light point (s, t)."""
    return mix(P, LAMP.point((s, t)), share)


def solid(corners):
    a, b, c, d = corners
    return [(a, b, c), (a, b, d), (b, c, d), (a, c, d)]


def depth(triangles, st):
    """Returns how many triangles the segment from P to a light point meets, triangle by triangle."""
    return sum(inside(st, counter_clockwise([LAMP.project(P, x) for x in triangle])) for triangle in triangles)


def signed(change):
    return f"+{change}" if change > 0 else f"−{-change}"


def rows_figure():
    tetrahedron = solid([seen_at(-1.25, -0.52, .6), seen_at(0.12, -0.8, .5), seen_at(-0.22, 0.72, .62),
                         seen_at(-0.45, -0.2, .4)])
    sheet = [(seen_at(-0.36, 0.22, .8), seen_at(0.86, -0.34, .8), seen_at(0.62, 0.8, .85))]
    triangles = tetrahedron + sheet
    rows, columns = 6, 10
    samples = rows_pattern(rows, columns, shifted=False)

    edges = []  # ends on the light, directed so that k > 0; and those inside the surface
    for (a, b), k in multiplicities(triangles, P).items():
        q, r = LAMP.project(P, a), LAMP.project(P, b)
        edges.append((q, r, k) if k >= 0 else (r, q, -k))

    d = Drawing(730, 532, "Edges over the grid of light samples: changes at crossings, and their running sum")
    d.text((20, 26), "The light as seen from *p*: crossings of each row with edges, and their sum", 14,
           bold=True)
    view = View(d, (130, 50, 470, 282), (-1.3, 1), (-1, 1), stretch=True)
    view.polygon(SQUARE, "#fff7df", LIGHT, 2)
    chosen = 3
    view.polygon([(-1, samples[chosen][0][1] - 1 / rows), (1, samples[chosen][0][1] - 1 / rows),
                  (1, samples[chosen][0][1] + 1 / rows), (-1, samples[chosen][0][1] + 1 / rows)], "#e8f3e8")
    for triangle in triangles:
        view.polygon([LAMP.project(P, x) for x in triangle], DARK, opacity=0.13)
    for row in samples:
        for st in row:
            view.dot(st, 3.6, LIGHT if depth(triangles, st) == 0 else DARK, stroke=INK, width=0.7)
    for q, r, k in edges:
        if k == 0:
            view.line(q, r, FAINT, 1.2, dash="3 3")
        else:
            view.line(q, r, INK, 2)
            middle = mix(q, r, 0.5)
            along = mul(0.02 / hypot(*sub(r, q)), sub(r, q))
            view.arrow(sub(middle, along), add(middle, along), INK, 1, 9)

    corner = depth(triangles, (-1, -1))
    d.text((20, 355), "D(corner) = " + str(corner), 12.5)
    d.line((105, 351), view.at((-1, -1)), FAINT, 1)
    histogram = []
    for r, row in enumerate(samples):
        t = row[0][1]
        left, changes = corner, [0] * columns
        for q, e, k in edges:
            if k == 0:
                continue
            lower, upper = min(q[1], e[1]), max(q[1], e[1])
            change = -k if e[1] > q[1] else k      # crossed to the right: upward −k, downward +k
            if lower < t < upper:                  # the row crosses the edge
                s = q[0] + (t - q[1]) / (e[1] - q[1]) * (e[0] - q[0])
                if s > -1:
                    column = max(0, ceil((s + 1) / 2 * columns - 0.5))
                    if column < columns:
                        changes[column] += change
                        view.text((s, t), signed(change), 11.5, (0, -4), anchor="middle",
                                  fill=RED if change > 0 else BLUE, bold=True, halo=True)
            if (q[0] + 1) * (e[0] + 1) < 0:        # the left side crosses the edge, at this height:
                height = q[1] + (-1 - q[0]) / (e[0] - q[0]) * (e[1] - q[1])
                if -1 < height < t:                # crossed upward: an edge that runs to the right adds k
                    left += k if e[0] > q[0] else -k
        assert left == depth(triangles, (-1, t)), "the left side's depth is what triangles say"
        total = left
        for column, change in enumerate(changes):
            total += change
            assert total == depth(triangles, row[column]), "the running sum is what triangles say"
        histogram.append((left, changes))
        x, y = view.at((-1.3, t))
        d.text((x - 10, y + 4), f"D(left, {r}) = {left}", 12.5, anchor="end", fill=GREEN if r == chosen else INK,
               bold=r == chosen)

    left, changes = histogram[chosen]
    top = 392
    width = 470 * 2 / 2.3 / columns
    x0 = view.at((-1, 0))[0]
    d.text((x0 - 12, top + 17), f"row {chosen}: changes", 12.5, anchor="end")
    d.text((x0 - 12, top + 49), f"{left} + running sum", 12.5, anchor="end")
    d.text((x0 - 12, top + 81), "sum = 0: visible", 12.5, anchor="end")
    total = left
    for column, change in enumerate(changes):
        total += change
        x = x0 + column * width
        for i in range(2):
            d.polygon([(x, top + 32 * i), (x + width, top + 32 * i), (x + width, top + 32 * i + 25),
                       (x, top + 32 * i + 25)], PALE if i == 0 else "#e8f3e8", FAINT, 1)
        if change:
            d.text((x + width / 2, top + 17), signed(change), 12.5, RED if change > 0 else BLUE, "middle", True)
        else:
            d.text((x + width / 2, top + 17), "0", 12.5, FAINT, "middle")
        d.text((x + width / 2, top + 49), total, 12.5, INK, "middle", True)
        d.circle((x + width / 2, top + 76), 4.5, LIGHT if total == 0 else DARK, INK, 0.7)
    d.legend((612, 88), [("dot", LIGHT, "visible"), ("dot", DARK, "hidden"), ("line", INK, "*k* ≠ 0"),
                         ("dash", FAINT, "*k* = 0")])
    d.text((612, 182), "tetrahedron:", 12)
    d.text((612, 198), "*k* = 2", 12)
    d.text((612, 222), "one triangle:", 12)
    d.text((612, 238), "*k* = 1", 12)
    d.text((20, 500), "Edges run counter-clockwise around what they hide. From left to right, a row that crosses", 12.5)
    d.text((20, 518), "a downward edge adds +*k*, one that crosses an upward edge adds −*k*.", 12.5)
    return d.finish()


def shaft_figure():
    """Draws, from the side, two clusters of one pixel block, the shaft of one of them, and boxes and cones of edges inside and outside this shaft."""
    light = [(2.6, 6.0), (4.4, 6.0)]
    table = [(1.62 + 0.16 * i, 1.55) for i in range(4)]
    floor = [(2.3 + 0.38 * i, 0.0) for i in range(4)]
    box = [(min(x for x, _ in floor), 0), (max(x for x, _ in floor), 0)]
    shaft = hull(box + light)

    d = Drawing(760, 430, "A block of view samples, its clusters, the shaft of one, and boxes of edges")
    view = View(d, (15, 40, 420, 370), (-0.1, 6.3), (-0.35, 6.3))
    d.text((20, 26), "Which edges does a cluster of view samples need?", 14, bold=True)
    view.polygon(shaft, "#e8f3e8", GREEN, 1.2, "5 3")
    view.line((0, 0), (6.2, 0), DARK, 2)
    view.polygon([(0.3, 1.55), (2.2, 1.55), (2.2, 1.4), (0.3, 1.4)], DARK)
    view.line(*light, stroke=LIGHT, width=6)
    view.text((3.5, 6.0), "light", 13, (0, -8), anchor="middle")
    for q in table:
        view.dot(q, 3.2, FAINT)
    for q in floor:
        view.dot(q, 3.6, INK)
    view.text(table[0], "cluster 1", 12.5, (-8, -8), anchor="middle")
    view.text((2.87, 0), "cluster 2", 12.5, (0, 16), anchor="middle")
    view.text((3.05, 1.6), "shaft", 12.5, (0, 0), fill=GREEN, anchor="middle")

    def surface(center, radius, start, end, steps=6):
        """Returns the ends of a bent sheet's facets, seen from the side."""
        return arc(center, radius, start, end, steps)

    def judge(points):
        """Returns the box around a sheet, and whether it is outside the shaft, seen from one side only, or may have silhouettes."""
        x0, x1 = min(x for x, _ in points), max(x for x, _ in points)
        y0, y1 = min(y for _, y in points), max(y for _, y in points)
        corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
        if area(clip_to(corners, shaft) or [(0, 0)] * 3) == 0:
            return corners, "outside the shaft"
        signs = set()
        for a, b in zip(points, points[1:]):
            n = (b[1] - a[1], a[0] - b[0])
            signs |= {dot(n, sub(p, x)) > 0 for p in box for x in (a, b)}
        return corners, "seen from one side" if len(signs) == 1 else "silhouettes possible"

    sheets = [surface((5.35, 2.2), 0.55, 0.3, 2.6), surface((3.25, 5.55), 1.0, -2.35, -0.95),
              surface((3.35, 2.7), 0.42, 0, 2 * pi, 12)]
    verdicts = []
    for points in sheets:
        corners, verdict = judge(points)
        verdicts.append(verdict)
        needed = verdict == "silhouettes possible"
        view.polygon(corners, None, GREEN if needed else FAINT, 1.5, None if needed else "4 3")
        view.path(points, INK, 2)
        for q in points:
            view.dot(q, 2.2, INK)
    assert verdicts == ["outside the shaft", "seen from one side", "silhouettes possible"]
    view.text((5.4, 3.1), "1", 13, (0, -2), anchor="middle", bold=True)
    view.text((2.38, 4.9), "2", 13, (0, 0), anchor="middle", bold=True)
    view.text((3.95, 3.15), "3", 13, (0, 0), anchor="middle", bold=True)

    # The cone of box 2: normals of its facets around an axis, and the directions from its edges to the view samples.
    points = sheets[1]
    normals = []
    for a, b in zip(points, points[1:]):
        n = (b[1] - a[1], a[0] - b[0])
        normals.append(mul(1 / hypot(*n), n))
    if dot(normals[0], sub(box[0], points[0])) < 0:
        normals = [mul(-1, n) for n in normals]
    angles = sorted(atan2(n[1], n[0]) for n in normals)
    axis, theta = (angles[0] + angles[-1]) / 2, (angles[-1] - angles[0]) / 2
    directions = sorted(atan2(p[1] - x[1], p[0] - x[0]) for p in box for x in points)
    center = (600, 84)
    inset = View(d, (center[0] - 140, center[1] - 140, 280, 280), (-1, 1), (-1, 1))
    inset.polygon([(0, 0)] + arc((0, 0), 0.95, directions[0], directions[-1]), "#dbe9f6")
    inset.polygon([(0, 0)] + arc((0, 0), 0.72, axis - theta, axis + theta), "#f6dcd8")
    for n in normals:
        inset.arrow((0, 0), mul(0.72, n), RED, 1, 5)
    inset.arrow((0, 0), (0.95 * cos(axis), 0.95 * sin(axis)), INK, 1.5, 7)
    inset.dot((0, 0), 3)
    d.text((460, 56), "The cone of box 2", 13, bold=True)
    d.text((center[0] + 14, center[1] - 2), "an edge", 12)
    tip = inset.at((0.95 * cos(axis), 0.95 * sin(axis)))
    d.text((tip[0] + 4, tip[1] + 14), "axis", 12)
    d.text((460, 252), "red: normals of its facets, all within", 12.5, RED)
    d.text((460, 269), f"θ = {degrees(theta):.0f}° of the axis", 12.5, RED)
    d.text((460, 290), "blue: all directions *d* from its edges to cluster 2", 12.5, BLUE)
    worst = max(abs(w - axis) for w in (directions[0], directions[-1])) + theta
    d.text((460, 311), f"A direction and a normal are at most {degrees(worst):.0f}° apart,", 12.5)
    d.text((460, 328), "less than 90°: every *n* · *d* is positive.", 12.5)
    assert worst < pi / 2
    for i, (label, verdict) in enumerate(zip("123", verdicts)):
        d.text((460, 364 + 19 * i), f"{label}  {verdict}: " + ("kept" if i == 2 else "left out"), 12.5,
               GREEN if i == 2 else INK, bold=i == 2)
    return d.finish()


def open_figure():
    """Draws a crossing and a vertex with their errors, many thousand times too large."""
    rows, columns = 4, 8
    samples = rows_pattern(rows, columns)
    spacing = (2 / columns, 2 / rows)
    ends = [((-0.7, -0.93), (0.28, 0.9)), ((0.5, -0.9), (0.71, 0.27)), ((0.71, 0.27), (0.4, 0.95))]
    error = 0.036  # of every vertex, in s and in t

    d = Drawing(760, 380, "Open light samples around a crossing and around a vertex")
    d.text((20, 26), "A light sample is *open* if rounding may have moved an edge across it", 14, bold=True)
    view = View(d, (20, 42, 480, 316), (-1.02, 1.02), (-1.02, 1.02), stretch=True)
    view.polygon(SQUARE, "#fffdf5", LIGHT, 2)
    opened = set()
    for a, b in ends:
        m = (b[0] - a[0]) / (b[1] - a[1])
        wide = error * (1 + abs(m))
        view.polygon([(a[0] - wide, a[1]), (a[0] + wide, a[1]), (b[0] + wide, b[1]), (b[0] - wide, b[1])], RED,
                     opacity=0.16)
        view.line(a, b, INK, 2)
        for r, row in enumerate(samples):
            t = row[0][1]
            view.line((-1, t), (1, t), FAINT, 0.8, "2 3")
            x = a[0] + (t - a[1]) * m
            if a[1] < t < b[1]:
                view.line((x - wide, t), (x + wide, t), RED, 3)
                opened |= {(r, k) for k, st in enumerate(row) if abs(st[0] - x) <= wide}
            for v in (a, b):  # a vertex within its error of the row
                if abs(t - v[1]) <= error:
                    opened |= {(r, k) for k, st in enumerate(row) if abs(st[0] - v[0]) <= wide}
    for v in {q for e in ends for q in e}:
        view.polygon([(v[0] - error, v[1] - error), (v[0] + error, v[1] - error), (v[0] + error, v[1] + error),
                      (v[0] - error, v[1] + error)], None, BLUE, 1.3)
        view.dot(v, 2.5, INK)
    for r, row in enumerate(samples):
        for k, st in enumerate(row):
            if (r, k) in opened:
                view.dot(st, 5, "#ffffff", stroke=RED, width=2.2)
            else:
                view.dot(st, 3.6, LIGHT, stroke=INK, width=0.7)
    assert 1 <= len(opened) <= 4
    d.legend((520, 70), [("dot", LIGHT, "certain"), ("ring", RED, "open"),
                         ("line", INK, "a projected edge"), ("line", RED, "a crossing ± its error"),
                         ("box", "#a9c8e4", "a vertex ± its error")], step=22)
    d.text((542, 185), "The crossing's error is", 12.5)
    d.text((542, 202), "that of the ends, times", 12.5)
    d.text((542, 219), "1 + |*m*|, *m* = Δ*X* / Δ*Y*.", 12.5)
    d.text((542, 252), f"{len(opened)} of {rows * columns} samples are open:", 12.5, RED)
    d.text((542, 269), "exact predicates decide them.", 12.5)
    d.text((542, 302), "Errors are drawn some ten", 12.5)
    d.text((542, 319), "thousand times too large.", 12.5)
    return d.finish()


def scattered_samples(count):
    """Returns points of the unit disk, evenly spread by area: their angles are a Kronecker sequence of the golden ratio."""
    golden = 0.6180339887498949
    points = []
    for i in range(count):
        radius, angle = ((i + 0.5) / count) ** 0.5, 2 * pi * ((i * golden) % 1)
        points.append((0.97 * radius * cos(angle), 0.97 * radius * sin(angle)))
    return points


def change_in_tiles(edge, q, corner, left=-1.0):
    """Returns the change of depth by an edge along a path to q: up the light's left side, along the path of q's row to the left side of q's
    tile, then up, and right."""
    (x0, y0), (x1, y1), jump = edge

    def passed(at, side):
        is_right = y0 <= at[1] < y1 and (at[0] - x0) * (y1 - y0) > (at[1] - y0) * (x1 - x0)
        return is_right + (at[1] >= y1 and x1 < side) - (at[1] >= y0 and x0 < side)

    return jump * (passed(corner, left) + passed(q, corner[0]) - passed(corner, corner[0]))


def tiles_figure():
    """Draws light samples of a disk in rows of tiles, and the changes by one edge there."""
    tile, rows, count = 16, 4, 256
    by_height = sorted(scattered_samples(count), key=lambda q: (q[1], q[0]))
    of_row = count // rows
    tiles = []                              # ((its light samples, from left to right), its lower left corner)
    for r in range(rows):
        row = sorted(by_height[r * of_row:(r + 1) * of_row])
        lowest = min(q[1] for q in row)
        tiles += [(row[i:i + tile], (row[i][0], lowest)) for i in range(0, of_row, tile)]
    corners = [(-0.3, -0.72), (0.93, 0.1), (0.02, 0.42)]
    edges = [upward(corners[i], corners[(i + 1) % 3], 1) for i in range(3)]
    for its, corner in tiles:
        for q in its:
            found = sum(change_in_tiles(edge, q, corner) for edge in edges)
            assert found == inside(q, counter_clockwise(corners)), "closed outlines add up to the depth"

    a, b, jump = edges[2]                   # the triangle's left side
    d = Drawing(760, 420, "Light samples of a disk in tiles of sixteen, and an edge among them")
    d.text((20, 26), "Sixteen light samples are a tile; an edge is tested against the few tiles that it passes",
           14, bold=True)
    view = View(d, (20, 42, 356, 356), (-1.05, 1.05), (-1.05, 1.05))
    view.polygon([(cos(i * pi / 60), sin(i * pi / 60)) for i in range(120)], "#fffdf5", LIGHT, 2)
    view.line((-1, -1), (-1, 1), FAINT, 1.2)
    tested, whole, ends = 0, 0, {}
    for its, corner in tiles:
        low, high = min(q[1] for q in its), max(q[1] for q in its)
        bottom, top = max(corner[1], a[1]), min(high, b[1])
        left, right = sorted(a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) for y in (bottom, top))
        passes = bottom <= top and its[0][0] <= right and its[-1][0] >= left
        changes = [change_in_tiles((a, b, jump), q, corner) for q in its]
        assert passes or len(set(changes)) == 1, "a tile that an edge does not pass changes as a whole"
        kind = "tested" if passes else "whole" if changes[0] else "none"
        fill = {"none": None, "tested": GREEN, "whole": RED}[kind]
        view.polygon([(its[0][0] - .02, low - .015), (its[-1][0] + .02, low - .015), (its[-1][0] + .02, high + .015),
                      (its[0][0] - .02, high + .015)], fill, FAINT, 0.9, opacity=0.2 if fill else 1)
        tested += kind == "tested"
        whole += kind == "whole"
        for q, change in zip(its, changes):
            view.dot(q, 2.4, RED if change else LIGHT, stroke=INK, width=0.5)
        if kind == "whole":
            ends["whole"] = (its[5], corner)
        elif passes and any(changes) and not all(changes):
            ends["tested"] = (next(q for q, change in zip(its, changes) if change), corner)
    assert tested and whole and len(ends) == 2
    for (q, corner), color in ((ends["tested"], BLUE), (ends["whole"], DARK)):
        for x, y in (((-1, -1), (-1, corner[1])), ((-1, corner[1]), corner), (corner, (corner[0], q[1])), ((corner[0], q[1]), q)):
            view.line(x, y, color, 1.8)
    view.line(a, b, INK, 2.2)
    d.legend((410, 84), [("line", INK, "an edge"), ("dot", RED, "changes by its multiplicity"), ("dot", LIGHT, "does not change"),
                         ("box", "#d3e6d4", f"{tested} tiles are tested, sample by sample"),
                         ("box", "#f4d6d2", f"{whole} tiles change as a whole: one number each"),
                         ("line", BLUE, "the path to a light sample of a tested tile"), ("line", DARK, "the same for a tile that changes as a whole")],
             step=24)
    d.text((410, 274), "A row's path goes along its lowest light sample, and", 12.5)
    d.text((410, 291), "from there up and to the right within a tile. So an", 12.5)
    d.text((410, 308), "edge changes all light samples of a tile that it does", 12.5)
    d.text((410, 325), "not pass by the same number, whether or not they are", 12.5)
    d.text((410, 342), "at its height: the edges that continue at its ends", 12.5)
    d.text((410, 359), "account for the rest.", 12.5)
    return d.finish()


def upward(a, b, k):
    """Returns (low end, high end, change of depth to the right) of an edge from a to b with multiplicity k."""
    return (a, b, -k) if a[1] < b[1] else (b, a, k)


def change_along_the_path(edge, q, middle, left=-1.0):
    """Returns the change of depth by an edge along a path to q: up the light's left side, along the row's middle, and then straight to q."""
    (x0, y0), (x1, y1), jump = edge
    spans, over = y0 <= middle < y1, x1 - x0

    def is_right(y):
        return over < 0 if y >= y1 else over > 0 if y < y0 else (q[0] - x0) * (y1 - y0) > (y - y0) * over

    along = spans if q[0] >= max(x0, x1) else 0
    if min(x0, x1) <= q[0] < max(x0, x1):
        along = is_right(q[1]) - (0 if spans else is_right(middle))
    ends = (y1 <= middle and x1 < left) - (y0 <= middle and x0 < left)
    return jump * (along + ends)


def points_figure():
    """Draws light samples of a disk in rows of equal height, and the paths to two of them past an edge."""
    rows, count = 9, 84
    samples = scattered_samples(count)
    corners = [(0.42, -0.36), (0.74, 0.88), (-0.62, 0.13)]
    edges = [upward(corners[i], corners[(i + 1) % 3], 1) for i in range(3)]

    def middle_of(q):
        return -1 + (min(rows - 1, int((q[1] + 1) * rows / 2)) + 0.5) * 2 / rows

    for q in samples:
        found = sum(change_along_the_path(edge, q, middle_of(q)) for edge in edges)
        assert found == inside(q, counter_clockwise(corners)), "closed outlines add up to the depth"

    low, high, jump = edges[2]      # from the triangle's left corner down to the right
    middle = middle_of((0, -0.05))
    d = Drawing(760, 420, "Light samples of a disk in rows, and the paths to two of them")
    d.text((20, 26), "The path to a light sample: up the left side, along its row's middle, then straight up or down", 14, bold=True)
    view = View(d, (20, 42, 356, 356), (-1.05, 1.05), (-1.05, 1.05))
    view.polygon([(-1, middle - 1 / rows), (1, middle - 1 / rows), (1, middle + 1 / rows), (-1, middle + 1 / rows)], "#e8f3e8")
    view.polygon([(cos(i * pi / 60), sin(i * pi / 60)) for i in range(120)], None, LIGHT, 2)
    view.line((-1, middle), (1, middle), GREEN, 1, dash="4 3")
    view.line((-1, -1), (-1, 1), FAINT, 1.2)
    in_row = sorted(q for q in samples if middle_of(q) == middle)
    changed = [q for q in in_row if change_along_the_path((low, high, jump), q, middle)]
    beside = [q for q in in_row if min(low[0], high[0]) <= q[0] < max(low[0], high[0])]
    shown = [next(q for q in in_row if q[0] > max(low[0], high[0])), max(beside, key=lambda q: abs(q[1] - middle))]
    assert changed and len(changed) < len(in_row)
    for q, color, width in zip(shown, (DARK, BLUE), (4, 1.8)):  # the second on a part of the first
        for x, y in (((-1, -1), (-1, middle)), ((-1, middle), (q[0], middle)), ((q[0], middle), q)):
            view.line(x, y, color, width)
    for q in samples:
        view.dot(q, 3.2, RED if q in changed else LIGHT if q in in_row else PALE, stroke=INK, width=0.5)
    view.line(low, high, INK, 2.2)
    d.legend((410, 84), [("line", INK, "an edge"), ("dot", RED, "in this row: changes"), ("dot", LIGHT, "in this row: does not change"),
                         ("line", BLUE, "the path to a light sample between its ends"), ("line", DARK, "the path to one to the right of it")], step=24)
    d.text((410, 226), "All light samples of a row that are right of the edge's", 12.5)
    d.text((410, 243), "right end change alike: by its multiplicity if it crosses", 12.5)
    d.text((410, 260), "the row's middle, else not at all. Only those between its", 12.5)
    d.text((410, 277), "ends, where it passes the row, are tested one by one.", 12.5)
    return d.finish()


FIGURES = {"edge-scatter-rows": rows_figure, "edge-scatter-shaft": shaft_figure, "edge-scatter-open": open_figure,
           "edge-scatter-tiles": tiles_figure, "edge-scatter-points": points_figure}
