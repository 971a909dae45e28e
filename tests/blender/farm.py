#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the add-on as render farms run it: `blender -b --addons penumbra FILE.blend … -f 1`, without saved preferences.
A frame that succeeds gives a file and exit code 0, one that fails gives no file and another code; a killed Blender
leaves no files.

    farm.py ADDON.zip PENUMBRA WORK
"""

import os
import shutil
import signal
import subprocess
import sys
import time
import unittest
import zipfile

ZIP, PENUMBRA, WORK = sys.argv[1:4]
HERE = os.path.dirname(os.path.abspath(__file__))

MAKE = """
import sys
import bpy
sys.path.insert(0, {here!r})
bpy.ops.wm.read_factory_settings(use_empty=True)
import scenes
scenes.stage()
scenes.lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)
scene = bpy.context.scene
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 32, 24, 100
scene.frame_start, scene.frame_end = 1, 3
block = bpy.data.objects["Block"]
for frame in range(1, 4):  # refused, for it casts shadows
    block.visible_camera = not (frame == 2 and {broken})
    block.keyframe_insert("visible_camera", frame=frame)
scene.render.engine = "PENUMBRA"
bpy.ops.wm.save_as_mainfile(filepath={path!r})
"""


def path(*names):
    return os.path.join(WORK, *names)


class Farm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        for name in ("scripts/addons", "config", "tmp", "runtime"):
            os.makedirs(path(name))
        with zipfile.ZipFile(ZIP) as archive:
            archive.extractall(path("scripts", "addons"))
        # Blender's audio client makes its folder there; without this variable, among the temporary files, which must be gone.
        os.chmod(path("runtime"), 0o700)
        cls.environment = {**os.environ, "BLENDER_USER_SCRIPTS": path("scripts"), "BLENDER_USER_CONFIG": path("config"),
                           "PENUMBRA": PENUMBRA, "TMPDIR": path("tmp"), "XDG_RUNTIME_DIR": path("runtime")}
        for name, broken in (("good", False), ("broken", True)):
            with open(path("make.py"), "w") as file:
                file.write(MAKE.format(here=HERE, broken=broken, path=path(f"{name}.blend")))
            cls.blender("--addons", "penumbra", "--python-exit-code", "1", "-P", path("make.py"), check=True)

    def setUp(self):
        shutil.rmtree(path("out"), ignore_errors=True)

    @classmethod
    def command(cls, *arguments):
        return ["blender", "-b", *arguments]

    @classmethod
    def blender(cls, *arguments, **how):
        return subprocess.run(cls.command(*arguments), env=cls.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, timeout=300, **how)

    def frames(self, scene, *arguments):
        """Renders frames; returns the run, and the files that it wrote."""
        run = self.blender("--addons", "penumbra", path(f"{scene}.blend"), "-o", path("out", "####"), "-F", "OPEN_EXR", *arguments)
        written = sorted(os.listdir(path("out"))) if os.path.isdir(path("out")) else []
        return run, [int(name[:4]) for name in written]

    def test_a_frame_without_saved_preferences(self):
        run, written = self.frames("good", "-f", "2")
        self.assertEqual((run.returncode, written), (0, [2]), run.stdout)
        self.assertEqual(os.listdir(path("tmp")), [])

    def test_a_frame_that_fails_is_a_process_that_fails(self):
        run, written = self.frames("broken", "-f", "2")
        self.assertEqual((run.returncode, written), (1, []), run.stdout)
        self.assertIn("Frame 2: 'Block' is hidden from the camera", run.stdout)
        self.assertEqual(os.listdir(path("tmp")), [])

    def test_frames_that_are_not_rendered_are_named(self):
        """If one of several frames on a command line fails, Blender saves none after it."""
        run, written = self.frames("broken", "-f", "1,2,3")
        self.assertEqual((run.returncode, written), (1, [1]), run.stdout)
        self.assertIn("Frame 3: not rendered, because frame 2 failed", run.stdout)
        self.assertIn("this process ends with code 1", run.stdout)

    def test_an_animation_fails_with_its_frame(self):
        run, written = self.frames("broken", "-a")
        self.assertEqual(run.returncode, 1, run.stdout)
        self.assertNotIn(2, written)
        run, written = self.frames("good", "-a")
        self.assertEqual((run.returncode, written), (0, [1, 2, 3]), run.stdout)

    def test_faults_of_the_add_on_are_errors_like_others(self):
        fault = "import penumbra.export as e; e.SceneWriter.write = lambda *_: {}['planted']"
        run, written = self.frames("good", "--python-expr", fault, "-f", "1")
        self.assertEqual((run.returncode, written), (1, []), run.stdout)
        self.assertIn("the add-on failed (KeyError: 'planted')", run.stdout)
        script = fault + "; import bpy; bpy.ops.render.render(write_still=True)"
        run, written = self.frames("good", "--python-exit-code", "7", "--python-expr", script)
        self.assertEqual((run.returncode, written), (7, []), run.stdout)

    def test_a_script_that_handles_an_error_decides_for_itself(self):
        script = ("import bpy\nscene = bpy.context.scene\nscene.frame_set(2)\n"
                  "try:\n  bpy.ops.render.render()\nexcept RuntimeError as error:\n  print('caught', error)\n"
                  "scene.frame_set(1)\nbpy.ops.render.render()")
        run, _ = self.frames("broken", "--python-expr", script)
        self.assertEqual(run.returncode, 0, run.stdout)
        self.assertIn("caught Error: Frame 2", run.stdout)

    def test_a_killed_blender_leaves_nothing(self):
        slow = path("slow")
        with open(slow, "w") as file:
            file.write(f"#!/bin/sh\necho $$ > {path('pid')}\nexec sleep 300\n")
        os.chmod(slow, 0o755)
        process = subprocess.Popen(self.command("--addons", "penumbra", path("good.blend"), "-f", "1"), start_new_session=True,
                                   env={**self.environment, "PENUMBRA": slow}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.assertTrue(eventually(lambda: content(path("pid"))))
        number = int(content(path("pid")))
        left = [name for name in os.listdir(path("tmp")) if name.startswith("penumbra-")]
        self.assertEqual(len(left), 1)
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        self.assertTrue(eventually(lambda: not any(name.startswith("penumbra-") for name in os.listdir(path("tmp")))))
        self.assertTrue(eventually(lambda: "State:\tZ" in content(f"/proc/{number}/status", "State:\tZ")))


def content(name, otherwise=""):
    if not os.path.exists(name):
        return otherwise
    with open(name) as file:
        return file.read()


def eventually(condition):
    until = time.time() + 60
    while time.time() < until:
        if condition():
            return True
        time.sleep(0.1)
    return False


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
