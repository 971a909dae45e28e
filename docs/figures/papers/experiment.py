# SPDX-License-Identifier: Apache-2.0
"""Scenes of the papers' figures, runs of `penumbra compare` on them, and measures of its pictures.

Truth is V of `edge-scatter:rows=exact`, exact areas, at every pixel of the same run. The camera looks straight down at the floor,
from just above it and below the casters, so that pixels are evenly spread on the floor and nothing is in front of it. Lengths are
in the scenes' unit, errors in V."""

import base64
import json
import subprocess
import sys
import tempfile
from math import atan, degrees, sqrt
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "browser"))
sys.path.insert(0, str(ROOT / "docs" / "figures"))

from exr import read_exr  # noqa: E402
from png import write_grey  # noqa: E402

TRUTH = "edge-scatter:rows=exact"


def square(name, center, half, half_z=None, **more):
    half_z = half if half_z is None else half_z
    return {"name": name, "quad": {"center": center, "halfU": [half, 0, 0], "halfV": [0, 0, -half_z]}, **more}


def ball(y=2.0, x=0.0, radius=1.0, segments=48):
    return {"name": "ball", "shape": {"type": "sphere", "center": [x, y, 0], "radius": radius, "segments": segments}}


def box(center, half):
    return {"name": "box", "shape": {"type": "box", "center": center, "halfSize": half}}


def bunny(base=0.02, height=2.0):
    return {"name": "bunny", "package": {"name": "glmark2-data", "file": "models/bunny.obj"},
            "fit": {"height": height, "base": [0, base, 0]}}


def scene(casters, half=0.5, light_y=5.0, floor=2.5, eye=0.01, half_z=None, center=(0.0, 0.0), floor_casts=False, strip=1):
    """Returns a scene of casters under a square light above a square floor at height 0. The camera, `eye` above the floor, sees the middle
    of the floor, 1 / `strip` of its side."""
    return {
        "format": "penumbra-scene/1",
        "size": [48, 48],
        "camera": {"eye": [center[0], eye, center[1]], "target": [center[0], 0, center[1]], "up": [0, 0, -1],
                   "verticalFov": degrees(2 * atan(0.98 * floor / strip / eye))},
        "meshes": [square("floor", [center[0], 0, center[1]], floor, castsShadow=floor_casts)] + casters,
        "lights": [{"name": "key", "rectangle": {"center": [0, light_y, 0], "halfU": [half, 0, 0],
                                                 "halfV": [0, 0, half if half_z is None else half_z]}}],
    }


def cross(a, b):
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def judged(world, channels):
    """Returns for each pixel whether errors are counted there. The pixel must show a surface. If the first light is a rectangle, the surface
    must also be in front of the light, with the whole light above its tangent plane."""
    if "dome" in world["lights"][0]:
        return [a > 0 for a in channels["A"]]
    light = world["lights"][0]["rectangle"]
    u, v = light["halfU"], light["halfV"]
    corners = [[c + s * x + t * y for c, x, y in zip(light["center"], u, v)] for s in (-1, 1) for t in (-1, 1)]
    normal = cross(u, v)
    found = []
    for a, *p_n in zip(channels["A"], *(channels[f"{name}.{axis}"] for name in "PN" for axis in "XYZ")):
        p, n = p_n[:3], p_n[3:]
        segments = [[x - y for x, y in zip(corner, p)] for corner in corners]
        found.append(a > 0 and dot(normal, segments[0]) < 0 and all(dot(n, segment) > 0 for segment in segments))
    return found


class Runner:
    """Runs the program, and records the commands of its runs."""

    def __init__(self, program):
        self.program = Path(program).resolve()
        self.commands = []
        self.device = None

    def compare(self, world, methods, size=48, runs=1, samples=None, more=()):
        """Returns {entry: {"V": pixels, "A", "judged", "counters", "passes", "evaluate", "light", "rmse"}}, with "truth" as one of the entries.
        `size`: pixels per side, or (width, height)."""
        width, height = size if isinstance(size, tuple) else (size, size)
        entries = list(dict.fromkeys([TRUTH, *methods]))
        args = ["--methods", ",".join(entries), "--reference", "raytrace", "--reference-samples", "16", "--runs", str(runs),
                "--size", f"{width}x{height}", *more]
        if samples:
            args += ["--light-samples", str(samples)]
        command = "penumbra compare SCENE -o OUT " + " ".join(args)
        if command not in self.commands:
            self.commands.append(command)
        with tempfile.TemporaryDirectory() as folder:
            path, out = Path(folder) / "scene.json", Path(folder) / "out"
            if isinstance(world, dict):
                path.write_text(json.dumps(world), encoding="utf-8")
            else:
                path = ROOT / world
                world = json.loads(path.read_text(encoding="utf-8"))
            subprocess.run([self.program, "-q", "compare", path, "-o", out, *args], check=True, stdout=subprocess.DEVNULL)
            metrics = json.loads((out / "metrics.json").read_text(encoding="utf-8"))
            found, counted = {}, None  # all entries have the same view samples
            for entry in metrics["methods"]:
                assert entry["failure"] is None, (entry["entry"], entry["failure"])
                channels, _ = read_exr(out / f"{entry['entry'].replace(':', ',')}.exr")
                counted = counted or judged(world, channels)
                found[entry["entry"]] = {
                    "V": channels["V"], "A": channels["A"], "judged": counted, "counters": entry["counters"], "device": entry["device"],
                    "passes": {p["name"]: p["milliseconds"] for p in entry["passes"]},
                    "evaluate": entry["seconds"]["evaluate"], "light": entry["seconds"]["light"],
                    "rmse": entry["error"]["rmse"]}
                if entry["entry"] != TRUTH:
                    self.device = entry["device"]
        found["truth"] = found.pop(TRUTH)
        return found


def measures(found, entry, keep=None):
    """Returns errors of an entry against the truth of its run. `s0` is the measure of Atty et al. 2006: the sum of |V − V_ref| divided by
    the number of pixels in umbra or penumbra. `leak`: share of the umbra with V > 0.05; `dark`: share of lit pixels with V < 0.95."""
    pairs = [(v, r) for v, r, a in zip(found[entry]["V"], found["truth"]["V"], found["truth"]["judged"]) if a]
    shadow = sum(r < 1 for _, r in pairs)
    umbra = [v for v, r in pairs if r == 0]
    lit = [v for v, r in pairs if r == 1]
    result = {
        "s0": sum(abs(v - r) for v, r in pairs) / max(shadow, 1),
        "rmse": sqrt(sum((v - r) ** 2 for v, r in pairs) / len(pairs)),
        "penumbraRmse": sqrt(sum((v - r) ** 2 for v, r in pairs if 0 < r < 1) / max(shadow - len(umbra), 1)),
        "bias": sum(v - r for v, r in pairs) / len(pairs),
        "leak": sum(v > 0.05 for v in umbra) / max(len(umbra), 1),
        "dark": sum(v < 0.95 for v in lit) / max(len(lit), 1),
        "shadow": shadow,
        "umbra": len(umbra),
    }
    return {name: rounded(value) for name, value in result.items() if keep is None or name in keep}


def rounded(x):
    """Returns a measured number with four significant digits, as it is kept."""
    return x if isinstance(x, int) else float(f"{x:.4g}")


def picture(found, entry, size):
    """Returns V as a grey PNG in base64."""
    values = [round(255 * min(max(v, 0), 1)) for v in found[entry]["V"]]
    return base64.b64encode(write_grey([bytes(values[y * size:(y + 1) * size]) for y in range(size)])).decode()
