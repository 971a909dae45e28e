# SPDX-License-Identifier: Apache-2.0
"""The geometry that the figures compute: vectors, projection onto a light, signed multiplicities, areas in the plane."""


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def mul(s, a):
    return tuple(s * x for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def mix(a, b, t):
    return add(a, mul(t, sub(b, a)))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def det2(a, b):
    return a[0] * b[1] - a[1] * b[0]


def det3(a, b, c):
    return dot(cross(a, b), c)


class Light:
    """A rectangle c + s u + t v, |s|, |t| ≤ 1, that emits towards u × v."""

    def __init__(self, c, u, v):
        self.c, self.u, self.v = c, u, v
        self.n = cross(u, v)

    def point(self, st):
        return add(self.c, add(mul(st[0], self.u), mul(st[1], self.v)))

    def project(self, p, x):
        """Returns (s, t) of the point where the line from p through x meets the light's plane."""
        d = sub(x, p)
        q = sub(add(p, mul(dot(sub(self.c, p), self.n) / dot(d, self.n), d)), self.c)
        return (det3(q, self.v, self.n) / dot(self.n, self.n), det3(self.u, q, self.n) / dot(self.n, self.n))


def row_shift(row):
    """The same as row_shift_of in visibility/sample_patterns.cpp."""
    return ((row * 40503 + 32768) % 65536 - 32768) / 65536


def rows_pattern(rows, columns, shifted=True):
    """Returns light samples row by row, (s, t) in [−1, 1]²."""
    return [[(2 * (k + 0.5 + (row_shift(r) if shifted else 0)) / columns - 1, 2 * (r + 0.5) / rows - 1)
             for k in range(columns)] for r in range(rows)]


def multiplicities(triangles, p):
    """Returns {(a, b): k} with a < b: the sum over an edge's triangles of +1 where the triangle, wound counter-clockwise as seen
    from p, runs from a to b, and −1 where it runs from b to a. Triangles are triples of points."""
    k = {}
    for a, b, c in triangles:
        # A triangle is counter-clockwise as seen from p if its normal (b − a) × (c − a) points to p.
        side = dot(cross(sub(b, a), sub(c, a)), sub(p, a))
        if side == 0:
            continue
        loop = (a, b, c) if side > 0 else (a, c, b)
        for i in range(3):
            x, y = loop[i], loop[(i + 1) % 3]
            edge, sign = ((x, y), 1) if x < y else ((y, x), -1)
            k[edge] = k.get(edge, 0) + sign
    return k


def area(polygon):
    """Returns the signed area, positive if the polygon is counter-clockwise."""
    return sum(det2(polygon[i - 1], polygon[i]) for i in range(len(polygon))) / 2


def clip(polygon, n, d):
    """Returns the part of a convex polygon where n · x ≤ d (Sutherland and Hodgman)."""
    out = []
    for i, b in enumerate(polygon):
        a = polygon[i - 1]
        fa, fb = dot(n, a) - d, dot(n, b) - d
        if (fa < 0 < fb) or (fb < 0 < fa):
            out.append(mix(a, b, fa / (fa - fb)))
        if fb <= 0:
            out.append(b)
    return out


def clip_to(polygon, convex):
    """Returns the part of a convex polygon inside another one, which is counter-clockwise."""
    for i in range(len(convex)):
        a, b = convex[i - 1], convex[i]
        n = (b[1] - a[1], a[0] - b[0])
        polygon = clip(polygon, n, dot(n, a))
        if not polygon:
            return []
    return polygon


def inside(point, convex):
    """Returns whether the point is strictly inside a counter-clockwise convex polygon."""
    return all(det2(sub(convex[i], convex[i - 1]), sub(point, convex[i - 1])) > 0 for i in range(len(convex)))


def counter_clockwise(polygon):
    return polygon if area(polygon) > 0 else polygon[::-1]


def hull(points):
    """Returns the convex hull, counter-clockwise (Andrew's monotone chain)."""
    points = sorted(set(points))
    halves = []
    for order in (points, points[::-1]):
        chain = []
        for q in order:
            while len(chain) > 1 and det2(sub(chain[-1], chain[-2]), sub(q, chain[-2])) <= 0:
                chain.pop()
            chain.append(q)
        halves.append(chain[:-1])
    return halves[0] + halves[1]


def meet(a, b, c, d):
    """Returns the point where the lines a b and c d meet."""
    return mix(a, b, det2(sub(c, a), sub(d, c)) / det2(sub(b, a), sub(d, c)))


def crosses(a, b, c, d):
    """Returns whether the open segments a b and c d cross."""
    def side(x, y, z):
        return det2(sub(y, x), sub(z, x))
    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0


SQUARE = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
