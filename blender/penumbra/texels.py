# SPDX-License-Identifier: Apache-2.0
"""Texels of Blender's images: read, interpolated as Cycles does, and written as PNG. Uses only names and values of
images, not bpy."""

import struct
import zlib

import numpy

# FINE: largest side, in texels, to which an image is enlarged by interpolation, if its side is at most half of this.
# _MOST: largest factor by which an image's sides are enlarged.
FINE, _MOST = 1024, 16


def linear_of(encoded):
    """Converts sRGB to linear values."""
    return numpy.where(encoded <= 0.04045, encoded / 12.92, ((numpy.maximum(encoded, 0) + 0.055) / 1.055) ** 2.4)


def encoded_of(linear):
    """Converts linear values to sRGB."""
    linear = numpy.clip(linear, 0, 1)
    return numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def pixels(image):
    """Returns the image's values: height x width x 4, first row at the top, in the image's own colour space."""
    width, height = image.size
    if width == 0 or height == 0:
        raise OSError("it has no pixels: its file is missing or not readable")
    values = numpy.empty(width * height * 4, numpy.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, 4)[::-1]


def is_encoded(image):
    """Returns whether the image's texels are stored in sRGB. Floats and data are linear."""
    space = image.colorspace_settings.name
    return space == "sRGB" and not image.is_float


def knows_space(image):
    """Returns whether the image's colour space is sRGB or a linear one, which linear() can convert."""
    return image.colorspace_settings.name in ("sRGB", "Non-Color", "Raw", "Linear", "Linear Rec.709") or image.is_float


def linear(node):
    """Returns a node's image in linear values, with the values that Cycles interpolates between the stored texels."""
    values = pixels(node.image)[..., :3].astype(numpy.float64)
    if node.interpolation != "Closest":
        values = finer(values, node.interpolation, getattr(node, "extension", "REPEAT"))
    return linear_of(values) if is_encoded(node.image) else values


def _weights(kind, t):
    """Returns offsets and weights of the texels around `t`: four, the first at −1 (cubic
    B-splines), or two (linear). `t`: position between texel 0 and texel 1."""
    if kind == "Linear":
        return (0, 1), (1 - t, t)
    return (-1, 0, 1, 2), ((1 - t) ** 3 / 6, (3 * t ** 3 - 6 * t ** 2 + 4) / 6, (-3 * t ** 3 + 3 * t ** 2 + 3 * t + 1) / 6, t ** 3 / 6)


def finer(values, kind, wrap):
    """Returns an image with more texels, interpolated between the given ones."""
    times = min(FINE // max(values.shape[:2]), _MOST)
    if times < 2:
        return values
    for axis in (0, 1):
        count = values.shape[axis]
        at = (numpy.arange(count * times) + 0.5) / times - 0.5
        low = numpy.floor(at).astype(int)
        steps, weights = _weights(kind, at - low)
        total = 0
        for step, weight in zip(steps, weights):
            index = numpy.clip(low + step, 0, count - 1) if wrap == "EXTEND" else (low + step) % count
            total = total + numpy.take(values, index, axis) * (weight[:, None, None] if axis == 0 else weight[None, :, None])
        values = total
    return values


def png(bytes_by_pixel):
    """Returns the bytes of a PNG. `bytes_by_pixel`: height x width x 3 or 4."""
    height, width, channels = bytes_by_pixel.shape
    rows = numpy.zeros((height, 1 + width * channels), numpy.uint8)
    rows[:, 1:] = bytes_by_pixel.reshape(height, -1)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    head = struct.pack(">IIBBBBB", width, height, 8, 2 if channels == 3 else 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 1)) + chunk(b"IEND", b"")


def bytes_of(values):
    return numpy.floor(numpy.clip(values, 0, 1) * 255 + 0.5).astype(numpy.uint8)


def hsv_of(color):
    most, least = color.max(axis=-1), color.min(axis=-1)
    delta = most - least
    safe = numpy.where(delta > 0, delta, 1)
    r, g, b = color[..., 0], color[..., 1], color[..., 2]
    hue = numpy.where(most == r, (g - b) / safe, numpy.where(most == g, 2 + (b - r) / safe, 4 + (r - g) / safe))
    hue = numpy.where(delta > 0, numpy.mod(hue / 6, 1), 0)
    return hue, numpy.where(most > 0, delta / numpy.where(most > 0, most, 1), 0), most


def rgb_of(hue, saturation, value):
    channels = []
    for n in (5, 3, 1):
        k = numpy.mod(n + hue * 6, 6)
        channels.append(value - value * saturation * numpy.clip(numpy.minimum(k, 4 - k), 0, 1))
    return numpy.stack(channels, axis=-1)
