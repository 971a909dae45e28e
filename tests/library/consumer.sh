#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# consumer.sh BUILD SOURCE WORK: installs the build into WORK, builds a project outside the tree with it, by
# find_package and by pkg-config, and runs both. The library must export nothing but its interface.
set -euo pipefail
build=$1 source=$2 work=$3
rm -rf -- "$work"
mkdir -p -- "$work"
cmake --install "$build" --prefix "$work/installed" >"$work/install.log"
library=$(find "$work/installed" -name 'libpenumbra.so')
strangers=$(nm -D --defined-only -C "$library" | cut -d' ' -f2- | grep -vE '^[A-Za-z] (penumbra::|(typeinfo|typeinfo name|vtable) for penumbra::)' || true)
if [[ -n $strangers ]]; then echo "libpenumbra shows what is not its interface:" && head -20 <<<"$strangers" && exit 1; fi
cmake -S "$source/tests/library/consumer" -B "$work/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/installed" >"$work/configure.log"
ninja -C "$work/build" >"$work/build.log" || { cat "$work/build.log"; exit 1; }
"$work/build/consumer" "$source/scenes/room.json"
export PKG_CONFIG_PATH=$(dirname "$library")/pkgconfig
g++ "$source/tests/library/consumer/main.cpp" $(pkg-config --cflags --libs penumbra) -Wl,-rpath,"$(dirname "$library")" -o "$work/by_pkg_config"
"$work/by_pkg_config" "$source/scenes/room.json"
cmake -S "$source/examples/own_method" -B "$work/own_method" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/installed" >"$work/configure.log"
ninja -C "$work/own_method" >"$work/build.log" || { cat "$work/build.log"; exit 1; }
"$work/own_method/own_method" "$source/scenes/contact.json" -o "$work/compared" >"$work/metrics.json"
for name in gathering pcss; do grep -q "\"method\": \"$name\"" "$work/metrics.json" || { echo "no $name in $work/metrics.json"; exit 1; }; done
[[ -s $work/compared/report.html ]]
PENUMBRA=$work/installed/bin/penumbra
"$PENUMBRA" --quiet render "$source/scenes/bunny.json" -o "$work/out.exr" --size 8x8  # it must find its import helper
repair=$work/installed/bin/penumbra-repair
if [[ -e $repair ]]; then "$PENUMBRA" --quiet inspect "$source/scenes/room.json" --repair "$work/repaired.ply" >"$work/repair.log"; fi
