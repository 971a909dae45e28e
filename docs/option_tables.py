#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/options.md, the page with every option of every method, from `penumbra methods --json`.

  docs/option_tables.py [--program build/penumbra]            writes the page
  docs/option_tables.py [--program build/penumbra] --check    exits 1 if the page is not what this script writes, or if an option is
                                                              neither on its method's page nor on a page for shared options to
                                                              which the method's page refers (domes.md counts for every method
                                                              that supports domes)"""

import argparse
import json
import re
import subprocess
import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parent
# Options that several methods share, by the page that describes them.
SHARED = {"map-fits.md": ("cascades", "split", "splitShare", "tiles", "refine", "changed", "focus"), "domes.md": ("suns",)}
HEAD = """# Options of all methods

Every method with what it can do and the options that it takes. `docs/option_tables.py` generates this page from `penumbra methods --json`; do not edit it. An option is
given as `--method-option KEY=VALUE`, or after the method's name: `--method pcss:size=512`. `penumbra methods NAME` prints the same for one method.
"""


def cell(text):
    return text.replace("|", "\\|").replace("\n", " ")


def section(method):
    lights = ", ".join(method["lights"])
    lines = [f"## {method['name']}",
             f"[{method['name']}]({method['name']}.md): {method['family']}, {method['output']} output. {method['paper']}. Lights: {lights}.", ""]
    if not method["options"]:
        return "\n".join(lines + ["No options.", ""])
    lines += ["| option | values | default | meaning |", "| --- | --- | --- | --- |"]
    for option in method["options"]:
        values = option["values"].replace("|", ", ")
        lines.append(f"| `{option['name']}` | {cell(values)} | {cell(str(option['default']))} | {cell(option['help'])} |")
    return "\n".join(lines + [""])


def left_out(methods, folder=DOCS):
    """Finds options that are neither on their method's page nor, if shared, on a page of SHARED to which this page refers."""
    for method in methods:
        page = (folder / f"{method['name']}.md").read_text(encoding="utf-8")
        pages = [name for name in SHARED if f"]({name}" in page] + (["domes.md"] if "dome" in method["lights"] else [])
        owned = {option for name in pages for option in SHARED[name]}
        for option in method["options"]:
            name = option["name"]
            if name not in owned and not re.search(rf"(?<![\w-]){re.escape(name)}[=`]", page):
                yield f"docs/{method['name']}.md: lacks the option {name}"
    for name, options in SHARED.items():
        page = (folder / name).read_text(encoding="utf-8")
        yield from (f"docs/{name}: lacks the option {option}" for option in options if f"`{option}`" not in page)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=DOCS.parent / "build" / "penumbra")
    parser.add_argument("--check", action="store_true")
    args = parser.parse_args()
    listed = subprocess.run([args.program, "methods", "--json"], check=True, capture_output=True, text=True).stdout
    methods = json.loads(listed)["methods"]
    text = "\n".join([HEAD, *map(section, methods)])
    page = DOCS / "options.md"
    if not args.check:
        page.write_text(text, encoding="utf-8")
        return
    complaints = list(left_out(methods))
    if not page.is_file() or page.read_text(encoding="utf-8") != text:
        complaints.append("docs/options.md: not what docs/option_tables.py writes; run it")
    sys.exit("\n".join(complaints) if complaints else 0)


if __name__ == "__main__":
    main()
