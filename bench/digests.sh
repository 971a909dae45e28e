#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# digests.sh BUILD [SCENE…]: prints one line per picture, with a digest of its channels and of its mask. Two builds with
# equal lists compute the same masks, V and beauty on this device:
#   bench/digests.sh build >before.txt; …; bench/digests.sh build | diff before.txt -
# Each method of `penumbra methods --json` renders every scene, and the scene with all kinds of lights under each single
# light; on one scene also with each choice of its options, and with another value of each number. If a method refuses,
# the line has its exit code instead of a digest. Without scenes, all scenes of scenes/ are rendered.
set -euo pipefail
export LC_ALL=C
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)

# --one BUILD SCENE LIGHT PATTERN ENTRY: prints the line of one picture; with all lights if LIGHT is `-`.
if [[ ${1:-} == --one ]]; then
  build=$2 scene=$3 light=$4 pattern=$5 entry=$6 samples=64 code=0 options=()
  work=$(mktemp -d)
  trap 'rm -rf -- "$work"' EXIT
  IFS=: read -ra words <<<"$entry"
  for word in "${words[@]:1}"; do options+=(--method-option "$word"); done
  if [[ $entry == *forest* || $entry == *counter-bits* ]]; then samples=16; fi  # the digests were taken with 16
  if [[ $scene == *.gltf ]]; then options+=(--frame 8 --lamp-radius 0.05 --sun-angle 2); fi  # in the midst of its animation
  if [[ $light != - ]]; then options+=(--light "$light"); fi
  command=("$build/penumbra" --quiet render "$scene" -o "$work/out.exr" --size 64x64 --method "${words[0]}" "${options[@]}"
           --light-samples "$samples" --sample-pattern "$pattern")
  # A method without a mask refuses --bits, and is then run again without it.
  "${command[@]}" --bits "$work/out.bits" 2>/dev/null || "${command[@]}" 2>/dev/null || code=$?
  picture="exit $code" mask=-
  if ((code == 0)); then picture=$("$build/exr_digest" "$work"/*.exr | cut -d' ' -f1); fi
  if compgen -G "$work/*.bits" >/dev/null; then mask=$(cat "$work"/*.bits | sha256sum | cut -c1-16); fi
  printf '%-16s %-6s %-6s %-52s %-16s %s\n' "$(basename "${scene%.*}")" "$light" "$pattern" "$entry" "$picture" "$mask"
  exit
fi

build=$(cd -- "${1:?usage: digests.sh BUILD [SCENE…]}" && pwd)
shift
if (($# == 0)); then
  for scene in "$root"/scenes/*.json "$root"/scenes/*.gltf; do [[ $scene == *.schema.json ]] || set -- "$@" "$scene"; done
fi
list=$(mktemp)
trap 'rm -f -- "$list"' EXIT
"$build/penumbra" methods --json | python3 -c '
import itertools, json, pathlib, sys

def another(number):
    """A value of an option that is a number, other than the one it has by itself."""
    least, most, whole = (number["range"][key] for key in ("least", "most", "whole"))
    default = float(number["default"])
    for value in (default / 2, default * 2, default + 1, (least + most) / 2):
        value = float(int(value)) if whole else value
        if least <= value <= most and value != default:
            return format(value, "g")

def show(scene, light, pattern, entry):
    sys.stdout.write("\0".join([str(scene), light, pattern, entry]) + "\0")

methods = json.load(sys.stdin)["methods"]
for method in methods:  # maps so small that loops over their texels end soon
    method["entry"] = method["name"] + (":size=128" if any(option["name"] == "size" for option in method["options"]) else "")
for scene in map(pathlib.Path, sys.argv[1:]):
    lights = ["-"]
    if scene.name == "lights.json":
        lights = [light["name"] for light in json.loads(scene.read_text())["lights"]]
    for light, method in itertools.product(lights, methods):
        show(scene, light, "rows", method["entry"])
        if method["output"] != "scalar" and method["anyPattern"]:
            show(scene, light, "sobol", method["entry"])
    if scene.name != "fusion.json":
        continue
    for method in methods:
        for option in method["options"]:
            values = option.get("choices") or ([another(option)] if option["name"] != "size" else [])
            for value in values:
                if value != option["default"]:
                    show(scene, "-", "rows", method["entry"] + ":" + option["name"] + "=" + value)
' "$@" >"$list"
xargs -0 -n 4 -P "$(nproc)" -a "$list" "$0" --one "$build" | sort
