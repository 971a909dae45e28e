#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Runs the program under AddressSanitizer and UndefinedBehaviorSanitizer: every method on the shipped scenes, and every
# command once. For CI, where the whole suite under sanitizers (preset asan-ubsan, half an hour of two cores) would take
# too long.
#   smoke.sh SOURCE WORK          builds `penumbra` and `penumbra-import` into WORK, and runs them there
#   smoke.sh SOURCE WORK run      runs what was built
# Any report is a failure, and so is an exit code other than 0. terrain-1m is left out: its two million triangles would
# take minutes here.
set -euo pipefail
source=$(cd -- "$1" && pwd)
mkdir -p -- "$2"
work=$(cd -- "$2" && pwd)
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)

if [[ ${3:-} != run ]]; then
  # With little optimisation, so that it compiles faster.
  cmake -S "$source" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DPENUMBRA_SANITIZE=address,undefined \
    -DPENUMBRA_BENCH=OFF -DPENUMBRA_TESTS=OFF "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g1 -DNDEBUG" >"$work/configure.log"
  ninja -C "$work/build" penumbra penumbra-import
fi
export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1:detect_stack_use_after_return=1
export LSAN_OPTIONS=suppressions=$here/leak.supp:print_suppressions=0 UBSAN_OPTIONS=print_stacktrace=1

failed=0
# check NAME ARGUMENTS…: runs the program, which must end with 0 and without a report.
check() {
  local name=$1 begin=$SECONDS code=0
  shift
  "$work/build/penumbra" "$@" >"$work/$name.out" 2>"$work/$name.log" || code=$?
  if ((code != 0)) || grep -qE 'ERROR: (Address|Leak)Sanitizer|runtime error:|penumbra: error' "$work/$name.log"; then
    echo "sanitizers: $name: exit code $code" >&2
    grep -E -m 20 'Sanitizer|runtime error|error|^ +#[0-9] ' "$work/$name.log" >&2 || tail -5 "$work/$name.log" >&2
    failed=1
  else
    echo "sanitizers: $name: $((SECONDS - begin)) s"
  fi
}

for scene in "$source"/scenes/*.json; do
  name=$(basename "$scene" .json)
  [[ $name == terrain-1m || $name == *.schema ]] && continue
  check "$name" compare "$scene" -o "$work/$name" --methods all --method-option size=128 --size 16x16 --light-samples 16 \
    --reference-samples 16 --runs 1 --device cpu --png
  # All lights, evaluated as areas and as samples of each kind.
  check "$name-areas" render "$scene" -o "$work/$name.exr" --size 24x16 --png "$work/$name.png" --stats "$work/$name-stats.json"
  check "$name-exact" render "$scene" -o "$work/$name.exr" --size 24x16 --method exact
done
# View samples on edges, triangles without area, and lights that the receiver's plane touches or cuts.
for light in '"rectangle": {"center": [-0.75, 5, 0.25], "halfU": [1, 0, 0], "halfV": [0, 0, 1]}' \
  '"sphere": {"center": [-0.375, -0.25, 0], "radius": 0.25}' '"sphere": {"center": [0.5, 0.125, 1.5], "radius": 0.5}' \
  '"disk": {"center": [0, 1, 0], "normal": [1, 0, 0], "radius": 1}' '"sun": {"direction": [0, 2, -1], "angle": 90}'; do
  cat >"$work/edges.json" <<JSON
{"format": "penumbra-scene/1", "size": [16, 16], "camera": {"eye": [0, 1, 0], "target": [0, 0, 0], "up": [0, 0, -1], "verticalFov": 90},
 "meshes": [{"name": "floor", "triangles": [[2, 0, 2, 2, 0, 0, -2, 0, -2], [-2, 0, -2, -2, 0, 2, 2, 0, 2], [0, 0.5, 0, 1, 0.5, 0, 2, 0.5, 0]]},
  {"name": "board", "triangles": [[0, 0.5, 0, 0.5, 0.5, 0, 0, 0.5, 0.5], [-1, 0, -1, -1, 1, 0, -1, 0, 1]]}],
 "lights": [{"name": "k", $light}]}
JSON
  check edges compare "$work/edges.json" -o "$work/edges" --methods all --method-option size=128 --light-samples 16 \
    --reference-samples 16 --runs 1 --device cpu
done
lights=$source/scenes/lights.json
check samples render "$lights" -o "$work/s.exr" --size 24x16 --sample-pattern sobol --light-samples 16 --pixel-samples 4
check convert convert "$lights" -o "$work/lights.glb"
check convert-back convert "$work/lights.glb" -o "$work/lights-again.json"
check inspect inspect "$work/lights.glb" --json "$work/inspect.json"
check wedges wedges "$source/scenes/room.json" --validate --json "$work/wedges.json"
check sweep sweep "$lights" -o "$work/sweep" --size 16x16 --light ball --methods edge-scatter,raytrace --over light-samples=4,16 --over light.half=0.2 \
  --runs 1 --device cpu
check frames compare "$source/scenes/leaves.gltf" -o "$work/frames" --size 16x12 --methods edge-scatter,depth-complexity --frames 0-2 --runs 1 --device cpu
# Instances without copies, under a sun and under a dome; moments of an open shutter; points of a lightmap.
for moment in 0 0.1; do
  cat >"$work/balls-$moment.json" <<JSON
{"format": "penumbra-scene/1", "size": [24, 16], "camera": {"eye": [0, 2, 6], "target": [0, 0.5, 0], "verticalFov": 45},
 "meshes": [{"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [4, 0, 0], "halfV": [0, 0, -4]}},
  {"name": "ball", "shape": {"type": "sphere", "center": [$moment, 0.5, 0], "radius": 0.3, "segments": 32},
   "instances": [{"transform": {"translate": [-1, 0, 0]}}, {"transform": {"translate": [0, 0, 1], "scale": 0.7}}, {"transform": {"translate": [1, 0, 0]}}]}],
 "lights": [{"name": "sun", "sun": {"direction": [-0.35, -0.87, -0.35], "angle": 2}}, {"name": "sky", "dome": {}}]}
JSON
done
check instances render "$work/balls-0.json" -o "$work/balls.exr" --instances shared --light-samples 16
check instances-areas render "$work/balls-0.json" -o "$work/balls.exr" --instances shared --light sun
check dome-rays render "$work/balls-0.json" -o "$work/balls.exr" --method raytrace --light-samples 16
check moments render "$work/balls-0.json" -o "$work/balls.exr" --moment "$work/balls-0.1.json" --pixel-samples 4
check bake bake "$work/balls-0.json" --mesh floor --vertices -o "$work/floor.ply"
check methods methods --json
check self-test devices --self-test --device cpu
exit $failed
