# SPDX-License-Identifier: Apache-2.0
"""Penumbra: how much of an area light each visible point sees, exactly or by any known approximation.

    import penumbra
    scene = penumbra.load("room.json")
    picture = penumbra.render(scene, size=(512, 512))        # exact areas
    picture.V, picture.rgb                                   # numpy arrays (H, W) and (H, W, 3)

Lengths are in the scene's unit, Y is up, angles are in degrees. Arrays of a picture are read-only views of its memory, row
by row from the top left. Calls release the interpreter's lock while they work, and Ctrl-C ends them. Errors are
`penumbra.Error` with the command line's messages: `UsageError` for an invalid call, such as arguments of a wrong type,
`InputError` for a scene or file that cannot be used, `ResourceError` for a missing resource of the machine.
"""

from __future__ import annotations

import json as _json
import os as _os
import typing as _typing
from collections.abc import Mapping as _Mapping

import numpy as _np

from . import _arguments, _core
from ._core import Cancelled, Error, InputError, ResourceError, UsageError

__version__ = _core.version()
for _error in (Cancelled, Error, InputError, ResourceError, UsageError):
    _error.__module__ = __name__  # so that messages name the class as programs import it
__all__ = [
    "Cancelled", "Error", "InputError", "Instance", "LightPicture", "Picture", "Renderer", "ResourceError", "Scene", "UsageError",
    "add_method", "compare", "inspect", "load", "methods", "render", "wedges",
]

_SHAPES = {
    "rectangle": ("center", "half_u", "half_v"),
    "disk": ("center", "normal", "radius"),
    "ellipse": ("center", "half_u", "half_v"),
    "polygon": ("vertices",),
    "sphere": ("center", "radius"),
    "sun": ("direction", "angle"),
    "dome": ("up", "rotate", "half", "image", "sampled"),
}
_PARTS = {  # the check of each part of a shape
    "center": _arguments.vector, "half_u": _arguments.vector, "half_v": _arguments.vector, "normal": _arguments.vector,
    "direction": _arguments.vector, "up": _arguments.vector, "radius": _arguments.number, "angle": _arguments.number,
    "rotate": _arguments.number, "half": _arguments.flag, "sampled": _arguments.flag,
    "vertices": lambda name, value: _arguments.rows(name, value, "N").tolist(),
    "image": lambda name, value: "" if value is None else _os.fsdecode(_arguments.path(name, value)),
}
_SPELLINGS = {"halfU": "half_u", "halfV": "half_v", "twoSided": "two_sided"}  # spellings in scene files


class Instance(_typing.NamedTuple):
    """One instance of a mesh: the mesh's name or number, and the instance's number, from 0. Instances that were read
    from a file are named in this form: `Instance("tree", 17)`."""

    mesh: _typing.Union[str, int]
    number: int


