#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# docs/images/coverage-explain.svg: a light as one view sample sees it past a box and a leaning board, drawn by
# `wedges --explain`. Usage: docs/coverage_pictures.sh [PROGRAM]
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
program=${1:-$root/build/penumbra}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cat > "$work/box-and-board.json" <<'SCENE'
{ "format": "penumbra-scene/1", "size": [480, 360],
  "camera": {"eye": [4.2, 3.1, 5.2], "target": [0.1, 0.9, 0], "verticalFov": 36},
  "meshes": [
    {"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [4, 0, 0], "halfV": [0, 0, -4]}},
    {"name": "box", "shape": {"type": "box", "center": [0, 0.5, 0], "halfSize": [0.5, 0.5, 0.5]},
     "transform": {"rotate": [0, 30, 0]}},
    {"name": "board", "quad": {"center": [0.9, 1.2, 0.5], "halfU": [0.3, 0.1, 0], "halfV": [0, 0.15, -0.5]}}
  ],
  "lights": [{"name": "key", "rectangle": {"center": [-0.4, 3.2, -0.3], "halfU": [0.8, 0, 0], "halfV": [0, 0, 0.8]}}] }
SCENE
"$program" wedges "$work/box-and-board.json" --explain "${PIXEL:-260,275}" --svg "$root/docs/images/coverage-explain.svg"
