# SPDX-License-Identifier: Apache-2.0
"""Compares ssao and hbao with numpy versions from their papers: Mittring 2007 (as Akenine-Moeller et al. 2008 describe
it) and Bavoil et al. 2008. The picture's depths are those of its view samples; the eye's space is the camera's,
computed here once more."""

import unittest

import numpy as np

import penumbra

PIXELS = 40
EYE, TARGET, FOV = np.array([1.5, 3.5, 4.0]), np.array([0.0, 0.4, 0.0]), 45.0
SCENE = {"camera": {"eye": list(EYE), "target": list(TARGET), "verticalFov": FOV},
         "meshes": [{"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [3, 0, 0], "halfV": [0, 0, -3]}},
                    {"name": "wall", "quad": {"center": [-1, 1, 0], "halfU": [0, 1, 0], "halfV": [0, 0, -3]}},
                    {"name": "box", "shape": {"type": "box", "center": [0.6, 0.4, 0.2], "halfSize": [0.4, 0.4, 0.4]}},
                    {"name": "ball", "shape": {"type": "sphere", "center": [-0.3, 0.5, 1.0], "radius": 0.5, "segments": 24}}],
         "lights": [{"name": "sky", "dome": {}, "radiance": [1, 1, 1]}]}
DIAGONAL = np.linalg.norm(np.array([3, 2, 3]) - np.array([-3, 0, -3]))


class Eye:
    """The picture's view samples, with x to the right, y up and z toward the viewer; NaN in the background."""

    def __init__(self, picture):
        forward = (TARGET - EYE) / np.linalg.norm(TARGET - EYE)
        right = np.cross(forward, [0, 1, 0])
        right /= np.linalg.norm(right)
        axes = np.stack([right, np.cross(right, forward), -forward])
        self.p = np.where(picture.A[..., None] > 0, (picture.P - EYE) @ axes.T, np.nan)
        self.n = picture.N @ axes.T
        self.focal = 0.5 * PIXELS / np.tan(np.radians(FOV) / 2)  # pixels for a unit at distance 1

    def place(self, q):
        return np.array([0.5 * PIXELS + self.focal * q[0] / -q[2], 0.5 * PIXELS - self.focal * q[1] / -q[2]])

    def seen(self, place):
        """Returns the surface at a place; None in the background and outside the picture."""
        x, y = np.floor(place).astype(int)
        if not (0 <= x < PIXELS and 0 <= y < PIXELS) or np.isnan(self.p[y, x, 0]):
            return None
        return self.p[y, x]


def spread(count):
    i = np.arange(count)
    z = 1 - (2 * i + 1) / count
    turn = 2 * np.pi * (i * (np.sqrt(5) - 1) / 2 % 1)
    return np.stack([np.sqrt(1 - z * z) * np.cos(turn), np.sqrt(1 - z * z) * np.sin(turn), z], axis=-1)


def ball(count):
    pairs = count // 2
    mirrored = np.array([int(f"{i:032b}"[::-1], 2) / 2**32 for i in range(pairs)])
    half = np.cbrt(mirrored + 0.5 / pairs)[:, None] * spread(pairs)
    return np.concatenate([half, -half])


def ssao(eye, y, x, radius, samples, hemisphere, ranged):
    p, n, hidden = eye.p[y, x], eye.n[y, x], 0
    for at in ball(samples):
        if hemisphere and at @ n < 0:
            at = -at
        q = p + radius * at
        front = eye.seen(eye.place(q)) if q[2] < 0 else None
        if front is not None and front[2] > q[2] and not (ranged and front[2] > p[2] + radius):
            hidden += 1
    return 1 - hidden / samples if hemisphere else min(1, 2 * (1 - hidden / samples))


def hbao(eye, y, x, radius, directions, steps, bias, weight):
    p, n, hidden = eye.p[y, x], eye.n[y, x], 0.0
    for angle in 2 * np.pi * np.arange(directions) / directions:
        best = -1.0
        for k in range(1, steps + 1):
            place = np.array([x + 0.5, y + 0.5]) + radius * eye.focal / -p[2] * k / steps * np.array([np.cos(angle), -np.sin(angle)])
            if (place < 0).any() or (place >= PIXELS).any():
                break
            q = eye.seen(place)
            if q is None or (np.floor(place) == (x, y)).all():
                continue
            d = q - p
            r = np.linalg.norm(d)
            if r >= radius or r == 0:
                continue
            flat = np.hypot(d[0], d[1])
            tangent = np.arctan2(-(n[0] * d[0] + n[1] * d[1]) / flat, max(n[2], 0)) if flat > 0 else -np.pi / 2
            base = max(best, np.sin(min(tangent + bias, np.pi / 2)) if flat > 0 else -1.0)
            if d[2] / r > base:
                hidden += weight(r / radius) * (d[2] / r - base)
                best = d[2] / r
    return max(1 - hidden / directions, 0)


class Twins(unittest.TestCase):
    def check(self, method, options, twin, most_off=0.01):
        """`most_off`: share of pixels for which rounding decides a comparison, or the pixel of a place."""
        picture = penumbra.render(penumbra.Scene.from_dict(SCENE), size=(PIXELS, PIXELS), method=method,
                                  options={"dither": "off", "radius": "0.08", **options})
        eye, off, judged, soft = Eye(picture), [], 0, 0
        for y, x in zip(*np.nonzero(picture.A == 1)):
            v = twin(eye, y, x, 0.08 * DIAGONAL)
            judged += 1
            soft += v < 0.95
            if abs(v - picture.V[y, x]) > 1e-5:
                off.append((int(y), int(x), v, float(picture.V[y, x])))
        print(f"{method} {options}: {judged} pixels, {soft} below 0.95, {len(off)} off {off[:3]}")
        self.assertGreater(judged, 900)
        self.assertGreater(soft, judged / 10)
        self.assertLessEqual(len(off), most_off * judged, off[:5])

    def test_ssao(self):
        for around in ("ball", "hemisphere"):
            for ranged in ("off", "on"):
                self.check("ssao", {"around": around, "range": ranged, "samples": "24"},
                           lambda e, y, x, r: ssao(e, y, x, r, 24, around == "hemisphere", ranged == "on"), 0.03)

    def test_hbao(self):
        weights = {"none": lambda s: 1.0, "linear": lambda s: 1 - s, "quadratic": lambda s: 1 - s * s}
        for name, weight in weights.items():
            for bias in (10, 30):
                self.check("hbao", {"attenuation": name, "angleBias": str(bias), "directions": "6", "steps": "5"},
                           lambda e, y, x, r: hbao(e, y, x, r, 6, 5, np.radians(bias), weight), 0.03)


if __name__ == "__main__":
    unittest.main()
