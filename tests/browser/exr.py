# SPDX-License-Identifier: Apache-2.0
"""Reads only as much of OpenEXR as OUT.exr needs: scan lines, ZIP or no compression, 32-bit channels."""
import struct
import zlib


def unzip(data, size):
    """Unpacks a block: it is deflated, stored as differences, with the even bytes before the odd ones."""
    if len(data) == size:
        return data
    steps = bytearray(zlib.decompress(data))
    for i in range(1, size):
        steps[i] = (steps[i - 1] + steps[i] - 128) & 0xff
    half = (size + 1) // 2
    joined = bytearray(size)
    joined[0::2], joined[1::2] = steps[:half], steps[half:]
    return bytes(joined)


def read_exr(path):
    """Returns {channel: [value of each pixel]} and (width, height)."""
    with open(path, "rb") as file:
        data = file.read()
    assert data[:4] == b"\x76\x2f\x31\x01"
    at, header = 8, {}
    while data[at] != 0:
        name, kind = data[at:at + 600].split(b"\0", 2)[:2]
        at += len(name) + len(kind) + 2
        size = struct.unpack_from("<i", data, at)[0]
        header[name.decode()] = data[at + 4:at + 4 + size]
        at += 4 + size
    at += 1
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    lines = {0: 1, 2: 1, 3: 16}[header["compression"][0]]
    channels, rest = [], header["channels"]
    while rest[0] != 0:
        name, rest = rest.split(b"\0", 1)
        kind = struct.unpack_from("<i", rest)[0]
        assert kind in (0, 2), "32 bits each"
        channels.append((name.decode(), "I" if kind == 0 else "f"))
        rest = rest[16:]
    values = {name: [] for name, _ in channels}
    for first in struct.unpack_from(f"<{-(-height // lines)}Q", data, at):
        y, size = struct.unpack_from("<ii", data, first)
        count = min(lines, height - (y - y0))
        block = unzip(data[first + 8:first + 8 + size], 4 * width * count * len(channels))
        for line in range(count):
            for c, (name, letter) in enumerate(channels):
                values[name] += struct.unpack_from(f"<{width}{letter}", block, 4 * width * (line * len(channels) + c))
    return values, (width, height)


def read_bits(path):
    """Returns the mask of each pixel as a string of 0 and 1, in the order of light samples."""
    with open(path, "rb") as file:
        line = file.readline()
        data = file.read()
    width, height, count = map(int, line.split()[1:])
    words = (count + 31) // 32
    first, record = 24 + 12 * count, 16 + 4 * words
    masks = []
    for i in range(width * height):
        mask = int.from_bytes(data[first + i * record + 16:first + (i + 1) * record], "little")
        masks.append("".join(str(mask >> j & 1) for j in range(count)))
    return masks
