# SPDX-License-Identifier: Apache-2.0
"""Tests the add-on as Blender's render engine: animation, passes, refusals and warnings. Run inside Blender:

    run.sh engine.py ADDON.zip PENUMBRA WORK
"""

import json
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402
import numpy  # noqa: E402
from mathutils import Matrix  # noqa: E402

import inside  # noqa: E402
import scenes  # noqa: E402


def out(name):
    return os.path.join(inside.OUT, name)


class Engine(unittest.TestCase):
    def refusal(self, scene):
        with self.assertRaises(RuntimeError) as caught:
            inside.channels(scene, out("refused.exr"))
        return str(caught.exception)

    def warnings(self, scene):
        """Returns what the engine reports while it renders."""
        from penumbra import engine
        said, own = [], engine.PenumbraEngine._say

        def listen(this, lost, lenient):
            said.extend([*lost.refused, *lost.mentioned])
            own(this, lost, lenient)
        engine.PenumbraEngine._say = listen
        try:
            inside.channels(scene, out("warned.exr"))
        finally:
            engine.PenumbraEngine._say = own
        return said

    def stats(self, scene):
        """Returns the program's --stats of a render."""
        from penumbra import serving
        own = serving.run
        serving.run = lambda command, *rest: own([*command, "--stats", out("stats.json")], *rest)
        try:
            inside.channels(scene, out("counted.exr"))
        finally:
            serving.run = own
        with open(out("stats.json")) as file:
            return json.load(file)

    def test_worlds_are_counted_by_default(self):
        def build(add_world):
            scenes.area_square()
            add_world()
        for add_world in (scenes.world, scenes.pictured_world):
            scene = inside.fresh(lambda: build(add_world))
            for wanted, quantity, samples in (("SAMPLED", "count", 256), ("EXACT", "area", 0)):
                if wanted == "SAMPLED":
                    self.assertEqual(scene.penumbra.world, wanted)
                scene.penumbra.world = wanted
                lights = {light["name"]: light for light in self.stats(scene)["lights"]}
                self.assertEqual((lights["Sky"]["quantity"], lights["Sky"]["lightSamples"]), (quantity, samples))
                self.assertEqual(lights["Key"]["quantity"], "area")
        self.assertEqual(self.warnings(scene), [])

    def test_a_forest_is_not_copied(self):
        stats = self.stats(inside.fresh(scenes.forest))
        self.assertGreater(stats["triangles"], 500_000)
        self.assertEqual([light["quantity"] for light in sorted(stats["lights"], key=lambda light: light["name"])], ["count", "area"])
        self.assertLess(stats["counters"]["trianglesOfLargestPart"], stats["triangles"] / 2)
        self.assertEqual(stats["counters"]["meshTreesBuilt"], 2)  # bark and leaves

    def test_an_animation_is_its_frames(self):
        scene = inside.fresh(scenes.animated)
        scene.frame_start, scene.frame_end = 6, 8
        scene.render.filepath = out("run-####")
        bpy.ops.render.render(animation=True)
        pictures = []
        for frame in (6, 7, 8):
            scene.frame_set(frame)
            alone = inside.channels(scene, out("alone.exr"))["Combined.R"]
            pictures.append(inside.read(out(f"run-{frame:04}.exr")).channels["ViewLayer.Combined.R"])
            numpy.testing.assert_array_equal(alone, pictures[-1])
        self.assertFalse(numpy.array_equal(pictures[0], pictures[1]))

    def test_passes(self):
        scene = inside.fresh(scenes.many_lamps)
        layer = scene.view_layers[0]
        layer.use_pass_z = layer.use_pass_normal = layer.use_pass_position = layer.use_pass_cryptomatte_object = True
        found = inside.channels(scene, out("passes.exr"))
        lights = [key[6:-2] for key in found if key.startswith("Light ") and key.endswith(".R")]
        self.assertEqual(sorted(lights), ["Area", "Disk", "Panel", "Point", "Sun"])
        emitter = found["V Panel.X"] * 0 + found["Combined.R"] - sum(found[f"Light {light}.R"] for light in lights)
        self.assertLess(float(numpy.abs(emitter).max()), 1e-5 * float(found["Combined.R"].max()))
        self.assertEqual(float(found["Normal.Z"][-1, 48]), 1, "Z is up: the floor before the camera")
        self.assertLess(abs(float(found["Position.Z"][-1, 48])), 1e-6)
        self.assertLess(float(found["Position.Y"][-1, 48]), 0)
        self.assertAlmostEqual(float(found["Depth.Z"][36, 48]), 8.3, delta=2)
        self.assertIn("CryptoObject00.R", found)
        manifests = [text for name, text in inside.read(out("passes.exr")).attributes.items() if name.endswith("/manifest")]
        self.assertTrue(any('"Block"' in text for text in manifests))
        scene.penumbra.light_passes = False
        self.assertFalse([key for key in inside.channels(scene, out("plain.exr")) if key.startswith("Light ")])

    def test_what_would_change_shadows_is_refused_by_name(self):
        scene = inside.fresh(scenes.area_square)
        bpy.data.objects["Block"].visible_camera = False
        self.assertIn("'Block' is hidden from the camera but not from light", self.refusal(scene))
        scene.penumbra.lenient = True
        self.assertIn("Combined.R", inside.channels(scene, out("lenient.exr")))
        scene = inside.fresh(scenes.area_square)
        bpy.data.lights["Key"].spread = 1
        self.assertIn("'Key' is an area lamp whose light is spread", self.refusal(scene))
        scene = inside.fresh(scenes.area_square)
        scene.collection.objects.link(bpy.data.objects.new("Fog", bpy.data.volumes.new("Fog")))
        self.assertIn("'Fog' is a volume", self.refusal(scene))

    def test_pictures_of_another_kind_are_refused(self):
        scene = inside.fresh(scenes.area_square)
        scene.render.pixel_aspect_x = 2
        self.assertIn("not square", self.refusal(scene))
        scene = inside.fresh(scenes.area_square)
        scene.render.use_multiview = True
        self.assertIn("stereoscopy", self.refusal(scene))
        scene = inside.fresh(scenes.area_square)
        bpy.data.cameras["Shot"].type = "PANO"
        self.assertIn("'Shot' is panoramic", self.refusal(scene))

    def test_sizes_are_as_blender_rounds_them(self):
        """At every percentage the size passed to the program is that of Blender's own result."""
        from penumbra import serving
        asked, own = [], serving.run

        def stop(command, *_):
            asked.append(tuple(int(side) for side in command[command.index("--size") + 1].split("x")))
            return None, ""
        serving.run = stop
        scene = inside.fresh(scenes.area_square)
        scene.render.image_settings.file_format, scene.render.filepath = "BMP", out("size")
        try:
            for whole in ((1280, 720), (1999, 1001), (720, 1283), (173, 131)):
                scene.render.resolution_x, scene.render.resolution_y = whole
                for percentage in range(1, 101):
                    scene.render.resolution_percentage = percentage
                    bpy.ops.render.render()
                    wanted = tuple(side * percentage // 100 for side in whole)
                    self.assertEqual(asked[-1], wanted, f"{whole} at {percentage} %")
            scene.render.resolution_x, scene.render.resolution_y = 1280, 720
            for percentage in (35, 70):  # Blender's own files also have this size
                scene.render.resolution_percentage = percentage
                bpy.ops.render.render(write_still=True)
                self.assertEqual(tuple(bpy.data.images.load(out("size.bmp")).size), asked[-1])
                bpy.data.images.remove(bpy.data.images["size.bmp"])
            self.assertEqual(asked[-1], (896, 504))
            scene.render.use_border = scene.render.use_crop_to_border = True
            for i in range(30):
                low, high = ((i * 0.618) % 1 * 0.5, 0.5 + (i * 0.414) % 1 * 0.5)
                scene.render.border_min_x, scene.render.border_max_x = low, high
                scene.render.border_min_y, scene.render.border_max_y = 1 - high, 1 - low
                bpy.ops.render.render(write_still=True)
                self.assertEqual(tuple(bpy.data.images.load(out("size.bmp")).size), asked[-1], f"region {low} to {high}")
                bpy.data.images.remove(bpy.data.images["size.bmp"])
        finally:
            serving.run = own

    def test_a_region_is_a_part_of_the_whole(self):
        """A region with and without cropping, for both kinds of lenses."""
        for build in (scenes.camera_shift, scenes.orthographic_shift):
            scene = inside.fresh(build)
            whole = inside.channels(scene, out("whole.exr"))
            render = scene.render
            render.use_border = True
            render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.2, 0.71, 0.33, 0.9
            found = inside.channels(scene, out("part.exr"))
            rows, columns = whole["Combined.R"].shape
            left, right, bottom, top = (int(share * side) for share, side in
                                        ((0.2, columns), (0.71, columns), (0.33, rows), (0.9, rows)))
            part = (slice(rows - top, rows - bottom), slice(left, right))
            for name in ("Combined.R", "V Key.X"):
                difference = numpy.abs(found[name] - whole[name])[part]
                self.assertLess(float(numpy.median(difference)), 1e-5, name)
                self.assertLess(float(numpy.mean(difference > 1e-3)), 0.02, name)  # outlines move by rounding
            outside = found["Combined.A"].copy()
            outside[part] = 0
            self.assertEqual(float(outside.max()), 0)
            render.use_crop_to_border = True
            cropped = inside.channels(scene, out("cropped.exr"))
            numpy.testing.assert_array_equal(cropped["Combined.R"], found["Combined.R"][part])

    def test_passes_that_there_are_not_are_said_once(self):
        scene = inside.fresh(scenes.area_square)
        layer = scene.view_layers[0]
        layer.use_pass_mist = layer.use_pass_uv = layer.use_pass_vector = layer.use_pass_object_index = True
        said = self.warnings(scene)
        self.assertEqual(said, ["asks for passes that Penumbra does not have (Mist, Vector, UV, Object Index)"])

    def test_long_names_keep_their_passes(self):
        scene = inside.fresh(scenes.area_square)
        names = ["L" * 60 + end for end in ("ab", "ac")]
        bpy.data.objects["Key"].name = names[0]
        scenes.lamp("POINT", (-2, -1, 3), name=names[1], energy=100, shadow_soft_size=0.1)
        found = inside.channels(scene, out("long.exr"))
        lights = sorted(key[:-2] for key in found if key.startswith("Light ") and key.endswith(".R"))
        self.assertEqual(len(lights), 2)
        total = sum(found[f"{light}.R"] for light in lights)
        numpy.testing.assert_allclose(total, found["Combined.R"], rtol=1e-5, atol=1e-6)

    def test_a_film_that_is_not_transparent_shows_the_world(self):
        scene = inside.fresh(scenes.area_square)
        clear = inside.channels(scene, out("clear.exr"))
        scene.render.film_transparent = False
        scene.world = bpy.data.worlds.new("Sky")
        scene.world.use_nodes = True
        sky = scene.world.node_tree.nodes["Background"]
        sky.inputs["Color"].default_value, sky.inputs["Strength"].default_value = (0.1, 0.2, 0.4, 1), 2
        scene.penumbra.world = "SEEN"
        found = inside.channels(scene, out("film.exr"))
        self.assertEqual((float(found["Combined.A"].min()), float(clear["Combined.A"].min())), (1, 0))
        nothing = clear["Combined.A"] == 0
        for letter, value in zip("RGB", (0.2, 0.4, 0.8)):
            numpy.testing.assert_allclose(found[f"Combined.{letter}"][nothing], value, rtol=1e-6)
            numpy.testing.assert_array_equal(found[f"Combined.{letter}"][~nothing], clear[f"Combined.{letter}"][~nothing])

    def test_a_film_that_is_not_transparent_shows_the_worlds_picture(self):
        """The background equals that of Cycles, whatever direction the camera looks in."""
        for turn, target in (((0, 0, 0), (0, 0, 0)), ((0.4, -0.3, 2.1), (3, 4, 9)), ((0, 0, 0.7), (-9, 0, 2))):
            def build():
                scenes.translucent()  # only the pane remains, black, and covers half of the picture
                for name in ("Floor", "Block", "Key"):
                    bpy.data.objects.remove(bpy.data.objects[name])
                pane = bpy.data.objects["Pane"]
                pane.data.materials[0].node_tree.nodes["Diffuse BSDF"].inputs["Color"].default_value = (0, 0, 0, 1)
                scenes.camera((0, 0, 0), target) if any(target) else scenes.camera((0, 0, 0.1), (0.03, 0.05, -1))
                bpy.context.view_layer.update()
                pane.matrix_world = bpy.context.scene.camera.matrix_world @ Matrix.Translation((-0.9, 0, -2))
                scenes.pictured_world(turn, interpolation="Closest")
            scene = inside.fresh(build)
            scene.render.film_transparent = False
            ours = inside.channels(scene, out("ours.exr"))
            scene.render.engine = "CYCLES"
            scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.max_bounces = 64, False, 0
            scene.cycles.transparent_max_bounces = 8
            scene.cycles.pixel_filter_type, scene.cycles.filter_width = "GAUSSIAN", 0.01
            theirs = inside.channels(scene, out("theirs.exr"))
            self.assertEqual(float(ours["Combined.A"].min()), 1)
            for letter in "RGB":
                off = numpy.abs(ours[f"Combined.{letter}"] - theirs[f"Combined.{letter}"])
                self.assertGreater(float(numpy.ptp(theirs[f"Combined.{letter}"])), 0.05)
                self.assertLess(float(numpy.mean(off > 1e-3)), 0.01, letter)  # pixels on a border between texels

    def test_worlds_that_are_not_evaluated_are_refused_by_name(self):
        def refused(change):
            scene = inside.fresh(scenes.area_square)
            change(*scenes.pictured_world(), lambda kind: next(
                node for node in scene.world.node_tree.nodes if node.type == kind))
            return self.refusal(scene)
        self.assertIn("moves its picture", refused(
            lambda tree, _, find: setattr(find("MAPPING").inputs["Location"], "default_value", (1, 0, 0))))
        self.assertIn("scales its picture unevenly", refused(
            lambda tree, _, find: setattr(find("MAPPING").inputs["Scale"], "default_value", (1, 2, 1))))
        self.assertIn("whose projection is not Equirectangular", refused(
            lambda tree, _, find: setattr(find("TEX_ENVIRONMENT"), "projection", "MIRROR_BALL")))
        self.assertIn("'Sky' is a world made by the node 'Noise Texture'", refused(
            lambda tree, background, find: tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs[1], background.inputs[0])))
        self.assertIn("a world with a volume", refused(
            lambda tree, _, find: tree.links.new(tree.nodes.new("ShaderNodeVolumeScatter").outputs[0], find("OUTPUT_WORLD").inputs[1])))

    def test_what_is_left_out_is_warned_of_by_name(self):
        scene = inside.fresh(scenes.area_square)
        self.assertEqual(self.warnings(scene), [])
        scene.world = bpy.data.worlds.new("Sky")
        scene.world.color = (0.1, 0.1, 0.1)
        self.assertEqual(self.warnings(scene), [])
        scene.penumbra.world = "SEEN"
        self.assertTrue(any("whose light is left out" in text for text in self.warnings(scene)))
        bpy.data.cameras["Shot"].dof.use_dof = True
        bpy.data.cameras["Shot"].dof.aperture_blades = 6
        self.assertEqual(len(self.warnings(scene)), 2)

    def test_the_programs_own_errors_come_back(self):
        scene = inside.fresh(scenes.area_square)
        scene.penumbra.method = "pcsss"
        self.assertIn("pcss", self.refusal(scene))
        scene = inside.fresh(scenes.area_square)
        bpy.data.objects["Key"].hide_render = True
        said = self.refusal(scene)
        self.assertIn("there is no light in the scene", said)
        scene = inside.fresh(scenes.area_square)
        for name in ("Floor", "Block"):
            bpy.data.objects[name].hide_render = True
        said += self.refusal(scene)
        self.assertIn("there is no surface in the scene", said)
        self.assertFalse([word for word in ("export", "glTF", "scene.glb", "/tmp") if word in said], said)
        scene = inside.fresh(scenes.area_square)
        bpy.context.preferences.addons["penumbra"].preferences.program = "/nowhere/penumbra"
        self.assertIn("/nowhere/penumbra", self.refusal(scene))

    def test_settings_reach_the_program(self):
        scene = inside.fresh(scenes.area_square)
        exact = inside.channels(scene, out("exact.exr"))["V Key.X"]
        scene.penumbra.exactness, scene.penumbra.light_samples, scene.penumbra.method = "SAMPLES", 4, "raytrace"
        counted = inside.channels(scene, out("counted.exr"))["V Key.X"]
        self.assertLessEqual(set(numpy.unique(counted).tolist()), {0, 0.25, 0.5, 0.75, 1})
        self.assertGreater(len(numpy.unique(exact)), 20)
        scene.penumbra.pixel_samples = "4"
        scene.view_layers[0].use_pass_cryptomatte_object = True
        smooth = inside.channels(scene, out("smooth.exr"))
        self.assertGreater(len(numpy.unique(smooth["Combined.A"])), 2)
        covered = sum(smooth[f"CryptoObject{group:02}.{letter}"] for group in range(3) for letter in "GA")
        numpy.testing.assert_allclose(covered, smooth["Combined.A"], atol=1e-6)
        self.assertGreater(len(numpy.unique(smooth["CryptoObject00.G"])), 3)
        scene.penumbra.pixel_filter = "BLACKMAN_HARRIS"
        scene.penumbra.pixel_samples = "16"  # four would all have the same distance from the centre
        filtered = inside.channels(scene, out("filtered.exr"))
        self.assertFalse(numpy.array_equal(filtered["Combined.A"], smooth["Combined.A"]))


if __name__ == "__main__":
    inside.run_tests(Engine)
    inside.channels(inside.fresh(scenes.area_square), out("last.exr"))  # Blender exits with 1 if its last render failed
