# SPDX-License-Identifier: Apache-2.0
"""Renders small scenes (scenes.py) with the add-on and with Cycles' direct light, and compares them. Run inside
Blender:

    run.sh cycles.py ADDON.zip PENUMBRA WORK [SCENE...]

Cycles renders each scene twice, with different seeds: the difference is its noise. Prints a table, and exits 1 if any scene is off.

The add-on's V divides the pixels into three regions: all lights visible, none visible, and between. In lit and partly
lit regions our sum over Cycles' sum is 1 within five standard errors and BIAS, and single pixels differ by no more than
Cycles' own noise. In the umbra Cycles sees no light. Pixels whose neighbours show another surface are left out: at
borders between surfaces the two programs may round to different surfaces at a pixel's centre.
"""

import json
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import numpy  # noqa: E402

import scenes  # noqa: E402
from inside import ARGUMENTS, OUT, channels, fresh  # noqa: E402

SAMPLES = 256
SCALE = int(os.environ.get("SCALE", "1"))  # factor of the pictures' sides, for pictures that people look at
STANDARD_ERRORS = 5.0
# Bias of Cycles in the ratio of sums, due to its single-precision sampling of lights: 2e-4 where measured, on unshaded
# pixels with up to 65536 samples.
BIAS = 1e-3
# Pixels next to an umbra's edge may get a little light in Cycles, whose pixels are a hundredth wide and not points.
EDGE = 1e-2
# Scenes whose light is counted in light samples, here the largest number of them: it passes holes and panes, or comes
# from a world.
COUNTED = {"translucent", "cut_out", "world_color_counted", "world_and_lamp", "world_picture", "world_picture_turned",
           "world_picture_texture_mapping", "world_picture_mirrored", "world_and_translucent", "forest"}
# Scenes with several view samples for each pixel: means are compared at every pixel. Penumbra takes 64, evenly spread;
# 64 random ones would have twice the noise of Cycles' 256.
LENSES = {"depth_of_field", "orthographic_depth_of_field", "motion_and_lens"}
# Scenes in motion, at pixels' centres except for the last: 64 moments, evenly spread. Cycles exposes only the first 254
# of 256 parts of its shutter (docs/against-cycles.md, In motion), so its shutter time is made longer by that factor.
MOVING = {"motion_of_a_thing", "motion_of_the_camera", "motion_of_a_mesh", "motion_of_a_shining_thing", "motion_and_lens"}
BLURRED = LENSES | MOVING
# Further differences, where Cycles uses another shape: a point lamp of radius r at distance d is a disk in Cycles and a
# ball here, which gives up to r² / d² more (disks of spots are in their cones); an icosphere of 1280 faces and its
# sphere differ by 0.25 %; under the tube Cycles is 0.15 % below Lambert's closed form, which our result meets to 1e-6
# (both at 509 pixels of the floor).
MODEL = {"point": 0.1 ** 2 / 2.5 ** 2, "many_lamps": 0.05 ** 2 / 2 ** 2,
         "shadowless_lamp": 0.1 ** 2 / 2 ** 2, "emissive_sphere": 2.5e-3, "emissive_tube": 2e-3}


def colors(found):
    return numpy.stack([found[f"Combined.{letter}"] for letter in "RGB"], axis=-1).astype(numpy.float64)


def by_cycles(name, scene, seed, path):
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples, cycles.seed, cycles.max_bounces = SAMPLES, seed, 0
    cycles.transparent_max_bounces, cycles.use_denoising, cycles.use_adaptive_sampling = 8, False, False
    cycles.sample_clamp_direct = cycles.light_sampling_threshold = 0
    if name in LENSES:
        cycles.pixel_filter_type, cycles.filter_width = "BOX", 1
    else:
        cycles.pixel_filter_type, cycles.filter_width = "GAUSSIAN", 0.01  # a box would cover the whole pixel
    shutter = scene.render.motion_blur_shutter
    scene.render.motion_blur_shutter = shutter * 256 / 254
    try:
        return colors(channels(scene, path))
    finally:
        scene.render.motion_blur_shutter = shutter


def by_penumbra(name, scene, path):
    scene.render.engine = "PENUMBRA"
    if name in COUNTED:
        scene.penumbra.exactness, scene.penumbra.light_samples = "SAMPLES", 4096
    if name in LENSES:
        scene.penumbra.pixel_samples = "16" if name in MOVING else "64"
    if name in MOVING:
        scene.penumbra.motion_samples = 16 if name in LENSES else 64
    scene.view_layers[0].use_pass_normal = scene.view_layers[0].use_pass_z = True
    scene.view_layers[0].use_pass_position = True
    return channels(scene, path)


