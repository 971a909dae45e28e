# SPDX-License-Identifier: Apache-2.0
"""Compares backprojection methods with twins in numpy (the module penumbra must be found).

Each twin is written from its paper and shares with the program only the width of a map's window: depths are those of
parallelograms along the directions of texels' centres, computed, not drawn. A square light of half-size HALF is at
height 5; the floor at height 0 is the only receiver and does not cast. Tangents (a, b) = (x, z) / depth, depth = 5 - y.

Tolerance: a border on the light is ((tangent - a) f) with f = z_s z / (z - z_s), at most 20 here. Tangents and depths
are float32, off by 2^-24 of 1 and of the scene's 8, and a few roundings follow: f is off by 2^-21 of itself, a border
by 1e-5 of a light 1 wide. Up to 50 texels' borders form an outline that counts: 5e-4 at worst, 1e-5 on average. A
constant that is wrong by 2 % moves V by 1e-2 somewhere. Texels whose centre is within 1/128 texel of an outline may be
drawn either way (the rasteriser snaps corners to 1/256): pixels whose kernels contain one are left out.
"""

import struct
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

import numpy as np

import penumbra

HALF, HEIGHT, FLOOR = 0.5, 5.0, 2.0
FAR = 1e9


def parallelogram(center, u, v):
    return np.array([center, u, v], float)


def box(center, half):
    faces, axes = [], np.diag(half)
    for k in range(3):
        for sign in (-1, 1):
            faces.append(parallelogram(np.add(center, sign * axes[k]), axes[(k + 1) % 3], axes[(k + 2) % 3]))
    return faces


CASTERS = {
    "plate": [parallelogram((0.113, 2.1, 0.052), (0.83, 0, 0), (0, 0, 0.71))],
    "two plates": [parallelogram((0.051, 3.2, 0.023), (0.33, 0, 0), (0, 0, 0.37)),
                   parallelogram((-0.072, 1.3, 0.041), (0.97, 0, 0), (0, 0, 0.89))],
    "tilted plate": [parallelogram((0.031, 2.2, 0.067), (0.81, 0.43, 0.06), (-0.04, 0.11, 0.77))],
    "box": box((0.071, 1.9, -0.043), (0.51, 0.62, 0.43)),
}


def scene_of(casters):
    def mesh(name, quad, **more):
        c, u, v = quad
        return {"name": name, "vertices": [c - u - v, c + u - v, c + u + v, c - u + v], "faces": [[0, 1, 2], [0, 2, 3]], **more}
    floor = mesh("floor", parallelogram((0, 0, 0), (FLOOR, 0, 0), (0, 0, -FLOOR)), castsShadow=False)
    return {"camera": {"eye": [0, 2.6, 5.5], "target": [0, 0, 0]},
            "meshes": [floor] + [mesh(f"caster{k}", quad, receivesShadow=False) for k, quad in enumerate(casters)],
            "lights": [{"name": "key", "rectangle": {"center": [0, HEIGHT, 0], "halfU": [HALF, 0, 0], "halfV": [0, 0, HALF]}}]}


def local(points):
    """Converts from world space to (x, z, depth)."""
    points = np.asarray(points, float)
    return np.stack([points[..., 0], points[..., 2], HEIGHT - points[..., 1]], -1)


def corners_of(quads):
    return np.array([[c - u - v, c + u - v, c + u + v, c - u + v] for c, u, v in quads])


