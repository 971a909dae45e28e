#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# radiance_pictures.sh [PENUMBRA]: the pictures and the second table of docs/radiance.md. Pictures: things before a panel
# that stands on the floor, by `exact` and by a method that knows only V. Table: error of the beauty against `exact`.
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
penumbra=${1:-$root/build/penumbra}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cat > "$work/near-light.json" <<'SCENE'
{ "format": "penumbra-scene/1", "size": [360, 270],
  "camera": {"eye": [0.3, 3, 1.3], "target": [0.1, 0, -0.2], "verticalFov": 38},
  "meshes": [
    {"name": "floor", "quad": {"center": [0, 0, 0.5], "halfU": [2.5, 0, 0], "halfV": [0, 0, -1.5]}},
    {"name": "board", "quad": {"center": [-0.6, 0.25, -0.7], "halfU": [0.25, 0, 0.1], "halfV": [0, 0.25, 0]}},
    {"name": "post", "quad": {"center": [0.15, 0.6, -0.75], "halfU": [0.06, 0, 0], "halfV": [0, 0.6, 0]}},
    {"name": "shelf", "quad": {"center": [0.8, 0.12, -0.65], "halfU": [0.3, 0, 0], "halfV": [0, 0.03, 0.2]}}
  ],
  "lights": [{"name": "panel", "rectangle": {"center": [0, 0.61, -1.01], "halfU": [1.2, 0, 0], "halfV": [0, 0.6, 0]},
              "radiance": [6, 5.8, 5.4]}] }
SCENE
for method in exact soft-volume; do
  "$penumbra" render "$work/near-light.json" -o "$work/picture.exr" --method "$method" --quiet \
    --png "$root/docs/images/radiance-$method.png"
done

echo "| scene | method | 16 | 64 | 256 | 1024 |"
echo "| --- | --- | --- | --- | --- | --- |"
row() {  # SCENE METHOD PATTERN: relative RMSE of the beauty at four numbers of light samples
  local cells=""
  for samples in 16 64 256 1024; do
    "$penumbra" compare "$1" -o "$work/out" --methods "$2" --light-samples "$samples" --sample-pattern "$3" \
      --size 256x192 --reference exact --quiet > "$work/table"
    cells+=" $(sed -n 's/.*"relativeRmse": \([0-9.e-]*\).*/\1/p' "$work/out/metrics.json" | xargs printf '%.4f') |"
  done
  echo "| $(basename "$1" .json) | $2, $3 |$cells"
}
for scene in "$work/near-light.json" "$root/scenes/contact.json" "$root/scenes/parallel-square.json"; do
  for pattern in rows jittered; do row "$scene" raytrace "$pattern"; done
  row "$scene" soft-volume rows
done
