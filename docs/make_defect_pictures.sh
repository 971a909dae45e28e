#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# make_defect_pictures.sh [PENUMBRA]: the pictures of docs/defects.md: scenes/broken.json by four methods. bench/page_tables.py
# makes the tables.
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
