#!/bin/bash
# run.sh SCRIPT ADDON.zip PENUMBRA WORK [ARGUMENT…]: a script of this folder in a Blender that has no settings but its own.
# Prints what the script prints after "compare: "; the rest is in WORK/log.
set -euo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
script=$1 addon=$2 program=$3 work=$4
shift 4
command -v blender >/dev/null || { echo "blender is not installed; ./test.sh -L full installs it" >&2; exit 1; }
rm -rf -- "$work"
mkdir -p "$work/scripts" "$work/config" "$work/out"
export BLENDER_USER_SCRIPTS=$work/scripts BLENDER_USER_CONFIG=$work/config
failed=0
blender -b --factory-startup --python-exit-code 1 -P "$here/$script" -- "$addon" "$program" "$work/out" "$@" >"$work/log" 2>&1 || failed=1
sed -n 's/^compare: //p' "$work/log"
if ((failed)); then tail -n 60 "$work/log" >&2; fi
exit $failed
