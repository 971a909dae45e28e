#!/bin/bash
# Fails if clang-format would change any C++ source or header, structs that shaders share among them.
#   format.sh SOURCE          names what it would change
#   format.sh SOURCE --write  changes it
set -euo pipefail
cd -- "$1"
format=$(command -v clang-format-14 || command -v clang-format || true)
[[ $format && $("$format" --version) == *' 14.'* ]] || { echo 'style: clang-format 14 is not installed (packages.txt)' >&2; exit 1; }
rooms=(app areas base bench cmake compare engines examples hybrids import include library maps mesh network python reference render repair scenes selftest tests visibility volumes vsm)
options=(--dry-run --Werror)
[[ ${2:-} == --write ]] && options=(-i)
find "${rooms[@]}" -type f \( -name '*.cpp' -o -name '*.hpp' -o -name '*.h' \) -print0 | xargs -0 -n 50 -P 2 "$format" "${options[@]}"
