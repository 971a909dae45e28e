# SPDX-License-Identifier: Apache-2.0
"""Figure of docs/exact.md: the part of a trapezoid inside a disk."""

from math import atan2, cos, hypot, pi, sin, sqrt

from drawing import BLUE, FAINT, GREEN, INK, LIGHT, PALE, Drawing, View, arc


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def turn(a, b):
    """Returns the angle from a to b as seen from the centre."""
    return atan2(cross(a, b), a[0] * b[0] + a[1] * b[1])


def part_of_edge(a, b):
    """Returns (angle before, chord or None, angle after): the part of the edge inside the disk (its chord), and the angles of the
    parts before and after it, which are projected onto the rim."""
    length = hypot(b[0] - a[0], b[1] - a[1])
    along = ((b[0] - a[0]) / length, (b[1] - a[1]) / length)
    beside = cross(a, along)
    foot = (beside * along[1], -beside * along[0])
    if abs(beside) >= 1:
        return turn(a, b), None, 0
    half = sqrt(1 - beside * beside)
    at = [q[0] * along[0] + q[1] * along[1] for q in (a, b)]
    first, last = max(at[0], -half), min(at[1], half)
    if first >= last:
        return turn(a, b), None, 0
    place = [(foot[0] + s * along[0], foot[1] + s * along[1]) for s in (first, last)]
    return (turn(a, place[0]) if first > at[0] else 0), place, (turn(place[1], b) if last < at[1] else 0)


def disk_figure():
    corners = [(-0.55, -0.45), (1.25, -0.45), (0.95, 0.55), (-0.2, 0.55)]
    d = Drawing(780, 400, "The part of a trapezoid inside a disk")
    d.text((20, 26), "A visible trapezoid (between two edges and two rows) on a round light", 14, bold=True)
    view = View(d, (20, 44, 420, 340), (-1.1, 1.4), (-1.05, 1.05))
    rim = arc((0, 0), 1, 0, 2 * pi, 96)
    view.polygon(rim, "#fff7df", LIGHT, 2)
    outline, twice = [], 0
    for i, a in enumerate(corners):
        b = corners[(i + 1) % 4]
        before, chord, after = part_of_edge(a, b)
        twice += before + after
        if before:
            outline += arc((0, 0), 1, atan2(a[1], a[0]), atan2(a[1], a[0]) + before)
        if chord:
            twice += cross(*chord)
            outline += chord
        if after:
            outline += arc((0, 0), 1, atan2(chord[1][1], chord[1][0]), atan2(chord[1][1], chord[1][0]) + after)
    view.polygon(outline, LIGHT, opacity=0.55)
    view.polygon(corners, None, FAINT, 1.5, "5 4")
    for i, a in enumerate(corners):
        b = corners[(i + 1) % 4]
        before, chord, after = part_of_edge(a, b)
        if chord:
            view.line(chord[0], chord[1], GREEN, 2.6)
        for start, swept in ((a, before), (chord[1] if chord else b, after)):
            if swept:
                from_angle = atan2(start[1], start[0])
                view.path(arc((0, 0), 1, from_angle, from_angle + swept), BLUE, 3)
                for at in (from_angle, from_angle + swept):
                    view.line((0, 0), (cos(at), sin(at)), PALE, 1)
    for q in corners:
        view.dot(q, 3, INK)
    view.dot((0, 0), 3, INK)
    area = twice / 2

    def inside(x, y):
        return x * x + y * y < 1 and all(cross((corners[(i + 1) % 4][0] - a[0], corners[(i + 1) % 4][1] - a[1]),
                                               (x - a[0], y - a[1])) > 0 for i, a in enumerate(corners))
    steps = 700
    count = sum(inside(-1 + (2 * i + 1) / steps, -1 + (2 * j + 1) / steps) for i in range(steps) for j in range(steps))
    assert abs(count * 4 / steps ** 2 - area) < 2e-3, "chords and angles are the part's boundary"
    x = 470
    d.legend((x, 96), [("line", GREEN, "inside: the edge itself, ½ *a* × *b*"),
                       ("line", BLUE, "outside: the angle that it subtends, ½ *φ*"),
                       ("box", "#f7d98a", "the part in the disk")])
    d.text((x, 176), "Each edge is computed separately: only the", 12.5)
    d.text((x, 193), "length inside the disk matters. Where chord and", 12.5)
    d.text((x, 210), "arc meet, both sweep the same area: an error *δ*", 12.5)
    d.text((x, 227), "of this place changes the area by *δ*².", 12.5)
    d.text((x, 268), f"area = {area:.6f}, of the disk {area / pi:.6f}", 13, bold=True)
    return d.finish()


FIGURES = {"exact-disk": disk_figure}
