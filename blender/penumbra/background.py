"""Blender without a window (`blender -b`): a frame that failed makes the process fail."""

import atexit
import os
import shutil
import sys

import bpy

_failed = None  # the first frame that failed


def asked_for_frames(arguments):
    """Does Blender's command line say which frames to render? Else a script does, and is told by an exception."""
    own = arguments[:arguments.index("--")] if "--" in arguments else arguments
    return any(one in own for one in ("-f", "--render-frame", "-a", "--render-anim"))


def failed_before():
    """The frame that failed, of the frames that the command line asked for. Blender renders those after it, but saves none."""
    return _failed


def note_failure(frame):
    """Blender itself ends with 1 only if the last of the frames failed."""
    global _failed
    if _failed is not None or not bpy.app.background or not asked_for_frames(sys.argv):
        return
    _failed = frame
    atexit.register(_end, bpy.app.tempdir)


def _end(temporary):
    """The last that Python does before Blender would leave."""
    print(f"Penumbra: frame {_failed} failed (above); no frame after it was rendered, and this process ends with code 1",
          file=sys.stderr)
    shutil.rmtree(temporary, ignore_errors=True)  # Blender's own folder, which it would remove
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(1)
