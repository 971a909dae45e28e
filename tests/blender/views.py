#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests what the add-on's 3D view sends and reports, without Blender: refused objects are sent again; a picture of the
world is replaced while it is being read.

    views.py ADDON.zip PENUMBRA
"""

import os
import queue
import sys
import tempfile
import time
import unittest
from unittest import mock

ZIP, PENUMBRA = sys.argv[1:3]
sys.path.insert(0, ZIP)  # tests the code that users get
for name in ("bpy", "bpy.props", "gpu", "gpu_extras", "gpu_extras.presets"):
    sys.modules[name] = mock.MagicMock()

import numpy  # noqa: E402

from penumbra import exr, glb, losses, serving, sky, viewport  # noqa: E402
from penumbra.viewpoint import Viewpoint  # noqa: E402

WANTED = mock.MagicMock(exactness="EXACT", method="")


def viewpoint(x=0.0):
    """Returns an orthographic view from above."""
    return Viewpoint([[1, 0, 0, x], [0, 1, 0, 0], [0, 0, 1, 4], [0, 0, 0, 1]],
                     [[0.5, 0, 0, 0], [0, 0.5, 0, 0], [0, 0, -0.01, 0], [0, 0, 0, 1]], (40, 40))


def floor(file):
    rows = numpy.array([(-4, -4, 0), (4, -4, 0), (4, 4, 0), (-4, 4, 0)], "<f4")
    place = file.accessor(rows.tobytes(), "VEC3", bounds=(rows.min(axis=0), rows.max(axis=0)))
    indices = file.accessor(numpy.array((0, 1, 2, 0, 2, 3), "<u4").tobytes(), "SCALAR", glb.UNSIGNED)
    file.node("Floor", numpy.eye(4).tolist(), mesh=file.mesh("Floor", [
        {"attributes": {"POSITION": place}, "indices": indices, "material": file.material("Plain", (0.7, 0.6, 0.5))}]))


def lamp(file):
    file.lamp("Bulb", [[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 3], [0, 0, 0, 1]], "point", 20, (1, 1, 1), {"radius": 0.2})


class WithAProgram(unittest.TestCase):
    def setUp(self):
        self.view = viewport.View()
        self.view.child = serving.Child(PENUMBRA)

    def tearDown(self):
        self.view.child.kill()

    def put(self, name, add):
        file = glb.OfThings()
        file.thing = name
        add(file)
        self.view.child.send({"type": "put", "things": [name]}, file.encoded())

    def wait(self, condition):
        end = time.monotonic() + 30
        while not condition():
            self.assertLess(time.monotonic(), end, self.view.said)
            time.sleep(0.005)
            self.view.take_news()

    def test_a_lamp_that_comes_later(self):
        self.put("Object/Floor", floor)
        self.view.look(viewpoint(), WANTED)
        self.wait(lambda: "light" in self.view.said)
        self.put("Object/Lamp", lamp)
        self.view._show(WANTED, changed=True)
        self.wait(self.view.is_final)
        self.assertEqual(self.view.said, "")

    def test_a_method_that_is_put_right(self):
        self.put("Object/Floor", floor)
        self.put("Object/Lamp", lamp)
        self.view.look(viewpoint(), WANTED)
        self.view._show(mock.MagicMock(exactness="EXACT", method="magic"), changed=True)
        self.view.look(viewpoint(100.0), WANTED)
        self.wait(lambda: "magic" in self.view.said)
        self.view._show(WANTED, changed=False)
        self.wait(self.view.is_final)
        self.assertEqual(float(self.view.picture.rgba[20, 20, 3]), 0.0)  # this pixel is next to the floor

    def test_things_that_were_refused_are_sent_again(self):
        self.put("Object/Floor", floor)
        self.put("Object/Lamp", lamp)
        self.view._marks, self.view._sent = {"Object/Floor": [1], "Object/Lamp": [2]}, {"Object/Floor", "Object/Lamp"}
        self.view.child.send({"type": "put"}, b"glTF is this not")
        self.view.child.send({"type": "order", "things": ["Object/Moon"]})
        self.view.look(viewpoint(), WANTED)
        self.wait(self.view.is_final)
        self.assertIn("GLB", self.view.said)  # the cause, even after a picture of the earlier objects
        self.assertEqual((self.view._marks, self.view._order), ({}, []))
        self.assertEqual(self.view._sent, {"Object/Floor", "Object/Lamp"})  # so that they can be removed

    def test_the_last_error_is_why_the_program_has_ended(self):
        self.view.child.send({"type": "put", "bytes": -1})
        self.wait(lambda: self.view.child.process.poll() is not None and self.view.said)
        self.assertIn("bytes", self.view.said)


class WithoutAProgram(unittest.TestCase):
    def test_an_error_stays_until_a_picture_of_what_came_later(self):
        view = viewport.View()
        view.child = mock.MagicMock(messages=queue.SimpleQueue())

        def take(arrival, stamp, *heads):
            for head in heads:
                view.child.messages.put(head)
            view.child.take_picture.return_value = mock.MagicMock(head={"final": True, "stamp": stamp, "arrival": arrival})
            view.take_news()
            return view.said

        error = {"type": "say", "level": "error", "text": "no method magic", "refused": "show"}
        self.assertIn("magic", take(1, 1, {**error, "stamp": 2, "arrival": 0}))  # the picture is that of the earlier `show`
        self.assertIn("magic", take(2, 2))
        self.assertEqual(take(3, 3), "")
        unstamped = {"type": "say", "level": "error", "text": "there is no light", "arrival": 5}
        self.assertIn("light", take(4, 4, unstamped))  # the picture came before the error, and is taken together with it
        self.assertEqual(take(6, 4), "")

    def test_a_picture_of_the_world_is_replaced_whole(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(sky._save(numpy.zeros((4, 8, 3)), os.path.join(folder, sky.PICTURE)), "world.exr")
            with open(os.path.join(folder, "world.exr"), "rb", buffering=0) as read:
                begin = read.read(10)
                sky._save(numpy.ones((2, 4, 3)), os.path.join(folder, sky.PICTURE))
                earlier = exr.read(begin + read.read())
            self.assertEqual(earlier.channels["R"].shape, (4, 8))
            self.assertEqual(os.listdir(folder), ["world.exr"])

    def test_losses_of_several_things(self):
        one, other = losses.Losses(), losses.Losses()
        one.refuse("is hair", "Fur")
        other.refuse("is hair", "Beard")
        other.mention("is dark", "Bulb")
        self.assertEqual(losses.sentences(losses.together((one, other)).refused), ["'Fur', 'Beard' is hair"])
        self.assertEqual(losses.sentences(one.refused), ["'Fur' is hair"])

    def test_what_the_view_layer_changes_of_an_instance_is_compared(self):
        def mark(override=None, holdout=False, indirect=False):
            thing = mock.MagicMock(matrix_world=[], material_slots=[])
            thing.name_full, thing.material_slots = "Block", []
            thing.holdout_get.return_value, thing.indirect_only_get.return_value = holdout, indirect
            instance = mock.MagicMock(object=thing, is_instance=False, matrix_world=[])
            if override is not None:
                override = mock.MagicMock(name_full=override)
            return viewport._mark(instance, mock.MagicMock(material_override=override))
        marks = [mark(), mark("Clay"), mark("Chalk"), mark(holdout=True), mark(indirect=True)]
        self.assertEqual(len(set(marks)), len(marks))
        self.assertEqual(mark("Clay"), mark("Clay"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
