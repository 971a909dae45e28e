#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Runs clang-tidy over sources, and over those of our headers that they include; fails on any finding.
#   tidy.sh SOURCE BUILD           all sources, joined as for g++: a target's files as one
#   tidy.sh SOURCE BUILD changed   sources that this branch changed since it left its upstream; on the upstream itself,
#                                  those of the last commit
#   tidy.sh SOURCE BUILD PATTERN   sources whose path matches PATTERN, each alone
# A header is checked through the sources that include it; each finding is printed once. BUILD may have g++'s
# precompiled headers, which clang-tidy cannot use, so CMake makes the compile commands without them in BUILD/tidy.
# Nothing is compiled there; shaders embedded as headers are those of BUILD, so it must have been built. Exit 77:
# nothing to check. (The fifteen files of base took 11 CPU s as one; fourteen of other rooms took 140 s each, alone.)
set -euo pipefail
source=$(cd -- "$1" && pwd) build=$(cd -- "$2" && pwd) what=${3:-all}
most=6  # check at most this many changed sources: the test runs next to others
tidy=$(command -v clang-tidy-14 || command -v clang-tidy || true)
[[ $tidy ]] || { echo 'style: clang-tidy is not installed (packages.txt)' >&2; exit 1; }

# The sources that changed, and for a changed header one source that includes it.
changed_sources() {
  local base file
  base=$(git -C "$source" merge-base HEAD '@{upstream}' 2>/dev/null || true)
  if [[ -z $base || $base == "$(git -C "$source" rev-parse HEAD)" ]]; then base=HEAD~1; fi
  git -C "$source" diff --name-only --diff-filter=d "$base" -- '*.cpp' '*.hpp' 2>/dev/null | while read -r file; do
    case $file in
      *.hpp)
        if [[ -f $source/${file%.hpp}.cpp ]]; then echo "${file%.hpp}.cpp"
        else git -C "$source" grep -lF "#include \"$file\"" -- '*.cpp' | head -1; fi ;;
      *) echo "$file" ;;
    esac
  done | sort -u
}

found=$(mktemp)
trap 'rm -f "$found"' EXIT
alone=$build/tidy join=OFF
if [[ $what == all ]]; then alone=$build/tidy-joined join=ON; fi
cmake -S "$source" -B "$alone" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPENUMBRA_TESTS=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON \
  -DPENUMBRA_JOIN=$join >"$build/tidy.log" 2>&1 || { cat "$build/tidy.log" >&2; exit 1; }
sed -i "s,$alone/shaders,$build/shaders,g" "$alone/compile_commands.json"
sources=$(sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' "$alone/compile_commands.json" | sort -u | grep -F "$source/")
options=()
case $what in
  all)  # sources of this tree, or joined files; findings in these count
    sources=$(grep -vF "$build/" <<<"$sources"; grep -F /Unity/ <<<"$sources")
    options=(--checks=-bugprone-suspicious-include "--header-filter=^$source/(app|areas|base|bench|compare|engines|hybrids|import|maps|mesh|network|reference|render|repair|scenes|selftest|session|tests|visibility|volumes|vsm)/") ;;
  changed)
    wanted=$(changed_sources || true)  # nothing if there is no history, as in a shallow clone
    sources=$(grep -vF "$build/" <<<"$sources" | grep -Fxf <(sed "s,^,$source/," <<<"$wanted") || true)
    [[ $sources && $wanted ]] || { echo 'style: no source changed'; exit 77; }
    if (($(wc -l <<<"$sources") > most)); then
      echo "style: $(wc -l <<<"$sources") sources changed; only the first $most are looked at here (all: ctest -L full -R style.tidy)"
      sources=$(head -n "$most" <<<"$sources")
    fi ;;
  *) sources=$(grep -vF "$build/" <<<"$sources" | grep -E -- "$what") ;;
esac
xargs -d '\n' -P "$(nproc)" -n 1 "$tidy" -p "$alone" --quiet "${options[@]}" <<<"$sources" >>"$found" 2>/dev/null || true
findings=$(grep -E '(warning|error): ' "$found" | sort -u || true)
echo "style: $(wc -l <<<"$sources") sources"
[[ -z $findings ]] && exit 0
printf '%s\n' "$findings" >&2
exit 1
