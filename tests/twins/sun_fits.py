# SPDX-License-Identifier: Apache-2.0
"""Tests maps of a sun fitted to the camera's view against rays in numpy and exact areas: hard shadows of the sun's
middle are wrong at fewer pixels as texels shrink, one slice and one tile equal the window of the view, filters approach
the area, and slices are better than one window. Texels' places are not computed again here: they are the program's
own."""

import unittest

import numpy as np

import penumbra
from filtering import FLOOR, PIXELS, plate

TOWARD = np.array([0.31, -1.0, 0.17])  # direction in which the light travels
EYE, TARGET, FOV, ANGLE = [0.7, 0.55, 2.9], [-0.1, 0.2, 0.2], 50.0, 8.0
FITS = [{"fit": "view"}, {"fit": "view", "snap": "on"}, {"fit": "view", "body": "frustum"}, {"fit": "cascades"},
        {"fit": "cascades", "body": "frustum"}, {"fit": "tiles"}, {"fit": "tiles", "refine": "queried"}]
QUADS = [plate(0.9, (0.13, 0.35), (0.52, 0.43)), plate(1.3, (-0.9, -1.1), (0.45, 0.6))]


def picture(options, method="shadow-map", angle=ANGLE):
    floor = {"center": [0, 0, 0], "halfU": [FLOOR, 0, 0], "halfV": [0, 0, -FLOOR]}
    scene = {"camera": {"eye": EYE, "target": TARGET, "verticalFov": FOV},
             "meshes": [{"name": f"quad {k}", "quad": quad} for k, quad in enumerate([floor, *QUADS])],
             "lights": [{"name": "sun", "sun": {"direction": list(TOWARD), "angle": angle}}]}
    return penumbra.render(penumbra.Scene.from_dict(scene), size=(2 * PIXELS, 2 * PIXELS), method=method, options=options)


def floor_of(shown):
    return (shown.A == 1) & (np.abs(shown.P[..., 1]) < 1e-4) & (shown.N[..., 1] > 0)


def truth(shown, here):
    """Returns 1 where the ray to the sun's middle meets no plate."""
    p, lit = shown.P[here], np.ones(here.sum())
    for quad in QUADS:
        at = p - TOWARD / TOWARD[1] * (p[:, 1:2] - quad["center"][1])
        lit[(np.abs(at[:, 0] - quad["center"][0]) <= quad["halfU"][0]) & (np.abs(at[:, 2] - quad["center"][2]) <= quad["halfV"][2])] = 0
    return lit


def rms(difference):
    return float(np.sqrt(np.mean(np.square(difference))))


class SunFits(unittest.TestCase):
    def test_hard_shadows_come_to_those_of_rays(self):
        for fit in FITS:
            wrong = []
            for size in (16, 64, 256):
                found = picture(fit | {"size": str(size)})
                here = floor_of(found)
                wrong.append((found.V[here] != truth(found, here)).mean())
            print(fit, " ".join(f"{share:.4f}" for share in wrong), f"of {here.sum()}")
            self.assertGreater(here.sum(), 800)
            self.assertGreater((truth(found, here) == 0).sum(), 100)
            self.assertLess(wrong[2], 0.5 * wrong[0] + 1e-9, fit)
            self.assertLess(wrong[2], 0.01, fit)

    def test_one_slice_and_one_tile_are_one_window(self):
        for method in ("shadow-map", "vssm"):  # pcf leaves other margins
            view, slice_, tile = (picture(fit | {"size": "64"}, method)
                                  for fit in ({"fit": "view"}, {"fit": "cascades", "cascades": "1"}, {"fit": "tiles", "tiles": "1"}))
            here = floor_of(view)
            self.assertTrue((slice_.V == tile.V).all(), method)
            off = np.abs(slice_.V - view.V)[here]
            print(f"{method}: one slice against the window, {(off > 1e-3).sum()} of {here.sum()} pixels differ")
            self.assertLess((off > 1e-3).mean(), 0.005, method)  # float32 of two formulas for one window

    def test_filters_come_to_the_area(self):
        exact = picture({}, "exact")
        here = floor_of(exact)
        self.assertGreater(((exact.V > 0.05) & (exact.V < 0.95))[here].sum(), 50)
        for method in ("pcss", "vssm"):
            for fit in ({"fit": "view"}, {"fit": "cascades"}):
                errors = [rms((picture(fit | {"size": str(size)}, method).V - exact.V)[here]) for size in (16, 64, 256)]
                print(method, fit, " ".join(f"{error:.4f}" for error in errors))
                self.assertLess(errors[2], errors[0] / 2, (method, fit))
                self.assertLess(errors[2], 0.04, (method, fit))

    def test_slices_need_fewer_texels(self):
        counted = {fit: picture({"fit": fit, "size": "128", "aliasing": "count"}).stats["counters"] for fit in ("receivers", "view", "cascades", "tiles")}
        mean = {fit: c["aliasingThousandths"] / c["aliasingPixels"] for fit, c in counted.items()}
        print(mean)
        self.assertLess(mean["view"], mean["receivers"])
        self.assertLess(mean["cascades"], 0.8 * mean["view"])
        self.assertLess(mean["tiles"], mean["view"])
        half = picture({"fit": "view", "size": "65", "aliasing": "count"}).stats["counters"]  # 63 texels, not 126, within the border
        self.assertAlmostEqual(half["aliasingThousandths"] / half["aliasingPixels"] / mean["view"], 2, delta=0.01)

    def test_the_cameras_perspective_is_refused(self):
        for fit in ("lispsm", "tsm", "psm", "logpsm", "faces"):
            with self.assertRaisesRegex(Exception, f"not with fit={fit}"):
                picture({"fit": fit})


if __name__ == "__main__":
    unittest.main()
