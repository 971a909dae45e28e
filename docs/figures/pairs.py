# SPDX-License-Identifier: Apache-2.0
"""Figures of docs/definitions.md and docs/raytrace.md (light samples and the truth of a pair), docs/view-sample.md (half-planes,
bits), docs/depth-complexity.md (counters along segments) and docs/exact.md (the sweep)."""

from math import cos, hypot, pi, sin

from drawing import BLUE, DARK, FAINT, GREEN, INK, LIGHT, PALE, RED, Drawing, View
from geometry import (SQUARE, counter_clockwise, crosses, det2, inside, meet, mix, mul, multiplicities, rows_pattern,
                      sub)
from scatter import LAMP, P, depth, seen_at, signed, solid

WORD = 0xffffffff


def reverse_bits(x):
    return int(f"{x:032b}"[::-1], 2)


def mix_bits(a, b, c):
    """The same as hash in visibility/sample_patterns.hpp."""
    x = ((a << 32 | b) + 0x9e3779b97f4a7c15 * (c + 1)) & 0xffffffffffffffff
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9 & 0xffffffffffffffff
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb & 0xffffffffffffffff
    return (x ^ (x >> 31)) >> 32


def owen_scramble(x, seed):
    x = (reverse_bits(x) + seed) & WORD
    for factor in (0x6c50b47c, 0xb82f1e52, 0xc7afe638, 0x8d22f6e6):
        x ^= x * factor & WORD
    return reverse_bits(x)


def sobol(count):
    samples = []
    for i in range(count):
        second, direction, index = 0, 0x80000000, i
        while index:
            second ^= direction if index & 1 else 0
            index, direction = index >> 1, direction ^ direction >> 1
        samples.append((owen_scramble(reverse_bits(i), mix_bits(0, 0, 0)) / 2**32,
                        owen_scramble(second, mix_bits(0, 1, 0)) / 2**32))
    return samples


