#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# gpu.sh [FILE.json] [DEVICE] [largest side] [BOTH [OTHERS]]: checks and times all passes on this machine's GPU, in at
# most eight minutes. Runs from the unpacked tarball (cmake/tarball.sh), where nothing needs to be installed, or from a
# built clone. DEVICE is that of --device.
# Writes FILE.json (default gpu.json) in four parts: the self-test; whether exact methods give the same bits on the
# device and on the processor's vector units; seconds, and milliseconds of each pass, of exact and image-based methods
# from 512x512 to 4K; errors and seconds of the default methods of `compare`, at two sizes. BOTH (exact methods with an
# option `engine`) and OTHERS replace the methods below: names separated by spaces. The exit code is 1 if bits differ or
# a run fails; a run that is out of time does not count as failed.
set -uo pipefail
file=${1:-gpu.json} device=${2:-} largest=${3:-3840}
read -ra both <<<"${4:-edge-scatter view-sample depth-complexity}"
read -ra others <<<"${5:-soft-volume hard-volume shadow-map pcss vssm accumulate backproject}"
judge=${both[0]}:rows=exact
here=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")" && pwd)
if [[ -x $here/bin/penumbra ]]; then
  program=$here/bin/penumbra scenes=$here/share/penumbra/scenes commit=$(cat "$here/share/doc/penumbra/commit" 2>/dev/null)
else
  program=$here/../build/penumbra scenes=$here/../scenes commit=$(git -C "$here" describe --always --dirty --abbrev=12 --exclude='*' 2>/dev/null)
fi
[[ -x $program ]] || { echo "gpu.sh: no program at $program" >&2; exit 4; }
# Containers that only mount NVIDIA's driver do not tell the loaders where it is.
nvidia=/usr/local/nvidia/share
[[ ! -e $nvidia/vulkan/icd.d/nvidia_icd.json ]] || export VK_DRIVER_FILES=${VK_DRIVER_FILES:-$nvidia/vulkan/icd.d/nvidia_icd.json}
[[ ! -e $nvidia/glvnd/egl_vendor.d/10_nvidia.json ]] ||
  export __EGL_VENDOR_LIBRARY_FILENAMES=${__EGL_VENDOR_LIBRARY_FILENAMES:-$nvidia/glvnd/egl_vendor.d/10_nvidia.json}
work=$(mktemp -d "$(dirname -- "$file")/gpu.XXXXXX") || exit 4
trap 'rm -rf "$work"' EXIT
on=() wrong=0
[[ -z $device ]] || on=(--device "$device")
say() { printf '%4d s  %s\n' "$SECONDS" "$*" >&2; }
# failed WHAT CODE: reports a failed run with the program's output; sets `wrong` unless `timeout` ended the run (124).
failed() {
  if (($2 == 124)); then say "$1: out of time"; else wrong=1; say "$1: exit $2"; fi
  cat "$work/errors.txt" >&2
}
left() { local rest=$((${1} - SECONDS)); echo $((rest > 0 ? rest : 1)); }  # seconds until the one named, for `timeout`

say "devices"
"$program" devices --json >"$work/devices.json" 2>/dev/null || echo null >"$work/devices.json"
say "self-test"
timeout "$(left 150)" "$program" devices --self-test "${on[@]}" --json >"$work/self-test.json" 2>"$work/errors.txt"
self_test=$?
((self_test == 0)) || failed "self-test" $self_test
[[ -s $work/self-test.json ]] || echo null >"$work/self-test.json"

# picture NAME METHOD SIZE SAMPLES SCENE UNTIL: renders one picture; writes its stats to NAME.json, and its bits to
# NAME.bits if NAME contains -bits-.
picture() {
  local bits=()
  [[ $1 != *-bits-* ]] || bits=(--bits "$work/$1.bits")
  timeout "$(left "$6")" "$program" render "$scenes/$5.json" --method "$2" "${on[@]}" --light-samples "$4" --size "$3" -o "$work/x.exr" \
    --stats "$work/$1.json" "${bits[@]}" --quiet >"$work/errors.txt" 2>&1
}

bits=()
for scene in contact thin fusion; do
  for method in "${both[@]}"; do
    same=null
    if picture x-bits-device $method:engine=vulkan 512x512 256 $scene 270 && picture x-bits-vectors $method:engine=native 512x512 256 $scene 270; then
      if cmp -s "$work"/x-bits-{device,vectors}.bits; then same=true; else same=false wrong=1; fi
    else
      failed "$scene, $method" $?
    fi
    say "$scene, $method: same bits as the vector units: $same"
    bits+=("{\"scene\": \"$scene\", \"method\": \"$method\", \"size\": [512, 512], \"lightSamples\": 256, \"same\": $same}")
  done
done

speed=()
for size in 512x512 1920x1080 3840x2160; do
  ((${size%x*} <= largest)) || continue
  for method in "${both[@]/%/:engine=vulkan}" "${others[@]}"; do
    name=${method%%:*}
    counts=(256)  # of light samples, for methods that take any
    [[ $method != *engine=vulkan ]] || counts+=(1024)
    for count in "${counts[@]}"; do
      if picture "speed" "$method" "$size" "$count" self-shadow 470; then
        speed+=("$(cat "$work/speed.json")")
        say "$size, $name: shadow $(sed -n 's/^ *"shadow": \([0-9.e-]*\).*/\1/p' "$work/speed.json" | head -1) s"
      else
        failed "$size, $name" $?
      fi
    done
  done
done

methods=()
for size in 512x512 1920x1080; do
  ((${size%x*} <= largest)) || continue
  if timeout "$(left 480)" "$program" compare "$scenes/self-shadow.json" "${on[@]}" --size "$size" --reference "$judge" --runs 3 \
    -o "$work/compared" --stats "$work/metrics.json" --quiet >"$work/errors.txt" 2>&1; then
    methods+=("$(cat "$work/metrics.json")")
    say "$size, methods: compared"
  else
    failed "$size, methods" $?
  fi
  rm -rf "$work/compared"
done

join() { local IFS=,; printf '%s' "$*"; }
{
  printf '{"format": "penumbra-gpu/1", "commit": "%s", "date": "%s", "processors": %d, "seconds": %d,\n' "$commit" "$(date -u +%FT%TZ)" "$(nproc)" "$SECONDS"
  printf '"devices": %s,\n"selfTest": {"exitCode": %d, "rows": %s},\n' "$(cat "$work/devices.json")" $self_test "$(cat "$work/self-test.json")"
  printf '"sameBitsAsVectorUnits": [%s],\n"speed": [%s],\n"methods": [%s]}\n' "$(join "${bits[@]}")" "$(join "${speed[@]}")" "$(join "${methods[@]}")"
} >"$work/all.json" && mv -- "$work/all.json" "$file"
say "written: $file"
exit $wrong
