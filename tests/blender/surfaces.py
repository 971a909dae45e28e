# SPDX-License-Identifier: Apache-2.0
"""Compares colours made by nodes and images with Cycles, and tests what is refused or mentioned of surfaces, lamps and
cameras. Run inside Blender:

    run.sh surfaces.py ADDON.zip PENUMBRA WORK
"""

import json
import os
import sys
import unittest
from math import radians

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402
import numpy  # noqa: E402

import inside  # noqa: E402
import scenes  # noqa: E402


def out(name):
    return os.path.join(inside.OUT, name)


def colors(found):
    return numpy.stack([found[f"Combined.{letter}"] for letter in "RGB"], axis=-1).astype(numpy.float64)


def by_cycles(scene, samples=64):
    """Renders with Cycles: direct light only, at pixels' centres."""
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples, cycles.seed, cycles.max_bounces, cycles.transparent_max_bounces = samples, 3, 0, 8
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    cycles.sample_clamp_direct = cycles.light_sampling_threshold = 0
    cycles.pixel_filter_type, cycles.filter_width = "GAUSSIAN", 0.01
    found = colors(inside.channels(scene, out("cycles.exr")))
    scene.render.engine = "PENUMBRA"
    return found


def lamp(**values):
    scenes.lamp("AREA", (1, -1, 4), (15, 15, 0), **{"energy": 300, "shape": "SQUARE", "size": 1.2, **values})


def chequers(size=8, steep=False):
    """Returns a picture whose texels differ much from their neighbours."""
    image = bpy.data.images.new("Chequers", size, size)
    values = numpy.ones((size, size, 4), numpy.float32)
    across = numpy.arange(size)
    values[..., 0] = (across[:, None] + across) % 2 * 0.9 + 0.05
    values[..., 1] = across / size if not steep else across % 3 == 0
    values[..., 2] = across[:, None] / size
    image.pixels.foreach_set(values.ravel())
    image.pack()
    return image


class Tree:
    """A floor whose colour comes from nodes."""

    def __init__(self):
        self.material = scenes.diffuse(name="Painted")
        self.tree, self.surface = self.material.node_tree, self.material.node_tree.nodes["Diffuse BSDF"]
        data = scenes.quad("Floor", self.material, 4)
        for loop, place in zip(data.uv_layers.new(name="UVMap").data, ((0, 0), (1, 0), (1, 1), (0, 1))):
            loop.uv = place
        scenes.add("Floor", data)
        scenes.camera()
        lamp()

    def node(self, kind, **values):
        """Adds a node. `values`: inputs by number (_0), otherwise properties; an output as value is linked to the
        input."""
        made = self.tree.nodes.new(kind)
        for key, value in values.items():
            if not key.startswith("_"):
                setattr(made, key, value)
        for key, value in values.items():
            if key.startswith("_"):
                socket = made.inputs[int(key[1:])]
                if isinstance(value, bpy.types.NodeSocket):
                    self.tree.links.new(value, socket)
                else:
                    socket.default_value = value
        return made

    def image(self, image=None, **values):
        return self.node("ShaderNodeTexImage", image=image or chequers(), **values)

    def color(self, output):
        self.tree.links.new(output, self.surface.inputs["Color"])


