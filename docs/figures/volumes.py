# SPDX-License-Identifier: Apache-2.0
"""Figures of docs/hard-volume.md, soft-volume.md, soft-volume-blend.md, wedge-ramp.md, plateaus.md, signed-crossings.md."""

from math import hypot

from drawing import BLUE, DARK, FAINT, GREEN, INK, LIGHT, PALE, RED, Drawing, View
from geometry import (SQUARE, add, area, clip, clip_to, counter_clockwise, crosses, det2, dot, inside, meet, mix, mul,
                      multiplicities, sub)
from scatter import LAMP, P, seen_at, signed, solid


def hard_volume_figure():
    """Draws hard volumes in a plane: a caster is a segment, its volume has the segment and two rays as faces."""
    lamp, eye, bottom = (3.2, 5.6), (-0.9, 1.35), -4.6
    casters = [((2.2, 3.3), (3.5, 3.4)), ((3.15, 1.9), (4.3, 2.1))]
    receivers = [(0.4, 0.35), (3.35, 0.35), (6.2, 0.35)]
    d = Drawing(800, 500, "Counting shadow volumes beyond the view sample")
    d.text((20, 26), "Faces of volumes that the pixel's ray meets beyond *p*", 14, bold=True)
    view = View(d, (10, 36, 570, 455), (-1.4, 9.2), (bottom, 5.9))

    def in_volume(x, caster):
        return crosses(lamp, x, *caster)

    def away(x, length=20):
        return add(x, mul(length / hypot(*sub(x, lamp)), sub(x, lamp)))

    for a, b in casters:
        shape = clip([a, b, away(b), away(a)], (0, -1), -bottom)
        view.polygon(shape, DARK, opacity=0.17)
        for x in (a, b):
            view.line(x, meet(x, away(x), (0, bottom), (1, bottom)), FAINT, 1.2)
        view.line(a, b, INK, 4)
    view.line((-1.3, 0.35), (9.1, 0.35), DARK, 2)
    view.dot(lamp, 6, LIGHT, stroke=INK)
    view.text(lamp, "centre of the light", 12.5, (10, 4))
    view.dot(eye, 5, "#ffffff", stroke=INK)
    view.text(eye, "camera", 12.5, (0, -12), anchor="middle")
    rows = []
    for i, p in enumerate(receivers):
        direction = sub(p, eye)
        end = add(p, mul(1000, direction))
        events = []
        for a, b in casters:
            for u, v in ((a, b), (a, away(a, 5000)), (b, away(b, 5000))):
                if crosses(p, end, u, v):
                    events.append((meet(p, end, u, v), (a, b)))
        events.sort(key=lambda e: hypot(*sub(e[0], p)))
        stop = meet(p, end, (0, bottom), (1, bottom))
        if stop[0] > 9:
            stop = meet(p, end, (9, 0), (9, 1))
        view.line(eye, p, FAINT, 1.2)
        view.arrow(p, stop, GREEN, 1.5, 8)
        terms = []
        for at, caster in events:
            before = in_volume(sub(at, mul(1e-6, direction)), caster)
            terms.append(1 if before else -1)
            if at[1] > bottom:
                view.dot(at, 3.2, "#ffffff", stroke=INK)
                view.text(at, signed(terms[-1]), 13, (10, 3), fill=RED if before else BLUE, bold=True, halo=True)
        ends_in = sum(in_volume(end, caster) for caster in casters)
        count = sum(terms) + ends_in
        assert count == sum(in_volume(p, caster) for caster in casters)
        view.dot(p, 5, LIGHT if count == 0 else INK, stroke=INK)
        view.text(p, f"*p*_{i + 1}", 14, (-8, -10), anchor="end", bold=True, halo=True)
        rows.append((i + 1, terms, ends_in, count))
    x = 590
    d.text((x, 74), "+1 the ray leaves a volume", 12.5, RED)
    d.text((x, 93), "−1 it enters one", 12.5, BLUE)
    d.text((x, 112), "and one for each volume in", 12.5)
    d.text((x, 129), "which it ends (at infinity)", 12.5)
    for i, terms, ends_in, count in rows:
        y = 122 + 48 * i
        text = " ".join(signed(t) for t in terms) or "no face"
        d.text((x, y), f"*p*_{i}: {text}, ends in {ends_in}", 13)
        d.text((x, y + 18), f"count = {count}: *V* = {int(count == 0)}", 13, bold=True)
    d.text((x, 330), "The count is the number of", 12.5)
    d.text((x, 347), "triangles between *p* and", 12.5)
    d.text((x, 364), "the light's centre.", 12.5)
    return d.finish()


