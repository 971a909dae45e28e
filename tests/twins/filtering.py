# SPDX-License-Identifier: Apache-2.0
"""Compares the filtering map methods with numpy versions from their papers, on depths of parallelograms that are
computed and not drawn. The light is a square of half-size LIGHT at height TOP over a level floor; everything is in the
light's frame: x and y across, z the depth below its plane."""

import itertools
import unittest

import numpy as np

import penumbra

TOP, LIGHT, FLOOR, SIZE, PIXELS = 5.0, 0.5, 3.0, 160, 28
BIAS, STEEPEST, LAYERS = 0.5, 8.0, 4  # the program's defaults: maps/README.md, docs/vssm.md


def plate(height, center, half, rise=0.0):
    """Returns a rectangle at this height; it rises by `rise` for each unit of x."""
    return {"center": [center[0], height, center[1]], "halfU": [half[0], rise * half[0], 0], "halfV": [0, 0, half[1]]}


def box(height, center, half, low):
    """Returns the five sides of a box that a light above it can see."""
    (x, z), (a, b), middle, tall = center, half, (height + low) / 2, (height - low) / 2
    sides = [{"center": [x + s * a, middle, z], "halfU": [0, 0, b], "halfV": [0, tall, 0]} for s in (-1, 1)]
    sides += [{"center": [x, middle, z + s * b], "halfU": [a, 0, 0], "halfV": [0, tall, 0]} for s in (-1, 1)]
    return [plate(height, center, half)] + sides


# Texels are 1.2 / 158 wide at depth 1: no outline below passes within 1/256 of a texel's centre.
SCENES = {
    "plate": [plate(2.5, (0.1, 0.05), (0.61, 0.47))],
    "two plates": [plate(3.5, (-0.41, 0.03), (0.35, 0.52)), plate(1.7, (0.33, -0.12), (0.55, 0.44))],
    "tilted plate": [plate(2.2, (0.07, 0.02), (0.72, 0.5), 0.6)],
    "box": box(2.0, (0.13, -0.04), (0.42, 0.37), 0.9),
}


def scene_of(quads):
    floor = {"center": [0, 0, 0], "halfU": [FLOOR, 0, 0], "halfV": [0, 0, -FLOOR]}
    return {"camera": {"eye": [0.4, 5.5, 5.0], "target": [0, 0.4, 0], "verticalFov": 50},
            "meshes": [{"name": f"quad {i}", "quad": quad} for i, quad in enumerate([floor, *quads])],
            "lights": [{"name": "key", "rectangle": {"center": [0, TOP, 0], "halfU": [LIGHT, 0, 0], "halfV": [0, 0, LIGHT]}}]}


def in_frame(point):
    """Converts from world space to the light's frame; the directions of x and y do not matter, since the grid of texels
    is symmetric."""
    p = np.asarray(point, float)
    return np.stack([p[..., 0], p[..., 2], TOP - p[..., 1]], axis=-1)


class Map:
    """The depth map from the light's centre; its window is the floor's directions and one more texel on every side."""

    def __init__(self, quads):
        self.texel = 2 * FLOOR / TOP / (SIZE - 2)
        self.lower = -FLOOR / TOP - self.texel
        at = self.lower + (np.arange(SIZE) + 0.5) * self.texel
        self.rays = np.stack([*np.meshgrid(at, at), np.ones((SIZE, SIZE))], axis=-1)  # [y, x]
        depth = np.where(np.abs(self.rays[..., :2]).max(axis=-1) * TOP <= FLOOR, TOP, np.inf)
        for quad in quads:
            depth = np.minimum(depth, self.depth_of(quad))
        self.depth, self.nearest = depth, depth.min()
        self.low, self.high = self.nearest * (1 - 1 / 1024), TOP
        self.t = np.where(np.isfinite(depth), self.normalised(np.where(np.isfinite(depth), depth, TOP)), 1.0)

    def depth_of(self, quad):
        """Returns the depth at each texel's centre; infinite outside the quad."""
        center, rays = in_frame(quad["center"]), self.rays
        u, v = (in_frame(np.add(quad["center"], quad[k])) - center for k in ("halfU", "halfV"))
        # center + a u + b v = z ray
        solved = np.linalg.solve(np.stack(np.broadcast_arrays(rays, -u, -v), axis=-1), np.broadcast_to(center, rays.shape)[..., None])
        z, a, b = np.moveaxis(solved[..., 0], -1, 0)
        return np.where((np.abs(a) <= 1) & (np.abs(b) <= 1) & (z > 0), z, np.inf)

    def normalised(self, z):
        return np.clip((z - self.low) / (self.high - self.low), 0, 1)

    def place(self, d):
        return (d[:2] / d[2] - self.lower) / self.texel


