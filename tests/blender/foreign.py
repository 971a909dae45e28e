# SPDX-License-Identifier: Apache-2.0
"""Renders small scenes (scenes.py) from FBX and COLLADA files made by Blender's own exporters, and compares them with
Cycles' direct light as exported.py does. Run inside Blender:

    run.sh foreign.py ADDON.zip PENUMBRA WORK [SCENE...]

These files have no sizes of lamps, so options of the program set them. COLLADA has no strength of emission, and no cone
whose light falls off toward its rim.
"""

import os
import subprocess
import sys
from math import degrees

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402

import exported  # noqa: E402
import scenes  # noqa: E402
from inside import ARGUMENTS, OUT, PENUMBRA, fresh, read  # noqa: E402

cycles = exported.cycles
FBX = ("point", "spot", "spot_rim", "sun", "emissive_plane", "emissive_tube", "turned_below_a_parent")
COLLADA = ("point", "sun", "turned_below_a_parent")


@scenes.scene
def turned_below_a_parent():
    """A turned block below a turned parent with uniform scale; more lamps than cameras, white and coloured."""
    block = scenes.stage()
    parent = scenes.add("Parent", None, (0, 0, 0.2), (0, 20, 30), scale=(1.3, 1.3, 1.3))
    block.parent = parent
    scenes.lamp("POINT", (1, -1, 4), name="White", energy=200, shadow_soft_size=0.05)
    scenes.lamp("POINT", (-1, -2, 4), name="Red", energy=200, shadow_soft_size=0.05, color=(1, 0.4, 0.2))


def make_exportable():
    """Moves emission into Principled surfaces, as the exporters write no other emission."""
    exported.make_exportable()
    for material in bpy.data.materials:
        tree = material.node_tree
        old = next((node for node in tree.nodes if node.type == "EMISSION"), None) if material.use_nodes else None
        if old is not None:
            new = tree.nodes.new("ShaderNodeBsdfPrincipled")
            new.inputs["Base Color"].default_value = (0, 0, 0, 1)
            new.inputs["Emission"].default_value = old.inputs["Color"].default_value
            new.inputs["Emission Strength"].default_value = old.inputs["Strength"].default_value
            exported.replace(tree, old, new)


def make_diffuse():
    """Makes surfaces diffuse as exported.make_diffuse does, except emissive ones."""
    for material in bpy.data.materials:
        tree = material.node_tree
        old = next((node for node in tree.nodes if node.type == "BSDF_PRINCIPLED"), None) if material.use_nodes else None
        if old is not None and max(old.inputs["Emission"].default_value[:3]) > 0:
            new = tree.nodes.new("ShaderNodeEmission")
            new.inputs["Color"].default_value = old.inputs["Emission"].default_value
            new.inputs["Strength"].default_value = old.inputs["Emission Strength"].default_value
            exported.replace(tree, old, new)
    exported.make_diffuse()


def by_penumbra(name, scene, end):
    from penumbra import passes
    file, picture = (os.path.join(OUT, f"{name}.{one}") for one in (end, f"{end}.exr"))
    if end == "fbx":
        bpy.ops.export_scene.fbx(filepath=file)
    else:
        bpy.ops.wm.collada_export(filepath=file)
    render = scene.render
    command = [PENUMBRA, "render", file, "-o", picture, "--size", f"{render.resolution_x}x{render.resolution_y}", "--no-studio"]
    for thing in scene.objects:
        if thing.type == "LIGHT":
            command += ["--sun-angle", str(degrees(thing.data.angle))] if thing.data.type == "SUN" else \
                ["--lamp-radius", str(thing.data.shadow_soft_size)]
    unlike = [i for i, word in enumerate(command) if word in ("--lamp-radius", "--sun-angle")]
    run = subprocess.run(command[:unlike[1]] if len(unlike) > 1 else command, capture_output=True, text=True)
    for line in run.stderr.splitlines():
        if "info" not in line:
            print(f"compare: {name}: {line}", flush=True)
    run.check_returncode()
    return passes.Names("").channels(read(picture))


def main():
    failed, count = [], 0
    for end, names in (("fbx", FBX), ("dae", COLLADA)):
        for name in names:
            if ARGUMENTS and name not in ARGUMENTS:
                continue
            scene = fresh(scenes.SCENES[name])
            bpy.ops.preferences.addon_enable(module="io_scene_fbx")
            make_exportable()
            found = by_penumbra(name, scene, end)
            make_diffuse()
            both = [cycles.by_cycles(scene, seed, os.path.join(OUT, f"{name}.cycles{seed}.exr")) for seed in (1, 2)]
            rows = cycles.compare(name, found, *both)
            for row in rows:
                print(cycles.text_of(f"{name}.{end}", row), flush=True)
            count += 1
            if not rows or not all(row["well"] for row in rows):
                failed.append(f"{name}.{end}")
    print(f"compare: {'off: ' + ', '.join(failed) if failed else f'{count} scenes, all right'}", flush=True)
    if failed:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
