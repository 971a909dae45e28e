# SPDX-License-Identifier: Apache-2.0
"""Blender's scene, as its dependency graph evaluates it for a render, in the exchange file (glb.py)."""

import os

import bpy
import numpy

from . import glb, lamps, losses as loss_words, materials, sky, space, texels
from .changes import key_of

_SURFACES = {"MESH", "CURVE", "SURFACE", "META", "FONT"}
_MESH_OR_NOTHING = "make a mesh of it, or hide it in renders"
_UNKNOWN = {"VOLUME": f"is a volume, which is not rendered; {_MESH_OR_NOTHING} (Volume to Mesh modifier)",
            "POINTCLOUD": f"is a point cloud, which is not rendered; {_MESH_OR_NOTHING}",
            "CURVES": f"is hair, which is not rendered; {_MESH_OR_NOTHING} (Object, Convert; Curve to Mesh in geometry nodes)",
            "GPENCIL": f"is grease pencil, which is not rendered; {_MESH_OR_NOTHING}",
            "GREASEPENCIL": f"is grease pencil, which is not rendered; {_MESH_OR_NOTHING}"}


class SceneWriter:
    """Writes one frame. Reports unsupported data to `losses` by name (losses.py)."""

    def __init__(self, depsgraph, losses, shading_normals, baked=None):
        """`baked`: the object to bake (bake.py), whose lightmap coordinates are written in addition to those of images;
        or None."""
        self.depsgraph, self.losses, self.shading_normals = depsgraph, losses, shading_normals
        self.scene, self.layer = depsgraph.scene, depsgraph.view_layer_eval
        self.glb = glb.Glb()
        self.background = (0.0, 0.0, 0.0)  # colour to be composited behind everything
        self._meshes, self._materials, self._looks, self._images = {}, {}, {}, {}
        self._baked, self._shines = baked, False
        self._named = {}  # meshes by their object's name, for other moments; None: several meshes share the name
        self._before = self._changes = None  # the writer of the frame's own time, and changes since
        self._world_picture = sky.PICTURE
        self._seen_by = self.scene.camera.original if self.scene.camera is not None else None
        self._balls, self._placed = [], []  # lamps with a radius, and surfaces in world space, for tests of
                                            # their distances

    def at_moment(self, changes, losses, beside, world_picture):
        """Returns a writer of the scene at another moment, which reuses this writer's meshes and world if they have not
        changed since (changes.Changes). `beside`: name of the file with the binary data of these meshes
        (Glb.without_nodes); `world_picture`: file name of the world's picture, if that has changed."""
        other = SceneWriter(self.depsgraph, losses, self.shading_normals)
        other._world_picture, other._seen_by = world_picture, self._seen_by  # markers may change the scene's camera
        if not changes.all:
            other.glb, other._images = self.glb.without_nodes(beside), dict(self._images)
            other._before, other._changes = self, changes
        return other

    def write(self, path, region):
        """Writes the file. `region`: pixels to render (frames.py); None: no picture is rendered."""
        encoded = self.encoded(os.path.dirname(path), region)
        with open(path, "wb") as file:
            file.write(encoded)

    def encoded(self, folder, region):
        """Returns the file's bytes. `folder`: where it will be, for a picture of the world; `region`: as of write()."""
        for instance in self.depsgraph.object_instances:
            # A view's dependency graph also contains objects that are hidden only in renders.
            hidden = instance.object.hide_render or (instance.is_instance and instance.parent.hide_render)
            if instance.show_self and not (region is None and hidden):
                self._object(instance)
        self._world(folder)
        if not self._shines and not self.glb.has_lamps:
            unknown = "".join(f"; {sentence}" for sentence in loss_words.sentences(self.losses.refused))
            raise ValueError("there is no light in the scene: no lamp, no emissive material that is shown in renders, and no "
                             f"world that lights{unknown}")
        if not self._placed:
            raise ValueError("there is no surface in the scene that is shown in renders")
        if region is not None:
            self._camera(region)
        else:  # a camera without effect
            self.glb.camera("None", numpy.eye(4).tolist(), 1, (0, 0), half_angle=1)
        lamps.check_balls(self._balls, self._placed, self.losses)
        return self.glb.encoded()

    def _object(self, instance):
        thing = instance.object
        if lamps.is_linked(thing):
            self.losses.refuse("is linked to certain objects only (Object, Shading, Light Linking), which is not supported", thing.name)
        if thing.type == "LIGHT":
            if thing.visible_diffuse:
                self._balls += lamps.write_lamp(thing.data, thing.name, instance.matrix_world, self.glb, self.losses)
            return
        if thing.type in _UNKNOWN:
            self.losses.refuse(_UNKNOWN[thing.type], thing.name)
        if thing.type not in _SURFACES:
            return
        for system in thing.particle_systems:
            if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
                self.losses.refuse("has hair, which is not rendered; convert it to a mesh (Modifiers, Convert to Mesh, and give that "
                                   "a thickness), or do not show it in renders", thing.name)
        owner = instance.parent if instance.is_instance else thing
        if thing.is_holdout or thing.is_shadow_catcher or owner.holdout_get(view_layer=self.layer):
            self.losses.refuse("is a holdout or shadow catcher, or in a collection that is a holdout", thing.name)
        is_baked = self._baked is not None and self._baked.is_it(instance)
        mesh = self._mesh(thing, is_baked)
        if mesh is None:
            return
        number, emits, corners = mesh
        self._shines = self._shines or emits
        extras = {} if thing.visible_shadow else {"castsShadow": False}
        if owner.indirect_only_get(view_layer=self.layer):
            self.losses.refuse("is in a collection that is indirect only", thing.name)
        if not thing.visible_camera:
            if not emits or thing.visible_shadow:
                self.losses.refuse("is hidden from the camera but not from light", thing.name)
            else:
                extras["body"] = False
        self._placed.append(space.Placed(thing.name, corners.positions, corners.vertices, numpy.array(instance.matrix_world)))
        self.glb.node(self._baked.name if is_baked else thing.name, instance.matrix_world, extras, mesh=number)

    def _materials_of(self, thing):
        """Returns the materials of an object's slots; the view layer's override replaces all."""
        if self.layer.material_override is not None:
            return [self.layer.material_override]
        return [slot.material for slot in thing.material_slots]

    def _mesh(self, thing, is_baked):
        """Returns the number of an object's mesh in the file, whether it emits light, and its corners; None for a mesh without faces."""
        materials_ = tuple(material.name_full if material else "" for material in self._materials_of(thing))
        key = (is_baked, thing.data.as_pointer(), thing.original.as_pointer() if thing.type != "MESH" else 0, materials_)
        name = (thing.name_full, thing.data.name_full, materials_)
        if key not in self._meshes:
            known = self._before._named.get(name) if self._before is not None else None
            if known is not None and not self._changes.touch(thing, self.layer.material_override):
                self._meshes[key] = known
            else:
                data = thing.to_mesh()
                self._meshes[key] = self._primitives(thing, data, is_baked) if data is not None else None
                thing.to_mesh_clear()
        mesh = self._meshes[key]
        # Instances made by geometry nodes have the name of the object with the nodes: a name may have several meshes.
        self._named[name] = mesh if self._named.setdefault(name, mesh) is mesh else None
        return mesh

    def _primitives(self, thing, data, is_baked):
        data.calc_loop_triangles()
        count = len(data.loop_triangles)
        if count == 0:
            return None
        corners = Corners(data, self.shading_normals)
        material_of = numpy.zeros(count, numpy.int32)
        slots = self._materials_of(thing)
        if len(slots) > 1:
            data.loop_triangles.foreach_get("material_index", material_of)
        material_of = numpy.clip(material_of, 0, max(len(slots) - 1, 0))
        primitives, emits = [], False
        for slot in numpy.unique(material_of):
            material = slots[slot] if slots else None
            look = self._look(material, thing.name)
            emits = emits or max(look.radiance) > 0
            number = self._material(material, look)
            for smooth in (False, True):
                chosen = (material_of == slot) & (corners.smooth == smooth)
                if chosen.any():
                    attributes, indices = corners.of(chosen, look, self, smooth, is_baked)
                    primitives.append({"attributes": attributes, "indices": indices, "material": number})
        corners.forget()
        return self.glb.mesh(thing.data.name, primitives), emits, corners

    def _look(self, material, name):
        key = material.name_full if material else ""
        if key not in self._looks:
            self._looks[key] = materials.Reader(self.losses, key or name).look(material)
        return self._looks[key]

    def _material(self, material, look):
        key = material.name_full if material else ""
        if key not in self._materials:
            texture = self._texture(look) if look.image else None
            cuts = getattr(material, "blend_method", "") == "CLIP" and (look.alpha < 1 or look.image_alpha)
            self._materials[key] = self.glb.material(
                key or "Default", look.color, look.radiance, look.alpha,
                material.alpha_threshold if cuts else None, texture, look.image_alpha)
        return self._materials[key]

    def _texture(self, look):
        image = look.image
        key = (image.name_full, look.interpolation, look.wrap, look.image_alpha, id(look.pixels) if look.pixels is not None else 0)
        if key not in self._images:
            try:
                self._images[key] = self.glb.image(image.name, *encoded_image(image, look))
                if image.is_float and texels.pixels(image)[..., :3].max() > 1.001:
                    self.losses.refuse("is an image with colours above 1, which are cut off", image.name)
            except (OSError, RuntimeError) as error:
                self.losses.refuse(f"is an image that cannot be read ({error})", image.name)
                self._images[key] = None
            if look.interpolation in ("Cubic", "Smart") and max(image.size) > texels.FINE // 2 and not look.image_alpha:
                self.losses.mention(f"is an image of more than {texels.FINE // 2} pixels: interpolated linearly", image.name)
            if not texels.knows_space(image):
                self.losses.refuse(f"is an image in the colour space {image.colorspace_settings.name}, which is not supported", image.name)
        number = self._images[key]
        if number is None:
            return None
        return self.glb.texture(number, 33071 if look.wrap == "EXTEND" else 10497, look.nearest)

    def _camera(self, region):
        if self._seen_by is None:
            raise ValueError("the scene has no camera")
        camera = self._seen_by.evaluated_get(self.depsgraph)
        lens = camera.data
        if lens.type not in ("PERSP", "ORTHO"):
            raise ValueError(f"camera '{camera.name}' is panoramic; only perspective and orthographic cameras are rendered")
        matrix = lamps.without_scale(camera.matrix_world)
        if lamps.is_sheared(matrix):
            self.losses.refuse("is a camera that is sheared (by a parent with uneven scale)", camera.name)
        view = lamps.lens_of(lens, region)
        focus = lamps.focus_of(camera, matrix)
        if focus is not None and lamps.has_blades(lens.dof):
            self.losses.mention("has an aperture with blades or a ratio, which is treated as round", camera.name)
        self.glb.camera(camera.name, matrix, region.size[0] / region.size[1], focus=focus, **view)
        frustum = space.Frustum(matrix, region.size[0] / region.size[1], **view)
        for placed in self._placed:
            if frustum.sees(placed, 0, lens.clip_start):
                self.losses.refuse(f"is cut by the clip start of camera '{camera.name}', which is not supported; lower it", placed.name)
            if frustum.sees(placed, lens.clip_end, numpy.inf):
                self.losses.mention(f"reaches beyond the clip end of camera '{camera.name}', and is shown there", placed.name)

    def _world(self, folder):
        world = getattr(self.layer, "world_override", None) or self.depsgraph.scene_eval.world
        if world is None:
            return
        if self._before is not None and key_of(world) not in self._changes.blocks:
            self.background = self._before.background
            for dome in self._before.glb.domes:
                self.glb.dome(*dome)
            return
        self.background = sky.write(world, world.name, self.scene.penumbra.world, not self.scene.render.film_transparent,
                                    self.glb, os.path.join(folder, self._world_picture), self.losses)


