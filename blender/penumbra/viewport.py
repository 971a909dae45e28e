# SPDX-License-Identifier: Apache-2.0
"""The *Rendered* shading of 3D views: a `penumbra serve` child for each, which is sent only what has changed."""

import traceback
import weakref

import bpy
import gpu
import numpy
from gpu_extras.presets import draw_texture_2d

from . import glb, losses, program, serving, settings
from .changes import Changes, key_of
from .export import SceneWriter
from .viewpoint import Viewpoint

_WORLD = "World"  # the world's name among things
_views = weakref.WeakSet()
_TICK = 1 / 60  # seconds


def _thing_of(instance):
    """Returns the name of the thing that an instance belongs to: an object, or all instances of an instancer."""
    owner = instance.parent if instance.is_instance else instance.object
    return "Object/" + owner.name_full


def _mark(instance, layer):
    """Returns the properties of an instance that are compared with those sent: no update reports changes of the view layer."""
    thing, override = instance.object, layer.material_override
    owner = instance.parent if instance.is_instance else thing
    return (thing.name_full, tuple(tuple(row) for row in instance.matrix_world),
            tuple(slot.material.name_full if slot.material else "" for slot in thing.material_slots),
            override.name_full if override is not None else "", owner.holdout_get(view_layer=layer),
            owner.indirect_only_get(view_layer=layer))


def _world_of(depsgraph):
    return getattr(depsgraph.view_layer_eval, "world_override", None) or depsgraph.scene.world


def _shown(depsgraph):
    for instance in depsgraph.object_instances:
        if instance.show_self and instance.object.type not in ("CAMERA", "EMPTY", "ARMATURE"):
            yield _thing_of(instance), instance


class View:
    """One 3D view: its child process, the data sent to it, and the picture on display."""

    def __init__(self):
        self.child, self.started_with = None, None  # the process, and its program and settings
        self._workspace = None  # for the picture of the world, made when first needed
        self._losses = {}  # of each thing
        self._is_stale = False  # the child refused things that the scene now contains
        self.picture, self.texture, self.said = None, None, ""
        self._said_at, self._refused_stamp = -1, 0  # arrival of the message in `said`; stamp of the last refused `show`
        self.background = (0.0, 0.0, 0.0)
        self._marks, self._sent, self._order = {}, set(), []  # of things: data for comparison, sent names, and
                                                              # order
        self._viewpoint, self._wanted, self._stamp = None, None, 0
        self._backdrop = None
        _views.add(self)
        if not bpy.app.timers.is_registered(_tick):
            bpy.app.timers.register(_tick, persistent=True)

    def close(self):
        if self.child is not None:
            self.child.close()
        self.child = None
        if self._workspace is not None:
            self._workspace.close()
        self._workspace = None

    def _start(self, wanted):
        key = (program.find(settings.program_path()), wanted.device, wanted.shading_normals)
        if self.child is not None and self.started_with == key and self.child.process.poll() is None:
            return
        self.close()
        more = ["--device", wanted.device] if wanted.device else []
        self.child = serving.Child(key[0], "--normals", "shading" if wanted.shading_normals else "geometric", *more)
        self.started_with = key
        self._marks, self._sent, self._order, self._losses, self._is_stale = {}, set(), [], {}, False
        self._viewpoint, self._wanted = None, None
        self._said_at, self._refused_stamp = -1, 0

    def update(self, depsgraph):
        """Sends the things of the scene that have changed."""
        wanted = depsgraph.scene.penumbra
        self._start(wanted)
        changes, marks, touched = Changes(), {}, set()
        changes.note(depsgraph)
        layer = depsgraph.view_layer_eval
        for thing, instance in _shown(depsgraph):
            marks.setdefault(thing, []).append(_mark(instance, layer))
            if changes.touch(instance.object, layer.material_override):
                touched.add(thing)
        world = _world_of(depsgraph)
        marks[_WORLD] = (world.name_full if world is not None else "", wanted.world, depsgraph.scene.render.film_transparent)
        if changes.all or (world is not None and key_of(world) in changes.blocks):
            touched.add(_WORLD)
        touched |= {thing for thing, mark in marks.items() if self._marks.get(thing) != mark}
        self._put(depsgraph, touched, wanted)
        gone = sorted(self._sent - set(marks))
        if gone:
            self.child.send({"type": "remove", "things": gone})
            self._sent -= set(gone)
            for thing in gone:
                self._losses.pop(thing, None)
        order = [thing for thing in marks if thing in self._sent]
        if order != self._order:
            self.child.send({"type": "order", "things": order})
        self._marks, self._order = marks, order
        self._show(wanted, changed=bool(touched or gone))

    def _put(self, depsgraph, touched, wanted):
        """Sends these things, all in one file."""
        if not touched:
            return
        writer = SceneWriter(depsgraph, None, wanted.shading_normals)
        lost = {thing: losses.Losses() for thing in touched}
        writer.glb = glb.OfThings()
        for thing, instance in _shown(depsgraph):
            if thing in touched:
                writer.glb.thing, writer.losses = thing, lost[thing]
                writer._object(instance)
        if _WORLD in touched:
            writer.glb.thing, writer.losses = _WORLD, lost[_WORLD]
            if self._workspace is None:
                self._workspace = program.Workspace()
            writer._world(self._workspace.folder)
            self.background = writer.background
        folder = {"folder": self._workspace.folder} if _WORLD in touched else {}
        self.child.send({"type": "put", "things": sorted(touched), "shadeless": sorted(writer.glb.shadeless), **folder},
                        writer.glb.encoded())
        self._sent |= touched
        self._is_stale = False
        self._losses.update(lost)

    def _show(self, wanted, changed):
        """Sends the picture's other settings, if they or things have changed."""
        samples = wanted.light_samples if wanted.exactness == program.SAMPLES else 0
        changed = changed or (samples, wanted.method) != self._wanted
        self._wanted = samples, wanted.method
        if changed and self._viewpoint is not None:  # None before the first drawing
            self._send_show()

    def _send_show(self, moving=False):
        """Sends all settings of the picture, not only changed ones, since an earlier `show` may have been refused."""
        self._stamp += 1
        message = {"type": "show", "stamp": self._stamp, "visibility": True, "moving": moving,
                   "camera": self._viewpoint.camera(), "size": self._viewpoint.size}
        if self._wanted is not None:
            message["lightSamples"], message["method"] = self._wanted
        self.child.send(message)

    def look(self, viewpoint, wanted):
        if self.child is None or (self._viewpoint is not None and self._viewpoint.key() == viewpoint.key()):
            return
        moving = self._viewpoint is not None
        self._viewpoint = viewpoint
        self._send_show(moving)

    def is_final(self):
        """Returns whether the picture on display is the final one of all data sent."""
        return self.picture is not None and self.picture.head["final"] and self.picture.head["stamp"] == self._stamp

    def take_news(self):
        while not self.child.messages.empty():
            head = self.child.messages.get()
            if head is None:
                self.said = self.said or "the program has ended"
            elif head["type"] == "say" and head["level"] != "note":
                refused = head.get("refused")
                if refused == "put" or not self._is_stale:  # later refusals are consequences of the first
                    self.said = program.messages(f"penumbra: error: {head['text']}")[1]
                    self._said_at = head["arrival"]
                if refused == "show":
                    self._refused_stamp = head.get("stamp") or 0
                if refused in ("put", "remove", "order"):
                    self._is_stale = True
                    self._marks, self._order = {}, []  # the next update sends all things again
        picture = self.child.take_picture()
        if picture is not None:
            self.picture, self.texture = picture, None
            # A picture of earlier data does not prove that the error no longer exists.
            is_newer = picture.head["arrival"] > self._said_at and (picture.head["stamp"] or 0) > self._refused_stamp
            if picture.head["final"] and is_newer and not self._is_stale:
                self.said = ""

    def draw(self, width, height, transparent):
        """Draws the newest picture, scaled to the view."""
        backdrop = None if transparent else self.background
        if self.picture is None:
            return
        if self.texture is None or self._backdrop != backdrop:
            pixels, self._backdrop = numpy.array(self.picture.rgba[::-1]), backdrop
            if backdrop is not None:
                pixels[..., :3] += (1 - pixels[..., 3:]) * numpy.array(backdrop, numpy.float32)
                pixels[..., 3] = 1
            head = self.picture.head
            buffer = gpu.types.Buffer("FLOAT", pixels.size, pixels.ravel())
            self.texture = gpu.types.GPUTexture((head["width"], head["height"]), format="RGBA16F", data=buffer)
        gpu.state.blend_set("ALPHA_PREMULT")
        draw_texture_2d(self.texture, (0, 0), width, height)
        gpu.state.blend_set("NONE")

    def status(self):
        if self.said:
            return self.said
        if self.picture is None:
            return "Reading the scene"
        head = self.picture.head
        what = "exact areas" if head["lightSamples"] == 0 else f"{head['lightSamples']} light samples"
        left_out = losses.sentences(losses.together(self._losses.values()).refused)
        more = f"; left out: {left_out[0]}" if left_out else ""
        return f"{what if head['final'] else 'Quick: ' + what}, {head['milliseconds']:.0f} ms{more}"


