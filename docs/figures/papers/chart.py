# SPDX-License-Identifier: Apache-2.0
"""Charts of measured numbers on a Drawing: axes, curves with one kind of marker each, bars, pictures."""

from math import log10

from drawing import BLUE, DARK, FAINT, GREEN, INK, LIGHT, PALE, RED, number

PURPLE = "#7b3fa0"
# Each style has a colour and a marker, so that curves differ without colour, too.
STYLES = [(BLUE, "circle"), (RED, "square"), (GREEN, "triangle"), (PURPLE, "diamond"), (DARK, "ring"), (LIGHT, "cross")]


def tick_text(value):
    if value and (abs(value) >= 1e5 or abs(value) < 1e-3):
        mantissa, exponent = f"{value:.0e}".split("e")
        return f"{mantissa}e{int(exponent)}"
    return f"{value:g}"


class Chart:
    def __init__(self, d, box, xs, ys, title, x_label, y_label, log_x=False, log_y=False, x_ticks=(), y_ticks=(), x_names=None):
        """`xs`, `ys`: the ends of the axes; `x_names`: texts in place of numbers at the ticks of x."""
        self.d, self.box, self.xs, self.ys, self.logs = d, box, xs, ys, (log_x, log_y)
        left, top, width, height = box
        d.text((left, top - 10), title, 13, bold=True)
        for y in y_ticks:
            at = self.at(xs[0], y)
            d.line(at, (left + width, at[1]), PALE, 1)
            d.text((left - 5, at[1] + 4), tick_text(y), 11, anchor="end")
        for i, x in enumerate(x_ticks):
            at = self.at(x, ys[0])
            d.line(at, (at[0], at[1] + 4), FAINT, 1)
            d.text((at[0], at[1] + 15), x_names[i] if x_names else tick_text(x), 11, anchor="middle")
        d.line((left, top), (left, top + height), FAINT, 1)
        d.line((left, top + height), (left + width, top + height), FAINT, 1)
        d.text((left + width / 2, top + height + 31), x_label, 12, anchor="middle")
        if y_label:
            d.text((left, top + 5), f" {y_label}", 11.5, DARK)

    def at(self, x, y):
        left, top, width, height = self.box

        def share(value, ends, logarithmic):
            if logarithmic:
                value, ends = log10(value), (log10(ends[0]), log10(ends[1]))
            return (value - ends[0]) / (ends[1] - ends[0])

        return (left + width * share(x, self.xs, self.logs[0]), top + height - height * share(y, self.ys, self.logs[1]))

    def curve(self, points, style, dash=None, line=True):
        colour, marker = STYLES[style]
        held = [self.at(x, min(max(y, self.ys[0]), self.ys[1])) for x, y in points]
        if line and len(held) > 1:
            self.d.polygon(held, None, colour, 1.8, dash, closed=False)
        for at in held:
            mark(self.d, at, colour, marker)

    def level(self, y, colour=INK, dash="5 4", text=None):
        a, b = self.at(self.xs[0], y), self.at(self.xs[1], y)
        self.d.line(a, b, colour, 1.3, dash)
        if text:
            self.d.text((b[0] - 4, b[1] - 5), text, 11.5, colour, "end", halo=True)

    def path(self, points, colour=INK, width=1.5, dash=None):
        self.d.polygon([self.at(*p) for p in points], None, colour, width, dash, closed=False)

    def bar(self, x, y, half, colour):
        (x0, base), (x1, top) = self.at(x - half, self.ys[0]), self.at(x + half, min(y, self.ys[1]))
        self.d.polygon([(x0, base), (x0, top), (x1, top), (x1, base)], colour)

    def note(self, x, y, text, fill=INK, anchor="start", offset=(0, 0)):
        at = self.at(x, y)
        self.d.text((at[0] + offset[0], at[1] + offset[1]), text, 11.5, fill, anchor, halo=True)


def mark(d, at, colour, marker, r=3.6):
    x, y = at
    if marker == "circle":
        d.circle(at, r, colour)
    elif marker == "ring":
        d.circle(at, r, "#ffffff", colour, 1.6)
    elif marker == "square":
        d.polygon([(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)], colour)
    elif marker == "triangle":
        d.polygon([(x, y - 1.3 * r), (x + 1.2 * r, y + r), (x - 1.2 * r, y + r)], colour)
    elif marker == "diamond":
        d.polygon([(x, y - 1.4 * r), (x + 1.2 * r, y), (x, y + 1.4 * r), (x - 1.2 * r, y)], colour)
    else:
        d.line((x - r, y - r), (x + r, y + r), colour, 2)
        d.line((x - r, y + r), (x + r, y - r), colour, 2)


def key(d, at, entries, step=None):
    """Draws a key of markers and texts: below one another, or in a row, `step` pixels apart."""
    x, y = at
    for style, text in entries:
        colour, marker = STYLES[style]
        d.line((x, y - 4), (x + 22, y - 4), colour, 1.8)
        mark(d, (x + 11, y - 4), colour, marker)
        d.text((x + 28, y), text, 12)
        if step:
            x += step
        else:
            y += 18


def image(d, at, side, data, caption, text=None):
    """Draws a picture in base64 without smoothing its pixels, and its caption below it."""
    x, y = at
    d.raw(f'<image x="{number(x)}" y="{number(y)}" width="{number(side)}" height="{number(side)}" '
          f'style="image-rendering:pixelated" href="data:image/png;base64,{data}"/>')
    d.polygon([(x, y), (x + side, y), (x + side, y + side), (x, y + side)], None, FAINT, 1)
    d.text((x + side / 2, y + side + 16), caption, 12, anchor="middle", bold=True)
    if text:
        d.text((x + side / 2, y + side + 32), text, 11.5, anchor="middle")
