#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Runs the tests under ThreadSanitizer, with a TBB that is instrumented, too: otherwise every parallel loop would look
# like a race.
#   tests/sanitizers/thread.sh WORK [CTEST ARGS…]     default: -L quick -j2
# Fetches Debian's source of TBB (that needs a deb-src line for apt), builds it and the project into WORK, once.
set -euo pipefail

here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
source=$(cd -- "$here/../.." && pwd)
mkdir -p -- "$1"
work=$(cd -- "$1" && pwd)
shift

if ! compgen -G "$work/tbb/*/libtbb.so.12" >/dev/null; then
  (cd -- "$work" && apt-get source --download-only onetbb && rm -rf onetbb && dpkg-source -x onetbb_*.dsc onetbb)
  cmake -S "$work/onetbb" -B "$work/tbb" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTBB_SANITIZE=thread \
    -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF
  ninja -C "$work/tbb"
fi
libraries=("$work"/tbb/*/libtbb.so.12)

cmake -S "$source" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DPENUMBRA_SANITIZE=thread -DPENUMBRA_BENCH=OFF \
  "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g1 -DNDEBUG" -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON \
  -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++
ninja -C "$work/build"

(($#)) || set -- -L quick -j2
export LD_LIBRARY_PATH=${libraries[0]%/*}
export TSAN_OPTIONS="suppressions=$here/thread.supp:ignore_noninstrumented_modules=1:second_deadlock_stack=1"
exec ctest --test-dir "$work/build" --timeout 3600 "$@"
