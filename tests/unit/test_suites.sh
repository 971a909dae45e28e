#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Tests the list of an executable's suites that ctest gets (cmake/test_suites.cmake): labels, names, parts, skipped and
# failed tests.
# Usage: test_suites.sh SOURCE WORK
set -euo pipefail
source=$(cd -- "$1" && pwd)
rm -rf -- "$2"
mkdir -p -- "$2"
cd -- "$2"

# Stands for a GoogleTest executable: lists its tests, skips and fails in two suites, and fails if a part gets the wrong variables.
cat >program <<'E2'
#!/bin/bash
case "$*" in
  '--gtest_list_tests --gtest_filter=*')
    printf '%s\n' 'Running main() from gtest_main.cc' Mixed. '  Short' '  OfHoursFull' In/Values. \
      '  Each/0  # GetParam() = "a;b [c."' '  Each/1' Skipped. '  One' Failing. '  One' ;;
  '--gtest_list_tests --gtest_filter=*Full') printf '%s\n' 'Running main() from gtest_main.cc' Mixed. '  OfHoursFull' ;;
  '--gtest_filter=Skipped.*') printf '%s\n' '[  PASSED  ] 0 tests.' '[  SKIPPED ] 1 test, listed below:' '[  SKIPPED ] Skipped.One' ;;
  '--gtest_filter=Failing.*')
    printf '%s\n' '[  PASSED  ] 0 tests.' '[  SKIPPED ] 1 test, listed below:' '[  SKIPPED ] Failing.Two' \
      '[  FAILED  ] 1 test, listed below:' '[  FAILED  ] Failing.One'
    exit 1 ;;
  '--gtest_filter=In/Values.*') [[ $GTEST_TOTAL_SHARDS == 2 && $GTEST_SHARD_INDEX == [01] ]] ;;
  '--gtest_filter=Mixed.*-*Full' | '--gtest_filter=Mixed.OfHoursFull') ;;
  *) exit 2 ;;
esac
E2
chmod +x program
cmake -DEXECUTABLE="$PWD/program" -DFILE="$PWD/CTestTestfile" -DPREFIX=room. '-DFULL=*Full' -DSHARDS=In/Values=2 \
  -P "$source/cmake/test_suites.cmake"

names() { ctest -N "$@" | sed -n 's/^ *Test *#[0-9]*: //p' | sort | tr '\n' ' '; }
expect() { [[ $1 == "$2" ]] || { printf 'test_suites: "%s" in place of "%s"\n' "$1" "$2" >&2; exit 1; }; }
expect "$(names -L full)" 'room.Mixed.full '
expect "$(names -L quick)" 'room.Failing room.In/Values.1of2 room.In/Values.2of2 room.Mixed room.Skipped '
results=$({ ctest 2>&1 || true; } | sed -n 's/.*: \(room[^ ]*\) \.*\(.*[A-Za-z]\) .*sec$/\1 \2/p' | sed 's/  */ /' | sort | tr '\n' ',')
expect "$results" 'room.Failing ***Failed,room.In/Values.1of2 Passed,room.In/Values.2of2 Passed,room.Mixed Passed,room.Mixed.full Passed,room.Skipped ***Skipped,'
cp CTestTestfile_single.cmake CTestTestfile.cmake
expect "$(names)" 'room.Failing.One room.In/Values.Each/0 room.In/Values.Each/1 room.Mixed.OfHoursFull room.Mixed.Short room.Skipped.One '
