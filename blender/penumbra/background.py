# SPDX-License-Identifier: Apache-2.0
"""Blender without a window (`blender -b`): a frame that failed makes the process fail."""

import atexit
import os
import shutil
import sys

import bpy

_failed = None  # the first frame that failed


def asked_for_frames(arguments):
    """Returns whether Blender's command line lists the frames to render. If not, a script requests them and gets an
    exception."""
    own = arguments[:arguments.index("--")] if "--" in arguments else arguments
    return any(one in own for one in ("-f", "--render-frame", "-a", "--render-anim"))


def failed_before():
    """Returns the frame of the command line that failed, or None. Blender renders the frames after it, but saves none of them."""
    return _failed


def note_failure(frame):
    """Makes the process exit with 1 after a frame of the command line failed. Blender itself does so only for the last frame."""
    global _failed
    if _failed is not None or not bpy.app.background or not asked_for_frames(sys.argv):
        return
    _failed = frame
    atexit.register(_end, bpy.app.tempdir)


def _end(temporary):
    """Runs at exit, as the last Python code before Blender ends."""
    print(f"Penumbra: frame {_failed} failed (above); no frame after it was rendered, and this process ends with code 1",
          file=sys.stderr)
    shutil.rmtree(temporary, ignore_errors=True)  # Blender's own folder, which it would remove
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(1)
