# SPDX-License-Identifier: Apache-2.0
"""Compares hard shadows of the light's centre with numpy, on the scenes of filtering.py: volumes, in all ways of
counting, and lists of view samples are compared with what a ray to the centre meets; volumes from a map (McCool 2000)
with walls on the borders of texels, found on the segment from the eye to the view sample."""

import unittest

import numpy as np

import penumbra
from filtering import FLOOR, LIGHT, PIXELS, SCENES, SIZE, TOP, Map, in_frame, scene_of

HIGH = ([0.4, 5.5, 5.0], [0, 0.4, 0])  # above the light's plane
LOW = ([-0.35, 0.8, 1.1], [0.3, 0.2, -0.6])  # in the shadow of some scenes' casters
JUMP = 2


def camera(scene, place):
    scene["camera"]["eye"], scene["camera"]["target"] = place
    return scene


def depths(ray, quads):
    """Returns the depths at which a ray of depth 1 meets quads and the floor."""
    floor = {"center": [0, 0, 0], "halfU": [FLOOR, 0, 0], "halfV": [0, 0, -FLOOR]}
    found = []
    for quad in [*quads, floor]:
        center = in_frame(quad["center"])
        u, v = (in_frame(np.add(quad["center"], quad[k])) - center for k in ("halfU", "halfV"))
        matrix = np.stack([ray, -u, -v], axis=-1)
        if abs(np.linalg.det(matrix)) < 1e-12:
            continue
        z, a, b = np.linalg.solve(matrix, center)
        if max(abs(a), abs(b)) <= 1 and z > 0:
            found.append(z)
    return found


def is_lit(d, quads):
    """Returns whether nothing is between the light's centre and the view sample; None within 1e-5 of an outline."""
    answers = {min(depths(np.append(d[:2] / d[2] + off, 1.0), quads), default=np.inf) > d[2] * (1 - 1e-4)
               for off in ((0, 0), (1e-5, 0), (-1e-5, 0), (0, 1e-5), (0, -1e-5))}
    return answers.pop() if len(answers) == 1 else None


class Walls:
    """A map's inverse depths, with nothing around it, and walls between neighbours that are not on one surface."""

    def __init__(self, map_):
        self.map = map_
        self.inverse = np.zeros((SIZE + 4, SIZE + 4))  # [y, x], two empty texels on each side
        self.inverse[2:-2, 2:-2] = np.where(np.isfinite(map_.depth), 1 / map_.depth, 0)
        self.tolerance = JUMP * map_.texel  # a step of k texels' widths at depth z is k · texel · z, and in 1/z that divided by z²

    def near(self, v, w):
        return abs(v - w) <= self.tolerance * max(v, w)

    def line(self, fixed, k, axis):
        """The inverse depths of the two texels on each side of border k of a row (axis 0) or a column."""
        at = self.inverse[fixed + 2] if axis == 0 else self.inverse[:, fixed + 2]
        return at[k:k + 4]

    def wall(self, fixed, k, axis):
        """Returns (whether the second texel is nearer, the wall's first depth, its last depth); None if there is no
        wall."""
        before, one, other, after = self.line(fixed, k, axis)
        if one == 0 and other == 0:
            return None
        if one > 0 and other > 0:
            goes_on = (before > 0 and self.near(2 * one - before, other)) or (after > 0 and self.near(2 * other - after, one))
            if self.near(one, other) or goes_on:
                return None
        slope = lambda here, there: 0.5 * (here - there) if there > 0 and self.near(here, there) else 0.0
        ends = one + slope(one, before) if one > 0 else 0.0, other + slope(other, after) if other > 0 else 0.0
        nearer = int(other > one)
        begins, far = ends[nearer], ends[1 - nearer]
        return (nearer, 1 / begins, 1 / far if far > 0 else np.inf) if begins > far else None

    def is_behind(self, x):
        if x[2] <= 0:
            return False
        i, j = np.floor(self.map.place(x)).astype(int)
        return 0 <= i < SIZE and 0 <= j < SIZE and x[2] > self.map.depth[j, i]

    def lit(self, eye, p):
        """Returns whether the segment from the eye to p enters as many walls as it leaves; None if it passes very near
        a wall's end."""
        count = int(self.is_behind(eye))
        borders = self.map.lower + np.arange(SIZE + 1) * self.map.texel
        for axis in (0, 1):
            start, end = eye[axis] - borders * eye[2], p[axis] - borders * p[2]
            for k in np.flatnonzero((start < 0) != (end < 0)):
                t = start[k] / (start[k] - end[k])
                x = eye + t * (p - eye)
                if x[2] <= 0:
                    continue
                place = (x[1 - axis] / x[2] - self.map.lower) / self.map.texel
                fixed = int(np.floor(place))
                if not 0 <= fixed < SIZE:
                    continue
                wall = self.wall(fixed, k, axis)
                if wall is None:
                    continue
                nearer, begins, ends = wall
                if min(abs(x[2] / begins - 1), abs(x[2] / ends - 1)) < 1e-6 or min(place - fixed, fixed + 1 - place) < 1e-4:
                    return None
                if begins < x[2] < ends:
                    to_the_second = end[k] > start[k]
                    count += 1 if to_the_second == bool(nearer) else -1
        return count == 0


class Twins(unittest.TestCase):
    def check(self, method, options, places, twin, most_off):
        shadows = 0
        for name, quads in SCENES.items():
            for place in places:
                answer = twin(quads, in_frame(place[0]))
                picture = penumbra.render(penumbra.Scene.from_dict(camera(scene_of(quads), place)), size=(PIXELS, PIXELS), method=method,
                                          options=options)
                judged, off, dark = 0, [], 0
                for y, x in zip(*np.nonzero(picture.A == 1)):
                    d, n = in_frame(picture.P[y, x]), picture.N[y, x]
                    if -np.array([n[0], n[2], -n[1]]) @ d <= LIGHT * 1.4:  # part of the light is below the horizon
                        continue
                    lit = answer(d)
                    if lit is None:
                        continue
                    judged += 1
                    dark += not lit
                    if picture.V[y, x] != lit:
                        off.append((int(y), int(x), bool(lit)))
                print(f"{method} {options} on {name} from {place[0]}: {judged} pixels, {dark} dark, {len(off)} off {off[:3]}")
                self.assertGreater(judged, 150)
                self.assertLessEqual(len(off), most_off * judged, (method, options, name, off[:5]))
                shadows += dark
        self.assertGreater(shadows, 200)

    def test_volumes_and_lists(self):
        known = {}  # all methods have the same view samples

        def twin(quads, eye):
            def answer(d):
                key = id(quads), d.tobytes()
                if key not in known:
                    known[key] = is_lit(d, quads)
                return known[key]
            return answer

        for variant in ("z-fail", "zp+", "cc", "split", "hierarchical", "tiles"):
            self.check("hard-volume", {"variant": variant}, (HIGH, LOW), twin, 0)
        self.check("alias-free", {}, (HIGH, LOW), twin, 0)

    # If an eye or a view sample is within rounding of a wall's plane, the program counts triangles, not walls.
    def test_volumes_from_a_map(self):
        def twin(quads, eye):
            walls = Walls(Map(quads))
            return lambda d: walls.lit(eye, d)
        self.check("hybrid-volume", {"variant": "mccool", "size": str(SIZE), "jump": str(JUMP)}, (HIGH, LOW), twin, 0.004)


if __name__ == "__main__":
    unittest.main()
