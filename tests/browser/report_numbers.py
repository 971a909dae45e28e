#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests tables, plots and texts of the report in a browser, where a script draws them from the JSON in the page. Those
of a real comparison are compared with metrics.json; others come from JSON that the test changes.
  report_numbers.py PROGRAM SCENE [PHOTOGRAPHS]   PHOTOGRAPHS: a folder for pictures of the page, for people to look at"""
import copy
import csv
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from browser import Browser  # noqa: E402
from claims import expect, same, verdict  # noqa: E402

METHODS = ["edge-scatter", "pcss:size=16", "bitmask:size=16:occluder=patch"]
CAUSES = ("resolution", "view", "layers", "fusion", "gaps", "bias", "samples", "falloff")
DATA = re.compile(r'(<script type="application/json" id="report-data">)(.*?)(</script>)', re.S)
WINDOWS = {"wide": {"width": 1400, "height": 900}, "narrow": {"width": 390, "height": 844, "phone": True},
           "dark": {"width": 1400, "height": 900, "dark": True}}


def general(number):
    """Formats a number with three significant digits, as the page does."""
    mantissa, _, exponent = f"{number:.3g}".partition("e")
    return (mantissa + (f"e{int(exponent)}" if exponent else "")).replace("-", "−", 1 if number < 0 else 0)


class Numbers:
    """The page of a comparison, unchanged or with its JSON changed."""

    def __init__(self, browser, folder):
        self.browser, self.folder = browser, folder
        self.html = (folder / "report.html").read_text(encoding="utf-8")
        self.data = json.loads(DATA.search(self.html)[2])
        self.metrics = json.loads((folder / "metrics.json").read_text(encoding="utf-8"))

    def open(self, change=None, hash="", **window):
        """Opens the page. `change` is a function that changes the page's JSON in place."""
        data = copy.deepcopy(self.data)
        if change:
            change(data)
        path = self.folder / "changed.html"
        text = json.dumps(data).replace("<", "\\u003c")
        path.write_text(DATA.sub(lambda found: found[1] + text + found[3], self.html), encoding="utf-8")
        self.browser.open(path.as_uri() + hash, **window)

    def table(self, caption):
        """Returns rows of [text, value, class of the cell's content] of the table whose caption begins with `caption`,
        or None if there is no such table."""
        return self.browser.ask(f"""(() => {{
            const table = [...document.querySelectorAll('table.sortable')].find(t => t.caption.textContent.startsWith({json.dumps(caption)}));
            return table && [...table.rows].slice(1).map(row => [...row.cells].map(cell =>
                [cell.textContent, cell.dataset.value === undefined ? null : Number(cell.dataset.value), cell.querySelector('span')?.className ?? '']));
        }})()""")

    def values(self, caption):
        return [[row[0][0], *(cell[1] for cell in row[1:])] for row in self.table(caption) or []]

    def card(self, title):
        return self.browser.ask(f"""[...document.querySelectorAll('#glance > div')].find(
            c => c.querySelector('dt').textContent === {json.dumps(title)})?.querySelector('dd').innerText.replace('\\n', ': ') ?? null""")


def error_row(name, error, *more):
    return [name, *(error[key] for key in ("mean", "rmse", "p999", "max", "over05", "bias")), *more]


