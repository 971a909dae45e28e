# SPDX-License-Identifier: Apache-2.0
# Shared by run.sh and test.sh (sourced): from a bare clone to a built tree. Quiet when there is nothing to do.
# Everything is built in one folder, build/, so that a fresh clone compiles each file once.

say() { printf 'penumbra: %s\n' "$*" >&2; }
die() { say "$1"; exit 4; }

# lively TEXT COMMAND…: runs the command, and meanwhile says every eight seconds what the command TEXT prints. COMMAND
# stays in the foreground, so that Ctrl-C ends it; the clock and its sleep keep none of its files open.
lively() {
  local text=$1 clock code=0
  shift
  (while sleep 8 >/dev/null 2>&1 9>&-; do say "$($text)"; done) 9>&- &
  clock=$!
  trap 'kill "$clock" 2>/dev/null || true' EXIT
  "$@" || code=$?
  kill "$clock" 2>/dev/null || true
  wait "$clock" 2>/dev/null || true
  trap - EXIT
  return "$code"
}

# apt_text, configure_text: what `lively` says while it waits; the output of apt-get is in $apt_log.
apt_text() {
  printf '%s: %d packages fetched, %d unpacked, %d set up' "$apt_step" "$(grep -c '^Get:' "$apt_log")" \
    "$(grep -c '^Unpacking ' "$apt_log")" "$(grep -c '^Setting up ' "$apt_log")"
}
configure_text() { echo 'configuring build/ goes on'; }

# never_silent TEXT: passes lines on, and says TEXT on stderr whenever no line has come for eight seconds.
never_silent() {
  local line code
  while true; do
    code=0
    IFS= read -r -t 8 line || code=$?
    if ((code == 0)); then
      printf '%s\n' "$line"
      continue
    fi
    printf '%s' "$line"
    if ((code <= 128)); then break; fi  # the end
    say "$1 ($SECONDS s)"
  done
}

# Installs the packages of packages.txt that this machine does not have. The first paragraph of that file is what the
# program needs to be built and run. `install_packages all` also installs the second, which tests and developers need;
# `install_packages full` also the third, which is large and which only long tests need.
install_packages() {
  local missing=() package paragraphs=1
  case ${1-} in all) paragraphs=2 ;; full) paragraphs=3 ;; esac
  # Ask for all packages at once: dpkg-query answers in milliseconds, apt would take seconds. A status has three
  # letters: the first is the wanted state (`h`: held as it is), the second the actual state (`i`: installed), the third
  # an error.
  local installed
  installed=$(dpkg-query -W -f='${db:Status-Abbrev} ${Package}\n' 2>/dev/null | sed -n 's/^.i  //p') ||
    die "cannot ask dpkg what is installed; this script is for Debian 12 and systems derived from it"
  while read -r package _; do
    if [[ -z $package ]]; then
      if ((--paragraphs > 0)); then continue; else break; fi
    fi
    grep -qxF -- "$package" <<<"$installed" || missing+=("$package")
  done <"$root/packages.txt"
  if ((${#missing[@]} == 0)); then return; fi

  local sudo=()
  if ((EUID != 0)); then
    command -v sudo >/dev/null || die "packages are missing, and there is no sudo. Let root run

    apt-get update && apt-get install --no-install-recommends ${missing[*]}

and start this again; or, without this script, in $root:

    cmake -S . -B build -G Ninja -DPENUMBRA_TESTS=OFF && ninja -C build penumbra && build/penumbra --help"
    sudo=(sudo)
  fi
  apt_log=$(mktemp)
  apt_step=installing
  say "installing ${#missing[@]} packages and what they need: ${missing[*]}"
  # Package lists may be fresh enough; only if not, fetch them.
  if ! lively apt_text install_now; then
    say 'apt-get update, then once more'
    apt_step='apt-get update'
    lively apt_text update_now ||
      { cat "$apt_log" >&2; die "apt-get update failed; is the package mirror within reach?"; }
    apt_step=installing
    lively apt_text install_now || { tail -20 "$apt_log" >&2; die "apt-get install failed for: ${missing[*]}"; }
  fi
  rm -f "$apt_log"
}

# update_now, install_now: steps of install_packages, with its variables.
update_now() { "${sudo[@]}" apt-get -q update >"$apt_log" 2>&1; }
install_now() {
  "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 install --no-install-recommends -y \
    "${missing[@]}" >"$apt_log" 2>&1
}

configure_now() {
  cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE="${PENUMBRA_BUILD_TYPE:-Release}" -DPENUMBRA_TESTS="$1" \
    >"$build/configure.log" 2>&1
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
    lively configure_text configure_now "$tests" || {
      cat "$build/configure.log" >&2
      die "configuring failed (see above)"
    }
  fi
  # Progress goes to stderr, so that stdout has only the program's output; a build with nothing to do prints nothing.
  NINJA_STATUS='[%f/%t] ' ninja -C "$build" "$@" |
    sed -u -e '/^ninja: Entering directory/d' -e '/^ninja: no work to do/d' -e '/Re-checking globbed directories/d' |
    never_silent 'still compiling' >&2 || die "the build failed (see above)"
  flock -u 9
  exec 9>&-
}
