# SPDX-License-Identifier: Apache-2.0
"""Turns a 3D view in Rendered shading until killed.py kills this Blender. Run inside Blender:

    WINDOW=1 run.sh turning.py ADDON.zip PENUMBRA WORK

Once pictures come, WORK/out/processes.json lists the processes, and the view's folder.
"""

import json
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from mathutils import Quaternion  # noqa: E402

import inside  # noqa: E402
import scenes  # noqa: E402
from window import run, shown, until, view_3d  # noqa: E402

LONGEST = 600  # seconds; if it was not killed by then, it ends by itself


def turn():
    inside.fresh(scenes.many_lamps)
    yield 0.2
    area, _, space = view_3d()
    space.shading.type = "RENDERED"
    yield from until(lambda: shown() is not None and shown().picture is not None, "no picture came")
    path = os.path.join(inside.OUT, "processes.json")
    with open(path + ".part", "w") as file:
        json.dump({"blender": os.getpid(), "child": shown().child.process.pid, "folder": shown()._workspace.folder}, file)
    os.rename(path + ".part", path)
    end = time.monotonic() + LONGEST
    while time.monotonic() < end:
        space.region_3d.view_rotation = Quaternion((0, 0, 1), 0.03) @ space.region_3d.view_rotation
        area.tag_redraw()
        yield 0.03


run(turn())
