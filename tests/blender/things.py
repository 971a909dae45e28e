# SPDX-License-Identifier: Apache-2.0
"""A scene of objects that tests of `penumbra serve` send and write, seen as a 3D view sees it."""

import math
import os

import numpy

from penumbra import exr, glb, texels
from penumbra.viewpoint import Viewpoint

SIZE = (60, 44)


def at(x, y, z, scale=1.0, turn=0.0):
    c, s = scale * math.cos(turn), scale * math.sin(turn)
    return [[c, -s, 0, x], [s, c, 0, y], [0, 0, scale, z], [0, 0, 0, 1]]


def seen_from(angle, distance=7.0, height=4.0, ortho=False):
    """Returns a view of the origin with Z up, with matrices like those of a 3D view."""
    eye = numpy.array([distance * math.sin(angle), -distance * math.cos(angle), height])
    back = eye / numpy.linalg.norm(eye)
    right = numpy.cross([0, 0, 1], back)
    right /= numpy.linalg.norm(right)
    up = numpy.cross(back, right)
    matrix = numpy.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = right, up, back, eye
    aspect = SIZE[0] / SIZE[1]
    if ortho:
        projection = [[2 / (6 * aspect), 0, 0, 0.1], [0, 2 / 6, 0, -0.05], [0, 0, -0.01, 0], [0, 0, 0, 1]]
    else:
        projection = [[2 / aspect, 0, 0.1, 0], [0, 2, -0.2, 0], [0, 0, -1, -0.2], [0, 0, -1, 0]]
    rows = matrix.astype(numpy.float32)
    return Viewpoint(rows.tolist(), numpy.array(projection, numpy.float32).tolist(), SIZE)


class Scene:
    """The objects by name, in their order; each is a function that adds its object to an exchange file."""

    def __init__(self):
        self.things = {
            "Floor": self.mesh("Floor", [(-4, -4, 0), (4, -4, 0), (4, 4, 0), (-4, 4, 0)], [(0, 1, 2), (0, 2, 3)], at(0, 0, 0)),
            "Block": self.block(at(0.2, 0, 1, 1, 0.4)),
            "Key": self.area(at(1, -1, 4)),
            "Bulb": lambda file: file.lamp("Bulb", at(-2, 1, 3), "point", 20, (1, 0.5, 0.2), {"radius": 0.2}),
            "Fill": lambda file: file.lamp("Fill", at(0, 0, 9), "directional", 0.2, (1, 1, 1), {"angle": 4}, False),
            "Panel": self.quad("Panel", at(0, 3, 2), 3.0)}

    @staticmethod
    def mesh(name, corners, triangles, matrix, radiance=0.0, alpha=1.0, image=None):
        """`image`: the values of four pixels, as seen from above."""
        def add(file):
            rows = numpy.array(corners, "<f4")
            attributes = {"POSITION": file.accessor(rows.tobytes(), "VEC3", bounds=(rows.min(axis=0), rows.max(axis=0)))}
            indices = file.accessor(numpy.array(triangles, "<u4").tobytes(), "SCALAR", glb.UNSIGNED)
            texture = None
            if image is not None:
                attributes["TEXCOORD_0"] = file.accessor(numpy.ascontiguousarray(rows[:, :2]).tobytes(), "VEC2")
                grey = numpy.repeat(numpy.array(image, numpy.uint8).reshape(2, 2, 1), 3, axis=2)
                texture = file.texture(file.image(name, texels.png(grey), "image/png"))
            material = file.material("Plain", (0.7, 0.6, 0.5), (radiance,) * 3, alpha, texture=texture)
            file.node(name, matrix, mesh=file.mesh(name, [
                {"attributes": attributes, "indices": indices, "material": material}]))
        return add

    @classmethod
    def quad(cls, name, matrix, radiance=0.0):
        return cls.mesh(name, [(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1)], [(0, 1, 2), (0, 2, 3)], matrix, radiance)

    @classmethod
    def tile(cls, name, matrix, image):
        return cls.mesh(name, [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [(0, 1, 2), (0, 2, 3)], matrix, image=image)

    @classmethod
    def block(cls, matrix, top=1.0, alpha=1.0):
        corners = [(x, y, top * z) for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)]
        faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        return cls.mesh("Block", corners, [half for a, b, c, d in faces for half in ((a, b, c), (a, c, d))], matrix, alpha=alpha)

    @staticmethod
    def area(matrix):
        return lambda file: file.area_lamp("Key", matrix, "rectangle", (1.2, 0.8), (9, 8, 7))

    def put(self, child, *names):
        file = glb.OfThings()
        for name in names:
            file.thing = name
            self.things[name](file)
        folder = {"folder": self.folder} if "Sky" in names else {}
        child.send({"type": "put", "things": names, "shadeless": sorted(file.shadeless), **folder}, file.encoded())

    def add_sky(self, folder, bright):
        """Adds a world with a picture, half of which has the value `bright`."""
        self.folder = folder
        texels = numpy.full((8, 16), 0.1, numpy.float32)
        texels[:, :8] = bright
        with open(os.path.join(folder, "world.exr"), "wb") as out:
            out.write(exr.encoded({letter: texels for letter in "RGB"}))
        self.things["Sky"] = lambda file: file.dome("Sky", numpy.eye(4).tolist(), (1, 1, 1), "world.exr", True)

    def write(self, path, viewpoint):
        """Returns all objects in one file, as for F12 (render)."""
        file = glb.Glb()
        for add in self.things.values():
            add(file)
        viewpoint.write(file)
        with open(path, "wb") as out:
            out.write(file.encoded())
