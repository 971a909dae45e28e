# SPDX-License-Identifier: Apache-2.0
"""Figures of docs/backproject.md, backproject-peel.md, bitmask.md, soft-shadow-map.md, contour.md, packet.md: texels of one map as
occluders. As seen from the side, a map is a row of texels, a caster a segment, and the light a line at height 0; heights grow downward."""

from math import atan2, hypot, pi

from drawing import BLUE, DARK, FAINT, GREEN, INK, LIGHT, PALE, RED, Drawing, View
from geometry import crosses

FLOOR = 5.0


def heights(casters, direction):
    """Returns where the ray along (direction, 1) from the light's centre meets casters, the nearest first."""
    found = []
    for (x0, z0), (x1, z1) in casters:
        dx, dz = x1 - x0, z1 - z0
        bottom = dx - direction * dz
        if bottom:
            t = (direction * z0 - x0) / bottom
            if 0 <= t <= 1:
                found.append(z0 + t * dz)
    return sorted(found)


def map_of(casters, span, texels):
    """Returns [(left, right, heights)] of the texels that are not empty."""
    width = 2 * span / texels
    rows = [(-span + i * width, -span + (i + 1) * width) for i in range(texels)]
    return [(a, b, heights(casters, (a + b) / 2)) for a, b in rows if heights(casters, (a + b) / 2)]


def on_light(p, a, b, z, half):
    """Returns the part of the light that a texel [a, b] at height z hides from p, as (from, to)."""
    x, depth = p
    f = z * depth / (depth - z)
    return max((a - x / depth) * f, -half), min((b - x / depth) * f, half)


def truth(casters, p, half, count=4000):
    return sum(not any(crosses((half * (2 * (i + 0.5) / count - 1), 0), p, *c) for c in casters) for i in range(count)) / count


def union(parts):
    total, end = 0.0, -9.0
    for a, b in sorted(parts):
        total += max(0.0, b - max(a, end))
        end = max(end, b)
    return total


def scene_view(d, box, casters, patches, p, half, left=-2.6, right=2.6):
    """Draws the light, casters, the floor, patches of texels, and the rays from p past them."""
    view = View(d, box, (left, right), (-FLOOR - 0.35, 0.35), stretch=True)
    view.line((left, -FLOOR), (right, -FLOOR), DARK, 2)
    for (x0, z0), (x1, z1) in casters:
        view.line((x0, -z0), (x1, -z1), FAINT, 6)
    for a, b, z, colour in patches:
        for tangent in (a, b):
            view.line((0, 0), (tangent * z, -z), PALE, 0.8)
    for a, b, z, colour in patches:
        first, last = on_light(p, a, b, z, half)
        if first < last:
            for s in (first, last):
                view.line((s, 0), (p[0], -p[1]), colour, 0.7, opacity=0.55)
        view.line((a * z, -z), (b * z, -z), colour, 4)
    view.line((-half, 0), (half, 0), LIGHT, 7)
    view.dot((0, 0), 4)
    view.dot((p[0], -p[1]), 5)
    view.text((p[0], -p[1]), "*p*", 14, (10, -6), bold=True)
    return view


def light_bar(d, at, width, half, parts, label):
    """Draws the light enlarged, with its hidden parts; where two overlap, it is darker."""
    x, y = at
    view = View(d, (x, y, width, 22), (-half, half), (0, 1), stretch=True)
    view.polygon([(-half, 0), (half, 0), (half, 1), (-half, 1)], LIGHT)
    for a, b in parts:
        if a < b:
            view.polygon([(a, 0), (b, 0), (b, 1), (a, 1)], DARK, opacity=0.55)
            view.line((a, 0), (a, 1), "#ffffff", 1)
    d.text((x, y - 6), label, 12.5)


PLATES = [((-0.42, 1.7), (0.42, 1.7)), ((-2.0, 3.5), (2.0, 3.5))]
P = (1.15, FLOOR)
HALF, SPAN, TEXELS = 0.6, 0.72, 18


