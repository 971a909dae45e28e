#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that every method of the program has a row in the bench's tables of seconds and error, and that every method
for planar lights is in the ranking: every_method_has_rows.py PROGRAM ROOT."""

import json
import subprocess
import sys
from pathlib import Path

program, root = sys.argv[1], Path(sys.argv[2])
methods = json.loads(subprocess.run([program, "methods", "--json"], check=True, capture_output=True, text=True).stdout)["methods"]
judged = [method for method in methods if method["family"] != "reference"]

times = json.loads((root / "docs/figures/papers/times.json").read_text(encoding="utf-8"))["data"]
domes = json.loads((root / "bench/results/domes.json").read_text(encoding="utf-8"))["rows"]
measured = {row[0].partition(":")[0] for scene, rows in times.items() if scene != "of" for row in rows}
measured |= {entry.partition(":")[0] for _, entry, *_ in domes}
ranking = json.loads((root / "docs/figures/ranking.json").read_text(encoding="utf-8"))
ranked = {entry.partition(":")[0] for cell in ranking["cells"].values() for entry in cell["methods"]}

complaints = [f"{method['name']}: no row in docs/figures/papers/times.json (docs/figures/papers/measure.py times) or bench/results/domes.json" for method in judged if method["name"] not in measured]
complaints += [f"{method['name']}: no place in docs/ranking.md (docs/figures/ranking.py measure)" for method in judged
               if method["name"] not in ranked and "rectangle" in method["lights"]]
assert len(judged) > 30 and len(ranking["cells"]) > 10, "nothing was looked at"
sys.exit("\n".join(complaints) if complaints else 0)
