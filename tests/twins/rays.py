# SPDX-License-Identifier: Apache-2.0
"""Compares layer-rays with numpy (Lischinski and Rappoport 1998, Keating and Max 1999, Agrawala et al. 2000): rays from
a view sample to each light sample through the layers of the centre's map, whose texels are flat pieces at their depths.
Scenes and maps are those of backprojection.py. A ray is stopped where

  - it passes a piece's depth within the piece's texel;
  - (`gap`) it passes from one texel to the next between their two depths, if these are at most `gap` texels apart:
    written for one layer, where no surface continues next to another;
  - (`solid`) a part of it inside a texel is between the first and the second layer, or the third and the fourth.

Each test is written for all texels at once: with r the depth of a point of the ray, the point is seen in the map at s +
(p - s) r / p.z over r, a line in 1/r. V is a whole number of rays; pixels are left out if a ray passes so near to a
border that rounding decides."""

import sys
import unittest

import numpy as np

import penumbra
from backprojection import CASTERS as FOUR, FAR, HALF, box, is_sure, local, map_of, parallelogram, scene_of

ACROSS, SIZE = 6, 40
HAIR, DEPTHS = 2e-4, 1e-5  # texels; relative depths
CASTERS = FOUR | {"steep plate": [parallelogram((0.053, 2.1, 0.032), (0.33, 0.83, 0.04), (-0.02, 0.05, 0.72))],
                  "board": box((0.071, 1.9, -0.043), (0.083, 1.21, 0.63))}


def samples():
    at = -HALF + (np.arange(ACROSS) + 0.5) * 2 * HALF / ACROSS
    return [np.array([x, y]) for y in at for x in at]


def inside(line, m):
    """Returns, for each texel of the map, the smallest distance of a line's points to the texel's borders, in texels:
    negative outside."""
    a, b = line
    x = (a - m.lower[0]) / m.texel[0] - np.arange(m.size)[None]
    y = (b - m.lower[1]) / m.texel[1] - np.arange(m.size)[:, None]
    return np.minimum(np.minimum(x, 1 - x), np.minimum(y, 1 - y))


def seen(p, sample, depth):
    """Returns the place in the map of the ray's point at a depth."""
    return [sample[k] / depth + (p[k] - sample[k]) / p[2] for k in (0, 1)]


def pieces(m, p, sample, layers):
    stopped, close = False, False
    for k in range(layers):
        depth = m.layer(k)
        there = depth < p[2] * (1 - 1e-3)
        at = np.where(there, inside(seen(p, sample, np.where(there, depth, 1)), m), -1)
        stopped |= (at > 0).any()
        close |= (np.abs(at) < HAIR).any()
    return stopped, close


def walls(m, p, sample, gap):
    """Finds borders between texels that the ray passes between the two texels' depths."""
    depth, stopped, close = m.layer(0), False, False
    for axis in (0, 1):
        one, other = (depth[:, :-1], depth[:, 1:]) if axis == 0 else (depth[:-1], depth[1:])
        border = m.borders(axis)[1:-1] - p[axis] / p[2]
        # sample / r = border + sample / p.z along the axis.
        with np.errstate(divide="ignore"):
            r = sample[axis] / (border + sample[axis] / p[2])
        r = r[None] if axis == 0 else r[:, None]
        r = np.where((r > 0) & (r < p[2]), r, -1.0)
        near, far = np.minimum(one, other), np.maximum(one, other)
        joined = (far < FAR) & (far - near <= gap * max(m.texel) * near)
        close |= ((far < FAR) & (np.abs(far - near - gap * max(m.texel) * near) < 1e-4) & (near < r) & (r < far)).any()
        along = 1 - axis
        at = (sample[along] / np.where(r > 0, r, 1) + (p[along] - sample[along]) / p[2] - m.lower[along]) / m.texel[along]
        at = at - (np.arange(m.size)[:, None] if axis == 0 else np.arange(m.size)[None])
        # In units of the change that rounding may cause.
        within = np.minimum(at, 1 - at) / HAIR
        between = np.minimum(r / near - 1, 1 - r / far) / DEPTHS
        hit = np.where(joined & (r > 0), np.minimum(within, between), -2)
        stopped |= (hit > 0).any()
        close |= (np.abs(hit) < 1).any()
    return stopped, close


