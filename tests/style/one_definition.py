#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""one_definition.py SOURCE: tests that no two files define different types of one name in one namespace.

Compilers see one file at a time, and linkers keep only one constructor or destructor of each name: if there are two
types of that name, which of them runs depends on how the optimiser treated calls, and on the order of linking. Left out
are anonymous namespaces, types inside types, specialisations of others' templates, and the tests' sources (not their
headers), which belong to separate programs.
"""
import collections
import pathlib
import re
import subprocess
import sys

# Files that are built in place of others, with the same types.
ALTERNATIVES = {"render/opengl/absent.cpp"}

TOKEN = re.compile(
    r"(?:inline\s+)?namespace\s*(?P<namespace>[\w:]*)\s*\{"
    r"|\b(?:struct|class|union|enum(?:\s+class)?)\s+(?:\[\[\w+\]\]\s*|alignas\(\w+\)\s*|PENUMBRA_API\s+)*(?P<type>[\w:]+)(?P<rest>[^;{}()=]*)\{"
    r"|[{}]")
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.S)


def types_of(text):
    """Yields the qualified names of the types that a file defines outside anonymous namespaces, functions and other
    types."""
    scopes = []  # one for each open brace: a namespace's name, or None
    for token in TOKEN.finditer(NOT_CODE.sub(" ", text)):
        if token[0] == "}":
            if scopes:
                scopes.pop()
        elif token["namespace"] is not None:
            scopes.append(token["namespace"])
        else:
            name = token["type"]
            if name and all(scopes) and "<" not in token["rest"].split(":")[0]:
                yield "::".join([*scopes, name])
            scopes.append(None)


def main(source):
    listed = subprocess.run(["find", ".", "(", "-name", "CMakeCache.txt", "-printf", "%h\\n", ")"], cwd=source,
                            capture_output=True, text=True, check=True).stdout.split()
    builds = [pathlib.PurePath(build) for build in listed]
    places = collections.defaultdict(set)
    for path in sorted(source.rglob("*")):
        file = path.relative_to(source)
        if path.suffix not in {".cpp", ".hpp", ".h"} or str(file) in ALTERNATIVES:
            continue
        if (file.parts[0] == "tests" and path.suffix == ".cpp") or any(build in file.parents for build in builds):
            continue
        for name in types_of(path.read_text(errors="replace")):
            places[name].add(str(file))
    twice = {name: files for name, files in places.items() if len(files) > 1}
    for name, files in sorted(twice.items()):
        print(f"{name} is defined in {' and in '.join(sorted(files))}", file=sys.stderr)
    print(f"{len(places)} types")
    return 1 if twice else 0


sys.exit(main(pathlib.Path(sys.argv[1])))