class Receiver:
    def __init__(self, position, normal):
        self.d = in_frame(position)
        n = np.asarray(normal, float)
        self.m = -np.array([n[0], n[2], -n[1]])  # away from the light
        self.h = self.m @ self.d
        facing = self.h / self.d[2]
        across = np.abs(self.m[:2]).sum()
        self.slope = min(across / facing, STEEPEST) if facing > 0 else STEEPEST

    def plane(self, direction, limit):
        facing = self.m @ direction
        return self.h / facing if self.h < limit * facing else limit


def blocks(map_, receiver, at, limit, bias):
    """Williams 1978, with the receiver's plane taken at the direction of the texel's centre (maps/README.md)."""
    direction = np.append(map_.lower + (np.asarray(at) + 0.5) * map_.texel, 1.0)
    facing = receiver.m @ direction
    across = np.abs(receiver.m[:2]).sum()
    slope = across / facing if across < STEEPEST * facing else STEEPEST
    depth = map_.depth[int(at[1]), int(at[0])] if (np.asarray(at) >= 0).all() and (np.asarray(at) < SIZE).all() else np.inf
    return depth < receiver.plane(direction, limit) - bias * map_.texel * receiver.d[2] * (1 + slope)


def pcf(map_, receiver, window):
    if receiver.h <= 0:
        return 0.0
    own = np.floor(map_.place(receiver.d))
    first = np.floor(map_.place(receiver.d) - window / 2 + 0.5)
    lit = 0
    for j, i in itertools.product(range(window), repeat=2):
        at = first + (i, j)
        away = max(np.abs(at - own).max(), 1.0)
        lit += not blocks(map_, receiver, at, receiver.d[2] * (1 + STEEPEST * map_.texel * away), BIAS)
    return lit / window**2


def forward(map_, receiver, degree):
    """Zhang 1998: every texel splats a B-spline onto the surface that it shows; here at one receiver, for all texels of
    the map at once."""
    if receiver.h <= 0:
        return 0.0
    spline = [lambda a: (a < 0.5) * 1.0, lambda a: np.maximum(1 - a, 0),
              lambda a: np.where(a <= 0.5, 0.75 - a * a, np.where(a < 1.5, 0.5 * (1.5 - a) ** 2, 0.0))][degree]
    place, facing = map_.place(receiver.d), map_.rays @ receiver.m
    if degree > 0:  # places are counted in 64ths of a texel
        place = np.floor(place) + 0.5 + np.round((place - np.floor(place) - 0.5) * 64) / 64
    weight = [spline(np.abs(place[k] - np.arange(SIZE) - 0.5)) for k in (0, 1)]
    across = np.abs(receiver.m[:2]).sum()
    slope = np.where(across < STEEPEST * facing, across / np.where(facing > 0, facing, 1), STEEPEST)
    limit = receiver.d[2] * (1 + 3 * STEEPEST * map_.texel)
    plane = np.where(receiver.h < limit * facing, receiver.h / np.where(facing > 0, facing, 1), limit)
    lands = np.abs(map_.depth - plane) <= BIAS * map_.texel * receiver.d[2] * (1 + slope)
    return float((np.outer(weight[1], weight[0]) * lands).sum())


