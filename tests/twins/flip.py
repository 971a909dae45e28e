# SPDX-License-Identifier: Apache-2.0
"""Compares FLIP (Andersson et al. 2020) in numpy with the results of `compare` for the pictures that it writes:
arguments are the program and a scene.

Written from the paper, with whole two-dimensional filters where the program filters rows and columns. Both work in
double on the same bytes: the tolerance is the rounding of a float32 map. With --print WIDTH HEIGHT it prints the values
in the unit test FlipTest.IsAsTheTwinHasIt.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import zlib

import numpy as np

PIXELS_PER_DEGREE = 0.7 * 3840 / 0.7 * np.pi / 180


def png(path):
    """Reads an 8-bit RGB PNG without interlacing."""
    data = pathlib.Path(path).read_bytes()
    at, packed = 8, b""
    while at < len(data):
        size, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height = int.from_bytes(body[:4], "big"), int.from_bytes(body[4:8], "big")
            assert body[8:] == b"\x08\x02\x00\x00\x00", body
        if kind == b"IDAT":
            packed += body
        at += 12 + size
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + 3 * width).astype(int)
    out = np.zeros((height, 3 * width), int)
    for y in range(height):
        above = out[y - 1] if y > 0 else np.zeros(3 * width, int)
        for x in range(3 * width):
            left, up, corner = (out[y, x - 3] if x >= 3 else 0), above[x], (above[x - 3] if x >= 3 else 0)
            guess = left + up - corner
            paeth = min((left, up, corner), key=lambda v: abs(guess - v))
            out[y, x] = (rows[y, 1 + x] + (0, left, up, (left + up) // 2, paeth)[rows[y, 0]]) % 256
    return out.reshape(height, width, 3)


def linear(encoded):
    s = encoded / 255
    return np.where(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055) ** 2.4)


TO_XYZ = np.array([[10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
                   [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
                   [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]])
WHITE = TO_XYZ.sum(axis=1)


def hunt(rgb):
    t = rgb @ TO_XYZ.T / WHITE
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t * (29 / 6) ** 2 / 3 + 4 / 29)
    light = 116 * f[..., 1] - 16
    return np.stack([light, light * 5 * (f[..., 0] - f[..., 1]), light * 2 * (f[..., 1] - f[..., 2])], -1)


def hyab(a, b):
    d = hunt(a) - hunt(b)
    return np.abs(d[..., 0]) + np.sqrt(d[..., 1] ** 2 + d[..., 2] ** 2)


def convolved(plane, kernel):
    r = kernel.shape[0] // 2
    padded = np.pad(plane, r, mode="edge")
    out = np.zeros_like(plane)
    for dy in range(2 * r + 1):
        for dx in range(2 * r + 1):
            out += kernel[dy, dx] * padded[dy:dy + plane.shape[0], dx:dx + plane.shape[1]]
    return out


def grid(radius):
    return np.meshgrid(np.arange(-radius, radius + 1.0), np.arange(-radius, radius + 1.0))


def filtered(rgb, ppd):
    xyz = rgb @ TO_XYZ.T / WHITE
    channels = [116 * xyz[..., 1] - 16, 500 * (xyz[..., 0] - xyz[..., 1]), 200 * (xyz[..., 1] - xyz[..., 2])]
    x, y = grid(int(np.ceil(3 * np.sqrt(0.04 / (2 * np.pi ** 2)) * ppd)))
    seen = []
    for plane, terms in zip(channels, ([(1, 0.0047)], [(1, 0.0053)], [(34.1, 0.04), (13.5, 0.025)])):
        kernel = sum(a * np.sqrt(np.pi / b) * np.exp(-np.pi ** 2 * (x ** 2 + y ** 2) / ppd ** 2 / b) for a, b in terms)
        seen.append(convolved(plane, kernel / kernel.sum()))
    light = (seen[0] + 16) / 116
    back = np.stack([seen[1] / 500 + light, light, light - seen[2] / 200], -1) * WHITE
    return np.clip(back @ np.linalg.inv(TO_XYZ).T, 0, 1)


def features(rgb, ppd):
    light = (rgb @ TO_XYZ.T / WHITE)[..., 1]
    deviation = 0.5 * 0.082 * ppd
    x, y = grid(int(np.ceil(3 * deviation)))
    bell = np.exp(-(x ** 2 + y ** 2) / (2 * deviation ** 2))
    lengths = []
    for kernel in (-x * bell, (x ** 2 / deviation ** 2 - 1) * bell):
        kernel = np.where(kernel > 0, kernel / kernel[kernel > 0].sum(), kernel / -kernel[kernel < 0].sum())
        lengths.append(np.sqrt(convolved(light, kernel) ** 2 + convolved(light, kernel.T) ** 2))
    return lengths


def flip(reference, picture, ppd=PIXELS_PER_DEGREE):
    a, b = linear(reference), linear(picture)
    color = hyab(filtered(a, ppd), filtered(b, ppd)) ** 0.7
    largest = hyab(np.array([0.0, 1, 0]), np.array([0.0, 0, 1])) ** 0.7
    knee = 0.4 * largest
    color = np.where(color < knee, 0.95 / knee * color, 0.95 + (color - knee) / (largest - knee) * 0.05)
    edges, points = (np.abs(f - g) for f, g in zip(features(a, ppd), features(b, ppd)))
    return color ** (1 - np.sqrt(np.maximum(edges, points) / np.sqrt(2)))


def made_up(width, height):
    """Returns two generated pictures: steps, a dot, colours."""
    y, x = np.mgrid[0:height, 0:width]
    first = np.stack([(37 * x + 11 * y) % 256, (16 * x) % 256, np.where(x > y, 200, 30)], -1)
    second = first.copy()
    second[..., 1] = (16 * x + 40 * (y > 3)) % 256
    second[height // 2, width // 2] = (255, 255, 255)
    return first, second


def main():
    if sys.argv[1] == "--print":
        found = flip(*made_up(int(sys.argv[2]), int(sys.argv[3])))
        print(repr(found.mean()), repr(found.max()), repr(found[0, 0]))
        return
    program, scene = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "compare", scene, "-o", folder, "--methods", "pcss:size=64,shadow-map:size=32", "--reference", "exact",
                        "--size", "72x54", "--png", "--runs", "1", "--quiet"], check=True)
        reference = png(f"{folder}/reference.png")
        for method in json.loads(pathlib.Path(folder, "metrics.json").read_text())["methods"]:
            twin = flip(reference, png(f"{folder}/{method['entry'].replace(':', ',')}.png"))
            said = method["eye"]["flip"]
            print(method["entry"], said, twin.mean(), twin.max())
            assert said["mean"] > 1e-3
            assert abs(said["mean"] - twin.mean()) < 1e-6 and abs(said["max"] - twin.max()) < 1e-6, method["entry"]


if __name__ == "__main__":
    main()
