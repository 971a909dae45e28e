#!/usr/bin/env python3
"""The strip of methods in README.md: for each method V, and below it how far V is off, one PNG each in
docs/images/methods/. Runs one comparison against exact areas and takes the pictures out of its report. Python's standard
library is all that it needs.

  docs/method_pictures.py [build/penumbra]          minutes: exact areas at every pixel"""

import base64
import json
import re
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCENE, SIZE = "scenes/fusion.json", 320
LEFT, TOP, RIGHT, BOTTOM = 16, 40, 296, 290  # the part of the picture in which something happens
METHODS = ["edge-scatter", "edge-scatter:rows=exact", "view-sample", "depth-complexity", "soft-volume",
           "soft-volume-blend", "wedge-ramp", "hard-volume", "pcss", "accumulate", "shadow-map", "raytrace"]


def read_png(data):
    """Rows of bytes of an 8-bit RGB picture that is not interlaced, as penumbra writes it."""
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
    def filtered(line, before):
        """Of the five filters the one whose differences are smallest in sum."""
        choices = []
        for kind in range(5):
            out = bytearray([kind])
            for i, value in enumerate(line):
                a, b, c = line[i - 3] if i > 2 else 0, before[i], before[i - 3] if i > 2 else 0
                out.append(value - (0, a, b, (a + b) // 2, paeth(a, b, c))[kind] & 255)
            choices.append((sum(min(x, 256 - x) for x in out[1:]), kind, bytes(out)))
        return min(choices)[2]

    body = b"".join(filtered(line, rows[y - 1] if y else bytes(len(line))) for y, line in enumerate(rows))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", len(rows[0]) // 3, len(rows), 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(body, 9)) +
                     chunk(b"IEND", b""))


def half(rows):
    """The part, at half its size: the mean of four pixels (of what is shown, not of light)."""
    out = []
    for y in range(TOP, BOTTOM, 2):
        line = bytearray()
        for x in range(LEFT, RIGHT, 2):
            for k in range(3):
                line.append((rows[y][3 * x + k] + rows[y][3 * x + 3 + k] + rows[y + 1][3 * x + k] +
                             rows[y + 1][3 * x + 3 + k] + 2) // 4)
        out.append(bytes(line))
    return out


def main():
    program = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build" / "penumbra").resolve()
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        subprocess.run([program, "-q", "compare", ROOT / SCENE, "-o", out, "--methods", ",".join(METHODS), "--reference",
                        "exact", "--runs", "1", "--size", f"{SIZE}x{SIZE}"], check=True, stdout=subprocess.DEVNULL)
        report = (out / "report.html").read_text(encoding="utf-8")
        metrics = json.loads((out / "metrics.json").read_text(encoding="utf-8"))
    pictures = {}
    for alt, data in re.findall(r'<img alt="([^"]*)"[^>]*src="data:image/png;base64,([^"]*)"', report):
        pictures[alt.partition(": ")[0]] = read_png(base64.b64decode(data))
    images = ROOT / "docs" / "images" / "methods"
    images.mkdir(exist_ok=True)
    for name, result in zip(METHODS, metrics["methods"]):
        error = half(pictures[f"Signed error of V by {name}"])
        gap = [b"\xff" * len(error[0])] * 4
        path = images / (name.replace(":", "-").replace("=", "-") + ".png")
        write_png(path, half(pictures[f"V by {name}"]) + gap + error)
        e = result["error"]
        print(f"{name}: RMSE {e['rmse']:.4f}, largest {e['max']:.2f}, {path.stat().st_size} bytes")


main()