class Filter:
    """The windows of pcss, filtered by means: Yang et al. 2010, Lauritzen and McCool 2008, Annen et al. 2007 and
    2008."""

    def __init__(self, map_, moments, cuts=0, terms=16, exponent=80.0, window=0):
        self.map, self.moments, self.cuts, self.terms, self.window = map_, moments, cuts, terms, window
        self.c = exponent / 2 if moments == "evsm" else exponent

    def mean(self, lower, upper, f):
        """Returns the mean of f(t) over a window, in which a texel at the border counts by its share; outside the map t
        is 1."""
        x0, y0 = np.maximum(np.floor(lower), 0).astype(int)
        x1, y1 = np.minimum(np.ceil(upper), SIZE).astype(int)
        if x1 <= x0 or y1 <= y0:
            return f(np.float64(1))
        shares = [np.minimum(np.arange(a, b) + 1.0, upper[k]) - np.maximum(np.arange(a, b), lower[k]) for k, (a, b) in enumerate([(x0, x1), (y0, y1)])]
        whole = np.prod(upper - lower)
        inside = np.outer(shares[1], shares[0])
        return ((inside * f(self.map.t[y0:y1, x0:x1])).sum() + (whole - inside.sum()) * f(np.float64(1))) / whole

    def bound(self, mean, square, x, least):
        variance = max(square - mean * mean, least)
        return 1.0 if x <= mean else variance / (variance + (x - mean) ** 2)

    def lit(self, lower, upper, t):
        mean = lambda f: self.mean(lower, upper, f)
        if self.moments == "vsm":
            share = self.bound(mean(lambda q: q), mean(lambda q: q * q), t, 2.0**-22)
        elif self.moments == "lvsm":  # Lauritzen and McCool 2008: only the layer that contains t
            layer = min(int(t * LAYERS), LAYERS - 1)
            warp = lambda q: np.clip(LAYERS * q - layer, 0, 1)
            share = self.bound(mean(warp), mean(lambda q: warp(q) ** 2), t * LAYERS - layer, 2.0**-22 * LAYERS**2)
        elif self.moments == "evsm":
            least = max(2.0**-22, self.slack**2) * self.c**2
            warps = [(lambda q, s=s: s * np.exp(s * self.c * (q - t))) for s in (1, -1)]
            share = min(self.bound(mean(f), mean(lambda q: f(q) ** 2), s, least) for f, s in zip(warps, (1, -1)))
        elif self.moments == "esm":
            f = lambda q: np.exp(self.c * (q - t))
            share = mean(f)
            if share > 1 + 1 / 1024:
                share = self.texel_by_texel(lower, upper, lambda q: np.minimum(f(q), 1))
            share = min(share, 1.0)
        else:
            span, share, blocked = max(1 - 1 / self.terms, 0.5), 0.5, 0.5 * mean(lambda q: q)
            for k in range(1, self.terms + 1):
                c = (2 * k - 1) * np.pi
                weight = 2 / c * np.exp(-((k / self.terms) ** 2))
                wave = lambda q: np.sin(c * (span * (q - t) + 0.5 / self.terms))
                share += weight * mean(wave)
                blocked -= weight * mean(lambda q: q * wave(q))
            return share, blocked if share < 1 else 0.0
        return share, mean(lambda q: q) - share * t

    def texel_by_texel(self, lower, upper, f, most=16):
        lower, upper = np.clip(lower, 0, SIZE), np.clip(upper, 0, SIZE)
        first, extent = np.floor(lower), np.ceil(upper) - np.floor(lower)
        count = np.minimum(extent, most).astype(int)
        at = [(first[k] + (np.arange(count[k]) + 0.5) * extent[k] / count[k]).astype(int) for k in (0, 1)]
        return f(self.map.t[np.ix_(at[1], at[0])]).mean()

    def plane(self, place):
        direction = np.append(self.map.lower + place * self.map.texel, 1.0)
        facing = self.receiver.m @ direction
        if self.receiver.h <= 0 or self.receiver.h >= self.receiver.d[2] * facing:
            return self.biased
        return self.map.normalised(self.kept * self.receiver.h / facing)

    def parts(self, lower, upper, cut=0):
        """Returns the result for the window, or the mean over the 4^cuts parts into which it is cut."""
        if self.cuts == 0:
            return self.lit(lower, upper, self.exact)
        if self.mean(lower, upper, lambda q: (q < self.biased).astype(float)) == 0:
            return 1.0, 0.0
        if cut < self.cuts and (upper - lower).max() > 1:
            half = (upper - lower) / 2
            sums = [self.parts(lower + half * (i, j), lower + half * (i + 1, j + 1), cut + 1) for j in (0, 1) for i in (0, 1)]
            return tuple(np.mean(sums, axis=0))
        t = self.exact if cut == 0 else self.plane((lower + upper) / 2) + self.slack
        share, blocked = self.lit(lower, upper, t)
        if share < 1:
            return share, blocked
        first, last = np.clip(lower, 0, SIZE), np.clip(upper, 0, SIZE)
        count = np.clip(np.ceil(last - first), 1, 4).astype(int)
        inside, found = np.prod(last - first) / np.prod(upper - lower), []
        for j, i in itertools.product(range(count[1]), range(count[0])):
            at = np.floor(first + (np.array([i, j]) + 0.5) * (last - first) / count)
            q = self.map.t[int(at[1]), int(at[0])]
            hidden = q < self.plane(at + 0.5)
            found.append((0.0, q) if hidden else (1.0, 0.0))
        share, blocked = np.mean(found, axis=0)
        return inside * share + 1 - inside, inside * blocked

    def window_through(self, z):
        d = self.receiver.d
        at, width = self.map.place(d), 2 * LIGHT * max(1 / z - 1 / d[2], 0) / self.map.texel
        own = at if width >= 1 else (np.floor(at) + 0.5) * (1 - width) + at * width
        half = max(width, 1.0) / 2
        return own - half, own + half

    def __call__(self, receiver):
        self.receiver, d, map_ = receiver, receiver.d, self.map
        if d[2] <= map_.nearest:
            return 1.0
        self.kept = 1 - BIAS * map_.texel * (1 + receiver.slope)
        self.biased = self.exact = map_.normalised(d[2] * self.kept)
        self.slack = 0.0
        if self.moments == "esm":
            self.exact = map_.normalised(d[2]) - 2.0**-20
        if self.moments == "evsm":
            self.exact = map_.normalised(d[2])
            self.slack = self.exact - self.biased
        if self.window:
            first = np.floor(map_.place(d) - self.window / 2 + 0.5)
            return float(np.clip(self.parts(first, first + self.window)[0], 0, 1))
        radius = 2 * LIGHT / np.sqrt(np.pi)  # radius of a disk with the light's area
        share, blocked = self.parts(*self.window_through(min(max(map_.nearest, radius), d[2])))
        if share >= 1:
            return 1.0
        z = np.clip(map_.low + blocked / (1 - share) * (map_.high - map_.low), map_.nearest, d[2])
        return float(np.clip(self.parts(*self.window_through(z))[0], 0, 1))