def check_tables(page):
    """Every table has the numbers of metrics.json, with all digits."""
    page.open()
    metrics, methods = page.metrics, page.metrics["methods"]
    rays, lights = metrics["sameSamples"], [light["name"] for light in methods[0]["lights"]]
    same(len(lights), 2, "lights of the scene")
    cost = f"rays on the same light samples{rays['method']}, {rays['lightSamples']} light samples: the cost of that number of light samples"
    same(page.values("Error of V against raytrace under all lights together"),
         [error_row(m["entry"], m["errorAllLights"], m["beautyError"]["relativeRmse"]) for m in methods] +
         [error_row(cost, rays["errorAllLights"], None)], "errors under all lights")
    for i, name in enumerate(lights):
        of, under = [(m["entry"], m["lights"][i]) for m in methods], f"under light \u201c{name}\u201d"
        same(page.values(f"Error of V against raytrace {under}. 0 would"),
             [error_row(entry, light["error"]) for entry, light in of] + [error_row(cost, rays["lights"][i]["error"])], f"errors {under}")
        horizon = page.values(f"Error of V against raytrace {under} at")
        same(horizon, [error_row(entry, light["horizonError"]) for entry, light in of] if of[0][1]["horizonPixels"] else [], f"horizon {under}")
        same(page.values(f"RMSE of V {under} by what happens"), [[entry, *(part["rmse"] for part in light["classes"].values())] for entry, light in of],
             f"classes {under}")
        for caption, pick in (("in penumbrae, by their width there, in pixels", lambda light: light["penumbraWidth"]["pixels"]),
                              ("in penumbrae, by their width there, in texels", lambda light: light["penumbraWidth"]["texels"]),
                              ("in shadows", lambda light: light["contactDistance"]["pixels"])):
            same(page.values(f"RMSE of V {under} {caption}"), [[entry, *(part["rmse"] for part in pick(light))] for entry, light in of if pick(light)],
                 f"{caption} {under}")
        masked = [(entry, light["sameSamples"]) for entry, light in of if light["sameSamples"]]
        for entry, pairs in masked:
            same([row[1:3] + row[4:5] for row in rows_under(page, "On how many", name) if row[0] == entry],
                 [[pairs["pairsDiffering"], pairs["pairsAll"], pairs["pairs"]]], f"pairs of {entry} {under}")
    same(page.values("Seconds on the machine")[1][1:2] + page.values("Seconds on the machine")[1][-2:],
         [methods[0]["seconds"]["shadow"], methods[0]["peakMemoryBytes"], len(methods[0]["passes"])], "seconds, bytes and passes")
    same(page.browser.ask("""[...document.querySelectorAll('details')].filter(d => d.firstChild.textContent.startsWith('Passes and counters of'))
        .map(d => [...d.querySelectorAll('tbody tr')].length)"""), [len(m["passes"]) + len(m["counters"]) for m in methods], "passes and counters")
    same(page.browser.ask("[...document.querySelectorAll('table')].every(t => [...t.querySelectorAll('th')].every(h => h.scope))"), True, "a scope for each header")
    same(page.browser.ask("[...document.querySelectorAll('nav a, tbody a')].every(a => document.getElementById(decodeURIComponent(a.hash.slice(1))))"), True,
         "links lead somewhere")


def rows_under(page, caption, light):
    """Returns the values of the table of pairs of one light."""
    return page.browser.ask(f"""(() => {{
        const table = [...document.querySelectorAll('table.sortable')].find(t => t.caption.textContent.startsWith({json.dumps(caption)})
            && t.caption.textContent.includes({json.dumps(light)}));
        return table ? [...table.tBodies[0].rows].map(row => [row.cells[0].textContent, ...[...row.cells].slice(1).map(c => Number(c.dataset.value))]) : [];
    }})()""")


def check_sorting(page):
    """Tables are sorted by the keyboard, and saved."""
    page.open()
    browser = page.browser
    wanted = [method["errorAllLights"]["rmse"] for method in page.metrics["methods"]] + [page.metrics["sameSamples"]["errorAllLights"]["rmse"]]
    table = "[...document.querySelectorAll('#numbers table.sortable')].find(t => t.caption.textContent.includes('all lights'))"
    text = browser.ask(f"""(() => {{
        const made = URL.createObjectURL.bind(URL);
        let saved;
        URL.createObjectURL = (blob) => {{ saved = blob; return made(blob); }};
        {table}.querySelector('.csv').click();
        return saved.text();
    }})()""")
    lines = list(csv.reader(text.splitlines()))
    same([float(line[2]) for line in lines[1:]], wanted, "the saved table has the same numbers")
    same(lines[0][:3], ["Method", "Mean", "RMSE"], "and headers")
    expect(browser.ask("[...document.querySelectorAll('table.sortable caption')].every(c => c.querySelector('.csv'))"), "every table can be saved")
    browser.ask(f"{table}.tHead.rows[0].cells[2].querySelector('button').focus()")
    for order, values in (("ascending", sorted(wanted)), ("descending", sorted(wanted, reverse=True)), (None, wanted)):
        browser.key("Enter")
        same(browser.ask(f"[...{table}.tBodies[0].rows].map(r => Number(r.cells[2].dataset.value))"), values, f"RMSE {order}")
        same(browser.ask(f"{table}.tHead.rows[0].cells[2].getAttribute('aria-sort')"), order, "the order is announced (aria-sort)")


