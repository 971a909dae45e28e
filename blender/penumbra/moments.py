# SPDX-License-Identifier: Apache-2.0
"""Exchange files of a frame's moments, in addition to that of the frame's own time."""

import os

from .changes import Changes

_STILL = "still.bin"


class Moments:
    """Files of a frame's moments, one after the other. Meshes and pictures that have not changed since the frame's own time are
    in one further file that all share, so that each moment only costs what changes."""

    def __init__(self, whole, writer, region):
        """`whole`: the file of the frame's own time, written by `writer` (a SceneWriter); `region`: pixels to render (frames.py)."""
        self._whole, self._writer, self._region = whole, writer, region
        self._folder, self._changes = os.path.dirname(whole), Changes(by_time=True)
        self._files, self._last = [], None  # of all moments; bytes of the last file written

    def add(self, depsgraph, lost):
        """Adds the moment that Blender has just evaluated, and its losses to `lost`. Equal moments share a file."""
        before = self._files[-1] if self._files else self._whole
        self._files.append(before)
        if not self._changes.note(depsgraph):
            return
        number = len(self._files)
        writer = self._writer.at_moment(self._changes, lost, _STILL, f"world-{number}.exr")
        encoded = writer.encoded(self._folder, self._region)
        if not self._changes.all and writer.glb.placed() == self._writer.glb.placed():
            self._files[-1] = self._whole  # nothing visible has changed
        elif before == self._whole or encoded != self._last:
            self._files[-1], self._last = os.path.join(self._folder, f"moment-{number}.glb"), encoded
            with open(self._files[-1], "wb") as file:
                file.write(encoded)
            self._write_still()

    def _write_still(self):
        path = os.path.join(self._folder, _STILL)
        if not os.path.exists(path):
            with open(path, "wb") as file:
                file.write(self._writer.glb.binary())

    def files(self):
        """Returns the files of all moments; an empty list if all equal the frame's own time."""
        return self._files if any(file != self._whole for file in self._files) else []
