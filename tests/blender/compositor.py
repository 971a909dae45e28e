# SPDX-License-Identifier: Apache-2.0
"""Tests that Blender's compositor can use a picture written by the program: layers of each light, depth, and objects
cut out by Cryptomatte. Run inside Blender:

    run.sh compositor.py ADDON.zip PENUMBRA WORK
"""

import os
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402
import numpy  # noqa: E402

import inside  # noqa: E402
import scenes  # noqa: E402


def out(name):
    return os.path.join(inside.OUT, name)


class Compositor(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """Makes a picture, with several view samples for each pixel, of a scene written by the add-on."""
        inside.fresh(scenes.many_lamps)
        from penumbra import export, frames, losses
        writer = export.SceneWriter(bpy.context.evaluated_depsgraph_get(), losses.Losses(), False)
        writer.write(out("scene.glb"), frames.Region(*[(inside.WIDTH, inside.HEIGHT)] * 2))
        cls.file = out("picture.exr")
        command = [inside.PENUMBRA, "render", out("scene.glb"), "--size", f"{inside.WIDTH}x{inside.HEIGHT}", "--pixel-samples", "9"]
        subprocess.run([*command, "--layers", "*,*_light,*_V", "-o", cls.file], check=True)
        subprocess.run([*command, "--compression", "dwaa", "-o", out("dwaa.exr")], check=True)
        cls.picture = inside.read(cls.file).channels

    def composite(self, node, prepare, socket, file=None):
        """Returns the output of the node, whose image is the picture, after compositing."""
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.preferences.addon_enable(module="penumbra")
        scene = bpy.context.scene
        render, image = scene.render, bpy.data.images.load(file or self.file)
        render.resolution_x, render.resolution_y, render.resolution_percentage = inside.WIDTH, inside.HEIGHT, 100
        settings = render.image_settings
        settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR_MULTILAYER", "32", "ZIP"
        scene.use_nodes, render.use_compositing = True, True
        tree = scene.node_tree
        tree.nodes.clear()
        source, end = tree.nodes.new(node), tree.nodes.new("CompositorNodeComposite")
        prepare(source, image)
        tree.links.new(source.outputs[socket], end.inputs["Image"])
        render.filepath = out("composited.exr")
        bpy.ops.render.render(write_still=True)
        found = inside.read(out("composited.exr")).channels
        return {letter: found[f"Composite.Combined.{letter}"] for letter in "RGB"}

    def matte(self, layer, name):
        def prepare(source, image):
            source.source, source.image = "IMAGE", image
            source.layer_name = layer
            source.matte_id = name
        return self.composite("CompositorNodeCryptomatteV2", prepare, "Matte")["R"]

    def image(self, socket, file=None):
        def prepare(source, image):
            source.image = image
        return self.composite("CompositorNodeImage", prepare, socket, file)

    def coverage(self, layer, name):
        """Returns the coverage by the specification: the sum over all ranks whose number is that of the name."""
        number = numpy.array([murmur3(name)], "<u4")
        exponent = int(number[0]) >> 23 & 255
        if exponent in (0, 255):
            number ^= numpy.array([1 << 23], "<u4")
        number = number.view("<f4")[0]
        ranks = [(f"{layer}{group:02}.{id}", f"{layer}{group:02}.{part}") for group in range(3) for id, part in ("RG", "BA")]
        return sum(numpy.where(self.picture[id] == number, self.picture[part], 0) for id, part in ranks)

    def test_objects_are_cut_out(self):
        for name in ("Block", "Floor"):
            wanted = self.coverage("CryptoObject", name)
            self.assertGreater(len(numpy.unique(wanted)), 5, "shares, not all or nothing")
            numpy.testing.assert_allclose(self.matte("CryptoObject", name), wanted, atol=1e-6, err_msg=name)

    def test_layers_of_lights(self):
        for light in ("Area", "Sun", "Panel"):
            found, seen = self.image(f"{light}_light"), self.image(f"{light}_V")
            for letter in "RGB":
                numpy.testing.assert_array_equal(found[letter], self.picture[f"{light}.{letter}"])
                numpy.testing.assert_array_equal(seen[letter], self.picture[f"{light}.V"])

    def test_depth_and_visibility(self):
        numpy.testing.assert_array_equal(self.image("Depth")["R"], self.picture["Z"])

    def test_triangles_are_numbers(self):
        numbers = self.image("triangle")["R"]
        numpy.testing.assert_array_equal(numbers, self.picture["triangle.X"])
        self.assertGreater(len(numpy.unique(numbers)), 5)

    def test_dwaa_of_two_parts(self):
        """Colours are in the first part, compressed with loss; positions are in the second part, unchanged."""
        numpy.testing.assert_allclose(self.image("Combined", out("dwaa.exr"))["R"], self.picture["R"], rtol=.05, atol=.02)
        numpy.testing.assert_array_equal(self.image("P", out("dwaa.exr"))["G"], self.picture["P.Y"])
        numpy.testing.assert_array_equal(self.image("triangle", out("dwaa.exr"))["R"], self.picture["triangle.X"])


def murmur3(name):
    """Returns MurmurHash3_x86_32 (Appleby) with seed 0."""
    data, mask = name.encode(), 0xffffffff
    mixed = lambda k: (lambda m: ((m << 15 | m >> 17) & mask) * 0x1b873593 & mask)(k * 0xcc9e2d51 & mask)  # noqa: E731
    value = 0
    for at in range(0, len(data) // 4 * 4, 4):
        value ^= mixed(int.from_bytes(data[at:at + 4], "little"))
        value = ((value << 13 | value >> 19) & mask) * 5 + 0xe6546b64 & mask
    value ^= mixed(int.from_bytes(data[len(data) // 4 * 4:], "little"))
    value ^= len(data)
    for shift, factor in ((16, 0x85ebca6b), (13, 0xc2b2ae35), (16, 1)):
        value = (value ^ value >> shift) * factor & mask
    return value


if __name__ == "__main__":
    inside.run_tests(Compositor)
