# Shared by run.sh and test.sh (sourced): from a bare clone to a built tree. Quiet when there is nothing to do.
# Everything is built in one folder, build/, so that a fresh clone compiles each file once.

say() { printf 'penumbra: %s\n' "$*" >&2; }
die() { say "$1"; exit 4; }

# Installs what packages.txt lists and this machine does not have. Its first paragraph is what the program needs to be
# built and run; `install_packages all` installs the second, too: what tests and developers need. `install_packages full`
# also the third: what long tests alone need, and is large.
install_packages() {
  local missing=() package paragraphs=1
  case ${1-} in all) paragraphs=2 ;; full) paragraphs=3 ;; esac
  # Ask for all packages at once: dpkg-query answers in milliseconds, apt would take seconds. Of the three letters of a
  # status the second says what is (`i`: installed), the first what is wanted (`h`: held as it is), the third what is broken.
  local installed
  installed=$(dpkg-query -W -f='${db:Status-Abbrev} ${Package}\n' 2>/dev/null | sed -n 's/^.i  //p') ||
    die "cannot ask dpkg what is installed; this script is for Debian 12 and its kin"
  while read -r package _; do
    if [[ -z $package ]]; then
      if ((--paragraphs > 0)); then continue; else break; fi
    fi
    grep -qxF -- "$package" <<<"$installed" || missing+=("$package")
  done <"$root/packages.txt"
  if ((${#missing[@]} == 0)); then return; fi

  local sudo=()
  if ((EUID != 0)); then
    command -v sudo >/dev/null ||
      die "missing packages and no sudo; as root, run: apt-get install --no-install-recommends ${missing[*]}"
    sudo=(sudo)
  fi
  say "installing ${missing[*]}"
  local apt=(env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300)
  # Package lists may be fresh enough; only if not, fetch them.
  if ! "${sudo[@]}" "${apt[@]}" install --no-install-recommends -y "${missing[@]}" >/dev/null 2>&1; then
    "${sudo[@]}" "${apt[@]}" update >&2 || die "apt-get update failed; is the package mirror within reach?"
    "${sudo[@]}" "${apt[@]}" install --no-install-recommends -y "${missing[@]}" >&2 ||
      die "apt-get install failed for: ${missing[*]}"
  fi
}

# build TESTS TARGET…: configures once (ninja itself notices later changes of the build rules), with tests where TESTS is ON,
# and builds. A folder that has been configured with tests stays so.
build() {
  local tests=$1
  shift
  mkdir -p "$build"
  # Two runs at once from one clone must not build into the same folder at the same time.
  exec 9>"$build/.lock"
  flock 9
  if [[ ! -f $build/build.ninja ]] || { [[ $tests == ON ]] && grep -q '^PENUMBRA_TESTS:BOOL=OFF' "$build/CMakeCache.txt"; }; then
    say "configuring build/"
    cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE="${PENUMBRA_BUILD_TYPE:-Release}" \
      -DPENUMBRA_TESTS="$tests" >"$build/configure.log" 2>&1 || {
      cat "$build/configure.log" >&2
      die "configuring failed (see above)"
    }
  fi
  # Progress goes to stderr, so that stdout is the program's alone; a build with nothing to do says nothing.
  NINJA_STATUS='[%f/%t] ' ninja -C "$build" "$@" |
    sed -u -e '/^ninja: Entering directory/d' -e '/^ninja: no work to do/d' -e '/Re-checking globbed directories/d' >&2 ||
    die "the build failed (see above)"
  flock -u 9
  exec 9>&-
}
