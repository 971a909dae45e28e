#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the Blender add-on without Blender: the contents of the zip, that all of it compiles, and its parts that do not
need Blender: lamps and lenses, the exchange file, and the pictures that come back. Nodes: addon_nodes.py.

    addon.py SOURCE ADDON.zip PENUMBRA
"""

import math
import os
import subprocess
import sys
import tempfile
import unittest
import zipfile

SOURCE, ZIP, PENUMBRA = sys.argv[1:4]
sys.path.insert(0, ZIP)  # tests the code that users get
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import numpy  # noqa: E402

from penumbra import exr, frames, glb, lamps, losses, motion, passes, program, space  # noqa: E402
from stubs import box  # noqa: E402

IDENTITY = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


def at(x, y, z, scale=(1, 1, 1)):
    return [[scale[0], 0, 0, x], [0, scale[1], 0, y], [0, 0, scale[2], z], [0, 0, 0, 1]]



class Package(unittest.TestCase):
    def test_the_zip_holds_the_sources_and_they_compile(self):
        with zipfile.ZipFile(ZIP) as archive:
            names = sorted(archive.namelist())
            folder = os.path.join(SOURCE, "penumbra")
            self.assertEqual(names, sorted(f"penumbra/{name}" for name in os.listdir(folder) if name.endswith(".py")))
            for name in names:
                with open(os.path.join(SOURCE, name), "rb") as file:
                    text = file.read()
                self.assertEqual(archive.read(name), text, name)
                compile(text, name, "exec")


class Lenses(unittest.TestCase):
    def lens(self, width, height, **values):
        defaults = dict(type="PERSP", sensor_fit="AUTO", sensor_width=36, sensor_height=24, lens=18, shift_x=0, shift_y=0,
                        ortho_scale=6)
        return lamps.lens_of(box(**{**defaults, **values}), frames.Region((width, height), (width, height)))

    def test_angles_are_of_the_side_that_fits(self):
        self.assertAlmostEqual(self.lens(200, 100)["half_angle"], 0.5)
        self.assertAlmostEqual(self.lens(100, 200)["half_angle"], 1)
        self.assertAlmostEqual(self.lens(100, 200, sensor_fit="HORIZONTAL")["half_angle"], 2)
        self.assertAlmostEqual(self.lens(200, 100, sensor_fit="VERTICAL")["half_angle"], 24 / 36)
        self.assertAlmostEqual(self.lens(200, 100, type="ORTHO")["height"], 3)

    def test_shifts_are_in_heights(self):
        self.assertEqual(self.lens(200, 100, shift_x=0.25, shift_y=-0.5)["shift"], (0.5, -1))
        self.assertEqual(self.lens(100, 200, shift_x=0.25)["shift"], (0.25, 0))

    def test_cones(self):
        inner, outer = lamps.cone_of(box(spot_size=math.pi / 3, spot_blend=0.5))
        self.assertAlmostEqual(outer, math.pi / 6)
        self.assertAlmostEqual(math.cos(inner), (1 + math.cos(math.pi / 6)) / 2)
        inner, outer = lamps.cone_of(box(spot_size=1, spot_blend=0))
        self.assertAlmostEqual(math.cos(inner) - math.cos(outer), 0.001)


    def test_areas_of_sheared_lamps(self):
        """A unit square whose second side leans: its area is that of the parallelogram."""
        sides = ((2, 0, 0), (3, 4, 0))
        self.assertEqual(lamps.radiance_of_area((32, 16, 0), "rectangle", (1, 1), sides), (1, 0.5, 0))
        round_ = lamps.radiance_of_area((32, 16, 0), "ellipse", (1, 1), sides)
        self.assertAlmostEqual(round_[0], 4 / math.pi)
        self.assertFalse(lamps.is_sheared(at(0, 0, 0, (2, 3, 4))))
        self.assertTrue(lamps.is_sheared([[1, 0.1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]))

    def test_links_of_blender_4(self):
        none, some = (box(receiver_collection=one, blocker_collection=None) for one in (None, "Lit"))
        self.assertEqual([lamps.is_linked(thing) for thing in (box(), box(light_linking=none), box(light_linking=some))],
                         [False, False, True])

    def test_power_of_newer_blenders(self):
        self.assertEqual(lamps.power_of(box(energy=3, color=(1, 0.5, 0))), (3, 1.5, 0))
        self.assertEqual(lamps.power_of(box(energy=3, color=(1, 0.5, 0), exposure=2)), (12, 6, 0))

    def test_regions(self):
        """The middle of a region, computed from that of the whole, in heights of the region."""
        region = frames.Region((200, 100), (50, 20), 150, 10)
        self.assertEqual(region.shift_of_middle(), (75 / 20, -30 / 20))
        whole = self.lens(200, 100)
        lens = lamps.lens_of(box(type="PERSP", sensor_fit="AUTO", sensor_width=36, sensor_height=24, lens=18, shift_x=0.1,
                                 shift_y=0, ortho_scale=6), region)
        self.assertAlmostEqual(lens["half_angle"], whole["half_angle"] / 5)
        self.assertAlmostEqual(lens["shift"][0], (0.1 * 200 + 75) / 20)
        render = box(pixel_aspect_x=1, pixel_aspect_y=1, use_multiview=False, use_border=True, border_min_x=0.1,
                     border_max_x=0.7, border_min_y=0, border_max_y=1)
        self.assertEqual(frames.region_of(render, 100, 30), frames.Region((100, 30), (60, 30), 10, 0))


class Motion(unittest.TestCase):
    def test_moments_are_middles_of_equal_parts(self):
        for position, first in (("START", 7.125), ("CENTER", 6.625), ("END", 6.125)):
            found = motion.moments(7, 1, position, 4, [1] * 257)
            numpy.testing.assert_allclose(found, [first + i / 4 for i in range(4)], rtol=1e-14)
        self.assertEqual(motion.moments(7, 1, "CENTER", 1, [1] * 257), [7])
        numpy.testing.assert_allclose(motion.moments(0, 2, "START", 2, [0] * 257), [0.5, 1.5])  # never open: even spacing

    def test_a_shutter_that_opens_slowly(self):
        """The shutter is open by a share t at time t: by then t² of the exposure is done."""
        found = motion.moments(0, 1, "START", 8, numpy.linspace(0, 1, 257))
        numpy.testing.assert_allclose(found, numpy.sqrt((numpy.arange(8) + 0.5) / 8), atol=1 / 256 ** 2)

    def test_times_before_the_first_frame(self):
        self.assertEqual([motion.whole_and_rest(time) for time in (2.25, -0.25, -3)], [(2, 0.25), (-1, 0.75), (-3, 0)])

    def test_whose_position_counts(self):
        cycles, eevee = box(motion_blur_position="END"), box(motion_blur_position="START")
        scene = box(render=box(motion_blur_shutter=1), cycles=cycles, eevee=eevee)
        self.assertIs(motion.position_owner(scene), cycles)
        self.assertIs(motion.position_owner(box(render=box(), eevee=eevee)), eevee)
        self.assertIs(motion.position_owner(box(render=cycles, cycles=eevee)), cycles)  # since Blender 4.2
        self.assertIsNone(motion.position_owner(box(render=box())))

    def test_another_moment_is_a_file_of_its_own(self):
        """The second file has an object that moved, one that exists only at that moment, and one whose mesh stays in
        the first file: the picture is that of one file with all of them."""
        settings = box(method="", exactness=program.EXACT, light_samples=1, pixel_samples=1, pixel_filter=program.BOX, filter_width=1.5,
                       light_cutoff=0, shading_normals=False, lenient=False, device="", light_passes=True)

        def square(file, name, height, half):
            rows = numpy.array([(-half, -half, height), (half, -half, height), (half, half, height), (-half, half, height)], "<f4")
            place = file.accessor(rows.tobytes(), "VEC3", bounds=(rows.min(axis=0), rows.max(axis=0)))
            indices = file.accessor(numpy.array((0, 1, 2, 0, 2, 3), "<u4").tobytes(), "SCALAR", glb.UNSIGNED)
            return file.mesh(name, [{"attributes": {"POSITION": place}, "indices": indices, "material": file.material(name, (0.7, 0.6, 0.5))}])

        def place(file, floor, block, x):
            file.node("Floor", IDENTITY, mesh=floor)
            file.node("Block", at(x, 0, 0), mesh=block)
            file.area_lamp("Key", at(0, 0, 4), "rectangle", (1, 1), (5, 5, 5))
            file.camera("Shot", at(0, 0, 6), 2, (0, 0), half_angle=0.4)
        with tempfile.TemporaryDirectory() as folder:
            first, whole = glb.Glb(), glb.Glb()
            place(first, *(numbers := (square(first, "Floor", 0, 3), square(first, "Block", 1, 0.5))), 0.5)
            second = first.without_nodes("still.bin")
            self.assertNotEqual(first.placed(), second.placed())
            place(second, *numbers, -0.75)
            second.node("Roof", IDENTITY, mesh=square(second, "Roof", 2, 0.25))
            place(whole, square(whole, "Floor", 0, 3), square(whole, "Block", 1, 0.5), -0.75)
            whole.node("Roof", IDENTITY, mesh=square(whole, "Roof", 2, 0.25))
            same = first.without_nodes("still.bin")
            place(same, *numbers, 0.5)
            self.assertEqual(first.placed(), same.placed())
            for name, data in (("still.bin", first.binary()), ("first.glb", first.encoded()), ("second.glb", second.encoded()),
                               ("same.glb", same.encoded()), ("whole.glb", whole.encoded())):
                with open(os.path.join(folder, name), "wb") as file:
                    file.write(data)

            def picture(name, *moments):
                out = os.path.join(folder, "o.exr")
                command = program.arguments(PENUMBRA, os.path.join(folder, name), out, (40, 20), settings,
                                            [os.path.join(folder, moment) for moment in moments])
                code, printed = program.run(command, lambda: False)
                self.assertEqual(code, 0, printed)
                with open(out, "rb") as file:
                    return exr.read(file.read()).channels
            one, other = picture("first.glb"), picture("whole.glb")
            for name, values in picture("second.glb").items():
                numpy.testing.assert_array_equal(values, other[name], name)
            for name, values in picture("same.glb").items():
                numpy.testing.assert_array_equal(values, one[name], name)
            mean = picture("first.glb", "second.glb", "same.glb")
            self.assertGreater(float(numpy.abs(one["V"] - other["V"]).max()), 0.5)
            for name in ("R", "V", "Key.V"):
                numpy.testing.assert_allclose(mean[name], (one[name] + other[name]) / 2, atol=2e-6)

    def test_what_is_lost_a_moment_later_is_news_once(self):
        all, later = losses.Losses(), losses.Losses()
        all.refuse("is 0.5 away", "A")
        later.refuse("is 0.25 away", "A")
        later.refuse("is 0.25 away", "B")
        later.mention("is metallic", "A")
        news = all.take_news(later)
        self.assertEqual((news.refused, news.mentioned), ({"is 0.25 away": {"B": None}}, {"is metallic": {"A": None}}))
        self.assertEqual(losses.sentences(all.take_news(later).refused), [])


class Space(unittest.TestCase):
    def placed(self, *triangles):
        points = numpy.array(triangles, numpy.float32).reshape(-1, 3)
        return space.Placed("It", points, numpy.arange(len(points), dtype=numpy.int32), numpy.eye(4))

    def test_distances(self):
        """Distances to points inside, on an edge and at a corner, and those of a degenerate triangle."""
        triangle = numpy.array([[(0, 0, 0), (4, 0, 0), (0, 4, 0)], [(0, 0, 1), (2, 0, 1), (4, 0, 1)]], float)
        for point, wanted in (((1, 1, 3), (3, 5 ** 0.5)), ((1, -2, 0), (2, 5 ** 0.5)), ((-3, -4, 0), (5, 26 ** 0.5))):
            numpy.testing.assert_allclose(space.distances(triangle, numpy.array(point, float)), wanted)
        far, near = self.placed((9, 0, 0), (9, 1, 0), (9, 0, 1)), self.placed((0, 0, 3), (1, 0, 3), (0, 1, 3))
        self.assertEqual(space.Surfaces([far, near]).nearest_to((0, 0, 0), 5), (near, 3))
        self.assertEqual(space.Surfaces([near, far]).nearest_to((9, 0.2, 0.2), 5), (far, 0))
        self.assertEqual(space.Surfaces([far, near]).nearest_to((0, 0, -3), 5), (None, 5))
        self.assertEqual(space.Surfaces([]).nearest_to((0, 0, 0), 5), (None, 5))

    def test_a_camera_is_sharp_where_cycles_has_it(self):
        """A lens of 50 mm at f/2 has a radius of 12.5 mm; only the distance of the object in focus along the view axis
        counts."""
        def camera(type="PERSP", **field):
            defaults = dict(use_dof=True, focus_object=None, focus_distance=3.0, aperture_fstop=2.0, aperture_blades=0,
                            aperture_ratio=1.0)
            return box(data=box(type=type, lens=50.0, dof=box(**{**defaults, **field})))
        self.assertEqual(lamps.focus_of(camera(), IDENTITY), (0.0125, 3.0))
        self.assertEqual(lamps.focus_of(camera("ORTHO"), IDENTITY), (0.25, 3.0))
        self.assertIsNone(lamps.focus_of(camera(use_dof=False), IDENTITY))
        target = box(matrix_world=[[1, 0, 0, 5], [0, 1, 0, -2], [0, 0, 1, -4], [0, 0, 0, 1]])
        self.assertEqual(lamps.focus_of(camera(focus_object=target), IDENTITY), (0.0125, 4.0))
        self.assertFalse(lamps.has_blades(camera().data.dof))
        self.assertTrue(lamps.has_blades(camera(aperture_blades=6).data.dof) and lamps.has_blades(camera(aperture_ratio=2).data.dof))
        file = glb.Glb()
        file.camera("Shot", IDENTITY, 1.5, (0, 0), half_angle=0.5, focus=(0.0125, 3.0))
        self.assertEqual(file._document["cameras"][0]["extras"], {"aperture": 0.0125, "focusDistance": 3.0})

    def test_what_a_camera_sees(self):
        """A camera at the origin looks along −Z and sees half its distance to each side. A triangle around the whole
        view counts, one beside the view does not."""
        for lens in (dict(half_angle=0.5), dict(height=4)):
            frustum = space.Frustum(IDENTITY, 1, (0, 0), **lens)
            self.assertTrue(frustum.sees(self.placed((-99, -99, -2), (99, -99, -2), (0, 99, -2)), 1, 3))
            self.assertFalse(frustum.sees(self.placed((-99, -99, -2), (99, -99, -2), (0, 99, -2)), 2.5, 3))
            self.assertFalse(frustum.sees(self.placed((-99, -99, 2), (99, -99, 2), (0, 99, 2)), 1, 3))
            self.assertFalse(frustum.sees(self.placed((2.5, -9, -2), (9, 0, -2), (2.5, 9, -2)), 1, 3))
            # Outside the picture where the floor is near, inside it where it is far.
            floor = self.placed((-9, -1.5, 1), (9, -1.5, 1), (0, -1.5, -99))
            self.assertEqual((frustum.sees(floor, 0, 2.9), frustum.sees(floor, 0, 3.1)),
                             (False, True) if "half_angle" in lens else (True, True))
        moved = space.Frustum(IDENTITY, 1, (1, 0), half_angle=0.5)
        self.assertTrue(moved.sees(self.placed((2, 0, -2), (2.2, 0, -2), (2, 0.2, -2)), 1, 3))


class Pictures(unittest.TestCase):
    """A scene written by the add-on's code, rendered, and read back by that code."""

    @classmethod
    def setUpClass(cls):
        file = glb.Glb()
        corners = numpy.array([(-4, -4, 0), (4, -4, 0), (4, 4, 0), (-4, 4, 0)], "<f4")
        at_board = numpy.array([(1, -4, 1), (4, -4, 1), (4, 4, 1), (1, 4, 1)], "<f4")
        for name, positions in (("Floor", corners), ("Board", at_board)):
            attributes = {"POSITION": file.accessor(positions.tobytes(), "VEC3", bounds=(positions.min(0), positions.max(0)))}
            indices = file.accessor(numpy.array([0, 1, 2, 0, 2, 3], "<u4").tobytes(), "SCALAR", glb.UNSIGNED)
            material = file.material(name, (0.5, 0.25, 1))
            file.node(name, IDENTITY, mesh=file.mesh(name, [{"attributes": attributes, "indices": indices, "material": material}]))
        lost = losses.Losses()
        lamp = dict(energy=100.0, color=(1, 0.5, 0.25), use_nodes=False, node_tree=None, use_shadow=True)
        area = dict(type="AREA", shape="SQUARE", size=0.02, size_y=9, spread=math.pi)
        lamps.write_lamp(box(**lamp, **area), "Key", at(0, 0, 2), file, lost)
        lamps.write_lamp(box(**lamp, **{**area, "shape": "ELLIPSE", "size_y": 0.04}), "Oval", at(0, 0, 2, (1, 0.5, 1)), file, lost)
        point = dict(shadow_soft_size=0.01, cycles=box(is_portal=False, cast_shadow=False))
        lamps.write_lamp(box(**lamp, **point, type="POINT"), "Point", at(0, 0, 2), file, lost)
        spot = dict(shadow_soft_size=0.001, spot_size=math.pi / 2, spot_blend=0.5, type="SPOT")
        lamps.write_lamp(box(**lamp, **spot), "Spot", at(0, 0, 2), file, lost)
        lamps.write_lamp(box(**{**lamp, "energy": 2.0}, type="SUN", angle=0.0), "Sun", at(0, 0, 2), file, lost)
        lamps.write_lamp(box(**{**lamp, "energy": 0.0}, type="SUN", angle=0.0), "Off", at(0, 0, 2), file, lost)
        # Straight down onto the floor, x from −2 to 2 and y from −1 to 1 before the shift: half a unit to the right, a
        # tenth up.
        file.camera("Shot", at(0, 0, 0.5), 2, (0.25, 0.05), height=2)
        assert not lost.refused and not lost.mentioned
        cls.folder = tempfile.TemporaryDirectory()
        scene, picture = (os.path.join(cls.folder.name, name) for name in ("scene.glb", "picture.exr"))
        with open(scene, "wb") as out:
            out.write(file.encoded())
        settings = box(method="", exactness=program.EXACT, light_samples=1, pixel_samples=1, pixel_filter=program.BOX, filter_width=1.5,
                       light_cutoff=0, shading_normals=False, lenient=False, device="", light_passes=True)
        command = program.arguments(PENUMBRA, scene, picture, (40, 20), settings)
        code, cls.printed = program.run(command, lambda: False)
        assert code == 0, cls.printed
        with open(picture, "rb") as file:
            cls.picture = exr.read(file.read())

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def light(self, name):
        """Returns x, y and the red light that each pixel of the floor reflects of one light."""
        channels = self.picture.channels
        return channels["P.X"], -channels["P.Z"], channels[f"{name}.R"]

    def expect(self, name, formula):
        x, y, red = self.light(name)
        for i in ((0, 0), (10, 10), (19, 20), (7, 13)):
            wanted = 0.5 / math.pi * formula(float(x[i]), float(y[i]))
            self.assertAlmostEqual(red[i] / wanted, 1, delta=2e-4, msg=f"{name} at {x[i]}, {y[i]}")

    def test_the_program_says_nothing_else(self):
        warnings, error = program.messages(self.printed)
        self.assertEqual((warnings, error), ([], None))

    def test_a_shifted_lens(self):
        x, y, _ = self.light("Key")
        self.assertAlmostEqual(float(x[10, 20]), 0.5 + 0.05, places=5)
        self.assertAlmostEqual(float(y[10, 20]), 0.1 - 0.05, places=5)

    def test_lamps_are_as_bright_as_in_cycles(self):
        """Lamps are far enough away to count as points: intensity times cosine over distance squared; areas have a
        second cosine."""
        def area(x, y):
            d2 = x * x + y * y + 4
            return 25 * 4 / d2 / d2
        self.expect("Key", area)
        self.expect("Oval", area)
        self.expect("Point", lambda x, y: 100 / (4 * math.pi) * 2 / (x * x + y * y + 4) ** 1.5)
        self.expect("Sun", lambda x, y: 2.0)

        def spot(x, y):
            d2 = x * x + y * y + 4
            cosine, outer = 2 / math.sqrt(d2), math.sqrt(0.5)
            t = min(max((cosine - outer) / ((1 - outer) / 2), 0), 1)
            return 100 / (4 * math.pi) * 2 / d2 ** 1.5 * cosine * t * t * (3 - 2 * t)
        self.expect("Spot", spot)

    def test_a_lamp_without_shadow_has_none(self):
        """The pixels under the board, which is above the camera, are lit."""
        x, _, _ = self.light("Key")
        under = x > 2.05  # as seen from (0, 0, 2), the board begins at x = 2 on the floor
        self.assertTrue(under.any())
        self.assertEqual(self.picture.channels["Key.V"][under].max(), 0)
        self.assertEqual(self.picture.channels["Point.V"].min(), 1)
        self.assertEqual(self.picture.channels["Sun.V"][x > 1.05].max(), 0)

    def test_passes(self):
        found = passes.Names("ViewLayer").channels(self.picture)
        lights = ["Key", "Oval", "Point", "Spot", "Sun"]
        self.assertEqual(passes.layers(self.picture), lights)
        self.assertAlmostEqual(float(found["Position.X"][19, 0]), -1.5 + 0.05, places=5)
        self.assertAlmostEqual(float(found["Position.Y"][19, 0]), -0.9 + 0.05, places=5)
        self.assertEqual([float(found[f"Normal.{axis}"][0, 0]) for axis in "XYZ"], [0, 0, 1])
        total = sum(found[f"Light {light}.R"] for light in lights)
        numpy.testing.assert_allclose(total, found["Combined.R"], rtol=1e-5, atol=1e-7)
        names = {f"{name}.{letter}" for name, letters, _ in passes.Names("ViewLayer").own_passes(lights) for letter in letters}
        self.assertLessEqual(names, found.keys())

    def test_passes_are_written_as_they_are(self):
        again = exr.read(exr.encoded(passes.Names("ViewLayer").channels(self.picture)))
        for name, values in passes.Names("ViewLayer").channels(self.picture).items():
            numpy.testing.assert_array_equal(again.channels[name], values.astype("<f4"), name)


