# SPDX-License-Identifier: Apache-2.0
"""Motion blur: the moments of an open shutter. Independent of bpy."""

import math

import numpy

START, CENTER, END = "START", "CENTER", "END"


def position_owner(scene):
    """Returns the settings that determine whether the frame is at the start, middle or end of the shutter's time:
    Blender's own since 4.2, before that Cycles', or EEVEE's if there is no Cycles."""
    for owner in (scene.render, getattr(scene, "cycles", None), getattr(scene, "eevee", None)):
        if hasattr(owner, "motion_blur_position"):
            return owner
    return None


def is_on(scene):
    return scene.render.use_motion_blur and scene.render.motion_blur_shutter > 0 and scene.penumbra.motion_samples > 1


def samples_of(scene):
    """Returns the number of moments of a frame; 1: only the frame's own time."""
    return scene.penumbra.motion_samples if is_on(scene) else 1


def moments_of(scene):
    """Returns the moments of the frame's open shutter, in frames; none without motion blur."""
    if not is_on(scene):
        return []
    owner = position_owner(scene)
    curve = scene.render.motion_blur_shutter_curve
    curve.initialize()
    heights = [curve.evaluate(curve.curves[0], place) for place in numpy.linspace(0, 1, 257)]
    return moments(scene.frame_current + scene.frame_subframe, scene.render.motion_blur_shutter,
                   owner.motion_blur_position if owner is not None else CENTER, scene.penumbra.motion_samples, heights)


def moments(frame, shutter, position, count, heights):
    """Returns the middles of `count` parts of the shutter's time with equal exposure. `shutter`: length in frames;
    `heights`: how far the shutter is open, at equal time steps from its opening to its closing."""
    exposed = numpy.concatenate([[0], numpy.cumsum(numpy.maximum(heights, 0)[1:] + numpy.maximum(heights, 0)[:-1])])
    shares = (numpy.arange(count) + 0.5) / count
    if exposed[-1] > 0:
        shares = numpy.interp(shares * exposed[-1], exposed, numpy.linspace(0, 1, len(exposed)))
    opens = frame - {START: 0, CENTER: shutter / 2, END: shutter}[position]
    return [float(opens + shutter * share) for share in shares]


def whole_and_rest(time):
    """Returns a time in Blender's form: a whole frame, and the fraction from 0 to below 1."""
    frame = math.floor(time)
    return frame, time - frame
