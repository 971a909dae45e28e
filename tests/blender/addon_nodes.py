#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests how the add-on converts materials' nodes, without Blender: surfaces, evaluated colours, images, and refusals.

    addon_nodes.py ADDON.zip
"""

import math
import os
import sys
import unittest
import zlib

ZIP = sys.argv[1]
sys.path.insert(0, ZIP)  # tests the code that users get
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import numpy  # noqa: E402

from penumbra import graph, losses, materials, sky, spectrum, texels  # noqa: E402
from stubs import Inputs, Socket, box, image, image_node, node  # noqa: E402


def principled(**values):
    defaults = dict(Base_Color=(0.8, 0.8, 0.8, 1), Emission=(0, 0, 0, 1), Emission_Strength=1.0, Alpha=1.0,
                    Transmission=0.0, Metallic=0.0, Subsurface=0.0, Normal=None)
    return node("BSDF_PRINCIPLED", **{**defaults, **values})


def surface_of(shader):
    output = node("OUTPUT_MATERIAL", Surface=None, Volume=None, Displacement=None)
    if shader is not None:
        output.inputs["Surface"].link(shader)
    return box(use_nodes=True, node_tree=box(get_output_node=lambda _: output))


def look(shader):
    lost = losses.Losses()
    return materials.Reader(lost, "M").look(surface_of(shader)), lost


class Materials(unittest.TestCase):
    def test_surfaces(self):
        found, lost = look(principled(Base_Color=(0.5, 0.25, 1, 1), Emission=(1, 0.5, 0, 1), Emission_Strength=6.0, Alpha=0.5))
        self.assertEqual((found.color, found.radiance, found.alpha), ((0.5, 0.25, 1), (6, 3, 0), 0.5))
        self.assertFalse(lost.refused or lost.mentioned)
        self.assertEqual(look(node("EMISSION", Color=(1, 0.5, 0, 1), Strength=4.0))[0].radiance, (4, 2, 0))
        self.assertEqual(look(None)[0].color, (0, 0, 0))
        plain = materials.Reader(lost, "M").look(box(use_nodes=False, node_tree=None, diffuse_color=(0.1, 0.2, 0.3, 1)))
        self.assertEqual(plain.color, (0.1, 0.2, 0.3))

    def test_mixed_with_nothing(self):
        mix = node("MIX_SHADER", Fac=0.25, First=None, Second=None)
        mix.inputs["First"].link(node("BSDF_TRANSPARENT", Color=(1, 1, 1, 1)))
        mix.inputs["Second"].link(node("BSDF_DIFFUSE", Color=(0.4, 0.8, 0.2, 1), Roughness=0.0))
        found, _ = look(mix)
        self.assertAlmostEqual(found.alpha, 0.25)
        for value, wanted in zip(found.color, (0.4, 0.8, 0.2)):
            self.assertAlmostEqual(value, wanted)

    def test_an_image_that_cuts(self):
        picture = node("TEX_IMAGE", Vector=None)
        picture.image, picture.interpolation, picture.extension, picture.projection = "image", "Closest", "EXTEND", "FLAT"
        shader = principled()
        shader.inputs["Base Color"].link(picture)
        shader.inputs["Alpha"].link(picture, "Alpha")
        found, lost = look(shader)
        self.assertEqual((found.image, found.image_alpha, found.nearest, found.wrap), ("image", True, True, "EXTEND"))
        self.assertFalse(lost.refused)

    def test_sockets_of_blender_4(self):
        """Principled BSDF with the inputs' names of Blender 4, also translated to another language: identifiers stay English."""
        def four(translate=str, **values):
            defaults = dict(Base_Color=(0.8, 0.8, 0.8, 1), Metallic=0.0, Roughness=0.5, IOR=1.5, Alpha=1.0, Normal=None,
                            Subsurface_Weight=0.0, Specular_IOR_Level=0.0, Transmission_Weight=0.0, Coat_Weight=0.0,
                            Sheen_Weight=0.0, Emission_Color=(1, 1, 1, 1), Emission_Strength=0.0)
            made = node("BSDF_PRINCIPLED", **{**defaults, **values})
            made.inputs = Inputs({translate(name): socket for name, socket in made.inputs.items()})
            for name, socket in made.inputs.items():
                socket.name = name
            return made
        for translate in (str, lambda name: name[::-1]):
            found, lost = look(four(translate, Emission_Strength=3.0, Emission_Color=(1, 0.5, 0, 1), Alpha=0.5,
                                    Base_Color=(0.1, 0.2, 0.3, 1)))
            self.assertEqual((found.radiance, found.alpha, found.color), ((3, 1.5, 0), 0.5, (0.1, 0.2, 0.3)))
            self.assertFalse(lost.refused or lost.mentioned)
            self.assertEqual(look(four(translate))[0].radiance, (0, 0, 0))
            self.assertTrue(look(four(translate, Transmission_Weight=0.5))[1].refused)
            for name in ("Subsurface_Weight", "Specular_IOR_Level", "Coat_Weight", "Sheen_Weight"):
                self.assertTrue(look(four(translate, **{name: 0.5}))[1].mentioned, name)
            lit, dark = (box(use_nodes=True, node_tree=box(nodes=[four(translate, Emission_Strength=x)])) for x in (1.0, 0.0))
            self.assertEqual((materials.may_shine(lit), materials.may_shine(dark)), (True, False))
        self.assertTrue(materials.may_shine(box(use_nodes=True, node_tree=box(nodes=[principled(Emission=(1, 0, 0, 1))]))))
        self.assertFalse(materials.may_shine(box(use_nodes=True, node_tree=box(nodes=[principled()]))))

    def test_what_changes_shadows_is_refused(self):
        self.assertIn("'M' lets light through (transmission)", losses.sentences(look(principled(Transmission=0.5))[1].refused))
        for kind in ("BSDF_GLASS", "BSDF_TRANSLUCENT", "SOMETHING"):
            self.assertTrue(look(node(kind, Color=(1, 1, 1, 1)))[1].refused, kind)
        dim = node("BSDF_TRANSPARENT", Color=(1, 0.5, 0.5, 1))
        self.assertTrue(look(dim)[1].refused)
        shader = principled()
        shader.inputs["Alpha"].link(node("NOISE"), "Fac")
        self.assertTrue(look(shader)[1].refused)
        shader = principled()
        shader.inputs["Emission"].link(node("NOISE"))
        self.assertTrue(look(shader)[1].refused)
        self.assertTrue(look(principled(Metallic=1.0))[1].mentioned)

    def test_what_changes_a_surface_is_mentioned(self):
        """Bump maps on any shader are mentioned, and Principled's diffuse part: it is no Lambert surface before Blender
        4, nor in Blender 4 if it is rough."""
        def mentioned(shader):
            return " ".join(losses.sentences(look(shader)[1].mentioned))
        for shader in (principled(), node("BSDF_DIFFUSE", Color=(1, 1, 1, 1), Roughness=0.0, Normal=None),
                       node("BSDF_GLOSSY", Color=(1, 1, 1, 1), Normal=None)):
            self.assertNotIn("bump", mentioned(shader))
            shader.inputs["Normal"].link(node("BUMP"), "Normal")
            self.assertIn("has a normal or bump map, which is left out", mentioned(shader), shader.type)
        self.assertIn("is a Lambert surface", mentioned(principled(Specular=0.0, Roughness=1.0)))
        self.assertNotIn("Lambert", mentioned(principled(Specular=0.5)))  # another sentence says that all is diffuse
        self.assertIn("is a Lambert surface", mentioned(principled(Diffuse_Roughness=0.5)))
        self.assertEqual(mentioned(principled(Diffuse_Roughness=0.0)), "")

    def test_mixed_surfaces_of_images_are_refused(self):
        mix = node("MIX_SHADER", Fac=0.5, First=None, Second=None)
        for name, value in (("First", (0.1, 0.1, 0.1, 1)), ("Second", (1, 1, 1, 1))):
            mix.inputs[name].link(node("BSDF_DIFFUSE", Color=value, Roughness=0.0))
        self.assertFalse(look(mix)[1].refused)
        mix.inputs["Second"].links[0].from_node.inputs["Color"].link(image_node(CHEQUERS))
        self.assertTrue(look(mix)[1].refused)


