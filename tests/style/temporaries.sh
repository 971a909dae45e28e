#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Finds views of destroyed temporaries: a range-for over the result of a member function of a temporary (C++20 keeps
# only the last temporary of a range alive, not those before it), and a span or string_view that is kept of a temporary
# that owns the data. Both compile without a warning, and read a dead stack frame.
#   temporaries.sh SOURCE BUILD [PATTERN]     in sources whose path matches PATTERN; default: in all
# Uses clang-query (packages.txt: clang-tools) over targets whose files are joined, as in tidy.sh. BUILD must have been
# built.
set -euo pipefail
source=$(cd -- "$1" && pwd) build=$(cd -- "$2" && pwd)
query=$(command -v clang-query-14 || command -v clang-query || true)
[[ $query ]] || { echo 'style: clang-query is not installed (packages.txt: clang-tools)' >&2; exit 1; }
joined=$build/tidy-joined
cmake -S "$source" -B "$joined" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPENUMBRA_TESTS=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON \
  -DPENUMBRA_JOIN=ON >"$build/temporaries.log" 2>&1 || { cat "$build/temporaries.log" >&2; exit 1; }
sed -i "s,$joined/shaders,$build/shaders,g" "$joined/compile_commands.json"
sources=$(sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' "$joined/compile_commands.json" | sort -u)
sources=$( (grep -vF "$build/" <<<"$sources"; grep -F /Unity/ <<<"$sources") | grep -E -- "${3:-.}")

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/query" <<'QUERY'
set output diag
set bind-root false
let view cxxRecordDecl(hasAnyName("span", "basic_string_view", "initializer_list", "__normal_iterator", "subrange"))
let owner materializeTemporaryExpr(hasType(hasUnqualifiedDesugaredType(recordType(hasDeclaration(cxxRecordDecl(unless(view)))))))
let kept cxxRecordDecl(hasAnyName("span", "basic_string_view"))
let call cxxMemberCallExpr(onImplicitObjectArgument(anyOf(owner.bind("t"), implicitCastExpr(has(owner.bind("t"))))), hasType(hasUnqualifiedDesugaredType(recordType(hasDeclaration(view)))))
m cxxForRangeStmt(unless(isExpansionInSystemHeader()), hasRangeInit(expr(anyOf(call, hasDescendant(call))).bind("init")))
m varDecl(unless(isExpansionInSystemHeader()), hasType(hasUnqualifiedDesugaredType(recordType(hasDeclaration(kept)))), hasInitializer(expr(anyOf(call, hasDescendant(call), hasDescendant(cxxConstructExpr(hasType(hasUnqualifiedDesugaredType(recordType(hasDeclaration(kept)))), hasArgument(0, anyOf(owner.bind("t"), implicitCastExpr(has(owner.bind("t"))))))))).bind("init")))
QUERY
xargs -d '\n' -P "$(nproc)" -n 1 bash -c \
  '"$1" -p "$2" -f "$3/query" --extra-arg=-Wno-unknown-warning-option "$4" >"$3/of.$$" 2>/dev/null || true' \
  _ "$query" "$joined" "$work" <<<"$sources"
cat "$work"/of.* >"$work/found"
[[ $(grep -c 'matches\.\|match\.' "$work/found") -ge $(wc -l <<<"$sources") ]] || { echo 'style: clang-query did not run' >&2; exit 1; }
python3 - "$work/found" "$source" <<'PYTHON'
import re, sys
text, source = open(sys.argv[1]).read(), sys.argv[2] + "/"
found = set()
for match in re.split(r"\nMatch #\d+:\n", text)[1:]:
    bound = {name: (place, line) for place, name, line in
             re.findall(r'(/[^\n]*?:\d+:\d+): note: "(\w+)" binds here\n([^\n]*)', match)}
    if len(bound) == 2:
        found.add(bound["init"][0].replace(source, "") + ": " + bound["init"][1].strip())
for line in sorted(found):
    print("style: a view of a temporary that may be gone: " + line, file=sys.stderr)
sys.exit(1 if found else 0)
PYTHON
