#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Plants each fault of faults.txt into a copy of the tree, builds what is needed and runs the tests that should fail.
#   run.sh match SOURCE               tests whether every fault still fits the tree. Builds nothing.
#   run.sh plant SOURCE WORK [NAME…]  plants all faults, or those whose names contain one of the NAMEs; prints a table.
#                                     Objects that an earlier run built in WORK are used again.
# Exits with 1 if a fault does not fit or does not compile, if a test fails without a fault, or if a fault survives (no
# test fails). See README.md.
set -euo pipefail

here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
mode=$1 source=$(cd -- "$2" && pwd)
full='*Full:*Full.*:*Full/*:MapsTable.*'  # tests of label full, which are not run
names=() files=() olds=() news=() targets=() filters=()

say() { printf '%s\n' "$*" >&2; }

read_faults() {
  local key rest
  while IFS= read -r line || [[ -n $line ]]; do
    [[ -z $line || $line == '#'* ]] && continue
    key=${line%% *} rest=${line#* }
    case $key in
      fault) names+=("$rest") ;;
      file) files+=("$rest") ;;
      old) olds+=("$rest") ;;
      new) news+=("$rest") ;;
      test) targets+=("${rest%% *}") filters+=("${rest#* }") ;;
      *) say "faults.txt: what is '$line'?"; exit 1 ;;
    esac
  done <"$here/faults.txt"
  local count=${#names[@]}
  if ((${#files[@]} != count || ${#olds[@]} != count || ${#news[@]} != count || ${#targets[@]} != count)); then
    say "faults.txt: every fault has a file, an old, a new and a test line"; exit 1
  fi
}

# Fails unless the old text is in the file exactly once, on one line.
fits() {
  local found
  found=$(grep -cF -- "${olds[$1]}" "$source/${files[$1]}" || true)
  [[ $found == 1 ]] && return
  say "${names[$1]}: '${olds[$1]}' is on ${found:-0} lines of ${files[$1]}, not on one"
  return 1
}

fit_all() {
  local bad=0 i
  for i in "${!names[@]}"; do fits "$i" || bad=1; done
  return $bad
}

# swap FILE FROM TO: replaces the only occurrence of FROM, as plain text.
swap() {
  FROM=$2 TO=$3 perl -0777 -pi -e 's/\Q$ENV{FROM}\E/$ENV{TO}/' "$1"
}

# CMAKE_BUILD_PARALLEL_LEVEL chooses the number of jobs here.
build() { cmake --build "$work/tree/build" --target "$@" >"$work/build.log" 2>&1; }
# passes EXECUTABLE FILTER: runs its quick tests up to the first that fails. Anything but success means that the fault
# is caught.
passes() {
  (cd "$work/tree/build" && timeout 1200 "./$1" --gtest_filter="$2-$full" --gtest_brief=1 --gtest_fail_fast) >"$work/test.log" 2>&1
}

# Makes $work/tree a copy of the source, without builds, their outputs and $work itself. Files that are the same already
# stay untouched, so that their objects stay valid.
copy_tree() {
  local file
  mkdir -p "$work/tree/build"  # inside the tree, as builds mostly are, so that compiler caches recognise the files
  (cd "$source" && find . \( -name .git -o -path ./out -o -path ./.cache -o -samefile "$work" -o \
    -type d -exec test -e {}/CMakeCache.txt \; \) -prune -o -type f -printf '%P\0') | sort -z >"$work/files"
  while IFS= read -r -d '' file; do
    cmp -s "$source/$file" "$work/tree/$file" || (cd "$source" && cp --parents -t "$work/tree" -- "$file")
  done <"$work/files"
  (cd "$work/tree" && find . -path ./build -prune -o -type f -printf '%P\0') | sort -z | comm -z -13 "$work/files" - | (cd "$work/tree" && xargs -0r rm --)
}

# find_nothing_unplanted EXECUTABLE FILTER: fails unless every pattern of the filter matches a test, and all of these
# tests pass without a fault.
find_nothing_unplanted() {
  local pattern
  tr ':' '\n' <<<"$2" >"$work/patterns"
  while IFS= read -r pattern; do
    [[ $("$work/tree/build/$1" --gtest_list_tests --gtest_filter="$pattern-$full") == *'  '* ]] && continue
    say "$1 has no test '$pattern'"; exit 1
  done <"$work/patterns"
  passes "$1" "$2" && return
  tail -30 "$work/test.log" >&2
  say "$1 --gtest_filter=$2 fails without a fault"; exit 1
}

plant_all() {
  local survivors=0 i name status seconds
  local wanted=()
  for i in "${!names[@]}"; do
    ((${#only[@]} == 0)) && wanted+=("$i") && continue
    for name in "${only[@]}"; do [[ ${names[$i]} == *"$name"* ]] && wanted+=("$i") && break; done
  done
  ((${#wanted[@]} > 0)) || { say "no fault has such a name"; exit 1; }
  copy_tree
  # shellcheck disable=SC2086
  cmake -S "$work/tree" -B "$work/tree/build" -G Ninja -DCMAKE_BUILD_TYPE=Release ${PENUMBRA_CMAKE_OPTIONS:-} >"$work/configure.log"
  local needed tests
  needed=$(for i in "${wanted[@]}"; do echo "${targets[$i]}"; done | sort -u)
  # shellcheck disable=SC2086
  build $needed || { tail -30 "$work/build.log" >&2; say "the tree does not build even without a fault"; exit 1; }
  tests=$(for i in "${wanted[@]}"; do echo "${targets[$i]} ${filters[$i]}"; done | sort -u)
  while IFS= read -r name; do find_nothing_unplanted "${name%% *}" "${name#* }"; done <<<"$tests"
  printf '| fault | place | tests | |\n| --- | --- | --- | --- |\n'
  for i in "${wanted[@]}"; do
    seconds=$SECONDS
    swap "$work/tree/${files[$i]}" "${olds[$i]}" "${news[$i]}"
    status=caught
    if ! build "${targets[$i]}"; then
      status='**does not compile**'                       # not a fault that a program could have
    elif passes "${targets[$i]}" "${filters[$i]}"; then
      status='**survives**'
    fi
    [[ $status == caught ]] || survivors=$((survivors + 1))
    cp -f "$source/${files[$i]}" "$work/tree/${files[$i]}"
    printf '| %s | %s | %s %s | %s |\n' "${names[$i]}" "${files[$i]}" "${targets[$i]}" "${filters[$i]}" "$status"
    say "${names[$i]}: $status ($((SECONDS - seconds)) s)"
  done
  printf '%d of %d survive\n' "$survivors" "${#wanted[@]}"
  ((survivors == 0))
}

read_faults
fit_all
if [[ $mode == plant ]]; then
  mkdir -p "$3"
  work=$(cd -- "$3" && pwd)
  only=("${@:4}")
  plant_all
fi
