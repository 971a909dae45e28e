# SPDX-License-Identifier: Apache-2.0
"""Pixels that a render requests, and settings of a scene that are not supported. Independent of bpy."""

from dataclasses import dataclass

import numpy

from . import materials, passes, sky


@dataclass
class Region:
    """A rectangle of pixels in a whole picture; its lower left corner is at (left, bottom)."""
    whole: tuple
    size: tuple
    left: int = 0
    bottom: int = 0

    def shift_of_middle(self):
        """Returns the offset from the whole picture's middle to the region's, in heights of the region."""
        return tuple((start + side / 2 - all / 2) / self.size[1]
                     for start, side, all in zip((self.left, self.bottom), self.size, self.whole))


def region_of(render, width, height):
    """Returns the region to render. `width`, `height`: the whole picture's, as Blender rounds them. Raises ValueError
    for pictures that are not supported."""
    if abs(render.pixel_aspect_x - render.pixel_aspect_y) > 1e-6 * render.pixel_aspect_x:
        raise ValueError("the pixels are not square (Output, Format, Aspect); Penumbra renders square pixels")
    if render.use_multiview:
        raise ValueError("stereoscopy is on (Output, Stereoscopy); Penumbra renders one view")
    if not render.use_border:
        return Region((width, height), (width, height))
    # Rounds as Blender does, in single precision.
    left, right = (int(numpy.float32(x) * numpy.float32(width)) for x in (render.border_min_x, render.border_max_x))
    bottom, top = (int(numpy.float32(y) * numpy.float32(height)) for y in (render.border_min_y, render.border_max_y))
    if right <= left or top <= bottom:
        raise ValueError("the render region has no pixels (Ctrl Alt B removes it)")
    return Region((width, height), (right - left, top - bottom), left, bottom)


_ABSENT = {
    "mist": "Mist", "vector": "Vector", "uv": "UV", "object_index": "Object Index", "material_index": "Material Index",
    "diffuse_direct": "Diffuse Direct", "diffuse_indirect": "Diffuse Indirect", "diffuse_color": "Diffuse Color",
    "glossy_direct": "Glossy Direct", "glossy_indirect": "Glossy Indirect", "glossy_color": "Glossy Color",
    "transmission_direct": "Transmission Direct", "transmission_indirect": "Transmission Indirect",
    "transmission_color": "Transmission Color", "subsurface_direct": "Subsurface Direct",
    "subsurface_indirect": "Subsurface Indirect", "subsurface_color": "Subsurface Color", "emit": "Emission",
    "environment": "Environment", "shadow": "Shadow", "ambient_occlusion": "Ambient Occlusion",
    "cryptomatte_asset": "Cryptomatte Asset"}


def check_render(scene, layer, lost):
    """Reports the settings of a scene and a view layer that are left out."""
    render = scene.render
    if render.use_simplify:
        lost.mention("is simplified as the render settings say", scene.name)
    if getattr(render, "use_freestyle", False):
        lost.mention("has Freestyle lines, which are not drawn", scene.name)
    absent = [name for key, name in _ABSENT.items() if getattr(layer, f"use_pass_{key}", False)]
    if absent:
        lost.mention(f"asks for passes that Penumbra does not have ({', '.join(absent)})", layer.name)


def check_motion(scene, lost):
    """Reports settings of Cycles' motion blur that are left out."""
    for thing in scene.objects:
        own = getattr(thing, "cycles", None)
        if not thing.hide_render and not (getattr(own, "use_motion_blur", True) and getattr(own, "use_deform_motion", True)):
            lost.mention("has motion blur switched off in Cycles (Object, Motion Blur), and is blurred here", thing.name)
    if getattr(getattr(scene, "cycles", None), "rolling_shutter_type", "NONE") != "NONE":
        lost.mention("has a rolling shutter, which is left out", scene.name)


def likely_lights(scene):
    """Returns the layer names of the lights that a render will have: lamps, objects with an emissive material, and the
    world."""
    def shines(thing):
        return any(slot.material and materials.may_shine(slot.material) for slot in thing.material_slots)
    found = [thing for thing in scene.objects if not thing.hide_render and (thing.type == "LIGHT" or shines(thing))]
    if scene.penumbra.world != sky.SEEN and sky.may_light(scene.world):
        found.append(scene.world)
    return [passes.layer_of(thing.name) for thing in found]
