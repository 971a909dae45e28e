# SPDX-License-Identifier: Apache-2.0
"""Figures of docs/pcf.md, vssm.md, convolution.md, occlusion-textures.md, adaptive-light.md, deep-penumbra.md, layered-attenuation.md."""

from math import floor

from drawing import BLUE, DARK, FAINT, GREEN, INK, LIGHT, PALE, RED, Drawing, View
from geometry import crosses
from texels import FLOOR, heights, truth


def graph_of(d, box, xs, curves, label, left=-3.0, right=3.0):
    """Draws V over x on the floor. `curves`: [(colour, values of V at `xs`)]."""
    graph = View(d, box, (left, right), (0, 1.08), stretch=True)
    for v in (0, 1):
        graph.line((left, v), (right, v), PALE, 1)
        graph.text((left, v), v, 12, (-4, 4), anchor="end")
    for colour, values in curves:
        graph.path(list(zip(xs, values)), colour, 2)
    d.text((box[0], box[1] + box[3] + 16), label, 12)
    return graph


def pcf_figure():
    """Draws the course notes' figure 4.2: 42 of 49 texels are nearer than the receiver."""
    d = Drawing(860, 330, "Percentage-closer filtering: a window of texels, each of them nearer or not",
                "A map of depths around the receiver's texel; in a window of seven by seven 42 texels are nearer than the receiver and 7 are not: V = 7/49.")
    depth = {(i, j): 2.0 + 0.02 * i if i + 0.05 * j < 9.05 else 5.0 for i in range(13) for j in range(11)}
    d.text((20, 26), "One window for every receiver; V is the share of its texels that are not nearer", 14, bold=True)
    view = View(d, (20, 45, 380, 260), (-0.5, 13.5), (-0.5, 11.5))
    window = [(i, j) for i in range(3, 10) for j in range(2, 9)]
    blocked = [cell for cell in window if depth[cell] < 4.8]
    for (i, j), z in depth.items():
        view.polygon([(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)], "#8d99a6" if z < 4.8 else "#f6e3b4", "#ffffff", 0.8)
        if (i, j) in window:
            view.text((i + 0.5, j + 0.5), f"{z:.1f}", 10, (0, 4), anchor="middle")
    view.polygon([(3, 2), (10, 2), (10, 9), (3, 9)], None, RED, 2.5)
    view.dot((6.5, 5.5), 3.5, INK)
    x = 440
    d.text((x, 90), "receiver at depth 4.8", 13)
    d.text((x, 120), f"{len(blocked)} texels of the window nearer, {len(window) - len(blocked)} not", 13)
    visible = (len(window) - len(blocked)) / len(window)
    d.text((x, 150), f"*V* = {len(window) - len(blocked)}/{len(window)} = {visible:.2f}", 15, bold=True)
    assert len(blocked) == 42
    d.legend((x, 185), [("box", "#8d99a6", "depth below 4.8"), ("box", "#f6e3b4", "beyond"), ("line", RED, "window, the same for all receivers")])
    d.text((x, 260), "How far the occluder is, or how large the light,", 12.5)
    d.text((x, 277), "makes no difference.", 12.5)
    return d.finish()