CHEQUERS = image([[(1, 0.5, 0, 1), (0, 0, 0, 1)], [(0, 0, 0, 1), (1, 0.5, 0, 1)]])


def colored(source, name="Color"):
    """Returns a surface whose colour comes from a node."""
    shader = node("BSDF_DIFFUSE", Color=(1, 1, 1, 1), Roughness=0.0)
    shader.inputs["Color"].link(source, name)
    return shader


class Colors(unittest.TestCase):
    def test_constants(self):
        """Values computed by hand: twice the contrast about 0.5; the square of a mixed colour."""
        mixed = node("MIX_RGB", Fac=0.25, Color1=(0.2, 0.4, 0.8, 1), Color2=(1, 0, 0, 1))
        mixed.blend_type, mixed.use_clamp = "MIX", False
        gamma = node("GAMMA", Color=None, Gamma=2.0)
        gamma.inputs["Color"].link(mixed)
        found, lost = look(colored(gamma))
        self.assertFalse(lost.refused or lost.mentioned)
        numpy.testing.assert_allclose(found.color, (0.16, 0.09, 0.36))
        contrast = node("BRIGHTCONTRAST", Color=(0.5, 0.75, 0.6, 1), Bright=0.0, Contrast=1.0)
        numpy.testing.assert_allclose(look(colored(contrast))[0].color, (0.5, 1.0, 0.7))
        grey = node("HUE_SAT", Hue=0.5, Saturation=0.0, Value=0.5, Fac=1.0, Color=(0.2, 0.8, 0.4, 1))
        numpy.testing.assert_allclose(look(colored(grey))[0].color, (0.4, 0.4, 0.4))
        turned = node("HUE_SAT", Hue=0.5 + 1 / 3, Saturation=1.0, Value=1.0, Fac=1.0, Color=(0.8, 0.2, 0.4, 1))
        numpy.testing.assert_allclose(look(colored(turned))[0].color, (0.4, 0.8, 0.2))

    def test_what_nodes_make_of_a_picture(self):
        invert = node("INVERT", Fac=1.0, Color=None)
        invert.inputs["Color"].link(image_node(CHEQUERS))
        found, lost = look(colored(invert))
        self.assertFalse(lost.refused)
        self.assertIs(found.image, CHEQUERS)
        half = ((0.5 + 0.055) / 1.055) ** 2.4
        numpy.testing.assert_allclose(found.pixels, [[(0, 1 - half, 1), (1, 1, 1)], [(1, 1, 1), (0, 1 - half, 1)]], atol=1e-9)
        product = node("MIX_RGB", Fac=1.0, Color1=None, Color2=(0.5, 0.5, 1, 1))
        product.blend_type, product.use_clamp = "MULTIPLY", False
        product.inputs["Color1"].link(image_node(CHEQUERS))
        found, _ = look(colored(product))
        self.assertEqual((found.pixels, found.color), (None, (0.5, 0.5, 1)))

    def test_what_is_not_evaluated_is_refused_by_name_and_not_white(self):
        for source in (node("TEX_NOISE"), node("NEW_GEOMETRY"), node("HUE_SAT", Hue=0.5)):
            found, lost = look(colored(source))
            self.assertIn(f"the node '{source.name}'", losses.sentences(lost.refused)[0])
            self.assertEqual(found.color, (0.8, 0.8, 0.8))

    def test_groups_and_muted_nodes(self):
        """The output of a group is the product of its input and one half."""
        half = node("MIX_RGB", Fac=1.0, Color1=None, Color2=(0.5, 0.5, 0.5, 1))
        half.blend_type, half.use_clamp = "MULTIPLY", False
        start, end = node("GROUP_INPUT"), node("GROUP_OUTPUT", Result=None)
        start.outputs = [box(name="Tint", identifier="Tint")]
        half.inputs["Color1"].link(start, "Tint")
        end.inputs["Result"].link(half)
        group = node("GROUP", Tint=(0.2, 0.4, 0.6, 1))
        group.node_tree, group.outputs = box(nodes=[start, half, end]), [box(name="Result", identifier="Result")]
        self.assertEqual(look(colored(group, "Result"))[0].color, (0.1, 0.2, 0.3))
        group.inputs["Tint"].link(image_node(CHEQUERS))
        found, _ = look(colored(group, "Result"))
        self.assertEqual((found.image, found.color), (CHEQUERS, (0.5, 0.5, 0.5)))
        muted = node("GAMMA", Color=(0.3, 0.2, 0.1, 1), Gamma=3.0)
        muted.outputs = [box(name="Color", identifier="Color")]
        muted.mute, muted.internal_links = True, [box(from_socket=muted.inputs["Color"], to_socket=muted.outputs[0])]
        self.assertEqual(look(colored(muted))[0].color, (0.3, 0.2, 0.1))

    def test_mapping(self):
        """A quarter turn, scaled by two and moved; and the inverse."""
        for kind, wanted in (("POINT", (0.1 - 2 * 0.5, 0.2 + 2 * 0.25)), ("TEXTURE", ((0.5 - 0.2) / 2, (0.1 - 0.25) / 2))):
            mapping = node("MAPPING", Vector=None, Location=(0.1, 0.2, 0), Rotation=(0, 0, math.pi / 2), Scale=(2, 2, 1))
            mapping.vector_type = kind
            picture = image_node(CHEQUERS)
            picture.inputs["Vector"].link(mapping, "Vector")
            rows = numpy.array(look(colored(picture))[0].placing)
            numpy.testing.assert_allclose(rows @ (0.25, 0.5, 1), wanted, atol=1e-12)

    def test_black_bodies(self):
        """Daylight is nearly white, a candle's blue is gone, and luminance is 1."""
        for kelvin in (900, 2000, 6500, 20000):
            red, green, blue = spectrum.blackbody(kelvin)
            if min(red, green, blue) > 0:
                self.assertAlmostEqual(0.2126 * red + 0.7152 * green + 0.0722 * blue, 1, places=3)
        self.assertEqual(spectrum.blackbody(900)[2], 0)
        numpy.testing.assert_allclose(spectrum.blackbody(6504), (1.0, 1.0, 1.0), atol=0.06)


