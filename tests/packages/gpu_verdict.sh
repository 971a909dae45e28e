#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# gpu_verdict.sh: tests that bench/gpu.sh exits with 1 if a run fails or bits differ, and with 0 if runs are only out of
# time. A script stands in for the program and behaves in each of these ways.
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin"
cp "$root/bench/gpu.sh" "$work/"
cat >"$work/bin/penumbra" <<'END'
#!/bin/bash
# A run whose arguments contain the words of $FAIL ends with the exit code $CODE, or writes other bits if $CODE is
# `other`.
all="$* "
[[ -z $FAIL || $all != *"$FAIL"* || $CODE == other ]] || exit "$CODE"
while (($#)); do
  case $1 in
    --bits) if [[ -n $FAIL && $all == *"$FAIL"* ]]; then echo 1; else echo 0; fi >"$2" ;;
    --stats) printf '{"seconds": {"shadow": 1}}' >"$2" ;;
    --json) echo '{}' ;;
  esac
  shift
done
END
chmod +x "$work/bin/penumbra"

# verdict EXPECTED FAIL CODE: expects that gpu.sh exits with EXPECTED.
verdict() {
  local code=0
  FAIL=$2 CODE=$3 bash "$work/gpu.sh" "$work/gpu.json" "" 512 2>"$work/said.txt" || code=$?
  ((code == $1)) || { echo "FAILED: exit $code in place of $1, of '$2' with $3"; cat "$work/said.txt"; exit 1; }
  [[ -s $work/gpu.json ]] || { echo "FAILED: no gpu.json, of '$2' with $3"; exit 1; }
}
verdict 0 "" 0
for part in --self-test view-sample:engine=native "shadow-map " "compare "; do
  verdict 1 "$part" 139
  verdict 0 "$part" 124  # 124 is the exit code of `timeout`
done
verdict 1 view-sample:engine=native other