class Colors(unittest.TestCase):
    def beside_cycles(self, build, allowed=2e-3, pixel=0.02):
        """Compares with Cycles: the sums of each channel, and the median difference of pixels."""
        scene = inside.fresh(build)
        ours, theirs = colors(inside.channels(scene, out("ours.exr"))), by_cycles(scene)
        self.assertGreater(theirs.sum(), 1)
        for channel in range(3):
            if theirs[..., channel].sum() > 0.01 * theirs.sum():
                self.assertAlmostEqual(ours[..., channel].sum() / theirs[..., channel].sum(), 1, delta=allowed, msg=str(channel))
        self.assertLess(float(numpy.median(numpy.abs(ours - theirs))) / theirs.mean(), pixel)

    def test_pictures_are_interpolated_as_by_cycles(self):
        for kind in ("Closest", "Linear", "Cubic"):
            for extension in ("REPEAT", "EXTEND"):
                with self.subTest(kind=kind, extension=extension):
                    def build():
                        tree = Tree()
                        place = tree.node("ShaderNodeUVMap", uv_map="UVMap")
                        moved = tree.node("ShaderNodeMapping", _0=place.outputs[0], _1=(0.1, 0.2, 0), _3=(1.3, 1.2, 1))
                        tree.color(tree.image(interpolation=kind, extension=extension, _0=moved.outputs[0]).outputs["Color"])
                    self.beside_cycles(build, 4e-3 if kind != "Cubic" else 8e-3)

    def test_mapping(self):
        for kind in ("POINT", "TEXTURE", "VECTOR"):
            with self.subTest(kind=kind):
                def build():
                    tree = Tree()
                    place = tree.node("ShaderNodeTexCoord")
                    moved = tree.node("ShaderNodeMapping", vector_type=kind, _0=place.outputs["UV"])
                    for name, value in (("Location", (0.3, -0.2, 0)), ("Rotation", (0, 0, 0.4)), ("Scale", (2, 1.5, 1))):
                        if name in moved.inputs and moved.inputs[name].enabled:
                            moved.inputs[name].default_value = value
                    tree.color(tree.image(interpolation="Closest", _0=moved.outputs[0]).outputs["Color"])
                self.beside_cycles(build)

    def test_constant_colours(self):
        """Nodes with only constant inputs: each evaluates to one colour, so the surface has no picture."""
        one, two = (0.7, 0.6, 0.5, 1), (0.9, 0.5, 0.7, 1)
        nodes = [("ShaderNodeHueSaturation", dict(_0=0.6, _1=0.7, _2=1.1, _3=0.8, _4=one)),
                 ("ShaderNodeGamma", dict(_0=one, _1=1.7)), ("ShaderNodeBrightContrast", dict(_0=one, _1=0.1, _2=0.2)),
                 ("ShaderNodeInvert", dict(_0=0.7, _1=one)), ("ShaderNodeBlackbody", dict(_0=2700)),
                 ("ShaderNodeRGBToBW", dict(_0=one)), ("ShaderNodeCombineColor", dict(_0=0.2, _1=0.4, _2=0.6))]
        nodes += [("ShaderNodeMixRGB", dict(blend_type=kind, _0=0.6, _1=one, _2=two)) for kind in
                  ("MIX", "MULTIPLY", "ADD", "SUBTRACT", "SCREEN", "DARKEN", "LIGHTEN", "DIFFERENCE", "DIVIDE", "OVERLAY")]
        nodes += [("ShaderNodeValToRGB", dict(_0=0.3)), ("ShaderNodeMath", dict(operation="POWER", _0=0.5, _1=1.5))]
        for kind, values in nodes:
            with self.subTest(kind=kind, **{key: str(value) for key, value in values.items()}):
                def build():
                    tree = Tree()
                    dim = tree.node("ShaderNodeMixRGB", blend_type="MULTIPLY", _0=1.0,
                                    _1=tree.node(kind, **values).outputs[0], _2=(0.5, 0.5, 0.5, 1))
                    tree.color(dim.outputs[0])
                self.beside_cycles(build)

    def test_mix_nodes_of_colours(self):
        def build():
            tree = Tree()
            mix = tree.node("ShaderNodeMix", data_type="RGBA", blend_type="SCREEN")
            for name, value in (("Factor_Float", 0.4), ("A_Color", (0.1, 0.4, 0.3, 1)), ("B_Color", (0.5, 0.2, 0.3, 1))):
                next(socket for socket in mix.inputs if socket.identifier == name).default_value = value
            tree.color(next(socket for socket in mix.outputs if socket.identifier == "Result_Color"))
        self.beside_cycles(build)

    def test_pictures_that_nodes_change(self):
        def build():
            tree = Tree()
            image = tree.image(interpolation="Closest")
            turned = tree.node("ShaderNodeHueSaturation", _0=0.7, _1=0.6, _2=0.9, _3=0.9, _4=image.outputs["Color"])
            tree.color(tree.node("ShaderNodeMixRGB", _0=0.3, _1=turned.outputs[0], _2=(0.1, 0.6, 0.2, 1)).outputs[0])
        self.beside_cycles(build, 4e-3)

    def test_groups(self):
        """A surface inside a group, whose colour comes from outside, through another group."""
        def build():
            tree = Tree()
            inner = bpy.data.node_groups.new("Dimmed", "ShaderNodeTree")
            inner.inputs.new("NodeSocketColor", "Color")
            inner.outputs.new("NodeSocketShader", "Surface")
            start, end = inner.nodes.new("NodeGroupInput"), inner.nodes.new("NodeGroupOutput")
            dim, surface = inner.nodes.new("ShaderNodeGamma"), inner.nodes.new("ShaderNodeBsdfDiffuse")
            dim.inputs[1].default_value = 1.5
            inner.links.new(start.outputs[0], dim.inputs[0])
            inner.links.new(dim.outputs[0], surface.inputs["Color"])
            inner.links.new(surface.outputs[0], end.inputs[0])
            group = tree.node("ShaderNodeGroup", node_tree=inner, _0=tree.image(interpolation="Closest").outputs["Color"])
            tree.tree.links.new(group.outputs[0], tree.tree.nodes["Material Output"].inputs["Surface"])
        self.beside_cycles(build, 4e-3)

    def test_pictures_of_floats_and_of_data(self):
        for space, is_float in (("Linear", True), ("Non-Color", False)):
            def build():
                tree = Tree()
                image = bpy.data.images.new("Floats", 16, 16, float_buffer=is_float)
                image.colorspace_settings.name = space
                image.pixels.foreach_set(numpy.linspace(0.1, 0.9, 1024).astype(numpy.float32))
                image.pack()
                tree.color(tree.image(image, interpolation="Closest").outputs["Color"])
            with self.subTest(space=space):
                self.beside_cycles(build, 6e-3)

    def test_smooth_shading_is_as_the_file_has_it(self):
        def build():
            scenes.add("Floor", scenes.quad("Floor", half=4))
            scenes.camera()
            bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8, radius=1, location=(0, 0, 1.5))
            bpy.ops.object.shade_smooth()
            bpy.context.object.data.materials.append(scenes.diffuse())
            lamp()
        self.beside_cycles(build, 5e-3)


