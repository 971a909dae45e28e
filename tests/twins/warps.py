# SPDX-License-Identifier: Apache-2.0
"""Compares warped maps with numpy, from Wimmer et al. 2004 (LiSPSM), Martin and Tan 2004 (TSM), Stamminger and
Drettakis 2002 (PSM) and Lloyd et al. 2008 (LogPSM), on the scenes and from the eye of fits.py: a pixel is dark if the
ray through its texel's centre meets a plate before the plane of the pixel's own surface.

Directions are e = (x, y, depth) below the light; (x, y) / depth is the light's post-perspective space, where its rays
are parallel. PSM is written with the camera's 4 x 4 matrix: the line that is a ray's image is cut by the plane
perpendicular to the light's image."""

import unittest

import numpy as np

import penumbra
from filtering import PIXELS, SCENES, scene_of
from fits import EYE, FOV, HAIR, NAMES, TARGET, Seen
from hard import depths

FOCUS = 0.25  # the program's default
SPARE = 1  # texels left free at each end of a map


class Perspective:
    """A perspective along the view's image. Rows across it stay straight; along it, a row at y goes to
    (n + d) y / (d (n + y)), or to the logarithm of that perspective."""

    def __init__(self, fit, seen, size):
        self.size, self.logarithmic = size, fit == "logpsm"
        plane = lambda e: np.asarray(e)[..., :2] / np.asarray(e)[..., 2:]
        on_axis = lambda depth: plane(seen.eye + depth * seen.forward)
        axis = on_axis(seen.far) - on_axis(seen.near)
        self.along = axis / np.linalg.norm(axis)
        self.across = np.array([-self.along[1], self.along[0]])
        at = plane(seen.points) @ self.along
        self.first, self.length = at.min(), at.max() - at.min()
        eye = plane(seen.eye) @ self.along
        near = self.first - eye
        if fit == "tsm":  # the focus is at four fifths of the rows: (n + d) y / (d (n + y)) = 0.8
            y = on_axis(seen.near + FOCUS * (seen.far - seen.near)) @ self.along - self.first
            self.n = 0.2 * self.length * y / (0.8 * self.length - y)
        else:
            middle = seen.points.sum(axis=0)
            cosine = middle @ seen.forward / np.linalg.norm(middle) / np.linalg.norm(seen.forward)
            sine = np.sqrt(1 - cosine**2)
            self.n = self.optimal(seen, sine) if fit == "lispsm" else near / sine
        self.margin = SPARE / size
        places = np.array([self.warped(e) for e in seen.points])
        self.lower, self.width = places.min(axis=0), places.max(axis=0) - places.min(axis=0)

    def optimal(self, seen, sine):
        """Returns d / (sqrt(z1 / z0) - 1), with the view depths z0 of the nearest point and z1 of the far end of the
        map in the plane through the nearest point perpendicular to the light: Wimmer and Scherzer 2006, the same as (z0
        + sqrt(z0 z1)) / sine."""
        depths = (seen.points - seen.eye) @ seen.forward
        nearest = depths.argmin()
        z0 = depths[nearest]
        z1 = z0 + self.length * seen.points[nearest, 2] * sine
        return self.length / (np.sqrt(z1 / z0) - 1)

    def warped(self, e):
        at = np.asarray(e)[:2] / e[2]
        y = at @ self.along - self.first
        row = np.log((self.n + y) / self.n) if self.logarithmic else y / (self.n + y)
        return np.array([at @ self.across / (self.n + y), row])

    def texel(self, e):
        share = (self.warped(e) - self.lower) / self.width
        return (self.margin + share * (1 - 2 * self.margin)) * self.size

    def ray(self, texel):
        share = ((texel + 0.5) / self.size - self.margin) / (1 - 2 * self.margin)
        x, row = self.lower + share * self.width
        y = self.n * (np.exp(row) - 1) if self.logarithmic else self.n * row / (1 - row)
        return np.append((self.first + y) * self.along + x * (self.n + y) * self.across, 1.0)