class Scene:
    """Triangle meshes, area lights and cameras: a value that can be changed and copied (`copy.copy`)."""

    def __init__(self, core=None):
        if core is not None and not isinstance(core, _core.Scene):
            raise UsageError(f"Scene({_arguments.shown(core)}): expected no argument; Scene.load reads a file, Scene.from_dict a dict")
        self._core = _core.Scene() if core is None else core

    def __copy__(self):
        return Scene(_core.Scene(self._core))

    def __deepcopy__(self, memo):
        return self.__copy__()

    @classmethod
    def load(cls, file, *, lenient=False, allow_outside=False, frame=None, fps=24.0, lamp_radius=None, sun_angle=None,
             lumens_per_watt=None, clips=(), studio=False):
        """Reads a .json (penumbra-scene/1), .gltf or .glb file, or a mesh file. A mesh, or a glTF scene without lights,
        is placed in a studio (a light, a floor, a camera); with `studio` every scene is. `frame` is at frame / fps
        seconds of the file's animation; the other options are those of `penumbra render`."""
        arguments = _arguments
        return cls(_core.Scene.load(
            arguments.path("file", file), arguments.flag("lenient", lenient), arguments.flag("allow_outside", allow_outside),
            arguments.finite("frame", frame), arguments.finite("fps", 24.0 if fps is None else fps),
            arguments.finite("lamp_radius", lamp_radius), arguments.finite("sun_angle", sun_angle),
            arguments.finite("lumens_per_watt", lumens_per_watt), arguments.names("clips", clips, numbers=True),
            arguments.flag("studio", studio)))

    @classmethod
    def from_dict(cls, scene, folder=".", *, allow_outside=False):
        """Builds a scene from a dict with the content of a penumbra-scene/1 file. A mesh may have arrays "vertices" (V,
        3) and "faces" (F, 3) in place of a file or a shape. Names of files are relative to `folder`."""
        if not isinstance(scene, _Mapping):
            raise UsageError(f"Scene.from_dict({_arguments.shown(scene)}): expected a dict with the content of a penumbra-scene/1 file")
        scene = dict(scene)
        scene.setdefault("format", "penumbra-scene/1")
        arrays = []
        meshes = scene.get("meshes", [])
        if isinstance(meshes, (list, tuple)):
            scene["meshes"] = [_without_arrays(index, mesh, arrays) for index, mesh in enumerate(meshes)]
        text = _json.dumps(_arguments.plain(scene))
        folder = _arguments.path("folder", folder, "a folder's name")
        return cls(_core.Scene.parse(text, folder, _arguments.flag("allow_outside", allow_outside), arrays))

    def add_mesh(self, name, vertices, faces, *, color=(0.8, 0.8, 0.8), casts_shadow=True, receives_shadow=True):
        """Adds a mesh: vertices (V, 3), faces (F, 3). Returns its number."""
        return self._core.add_mesh(
            _arguments.name_of("name", name), _arguments.rows("vertices", vertices), _arguments.faces("faces", faces),
            _arguments.vector("color", color), _arguments.flag("casts_shadow", casts_shadow),
            _arguments.flag("receives_shadow", receives_shadow))

    def add_instance(self, mesh, matrix):
        """Adds an instance of a mesh, given by its name or number, whose vertices are stored once. `matrix` (4, 4), for
        column vectors, transforms them to the world. As soon as a mesh has an instance, it appears only where its
        instances are. Returns an Instance, for set_transform."""
        mesh = self._mesh(mesh)
        return Instance(mesh, self._core.add_instance(mesh, _arguments.matrix("matrix", matrix)))

    def instance_count(self, mesh):
        """Returns the number of instances of a mesh, given by its name or number; 0: the mesh itself is in the
        scene."""
        return self._core.instance_count(self._mesh(mesh))

    def set_positions(self, mesh, vertices):
        """Replaces the positions (V, 3) of the vertices of a mesh, given by its name or number."""
        self._core.set_positions(self._mesh(mesh), _arguments.rows("vertices", vertices))

    def set_transform(self, mesh, matrix):
        """Moves a mesh, given by its name or number: applies `matrix` (4, 4), for column vectors, to the positions with
        which the mesh was added or read. If the mesh has instances, moves them all. For an Instance, replaces its
        matrix."""
        matrix = _arguments.matrix("matrix", matrix)
        if isinstance(mesh, Instance):
            number = _arguments.whole("number of the instance", mesh.number)
            self._core.set_instance_transform(self._mesh(mesh.mesh), number, matrix)
        else:
            self._core.set_transform(self._mesh(mesh), matrix)

    def _mesh(self, mesh):
        expected = "a mesh's name, or its number from 0 on"
        if isinstance(mesh, str):
            return self._core.mesh(_arguments.text("mesh", mesh, expected))
        if mesh is None:
            raise UsageError(f"mesh None: expected {expected}")
        return _arguments.whole("mesh", mesh, expected=expected)

    def add_light(self, name, kind, *, radiance=(10, 10, 10), two_sided=False, **shape):
        """Adds a light of a kind: rectangle(center, half_u, half_v), disk(center, normal, radius), ellipse(center,
        half_u, half_v), polygon(vertices), sphere(center, radius), sun(direction, angle) or dome(up, rotate, half,
        image, sampled). All parts of a dome have defaults."""
        self._core.add_light(_arguments.name_of("name", name), kind, _shape(kind, shape), _arguments.vector("radiance", radiance),
                             _arguments.flag("two_sided", two_sided))

    def set_light(self, name, **changes):
        """Changes a light: parts of its shape, `radiance` and `two_sided`, or `kind` with all parts of a new shape."""
        light = self.light(name)
        changes = {_SPELLINGS.get(key, key): value for key, value in changes.items()}
        has_options = "radiance" in changes or "two_sided" in changes
        radiance = _arguments.vector("radiance", changes.pop("radiance", light["radiance"]))
        two_sided = _arguments.flag("two_sided", changes.pop("two_sided", light["two_sided"]))
        kind = changes.pop("kind", light["kind"])
        if not isinstance(kind, str):
            raise _unknown_kind(kind)
        # another kind needs all parts of its shape; the same kind keeps the parts that are not given
        kept = {} if kind != light["kind"] else {key: light[key] for key in light if key not in ("kind", "radiance", "two_sided")}
        shape = _shape(kind, kept | changes) if changes or kind != light["kind"] else None
        if has_options:
            self._core.set_light_options(name, radiance, two_sided)
        if shape is not None:
            try:
                self._core.set_light_shape(name, kind, shape)
            except Exception:
                if has_options:
                    self._core.set_light_options(name, light["radiance"], light["two_sided"])  # neither change is made
                raise

    def remove_light(self, name):
        self._core.remove_light(_arguments.name_of("name", name))

    def light(self, name):
        """Returns a dict of the light: its kind, the parts of its shape, radiance and two_sided."""
        return self._core.light(_arguments.name_of("name", name))

    def set_camera(self, eye, target, up=(0, 1, 0), vertical_fov=45.0, height=None, name="camera", *,
                   aperture=0.0, focus_distance=None):
        """Adds a camera, or replaces the one with the same name, and makes it the default. `height` makes it
        orthographic. `aperture`: radius of a thin lens, which is sharp at `focus_distance` along the view axis (by
        default the target's) and blurs other surfaces if a pixel has several view samples; 0: everything is sharp."""
        eye, target = _arguments.vector("eye", eye), _arguments.vector("target", target)
        if focus_distance is None:
            focus_distance = float(_np.linalg.norm(_np.subtract(eye, target)))
        self._core.set_camera(eye, target, _arguments.vector("up", up), _arguments.number("vertical_fov", vertical_fov),
                              None if height is None else _arguments.number("height", height), _arguments.name_of("name", name),
                              _arguments.number("aperture", aperture), _arguments.number("focus_distance", focus_distance))

    @property
    def meshes(self):
        return self._core.mesh_names()

    @property
    def lights(self):
        return self._core.light_names()

    @property
    def cameras(self):
        return self._core.camera_names()

    @property
    def triangle_count(self):
        return self._core.triangle_count()

    @property
    def size(self):
        """Default (width, height) of pictures."""
        return tuple(self._core.size())

    @size.setter
    def size(self, size):
        self._core.set_size(*_arguments.size(size))

    @property
    def warnings(self):
        """Messages about parts of the file that were skipped or changed while the scene was read."""
        return self._core.warnings()

    def save(self, file):
        """Writes .json, .glb or .obj; returns warnings about features that the format does not support."""
        return self._core.save(_arguments.path("file", file))

    def __repr__(self):
        return f"<penumbra.Scene: {self.triangle_count} triangles, lights {self.lights}, cameras {self.cameras}>"