class Texels(unittest.TestCase):
    def test_between_texels(self):
        """Linear interpolation gives the mean halfway between two texels; beyond the last texel it gives the last or
        (repeated) the first one. B-splines keep straight lines."""
        values = numpy.linspace(0, 1, 8).reshape(1, 8, 1).repeat(3, axis=2)
        fine = texels.finer(values, "Linear", "EXTEND")
        self.assertEqual(fine.shape, (16, 128, 3))
        at = (numpy.arange(128) + 0.5) / 16 - 0.5
        numpy.testing.assert_allclose(fine[3, :, 0], numpy.clip(at / 7, 0, 1), atol=1e-12)
        self.assertAlmostEqual(texels.finer(values, "Linear", "REPEAT")[0, -1, 0], 1 - (at[-1] - 7) * 1)
        numpy.testing.assert_allclose(texels.finer(values, "Cubic", "EXTEND")[0, 32:96, 0], at[32:96] / 7, atol=1e-12)

    def test_colours_there_and_back(self):
        generator = numpy.random.default_rng(7)
        values = generator.random((50, 40, 3))
        numpy.testing.assert_allclose(texels.rgb_of(*texels.hsv_of(values)), values, atol=1e-12)
        numpy.testing.assert_allclose(texels.linear_of(texels.encoded_of(values)), values, atol=1e-7)

    def test_png(self):
        """The rows of a PNG, unpacked by hand."""
        values = numpy.arange(24, dtype=numpy.uint8).reshape(2, 4, 3)
        data = texels.png(values)
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        packed = data[data.index(b"IDAT") + 4:data.index(b"IEND") - 8]
        rows = numpy.frombuffer(zlib.decompress(packed), numpy.uint8).reshape(2, 13)
        numpy.testing.assert_array_equal(rows[:, 1:], values.reshape(2, 12))
        self.assertEqual(rows[:, 0].tolist(), [0, 0])


