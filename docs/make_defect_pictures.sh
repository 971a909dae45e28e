#!/bin/bash
# make_defect_pictures.sh [PENUMBRA]: the pictures and the table of docs/defects.md.
# Pictures: scenes/broken.json by four methods. Table: each defect of the generator on a floor, under a square light, and
# what each method gets wrong against ray casting on the same 64 light samples.
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
penumbra=${1:-$root/build/penumbra}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for method in view-sample accumulate pcss shadow-map; do
  options=(--method "$method")
  if [[ $method != view-sample ]]; then options+=(--method-option size=256); fi
  "$penumbra" render "$root/scenes/broken.json" -o "$work/picture.exr" --png "$root/docs/images/defects-$method.png" \
    --size 320x240 --quiet "${options[@]}"
done

row() {  # DEFECT: | defect | differing pairs of view-sample, accumulate | RMSE of accumulate, pcss, shadow-map |
  cat > "$work/scene.json" <<SCENE
{ "format": "penumbra-scene/1", "size": [192, 144],
  "camera": {"eye": [-1.6, 2.2, 2.6], "target": [0.15, 0.45, 0], "verticalFov": 40},
  "meshes": [
    {"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [3, 0, 0], "halfV": [0, 0, -3]}},
    {"name": "part", "shape": {"type": "broken", "defects": ["$1"], "size": 4, "center": [0, 0.6, 0], "halfExtent": 0.5}}],
  "lights": [
    {"name": "key", "rectangle": {"center": [-1.5, 4, 0.5], "halfU": [0.4, 0, 0], "halfV": [0, 0, 0.4]}}]}
SCENE
  "$penumbra" compare "$work/scene.json" -o "$work/out" --methods view-sample,accumulate,pcss,shadow-map \
    --light-samples 64 --reference-samples same --quiet |
    awk -v defect="$1" '{ rmse[$1] = $2; differing[$1] = $5; pairs[$1] = $6 }
      END { printf "| `%s` | %s | %s of %s | %.4f | %.4f | %.4f |\n", defect, differing["view-sample"],
            differing["accumulate"], pairs["accumulate"], rmse["accumulate"], rmse["pcss"], rmse["shadow-map"] }'
}
echo "| part | view-sample: pairs | accumulate: pairs | RMSE | pcss: RMSE | shadow-map: RMSE |"
echo "| --- | --- | --- | --- | --- | --- |"
for defect in none inside-out flipped-patch duplicate-face opposite-face doubled-box unmerged t-junction crack gap lost-gap \
  collinear repeated-vertex needle lid hollow hole holes fin spikes shared-edge bowtie crossing-sheets loose-triangles; do
  row "$defect"
done
