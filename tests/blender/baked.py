# SPDX-License-Identifier: Apache-2.0
"""Tests the Bake button: compares the baked image of an object with a picture of the same points. Run inside Blender:

    run.sh baked.py ADDON.zip PENUMBRA WORK
"""

import os
import sys
import unittest
from math import radians

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402
import numpy  # noqa: E402

import inside  # noqa: E402
import scenes  # noqa: E402

SIDE = 32
COLOR = (0.5, 0.25, 0.75)


def floor_seen_from_above():
    """Builds a floor of 4 by 4 that fills the picture, with an upright UV map, and a block above the camera, which
    therefore does not show it."""
    material = scenes.diffuse(COLOR, "Floor")
    data = scenes.quad("Floor", material, 2)
    for name, corners in (("Other", ((0, 0),) * 4), ("Map", ((0, 0), (1, 0), (1, 1), (0, 1)))):
        for loop, place in zip(data.uv_layers.new(name=name).data, corners):
            loop.uv = place
    data.uv_layers.active = data.uv_layers["Map"]
    floor = scenes.add("Floor", data)
    bpy.context.view_layer.objects.active = floor
    scenes.add("Block", scenes.cube("Block", half=0.6), (0.4, 0.2, 3), (20, 30, 40))
    camera = scenes.camera((0, 0, 2), (0, 0.0001, 0), type="ORTHO", ortho_scale=4)
    camera.rotation_euler = (0, 0, 0)
    scenes.lamp("AREA", (1, -1, 5), (radians(15), 0, 0), energy=300, shape="SQUARE", size=1.2, color=(1, 0.6, 0.3))
    scenes.lamp("SUN", (0, 0, 9), (35, 20, 0), name="Sun", energy=2, angle=radians(8))


def baked(scene, **settings):
    scene.penumbra.bake_size, scene.penumbra.bake_margin = SIDE, 0
    for key, value in settings.items():
        setattr(scene.penumbra, key, value)
    assert bpy.ops.penumbra.bake() == {"FINISHED"}
    image = bpy.data.images["Floor light"]
    values = numpy.empty(4 * SIDE * SIDE, numpy.float32)
    image.pixels.foreach_get(values)
    return values.reshape(SIDE, SIDE, 4)[::-1]


class Bake(unittest.TestCase):
    def test_texels_have_the_light_of_pixels(self):
        scene = inside.fresh(floor_seen_from_above)
        scene.render.resolution_x = scene.render.resolution_y = SIDE
        seen = inside.channels(scene, os.path.join(inside.OUT, "seen.exr"))
        light = baked(scene)
        self.assertGreater(float(numpy.ptp(seen["V Key.X"])), 0.9, "there is a shadow")
        for number, (letter, color) in enumerate(zip("RGB", COLOR)):
            numpy.testing.assert_allclose(light[..., number] * color, seen[f"Combined.{letter}"], rtol=2e-3, atol=1e-4)
        visible = baked(scene, bake_what="VISIBILITY")
        numpy.testing.assert_allclose(visible[..., 0], seen["V.X"], atol=1e-3)
        self.assertEqual(len([image for image in bpy.data.images if image.name.startswith("Floor light")]), 1)
        self.assertTrue(bpy.data.images["Floor light"].packed_file, "it is saved with the scene")

    def test_of_several_materials_all_are_baked(self):
        def parted():
            floor_seen_from_above()
            data = bpy.data.objects["Floor"].data
            corners = [(x, y, 0) for y in (-2, 0, 2) for x in (-2, 2)]
            data.clear_geometry()
            data.from_pydata(corners, [], [(0, 1, 3, 2), (2, 3, 5, 4)])
            for loop in data.uv_layers.new(name="Map").data:
                pass
            layer = data.uv_layers["Map"]
            for loop, corner in zip(data.loops, layer.data):
                x, y, _ = corners[loop.vertex_index]
                corner.uv = ((x + 2) / 4, (y + 2) / 4)
            data.uv_layers.active = layer
            data.materials.append(scenes.diffuse((0.1, 0.2, 0.3), "Second"))
            data.polygons[1].material_index = 1
        whole = baked(inside.fresh(floor_seen_from_above))
        numpy.testing.assert_allclose(baked(inside.fresh(parted)), whole, rtol=1e-3, atol=1e-4)

    def test_what_cannot_be_baked_is_said(self):
        scene = inside.fresh(floor_seen_from_above)
        layers = bpy.data.objects["Floor"].data.uv_layers
        while layers:
            layers.remove(layers[0])
        with self.assertRaises(RuntimeError) as caught:
            baked(scene)
        self.assertIn("'Floor' has no UV map", str(caught.exception))
        scene = inside.fresh(floor_seen_from_above)
        bpy.data.lights["Key"].spread = 1
        with self.assertRaises(RuntimeError) as caught:
            baked(scene)
        self.assertIn("'Key' is an area lamp whose light is spread", str(caught.exception))
        for hide, words in ((lambda floor: setattr(floor, "hide_render", True), "'Floor' is disabled in renders"),
                            (lambda floor: floor.hide_set(True), "'Floor' is hidden in the viewport")):
            scene = inside.fresh(floor_seen_from_above)
            hide(bpy.data.objects["Floor"])
            with self.assertRaises(RuntimeError) as caught:
                baked(scene)
            self.assertIn(words, str(caught.exception))

    def test_names_that_others_have(self):
        scene = inside.fresh(floor_seen_from_above)
        whole = baked(scene)
        scene = inside.fresh(floor_seen_from_above)
        scenes.add("baked", scenes.cube("baked", half=0.1), (0, 0, -3))
        own = bpy.data.images.new("Other light", 4, 4, float_buffer=True)
        own.name = "Floor light"
        scene.penumbra.bake_size = SIDE
        for _ in range(2):
            self.assertEqual(bpy.ops.penumbra.bake(), {"FINISHED"})
            self.assertEqual(tuple(own.size), (4, 4))
        own.name = "Own"
        made = [image for image in bpy.data.images if image.name.startswith("Floor light")]
        self.assertEqual(len(made), 1)
        made[0].name = "Floor light"
        numpy.testing.assert_allclose(baked(scene), whole, rtol=1e-4, atol=1e-5)

    def test_instances_of_what_renders_do_not_show(self):
        scene = inside.fresh(floor_seen_from_above)
        whole = baked(scene)
        scene = inside.fresh(floor_seen_from_above)
        instancer, parts = scenes.add("Instancer", None, (0, 0, 1)), bpy.data.collections.new("Parts")
        parts.objects.link(bpy.data.objects.new("Part", scenes.cube("Part", half=0.5)))
        instancer.instance_type, instancer.instance_collection, instancer.hide_render = "COLLECTION", parts, True
        numpy.testing.assert_array_equal(baked(scene), whole)


if __name__ == "__main__":
    inside.run_tests(Bake)
