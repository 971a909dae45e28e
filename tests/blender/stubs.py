# SPDX-License-Identifier: Apache-2.0
"""Stand-ins for Blender's objects for tests without Blender: values by name, sockets, nodes, images."""

import types

import numpy


def box(**values):
    return types.SimpleNamespace(**values)


class Socket:
    def __init__(self, value=None, name=None):
        self.default_value, self.links, self.name, self.identifier = value, [], name, name

    @property
    def is_linked(self):
        return bool(self.links)

    def link(self, node, name="Color"):
        """Links to the node's output of the given name."""
        output = next((one for one in node.outputs if one.name == name), None) or box(name=name, identifier=name)
        self.links = [box(from_node=node, from_socket=output)]


class Inputs(dict):
    """Inputs by name and by number, as in Blender."""

    def __getitem__(self, key):
        return list(self.values())[key] if isinstance(key, int) else super().__getitem__(key)

    def __iter__(self):
        return iter(self.values())

    def __contains__(self, key):
        return key in self.keys()


def node(kind, **inputs):
    names = {key: key.replace("_", " ") for key in inputs}
    sockets = Inputs({names[key]: Socket(value, names[key]) for key, value in inputs.items()})
    return box(type=kind, name=kind, inputs=sockets, outputs=[])


class Pixels:
    def __init__(self, values):
        self._values = values

    def foreach_get(self, into):
        into[:] = self._values


def image(texels, space="sRGB", is_float=False):
    """`texels`: height x width x 4, first row at the top."""
    texels = numpy.asarray(texels, numpy.float32)
    return box(size=(texels.shape[1], texels.shape[0]), pixels=Pixels(texels[::-1].ravel()), is_float=is_float,
               colorspace_settings=box(name=space))


def image_node(picture, interpolation="Closest", extension="REPEAT"):
    found = node("TEX_IMAGE", Vector=None)
    found.image, found.interpolation, found.extension, found.projection = picture, interpolation, extension, "FLAT"
    return found


