# SPDX-License-Identifier: Apache-2.0
"""Shows settings: Blender's panels with properties that Penumbra reads, and the add-on's own panels where Blender has
none for engines of add-ons."""

import bpy

from . import motion, program

ENGINE = "PENUMBRA"
# Blender's panels that are not shown: for unsupported features, or replaced by a panel of the add-on.
_NOT_OURS = {
    "DATA_PT_light", "DATA_PT_area", "DATA_PT_spot", "DATA_PT_falloff_curve", "DATA_PT_preview", "DATA_PT_lightprobe", "DATA_PT_context_lightprobe",
    "DATA_PT_lightprobe_parallax", "DATA_PT_lightprobe_display",
    "DATA_PT_camera_stereoscopy", "RENDER_PT_stereoscopy", "NODE_DATA_PT_light", "NODE_DATA_PT_spot", "OBJECT_PT_visibility",
    "VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes", "RENDER_PT_eevee_motion_blur", "RENDER_PT_freestyle",
    "RENDER_PT_gpencil", "EEVEE_WORLD_PT_mist"}
# Panels of EEVEE for properties that Penumbra also reads.
_OF_EEVEE = {"EEVEE_MATERIAL_PT_context_material"}


def panels_of_blender():
    """Returns the panels that are shown with Penumbra as the engine. Leaving out a panel also leaves out the panels within it."""
    found = {}
    for panel in bpy.types.Panel.__subclasses__():
        engines, name = getattr(panel, "COMPAT_ENGINES", None), panel.__name__
        if engines is None or name in _NOT_OURS or "freestyle" in name or panel in CLASSES:
            continue
        if "BLENDER_RENDER" in engines or name in _OF_EEVEE:
            found[name] = panel

    def is_left_out(panel):
        parent = getattr(panel, "bl_parent_id", "")
        if not parent or not hasattr(bpy.types, parent) or not hasattr(getattr(bpy.types, parent), "COMPAT_ENGINES"):
            return False
        return parent not in found or is_left_out(found[parent])
    return [panel for panel in found.values() if not is_left_out(panel)]


class _Panel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES

    def split_layout(self):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout


class PENUMBRA_PT_shadows(_Panel, bpy.types.Panel):
    bl_label = "Shadows"
    bl_context = "render"

    def draw(self, context):
        settings, layout = context.scene.penumbra, self.split_layout()
        layout.prop(settings, "exactness")
        if settings.exactness == program.SAMPLES:
            layout.prop(settings, "light_samples")
        for name in ("method", "light_cutoff", "shading_normals", "lenient", "device"):
            layout.prop(settings, name)


class PENUMBRA_PT_sampling(_Panel, bpy.types.Panel):
    bl_label = "Antialiasing"
    bl_context = "render"

    def draw(self, context):
        settings, layout = context.scene.penumbra, self.split_layout()
        layout.prop(settings, "pixel_samples")
        if settings.pixel_samples != "1":
            layout.prop(settings, "pixel_filter")
            if settings.pixel_filter == program.BLACKMAN_HARRIS:
                layout.prop(settings, "filter_width")


class PENUMBRA_PT_motion_blur(_Panel, bpy.types.Panel):
    bl_label = "Motion Blur"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context):
        scene, layout = context.scene, self.split_layout()
        layout.active = scene.render.use_motion_blur
        layout.prop(scene.penumbra, "motion_samples")
        owner = motion.position_owner(scene)
        if owner is not None:
            layout.prop(owner, "motion_blur_position", text="Position")
        layout.prop(scene.render, "motion_blur_shutter")
        layout.template_curve_mapping(scene.render, "motion_blur_shutter_curve")


class PENUMBRA_PT_bake(_Panel, bpy.types.Panel):
    bl_label = "Bake"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        settings, layout = context.scene.penumbra, self.split_layout()
        for name in ("bake_what", "bake_size", "bake_margin"):
            layout.prop(settings, name)
        layout.operator("penumbra.bake", icon="RENDER_STILL")


class PENUMBRA_PT_film(_Panel, bpy.types.Panel):
    bl_label = "Film"
    bl_context = "render"

    def draw(self, context):
        self.split_layout().prop(context.scene.render, "film_transparent", text="Transparent")


class PENUMBRA_PT_light(_Panel, bpy.types.Panel):
    bl_label = "Light"
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return context.light is not None and super().poll(context)

    def draw(self, context):
        light, layout = context.light, self.layout
        layout.row().prop(light, "type", expand=True)
        layout = self.split_layout()
        column = layout.column()
        column.prop(light, "color")
        column.prop(light, "energy")
        for name in ("exposure", "normalize", "use_soft_falloff"):  # exist only in newer versions of Blender
            if hasattr(light, name):
                column.prop(light, name)
        column.separator()
        column = layout.column(align=True)
        if light.type == "SUN":
            column.prop(light, "angle")
        elif light.type == "AREA":
            column.prop(light, "shape")
            if light.shape in ("SQUARE", "DISK"):
                column.prop(light, "size")
            else:
                column.prop(light, "size", text="Size X")
                column.prop(light, "size_y", text="Y")
        else:
            column.prop(light, "shadow_soft_size", text="Radius")
        layout.prop(light, "use_shadow", text="Casts Shadow")


