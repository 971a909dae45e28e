# SPDX-License-Identifier: Apache-2.0
"""Compares the Python module with the program and with itself: module.py PENUMBRA SOURCE."""

import copy
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock

import numpy as np

import penumbra

from arguments import Arguments  # noqa: F401: its tests run here

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
ROOM = SOURCE / "scenes" / "room.json"
LIGHTS = SOURCE / "scenes" / "lights.json"


def program(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=True).stdout


def board_over_floor():
    """Returns a scene made by hand: a square light at height 2 over a floor, half of it hidden by a board."""
    return {
        "camera": {"eye": [0, 0.8, 4], "target": [0, 0, 0]},
        "meshes": [
            {"name": "floor", "vertices": np.array([[-3, 0, 3], [3, 0, 3], [3, 0, -3], [-3, 0, -3]]),
             "faces": np.array([[0, 1, 2], [0, 2, 3]]), "color": [0.5, 0.5, 0.5]},
            {"name": "board", "vertices": [[0, 1, -3.0], [3, 1, -3], [3, 1, 3], [0, 1, 3]], "faces": [[0, 1, 2], [0, 2, 3]]},
        ],
        "lights": [{"name": "key", "rectangle": {"center": [0, 2, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}}],
    }


def camp(instances):
    """Returns tents on the floor, to be placed by add_instance or, with `instances`, placed as in a file, with
    arrays."""
    room = board_over_floor()
    tent = np.array([[-0.3, 0, -0.2], [0.3, 0, -0.3], [0, 0, 0.3], [0, 0.5, 0]])
    faces = np.array([[0, 1, 3], [1, 2, 3], [2, 0, 3]])
    if instances is None:
        scene = penumbra.Scene.from_dict(room)
        return scene, scene.add_mesh("tent", tent, faces)
    room["meshes"].append({"name": "tent", "vertices": tent, "faces": faces, "instances": [list(m.ravel()) for m in instances]})
    return penumbra.Scene.from_dict(room), 2


def crossed_segments(question):
    """Returns which segments from p to the light's points meet no triangle, in double: (K, N)."""
    ends = question.points_of_pixel if question.points_of_pixel is not None else question.light["points"][None]
    p = question.p[:, None].astype(float)
    segment = ends - p if question.light["kind"] != "sun" else np.broadcast_to(ends, (len(p), *ends.shape[1:])).astype(float)
    free = (segment * question.n[:, None]).sum(-1) > 0
    if question.light["kind"] != "sun" and question.light["kind"] != "sphere":
        free &= (segment * np.cross(question.light["u"], question.light["v"])).sum(-1) < 0
    for face in question.faces[question.casts]:
        a, b, c = question.vertices[face].astype(float)
        normal = np.cross(b - a, c - a)
        along = segment @ normal
        with np.errstate(divide="ignore", invalid="ignore"):
            t = ((a - p) @ normal) / along
            hit = p + t[..., None] * segment
            inside = np.ones(t.shape, bool)
            for start, end in ((a, b), (b, c), (c, a)):
                inside &= np.cross(end - start, hit - start) @ normal >= 0
            free &= ~(inside & (t > 1e-6) & ((t < 1) | (question.light["kind"] == "sun")))
    return free


class Instances(unittest.TestCase):
    """Meshes with many instances."""

    def test_instances_are_those_of_a_file_and_move(self):
        places = []
        for i in range(6):
            place = np.diag([1.0 if i % 2 else -1.0, 1 + 0.1 * i, 0.9, 1])
            place[:3, 3] = [0.8 * (i % 3) - 1, 0.01, 0.7 * (i // 3) - 0.5]
            places.append(place)
        scene, mesh = camp(None)
        added = [scene.add_instance("tent", place) for place in places]
        self.assertEqual(added[4], penumbra.Instance(mesh, 4))
        self.assertEqual((scene.instance_count(mesh), scene.triangle_count), (6, 4 + 18))
        read, _ = camp(places)
        self.assertEqual(read.instance_count("tent"), 6)
        renderer = penumbra.Renderer(scene)
        first = renderer.render((30, 50), instances="shared")
        for other in (penumbra.render(read, (30, 50), instances="shared"), renderer.render((30, 50), instances="copies")):
            for name in ("V", "P", "N", "Z", "id"):
                np.testing.assert_array_equal(getattr(first, name), getattr(other, name), name)
        renderer.set_transform(added[5], np.diag([1.0, 2, 1, 1]))
        moved = renderer.render((30, 50), instances="shared")
        self.assertFalse(np.array_equal(moved.V, first.V))
        self.assertEqual(moved.stats["counters"]["meshTreesBuilt"], 0)
        np.testing.assert_array_equal(moved.V, renderer.render((30, 50), instances="copies").V)
        read.set_transform(penumbra.Instance("tent", 5), np.diag([1.0, 2, 1, 1]))
        np.testing.assert_array_equal(moved.V, penumbra.render(read, (30, 50), instances="shared").V)
        with self.assertRaisesRegex(penumbra.UsageError, "has 6 instances, and none 6"):
            scene.set_transform(penumbra.Instance(mesh, 6), np.eye(4))


class OwnMethod(unittest.TestCase):
    """Methods implemented by Python functions."""

    def test_masks_of_a_function_are_those_of_exact_methods(self):
        penumbra.add_method("segments", crossed_segments, masks=True, family="geometry", exact_for="all but rounding")
        scene = board_over_floor()
        for light in ({"rectangle": {"center": [0, 2, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}},
                      {"sphere": {"center": [0, 2, 0], "radius": 0.4}}, {"sun": {"direction": [-0.2, -1, 0.1], "angle": 20}}):
            scene["lights"] = [{"name": "key", **light}]
            own = penumbra.render(scene, size=(24, 18), method="segments", light_samples=49)
            exact = penumbra.render(scene, size=(24, 18), method="edge-scatter", light_samples=49)
            self.assertEqual(own.masks.shape, (18, 24, 49))
            # Rows of light samples that end exactly on the board's edge depend on rounding: at most one row of seven.
            self.assertLess((own.masks != exact.masks).mean(), 0.002, light)
            self.assertGreater((exact.masks != exact.masks[0, 0]).mean(), 0.01)
            np.testing.assert_array_equal(own.V, own.masks.mean(-1, dtype=float).astype(np.float32))

    def test_is_compared_with_its_options(self):
        seen = []

        def even(question, share, rule):
            seen.append((share, rule))
            self.assertEqual(question.all_p.shape, (12, 16, 3))
            np.testing.assert_array_equal(question.all_p.reshape(-1, 3)[question.pixels], question.p)
            return np.full(len(question.p), share)

        penumbra.add_method("even", even, options={"share": (0.5, 0.0, 1.0), "rule": ["plain", "odd"]}, lights="rectangle")
        rows = penumbra.compare(board_over_floor(), ["even:share=0.25", "even:rule=odd"], reference="exact", size=(16, 12), runs=1)
        exact = penumbra.render(board_over_floor(), size=(16, 12))
        judged = [row["error"]["bias"] for row in rows]
        self.assertEqual(set(seen), {(0.25, "plain"), (0.5, "odd")})
        self.assertAlmostEqual(judged[1] - judged[0], 0.25, places=6)
        self.assertEqual(exact.V.shape, (12, 16))
        listed = {method["name"]: method for method in penumbra.methods()}["even"]
        self.assertEqual((listed["family"], listed["output"]), ("image", "scalar"))
        with self.assertRaisesRegex(penumbra.UsageError, "share"):
            penumbra.render(board_over_floor(), size=(8, 6), method="even", options={"share": 2})
        scene = board_over_floor()
        scene["lights"][0] = {"name": "key", "sphere": {"center": [0, 2, 0], "radius": 0.4}}
        with self.assertRaisesRegex(penumbra.InputError, "sphere"):
            penumbra.render(scene, size=(8, 6), method="even")

    def test_names_arguments_that_cannot_be(self):
        scene = board_over_floor()
        for what, call in (("size", lambda: penumbra.render(scene, size="ab")), ("size", lambda: penumbra.render(scene, size=(8, 2.5))),
                           ("light_samples", lambda: penumbra.render(scene, size=(8, 6), light_samples=-1)),
                           ("light_samples", lambda: penumbra.render(scene, size=(8, 6), light_samples="many")),
                           ("light_samples", lambda: penumbra.render(scene, size=(8, 6), light_samples=float("inf"))),
                           ("size", lambda: penumbra.render(scene, size=(2 ** 33, 8))),
                           ("faces", lambda: penumbra.Scene().add_mesh("x", np.eye(3), [[0, 1, np.inf]])),
                           ("pixel_samples", lambda: penumbra.render(scene, size=(8, 6), pixel_samples=1.5)),
                           ("methods", lambda: penumbra.compare(scene, [])),
                           ("faces", lambda: penumbra.Scene().add_mesh("x", np.eye(3), [[0, 1, 1.9]]))):
            with self.assertRaisesRegex(penumbra.UsageError, what):
                call()
        self.assertEqual(penumbra.Scene().add_mesh("x", np.eye(3), [[0.0, 1.0, 2.0]]), 0)

    def test_refuses_what_cannot_be(self):
        answer = {}
        penumbra.add_method("answers", lambda question: answer["of"](question))
        render = lambda: penumbra.render(board_over_floor(), size=(8, 6), method="answers")
        answer["of"] = lambda question: np.full(len(question.p), np.nan)
        with self.assertRaisesRegex(penumbra.ResourceError, "answers"):
            render()
        answer["of"] = lambda question: np.zeros(1)
        with self.assertRaisesRegex(penumbra.UsageError, "shape"):
            render()
        answer["of"] = lambda question: {}["missing"]
        with self.assertRaises(KeyError):
            render()
        answer["of"] = lambda question: np.zeros(len(question.p))
        self.assertEqual(render().V[render().A == 1].max(), 0)
        for name in ("answers", "edge-scatter", "image", "a:b", ""):
            with self.assertRaises(penumbra.UsageError, msg=name):
                penumbra.add_method(name, print)
        with self.assertRaisesRegex(penumbra.UsageError, "did you mean"):
            penumbra.add_method("other", print, lights=["rectangel"])
        with self.assertRaises(penumbra.UsageError):
            penumbra.add_method("other", print, options={"n": (0, 1, 4)})
        with self.assertRaises(penumbra.UsageError):
            penumbra.add_method("other", print, family="reference")


class Module(unittest.TestCase):
    def test_masks_are_the_programs_bits(self):
        with tempfile.TemporaryDirectory() as folder:
            program("--quiet", "render", ROOM, "-o", f"{folder}/a.exr", "--size", "24x16", "--method", "edge-scatter",
                    "--light-samples", 64, "--bits", f"{folder}/a.bits", "--light", "sky")
            data = pathlib.Path(folder, "a.bits").read_bytes()
        picture = penumbra.render(penumbra.load(ROOM), size=(24, 16), method="edge-scatter", light_samples=64, light="sky")
        start = data.index(b"\n") + 1 + 3 * 8 + 64 * 12
        rows = np.frombuffer(data[start:], np.uint8).reshape(16, 24, 16 + 8)
        bits = np.unpackbits(rows[..., 16:], axis=-1, bitorder="little").astype(bool)
        self.assertEqual(picture.masks.shape, (16, 24, 64))
        self.assertEqual(picture.masks.dtype, bool)
        np.testing.assert_array_equal(picture.masks, bits)
        np.testing.assert_array_equal(np.ascontiguousarray(rows[..., :12]).view("<f4").reshape(16, 24, 3), picture.Prel)
        seen = picture.masks.mean(axis=-1)[picture.A == 1]
        np.testing.assert_allclose(picture.V[picture.A == 1], seen, atol=1e-7)  # a share of 64, rounded to float32

    def test_masks_without_room_are_refused_first(self):
        scene = penumbra.load(ROOM)
        options = dict(size=(1024, 1024), method="edge-scatter", light_samples=4096)  # two lights: 1 GiB of masks
        soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
        data = int(pathlib.Path("/proc/self/statm").read_text().split()[5]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_DATA, (data + (640 << 20), hard))
        try:
            with self.assertRaisesRegex(penumbra.ResourceError, "each of 8192 light samples.* 1024x1024 .*about 1 GiB.* do without masks"):
                penumbra.render(scene, **options)
        finally:
            resource.setrlimit(resource.RLIMIT_DATA, (soft, hard))
        self.assertIsNone(penumbra.render(scene, **{**options, "size": (8, 8)}, masks=False).masks)

    def test_exact_half_shadow(self):
        # The plane x = 0 through p divides the light below the board's edge. V follows from the similar triangles in
        # the cross-section, because the board is as long as the scene. p at x sees the light up to x' = -x (the edge at
        # half height mirrors it).
        picture = penumbra.render(board_over_floor(), size=(64, 64))
        on_floor = (picture.id < 2) & (np.abs(picture.P[..., 0]) < 0.45) & (np.abs(picture.P[..., 2]) < 1)
        self.assertGreater(on_floor.sum(), 50)
        expected = 0.5 - picture.P[..., 0] / 1.0  # the light is from -0.5 to 0.5, and p sees it from -0.5 to -x
        np.testing.assert_allclose(picture.V[on_floor], expected[on_floor], atol=2e-6)  # x in float32, twice

    def test_arrays(self):
        picture = penumbra.render(ROOM, size=(20, 10))
        self.assertEqual([a.shape for a in (picture.V, picture.rgb, picture.P, picture.N, picture.Z, picture.id, picture.A)],
                         [(10, 20), (10, 20, 3), (10, 20, 3), (10, 20, 3), (10, 20), (10, 20), (10, 20)])
        self.assertIsNone(picture.masks)
        self.assertEqual(list(picture.lights), ["sun", "sky"])
        np.testing.assert_allclose(picture.rgb, sum(light.rgb for light in picture.lights.values()), rtol=1e-6)
        np.testing.assert_array_equal(picture.lights["sun"].V, picture.V)
        v = picture.V
        first = v[0, 0]
        del picture  # the array keeps its memory alive
        self.assertEqual(v[0, 0], first)
        with self.assertRaises(ValueError):
            v[0, 0] = 2  # read-only
        self.assertIsNot(v.base, None)  # a view, not a copy

    def test_kept_renderer(self):
        renderer = penumbra.Renderer(penumbra.load(LIGHTS))
        size = (24, 16)
        for name, changes in {"panel": {"center": (0.3, 2.5, 0)}, "ball": {"radius": 0.2}, "sun": {"angle": 3.0},
                              "disk": {"radiance": (1, 2, 3), "two_sided": True}}.items():
            renderer.set_light(name, **changes)
            light = renderer.scene.light(name)
            for key, value in changes.items():
                np.testing.assert_allclose(light[key], value)
            fresh = penumbra.render(renderer.scene, size=size)
            kept = renderer.render(size=size)
            np.testing.assert_array_equal(kept.rgb, fresh.rgb)
        renderer.set_light("panel", kind="sphere", center=(0, 3, 0), radius=0.25)
        self.assertEqual(renderer.scene.light("panel")["kind"], "sphere")

    def test_domes(self):
        renderer = penumbra.Renderer(penumbra.load(LIGHTS))
        renderer.scene.add_light("sky", "dome", half=True, radiance=(1, 1, 1))
        self.assertEqual(renderer.scene.light("sky")["half"], True)
        v = renderer.render(size=(24, 16), light="sky").V
        self.assertGreater(((v > 0) & (v < 1)).mean(), 0.1)
        renderer.set_light("sky", rotate=30)  # turning a dome of constant radiance changes nothing
        np.testing.assert_array_equal(renderer.render(size=(24, 16), light="sky").V, v)
        with self.assertRaisesRegex(penumbra.InputError, "none.hdr"):
            renderer.set_light("sky", image="none.hdr")
        self.assertEqual(renderer.scene.light("sky")["image"], "")
        self.assertEqual(renderer.scene.light("sky")["sampled"], False)
        renderer.set_light("sky", sampled=True)
        self.assertEqual(renderer.scene.light("sky")["sampled"], True)
        counted = renderer.render(size=(24, 16), light="sky").V
        np.testing.assert_array_equal(counted, renderer.render(size=(24, 16), light="sky", light_samples=256).V)
        self.assertTrue((counted != v).any())

    def test_arrays_are_placed_as_the_file_places_them(self):
        turn = {"translate": [0.1, 0.2, 0.3], "rotate": [10, 20, 37], "scale": [0.7, 0.3, 1.1]}
        rows = [0.1, 0, 0.7, 1.3, 0, -0.9, 0.2, 0.6, -0.3, 0, 0.1, 0.3, 0, 0, 0, 1]
        placings = [{"transform": turn}, {"transform": rows}, {"transform": {"scale": [-1.1, 1, 1]}}, {"fit": {"height": 0.7}},
                    {"instances": [rows, {"transform": turn}, {"translate": [0.7, 0, 0]}]}]
        vertices = np.array([[0, 0, 0], [9, 9, 9], [0.1, 0, 0.3], [0.7, 0.9, 0], [0.3, 1, 0.7]])  # no face uses the second one
        faces = np.array([[0, 2, 3], [0, 3, 4]])
        for placing in placings:
            scene = board_over_floor()
            scene["meshes"] = [{"name": "tilted", "vertices": vertices, "faces": faces, "emits": "key", **placing}]
            given = penumbra.Scene.from_dict(scene)
            scene["meshes"][0] = {"name": "tilted", "emits": "key", **placing,
                                  "triangles": [vertices[face].ravel().tolist() for face in faces]}
            scene["format"] = "penumbra-scene/1"
            with tempfile.TemporaryDirectory() as folder:
                file = pathlib.Path(folder, "scene.json")
                file.write_text(json.dumps(scene))
                penumbra.load(file).save(f"{folder}/file.json")
                given.save(f"{folder}/given.json")
                saved = [pathlib.Path(folder, name).read_bytes() for name in ("file.json", "given.json")]
            self.assertEqual(saved[0], saved[1], placing)
            self.assertIn("left out 1 vertices", " ".join(given.warnings))
            if "instances" in placing:  # these have the mesh's own vertices, including the unused one
                del scene["meshes"][0]["emits"]
                scene["meshes"][0].pop("triangles")
                given = penumbra.Scene.from_dict({**scene, "meshes": [{"vertices": vertices, "faces": faces, **placing}]})
                given.set_positions(0, vertices + 0.1)
                with self.assertRaisesRegex(penumbra.InputError, "it has 5"):
                    given.set_positions(0, np.concatenate([vertices, vertices]))
        with self.assertRaisesRegex(penumbra.InputError, "/meshes/0: triangle 0 has vertex 7"):
            penumbra.Scene.from_dict({**board_over_floor(), "meshes": [{"vertices": vertices, "faces": [[0, 1, 7]]}]})

    def test_errors(self):
        scene = penumbra.load(ROOM)
        for error in (penumbra.UsageError, penumbra.InputError, penumbra.ResourceError, penumbra.Cancelled):
            self.assertTrue(issubclass(error, penumbra.Error))
        with self.assertRaisesRegex(penumbra.UsageError, "edge-scater.*edge-scatter"):
            penumbra.render(scene, method="edge-scater")
        with self.assertRaisesRegex(penumbra.InputError, "nowhere.json"):
            penumbra.load("nowhere.json")
        with self.assertRaisesRegex(penumbra.UsageError, 'no "radius"'):
            scene.set_light("sky", radius=2)
        with self.assertRaises(penumbra.UsageError):
            scene.set_light("moon", radius=2)
        with self.assertRaises(penumbra.InputError):
            penumbra.Scene.from_dict({"meshes": [], "lights": []})
        with self.assertRaises(penumbra.InputError):
            scene.add_mesh("bad", [[0, 0, 0], [1, 0, 0], [0, 1, np.nan]], [[0, 1, 2]])
        for size in ((0, 0), (8, 0), (8.5, 8)):
            with self.assertRaisesRegex(penumbra.UsageError, "at least 1"):
                penumbra.render(scene, size=size)
        self.assertEqual(repr(penumbra.InputError), "<class 'penumbra.InputError'>")
        before = scene.light("sky")
        with self.assertRaises(penumbra.InputError):
            scene.set_light("sky", half_u=(0, 0, 0), radiance=(1, 1, 1))
        self.assertEqual(scene.light("sky"), before)
        with self.assertRaises(penumbra.ResourceError):
            penumbra.render(scene, device="no such device", method="pcf")

    def test_copies_are_independent(self):
        scene = penumbra.load(ROOM)
        other = copy.copy(scene)
        other.set_light("sky", radiance=(1, 2, 3))
        self.assertNotEqual(scene.light("sky")["radiance"], other.light("sky")["radiance"])

    def test_compare_inspect_wedges_methods(self):
        rows = penumbra.compare(ROOM, methods=["edge-scatter", "edge-scatter:rows=exact"], reference="exact", size=(24, 16),
                                light_samples=64, runs=1)
        self.assertEqual([row["method"] for row in rows], ["edge-scatter", "edge-scatter"])
        self.assertLess(rows[1]["error"]["rmse"], 1e-6)
        self.assertGreater(rows[0]["error"]["rmse"], rows[1]["error"]["rmse"])
        tetrahedron = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
        faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        report = penumbra.inspect(tetrahedron, faces)
        self.assertTrue(report["closed"])
        self.assertAlmostEqual(report["volume"], 1 / 6)
        self.assertFalse(penumbra.inspect(tetrahedron, faces[:3])["closed"])
        wedges = penumbra.wedges(ROOM, light="sky", validate=True)
        self.assertEqual(wedges["violations"], [])
        self.assertGreater(len(wedges["wedges"]), 0)
        listed = json.loads(program("methods", "--json"))["methods"]
        self.assertEqual(penumbra.methods()[:len(listed)], listed)  # methods that other tests added come after these

    def test_works_beside_other_threads(self):
        # The interpreter's lock is released while a picture is made: another thread can count.
        count, stop = [0], threading.Event()

        def counting():
            while not stop.is_set():
                count[0] += 1

        thread = threading.Thread(target=counting)
        thread.start()
        before = count[0]
        penumbra.render(ROOM, size=(96, 96), method="exact")
        after = count[0]
        stop.set()
        thread.join()
        self.assertGreater(after - before, 1000)

    def test_progress_and_interrupt(self):
        stages = []
        with self.assertRaises(penumbra.Cancelled):
            penumbra.render(ROOM, size=(64, 64), progress=lambda stage, done: stages.append(stage) or len(stages) < 3)
        self.assertEqual(len(stages), 3)
        with self.assertRaises(ZeroDivisionError):
            penumbra.render(ROOM, size=(64, 64), progress=lambda stage, done: 1 // 0)
        with self.assertRaises(ZeroDivisionError):
            penumbra.compare(ROOM, ["edge-scatter", "raytrace"], size=(24, 16), runs=1, progress=lambda stage, done: 1 // 0)
        with self.assertRaises(ZeroDivisionError):
            penumbra.inspect([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], progress=lambda stage, done: 1 // 0)
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.dict(os.environ):
            slow, mesh = pathlib.Path(folder, "slow"), pathlib.Path(folder, "mesh.obj")
            slow.write_text("#!/bin/sh\nexec sleep 100\n")
            slow.chmod(0o700)
            mesh.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
            os.environ["PENUMBRA_IMPORT_HELPER"] = str(slow)
            for call in (penumbra.load, penumbra.inspect):
                threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
                begin = time.monotonic()
                with self.assertRaises(KeyboardInterrupt):
                    call(mesh)
                self.assertLess(time.monotonic() - begin, 5)
        threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            for _ in range(1000):
                penumbra.render(ROOM, size=(256, 256))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
