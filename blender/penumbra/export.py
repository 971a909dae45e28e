"""Blender's scene, as its dependency graph evaluates it for a render, in the exchange file (glb.py)."""

import os
import tempfile

import bpy
import numpy

from . import glb, lamps, materials

_SURFACES = {"MESH", "CURVE", "SURFACE", "META", "FONT"}
_UNKNOWN = {"VOLUME": "is a volume", "POINTCLOUD": "is a point cloud", "CURVES": "is hair", "GPENCIL": "is grease pencil"}


class SceneWriter:
    """Writes one frame. What is lost goes to `losses` by name (losses.py)."""

    def __init__(self, depsgraph, losses, shading_normals):
        self.depsgraph, self.losses, self.shading_normals = depsgraph, losses, shading_normals
        self.scene = depsgraph.scene
        self.glb = glb.Glb()
        self._meshes, self._materials, self._looks, self._images = {}, {}, {}, {}

    def write(self, path, size):
        for instance in self.depsgraph.object_instances:
            if instance.show_self:
                self._object(instance)
        self._camera(size)
        self._world()
        with open(path, "wb") as file:
            file.write(self.glb.encoded())

    def _object(self, instance):
        thing = instance.object
        if thing.type == "LIGHT":
            if thing.visible_diffuse:
                lamps.write_lamp(thing.data, thing.name, instance.matrix_world, self.glb, self.losses)
            return
        if thing.type in _UNKNOWN:
            self.losses.refuse(f"{_UNKNOWN[thing.type]}, which is not rendered", thing.name)
        if thing.type not in _SURFACES:
            return
        for system in thing.particle_systems:
            if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
                self.losses.refuse("has hair, which is not rendered", thing.name)
        if thing.is_holdout or thing.is_shadow_catcher:
            self.losses.refuse("is a holdout or shadow catcher", thing.name)
        mesh = self._mesh(thing)
        if mesh is None:
            return
        number, emits = mesh
        extras = {} if thing.visible_shadow else {"castsShadow": False}
        if not thing.visible_camera:
            if not emits or thing.visible_shadow:
                self.losses.refuse("is hidden from the camera but not from light", thing.name)
            else:
                extras["body"] = False
        self.glb.node(thing.name, instance.matrix_world, extras, mesh=number)

    def _mesh(self, thing):
        """The number of an object's mesh in the file, and whether it shines; None for one without faces."""
        key = (thing.data.as_pointer(), thing.original.as_pointer() if thing.type != "MESH" else 0,
               tuple(slot.material.name_full if slot.material else "" for slot in thing.material_slots))
        if key not in self._meshes:
            data = thing.to_mesh()
            self._meshes[key] = self._primitives(thing, data) if data is not None else None
            thing.to_mesh_clear()
        return self._meshes[key]

    def _primitives(self, thing, data):
        data.calc_loop_triangles()
        count = len(data.loop_triangles)
        if count == 0:
            return None
        corners = Corners(data, self.shading_normals)
        material_of = numpy.empty(count, numpy.int32)
        data.loop_triangles.foreach_get("material_index", material_of)
        slots = thing.material_slots
        material_of = numpy.clip(material_of, 0, max(len(slots) - 1, 0))
        primitives, emits = [], False
        for slot in numpy.unique(material_of):
            material = slots[slot].material if len(slots) > 0 else None
            look = self._look(material, thing.name)
            emits = emits or max(look.radiance) > 0
            attributes, indices = corners.of(material_of == slot, look, self)
            primitives.append({"attributes": attributes, "indices": indices, "material": self._material(material, look)})
        return self.glb.mesh(thing.data.name, primitives), emits

    def _look(self, material, name):
        key = material.name_full if material else ""
        if key not in self._looks:
            self._looks[key] = materials.Reader(self.losses, key or name).look(material)
        return self._looks[key]

    def _material(self, material, look):
        key = material.name_full if material else ""
        if key not in self._materials:
            texture = self._texture(look) if look.image else None
            cuts = material is not None and material.blend_method == "CLIP" and (look.alpha < 1 or look.image_alpha)
            self._materials[key] = self.glb.material(
                key or "Default", look.color, look.radiance, look.alpha,
                material.alpha_threshold if cuts else None, texture, look.image_alpha)
        return self._materials[key]

    def _texture(self, look):
        image = look.image
        if image.name_full not in self._images:
            try:
                self._images[image.name_full] = self.glb.image(image.name, *encoded_image(image))
            except (OSError, RuntimeError) as error:
                self.losses.refuse(f"is an image that cannot be written as PNG ({error})", image.name)
                self._images[image.name_full] = None
            if image.colorspace_settings.name not in ("sRGB", "Non-Color") or \
                    (image.colorspace_settings.name == "Non-Color" and not look.image_alpha):
                self.losses.mention(f"is read as sRGB, not {image.colorspace_settings.name}", image.name)
        number = self._images[image.name_full]
        if number is None:
            return None
        return self.glb.texture(number, 33071 if look.wrap == "EXTEND" else 10497, look.nearest)

    def _camera(self, size):
        camera = self.scene.camera
        if camera is None:
            raise ValueError("the scene has no camera")
        camera = camera.evaluated_get(self.depsgraph)
        lens = camera.data
        if lens.type == "PANO":
            raise ValueError(f"camera '{camera.name}' is panoramic; perspective and orthographic ones are rendered")
        if lens.dof.use_dof:
            self.losses.mention("has a depth of field, which is left out", camera.name)
        self.glb.camera(camera.name, lamps.without_scale(camera.matrix_world), size[0] / size[1],
                        **lamps.lens_of(lens, *size))

    def _world(self):
        world = self.scene.world
        if world is not None and sends_light(world):
            self.losses.mention("is a world (or HDRI) whose light is not rendered", world.name)