class PENUMBRA_PT_spot(_Panel, bpy.types.Panel):
    bl_label = "Spot Shape"
    bl_context = "data"
    bl_parent_id = "PENUMBRA_PT_light"

    @classmethod
    def poll(cls, context):
        return context.light is not None and context.light.type == "SPOT" and super().poll(context)

    def draw(self, context):
        light, layout = context.light, self.split_layout()
        layout.prop(light, "spot_size", text="Size")
        layout.prop(light, "spot_blend", text="Blend", slider=True)
        layout.prop(light, "show_cone")


def _draw_nodes(layout, data, socket):
    """Draws the nodes of a material, light or world behind one input of its output node; without nodes, the button that enables them.
    Returns whether there are nodes."""
    if not data.use_nodes or data.node_tree is None:
        layout.prop(data, "use_nodes", icon="NODETREE")
        return False
    output = data.node_tree.get_output_node("CYCLES")
    if output is None:
        layout.label(text="No output node")
    else:
        layout.template_node_view(data.node_tree, output, output.inputs[socket])
    return True


class PENUMBRA_PT_light_nodes(_Panel, bpy.types.Panel):
    bl_label = "Nodes"
    bl_context = "data"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return context.light is not None and super().poll(context)

    def draw(self, context):
        self.split_layout()
        _draw_nodes(self.layout, context.light, "Surface")


class PENUMBRA_PT_surface(_Panel, bpy.types.Panel):
    bl_label = "Surface"
    bl_context = "material"

    @classmethod
    def poll(cls, context):
        return context.material is not None and not context.material.grease_pencil and super().poll(context)

    def draw(self, context):
        material, layout = context.material, self.split_layout()
        if not _draw_nodes(layout, material, "Surface"):
            layout.prop(material, "diffuse_color", text="Base Color")


class PENUMBRA_PT_material_settings(_Panel, bpy.types.Panel):
    bl_label = "Settings"
    bl_context = "material"

    @classmethod
    def poll(cls, context):
        return context.material is not None and not context.material.grease_pencil and super().poll(context)

    def draw(self, context):
        material, layout = context.material, self.split_layout()
        if hasattr(material, "blend_method"):
            layout.prop(material, "blend_method", text="Alpha")
            if material.blend_method == "CLIP":
                layout.prop(material, "alpha_threshold")
        layout.prop(material, "pass_index")


class PENUMBRA_PT_world(_Panel, bpy.types.Panel):
    bl_label = "Surface"
    bl_context = "world"

    @classmethod
    def poll(cls, context):
        return context.world is not None and super().poll(context)

    def draw(self, context):
        world, layout = context.world, self.split_layout()
        layout.prop(context.scene.penumbra, "world", text="Light")
        if not _draw_nodes(layout, world, "Surface"):
            layout.prop(world, "color")


class PENUMBRA_PT_visibility(_Panel, bpy.types.Panel):
    bl_label = "Visibility"
    bl_context = "object"

    @classmethod
    def poll(cls, context):
        return context.object is not None and super().poll(context)

    def draw(self, context):
        thing, layout = context.object, self.split_layout()
        layout.prop(thing, "hide_select", text="Selectable", toggle=False, invert_checkbox=True)
        column = layout.column(heading="Show In")
        column.prop(thing, "hide_viewport", text="Viewports", toggle=False, invert_checkbox=True)
        column.prop(thing, "hide_render", text="Renders", toggle=False, invert_checkbox=True)
        column = layout.column(heading="Ray Visibility")
        if thing.type == "LIGHT":
            column.prop(thing, "visible_diffuse", text="Diffuse")
        else:
            column.prop(thing, "visible_camera", text="Camera")
            column.prop(thing, "visible_shadow", text="Shadow")


class PENUMBRA_PT_passes(_Panel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        layer, layout = context.view_layer, self.split_layout()
        column = layout.column(heading="Include", align=True)
        for name in ("use_pass_combined", "use_pass_z", "use_pass_position", "use_pass_normal"):
            column.prop(layer, name)
        column = layout.column(heading="Cryptomatte", align=True)
        column.prop(layer, "use_pass_cryptomatte_object", text="Object")
        column.prop(layer, "use_pass_cryptomatte_material", text="Material")
        layout.prop(context.scene.penumbra, "light_passes")


class PENUMBRA_PT_override(_Panel, bpy.types.Panel):
    bl_label = "Override"
    bl_context = "view_layer"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        self.split_layout().prop(context.view_layer, "material_override")


CLASSES = (PENUMBRA_PT_shadows, PENUMBRA_PT_sampling, PENUMBRA_PT_motion_blur, PENUMBRA_PT_bake, PENUMBRA_PT_film, PENUMBRA_PT_light,
           PENUMBRA_PT_spot, PENUMBRA_PT_light_nodes, PENUMBRA_PT_surface, PENUMBRA_PT_material_settings, PENUMBRA_PT_world,
           PENUMBRA_PT_visibility, PENUMBRA_PT_passes, PENUMBRA_PT_override)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    for panel in panels_of_blender():
        panel.COMPAT_ENGINES.add(ENGINE)


def unregister():
    for panel in bpy.types.Panel.__subclasses__():
        if panel not in CLASSES:
            getattr(panel, "COMPAT_ENGINES", set()).discard(ENGINE)
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