def check_texts(page):
    """Numbers are written for people: three digits, thousands separated, seconds and bytes in suitable units."""
    error = dict(zip(("mean", "rmse", "p999", "max", "over05", "bias"), (0.1, 0.2, 0.3, 0.4, 0.5, -0.6)))
    page.open(lambda data: data["metrics"]["methods"][0].update(errorAllLights=error))
    same([cell[0] for cell in page.table("Error of V against raytrace under all lights")[0][1:-1]], ["0.1", "0.2", "0.3", "0.4", "50 %", "−0.6"], "errors as texts")
    numbers = [0, 0.0123, 0.00012345, 0.000099999, 1.2345e-5, 0.9996, 1, 12.345, 0.5, 1e-12]
    for number in numbers:
        def change(data):
            data["metrics"]["methods"][0]["errorAllLights"] |= {"mean": number, "bias": -number}
        page.open(change)
        row = page.table("Error of V against raytrace under all lights")[0]
        same((row[1][0], row[6][0]), (general(number), general(-number) if number else "0"), f"{number} as a text")
    for seconds, text in ((1.23e-5, "12.3 µs"), (0.0123, "12.3 ms"), (0.9996, "1 s"), (1.234, "1.23 s"), (1234.5, "1235 s"), (None, "–")):
        def change(data):
            data["metrics"]["methods"][0] |= {"peakMemoryBytes": 12 * 1024 ** 2 + 300 * 1024, "counters": {"candidates": 1234567}}
            data["metrics"]["methods"][0]["seconds"]["light"] = seconds
        page.open(change)
        same(page.table("Seconds on the machine")[1][-6][0], text, f"{seconds} s as a text")
        same(page.table("Seconds on the machine")[1][-2][0], "12.3 MiB", "bytes")
        same(page.table("What was counted")[0][1][0], "1\u202f234\u202f567", "a count")


def check_findings(page):
    """The summary names ties, and compares speeds only of methods that answer the same question."""
    def tie(data):
        for result, rmse in zip(data["metrics"]["methods"], (0.0034, 0.00340001, 0.0035)):
            result["errorAllLights"]["rmse"] = rmse
            result["seconds"]["shadow"] = 2
    page.open(tie)
    expect(page.card("Closest to the reference").startswith("edge-scatter, pcss:size=16: a tie: V is off by"), page.card("Closest to the reference"))
    same([row[0][0] for row in page.table("Error of V against raytrace under all lights") if row[2][2] == "best"], METHODS[:2], "the best in the table")
    expect(page.card("Least time").startswith(", ".join(METHODS) + ": a tie: 2 s for the shadow"), page.card("Least time"))
    expect("answers differ from rays" in page.card("Most exact"), page.card("Most exact"))

    def many(data):
        for _ in range(2):
            data["metrics"]["methods"].append(copy.deepcopy(data["metrics"]["methods"][0]))
            data["methods"].append(copy.deepcopy(data["methods"][0]))
        tie(data)
        for result in data["metrics"]["methods"]:
            result["seconds"]["shadow"] = 2
    page.open(many)
    expect(page.card("Least time").startswith(", ".join(METHODS) + " and 2 more: a tie"), page.card("Least time"))
    for is_same in (True, False):
        for shadow, words in ((2, "2.00× faster"), (6, "1.50× slower"), (4, "as fast"), (0.04, "100× faster")):
            def change(data):
                data["metrics"]["reference"]["seconds"]["shadow"] = 4
                for result, method in zip(data["metrics"]["methods"], data["methods"]):
                    result["seconds"]["shadow"] = shadow if method is data["methods"][0] else 50
                    method["sameQuestion"] = is_same
            page.open(change)
            what = f"{shadow} s of 4, {'same' if is_same else 'another'} question"
            same(f": {words} {'as' if words == 'as fast' else 'than'} the reference" in page.card("Least time"), is_same, f"{what}: {page.card('Least time')}")
            table = page.table("Seconds on the machine")
            same(any(cell[0] == words for cell in table[1]), is_same, what)
            same("another question" in page.browser.ask("document.getElementById('numbers').textContent"), not is_same, f"caption: {what}")


