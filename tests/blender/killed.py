#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that if Blender is killed while a 3D view makes pictures, the view's child process ends and its folder is
deleted.

    killed.py ADDON.zip PENUMBRA WORK
"""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
import unittest

ZIP, PENUMBRA, WORK = sys.argv[1:4]
RUN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "run.sh")
SECONDS = 10  # a wait for ends that take milliseconds on an idle machine


def lives(number):
    """Returns whether a process runs; a process that has ended but was not yet waited for does not."""
    try:
        with open(f"/proc/{number}/stat") as file:
            return file.read().rpartition(")")[2].split()[0] not in "ZX"
    except (FileNotFoundError, ProcessLookupError):
        return False


def eventually(condition, seconds):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.05)
    return True


class KilledBlender(unittest.TestCase):
    def killed_by(self, number):
        """Kills a Blender whose view turns; no process or folder of the view may remain."""
        work = os.path.join(WORK, str(int(number)))
        said = os.path.join(work, "out", "processes.json")
        shutil.rmtree(work, ignore_errors=True)  # removes the output of an earlier run
        os.makedirs(WORK, exist_ok=True)
        runs = subprocess.Popen([RUN, "turning.py", ZIP, PENUMBRA, work], env={**os.environ, "WINDOW": "1"}, stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL, start_new_session=True)
        processes = {}
        try:
            self.assertTrue(eventually(lambda: os.path.exists(said) or runs.poll() is not None, 180))
            self.assertIsNone(runs.poll(), "Blender ended by itself")
            with open(said) as file:
                processes = json.load(file)
            time.sleep(1)
            self.assertTrue(lives(processes["child"]))
            self.assertTrue(os.path.isdir(processes["folder"]))
            os.kill(processes["blender"], number)
            self.assertTrue(eventually(lambda: not lives(processes["child"]), SECONDS), "the child outlives Blender")
            self.assertTrue(eventually(lambda: not os.path.exists(processes["folder"]), SECONDS), "the folder is left")
            self.assertNotEqual(runs.wait(60), 0)
        finally:
            for process in [processes.get("child"), processes.get("blender")]:
                if process is not None and lives(process):
                    os.kill(process, signal.SIGKILL)
            if runs.poll() is None:
                os.killpg(runs.pid, signal.SIGTERM)
                runs.wait(60)

    def test_by_sigkill(self):
        self.killed_by(signal.SIGKILL)

    def test_by_sigterm(self):
        self.killed_by(signal.SIGTERM)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