class Camera:
    """The camera's own perspective."""

    def __init__(self, fit, seen, size):
        self.size, self.margin = size, SPARE / size
        n, f = seen.near, seen.far
        rows = np.array([np.append(r, -r @ seen.eye) for r in (seen.sideward, seen.upward, seen.forward, seen.forward)])
        rows[2] = rows[2] * (f + n) / (f - n) - np.array([0, 0, 0, 2 * f * n / (f - n)])
        images = np.column_stack([seen.points, np.ones(len(seen.points))]) @ rows.T
        images = images[:, :3] / images[:, 3:]
        middle = (images.min(axis=0) + images.max(axis=0)) / 2
        light = rows[:, 3]  # image of e = 0
        # The direction from the light's image at light[:3] / light[3] through the middle.
        v = middle * light[3] - light[:3]
        v /= np.linalg.norm(v)
        up = np.array([0, 0, 1.0]) if abs(v[2]) < 0.9 else np.array([0, 1.0, 0])
        up = up - v * (v @ up)
        up /= np.linalg.norm(up)
        plane = np.append(v, -v @ middle)
        # The point light + t direction is on the plane, for every direction e, if t = -(plane . light) / (plane .
        # direction).
        directions = rows[:, :3]
        image = np.outer(light, plane @ directions) - (plane @ light) * directions
        self.matrix = np.stack([np.append(np.cross(up, v), 0) @ image, np.append(up, 0) @ image, image[3]])
        if (self.matrix @ seen.points[0])[2] < 0:
            self.matrix = -self.matrix
        at = seen.points @ self.matrix.T
        assert (at[:, 2] > 0).all(), "the eye need not go back"
        at = at[:, :2] / at[:, 2:]
        self.lower, self.width = at.min(axis=0), at.max(axis=0) - at.min(axis=0)

    def texel(self, e):
        at = self.matrix @ e
        share = (at[:2] / at[2] - self.lower) / self.width
        return (self.margin + share * (1 - 2 * self.margin)) * self.size

    def ray(self, texel):
        share = ((texel + 0.5) / self.size - self.margin) / (1 - 2 * self.margin)
        ray = np.linalg.solve(self.matrix, np.append(self.lower + share * self.width, 1))
        return ray / ray[2]


class Floor:
    """Only a floor, seen from above by a camera of 4 : 3, under a light whose rays meet the view's axis at an angle of
    `degrees`: from behind the eye (sign 1) or toward it (-1)."""

    WIDE, HIGH, FAR, FOV = 96, 72, 40.0, 45.0

    def __init__(self, degrees, sign):
        eye, target = np.array([0, 1.6, 6]), np.array([0, 0.2, 0])
        forward = (target - eye) / np.linalg.norm(target - eye)
        right = np.array([1.0, 0, 0])
        upward = np.cross(right, forward)
        light = sign * np.cos(np.radians(degrees)) * forward - np.sin(np.radians(degrees)) * upward  # direction in which its rays travel
        lamp = eye + 12 * forward - self.FAR * light
        frame = np.array([right, np.cross(light, right), light])
        turn = lambda x: np.asarray(x) @ frame.T
        half = np.tan(np.radians(self.FOV) / 2)
        self.ray_of = lambda x, y: (forward + half * ((2 * x - self.WIDE) / self.HIGH)[..., None] * right
                                    + half * (1 - 2 * y / self.HIGH)[..., None] * upward)
        x, y = np.meshgrid(np.arange(self.WIDE) + 0.5, np.arange(self.HIGH) + 0.5)
        here, across, down = (self.on_floor(eye, self.ray_of(x + i, y + j)) for i, j in ((0, 0), (1e-4, 0), (0, 1e-4)))
        seen = (np.abs(here[..., 0]) < 12) & (here[..., 2] > -44) & (here[..., 2] < 6)
        self.points = turn(here[seen] - lamp)
        self.steps = [(turn(there[seen] - lamp) - self.points) / 1e-4 for there in (across, down)]
        self.eye, self.forward = turn(eye - lamp), turn(forward)
        depths = (self.points - self.eye) @ self.forward
        self.near, self.far = depths.min(), depths.max()
        quad = lambda center, u, v: {"center": list(center), "halfU": list(u), "halfV": list(v)}
        self.scene = {"format": "penumbra-scene/1", "camera": {"eye": list(eye), "target": list(target), "verticalFov": self.FOV},
                      "meshes": [{"name": "floor", "quad": quad([0, 0, -19], [12, 0, 0], [0, 0, -25])}],
                      "lights": [{"name": "lamp", "radiance": [1e8] * 3,
                                  "rectangle": quad(lamp, 0.001 * frame[0], 0.001 * frame[1])}]}

    @staticmethod
    def on_floor(eye, ray):
        with np.errstate(divide="ignore", invalid="ignore"):
            at = eye - eye[1] / ray[..., 1:2] * ray
        return np.where(ray[..., 1:2] < 0, at, np.inf)

    def errors(self, map_):
        """Returns m at every point: the longer column of the inverse of the change of texels per pixel."""
        here = np.array([map_.texel(e) for e in self.points])
        change = np.stack([np.array([map_.texel(e + 1e-4 * step) for e, step in zip(self.points, steps)]) - here
                           for steps in self.steps], axis=-1) / 1e-4
        return np.linalg.norm(np.linalg.inv(change), axis=-2).max(axis=-1)


