#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# radiance_pictures.sh [PENUMBRA]: the pictures of docs/radiance.md: things in front of a panel that stands on the floor, by `exact`
# and by a method that knows only V. bench/page_tables.py has the scene, and makes the second table.
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
penumbra=${1:-$root/build/penumbra}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$root/bench/page_tables.py" --scene near-light > "$work/near-light.json"
for method in exact soft-volume; do
  "$penumbra" render "$work/near-light.json" -o "$work/picture.exr" --method "$method" --quiet \
    --png "$root/docs/images/radiance-$method.png"
done