def vssm_figure():
    d = Drawing(860, 380, "Chebyshev's bound of the share of texels beyond a depth, from mean and variance of a window",
                "Two windows of depths. With two depths Chebyshev's bound is the share itself at the deeper one; with three the bound lets light through where "
                "every texel is nearer.")
    d.text((20, 26), "A window's depths, the share that is not nearer than *t*, and Chebyshev's bound of it", 14, bold=True)
    cases = [("two depths: right at the receiver", [(0.3, 0.6), (1.0, 0.4)], 1.0), ("two occluders: a leak behind both", [(0.2, 0.3), (0.6, 0.7)], 0.9)]
    for k, (title, window, receiver) in enumerate(cases):
        mean = sum(t * w for t, w in window)
        variance = sum(t * t * w for t, w in window) - mean * mean

        def bound(t):
            return 1.0 if t <= mean else variance / (variance + (t - mean) ** 2)

        def share(t):
            return sum(w for depth, w in window if depth >= t)

        x0 = 40 + 420 * k
        d.text((x0, 60), title, 13, bold=True)
        view = View(d, (x0, 80, 360, 210), (0, 1.15), (0, 1.05), stretch=True)
        view.line((0, 0), (1.15, 0), FAINT, 1)
        view.line((0, 0), (0, 1.05), FAINT, 1)
        ts = [1.12 * i / 300 for i in range(301)]
        for depth, weight in window:
            view.polygon([(depth - 0.012, 0), (depth + 0.012, 0), (depth + 0.012, weight), (depth - 0.012, weight)], PALE)
            view.text((depth, weight / 2), f"{weight:.1f} of the window", 11, (-6, 0) if depth > 0.5 else (8, 0), anchor="end" if depth > 0.5 else "start", halo=True)
        view.path([(t, share(t)) for t in ts], INK, 2)
        view.path([(t, bound(t)) for t in ts], BLUE, 2)
        view.line((receiver, 0), (receiver, 1), RED, 1.3, "5 4")
        view.text((receiver, 1), "receiver", 12, (-6, 10), anchor="end", fill=RED, halo=True)
        view.dot((receiver, bound(receiver)), 4.5, BLUE)
        d.text((x0, 316), f"share {share(receiver):.2f}, bound {bound(receiver):.2f}", 13, GREEN if abs(bound(receiver) - share(receiver)) < 1e-9 else RED, bold=True)
    d.legend((40, 348), [("line", INK, "share of texels with depth ≥ *t*")])
    d.legend((300, 348), [("line", BLUE, "the bound, from mean and variance alone")])
    d.text((600, 352), "*t*: depth, to the right", 12.5)
    return d.finish()


def convolution_figure():
    half, plane = 0.7, 2.5
    flat = [((-1.1, plane), (-0.35, plane)), ((0.15, plane), (0.6, plane))]
    d = Drawing(860, 470, "A flat blocker's picture, and the light's image that is moved over it",
                "Blockers hide the share of the light by which they cover its image in their plane: exactly, for a plane parallel to the light.")
    d.text((20, 26), "For blockers in one plane, V is a mean over the light's image in that plane", 14, bold=True)
    view = View(d, (20, 45, 540, 250), (-3.0, 3.0), (-5.3, 0.3), stretch=True)
    view.line((-3, -FLOOR), (3, -FLOOR), DARK, 2)
    view.line((-3, -plane), (3, -plane), PALE, 1.5, "5 4")
    for (x0, z), (x1, _) in flat:
        view.line((x0, -z), (x1, -z), DARK, 6)
    p = 0.9
    a, b = (-half + (p + half) * plane / FLOOR, half + (p - half) * plane / FLOOR)
    view.polygon([(p, -FLOOR), (-half, 0), (half, 0)], GREEN, opacity=0.14)
    view.line((a, -plane), (b, -plane), GREEN, 6, opacity=0.6)
    view.line((-half, 0), (half, 0), LIGHT, 7)
    view.dot((p, -FLOOR), 5)
    view.text((p, -FLOOR), "*p*", 14, (8, 18), bold=True)

    def filtered(x):
        first, last = -half + (x + half) * plane / FLOOR, half + (x - half) * plane / FLOOR
        return 1 - sum(max(0.0, min(last, x1) - max(first, x0)) for (x0, _), (x1, _) in flat) / (last - first)

    xs = [-3 + 6 * i / 240 for i in range(241)]
    means, real = [filtered(x) for x in xs], [truth(flat, (x, FLOOR), half, 400) for x in xs]
    assert max(abs(u - v) for u, v in zip(means, real)) < 0.01
    graph_of(d, (20, 320, 540, 100), xs, [(INK, real), (GREEN, means)], "*V* along the floor")
    d.legend((585, 90), [("line", DARK, "blockers, in one plane"), ("box", "#b9d7ba", "the light as p sees it"), ("line", GREEN, "its image in the plane: the window")])
    d.text((585, 175), f"covered there: {1 - filtered(p):.2f}, *V* = {filtered(p):.2f}", 13, bold=True)
    d.legend((585, 360), [("line", GREEN, "mean over the window"), ("line", INK, "true *V*: the same")])
    return d.finish()