def backproject_figure():
    d = Drawing(860, 470, "Texels as patches, seen from a receiver: the hidden parts of the light, with gaps and with gaps filled",
                "A small plate above a large one. Patches of the large plate end where the small one hides it from the light's centre; "
                "from p light shows through the gap, until patches reach to the height of their neighbours.")
    texels = [(a, b, z[0]) for a, b, z in map_of(PLATES, SPAN, TEXELS)]
    d.text((20, 26), "Each texel is a patch at its own depth, and hides a part of the light from p", 14, bold=True)
    scene_view(d, (20, 45, 520, 300), PLATES, [(a, b, z, BLUE if z < 2 else GREEN) for a, b, z in texels], P, HALF)
    plain = [on_light(P, a, b, z, HALF) for a, b, z in texels]
    filled = []
    for i, (a, b, z) in enumerate(texels):
        # A patch can only grow (Guennebaud et al. 2006): its left border, projected at the left neighbour's depth, counts if farther out.
        first, last = on_light(P, a, b, z, HALF)
        if i:
            own = (a - P[0] / P[1]) * z * P[1] / (P[1] - z)
            other = (a - P[0] / P[1]) * texels[i - 1][2] * P[1] / (P[1] - texels[i - 1][2])
            first = max(min(own, other), -HALF)
        filled.append((first, last))
    real = truth(PLATES, P, HALF)
    x = 565
    for y, parts, name in ((110, plain, "patches alone"), (190, filled, "edges filled")):
        hidden = min(1.0, sum(max(0.0, b - a) for a, b in parts) / (2 * HALF))
        light_bar(d, (x, y), 270, HALF, parts, f"{name}: *V* = {1 - hidden:.2f}")
    d.text((x, 250), f"true *V* = {real:.2f}", 13, bold=True)
    assert real == 0
    d.legend((x, 285), [("line", BLUE, "patches of the small plate"), ("line", GREEN, "patches of the large plate"), ("box", FAINT, "the plates themselves"),
                        ("box", DARK, "hidden part of the light")])
    d.text((20, 380), "The map lacks the part of the large plate that the small one hides from the light's centre. As seen from p the plates", 12.5)
    d.text((20, 397), "are apart, and light comes through the gap. Filling assumes one surface: right here, too dark where the gap is real.", 12.5)
    d.text((20, 425), f"A border at tangent *α* and height *z*_s falls at (*α* − *x*/*z*) · *f* on the light, *f* = *z*_s *z* / (*z* − *z*_s); map of {TEXELS} texels.", 12.5)
    return d.finish()


def peel_figure():
    d = Drawing(860, 420, "Two layers of a map: the surface behind closes the gap",
                "The same plates. With two layers a texel has both plates; of the two the deepest that hides light counts, and no light comes through.")
    rows = map_of(PLATES, SPAN, TEXELS)
    chosen, patches = [], []
    for a, b, layers in rows:
        parts = [(z, on_light(P, a, b, z, HALF)) for z in reversed(layers)]
        z, part = next(((z, part) for z, part in parts if part[0] < part[1]), parts[0])
        chosen.append(part)
        patches += [(a, b, layer, GREEN if layer == z else BLUE) for layer in layers]
    d.text((20, 26), "Peeled layers: the deepest surface of a texel that hides light from p counts", 14, bold=True)
    scene_view(d, (20, 45, 520, 300), PLATES, patches, P, HALF)
    hidden = min(1.0, sum(max(0.0, b - a) for a, b in chosen) / (2 * HALF))
    light_bar(d, (565, 110), 270, HALF, chosen, f"two layers: *V* = {1 - hidden:.2f}")
    d.text((565, 170), f"true *V* = {truth(PLATES, P, HALF):.2f}", 13, bold=True)
    assert abs(1 - hidden - truth(PLATES, P, HALF)) < 1e-9
    d.legend((565, 205), [("line", GREEN, "counts"), ("line", BLUE, "does not: something behind it does"), ("box", DARK, "hidden part of the light")])
    middles = sum(len(layers) > 1 for *_, layers in rows)
    d.text((20, 380), f"{middles} of {len(rows)} texels have a second layer. Whether p is behind a layer is decided at the middle between it and the next, so that", 12.5)
    d.text((20, 397), "a closed surface does not shade itself and needs no bias.", 12.5)
    return d.finish()


