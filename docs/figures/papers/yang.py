# SPDX-License-Identifier: Apache-2.0
"""Figures of B. Yang, J. Feng, G. Guennebaud, X. Liu, *Packet-based hierarchal soft shadow mapping*, EGSR 2009: `packet`,
`contour`, and the methods with which they are compared."""

from chart import STYLES, Chart, image, key, mark
from drawing import DARK, INK, Drawing
from experiment import ball, bunny, measures, picture, rounded, scene, square

FLAT, MINMAX, HIERARCHY, PACKET = 0, 1, 2, 3
VARIANTS = [("every cell", "contour:size={}:search=mssm:traversal=flat"), ("min-max quadtree (Dmitriev and Uralsky)", "contour:size={}:search=mssm:traversal=minmax"),
        ("hierarchy of contours", "contour:size={}:search=mssm:traversal=hierarchy"), ("hierarchy and packets of 3 × 3", "packet:size={}")]


def visited(counters):
    return counters["cells"] + counters["nodes"]


def measure_samples(runner):
    rows = {"ball": [], "bunny": []}
    for body, make in (("ball", ball), ("bunny", bunny)):
        for half in (0.25, 0.5, 1.0, 2.0):
            entries = [text.format(96) for _, text in VARIANTS]
            found = runner.compare(scene([make()], half=half), entries)
            rows[body].append([half] + [rounded(visited(found[entry]["counters"]) / 48 ** 2) for entry in entries])
    return rows


def draw_samples(data):
    d = Drawing(900, 380, "Yang et al. 2009, figures 7 and 8: cells and nodes examined per pixel",
                "Two charts on a logarithmic axis. For ball and bunny and every size of the light a hierarchy of contours examines "
                "fewer than a min-max quadtree, this fewer than a flat kernel, and packets the fewest.")
    for i, body in enumerate(data):
        chart = Chart(d, (70 + 430 * i, 50, 350, 230), (0.22, 2.3), (1, 1e4), f"({'ab'[i]}) {body}", "half the light's side",
                      "cells and nodes a pixel", log_x=True, log_y=True, x_ticks=(0.25, 0.5, 1, 2), y_ticks=(1, 10, 100, 1000, 10000))
        for style in range(4):
            chart.curve([(row[0], row[1 + style]) for row in data[body]], style)
        last = data[body][-1]
        chart.note(last[0], last[1], f"{last[1] / last[4]:.0f} × fewer", anchor="end", offset=(-8, -10))
    key(d, (70, 340), [(FLAT, VARIANTS[0][0]), (MINMAX, VARIANTS[1][0])], 115)
    key(d, (465, 340), [(HIERARCHY, VARIANTS[2][0]), (PACKET, VARIANTS[3][0])], 180)
    d.text((70, 366), "Map of 96 × 96, picture of 48 × 48 pixels of the floor; the outlines found are the same, to the bit.", 11.5)
    return d.finish()


PACKETS = ["1x1", "2x2", "3x3", "4x4", "5x5", "8x8"]


def measure_packets(runner):
    data = {"size": [], "coherent": []}
    for size in (48, 96, 192):
        entries = [f"packet:size=64:packet={packet}:hierarchy=off" for packet in PACKETS]
        found = runner.compare(scene([bunny()]), entries, size=size)
        data["size"].append([size] + [rounded(visited(found[entry]["counters"]) / size ** 2) for entry in entries])
    for half in (0.25, 0.5, 1.0, 2.0):
        row = [half]
        world = scene([bunny(base=0)], half=half, floor=6.0, floor_casts=True)
        world["camera"] = {"eye": [4, 3, 5], "target": [0, 0.8, 0], "verticalFov": 45}
        for size in (96, 192):
            found = runner.compare(world, ["packet:size=256"], size=size)
            c = found["packet:size=256"]["counters"]
            row.append(rounded(c["packetsShared"] / max(c["packetsShared"] + c["packetsParted"] + c["packetsDiverged"], 1)))
        data["coherent"].append(row)
    return data


def draw_packets(data):
    d = Drawing(900, 380, "Yang et al. 2009, figures 9 and 12: sizes of packets, and how many packets are coherent",
                "Left: cells looked at a pixel fall with the packet's size up to a size that grows with the picture. Right: the share of "
                "packets with one outline for all pixels against the size of the light.")
    top = 1.15 * max(max(row[1:]) for row in data["size"])
    chart = Chart(d, (70, 50, 350, 230), (0.7, 6.3), (0, top), "(a) figure 12: cells a pixel, no hierarchy", "pixels of a packet", "cells a pixel",
                  x_ticks=range(1, 7), x_names=[name.replace("x", " × ") for name in PACKETS], y_ticks=range(0, int(top), 20))
    for style, row in enumerate(data["size"]):
        chart.curve(list(enumerate(row[1:], 1)), style)
    key(d, (290, 75), [(style, f"{row[0]} × {row[0]} pixels") for style, row in enumerate(data["size"])])
    chart = Chart(d, (510, 50, 350, 230), (0.22, 2.3), (0, 1), "(b) figure 9: coherent share of packets of 3 × 3", "half the light's side", "share",
                  log_x=True, x_ticks=(0.25, 0.5, 1, 2), y_ticks=(0, 0.25, 0.5, 0.75, 1))
    for style in (1, 2):
        chart.curve([(row[0], row[style]) for row in data["coherent"]], style)
    chart.note(0.25, 0.06, "paper, 1280 × 1024 pixels, light 1 : 2 : 4: 0.52, 0.68, 0.88", DARK)
    d.text((70, 340), "The bunny over the floor; (a) map of 64 × 64, light of half-size 0.5; (b) seen from the side, map of 256 × 256: of the packets that search at all.", 11.5)
    return d.finish()


