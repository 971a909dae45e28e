# SPDX-License-Identifier: Apache-2.0
"""Figure of ARCHITECTURE.md: which room (folder of code) includes which, from the files' #include lines. The rooms are those of
tests/layering.cmake, a test that fails on an include that is not allowed; this script only draws the existing ones."""

import re
from pathlib import Path

from drawing import FAINT, INK, Drawing

ROOT = Path(__file__).parent.parent.parent
SUFFIXES = {".hpp", ".cpp", ".h", ".comp", ".vert", ".frag", ".glsl"}
FAMILY = {"app": "#f7e3b0", "session": "#f7e3b0", "bench": "#f7e3b0", "compare": "#f7e3b0", "volumes": "#d3e5f5", "vsm": "#d3e5f5",
          "maps": "#d3e5f5", "reference": "#d8ecd8", "areas": "#d8ecd8", "engines": "#e6dcf0", "render": "#e6dcf0",
          "visibility": "#f5d9d4"}


def rooms_of_layering():
    text = (ROOT / "tests" / "layering.cmake").read_text(encoding="utf-8")
    return re.search(r"^set\(rooms ([^)]*)\)", text, re.MULTILINE).group(1).split()


def room_of(folder, rooms):
    while folder and folder not in rooms:
        folder = folder.rpartition("/")[0]
    return folder


def included(rooms):
    """Returns {room: rooms whose headers its files include}."""
    arrows = {room: set() for room in rooms}
    for top in sorted({room.partition("/")[0] for room in rooms}):
        for path in sorted((ROOT / top).rglob("*")):
            if path.suffix not in SUFFIXES:
                continue
            room = room_of(path.parent.relative_to(ROOT).as_posix(), rooms)
            for target in re.findall(r'^\s*#\s*include\s*"([^"]+)"', path.read_text(encoding="utf-8"), re.MULTILINE):
                other = room_of(target.rpartition("/")[0], rooms)
                if room and other and other != room:
                    arrows[room].add(other)
    return arrows


def reach(arrows):
    """Returns {room: all rooms that arrows lead to}. The arrows form no cycle, as layering.cmake ensures."""
    known = {}

    def of(room):
        if room not in known:
            known[room] = set().union(*({other} | of(other) for other in arrows[room]), set())
        return known[room]

    for room in arrows:
        of(room)
    return known


def rooms_figure():
    rooms = rooms_of_layering()
    arrows = included(rooms)
    reached = reach(arrows)
    # An arrow is not drawn if other arrows imply it.
    drawn = {room: {other for other in arrows[room] if not any(other in reached[third] for third in arrows[room])}
             for room in rooms}
    level = {}
    for room in sorted(rooms, key=lambda r: len(reached[r])):
        level[room] = 1 + max((level[other] for other in reached[room]), default=-1)
    height = max(level.values()) + 1
    # A room that only high rooms include is drawn one row below them rather than at the bottom.
    users = {room: [other for other in rooms if room in drawn[other]] for room in rooms}
    for room in sorted(rooms, key=lambda r: -level[r]):
        if users[room]:
            level[room] = min(level[other] for other in users[room]) - 1
    # If a row has more boxes than fit, boxes that may be lower move one row down; then the same for the rows below.
    width, step, margin = 1160, 62, 16
    box = {room: 7.6 * len(room) + 18 for room in rooms}

    def lowest(room):
        return 1 + max((level[other] for other in drawn[room]), default=-1)

    for n in range(height - 1, 0, -1):
        while True:
            row = [room for room in rooms if level[room] == n]
            free = [room for room in row if level[room] > lowest(room)]
            if not free or sum(box[room] + 40 for room in row) < width - 2 * margin:
                break
            level[min(free, key=lambda room: (lowest(room), room))] -= 1
    # An arrow over several rows has a separate place in each row in between, so that no arrow runs behind a box.
    chains = []
    for room in rooms:
        for other in sorted(drawn[room]):
            between = [(room, other, n) for n in range(level[room] - 1, level[other], -1)]
            level.update({node: node[2] for node in between})
            chains.append([room, *between, other])
    nodes = list(level)
    above = {node: [chain[i - 1] for chain in chains for i in range(1, len(chain)) if chain[i] == node] for node in nodes}
    below = {node: [chain[i + 1] for chain in chains for i in range(len(chain) - 1) if chain[i] == node] for node in nodes}

    # Order from left to right: sort each row by the mean place of its neighbours above, then below; repeat a few times.
    span = {node: box.get(node, 14) for node in nodes}
    rows = [[node for node in nodes if level[node] == n] for n in range(height)]
    place = {}

    def spread(row):
        gap = (width - 2 * margin - sum(span[node] for node in row)) / (len(row) + 1)
        x = margin + gap
        for node in row:
            place[node] = x + span[node] / 2
            x += span[node] + gap

    for row in rows:
        spread(row)
    for sweep in range(24):
        near = below if sweep % 2 else above
        for n in range(height) if sweep % 2 else range(height - 1, -1, -1):
            mean = {node: round(sum(place[x] for x in near[node]) / len(near[node]), 4) if near[node] else place[node]
                    for node in rows[n]}
            rows[n].sort(key=lambda node: (mean[node], str(node)))
            spread(rows[n])

    d = Drawing(width, height * step + 40, "Which room includes which")
    top = {node: 20 + (height - 1 - level[node]) * step for node in nodes}
    for chain in chains:
        start, end = chain[0], chain[-1]
        limit = span[start] / 2 - 8
        x = place[start] + max(-limit, min(limit, (place[chain[1]] - place[start]) * 0.15))
        points = [(x, top[start] + 26)]
        for node in chain[1:-1]:
            points += [(place[node], top[node] - 2), (place[node], top[node] + 28)]
        limit = span[end] / 2 - 8
        x = place[end] + max(-limit, min(limit, (points[-1][0] - place[end]) * 0.15))
        d.polygon(points, None, FAINT, 1.3, closed=False)
        d.arrow(points[-1], (x, top[end] - 1), FAINT, 1.3, 6)
    for room in rooms:
        x, y, w = place[room], top[room], span[room]
        d.polygon([(x - w / 2, y), (x + w / 2, y), (x + w / 2, y + 26), (x - w / 2, y + 26)],
                  FAMILY.get(room.partition("/")[0], "#eef1f4"), INK, 1)
        d.text((x, y + 17.5), room.replace("_", "\\_"), 13, anchor="middle")
    d.text((20, height * step + 24), "An arrow: includes. Arrows that follow from others are left out.", 12.5)
    return d.finish()


FIGURES = {"rooms": rooms_figure}
