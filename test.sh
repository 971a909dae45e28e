#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, and runs the tests with ctest: label `quick`, or those selected by the arguments
# (./test.sh -L full, ./test.sh -R layering, ./test.sh -R Suite.Test).
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")" && pwd)
build=$root/build
source "$root/cmake/bootstrap.sh"

case " $* " in
  *" full "* | *" -R blender"* | *" -R "*Slurm* | *" -R packages"*) install_packages full ;;
  *) install_packages all ;;
esac
build ON all
if (($# == 0)); then set -- -L quick; fi
# ctest lists suites. If none matches the arguments, they may name a single test, as printed by a failure.
if [[ $(ctest --test-dir "$build" -N "$@") == *'Total Tests: 0'* ]]; then export PENUMBRA_SINGLE_TESTS=1; fi
# GPU tests on the processor already use all cores: more than two at once only make each slower.
ctest --test-dir "$build" --output-on-failure --no-tests=error --parallel 2 "$@" | never_silent 'tests are running'
