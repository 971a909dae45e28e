"""Settings of a scene, and where they are shown."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from . import program


class PenumbraPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(
        name="Program", subtype="FILE_PATH",
        description="The penumbra program; empty: what the variable PENUMBRA says, or the one in PATH")

    def draw(self, _context):
        self.layout.prop(self, "program")


class PenumbraSettings(bpy.types.PropertyGroup):
    exactness: EnumProperty(name="Shadows", default=program.EXACT, items=[
        (program.EXACT, "Exact", "The exact area of each light that is seen, where a method can; else light samples"),
        (program.SAMPLES, "Light samples", "Points of each light, each of them exactly seen or not")])
    light_samples: IntProperty(name="Light samples", default=256, min=1, max=4096, description="Points of each light")
    method: StringProperty(name="Method", description="A shadow method's name (`penumbra methods` lists them); empty: "
                           "for each light the best")
    pixel_samples: EnumProperty(name="Pixel samples", default="1", description="View samples a pixel", items=[
        (str(n * n), str(n * n), "") for n in range(1, 9)])
    pixel_filter: EnumProperty(name="Pixel filter", default=program.BOX, items=[
        (program.BOX, "Box", "The mean of a pixel's own view samples"),
        (program.BLACKMAN_HARRIS, "Blackman-Harris", "As Cycles has it, neighbours' view samples included")])
    filter_width: FloatProperty(name="Width", default=1.5, min=1, max=10, description="Of the filter, in pixels")
    shading_normals: BoolProperty(name="Smooth normals", description="Cosines of smooth shading; shadows are always those "
                                  "of the triangles")
    lenient: BoolProperty(name="Lenient", description="Leave out what would change shadows and cannot be done, with a "
                          "warning, instead of refusing")
    light_passes: BoolProperty(name="Passes of each light", default=True,
                               description="V, and each light's V and its light alone")
    device: StringProperty(name="Device", description="Part of a Vulkan device's name, its number, or cpu; empty: the best")


class Panel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = {"PENUMBRA"}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES


class PENUMBRA_PT_shadows(Panel, bpy.types.Panel):
    bl_label = "Shadows"

    def draw(self, context):
        settings, layout = context.scene.penumbra, self.layout
        layout.use_property_split = True
        layout.prop(settings, "exactness")
        if settings.exactness == program.SAMPLES:
            layout.prop(settings, "light_samples")
        for name in ("method", "pixel_samples"):
            layout.prop(settings, name)
        if settings.pixel_samples != "1":
            layout.prop(settings, "pixel_filter")
            if settings.pixel_filter == program.BLACKMAN_HARRIS:
                layout.prop(settings, "filter_width")
        for name in ("shading_normals", "lenient", "light_passes", "device"):
            layout.prop(settings, name)


def _panels_of_others():
    """Panels that say nothing of how a renderer works: of lamps, cameras, materials, output, layers."""
    excluded = {"VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes", "RENDER_PT_eevee_motion_blur"}
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is not None and "BLENDER_RENDER" in engines and panel.__name__ not in excluded:
            yield panel


CLASSES = (PenumbraPreferences, PenumbraSettings, PENUMBRA_PT_shadows)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.penumbra = PointerProperty(type=PenumbraSettings)
    for panel in _panels_of_others():
        panel.COMPAT_ENGINES.add("PENUMBRA")


def unregister():
    for panel in _panels_of_others():
        panel.COMPAT_ENGINES.discard("PENUMBRA")
    del bpy.types.Scene.penumbra
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
