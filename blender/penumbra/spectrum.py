# SPDX-License-Identifier: Apache-2.0
"""Colour of a black body: Planck's law, seen by the CIE 1931 observer, in linear Rec. 709 of luminance 1."""

from math import exp

_TO_REC709 = ((3.2404542, -1.5371385, -0.4985314), (-0.9692660, 1.8760108, 0.0415560), (0.0556434, -0.2040259, 1.0572252))
# The observer's three colour matching functions, every 10 nm from 380 nm on, in ten-thousandths.
_OBSERVER = (
    (14, 42, 143, 435, 1344, 2839, 3483, 3362, 2908, 1954, 956, 320, 49, 93, 633, 1655, 2904, 4334, 5945, 7621, 9163, 10263,
     10622, 10026, 8544, 6424, 4479, 2835, 1649, 874, 468, 227, 114, 58, 29, 14, 7, 3, 2, 1),
    (0, 1, 4, 12, 40, 116, 230, 380, 600, 910, 1390, 2080, 3230, 5030, 7100, 8620, 9540, 9950, 9950, 9520, 8700, 7570, 6310,
     5030, 3810, 2650, 1750, 1070, 610, 320, 170, 82, 41, 21, 10, 5, 3, 1, 1, 0),
    (65, 201, 679, 2074, 6456, 13856, 17471, 17721, 16692, 12876, 8130, 4652, 2720, 1582, 782, 422, 203, 87, 39, 21, 17, 11, 8,
     3, 2))


def blackbody(kelvin):
    """Returns the colour as Blender's node does: constant above 12,000 K and below 800 K; negative channels are 0."""
    kelvin = min(max(kelvin, 800.0), 12000.0)
    seen = [sum(weight * radiance(380 + 10 * i, kelvin) for i, weight in enumerate(weights)) for weights in _OBSERVER]
    return tuple(max(sum(a * b / seen[1] for a, b in zip(row, seen)), 0.0) for row in _TO_REC709)


def radiance(nanometres, kelvin):
    return nanometres ** -5.0 / (exp(1.438777e7 / (nanometres * kelvin)) - 1)
