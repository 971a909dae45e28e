"""Penumbra as one of Blender's render engines."""

import os
import tempfile

import bpy

from . import exr, losses, passes, program
from .export import SceneWriter


class Refused(Exception):
    """What the user can act on."""


class PenumbraEngine(bpy.types.RenderEngine):
    bl_idname = "PENUMBRA"
    bl_label = "Penumbra"
    bl_use_preview = False
    bl_use_shading_nodes_custom = False
    bl_use_eevee_viewport = True

    def render(self, depsgraph):
        try:
            self._render(depsgraph)
        except (Refused, ValueError, OSError) as error:
            self._fail(str(error))

    def _fail(self, text):
        self.report({"ERROR"}, text)
        self.error_set(text)

    def _render(self, depsgraph):
        scene = depsgraph.scene
        settings = scene.penumbra
        size = picture_size(scene.render)
        binary = program.find(bpy.context.preferences.addons[__package__].preferences.program)
        lost = losses.Losses()
        with tempfile.TemporaryDirectory(prefix="penumbra-") as folder:
            glb, picture = (os.path.join(folder, name) for name in ("scene.glb", "picture.exr"))
            self.update_stats("", "Exporting")
            SceneWriter(depsgraph, lost, settings.shading_normals).write(glb, size)
            check_render(scene.render, scene, lost)
            self._say(lost, settings.lenient)
            self.update_stats("", "Rendering")
            command = program.arguments(binary, glb, picture, size, settings)
            code, printed = program.run(command, self.test_break)
            if code is None:
                return
            warnings, error = program.messages(printed)
            for warning in warnings:
                self.report({"WARNING"}, warning)
            if code != 0:
                raise Refused(error or f"penumbra ended with code {code}")
            with open(picture, "rb") as file:
                self._show(depsgraph, exr.read(file.read()), folder)

    def _say(self, lost, lenient):
        refused = losses.sentences(lost.refused)
        if refused and not lenient:
            raise Refused("; ".join(refused) + ". Shadows would be wrong; 'Lenient' renders all the same")
        for text in refused + losses.sentences(lost.mentioned):
            self.report({"WARNING"}, text)

    def _show(self, depsgraph, picture, folder):
        layer = depsgraph.view_layer.name
        if depsgraph.scene.penumbra.light_passes:
            for name, letters, _ in passes.own_passes(passes.layers(picture)):
                self.add_pass(name, len(letters), letters, layer=layer)
        result = self.begin_result(0, 0, picture.width, picture.height, layer=layer)
        # Pixels one by one would take Python minutes; Blender reads them itself where their names are its own.
        file = os.path.join(folder, "passes.exr")
        wanted = {one.name for one in result.layers[0].passes}
        content = {f"{layer}.{name}": values for name, values in passes.channels(picture).items()
                   if name.rpartition(".")[0] in wanted}
        with open(file, "wb") as out:
            out.write(exr.encoded(content))
        result.load_from_file(file)
        self.end_result(result)
        whole = self.get_result()
        for name, text in picture.attributes.items():
            if name.startswith("cryptomatte/"):
                whole.stamp_data_add_field(name, f"{layer}.{text}" if name.endswith("/name") else text)

    def update_render_passes(self, scene=None, renderlayer=None):
        """What the compositor's node has sockets for."""
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        if renderlayer.use_pass_z:
            self.register_pass(scene, renderlayer, "Depth", 1, "Z", "VALUE")
        for wanted, name in ((renderlayer.use_pass_position, "Position"), (renderlayer.use_pass_normal, "Normal")):
            if wanted:
                self.register_pass(scene, renderlayer, name, 3, "XYZ", "VECTOR")
        for wanted, name in ((renderlayer.use_pass_cryptomatte_object, "CryptoObject"),
                             (renderlayer.use_pass_cryptomatte_material, "CryptoMaterial")):
            for group in passes.matte_groups(name, scene.penumbra.pixel_samples) if wanted else ():
                self.register_pass(scene, renderlayer, group, 4, "RGBA", "COLOR")
        if scene.penumbra.light_passes:
            for name, letters, kind in passes.own_passes(likely_lights(scene)):
                self.register_pass(scene, renderlayer, name, len(letters), letters, kind)


def likely_lights(scene):
    """The lights that a render will have: lamps, and objects with an emissive material."""
    def shines(thing):
        return any(slot.material and slot.material.use_nodes and any(
            node.type == "EMISSION" or node.type == "BSDF_PRINCIPLED" and max(node.inputs["Emission"].default_value[:3]) > 0
            for node in slot.material.node_tree.nodes) for slot in thing.material_slots)
    return [passes.layer_of(thing.name) for thing in scene.objects if not thing.hide_render and (thing.type == "LIGHT" or shines(thing))]


def picture_size(render):
    """Pixels across and up. Refuses what a picture of another shape would be."""
    if render.use_border:
        raise Refused("a render region is set; Penumbra renders whole pictures (Ctrl Alt B takes it away)")
    if abs(render.pixel_aspect_x - render.pixel_aspect_y) > 1e-6 * render.pixel_aspect_x:
        raise Refused("the pixels are not square (Output, Aspect)")
    if render.use_multiview:
        raise Refused("stereoscopy is on; Penumbra renders one view")
    scale = render.resolution_percentage / 100
    return max(int(render.resolution_x * scale), 1), max(int(render.resolution_y * scale), 1)


def check_render(render, scene, lost):
    """What of the render's settings is left out."""
    if render.use_motion_blur:
        lost.mention("has motion blur switched on, which is left out", scene.name)
    if render.use_simplify:
        lost.mention("is simplified as the render settings say", scene.name)