def inner(found):
    """Returns the pixels that show the same surface as all their neighbours."""
    position = numpy.stack([found[f"Position.{axis}"] for axis in "XYZ"], axis=-1)
    normal = numpy.stack([found[f"Normal.{axis}"] for axis in "XYZ"], axis=-1)
    same = found["Combined.A"] == 1
    for axis in (0, 1):
        for step in (1, -1):
            other = numpy.roll(position, step, axis) - position
            turned = numpy.sum(numpy.roll(normal, step, axis) * normal, axis=-1)
            flat = numpy.abs(numpy.sum(other * normal, axis=-1)) < 1e-3 * numpy.linalg.norm(other, axis=-1) + 1e-6
            same &= flat & (turned > 0.999)
    same[0], same[-1], same[:, 0], same[:, -1] = False, False, False, False
    return same


def regions(found, lights):
    values = numpy.stack([found[f"V {light}.X"] for light in lights])
    return {"lit": numpy.all(values == 1, axis=0), "umbra": numpy.all(values == 0, axis=0),
            "penumbra": numpy.any((values > 0) & (values < 1), axis=0)}


def compare(name, found, first, second):
    """Returns a row for each region of at least 20 pixels: its figures, and whether they are within bounds."""
    lights = [key[2:-2] for key in found if key.startswith("V ")]
    ours, theirs = colors(found), (first + second) / 2
    usable, rows = inner(found), []
    places = regions(found, lights) if lights else {}
    if name in BLURRED:
        usable = numpy.ones_like(usable)
        places = {"all": usable}
    ours_too = numpy.sqrt(5) if name in BLURRED else 1
    for region, where in places.items():
        where = where & usable
        row = {"region": region, "pixels": int(where.sum())}
        if row["pixels"] < 20:
            continue
        a, b = ours[where], theirs[where]
        if region == "umbra":
            b = b / theirs[usable].max()
            row.update(ours=float(a.max()), cycles=float(b.mean()), brightest=float(b.max()))
            row["well"] = row["ours"] == 0 and row["brightest"] <= EDGE and row["cycles"] <= EDGE / 100
        else:
            noise = ours_too * numpy.sqrt(numpy.mean((first[where] - second[where]) ** 2)) / 2
            row.update(ratio=float(a.sum() / b.sum()), error=float(noise / numpy.sqrt(a.size) / b.mean()),
                       rms=float(numpy.sqrt(numpy.mean((a - b) ** 2)) / b.mean()), noise=float(noise / b.mean()))
            row["allowed"] = STANDARD_ERRORS * row["error"] + BIAS + MODEL.get(name, 0)
            model = (2 * BIAS + MODEL.get(name, 0)) * numpy.sqrt(numpy.mean(b ** 2)) / b.mean()
            row["well"] = abs(row["ratio"] - 1) <= row["allowed"] and row["rms"] <= 1.5 * (row["noise"] + model)
        row["well"] = bool(row["well"])
        rows.append(row)
    return rows


def text_of(name, row):
    numbers = " ".join(f"{key} {value:.5f}" for key, value in row.items() if isinstance(value, float))
    return f"compare: {name:20} {row['region']:9} {row['pixels']:6}  {numbers}{'' if row['well'] else '  WRONG'}"


def main():
    results, failed = {}, []
    for name in ARGUMENTS or scenes.SCENES:
        scene = fresh(scenes.SCENES[name])
        scene.render.resolution_x, scene.render.resolution_y = (SCALE * side for side in (scene.render.resolution_x, scene.render.resolution_y))
        found = by_penumbra(name, scene, os.path.join(OUT, f"{name}.penumbra.exr"))
        cycles = [by_cycles(name, scene, seed, os.path.join(OUT, f"{name}.cycles{seed}.exr")) for seed in (1, 2)]
        rows = results[name] = compare(name, found, *cycles)
        for row in rows:
            print(text_of(name, row), flush=True)
        if not rows or not all(row["well"] for row in rows):
            failed.append(name)
    with open(os.path.join(OUT, "results.json"), "w") as file:
        json.dump(results, file, indent=1)
    print(f"compare: {'off: ' + ', '.join(failed) if failed else f'{len(results)} scenes, all right'}", flush=True)
    if failed:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