def occlusion_textures_figure():
    half, slices, top = 0.7, 4, 1.5
    casters = [((-0.9, 1.7), (-0.1, 2.1)), ((0.1, 3.3), (0.9, 2.7))]
    bottoms = [top + (3.5 - top) * (k + 1) / slices for k in range(slices)]
    d = Drawing(860, 500, "Occlusion textures: casters sorted into slices, one picture each, joined by a product",
                "Casters between four planes are drawn on the plane below them, seen from the light's centre. Each receiver takes a mean of every picture over "
                "the light's image and multiplies them.")
    d.text((20, 26), "Each slice is drawn on the plane below it; V is the product of the slices' means", 14, bold=True)
    view = View(d, (20, 45, 540, 260), (-3.0, 3.0), (-5.3, 0.3), stretch=True)
    view.line((-3, -FLOOR), (3, -FLOOR), DARK, 2)
    pictures, last = [], top
    for bottom in bottoms:
        held = []
        for i in range(800):
            m = -0.6 + 1.2 * (i + 0.5) / 800
            if any(last <= z < bottom for z in heights(casters, m)):
                held.append(m)
        view.line((-3, -bottom), (3, -bottom), PALE, 1.5)
        for m in held:
            view.line((m * bottom - 0.004, -bottom), (m * bottom + 0.004, -bottom), RED, 4)
        pictures.append((bottom, held))
        last = bottom
    for (x0, z0), (x1, z1) in casters:
        view.line((x0, -z0), (x1, -z1), DARK, 5)
    p = 0.35
    for bottom, _ in pictures:
        view.line((-half + (p + half) * bottom / FLOOR, -bottom), (half + (p - half) * bottom / FLOOR, -bottom), GREEN, 2.2)
    view.polygon([(p, -FLOOR), (-half, 0), (half, 0)], GREEN, opacity=0.12)
    view.line((-half, 0), (half, 0), LIGHT, 7)
    view.dot((p, -FLOOR), 5)
    view.text((p, -FLOOR), "*p*", 14, (8, 18), bold=True)

    def product(x):
        v, parts = 1.0, []
        for bottom, held in pictures:
            first, end = (-half + (x + half) * bottom / FLOOR) / bottom, (half + (x - half) * bottom / FLOOR) / bottom
            mean = sum(first <= m <= end for m in held) * (1.2 / 800) / (end - first)
            parts.append(1 - min(mean, 1))
            v *= parts[-1]
        return v, parts

    xs = [-3 + 6 * i / 120 for i in range(121)]
    graph_of(d, (20, 330, 540, 110), xs, [(INK, [truth(casters, (x, FLOOR), half, 300) for x in xs]), (RED, [product(x)[0] for x in xs])], "*V* along the floor")
    v, parts = product(p)
    x = 585
    d.legend((x, 80), [("line", DARK, "casters"), ("line", RED, "their pictures, slice by slice"), ("line", GREEN, "the light's image in each")])
    for k, part in enumerate(parts):
        d.text((x, 160 + 18 * k), f"slice {k + 1}: mean {part:.2f}", 12.5)
    d.text((x, 240), f"product {v:.2f}; true *V* = {truth(casters, (p, FLOOR), half):.2f}", 13, bold=True)
    d.legend((x, 370), [("line", RED, "product"), ("line", INK, "true *V*")])
    d.text((20, 484), "The hidden light is the union of what two slices of a surface hide; the product treats them as independent.", 12.5)
    return d.finish()


