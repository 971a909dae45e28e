# SPDX-License-Identifier: Apache-2.0
"""method_names.py SOURCE PROGRAM: fails if app/, bench/, compare/, session/ or a script of theirs names a shadow method
in a string. Properties of methods must come from the tables of their families; only the methods that users get by
default may be named."""

import json
import re
import subprocess
import sys
from pathlib import Path

DEFAULTS = {("session/comparison/comparison.hpp", "raytrace"), ("bench/swimming.py", "exact"),
            ("bench/options.cpp", "edge-scatter,view-sample"), ("bench/options.cpp", "edge-scatter,edge-scatter:rows=exact")}
# Files that measure what papers, or a page, say of certain methods.
OF_PAPERS = {"bench/time_ratios.py", "bench/domes.py", "bench/page_tables.py", "bench/ray_tables.py", "bench/scaling_tables.py"}


# Shell lines with what users get by default.
DEFAULT_LINES = re.compile(r"^read -ra \w+ <<<\"\$\{\d:-[^}]*\}\"$")


def literals(text, words=False):
    """Returns the strings of a line of C++, Python or Bash, except for names of JSON members; with `words` also a shell's bare words."""
    if words:
        return re.split(r"""[\s"'();|&<>{}\[\]$]+|^\w+=""", text) + literals(text)
    return [a or b for a, b in re.findall(r'''(?<!\[)"((?:[^"\\]|\\.)*)"|(?<!\[)'((?:[^'\\]|\\.)*)\'''', text)]


def is_named(literal, names):
    """Returns whether the literal is a method's name, or a list of names with options, as --methods takes them."""
    return any(entry.partition(":")[0] in names for entry in literal.split(","))


def complaints(root, names):
    for folder in ("app", "bench", "compare", "session"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in (".hpp", ".cpp", ".sh", ".py", ".js"):
                continue
            file = path.relative_to(root).as_posix()
            if file in OF_PAPERS:
                continue
            comment = re.compile(r"(^|\s)#\s.*" if path.suffix in (".sh", ".py") else r"(^|\s)//.*|^#include.*")
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                if path.suffix == ".sh" and DEFAULT_LINES.match(line):
                    continue
                for literal in literals(comment.sub("", line), path.suffix == ".sh"):
                    if is_named(literal, names) and (file, literal) not in DEFAULTS:
                        yield f"{file}:{number}: names a method: {literal}"


def main():
    root, program = Path(sys.argv[1]), sys.argv[2]
    listed = subprocess.run([program, "methods", "--json"], check=True, capture_output=True, text=True).stdout
    names = {method["name"] for method in json.loads(listed)["methods"]}
    for planted in ('name == "pcss"', 'add("exact,pcss:size=8");'):  # tests that the search finds what it should
        assert any(is_named(literal, names) for literal in literals(planted)), planted
    assert any(is_named(literal, names) for literal in literals("for method in pcss exact; do", words=True))
    found = list(complaints(root, names))
    sys.exit("\n".join(found) if found else 0)


main()
