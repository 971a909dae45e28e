"""The add-on as Blender's render engine: animation, passes, what is refused and what is warned of. Run inside Blender:

    run.sh engine.py ADDON.zip PENUMBRA WORK
"""

import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402
import numpy  # noqa: E402

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
        """What the engine reports while it renders."""
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
        scene.render.use_border = True
        self.assertIn("render region", self.refusal(scene))
        scene = inside.fresh(scenes.area_square)
        bpy.data.cameras["Shot"].type = "PANO"
        self.assertIn("'Shot' is panoramic", self.refusal(scene))

    def test_the_world_is_warned_of_by_name(self):
        scene = inside.fresh(scenes.area_square)
        self.assertEqual(self.warnings(scene), [])
        scene.world = bpy.data.worlds.new("Sky")
        scene.world.color = (0.1, 0.1, 0.1)
        self.assertTrue(any("whose light is not rendered" in text for text in self.warnings(scene)))
        scene.render.use_motion_blur = bpy.data.cameras["Shot"].dof.use_dof = True
        self.assertEqual(len(self.warnings(scene)), 3)

    def test_the_programs_own_errors_come_back(self):
        scene = inside.fresh(scenes.area_square)
        scene.penumbra.method = "pcsss"
        self.assertIn("pcss", self.refusal(scene))
        scene = inside.fresh(scenes.area_square)
        bpy.data.objects["Key"].hide_render = True
        self.assertIn("no light", self.refusal(scene))
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
        scene.penumbra.pixel_samples = "16"  # four are all at the same distance
        filtered = inside.channels(scene, out("filtered.exr"))
        self.assertFalse(numpy.array_equal(filtered["Combined.A"], smooth["Combined.A"]))


if __name__ == "__main__":
    result = unittest.TextTestRunner(verbosity=2).run(unittest.defaultTestLoader.loadTestsFromTestCase(Engine))
    print(f"compare: {result.testsRun} tests, {len(result.failures) + len(result.errors)} failed", flush=True)
    if not result.wasSuccessful():
        raise SystemExit(1)
    inside.channels(inside.fresh(scenes.area_square), out("last.exr"))  # Blender exits with 1 if its last render failed
