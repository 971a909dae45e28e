# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of a page as a reader would, from top to bottom, in a folder that has scenes/:

  console.py PROGRAM SOURCE PAGE              fails if a command prints something else than the page says
  console.py PROGRAM SOURCE PAGE --show       prints what each command prints
  console.py PROGRAM SOURCE PAGE --pictures   writes the page's pictures of docs/images/start/ from what the commands wrote

Commands are the lines that begin with "$ " in blocks of the kind `console`; below each is its standard output, where "…"
stands for any text and a line "…" for any lines. A line "(exit code N)" ends the output of a command that fails.
`penumbra` and `./run.sh` are the program. A block of JSON below a line "`NAME`:" is a file of that name. If a page shows
pictures of docs/images/start/, its commands have to write files of these names."""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path


def commands(page):
    """Returns the commands of a page, each with the lines that it has to print."""
    found = []
    for block in re.findall(r"^```console\n(.*?)^```", page, re.S | re.M):
        for line in block.splitlines():
            if line.startswith("$ "):
                found.append((line[2:], []))
            elif found and found[-1][0].endswith("\\"):
                found[-1] = (found[-1][0][:-1] + line.strip(), [])
            else:
                found[-1][1].append(line)
    return found


def matches(output, expected):
    pattern = "".join(r"(?:.*\n)*?" if line.strip() == "…" else ".*".join(map(re.escape, line.rstrip().split("…"))) + r"[ \t]*\n" for line in expected)
    return re.fullmatch(pattern, output) is not None


def run(command, expected, folder, show):
    done = subprocess.run(["bash", "-c", command], cwd=folder, capture_output=True, text=True)
    code = int(expected.pop()[11:-1]) if expected and re.fullmatch(r"\(exit code \d+\)", expected[-1]) else 0
    if show:
        print(f"$ {command}\n{done.stdout}(exit code {done.returncode})", flush=True)
    elif done.returncode != code:
        sys.exit(f"{command}\nexit code {done.returncode} in place of {code}\n{done.stderr}")
    elif not matches(done.stdout, expected):
        sys.exit(f"{command}\nprints\n{done.stdout}\nand the page says\n" + "\n".join(expected))


def main():
    program, source, page = (Path(arg).resolve() for arg in sys.argv[1:4])
    text = page.read_text(encoding="utf-8")
    listed = commands(text)
    files = re.findall(r"^`([\w.-]+)`:\n+```json\n(.*?)^```", text, re.S | re.M)
    assert listed, f"{page} has no commands"
    for shown in ("a 0.3 s", "a\nb", "a 1 s\nb"):  # tests that the pattern finds what it should
        assert matches(shown + "\n", ["a …", "…"]) == shown.startswith("a "), shown
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scenes").symlink_to(source / "scenes")
        (folder / "bin").mkdir()
        for path in (folder / "bin" / "penumbra", folder / "run.sh"):
            path.write_text(f'#!/bin/sh\nexec {shlex.quote(str(program))} "$@"\n')
            path.chmod(0o755)
        for file, content in files:
            (folder / file).write_text(content)
        os.environ["PATH"] = f"{folder / 'bin'}:{os.environ['PATH']}"
        for command, expected in listed:
            run(command, expected, folder, "--show" in sys.argv)
        for picture in sorted(set(re.findall(r"images/start/([\w.-]+)", text))):
            written = next(folder.rglob(picture), folder / picture)
            assert written.is_file() and written.stat().st_size > 1000, f"no command of {page.name} writes {picture}"
            if "--pictures" in sys.argv:
                shutil.copyfile(written, source / "docs" / "images" / "start" / picture)


main()
