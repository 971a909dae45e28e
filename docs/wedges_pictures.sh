#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# docs/images/wedges-original.png and wedges-tight.png: the penumbra wedges of one slanted edge's triangle, exported by
# `wedges` and rendered by `render`. Usage: docs/wedges_pictures.sh [PROGRAM]
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
program=${1:-$root/build/penumbra}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

camera='"size": [480, 360], "camera": {"eye": [4.2, 3.1, 5.2], "target": [0.1, 0.9, 0], "verticalFov": 36}'
floor='{"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [2.4, 0, 0], "halfV": [0, 0, -2.4]}, "castsShadow": false, "color": [0.62, 0.62, 0.6]}'
strip='{"name": "strip", "triangles": [[-0.7,1.1,0.1, 0.7,1.7,-0.1, -0.7,1.1,0.12]], "color": [0.1, 0.1, 0.1]}'
light='"lights": [{"name": "key", "rectangle": {"center": [0, 3, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}, "radiance": [9, 9, 9]}]'

echo "{\"format\": \"penumbra-scene/1\", $camera, \"meshes\": [$floor, $strip], $light}" > "$work/cast.json"
for construction in original tight; do
  "$program" wedges "$work/cast.json" --construction "$construction" --validate --export "$work/wedges.glb"
  shown='{"name": "wedges", "file": "wedges.glb", "castsShadow": false, "color": [0.35, 0.55, 0.85]}'
  echo "{\"format\": \"penumbra-scene/1\", $camera, \"meshes\": [$floor, $strip, $shown], $light}" > "$work/show.json"
  "$program" --quiet render "$work/show.json" -o "$work/show.exr" --png "$root/docs/images/wedges-$construction.png"
done
