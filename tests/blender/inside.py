# SPDX-License-Identifier: Apache-2.0
"""Code shared by scripts that run inside Blender: installs the add-on from its zip, and makes an empty scene."""

import os
import sys
import unittest

import bpy

ZIP, PENUMBRA, OUT, *ARGUMENTS = sys.argv[sys.argv.index("--") + 1:]
WIDTH, HEIGHT = 96, 72


def fresh(build):
    """Returns the scene that `build` makes, to be rendered by Penumbra."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="cycles")
    bpy.ops.preferences.addon_enable(module="penumbra")
    bpy.context.preferences.addons["penumbra"].preferences.program = PENUMBRA
    scene = bpy.context.scene
    scene.render.engine = "PENUMBRA"
    render = scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = WIDTH, HEIGHT, 100
    render.film_transparent, render.use_compositing, render.use_sequencer = True, False, False
    settings = render.image_settings
    settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR_MULTILAYER", "32", "ZIP"
    build()
    return scene


def read(path):
    from penumbra import exr
    with open(path, "rb") as file:
        return exr.read(file.read())


def channels(scene, path):
    """Renders, and returns the picture's channels by the part of their names after the view layer's name."""
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    return {name.split(".", 1)[1]: values for name, values in read(path).channels.items() if "." in name}


def run_tests(*cases):
    """Runs all tests; Blender ends with 1 if one fails."""
    load = unittest.defaultTestLoader.loadTestsFromTestCase
    result = unittest.TextTestRunner(verbosity=2).run(unittest.TestSuite(load(case) for case in cases))
    print(f"compare: {result.testsRun} tests, {len(result.failures) + len(result.errors)} failed", flush=True)
    if not result.wasSuccessful():
        raise SystemExit(1)


bpy.ops.preferences.addon_install(filepath=ZIP)
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