def _without_arrays(index, mesh, arrays):
    """Returns a mesh of a scene's dict with a placeholder for its arrays, which are added to `arrays`."""
    if not isinstance(mesh, _Mapping) or not ("vertices" in mesh or "faces" in mesh):
        return mesh
    if not ("vertices" in mesh and "faces" in mesh):
        raise UsageError(f"/meshes/{index}: expected both vertices and faces")
    mesh = dict(mesh)
    vertices = _arguments.rows(f"/meshes/{index}/vertices", mesh.pop("vertices"))
    arrays.append((index, vertices, _arguments.faces(f"/meshes/{index}/faces", mesh.pop("faces"))))
    # The schema requires a source of triangles; the arrays replace this one.
    mesh["triangles"] = [[0, 0, 0, 1, 0, 0, 0, 1, 0]]
    return mesh


def _unknown_kind(kind):
    return UsageError(f'light of kind {_arguments.shown(kind)}: expected {", ".join(_SHAPES)}')


def _shape(kind, given):
    if not isinstance(kind, str) or kind not in _SHAPES:
        raise _unknown_kind(kind)
    shape = {_SPELLINGS.get(key, key): value for key, value in given.items()}
    for key in shape:
        if key not in _SHAPES[kind]:
            raise UsageError(f'a {kind} light has no "{key}"; it has {", ".join(_SHAPES[kind])}')
    return {key: _PARTS[key](key, value) for key, value in shape.items()}