class Slices:
    """Eisemann and Decoret 2006: casters in equally thick slices, each a picture of bits that the light's box filters;
    V is the product."""

    def __init__(self, map_, quads, count=8):
        self.filter = Filter(map_, "vsm")
        self.map = map_
        floor = {"center": [0, 0, 0], "halfU": [FLOOR, 0, 0], "halfV": [0, 0, -FLOOR]}
        corners = [in_frame(np.add(q["center"], s * np.asarray(q["halfU"]) + t * np.asarray(q["halfV"])))[2]
                   for q in quads for s in (-1, 1) for t in (-1, 1)]
        nearest = min(corners)
        self.planes = nearest + (TOP - nearest) * (np.arange(count) + 1) / count
        self.nearest = nearest
        self.bits = np.zeros((count, SIZE, SIZE))
        for quad in [*quads, floor]:
            depth = map_.depth_of(quad)
            number = np.searchsorted(self.planes * (1 + 2.0**-18), depth)
            for k in range(count):
                self.bits[k] = np.where(np.isfinite(depth) & (number == k), 1.0, self.bits[k])

    def mean(self, lower, upper, k):
        x0, y0 = np.maximum(np.floor(lower), 0).astype(int)
        x1, y1 = np.minimum(np.ceil(upper), SIZE).astype(int)
        shares = [np.minimum(np.arange(a, b) + 1.0, upper[i]) - np.maximum(np.arange(a, b), lower[i])
                  for i, (a, b) in enumerate([(x0, x1), (y0, y1)])]
        return (np.outer(shares[1], shares[0]) * self.bits[k][y0:y1, x0:x1]).sum() / np.prod(upper - lower)

    def __call__(self, receiver):
        self.filter.receiver = receiver
        height = receiver.d[2] * max(1 - BIAS * self.map.texel * (1 + receiver.slope), 0)
        if self.nearest >= height:
            return 1.0
        v = 1.0
        for k, plane in enumerate(self.planes):
            if plane >= height:
                break
            v *= 1 - self.mean(*self.filter.window_through(plane), k)
        return v


class Convolution(Slices):
    """Soler and Sillion 1998: all blockers are in one plane, at the mean height of their triangles weighed by their
    area as seen from the light's plane; if all objects receive, the largest as seen from there is no blocker."""

    def __init__(self, map_, quads):
        self.filter, self.map = Filter(map_, "vsm"), map_
        turned = lambda v: in_frame(v) - in_frame([0, 0, 0])
        seen = [abs(np.cross(turned(q["halfU"]), turned(q["halfV"]))[2]) for q in quads]
        self.nearest = np.average([in_frame(q["center"])[2] for q in quads], weights=seen)
        self.planes = [self.nearest]
        self.bits = np.any([np.isfinite(map_.depth_of(q)) for q in quads], axis=0)[None].astype(float)


