# SPDX-License-Identifier: Apache-2.0
"""Settings of a scene and of the add-on. panels.py shows them."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from . import program, sky


class PenumbraPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(
        name="Program", subtype="FILE_PATH",
        description="Path of the program penumbra; empty: the value of the variable PENUMBRA, or the program in PATH")

    def draw(self, _context):
        self.layout.prop(self, "program")


class PenumbraSettings(bpy.types.PropertyGroup):
    exactness: EnumProperty(name="Shadows", default=program.EXACT, items=[
        (program.EXACT, "Exact", "The exact visible area of each light where a method can compute it; else light samples"),
        (program.SAMPLES, "Light samples", "Points on each light; whether each is visible is decided exactly")])
    light_samples: IntProperty(name="Light samples", default=256, min=1, max=4096, description="Points of each light")
    method: StringProperty(name="Method", description="A shadow method's name (`penumbra methods` lists them); empty: "
                           "for each light the best")
    pixel_samples: EnumProperty(name="Pixel samples", default="1", description="View samples a pixel", items=[
        (str(n * n), str(n * n), "") for n in range(1, 9)])
    pixel_filter: EnumProperty(name="Pixel filter", default=program.BOX, items=[
        (program.BOX, "Box", "The mean of a pixel's own view samples"),
        (program.BLACKMAN_HARRIS, "Blackman-Harris", "As in Cycles, includes view samples of neighbouring pixels")])
    filter_width: FloatProperty(name="Width", default=1.5, min=1, max=10, description="Width of the filter, in pixels")
    motion_samples: IntProperty(name="Moments", default=16, min=1, max=256, description="Moments at which the shutter is open; the picture is their mean")
    light_cutoff: FloatProperty(name="Light cutoff", default=0, min=0, max=1, precision=4, description="Leaves out a light at pixels where, even if nothing blocked it, it would contribute at most this share of all lights; 0: nowhere")
    shading_normals: BoolProperty(name="Smooth shading", default=True, description="Smooth faces are shaded by their normals, as in Cycles; shadows are always those of the triangles")
    world: EnumProperty(name="World", default=sky.SAMPLED, items=[
        (sky.SAMPLED, "Light samples", "The world lights the scene from this number of directions: quick"),
        (sky.EXACT, "Exact", "The exact share of the world that is seen, of one colour or a picture, unless Shadows are light "
         "samples; slow where there are many triangles, and every instance is copied"),
        (sky.SEEN, "Background only", "The world lights nothing")])
    lenient: BoolProperty(name="Lenient", description="Leave out unsupported features that would change shadows, with a warning, instead of refusing")
    light_passes: BoolProperty(name="Passes of each light", default=True,
                               description="V, and each light's V and its light alone")
    bake_size: IntProperty(name="Size", default=1024, min=4, max=8192, description="Side of the baked image in texels")
    bake_margin: IntProperty(name="Margin", default=8, min=0, max=1024, description="Margin around the mesh's texels, in texels")
    bake_what: EnumProperty(name="Bake", default="LIGHT", items=[
        ("LIGHT", "Light", "Light that a white surface reflects; multiplied by the base colour it gives the picture"),
        ("VISIBILITY", "Visibility", "How much of the first light is seen, from 0 to 1")])
    device: StringProperty(name="Device", description="Part of a Vulkan device's name, its index, or cpu; empty: the best")


CLASSES = (PenumbraPreferences, PenumbraSettings)


def program_path():
    """Returns the program's path in the preferences; "" if the add-on is enabled for this start only (`blender --addons penumbra`)."""
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences.program if addon is not None and addon.preferences is not None else ""


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.penumbra = PointerProperty(type=PenumbraSettings)


def unregister():
    del bpy.types.Scene.penumbra
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
