#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# run.sh SOURCE BUILD TARGET SECONDS: runs a fuzz target with libFuzzer. Builds the preset `fuzz` in BUILD/fuzz, unless
# BUILD is already such a build. Failing inputs are written to BUILD/fuzz_findings, new corpus inputs to
# BUILD/fuzz_corpus.
set -euo pipefail
source=$1 build=$2 target=$3 seconds=$4
if ! grep -q '^PENUMBRA_FUZZ:BOOL=ON' "$build/CMakeCache.txt"; then
  build=$build/fuzz
  cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_C_COMPILER=clang \
    -DCMAKE_CXX_COMPILER=clang++ -DPENUMBRA_SANITIZE=address,undefined -DPENUMBRA_FUZZ=ON -DPENUMBRA_BENCH=OFF
  cmake --build "$build" --target "fuzz_$target"
fi
corpus=$build/fuzz_corpus/$target
mkdir -p "$corpus" "$build/fuzz_findings"
arguments=(-max_total_time="$seconds" -timeout=60 -rss_limit_mb=4096 -max_len=4096 -print_final_stats=1
           -artifact_prefix="$build/fuzz_findings/$target-")
if [[ -f $source/tests/fuzz/$target.dict ]]; then arguments+=(-dict="$source/tests/fuzz/$target.dict"); fi
exec "$build/fuzz_$target" "${arguments[@]}" "$corpus" "$source/tests/fuzz/corpus/$target"
