# SPDX-License-Identifier: Apache-2.0
"""Renders the small scenes (scenes.py) from files made by Blender's own glTF exporter, and compares them with Cycles'
direct light as cycles.py does. Run inside Blender:

    run.sh exported.py ADDON.zip PENUMBRA WORK [SCENE...]

The scenes are prepared as an artist has to do for the export: an emissive plane replaces each area lamp, lamps have
their size in a custom property, and surfaces are Principled BSDF. Cycles renders these as the diffuse surfaces that
they are to Penumbra.
"""

import importlib.util
import os
import subprocess
import sys
from math import cos, degrees, pi, radians, sin

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402

import scenes  # noqa: E402
from inside import ARGUMENTS, OUT, PENUMBRA, fresh, read  # noqa: E402

# cycles is also the name of Cycles' own add-on, so the module is loaded under another name.
_spec = importlib.util.spec_from_file_location("beside_cycles", os.path.join(os.path.dirname(os.path.abspath(__file__)), "cycles.py"))
cycles = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(cycles)

# Scenes that the file cannot hold: lens shift, shadow visibility, worlds, objects scattered by particles, and mixed
# shaders.
LOST = {name for name in scenes.SCENES if name.startswith("world_")} | {"camera_shift", "orthographic_shift", "depth_of_field", "orthographic_depth_of_field", "shadowless_lamp", "shadowless_object", "translucent", "cut_out", "hidden"}
# The file has the irradiance of a surface that faces the sun, and Penumbra gives it that; in Cycles a sun of half angle
# a gives about a² / 4 less.
cycles.MODEL = {**cycles.MODEL, "sun": radians(4) ** 2 / 4}
SIDES = 64  # of the polygon that replaces a round lamp


def plane_for(name, data, location, rotation, scale):
    """Returns an emissive mesh of an area lamp's shape and radiance, with its front along −Z. Like all emission it
    shines to both sides."""
    width, depth = data.size, data.size_y if data.shape in ("RECTANGLE", "ELLIPSE") else data.size
    area = width * depth * scale[0] * scale[1]
    if data.shape in ("DISK", "ELLIPSE"):
        corners = [(width / 2 * cos(2 * pi * i / SIDES), -depth / 2 * sin(2 * pi * i / SIDES), 0) for i in range(SIDES)]
        area *= SIDES / 8 * sin(2 * pi / SIDES)
    else:
        corners = [(x * width / 2, y * depth / 2, 0) for x, y in ((-1, -1), (-1, 1), (1, 1), (1, -1))]
    material = scenes.emission(data.color, data.energy / (4 * abs(area)))
    return scenes.add(name, scenes.mesh(name, corners, [tuple(range(len(corners)))], material), location, rotation, scale)


def exportable_lamp(kind, location, rotation=(0, 0, 0), scale=(1, 1, 1), name="Key", **values):
    thing = lamp(kind, location, rotation, scale, name, **values)
    if kind == "AREA":
        data = thing.data
        bpy.data.objects.remove(thing)
        return plane_for(name, data, location, rotation, scale)
    if kind == "SUN":
        thing["angle"] = degrees(thing.data.angle)
    else:
        thing["radius"] = thing.data.shadow_soft_size
    return thing


lamp, scenes.lamp = scenes.lamp, exportable_lamp


@scenes.scene
def cards():
    """Principled surfaces: one with holes from an image, one translucent."""
    scenes.add("Floor", scenes.quad("Floor", half=4))
    scenes.camera()
    image = bpy.data.images.new("Leaf", 16, 16, alpha=True)
    image.pixels = [value for y in range(16) for x in range(16)
                    for value in (0.3, 0.7, 0.2, 1.0 if abs(x - 7.5) + abs(y - 7.5) < 8 else 0.0)]
    image.pack()
    for name, image, alpha, place in (("Leaf", image, 1, (-0.7, 0, 1)), ("Pane", None, 0.3, (0.9, 0.2, 1.2))):
        material = scenes.diffuse((0.3, 0.7, 0.2), name)
        material.blend_method = "CLIP" if image else "BLEND"
        surface = principled(material)
        surface.inputs["Alpha"].default_value = alpha
        if image:
            texture = material.node_tree.nodes.new("ShaderNodeTexImage")
            texture.image, texture.interpolation = image, "Closest"
            for output, wanted in (("Color", "Base Color"), ("Alpha", "Alpha")):
                material.node_tree.links.new(texture.outputs[output], surface.inputs[wanted])
        data = scenes.quad(name, material, 0.6)
        for loop, place_in_image in zip(data.uv_layers.new().data, ((0, 0), (1, 0), (1, 1), (0, 1))):
            loop.uv = place_in_image
        scenes.add(name, data, place, (10, 20, 30))
    scenes.add("Panel", scenes.quad("Panel", scenes.emission((1, 0.9, 0.7), 12), 0.5), (0.8, 0, 3), (200, 10, 0))