class LightPicture:
    """One light's part of a picture."""

    def __init__(self, core, index):
        self._core, self._index = core, index

    @property
    def V(self):
        """Visibility (H, W), 0 to 1: the fraction of the light's area that the pixel sees."""
        return self._core.visibility(self._index)

    @property
    def rgb(self):
        """Linear beauty of this light alone (H, W, 3)."""
        return self._core.light_beauty(self._index)

    @property
    def masks(self):
        """Light samples that each pixel sees, bool (H, W, N); None for exact areas and for methods without masks."""
        words = self._core.mask_words(self._index)
        if words is None:
            return None
        bits = _np.unpackbits(words.astype("<u4").view(_np.uint8), axis=-1, bitorder="little")
        return bits[..., : self._core.light_samples(self._index)].astype(bool)

    @property
    def method(self):
        """The name of the method that was used for this light."""
        return self._core.method(self._index)


class Picture(LightPicture):
    """A rendered picture: numpy arrays, row by row from the top left. V and masks are of the first light."""

    def __init__(self, core):
        super().__init__(core, 0)
        self.lights = {name: LightPicture(core, i) for i, name in enumerate(core.light_names())}

    @property
    def size(self):
        """(width, height)."""
        return self._core.width(), self._core.height()

    @property
    def rgb(self):
        """Linear beauty of all lights together (H, W, 3)."""
        return self._core.beauty()

    @property
    def A(self):
        """Coverage (H, W): 1 where the pixel shows a surface, 0 in the background."""
        return self._core.alpha()

    @property
    def P(self):
        """Positions in world space (H, W, 3)."""
        return self._core.positions()

    @property
    def Prel(self):
        """Positions relative to `origin` (H, W, 3), in which visibility is decided."""
        return self._core.relative_positions()

    @property
    def origin(self):
        return tuple(self._core.origin())

    @property
    def N(self):
        """Geometric normals toward the camera (H, W, 3)."""
        return self._core.normals()

    @property
    def Z(self):
        """Depth along the camera's axis (H, W); 1e10 in the background."""
        return self._core.depth()

    @property
    def id(self):
        """Triangle numbers (H, W); 4294967295 in the background."""
        return self._core.ids()

    @property
    def stats(self):
        """A dict: seconds of each phase, counters, warnings, lights."""
        return _json.loads(self._core.stats_json())

    def __repr__(self):
        return f"<penumbra.Picture: {self.size[0]}x{self.size[1]}, lights {list(self.lights)}>"


class Renderer:
    """Renders pictures of one scene, and keeps unchanged data from call to call: hierarchies over meshes, view samples,
    the Vulkan device. The given scene is copied; `scene` is the renderer's copy, which may be changed between calls."""

    def __init__(self, scene, *, device="", log=None, progress=None):
        """`device`: part of a Vulkan device's name, its index, or "cpu". `log(level, message)` receives messages,
        `progress(stage, done)` is called several times a second; the call ends with Cancelled if it returns False."""
        self._core = _core.Renderer(_as_scene(scene)._core, _device(device), _arguments.function("log", log),
                                    _arguments.function("progress", progress))
        self._scene = Scene(self._core.scene())

    @property
    def scene(self):
        """The renderer's own scene."""
        return self._scene

    def set_light(self, name, **changes):
        """Calls Scene.set_light of the renderer's scene."""
        self.scene.set_light(name, **changes)

    def set_camera(self, *args, **kwargs):
        """Calls Scene.set_camera of the renderer's scene."""
        self.scene.set_camera(*args, **kwargs)

    def set_transform(self, mesh, matrix):
        """Calls Scene.set_transform of the renderer's scene."""
        self.scene.set_transform(mesh, matrix)

    def render(self, size=None, method="", light_samples=0, options=None, light=None, camera="", *, sample_pattern="",
               sample_seed=0, pixel_samples=1, pixel_tolerance=1 / 512, light_cutoff=0.0, normals="shading",
               masks=True, instances="auto"):
        """Returns a Picture. `size`: (width, height), or None for the scene's. Without `method` each light gets the
        best method that computes its exact area; with `light_samples` (1 to 4096) the best one with light samples.
        `options`: a dict of the method's options. `light`: a name or names; only these lights are rendered. `normals`:
        "shading" or "geometric", for the beauty. `pixel_samples`: view samples a pixel, a square number. Exact areas
        are interpolated where the estimated error is at most `pixel_tolerance` (0: nowhere). A light is left out, with
        V = 0, where without occluders it would be at most the share `light_cutoff` of all lights together, in each of
        red, green and blue. `instances`: "copies", "shared" (without copies), or "auto": the cheaper one. All give the
        same picture."""
        normals = _arguments.text("normals", normals)
        if normals not in ("shading", "geometric"):
            raise UsageError(f'normals "{normals}": expected shading or geometric')
        arguments = _arguments
        width, height = arguments.size(size)
        return Picture(self._core.render(
            width, height, arguments.text("method", method, "a method's name"), arguments.options("options", options),
            arguments.whole("light_samples", light_samples), arguments.text("sample_pattern", sample_pattern),
            arguments.whole("sample_seed", sample_seed), arguments.names("light", light),
            arguments.text("camera", camera, "a camera's name"), arguments.whole("pixel_samples", pixel_samples),
            arguments.number("pixel_tolerance", pixel_tolerance), arguments.number("light_cutoff", light_cutoff),
            normals == "shading", arguments.flag("masks", masks), arguments.text("instances", instances)))


