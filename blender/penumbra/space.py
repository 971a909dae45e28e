"""Where surfaces are: how near to a lamp, and whether between two distances before the camera. Knows nothing of Blender."""

import numpy


class Placed:
    """An object's triangles in the world."""

    def __init__(self, name, positions, vertices, matrix):
        self.name, self.positions, self.vertices, self.matrix = name, positions, vertices, numpy.asarray(matrix, float)
        low, high = positions.min(axis=0), positions.max(axis=0)
        corners = numpy.array([[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)], float)
        self.box = self.moved(corners)

    def moved(self, points):
        return points @ self.matrix[:3, :3].T + self.matrix[:3, 3]

    def triangles(self):
        return self.moved(self.positions.astype(float))[self.vertices].reshape(-1, 3, 3)

    def distance_to(self, point, enough):
        """From a point to the nearest triangle; more than `enough` may be any number above."""
        low, high = self.box.min(axis=0), self.box.max(axis=0)
        outside = numpy.maximum(numpy.maximum(low - point, point - high), 0)
        least = float(numpy.linalg.norm(outside))
        return least if least > enough else float(distances(self.triangles(), numpy.asarray(point, float)).min())


def distances(triangles, point):
    """From a point to each triangle (n x 3 x 3)."""
    corners = triangles - point
    nearest = numpy.full(len(corners), numpy.inf)
    for i in range(3):
        a, way = corners[:, i], corners[:, (i + 1) % 3] - corners[:, i]
        squared = numpy.einsum("ij,ij->i", way, way)
        t = -numpy.einsum("ij,ij->i", a, way) / numpy.where(squared > 0, squared, 1)
        nearest = numpy.minimum(nearest, numpy.linalg.norm(a + numpy.clip(t, 0, 1)[:, None] * way, axis=1))
    normal = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    above = numpy.ones(len(corners), bool)  # is the foot of the perpendicular within the triangle?
    for i in range(3):
        a, b = corners[:, i], corners[:, (i + 1) % 3]
        above &= numpy.einsum("ij,ij->i", numpy.cross(a, b), normal) > 0
    length = numpy.linalg.norm(normal, axis=1)
    height = numpy.abs(numpy.einsum("ij,ij->i", corners[:, 0], normal)) / numpy.where(length > 0, length, 1)
    return numpy.where(above & (length > 0), height, nearest)


class Frustum:
    """What a camera sees. `matrix`: its place, along −Z; the lens as glb.camera takes it."""

    def __init__(self, matrix, aspect, shift, half_angle=None, height=None):
        self._to_camera = numpy.linalg.inv(numpy.asarray(matrix, float))
        # Planes (x, y, depth, 1) of which the inside is positive.
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
        """Is any part of it in the picture, at a depth between two?"""
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
            return True  # a corner is
        candidates = placed.triangles()[inside.any(axis=1).all(axis=1)]
        return any(_is_left(self._seen(triangle), planes) for triangle in candidates)

    def _seen(self, points):
        camera = points @ self._to_camera[:3, :3].T + self._to_camera[:3, 3]
        camera[:, 2] *= -1
        return numpy.hstack([camera, numpy.ones((len(camera), 1))])


def _is_left(polygon, planes):
    """Is anything left of a polygon, cut by planes one after the other?"""
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
