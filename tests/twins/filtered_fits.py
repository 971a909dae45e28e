# SPDX-License-Identifier: Apache-2.0
"""Tests `vssm` and `forward-map` on maps fitted to the camera's view: windows of one texel against the hard shadow of
the same maps, one slice and one tile against one window, and all fits against exact areas as texels shrink. Receivers
are the level floor and blockers are level plates, so that a bound is the share itself where no window contains two
plates, and so are exponentials."""

import unittest

import numpy as np

import penumbra
from filtering import FLOOR, PIXELS, SCENES, scene_of
from fits import EYE, FOV, TARGET

FITS = [{"fit": fit} for fit in ("receivers", "view", "cascades", "tiles", "lispsm", "tsm", "psm", "logpsm", "faces")]
FITS += [{"projection": projection} for projection in ("cube", "paraboloid")]
MOMENTS, FILTERS = ("vsm", "lvsm", "evsm", "esm", "csm"), ("sat", "mip", "n-buffer")


def picture(name, options, method="vssm"):
    scene = scene_of(SCENES[name])
    scene["camera"] = {"eye": list(EYE), "target": list(TARGET), "verticalFov": FOV}
    return penumbra.render(penumbra.Scene.from_dict(scene), size=(PIXELS, PIXELS), method=method, options=options)


def floor_of(shown):
    return (shown.A == 1) & (np.abs(shown.P[..., 1]) < 1e-4) & (shown.N[..., 1] > 0)


def rms(difference):
    return float(np.sqrt(np.mean(np.square(difference))))


class FilteredFits(unittest.TestCase):
    def test_a_window_of_one_texel_is_the_shadow_map(self):
        # Between the plates and the floor is at least a third of the range of heights: evsm gives 1 - exp(-40/3). The
        # least variance L leaves V = L / (L + distance^2): for vsm L is 2^-22, for four layers 16 times that, for evsm
        # (40 b)^2 with a bias b, here 0.05 texels of at most 1/40 each over a range of more than a half: 0.01. A series
        # is up to a third off (docs/vssm.md).
        bounds = {"vsm": 1e-4, "lvsm": 1e-3, "evsm": 0.02, "esm": 1e-3, "csm": 0.4}
        for fit in FITS:
            common = fit | {"size": "128", "bias": "0.05"}
            hard = picture("two plates", common, "shadow-map")
            here = floor_of(hard)
            self.assertGreater((hard.V[here] == 0).sum(), 20)
            for moments, prefilter in [(moments, "sat") for moments in MOMENTS] + [("vsm", "mip"), ("vsm", "n-buffer")]:
                found = picture("two plates", common | {"moments": moments, "filter": prefilter, "window": "1"})
                off = np.abs(found.V - hard.V)[here].max()
                self.assertLess(off, bounds[moments], (fit, moments, prefilter))

    def test_splats_of_one_texel_are_the_shadow_map(self):
        # The plates are far above the floor: both conditions of forward-map hold for a texel that shows the floor, none
        # for one that shows a plate. Near the floor's border a texel shows what is outside the floor.
        for fit in FITS:
            common = fit | {"size": "128"}
            hard, found = picture("two plates", common, "shadow-map"), picture("two plates", common | {"splat": "box"}, "forward-map")
            here = floor_of(hard) & (np.abs(hard.P[..., [0, 2]]).max(axis=-1) < 0.8 * FLOOR)
            self.assertGreater((hard.V[here] == 0).sum(), 20)
            self.assertTrue((found.V == hard.V)[here].all(), fit)

    def test_one_slice_and_one_tile_are_one_window(self):
        for moments in MOMENTS:
            for prefilter in FILTERS if moments in ("vsm", "csm") else ("sat",):
                common = {"size": "128", "moments": moments, "filter": prefilter}
                slice, tile = (picture("two plates", common | fit) for fit in ({"fit": "cascades", "cascades": "1"}, {"fit": "tiles", "tiles": "1"}))
                self.assertTrue((slice.V == tile.V).all(), (moments, prefilter))
                view = picture("two plates", common | {"fit": "view"})
                off = np.abs(slice.V - view.V)[floor_of(view)]
                print(f"{moments} {prefilter}: one slice against the window, most {off.max():.5f}")
                self.assertLess(off.max(), 1e-3, (moments, prefilter))

    def test_fits_approach_the_area(self):
        # With one flat blocker over a level floor, only the width of texels causes errors: each border of a window is
        # off by less than a texel, of a sixteenth of the width at 512.
        exact = picture("plate", {}, "exact")
        here = floor_of(exact)
        for fit in FITS:
            errors = [rms((picture("plate", fit | {"size": str(size)}).V - exact.V)[here]) for size in (32, 128, 512)]
            print(fit, " ".join(f"{error:.4f}" for error in errors))
            self.assertLess(errors[2], errors[0] / 3, fit)
            self.assertLess(errors[2], 0.01, fit)

    def test_one_slice_of_pcf_is_one_window_but_for_its_margin(self):
        # A slice leaves free, on every side, one texel more than pcf's taps reach from a receiver; a window leaves one,
        # and includes the casters there. With that many more texels a slice has the window's texels, if no caster is
        # outside the receivers: here the floor, which is wider than the part that pixels show, casts nothing.
        for name in ("plate", "two plates"):
            scene = scene_of(SCENES[name])
            scene["meshes"][0]["castsShadow"] = False
            scene["camera"] = {"eye": [0, 12, 0.01], "target": [0, 0, 0], "verticalFov": 60}
            for window in (1, 3, 7):
                render = lambda options: penumbra.render(penumbra.Scene.from_dict(scene), size=(64, 64), method="pcf",
                                                         options=options | {"window": str(window)})
                view = render({"fit": "view", "size": "128"})
                slices = [render({"fit": "cascades", "cascades": "1", "size": str(size)}) for size in (128 + 2 * (window // 2), 128)]
                here = floor_of(view)
                off, moved = (int((one.V != view.V)[here].sum()) for one in slices)
                print(f"pcf, window {window}, {name}: of {here.sum()} pixels {off} off with the window's texels, {moved} with as many texels")
                self.assertGreater(((view.V > 0) & (view.V < 1))[here].sum() if window > 1 else (view.V < 1)[here].sum(), 10)
                self.assertEqual(off, 0, (name, window))


if __name__ == "__main__":
    unittest.main()