def bitmask_figure():
    casters = [((-1.5, 1.6), (0.0, 1.6)), ((0.28, 3.4), (0.7, 3.4))]
    p, half, count = (1.0, FLOOR), 1.0, 32
    d = Drawing(860, 440, "Parts of the light as sets of light samples: light that two patches hide counts once",
                "Two plates overlap as p sees them. Summed parts hide more than the light has; joined sets of 32 light samples do not.")
    texels = [(a, b, z[0]) for a, b, z in map_of(casters, 0.95, 38)]
    d.text((20, 26), "Hidden light as bits of light samples: joined, not added", 14, bold=True)
    scene_view(d, (20, 45, 500, 290), casters, [(a, b, z, BLUE if z < 2 else GREEN) for a, b, z in texels], p, half)
    parts = [on_light(p, a, b, z, half) for a, b, z in texels]
    parts = [part for part in parts if part[0] < part[1]]
    total = sum(b - a for a, b in parts) / (2 * half)
    samples = [half * (2 * (i + 0.5) / count - 1) for i in range(count)]
    x = 545
    light_bar(d, (x, 90), 290, half, parts, f"added: hidden {total:.2f}, *V* = {max(0, 1 - total):.2f}")
    groups = [("bits of the upper plate", [q for (a, b, z), q in zip(texels, (on_light(p, *t, half) for t in texels)) if z < 2]),
              ("bits of the lower plate", [q for (a, b, z), q in zip(texels, (on_light(p, *t, half) for t in texels)) if z > 2])]
    joined = set()
    for row, (name, held) in enumerate(groups):
        bits = {i for i, s in enumerate(samples) if any(a <= s <= b for a, b in held)}
        joined |= bits
        bit_row(d, (x, 150 + 50 * row), name, bits, count)
    bit_row(d, (x, 250), f"joined: *V* = {count - len(joined)}/{count} = {1 - len(joined) / count:.2f}", joined, count)
    real = truth(casters, p, half)
    d.text((x, 305), f"true *V* = {real:.2f}", 13, bold=True)
    assert abs(1 - len(joined) / count - real) < 0.06 and 1 - total < real - 0.2
    d.text((20, 375), "From the light's centre the plates are apart, so both are in the map; from p one is behind the other. Sums subtract", 12.5)
    d.text((20, 392), "the overlap twice. Bits are the light samples that all methods share, so masks can be compared with rays pair by pair, and", 12.5)
    d.text((20, 409), "each sample has its own colour and cosine.", 12.5)
    return d.finish()


def bit_row(d, at, label, bits, count):
    x, y = at
    d.text((x, y - 6), label, 12.5)
    for i in range(count):
        d.polygon([(x + 9 * i, y), (x + 9 * i + 8, y), (x + 9 * i + 8, y + 16), (x + 9 * i, y + 16)], DARK if i in bits else LIGHT)


def soft_shadow_map_figure():
    casters = [((-0.85, 2.3), (0.1, 2.6)), ((0.1, 2.6), (0.75, 2.0))]
    half, count = 0.7, 14
    d = Drawing(860, 500, "A soft shadow map: each occluder texel adds its penumbra to a map of the receivers",
                "One patch and the wedge of directions in which it hides some of the light; below it the hidden share that it adds on the floor, the sums "
                "of all patches, and the truth.")
    texels = [(a, b, z[0]) for a, b, z in map_of(casters, 0.42, count)]
    d.text((20, 26), "Each occluder patch adds its hidden light to every receiver that it can reach", 14, bold=True)
    view = View(d, (20, 45, 540, 250), (-3.1, 3.1), (-5.2, 0.3), stretch=True)
    view.line((-3.1, -FLOOR), (3.1, -FLOOR), DARK, 2)
    for (x0, z0), (x1, z1) in casters:
        view.line((x0, -z0), (x1, -z1), FAINT, 6)
    for a, b, z in texels:
        view.line((a * z, -z), (b * z, -z), BLUE, 3)
    a, b, z = texels[4]
    reach = half * (1 / z - 1 / FLOOR)
    view.polygon([(a * z, -z), (b * z, -z), ((b + reach) * FLOOR, -FLOOR), ((a - reach) * FLOOR, -FLOOR)], GREEN, opacity=0.18)
    view.line((-half, 0), ((b + reach) * FLOOR, -FLOOR), GREEN, 1)
    view.line((half, 0), ((a - reach) * FLOOR, -FLOOR), GREEN, 1)
    view.line((a * z, -z), (b * z, -z), GREEN, 5)
    view.line((-half, 0), (half, 0), LIGHT, 7)
    graph = View(d, (20, 310, 540, 120), (-3.1, 3.1), (0, 1.1), stretch=True)
    xs = [-3.1 + 6.2 * i / 400 for i in range(401)]
    one, sums, real = [], [], []
    for x in xs:
        share = [max(0.0, e - s) / (2 * half) for s, e in (on_light((x, FLOOR), *t, half) for t in texels)]
        one.append((x, share[4]))
        sums.append((x, 1 - min(1.0, sum(share))))
    for x in xs[::4]:
        real.append((x, truth(casters, (x, FLOOR), half, 300)))
    for v in (0, 1):
        graph.line((-3.1, v), (3.1, v), PALE, 1)
        graph.text((-3.1, v), v, 12, (-4, 4), anchor="end")
    graph.path(real, INK, 2)
    graph.path(sums, BLUE, 2)
    graph.path(one, GREEN, 2)
    worst = max(abs(v - dict(sums)[x]) for x, v in real)
    x = 585
    d.legend((x, 90), [("line", FAINT, "casters"), ("line", BLUE, "patches of the occluder map"), ("line", GREEN, "one patch, and what it reaches")])
    d.legend((x, 340), [("line", GREEN, "hidden by that patch alone"), ("line", BLUE, "*V*: 1 − the sum of all"), ("line", INK, "true *V*")])
    d.text((x, 410), f"off by up to {worst:.2f}", 12.5)
    d.text((20, 465), "Hidden light is computed at the texels of a second map, of the receivers, in which pixels look up *V*.", 12.5)
    d.text((20, 484), f"A patch reaches (half the light) · (1/*z*_p − 1/*z*) beyond its own directions; {count} texels across.", 12.5)
    return d.finish()