class Programs(unittest.TestCase):
    def settings(self, **values):
        defaults = dict(method="", exactness=program.EXACT, light_samples=64, pixel_samples="1", pixel_filter=program.BOX,
                        filter_width=1.5, light_cutoff=0, shading_normals=False, lenient=False, device="", light_passes=True)
        return box(**{**defaults, **values})

    def test_arguments(self):
        plain = program.arguments("p", "s.glb", "o.exr", (3, 2), self.settings())
        self.assertEqual(plain, ["p", "render", "s.glb", "-o", "o.exr", "--no-studio", "--size", "3x2", "--normals", "geometric",
                                 "--compression", "none"])
        much = program.arguments("p", "s", "o", (3, 2), self.settings(
            method="raytrace", exactness=program.SAMPLES, pixel_samples="16", light_cutoff=0.0010000000475, shading_normals=True, lenient=True, device="cpu"))
        self.assertEqual(much[8:], ["--method", "raytrace", "--light-samples", "64", "--pixel-samples", "16", "--light-cutoff", "0.001", "--normals",
                                    "shading", "--lenient", "--device", "cpu", "--compression", "none"])
        filtered = program.arguments("p", "s", "o", (3, 2), self.settings(
            pixel_samples="4", pixel_filter=program.BLACKMAN_HARRIS, filter_width=1.6000000238))
        self.assertEqual(filtered[8:], ["--pixel-samples", "4", "--pixel-filter", "blackman-harris", "--filter-width", "1.6",
                                        "--normals", "geometric", "--compression", "none"])

        baking = self.settings(bake_size=64, bake_margin=3, lenient=True, method="exact")
        self.assertEqual(program.bake_arguments("p", "s.glb", "o.exr", "It", baking), [
            "p", "bake", "s.glb", "-o", "o.exr", "--no-studio", "--mesh", "It", "--uv", "1", "--size", "64", "--margin", "3",
            "--method", "exact", "--normals", "geometric", "--lenient"])
        alone = program.arguments("p", "s", "o", (3, 2), self.settings(light_passes=False))
        self.assertEqual(alone[10:], ["--layers", "beauty,V,Z,P,N,Crypto*", "--compression", "none"])

        moved = program.arguments("p", "s", "o", (3, 2), self.settings(), ["a.glb", "b.glb"])
        self.assertEqual(moved[8:], ["--moment", "a.glb", "--moment", "b.glb", "--normals", "geometric", "--compression", "none"])

    def test_matte_groups(self):
        self.assertEqual(passes.matte_groups("CryptoObject", "1"), ["CryptoObject00"])
        self.assertEqual(passes.matte_groups("CryptoObject", "4"), ["CryptoObject00", "CryptoObject01", "CryptoObject02"])

    def test_messages(self):
        text = "penumbra: warning: a: b\npenumbra: something\npenumbra: error: c\n"
        self.assertEqual(program.messages(text), (["a: b"], "c"))
        text = "".join(f"penumbra: warning: /tmp/x/moment-{i}.glb: 'Block' is metallic\n" for i in (1, 2))
        self.assertEqual(program.messages(text, "/tmp/x/scene.glb", "/tmp/x/moment-1.glb", "/tmp/x/moment-2.glb"), (["'Block' is metallic"], None))
        text = "penumbra: error: /tmp/x/scene.glb: 'Pane' lets light through. Shadows would be wrong: --lenient renders it nevertheless, with a warning"
        self.assertEqual(program.messages(text, "/tmp/x/scene.glb")[1],
                         "'Pane' lets light through. Shadows would be wrong; 'Lenient' renders the scene nevertheless")

    def test_workspaces_go(self):
        with program.Workspace() as workspace:
            self.assertTrue(os.path.isdir(workspace.folder))
            code, printed = program.run(["/bin/sh", "-c", "echo one >&2; echo two >&2; exit 3"], lambda: False, workspace)
            self.assertEqual((code, printed), (3, "one\ntwo\n"))
        self.assertFalse(os.path.exists(workspace.folder))
        self.assertEqual(program.run(["/bin/sleep", "60"], lambda: True), (None, ""))

    def test_an_error_comes_back(self):
        code, printed = program.run([PENUMBRA, "render", "none.glb", "-o", "none.exr"], lambda: False)
        self.assertEqual(code, 3)
        self.assertIn("none.glb", program.messages(printed)[1])

    def test_a_program_is_found_or_named(self):
        self.assertEqual(program.find(PENUMBRA), PENUMBRA)
        with self.assertRaises(FileNotFoundError):
            program.find("/nowhere/penumbra")


class Exr(unittest.TestCase):
    def test_names_of_layers(self):
        self.assertEqual(passes.layer_of("Plane.001/a"), "Plane_001_a")
        self.assertEqual(len(passes.layer_of("\u00fc" * 40).encode()), 44)

    def test_long_names_are_shortened_and_stay_apart(self):
        names = passes.Names("ViewLayer")
        lights = ["\u00e9" * 60, "\u00e9" * 61, "a" * 60]
        found = [name for name, _, _ in names.own_passes(lights)]
        self.assertEqual(len(set(found)), 7)
        self.assertLessEqual(max(len(f"ViewLayer.{name}.X".encode()) for name in found), 63)
        self.assertEqual(len(names.shortened), 6)
        self.assertEqual([name for name, _, _ in names.own_passes(lights)], found)
        self.assertEqual(passes.Names("ViewLayer").own_passes(["Key"])[1][0], "V Key")

    def test_refuses_what_it_cannot_read(self):
        with self.assertRaises(ValueError):
            exr.read(b"P6 this is none")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
