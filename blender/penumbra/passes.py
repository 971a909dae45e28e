# SPDX-License-Identifier: Apache-2.0
"""Assigns a picture's channels to Blender's passes. Independent of bpy; Blender's Z is up."""

import hashlib
import json

import numpy

_CHANNELS = {  # Blender's passes, and the picture's channels for them; "-": negated
    "Combined.R": "R", "Combined.G": "G", "Combined.B": "B", "Combined.A": "A", "Depth.Z": "Z",
    "Position.X": "P.X", "Position.Y": "-P.Z", "Position.Z": "P.Y",
    "Normal.X": "N.X", "Normal.Y": "-N.Z", "Normal.Z": "N.Y",
}


def layers(picture):
    """Returns the picture's layers of lights, in the order of the lights."""
    return [light["layer"] for light in json.loads(picture.attributes.get("penumbra.lights", "[]"))]


_LONGEST_LAYER = 44  # bytes of UTF-8, as truncated by the program


def layer_of(name):
    """Returns the layer name that the program gives a light, unless an earlier light already has this name."""
    plain = "".join("_" if letter in "./" or ord(letter) < 0x20 or ord(letter) == 0x7F else letter for letter in name)
    return plain.encode()[:_LONGEST_LAYER].decode("utf-8", "ignore")


def matte_groups(name, view_samples):
    """Returns the names of a matte's passes. With one view sample a pixel, at one moment, there is one object per
    pixel; with several, up to six."""
    return [f"{name}{group:02}" for group in range(1 if int(view_samples) == 1 else 3)]


# Number of bytes of a whole name, layer and channel included ("ViewLayer.Light Key.R"), kept by Blender.
_LONGEST = 63


def put_before(picture, world):
    """Puts a colour behind the picture, for a film that is not transparent."""
    missing = 1 - picture.channels["A"]
    for letter, value in zip("RGB", world):
        picture.channels[letter] = picture.channels[letter] + missing * numpy.float32(value)
    picture.channels["A"] = numpy.ones_like(missing)


class Names:
    """Names of passes within one view layer; `shortened`: names that Blender would otherwise have cut, as (full,
    short)."""

    def __init__(self, layer):
        self._room = max(_LONGEST - len(layer.encode()) - len("..X"), 16)
        self.shortened = []

    def _short(self, name):
        """Returns a shortened name that differs from every other: its end is a number computed from the whole name."""
        if len(name.encode()) <= self._room:
            return name
        tail = "~" + hashlib.sha256(name.encode()).hexdigest()[:6]
        short = name.encode()[:self._room - len(tail)].decode("utf-8", "ignore") + tail
        if (name, short) not in self.shortened:
            self.shortened.append((name, short))
        return short

    def own_passes(self, lights):
        """Returns the passes that are not Blender's own: name, letters of the channels, kind. `lights`: layers of the
        lights."""
        found = [("V", "X", "VALUE")]
        for light in lights:
            found += [(self._short(f"V {light}"), "X", "VALUE"), (self._short(f"Light {light}"), "RGB", "COLOR")]
        return found

    def channels(self, picture):
        """Returns all of the picture's values, by pass and channel."""
        names = dict(_CHANNELS)
        names["V.X"] = "V"
        for layer in layers(picture):
            if f"{layer}.V" not in picture.channels:
                continue  # passes for each light were not requested
            names[self._short(f"V {layer}") + ".X"] = f"{layer}.V"
            for letter in "RGB":
                names[f"{self._short(f'Light {layer}')}.{letter}"] = f"{layer}.{letter}"
        for name in picture.channels:
            if name.startswith("Crypto"):
                names[name] = name
        found = {}
        for name, own in names.items():
            values = picture.channels[own.lstrip("-")]
            found[name] = -values if own.startswith("-") else values
        return found
