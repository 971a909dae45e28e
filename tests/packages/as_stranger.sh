#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# as_stranger.sh package|tarball|driver [FOLDER]: the part of try.sh that runs in a bare system, as a user who may write
# only to a home folder.
set -euo pipefail
kind=$1
[[ -z ${2-} ]] || PATH=$2/bin:$PATH
fail() { echo "FAILED: $1"; exit 1; }
if touch /tmp/x 2>/dev/null; then fail "/tmp can be written"; fi
mkdir -p "$HOME/my pictures"
cd "$HOME/my pictures"
cp /srv/room.json "a room.json"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n' >"a mesh.obj"
whole() { [[ -s $1 ]] || fail "no $1"; }

penumbra --version
penumbra render "a room.json" -o "a room.exr" --png "a room.png" --size 96x96 --quiet
whole "a room.exr"
penumbra render "a mesh.obj" -o "a mesh.exr" --size 32x32 --quiet
whole "a mesh.exr"
penumbra inspect "a mesh.obj" --repair "mended.obj" >repair.txt
whole mended.obj
grep -q 'watertight yes' repair.txt || fail "the mended mesh: $(tail -1 repair.txt)"
methods=edge-scatter,view-sample
[[ $kind == tarball ]] || methods+=,pcss,soft-volume
penumbra compare "a room.json" -o "$kind report" --size 32x32 --methods "$methods" --reference-samples 16 --quiet >/dev/null
whole "$kind report/report.html"
case $kind in
  package)
    python3 -c 'import penumbra; v = penumbra.Renderer(penumbra.load("a room.json")).render(size=(32, 32)).V
assert v.shape == (32, 32) and 0 < v.mean() < 1, v'
    [[ -s /usr/share/man/man1/penumbra-render.1 || -s /usr/share/man/man1/penumbra-render.1.gz ]] || fail "no manual page"
    ;;
  tarball)
    # Without a driver the program's error says what is missing.
    code=0
    penumbra render "a room.json" -o none.exr --method pcss --size 32x32 --quiet 2>error.txt || code=$?
    ((code == 4)) && grep -qi 'vulkan' error.txt || fail "pcss without Vulkan: exit $code, $(cat error.txt)"
    ;;
  driver)
    # Only the size 512x512, as a driver for processors is slow.
    code=0
    bash "$2/gpu.sh" gpu.json cpu 512 2>gpu.txt || code=$?
    python3 - <<'END' || fail "gpu.sh: exit $code, $(cat gpu.txt)"
import json
gpu = json.load(open("gpu.json"))
assert gpu["selfTest"]["exitCode"] in (0, 124), gpu["selfTest"]  # 124: out of time
assert gpu["format"] == "penumbra-gpu/1" and gpu["devices"]["devices"], gpu
assert len(gpu["sameBitsAsVectorUnits"]) == 9 and all(one["same"] for one in gpu["sameBitsAsVectorUnits"]), gpu["sameBitsAsVectorUnits"]
out_of_time = "methods: out of time" in open("gpu.txt").read()
assert out_of_time or (gpu["methods"] and all(len(one["methods"]) >= 15 for one in gpu["methods"])), gpu["methods"]
assert len(gpu["speed"]) >= 5 and all(run["seconds"]["shadow"] > 0 for run in gpu["speed"])
END
    ((code == 0)) || fail "gpu.sh: exit $code, $(cat gpu.txt)"
    ;;
esac
echo "$kind: good"