class Refusals(unittest.TestCase):
    def said(self, scene):
        """Returns what is refused and what is mentioned, as sentences."""
        from penumbra import export, frames, losses
        lost = losses.Losses()
        writer = export.SceneWriter(bpy.context.evaluated_depsgraph_get(), lost, True)
        writer.write(out("said.glb"), frames.region_of(scene.render, inside.WIDTH, inside.HEIGHT))
        return " ".join(losses.sentences(lost.refused)), " ".join(losses.sentences(lost.mentioned))

    def expect(self, scene, refused="", mentioned=""):
        found = self.said(scene)
        for text, wanted in zip(found, (refused, mentioned)):
            self.assertIn(wanted, text)
            self.assertTrue(wanted or not text, text)

    def test_an_override_is_the_material_of_all(self):
        scene = inside.fresh(scenes.area_square)
        plain = scenes.diffuse((0.2, 0.4, 0.6), "Override")
        scene.view_layers[0].material_override = plain
        overridden = colors(inside.channels(scene, out("override.exr")))
        scene.view_layers[0].material_override = None
        for name in ("Floor", "Block"):
            bpy.data.objects[name].data.materials[0] = plain
        numpy.testing.assert_array_equal(overridden, colors(inside.channels(scene, out("plain.exr"))))

    def test_each_view_layer_has_its_own_override(self):
        scene = inside.fresh(scenes.area_square)
        alone = inside.channels(scene, out("alone.exr"))
        scene.view_layers.new("Clay").material_override = scenes.diffuse((0.2, 0.4, 0.6), "Override")
        scene.render.filepath = out("layers.exr")
        bpy.ops.render.render(write_still=True)
        found = inside.read(out("layers.exr")).channels
        numpy.testing.assert_array_equal(found["ViewLayer.Combined.R"], alone["Combined.R"])
        self.assertFalse(numpy.array_equal(found["Clay.Combined.R"], alone["Combined.R"]))

    def test_instances_share_a_mesh_in_the_file(self):
        """A mesh that a collection, particles or geometry nodes show many times, and once by itself, is in the file
        only once."""
        from penumbra import export, losses
        for build, name, count in ((scenes.instances, "Stone", 3), (scenes.particles, "Crumb", 21), (scenes.scattered, "Crumb", 5)):
            scene = inside.fresh(build)
            lost = losses.Losses()
            writer = export.SceneWriter(bpy.context.evaluated_depsgraph_get(), lost, True)
            writer.write(out("shared.glb"), None)
            self.assertEqual(lost.refused, {})
            with open(out("shared.glb"), "rb") as file:
                data = file.read()
            gltf = json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])
            meshes = [node["mesh"] for node in gltf["nodes"] if node.get("name") == name and "mesh" in node]
            self.assertEqual(len(meshes), count, scene.name)
            self.assertEqual(len(set(meshes)), 1, name)

    def test_collections_of_a_view_layer(self):
        for key, wanted in (("holdout", "'Block' is a holdout"), ("indirect_only", "'Block' is in a collection that is indirect")):
            scene = inside.fresh(scenes.area_square)
            collection = bpy.data.collections.new("Own")
            scene.collection.children.link(collection)
            block = bpy.data.objects["Block"]
            scene.collection.objects.unlink(block)
            collection.objects.link(block)
            self.expect(scene)
            setattr(scene.view_layers[0].layer_collection.children["Own"], key, True)
            self.expect(scene, wanted)

    def test_lamps_that_reach_surfaces(self):
        scene = inside.fresh(scenes.stage)
        scenes.lamp("POINT", (-2, 0, 1.5), name="Bulb", energy=100, shadow_soft_size=0.05)
        self.expect(scene)
        bpy.data.lights["Bulb"].shadow_soft_size = 0.5
        self.expect(scene, "", "'Bulb' is a ball here and a disk in Cycles, and only 1.44 away from 'Block', with a radius of 0.5: up to 12 %")
        bpy.data.lights["Bulb"].shadow_soft_size = 1.6
        self.expect(scene, "'Bulb' is a lamp whose radius, 1.6, reaches 'Block'")

    def test_wide_suns(self):
        scene = inside.fresh(scenes.sun)
        for degrees, refused, mentioned in ((89, "", ""), (110, "", "wider than 90"), (150, "wider than 120", "")):
            bpy.data.lights["Key"].angle = radians(degrees)
            self.expect(scene, refused, mentioned)

    def shear(self, name):
        """Shears an object by a non-uniformly scaled parent, relative to which the object is turned."""
        parent = scenes.add("Parent", None, scale=(1, 3, 1))
        thing = bpy.data.objects[name]
        matrix = thing.matrix_world.copy()
        thing.parent = parent
        bpy.context.view_layer.update()
        return matrix

    def test_what_parents_shear(self):
        scene = inside.fresh(scenes.area_rectangle)
        bpy.context.view_layer.update()
        self.shear("Key")
        self.expect(scene, "", "'Key' is an area lamp that is sheared")
        scene = inside.fresh(scenes.area_square)
        bpy.context.view_layer.update()
        bpy.data.objects["Shot"].rotation_euler = (0.6, 0.2, 0.3)
        self.shear("Shot")
        self.assertIn("'Shot' is a camera that is sheared", self.said(scene)[0])

    def test_hair_is_refused_with_what_to_do(self):
        def hairy():
            scenes.area_square()
            system = bpy.data.objects["Floor"].modifiers.new("Hair", "PARTICLE_SYSTEM").particle_system
            system.settings.type, system.settings.count = "HAIR", 5
        self.expect(inside.fresh(hairy), "'Floor' has hair, which is not rendered; convert it to a mesh")

    def test_clip_distances(self):
        scene = inside.fresh(scenes.area_square)
        lens = bpy.data.cameras["Shot"]
        scenes.add("Behind", scenes.quad("Behind"), (0, -9, 5))
        self.expect(scene)
        lens.clip_start = 8
        self.expect(scene, "'Block' is cut by the clip start of camera 'Shot'")
        lens.clip_start, lens.clip_end = 0.1, 9
        self.expect(scene, "", "'Floor' reaches beyond the clip end of camera 'Shot'")

    def test_colours_that_are_not_evaluated(self):
        def noisy():
            tree = Tree()
            tree.color(tree.node("ShaderNodeTexNoise").outputs["Color"])
        scene = inside.fresh(noisy)
        self.expect(scene, "'Painted' has a colour made by the node 'Noise Texture'")

        def negative():
            tree = Tree()
            tree.color(tree.node("ShaderNodeMixRGB", blend_type="SUBTRACT", _0=1, _1=(0.2, 0.2, 0.2, 1), _2=(1, 0, 0, 1)).outputs[0])
        self.expect(inside.fresh(negative), "'Painted' has a colour below 0")

        def blown():
            tree = Tree()
            paint = tree.node("ShaderNodeVertexColor", layer_name="Paint")
            tree.color(tree.node("ShaderNodeGamma", _0=paint.outputs["Color"], _1=2).outputs[0])
        self.expect(inside.fresh(blown), "'Painted' has a colour made by a colour attribute")

    def test_emitters_whose_parts_stand_before_one_another(self):
        scene = inside.fresh(scenes.stage)
        bpy.ops.mesh.primitive_cylinder_add(vertices=16, radius=0.4, depth=0.6, end_fill_type="NOTHING", location=(0, -0.5, 3))
        bpy.context.object.data.materials.append(scenes.emission((1, 1, 1), 9))
        with self.assertRaises(RuntimeError) as caught:
            inside.channels(scene, out("shade.exr"))
        self.assertIn("shadow one another", str(caught.exception))
        scene.penumbra.lenient = True
        self.assertGreater(colors(inside.channels(scene, out("shade.exr"))).sum(), 0)


if __name__ == "__main__":
    inside.run_tests(Colors, Refusals)
    inside.channels(inside.fresh(scenes.area_square), out("last.exr"))  # Blender exits with 1 if its last render failed
