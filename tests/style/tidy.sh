#!/bin/bash
# clang-tidy over every source that a build compiles, and over every header of ours that those include: any finding fails.
#   tidy.sh SOURCE BUILD [PATTERN]  PATTERN: sources whose path it fits
# A header is looked at through the sources that include it; each finding is printed once.
set -euo pipefail
source=$(cd -- "$1" && pwd) build=$(cd -- "$2" && pwd) pattern=${3:-.}
tidy=$(command -v clang-tidy-14 || command -v clang-tidy || true)
[[ $tidy ]] || { echo 'style: clang-tidy is not installed (packages.txt)' >&2; exit 1; }
found=$(mktemp)
trap 'rm -f "$found"' EXIT
# Of this tree and not made by the build.
sources=$(sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' "$build/compile_commands.json" | sort -u |
  grep -F "$source/" | grep -vF "$build/" | grep -E -- "$pattern")
xargs -d '\n' -P "$(nproc)" -n 1 "$tidy" -p "$build" --quiet <<<"$sources" >>"$found" 2>/dev/null || true
findings=$(grep -E '(warning|error): ' "$found" | sort -u || true)
echo "style: $(wc -l <<<"$sources") sources"
[[ -z $findings ]] && exit 0
printf '%s\n' "$findings" >&2
exit 1