def beyond(c, q0, q1):
    """Returns the region of light points l for which the segment c→l crosses the edge q0 q1."""
    if det2(sub(q0, c), sub(q1, c)) < 0:
        q0, q1 = q1, q0
    region = SQUARE
    for a, b in ((c, q0), (q1, c), (q0, q1)):      # right of c→q1, left of c→q0, beyond the edge
        n = (b[1] - a[1], a[0] - b[0])              # n · x ≤ n · a: on the left of a→b
        if (a, b) == (q0, q1):
            n = mul(-1, n)                          # c is on the left of q0→q1; beyond is on the right
        region = clip(region, n, dot(n, a))
        if not region:
            return []
    return region


def soft_volume_figure():
    c = (0.0, 0.0)
    occluder = [(0.18, -0.55), (0.78, -0.32), (0.62, 0.52), (0.08, 0.3)]
    edges = [(occluder[i], occluder[(i + 1) % 4]) for i in range(4)]
    d = Drawing(860, 440, "Each silhouette edge takes the area beyond it from the light, or gives it back")
    hidden = area(clip_to(occluder, SQUARE)) / 4
    total = 0
    for panel, title in enumerate(("One edge: the area beyond it, seen from *C*", "All edges of a board")):
        x0 = 20 + 420 * panel
        d.text((x0, 26), title, 14, bold=True)
        view = View(d, (x0, 40, 330, 330), (-1.05, 1.05), (-1.05, 1.05))
        view.polygon(SQUARE, "#fff7df", LIGHT, 2)
        if panel:
            view.polygon(occluder, DARK, opacity=0.35)
        for i, (a, b) in enumerate(edges[:1] if panel == 0 else edges):
            i = 3 if panel == 0 else i
            a, b = edges[i]
            region = beyond(c, a, b)
            share = abs(area(region)) / 4
            # Seen from c, an edge that runs clockwise is crossed from outside the board: it takes light away.
            takes = det2(sub(a, c), sub(b, c)) < 0
            view.polygon(region, RED if takes else BLUE, opacity=0.22)
            view.line(a, b, RED if takes else BLUE, 3)
            middle = mix(a, b, 0.5)
            if panel == 0:
                for q in (a, b):
                    far = next(x for x in (meet(c, q, SQUARE[k - 1], SQUARE[k]) for k in range(4))
                               if max(map(abs, x)) < 1 + 1e-9 and dot(sub(x, c), sub(q, c)) > 0)
                    view.line(c, far, FAINT, 1.3, "4 3")
                view.text(a, "*q*_1", 14, (-8, -8), anchor="end")
                view.text(b, "*q*_0", 14, (-8, 14), anchor="end")
                center = mul(1 / len(region), tuple(map(sum, zip(*region))))
                view.text(center, "*F*", 16, bold=True, fill=RED, anchor="middle")
                d.text((x0, 395), f"*F* = sector of the light between the rays *C*→*q*_0 and *C*→*q*_1,", 12.5)
                d.text((x0, 413), f"less the triangle *C* *q*_0 *q*_1: {share:.4f} of the light", 12.5)
            else:
                total += share if takes else -share
                away = mul(0.16 / hypot(*middle), middle)
                view.text(add(middle, mul(2, away) if takes else away), ("+" if takes else "−") + f"{share:.4f}", 12,
                          (0, 4), anchor="middle", fill=RED if takes else BLUE, bold=True, halo=True)
        view.dot(c, 4.5)
        view.text(c, "*C*", 14, (-8, 14), anchor="end", bold=True)
    assert abs(total - hidden) < 1e-12
    d.text((440, 395), f"0 + sum = {total:.4f}, the board's area: *V* = {1 - total:.4f}", 12.5, bold=True)
    d.text((440, 413), "red edges take light away, blue ones give it back", 12.5)
    return d.finish()