VIEWS = [("GBP07: contour", "contour:size=128:traversal=hierarchy"), ("S = 2", "packet:size=128:sublights=2"), ("S = 4", "packet:size=128:sublights=4"),
         ("SS07: bitmask, 4 layers", "bitmask:size=128:layers=4"), ("BCS08: peel, 4 layers", "backproject-peel:size=128:layers=4:samples=0")]


def gap_casters():
    """Returns a small plate high above a large one."""
    return [square("small", [0, 3.5, 0], 0.3), square("large", [0, 1.5, 0], 1.6)]


def measure_views(runner):
    data = {"rows": {}, "tiles": []}
    for body, make, half in (("ball", lambda: [ball()], 1.0), ("bunny", lambda: [bunny()], 1.0), ("plates", gap_casters, 0.6)):
        found = runner.compare(scene(make(), half=half), [entry for _, entry in VIEWS], samples=1024)
        data["rows"][body] = [measures(found, entry, ("rmse", "bias")) for _, entry in VIEWS]
        if body == "ball":
            data["tiles"] = [picture(found, entry, 48) for _, entry in VIEWS] + [picture(found, "truth", 48)]
    return data


def draw_views(data):
    d = Drawing(900, 480, "Yang et al. 2009, figures 10 and 11: sub-lights against layers",
                "Six pictures of V below a ball, and a chart of errors: more sub-lights are nearer to the truth on all three scenes; "
                "joined layers are nearer still on two flat plates; peeled layers, added, are far too dark.")
    names = [name for name, _ in VIEWS]
    for i, tile in enumerate(data["tiles"]):
        error = f"RMSE {data['rows']['ball'][i]['rmse']:.4f}" if i < len(VIEWS) else ""
        image(d, (20 + 145 * i, 40), 132, tile, ([*names, "exact"])[i].replace("GBP07: ", "").replace("SS07: ", "").replace("BCS08: ", ""), error)
    d.text((20, 28), "V on the floor below a ball of radius 1, light of half-size 1, maps of 128 × 128", 13, bold=True)
    top = 0.2
    chart = Chart(d, (60, 260, 790, 150), (-0.4, 2.6), (0, top), "RMSE of V over the floor", "", "", x_ticks=(0, 1, 2),
                  x_names=["ball", "bunny", "plates: a small one high above a large one (figure 10's kind)"], y_ticks=(0, 0.05, 0.1, 0.15, 0.2))
    for group, body in enumerate(data["rows"]):
        for i, result in enumerate(data["rows"][body]):
            x = group + (i - 2) * 0.13
            chart.bar(x, result["rmse"], 0.05, STYLES[i][0])
            chart.note(x, min(result["rmse"], top), f"{result['rmse']:.3f}", anchor="middle", offset=(0, -4))
    for i, name in enumerate(names):
        mark(d, (66 + 168 * i, 456), STYLES[i][0], "square", 5)
        d.text((78 + 168 * i, 460), name, 12)
    return d.finish()


def measure_speed(runner):
    rows = []
    variants = ["contour:size=192:search=mssm:traversal=flat", "packet:size=192:hierarchy=off", "packet:size=192"]
    for half in (0.25, 0.5, 1.0, 2.0):
        found = runner.compare(scene([bunny()], half=half), variants, size=48, runs=1)
        rows.append([half] + [rounded(found[variants[0]]["evaluate"] / found[variant]["evaluate"]) for variant in variants[1:]] +
                    [rounded(visited(found[variants[0]]["counters"]) / visited(found[variant]["counters"])) for variant in variants[1:]])
    return {"rows": rows}


def draw_speed(data):
    d = Drawing(900, 372, "Yang et al. 2009, figure 13: how many times faster packets and a hierarchy are",
                "Two charts against the size of the light. Left measured time, right cells and nodes looked at: packets alone "
                "gain some, packets with a hierarchy gain more the larger the light.")
    rows = data["rows"]
    for i, (title, first) in enumerate((("(a) time of flat contour / time", 1), ("(b) cells and nodes of flat contour / those", 3))):
        top = 10 ** (1 if max(max(row[first:first + 2]) for row in rows) <= 10 else 2 if max(max(row[first:first + 2]) for row in rows) <= 100 else 3)
        chart = Chart(d, (70 + 430 * i, 50, 350, 230), (0.22, 2.3), (0.5, top), title, "half the light's side", "times",
                      log_x=True, log_y=True, x_ticks=(0.25, 0.5, 1, 2), y_ticks=[t for t in (0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000) if t <= top])
        chart.level(1)
        for style in (1, 0):
            points = [(row[0], row[first + style]) for row in rows]
            chart.curve(points, style)
            for x, y in points:
                chart.note(x, y, f"{y:.1f}", anchor="middle", offset=(0, -8))
    key(d, (70, 340), [(0, "packets of 3 × 3"), (1, "packets of 3 × 3 and hierarchy")], 160)
    d.text((470, 344), "Bunny over the floor, 48 × 48 pixels, map of 192 × 192; a processor.", 11.5, INK)
    return d.finish()


FIGURES = {
    "yang-samples": (measure_samples, draw_samples),
    "yang-packets": (measure_packets, draw_packets),
    "yang-views": (measure_views, draw_views),
    "yang-speed": (measure_speed, draw_speed),
}
