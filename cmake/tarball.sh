#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# tarball.sh BUILD [FOLDER]: packs the programs of a built tree as FOLDER/penumbra-VERSION-linux-x86_64.tar.xz, which runs where nothing is
# installed but the C library (Debian 12's or a newer one). Unpack it anywhere:
#   bin/            penumbra, penumbra-import, penumbra-repair
#   lib/penumbra/   every library that these need, and the loaders of Vulkan and OpenGL, which find the machine's drivers
#   share/          scenes, manual pages, completions of shells; share/doc/penumbra: licences of all that is inside
#   gpu.sh          what is right and how fast, on this machine's GPU
set -euo pipefail
build=$(readlink -f -- "${1:?usage: tarball.sh BUILD [FOLDER]}")
folder=$(readlink -f -- "${2:-.}")
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
version=$("$build/penumbra" --version | sed 's/^penumbra //')
name=penumbra-$version-linux-$(uname -m)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
stage=$work/$name

cmake --install "$build" --component programs --strip --prefix "$stage" >"$work/install.log" ||
  { cat "$work/install.log" >&2; exit 1; }
mkdir -p "$stage/lib/penumbra" "$stage/share/doc/penumbra"

# The C library is not packed: it must match the kernel, the loader and the drivers of the machine.
libraries=$(for program in "$build"/penumbra{,-import,-repair}; do
  if [[ -x $program ]]; then ldd "$program"; fi  # a build of `penumbra` alone has no penumbra-repair
done | awk '$2 == "=>" && $3 ~ /^\// {print $3}' | sort -u | grep -vE '/(libc|libm|libpthread|libdl|librt|ld-linux-[^/]*)\.so')
# Nothing links to Vulkan's loader; the program opens it by name.
libraries+=" $(ldconfig -p | awk '$1 == "libvulkan.so.1" {path = $NF} END {print path}')"
for library in $libraries; do
  cp -L -- "$library" "$stage/lib/penumbra/"
  # Copies each library's licence from its package.
  package=$(dpkg-query -S "$(readlink -f -- "$library")" 2>/dev/null || dpkg-query -S "$library" 2>/dev/null || dpkg-query -S "/usr$(readlink -f -- "$library")")
  package=${package%%:*}
  cp -L -- "/usr/share/doc/$package/copyright" "$stage/share/doc/penumbra/$package.copyright"
done
strip --strip-unneeded "$stage"/lib/penumbra/*
cp -- "$root/LICENSE" "$stage/share/doc/penumbra/"
cp -- "$root/bench/gpu.sh" "$stage/"
git -C "$root" describe --always --dirty --abbrev=12 --exclude='*' >"$stage/share/doc/penumbra/commit" 2>/dev/null || true

# The same tree gives the same bytes: sorted names, one time stamp, and no owner.
tar -C "$work" --sort=name --owner=0 --group=0 --numeric-owner --mtime="@${SOURCE_DATE_EPOCH:-0}" -cJf "$folder/$name.tar.xz" "$name"
printf '%s: %d MiB, unpacked %d MiB\n' "$folder/$name.tar.xz" $(($(stat -c %s "$folder/$name.tar.xz") >> 20)) \
  "$(du -sm "$stage" | cut -f1)"
