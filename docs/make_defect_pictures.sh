#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# make_defect_pictures.sh [PENUMBRA [WHAT]]: the pictures and the tables of docs/defects.md; WHAT: pictures, tables or all.
# Pictures: scenes/broken.json by four methods. Tables: each defect of the generator on a floor, under a square light, and
# what each method gets wrong: methods of light samples and maps against ray casting on the same 64 light samples
# (variant=forest: 16), shadow volumes against the exact areas.
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
penumbra=${1:-$root/build/penumbra}
what=${2:-all}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

pictures() {
  for method in view-sample accumulate pcss shadow-map; do
    options=(--method "$method")
    if [[ $method != view-sample ]]; then options+=(--method-option size=256); fi
    "$penumbra" render "$root/scenes/broken.json" -o "$work/picture.exr" --png "$root/docs/images/defects-$method.png" \
      --size 320x240 --quiet "${options[@]}"
  done
}

scene() {  # DEFECT
  cat > "$work/scene.json" <<SCENE
{ "format": "penumbra-scene/1", "size": [192, 144],
  "camera": {"eye": [-1.6, 2.2, 2.6], "target": [0.15, 0.45, 0], "verticalFov": 40},
  "meshes": [
    {"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [3, 0, 0], "halfV": [0, 0, -3]}},
    {"name": "part", "shape": {"type": "broken", "defects": ["$1"], "size": 4, "center": [0, 0.6, 0], "halfExtent": 0.5}}],
  "lights": [
    {"name": "key", "rectangle": {"center": [-1.5, 4, 0.5], "halfU": [0.4, 0, 0], "halfV": [0, 0, 0.4]}}]}
SCENE
}

compare() {  # LIGHT-SAMPLES METHODS REFERENCE-OPTION...
  "$penumbra" compare "$work/scene.json" -o "$work/out" --methods "$2" --light-samples "$1" "${@:3}" --runs 1 --quiet
}

masks() {  # DEFECT: pairs that differ, of five methods; and of maps, the RMSE
  {
    compare 64 view-sample,edge-scatter,depth-complexity,depth-complexity:variant=laine,accumulate,pcss,shadow-map \
      --reference-samples same
    compare 16 depth-complexity:variant=forest --reference-samples same
  } | awk -v defect="$1" '$1 != "reference" { rmse[$1] = $2; differing[$1] = $5; pairs[$1] = $6 }
      END { printf "| `%s` | %s | %s | %s | %s | %s | %s of %s | %.4f | %.4f | %.4f |\n", defect, differing["view-sample"],
            differing["edge-scatter"], differing["depth-complexity"], differing["depth-complexity:variant=laine"],
            differing["depth-complexity:variant=forest"], differing["accumulate"], pairs["accumulate"],
            rmse["accumulate"], rmse["pcss"], rmse["shadow-map"] }'
}

volumes() {  # DEFECT: RMSE of shadow volumes
  compare 64 soft-volume,soft-volume-blend,wedge-ramp,hard-volume --reference exact |
    awk -v defect="$1" '$1 != "reference" { rmse[$1] = $2; most[$1] = $3 }
      END { printf "| `%s` | %.4f, %.2f | %.4f, %.2f | %.4f, %.2f | %.4f, %.2f |\n", defect,
            rmse["soft-volume"], most["soft-volume"], rmse["soft-volume-blend"], most["soft-volume-blend"],
            rmse["wedge-ramp"], most["wedge-ramp"], rmse["hard-volume"], most["hard-volume"] }'
}

tables() {
  local defects=(none inside-out flipped-patch duplicate-face opposite-face doubled-box unmerged t-junction crack gap lost-gap
    collinear repeated-vertex needle lid hollow hole holes fin spikes shared-edge bowtie crossing-sheets loose-triangles)
  echo "| part | view-sample | edge-scatter | depth-complexity | laine | forest | accumulate | RMSE | pcss: RMSE | shadow-map: RMSE |"
  echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
  for defect in "${defects[@]}"; do scene "$defect" && masks "$defect"; done
  echo
  echo "| part | soft-volume: RMSE, max | soft-volume-blend | wedge-ramp | hard-volume |"
  echo "| --- | --- | --- | --- | --- |"
  for defect in "${defects[@]}"; do scene "$defect" && volumes "$defect"; done
}

if [[ $what != tables ]]; then pictures; fi
if [[ $what != pictures ]]; then tables; fi