def principled(material):
    """Replaces the material's diffuse surface by a Principled BSDF, and returns the new node."""
    tree = material.node_tree
    old = next(node for node in tree.nodes if node.type == "BSDF_DIFFUSE")
    new = tree.nodes.new("ShaderNodeBsdfPrincipled")
    new.inputs["Specular"].default_value = 0
    if old.inputs["Color"].is_linked:
        tree.links.new(old.inputs["Color"].links[0].from_socket, new.inputs["Base Color"])
    else:
        new.inputs["Base Color"].default_value = old.inputs["Color"].default_value
    replace(tree, old, new)
    return new


def replace(tree, old, new):
    for link in list(old.outputs[0].links):
        tree.links.new(new.outputs[0], link.to_socket)
    tree.nodes.remove(old)


def make_exportable():
    for material in bpy.data.materials:
        if material.use_nodes and any(node.type == "BSDF_DIFFUSE" for node in material.node_tree.nodes):
            principled(material)


def make_diffuse():
    """Makes Principled surfaces what they are to Penumbra: diffuse, and present where their image or alpha says so."""
    for material in bpy.data.materials:
        tree = material.node_tree
        old = next((node for node in tree.nodes if node.type == "BSDF_PRINCIPLED"), None) if material.use_nodes else None
        if old is None:
            continue
        new = tree.nodes.new("ShaderNodeBsdfDiffuse")
        color, alpha = old.inputs["Base Color"], old.inputs["Alpha"]
        if color.is_linked:
            tree.links.new(color.links[0].from_socket, new.inputs["Color"])
        new.inputs["Color"].default_value = color.default_value
        if alpha.is_linked or alpha.default_value < 1:
            mixed, clear = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfTransparent")
            mixed.inputs[0].default_value = alpha.default_value
            if alpha.is_linked:
                tree.links.new(alpha.links[0].from_socket, mixed.inputs[0])
            tree.links.new(clear.outputs[0], mixed.inputs[1])
            tree.links.new(new.outputs[0], mixed.inputs[2])
            new = mixed
        replace(tree, old, new)


def by_penumbra(name, scene):
    from penumbra import passes
    file, picture = (os.path.join(OUT, f"{name}.{end}") for end in ("glb", "exr"))
    moves = name == "animated"
    if moves:
        scene.frame_set(scene.frame_start)
    bpy.ops.export_scene.gltf(filepath=file, export_cameras=True, export_lights=True, export_extras=True,
                              export_apply=not moves, export_animations=moves)
    render = scene.render
    size = [side * render.resolution_percentage // 100 for side in (render.resolution_x, render.resolution_y)]
    command = [PENUMBRA, "render", file, "-o", picture, "--size", f"{size[0]}x{size[1]}"]
    command += ["--frame", "7"] if moves else ["--light-samples", "4096"] if name == "cards" else []
    run = subprocess.run(command, capture_output=True, text=True)
    for line in run.stderr.splitlines():
        if "info" not in line:
            print(f"compare: {name}: {line}", flush=True)
    run.check_returncode()
    if moves:
        scene.frame_set(7)
    return passes.Names("").channels(read(picture))


def main():
    failed, names = [], ARGUMENTS or [name for name in scenes.SCENES if name not in LOST]
    for name in names:
        scene = fresh(scenes.SCENES[name])
        bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
        make_exportable()
        found = by_penumbra(name, scene)
        make_diffuse()
        both = [cycles.by_cycles(name, scene, seed, os.path.join(OUT, f"{name}.cycles{seed}.exr")) for seed in (1, 2)]
        rows = cycles.compare(name, found, *both)
        for row in rows:
            print(cycles.text_of(name, row), flush=True)
        if not rows or not all(row["well"] for row in rows):
            failed.append(name)
    print(f"compare: {'off: ' + ', '.join(failed) if failed else f'{len(names)} scenes, all right'}", flush=True)
    if failed:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