class Twins(unittest.TestCase):
    def check(self, method, options, twin, tolerance, most_off=0.01):
        """`most_off`: share of pixels that rounding may change: their search is at the limit of being blocked, or their
        place is at a texel's border within float32."""
        for name, quads in SCENES.items():
            picture = penumbra.render(penumbra.Scene.from_dict(scene_of(quads)), size=(PIXELS, PIXELS), method=method,
                                      options={"size": str(SIZE), **options})
            map_ = Map(quads)
            map_.quads = quads
            answer, off, judged, soft = twin(map_), [], 0, 0
            for y, x in zip(*np.nonzero(picture.A == 1)):
                receiver = Receiver(picture.P[y, x], picture.N[y, x])
                if receiver.h <= 0.7:  # the light's centre and all else of it are above the receiver's horizon
                    continue
                v = answer(receiver)
                judged += 1
                soft += 0.02 < v < 0.98
                if abs(v - picture.V[y, x]) > tolerance:
                    off.append((int(y), int(x), round(v, 5), float(picture.V[y, x])))
            print(f"{method} {options} on {name}: {judged} pixels, {soft} in penumbra, {len(off)} off {off[:3]}")
            self.assertGreater(judged, 400)
            self.assertLessEqual(len(off), most_off * judged, (method, options, name, off[:5]))

    def test_hard_and_counted(self):
        for window in (1, 4, 7):
            self.check("pcf", {"window": str(window)}, lambda m: lambda r: pcf(m, r, window), 1e-6)
        self.check("shadow-map", {}, lambda m: lambda r: pcf(m, r, 1), 1e-6)

    def test_forward(self):
        for degree, splat in enumerate(("box", "tent", "spline")):
            self.check("forward-map", {"splat": splat}, lambda m: lambda r: forward(m, r, degree), 1e-5, 0.015)

    # Means are right to 2^-23 of their range, a variance to 2^-22. The bound divides the variance by itself plus the
    # squared distance from the mean; the smallest distance is half a texel of depth, 0.004 of the range: 2^-22 / 0.004
    # = 6e-5.
    def test_variance(self):
        self.check("vssm", {"subdivision": "none"}, lambda m: Filter(m, "vsm"), 2e-4)

    def test_kernel_subdivision(self):
        self.check("vssm", {}, lambda m: Filter(m, "vsm", cuts=3), 2e-4)
        self.check("vssm", {"cuts": "1"}, lambda m: Filter(m, "vsm", cuts=1), 2e-4)

    # A layer's heights are LAYERS times as far apart, and its variance has the same rounding.
    def test_layers(self):
        self.check("vssm", {"moments": "lvsm", "subdivision": "none"}, lambda m: Filter(m, "lvsm"), 2e-4, 0.02)
        self.check("vssm", {"moments": "lvsm"}, lambda m: Filter(m, "lvsm", cuts=3), 2e-4, 0.02)

    # Means of bits are exact: only the float32 rounding of windows' borders is left.
    def test_slices(self):
        for count in (3, 8):
            self.check("occlusion-textures", {"slices": str(count)}, lambda m: Slices(m, m.quads, count), 1e-4)

    def test_one_plane(self):
        self.check("convolution", {}, lambda m: Convolution(m, m.quads), 1e-4)

    def test_fixed_window(self):
        self.check("vssm", {"window": "9", "subdivision": "none"}, lambda m: Filter(m, "vsm", window=9), 2e-4)

    def test_exponentials(self):
        self.check("vssm", {"moments": "evsm"}, lambda m: Filter(m, "evsm"), 5e-4, 0.02)
        self.check("vssm", {"moments": "esm"}, lambda m: Filter(m, "esm"), 5e-4, 0.02)

    # Functions of the series have 12 digits; their weights add up to less than 2. A damped step ends close to 1, so
    # more searches are at the limit of being blocked.
    def test_series(self):
        self.check("vssm", {"moments": "csm"}, lambda m: Filter(m, "csm"), 1e-3, 0.08)
        self.check("vssm", {"moments": "csm", "terms": "6"}, lambda m: Filter(m, "csm", terms=6), 1e-3, 0.08)


if __name__ == "__main__":
    unittest.main()