def adaptive_light_figure():
    depth_most = 3

    def shades(s, t):
        """Returns whether an edge hides the point (s, t) of the unit light."""
        return 0.9 * s + 0.35 * t > 0.62

    leaves, points = [], {}

    def split(x, y, side, depth):
        corners = [(x, y), (x + side, y), (x, y + side), (x + side, y + side)]
        if depth < depth_most and len({shades(*c) for c in corners}) > 1:
            for dx in (0, side / 2):
                for dy in (0, side / 2):
                    split(x + dx, y + dy, side / 2, depth + 1)
        else:
            leaves.append((x, y, side))
            for c in corners:
                points[c] = max(points.get(c, 0), depth)

    split(0.0, 0.0, 1.0, 0)
    weights = {c: 1 / (2 ** depth + 1) ** 2 for c, depth in points.items()}
    total = sum(weights.values())
    hidden = sum(w for c, w in weights.items() if shades(*c)) / total
    equal = sum(shades(*c) for c in weights) / len(weights)
    count = 400
    real = sum(shades((i + 0.5) / count, (j + 0.5) / count) for i in range(count) for j in range(count)) / count ** 2
    d = Drawing(860, 400, "Light points where two maps differ: cells of the light, halved",
                "A square light with a quadtree refined along an edge that hides a part of it; points at cells' corners have areas in proportion to their weights.")
    d.text((20, 26), "Cells are halved where the maps of their corners differ", 14, bold=True)
    view = View(d, (20, 50, 330, 320), (-0.05, 1.05), (-0.05, 1.05))
    for x, y, side in leaves:
        view.polygon([(x, y), (x + side, y), (x + side, y + side), (x, y + side)], "#fdf3d7", FAINT, 1)
    view.line((0.62 / 0.9, 0), ((0.62 - 0.35) / 0.9, 1), INK, 2)
    for c, w in weights.items():
        view.dot(c, 26 * (w / total) ** 0.5, DARK if shades(*c) else LIGHT, stroke=INK, width=0.8)
    x = 400
    d.legend((x, 80), [("dot", DARK, "light point from which p is hidden"), ("dot", LIGHT, "light point that p sees; areas are weights"), ("line", INK, "edge that hides a part of the light")])
    d.text((x, 165), f"{len(points)} maps of {(2 ** depth_most + 1) ** 2}", 14, bold=True)
    d.text((x, 195), f"hidden share, weighted 1/(2^d + 1)²: {hidden:.3f}".replace("^d", "ᵈ"), 12.5)
    d.text((x, 215), f"all points alike: {equal:.3f}", 12.5)
    d.text((x, 235), f"true: {real:.3f}", 12.5)
    d.text((x, 275), "For p alone; the method counts the pixels in which two", 12.5)
    d.text((x, 292), "maps hold different depths, and adds maps until these", 12.5)
    d.text((x, 309), "are few.", 12.5)
    return d.finish()


def deep_penumbra_figure():
    half, count, direction = 1.0, 12, 0.1
    casters = [((-0.6, 1.4), (0.25, 1.4)), ((0.3, 2.7), (0.9, 2.9))]
    samples = [half * (2 * (i + 0.5) / count - 1) for i in range(count)]
    steps = 900

    def visible(z):
        return [not any(crosses((s, 0), (direction * z, z), *c) for c in casters) for s in samples]

    d = Drawing(860, 430, "A texel of a penumbra deep shadow map: V along one ray from the light's centre",
                "Left the ray of one texel and twelve light samples; right V over depth, a step down where a sample is hidden and up where it comes out again, and "
                "fewer steps within a bound.")
    d.text((20, 26), "V as a function of depth along a texel's ray", 14, bold=True)
    view = View(d, (20, 50, 380, 330), (-1.6, 1.6), (-5.2, 0.3), stretch=True)
    for (x0, z0), (x1, z1) in casters:
        view.line((x0, -z0), (x1, -z1), DARK, 5)
    view.line((0, 0), (direction * FLOOR, -FLOOR), RED, 2)
    z = 3.6
    for s, lit in zip(samples, visible(z)):
        view.line((s, 0), (direction * z, -z), GREEN if lit else FAINT, 1)
        view.dot((s, 0), 3.5, LIGHT if lit else DARK, stroke=INK, width=0.8)
    view.dot((direction * z, -z), 4.5, INK)
    graph = View(d, (460, 60, 340, 290), (0, 1.05), (-5.2, 0.3), stretch=True)
    graph.line((0, 0), (0, -FLOOR), FAINT, 1)
    graph.line((0, 0), (1.05, 0), FAINT, 1)
    graph.text((1, 0), "*V* = 1", 12, (0, -6), anchor="middle")
    held = [(sum(visible(FLOOR * (i + 0.5) / steps)) / count, FLOOR * (i + 0.5) / steps) for i in range(steps)]
    events = sum(a[0] != b[0] for a, b in zip(held, held[1:]))
    graph.path([(v, -z) for v, z in held], INK, 2)
    # Greedy: each step is as long as possible; the values that it replaces differ by at most twice the bound.
    bound, kept, start = 0.1, [], 0
    for i in range(1, steps + 1):
        values = [v for v, _ in held[start:i + 1]]
        if i == steps or max(values) - min(values) > 2 * bound + 1e-9:
            values = [v for v, _ in held[start:i]]
            kept.append(((min(values) + max(values)) / 2, start, i))
            start = i
    path = []
    for v, a, b in kept:
        path += [(v, -FLOOR * a / steps), (v, -FLOOR * b / steps)]
    graph.path(path, BLUE, 1.8)
    graph.line((0, -3.6), (1.05, -3.6), RED, 1, "4 3")
    worst = max(abs(v - held[i][0]) for v, a, b in kept for i in range(a, b))
    assert worst <= bound + 1e-9
    d.legend((460, 375), [("line", INK, f"{events} events of {count} samples")])
    d.legend((460, 397), [("line", BLUE, f"{len(kept)} steps within {bound:g}, off by {worst:.2f} at most")])
    d.legend((20, 405), [("line", RED, "the texel's ray")])
    d.legend((150, 405), [("line", GREEN, "visible at the depth marked")])
    return d.finish()


