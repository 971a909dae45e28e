#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, and runs penumbra with the given arguments. Paths are relative to the current folder.
# Without arguments, the main job: compare geometry-based, image-based and reference methods on the default scene.
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")" && pwd)
build=$root/build
source "$root/cmake/bootstrap.sh"

install_packages
targets=(penumbra)
# The program that repairs meshes is built only if needed: it takes long to compile.
case " $* " in *" --repair"*) targets+=(penumbra-repair) ;; esac
build OFF "${targets[@]}"
if (($# == 0)); then
  set -- compare "$root/scenes/bunny.json" -o out
  say "no arguments: running the main job, penumbra $*"
fi
exec "$build/penumbra" "$@"
