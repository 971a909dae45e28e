# SPDX-License-Identifier: Apache-2.0
"""A small SVG writer for the figures of docs/. It needs only Python's standard library.

A Drawing has pixel coordinates, y down, and a white background, so that it is legible on a dark page, too.
A View maps the coordinates of a construction (y up) into a part of a Drawing."""

from math import cos, hypot, sin

# Colours with one meaning in all figures.
INK = "#1f2933"      # text, outlines
FAINT = "#9aa5b1"    # helping lines
LIGHT = "#f0b429"    # the light, what is visible of it
DARK = "#52606d"     # hidden, shadow, occluders
RED = "#c0392b"      # takes light away, +k
BLUE = "#1f6fb2"     # gives light back, −k
GREEN = "#2f8132"    # what the figure is about: kept, certain
PALE = "#e4e7eb"


def number(x):
    """Returns x with at most two decimals, no −0: the same text on every machine."""
    text = f"{x:.2f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def escape(text):
    return str(text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


class Drawing:
    def __init__(self, width, height, title, description=None):
        self.width, self.height = width, height
        self.parts = [f"<title>{escape(title)}</title>"]
        if description:
            self.parts.append(f"<desc>{escape(description)}</desc>")
        self.parts += [
            f'<rect width="{width}" height="{height}" rx="6" fill="#ffffff"/>']

    def raw(self, text):
        self.parts.append(text)

    def style(self, fill, stroke, width, dash, opacity):
        text = f' fill="{fill or "none"}"'
        if stroke:
            text += f' stroke="{stroke}" stroke-width="{number(width)}" stroke-linejoin="round"'
        if dash:
            text += f' stroke-dasharray="{dash}"'
        if opacity != 1:
            text += f' opacity="{number(opacity)}"'
        return text

    def polygon(self, points, fill=None, stroke=None, width=1.5, dash=None, opacity=1, closed=True):
        text = " ".join(f"{number(x)},{number(y)}" for x, y in points)
        name = "polygon" if closed else "polyline"
        self.raw(f'<{name} points="{text}"{self.style(fill, stroke, width, dash, opacity)}/>')

    def line(self, a, b, stroke=INK, width=1.5, dash=None, opacity=1):
        self.raw(f'<line x1="{number(a[0])}" y1="{number(a[1])}" x2="{number(b[0])}" y2="{number(b[1])}"'
                 f'{self.style(None, stroke, width, dash, opacity)}/>')

    def arrow(self, a, b, stroke=INK, width=1.5, head=7, dash=None, opacity=1):
        """Draws a line with an arrowhead at b."""
        length = hypot(b[0] - a[0], b[1] - a[1]) or 1
        dx, dy = (b[0] - a[0]) / length, (b[1] - a[1]) / length
        foot = (b[0] - dx * head, b[1] - dy * head)
        self.line(a, foot, stroke, width, dash, opacity)
        self.polygon([b, (foot[0] - dy * head * 0.45, foot[1] + dx * head * 0.45),
                      (foot[0] + dy * head * 0.45, foot[1] - dx * head * 0.45)], fill=stroke, opacity=opacity)

    def circle(self, at, radius, fill=None, stroke=None, width=1.5, dash=None, opacity=1):
        self.raw(f'<circle cx="{number(at[0])}" cy="{number(at[1])}" r="{number(radius)}"'
                 f'{self.style(fill, stroke, width, dash, opacity)}/>')

    def text(self, at, text, size=13, fill=INK, anchor="start", bold=False, halo=False):
        """Draws text on its baseline. `a_bc` sets bc as an index, `*a*` sets a in italics."""
        weight = ' font-weight="bold"' if bold else ""
        around = ' stroke="#ffffff" stroke-width="4" stroke-linejoin="round" paint-order="stroke"' if halo else ""
        self.raw(f'<text x="{number(at[0])}" y="{number(at[1])}" font-size="{number(size)}" fill="{fill}" '
                 f'text-anchor="{anchor}"{weight}{around}>{spans(str(text), size)}</text>')

    def legend(self, at, entries, size=12.5, step=19):
        """Draws rows of (symbol, colour, text); symbol is dot, ring, box, line or dash."""
        x, y = at
        for symbol, colour, text in entries:
            middle = y - size * 0.35
            if symbol == "dot":
                self.circle((x + 8, middle), 4, fill=colour)
            elif symbol == "ring":
                self.circle((x + 8, middle), 4, fill="#ffffff", stroke=colour)
            elif symbol == "box":
                self.polygon([(x + 1, middle - 5), (x + 15, middle - 5), (x + 15, middle + 5), (x + 1, middle + 5)],
                             fill=colour)
            else:
                self.line((x, middle), (x + 16, middle), colour, 2, "4 3" if symbol == "dash" else None)
            self.text((x + 22, y), text, size)
            y += step

    def finish(self):
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" '
                f'width="{self.width}" height="{self.height}" font-family="Helvetica, Arial, sans-serif" xml:space="preserve">')
        return head + "\n" + "\n".join(self.parts) + "\n</svg>\n"