class Map:
    """Depths along the directions of texels' centres as seen from a point of the light, in layers beginning with the
    nearest."""

    def __init__(self, casters, size, lower, upper, point=(0.0, 0.0)):
        self.size, self.lower, self.texel = size, lower, (upper - lower) / size
        at = [lower[k] + (np.arange(size) + 0.5) * self.texel[k] for k in range(2)]
        a, b = np.meshgrid(at[0], at[1], indexing="xy")  # rows are b
        depths, self.unsure = [], np.zeros((size, size), bool)
        for c, u, v in casters:
            origin = local(c) - np.append(point, 0)
            du, dv = (np.array([w[0], w[2], -w[1]]) for w in (u, v))
            # s du + t dv - depth (a, b, 1) = -origin
            matrix = np.empty((size, size, 3, 3))
            matrix[..., 0], matrix[..., 1] = du, dv
            matrix[..., 2] = -np.stack([a, b, np.ones_like(a)], -1)
            singular = np.abs(np.linalg.det(matrix)) < 1e-12
            matrix[singular] = np.eye(3)
            s, t, depth = np.moveaxis(np.linalg.solve(matrix, np.broadcast_to(-origin[:, None], matrix.shape[:-1] + (1,)))[..., 0], -1, 0)
            hit = (np.abs(s) <= 1) & (np.abs(t) <= 1) & (depth > 0) & ~singular
            depths.append(np.where(hit, depth, FAR))
            corner = local(np.array([c - u - v, c + u - v, c + u + v, c - u + v])) - np.append(point, 0)
            seen = corner[:, :2] / corner[:, 2:]
            for k in range(4):
                p, q = (seen[k] - lower) / self.texel, (seen[(k + 1) % 4] - lower) / self.texel
                along = (q - p) / max(np.linalg.norm(q - p), 1e-30)
                x, y = np.meshgrid(np.arange(size) + 0.5 - p[0], np.arange(size) + 0.5 - p[1], indexing="xy")
                on = (x * along[0] + y * along[1] > -1) & (x * along[0] + y * along[1] < np.linalg.norm(q - p) + 1)
                self.unsure |= on & (np.abs(x * along[1] - y * along[0]) < 1 / 128)
        self.layers = np.sort(np.array(depths), 0)
        self.a, self.b = a, b

    def layer(self, k):
        return self.layers[k] if k < len(self.layers) else np.full((self.size,) * 2, FAR)

    def farthest(self):
        return np.max(np.where(self.layers < FAR, self.layers, 0), 0)

    def borders(self, k):
        return self.lower[k] + np.arange(self.size + 1) * self.texel[k]


def spared(lower, upper, size):
    texel = (upper - lower) / (size - 2)
    return lower - texel, upper + texel


def whole_light_window(casters, size):
    """Returns the window that holds all receivers, and the casters between any receiver and any point of the light."""
    seen, depth = tangents(corners_of(casters)), local(corners_of(casters))[..., 2]
    reach = HALF * (1 / depth.min() - 1 / HEIGHT)
    edge = FLOOR / HEIGHT
    lower, upper = np.full(2, -edge), np.full(2, edge)
    lower, upper = np.minimum(lower, np.maximum(seen[0], lower - reach)), np.maximum(upper, np.minimum(seen[1], upper + reach))
    return spared(lower, upper, size)


def tangents(corners, point=(0.0, 0.0)):
    at = local(corners).reshape(-1, 3) - np.append(point, 0)
    seen = at[:, :2] / at[:, 2:]
    return seen.min(0), seen.max(0)


def map_of(casters, size):
    """Returns the map of the light's centre; of ten sizes from this one on, the one that leaves fewest texels to the
    rasteriser."""
    return min((Map(casters, n, *whole_light_window(casters, n)) for n in range(size, size + 10)), key=lambda m: m.unsure.sum())


def is_sure(m, p):
    """Returns whether no texel that can hide light from p, nor a neighbour of one, is left to the rasteriser."""
    reach = HALF * (1 / m.layer(0).min() - 1 / p[2]) + 2 * max(m.texel)
    near = (np.abs(m.a - p[0] / p[2]) < reach) & (np.abs(m.b - p[1] / p[2]) < reach)
    return not (m.unsure & near).any()


def overlap(low, high):
    return np.maximum(np.minimum(high, HALF) - np.maximum(low, -HALF), 0)


def scale(depth, z):
    """Returns f(z_s, z): the factor from a border's tangent at this depth to its distance on the light, as seen from
    z."""
    hides = depth < z
    return np.where(hides, depth * z / np.where(hides, z - depth, 1), 0)


