# SPDX-License-Identifier: Apache-2.0
"""Tests the panels of each tab while Penumbra is the engine, and the properties that they show. Run inside Blender:

    run.sh panels.py ADDON.zip PENUMBRA WORK
"""

import os
import sys
import types
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402

import inside  # noqa: E402
import scenes  # noqa: E402


class Layout:
    """Stands in for bpy.types.UILayout: records what a panel shows, and fails for a property that its owner lacks."""

    def __init__(self, shown=None):
        self.shown = [] if shown is None else shown

    def _inner(self, *_, **__):
        return Layout(self.shown)
    row = column = split = box = _inner

    def prop(self, owner, name, **_):
        if name not in owner.bl_rna.properties:
            raise AssertionError(f"{owner} has no {name}")
        self.shown.append(name)

    template_curve_mapping = prop

    def template_node_view(self, tree, node, socket):
        self.shown.append(f"nodes from {socket.name}")

    def label(self, **_):
        pass
    separator = label

    def operator(self, name, **_):
        if name.removeprefix("penumbra.") not in dir(bpy.ops.penumbra):
            raise AssertionError(f"there is no operator {name}")
        self.shown.append(name)


def context_of(tab, thing=None):
    """Returns a context with the members that the panels of a tab read."""
    data = thing.data if thing else None
    found = types.SimpleNamespace(
        engine="PENUMBRA", scene=bpy.context.scene, view_layer=bpy.context.view_layer, object=thing, active_object=thing,
        world=bpy.data.worlds[0], material=None, material_slot=None, light=None, camera=None, mesh=None, tab=tab,
        space_data=types.SimpleNamespace(type="PROPERTIES"))
    if thing and thing.type == "LIGHT":
        found.light = data
    if thing and thing.type == "MESH":
        found.mesh, found.material_slot, found.material = data, thing.material_slots[0], thing.material_slots[0].material
    if thing and thing.type == "CAMERA":
        found.camera = data
    return found


def panels_of(tab):
    for panel in bpy.types.Panel.__subclasses__():
        if getattr(panel, "bl_context", "") == tab and "PENUMBRA" in getattr(panel, "COMPAT_ENGINES", ()):
            yield panel


def shown(tab, thing=None):
    """Returns what the add-on's panels of a tab show, for the panels whose poll() accepts the context."""
    context, layout = context_of(tab, thing), Layout()
    for panel in panels_of(tab):
        if panel.__module__.startswith("penumbra") and panel.poll(context):
            own = types.SimpleNamespace(layout=layout)
            own.split_layout = lambda: own.layout
            panel.draw(own, context)
    return layout.shown


class Panels(unittest.TestCase):
    def setUp(self):
        self.scene = inside.fresh(scenes.stage)
        bpy.data.worlds.new("World")

    def lamp(self, kind, **values):
        return scenes.lamp(kind, (0, 0, 3), **values)

    def test_lamps(self):
        """The lamp's tab shows every property that changes its light or shadow."""
        both = {"type", "color", "energy", "use_shadow"}
        sizes = {"POINT": {"shadow_soft_size"}, "SUN": {"angle"}, "SPOT": {"shadow_soft_size", "spot_size", "spot_blend"}}
        for kind, wanted in sizes.items():
            self.assertLessEqual(both | wanted, set(shown("data", self.lamp(kind))), kind)
        self.assertLessEqual(both | {"shape", "size"}, set(shown("data", self.lamp("AREA", shape="DISK"))))
        self.assertLessEqual(both | {"shape", "size", "size_y"}, set(shown("data", self.lamp("AREA", shape="ELLIPSE"))))
        self.assertNotIn("spot_size", shown("data", self.lamp("POINT")))
        lamp = self.lamp("POINT")
        lamp.data.use_nodes = True
        self.assertIn("nodes from Surface", shown("data", lamp))

    def test_objects_materials_worlds_layers(self):
        block = bpy.data.objects["Block"]
        self.assertLessEqual({"visible_camera", "visible_shadow", "hide_render"}, set(shown("object", block)))
        self.assertLessEqual({"nodes from Surface", "blend_method"}, set(shown("material", block)))
        block.data.materials[0].use_nodes = False
        self.assertLessEqual({"use_nodes", "diffuse_color"}, set(shown("material", block)))
        self.assertLessEqual({"world", "color"}, set(shown("world")))
        passes = {"use_pass_z", "use_pass_normal", "use_pass_position", "use_pass_cryptomatte_object", "light_passes"}
        self.assertLessEqual(passes | {"material_override"}, set(shown("view_layer")))
        self.assertLessEqual({"exactness", "pixel_samples", "shading_normals", "film_transparent", "bake_size", "penumbra.bake",
                              "motion_samples", "motion_blur_position", "motion_blur_shutter", "motion_blur_shutter_curve"},
                             set(shown("render")))

    def test_blenders_own_panels(self):
        names = {panel.__name__ for tab in ("data", "object", "material", "world", "view_layer", "output", "render", "particle")
                 for panel in panels_of(tab)}
        self.assertLessEqual({"EEVEE_MATERIAL_PT_context_material", "DATA_PT_context_light", "DATA_PT_lens", "DATA_PT_camera",
                              "DATA_PT_uv_texture", "OBJECT_PT_custom_props", "RENDER_PT_format", "RENDER_PT_output",
                              "RENDER_PT_color_management", "VIEWLAYER_PT_layer", "WORLD_PT_context_world",
                              "PARTICLE_PT_render"}, names)
        # The tab has no second panel for the same settings, and none for features that Penumbra does not render.
        self.assertFalse({"DATA_PT_light", "DATA_PT_EEVEE_light", "EEVEE_MATERIAL_PT_surface", "RENDER_PT_eevee_bloom",
                          "RENDER_PT_freestyle", "RENDER_PT_stereoscopy", "VIEWLAYER_PT_layer_passes"} & names)

    def test_every_parent_is_there_and_nothing_stays(self):
        ours = [panel for panel in bpy.types.Panel.__subclasses__() if "PENUMBRA" in getattr(panel, "COMPAT_ENGINES", ())]
        self.assertGreater(len(ours), 80)
        names = {panel.__name__ for panel in ours}
        for panel in ours:
            parent = getattr(panel, "bl_parent_id", "")
            limited = hasattr(getattr(bpy.types, parent, None), "COMPAT_ENGINES") if parent else False
            self.assertTrue(parent in names or not limited, f"{panel.__name__} in {parent}")
        bpy.ops.preferences.addon_disable(module="penumbra")
        self.assertEqual([panel.__name__ for panel in bpy.types.Panel.__subclasses__()
                          if "PENUMBRA" in getattr(panel, "COMPAT_ENGINES", ()) and panel.__module__ != "penumbra.panels"], [])


if __name__ == "__main__":
    inside.run_tests(Panels)
