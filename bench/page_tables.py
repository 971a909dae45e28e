#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures tables of pages about methods: errors against exact areas, and counters.

  bench/page_tables.py [--build build] [NAME …]     measures the named tables, all without names, and writes bench/results/NAME.json

`bench/tables.py` then writes the pages. Errors and counters are of one `penumbra compare` a scene, with the methods of all named tables; they depend on no
machine and no load. Uses Python's standard library alone."""

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "bench" / "results"
AREAS = "edge-scatter:rows=exact"
SIZE = "128x128"
FIVE = ("parallel-square", "contact", "fusion", "room", "bunny")


@dataclass(frozen=True)
class Compared:
    """A column from metrics.json: `path` in the entry of a method."""
    head: str
    entry: str
    path: tuple
    form: str | None = ".4f"


@dataclass(frozen=True)
class Table:
    title: str
    conditions: str
    scenes: tuple
    columns: tuple
    size: str = SIZE
    light_samples: int | None = None


@dataclass(frozen=True)
class Measured:
    title: str
    conditions: str
    columns: list
    formats: list
    rows: list


def rmse(head, entry):
    return Compared(head, entry, ("error", "rmse"))


def largest(head, entry):
    return Compared(head, entry, ("error", "max"), ".2f")


def count(head, entry, name):
    return Compared(head, entry, ("counters", name), None)


def wedge_columns(entry):
    return (count("silhouette edges", entry, "silhouetteEdges"), count("wedges on screen", entry, "wedgesOnScreen"), count("fragments", entry, "fragments"),
            rmse("RMSE", entry), largest("largest error", entry))


VARIANTS = ("z-fail", "zp+", "cc", "split", "hierarchical", "tiles")
SPLITS = ("soft-volume", "soft-volume:split=2", "soft-volume:split=3")
EIGHT = ("parallel-square", "contact", "broken", "fusion", "large-penumbra", "room", "self-shadow", "bunny")


def variants(name):
    return tuple(count(f"`{variant}`", f"hard-volume:variant={variant}", name) for variant in VARIANTS)


def errors(head, entry):
    return (rmse(f"{head}: RMSE", entry), largest("largest error", entry))


ERRORS = "128 × 128 pixels; errors of V over judged pixels against exact areas (`edge-scatter:rows=exact`)."

TABLES = {
    "plateaus": Table("plateaus: errors beside wedge-ramp and hard shadows", ERRORS, FIVE,
                      (rmse("RMSE", "plateaus"), largest("largest error", "plateaus"), rmse("wedge-ramp: RMSE", "wedge-ramp"), rmse("hard-volume: RMSE", "hard-volume"))),
    "alias-free": Table("alias-free: errors of a hard shadow", ERRORS, FIVE,
                        (rmse("`alias-free`: RMSE", "alias-free"), rmse("`hard-volume`", "hard-volume"), rmse("`shadow-map`", "shadow-map"),
                         rmse("`edge-scatter`, 256 light samples", "edge-scatter"))),
    "wedge-ramp": Table("wedge-ramp: wedges, fragments and errors", ERRORS, FIVE,
                        (*wedge_columns("wedge-ramp"), rmse("soft-volume: RMSE", "soft-volume"), rmse("hard-volume: RMSE", "hard-volume"))),
    "soft-volume": Table("soft-volume: wedges, fragments and errors", ERRORS, FIVE, wedge_columns("soft-volume")),
    "soft-volume-blend": Table("soft-volume-blend: wedges, fragments and errors", ERRORS, FIVE,
                               (*wedge_columns("soft-volume-blend"), rmse("soft-volume: RMSE", "soft-volume"), rmse("hard-volume: RMSE", "hard-volume"))),
    "wedge-fragments": Table("fragments of soft-volume's wedges", "128 × 128 pixels. A fragment is a pixel of a wedge's footprint.", FIVE,
                             tuple(count(head, entry, "fragments") for head, entry in (("`tests=none`", "soft-volume:tests=none"), ("`z`", "soft-volume:tests=z"), ("`both`", "soft-volume"),
                                                                                       ("`both`, tight", "soft-volume:construction=tight")))),
    "soft-irregular": Table("soft-irregular: errors, with leaks and with layers", ERRORS, ("contact", "fusion", "room"),
                            (rmse("RMSE", "soft-irregular"), Compared("mean error", "soft-irregular", ("error", "bias"), "+.4f"), largest("largest error", "soft-irregular"),
                             rmse("`umbra=layers`: RMSE", "soft-irregular:umbra=layers"), largest("largest error", "soft-irregular:umbra=layers"))),
    "hard-volume-fragments": Table("fragments of hard-volume's variants", "512 × 512 pixels. A fragment is a pixel of the box that a face of a volume covers.",
                                   ("fusion", "room", "thin", "bunny"), variants("fragments"), "512x512"),
    "hard-volume-updates": Table("changes of counts by hard-volume's variants", "512 × 512 pixels. A change is what a stencil would be written for.",
                                 ("fusion", "room", "thin", "bunny"), variants("countUpdates"), "512x512"),
    "hard-volume-culled": Table("what hard-volume's variants leave out", "512 × 512 pixels.", ("fusion", "room", "thin", "bunny"),
                                (count("`cc`: volumes", "hard-volume:variant=cc", "volumes"), count("culled", "hard-volume:variant=cc", "culledVolumes"),
                                 count("cut", "hard-volume:variant=cc", "clampedVolumes"), count("`hierarchical`: triangles", "hard-volume:variant=hierarchical", "volumes"),
                                 count("culled", "hard-volume:variant=hierarchical", "culledVolumes"), count("`tiles`: tiles", "hard-volume:variant=tiles", "tiles"),
                                 count("whole", "hard-volume:variant=tiles", "wholeTiles")), "512x512"),
    "soft-volume-split": Table("soft-volume: errors with a split light", ERRORS, EIGHT,
                               (*(column for entry, head in zip(SPLITS, ("`split=1`", "`split=2`", "`split=3`")) for column in errors(head, entry)),
                                rmse("`coverage=table`: RMSE", "soft-volume:coverage=table"), rmse("hard-volume: RMSE", "hard-volume"))),
    "layer-rays": Table("layer-rays beside other methods of one map", "64 × 64 pixels, 64 light samples, maps of 1024²; RMSE of V over judged pixels against exact areas (`edge-scatter:rows=exact`).",
                        ("bunny", "contact", "fusion"),
                        tuple(rmse(f"`{entry}`", entry) for entry in ("layer-rays:layers=1", "layer-rays:layers=4", "bitmask", "contour", "backproject", "shadow-map")), "64x64", 64),
    "hierarchical-penumbra": Table("errors of 256 light samples, and of view-sample-planar's table",
                                   "128 × 128 pixels, 256 light samples in rows; errors of V over judged pixels against exact areas (`edge-scatter:rows=exact`).",
                                   ("broken", "contact", "fusion", "parallel-square", "thin"),
                                   (*errors("`hierarchical-penumbra`", "hierarchical-penumbra"), *errors("`view-sample:variant=sintorn`", "view-sample:variant=sintorn"),
                                    *errors("`view-sample-planar:lookup=nearest`", "view-sample-planar:lookup=nearest")), SIZE, 256),
    "depth-complexity-forest": Table("errors of depth-complexity's silhouettes from the light's centre",
                                     "256 × 256 pixels, 16 light samples in rows; errors of V over judged pixels against exact areas (`edge-scatter:rows=exact`). Every bit of "
                                     "`depth-complexity` is right: its errors are those of 16 light samples.",
                                     ("parallel-square", "contact", "broken", "fusion", "large-penumbra", "room", "self-shadow", "thin", "bunny"),
                                     (count("silhouette edges", "depth-complexity:variant=forest", "silhouetteEdges"), *errors("`variant=forest`", "depth-complexity:variant=forest"),
                                      Compared("mean error", "depth-complexity:variant=forest", ("error", "bias"), "+.4f"), *errors("`depth-complexity`", "depth-complexity"),
                                      *(count(f"pixels that overflow {bits} bits", f"depth-complexity:variant=forest:counter-bits={bits}", "overflowPixels") for bits in (16, 8, 6))),
                                     "256x256", 16),
}


