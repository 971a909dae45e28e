# SPDX-License-Identifier: Apache-2.0
"""Runs the code of docs/python.md from top to bottom, as a reader would: page.py PENUMBRA SOURCE. The last lines check
the results."""

import os
import pathlib
import re
import sys
import tempfile

source = pathlib.Path(sys.argv[2]).resolve()
page = (source / "docs" / "python.md").read_text()
blocks = re.findall(r"^```python\n(.*?)^```", page, re.S | re.M)
assert len(blocks) >= 5, "the page has lost its code"
names = {}
with tempfile.TemporaryDirectory() as folder:
    os.symlink(source / "scenes", pathlib.Path(folder, "scenes"))
    os.chdir(folder)
    for number, block in enumerate(blocks, 1):
        try:
            exec(compile(block, f"docs/python.md, block {number}", "exec"), names)
        except Exception:
            print(block)
            raise
    for picture in re.findall(r'savefig\("([^"]+)"', page):
        assert pathlib.Path(picture).stat().st_size > 1000, f"{picture} was not drawn"
    os.chdir("/")