def blend_figure():
    one = counter_clockwise([(-0.75, -0.62), (0.5, -0.85), (0.62, 0.2), (-0.55, 0.42)])
    two = counter_clockwise([(-0.28, -0.2), (0.9, 0.02), (0.66, 0.85), (-0.42, 0.7)])
    quarters = [[(x0, y0), (x0 + 1, y0), (x0 + 1, y0 + 1), (x0, y0 + 1)] for y0 in (-1, 0) for x0 in (-1, 0)]

    def box(shape):
        xs, ys = [x for x, _ in shape], [y for _, y in shape]
        return min(xs), min(ys), max(xs), max(ys)

    def box_area(b):
        return max(0, b[2] - b[0]) * max(0, b[3] - b[1])

    d = Drawing(800, 430, "Boxes around the parts that two occluders hide in each quarter of the light")
    d.text((20, 26), "The light's quarters as seen from *p*, and boxes around what is hidden", 14, bold=True)
    view = View(d, (20, 42, 370, 370), (-1.05, 1.05), (-1.05, 1.05))
    view.polygon(SQUARE, "#fff7df", LIGHT, 2)
    view.polygon(one, BLUE, opacity=0.3)
    view.polygon(two, RED, opacity=0.3)
    view.line((-1, 0), (1, 0), FAINT, 1.2)
    view.line((0, -1), (0, 1), FAINT, 1.2)
    blended, union, added, lines = 0, 0, 0, []
    for i, quarter in enumerate(quarters):
        share, bounds, parts = 0, None, []
        for shape, colour in ((one, BLUE), (two, RED)):
            part = clip_to(shape, quarter)
            parts.append(part)
            if not part:
                continue
            a, b = area(part), box(part)
            inset = 0.012 if colour == RED else 0
            view.polygon([(b[0] + inset, b[1] + inset), (b[2] - inset, b[1] + inset), (b[2] - inset, b[3] - inset),
                          (b[0] + inset, b[3] - inset)], None, colour, 1.5, "5 3")
            if bounds is None:
                share, bounds = a, b
            else:
                common = (max(b[0], bounds[0]), max(b[1], bounds[1]), min(b[2], bounds[2]), min(b[3], bounds[3]))
                overlap = box_area(common) if common[0] < common[2] and common[1] < common[3] else 0
                next_share = share + a * (1 - overlap / box_area(b) * share / box_area(bounds))
                share = min(1, max(next_share, share, a))
                bounds = (min(b[0], bounds[0]), min(b[1], bounds[1]), max(b[2], bounds[2]), max(b[3], bounds[3]))
        both = area(clip_to(parts[0], parts[1])) if parts[0] and parts[1] and clip_to(parts[0], parts[1]) else 0
        true = sum(area(x) for x in parts if x) - both
        blended, union, added = blended + share / 4, union + true / 4, added + sum(area(x) for x in parts if x) / 4
        lines.append((quarter, share, true))
    for quarter, share, true in lines:
        view.text(quarter[0], f"{share:.3f} ({true:.3f})", 12, (8, -8), halo=True, bold=True)
    x = 415
    d.legend((x, 74), [("box", "#a9c8e4", "first occluder"), ("box", "#eab6ae", "second occluder"),
                       ("dash", BLUE, "its box in a quarter"), ("dash", RED, "its box in a quarter")])
    d.text((x, 172), "In each quarter: share by blending (true share)", 12.5)
    d.text((x, 204), "share ← share + *a* (1 − |*B* ∩ *B*_0| / |*B*| · share / |*B*_0|)", 12.5)
    rows = [("*V* by blending", 1 - blended, GREEN), ("*V* by the sum (soft-volume)", 1 - added, RED),
            ("*V* of the union (true)", 1 - union, INK)]
    for i, (name, value, colour) in enumerate(rows):
        d.text((x, 250 + 24 * i), name, 13.5, colour, bold=True)
        d.text((x + 270, 250 + 24 * i), f"{value:.3f}", 13.5, colour, "end", True)
    return d.finish()


