# SPDX-License-Identifier: Apache-2.0
"""The Bake button: writes the light or visibility at the active object into one of Blender's images, by the active UV map."""

import math
import os
import traceback

import bpy
import numpy

from . import exr, losses, program, settings
from .export import SceneWriter

# Name of the object's mesh in the exchange file: longer than any that Blender allows, so that no other has it.
_NAME = "baked" + 256 * "_"
_OF = "penumbra_bake_of"  # custom property of a baked image: the object's name
_LINEAR = ("Linear Rec.709", "Linear")


class PENUMBRA_OT_bake(bpy.types.Operator):
    """Bake the active object's light or visibility by its active UV map into an image"""
    bl_idname = "penumbra.bake"
    bl_label = "Bake"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == "MESH"

    def execute(self, context):
        try:
            image = self._bake(context)
        except (ValueError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        except Exception as error:  # an error in the add-on itself
            traceback.print_exc()
            self.report({"ERROR"}, f"the add-on failed ({type(error).__name__}: {error}); the console has the details")
            return {"CANCELLED"}
        self.report({"INFO"}, f"baked into the image '{image.name}'")
        return {"FINISHED"}

    def _bake(self, context):
        thing, wanted, lost = context.object, context.scene.penumbra, losses.Losses()
        if not thing.data.uv_layers:
            raise ValueError(f"'{thing.name}' has no UV map; unwrap it first, without overlaps")
        if thing.hide_render:
            raise ValueError(f"'{thing.name}' is disabled in renders; enable it there (the camera in the outliner)")
        if not thing.visible_get():
            raise ValueError(f"'{thing.name}' is hidden in the viewport; show it first")
        binary = program.find(settings.program_path())
        with program.Workspace() as workspace:
            glb, picture = (os.path.join(workspace.folder, name) for name in ("scene.glb", "baked.exr"))
            writer = SceneWriter(context.evaluated_depsgraph_get(), lost, wanted.shading_normals, Baked(thing))
            writer.write(glb, None)
            refused = losses.sentences(lost.refused)
            if refused and not wanted.lenient:
                raise ValueError("; ".join(refused) + ". The image would be wrong; 'Lenient' bakes it nevertheless")
            command = program.bake_arguments(binary, glb, picture, _NAME, wanted)
            code, printed = program.run(command, lambda: False, workspace)
            warnings, error = program.messages(printed.replace(_NAME, thing.name), glb)
            for text in refused + losses.sentences(lost.mentioned) + warnings:
                self.report({"WARNING"}, text)
            if code != 0:
                raise ValueError(error or f"{binary} ended with code {code}")
            with open(picture, "rb") as file:
                return _put(image_for(thing.name, wanted.bake_size), exr.read(file.read()), wanted.bake_what)


class Baked:
    """The object to bake, as SceneWriter needs it."""
    name = _NAME

    def __init__(self, thing):
        self._thing = thing

    def is_it(self, instance):
        return not instance.is_instance and instance.object.original == self._thing


def image_for(name, size):
    """Returns the object's image of this size. Reuses only an image that an earlier bake of the object made."""
    image = next((image for image in bpy.data.images if image.get(_OF) == name and image.is_float), None)
    if image is None:
        image = bpy.data.images.new(f"{name} light", size, size, float_buffer=True)
        image[_OF] = name
    elif tuple(image.size) != (size, size):
        image.scale(size, size)
    spaces = image.colorspace_settings.bl_rna.properties["name"].enum_items.keys()
    image.colorspace_settings.name = next(name for name in (*_LINEAR, "Non-Color") if name in spaces)
    return image


def _put(image, picture, what):
    values = numpy.ones((picture.height, picture.width, 4), numpy.float32)
    for number, letter in enumerate("RGB"):
        values[..., number] = picture.channels["V"] if what == "VISIBILITY" else picture.channels[letter] / math.pi
    image.pixels.foreach_set(values[::-1].ravel())
    image.update()
    image.pack()
    return image