def check_gaps(page):
    """Failures, and values that were not measured."""
    def fail(data):
        failed = data["metrics"]["methods"][1]
        failed |= {key: None for key in ("error", "errorAllLights", "horizonError", "beautyError", "separation")}
        failed |= {"failure": {"exitCode": 4, "message": "out of memory"}, "lights": [], "passes": [], "counters": {}}
        failed["seconds"] = {key: None for key in failed["seconds"]}
        data["entries"] = [entry for entry in data["entries"] if entry["method"] != 1]
        data["reference"]["output"] = "radiance"
    page.open(fail)
    same([[cell[0] for cell in row] for row in page.table("Methods that gave no answer")], [["pcss:size=16", "out of memory"]], "the failure")
    for caption in ("Error of V against raytrace under all lights", "Seconds on the machine", "RMSE of V under light"):
        expect(all(row[0][0] != "pcss:size=16" for row in page.table(caption)), f"a method that failed has no row: {caption}")
    expect("needs no points of the light" in page.browser.ask("document.getElementById('question').textContent"), "a reference of areas")
    same(page.browser.ask("[...document.querySelectorAll('.plot .mark title')].length"), 2, "marks in the plot")

    def nothing(data):
        data["metrics"] |= {"methods": [], "sameSamples": None}
        data |= {"methods": [], "entries": []}
    page.open(nothing)
    same(page.browser.ask("document.getElementById('look').hidden"), True, "nothing to wipe")
    expect("no pictures" in page.browser.ask("document.getElementById('pictures').textContent"), "no pictures")
    same(page.table("Error of V"), None, "no table without methods")

    def alone(data):
        data["metrics"]["methods"] = data["metrics"]["methods"][:1]
        data["methods"] = data["methods"][:1]
        data["entries"] = [entry for entry in data["entries"] if entry["role"] == "reference" or entry["method"] == 0]
        data["lights"] = data["lights"][:1]
        data["warnings"] = ["2 faces skipped"]
        for stats in (data["metrics"]["methods"][0], data["metrics"]["reference"]):
            stats["warnings"] = ["2 faces skipped", "another"]
    page.open(alone)
    page.browser.wait("document.getElementById('look').dataset.painted === '50'")
    same(page.browser.ask("[document.getElementById('look').dataset.left, document.getElementById('look').dataset.right]"), ["1", "0"], "beside the reference")
    same(page.browser.ask("[...document.querySelectorAll('#warnings li')].map(l => l.textContent)"), ["2 faces skipped", "another"], "each warning once")
    same(page.browser.ask("document.querySelector('#warnings h2').textContent"), "Warnings: 2", "and how many")
    expect("under light" not in page.browser.ask("document.getElementById('numbers').textContent"), "one light needs no name")


def check_foreign_texts(page):
    """Names may contain anything: none becomes markup, and none is executed."""
    evil = "</script><img src=x onerror=\"window.evil = 1\"><script>window.evil = 1</script>'&{}"

    def change(data):
        data |= {"version": evil, "command": evil, "warnings": [evil], "scene": [[evil, evil]]}
        data["machine"] |= {"processor": evil, "system": evil}
        for light in data["lights"]:
            light["name"] = evil
        data["metrics"]["reference"] |= {"method": evil, "scene": evil}
        for result, method in zip(data["metrics"]["methods"], data["methods"]):
            result |= {"entry": evil, "method": evil, "device": evil, "options": {evil: evil}, "passes": [{"name": evil, "milliseconds": 1}],
                       "counters": {evil: 1}}
            method |= {"paper": evil, "exactFor": evil, "question": evil, "options": [dict.fromkeys(("name", "values", "default", "help"), evil)]}
            for light in result["lights"]:
                if light["errorBudget"]:
                    light["errorBudgetRuns"]["resolution"] |= {"words": evil}
                    light["errorBudgetRuns"]["resolution"]["runs"] = [{"method": evil, "options": {evil: evil}, "lightParts": 1, "lightSamples": 1, "rmse": None,
                                                                       "actsOn": None, "failure": evil}]
    page.open()
    before = page.browser.ask("document.scripts.length")
    page.open(change)
    same(page.browser.ask("[window.evil === undefined, document.scripts.length, document.querySelectorAll('img[src=x]').length]"), [True, before, 0], "nothing ran")
    for part in ("#title", "#lead", "#glance", "#warnings", "#machine", "#scene", "#methods", "#numbers", "#question", "#command", "#written", ".plot"):
        expect(evil in page.browser.ask(f"document.querySelector('{part}').textContent"), f"the name is written in {part}")
    page.browser.ask("document.querySelector('#numbers tbody a').click()")
    page.browser.wait("document.getElementById('methods').open")