def ramp_figure():
    lamp, edge = ((-1.0, 5.0), (1.0, 5.0)), (1.9, 2.4)
    centre = mix(*lamp, 0.5)
    # Both planes touch the light: in front of the front plane all of it is visible, behind the back plane nothing.
    at = {name: meet(q, edge, (0, 0), (1, 0))[0] for name, q in
          (("front", lamp[0]), ("back", lamp[1]), ("hard", centre))}
    at["front"], at["back"] = max(at["front"], at["back"]), min(at["front"], at["back"])
    ends = {"front": (at["front"], 0.0), "back": (at["back"], 0.0), "hard": (at["hard"], 0.0)}

    def distance(x, name):
        a = sub(ends[name], edge)
        return abs(det2(a, sub(x, edge))) / hypot(*a)

    def ramp(x):
        front, back = distance((x, 0), "front"), distance((x, 0), "back")
        return back / (front + back) if at["back"] < x < at["front"] else float(x >= at["front"])

    def visible(x):
        """Returns the visible share of the light beyond a board that reaches from far left to the edge, by counting."""
        n, seen = 4000, 0
        for i in range(n):
            l = mix(*lamp, (i + 0.5) / n)
            crossing = x + (l[0] - x) * edge[1] / 5
            seen += crossing > edge[0]
        return seen / n

    d = Drawing(800, 480, "A penumbra wedge from the side, and the ramp across it, compared with the true visibility")
    d.text((20, 26), "A wedge from the side, and *V* along the floor", 14, bold=True)
    view = View(d, (20, 36, 540, 290), (-1.6, 5.2), (-0.25, 5.4), stretch=True)
    view.polygon([edge, ends["front"], ends["back"]], GREEN, opacity=0.15)
    view.line((-1.5, 0), (5.1, 0), DARK, 2)
    view.line((-1.5, edge[1]), edge, INK, 4)
    view.text((-1.4, edge[1]), "occluder", 12.5, (0, -8))
    view.text(edge, "*e*", 14, (8, -4))
    view.line(*lamp, stroke=LIGHT, width=6)
    view.text(lamp[1], "light", 12.5, (10, 4))
    view.line(lamp[0], ends["front"], BLUE, 1.5)
    view.line(lamp[1], ends["back"], RED, 1.5)
    view.line(centre, ends["hard"], FAINT, 1.5, "5 3")
    view.dot(centre, 3.5)
    view.text(centre, "*c*", 13, (-4, 18), anchor="end")
    view.text((at["front"], 0), "front", 12.5, (0, 16), anchor="middle", fill=BLUE)
    view.text((at["back"], 0), "back", 12.5, (0, 16), anchor="middle", fill=RED)
    view.text((at["hard"], 0), "hard", 12.5, (0, 16), anchor="middle", fill=DARK)
    graph = View(d, (20, 350, 540, 110), (-1.6, 5.2), (-0.1, 1.1), stretch=True)
    for v in (0, 1):
        graph.line((-1.6, v), (5.2, v), PALE, 1)
        graph.text((-1.6, v), v, 12, (-4, 4), anchor="end")
    xs = [-1.5 + 6.6 * i / 240 for i in range(241)]
    worst = max(abs(ramp(x) - visible(x)) for x in xs)
    graph.path([(x, visible(x)) for x in xs], INK, 2)
    graph.path([(x, ramp(x)) for x in xs], GREEN, 2.5, dash="6 3")
    graph.path([(-1.5, 0), (at["hard"], 0), (at["hard"], 1), (5.1, 1)], FAINT, 1.5, dash="3 3")
    x = 585
    d.text((x, 90), "*h*_front, *h*_back: distances", 12.5)
    d.text((x, 107), "of *p* to the two planes.", 12.5)
    d.text((x, 139), "In the wedge *V* falls from 1", 12.5)
    d.text((x, 156), "at front to 0 at back:", 12.5)
    d.text((x, 178), "*h*_back / (*h*_front + *h*_back)", 13, bold=True)
    d.legend((x, 380), [("dash", GREEN, "*V* by the ramp"), ("line", INK, "true *V*"),
                        ("dash", FAINT, "hard shadow of *c*")])
    d.text((x, 446), f"off by up to {worst:.3f} here", 12.5)
    return d.finish()


