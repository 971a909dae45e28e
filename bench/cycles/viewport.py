# SPDX-License-Identifier: Apache-2.0
"""Turns a 3D view in Rendered shading and moves its lamp, with Penumbra and with Cycles, for viewport_latency.py. Runs inside a
Blender with a window, by tests/blender/run.sh:

    WINDOW=1 run.sh ../../bench/cycles/viewport.py ADDON.zip PENUMBRA WORK SCENE.blend SECONDS REST RUNS

Writes WORK/out/drags.json. A picture is the content of the view's framebuffer after an engine has drawn; a crop full of
penumbra is read from it. All moves end where they began, so that one judge is enough: Cycles with many samples, under
two seeds. After the moves an engine's pictures are watched until one is exact or its error is below the least of
ERRORS, for at most REST seconds.
"""

import json
import os
import subprocess
import sys
import time
from math import sin, sqrt
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / "tests/blender"), str(ROOT / "bench")]

import bpy  # noqa: E402
import gpu  # noqa: E402
import numpy  # noqa: E402
from mathutils import Quaternion, Vector  # noqa: E402

import inside  # noqa: E402
import window  # noqa: E402
from against_cycles import CROP, crop_of_most_penumbra  # noqa: E402

SCENE, *NUMBERS = inside.ARGUMENTS
SECONDS, REST, RUNS = float(NUMBERS[0]), float(NUMBERS[1]), int(NUMBERS[2])
JUDGE_SAMPLES = 4096  # for each of two seeds
ERRORS = 0.05, 0.02, 0.01
EYE, TARGET = Vector((4.2, -5.0, 3.4)), Vector((0, 0, 0.6))


def processor():
    """Processor seconds of Blender and of the add-on's child, with all their threads, until now."""
    view, seconds = window.shown(), time.process_time()
    if view is not None:
        with open(f"/proc/{view.child.process.pid}/stat") as file:
            seconds += sum(map(int, file.read().rpartition(")")[2].split()[11:13])) / os.sysconf("SC_CLK_TCK")
    return seconds


class Watch:
    """Notes each new picture: its time, the processor seconds until then, and its crop."""

    def __init__(self, *engines):
        self.notes, self.corner = [], None  # the crop's left column and lowest row
        for engine in engines:
            self._follow(engine, engine.view_draw)

    def _follow(self, engine, own):
        def view_draw(one, context, depsgraph):
            own(one, context, depsgraph)
            if self.corner is not None:
                self._note()
        engine.view_draw = view_draw

    def _note(self):
        buffer = gpu.state.active_framebuffer_get().read_color(*self.corner, *CROP, 4, 0, "FLOAT")
        crop = numpy.array(buffer.to_list(), numpy.float32).reshape(CROP[1], CROP[0], 4)[::-1, :, :3]
        if crop.any() and not (self.notes and numpy.array_equal(self.notes[-1][2], crop)):
            self.notes.append((time.monotonic(), processor(), crop))


