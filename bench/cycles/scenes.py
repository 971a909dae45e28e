# SPDX-License-Identifier: Apache-2.0
"""Scenes for error against time (against_cycles.py) and for whole processes (whole_processes.py). Runs inside Blender:

    blender -b --factory-startup --python-exit-code 1 -P scenes.py -- ADDON.zip FOLDER WIDTH HEIGHT [NAME …]

Without names, writes the five scenes of against_cycles.py. Files: FOLDER/NAME.blend; FOLDER/NAME.glb, as the add-on
gives it to the program, at frame 1; and FOLDER/NAME.json with `triangles`, with `aperture` and `focus` of the camera's
lens, which is switched off, and with `mover`, the object that moves in Blender's animation by `step` from frame to
frame.
"""

import json
import os
import random
import sys
from math import radians, sin

import bpy
import numpy
from mathutils import Vector

ZIP, FOLDER, WIDTH, HEIGHT, *NAMES = sys.argv[sys.argv.index("--") + 1:]


def diffuse(name, color):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output, surface = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new("ShaderNodeBsdfDiffuse")
    surface.inputs["Color"].default_value = (*color, 1)
    tree.links.new(surface.outputs[0], output.inputs["Surface"])
    return material


def place(thing, name, color):
    thing.name = name
    thing.data.materials.clear()
    thing.data.materials.append(diffuse(name, color))
    return thing


def floor():
    bpy.ops.mesh.primitive_plane_add(size=12)
    place(bpy.context.object, "Floor", (0.6, 0.6, 0.6))


