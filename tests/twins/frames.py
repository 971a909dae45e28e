# SPDX-License-Identifier: Apache-2.0
"""frames.py PROGRAM: compares shadow-map:reproject=on with numpy, from Scherzer, Jeschke and Wimmer 2007 (course notes,
3.2.6), on a sequence whose camera moves over level plates. Each frame's map is moved by a point of Halton's sequence; V
is mixed with V of the frame before, at the place where the surface was seen there, with a weight given by how near the
pixel is to its texel's centre."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "browser"))
from exr import read_exr  # noqa: E402
from filtering import FLOOR, PIXELS, SCENES, TOP, in_frame, scene_of  # noqa: E402
from hard import depths  # noqa: E402

SIZE, FRAMES = 40, 5
TARGET, FOV = np.array([0.0, 0.2, 0.0]), 50.0
SAME_SURFACE = 2.0**-10
HAIR = 2e-3  # in texels: float32 may put a place so near a border into the next texel, whose answer may count fully


def eye_of(frame):
    return np.array([0.3 + 0.11 * frame, 4.2 - 0.07 * frame, 3.9])


def halton(index, base):
    value, digit = 0.0, 1.0
    while index:
        digit /= base
        value += digit * (index % base)
        index //= base
    return value


class Picture:
    def __init__(self, path, frame):
        channels, (width, height) = read_exr(path)
        read = lambda *names: np.stack([np.reshape(channels[name], (height, width)) for name in names], axis=-1)
        self.p, self.n = read("P.X", "P.Y", "P.Z"), read("N.X", "N.Y", "N.Z")
        self.v, self.shown = read("V")[..., 0], read("A")[..., 0] == 1
        self.eye = eye_of(frame)
        forward = (TARGET - self.eye) / np.linalg.norm(TARGET - self.eye)
        right = np.cross(forward, [0, 1, 0])
        right /= np.linalg.norm(right)
        self.axes = np.stack([right, np.cross(right, forward), forward])

    def place(self, p):
        """Returns column and row, with pixels' centres at whole numbers."""
        x, y, z = self.axes @ (p - self.eye)
        scale = 0.5 * PIXELS / np.tan(np.radians(FOV) / 2) / z
        return (x * scale + 0.5 * PIXELS - 0.5, 0.5 * PIXELS - y * scale - 0.5) if z > 0 else None


class Window:
    """The moved map of one frame: the floor's directions and one more texel on every side."""

    def __init__(self, quads, frame):
        self.quads, self.texel = quads, 2 * FLOOR / TOP / (SIZE - 2)
        moved = np.array([halton(frame, 2), halton(frame, 3)]) - 0.5 if frame else np.zeros(2)
        self.lower = -FLOOR / TOP - self.texel + moved * self.texel

    def ask(self, d):
        """Returns V and the confidence in it; None if rounding may choose another texel."""
        place = (d[:2] / d[2] - self.lower) / self.texel
        off = np.abs(place - np.floor(place) - 0.5).max()
        if off > 0.5 - HAIR:
            return None
        ray = np.append(self.lower + (np.floor(place) + 0.5) * self.texel, 1.0)
        return float(min(depths(ray, self.quads), default=np.inf) > d[2] * (1 - 1e-3)), 1 - 2 * off


def before(last, values, p, n):
    """Returns V where the last picture shows this surface, bilinear over those of four pixels that see its plane; None
    if it does not show it."""
    place = last.place(p)
    if place is None:
        return None
    total = weights = 0.0
    for row in (int(np.floor(place[1])), int(np.floor(place[1])) + 1):
        for column in (int(np.floor(place[0])), int(np.floor(place[0])) + 1):
            weight = (1 - abs(place[0] - column)) * (1 - abs(place[1] - row))
            if weight <= 0 or not (0 <= column < PIXELS and 0 <= row < PIXELS) or not last.shown[row, column]:
                continue
            if np.isnan(values[row, column]):
                return np.nan  # this twin does not know V there
            seen = last.p[row, column] - last.eye
            if abs(n @ (p - last.eye) / (n @ seen) - 1) < SAME_SURFACE:
                total, weights = total + weight * values[row, column], weights + weight
    return total / weights if weights > 0 else None


class Twins(unittest.TestCase):
    # V is stored in float32 in each frame: 2^-24 of it, for five frames.
    def test_reprojection(self):
        for name in ("plate", "two plates"):
            with tempfile.TemporaryDirectory() as folder:
                folder = pathlib.Path(folder)
                for frame in range(1, FRAMES + 1):
                    scene = {"format": "penumbra-scene/1", **scene_of(SCENES[name])}
                    scene["camera"] = {"eye": list(eye_of(frame)), "target": list(TARGET), "verticalFov": FOV}
                    (folder / f"scene.{frame:04d}.json").write_text(json.dumps(scene), encoding="utf-8")
                subprocess.run([PROGRAM, "-q", "render", folder / "scene.####.json", "--frames", f"1-{FRAMES}", "--size", f"{PIXELS}x{PIXELS}",
                                "--method", f"shadow-map:size={SIZE}:reproject=on", "-o", folder / "out.####.exr"], check=True)
                pictures = [Picture(folder / f"out.{frame:04d}.exr", frame) for frame in range(1, FRAMES + 1)]
            mixed, last = None, None
            for index, picture in enumerate(pictures):
                window, now = Window(SCENES[name], index), np.full((PIXELS, PIXELS), np.nan)
                found = judged = off = between = 0
                for y, x in zip(*np.nonzero(picture.shown)):
                    p, n = picture.p[y, x], picture.n[y, x]
                    asked = window.ask(in_frame(p)) if n[1] > 0 else None
                    if asked is None:
                        continue
                    now[y, x], share = asked
                    kept = before(last, mixed, p, n) if last else None
                    if kept is not None:
                        found += 1
                        now[y, x] = share * now[y, x] + (1 - share) * kept
                    if np.isnan(now[y, x]):
                        continue
                    judged += 1
                    between += 0.02 < now[y, x] < 0.98
                    off += abs(now[y, x] - picture.v[y, x]) > 1e-4
                print(f"reproject on {name}, frame {index + 1}: {judged} pixels, {found} seen before, {between} between, {off} off")
                self.assertGreater(judged, 300)
                self.assertLessEqual(off, 0.01 * judged)
                if index:
                    self.assertGreater(found, 0.7 * judged)
                    self.assertGreater(between, 10)
                else:
                    self.assertEqual((found, between), (0, 0))
                mixed, last = now, picture


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
