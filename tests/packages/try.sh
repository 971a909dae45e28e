#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# try.sh BUILD WORK: makes the Debian package and the tarball of a built tree, and tries both in a bare Debian 12 made by
# debootstrap: as another user, in a folder with spaces in its name, and with a /tmp that cannot be written. Skipped (77)
# without root, debootstrap or a mirror.
#   The package is installed by apt; the program renders, compares and repairs, and Python imports the module.
#   The tarball is tried in a system without other packages, where methods that need no Vulkan give the same bytes as the built tree; and in
#     the system with the package, whose driver it finds, where other methods run, too.
set -euo pipefail
build=$(readlink -f -- "$1") work=$2
here=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")" && pwd)
mirror=${PENUMBRA_MIRROR:-http://deb.debian.org/debian}
skip() { echo "skipped: $1"; exit 77; }
((EUID == 0)) || skip "only root can make a bare system"
command -v debootstrap >/dev/null || skip "debootstrap is not installed"
# A separate mount namespace, so that nothing stays mounted.
[[ ${PENUMBRA_UNSHARED-} == 1 ]] || PENUMBRA_UNSHARED=1 exec unshare -m "$0" "$@"
mkdir -p "$work"
work=$(readlink -f -- "$work")
fail() { echo "FAILED: $1"; exit 1; }

if [[ ! -e $work/bare/etc/debian_version ]]; then
  rm -rf "$work/bare"
  debootstrap --variant=minbase bookworm "$work/bare.part" "$mirror" >"$work/debootstrap.log" 2>&1 ||
    { rm -rf "$work/bare.part"; skip "debootstrap: $(tail -1 "$work/debootstrap.log")"; }
  mv "$work/bare.part" "$work/bare"
fi

# system NAME: makes a copy of the bare system with another user, a clone's scenes that this user can read, and a /tmp
# that the user cannot write.
system() {
  umount "$work/$1/proc" 2>/dev/null || true
  rm -rf "${work:?}/$1"
  cp -a "$work/bare" "$work/$1"
  cp /etc/resolv.conf "$work/$1/etc/"
  mount -t proc proc "$work/$1/proc"
  chroot "$work/$1" useradd -m -s /bin/bash stranger
  cp "$here/as_stranger.sh" "$here"/../../scenes/room.json "$work/$1/srv/"
  chmod 755 "$work/$1/tmp"
}
# as_stranger NAME WORDS…: runs as_stranger.sh in that system as this user, without the environment of this process.
as_stranger() {
  local name=$1
  shift
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb chroot "$work/$name" su - stranger -c "bash /srv/as_stranger.sh $*"
}

echo "--- package"
rm -rf "$work/made" && mkdir "$work/made"
(cd "$build" && cpack -G DEB -B "$work/made" >"$work/cpack.log" 2>&1) || { tail -20 "$work/cpack.log"; fail "cpack"; }
system installed
chmod 1777 "$work/installed/tmp"
cp "$work"/made/*.deb "$work/installed/srv/"
chroot "$work/installed" sh -c "echo 'deb $mirror bookworm main' >/etc/apt/sources.list && apt-get -q update &&
  DEBIAN_FRONTEND=noninteractive apt-get -q install -y /srv/*.deb" >"$work/apt.log" 2>&1 || { tail -20 "$work/apt.log"; fail "apt-get install"; }
chmod 755 "$work/installed/tmp"
as_stranger installed package || fail "the package"

echo "--- tarball"
"$here/../../cmake/tarball.sh" "$build" "$work/made"
tarball=$(ls "$work"/made/*.tar.xz)
(($(stat -c %s "$tarball") < 64 << 20)) || fail "the tarball has more than 64 MiB"
system nothing
for name in nothing installed; do
  mkdir -p "$work/$name/opt/my programs"
  # Debian's minimal system has no xz, so the tarball is unpacked from outside.
  tar -C "$work/$name/opt/my programs" -xJf "$tarball"
done
folder=$(basename "$tarball" .tar.xz)
(($(du -sm "$work/nothing/opt/my programs" | cut -f1) < 128)) || fail "unpacked it has more than 128 MiB"
as_stranger nothing tarball "'/opt/my programs/$folder'" || fail "the tarball where nothing is installed"
cp "$here/../../scenes/room.json" "$work/made/a room.json"
(cd "$work/made" && "$build/penumbra" render "a room.json" --size 96x96 -o "a room.exr" --quiet)
cmp "$work/made/a room.exr" "$work/nothing/home/stranger/my pictures/a room.exr" || fail "the bytes differ from those of the built tree"
as_stranger installed driver "'/opt/my programs/$folder'" || fail "the tarball beside a driver"
echo "all is as it should be"
