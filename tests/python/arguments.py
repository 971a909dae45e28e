# SPDX-License-Identifier: Apache-2.0
"""Tests the module's errors for arguments of wrong types: each public function, each parameter. module.py runs these
tests."""

import copy
import decimal
import fractions
import inspect
import os
import pathlib
import sys
import tempfile
import unittest

import numpy as np

import penumbra

SOURCE = pathlib.Path(sys.argv[2])
TRIANGLE = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
FACE = np.array([[0, 1, 2]])


def small_scene():
    """Returns a floor under a square light, with a board between them."""
    return {
        "size": [8, 6],
        "camera": {"eye": [0, 0.8, 4], "target": [0, 0, 0]},
        "meshes": [{"name": "floor", "vertices": [[-3, 0, 3], [3, 0, 3], [3, 0, -3], [-3, 0, -3]], "faces": [[0, 1, 2], [0, 2, 3]]},
                   {"name": "board", "vertices": [[0, 1, -3.0], [3, 1, -3], [3, 1, 3], [0, 1, 3]], "faces": [[0, 1, 2], [0, 2, 3]]}],
        "lights": [{"name": "key", "rectangle": {"center": [0, 2, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}}],
    }


def with_mesh(**parts):
    return {**small_scene(), "meshes": [{"name": "m", "vertices": TRIANGLE, "faces": FACE, **parts}]}


def contains_itself():
    scene = small_scene()
    scene["size"].append(scene["size"])
    return scene


class Arguments(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = penumbra.Scene.from_dict(small_scene())

    def test_wrong_ones_are_named_with_what_would_be_right(self):
        usage, wrong_input, resource = penumbra.UsageError, penumbra.InputError, penumbra.ResourceError
        scene, parse = copy.copy(self.scene), penumbra.Scene.from_dict
        renderer = penumbra.Renderer(scene)
        render = renderer.render
        nan = float("nan")
        huge = np.broadcast_to(np.zeros(3), (1 << 36, 3))  # takes only 24 bytes of memory
        rows = [
            # scenes as dicts
            (usage, "/meshes/0/vertices: expected numbers.*texts", lambda: parse(with_mesh(vertices=[["0", "0", "0"]] * 3))),
            (usage, "/meshes/0/vertices.*complex", lambda: parse(with_mesh(vertices=TRIANGLE + 1j))),
            (usage, "/meshes/0/vertices.*objects", lambda: parse(with_mesh(vertices=TRIANGLE.astype(object)))),
            (usage, r"/meshes/0/vertices.*\(V, 3\).*\(1, 3, 3\)", lambda: parse(with_mesh(vertices=[TRIANGLE]))),
            (usage, r"/meshes/0/vertices.*\(V, 3\)", lambda: parse(with_mesh(vertices=[[0, 0, 0], [1, 0], [0, 1, 0]]))),
            (usage, "/meshes/0/vertices", lambda: parse(with_mesh(vertices=None))),
            (usage, "/meshes/0/vertices.*masked", lambda: parse(with_mesh(vertices=np.ma.masked_equal(TRIANGLE, 1)))),
            (usage, "/meshes/0/faces.*bools", lambda: parse(with_mesh(faces=FACE > 0))),
            (usage, "/meshes/0: expected both vertices and faces", lambda: parse({**small_scene(), "meshes": [{"vertices": TRIANGLE}]})),
            (wrong_input, "/meshes/0/faces: row 0 is .*-1", lambda: parse(with_mesh(faces=[[0, 1, -1]]))),
            (wrong_input, "/meshes/0.*vertex 1.*nan", lambda: parse(with_mesh(vertices=[[0, 0, 0], [nan, 0, 0], [0, 1, 0]]))),
            (wrong_input, "/meshes/0", lambda: parse({**small_scene(), "meshes": [3]})),
            (wrong_input, "/meshes", lambda: parse({**small_scene(), "meshes": "x"})),
            (usage, r"/meshes \{1, 2\}: expected a number, .*a list", lambda: parse({**small_scene(), "meshes": {1, 2}})),
            (wrong_input, "/camera/eye/1: nan", lambda: parse({**small_scene(), "camera": {"eye": [0, nan, 4], "target": [0, 0, 0]}})),
            (usage, "/camera/eye/0 1j", lambda: parse({**small_scene(), "camera": {"eye": [1j, 0, 4], "target": [0, 0, 0]}})),
            (wrong_input, "/camera/eye", lambda: parse({**small_scene(), "camera": {"eye": [[0], 0, 4], "target": [0, 0, 0]}})),
            (wrong_input, "/camera/verticalFov",
             lambda: parse({**small_scene(), "camera": {"eye": [0, 0, 4], "target": [0, 0, 0], "verticalFov": [45]}})),
            (usage, "/size.*contain itself", lambda: parse(contains_itself())),
            (usage, "the scene: the key 3: expected a name", lambda: parse({**small_scene(), 3: 4})),
            (usage, "/lights/0/name b'key'", lambda: parse({**small_scene(), "lights": [{"name": b"key"}]})),
            (usage, "surrogate", lambda: parse({**small_scene(), "lights": [{"name": "\ud800"}]})),
            (usage, r"from_dict\(3\): expected a dict", lambda: parse(3)),
            (usage, "folder 3", lambda: parse(small_scene(), 3)),
            (usage, r"Scene\(3\)", lambda: penumbra.Scene(3)),
            # meshes
            (usage, "name 3", lambda: scene.add_mesh(3, TRIANGLE, FACE)),
            (usage, "vertices.*complex", lambda: scene.add_mesh("m", TRIANGLE + 1j, FACE)),
            (usage, "vertices.*texts", lambda: scene.set_positions("floor", "abc")),
            (resource, "vertices.*GiB", lambda: scene.set_positions("floor", huge)),
            (resource, "faces.*GiB", lambda: scene.add_mesh("m", TRIANGLE, np.broadcast_to(FACE[0], (1 << 36, 3)))),
            (usage, "color", lambda: scene.add_mesh("m", TRIANGLE, FACE, color="red")),
            (usage, "casts_shadow 'no'", lambda: scene.add_mesh("m", TRIANGLE, FACE, casts_shadow="no")),
            (usage, "mesh -1: expected a mesh's name, or its number", lambda: scene.set_transform(-1, np.eye(4))),
            (usage, "mesh None", lambda: scene.set_transform(None, np.eye(4))),
            (usage, "2 meshes, and none 7", lambda: scene.set_transform(7, np.eye(4))),
            (usage, r"matrix.*\(4, 4\), not of shape \(3, 3\)", lambda: scene.set_transform("floor", np.eye(3))),
            (usage, r"matrix.*\(4, 4\), not of shape \(2, 8\)", lambda: scene.set_transform("floor", np.zeros((2, 8)))),
            (usage, "matrix.*texts", lambda: scene.add_instance("floor", "x")),
            (usage, "instance -1", lambda: scene.set_transform(penumbra.Instance("floor", -1), np.eye(4))),
            (wrong_input, "transform.*finite", lambda: scene.set_transform("floor", np.full((4, 4), np.nan))),
            # lights and cameras
            (usage, "radiance 3: expected three numbers", lambda: scene.set_light("key", radiance=3)),
            (usage, "two_sided", lambda: scene.set_light("key", two_sided="yes")),
            (usage, r"kind \['disk'\]", lambda: scene.set_light("key", kind=["disk"])),
            (usage, "name 3", lambda: scene.set_light(3)),
            (usage, "center", lambda: scene.set_light("key", center=(0, 1))),
            (usage, "radius", lambda: scene.add_light("ball", "sphere", center=(0, 1, 0), radius="1")),
            (usage, "needs radius", lambda: scene.add_light("ball", "sphere", center=(0, 1, 0))),
            (usage, "vertices", lambda: scene.add_light("flat", "polygon", vertices=[[0, 1], [2, 3]])),
            (usage, "image 3", lambda: scene.add_light("sky", "dome", image=3)),
            (usage, "half", lambda: scene.add_light("sky", "dome", half="north")),
            (usage, r"eye \(0, 1\): expected three numbers", lambda: scene.set_camera((0, 1), (0, 0, 0))),
            (usage, "target", lambda: scene.set_camera((0, 1, 2), "origin")),
            (usage, "vertical_fov '45'", lambda: scene.set_camera((0, 1, 2), (0, 0, 0), vertical_fov="45")),
            (usage, "name 3", lambda: scene.set_camera((0, 1, 2), (0, 0, 0), name=3)),
            (usage, "size", lambda: setattr(scene, "size", "x")),
            (usage, "file 3", lambda: scene.save(3)),
            # files
            (usage, "file 3", lambda: penumbra.load(3)),
            (usage, "file 'a.x00b'", lambda: penumbra.load("a\0b")),
            (usage, "frame nan", lambda: penumbra.load("a.gltf", frame=nan)),
            (usage, "clips 3.5", lambda: penumbra.load("a.gltf", clips=3.5)),
            (usage, "lenient", lambda: penumbra.load("a.gltf", lenient="no")),
            (wrong_input, r"no\\xffwhere.obj", lambda: penumbra.load(b"no\xffwhere.obj")),
            # pictures
            (usage, "scene 3: expected a Scene, a dict", lambda: penumbra.render(3)),
            (usage, "method 3: expected a method's name", lambda: render(method=3)),
            (usage, "camera 3", lambda: render(camera=3)),
            (usage, "light 3", lambda: render(light=3)),
            (usage, "light 3", lambda: render(light=["key", 3])),
            (usage, r"options \['a'\]: expected a dict", lambda: render(method="pcss", options=["a"])),
            (usage, r"options: size \[1\]", lambda: render(method="pcss", options={"size": [1]})),
            (usage, "size 'x'", lambda: render(size="x")),
            (usage, "size", lambda: render(size={8, 6})),
            (usage, "sample_pattern 3", lambda: render(sample_pattern=3)),
            (usage, "sample_seed -1", lambda: render(sample_seed=-1)),
            (usage, "pixel_tolerance", lambda: render(pixel_tolerance="fine")),
            (usage, "masks 2", lambda: render(masks=2)),
            (usage, "normals 3", lambda: render(normals=3)),
            (usage, "normals", lambda: render(normals=np.zeros(2))),
            (usage, "log 'x': expected a function", lambda: penumbra.Renderer(scene, log="x")),
            (usage, "progress 3", lambda: penumbra.render(scene, progress=3)),
            (usage, "device", lambda: penumbra.Renderer(scene, device=["cpu"])),
            # the rest
            (usage, "methods 3", lambda: penumbra.compare(scene, methods=3)),
            (usage, "methods None", lambda: penumbra.compare(scene, methods=["pcss", None])),
            (usage, "did you mean pcss", lambda: penumbra.compare(scene, methods="pcs")),
            (usage, "reference_samples", lambda: penumbra.compare(scene, reference_samples=0.5)),
            (usage, "error_budget", lambda: penumbra.compare(scene, error_budget="yes")),
            (usage, "out 3", lambda: penumbra.compare(scene, out=3)),
            (usage, "light 3: expected a light's name", lambda: penumbra.wedges(scene, light=3)),
            (usage, "validate", lambda: penumbra.wedges(scene, validate="x")),
            (usage, "from_ 3", lambda: penumbra.wedges(scene, from_=3)),
            (usage, "mesh .*shape.*expected a file's name, or vertices together with `faces`", lambda: penumbra.inspect(TRIANGLE)),
            (usage, "vertices.*texts", lambda: penumbra.inspect("mesh.obj", FACE)),
            (usage, "list_limit -1", lambda: penumbra.inspect(TRIANGLE, FACE, list_limit=-1)),
            (usage, "weld", lambda: penumbra.inspect(TRIANGLE, FACE, weld="1")),
            (usage, "function 3", lambda: penumbra.add_method("wrong", 3)),
            (usage, "options: n", lambda: penumbra.add_method("wrong", print, options={"n": 3})),
            (usage, "options: n", lambda: penumbra.add_method("wrong", print, options={"n": (1, None, 3)})),
            (usage, "options: n", lambda: penumbra.add_method("wrong", print, options={"n": []})),
        ]
        for error, says, call in rows:
            with self.subTest(says):
                with self.assertRaisesRegex(error, says) as raised:
                    call()
                self.assertNotIn("incompatible function arguments", str(raised.exception))
        self.assertEqual(renderer.render().size, (8, 6))  # the renderer can still be used

    def test_answers_of_own_methods_have_a_type(self):
        answer = {}
        penumbra.add_method("typed", lambda question: answer["of"](len(question.p)))
        penumbra.add_method("typed-masks", lambda question: answer["of"](len(question.p)), masks=True)
        for masks, value, says in ((False, lambda k: np.zeros(k, complex), "complex"), (False, lambda k: ["x"] * k, "texts"),
                                   (False, lambda k: None, "objects"), (False, lambda k: [[1], [1, 2]], "numpy"),
                                   (True, lambda k: np.full((k, 4), 0.5), "bools"), (False, lambda k: np.zeros((k, 1)), "shape")):
            answer["of"] = value
            with self.assertRaisesRegex(penumbra.UsageError, says):
                penumbra.render(self.scene, method="typed-masks" if masks else "typed", light_samples=4)
        answer["of"] = lambda k: np.ones((k, 4), np.uint8)
        self.assertEqual(penumbra.render(self.scene, method="typed-masks", light_samples=4).masks.shape, (6, 8, 4))

    def test_every_kind_of_array_is_the_same_mesh(self):
        vertices = np.array([[-3, 0, 3], [3, 0, 3], [3, 0, -3], [-3, 0, -3]])
        faces = np.array([[0, 1, 2], [0, 2, 3]])
        read_only = vertices.copy()
        read_only.flags.writeable = False
        padded = np.zeros((8, 6), np.float32)
        padded[::2, ::2] = vertices
        expected = penumbra.inspect(vertices.tolist(), faces.tolist())
        for kind in (np.float64, np.float32, np.float16, np.longdouble, np.int64, np.int8, ">f8", "<i2"):
            self.assertEqual(penumbra.inspect(vertices.astype(kind), faces), expected, kind)
        for given in (read_only, np.asfortranarray(vertices), padded[::2, ::2], vertices[::-1][::-1], tuple(map(tuple, vertices))):
            self.assertEqual(penumbra.inspect(given, faces), expected)
        for kind in (np.uint8, np.int32, np.uint64, np.float32, ">u4"):
            self.assertEqual(penumbra.inspect(vertices, np.asfortranarray(faces.astype(kind))), expected, kind)
        for empty in ([], np.zeros((0, 3))):
            with self.assertRaisesRegex(penumbra.InputError, "no triangles"):
                penumbra.inspect(vertices, empty)
        with self.assertRaisesRegex(penumbra.InputError, "18446744073709551615"):
            penumbra.inspect(vertices, np.array([[0, 1, 2 ** 64 - 1]], np.uint64))
        flat = copy.copy(self.scene)
        flat.set_transform("floor", list(np.diag([2.0, 1, 1, 1]).ravel()))  # sixteen numbers, row by row
        self.assertEqual(flat.triangle_count, 4)

    def test_numbers_of_any_library_are_numbers(self):
        scene = penumbra.Scene.from_dict({**small_scene(), "size": (np.int32(8), np.uint8(6))}, pathlib.Path("."))
        scene.set_light("key", center=np.array([0, 2, 0], np.float32), two_sided=np.bool_(True))
        self.assertEqual(scene.light("key")["center"], [0, 2, 0])
        scene.set_camera(np.array([0, 0.8, 4]), [0, 0, 0], vertical_fov=fractions.Fraction(91, 2), height=None, aperture=decimal.Decimal(0))
        self.assertEqual(penumbra.render(scene, method="pcf", options={"window": np.int64(3)}, light_samples=np.float64(64)).V.shape, (6, 8))
        self.assertEqual(penumbra.render(scene, size=np.array([4, 2]), light=("key",), camera=None, method=None).size, (4, 2))

    def test_lights_have_their_own_names(self):
        scene = copy.copy(self.scene)
        names = ["N", "P", "V", "Z", "id", "object", "R", "a.b", "a_b", "N_2"]
        for index, name in enumerate(names):
            scene.add_light(name, "sphere", center=(index, 3, 0), radius=0.1)
        lights = penumbra.render(scene).lights
        self.assertEqual(list(lights), ["key", *names])
        np.testing.assert_array_equal(lights["N"].V, penumbra.render(scene, light="N").V)

    def test_names_that_are_not_utf8_can_be_shown(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(os.fsencode(folder), b"\xe9.obj")
            with open(file, "wb") as stream:
                stream.write(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
            messages = []
            scene = penumbra.load(file)
            self.assertGreater(len(scene.warnings), 0)  # a warning about the added studio
            penumbra.inspect(file, log=lambda level, text: messages.append(text))
            penumbra.inspect(os.fsdecode(file))
            with open(file, "wb") as stream:
                stream.write(b"v 0 0 0\nf 1 2 3\n")
            with self.assertRaisesRegex(penumbra.InputError, "obj: line 2"):
                penumbra.load(file)

    def test_no_call_ends_in_an_error_of_another_kind(self):
        """Every parameter of every public function gets values for which it may not be meant."""
        odd = [None, True, 3, -1, 2.5, float("nan"), float("inf"), 10 ** 30, 1j, "", "x", "\ud800", "a\0b", b"x", [], [3], [None], ["x", 3],
               [[1, 2], [3]], (1, 2, 3), {}, {"x": 1}, {3: [object()]}, {1, 2}, object(), lambda *_: None, np.zeros(0), np.zeros((2, 2)),
               np.zeros(3, complex), np.array(["x"]), np.array([None]), np.float32(0.5), np.datetime64("2020-01-01"), penumbra.Instance("x", 3)]
        scene = copy.copy(self.scene)
        renderer = penumbra.Renderer(scene)
        pictures = dict(size=(4, 2), light_samples=4, method="pcf")
        with tempfile.TemporaryDirectory() as folder:
            calls = [
                (penumbra.Scene, {}), (penumbra.Scene.load, {"file": SOURCE / "scenes" / "room.json"}), (penumbra.Scene.from_dict, {"scene": small_scene()}),
                (penumbra.Scene.add_mesh, {"name": "m", "vertices": TRIANGLE, "faces": FACE}),
                (penumbra.Scene.add_instance, {"mesh": "board", "matrix": np.eye(4)}), (penumbra.Scene.instance_count, {"mesh": "board"}),
                (penumbra.Scene.set_positions, {"mesh": 0, "vertices": np.eye(4, 3)}),
                (penumbra.Scene.set_transform, {"mesh": 0, "matrix": np.eye(4)}),
                (penumbra.Scene.add_light, {"name": "l", "kind": "disk", "center": (0, 3, 0), "normal": (0, -1, 0), "radius": 1.0}),
                (penumbra.Scene.add_light, {"name": "l", "kind": "dome", "half": True, "rotate": 3, "up": (0, 1, 0), "sampled": True, "image": None}),
                (penumbra.Scene.set_light, {"name": "key", "center": (0, 3, 0), "radiance": (1, 1, 1), "two_sided": False, "kind": "rectangle"}),
                (penumbra.Scene.remove_light, {"name": "key"}), (penumbra.Scene.light, {"name": "key"}),
                (penumbra.Scene.set_camera, {"eye": (0, 1, 4), "target": (0, 0, 0)}), (penumbra.Scene.save, {"file": os.path.join(folder, "x.obj")}),
                (penumbra.Scene.size.fset, {"size": (8, 6)}), (penumbra.Renderer, {"scene": scene}), (penumbra.Renderer.render, pictures),
                (penumbra.render, {"scene": scene, **pictures}),
                (penumbra.compare, {"scene": scene, "methods": "pcf", "size": (4, 2), "light_samples": 4, "runs": 1, "reference_samples": 4}),
                (penumbra.inspect, {"mesh": TRIANGLE, "faces": FACE}), (penumbra.wedges, {"scene": scene}), (penumbra.load, {"file": "none.obj"}),
            ]
            here = os.getcwd()
            os.chdir(folder)  # "x" may be a folder for pictures
            self.addCleanup(os.chdir, here)
            tried = 0
            for function, given in calls:
                parameters = [p for p in inspect.signature(function).parameters.values() if p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD)]
                for key in ({p.name for p in parameters} | given.keys()) - {"self"}:
                    for value in odd:
                        arguments = {**given, key: value}
                        of = {} if "self" not in inspect.signature(function).parameters or inspect.isclass(function) else \
                            {"self": renderer if function is penumbra.Renderer.render else copy.copy(scene)}
                        tried += 1
                        try:
                            function(**of, **arguments)
                        except penumbra.Error as error:
                            self.assertNotIn("incompatible function arguments", str(error))
                            self.assertNotEqual(str(error), "")
                        except Exception as error:
                            self.fail(f"{function.__qualname__}({key}={value!r}) raised {type(error).__name__}: {error}")
            os.chdir(here)
        self.assertGreater(tried, 2000)
