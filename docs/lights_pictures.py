#!/usr/bin/env python3
"""docs/images/lights.png: one scene under seven kinds of light, side by side. Python's standard library is all that it
needs.

  docs/lights_pictures.py [build/penumbra]          a minute"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "docs" / "figures"))
from png import read_png, write_png  # noqa: E402

SIZE = 200
CENTER = [-1.2, 4, 0.8]
TRAVELS = [1.2, -4, -0.8]
LIGHTS = [
    {"rectangle": {"center": CENTER, "halfU": [0.8, 0, 0], "halfV": [0, 0, 0.8]}},
    {"disk": {"center": CENTER, "normal": [0, -1, 0], "radius": 0.9}},
    {"ellipse": {"center": CENTER, "halfU": [1.5, 0, 0], "halfV": [0, 0, 0.25]}},
    {"polygon": [[-2.1, 4, 0], [-0.3, 4, 0], [-1.2, 4, 1.9]]},
    {"sphere": {"center": CENTER, "radius": 0.8}},
    {"sun": {"direction": TRAVELS, "angle": 10}},
    {"sun": {"direction": TRAVELS, "angle": 0}},
]


def scene(light):
    return {
        "format": "penumbra-scene/1", "size": [SIZE, SIZE],
        "camera": {"eye": [2.6, 2.9, 3.4], "target": [0, 0.35, 0], "verticalFov": 40},
        "meshes": [
            {"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [6, 0, 0], "halfV": [0, 0, -6]}},
            {"name": "knot", "shape": {"type": "knot", "radius": 0.55, "tube": 0.12, "segments": 192},
             "transform": {"translate": [0, 0.75, 0], "rotate": [70, 0, 20]}}],
        "lights": [{"name": "light", **light}]}


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/penumbra"
    strips = []
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        for light in LIGHTS:
            (work / "scene.json").write_text(json.dumps(scene(light)))
            subprocess.run([program, "--quiet", "render", work / "scene.json", "-o", work / "out.exr", "--png",
                            work / "out.png", "--method", "raytrace", "--light-samples", "1024"], check=True)
            strips.append(read_png((work / "out.png").read_bytes()))
    gap = b"\xff" * 3 * 4
    write_png(ROOT / "docs/images/lights.png", [gap.join(lines) for lines in zip(*strips)])


if __name__ == "__main__":
    main()