def _device(device):
    """Returns part of a device's name, or its index, as text."""
    if isinstance(device, int) and not isinstance(device, bool):
        return str(device)
    return _arguments.text("device", device, "part of a device's name, its index, or \"cpu\"")


def _as_scene(scene):
    if isinstance(scene, Scene):
        return scene
    if isinstance(scene, _Mapping):
        return Scene.from_dict(scene)
    return load(_arguments.path("scene", scene, "a Scene, a dict (Scene.from_dict) or a file's name"))


def load(file, **options):
    """Reads a scene: Scene.load(file, …)."""
    return Scene.load(file, **options)


def render(scene, size=None, method="", light_samples=0, options=None, light=None, camera="", *, device="", log=None,
           progress=None, **more):
    """Renders one picture of a Scene, a dict (Scene.from_dict) or a file: Renderer(scene).render(…)."""
    return Renderer(scene, device=device, log=log, progress=progress).render(
        size, method, light_samples, options, light, camera, **more)


def compare(scene, methods="default", *, reference="raytrace", reference_samples=1024, size=None, light_samples=256,
            sample_pattern="", light=None, camera="", runs=0, error_budget=False, out="", device="", log=None,
            progress=None):
    """Compares several methods on the same view samples with a reference ("raytrace", "exact", or an entry with exact
    areas, such as "edge-scatter:rows=exact"). Returns a list of dicts, as under `methods` in metrics.json. `methods`:
    entries "NAME:key=value:…", or the groups geometry, image, all, default. `out`: a folder for pictures and the
    report."""
    arguments = _arguments
    width, height = arguments.size(size)
    entries = arguments.names("methods", methods, "an entry such as \"pcss:size=512\", a group, or a list of them")
    if not entries:
        raise UsageError("methods: expected one or more entries, or a group")
    if not isinstance(reference_samples, str):
        reference_samples = arguments.whole("reference_samples", reference_samples, 1, 'a whole number, from 1 on, or "same"')
    text = _core.compare_json(
        _as_scene(scene)._core, entries, arguments.text("reference", reference), arguments.text("reference_samples", str(reference_samples)),
        width, height, arguments.whole("light_samples", light_samples), arguments.text("sample_pattern", sample_pattern),
        arguments.names("light", light), arguments.text("camera", camera, "a camera's name"), arguments.whole("runs", runs),
        arguments.flag("error_budget", error_budget), arguments.path("out", "" if out is None else out, "a folder's name"),
        _device(device), arguments.function("log", log), arguments.function("progress", progress))
    return _json.loads(text)["methods"]


class Question:
    """Arguments of the function of a method added by add_method: numpy arrays; all positions are relative to `origin`.

    For the K pixels that receive shadows of this light: `p` (K, 3) points, `n` (K, 3) unit normals toward the camera,
    `face` (K,) indices of the faces that the points are on, `pixels` (K,) indices of the pixels, row by row.
    The scene: `vertices` (V, 3) float32, `faces` (F, 3), `casts` (F,) False for faces that cast no shadow of this
    light.
    The light: `light`, a dict with name, kind, center, u, v, radius, two_sided, outline, points (N, 3) and weights; for
    a sun, center, u, v and points are directions toward it. `points_of_pixel` (K, N, 3): a sphere's light samples, else
    None.
    The whole view: `size` (width, height), `all_p` and `all_n` (H, W, 3), `all_faces` (H, W), -1 in the background."""

    def __init__(self, values):
        self.__dict__.update(values)