def encoded_image(image, look):
    """Returns an image's bytes and their MIME type: those of its file if that is an unchanged PNG or JPEG in sRGB."""
    if look.pixels is not None:
        return texels.png(texels.bytes_of(texels.encoded_of(look.pixels))), "image/png"
    small = not look.nearest and max(image.size) <= texels.FINE // 2
    plain = texels.is_encoded(image) or look.image_alpha
    if plain and not (small and not look.image_alpha) and not image.is_dirty and image.source == "FILE" and \
            image.file_format in ("PNG", "JPEG"):
        if image.packed_file is not None:
            data = image.packed_file.data
        else:
            with open(bpy.path.abspath(image.filepath, library=image.library), "rb") as file:
                data = file.read()
        if data[:8] == b"\x89PNG\r\n\x1a\n":
            return data, "image/png"
        if data[:2] == b"\xff\xd8":
            return data, "image/jpeg"
    values = texels.pixels(image)
    if not look.image_alpha:
        values = values[..., :3]
        if not look.nearest:
            values = texels.finer(values, look.interpolation, look.wrap)
    if not texels.is_encoded(image):
        values = numpy.concatenate([texels.encoded_of(values[..., :3]), values[..., 3:]], axis=-1)
    return texels.png(texels.bytes_of(values)), "image/png"


