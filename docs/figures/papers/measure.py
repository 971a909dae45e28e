#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the numbers of the papers' figures with a built program, and draws the figures. Needs only Python's standard library and the
models of Debian's glmark2-data.

  docs/figures/papers/measure.py [NAME…] [--program build/penumbra]      all of them: an hour or two on two cores"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
sys.path.insert(0, str(Path(__file__).resolve().parent))

from experiment import ROOT, Runner  # noqa: E402
from papers import FIGURES, HERE, drawn  # noqa: E402


def written(kept, data):
    """Returns JSON with one line for each part of the data."""
    text = json.dumps(kept, ensure_ascii=False, indent=1).removesuffix("\n}")
    parts = [f"  {json.dumps(name)}: {json.dumps(part, ensure_ascii=False)}" for name, part in data.items()]
    return text + ',\n "data": {\n' + ",\n".join(parts) + "\n }\n}\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="one of " + ", ".join(FIGURES))
    parser.add_argument("--program", type=Path, default=ROOT / "build" / "penumbra")
    args = parser.parse_args()
    unknown = [name for name in args.names if name not in FIGURES]
    if unknown:
        parser.error(f"no figure {unknown[0]}; there are " + ", ".join(FIGURES))
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], check=True, capture_output=True, text=True)
    for name in args.names or FIGURES:
        runner = Runner(args.program)
        data = FIGURES[name][0](runner)
        kept = {"commit": commit.stdout.strip(), "device": runner.device, "commands": runner.commands}
        (HERE / f"{name}.json").write_text(written(kept, data), encoding="utf-8")
        (HERE / f"{name}.svg").write_text(drawn(name), encoding="utf-8")
        print(name, flush=True)


main()
