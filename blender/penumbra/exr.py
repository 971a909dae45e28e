# SPDX-License-Identifier: Apache-2.0
"""Reads the pictures that the program writes: OpenEXR, scan lines, ZIP (16 lines a block), float and unsigned channels.
Also writes such files, without compression: Blender can load all pixels of a file at once.

Independent of Blender. Blender's own Python cannot read OpenEXR layers by name.
"""

import struct
import zlib

import numpy

_TYPES = {0: numpy.dtype("<u4"), 2: numpy.dtype("<f4")}
_LINES = {0: 1, 2: 1, 3: 16}  # lines of a block, by compression: none, ZIPS, ZIP


class Picture:
    """`channels`: name to array of height x width, first row at the top; `attributes`: the header's texts."""

    def __init__(self, width, height):
        self.width, self.height = width, height
        self.channels, self.attributes = {}, {}


def _text(data, start):
    end = data.index(b"\0", start)
    return data[start:end].decode("utf-8", "replace"), end + 1


def _header(data):
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError("this is not an OpenEXR file")
    if struct.unpack_from("<I", data, 4)[0] & 0x1A00:
        raise ValueError("tiles, deep data and several parts are not supported")
    entries, at = {}, 8
    while data[at]:
        name, at = _text(data, at)
        kind, at = _text(data, at)
        size = struct.unpack_from("<i", data, at)[0]
        entries[name] = (kind, data[at + 4:at + 4 + size])
        at += 4 + size
    return entries, at + 1


def _channels(value):
    names, at = [], 0
    while value[at]:
        name, at = _text(value, at)
        names.append((name, _TYPES[struct.unpack_from("<i", value, at)[0]]))
        at += 16
    return names


def _unzip(block, size):
    """OpenEXR's ZIP: deflate of differences (plus 128) of bytes whose two halves were interleaved."""
    if len(block) == size:
        return block  # data that would not become smaller is stored unchanged
    plain = numpy.cumsum(numpy.frombuffer(zlib.decompress(block), numpy.uint8), dtype=numpy.uint8)
    plain[1::2] ^= 128  # removes the offset 128 added to each difference
    whole, half = numpy.empty_like(plain), (len(plain) + 1) // 2
    whole[0::2], whole[1::2] = plain[:half], plain[half:]
    return whole.tobytes()


def read(data):
    """Returns the Picture in a file's bytes. Raises ValueError if they are not an OpenEXR file, or of an unsupported
    form."""
    entries, table = _header(data)
    left, top, right, bottom = struct.unpack("<4i", entries["dataWindow"][1])
    width, height = right - left + 1, bottom - top + 1
    compression = entries["compression"][1][0]
    if compression not in _LINES:
        raise ValueError(f"compression {compression} is not supported")
    picture = Picture(width, height)
    picture.attributes = {name: value.decode("utf-8", "replace") for name, (kind, value) in entries.items() if kind == "string"}
    channels = _channels(entries["channels"][1])
    rows = numpy.empty((len(channels), height, width), "<u4")
    lines = _LINES[compression]
    for (offset,) in struct.iter_unpack("<Q", data[table:table + 8 * -(-height // lines)]):
        y, size = struct.unpack_from("<ii", data, offset)
        here = min(lines, bottom + 1 - y)
        block = data[offset + 8:offset + 8 + size]
        if compression:
            block = _unzip(block, 4 * here * width * len(channels))
        found = numpy.frombuffer(block, "<u4").reshape(here, len(channels), width)
        rows[:, y - top:y - top + here] = found.transpose(1, 0, 2)
    for (name, kind), values in zip(channels, rows):
        picture.channels[name] = values.view(kind)
    return picture


def _entry(name, kind, value):
    return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value


def encoded(channels):
    """Returns the bytes of a file with float channels (name to array of height x width)."""
    names = sorted(channels)
    height, width = channels[names[0]].shape
    listed = b"".join(name.encode() + b"\0" + struct.pack("<iIii", 2, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<II", 20000630, 2 | 0x400)  # names may be long
    for name, kind, value in ((b"channels", b"chlist", listed), (b"compression", b"compression", b"\0"),
                              (b"dataWindow", b"box2i", window), (b"displayWindow", b"box2i", window),
                              (b"lineOrder", b"lineOrder", b"\0"), (b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
                              (b"screenWindowCenter", b"v2f", struct.pack("<ff", 0, 0)),
                              (b"screenWindowWidth", b"float", struct.pack("<f", 1))):
        header += _entry(name, kind, value)
    header += b"\0"
    size = 4 * width * len(names)
    first = len(header) + 8 * height
    table = (first + (size + 8) * numpy.arange(height)).astype("<u8")
    lines = numpy.empty((height, 2 + width * len(names)), "<f4")
    heads = numpy.stack([numpy.arange(height), numpy.full(height, size)], axis=-1).astype("<i4")
    lines[:, :2] = heads.view("<f4")
    for i, name in enumerate(names):
        lines[:, 2 + i * width:2 + (i + 1) * width] = channels[name]
    return b"".join([header, table.tobytes(), lines.tobytes()])
