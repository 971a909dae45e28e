# SPDX-License-Identifier: Apache-2.0
"""Positions of surfaces: distances from lamps, and whether they are visible within a range of depths. Independent of
bpy."""

import numpy


class Placed:
    """An object's triangles in world space."""

    def __init__(self, name, positions, vertices, matrix):
        self.name, self.positions, self.vertices, self.matrix = name, positions, vertices, numpy.asarray(matrix, float)
        low, high = positions.min(axis=0), positions.max(axis=0)
        corners = numpy.array([[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)], float)
        self.box, self._bounds = self.moved(corners), None

    def moved(self, points):
        return points @ self.matrix[:3, :3].T + self.matrix[:3, 3]

    def triangles(self):
        return self.moved(self.positions.astype(float))[self.vertices].reshape(-1, 3, 3)

    def distance_to(self, point, enough):
        """Returns the distance from a point to the nearest triangle; infinite if it exceeds `enough`."""
        if self._bounds is None:
            triangles = self.triangles()
            self._bounds = triangles.astype(numpy.float32), triangles.min(axis=1), triangles.max(axis=1)
        triangles, low, high = self._bounds
        near = triangles[((high >= point - enough) & (low <= point + enough)).all(axis=1)]
        nearest = float(distances(near.astype(float), point).min()) if len(near) else numpy.inf
        return nearest if nearest <= enough else numpy.inf


class Surfaces:
    """A list of Placed objects that finds the one nearest to a point."""

    def __init__(self, placed):
        self._placed = placed
        self._low, self._high = (numpy.array([bound(one.box, axis=0) for one in placed]).reshape(-1, 3)
                                 for bound in (numpy.min, numpy.max))

    def nearest_to(self, point, enough):
        """Returns the nearest object and its distance; (None, `enough`) if all are farther."""
        point, found = numpy.asarray(point, float), None
        least = numpy.linalg.norm(numpy.maximum(numpy.maximum(self._low - point, point - self._high), 0), axis=1)
        for i in numpy.argsort(least, kind="stable"):
            if least[i] > enough:
                break
            distance = self._placed[i].distance_to(point, enough)
            if distance < enough:
                enough, found = distance, self._placed[i]
        return found, enough


def distances(triangles, point):
    """Returns the distances from a point to each triangle (n x 3 x 3)."""
    corners = triangles - point
    nearest = numpy.full(len(corners), numpy.inf)
    for i in range(3):
        a, edge = corners[:, i], corners[:, (i + 1) % 3] - corners[:, i]
        squared = numpy.einsum("ij,ij->i", edge, edge)
        t = -numpy.einsum("ij,ij->i", a, edge) / numpy.where(squared > 0, squared, 1)
        nearest = numpy.minimum(nearest, numpy.linalg.norm(a + numpy.clip(t, 0, 1)[:, None] * edge, axis=1))
    normal = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    above = numpy.ones(len(corners), bool)  # whether the foot of the perpendicular is within the triangle
    for i in range(3):
        a, b = corners[:, i], corners[:, (i + 1) % 3]
        above &= numpy.einsum("ij,ij->i", numpy.cross(a, b), normal) > 0
    length = numpy.linalg.norm(normal, axis=1)
    height = numpy.abs(numpy.einsum("ij,ij->i", corners[:, 0], normal)) / numpy.where(length > 0, length, 1)
    return numpy.where(above & (length > 0), height, nearest)


class Frustum:
    """A camera's view. `matrix`: its pose, looking along −Z; the lens as in glb.camera."""

    def __init__(self, matrix, aspect, shift, half_angle=None, height=None):
        self._to_camera = numpy.linalg.inv(numpy.asarray(matrix, float))
        # Planes (x, y, depth, 1) whose inner side is positive.
        half = half_angle if half_angle is not None else height / 2
        self._sides = []
        for axis, reach in ((0, half * aspect), (1, half)):
            middle = 2 * half * shift[axis]
            for sign in (1, -1):
                plane = numpy.zeros(4)
                plane[axis] = -sign
                plane[2 if half_angle is not None else 3] = sign * middle + reach
                self._sides.append(plane)

    def sees(self, placed, start, end):
        """Returns whether any part is in the picture, at a depth between the two given ones."""
        planes = [*self._sides, numpy.array([0, 0, 1, -start])]
        if numpy.isfinite(end):
            planes.append(numpy.array([0, 0, -1, end]))
        planes = numpy.stack(planes)
        box = self._seen(placed.box) @ planes.T
        if (box.max(axis=0) <= 0).any():
            return False
        inside = self._seen(placed.triangles().reshape(-1, 3)) @ planes.T > 0
        inside = inside.reshape(-1, 3, len(planes))
        if inside.all(axis=2).any():
            return True  # a corner is inside
        candidates = placed.triangles()[inside.any(axis=1).all(axis=1)]
        return any(_is_left(self._seen(triangle), planes) for triangle in candidates)

    def _seen(self, points):
        camera = points @ self._to_camera[:3, :3].T + self._to_camera[:3, 3]
        camera[:, 2] *= -1
        return numpy.hstack([camera, numpy.ones((len(camera), 1))])


def _is_left(polygon, planes):
    """Returns whether a polygon is not empty after it is cut by all planes."""
    corners = list(polygon)
    for plane in planes:
        heights = [float(corner @ plane) for corner in corners]
        kept = []
        for i, corner in enumerate(corners):
            other, here, there = corners[i - 1], heights[i], heights[i - 1]
            if (here > 0) != (there > 0):
                kept.append(other + (corner - other) * (there / (there - here)))
            if here > 0:
                kept.append(corner)
        corners = kept
        if not corners:
            return False
    return True
