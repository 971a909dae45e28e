#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Tests which packages cmake/bootstrap.sh installs, with a replacement of dpkg-query and of apt-get.
# Usage: bootstrap.sh SOURCE WORK
set -euo pipefail
source=$1 work=$2
rm -rf -- "$work"
mkdir -p "$work/bin" "$work/root"
WORK=$(cd -- "$work" && pwd)
export WORK
export PATH=$WORK/bin:$PATH

printf 'there\nheld\nremoved\nhalf\nbroken\nunknown\nthere-too\n\nof-tests\nof-tests-there\n\nof-long-tests\n' >"$work/root/packages.txt"
# The format is that of dpkg-query -W -f='${db:Status-Abbrev} ${Package}\n': the first letter is the wanted state, the
# second the actual one, a third marks errors.
cat >"$work/dpkg" <<'END'
ii  there
hi  held
rc  removed
iH  half
iiR broken
ii  unknown-but-longer
ri  there-too
ii  of-tests-there
END
cat >"$work/bin/dpkg-query" <<'END'
#!/bin/bash
[[ $1 == -W && $2 == "-f=\${db:Status-Abbrev} \${Package}\\n" && $# == 2 ]] || { echo "dpkg-query $*?" >&2; exit 2; }
cat "$WORK/dpkg"
END
cat >"$work/bin/apt-get" <<'END'
#!/bin/bash
echo "$*" >>"$WORK/apt"
END
printf '#!/bin/bash\nexec "$@"\n' >"$work/bin/sudo"
chmod +x "$work"/bin/*

failed=0
# expect CALL PACKAGES: expects that CALL makes apt-get install PACKAGES; '' if apt-get must not be called.
expect() {
  local asked
  rm -f "$work/apt"
  : >"$work/apt"
  # shellcheck disable=SC2034
  (root=$WORK/root && source "$source/cmake/bootstrap.sh" && $1) 2>"$work/said" || { cat "$work/said" >&2; failed=1; }
  asked=$(sed -n 's/.* install --no-install-recommends -y //p' "$work/apt")
  [[ $asked == "$2" && $(wc -l <"$work/apt") == "$([[ $2 ]] && echo 1 || echo 0)" ]] && return
  printf '%s: installs "%s", not "%s"; apt-get was called with:\n' "$1" "$asked" "$2" >&2
  cat "$work/apt" >&2
  failed=1
}
expect install_packages 'removed half broken unknown'
expect 'install_packages all' 'removed half broken unknown of-tests'
expect 'install_packages full' 'removed half broken unknown of-tests of-long-tests'
printf '%s\n' 'ii  there' 'hi  held' 'ii  removed' 'ii  half' 'ii  broken' 'ii  unknown' 'ii  there-too' >"$work/dpkg"
expect install_packages ''
[[ ! -s $work/said ]] || { echo "prints something although nothing is missing" >&2; failed=1; }

# Package lists that are too old: the script says that it fetches them, and reports the progress of a slow installation.
printf '%s\n' 'ii  there' 'hi  held' 'ii  removed' 'ii  half' 'ii  broken' 'ii  unknown' >"$work/dpkg"
cat >"$work/bin/apt-get" <<'END'
#!/bin/bash
echo "$*" >>"$WORK/apt"
case "$*" in
  *update*) touch "$WORK/fresh" ;;
  *) [[ -e $WORK/fresh ]] || exit 100
     echo 'Get:1 http://mirror there-too'; sleep 9 ;;
esac
END
rm -f "$work/apt"
# shellcheck disable=SC2034
(root=$WORK/root && source "$source/cmake/bootstrap.sh" && install_packages) 2>"$work/said" || { cat "$work/said" >&2; failed=1; }
[[ $(wc -l <"$work/apt") == 3 ]] || { echo "apt-get is not called three times" >&2; failed=1; }
for said in 'installing 1 packages and what they need: there-too' 'apt-get update' 'installing: 1 packages fetched, 0 unpacked'; do
  grep -qF "$said" "$work/said" || { echo "does not print: $said" >&2; cat "$work/said" >&2; failed=1; }
done

# Lines pass through, and so does the exit status of the pipeline's first command; silence is broken.
# shellcheck disable=SC2034
(root=$WORK/root && source "$source/cmake/bootstrap.sh" && (echo a; sleep 9; echo b; exit 7) | never_silent 'goes on') \
  >"$work/lines" 2>"$work/said" && { echo "a command's failure is lost" >&2; failed=1; }
[[ $(<"$work/lines") == $'a\nb' ]] || { echo "lines of the output are lost" >&2; failed=1; }
grep -q 'goes on' "$work/said" || { echo "nothing is said for nine seconds" >&2; failed=1; }
exit $failed
