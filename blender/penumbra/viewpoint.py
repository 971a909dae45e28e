# SPDX-License-Identifier: Apache-2.0
"""Camera of a 3D view. Independent of bpy; Blender's Z is up."""

from math import atan, degrees, sqrt


def _turned(x, y, z):
    """Converts from Z up to Y up, as the exchange file's first node does."""
    return (x, z, -y)


def _unit(vector):
    """Normalizes with the same order of operations as the program's reader, so that all digits are the same."""
    x, y, z = vector
    scale = 1.0 / sqrt(x * x + y * y + z * z)
    return (x * scale, y * scale, z * scale)


_LARGEST = 4096  # pixels a side of a picture that is shown (docs/serve.md)


def _fitting(size):
    """Returns the size, halved until `serve` accepts it; the picture is enlarged when it is drawn."""
    while max(size) > _LARGEST:
        size = tuple((side + 1) // 2 for side in size)
    return tuple(size)


class Viewpoint:
    """Viewpoint of a 3D view. `matrix`: rows, from view to world, without scale; `projection`: rows, as in OpenGL;
    `size`: the view's size in pixels. The member `size` is the picture's, which is smaller for very large views."""

    def __init__(self, matrix, projection, size):
        self.matrix, self.size = [[float(x) for x in row] for row in matrix], _fitting(size)
        size = self.size
        self.aspect = size[0] / size[1]
        rows = [[float(x) for x in row] for row in projection]
        self.half_angle = self.height = None
        if rows[3][3] == 0:  # perspective
            self.half_angle = 1 / rows[1][1]
            middle = rows[0][2], rows[1][2]
        else:
            self.height = 2 / rows[1][1]
            middle = -rows[0][3], -rows[1][3]
        self.shift = (middle[0] / 2 * self.aspect, middle[1] / 2)

    def key(self):
        return self.matrix, self.half_angle, self.height, self.shift, self.size

    def camera(self):
        """Returns the camera for the message `show`."""
        column = [tuple(self.matrix[row][i] for row in range(3)) for i in range(4)]
        eye = _turned(*column[3])
        forward = _unit(_turned(*(-x for x in column[2])))
        camera = {"eye": eye, "target": [a + b for a, b in zip(eye, forward)], "up": _unit(_turned(*column[1])),
                  "shift": self.shift}
        if self.height is None:
            camera["verticalFov"] = degrees(2 * atan(self.half_angle))
        else:
            camera["orthographicHeight"] = self.height
        return camera

    def write(self, glb):
        """Writes the same view as a camera of an exchange file."""
        glb.camera("View", self.matrix, self.aspect, self.shift, half_angle=self.half_angle, height=self.height)
