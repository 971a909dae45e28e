"""The *Rendered* shading of 3D views: a `penumbra serve` child for each, which is sent what changes and nothing else."""

import traceback
import weakref

import bpy
import gpu
import numpy
from gpu_extras.presets import draw_texture_2d

from . import glb, losses, program, serving, settings
from .export import SceneWriter
from .viewpoint import Viewpoint

_WORLD = "World"  # name of the world's thing
_views = weakref.WeakSet()
_TICK = 1 / 60  # seconds


def _key(block):
    return block.bl_rna.identifier, block.name_full


class Changes:
    """What a depsgraph says has changed, by kind and name."""

    def __init__(self, depsgraph):
        self.blocks, self.all = set(), False
        for update in depsgraph.updates:
            block = update.id
            if isinstance(block, (bpy.types.Image, bpy.types.Texture)) or \
                    (isinstance(block, bpy.types.NodeTree) and not block.is_embedded_data):
                self.all = True  # the objects with these materials are unknown here
            elif not isinstance(block, bpy.types.Object) or update.is_updated_geometry or update.is_updated_shading:
                self.blocks.add(_key(block))

    def touch(self, thing):
        """Has what an instance shows changed, apart from where it is?"""
        blocks = [thing, thing.data, *(slot.material for slot in thing.material_slots)]
        return self.all or any(block is not None and _key(block) in self.blocks for block in blocks)


def _thing_of(instance):
    """An object, or all that an instancer shows."""
    owner = instance.parent if instance.is_instance else instance.object
    return "Object/" + owner.name_full


def _mark(instance):
    """What of an instance is compared with what was sent."""
    thing = instance.object
    return (thing.name_full, tuple(tuple(row) for row in instance.matrix_world),
            tuple(slot.material.name_full if slot.material else "" for slot in thing.material_slots))


def _world_of(depsgraph):
    return getattr(depsgraph.view_layer_eval, "world_override", None) or depsgraph.scene.world


def _shown(depsgraph):
    for instance in depsgraph.object_instances:
        if instance.show_self and instance.object.type not in ("CAMERA", "EMPTY", "ARMATURE"):
            yield _thing_of(instance), instance


class View:
    """One 3D view: its child, what that was sent, and the picture that is shown."""

    def __init__(self):
        self.child, self.started_with = None, None  # the process, and its program and settings
        self._workspace = None  # for the picture of the world, made when first needed
        self.lost = losses.Losses()
        self.picture, self.texture, self.said = None, None, ""
        self.background = (0.0, 0.0, 0.0)
        self._marks, self._sent, self._order = {}, set(), []  # of things: data for comparison, names sent, and their
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
        self._marks, self._sent, self._order, self._viewpoint, self._wanted = {}, set(), [], None, None

    def update(self, depsgraph):
        """Sends the things of the scene that have changed."""
        wanted = depsgraph.scene.penumbra
        self._start(wanted)
        self.lost = losses.Losses()
        changes, marks, touched = Changes(depsgraph), {}, set()
        for thing, instance in _shown(depsgraph):
            marks.setdefault(thing, []).append(_mark(instance))
            if changes.touch(instance.object):
                touched.add(thing)
        world = _world_of(depsgraph)
        marks[_WORLD] = (world.name_full if world is not None else "", wanted.world, depsgraph.scene.render.film_transparent)
        if changes.all or (world is not None and _key(world) in changes.blocks):
            touched.add(_WORLD)
        touched |= {thing for thing, mark in marks.items() if self._marks.get(thing) != mark}
        self._put(depsgraph, touched, wanted)
        gone = sorted(self._sent - set(marks))
        if gone:
            self.child.send({"type": "remove", "things": gone})
            self._sent -= set(gone)
        order = [thing for thing in marks if thing in self._sent]
        if order != self._order:
            self.child.send({"type": "order", "things": order})
        self._marks, self._order = marks, order
        self._show(wanted, changed=bool(touched or gone))

    def _put(self, depsgraph, touched, wanted):
        """Sends these things, all in one file."""
        if not touched:
            return
        writer = SceneWriter(depsgraph, self.lost, wanted.shading_normals)
        writer.glb = glb.OfThings()
        for thing, instance in _shown(depsgraph):
            if thing in touched:
                writer.glb.thing = thing
                writer._object(instance)
        if _WORLD in touched:
            writer.glb.thing = _WORLD
            if self._workspace is None:
                self._workspace = program.Workspace()
            writer._world(self._workspace.folder)
            self.background = writer.background
        there = writer.glb.things
        if there:
            folder = {"folder": self._workspace.folder} if _WORLD in there else {}
            self.child.send({"type": "put", "shadeless": sorted(writer.glb.shadeless), **folder}, writer.glb.encoded())
        gone = sorted(self._sent & touched - there)
        if gone:
            self.child.send({"type": "remove", "things": gone})
        self._sent = self._sent - touched | there

    def _show(self, wanted, changed):
        """Sends what else the picture depends on, if it has changed."""
        message = {}
        samples = wanted.light_samples if wanted.exactness == program.SAMPLES else 0
        if (samples, wanted.method) != self._wanted:
            self._wanted = samples, wanted.method
            message["lightSamples"], message["method"] = self._wanted
        if self._viewpoint is None:
            return  # before the first drawing
        if changed or message:
            self._send_show(message)

    def _send_show(self, message):
        self._stamp += 1
        self.child.send({"type": "show", "stamp": self._stamp, "visibility": True, **message})

    def look(self, viewpoint, wanted):
        if self.child is None or (self._viewpoint is not None and self._viewpoint.key() == viewpoint.key()):
            return
        message = {"camera": viewpoint.camera(), "size": viewpoint.size, "moving": self._viewpoint is not None}
        self._viewpoint = viewpoint
        if self._wanted is not None:
            message["lightSamples"], message["method"] = self._wanted
        self._send_show(message)

    def is_final(self):
        """Is what is shown the final picture of all that has been sent?"""
        return self.picture is not None and self.picture.head["final"] and self.picture.head["stamp"] == self._stamp

    def take_news(self):
        while not self.child.messages.empty():
            head = self.child.messages.get()
            if head is None:
                self.said = "the program has ended"
            elif head["type"] == "say" and head["level"] != "note":
                self.said = program.messages(f"penumbra: error: {head['text']}")[1]
        picture = self.child.take_picture()
        if picture is not None:
            self.picture, self.texture = picture, None
            if picture.head["final"]:
                self.said = ""

    def draw(self, width, height, transparent):
        """What there is, as large as the view."""
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
        left_out = losses.sentences(self.lost.refused)
        more = f"; left out: {left_out[0]}" if left_out else ""
        return f"{what if head['final'] else 'Quick: ' + what}, {head['milliseconds']:.0f} ms{more}"


def _tick():
    """Views with news are drawn; the timer lives as long as they do."""
    if any(view.child is not None and view.child.has_news() for view in _views):
        for window in bpy.context.window_manager.windows:
            for area in window.screen.areas:
                if area.type == "VIEW_3D" and area.spaces.active.shading.type == "RENDERED":
                    area.tag_redraw()
    return _TICK if _views else None


class ShownInViews:
    """Of the engine: what Blender calls for 3D views. No exception leaves it."""

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
            self._view().said = f"the add-on failed ({type(error).__name__}: {error}); the console says where"

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
    """The scene as a view shows it, in an exchange file: `penumbra render --lenient` makes the same picture of it."""
    class Writer(SceneWriter):
        def _camera(self, _region):
            viewpoint.write(self.glb)
    lost = losses.Losses()
    Writer(depsgraph, lost, depsgraph.scene.penumbra.shading_normals).write(path, None)
