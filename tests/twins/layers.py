# SPDX-License-Identifier: Apache-2.0
"""Compares layered-attenuation with a twin in numpy (the module penumbra must be found), from Agrawala, Ramamoorthi,
Heirich and Moll 2000: which light samples see a texel of the centre's image, by the texel of each sample's own map in
which it lies.

The floor and the plates are parallel to the light. So the image of a sample's texel in the centre's map is an upright
rectangle, and those of neighbours on one surface meet: the middle of a texel of the centre is in exactly one of them,
and the sample counts if that texel's nearest surface is the receiver's. V is a whole number of samples. A pixel is left
out if rounding may choose another texel (a view sample or a middle within 1e-3 texel of a border), or if a texel's
middle is within 1/128 texel of an outline. Windows, casters and the light are those of backprojection.py."""

import sys
import unittest

import numpy as np

import penumbra
from backprojection import CASTERS, FLOOR, HALF, HEIGHT, Map, corners_of, local, scene_of, spared, tangents

ACROSS = 4  # samples along each side of the light
SIZE = 61
EPSILON = 0.02
BORDER = 1e-3


def sample_points():
    at = -HALF + (np.arange(ACROSS) + 0.5) * 2 * HALF / ACROSS
    return [(x, y) for y in at for x in at]


def window(casters, receive, point):
    """Returns the window of receivers as seen from a point of the light, and one more texel on every side."""
    lower, upper = (np.array([sign * FLOOR - c for c in point]) / HEIGHT for sign in (-1, 1))
    if receive:
        seen = tangents(corners_of(casters), point)
        lower, upper = np.minimum(lower, seen[0]), np.maximum(upper, seen[1])
    return spared(lower, upper, SIZE)


class Layers:
    def __init__(self, casters, receive):
        self.lower, upper = window(casters, receive, (0.0, 0.0))
        self.texel = (upper - self.lower) / SIZE
        self.points = sample_points()
        self.maps = [Map(casters, SIZE, *window(casters, receive, point), point) for point in self.points]
        for m, (lx, ly) in zip(self.maps, self.points):
            x, y = m.a * HEIGHT + lx, m.b * HEIGHT + ly
            on_floor = (np.abs(x) <= FLOOR) & (np.abs(y) <= FLOOR)
            m.nearest = np.minimum(m.layer(0), np.where(on_floor, HEIGHT, np.inf))

    def seen_by(self, texel, depth):
        """Returns how many samples see the surface at this depth in a texel of the centre's map, and whether that is sure."""
        middle = (self.lower + (texel + 0.5) * self.texel) * depth
        count, sure = 0, True
        for m, point in zip(self.maps, self.points):
            at = ((middle - point) / depth - m.lower) / m.texel
            x, y = np.floor(at).astype(int)
            if not (0 <= x < SIZE and 0 <= y < SIZE):
                continue
            sure = sure and (np.abs(at - np.round(at)) > BORDER).all() and not m.unsure[y, x]
            count += abs(m.nearest[y, x] - depth) <= EPSILON * depth
        return count, sure

    def visibility(self, p):
        at = (p[:2] / p[2] - self.lower) / self.texel
        own = np.floor(at)
        sure = (np.abs(at - np.round(at)) > BORDER).all()
        count, is_sure = self.seen_by(own, p[2])
        sure = sure and is_sure
        if count == 0 and sure:  # the receiver is searched in the eight surrounding texels
            around = [self.seen_by(own + (dx, dy), p[2]) for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
            count, sure = max(c for c, _ in around), all(s for _, s in around)
        return count / len(self.points), sure


class LayeredAttenuation(unittest.TestCase):
    def compare(self, name, receive, level):
        """Compares pixels of one height: those of the floor (0), or of a parallel plate that receives, too."""
        casters = CASTERS[name]
        scene = scene_of(casters)
        for mesh in scene["meshes"]:
            if receive:
                mesh.pop("receivesShadow", None)
        picture = penumbra.render(scene, size=(32, 32), method="layered-attenuation",
                                  options={"size": SIZE, "epsilon": EPSILON}, light_samples=ACROSS * ACROSS, sample_pattern="grid")
        there = (picture.A == 1) & (np.abs(picture.P[..., 1] - level) < 1e-4)
        places, found = local(picture.P[there].astype(float)), picture.V[there].astype(float)
        layers = Layers(casters, receive)
        twins = [layers.visibility(p) for p in places]
        sure = np.array([s for _, s in twins])
        expected = np.array([v for v, _ in twins])[sure]
        between = ((expected > 0) & (expected < 1)).sum()
        off = np.abs(found[sure] - expected)
        print(f"{name}, {'all receive' if receive else 'the floor receives'}, height {level}: {sure.sum()} of {len(sure)} places, "
              f"{between} in penumbra, off by {off.max():.2e}, at {(off > 1e-6).sum()}")
        self.assertGreater(sure.mean(), 0.4)
        self.assertGreater(between, 15)
        self.assertLess(off.max(), 1e-6)

    def test_the_floor_below(self):
        for name in CASTERS:
            self.compare(name, False, 0.0)

    def test_the_floor_below_what_receives_too(self):
        for name in CASTERS:
            self.compare(name, True, 0.0)

    def test_a_plate_below_another(self):
        self.compare("two plates", True, CASTERS["two plates"][1][0][1])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
