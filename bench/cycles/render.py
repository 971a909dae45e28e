# SPDX-License-Identifier: Apache-2.0
"""Renders one picture of an open file, for against_cycles.py. Runs inside Blender:

    blender -b FILE.blend --python-exit-code 1 -P render.py -- OUT.exr ENGINE SAMPLES PART SEED PENUMBRA [X0 X1 Y0 Y1]

`ENGINE`: CYCLES or PENUMBRA. `SAMPLES`: light samples a pixel of Cycles. `PART`: centres (one view sample at each
pixel's centre), motion (as centres, while the shutter is open for half a frame), antialiased (a Blackman-Harris filter
of 1.5 pixels, with 16 view samples of Penumbra) or lens (as antialiased, through the camera's lens). X0 to Y1: the
crop, as fractions of the picture, Y upward.
"""

import sys

import bpy

OUT, ENGINE, SAMPLES, PART, SEED, PENUMBRA, *CROP = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.preferences.addon_enable(module="cycles" if ENGINE == "CYCLES" else "penumbra")
scene = bpy.context.scene
render = scene.render
is_filtered = PART in ("antialiased", "lens")
scene.camera.data.dof.use_dof = PART == "lens"
render.use_motion_blur = PART == "motion"
render.motion_blur_shutter = 0.5
render.engine, render.film_transparent, render.use_compositing, render.use_sequencer = ENGINE, True, False, False
settings = render.image_settings
settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR_MULTILAYER", "32", "ZIP"
render.filepath = OUT
if CROP:
    render.use_border, render.use_crop_to_border = True, True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = map(float, CROP)
if ENGINE == "CYCLES":
    # Only direct light, and no settings that bias samples.
    cycles = scene.cycles
    cycles.samples, cycles.seed, cycles.max_bounces = int(SAMPLES), int(SEED), 0
    cycles.use_denoising, cycles.use_adaptive_sampling = False, False
    cycles.sample_clamp_direct = cycles.light_sampling_threshold = 0
    cycles.motion_blur_position = "CENTER"
    cycles.pixel_filter_type = "BLACKMAN_HARRIS" if is_filtered else "GAUSSIAN"
    cycles.filter_width = 1.5 if is_filtered else 0.01
    if CROP:
        scene.view_layers[0].use_pass_position = scene.view_layers[0].use_pass_normal = True
else:
    bpy.context.preferences.addons["penumbra"].preferences.program = PENUMBRA
    scene.penumbra.pixel_samples = "16" if is_filtered else "1"
    scene.penumbra.pixel_filter, scene.penumbra.filter_width = "BLACKMAN_HARRIS", 1.5
    if PART == "motion":  # open as long as Cycles exposes (against_cycles.py), from the start of its shutter time
        from penumbra.motion import position_owner
        position_owner(scene).motion_blur_position = "START"
        render.motion_blur_shutter *= 254 / 256
        scene.frame_set(scene.frame_current - 1, subframe=0.75)
bpy.ops.render.render(write_still=True)
