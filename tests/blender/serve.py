#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests `penumbra serve` with the add-on's own client, without Blender: the final picture is the same, byte for byte,
as that of `render` for the whole scene; refusals; how it ends.

    serve.py ADDON.zip PENUMBRA
"""

import json
import os
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest

ZIP, PENUMBRA = sys.argv[1:3]
sys.path.insert(0, ZIP)  # tests the code that users get
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import numpy  # noqa: E402

from penumbra import exr, glb, serving  # noqa: E402
from penumbra.viewpoint import Viewpoint  # noqa: E402
from things import Scene, at, seen_from  # noqa: E402


class Serve(unittest.TestCase):
    def setUp(self):
        self.child, self.scene, self.stamp = serving.Child(PENUMBRA), Scene(), 0
        self.folder = tempfile.TemporaryDirectory(prefix="penumbra-serve-")
        self.assertEqual(self.heard()["type"], "hello")

    def tearDown(self):
        self.child.kill()
        self.folder.cleanup()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def heard(self):
        return self.child.messages.get(timeout=60)

    def show(self, **message):
        self.stamp += 1
        self.child.send({"type": "show", "stamp": self.stamp, "visibility": True, **message})

    def final(self, stamps=None):
        """Returns the final picture of everything sent so far; `stamps` gets the stamps of the pictures before it."""
        end = time.monotonic() + 60
        while time.monotonic() < end:
            picture = self.child.take_picture()
            if picture is None:
                time.sleep(0.002)
                continue
            if stamps is not None:
                stamps.append(picture.head["stamp"])
            if picture.head["final"] and picture.head["stamp"] == self.stamp:
                return picture
        said = []
        while not self.child.messages.empty():
            said.append(self.child.messages.get())
        self.fail(f"no final picture came; said: {said}")

    def rendered(self, viewpoint, *arguments):
        self.scene.write(self.path("whole.glb"), viewpoint)
        subprocess.run([PENUMBRA, "render", self.path("whole.glb"), "-o", self.path("whole.exr"), "--no-studio", "--lenient", "-q",
                        "--size", "{}x{}".format(*viewpoint.size), *arguments], check=True)
        with open(self.path("whole.exr"), "rb") as file:
            return exr.read(file.read())

    def expect_whole(self, picture, viewpoint, *arguments):
        whole = self.rendered(viewpoint, *arguments).channels
        for number, letter in enumerate("RGBA"):
            self.assertEqual(picture.rgba[..., number].tobytes(), whole[letter].tobytes(), letter)
        self.assertGreater(len(picture.visibility), 0)
        for light, values in picture.visibility.items():
            self.assertEqual(values.tobytes(), whole[light.replace(".", "_") + ".V"].tobytes(), light)
        self.assertGreater(len(numpy.unique(picture.rgba)), 100)

    def begin(self, viewpoint):
        self.scene.put(self.child, *self.scene.things)
        self.order()
        self.show(camera=viewpoint.camera(), size=viewpoint.size)
        return self.final()

    def order(self):
        self.child.send({"type": "order", "things": list(self.scene.things)})

    def test_what_is_shown_is_what_render_makes(self):
        viewpoint = seen_from(0.3)
        self.expect_whole(self.begin(viewpoint), viewpoint)
        stamps = []
        for step in range(30):
            viewpoint = seen_from(0.3 + 0.02 * step)
            self.show(camera=viewpoint.camera(), moving=True)
            time.sleep(0.01)
        picture = self.final(stamps)
        self.assertEqual(stamps, sorted(stamps))
        self.expect_whole(picture, viewpoint)
        # A lamp moves: only the lamp is sent.
        self.scene.things["Key"] = self.scene.area(at(-1, -2, 3.5, 1.1, 0.7))
        self.scene.put(self.child, "Key")
        self.show()
        self.expect_whole(self.final(), viewpoint)
        # A mesh is edited, an emissive mesh moves, a lamp is removed.
        self.scene.things["Block"] = self.scene.block(at(0.5, 0.3, 1, 1, 0.9), 1.7)
        self.scene.put(self.child, "Block")
        self.show()
        self.expect_whole(self.final(), viewpoint)
        del self.scene.things["Bulb"]
        self.scene.things["Panel"] = self.scene.mesh("Panel", [(-1, 0, -1), (1, 0, -1), (1, 0, 1)], [(0, 1, 2)], at(1, 3, 2), 4.0)
        self.scene.put(self.child, "Panel")
        self.child.send({"type": "remove", "things": ["Bulb", "nothing"]})
        self.show(lightSamples=64)
        self.expect_whole(self.final(), viewpoint, "--light-samples", "64")
        # Another order of objects, other shadow settings of lights, and another kind of lens.
        self.scene.things = {name: self.scene.things[name] for name in ("Panel", "Fill", "Block", "Key", "Floor")}
        self.order()
        viewpoint = seen_from(-0.4, ortho=True)
        self.show(lightSamples=0, method="", camera=viewpoint.camera())
        picture = self.final()
        self.expect_whole(picture, viewpoint)
        self.assertEqual(picture.head["lightSamples"], 0)

    def test_a_world_with_a_picture(self):
        viewpoint = seen_from(0.3)
        self.scene.add_sky(self.folder.name, 0.4)
        self.expect_whole(self.begin(viewpoint), viewpoint)
        self.scene.add_sky(self.folder.name, 0.8)
        self.scene.put(self.child, "Sky")
        self.show()
        self.expect_whole(self.final(), viewpoint)
        self.scene.folder = os.path.join(self.folder.name, "none")
        self.scene.put(self.child, "Sky")
        while (said := self.heard())["type"] != "say" or said["level"] != "error":
            pass
        self.assertIn("none", said["text"])

    def error(self, refused):
        """Returns the text of the next error, which must refuse a message of this type."""
        while (said := self.heard())["type"] != "say" or said["level"] != "error":
            pass
        self.assertEqual(said["refused"], refused)
        return said["text"]

    def test_a_picture_is_read_from_the_folder_alone(self):
        """The picture must not be read from the folder where the program was started."""
        self.scene.add_sky(self.folder.name, 0.4)
        self.scene.folder = ""
        self.child.kill()
        before = os.getcwd()
        os.chdir(self.folder.name)
        try:
            child = self.child = serving.Child(PENUMBRA)
        finally:
            os.chdir(before)
        self.assertEqual(self.heard()["type"], "hello")
        self.scene.put(child, "Sky")
        self.assertIn("world.exr", self.error("put"))

    def test_pictures_stay_with_their_meshes(self):
        """The lamp comes first, from the same file as one of the meshes; then only the lamp is replaced."""
        self.scene.things = {"Key": self.scene.things["Key"], "Left": self.scene.tile("Left", at(-1.2, 0, 0), (255, 40, 80, 120)),
                             "Right": self.scene.tile("Right", at(1.2, 0, 0), (10, 200, 90, 160))}
        viewpoint = seen_from(0.2)
        self.begin(viewpoint)
        self.scene.things["Left"] = self.scene.tile("Left", at(-1.2, 0, 0), (0, 255, 0, 255))
        self.scene.put(self.child, "Left")
        self.show()
        self.expect_whole(self.final(), viewpoint)
        self.scene.things["Key"] = self.scene.area(at(-1, -2, 3.5, 1.1, 0.7))
        self.scene.put(self.child, "Key")
        self.show()
        self.expect_whole(self.final(), viewpoint)

    def test_a_thing_of_which_nothing_is_left(self):
        """Wholly transparent meshes are left out: at the start, and also if they were visible before. A message may name
        very many objects."""
        viewpoint = seen_from(0.3)
        shown, gone = self.scene.things["Block"], self.scene.block(at(0.2, 0, 1, 1, 0.4), alpha=0.0)
        self.scene.things["Block"] = gone
        self.begin(viewpoint)
        for block in (shown, gone):
            self.scene.things["Block"] = block
            self.scene.put(self.child, "Block")
            self.show()
            picture = self.final()
        self.expect_whole(picture, viewpoint)
        names = [f"Object/thing of a long name, number {number}" for number in range(40000)]
        self.child.send({"type": "put", "things": names}, glb.OfThings().encoded())
        self.child.send({"type": "order", "things": [*names, *self.scene.things]})
        self.child.send({"type": "remove", "things": names[1:]})
        self.show()
        self.assertEqual(self.final().rgba.tobytes(), picture.rgba.tobytes())
        self.assertTrue(all(said["type"] == "say" and said["level"] != "error" for said in self.all_said()))

    def all_said(self):
        while not self.child.messages.empty():
            yield self.child.messages.get()

    def test_equal_names_are_told_apart_as_in_one_file(self):
        viewpoint, key = seen_from(0.3), self.scene.things["Key"]

        def two(file):
            key(file)
            self.scene.area(at(-1, -1, 3))(file)
        self.scene.things["Lamps"] = two
        picture = self.begin(viewpoint)
        self.expect_whole(picture, viewpoint)
        self.assertIn("Key.3", picture.visibility)

    def test_large_views_get_smaller_pictures(self):
        whole = seen_from(0.3)
        viewpoint = Viewpoint(whole.matrix, numpy.eye(4).tolist(), (8193, 8))
        self.assertEqual(viewpoint.size, (2049, 2))
        self.begin(whole)
        self.show(camera=viewpoint.camera(), size=viewpoint.size, lightSamples=4)
        self.assertEqual(self.final().rgba.shape[:2], (2, 2049))

    def test_what_is_refused_changes_nothing(self):
        viewpoint = seen_from(0)
        before = self.begin(viewpoint)
        for message, data, words in (
                ({"type": "shutdown"}, b"", "shutdown"), ({"type": "order", "things": ["Moon"]}, b"", "Moon"),
                ({"type": "put"}, b"", "empty"), ({"type": "put"}, b"glTF is this not", "GLB"),
                ({"type": "put", "shadeless": 7}, b"x", "put"), ({"type": "show", "size": [9]}, b"", "show"),
                ({"type": "show", "size": [100000, 4]}, b"", "size"), ({"type": "show", "lightSamples": 99999}, b"", "99999"),
                ({"type": "show", "camera": {"eye": [0, 0, 0], "target": [0, 0, 0]}}, b"", "eye"),
                ({"type": "show", "method": "magic"}, b"", "magic"), ({"type": "render"}, b"", "arguments"),
                ({"type": "render", "arguments": ["--frames", "1-3"]}, b"", "")):
            self.child.send(message, data)
            said = self.heard()
            while said["type"] == "done":
                said = self.heard()
            self.assertEqual((said["type"], said["level"]), ("say", "error"), message)
            self.assertIn(words, said["text"])
        self.child.send({"type": "remove", "things": list(self.scene.things)})
        self.show()
        while "no light" not in (said := self.heard()).get("text", ""):
            self.assertEqual(said["type"], "done")
        self.scene.put(self.child, *self.scene.things)
        self.order()
        self.show()
        self.assertEqual(self.final().rgba.tobytes(), before.rgba.tobytes())

    def ends(self, data, code, seconds=20):
        """Expects that after this input the program ends with this code, and writes nothing more."""
        process = subprocess.Popen([PENUMBRA, "serve"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        out, error = process.communicate(data, seconds)
        self.assertEqual(process.returncode, code, error)
        return out, error.decode()

    def test_ends_with_its_input(self):
        self.ends(b"", 0)
        self.assertIn(b"ends within", self.ends(b"\5\0", 3)[0])
        self.assertIn(b"bytes", self.ends(struct.pack("<I", 1 << 30), 3)[0])
        for text in (b"{", b"[1]", b"{}", b'{"type": 3}', b"[" * 5000, b'{"type": "put", "bytes": -1}'):
            self.assertIn(b'"error"', self.ends(struct.pack("<I", len(text)) + text, 3)[0])
        self.assertIn("ends within", self.ends(serving.packed({"type": "put", "bytes": 1 << 30}), 3)[1])
        viewpoint = seen_from(0)
        self.scene.put(self.child, *self.scene.things)
        for _ in range(5):
            self.show(camera=viewpoint.camera(), size=(3000, 2000))  # nothing will read their pictures
        time.sleep(0.5)
        began = time.monotonic()
        self.child.close()
        self.assertEqual(self.child.process.returncode, 0)
        self.assertLess(time.monotonic() - began, 10)

    def test_ends_though_a_render_was_refused_and_nobody_reads(self):
        for head in ({"type": "render"}, {"type": "render", "arguments": [7]}):
            out = self.ends(serving.packed(head), 0)[0]
            self.assertIn(b'"refused":"render"', out)
            self.assertIn(b'"done"', out)
        with open(self.path("wrong"), "w+b") as messages:
            messages.write(serving.packed({"type": 2000 * "x"}) * 3000)
            messages.seek(0)
            process = subprocess.Popen([PENUMBRA, "serve"], stdin=messages, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
            try:
                self.assertEqual(process.wait(30), 0)
            finally:
                process.kill()
                process.stdout.close()

    def test_a_program_that_says_what_is_no_message(self):
        with open(self.path("program"), "w") as file:
            file.write("#!/bin/sh\nprintf '\\002\\000\\000\\000no'; exec sleep 60\n")
        os.chmod(self.path("program"), 0o755)
        threading.excepthook, before = (lambda _: None), threading.excepthook
        began = time.monotonic()
        try:
            code, printed = serving.run([self.path("program"), "render"], lambda: time.monotonic() > began + 20)
        finally:
            threading.excepthook = before
        self.assertNotIn(code, (0, None))
        self.assertEqual((printed, serving._kept), ("", {}))

    def test_ends_with_who_started_it(self):
        """The program ends with the process that started it, whatever ended that; also while a picture is written and
        nothing reads its output."""
        self.scene.write(self.path("long.glb"), seen_from(0))
        script = ("import sys, time; sys.path.insert(0, sys.argv[1]); from penumbra import serving; child = serving.Child(sys.argv[2]); "
                  "child.send({'type': 'render', 'arguments': sys.argv[3:]}); print(child.process.pid, flush=True); time.sleep(99)")
        parent = subprocess.Popen([sys.executable, "-c", script, ZIP, PENUMBRA, self.path("long.glb"), "-o", self.path("long.exr"),
                                   "--pixel-samples", "64", "--size", "2000x2000"], stdout=subprocess.PIPE, text=True)
        number = int(parent.stdout.readline())
        time.sleep(1)
        parent.send_signal(signal.SIGKILL)
        parent.wait()
        end = time.monotonic() + 20
        while os.path.exists(f"/proc/{number}/fd/0") and time.monotonic() < end:  # an ended process has none
            time.sleep(0.05)
        self.assertLess(time.monotonic(), end, "the child lives on")
        self.assertEqual([name for name in os.listdir(self.folder.name) if "exr" in name], [])

    def test_a_forest_is_not_copied(self):
        """As in `render`: the instances of a forest are not copied, also between pictures of scenes without
        instances."""
        places = [{"translate": [0.5 * (i % 20) - 5, 0.3, 0.5 * (i // 20) - 8]} for i in range(600)]
        tree = {"name": "tree", "shape": {"type": "sphere", "radius": 0.4, "segments": 32}}
        scene = {"format": "penumbra-scene/1", "size": [24, 16], "camera": {"eye": [0, 3, 6], "target": [0, 0, 0]},
                 "meshes": [{"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [9, 0, 0], "halfV": [0, 0, -9]}}],
                 "lights": [{"name": "day", "sun": {"direction": [0.4, -1, 0.3], "angle": 2}}, {"name": "sky", "dome": {"sampled": True}}]}
        try:
            for name, meshes in (("small", [tree]), ("forest", [{**tree, "instances": places}]), ("again", [tree])):
                with open(self.path("scene.json"), "w") as file:
                    json.dump({**scene, "meshes": scene["meshes"] + meshes}, file)
                command = [PENUMBRA, "render", self.path("scene.json"), "-o", self.path("kept.exr"), "--stats", self.path("stats.json")]
                code, printed = serving.run(command, lambda: False)
                self.assertEqual(code, 0, printed)
                with open(self.path("stats.json")) as file:
                    stats = json.load(file)
                self.assertEqual([light["quantity"] for light in stats["lights"]], ["area", "count"])
                self.assertEqual("trianglesOfLargestPart" in stats["counters"], name == "forest")
                subprocess.run([*command[:3], "-q", "-o", self.path("alone.exr")], check=True)
                with open(self.path("kept.exr"), "rb") as kept, open(self.path("alone.exr"), "rb") as alone:
                    self.assertEqual(kept.read(), alone.read(), name)
            self.assertEqual(len(serving._kept), 1)
        finally:
            serving.forget(now=True)

    def test_pictures_of_a_sequence_are_those_of_render(self):
        viewpoint = seen_from(0.1)
        try:
            for frame in range(3):
                self.scene.things["Block"] = self.scene.block(at(0.2 * frame, 0, 1, 1, 0.3 * frame))
                self.scene.write(self.path("frame.glb"), viewpoint)
                command = [PENUMBRA, "render", self.path("frame.glb"), "-o", self.path("kept.exr"), "--no-studio", "--size", "48x32"]
                code, printed = serving.run(command, lambda: False)
                self.assertEqual(code, 0, printed)
                self.assertIn("48x32", printed)
                subprocess.run([*command[:3], "-q", "-o", self.path("alone.exr"), *command[5:]], check=True)
                with open(self.path("kept.exr"), "rb") as kept, open(self.path("alone.exr"), "rb") as alone:
                    self.assertEqual(kept.read(), alone.read())
                numbers = {child.process.pid for child in serving._kept.values()}
                self.assertEqual(len(numbers), 1)
            code, printed = serving.run([PENUMBRA, "render", self.path("none.glb"), "-o", self.path("none.exr")], lambda: False)
            self.assertEqual(code, 3)
            self.assertIn("penumbra: error: ", printed)
            self.assertEqual({child.process.pid for child in serving._kept.values()}, numbers)
            long = [*command[:-1], "2000x2000", "--pixel-samples", "64"]
            self.assertEqual(serving.run(long, lambda: True), (None, ""))
            self.assertEqual(serving._kept, {})
        finally:
            serving.forget(now=True)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