def check_plot(page):
    """Marks are at their seconds and errors, names are inside the drawing and do not overlap, errors of 0 are on a
    separate line."""
    seconds, errors = (0.02, 0.2, 0.2), (0.004, 0.03, 0.03)  # two of them are at the same place

    def change(data):
        for result, s, e in zip(data["metrics"]["methods"], seconds, errors):
            result["seconds"]["shadow"], result["errorAllLights"]["rmse"] = s, e
        data["metrics"]["sameSamples"]["errorAllLights"]["rmse"] = 0.004
    page.open(change)
    marks = page.browser.ask("""[...document.querySelectorAll('.plot .mark')].map(m => { const box = m.firstChild.getBBox();
        return [m.firstChild.getAttribute('class'), box.x + box.width / 2, box.y + box.height / 2]; })""")
    families = ("geometry", "image", "image")
    for (family, x, y), wanted, s, e in zip(marks, families, seconds, errors):
        same(family, wanted, "a mark's form")
        # 0.01 to 1 s from 64 to 660, 0.001 to 0.1 from 372 up to 16
        expect(abs(x - (64 + 596 * (math.log10(s) + 2) / 2)) < 0.11, f"{s} s lies at {x}")
        expect(abs(y - (372 - 356 * (math.log10(e) + 3) / 2)) < 0.11, f"an error of {e} lies at {y}")
    level = page.browser.ask("document.querySelector('.plot .cost').getBBox().y")
    expect(abs(level - marks[0][2]) < 0.11, f"what light samples cost lies at {level}")
    boxes = page.browser.ask("""[...document.querySelectorAll('.plot text')].filter(t => !t.hasAttribute('transform')).map(t => { const b = t.getBBox();
        return [t.textContent, b.x, b.y + 3, b.x + b.width, b.y + b.height - 3]; })""")
    for i, (name, left, top, right, bottom) in enumerate(boxes):
        expect(0 <= left and right <= 860 and 0 <= top and bottom <= 420, f"{name} is in the drawing")
        for other in boxes[:i]:
            expect(left >= other[3] or right <= other[1] or top >= other[4] or bottom <= other[2], f"{name} lies on {other[0]}")

    def tiny(rmse):
        def change_it(data):
            for result in data["metrics"]["methods"]:
                result["errorAllLights"]["rmse"] = 0.003
            data["metrics"]["methods"][0]["errorAllLights"]["rmse"] = rmse
        return change_it
    for rmse, zero in ((2.5e-10, True), (2e-6, False)):
        page.open(tiny(rmse))
        ticks = page.browser.ask("[...document.querySelectorAll('.plot .axis')].map(t => t.textContent)")
        same(("0" in ticks, "1e-6" in ticks), (zero, not zero), f"an error of {rmse}: {ticks}")
        mark = page.browser.ask("document.querySelector('.plot .mark circle').cy.baseVal.value")
        same(abs(mark - 360) < 0.11, zero, f"an error of {rmse} lies at {mark}, and none at 360")

    def untimed(data):
        for result in data["metrics"]["methods"]:
            result["seconds"] = {key: None for key in result["seconds"]}
    page.open(untimed)
    same(page.browser.ask("document.querySelector('#numbers .wide')"), None, "no plot without seconds")


