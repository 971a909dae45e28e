#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests bench/error_chart.py on lines written by hand: marks are where seconds and errors put them, and results that
cannot be drawn are counted."""
import json
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as tree

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "bench" / "error_chart.py"
SVG = "{http://www.w3.org/2000/svg}"
LINES = [  # subject, method, light samples, seconds, RMSE
    ("a_scene", "edge-scatter", 64, 0.01, 0.1), ("a_scene", "edge-scatter", 256, 0.1, 0.001), ("a_scene", "exact & right", 256, 2, 0),
    ("b<b>", "edge-scatter", 64, 1, 0.01)]


def line(scene, method, samples, seconds, rmse):
    return {"name": f"{scene}/{method}", "scene": scene, "method": method, "samples": samples, "shadow": {"median": seconds},
            "errorToReference": {"rmse": rmse, "reference": "exact"}}


def draw(lines, folder):
    source, out = folder / "lines.jsonl", folder / "out.svg"
    source.write_text("".join(json.dumps(one) + "\n" for one in lines), encoding="utf-8")
    return subprocess.run([sys.executable, PROGRAM, source, out], capture_output=True, text=True, check=False), out


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        done, out = draw([line(*one) for one in LINES] + [{"name": "no reference", "scene": "a_scene"}], folder)
        assert done.returncode == 0, done.stderr
        root = tree.parse(out).getroot()
        texts = ["".join(text.itertext()) for text in root.iter(SVG + "text")]
        for wanted in ("a_scene", "b<b>", "exact & right", "1 points without error are not shown", "RMSE of V to exact; numbers are light samples"):
            assert wanted in texts, (wanted, texts)
        # The axes span 0.01 to 1 s and 0.001 to 0.1; a plot is 340 × 250 pixels at 62, 56 + 2 · 18 + 40, the second one
        # 420 further right.
        x = {0.01: 62, 0.1: 62 + 170, 1: 62 + 420 + 340}
        y = {0.1: 132, 0.001: 132 + 250, 0.01: 132 + 125}
        circles = {(float(c.get("cx")), float(c.get("cy"))) for c in root.iter(SVG + "circle")}
        for _, _, _, seconds, rmse in (LINES[0], LINES[1], LINES[3]):
            assert (x[seconds], y[rmse]) in circles, (seconds, rmse, circles)
        for wanted in ("64", "256"):
            assert wanted in texts, f"light samples beside the marks: {wanted}"
        done, _ = draw([line("a", "exact", 256, 1, 0)], folder)
        assert done.returncode == 1 and "no line has an error" in done.stderr, done.stderr


main()
