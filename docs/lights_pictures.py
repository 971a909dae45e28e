#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes docs/images/lights.png: scenes/lights.json under each of its seven lights alone, side by side, rendered without light
samples. Needs only Python's standard library.

  docs/lights_pictures.py [build/penumbra]          a few seconds"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "docs" / "figures"))
from png import read_png, write_png  # noqa: E402

SIZE = 200
SCENE = ROOT / "scenes/lights.json"


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/penumbra"
    strips = []
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        for light in json.loads(SCENE.read_text())["lights"]:
            subprocess.run([program, "--quiet", "render", SCENE, "-o", work / "out.exr", "--png", work / "out.png",
                            "--light", light["name"], "--size", f"{SIZE}x{SIZE}"], check=True)
            strips.append(read_png((work / "out.png").read_bytes()))
    gap = b"\xff" * 3 * 4
    write_png(ROOT / "docs/images/lights.png", [gap.join(lines) for lines in zip(*strips)])


if __name__ == "__main__":
    main()