def compared(program, folder, scene, entries, size, light_samples):
    """The entries of metrics.json by one run with all methods that any column asks of this scene."""
    out = folder / "compared"
    subprocess.run([program, "compare", ROOT / "scenes" / f"{scene}.json", "-o", out, "--methods", ",".join(entries), "--reference", AREAS, "--size", size, "--quiet",
                    "--runs", "1", *(["--light-samples", str(light_samples), "--sample-pattern", "rows"] if light_samples else [])],
                   check=True, stdout=subprocess.DEVNULL)
    return dict(zip(entries, json.loads((out / "metrics.json").read_text(encoding="utf-8"))["methods"], strict=True))


def value_of(metrics, column):
    value = metrics[column.entry]
    for key in column.path:
        value = value[key]
    return value


def machine():
    names = (line.partition(":")[2].strip() for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines() if line.startswith("model name"))
    return f"{next(names, platform.processor())}, {os.cpu_count()} threads, load {os.getloadavg()[1]:.0f}"


def save(name, measured):
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], check=True, capture_output=True, text=True).stdout.strip()
    data = {"title": measured.title, "commit": commit, "machine": machine(), "command": f"bench/page_tables.py {name}", "conditions": measured.conditions,
            "columns": measured.columns, "formats": measured.formats, "rows": None}
    rows = ",\n  ".join(json.dumps([rounded(cell) for cell in row], ensure_ascii=False) for row in measured.rows)
    fields = [f' "{key}": ' + (f"[\n  {rows}\n ]" if key == "rows" else json.dumps(value, ensure_ascii=False)) for key, value in data.items()]
    text = "{\n" + ",\n".join(fields) + "\n}"
    (RESULTS / f"{name}.json").write_text(text + "\n", encoding="utf-8")


def rounded(value):
    """To four significant digits: the pages print fewer."""
    return float(f"{value:.4g}") if isinstance(value, float) else value


def measured_table(table, metrics):
    return Measured(table.title, table.conditions, ["scene", *(column.head for column in table.columns)], [None, *(column.form for column in table.columns)],
                    [[scene, *(value_of(metrics[scene], column) for column in table.columns)] for scene in table.scenes])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(TABLES))
    asked = parser.parse_args()
    if unknown := set(asked.names) - TABLES.keys():
        parser.error(f"no table {', '.join(sorted(unknown))}; what there is: {', '.join(TABLES)}")
    names = asked.names or list(TABLES)
    with tempfile.TemporaryDirectory() as folder:
        measure({name: TABLES[name] for name in names}, asked.build / "penumbra", Path(folder))


def measure(tables, program, folder):
    """Runs each scene once a size and number of light samples, with the methods of all these tables."""
    entries = {}
    for table in tables.values():
        for scene in table.scenes:
            entries.setdefault((scene, table.size, table.light_samples), {}).update(dict.fromkeys(column.entry for column in table.columns))
    metrics = {}
    for (scene, size, light_samples), methods in entries.items():
        print(f"{scene}: {', '.join(methods)}", flush=True)
        metrics[scene, size, light_samples] = compared(program, folder, scene, list(methods), size, light_samples)
    for name, table in tables.items():
        save(name, measured_table(table, {scene: metrics[scene, table.size, table.light_samples] for scene in table.scenes}))


main()
