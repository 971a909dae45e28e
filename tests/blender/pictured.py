# SPDX-License-Identifier: Apache-2.0
"""Makes docs/images/view/blender.png: Blender's window while a 3D view in Rendered shading shows Penumbra's picture.
Run inside Blender, then copy WORK/out/blender.png:

    WINDOW=1440x810 run.sh pictured.py ADDON.zip PENUMBRA WORK
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402
from mathutils import Vector  # noqa: E402

import inside  # noqa: E402
import scenes  # noqa: E402
from window import final, run, view_3d  # noqa: E402


def room():
    """Suzanne, a ring and a pillar in a corner of a room, under a large lamp and a small warm one."""
    wall = scenes.diffuse((0.75, 0.72, 0.68), "Wall")
    scenes.add("Floor", scenes.quad("Floor", wall, 4))
    scenes.add("Back", scenes.quad("Back", wall, 4), (-3, 0, 2), (0, 90, 0))
    scenes.add("Pillar", scenes.cube("Pillar", scenes.diffuse((0.25, 0.45, 0.6), "Blue")), (-1.1, 1.7, 1), (0, 0, 25), (0.7, 0.7, 2))
    for make, name, color, values in (
            (bpy.ops.mesh.primitive_monkey_add, "Suzanne", (0.8, 0.5, 0.25),
             {"size": 1.7, "location": (0, -0.3, 0.85), "rotation": (-0.5, 0, 1.2)}),
            (bpy.ops.mesh.primitive_torus_add, "Ring", (0.6, 0.2, 0.2),
             {"location": (1.4, 1.3, 0.2), "major_radius": 0.6, "minor_radius": 0.2})):
        make(**values)
        thing = bpy.context.view_layer.objects.active
        thing.name = name
        thing.data.materials.append(scenes.diffuse(color, name))
        thing.data.polygons.foreach_set("use_smooth", [True] * len(thing.data.polygons))
        if name == "Suzanne":
            thing.modifiers.new("Subdivision", "SUBSURF").levels = 1
    scenes.lamp("AREA", (1.5, -2.2, 3.4), (28, 25, 0), name="Window", energy=110, shape="RECTANGLE", size=1.6, size_y=0.8)
    scenes.lamp("AREA", (1.8, 2.9, 1.8), (-60, 25, 0), name="Bulb", energy=40, shape="DISK", size=0.4, color=(1, 0.6, 0.3))
    bpy.ops.object.select_all(action="DESELECT")


def picture():
    scene = inside.fresh(room)
    from penumbra import sky
    scene.view_settings.view_transform = "Standard"
    scene.render.film_transparent = False
    scene.world = bpy.data.worlds.new("Grey")
    scene.world.color, scene.penumbra.world = (0.05, 0.05, 0.05), sky.SEEN
    yield 0.2
    area, _, space = view_3d()
    away, target = Vector((6.6, -2.4, 3.6)), Vector((-0.2, 0.35, 0.75))
    place = space.region_3d
    place.view_perspective, place.view_location, place.view_distance = "PERSP", target, (away - target).length
    place.view_rotation = (away - target).to_track_quat("Z", "Y")
    window = bpy.context.window_manager.windows[0]
    next(other for other in window.screen.areas if other.type == "PROPERTIES").spaces.active.context = "RENDER"
    space.shading.type = "RENDERED"
    yield from final("no picture came")
    yield 2.0
    bpy.ops.screen.screenshot(filepath=os.path.join(inside.OUT, "blender.png"))


run(picture())