def blob(i, j):
    """Returns whether a texel is in a shape that is neither convex nor aligned with the map's axes."""
    x, y = i - 6.7, j - 6.2
    return hypot(x, 1.25 * y) < 4.6 + 1.5 * (x * y > 0) * min(1, abs(x * y) / 9) or (5 <= i - 2 <= 9 and 9 <= j <= 11)


def outline_edges(inside, size):
    """Returns the edges of marching squares between texels' centres: each has the inside on its left, and saddles are separated."""
    edges = []
    for j in range(-1, size):
        for i in range(-1, size):
            corners = [((i, j), (i + 1, j)), ((i + 1, j), (i + 1, j + 1)), ((i + 1, j + 1), (i, j + 1)), ((i, j + 1), (i, j))]
            into = [((a[0] + b[0]) / 2, (a[1] + b[1]) / 2) for a, b in corners if not inside(*a) and inside(*b)]
            out = [((a[0] + b[0]) / 2, (a[1] + b[1]) / 2) for a, b in corners if inside(*a) and not inside(*b)]
            if len(into) == 1:
                edges.append((out[0], into[0]))
            elif len(into) == 2:
                edges += [(out[0], into[0]), (out[1], into[1])]
    return edges


def contour_figure():
    size = 16
    held = {(i, j) for i in range(size) for j in range(size) if blob(i, j)}
    edges = outline_edges(lambda i, j: (i, j) in held, size)
    d = Drawing(860, 430, "An outline of the texels that shade, and the parts of the light beyond its edges",
                "Left a map with shading texels and their outline through the middles between centres; right the outline on the light, "
                "with the sector beyond one edge.")
    d.text((20, 26), "Only the outline of the shading texels is projected", 14, bold=True)
    view = View(d, (20, 45, 360, 340), (-0.6, size - 0.4), (-0.6, size - 0.4))
    for i in range(size):
        for j in range(size):
            view.polygon([(i - 0.5, j - 0.5), (i + 0.5, j - 0.5), (i + 0.5, j + 0.5), (i - 0.5, j + 0.5)], "#c3cad3" if (i, j) in held else None, PALE, 0.8)
    for a, b in edges:
        view.line(a, b, RED, 2.2)
    p = (9.3, 5.4)
    view.dot(p, 5)
    view.text(p, "*p*", 14, (8, -6), bold=True)
    lamp = View(d, (430, 45, 400, 340), (-7.5, 7.5), (-6.4, 6.4))
    hw, hh = 4.5, 3.6
    lamp.polygon([(-hw, -hh), (hw, -hh), (hw, hh), (-hw, hh)], LIGHT, INK, 1.2, opacity=0.75)
    f = 0.8
    moved = [((f * (a[0] - p[0]), f * (a[1] - p[1])), (f * (b[0] - p[0]), f * (b[1] - p[1]))) for a, b in edges]
    for a, b in moved:
        lamp.line(a, b, RED, 2)
    pick = min(moved, key=lambda e: abs(e[0][0] + 1.6) + abs(e[0][1] - 1.5))
    far = 40

    def boundary(q):
        t = min(hw / abs(q[0]) if q[0] else far, hh / abs(q[1]) if q[1] else far)
        return (q[0] * t, q[1] * t)

    a, b = pick
    lamp.polygon([a, boundary(a), boundary(b), b], BLUE, opacity=0.5)
    lamp.line((0, 0), boundary(a), BLUE, 1, "4 3")
    lamp.line((0, 0), boundary(b), BLUE, 1, "4 3")
    lamp.dot((0, 0), 4)
    turn = sum(atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]) for a, b in moved) / (2 * pi)
    assert abs(turn - round(turn)) < 1e-9, turn
    d.text((430, 400), f"light; the edges turn {round(abs(turn))} time{'s' if round(abs(turn)) != 1 else ''} around its centre", 12.5)
    d.text((20, 400), f"map: {len(held)} texels shade, their outline has {len(edges)} edges", 12.5)
    d.legend((560, 26), [("line", RED, "outline"), ], 12.5)
    d.legend((660, 26), [("box", BLUE, "beyond one edge")], 12.5)
    d.text((20, 420), "hidden = inside − Σ turn · (light beyond the edge)", 12.5)
    return d.finish()


