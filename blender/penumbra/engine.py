# SPDX-License-Identifier: Apache-2.0
"""Penumbra as one of Blender's render engines."""

import os
import traceback

import bpy
import numpy

from . import background, exr, frames, losses, moments, motion, passes, program, serving, settings, viewport
from .export import SceneWriter


class Refused(Exception):
    """An error that the user can act on."""


class PenumbraEngine(viewport.ShownInViews, bpy.types.RenderEngine):
    bl_idname = "PENUMBRA"
    bl_label = "Penumbra"
    bl_use_preview = False
    bl_use_shading_nodes_custom = False
    bl_use_eevee_viewport = True

    def render(self, depsgraph):
        """Renders one frame. Raises nothing: after an exception Blender continues with an empty picture, or crashes."""
        try:
            if background.failed_before() is not None:
                raise Refused(f"not rendered, because frame {background.failed_before()} failed")
            self._render(depsgraph)
        except (Refused, ValueError, OSError) as error:
            self._fail(depsgraph, str(error))
        except Exception as error:  # an error in the add-on itself
            traceback.print_exc()
            self._fail(depsgraph, f"the add-on failed ({type(error).__name__}: {error}); the console has the details")

    def _fail(self, depsgraph, text):
        text = f"Frame {depsgraph.scene.frame_current}: {text}"
        self.report({"ERROR"}, text)
        self.error_set(text)
        background.note_failure(depsgraph.scene.frame_current)

    def _render(self, depsgraph):
        scene = depsgraph.scene
        region = frames.region_of(scene.render, self.resolution_x, self.resolution_y)
        wanted, lost = scene.penumbra, losses.Losses()
        binary = program.find(settings.program_path())
        with program.Workspace() as workspace:
            glb, picture = (os.path.join(workspace.folder, name) for name in ("scene.glb", "picture.exr"))
            self.update_stats("", "Exporting")
            writer = SceneWriter(depsgraph, lost, wanted.shading_normals)
            writer.write(glb, region)
            frames.check_render(scene, depsgraph.view_layer_eval, lost)
            if motion.is_on(scene):
                frames.check_motion(scene, lost)
            self._say(lost, wanted.lenient)
            files = self._write_moments(depsgraph, glb, writer, region, lost)
            if files is None:
                return
            self.update_stats("", "Rendering")
            command = program.arguments(binary, glb, picture, region.size, wanted, files)
            code, printed = serving.run(command, self.test_break, workspace)
            if code is None:
                return
            warnings, error = program.messages(printed, glb, *files)
            for warning in warnings:
                self.report({"WARNING"}, warning)
            if code != 0:
                raise Refused(error or f"{binary} ended with code {code}")
            with open(picture, "rb") as file:
                self._show(depsgraph, exr.read(file.read()), workspace.folder, writer.background)

    def _write_moments(self, depsgraph, whole, writer, region, lost):
        """Writes the scene at each moment of the open shutter. Returns the files, an empty list if nothing moves, or
        None if cancelled. `whole`: the file of the frame's own time, written by `writer`; `lost`: losses already
        reported for it."""
        scene = depsgraph.scene
        times, own = motion.moments_of(scene), (scene.frame_current, scene.frame_subframe)
        if not times:
            return []
        lenient, news, found = scene.penumbra.lenient, [], moments.Moments(whole, writer, region)
        try:
            for number, time in enumerate(times):
                self.update_stats("", f"Exporting moment {number + 1} of {len(times)}")
                if self.test_break():
                    return None
                frame, rest = motion.whole_and_rest(time)
                self.frame_set(frame, subframe=rest)
                now = losses.Losses()
                try:
                    found.add(depsgraph, now)
                except ValueError as error:
                    raise ValueError(f"at {time:.6g}, while the shutter is open: {error}") from error
                news.append(lost.take_news(now))
        finally:
            self.frame_set(own[0], subframe=own[1])
        self._say(losses.together(news), lenient)
        return found.files()

    def _say(self, lost, lenient):
        refused = losses.sentences(lost.refused)
        if refused and not lenient:
            raise Refused("; ".join(refused) + ". The picture would be wrong; 'Lenient' renders it nevertheless")
        for text in refused + losses.sentences(lost.mentioned):
            self.report({"WARNING"}, text)

    def _show(self, depsgraph, picture, folder, world):
        layer = depsgraph.view_layer.name
        if not depsgraph.scene.render.film_transparent:
            passes.put_before(picture, world)
        names = passes.Names(layer)
        if depsgraph.scene.penumbra.light_passes:
            for name, letters, _ in names.own_passes(passes.layers(picture)):
                self.add_pass(name, len(letters), letters, layer=layer)
        result = self.begin_result(0, 0, picture.width, picture.height, layer=layer)
        # Copying pixels one by one would take Python minutes; Blender reads passes with its own names from the file.
        file = os.path.join(folder, "passes.exr")
        wanted = {one.name for one in result.layers[0].passes}
        content = {f"{layer}.{name}": values for name, values in names.channels(picture).items()
                   if name.rpartition(".")[0] in wanted}
        for name in wanted:  # passes for several view samples, if the picture has only one
            if name.startswith("Crypto"):
                for letter in "RGBA":
                    content.setdefault(f"{layer}.{name}.{letter}", numpy.zeros((picture.height, picture.width), numpy.float32))
        with open(file, "wb") as out:
            out.write(exr.encoded(content))
        result.load_from_file(file)
        self.end_result(result)
        for full, short in names.shortened:
            self.report({"WARNING"}, f"the pass of '{full}' is named '{short}': Blender does not support longer names")
        whole = self.get_result()
        for name, text in picture.attributes.items():
            if name.startswith("cryptomatte/"):
                whole.stamp_data_add_field(name, f"{layer}.{text}" if name.endswith("/name") else text)

    def update_render_passes(self, scene=None, renderlayer=None):
        """Registers the passes for which the compositor's node gets sockets. Like render, raises nothing."""
        try:
            self._register_passes(scene, renderlayer)
        except Exception:
            traceback.print_exc()

    def _register_passes(self, scene, renderlayer):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        if renderlayer.use_pass_z:
            self.register_pass(scene, renderlayer, "Depth", 1, "Z", "VALUE")
        for wanted, name in ((renderlayer.use_pass_position, "Position"), (renderlayer.use_pass_normal, "Normal")):
            if wanted:
                self.register_pass(scene, renderlayer, name, 3, "XYZ", "VECTOR")
        for wanted, name in ((renderlayer.use_pass_cryptomatte_object, "CryptoObject"),
                             (renderlayer.use_pass_cryptomatte_material, "CryptoMaterial")):
            for group in passes.matte_groups(name, int(scene.penumbra.pixel_samples) * motion.samples_of(scene)) if wanted else ():
                self.register_pass(scene, renderlayer, group, 4, "RGBA", "COLOR")
        if scene.penumbra.light_passes:
            for name, letters, kind in passes.Names(renderlayer.name).own_passes(frames.likely_lights(scene)):
                self.register_pass(scene, renderlayer, name, len(letters), letters, kind)