def hides(m, depth, z, bias=0.5):
    return depth < z - bias * max(m.texel) * z


def backproject(m, p, fill):
    """Guennebaud, Barthe and Paulin 2006, with one layer."""
    (a, b), z = p[:2] / p[2], p[2]
    depth = m.layer(0)
    counts, f = hides(m, depth, z), scale(depth, z)
    x0, x1 = (m.borders(0)[:-1] - a) * f, (m.borders(0)[1:] - a) * f
    y0, y1 = ((m.borders(1)[:-1] - b)[:, None] * f, (m.borders(1)[1:] - b)[:, None] * f)
    if fill == "edges":
        left, below = np.zeros_like(f), np.zeros_like(f)
        left[:, 1:], below[1:] = f[:, :-1], f[:-1]
        by_left, by_below = np.zeros_like(counts), np.zeros_like(counts)
        by_left[:, 1:], by_below[1:] = counts[:, :-1], counts[:-1]
        x0 = np.where(by_left, np.minimum(x0, (m.borders(0)[:-1] - a) * left), x0)
        y0 = np.where(by_below, np.minimum(y0, (m.borders(1)[:-1] - b)[:, None] * below), y0)
    area = overlap(x0, x1) * overlap(y0, y1) / (4 * HALF * HALF)
    return 1 - min(area[counts].sum(), 1)


def peel(m, p, layers, select):
    """Bavoil, Callahan and Silva 2006: the deepest of a texel's surfaces counts for which p is behind the middle between
    it and the next one."""
    (a, b), z = p[:2] / p[2], p[2]
    hidden, settled = np.zeros((m.size, m.size)), np.zeros((m.size, m.size), bool)
    for k in reversed(range(layers)):
        depth, behind = m.layer(k), m.layer(k + 1)
        begins = np.where(behind < FAR, (depth + behind) / 2, depth + 0.5 * max(m.texel) * z)
        counts = (begins < z) & (depth < z) & (depth < FAR) & ~settled
        f = scale(depth, z)
        area = overlap((m.borders(0)[:-1] - a) * f, (m.borders(0)[1:] - a) * f) * \
            overlap((m.borders(1)[:-1] - b)[:, None] * f, (m.borders(1)[1:] - b)[:, None] * f) / (4 * HALF * HALF)
        if select == "contribution":
            counts &= area > 0
        hidden[counts] = area[counts]
        settled |= counts
    return 1 - min(hidden.sum(), 1)


def clipped(polygon, lower=(-HALF, -HALF), upper=(HALF, HALF)):
    """Clips a polygon to the light's square, or to a texel of it, edge by edge (Sutherland and Hodgman): signed areas
    inside stay the same."""
    for axis in range(2):
        for sign, end in ((-1, -lower[axis]), (1, upper[axis])):
            inside, count = [], len(polygon)
            for k in range(count):
                p, q = polygon[k], polygon[(k + 1) % count]
                over_p, over_q = end - sign * p[axis], end - sign * q[axis]
                if over_p >= 0:
                    inside.append(p)
                if (over_p >= 0) != (over_q >= 0):
                    inside.append(p + (q - p) * (over_p / (over_p - over_q)))
            polygon = inside
            if not polygon:
                return polygon
    return polygon


WINDOW = np.array([[64, 255, 130], [0, 190, 230]])  # 8-bit sRGB, the upper row first


def window_png():
    """Returns the PNG file, made with only the standard library."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes(int(x) for x in row) for row in WINDOW)
    head = struct.pack(">IIBBBBB", WINDOW.shape[1], WINDOW.shape[0], 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def window_texels():
    """Yields each texel's corners on the light and its share of the radiance; a plain light is one texel."""
    c = WINDOW / 255
    linear = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    height, width = linear.shape
    size = 2 * HALF / np.array([width, height])
    for y in range(height):
        for x in range(width):
            low = np.array([-HALF + x * size[0], HALF - (y + 1) * size[1]])
            yield low, low + size, linear[y, x] / linear.sum()


