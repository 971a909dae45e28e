#!/bin/bash
# clang-tidy over every source, and over every header of ours that those include: any finding fails.
#   tidy.sh SOURCE BUILD [PATTERN]  PATTERN: sources whose path it fits
# A header is looked at through the sources that include it; each finding is printed once. BUILD may join sources and have
# g++'s precompiled headers, neither of which clang-tidy can use: how each source is compiled alone is asked of CMake in
# BUILD/tidy. Nothing is compiled there; shaders embedded as headers are BUILD's, so it must have been built.
set -euo pipefail
source=$(cd -- "$1" && pwd) build=$(cd -- "$2" && pwd) pattern=${3:-.}
tidy=$(command -v clang-tidy-14 || command -v clang-tidy || true)
[[ $tidy ]] || { echo 'style: clang-tidy is not installed (packages.txt)' >&2; exit 1; }
found=$(mktemp)
trap 'rm -f "$found"' EXIT
alone=$build/tidy
cmake -S "$source" -B "$alone" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >"$build/tidy.log" 2>&1 ||
  { cat "$build/tidy.log" >&2; exit 1; }
sed -i "s,$alone/shaders,$build/shaders,g" "$alone/compile_commands.json"
# Of this tree and not made by the build.
sources=$(sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' "$alone/compile_commands.json" | sort -u |
  grep -F "$source/" | grep -vF "$build/" | grep -E -- "$pattern")
xargs -d '\n' -P "$(nproc)" -n 1 "$tidy" -p "$alone" --quiet <<<"$sources" >>"$found" 2>/dev/null || true
findings=$(grep -E '(warning|error): ' "$found" | sort -u || true)
echo "style: $(wc -l <<<"$sources") sources"
[[ -z $findings ]] && exit 0
printf '%s\n' "$findings" >&2
exit 1
