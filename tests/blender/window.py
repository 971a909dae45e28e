# SPDX-License-Identifier: Apache-2.0
"""Code shared by scripts that run inside a Blender with a window: its first 3D view, the pixels on the screen, and
steps between which Blender's main loop continues."""

import os
import sys
import time
import traceback

import bpy
import numpy


def view_3d():
    """Returns area, region and space of the first 3D view."""
    area = next(area for area in bpy.context.window_manager.windows[0].screen.areas if area.type == "VIEW_3D")
    return area, next(region for region in area.regions if region.type == "WINDOW"), area.spaces.active


def clear(space):
    """Hides everything that covers the picture."""
    space.overlay.show_overlays = space.show_gizmo = space.show_region_header = space.show_region_tool_header = False
    space.show_region_toolbar = space.show_region_ui = False


def shown():
    """Returns the add-on's view that has a child process; None if there is none."""
    from penumbra import viewport
    return next((view for view in viewport._views if view.child is not None), None)


def on_screen(path):
    """Returns the 3D view as the screen shows it, height x width x 3, first row at the bottom; `path` is the file of
    the screenshot, a PNG."""
    bpy.ops.screen.screenshot(filepath=path)
    image = bpy.data.images.load(path)
    pixels = numpy.array(image.pixels, numpy.float32).reshape(image.size[1], image.size[0], 4)
    bpy.data.images.remove(image)
    region = view_3d()[1]
    return pixels[region.y:region.y + region.height, region.x:region.x + region.width, :3]


def until(condition, what, seconds=120):
    """Waits for the condition while Blender's main loop continues."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            view = shown()
            raise TimeoutError(f"{what}; {view and view.status()}")
        yield 0.02


def final(what):
    """Waits for the final picture of the current state."""
    for _ in range(5):  # Blender notices the change
        yield 0.02
    yield from until(lambda: shown() is not None and shown().is_final(), what)


def run(steps, failures=lambda: 0):
    """Runs the steps by a timer; each yields the seconds until the next. Then ends Blender, with 1 after an exception
    or failures."""
    def step():
        try:
            return next(steps)
        except StopIteration:
            failed = failures()
        except BaseException:
            traceback.print_exc()
            print("compare: FAILED: it did not come to its end", flush=True)
            failed = 1
        sys.stdout.flush()
        os._exit(1 if failed else 0)

    bpy.app.timers.register(step, first_interval=0.5, persistent=True)  # the first step loads a file