PLAIN = [(np.full(2, -HALF), np.full(2, HALF), 1.0)]


def contour(m, p, texels=PLAIN):
    """Guennebaud, Barthe and Paulin 2007: loops of marching squares around texels that cast, with vertices midway, at
    the depth of the casting texel, projected onto the light. The hidden part is what they wind around, weighed by the
    light's texels."""
    e, z = p, p[2]
    shading = np.zeros((m.size + 2, m.size + 2), bool)
    shading[1:-1, 1:-1] = hides(m, m.layer(0), z)
    depth = np.pad(m.layer(0), 1, constant_values=FAR)
    ends = {}
    corner = [(0, 0), (0, 1), (1, 1), (1, 0)]  # corners of a cell, counter-clockwise
    cells = np.argwhere(shading[:-1, :-1] | shading[1:, :-1] | shading[:-1, 1:] | shading[1:, 1:])
    for row, column in cells:
        at = [(row + dy, column + dx) for dy, dx in corner]
        on = [shading[q] for q in at]
        if all(on):
            continue
        # The edge around each run of casting corners goes from the side after its last corner to the side before its
        # first, which leaves the corners on its left.
        for k in range(4):
            if not on[k] or on[k - 1]:
                continue
            last = k
            while on[(last + 1) % 4]:
                last = (last + 1) % 4
            out, into = (at[last], at[(last + 1) % 4]), (at[k - 1], at[k])
            ends[frozenset(out)] = frozenset(into)

    def vertex(key):
        q, r = tuple(key)
        inner = q if shading[q] else r
        x = m.lower[0] + ((q[1] + r[1]) / 2 - 1 + 0.5) * m.texel[0]
        y = m.lower[1] + ((q[0] + r[0]) / 2 - 1 + 0.5) * m.texel[1]
        f = depth[inner] * z / (z - depth[inner])
        return np.array([(x - e[0] / z) * f, (y - e[1] / z) * f])

    hidden = 0.0
    while ends:
        key = next(iter(ends))
        loop = []
        while key in ends:
            loop.append(vertex(key))
            key = ends.pop(key)
        for low, high, share in texels:
            polygon = clipped(loop, low, high)
            for k in range(len(polygon)):
                (x0, y0), (x1, y1) = polygon[k], polygon[(k + 1) % len(polygon)]
                hidden += (x0 * y1 - x1 * y0) / 2 * share / np.prod(high - low)
    return 1 - np.clip(abs(hidden), 0, 1)


def bitmask(m, p, across):
    """Schwarz and Stamminger 2008: one bit for each light sample, hidden by quads between the centres of four texels
    that all cast."""
    e, z = p, p[2]
    depth = m.layer(0)
    counts, f = hides(m, depth, z), scale(depth, z)
    seen = np.stack([(m.a - e[0] / z) * f, (m.b - e[1] / z) * f], -1)
    all_four = counts[:-1, :-1] & counts[1:, :-1] & counts[:-1, 1:] & counts[1:, 1:]
    s = -HALF + (np.arange(across) + 0.5) * 2 * HALF / across
    samples = np.stack(np.meshgrid(s, s), -1).reshape(-1, 2)
    hidden, unsure = np.zeros(len(samples), bool), False
    for row, column in np.argwhere(all_four):
        q = [seen[row, column], seen[row, column + 1], seen[row + 1, column + 1], seen[row + 1, column]]
        if np.min(q, 0).max() > HALF or np.max(q, 0).min() < -HALF:
            continue
        for triangle in ((q[0], q[1], q[2]), (q[0], q[2], q[3])):
            sides = []
            for k in range(3):
                c, d = triangle[k], triangle[(k + 1) % 3]
                sides.append((d[0] - c[0]) * (samples[:, 1] - c[1]) - (d[1] - c[1]) * (samples[:, 0] - c[0]))
            sides = np.array(sides)
            hidden |= (sides >= 0).all(0) | (sides <= 0).all(0)
            unsure = unsure or (np.abs(sides).min(0) < 1e-6).any()
    return 1 - hidden.mean(), unsure