def check_budget(page, photographs):
    """Checks the error budget: every light's table has the numbers of metrics.json, with bars of the right length on
    the right side, and the runs that gave them; the keyboard sorts and opens it."""
    browser, url = page.browser, (page.folder / "report.html").as_uri() + "#error-budget"
    browser.open(url)
    methods = page.metrics["methods"]
    budgets = [[method["lights"][light]["errorBudget"] for method in methods] for light in range(2)]
    runs = [[method["lights"][light]["errorBudgetRuns"] for method in methods] for light in range(2)]
    changes = [abs(change) for light in budgets for budget in light
               for cause, change in budget.items() if cause != "remainder" and change is not None]
    largest = max(changes)
    largest_error = max(max(run["rmse"], budget["remainder"] or 0) for light in range(2)
                        for run, budget in zip(runs[light], budgets[light]))
    expect(largest > 0.001, f"the budget shows an error to explain: {largest}")
    for light, name in enumerate(light["name"] for light in methods[0]["lights"]):
        table = f"""[...document.querySelectorAll('table.sortable')].find(t => t.caption.textContent.includes(
            'Why each method is wrong under light \u201c{name}\u201d'))"""
        browser.ask(f"{table}.closest('details')?.setAttribute('open', '')")
        rows = browser.ask(f"""[...{table}.tBodies[0].rows].map(row => [...row.cells].map(cell => ({{
            text: cell.textContent, value: cell.dataset.value ?? null, bar: cell.querySelector('svg rect') && {{
                better: cell.querySelector('rect').classList.contains('better'), x: Number(cell.querySelector('rect').getAttribute('x')),
                width: Number(cell.querySelector('rect').getAttribute('width')),
                drawn: cell.querySelector('svg').getBoundingClientRect().width}} }})))""")
        same(len(rows), len(methods), f"a row for each method under {name}")
        for row, method, budget, run in zip(rows, methods, budgets[light], runs[light]):
            what = f"of {method['entry']} under {name}"
            same(row[0]["text"], method["entry"], f"the method {what}")
            same(float(row[1]["value"]), run["rmse"], f"RMSE {what}")
            expect(abs(row[1]["bar"]["width"] - 78 * run["rmse"] / largest_error) < 0.06, f"the bar of the RMSE {what}")
            for cell, cause in zip(row[2:], budget):
                value = budget[cause]
                if value is None:
                    same((cell["text"], cell["bar"]), ("\u2013", None), f"{cause} {what} cannot be separated")
                    continue
                same(float(cell["value"]), value, f"{cause} {what}")
                expect(cell["bar"]["drawn"] > 20, f"the bar of {cause} {what} is seen")
                if cause == "remainder":
                    expect(abs(cell["bar"]["width"] - 78 * value / largest_error) < 0.06, f"the bar of the remainder {what}")
                    continue
                length = 38 * abs(value) / largest
                expect(abs(cell["bar"]["width"] - length) < 0.06, f"the bar of {cause} {what}: {cell['bar']}, not {length}")
                same(cell["bar"]["better"], value < 0, f"the colour of {cause} {what}")
                expect(abs(cell["bar"]["x"] - (40 - length if value < 0 else 40)) < 0.06, f"the side of {cause} {what}")
        browser.ask(f"{table}.tHead.rows[0].cells[1].querySelector('button').focus()")
        browser.key("Enter")
        same(browser.ask(f"[...{table}.tBodies[0].rows].map(row => Number(row.cells[1].dataset.value))"),
             sorted(run["rmse"] for run in runs[light]), f"sorted by RMSE under {name}")
        for method, run in zip(methods, runs[light]):
            details = f"""[...document.querySelectorAll('details')].find(d => d.querySelector('summary').textContent ===
                'How the budget of {method["entry"]} under light \u201c{name}\u201d was found out')"""
            browser.ask(f"{details}.querySelector('summary').focus()")
            browser.key("Enter")
            browser.wait(f"{details}.open")
            causes = browser.ask(f"[...{details}.querySelector('tbody').rows].map(row => row.cells[0].textContent)")
            same(causes[:8], list(CAUSES), f"causes of {method['entry']}")
            text = browser.ask(f"{details}.textContent")
            for cause in causes[:8]:
                expect(run[cause]["words"] in text, f"what was done about {cause}")
        acts = sum((run[cause]["runs"][-1]["actsOn"] or 0) > 0 for run in runs[light]
                   for cause in CAUSES if run[cause]["runs"])
        shown = browser.ask(f"""[...document.querySelectorAll('.gallery img')].filter(image =>
            image.alt.startsWith('By how much V of') && image.alt.includes('{name}')).length""")
        expect(shown >= acts > 0, f"{shown} pictures of {acts} repairs under {name}")
    for window_name, window in WINDOWS.items():
        browser.open(url, **window)
        expect(browser.ask("document.documentElement.scrollWidth <= innerWidth"), f"the budget is too wide: {window_name}")
        colors = browser.ask("""['better', 'worse'].map(name => getComputedStyle(
            document.querySelector('.bar-of-budget rect.' + name) ?? document.body).fill)""")
        expect(colors[0] != colors[1], f"bars of causes that help have another colour than the rest: {colors} ({window_name})")
        if photographs:
            browser.ask("document.getElementById('error-budget').scrollIntoView({behavior: 'instant'})")
            browser.photograph(photographs / f"budget-{window_name}.png")


def main():
    program, scene = sys.argv[1:3]
    photographs = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None
    if photographs:
        photographs.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([program, "compare", scene, "-o", name, "--size", "40x40", "--light-samples", "16", "--methods", ",".join(METHODS), "--runs", "1",
                        "--sample-pixels", "60", "--error-budget", "--quiet"], check=True, stdout=subprocess.DEVNULL)
        with Browser() as browser:
            page = Numbers(browser, folder)
            for check in (check_tables, check_sorting, check_texts, check_findings, check_gaps, check_foreign_texts, check_plot):
                check(page)
            check_budget(page, photographs)
            same(browser.problems, [], "the page complains, or asks for what is not in it")
    return verdict()


if __name__ == "__main__":
    sys.exit(main())
