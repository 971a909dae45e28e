#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# run.sh SCRIPT ADDON.zip PENUMBRA WORK [ARGUMENT…]: runs a script of this folder in a Blender with default settings.
# Prints what the script prints after "compare: "; the rest is in WORK/log. With WINDOW=1 in the environment Blender has
# a window of 900 × 700 pixels, with WINDOW=1440x810 one of that size, on a separate screen (Xvfb) that Mesa's processor
# drivers draw.
set -euo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
script=$1 addon=$2 program=$3 work=$4
shift 4
command -v blender >/dev/null || { echo "blender is not installed; ./test.sh -L full installs it" >&2; exit 1; }
rm -rf -- "$work"
mkdir -p "$work/scripts" "$work/config" "$work/out"
export BLENDER_USER_SCRIPTS=$work/scripts BLENDER_USER_CONFIG=$work/config
how=(-b)
if [ -n "${WINDOW:-}" ]; then
  size=900x700
  [[ $WINDOW == *x* ]] && size=$WINDOW
  command -v Xvfb >/dev/null || { echo "xvfb is not installed; ./test.sh -L full installs it" >&2; exit 1; }
  Xvfb -displayfd 3 -screen 0 ${size}x24 -nolisten tcp >"$work/screen" 2>&1 3>"$work/display" &
  screen=$!
  trap 'kill $screen' EXIT
  for ((i = 0; i < 200; ++i)); do [ -s "$work/display" ] && break; sleep 0.1; done
  DISPLAY=:$(<"$work/display")
  export DISPLAY LIBGL_ALWAYS_SOFTWARE=1
  how=(--window-geometry 0 0 ${size%x*} ${size#*x} --no-window-focus)
fi
failed=0
blender "${how[@]}" --factory-startup --python-exit-code 1 -P "$here/$script" -- "$addon" "$program" "$work/out" "$@" >"$work/log" 2>&1 || failed=1
sed -n 's/^compare: //p' "$work/log"
if ((failed)); then tail -n 60 "$work/log" >&2; fi
exit $failed
