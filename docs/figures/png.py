# SPDX-License-Identifier: Apache-2.0
"""8-bit PNG, RGB or grey, as far as the pictures of docs/ need it."""

import struct
import zlib


def read_png(data):
    """Returns the rows of bytes of an 8-bit RGB picture that is not interlaced, as penumbra writes it."""
    at, body = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, *form = struct.unpack(">IIBBBBB", data[at + 8:at + 8 + length])
            assert form == [8, 2, 0, 0, 0], form
        elif kind == b"IDAT":
            body += data[at + 8:at + 8 + length]
        at += length + 12
    raw, stride, rows = zlib.decompress(body), 3 * width, []
    before = bytes(stride)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = line[i - 3] if i > 2 else 0, before[i], before[i - 3] if i > 2 else 0
            line[i] = line[i] + (0, a, b, (a + b) // 2, paeth(a, b, c))[kind] & 255
        rows.append(bytes(line))
        before = line
    return rows


def paeth(a, b, c):
    p = a + b - c
    return min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]


def write_png(path, rows):
    path.write_bytes(encoded(rows, 3))


def write_grey(rows):
    """Returns the bytes of a file with these rows of one byte per pixel."""
    return encoded(rows, 1)


def write_moving(path, pictures, delay):
    """Writes RGB pictures of one size as an animated PNG that repeats forever. `delay`: milliseconds per picture."""
    height, width = len(pictures[0]), len(pictures[0][0]) // 3
    out, number = header(width, height, 3) + chunk(b"acTL", struct.pack(">II", len(pictures), 0)), 0
    for k, rows in enumerate(pictures):
        out += chunk(b"fcTL", struct.pack(">IIIIIHHBB", number, width, height, 0, 0, delay, 1000, 0, 0))
        out += chunk(b"fdAT", struct.pack(">I", number + 1) + packed(rows, 3)) if k else chunk(b"IDAT", packed(rows, 3))
        number += 2 if k else 1
    path.write_bytes(out + chunk(b"IEND", b""))


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def header(width, height, channels):
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2 if channels == 3 else 0, 0, 0, 0))


def encoded(rows, channels):
    return header(len(rows[0]) // channels, len(rows), channels) + chunk(b"IDAT", packed(rows, channels)) + chunk(b"IEND", b"")


def packed(rows, channels):
    """Returns the compressed lines of a picture."""
    def filtered(line, before):
        """Returns the line filtered by that of the five filters whose differences have the smallest sum."""
        choices = []
        for kind in range(5):
            out = bytearray([kind])
            for i, value in enumerate(line):
                a, c = (line[i - channels], before[i - channels]) if i >= channels else (0, 0)
                b = before[i]
                out.append(value - (0, a, b, (a + b) // 2, paeth(a, b, c))[kind] & 255)
            choices.append((sum(min(x, 256 - x) for x in out[1:]), kind, bytes(out)))
        return min(choices)[2]

    body = b"".join(filtered(line, rows[y - 1] if y else bytes(len(line))) for y, line in enumerate(rows))
    return zlib.compress(body, 9)