def soft_shadow_map(casters, size, receiver_size, places, passes):
    """Atty et al. 2006 at the centre of the receiver's texel in a map of the floor."""
    lower, upper = spared(*tangents(corners_of(casters)), size)
    m = Map(casters, size, lower, upper)
    edge = FLOOR / HEIGHT
    first, last = spared(np.full(2, -edge), np.full(2, edge), receiver_size)
    texel = (last - first) / receiver_size
    v = []
    for p in places:
        a, b = first + (np.floor((p[:2] / p[2] - first) / texel) + 0.5) * texel
        least = 1.0
        for depth in [m.layer(0), m.farthest()][:passes]:
            f = scale(depth, HEIGHT)
            area = overlap((m.borders(0)[:-1] - a) * f, (m.borders(0)[1:] - a) * f) * \
                overlap((m.borders(1)[:-1] - b)[:, None] * f, (m.borders(1)[1:] - b)[:, None] * f) / (4 * HALF * HALF)
            least = min(least, 1 - min(area[(depth < FAR) & (depth > 0)].sum(), 1))
        v.append(least)
    return np.array(v), m.unsure.any()


def adaptive_light(casters, size, places, taps):
    """Schwaerzler, with one split everywhere: nine maps of equal weight, each filtered over taps x taps texels."""
    v, unsure = np.zeros(len(places)), np.zeros(len(places), bool)
    beside = 2 * 4 * (taps // 2) / size if taps > 2 else 0.0
    for lx in (-HALF, 0, HALF):
        for ly in (-HALF, 0, HALF):
            lower = np.array([-FLOOR - lx, -FLOOR - ly]) / HEIGHT
            upper = np.array([FLOOR - lx, FLOOR - ly]) / HEIGHT
            if beside:
                seen = tangents(corners_of(casters), (lx, ly))
                lower = np.minimum(lower, np.maximum(seen[0], lower - beside))
                upper = np.maximum(upper, np.minimum(seen[1], upper + beside))
            m = Map(casters, size, *spared(lower, upper, size), (lx, ly))
            lit = ~hides(m, m.layer(0), HEIGHT)
            half = (taps - 1) / 2
            for i, p in enumerate(places):
                at = ((p[:2] - (lx, ly)) / p[2] - m.lower) / m.texel
                weights = [np.maximum(np.minimum(np.arange(size) + 1, at[k] + half) - np.maximum(np.arange(size), at[k] - half), 0)
                           for k in range(2)]
                both = weights[1][:, None] * weights[0][None] / (2 * half) ** 2
                v[i] += (1 - (both * ~lit).sum()) / 9  # outside the map there are no casters
                unsure[i] |= (m.unsure & (both > 0)).any()
    return v, unsure


class Twins(unittest.TestCase):
    SIZE = (20, 20)

    def pictures(self, name, method, textured=False, **options):
        samples = 64 if method == "bitmask" else 0
        with tempfile.TemporaryDirectory() as folder:
            scene = scene_of(CASTERS[name])
            if textured:
                scene["lights"][0]["texture"] = "window.png"
                Path(folder, "window.png").write_bytes(window_png())
            picture = penumbra.render(penumbra.Scene.from_dict(scene, folder), size=self.SIZE, method=method, options=options, light_samples=samples,
                                  sample_pattern="grid" if samples else "")
        floor = (picture.A == 1) & (np.abs(picture.P[..., 1]) < 1e-4)
        return local(picture.P[floor].astype(float)), picture.V[floor].astype(float)

    def sure_pictures(self, name, m, method, **options):
        places, found = self.pictures(name, method, size=m.size, **options)
        sure = np.array([is_sure(m, p) for p in places])
        self.assertGreater(sure.mean(), 0.4, name)
        return places[sure], found[sure]

    def compare(self, what, found, expected, tolerance, partly=20):
        between = ((expected > 0.01) & (expected < 0.99)).sum()
        off = np.abs(found - expected)
        print(f"{what}: {len(found)} places, {between} in penumbra, off by {off.max():.2e}, rms {np.sqrt((off ** 2).mean()):.2e}")
        self.assertGreaterEqual(between, partly, what)
        self.assertLess(off.max(), tolerance, what)

    def test_backproject(self):
        for name, casters in CASTERS.items():
            m = map_of(casters, 61)
            for fill in ("none", "edges"):
                places, found = self.sure_pictures(name, m, "backproject", fill=fill, search="none")
                self.compare(f"backproject {fill}, {name}", found, np.array([backproject(m, p, fill) for p in places]), 1e-4)

    def test_peel(self):
        for name, casters in CASTERS.items():
            m = map_of(casters, 61)
            for select in ("contribution", "deepest"):
                places, found = self.sure_pictures(name, m, "backproject-peel", samples=0, layers=3, select=select)
                self.compare(f"peel {select}, {name}", found, np.array([peel(m, p, 3, select) for p in places]), 1e-4)

    def test_contour(self):
        for name, casters in CASTERS.items():
            m = map_of(casters, 61)
            places, found = self.sure_pictures(name, m, "contour")
            self.compare(f"contour, {name}", found, np.array([contour(m, p) for p in places]), 1e-4)

    def test_contour_of_a_textured_light(self):
        texels = list(window_texels())
        for name, casters in CASTERS.items():
            m = map_of(casters, 61)
            for method in ("contour", "packet"):
                places, found = self.sure_pictures(name, m, method, textured=True)
                expected = np.array([contour(m, p, texels) for p in places])
                self.compare(f"{method}, {name}, textured", found, expected, 2e-4)  # the brightest column over the mean is 1.7
                self.assertGreater(np.abs(expected - [contour(m, p) for p in places]).max(), 0.05)

    def test_bitmask(self):
        for name, casters in CASTERS.items():
            m = map_of(casters, 61)
            places, found = self.sure_pictures(name, m, "bitmask")
            twins = [bitmask(m, p, 8) for p in places]
            sure = np.array([not unsure for _, unsure in twins])
            self.assertGreater(sure.mean(), 0.8)
            self.compare(f"bitmask, {name}", found[sure], np.array([v for v, _ in twins])[sure], 1e-6)

    def test_soft_shadow_map(self):
        for name, casters in CASTERS.items():
            for passes in (1, 2):
                size = min(range(40, 60), key=lambda n: Map(casters, n, *spared(*tangents(corners_of(casters)), n)).unsure.sum())
                places, found = self.pictures(name, "soft-shadow-map", size=size, receiverSize=64, passes=passes, filter="nearest")
                edge = FLOOR / HEIGHT
                first, last = spared(np.full(2, -edge), np.full(2, edge), 64)
                at = (places[:, :2] / places[:, 2:] - first) / (last - first) * 64
                inside = (np.abs(at - np.round(at)) > 1e-3).all(1)  # otherwise rounding may choose either texel
                expected, unsure = soft_shadow_map(casters, size, 64, places[inside], passes)
                if unsure:
                    continue  # every patch counts, wherever it is
                self.compare(f"soft-shadow-map {passes}, {name}", found[inside], expected, 1e-4)

    def test_adaptive_light(self):
        for name, casters in CASTERS.items():
            for taps in (2, 5):
                places, found = self.pictures(name, "adaptive-light", size=61, levels=1, epsilon=0, weights="equal",
                                              pcf={2: "on"}.get(taps, str(taps)))
                expected, unsure = adaptive_light(casters, 61, places, taps)
                self.assertGreater((~unsure).mean(), 0.5)
                self.compare(f"adaptive-light {taps}, {name}", found[~unsure], expected[~unsure], 1e-4)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
