# SPDX-License-Identifier: Apache-2.0
"""Compares maps fitted to the camera's view with numpy: the faces of the camera's frustum (Kozlov 2004, Lloyd et al.
2006) and queried tiles (Giegl and Wimmer 2007). The scenes have level plates far from one another, so that no bias
matters: a pixel is dark if the ray through its texel's centre meets a plate before the plane of the pixel's own
surface."""

import unittest

import numpy as np

import penumbra
from filtering import PIXELS, SCENES, TOP, in_frame, scene_of
from hard import depths

EYE, TARGET, FOV = np.array([0.7, 1.3, 4.1]), np.array([-0.1, 0.1, 0.2]), 50.0
NAMES = ("plate", "two plates")
HAIR = 1e-3  # in texels: places in float32 may be off by this


class Seen:
    """The picture's view samples and the camera, in the light's frame."""

    def __init__(self, picture):
        self.pixels = np.argwhere(picture.A == 1)
        self.points = np.array([in_frame(picture.P[y, x]) for y, x in self.pixels])
        level = np.array([picture.N[y, x] for y, x in self.pixels])
        self.up = level[:, 1] > 0  # facing the light
        turn = lambda v: in_frame(v) - in_frame([0, 0, 0])
        forward = (TARGET - EYE) / np.linalg.norm(TARGET - EYE)
        right = np.cross(forward, [0, 1, 0])
        right /= np.linalg.norm(right)
        across = np.tan(np.radians(FOV) / 2)  # a square picture
        self.eye, self.forward = in_frame(EYE), turn(forward)
        self.sideward, self.upward = turn(right) / across, turn(np.cross(right, forward)) / across
        seen = (self.points - self.eye) @ self.forward
        self.near, self.far = seen.min(), seen.max()


def fitted(matrix, points, size):
    """Returns the matrix followed by the one that maps the bounds of these points to the face, one texel from its
    border on each side."""
    at = points @ matrix.T
    at = at[:, :2] / at[:, 2:]
    middle, half = (at.max(axis=0) + at.min(axis=0)) / 2, (at.max(axis=0) - at.min(axis=0)) / 2 / (1 - 2 / size)
    scale = 0.5 / half
    unit = np.array([[scale[0], 0, 0.5 - scale[0] * middle[0]], [0, scale[1], 0.5 - scale[1] * middle[1]], [0, 0, 1]])
    return unit @ matrix


def place(matrix, e):
    at = matrix @ e
    return at[:2] / at[2] if at[2] > 0 else np.array([np.inf, np.inf])


class Frustum:
    """docs/map-fits.md, Faces of the frustum: for each face a matrix that takes rays to places."""

    def __init__(self, seen, size):
        self.size, self.faces = size, []
        parts = self.homographies(seen)
        # The face in which the ray's image is inside the picture, or nearest to it.
        leaves = np.argmin([[np.abs(place(m, e)).max() for m in parts] for e in seen.points], axis=1)
        for k, matrix in enumerate(parts):
            if (leaves == k).any():
                self.faces.append(fitted(matrix, seen.points[leaves == k], size))

    @staticmethod
    def homographies(seen):
        eye, parts = seen.eye, []
        for sign in (-1, 1):
            for normal, along in ((seen.sideward, seen.upward), (seen.upward, seen.sideward)):
                g = sign * normal - seen.forward
                if g @ eye <= 0:  # the light is outside
                    continue
                w = lambda of: (g @ eye) * of - (of @ eye) * g  # of · W, as a row that is multiplied by e
                depth = w(seen.forward)
                low, high = 1 / seen.far, 1 / seen.near
                parts.append(np.array([w(along), (2 * g - (low + high) * depth) / (high - low), depth]))
        for at, sign in ((seen.near, -1), (seen.far, 1)):
            away = at + seen.forward @ eye
            if sign * away > 0:
                w = lambda of: sign * (away * of - (of @ eye) * seen.forward)
                parts.append(np.array([w(seen.sideward), w(seen.upward), w(seen.forward)]))
        return parts

    def matrix_of(self, e):
        return next((m for m in self.faces if ((at := place(m, e)) >= 0).all() and (at <= 1).all()), None)


