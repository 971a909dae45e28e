#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes docs/images/domes.png: scenes/skies/knot.json under each of its domes alone, side by side. Also computes
scenes/skies/evening.hdr, the picture of the sky of one of these domes. Needs only Python's standard library.

  docs/domes_pictures.py [build/penumbra]          a few seconds"""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "docs" / "figures"))
from png import read_png, write_png  # noqa: E402

SIZE = 256
SCENE = ROOT / "scenes/skies/knot.json"
WIDTH, HEIGHT = 256, 128
SUN, SUN_RADIUS = (0.62, 0.42, -0.66), math.radians(2.5)  # low, in front and to the right


def mix(a, b, share):
    return tuple(x + share * (y - x) for x, y in zip(a, b))


def radiance(direction):
    """Returns the radiance of an evening sky: blue above, warm around a low sun, brown below."""
    x, y, z = direction
    length = math.sqrt(sum(part * part for part in SUN))
    angle = math.acos(max(-1.0, min(1.0, sum(a * b for a, b in zip(direction, SUN)) / length)))
    if y < 0:
        return mix((0.22, 0.17, 0.13), (0.10, 0.08, 0.07), -y)
    if angle < SUN_RADIUS:
        return (420.0, 330.0, 210.0)
    sky = mix((0.62, 0.60, 0.66), (0.10, 0.22, 0.55), min(1.0, 1.6 * y) ** 0.7)
    glow = math.exp(-3.5 * angle)
    return tuple(a + glow * b for a, b in zip(sky, (3.0, 1.7, 0.7)))


def rgbe(color):
    """Returns the four bytes of a pixel in a Radiance picture."""
    mantissa, exponent = math.frexp(max(color))
    scale = mantissa * 256 / max(color)
    return bytes(int(part * scale) for part in color) + bytes([exponent + 128])


def runs(values):
    """Returns one channel of a scan line, run-length encoded: literals of up to 128 values, runs of 4 to 127."""
    out, at = bytearray(), 0
    literal = bytearray()

    def flush():
        if literal:
            out.append(len(literal))
            out.extend(literal)
            literal.clear()

    while at < len(values):
        end = at
        while end < len(values) and values[end] == values[at] and end - at < 127:
            end += 1
        if end - at >= 4:
            flush()
            out += bytes([128 + end - at, values[at]])
            at = end
        else:
            literal.append(values[at])
            if len(literal) == 128:
                flush()
            at += 1
    flush()
    return bytes(out)


def sky_bytes():
    lines = [f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n".encode()]
    for row in range(HEIGHT):
        theta = math.pi * (row + 0.5) / HEIGHT
        pixels = []
        for column in range(WIDTH):
            phi = 2 * math.pi * ((column + 0.5) / WIDTH - 0.5)  # the middle looks along -Z, +X is to the right
            pixels.append(rgbe(radiance((math.sin(theta) * math.sin(phi), math.cos(theta), -math.sin(theta) * math.cos(phi)))))
        lines.append(bytes([2, 2, WIDTH >> 8, WIDTH & 255]))
        lines += [runs([pixel[channel] for pixel in pixels]) for channel in range(4)]
    return b"".join(lines)


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/penumbra"
    (ROOT / "scenes/skies/evening.hdr").write_bytes(sky_bytes())
    strips = []
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        for light in json.loads(SCENE.read_text())["lights"]:
            subprocess.run([program, "--quiet", "render", SCENE, "-o", work / "out.exr", "--png", work / "out.png",
                            "--light", light["name"], "--size", f"{SIZE}x{SIZE}", "--light-samples", "1024",
                            "--sample-pattern", "sobol"], check=True)
            strips.append(read_png((work / "out.png").read_bytes()))
    gap = b"\xff" * 3 * 4
    write_png(ROOT / "docs/images/domes.png", [gap.join(lines) for lines in zip(*strips)])


if __name__ == "__main__":
    main()