def _tick():
    """Redraws views with new pictures; the timer runs while there are views."""
    if any(view.child is not None and view.child.has_news() for view in _views):
        for window in bpy.context.window_manager.windows:
            for area in window.screen.areas:
                if area.type == "VIEW_3D" and area.spaces.active.shading.type == "RENDERED":
                    area.tag_redraw()
    return _TICK if _views else None


class ShownInViews:
    """The engine's methods that Blender calls for 3D views. They raise nothing."""

    def _view(self):
        if not hasattr(self, "_shown"):
            self._shown = View()
        return self._shown

    def view_update(self, context, depsgraph):
        try:
            self._view().update(depsgraph)
        except (ValueError, OSError) as error:
            self._view().said = str(error)
        except Exception as error:
            traceback.print_exc()
            self._view().said = f"the add-on failed ({type(error).__name__}: {error}); the console has the details"

    def view_draw(self, context, depsgraph):
        view = self._view()
        try:
            region, place = context.region, context.region_data
            viewpoint = Viewpoint(place.view_matrix.inverted(), place.window_matrix, (region.width, region.height))
            if view.child is not None:
                view.look(viewpoint, depsgraph.scene.penumbra)
                view.take_news()
            view.draw(region.width, region.height, depsgraph.scene.render.film_transparent)
            self.update_stats("Penumbra", view.status())
        except Exception:
            traceback.print_exc()

    def __del__(self):
        if hasattr(self, "_shown"):
            self._shown.close()


def write_whole(path, depsgraph, viewpoint):
    """Writes the scene as shown by a view to an exchange file; `penumbra render --lenient` makes the same picture from
    it."""
    class Writer(SceneWriter):
        def _camera(self, region):
            region.write(self.glb)  # writes the viewpoint, in place of a region of pixels
    lost = losses.Losses()
    Writer(depsgraph, lost, depsgraph.scene.penumbra.shading_normals).write(path, viewpoint)
