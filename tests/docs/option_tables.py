#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests which options docs/option_tables.py --check reports as missing on a method's page: option_tables.py DOCS."""

import sys
import tempfile
from pathlib import Path

sys.path.insert(0, sys.argv[1])
import option_tables  # noqa: E402

OWNED = option_tables.SHARED["map-fits.md"]


def missing(page, *options, lights=("sun",)):
    """Returns the names among `options` that are missing if a method's own page is `page`."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "m.md").write_text(page, encoding="utf-8")
        (folder / "shadow-map.md").write_text("| `size` | `bias` |", encoding="utf-8")
        (folder / "domes.md").write_text("`suns`", encoding="utf-8")
        (folder / "map-fits.md").write_text(" ".join(f"`{name}`" for name in OWNED) + " `other`", encoding="utf-8")
        method = {"name": "m", "lights": lights, "options": [{"name": name} for name in options]}
        return [line.split()[-1] for line in option_tables.left_out([method], folder)]


def expect(found, wanted):
    if found != wanted:
        sys.exit(f"{found} in place of {wanted}")


expect(missing("| `size` | and `m:bias=2` |", "size", "bias"), [])
expect(missing("| `mapsize` | and `rebias=2`, `re-bias=2` |", "size", "bias"), ["size", "bias"])  # these are only parts of other names
expect(missing("see [shadow-map](shadow-map.md)", "size"), ["size"])  # that page does not own the option
expect(missing("see [fits](map-fits.md)", OWNED[0], "other"), ["other"])
expect(missing("no page is referred to", "suns", lights=("sun", "dome")), [])
expect(missing("no page is referred to", "suns"), ["suns"])
expect(missing("no page is referred to", OWNED[0]), [OWNED[0]])