def spans(text, size):
    """Converts `a_bc` and `*a*` to tspans; `\\_` is an underscore. Text after an index returns to the baseline."""
    drop = number(size * 0.25)
    out, italic, lowered, i = "", False, False, 0
    while i < len(text):
        c = text[i]
        i += 1
        if c == "\\" and text[i:i + 1] == "_":
            out += "_"
            i += 1
        elif c == "*":
            out += "</tspan>" if italic else '<tspan font-style="italic">'
            italic = not italic
        elif c == "_":
            end = i
            while end < len(text) and text[end].isalnum():
                end += 1
            out += f'<tspan dy="{drop}" font-size="{number(size * 0.75)}">{escape(text[i:end])}</tspan>'
            i, lowered = end, True
        elif lowered:
            out += f'<tspan dy="-{drop}">{escape(c)}</tspan>'
            lowered = False
        else:
            out += escape(c)
    return out + ("</tspan>" if italic else "")


class View:
    """Maps [x0, x1] × [y0, y1], y up, onto a box of the drawing, at one scale in both directions unless `stretch`."""

    def __init__(self, drawing, box, x_range, y_range, stretch=False):
        (left, top, width, height), (x0, x1), (y0, y1) = box, x_range, y_range
        self.d = drawing
        self.sx, self.sy = width / (x1 - x0), height / (y1 - y0)
        if not stretch:
            self.sx = self.sy = min(self.sx, self.sy)
        self.ox = left + (width - self.sx * (x1 - x0)) / 2 - self.sx * x0
        self.oy = top + (height + self.sy * (y1 - y0)) / 2 + self.sy * y0

    def at(self, point):
        return (self.ox + self.sx * point[0], self.oy - self.sy * point[1])

    def polygon(self, points, *args, **kwargs):
        self.d.polygon([self.at(q) for q in points], *args, **kwargs)

    def path(self, points, stroke=INK, width=1.5, **kwargs):
        self.d.polygon([self.at(q) for q in points], None, stroke, width, closed=False, **kwargs)

    def line(self, a, b, *args, **kwargs):
        self.d.line(self.at(a), self.at(b), *args, **kwargs)

    def arrow(self, a, b, *args, **kwargs):
        self.d.arrow(self.at(a), self.at(b), *args, **kwargs)

    def dot(self, at, radius=4, fill=INK, **kwargs):
        self.d.circle(self.at(at), radius, fill, **kwargs)

    def text(self, at, text, size=13, offset=(0, 0), **kwargs):
        x, y = self.at(at)
        self.d.text((x + offset[0], y + offset[1]), text, size, **kwargs)


def arc(center, radius, start, end, steps=24):
    """Returns points of an arc; angles are in radians."""
    return [(center[0] + radius * cos(start + (end - start) * i / steps),
             center[1] + radius * sin(start + (end - start) * i / steps)) for i in range(steps + 1)]
