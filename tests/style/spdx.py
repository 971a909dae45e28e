#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""spdx.py SOURCE [--write]: checks that every source file names its licence at its beginning, in the form of SPDX. Prints
the files that do not, and exits with 1; with --write, adds the line to them. REUSE.toml names the licence of all other files."""
import pathlib
import subprocess
import sys

LINE = "SPDX-License-Identifier: Apache-2.0"
SLASHES = (".cpp", ".hpp", ".h", ".glsl", ".comp", ".frag", ".vert", ".js")
HASHES = (".py", ".sh", ".cmake")


def comment_of(path):
    """Returns the line as a comment of the file's language; None for a kind of file that gets none."""
    if path.suffix in SLASHES:
        return f"// {LINE}\n"
    if path.suffix in HASHES or path.name == "CMakeLists.txt":
        return f"# {LINE}\n"
    return f"/* {LINE} */\n" if path.suffix == ".css" else None


def source_files(source):
    """Returns the repository's files or, if it was unpacked from an archive, all files except built ones."""
    names = subprocess.run(["git", "-C", source, "ls-files", "-z"], capture_output=True, text=True)
    if names.returncode == 0:
        return [source / name for name in names.stdout.split("\0") if name]
    built = [cache.parent for cache in source.rglob("CMakeCache.txt")]
    return [path for path in source.rglob("*") if not any(folder in path.parents for folder in built)]


def main():
    source, missing = pathlib.Path(sys.argv[1]), 0
    for path in source_files(source):
        comment = comment_of(path)
        if comment is None or not path.is_file():
            continue
        text = path.read_text(encoding="utf-8")
        lines = text.splitlines(keepends=True)
        if any(LINE in line for line in lines[:2]):
            continue
        if "--write" in sys.argv[2:]:
            at = 1 if lines and lines[0].startswith("#!") else 0
            path.write_text("".join([*lines[:at], comment, *lines[at:]]), encoding="utf-8")
            continue
        print(f"{path.relative_to(source)}: no line \"{LINE}\" at its beginning (tests/style/spdx.py . --write adds it)")
        missing += 1
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
