#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""whole.py SOURCE: checks that no text has conflict marks of an unfinished merge, and that every Python file parses.
Prints the places that fail and exits with 1."""
import pathlib
import re
import sys

from spdx import source_files

MARK = re.compile(r"^(<{7}|>{7}) ", re.MULTILINE)


def main():
    source, wrong = pathlib.Path(sys.argv[1]), []
    for path in source_files(source):
        if not path.is_file():
            continue
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue  # a picture
        name = path.relative_to(source)
        for mark in MARK.finditer(text):
            wrong.append(f"{name}:{text.count(chr(10), 0, mark.start()) + 1}: a mark of a merge")
        if path.suffix == ".py":
            try:
                compile(text, str(path), "exec")
            except SyntaxError as error:
                wrong.append(f"{name}:{error.lineno}: {error.msg}")
    for line in wrong:
        print(line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
