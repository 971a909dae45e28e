# SPDX-License-Identifier: Apache-2.0
"""Reads the pictures that `compare` wrote for a method, as rows of RGB bytes. Needs only Python's standard library."""

import sys
from pathlib import Path

from png import read_png

sys.path.append(str(Path(__file__).resolve().parents[2] / "tests" / "browser"))
from exr import read_exr  # noqa: E402

BACKGROUND = bytes((96, 104, 116))  # of compare/error_picture.cpp


def stem(entry):
    """Returns the stem of an entry's file names, which contain no colons."""
    return entry.replace(":", ",")


def error_rows(folder, entry):
    """Returns the picture of the signed error of V under the first light."""
    return read_png((folder / f"{stem(entry)}-error.png").read_bytes())


def visibility_rows(folder, entry):
    """Returns V in greys, with the background at the pixels where the error picture has it."""
    channels, (width, _) = read_exr(folder / f"{stem(entry)}.exr")
    rows = []
    for y, error in enumerate(error_rows(folder, entry)):
        line = bytearray()
        for x, v in enumerate(channels["V"][y * width:(y + 1) * width]):
            outside = error[3 * x:3 * x + 3] == BACKGROUND
            line += BACKGROUND if outside else bytes((round(255 * min(max(v, 0), 1)),)) * 3
        rows.append(bytes(line))
    return rows
