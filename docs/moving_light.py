#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders the moving picture of README.md, docs/images/moving-light.png: the sun of scenes/room.json moves on a circle. Left: the picture
with exact shadows. Right: the error of V by `pcss` under that sun, in the colours of the report. Needs numpy and the Python module:

  PYTHONPATH=build/python docs/moving_light.py [--frames 16]          a minute"""

import argparse
import math
import sys
from pathlib import Path

import numpy as np
import penumbra

ROOT = Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "docs" / "figures"))

from png import write_moving  # noqa: E402

SIZE = (304, 228)
CENTER, RADIUS = (1.0, 3.9, -6.5), (1.3, 0.7)  # centre and radii of the sun's path, in the plane of the window
EXPOSURE, LIMIT = 2.6, 0.5  # exposure of the left picture; the error with the deepest colour in the right one
# Colours of compare/error_picture.cpp.
TOO_BRIGHT = ((255, 255, 255), (188, 218, 236), (90, 163, 206), (33, 102, 172), (5, 40, 90))
TOO_DARK = ((255, 255, 255), (253, 208, 180), (240, 130, 95), (190, 35, 45), (95, 0, 25))


def tone_mapped(rgb):
    linear = np.clip(EXPOSURE * rgb, 0, None)
    linear = linear / (1 + linear / 4)
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
    return np.round(255 * np.clip(srgb, 0, 1)).astype(np.uint8)


def error_colors(error):
    depth = np.sqrt(np.minimum(1, abs(error) / LIMIT)) * 4
    channels = []
    for k in range(3):
        bright, dark = (np.interp(depth, range(5), [colour[k] for colour in arm]) for arm in (TOO_BRIGHT, TOO_DARK))
        channels.append(np.where(error > 0, bright, dark))
    return np.round(np.stack(channels, axis=-1)).astype(np.uint8)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", type=int, default=16)
    args = parser.parse_args()
    exact, pcss = (penumbra.Renderer(penumbra.load(ROOT / "scenes" / "room.json")) for _ in range(2))
    pictures = []
    for k in range(args.frames):
        angle = 2 * math.pi * k / args.frames
        center = (CENTER[0] + RADIUS[0] * math.cos(angle), CENTER[1] + RADIUS[1] * math.sin(angle), CENTER[2])
        for renderer in (exact, pcss):
            renderer.set_light("sun", center=center)
        left = exact.render(size=SIZE)
        right = pcss.render(size=SIZE, method="pcss", light="sun")
        gap = np.full((SIZE[1], 6, 3), 255, np.uint8)
        picture = np.concatenate([tone_mapped(left.rgb), gap, error_colors(right.V - left.lights["sun"].V)], axis=1)
        pictures.append([bytes(line) for line in picture.reshape(SIZE[1], -1)])
        print(f"{k + 1} of {args.frames}", flush=True)
    path = ROOT / "docs" / "images" / "moving-light.png"
    write_moving(path, pictures, 120)
    print(f"{path.stat().st_size} bytes")


main()
