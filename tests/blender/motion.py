# SPDX-License-Identifier: Apache-2.0
"""Tests motion blur: a picture is the mean of the pictures of its moments, each of which Blender evaluates separately.
Run inside Blender:

    run.sh motion.py ADDON.zip PENUMBRA WORK
"""

import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402
import numpy  # noqa: E402

import inside  # noqa: E402
import scenes  # noqa: E402
from scenes import keyed  # noqa: E402

FRAME, COUNT, SHUTTER = 4, 3, 1.5


def out(name):
    return os.path.join(inside.OUT, name)


def lit_stage():
    scenes.stage()
    scenes.lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)


class Spy:
    """Records the program's command lines, and the sizes of its files, while pictures are made."""

    def __enter__(self):
        from penumbra import serving
        self.commands, self.sizes, self._own = [], [], serving.run

        def listen(command, *rest):
            self.commands.append(command)
            folder = os.path.dirname(command[2])
            self.sizes.append({name: os.path.getsize(os.path.join(folder, name)) for name in os.listdir(folder)})
            return self._own(command, *rest)
        serving.run = listen
        return self

    def __exit__(self, *_):
        from penumbra import serving
        serving.run = self._own

    def moments(self):
        """Returns the files of the last picture's moments."""
        command = self.commands[-1]
        return [os.path.basename(command[i + 1]) for i, word in enumerate(command) if word == "--moment"]