class Skies(unittest.TestCase):
    """Radiance of a world's nodes by direction, compared with Cycles' rule: u = 1/2 - atan2(y, x) / 2 pi, v = acos(z) /
    pi from the top."""

    def world_of(self, turn=(0, 0, 0), scale=(1, 1, 1), kind="POINT", place=(0, 0, 0)):
        mapping = node("MAPPING", Vector=None, Location=place, Rotation=turn, Scale=scale)
        mapping.vector_type = kind
        mapping.inputs["Vector"].link(node("TEX_COORD"), "Generated")
        values = numpy.ones((4, 8, 4))
        values[..., 0] = numpy.arange(32).reshape(4, 8) / 32
        picture = image_node(image(values, is_float=True))
        picture.type, picture.projection = "TEX_ENVIRONMENT", "EQUIRECTANGULAR"
        picture.inputs["Vector"].link(mapping)
        background = node("BACKGROUND", Color=(1, 1, 1, 1), Strength=2.0)
        background.inputs["Color"].link(picture)
        output = node("OUTPUT_WORLD", Surface=None, Volume=None)
        output.inputs["Surface"].link(background)
        return box(use_nodes=True, node_tree=box(get_output_node=lambda _: output))

    def looked_up(self, direction, world):
        """Returns the value of the written dome in a direction: the node's +Y is up, -Z is the middle column, +X is to
        the right of it."""
        lights, seen = sky.skies_of(world)
        self.assertIs(lights, seen)
        self.assertEqual(lights.radiance, (2, 2, 2))
        rows, mirrored = sky.placed(sky.looked_up(lights))
        right, up, back = numpy.array(rows)[:3, :3].T @ direction
        values = sky.picture(lights, mirrored)
        u, v = 0.5 + math.atan2(right, -back) / (2 * math.pi), math.acos(up) / math.pi
        return values[int(v * 4), int(u * 8) % 8, 0]

    def test_pictures_lie_as_mappings_say(self):
        random = numpy.random.default_rng(5)
        def turned(v, angles):  # about X, then Y, then Z
            for axis, angle in enumerate(angles):
                i, j = (axis + 1) % 3, (axis + 2) % 3
                v = v.copy()
                v[i], v[j] = v[i] * math.cos(angle) - v[j] * math.sin(angle), v[i] * math.sin(angle) + v[j] * math.cos(angle)
            return v
        for _ in range(60):
            angles, direction = random.uniform(-3, 3, 3), random.normal(size=3)
            direction /= numpy.linalg.norm(direction)
            signs = random.choice((-1, 1), 3)
            x, y, z = turned(direction * signs, angles)
            wanted = int(math.acos(z) / math.pi * 4) * 8 + int((0.5 - math.atan2(y, x) / (2 * math.pi)) * 8) % 8
            found = self.looked_up(direction, self.world_of(tuple(angles), tuple(2.5 * signs)))
            self.assertAlmostEqual(found * 32, wanted, places=4)
            # A mapping of type TEXTURE is the inverse.
            x, y, z = direction
            wanted = int(math.acos(z) / math.pi * 4) * 8 + int((0.5 - math.atan2(y, x) / (2 * math.pi)) * 8) % 8
            world = self.world_of(tuple(angles), tuple(2.5 * signs), "TEXTURE")
            self.assertAlmostEqual(self.looked_up(turned(signs * direction, angles), world) * 32, wanted, places=4)

    def test_what_is_no_turn_is_unknown(self):
        for values in (dict(place=(1, 0, 0)), dict(scale=(1, 2, 1)), dict(scale=(0, 0, 0))):
            with self.assertRaises(graph.Unknown):
                sky.looked_up(sky.skies_of(self.world_of(**values))[0])

    def test_cameras_may_see_another(self):
        first, second = (node("BACKGROUND", Color=(color, 0, 0, 1), Strength=1.0) for color in (0.5, 0.25))
        mix = node("MIX_SHADER", Fac=0.5, First=None, Second=None)
        mix.inputs["Fac"].link(node("LIGHT_PATH"), "Is Camera Ray")
        mix.inputs["First"].link(first)
        mix.inputs["Second"].link(second)
        output = node("OUTPUT_WORLD", Surface=None, Volume=None)
        output.inputs["Surface"].link(mix)
        lights, seen = sky.skies_of(box(use_nodes=True, node_tree=box(get_output_node=lambda _: output)))
        self.assertEqual((lights.radiance, seen.radiance), ((0.5, 0, 0), (0.25, 0, 0)))
        mix.inputs["Fac"].links = []
        with self.assertRaises(graph.Unknown):
            sky.skies_of(box(use_nodes=True, node_tree=box(get_output_node=lambda _: output)))

    def test_environments_are_for_worlds(self):
        surface = node("BSDF_DIFFUSE", Color=None, Roughness=0.0)
        picture = image_node(image(numpy.ones((4, 8, 4))))
        picture.type = "TEX_ENVIRONMENT"
        surface.inputs["Color"].link(picture)
        self.assertIn("which is for worlds", " ".join(look(surface)[1].refused))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