def plateaus_figure():
    lamp, edge = ((-1.0, 5.0), (1.0, 5.0)), (1.9, 2.4)
    centre, height = mix(*lamp, 0.5), lamp[0][1]
    hard = meet(centre, edge, (0, 0), (1, 0))[0]
    reach = 1.0 * edge[1] / (height - edge[1])

    def plateau(x):
        depth = min(max(1 - (x - hard) / reach, 0), 1) if x > hard else 1
        return 1 - depth * depth * (3 - 2 * depth)

    def visible(x):
        """Returns the visible share of the light beyond a board that reaches from far left to the edge, in closed form."""
        at = x + (edge[0] - x) * height / (height - (height - edge[1]))  # where the ray from x through the edge meets the light
        return min(max((lamp[1][0] - at) / 2, 0), 1)

    d = Drawing(800, 480, "The outer penumbra of a plateau from the side, compared with the true visibility")
    d.text((20, 26), "An edge from the side, and *V* along the floor", 14, bold=True)
    view = View(d, (20, 36, 540, 290), (-1.6, 7.2), (-0.25, 5.4), stretch=True)
    view.polygon([edge, (hard, 0), (hard + reach, 0)], GREEN, opacity=0.15)
    view.line((-1.5, 0), (7.1, 0), DARK, 2)
    view.line((-1.5, edge[1]), edge, INK, 4)
    view.text((-1.4, edge[1]), "occluder", 12.5, (0, -8))
    view.line(*lamp, stroke=LIGHT, width=6)
    view.text(lamp[1], "light", 12.5, (10, 4))
    view.line(centre, (hard, 0), FAINT, 1.5, "5 3")
    view.line(lamp[0], (hard + reach, 0), BLUE, 1.5)
    view.dot(centre, 3.5)
    view.text(centre, "*c*", 13, (-4, 18), anchor="end")
    view.text((hard, 0), "hard", 12.5, (0, 16), anchor="middle", fill=DARK)
    view.text((hard + reach, 0), "*b*", 12.5, (0, 16), anchor="middle", fill=BLUE)
    graph = View(d, (20, 350, 540, 110), (-1.6, 7.2), (-0.1, 1.1), stretch=True)
    for v in (0, 1):
        graph.line((-1.6, v), (7.2, v), PALE, 1)
        graph.text((-1.6, v), v, 12, (-4, 4), anchor="end")
    xs = [-1.5 + 8.6 * i / 240 for i in range(241)]
    worst = max(abs(plateau(x) - visible(x)) for x in xs)
    assert abs(plateau(hard)) < 1e-9 and abs(visible(hard) - 0.5) < 1e-9
    assert all(plateau(x) <= visible(x) + 1e-9 for x in xs if x < hard + 0.8 * reach)  # too bright in the last fifth
    graph.path([(x, visible(x)) for x in xs], INK, 2)
    graph.path([(x, plateau(x)) for x in xs], GREEN, 2.5, dash="6 3")
    x = 585
    d.text((x, 90), "*b* = *R* · height of the edge /", 12.5)
    d.text((x, 107), "its distance below the light", 12.5)
    d.text((x, 139), "From the hard shadow *V* rises", 12.5)
    d.text((x, 156), "to 1 at the rim of the plateau.", 12.5)
    d.legend((x, 380), [("dash", GREEN, "*V* by plateaus"), ("line", INK, "true *V*")])
    d.text((x, 446), f"off by up to {worst:.3f} here", 12.5)
    return d.finish()