def sends_light(world):
    """May any light come from the world?"""
    if not world.use_nodes or world.node_tree is None:
        return max(world.color) > 0
    output = world.node_tree.get_output_node("CYCLES")
    if output is None or not output.inputs["Surface"].is_linked:
        return False
    node = output.inputs["Surface"].links[0].from_node
    if node.type != "BACKGROUND" or any(socket.is_linked for socket in node.inputs):
        return True
    return max(node.inputs["Color"].default_value[:3]) > 0 and node.inputs["Strength"].default_value > 0


def encoded_image(image):
    """An image's bytes and their type: its file's, where that is PNG or JPEG and nothing was painted since."""
    if not image.is_dirty and image.source == "FILE" and image.file_format in ("PNG", "JPEG"):
        if image.packed_file is not None:
            data = image.packed_file.data
        else:
            with open(bpy.path.abspath(image.filepath, library=image.library), "rb") as file:
                data = file.read()
        if data[:8] == b"\x89PNG\r\n\x1a\n":
            return data, "image/png"
        if data[:2] == b"\xff\xd8":
            return data, "image/jpeg"
    handle, path = tempfile.mkstemp(suffix=".png")
    os.close(handle)
    copy = image.copy()
    try:
        copy.file_format = "PNG"
        copy.save(filepath=path)
        with open(path, "rb") as file:
            return file.read(), "image/png"
    finally:
        bpy.data.images.remove(copy)
        os.remove(path)


class Corners:
    """A mesh's triangles, corner by corner."""

    def __init__(self, data, shading_normals):
        self.data = data
        count = len(data.loop_triangles)
        self.vertices = numpy.empty(3 * count, numpy.int32)
        data.loop_triangles.foreach_get("vertices", self.vertices)
        self.loops = numpy.empty(3 * count, numpy.int32)
        data.loop_triangles.foreach_get("loops", self.loops)
        self.positions = numpy.empty(3 * len(data.vertices), numpy.float32)
        data.vertices.foreach_get("co", self.positions)
        self.positions = self.positions.reshape(-1, 3)
        self.normals = None
        if shading_normals:
            data.calc_normals_split()
            self.normals = numpy.empty(9 * count, numpy.float32)
            data.loop_triangles.foreach_get("split_normals", self.normals)
            self.normals = self.normals.reshape(-1, 3)

    def of(self, chosen, look, writer):
        """Attributes and indices of some triangles (a mask), as numbers of accessors."""
        corners = numpy.repeat(chosen, 3)
        columns = [self.positions[self.vertices[corners]]]
        names = [("POSITION", "VEC3")]
        if self.normals is not None:
            columns.append(self.normals[corners])
            names.append(("NORMAL", "VEC3"))
        if look.image is not None:
            columns.append(self._places(look)[self.loops[corners]])
            names.append(("TEXCOORD_0", "VEC2"))
        if look.attribute is not None:
            columns.append(self._colors(look, corners))
            names.append(("COLOR_0", "VEC4"))
        rows = numpy.ascontiguousarray(numpy.hstack(columns))
        # What is the same in all is one vertex.
        _, first, indices = numpy.unique(rows.view([("", f"V{rows.shape[1] * 4}")]).ravel(), return_index=True,
                                         return_inverse=True)
        rows, at, attributes = rows[first], 0, {}
        for (name, shape), column in zip(names, columns):
            part = numpy.ascontiguousarray(rows[:, at:at + column.shape[1]], "<f4")
            at += column.shape[1]
            bounds = (part.min(axis=0), part.max(axis=0)) if name == "POSITION" else None
            attributes[name] = writer.glb.accessor(part.tobytes(), shape, bounds=bounds)
        return attributes, writer.glb.accessor(indices.astype("<u4").tobytes(), "SCALAR", glb.UNSIGNED)

    def _places(self, look):
        """In glTF pictures begin at their top left."""
        layers = self.data.uv_layers
        layer = layers.get(look.uv_map) if look.uv_map else next((one for one in layers if one.active_render), None)
        places = numpy.zeros(2 * len(self.data.loops), numpy.float32)
        if layer is not None:
            layer.data.foreach_get("uv", places)
        places = places.reshape(-1, 2)
        places[:, 1] = 1 - places[:, 1]
        return places

    def _colors(self, look, corners):
        attributes = self.data.color_attributes
        layer = attributes.get(look.attribute) if look.attribute else attributes.active_color
        if layer is None:
            return numpy.ones((int(corners.sum()), 4), numpy.float32)
        values = numpy.empty(4 * len(layer.data), numpy.float32)
        layer.data.foreach_get("color", values)  # linear
        numbers = self.vertices if layer.domain == "POINT" else self.loops
        return values.reshape(-1, 4)[numbers[corners]]
