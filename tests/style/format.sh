#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Fails if clang-format would change any C++ source or header, including structs that shaders share.
#   format.sh SOURCE          names what it would change
#   format.sh SOURCE --write  changes it
set -euo pipefail
cd -- "$1"
format=$(command -v clang-format-14 || command -v clang-format || true)
[[ $format && $("$format" --version) == *' 14.'* ]] || { echo 'style: clang-format 14 is not installed (packages.txt)' >&2; exit 1; }
rooms=(app areas base bench cmake compare engines examples hybrids import include library maps mesh network python reference render repair scenes selftest session tests visibility volumes vsm)
sources() { find "${rooms[@]}" -type f \( -name '*.cpp' -o -name '*.hpp' -o -name '*.h' \) -print0; }
check() { xargs -0 -n 50 -P 2 "$format" --dry-run --Werror "$@"; }
if [[ ${2:-} == --write ]]; then
  # Writes only files that change: with a new time stamp, the others would be compiled again.
  sources | check 2>&1 | sed -n 's/^\([^:]*\):[0-9]*:[0-9]*: error: .*/\1/p' | sort -u | tr '\n' '\0' | xargs -0 -r "$format" -i
else
  sources | check
fi