def numbered(vertices, count):
    """Returns the used vertices (of `count`), ascending, and the index of each of `vertices` in this list."""
    is_used = numpy.zeros(count, bool)
    is_used[vertices] = True
    used = numpy.flatnonzero(is_used)
    number = numpy.empty(count, numpy.uint32)
    number[used] = numpy.arange(len(used), dtype=numpy.uint32)
    return used, number[vertices]


def shared(vertices, rows):
    """Returns the distinct corner data, and each corner's index into them. `vertices`: the mesh's vertex of each corner."""
    first = numpy.zeros(int(vertices.max()) + 1, numpy.int64)
    first[vertices[::-1]] = numpy.arange(len(vertices))[::-1]
    # fast path for the usual case: all corners of a vertex have the same data
    if numpy.array_equal(rows, rows[first[vertices]]):
        used, indices = numbered(vertices, len(first))
        return rows[first[used]], indices
    rows = numpy.ascontiguousarray(rows)
    _, first, indices = numpy.unique(rows.view([("", f"V{rows.shape[1] * 4}")]).ravel(), return_index=True, return_inverse=True)
    return rows[first], indices


class Corners:
    """Triangles of a mesh, corner by corner."""

    def __init__(self, data, shading_normals):
        self.data = data
        count = len(data.loop_triangles)
        self.vertices = numpy.empty(3 * count, numpy.int32)
        data.loop_triangles.foreach_get("vertices", self.vertices)
        self.loops = None  # read only when needed: Blender needs as much time for them as for everything else
        self.positions = numpy.empty(3 * len(data.vertices), numpy.float32)
        data.vertices.foreach_get("co", self.positions)
        self.positions = self.positions.reshape(-1, 3)
        self.smooth = numpy.zeros(count, bool)
        if shading_normals:
            faces = numpy.zeros(len(data.polygons), bool)  # read first: fewer than triangles, and usually all equal
            data.polygons.foreach_get("use_smooth", faces)
            if faces.all():
                self.smooth[:] = True
            elif faces.any():
                data.loop_triangles.foreach_get("use_smooth", self.smooth)
            # Normals at corners are needed for flat faces, too.
            if getattr(data, "use_auto_smooth", False) or getattr(data, "normals_domain", "FACE") == "CORNER":
                self.smooth[:] = True
        if self.smooth.any():
            if hasattr(data, "calc_normals_split"):  # before Blender 4.1
                data.calc_normals_split()
            self.normals = numpy.empty(9 * count, numpy.float32)
            data.loop_triangles.foreach_get("split_normals", self.normals)
            self.normals = self.normals.reshape(-1, 3)

    def _loops(self):
        if self.loops is None:
            self.loops = numpy.empty(len(self.vertices), numpy.int32)
            self.data.loop_triangles.foreach_get("loops", self.loops)
        return self.loops

    def forget(self):
        """Releases all data except the positions of triangles."""
        self.data = self.loops = self.smooth = self.normals = None

    def of(self, chosen, look, writer, smooth, is_baked):
        """Returns attributes and indices of some triangles (a mask), as numbers of accessors. `is_baked`: the active UV
        map is written as the second set of coordinates."""
        corners = slice(None) if chosen.all() else numpy.repeat(chosen, 3)
        vertices = self.vertices[corners]
        columns, names = [], [("POSITION", "VEC3")]
        if smooth:
            columns.append(self.normals[corners])
            names.append(("NORMAL", "VEC3"))
        if look.image is not None or is_baked:
            columns.append(self._places(look)[self._loops()[corners]])
            names.append(("TEXCOORD_0", "VEC2"))
        if is_baked:
            active = self.data.uv_layers.active
            columns.append(self._places(materials.Look(uv_map=active.name if active else ""))[self._loops()[corners]])
            names.append(("TEXCOORD_1", "VEC2"))
        if look.attribute is not None:
            columns.append(self._colors(look, corners))
            names.append(("COLOR_0", "VEC4"))
        if columns:
            columns.insert(0, self.positions[vertices])
            rows, indices = shared(vertices, numpy.hstack(columns))
        else:  # all corners of a vertex have the same data
            used, indices = numbered(vertices, len(self.positions))
            rows = self.positions[used]
            columns = [rows]
        at, attributes = 0, {}
        for (name, shape), column in zip(names, columns):
            part = numpy.ascontiguousarray(rows[:, at:at + column.shape[1]], "<f4")
            at += column.shape[1]
            bounds = (part.min(axis=0), part.max(axis=0)) if name == "POSITION" else None
            attributes[name] = writer.glb.accessor(part.tobytes(), shape, bounds=bounds)
        return attributes, writer.glb.accessor(indices.astype("<u4").tobytes(), "SCALAR", glb.UNSIGNED)

    def _places(self, look):
        """Flips v: in glTF, pictures begin at their top left."""
        layers = self.data.uv_layers
        layer = layers.get(look.uv_map) if look.uv_map else next((one for one in layers if one.active_render), None)
        places = numpy.zeros(2 * len(self.data.loops), numpy.float32)
        if layer is not None:
            layer.data.foreach_get("uv", places)
        places = places.reshape(-1, 2)
        if look.placing is not None:
            rows = numpy.array(look.placing)
            places = (places @ rows[:, :2].T + rows[:, 2]).astype(numpy.float32)
        places[:, 1] = 1 - places[:, 1]
        return places

    def _colors(self, look, corners):
        attributes = self.data.color_attributes
        layer = attributes.get(look.attribute) if look.attribute else attributes.active_color
        if layer is None:
            return numpy.ones((len(self.vertices[corners]), 4), numpy.float32)
        values = numpy.empty(4 * len(layer.data), numpy.float32)
        layer.data.foreach_get("color", values)  # linear
        numbers = self.vertices if layer.domain == "POINT" else self._loops()
        return values.reshape(-1, 4)[numbers[corners]]
