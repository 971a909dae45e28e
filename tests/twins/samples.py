# SPDX-License-Identifier: Apache-2.0
"""Compares methods that render a map from each light sample to their copies in numpy: accumulate (Heckbert and Herf 1997), the mean of hard
shadows, and deep-penumbra (St-Amour, Paquette and Poulin 2005), which along the ray through a texel's centre counts, at
every depth, the samples whose map shows nothing nearer. Scenes and maps are those of backprojection.py and layers.py; V
is that of the floor.

V is a whole number of samples. Pixels are left out if rounding may choose another texel, or if a texel's centre is
within 1/128 texel of an outline."""

import sys
import unittest

import numpy as np

import penumbra
from backprojection import CASTERS, Map, local, parallelogram, scene_of
from layers import ACROSS, BORDER, sample_points, window

SIZE, BIAS = 61, 0.5
# The window of each sample ends at another place on the plate, so that no two maps share texels.
WIDE = "a plate that receives, too"
SCENES = CASTERS | {WIDE: [parallelogram((0.552, 3.4, 0.103), (0.41, 0, 0), (0, 0, 0.36))]}


class Sampled:
    def __init__(self, casters, receive):
        self.points = np.array(sample_points())
        self.maps = [Map(casters, SIZE, *window(casters, receive, point), point) for point in self.points]
        self.lower, upper = window(casters, receive, (0.0, 0.0))
        self.texel = (upper - self.lower) / SIZE

    def sees(self, number, p, depth):
        """Returns whether a sample's map shows nothing nearer than this depth in the texel of p, and whether that is
        certain."""
        m = self.maps[number]
        at = ((p[:2] - self.points[number]) / p[2] - m.lower) / m.texel
        x, y = np.floor(at).astype(int)
        if not (0 <= x < SIZE and 0 <= y < SIZE):
            return True, (at < -BORDER).any() or (at > SIZE + BORDER).any()
        sure = (np.abs(at - np.round(at)) > BORDER).all() and not m.unsure[y, x]
        return m.layer(0)[y, x] >= depth, sure

    def share(self, p, depth):
        answers = [self.sees(number, p, depth) for number in range(len(self.points))]
        return sum(lit for lit, _ in answers) / len(answers), all(sure for _, sure in answers)

    def accumulate(self, p):
        return self.share(p, p[2])

    def deep_penumbra(self, p):
        """Returns V of the ray through the receiver's texel centre, at the receiver's depth minus the bias."""
        at = (p[:2] / p[2] - self.lower) / self.texel
        if (np.abs(at - np.round(at)) < BORDER).any():
            return 0.0, False
        depth = p[2] * (1 - BIAS * max(self.texel))
        ray = np.append(self.lower + (np.floor(at) + 0.5) * self.texel, 1.0)
        return self.share(ray * depth, depth)


class Twins(unittest.TestCase):
    def found(self, name, method, **options):
        scene = scene_of(SCENES[name])
        for mesh in scene["meshes"]:
            if name == WIDE:
                mesh.pop("receivesShadow", None)
        picture = penumbra.render(scene, size=(40, 40), method=method, options={"size": SIZE, **options},
                                  light_samples=ACROSS * ACROSS, sample_pattern="grid")
        there = (picture.A == 1) & (np.abs(picture.P[..., 1]) < 1e-4)
        return local(picture.P[there].astype(float)), picture.V[there].astype(float), picture.stats["counters"]

    def check(self, what, found, twins, tolerance):
        sure = np.array([s for _, s in twins])
        expected = np.array([v for v, _ in twins])[sure]
        between, off = ((expected > 0) & (expected < 1)).sum(), np.abs(found[sure] - expected)
        print(f"{what}: {sure.sum()} of {len(sure)} places, {between} in penumbra, off by {off.max():.2e}, at {(off > 1e-6).sum()}")
        self.assertGreater(sure.mean(), 0.4)
        self.assertGreater(between, 30)
        self.assertLessEqual(off.max(), tolerance, what)
        return expected

    def test_accumulate(self):
        for name in SCENES:
            sampled = Sampled(SCENES[name], name == WIDE)
            places, found, _ = self.found(name, "accumulate")
            self.check(f"accumulate, {name}", found, [sampled.accumulate(p) for p in places], 1e-6)

    def test_deep_penumbra(self):
        differ = 0
        for name in SCENES:
            sampled = Sampled(SCENES[name], name == WIDE)
            places, found, counters = self.found(name, "deep-penumbra", bound=0)
            twins = [sampled.deep_penumbra(p) for p in places]
            expected = self.check(f"deep-penumbra, {name}", found, twins, 1e-6)
            sure = np.array([s for _, s in twins])
            differ += (expected != np.array([sampled.accumulate(p)[0] for p in places])[sure]).sum()
            # Lokovic and Veach 2000: fewer steps, none of which is off by more than the bound.
            _, bounded, fewer = self.found(name, "deep-penumbra", bound=0.2)
            off = np.abs(bounded[sure] - expected)
            print(f"  bound=0.2: off by {off.max():.4f}, {fewer['steps']} of {counters['steps']} steps")
            self.assertLessEqual(off.max(), 0.2 + 1e-6)
            self.assertLess(fewer["steps"], 0.95 * counters["steps"])
        self.assertGreater(differ, 10, "V at a texel's centre must differ from V at the receiver somewhere")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