def crossings_figure():
    top, left, right, back = (seen_at(-0.1, 0.72, .62), seen_at(-0.72, -0.5, .6), seen_at(0.42, -0.66, .5),
                              seen_at(-0.2, -0.12, .4))
    triangles = solid([left, right, top, back])
    triangles.append((right, top, seen_at(0.93, 0.3, .55)))                                        # a fin on an edge
    triangles.append((seen_at(-0.5, 0.02, .75), seen_at(0.78, -0.2, .75), seen_at(0.62, 0.62, .75)))  # a loose one
    l = (-0.28, 0.12)
    d = Drawing(760, 440, "Signed multiplicities of edges, and their crossings with a ray from l")
    d.text((20, 26), "Edges as seen from *p*, each with its *k*", 14, bold=True)
    view = View(d, (20, 40, 430, 390), (-0.95, 1.1), (-0.82, 0.95))
    for triangle in triangles:
        view.polygon([LAMP.project(P, x) for x in triangle], DARK, opacity=0.12)
    total, terms = 0, []
    for (a, b), k in multiplicities(triangles, P).items():
        q, r = LAMP.project(P, a), LAMP.project(P, b)
        if k < 0:
            q, r, k = r, q, -k
        if k == 0:
            view.line(q, r, FAINT, 1.3, "3 3")
            view.text(mix(q, r, 0.42), "0", 12, (0, 4), anchor="middle", fill=FAINT, halo=True)
            continue
        view.line(q, r, INK, 1 + k * 0.9)
        middle, along = mix(q, r, 0.62), mul(0.025 / hypot(*sub(r, q)), sub(r, q))
        view.arrow(sub(middle, along), add(middle, along), INK, 1, 11)
        view.text(mix(q, r, 0.28), k, 14, (0, 5), anchor="middle", bold=True, fill=GREEN, halo=True)
        if (q[1] - l[1]) * (r[1] - l[1]) < 0:
            s = q[0] + (l[1] - q[1]) / (r[1] - q[1]) * (r[0] - q[0])
            if s > l[0]:
                terms.append((s, k if r[1] > q[1] else -k))
    view.arrow(l, (1.08, l[1]), BLUE, 2, 9)
    for s, term in sorted(terms):
        view.dot((s, l[1]), 3.5, "#ffffff", stroke=INK)
        view.text((s, l[1]), signed(term), 13.5, (3, 17), fill=RED if term > 0 else BLUE, bold=True, halo=True)
        total += term
    view.dot(l, 5, LIGHT, stroke=INK)
    view.text(l, "*l*", 15, (-9, 6), anchor="end", bold=True, halo=True)
    view.text((1.08, l[1]), "*H*", 14, (-4, -8), anchor="end", fill=BLUE)
    met = sum(inside(l, counter_clockwise([LAMP.project(P, x) for x in t])) for t in triangles)
    assert total == met
    x = 480
    d.text((x, 80), "Each triangle is wound counter-clockwise", 12.5)
    d.text((x, 97), "as seen from *p* and adds ±1 to its edges.", 12.5)
    d.text((x, 131), "Where the ray *H* from *l* is crossed upward,", 12.5)
    d.text((x, 148), "+*k* counts, where downward, −*k*:", 12.5)
    d.text((x, 176), " ".join(signed(t) for _, t in sorted(terms)) + f" = {total}", 15, bold=True)
    d.text((x, 204), f"{met} triangles stand between *p* and *l*.", 12.5)
    d.text((x, 246), "A tetrahedron (*k* = 2 around it, 0 at its", 12.5)
    d.text((x, 263), "front edges), a fin on one of its edges", 12.5)
    d.text((x, 280), "and a loose triangle.", 12.5)
    return d.finish()


FIGURES = {"hard-volume": hard_volume_figure, "soft-volume": soft_volume_figure, "soft-volume-blend": blend_figure,
           "wedge-ramp": ramp_figure, "plateaus": plateaus_figure, "signed-crossings": crossings_figure}