def layered_attenuation_figure():
    half, count, texels, span = 0.9, 6, 15, 0.75
    casters = [((-0.55, 2.2), (0.5, 2.5))]
    scene = casters + [((-4.0, FLOOR), (4.0, FLOOR))]
    samples = [half * (2 * (i + 0.5) / count - 1) for i in range(count)]
    width = 2 * span / texels
    lists = [{} for _ in range(texels)]
    for s in samples:
        seen = set()
        for k in range(1200):
            m = -1.1 + 2.2 * (k + 0.5) / 1200
            found = heights([((a - s, z0), (b - s, z1)) for (a, z0), (b, z1) in scene], m)
            if not found:
                continue
            x, z = s + m * found[0], found[0]
            texel = floor((x / z + span) / width)
            surface = 1 if z > 4 else 0
            if 0 <= texel < texels and (texel, surface) not in seen:
                seen.add((texel, surface))
                lists[texel].setdefault(surface, [0, z])[0] += 1
    d = Drawing(860, 420, "A layered attenuation map: surfaces that light samples see, warped to the centre and counted",
                "Texels of the centre's map with an entry for each surface; each entry says how many of six light samples see it.")
    d.text((20, 26), "Each entry of a texel counts the light samples that see its surface", 14, bold=True)
    view = View(d, (20, 50, 580, 330), (-4.0, 4.0), (-5.5, 0.4), stretch=True)
    for i in range(texels + 1):
        m = -span + i * width
        view.line((0, 0), (m * FLOOR, -FLOOR), PALE, 0.8)
    for (x0, z0), (x1, z1) in scene:
        view.line((x0, -z0), (x1, -z1), DARK, 3)
    for i, entries in enumerate(lists):
        m = -span + (i + 0.5) * width
        for surface, (seen_by, z) in entries.items():
            z = FLOOR if surface else heights(casters, m)[0] if heights(casters, m) else z
            view.dot((m * z, -z), 8.5, "#ffffff", stroke=BLUE if surface == 0 else GREEN, width=2)
            view.text((m * z, -z), seen_by, 12, (0, 4), anchor="middle")
    view.line((-half, 0), (half, 0), LIGHT, 6)
    for s in samples:
        view.dot((s, 0), 3)
    x = 625
    d.legend((x, 90), [("ring", BLUE, "entry on the caster"), ("ring", GREEN, "entry on the floor"), ("dot", INK, "light samples")])
    d.text((x, 170), f"*V* = count / {count}", 13, bold=True)
    d.text((x, 200), "Texels without an entry on the", 12.5)
    d.text((x, 217), "floor: no sample sees it, *V* = 0.", 12.5)
    return d.finish()


FIGURES = {"pcf": pcf_figure, "vssm": vssm_figure, "convolution": convolution_figure, "occlusion-textures": occlusion_textures_figure,
           "adaptive-light": adaptive_light_figure, "deep-penumbra": deep_penumbra_figure, "layered-attenuation": layered_attenuation_figure}