def jittered(rows, columns):
    return [((i % columns + mix_bits(0, i, 0) / 2**32) / columns, (i // columns + mix_bits(0, i, 1) / 2**32) / rows)
            for i in range(rows * columns)]


def concentric(st):
    """Maps [−1, 1]² to the unit disk with areas in proportion (Shirley and Chiu)."""
    a, b = st
    if a == 0 and b == 0:
        return (0, 0)
    radius, angle = (a, pi / 4 * b / a) if abs(a) > abs(b) else (b, pi / 2 - pi / 4 * a / b)
    return (radius * cos(angle), radius * sin(angle))


def patterns_figure():
    d = Drawing(900, 232, "The four patterns of 64 light samples on a square, and rows on a disk")
    rows = [st for row in rows_pattern(8, 8) for st in row]
    on_square = [("rows", rows), ("grid", [st for row in rows_pattern(8, 8, False) for st in row]),
                 ("sobol, seed 0", [(2 * x - 1, 2 * y - 1) for x, y in sobol(64)]),
                 ("jittered, seed 0", [(2 * x - 1, 2 * y - 1) for x, y in jittered(8, 8)])]
    for i, (name, samples) in enumerate(on_square):
        view = View(d, (16 + 176 * i, 36, 160, 160), (-1, 1), (-1, 1))
        d.text((96 + 176 * i, 24), name, 13, anchor="middle", bold=True)
        view.polygon(SQUARE, "#fff7df", LIGHT, 1.5)
        if name != "sobol, seed 0":
            for k in range(1, 8):
                view.line((-1, k / 4 - 1), (1, k / 4 - 1), PALE, 1)
                view.line((k / 4 - 1, -1), (k / 4 - 1, 1), PALE, 1)
        for st in samples:
            view.dot(st, 2.8)
    view = View(d, (720, 36, 160, 160), (-1, 1), (-1, 1))
    d.text((800, 24), "rows, on a disk", 13, anchor="middle", bold=True)
    view.dot((0, 0), 80, "#fff7df", stroke=LIGHT)
    for st in rows:
        view.dot(concentric(st), 2.8)
    d.text((16, 220), "64 light samples each. Lines: cells of rows and grid, strata of jittered.", 12.5)
    return d.finish()


def pair_figure():
    """Draws a pair in a plane: the carrier is a line, and so is every triangle."""
    p, slope = (0.0, 0.0), 0.3
    light = ((4.6, 0.35), (4.6, 4.1))
    samples = [mix(*light, (k + 0.5) / 8) for k in range(8)]
    occluder = ((2.2, 1.0), (2.75, 1.9))
    d = Drawing(760, 400, "Which light samples are visible from p?")
    view = View(d, (10, 20, 520, 370), (-1.6, 5.3), (-0.75, 4.4))
    low, high = (-1.5, -1.5 * slope), (5.2, 5.2 * slope)
    view.polygon([low, high, (5.2, -0.7), (-1.5, -0.7)], PALE, opacity=0.6)
    view.line(low, high, FAINT, 1.2, "5 3")
    view.line((-1.0, -1.0 * slope), (0.9, 0.9 * slope), INK, 5)
    view.text((-0.9, -0.5), "carrier", 12.5, (0, 8))
    view.text((3.3, 0.0), "not above the carrier's plane", 12.5, (0, 0), anchor="middle")
    view.line(*occluder, stroke=DARK, width=5)
    view.text(occluder[1], "a triangle", 12.5, (-8, -8), anchor="end")
    eye = (-1.2, 2.6)
    view.line(eye, p, FAINT, 1.2)
    view.dot(eye, 5, "#ffffff", stroke=INK)
    view.text(eye, "camera", 12.5, (0, -12), anchor="middle")
    n = mul(0.75 / hypot(slope, 1), (-slope, 1))
    view.arrow(p, n, INK, 2)
    view.text(n, "*n*", 13, (6, -2))
    view.line(*light, stroke=LIGHT, width=7)
    view.arrow((4.6, 3.85), (4.1, 3.85), LIGHT, 2)
    view.text((4.6, 4.1), "light, emits to the left", 12.5, (20, -8), anchor="end")
    counts = {"visible": 0, "blocked": 0, "horizon": 0}
    for j, l in enumerate(samples):
        if l[1] <= slope * l[0]:
            what = "horizon"
        elif crosses(p, l, *occluder):
            what = "blocked"
        else:
            what = "visible"
        counts[what] += 1
        if what == "blocked":
            hit = meet(p, l, *occluder)
            view.line(p, hit, RED, 1.4)
            view.line(hit, l, RED, 1, "3 4")
        else:
            view.line(p, l, GREEN if what == "visible" else FAINT, 1.4, None if what == "visible" else "2 3")
        view.dot(l, 4.6, {"visible": LIGHT, "blocked": DARK, "horizon": "#ffffff"}[what], stroke=INK)
        view.text(l, f"*l*_{j}", 12, (9, 4))
    view.dot(p, 5)
    view.text(p, "*p*", 14, (-6, -9), anchor="end", bold=True)
    assert all(counts.values())
    d.legend((560, 90), [("dot", LIGHT, "visible"), ("dot", DARK, "blocked: (3) fails"),
                         ("ring", INK, "horizon: (1) fails")], step=24)
    d.text((560, 190), f"*V* = {counts['visible']} / {len(samples)}", 15, bold=True)
    bits = "".join("1" if s[1] > slope * s[0] and not crosses(p, s, *occluder) else "0" for s in samples)
    d.text((560, 216), f"bits *l*_7 … *l*_0: {bits[::-1]}", 13)
    d.text((560, 262), "If *p* were to the right of the", 12.5)
    d.text((560, 279), "light, (2) would fail for all.", 12.5)
    return d.finish()


def half_plane(a, b):
    """Returns f with f(l) > 0 to the left of a→b."""
    return lambda l: det2(sub(b, a), sub(l, a))


def view_sample_figure():
    one = [LAMP.project(P, x) for x in (seen_at(-0.72, -0.62, .5), seen_at(0.42, -0.3, .6), seen_at(-0.3, 0.74, .7))]
    two = [LAMP.project(P, x) for x in (seen_at(0.02, -0.75, .5), seen_at(0.8, 0.1, .6), seen_at(0.1, 0.35, .7))]
    rows, columns = 8, 8
    samples = rows_pattern(rows, columns)
    error = 0.012  # of each edge, as a distance
    d = Drawing(860, 470, "Three half-planes bound the part that a triangle hides; masks are OR-ed")
    d.text((20, 26), "One triangle: three half-planes, seen from *p*", 14, bold=True)
    view = View(d, (20, 40, 420, 370), (-1.08, 1.08), (-1.08, 1.08))
    view.polygon(SQUARE, "#fff7df", LIGHT, 2)
    view.polygon(one, DARK, opacity=0.2)
    colours = (RED, BLUE, GREEN)
    corners = counter_clockwise(one)
    edges = [(corners[i], corners[(i + 1) % 3]) for i in range(3)]
    for (a, b), colour, name in zip(edges, colours, ("*f*_ab", "*f*_bc", "*f*_ca")):
        along = mul(1 / hypot(*sub(b, a)), sub(b, a))
        inward = (-along[1], along[0])
        far = [q for q in (meet(a, b, SQUARE[i - 1], SQUARE[i]) for i in range(4)) if max(map(abs, q)) < 1 + 1e-9]
        view.polygon([tuple(x + s * error * y for x, y in zip(q, inward)) for q, s in
                      ((far[0], 1), (far[1], 1), (far[1], -1), (far[0], -1))], colour, opacity=0.3)
        view.line(far[0], far[1], colour, 1.2)
        middle = mix(a, b, 0.5)
        view.arrow(middle, tuple(x + 0.13 * y for x, y in zip(middle, inward)), colour, 2)
        view.text(tuple(x + 0.2 * y for x, y in zip(middle, inward)), name + " > 0", 12, anchor="middle", fill=colour,
                  halo=True)
    chosen = 3
    ends, opened = [], 0
    for r, row in enumerate(samples):
        for st in row:
            values = [half_plane(a, b)(st) / hypot(*sub(b, a)) for a, b in edges]
            is_open = min(abs(v) for v in values) <= error and all(v >= -error for v in values)
            hidden = all(v > 0 for v in values)
            if is_open:
                opened += 1
                view.dot(st, 5, "#ffffff", stroke=RED, width=2)
            else:
                view.dot(st, 3.6, DARK if hidden else LIGHT, stroke=INK, width=0.7)
        t = row[0][1]
        if r == chosen:
            crossing = [a[0] + (t - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) for a, b in edges
                        if (a[1] - t) * (b[1] - t) < 0]
            ends = [min(crossing), max(crossing)]
            view.line((ends[0], t), (ends[1], t), INK, 2.5)
            view.text((ends[1], t), f"row {r}: one interval", 12, (6, 15), halo=True)
    assert opened
    d.legend((30, 432), [("dot", DARK, "hidden: all three *f* certainly of one sign")])
    d.legend((30, 452), [("ring", RED, "undecided: an *f* is within its error (drawn too wide)")])

    def bits(corners):
        corners = counter_clockwise(corners)
        return [[inside(st, corners) for st in row] for row in samples]

    first, second = bits(one), bits(two)
    both = [[a or b for a, b in zip(x, y)] for x, y in zip(first, second)]
    d.text((480, 26), "All triangles: blocked bits are OR-ed", 14, bold=True)
    for i, (name, grid) in enumerate((("triangle 1", first), ("triangle 2", second), ("OR", both))):
        x0, y0, size = (480 + 180 * (i % 2), 66 + 196 * (i // 2), 17)
        d.text((x0, y0 - 10), name, 12.5, bold=True)
        for r in range(rows):
            for k in range(columns):
                x, y = x0 + size * k, y0 + size * (rows - 1 - r)
                blocked = grid[r][k]
                d.polygon([(x, y), (x + size, y), (x + size, y + size), (x, y + size)], DARK if blocked else "#fff7df",
                          "#ffffff", 1)
                d.text((x + size / 2, y + 12.5), int(blocked), 10.5, "#ffffff" if blocked else FAINT, "middle")
    count = sum(map(sum, both))
    d.text((660, 300), f"{count} of {rows * columns} bits are set:", 13)
    d.text((660, 320), f"*V* = 1 − {count} / {rows * columns} = {1 - count / (rows * columns):.3f}", 13, bold=True)
    d.text((660, 352), "Where both triangles hide", 12.5)
    d.text((660, 369), "a sample, it counts once.", 12.5)
    return d.finish()


def counters_figure():
    triangles = solid([seen_at(-0.75, -0.6, .6), seen_at(0.3, -0.72, .5), seen_at(-0.22, 0.62, .62),
                       seen_at(-0.3, -0.2, .4)])
    triangles += [(seen_at(-0.36, 0.16, .8), seen_at(0.95, -0.3, .8), seen_at(0.6, 0.72, .85))]
    edges = []
    for (a, b), k in multiplicities(triangles, P).items():
        q, r = LAMP.project(P, a), LAMP.project(P, b)
        if k:
            edges.append((q, r, k) if k > 0 else (r, q, -k))
    samples = [concentric(st) for row in rows_pattern(6, 6) for st in row]
    c0 = (-1, -1)
    d = Drawing(780, 470, "Counters of a disk's light samples along segments from a corner")
    d.text((20, 26), "A disk light as seen from *p*: a counter for each light sample", 14, bold=True)
    view = View(d, (20, 44, 420, 410), (-1.1, 1.1), (-1.1, 1.1))
    view.polygon(SQUARE, None, FAINT, 1.5, "5 3")
    view.dot((0, 0), view.sx, "#fff7df", stroke=LIGHT, width=2)
    for triangle in triangles:
        view.polygon([LAMP.project(P, x) for x in triangle], DARK, opacity=0.12)
    for q, r, k in edges:
        view.line(q, r, INK, 2)
        middle, along = mix(q, r, 0.5), mul(0.03 / hypot(*sub(r, q)), sub(r, q))
        view.arrow(sub(middle, along), tuple(x + y for x, y in zip(middle, along)), INK, 1, 10)
    start = depth(triangles, c0)
    assert start == 0

    def walk(x):
        """Returns the changes along the segment from c₀ to x, in order: (place, change)."""
        steps = []
        for q, r, k in edges:
            if crosses(c0, x, q, r):
                entering = det2(sub(r, q), sub(x, c0)) < 0   # from the edge's right side to its left, or back?
                steps.append((meet(c0, x, q, r), -k if entering else k))
        return sorted(steps, key=lambda step: hypot(*sub(step[0], c0)))

    shown = [min(samples, key=lambda x: hypot(*sub(x, goal))) for goal in ((0.28, 0.12), (-0.11, 0.82))]
    for x in shown:
        view.arrow(c0, x, GREEN, 2, 9)
        for place, change in walk(x):
            view.dot(place, 3, "#ffffff", stroke=INK)
            view.text(place, signed(change), 12.5, (-9, -6), anchor="middle", fill=RED if change > 0 else BLUE,
                      bold=True, halo=True)
    free = 0
    for x in samples:
        counter = start + sum(change for _, change in walk(x))
        assert counter == depth(triangles, x)
        free += counter == 0
        view.dot(x, 7, LIGHT if counter == 0 else DARK)
        x_, y_ = view.at(x)
        d.text((x_, y_ + 3.8), counter, 10.5, INK if counter == 0 else "#ffffff", "middle", True)
    view.dot(c0, 5)
    view.text(c0, "*c*_0", 14, (10, 16), bold=True)
    view.text((1, 1), "*F*", 14, (-16, 18))
    x = 470
    d.text((x, 80), f"*D*(*c*_0) = {start}, counted triangle by triangle", 12.5)
    for i, target in enumerate(shown):
        steps = [change for _, change in walk(target)]
        text = f"{start} " + " ".join(("+ " if c > 0 else "− ") + str(abs(c)) for c in steps)
        d.text((x, 112 + 22 * i), f"segment {i + 1}: {text} = {start + sum(steps)}", 13, GREEN, bold=True)
    d.text((x, 170), "Edges run counter-clockwise around what", 12.5)
    d.text((x, 187), "they hide. A segment that crosses one from its", 12.5)
    d.text((x, 204), "right to its left enters *k* triangles: +*k*.", 12.5)
    d.text((x, 236), "Tetrahedron: *k* = 2. Single triangle: *k* = 1.", 12.5)
    d.text((x, 268), f"*V* = {free} / {len(samples)}", 14, bold=True)
    d.legend((x, 300), [("dot", LIGHT, "counter 0: visible"), ("dot", DARK, "counter > 0: hidden")])
    return d.finish()


def exact_figure():
    triangles = solid([seen_at(-0.85, -0.7, .6), seen_at(0.2, -0.85, .5), seen_at(-0.3, 0.6, .62),
                       seen_at(-0.35, -0.25, .4)])
    triangles += [(seen_at(-0.42, 0.1, .8), seen_at(0.9, -0.42, .8), seen_at(0.55, 0.75, .85))]
    projected = [counter_clockwise([LAMP.project(P, x) for x in triangle]) for triangle in triangles]
    edges = []
    for (a, b), k in multiplicities(triangles, P).items():
        q, r = LAMP.project(P, a), LAMP.project(P, b)
        if k:
            edges.append((q, r, k) if k > 0 else (r, q, -k))
    events = {-1.0, 1.0} | {q[0] for e in edges for q in e[:2]}
    for i, (a, b, _) in enumerate(edges):
        for c, e, _ in edges[:i]:
            if crosses(a, b, c, e):
                events.add(meet(a, b, c, e)[0])
    events = sorted(x for x in events if -1 <= x <= 1)

    def free(s):
        """Returns the intervals of the vertical line at s, each with the number of layers that cover it."""
        line = []
        for q, r, k in edges:
            if (q[0] - s) * (r[0] - s) < 0:
                line.append((q[1] + (s - q[0]) / (r[0] - q[0]) * (r[1] - q[1]), k if r[0] > q[0] else -k))
        total, at, out = 0, -1.0, []
        for t, change in sorted(line) + [(1.0, 0)]:
            out.append((at, t, total))
            total, at = total + change, t
        return out

    d = Drawing(780, 440, "Signed edges on the light and the sweep's slabs")
    d.text((20, 26), "The light as seen from *p*: slabs between ends and crossings of edges", 14, bold=True)
    view = View(d, (20, 44, 420, 380), (-1.05, 1.05), (-1.05, 1.05))
    view.polygon(SQUARE, "#fff7df", LIGHT, 2)
    for corners in projected:
        view.polygon(corners, DARK, opacity=0.16)
    visible = 0
    for a, b in zip(events, events[1:]):
        view.line((a, -1), (a, 1), FAINT, 1, "3 3")
        middle = (a + b) / 2
        for low, high, total in free(middle):
            if total == 0 and high > low:
                visible += (b - a) * (high - low)
                view.line((middle, low), (middle, high), GREEN, 2.2)
    for q, r, k in edges:
        view.line(q, r, INK, 2)
    # The numbers of layers are shown in the slab with the most layers, of those wider than 0.2.
    middle = max(((a + b) / 2 for a, b in zip(events, events[1:]) if b - a > 0.2),
                 key=lambda s: max(total for _, _, total in free(s)))
    for low, high, total in free(middle):
        if high - low > 0.08:
            view.text((middle, (low + high) / 2), total, 13, (6, 4), bold=True, fill=GREEN if total == 0 else INK, halo=True)
    share = visible / 4
    steps = 4000
    check = sum(high - low for i in range(steps) for low, high, total in free(-1 + (i + 0.5) * 2 / steps) if total == 0)
    assert abs(check * 2 / steps / 4 - share) < 1e-5, "the middle of a slab is its mean"
    for st in ((x / 7.3 - 0.9, y / 8.1 - 0.9) for x in range(14) for y in range(14)):
        count = [total for low, high, total in free(st[0]) if low < st[1] < high]
        assert not count or count[0] == sum(inside(st, c) for c in projected)
    x = 465
    d.text((x, 90), "Up a vertical line each edge changes the", 12.5)
    d.text((x, 107), "number of triangles that cover it (numbers", 12.5)
    d.text((x, 124), "in one slab). Edges inside a surface cancel:", 12.5)
    d.text((x, 141), f"{len(edges)} of {len(multiplicities(triangles, P))} are left here.", 12.5)
    d.text((x, 176), "In a slab the order of edges stays the same,", 12.5)
    d.text((x, 193), "so the uncovered length is linear: its value", 12.5)
    d.text((x, 210), "in the middle (green) times the width is the", 12.5)
    d.text((x, 227), "slab's visible area, exactly.", 12.5)
    d.text((x, 268), f"*V* = {share:.6f}", 15, bold=True)
    d.text((x, 292), f"from {len(events) - 1} slabs", 12.5)
    return d.finish()


FIGURES = {"patterns": patterns_figure, "pair": pair_figure, "view-sample": view_sample_figure,
           "depth-complexity": counters_figure, "exact": exact_figure}