class WithoutTheSine(Perspective):
    def optimal(self, seen, sine):
        return super().optimal(seen, sine) * sine


class EvenWindow(Perspective):
    def optimal(self, seen, sine):
        return 1e6 * self.length


class Errors(unittest.TestCase):
    def test_errors_of_tilted_views(self):
        for sign in (1, -1):
            for degrees in (90, 60, 30, 15):
                if sign < 0 and degrees == 90:
                    continue
                floor, size = Floor(degrees, sign), 256
                picture = penumbra.render(penumbra.Scene.from_dict(floor.scene), size=(floor.WIDE, floor.HIGH), method="shadow-map",
                                          options={"fit": "lispsm", "size": str(size), "aliasing": "count"})
                counters = picture.stats["counters"]
                self.assertEqual(counters["aliasingPixels"], len(floor.points))
                m, without, even = (floor.errors(twin("lispsm", floor, size)) for twin in (Perspective, WithoutTheSine, EvenWindow))
                print(f"{degrees} degrees {'from behind' if sign > 0 else 'towards the eye'}: m {m.mean():.3f} (largest {m.max():.2f}), without "
                      f"the sine {without.mean():.3f} ({without.max():.2f}), even {even.mean():.3f} ({even.max():.2f})")
                self.assertAlmostEqual(counters["aliasingThousandths"] / 1000 / len(m), m.mean(), delta=2e-3 * m.mean())
                self.assertAlmostEqual(counters["aliasingWorstThousandths"] / 1000, m.max(), delta=2e-3 * m.max())


class Twins(unittest.TestCase):
    def check(self, fit, twin):
        otherwise = 0
        for size in (24, 61):
            for name in NAMES:
                scene = scene_of(SCENES[name])
                scene["camera"] = {"eye": list(EYE), "target": list(TARGET), "verticalFov": FOV}
                render = lambda options: penumbra.render(penumbra.Scene.from_dict(scene), size=(PIXELS, PIXELS), method="shadow-map",
                                                         options=options | {"size": str(size)})
                picture, even = render({"fit": fit, "focus": str(FOCUS)}), render({"fit": "view"})
                seen = Seen(picture)
                map_ = twin(fit, seen, size)
                judged, off, dark, moved = 0, [], 0, 0
                for (y, x), e, up in zip(seen.pixels, seen.points, seen.up):
                    texel = map_.texel(e)
                    if not up or (np.abs(texel - np.round(texel)) < HAIR).any():
                        continue
                    lit = min(depths(map_.ray(np.floor(texel)), SCENES[name]), default=np.inf) > e[2] * (1 - 1e-3)
                    judged += 1
                    dark += not lit
                    moved += even.V[y, x] != lit
                    if picture.V[y, x] != lit:
                        off.append((int(y), int(x), bool(lit)))
                print(f"fit={fit}:size={size} on {name}: {judged} pixels, {dark} dark, {moved} else with fit=view, {len(off)} off {off[:3]}")
                self.assertGreater(judged, 200)
                self.assertGreater(dark, 20)
                otherwise += moved
                # Outlines within 1/256 texel of a centre are left to the rasteriser.
                self.assertLessEqual(len(off), 1, (fit, name, off[:5]))
        self.assertGreater(otherwise, 30, "a wrong map would be noticed")

    def test_lispsm(self):
        self.check("lispsm", Perspective)

    def test_tsm(self):
        self.check("tsm", Perspective)

    def test_logpsm(self):
        self.check("logpsm", Perspective)

    def test_psm(self):
        self.check("psm", Camera)


if __name__ == "__main__":
    unittest.main()
