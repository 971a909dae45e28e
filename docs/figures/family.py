# SPDX-License-Identifier: Apache-2.0
"""Figure of maps/README.md: the methods of the family by year, and which method improves on which."""

from drawing import BLUE, DARK, GREEN, INK, RED, Drawing

# Method: year, position of its middle in the figure, its use of the map. adaptive-light's paper has no year.
METHODS = {
    "shadow-map": (1978, (90, 235), "nearest depth"),
    "silhouette-map": (2003, (265, 128), "outlines between"),
    "forward-map": (1998, (540, 128), "texels throw light"),
    "pcf": (1987, (265, 60), "share of a window"),
    "pcss": (2005, (540, 60), "window from blockers"),
    "vssm": (2010, (770, 60), "means made beforehand"),
    "convolution": (1998, (450, 145), "image of the light"),
    "occlusion-textures": (2006, (680, 145), "product of slices"),
    "soft-shadow-map": (2006, (680, 235), "patches on receivers"),
    "backproject": (2006, (430, 325), "patches on the light"),
    "contour": (2007, (680, 325), "outlines of texels"),
    "packet": (2009, (915, 325), "pixels together"),
    "backproject-peel": (2006, (680, 410), "layers and midpoints"),
    "bitmask": (2007, (915, 410), "sets of light samples"),
    "layer-rays": (1999, (915, 475), "rays through layers"),
    "parker": (1998, (300, 715), "soft edges outside"),
    "brabec-seidel": (2002, (540, 745), "search, both sides"),
    "kirsch-doellner": (2003, (770, 745), "distances inside"),
    "smoothies": (2003, (770, 685), "strips outside"),
    "penumbra-map": (2003, (540, 685), "cones outside"),
    "arvo": (2004, (770, 805), "flood on the screen"),
    "accumulate": (1997, (340, 530), "a map a light sample"),
    "layered-attenuation": (2000, (680, 475), "counts in layers"),
    "deep-penumbra": (2005, (680, 545), "V along rays"),
    "adaptive-light": (None, (680, 612), "maps where they differ"),
}
# Arrows: from one method to another, the second method's improvement on the first, colour.
ARROWS = [
    ("shadow-map", "pcf", "soft edges", BLUE), ("pcf", "pcss", "width of penumbrae", BLUE), ("shadow-map", "silhouette-map", "straight edges", BLUE), ("pcss", "vssm", "no taps", BLUE), ("shadow-map", "forward-map", "", BLUE),
    ("shadow-map", "convolution", "areas", GREEN), ("convolution", "occlusion-textures", "several planes", GREEN),
    ("shadow-map", "soft-shadow-map", "the light from each receiver", RED), ("shadow-map", "backproject", "", RED),
    ("backproject", "backproject-peel", "gaps", RED), ("backproject", "bitmask", "overlaps", RED), ("backproject", "contour", "gaps", RED),
    ("contour", "packet", "time", RED), ("shadow-map", "accumulate", "all of the light", DARK),
    ("accumulate", "layered-attenuation", "time of a view", DARK), ("accumulate", "deep-penumbra", "time of a view", DARK), ("accumulate", "adaptive-light", "fewer maps", DARK),
    ("backproject-peel", "layer-rays", "all that layers tell", RED), ("shadow-map", "parker", "", INK), ("parker", "penumbra-map", "any receiver", INK),
    ("penumbra-map", "smoothies", "one width", INK), ("parker", "brabec-seidel", "both sides", INK), ("brabec-seidel", "kirsch-doellner", "time", INK),
    ("brabec-seidel", "arvo", "the map's resolution", INK),
]
def family_figure():
    d = Drawing(1000, 860, "The image-based family: which method improves on which",
                "A graph from shadow-map of 1978 in five branches: filters (pcf, pcss, vssm; silhouette-map between texels, forward-map the other way round), images of slices (convolution, occlusion-textures), patches "
                "projected back onto the light (soft-shadow-map, backproject, backproject-peel, bitmask, contour, packet, layer-rays), many maps (accumulate, layered-attenuation, "
                "deep-penumbra, adaptive-light), and penumbrae around one hard shadow (parker, penumbra-map, smoothies, brabec-seidel, kirsch-doellner, arvo). Each arrow says what the later method repairs.")
    assert {name for pair in ARROWS for name in pair[:2]} == set(METHODS)
    for a, b, what, colour in ARROWS:
        (x0, y0), (x1, y1) = METHODS[a][1], METHODS[b][1]
        start, end = (x0 + 70, y0), (x1 - 74, y1)
        d.arrow(start, end, colour, 1.6)
        if what:
            d.text((start[0] + 0.55 * (end[0] - start[0]), start[1] + 0.55 * (end[1] - start[1]) - 4), what, 11, colour, "middle", halo=True)
    for name, (year, (x, y), what) in METHODS.items():
        d.polygon([(x - 70, y - 20), (x + 70, y - 20), (x + 70, y + 20), (x - 70, y + 20)], "#ffffff", INK, 1.2)
        d.text((x, y - 4), name, 12.5, anchor="middle", bold=True)
        d.text((x, y + 12), what, 9.5, DARK, "middle")
        if year:
            d.text((x, y + 32), year, 10, DARK, "middle", halo=True)
    for y, text, colour in ((30, "one map, read over a window", BLUE), (115, "images of slices", GREEN), (290, "patches of one map, projected onto the light", RED),
                            (480, "maps from many points", DARK), (655, "penumbrae around one hard shadow", INK)):
        d.text((470 if colour == RED else 20, y), text, 12.5, colour, bold=True)
    return d.finish()


FIGURES = {"family": family_figure}
