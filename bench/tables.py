#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the tables of bench/README.md and docs/*.md from bench/results/*.json, and the list of these files in bench/results/README.md.

  bench/tables.py            writes them
  bench/tables.py --check    exits 1 if a page is not what this script writes, or if a file of results lacks commit, machine or command

A table stands between the lines `<!-- results/NAME.json -->` and `<!-- end -->`. A file of results has `title`, `commit`, `machine`, `command`, `conditions`, `columns` and
`rows`; a row holds texts and numbers, null where nothing was measured; `formats`, if present, has the format of each column's numbers. `recordedAt` in place of `commit` names the commit that recorded the figures, if the measured commit is
not known."""

import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / "docs" / "figures"), str(ROOT / "docs" / "figures" / "papers")]

import scaling  # noqa: E402
import times  # noqa: E402

RESULTS = ROOT / "bench" / "results"
BLOCK = re.compile(r"(<!-- results/([\w-]+)\.json -->\n).*?(<!-- end -->)", re.S)
DRAWN = {"times": times.table, **scaling.TABLES}
OWN_PAGE = {"against-cycles"}  # another script writes the page
PAGES = [page for page in (ROOT / "bench" / "README.md", *sorted((ROOT / "docs").glob("*.md"))) if "<!-- results/" in page.read_text(encoding="utf-8")]


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))


def decimals(value):
    return len(repr(value).partition(".")[2]) if isinstance(value, float) and "e" not in repr(value) else 0


def column_texts(values, form):
    """Returns a column's cells as texts: by the column's format, or all with as many decimals as the longest; large
    integers get commas."""
    places = max((decimals(value) for value in values if isinstance(value, float)), default=0)
    if form is None:
        form = ".1e" if any("e" in repr(value) for value in values if isinstance(value, float)) else f".{places}f"
    return [f"{value:{form}}" if isinstance(value, float) else f"{value:,}" if isinstance(value, int) and value >= 10000 else "" if value is None else str(value)
            for value in values]


def table(data):
    when = f"Commit {data['commit']}" if "commit" in data else f"Written down at {data['recordedAt']}, the measured commit is not known"
    lines = [f"{when}; {data['machine']}. {data['conditions']}", "", f"`{data['command']}`", ""]
    columns = list(zip(*data["rows"]))
    texts = [isinstance(cell, str) for cell in data["rows"][0]]
    lines += ["| " + " | ".join(data["columns"]) + " |", "| " + " | ".join("---" if text else "---:" for text in texts) + " |"]
    lines += ["| " + " | ".join(row) + " |" for row in zip(*map(column_texts, columns, data.get("formats", [None] * len(columns))))]
    return "\n".join(lines) + "\n"


def block(name):
    """Returns the table of one file. Tables of drawn figures are made from the figures' numbers, which are stored with
    the figures."""
    if name not in DRAWN:
        return table(read(RESULTS / f"{name}.json"))
    kept = read(ROOT / "docs" / "figures" / "papers" / f"{name}.json")
    return f"Commit {kept['commit']}; {kept['device']}. {kept['data']['of']}.\n\n{DRAWN[name](kept['data'])}\n"


def listing(files):
    lines = ["# Results", "", "Measured figures, a file a question: what was measured at which commit, on which machine, by which command. `bench/tables.py` writes this list, and tables of",
             "[bench/README.md](../README.md) and of pages in `docs/`, from these files; do not edit either.", "", "| file | what | commit | machine |", "| --- | --- | --- | --- |"]
    for path in files:
        data = read(path)
        lines.append(f"| [{path.name}]({path.name}) | {data['title']} | {data.get('commit', 'not known')} | {data['machine']} |")
    return "\n".join(lines) + "\n"


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__)
    files, complaints = sorted(RESULTS.glob("*.json")), []
    before = {page: page.read_text(encoding="utf-8") for page in PAGES}
    for path in files:
        data = read(path)
        keys = ("title", "machine", "command") if path.stem in OWN_PAGE else ("title", "machine", "command", "conditions", "columns", "rows")
        complaints += [f"{path.name}: lacks {key}" for key in keys if key not in data]
        complaints += [] if {"commit", "recordedAt"} & data.keys() else [f"{path.name}: lacks commit"]
        if path.stem in OWN_PAGE:
            continue
        complaints += [] if any(f"<!-- results/{path.name} -->" in text for text in before.values()) else [f"{path.name}: no page shows it"]
    if complaints:
        sys.exit("\n".join(complaints))
    texts = {page: BLOCK.sub(lambda found: found[1] + block(found[2]) + found[3], text) for page, text in before.items()}
    texts |= {RESULTS / "README.md": listing(files)}
    for path, text in texts.items():
        if not check:
            path.write_text(text, encoding="utf-8")
        elif not path.is_file() or path.read_text(encoding="utf-8") != text:
            complaints.append(f"{path.relative_to(ROOT)}: not what bench/tables.py writes; run it")
    sys.exit("\n".join(complaints) if complaints else 0)


main()
