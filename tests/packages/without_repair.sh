#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# without_repair.sh: tests that cmake/tarball.sh packs a build of `penumbra` alone, without penumbra-repair. Tiny
# scripts stand in for the programs and for `ldd`, to be quick.
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work"/{build,bin,made}
printf '#!/bin/sh\necho penumbra 1.2.3\n' >"$work/build/penumbra"
cp "$work/build/penumbra" "$work/build/penumbra-import"
cat >"$work/bin/ldd" <<'END'
#!/bin/sh
[ -e "$1" ] && ldconfig -p | awk '$1 == "libz.so.1" {print "\tlibz.so.1 => " $NF " (0x0)"; exit}'
END
chmod +x "$work"/build/* "$work/bin/ldd"
echo 'file(INSTALL DESTINATION "${CMAKE_INSTALL_PREFIX}/share" TYPE FILE FILES "${CMAKE_CURRENT_LIST_FILE}")' >"$work/build/cmake_install.cmake"

fail() { echo "FAILED: $1"; exit 1; }
PATH=$work/bin:$PATH XZ_OPT=-0 "$root/cmake/tarball.sh" "$work/build" "$work/made" || fail "exit $?"
inside=$(tar -tJf "$work"/made/penumbra-1.2.3-linux-*.tar.xz)
for file in lib/penumbra/libz.so.1 lib/penumbra/libvulkan.so.1 share/cmake_install.cmake gpu.sh; do
  grep -q "/$file\$" <<<"$inside" || fail "no $file in it"
done
