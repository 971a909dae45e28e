"""What of a picture goes into which of Blender's passes. Knows nothing of Blender, where Z is up."""

import json

_CHANNELS = {  # of passes that Blender knows: the pictures' own, and what turns them round
    "Combined.R": "R", "Combined.G": "G", "Combined.B": "B", "Combined.A": "A", "Depth.Z": "Z",
    "Position.X": "P.X", "Position.Y": "-P.Z", "Position.Z": "P.Y",
    "Normal.X": "N.X", "Normal.Y": "-N.Z", "Normal.Z": "N.Y",
}


def layers(picture):
    """The layers that the picture has of its lights, in their order."""
    return [light["layer"] for light in json.loads(picture.attributes.get("penumbra.lights", "[]"))]


def layer_of(name):
    """A light's layer; a second light of that name gets another."""
    return name.replace(".", "_").replace("/", "_")


def own_passes(lights):
    """Passes that Blender has no name for: name, letters of the channels, kind. `lights`: their layers."""
    passes = [("V", "X", "VALUE")]
    for light in lights:
        passes += [(_short(f"V {light}"), "X", "VALUE"), (_short(f"Light {light}"), "RGB", "COLOR")]
    return passes


def matte_groups(name, pixel_samples):
    """A matte's passes: of one view sample a pixel there is one that covers it, of more there may be six."""
    return [f"{name}{group:02}" for group in range(1 if int(pixel_samples) == 1 else 3)]


def _short(name):
    """Blender cuts longer ones."""
    return name.encode()[:63].decode("utf-8", "ignore")


def channels(picture):
    """All that the picture has, by pass and channel."""
    names = dict(_CHANNELS)
    names["V.X"] = "V"
    for layer in layers(picture):
        names[_short(f"V {layer}") + ".X"] = f"{layer}.V"
        for letter in "RGB":
            names[f"{_short(f'Light {layer}')}.{letter}"] = f"{layer}.{letter}"
    for name in picture.channels:
        if name.startswith("Crypto"):
            names[name] = name
    found = {}
    for name, own in names.items():
        values = picture.channels[own.lstrip("-")]
        found[name] = -values if own.startswith("-") else values
    return found
