#!/bin/bash
# digests.sh BUILD [SCENE.json…]: one line a method and scene with a digest of the picture's channels and of the mask.
# Two builds whose lists are the same compute the same masks, V and beauty on this device:
#   bench/digests.sh build >before.txt; …; bench/digests.sh build | diff before.txt -
# A method that refuses a scene has its exit code instead. Without scenes: all that ship.
set -euo pipefail
export LC_ALL=C
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
build=${1:?usage: digests.sh BUILD [SCENE.json…]}
shift
if (($# == 0)); then
  for scene in "$root"/scenes/*.json; do [[ $scene == *.schema.json ]] || set -- "$@" "$scene"; done
fi
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT

# Each method with the options that choose other code; those that need another number of light samples say so.
entries=(
  edge-scatter:engine=native edge-scatter:engine=vulkan edge-scatter:rows=exact
  view-sample:engine=native view-sample:engine=vulkan
  depth-complexity depth-complexity:crop=off depth-complexity:variant=laine depth-complexity:variant=forest@16
  soft-volume soft-volume:coverage=table soft-volume:split=3 soft-volume:construction=tight soft-volume:wedges=host
  soft-volume:tests=both soft-volume-blend wedge-ramp hard-volume
  shadow-map pcf pcf:receiverPlane=off pcss vssm vssm:moments=lvsm vssm:moments=csm:filter=mip vssm:moments=esm
  vssm:moments=evsm:filter=n-buffer convolution occlusion-textures accumulate soft-shadow-map adaptive-light deep-penumbra layered-attenuation
  bitmask:size=128 backproject:size=128 backproject-peel:size=128 raytrace exact contour:size=128 packet:size=128
)

# render SCENE ENTRY PATTERN: prints its line.
digest() {
  local scene=$1 entry=$2 pattern=$3 samples=64 code=0 options=() out=$work/out.exr bits=$work/out.bits
  [[ $entry == *@* ]] && samples=${entry#*@}
  local words=() word
  IFS=: read -ra words <<<"${entry%@*}"
  for word in "${words[@]:1}"; do options+=(--method-option "$word"); done
  rm -f -- "$out" "$bits"
  local command=("$build/penumbra" --quiet render "$scene" -o "$out" --size 64x64 --method "${words[0]}" "${options[@]}"
                 --light-samples "$samples" --sample-pattern "$pattern")
  # A method without a mask refuses --bits, and is then asked for its picture alone.
  "${command[@]}" --bits "$bits" 2>/dev/null || "${command[@]}" 2>/dev/null || code=$?
  local picture="exit $code" mask=-
  if ((code == 0)); then picture=$("$build/exr_digest" "$out" | cut -d' ' -f1); fi
  if [[ -s $bits ]]; then mask=$(sha256sum <"$bits" | cut -c1-16); fi
  printf '%-20s %-36s %-6s %-16s %s\n' "$(basename "$scene" .json)" "$entry" "$pattern" "$picture" "$mask"
}

for scene in "$@"; do
  for entry in "${entries[@]}"; do digest "$scene" "$entry" rows; done
  for entry in view-sample depth-complexity accumulate raytrace; do digest "$scene" "$entry" sobol; done
done