def add_method(name, function, *, family="image", masks=False, lights=tuple(_SHAPES), textures=False, options=None, paper="",
               exact_for="nothing"):
    """Adds a shadow method of the calling program to this process: `render`, `compare` and `methods` then accept its
    name.

    `function(question, **options)` receives a Question and returns V, an array (K,) of numbers from 0 to 1, or with
    `masks` a bool array (K, N): whether pixel k sees light sample j. `options`: a dict from names to (default, least,
    most) for numbers, which are integers if all three are int, or to a list of strings, the first of which is the
    default. `family`: "image" or "geometry". `lights`: supported kinds of lights; `textures`: V is weighted by
    light["weights"]. An exception of the function ends the call."""
    name = _arguments.name_of("name", name)
    _arguments.function(f"method {name!r}: function", function, optional=False)
    masks = _arguments.flag("masks", masks)
    if not (options is None or isinstance(options, _Mapping)):
        raise UsageError(f"options {_arguments.shown(options)}: expected a dict of names to (default, least, most) or a list of texts")
    described, types = [], {}
    for key, values in (options or {}).items():
        key = _arguments.name_of("options: the key", key)
        if isinstance(values, list) and values and all(isinstance(value, str) for value in values):
            described.append(dict(name=key, default=values[0], choices=values, least=0.0, most=0.0, whole=False))
            types[key] = str
        elif isinstance(values, (tuple, list)) and len(values) == 3:
            default, least, most = values
            numbers = [_arguments.finite(f"options: {key}", value) for value in (default, least, most) if value is not None]
            if len(numbers) != 3:
                raise UsageError(f"options: {key} {values!r}: expected three numbers (default, least, most)")
            whole = all(isinstance(value, (int, _np.integer)) for value in values)
            described.append(dict(name=key, default=str(default), choices=[], least=numbers[1], most=numbers[2], whole=whole))
            types[key] = int if whole else float
        else:
            raise UsageError(f"options: {key} {_arguments.shown(values)}: expected (default, least, most), or a list of texts")

    def ask(values):
        given = {key: types[key](text) for key, text in values["options"].items()}
        return _arguments.values_of(f"method {name!r}", function(Question(values), **given), masks)

    _core.add_method(name, ask, _arguments.text("family", family), _arguments.text("paper", paper),
                     _arguments.text("exact_for", exact_for), masks, _arguments.names("lights", lights, "kinds of lights"),
                     _arguments.flag("textures", textures), described)


def inspect(mesh, faces=None, *, weld=0.0, self_intersections=True, list_limit=100, log=None, progress=None):
    """Returns a mesh's defects and each method's verdict on it, as the dict that `penumbra inspect --json` prints.
    `mesh`: a file, or vertices (V, 3) with `faces` (F, 3). `log` and `progress`: as for Renderer."""
    options = (_arguments.number("weld", weld), _arguments.flag("self_intersections", self_intersections),
               _arguments.whole("list_limit", list_limit), _arguments.function("log", log), _arguments.function("progress", progress))
    if faces is None:
        file = _arguments.path("mesh", mesh, "a file's name, or vertices together with `faces`")
        return _json.loads(_core.inspect_file(file, *options))
    return _json.loads(_core.inspect_arrays(_arguments.rows("vertices", mesh), _arguments.faces("faces", faces), *options))


def wedges(scene, light="", *, construction="original", from_="centre", validate=False):
    """Returns the penumbra wedges of a light: the dict that `penumbra wedges --json` writes."""
    return _json.loads(_core.wedges_json(
        _as_scene(scene)._core, _arguments.text("light", light, "a light's name"), _arguments.text("construction", construction),
        _arguments.text("from_", from_), _arguments.flag("validate", validate)))


def methods():
    """Returns all methods: the list of dicts that `penumbra methods --json` prints."""
    return _json.loads(_core.methods_json())["methods"]