def packet_figure():
    size = 32
    held = {(i, j) for i in range(size) for j in range(size) if hypot(i - 15.3, j - 16.4) < 10.2}
    kernels = [(5 + dx, 6 + dy, 21, 21) for dx in range(3) for dy in range(3)]
    left, bottom = min(k[0] for k in kernels), min(k[1] for k in kernels)
    cells = max(k[0] + k[2] for k in kernels) - left
    level = (cells - 1).bit_length()
    visited, leaves = [], []

    def walk(x, y, side):
        square = [(i, j) in held for i in range(x, min(x + side + 1, size)) for j in range(y, min(y + side + 1, size))]
        cut = any(square) and not all(square)
        visited.append((x, y, side, "cut" if cut else "full" if any(square) else "empty"))
        if cut and side == 1:
            leaves.append((x, y))
        elif cut:
            for dx in (0, side // 2):
                for dy in (0, side // 2):
                    if x + dx < left + cells and y + dy < bottom + cells:
                        walk(x + dx, y + dy, side // 2)

    walk(left, bottom, 2 ** level)
    d = Drawing(860, 430, "Nine pixels share a kernel, and a pyramid skips nodes that are fully lit or fully in shadow",
                "A map with a round caster. Nine kernels lie within one; below the node over it, empty and full nodes are not opened, and the outline is found "
                "in the cells that remain.")
    d.text((20, 26), "3 × 3 pixels search once, and only where the outline can be", 14, bold=True)
    view = View(d, (20, 45, 360, 340), (3.5, 29.5), (4.5, 30.5))
    for i, j in held:
        view.polygon([(i - 0.5, j - 0.5), (i + 0.5, j - 0.5), (i + 0.5, j + 0.5), (i - 0.5, j + 0.5)], "#c3cad3")
    for x, y, w, h in kernels:
        view.polygon([(x, y), (x + w, y), (x + w, y + h), (x, y + h)], None, BLUE, 1)
    view.polygon([(left, bottom), (left + cells, bottom), (left + cells, bottom + cells), (left, bottom + cells)], None, RED, 2.2)
    second = View(d, (440, 45, 360, 340), (3.5, 29.5), (4.5, 30.5))
    for x, y, side, kind in visited:
        colour = {"cut": None, "full": "#8d99a6", "empty": "#f6e3b4"}[kind]
        x1, y1 = min(x + side, left + cells), min(y + side, bottom + cells)
        second.polygon([(x, y), (x1, y), (x1, y1), (x, y1)], colour, INK, 0.6)
    for x, y in leaves:
        second.polygon([(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)], RED, INK, 0.6)
    d.text((20, 400), f"kernels of nine pixels, and their common kernel: {cells} × {cells} cells", 12.5)
    d.text((440, 400), f"{len(visited)} nodes and {len(leaves)} cells of {cells * cells}", 12.5)
    d.legend((440, 424), [("box", "#8d99a6", "all in shadow")])
    d.legend((560, 424), [("box", "#f6e3b4", "all lit")])
    d.legend((650, 424), [("box", RED, "holds the outline")])
    d.legend((20, 424), [("line", BLUE, "one pixel's kernel")])
    d.legend((180, 424), [("line", RED, "the packet's")])
    return d.finish()


FIGURES = {"backproject": backproject_figure, "backproject-peel": peel_figure, "bitmask": bitmask_figure, "soft-shadow-map": soft_shadow_map_figure,
           "contour": contour_figure, "packet": packet_figure}
