# SPDX-License-Identifier: Apache-2.0
"""Tables with measured cells: kinds of cells, and writing a table to bench/results/NAME.json. bench/page_tables.py
declares the tables.

A cell is a text or an object with `value(bench)`. Cells that need different methods from the same `penumbra compare`
share one run: `Bench` first collects the methods that all tables need from each run. Uses only Python's standard
library."""

import json
import os
import platform
import re
import subprocess
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "bench" / "results"


@dataclass(frozen=True)
class Run:
    """One `penumbra compare` without its list of methods; `size`: None for the scene's own."""
    scene: str
    size: str | None
    reference: tuple
    light_samples: int | None = None
    pattern: str = "rows"
    more: tuple = ()

    def options(self):
        samples = () if self.light_samples is None else ("--light-samples", str(self.light_samples), "--sample-pattern", self.pattern)
        return (*(("--size", self.size) if self.size else ()), *self.reference, *samples, *self.more)


@dataclass(frozen=True)
class Compared:
    """A figure of a method in metrics.json: `of` is the path to it, or a function of the method's whole entry."""
    run: Run
    entry: str
    of: object

    def value(self, bench):
        method = bench.compared(self.run)[self.entry]
        if callable(self.of):
            return self.of(method)
        for key in self.of:
            method = None if method is None else method[key]
        return method


@dataclass(frozen=True)
class ProcessorSeconds:
    """User and system time of a whole `penumbra render`, the least of three runs."""
    scene: str
    entry: str
    options: tuple

    def value(self, bench):
        return min(bench.render(self.scene, "--layers", "V", "--method", self.entry, *self.options)[1] for _ in range(3))


@dataclass(frozen=True)
class Megabytes:
    """Size of the file that `penumbra render` writes."""
    scene: str
    options: tuple

    def value(self, bench):
        return bench.render(self.scene, *self.options)[0].stat().st_size / 1e6


@dataclass(frozen=True)
class Answer:
    """A figure from the JSON that a command prints, or writes to a file if its options end with --json."""
    command: tuple
    of: object

    def value(self, bench):
        return self.of(bench.answer(self.command))


@dataclass(frozen=True)
class Table:
    """Columns' heads and formats, and rows of cells, or a function of the bench that makes the rows; `merged`: rows
    that differ only in their first cell become one."""
    title: str
    conditions: str
    heads: tuple
    formats: tuple
    rows: object
    merged: bool = False


@dataclass
class Bench:
    """Makes the runs that the cells of some tables need. `scenes`: functions that return the JSON of scenes that are
    not in scenes/."""
    program_path: Path
    folder: Path
    scenes: dict
    wanted: dict = field(default_factory=dict)
    done: dict = field(default_factory=dict)

    def __post_init__(self):
        self.answer = cache(self.answer)

    def program(self, *arguments):
        return subprocess.run([self.program_path, *arguments, "--quiet"], check=True, capture_output=True, text=True).stdout

    def render(self, scene, *options):
        """Returns the file that `penumbra render` writes, and the processor seconds that it takes."""
        out, before = self.folder / "rendered.exr", os.times()
        self.program("render", self.scene(scene), "-o", out, *options)
        after = os.times()
        return out, after.children_user + after.children_system - before.children_user - before.children_system

    def printed(self, test, tests, pattern):
        """Returns the groups of each line of a test's output that fits the pattern; texts of numbers are converted."""
        out = subprocess.run([self.program_path.with_name(test), f"--gtest_filter={tests}"], check=True, capture_output=True, text=True).stdout
        found = [tuple(map(number, groups)) for groups in re.findall(pattern, out, re.M)]
        if not found:
            raise SystemExit(f"{test}, {tests}: prints no line that fits {pattern}")
        return found

    def lines(self, *options):
        """Returns the JSON lines of a run of penumbra-bench."""
        out = self.folder / "lines.json"
        out.unlink(missing_ok=True)
        subprocess.run([self.program_path.with_name("penumbra-bench"), *options, "--json", out], check=True, capture_output=True)
        return [json.loads(line) for line in out.read_text(encoding="utf-8").splitlines()]

    def scene(self, name):
        if name not in self.scenes:
            return ROOT / "scenes" / f"{name}.json"
        path = self.folder / f"{name.replace('/', '-')}.json"
        path.write_text(json.dumps(self.scenes[name]()), encoding="utf-8")
        return path

    def want(self, rows):
        for cell in (cell for row in rows for cell in row if isinstance(cell, Compared)):
            self.wanted.setdefault(cell.run, {})[cell.entry] = None

    def compared(self, run):
        """Returns the entries of metrics.json from one run with all methods that any cell needs from it."""
        if run not in self.done:
            entries, out = list(self.wanted[run]), self.folder / "compared"
            print(f"{run.scene}: {' '.join(run.options())}: {', '.join(entries)}", flush=True)
            self.program("compare", self.scene(run.scene), "-o", out, "--methods", ",".join(entries), "--runs", "1", *run.options())
            metrics = json.loads((out / "metrics.json").read_text(encoding="utf-8"))
            self.done[run] = {entry: {**method, "judgedPixels": metrics["judgedPixels"]} for entry, method in zip(entries, metrics["methods"], strict=True)}
        return self.done[run]

    def answer(self, command):
        if command[-1] != "--json" or command[0] == "devices":
            return json.loads(self.program(*command))
        out = self.folder / "answer.json"
        self.program(*(self.scene(part.removeprefix("scene:")) if part.startswith("scene:") else part for part in command), out)
        return json.loads(out.read_text(encoding="utf-8"))


def number(text):
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def machine():
    names = (line.partition(":")[2].strip() for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines() if line.startswith("model name"))
    return f"{next(names, platform.processor())}, {os.cpu_count()} threads, load {os.getloadavg()[1]:.0f}"


def head_commit():
    return subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], check=True, capture_output=True, text=True).stdout.strip()


def rounded(value):
    """Rounds to four significant digits; the pages print fewer."""
    return float(f"{value:.4g}") if isinstance(value, float) else value


def printed(row, formats):
    return tuple(f"{cell:{form}}" if isinstance(cell, float) and form else cell for cell, form in zip(row, formats))


def merged(rows, formats):
    """Merges rows whose cells after the first are printed alike; the first cell lists the first cells of all."""
    groups = {}
    for row in rows:
        groups.setdefault(printed(row[1:], formats[1:]), []).append(row)
    return [[", ".join(row[0] for row in group), *group[0][1:]] for group in groups.values()]


def save(name, table, commit, bench):
    rows = table.rows(bench) if callable(table.rows) else table.rows
    values = [[rounded(cell.value(bench) if hasattr(cell, "value") else cell) for cell in row] for row in rows]
    if table.merged:
        values = merged(values, table.formats)
    data = {"title": table.title, "commit": commit, "machine": machine(), "command": f"bench/page_tables.py {name}", "conditions": table.conditions,
            "columns": list(table.heads), "formats": list(table.formats), "rows": None}
    lines = ",\n  ".join(json.dumps(row, ensure_ascii=False) for row in values)
    fields = [f' "{key}": ' + (f"[\n  {lines}\n ]" if key == "rows" else json.dumps(value, ensure_ascii=False)) for key, value in data.items()]
    (RESULTS / f"{name}.json").write_text("{\n" + ",\n".join(fields) + "\n}\n", encoding="utf-8")


def measure(tables, bench, commit):
    for table in tables.values():
        if not callable(table.rows):
            bench.want(table.rows)
    for name, table in tables.items():
        save(name, table, commit, bench)
        print(f"{name}: done", flush=True)