def insides(m, p, sample, layers):
    """Finds texels in which a part of the ray is between two depths: in 1/r, one interval for the two borders on each
    axis and one for the two depths."""
    stopped, close = False, False
    low, high = np.full((m.size, m.size), 1 / p[2]), np.full((m.size, m.size), np.inf)
    for axis in (0, 1):
        if abs(sample[axis]) < 1e-9:
            raise ValueError("samples are beside the axes")
        # In 1/r, borders are (border - p / p.z) / sample + 1 / p.z.
        ends = (m.borders(axis) - p[axis] / p[2]) / sample[axis] + 1 / p[2]
        first, last = np.minimum(ends[:-1], ends[1:]), np.maximum(ends[:-1], ends[1:])
        shape = (lambda x: x[None]) if axis == 0 else (lambda x: x[:, None])
        low, high = np.maximum(low, shape(first)), np.minimum(high, shape(last))
    for k in range(1, layers, 2):
        front, back = m.layer(k - 1), m.layer(k)
        full = (back < FAR) & (back < p[2] * (1 - 1e-3))
        length = np.where(full, np.minimum(high, 1 / front) - np.maximum(low, 1 / np.where(full, back, 1)), -1)
        stopped |= (length > 0).any()
        close |= (np.abs(length) < 1e-6).any()
    return stopped, close


def visibility(m, p, layers, gap, solid):
    count, sure = 0, True
    for sample in samples():
        answers = [pieces(m, p, sample, layers)]
        if gap:
            answers.append(walls(m, p, sample, gap))
        if solid:
            answers.append(insides(m, p, sample, layers))
        stopped = any(s for s, _ in answers)
        # An answer close to its limit may be rounded to the opposite, whatever the other answers are.
        sure = sure and not any(close for _, close in answers)
        count += not stopped
    return count / ACROSS**2, sure


class Twins(unittest.TestCase):
    def check(self, name, layers, gap=0, solid=False):
        m = map_of(CASTERS[name], SIZE)
        picture = penumbra.render(scene_of(CASTERS[name]), size=(22, 22), method="layer-rays",
                                  options={"size": m.size, "layers": layers, "gap": gap, "solid": "on" if solid else "off"},
                                  light_samples=ACROSS * ACROSS, sample_pattern="grid")
        floor = (picture.A == 1) & (np.abs(picture.P[..., 1]) < 1e-4)
        places, found = local(picture.P[floor].astype(float)), picture.V[floor].astype(float)
        near = np.array([is_sure(m, p) for p in places])
        places, found = places[near], found[near]
        twins = [visibility(m, p, layers, gap, solid) for p in places]
        sure = np.array([s for _, s in twins])
        expected, found = np.array([v for v, _ in twins])[sure], found[sure]
        between, off = ((expected > 0) & (expected < 1)).sum(), np.abs(found - expected)
        print(f"{name}, {layers} layers, gap {gap}, solid {solid}: {sure.sum()} of {len(sure)} places, {between} in penumbra, "
              f"off by {off.max():.2e}, at {(off > 1e-6).sum()}")
        self.assertGreater(len(found), 60)
        self.assertGreater(between, 20)
        self.assertLess(off.max(), 1e-6, (name, layers, gap, solid))
        return dict(zip(map(tuple, places[sure]), expected))

    def test_pieces(self):
        for name in CASTERS:
            one, two = self.check(name, 1), self.check(name, 2)
            if name == "two plates":
                self.assertGreater(sum(two[p] < one[p] for p in one.keys() & two.keys()), 5, "with two layers the lower plate continues under the upper one")

    def test_walls(self):
        for name in ("tilted plate", "steep plate", "board"):
            before = self.check(name, 1)
            for gap in (1, 4, 64):
                walled, more = self.check(name, 1, gap), 0
                for p in before.keys() & walled.keys():
                    self.assertLessEqual(walled[p], before[p])
                    more += walled[p] < before[p]
                before = walled
                print(f"  darker than with smaller gaps: {more}")
                if name == "steep plate" and gap == 4:
                    self.assertGreater(more, 5, "light comes between pieces")

    def test_insides(self):
        bare, full = self.check("board", 2), self.check("board", 2, solid=True)
        self.assertGreater(sum(full[p] < bare[p] for p in bare.keys() & full.keys()), 5, "a box's sides")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