class Motion(unittest.TestCase):
    def build(self, add, still=lit_stage):
        def both():
            still()
            add()
            bpy.context.scene.frame_set(FRAME)
        scene = inside.fresh(both)
        scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, SHUTTER
        scene.penumbra.motion_samples = COUNT
        return scene

    def times(self, position="CENTER"):
        opens = FRAME - {"START": 0, "CENTER": SHUTTER / 2, "END": SHUTTER}[position]
        return [opens + SHUTTER * (i + 0.5) / COUNT for i in range(COUNT)]

    def mean(self, scene, times):
        """Returns the mean of the pictures at these times, and the picture of the frame itself."""
        scene.render.use_motion_blur, sums, pictures = False, {}, []
        for time in [*times, FRAME]:
            scene.frame_set(int(time // 1), subframe=time % 1)
            pictures.append(inside.channels(scene, out("one.exr")))
        scene.render.use_motion_blur = True
        for picture in pictures[:-1]:
            for name, values in picture.items():
                sums[name] = sums.get(name, 0) + values.astype(numpy.float64) / len(times)
        return sums, pictures[-1]

    def check(self, scene, position="CENTER", written=COUNT):
        """Compares a picture with the mean of its moments. `written`: number of different files of moments."""
        scene.cycles.motion_blur_position = position
        with Spy() as spy:
            found = inside.channels(scene, out("blur.exr"))
        self.assertEqual((scene.frame_current, scene.frame_subframe), (FRAME, 0))
        self.assertEqual(len(spy.moments()), COUNT)
        self.assertEqual(len(set(spy.moments())), written)
        mean, own = self.mean(scene, self.times(position))
        moved = 0
        for name, values in found.items():
            if name.startswith(("Combined", "V", "Light")):
                # A moment that is rendered separately has another float origin: a pixel at an edge may see another
                # surface.
                off = numpy.abs(values - mean[name]) > 1e-4 * max(float(mean[name].max()), 1)
                self.assertLess(int(off.sum()), 4, name)
                moved += int((numpy.abs(own[name] - mean[name]) > 1e-2).sum())
            elif name.startswith(("Depth", "Position", "Normal")):
                numpy.testing.assert_array_equal(values, own[name])
        self.assertGreater(moved, 100)
        return spy

    def test_things_that_move(self):
        def block():
            keyed(bpy.data.objects["Block"], "location", (-1, 0, 1), (1, 0.5, 1.4))
            keyed(bpy.data.objects["Block"], "rotation_euler", (0, 0, 0), (0.5, 0.3, 1))
        scene = self.build(block)
        for pass_ in ("use_pass_z", "use_pass_normal", "use_pass_position"):
            setattr(scene.view_layers[0], pass_, True)
        self.check(scene)
        for position in ("START", "END"):
            self.check(scene, position)

    def test_lamps_that_move_and_change(self):
        self.check(self.build(lambda: keyed(bpy.data.objects["Key"], "location", (-1, -1, 4), (2, 0, 3))))
        self.check(self.build(lambda: keyed(bpy.data.lights["Key"], "energy", 100, 900)), "START")
        self.check(self.build(lambda: keyed(bpy.data.lights["Key"], "size", 0.3, 2.5)), "START")

    def test_cameras_that_move_and_zoom(self):
        self.check(self.build(lambda: keyed(bpy.data.objects["Shot"], "location", (-1, -7, 5), (1, -6, 5))))
        self.check(self.build(lambda: keyed(bpy.data.cameras["Shot"], "lens", 30, 60)))

    def test_the_camera_is_that_of_the_frame(self):
        """A marker that switches to another camera at the next frame changes nothing while the shutter is open."""
        def cut():
            keyed(bpy.data.objects["Block"], "location", (-1, 0, 1), (1, 0, 1))
            first = bpy.context.scene.camera
            second = scenes.camera((3, -6, 4))
            for frame, camera in ((1, first), (FRAME, second)):
                bpy.context.scene.timeline_markers.new("Cut", frame=frame).camera = camera
        scene = self.build(cut)
        with_cut = inside.channels(scene, out("cut.exr"))
        scene.timeline_markers.clear()
        without = inside.channels(scene, out("uncut.exr"))
        numpy.testing.assert_array_equal(with_cut["Combined.R"], without["Combined.R"])

    def test_meshes_that_deform(self):
        def key():
            block = bpy.data.objects["Block"]
            block.shape_key_add(name="Basis")
            tall = block.shape_key_add(name="Tall")
            for point in tall.data:
                point.co *= 1 + point.co.z
            keyed(tall, "value", 0, 1)
            bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=0.5, location=(-1.5, 1, 0.5))
        sizes = self.check(self.build(key)).sizes[0]
        self.assertGreater(sizes["still.bin"], 50_000)  # the file has the sphere, which is written only once
        self.assertLess(sizes["moment-1.glb"], 6000)

        def bone():
            rig = scenes.add("Rig", bpy.data.armatures.new("Rig"))
            bpy.context.view_layer.objects.active = rig
            bpy.ops.object.mode_set(mode="EDIT")
            new = rig.data.edit_bones.new("Bone")
            new.head, new.tail = (0, 0, 0), (0, 0, 1)
            bpy.ops.object.mode_set(mode="OBJECT")
            block = bpy.data.objects["Block"]
            block.vertex_groups.new(name="Bone").add([0, 1, 2, 3], 1, "REPLACE")
            block.modifiers.new("Rig", "ARMATURE").object = rig
            keyed(rig.pose.bones["Bone"], "location", (0, 0, 0), (1, 0.5, 0))
        self.check(self.build(bone))

    def test_drivers_and_handlers_in_python(self):
        """Blender runs drivers and handlers on other threads while the add-on waits for a moment to be evaluated."""
        bpy.context.preferences.filepaths.use_scripts_auto_execute = True

        def drive():
            bpy.app.driver_namespace["away"] = lambda frame: 0.8 * (frame - FRAME)
            driver = bpy.data.objects["Block"].driver_add("location", 0).driver
            driver.type, driver.expression = "SCRIPTED", "away(frame)"
        scene, seen = self.build(drive), []

        def note(scene, _):
            seen.append(scene.frame_current + scene.frame_subframe)
        bpy.app.handlers.frame_change_post.append(note)
        try:
            inside.channels(scene, out("driven.exr"))
        finally:
            bpy.app.handlers.frame_change_post.remove(note)
        self.assertLessEqual(set(self.times()), set(seen))
        self.check(scene)

    def test_meshes_of_other_triangles_at_each_moment(self):
        def grow():
            modifier = bpy.data.objects["Block"].modifiers.new("Array", "ARRAY")
            modifier.relative_offset_displace = (1.1, 0, 0)
            for frame, count in ((FRAME - 1, 1), (FRAME, 2), (FRAME + 1, 3)):
                modifier.count = count
                modifier.keyframe_insert("count", frame=frame)
        self.check(self.build(grow), written=2)  # the mesh before the frame, and that of the frame

    def test_materials_and_worlds_that_change(self):
        def glow():
            material = scenes.emission((1, 0.5, 0.2), 5)
            scenes.add("Panel", scenes.quad("Panel", material), (-2, 1, 2), (0, 40, 0), (0.4, 0.4, 1))
            keyed(material.node_tree.nodes["Emission"].inputs["Strength"], "default_value", 1, 20)
        self.check(self.build(glow), "END")

        def turning():
            tree, _ = scenes.pictured_world()
            mapping = next(node for node in tree.nodes if node.type == "MAPPING")
            keyed(mapping.inputs["Rotation"], "default_value", (0, 0, 0), (0, 0, 3))
        self.check(self.build(turning))

        def brighter():
            keyed(scenes.pictured_world()[1].inputs["Strength"], "default_value", 0.5, 4)
        self.check(self.build(brighter), "START")

    def test_instances_that_move(self):
        def spread():
            source = bpy.data.collections.new("Source")
            for thing in (scenes.add("Cone", scenes.cube("Cone"), (0, 0, 0.3), scale=(0.3, 0.3, 0.6)),):
                bpy.context.scene.collection.objects.unlink(thing)
                source.objects.link(thing)
            for number in range(3):
                empty = scenes.add(f"Copy{number}", None, (number - 1, -1.5, 0))
                empty.instance_type, empty.instance_collection = "COLLECTION", source
            keyed(bpy.data.objects["Copy1"], "location", (0, -2, 0), (0, -1, 0.5))
        spy = self.check(self.build(spread))
        self.assertLess(spy.sizes[0]["moment-1.glb"], 6000)  # the file has only nodes

    def test_what_is_still_costs_nothing(self):
        """Nothing is keyed; keys that do not change anything; a world."""
        def held():
            keyed(bpy.data.objects["Block"], "location", (0.2, 0, 1), (0.2, 0, 1))
        for add in (lambda: None, held, scenes.pictured_world):
            scene = self.build(add)
            scene.view_layers[0].use_pass_cryptomatte_object = True
            with Spy() as spy:
                found = inside.channels(scene, out("still.exr"))
                self.assertEqual(spy.moments(), [])
                scene.render.use_motion_blur = False
                own = inside.channels(scene, out("own.exr"))
            self.assertEqual([sizes.keys() for sizes in spy.sizes], [sizes.keys() for sizes in reversed(spy.sizes)])
            for name, values in own.items():
                numpy.testing.assert_array_equal(found[name], values, name)

    def test_mattes_and_pixel_samples(self):
        """Shares of a matte sum to alpha; the view samples of a pixel, and those of a lens, are spread over all
        moments."""
        scene = self.build(lambda: keyed(bpy.data.objects["Block"], "location", (-1, 0, 1), (1, 0, 1)))
        scene.view_layers[0].use_pass_cryptomatte_object = True
        for samples, field in (("1", False), ("4", False), ("4", True)):
            scene.penumbra.pixel_samples = samples
            bpy.data.cameras["Shot"].dof.use_dof = field
            bpy.data.cameras["Shot"].dof.aperture_fstop = 0.1
            found = inside.channels(scene, out("matte.exr"))
            covered = sum(found[f"CryptoObject{group:02}.{letter}"] for group in range(3) for letter in "GA")
            numpy.testing.assert_allclose(covered, found["Combined.A"], atol=1e-6)
            if not field:
                mean, _ = self.mean(scene, self.times())
                self.assertLess(float(numpy.abs(mean["Combined.R"] - found["Combined.R"]).mean()), 1e-4)

    def test_view_layers_are_blurred_each(self):
        scene = self.build(lambda: keyed(bpy.data.objects["Block"], "location", (-1, 0, 1), (1, 0, 1)))
        other = scene.view_layers.new("Other")
        other.material_override = scenes.diffuse((0.1, 0.9, 0.1), "Green")
        with Spy() as spy:
            inside.channels(scene, out("layers.exr"))
        self.assertEqual([sum(word == "--moment" for word in command) for command in spy.commands], [COUNT, COUNT])
        self.assertEqual(scene.frame_current, FRAME)

    def test_settings_of_cycles_that_have_no_effect_are_said(self):
        from penumbra import engine
        said, own = [], engine.PenumbraEngine._say
        scene = self.build(lambda: None)
        bpy.data.objects["Block"].cycles.use_motion_blur = False
        scene.cycles.rolling_shutter_type = "TOP"
        engine.PenumbraEngine._say = lambda this, lost, lenient: said.extend((what, *names) for what, names in lost.mentioned.items())
        try:
            inside.channels(scene, out("said.exr"))
            self.assertEqual([names for _, *names in said], [["Block"], ["Scene"]])
            scene.render.use_motion_blur, said[:] = False, []
            inside.channels(scene, out("said.exr"))
            self.assertEqual(said, [])
        finally:
            engine.PenumbraEngine._say = own

    def test_cancelling_puts_the_frame_back(self):
        from penumbra import engine
        scene = self.build(lambda: keyed(bpy.data.objects["Block"], "location", (-1, 0, 1), (1, 0, 1)))
        asked, own = [], engine.moments.Moments.add

        def stop(this, *rest):
            asked.append(scene.frame_current + scene.frame_subframe)
            raise ValueError("stopped")
        engine.moments.Moments.add = stop
        try:
            with self.assertRaisesRegex(RuntimeError, "stopped"):
                inside.channels(scene, out("stopped.exr"))
        finally:
            engine.moments.Moments.add = own
        self.assertEqual(len(asked), 1)
        self.assertAlmostEqual(asked[0], self.times()[0])
        self.assertEqual((scene.frame_current, scene.frame_subframe), (FRAME, 0))

    def test_a_moment_that_cannot_be_rendered_is_named(self):
        scene = self.build(lambda: keyed(bpy.data.lights["Key"], "energy", 0, 9, frames=(FRAME - 0.4, FRAME)))
        with self.assertRaisesRegex(RuntimeError, "at 3.5, while the shutter is open: there is no light in the scene"):
            inside.channels(scene, out("refused.exr"))
        self.assertEqual((scene.frame_current, scene.frame_subframe), (FRAME, 0))

    def test_what_is_lost_at_a_moment_is_said_once(self):
        """A lamp moves into the floor while the shutter is open."""
        def sink():
            scenes.lamp("POINT", (-2, -1, 1), name="Bulb", energy=100, shadow_soft_size=0.1)
            keyed(bpy.data.objects["Bulb"], "location", (-2, -1, 1), (-2, -1, 0.05), frames=(FRAME, FRAME + 0.5))
        scene = self.build(sink)
        with self.assertRaisesRegex(RuntimeError, "'Bulb' is a lamp whose radius, 0.1, reaches 'Floor'") as caught:
            inside.channels(scene, out("refused.exr"))
        self.assertEqual(str(caught.exception).count("Bulb"), 1, str(caught.exception))


if __name__ == "__main__":
    inside.run_tests(Motion)
    inside.channels(inside.fresh(scenes.area_square), out("last.exr"))  # Blender exits with 1 if its last render failed