class Test:
    """One scene in one 3D view."""

    def __init__(self):
        inside.fresh(lambda: bpy.ops.wm.open_mainfile(filepath=SCENE, load_ui=False))
        self.scene = bpy.context.scene  # of the opened file
        self.scene.render.film_transparent = True
        cycles = self.scene.cycles
        cycles.max_bounces, cycles.light_sampling_threshold, cycles.pixel_filter_type, cycles.filter_width = 0, 0, "GAUSSIAN", 0.01
        import cycles as cycles_addon
        from penumbra.engine import PenumbraEngine
        self.watch, self.drags = Watch(cycles_addon.CyclesRender, PenumbraEngine), []
        self.lamp = next(thing for thing in self.scene.objects if thing.type == "LIGHT")
        self.lamp_x = self.lamp.location.x
        self.judge = self.judged = None  # Cycles' converged crop, and a mask of its pixels that are compared
        self.noise = 0.0  # RMS error of the judge itself

    def begin(self, engine):
        """Shows the scene with this engine in a new render."""
        yield 0.5  # until the file's windows are open
        self.area, self.region, self.space = window.view_3d()
        window.clear(self.space)
        self.space.shading.type = "SOLID"
        yield 0.5
        self.scene.render.engine = engine
        place = self.space.region_3d
        place.view_perspective, place.view_location, place.view_distance = "PERSP", TARGET, (EYE - TARGET).length
        place.view_rotation = self.rotation = (EYE - TARGET).to_track_quat("Z", "Y")
        self.space.shading.type = "RENDERED"
        self.area.tag_redraw()
        yield 1.0

    def turn(self, share):
        self.space.region_3d.view_rotation = Quaternion((0, 0, 1), 0.4 * share) @ self.rotation
        self.area.tag_redraw()

    def move_lamp(self, share):
        self.lamp.location.x = self.lamp_x + 0.8 * share

    def error(self, crop):
        squares = numpy.mean((crop[self.judged] - self.judge[self.judged]) ** 2)
        return sqrt(max(squares - self.noise ** 2, 0)) / float(self.judge[self.judged].mean())

    def is_done(self, engine, count):
        """Returns whether no further picture is needed. `count`: number of pictures before the last move."""
        notes = self.watch.notes
        if engine == "PENUMBRA":
            return len(notes) > count and window.shown().is_final()  # drawn after the last move
        return len(notes) > count and self.error(notes[-1][2]) < min(ERRORS)

    def drag(self, engine, what, move):
        """Calls `move` about sixty times a second, the last time with the initial state; then waits for the final
        picture."""
        notes, began, start = self.watch.notes, time.monotonic(), processor()
        notes.clear()
        while (now := time.monotonic() - began) < SECONDS:
            move(sin(2 * now + 0.5))
            yield 1 / 60
        count, seconds, used = len(notes), time.monotonic() - began, processor() - start
        move(0)
        last, start = time.monotonic(), processor()
        while time.monotonic() < last + REST and not self.is_done(engine, count):
            yield 0.02
        final = notes[-1][0] - last if engine == "PENUMBRA" and self.is_done(engine, count) else None
        self.drags.append({"engine": engine, "adaptive": self.scene.cycles.use_preview_adaptive_sampling, "what": what, "pictures": count,
                           "seconds": seconds, "processor": used, "final": final, "after": [(when - last, until - start, crop)
                                                                                                 for when, until, crop in notes[count:]]})

    def see_penumbra(self):
        """Chooses the crop, and its pixels to be compared: those whose neighbours show about the same plane."""
        from penumbra import exr, viewport
        yield from window.final("Penumbra shows nothing")
        view = window.shown()
        left, top = crop_of_most_penumbra(next(iter(view.picture.visibility.values())))
        self.watch.corner = left, self.region.height - top - CROP[1]
        glb, picture = (os.path.join(inside.OUT, name) for name in ("whole.glb", "whole.exr"))
        viewport.write_whole(glb, bpy.context.evaluated_depsgraph_get(), view._viewpoint)
        subprocess.run([inside.PENUMBRA, "render", glb, "-o", picture, "--no-studio", "--lenient", "-q", "--normals", "geometric",
                        "--size", "{}x{}".format(*view._viewpoint.size)], check=True)
        channels = inside.read(picture).channels
        shape = numpy.stack([*(channels["N." + letter] for letter in "XYZ"), numpy.log(channels["Z"])])
        near = [numpy.roll(shape, (x, y), (1, 2)) for x in (-1, 0, 1) for y in (-1, 0, 1)]
        step = (numpy.max(near, axis=0) - numpy.min(near, axis=0)).max(axis=0)
        self.judged = (step < 0.3)[top:top + CROP[1], left:left + CROP[0]]

    def see_judge(self):
        """Renders Cycles' converged crop, with a render border around it."""
        space, (left, bottom) = self.space, self.watch.corner
        space.render_border_min_x, space.render_border_max_x = (left - 2) / self.region.width, (left + CROP[0] + 2) / self.region.width
        space.render_border_min_y, space.render_border_max_y = (
            (bottom - 2) / self.region.height, (bottom + CROP[1] + 2) / self.region.height)
        space.use_render_border, cycles, seen = True, self.scene.cycles, []
        for seed in (11, 12):
            cycles.use_preview_adaptive_sampling, cycles.preview_samples, cycles.seed = False, JUDGE_SAMPLES, seed
            yield from self.begin("CYCLES")  # a new render: a running one ignores changes of these settings
            before = -10.0
            while time.process_time() - before > 0.5:  # until Cycles has taken its last sample
                before = time.process_time()
                yield 6
            seen.append(self.watch.notes[-1][2].astype(float))
        self.judge, self.noise = (seen[0] + seen[1]) / 2, sqrt(numpy.mean((seen[0] - seen[1])[self.judged] ** 2)) / 2
        space.use_render_border, cycles.preview_samples, cycles.seed = False, 1024, 0

    def steps(self):
        yield from self.begin("PENUMBRA")
        yield from self.see_penumbra()
        for _ in range(RUNS):
            yield from self.drag("PENUMBRA", "view", self.turn)
            yield from self.drag("PENUMBRA", "lamp", self.move_lamp)
        yield from self.see_judge()
        for is_adaptive in (True, False):
            self.scene.cycles.use_preview_adaptive_sampling = is_adaptive
            yield from self.begin("CYCLES")
            yield from self.drag("CYCLES", "view", self.turn)
            if is_adaptive:  # with adaptive sampling only: a lamp's move and a turn keep Cycles equally busy
                yield from self.drag("CYCLES", "lamp", self.move_lamp)
        for drag in self.drags:
            drag["after"] = [(when, used, self.error(crop)) for when, used, crop in drag["after"]]
        with open(os.path.join(inside.OUT, "drags.json"), "w") as file:
            json.dump({"size": [self.region.width, self.region.height], "judged": int(self.judged.sum()),
                       "least": self.noise / float(self.judge[self.judged].mean()), "errors": ERRORS, "drags": self.drags}, file)


def steps():
    yield from Test().steps()


window.run(steps())