class Even:
    """One window, and the squares into which it is cut."""

    def __init__(self, seen, size):
        self.size, self.whole = size, fitted(np.eye(3), seen.points, size)
        self.squares = [(0, 0, 0)]  # level, column, row

    def matrix_of(self, e):
        at = place(self.whole, e)
        for level, x, y in self.squares:
            if tuple(np.floor(at * 2**level)) == (x, y):
                return np.array([[2**level, 0, -x], [0, 2**level, -y], [0, 0, 1]]) @ self.whole
        return None


def lit(fit, e, quads):
    """Returns whether the texel of e is lit; None if rounding may choose another texel."""
    matrix = fit.matrix_of(e)
    if matrix is None:
        return None
    texel = place(matrix, e) * fit.size
    if (np.abs(texel - np.round(texel)) < HAIR).any():
        return None
    ray = np.linalg.solve(matrix, np.append((np.floor(texel) + 0.5) / fit.size, 1))
    return min(depths(ray / ray[2], quads), default=np.inf) > e[2] * (1 - 1e-3)  # receivers are level


def query(fit, seen, quads, tiles, changed):
    """Cuts squares whose last cut changed more than `changed` pixels; all that are due are cut for one picture."""
    answers = lambda: np.array([bool(lit(fit, e, quads)) if up else False for e, up in zip(seen.points, seen.up)])
    at = np.array([place(fit.whole, e) for e in seen.points])
    inside = lambda square: np.flatnonzero((np.floor(at * 2.0 ** square[0]) == square[1:]).all(axis=1))
    squares, pictures, before = [((0, 0, 0), np.inf)], 1, answers()
    while True:
        squares.sort(key=lambda square: -square[1])
        kept, quarters = [], []
        for square, changes in squares:
            if changes > changed and len(inside(square)) > 0 and len(squares) + 3 * (len(quarters) // 4 + 1) <= tiles:
                level, x, y = square
                quarters += [(level + 1, 2 * x + i, 2 * y + j) for j in (0, 1) for i in (0, 1)]
            else:
                kept.append((square, changes))
        if not quarters:
            return pictures
        fit.squares = [square for square, _ in kept] + quarters
        now, pictures = answers(), pictures + 1
        squares = kept + [(square, int((now != before)[inside(square)].sum())) for square in quarters]
        before = now


class Twins(unittest.TestCase):
    def picture(self, name, options):
        scene = scene_of(SCENES[name])
        scene["camera"] = {"eye": list(EYE), "target": list(TARGET), "verticalFov": FOV}
        return penumbra.render(penumbra.Scene.from_dict(scene), size=(PIXELS, PIXELS), method="shadow-map", options=options)

    def check(self, name, picture, seen, fit, what):
        judged, off, dark = 0, [], 0
        for (y, x), e, up in zip(seen.pixels, seen.points, seen.up):
            says = lit(fit, e, SCENES[name]) if up else None
            if says is None:
                continue
            judged += 1
            dark += not says
            if picture.V[y, x] != says:
                off.append((int(y), int(x), bool(says)))
        print(f"{what} on {name}: {judged} pixels, {dark} dark, {len(off)} off {off[:3]}")
        self.assertGreater(judged, 200)
        self.assertGreater(dark, 20)
        self.assertLessEqual(len(off), 0.01 * judged, (what, name, off[:5]))

    def test_faces_of_the_frustum(self):
        for size in (24, 61):
            for name in NAMES:
                picture = self.picture(name, {"fit": "faces", "size": str(size)})
                seen = Seen(picture)
                fit = Frustum(seen, size)
                self.assertGreater(len(fit.faces), 2, "rays leave through several faces")
                self.check(name, picture, seen, fit, f"fit=faces:size={size}, {len(fit.faces)} faces")

    def test_queried_tiles(self):
        for size, tiles, changed in ((16, 16, 4), (24, 64, 2), (24, 7, 0)):
            for name in NAMES:
                options = {"fit": "tiles", "refine": "queried", "size": str(size), "tiles": str(tiles), "changed": str(changed)}
                picture = self.picture(name, options)
                seen = Seen(picture)
                fit = Even(seen, size)
                pictures = query(fit, seen, SCENES[name], tiles, changed)
                self.assertGreater(pictures, 1)
                self.assertEqual(picture.stats["counters"]["queriedPictures"], pictures, options)
                self.check(name, picture, seen, fit, f"{options}, {len(fit.squares)} squares after {pictures} pictures")


if __name__ == "__main__":
    unittest.main()
