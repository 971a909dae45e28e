"""What of a picture goes into which of Blender's passes. Knows nothing of Blender, where Z is up."""

import hashlib
import json

import numpy

_CHANNELS = {  # Channels of passes known to Blender: the pictures' own names, and the conversion of their values
    "Combined.R": "R", "Combined.G": "G", "Combined.B": "B", "Combined.A": "A", "Depth.Z": "Z",
    "Position.X": "P.X", "Position.Y": "-P.Z", "Position.Z": "P.Y",
    "Normal.X": "N.X", "Normal.Y": "-N.Z", "Normal.Z": "N.Y",
}


def layers(picture):
    """The layers that the picture has of its lights, in their order."""
    return [light["layer"] for light in json.loads(picture.attributes.get("penumbra.lights", "[]"))]


_LONGEST_LAYER = 44  # bytes of UTF-8, as truncated by the program


def layer_of(name):
    """A light's layer; a second light of that name gets another."""
    plain = "".join("_" if letter in "./" or ord(letter) < 0x20 or ord(letter) == 0x7F else letter for letter in name)
    return plain.encode()[:_LONGEST_LAYER].decode("utf-8", "ignore")


def matte_groups(name, pixel_samples):
    """A matte's passes: of one view sample a pixel there is one that covers it, of more there may be six."""
    return [f"{name}{group:02}" for group in range(1 if int(pixel_samples) == 1 else 3)]


# Number of bytes of a whole name, layer and channel included ("ViewLayer.Light Key.R"), kept by Blender.
_LONGEST = 63


def put_before(picture, world):
    """A colour behind all that is there: what a film that is not transparent shows."""
    missing = 1 - picture.channels["A"]
    for letter, value in zip("RGB", world):
        picture.channels[letter] = picture.channels[letter] + missing * numpy.float32(value)
    picture.channels["A"] = numpy.ones_like(missing)


class Names:
    """Names of passes within one view layer; `shortened`: those that Blender would have cut, as (full, short)."""

    def __init__(self, layer):
        self._room = max(_LONGEST - len(layer.encode()) - len("..X"), 16)
        self.shortened = []

    def _short(self, name):
        """Unlike that of any other name: the end is a number made of the whole."""
        if len(name.encode()) <= self._room:
            return name
        tail = "~" + hashlib.sha256(name.encode()).hexdigest()[:6]
        short = name.encode()[:self._room - len(tail)].decode("utf-8", "ignore") + tail
        if (name, short) not in self.shortened:
            self.shortened.append((name, short))
        return short

    def own_passes(self, lights):
        """Passes that Blender has no name for: name, letters of the channels, kind. `lights`: their layers."""
        found = [("V", "X", "VALUE")]
        for light in lights:
            found += [(self._short(f"V {light}"), "X", "VALUE"), (self._short(f"Light {light}"), "RGB", "COLOR")]
        return found

    def channels(self, picture):
        """All that the picture has, by pass and channel."""
        names = dict(_CHANNELS)
        names["V.X"] = "V"
        for layer in layers(picture):
            if f"{layer}.V" not in picture.channels:
                continue  # passes of each light were not requested
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
