#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""licence.py BUILD: tests that no object of the library, the programs or the Python module depends on a header that is
under the GPL alone.

Reads each object's headers as ninja has recorded them, and the headers' SPDX lines. Such headers are allowed in objects of
tests and of penumbra-repair, which is a separate program for that reason. penumbra-repair must depend on one: otherwise
this test would examine nothing.
"""
import re
import subprocess
import sys

ALLOWED = re.compile(r"(^|/)CMakeFiles/(penumbra[-_]repair|[a-z_]+_test)\.dir/")
SKIPPED = 77


def is_gpl_alone(header, known={}):
    """Returns whether the file is under the GPL, without LGPL or a permissive licence as an alternative, and without an exception
    like that of Linux."""
    if header not in known:
        try:
            with open(header, encoding="utf-8", errors="replace") as file:
                lines = re.findall(r"SPDX-License-Identifier:(.*)", file.read(4096))
        except FileNotFoundError:  # an object of an earlier state of the tree
            lines = []
        known[header] = any(re.search(r"\bGPL-", line) and not re.search(r"LGPL|BSL|MIT|Apache| WITH ", line) for line in lines)
    return known[header]


def main(build):
    try:
        recorded = subprocess.run(["ninja", "-C", build, "-t", "deps"], capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        print("this folder was not built by ninja")
        return SKIPPED
    target, offenders, allowed = "", {}, 0
    for line in recorded.splitlines():
        if not line.startswith(" "):
            target = line.partition(":")[0]
        elif line.strip().startswith("/") and is_gpl_alone(line.strip()):
            if ALLOWED.search(target):
                allowed += 1
            else:
                offenders.setdefault(target, []).append(line.strip())
    for target, headers in sorted(offenders.items()):
        print(f"{target} includes {len(headers)} headers under the GPL, the first of them {headers[0]}")
    if not allowed:
        print("not even penumbra-repair includes a header under the GPL: is it built?")
        return SKIPPED
    return 1 if offenders else 0


sys.exit(main(*sys.argv[1:]))