def lamp(name, kind, location, target=(0, 0, 0.5), **values):
    data = bpy.data.lights.new(name, kind)
    for key, value in values.items():
        setattr(data, key, value)
    thing = bpy.data.objects.new(name, data)
    thing.location = location
    thing.rotation_euler = (Vector(target) - Vector(location)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(thing)


def camera(location=(4.2, -5.0, 3.4), target=(0, 0, 0.6), angle=40):
    data = bpy.data.cameras.new("Camera")
    data.angle = radians(angle)
    data.dof.aperture_fstop, data.dof.focus_distance = 0.25, 5.5
    thing = bpy.data.objects.new("Camera", data)
    thing.location = location
    thing.rotation_euler = (Vector(target) - Vector(location)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.scene.camera = thing


def still_life():
    """Makes a still life of a few hundred triangles."""
    floor()
    bpy.ops.mesh.primitive_torus_add(location=(0.9, -0.2, 0.3), major_radius=0.6, minor_radius=0.22, major_segments=24, minor_segments=12)
    place(bpy.context.object, "Ring", (0.8, 0.4, 0.3))
    bpy.ops.mesh.primitive_cube_add(size=1, location=(-0.9, 0.3, 0.9), rotation=(0.4, 0.3, 0.5))
    place(bpy.context.object, "Box", (0.4, 0.6, 0.8))
    bpy.ops.mesh.primitive_cone_add(vertices=24, radius1=0.4, depth=1.4, location=(0.1, 1.2, 0.7))
    place(bpy.context.object, "Cone", (0.5, 0.8, 0.4))


def small():
    still_life()
    lamp("Key", "AREA", (1.5, -2, 4.5), shape="SQUARE", size=0.3, energy=300)


def large_penumbrae():
    still_life()
    lamp("Key", "AREA", (1.5, -2, 4.5), shape="SQUARE", size=2.5, energy=300)


def dense():
    """Makes a terrain and a bumpy ball with 504,000 triangles in total, none larger than a few pixels."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=420, y_subdivisions=210, size=8)
    terrain = place(bpy.context.object, "Terrain", (0.6, 0.6, 0.5))
    for vertex in terrain.data.vertices:
        x, y = vertex.co.x, vertex.co.y
        vertex.co.z = 0.12 * sin(3 * x) * sin(2.6 * y) + 0.03 * sin(17 * x + 9 * y)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=8, radius=0.9)
    ball = place(bpy.context.object, "Ball", (0.7, 0.5, 0.4))
    for vertex in ball.data.vertices:
        x, y, z = vertex.co
        vertex.co *= 1 + 0.04 * sin(11 * x) * sin(13 * y) * sin(12 * z)
    ball.location = (0, 0, 1.2)
    lamp("Key", "AREA", (1.5, -2, 4.5), shape="DISK", size=0.8, energy=300)


def four_lamps():
    still_life()
    lamp("Key", "AREA", (2.5, -2, 4), shape="RECTANGLE", size=0.8, size_y=0.4, energy=150)
    lamp("Rim", "AREA", (-3, 2, 3.5), shape="DISK", size=0.6, energy=80)
    lamp("Bulb", "POINT", (-1.5, -2.5, 2.5), shadow_soft_size=0.15, energy=60)
    lamp("Sun", "SUN", (0, -3, 6), angle=radians(3), energy=0.5)


def sky():
    """The still life under an environment picture: a sky brighter at the horizon, and a low sun of 8 degrees behind haze."""
    still_life()
    width, height = 512, 256
    u, v = numpy.meshgrid((numpy.arange(width) + 0.5) / width, (numpy.arange(height) + 0.5) / height)
    longitude, latitude = 2 * numpy.pi * (0.5 - u), numpy.pi * (v - 0.5)  # rows from the bottom; the middle column along +X
    toward = numpy.stack([numpy.cos(latitude) * numpy.cos(longitude), numpy.cos(latitude) * numpy.sin(longitude), numpy.sin(latitude)], axis=-1)
    sun = Vector((0.5, -0.6, 0.62)).normalized()
    angle = numpy.degrees(numpy.arccos(numpy.clip(toward @ numpy.array(sun), -1, 1)))
    shade = numpy.where(latitude > 0, 1.2 - 0.8 * numpy.sin(numpy.abs(latitude)), 0.2)
    pixels = numpy.ones((height, width, 4), numpy.float32)
    pixels[..., :3] = shade[..., None] * [0.45, 0.6, 1.0] + (80 * numpy.clip(5 - angle, 0, 1) + 3 * numpy.exp(-angle / 8))[..., None] * [1.0, 0.9, 0.7]
    image = bpy.data.images.new("Sky", width, height, float_buffer=True)
    image.colorspace_settings.name = "Linear"
    image.pixels.foreach_set(pixels.ravel())
    image.filepath_raw, image.file_format = os.path.join(FOLDER, "sky.exr"), "OPEN_EXR"
    image.save()
    world = bpy.data.worlds.new("World")
    bpy.context.scene.world = world
    world.use_nodes = True
    picture = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    picture.image = image
    world.node_tree.links.new(picture.outputs["Color"], world.node_tree.nodes["Background"].inputs["Color"])


def lamps(count):
    """Makes point lamps, spot lamps and rectangles in turn over a floor of 40 × 40 with 64 blocks; random numbers are
    the same in every run."""
    numbers = random.Random(7)
    bpy.ops.mesh.primitive_plane_add(size=40)
    place(bpy.context.object, "Floor", (0.6, 0.6, 0.6))
    for i in range(64):
        height = numbers.uniform(0.5, 2.5)
        bpy.ops.mesh.primitive_cube_add(size=1, location=(4 * (i % 8) - 14, 4 * (i // 8) - 14, height / 2),
                                        rotation=(0, 0, numbers.uniform(0, 1.5)))
        bpy.context.object.scale = (1.2, 1.2, height)
        place(bpy.context.object, f"Block {i}", [numbers.uniform(0.3, 0.9) for _ in range(3)])
    for i in range(count):
        x, y, z = numbers.uniform(-17, 17), numbers.uniform(-17, 17), numbers.uniform(3.6, 5)
        down = (x + numbers.uniform(-1, 1), y + numbers.uniform(-1, 1), 0)
        if i % 3 == 0:
            lamp(f"Lamp {i}", "POINT", (x, y, z), down, shadow_soft_size=0.1, energy=20)
        elif i % 3 == 1:
            lamp(f"Lamp {i}", "SPOT", (x, y, z), down, shadow_soft_size=0.1, energy=60, spot_size=radians(60), spot_blend=0.2)
        else:
            lamp(f"Lamp {i}", "AREA", (x, y, z), down, shape="RECTANGLE", size=0.4, size_y=0.2, energy=20)
    camera((20, -24, 16), (0, 0, 0), 50)


def lamps_200():
    lamps(200)


def lamps_1000():
    lamps(1000)


STEP = (0.5, 0, 0)  # movement from frame to frame


def let_move(thing):
    """Animates the object from frame 0 to frame 2 at constant speed, with its own place at frame 1."""
    place = thing.location.copy()
    for frame, share in ((0, -1), (2, 1)):
        thing.location = place + share * Vector(STEP)
        thing.keyframe_insert("location", frame=frame)
    for curve in thing.animation_data.action.fcurves:
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"
    bpy.context.scene.frame_set(1)


def lens_of(camera):
    from penumbra.lamps import focus_of
    camera.data.dof.use_dof = True
    aperture, focus = focus_of(camera, camera.matrix_world)
    camera.data.dof.use_dof = False
    return {"aperture": aperture, "focus": focus}


def write(name, build):
    from penumbra.export import SceneWriter
    from penumbra.frames import region_of
    from penumbra.losses import Losses
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="cycles")
    bpy.ops.preferences.addon_enable(module="penumbra")
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = int(WIDTH), int(HEIGHT), 100
    build()
    if scene.camera is None:
        camera()
    mover = next((bpy.data.objects[name] for name in ("Ball", "Box") if name in bpy.data.objects), None)
    if mover is not None:
        let_move(mover)
    scene.render.engine = "PENUMBRA"
    losses = Losses()
    writer = SceneWriter(bpy.context.evaluated_depsgraph_get(), losses, True)
    writer.write(os.path.join(FOLDER, f"{name}.glb"), region_of(scene.render, int(WIDTH), int(HEIGHT)))
    if losses.refused or losses.mentioned:
        raise SystemExit(f"{name}: {losses.refused} {losses.mentioned}")
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(FOLDER, f"{name}.blend"))
    triangles = sum(len(polygon.vertices) - 2 for thing in scene.objects if thing.type == "MESH" for polygon in thing.data.polygons)
    with open(os.path.join(FOLDER, f"{name}.json"), "w") as file:
        json.dump({"triangles": triangles, **lens_of(scene.camera), "mover": mover.name if mover else None, "step": STEP}, file)


bpy.ops.preferences.addon_install(filepath=ZIP)
SCENES = {function.__name__: function for function in (small, large_penumbrae, dense, four_lamps, sky, lamps_200, lamps_1000)}
for name in NAMES or list(SCENES)[:5]:
    write(name, SCENES[name])
