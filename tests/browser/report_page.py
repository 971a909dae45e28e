#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the report in a browser, by keys and by pointer, against the files next to it.
  report_page.py PROGRAM SCENE [PHOTOGRAPHS]   PHOTOGRAPHS: a folder for pictures of the page, for people to look at"""
import json
import pathlib
import subprocess
import sys
import tempfile
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from browser import Browser  # noqa: E402
from claims import expect, same, verdict  # noqa: E402
from exr import read_bits, read_exr  # noqa: E402

WIDTH, HEIGHT, SAMPLES = 96, 96, 64
METHODS = ["edge-scatter", "pcss", "accumulate:size=16"]
READY = "document.getElementById('viewer').dataset.drawn !== undefined"
READ = "document.getElementById('viewer').dataset.read"


def file_stem(entry):
    """Returns the entry as a file name, which has no colon."""
    return entry.replace(":", ",")


def srgb(linear):
    x = min(1, max(0, linear))
    return round(255 * (12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055))


class Page:
    def __init__(self, browser, folder):
        self.browser, self.folder = browser, pathlib.Path(folder)
        self.url = (self.folder / "report.html").as_uri()
        self.metrics = json.loads((self.folder / "metrics.json").read_text())
        self.lights = [light["name"] for light in self.metrics["methods"][0]["lights"]]
        # The viewer's entries in order; rays on the methods' samples have no file.
        self.entries = ["reference", None, *METHODS]
        self.exr = {name: read_exr(self.folder / f"{file_stem(name)}.exr")[0] for name in self.entries if name}
        self.bits = {name: read_bits(self.folder / f"{file_stem(name)}.bits") for name in ("edge-scatter", "accumulate:size=16")}

    def v(self, entry, light, pixel):
        return self.exr[self.entries[entry]][self.lights[light].replace(".", "_").replace("/", "_") + ".V"][pixel]

    def look(self, words="", **window):
        self.browser.open(f"{self.url}#look?{words}", **window)
        self.browser.wait(f"document.getElementById('viewer').open && {READY}")

    def press(self, *keys):
        for key in keys:
            self.browser.key(*key.split("+")[::-1]) if "+" in key[1:] else self.browser.key(key)
        self.browser.wait(READY)

    def title(self):
        return self.browser.ask("document.getElementById('viewer-title').textContent")

    def values(self):
        self.browser.wait(READ)
        return self.browser.ask("""[...document.querySelectorAll('#viewer-values tr')].map(row => ({
            entry: Number(row.dataset.entry), v: row.cells[1].dataset.value, error: row.cells[2].dataset.value ?? null,
            seen: row.cells[3].dataset.seen ?? null}))""")

    def stage(self):
        """Returns the stage's place and size."""
        return self.browser.ask("""(() => { const b = document.querySelector('#viewer-stage canvas').getBoundingClientRect();
            return {x: b.x, y: b.y, width: b.width, height: b.height}; })()""")

    def place(self, x, y):
        """Returns the middle of a pixel on the stage when one whole picture is shown."""
        stage = self.stage()
        scale = min(stage["width"] / WIDTH, stage["height"] / HEIGHT)
        return (stage["width"] / 2 + (x + 0.5 - WIDTH / 2) * scale, stage["height"] / 2 + (y + 0.5 - HEIGHT / 2) * scale)

    def colors(self, places):
        """Returns the colours of the stage at these places: [red, green, blue] each."""
        return self.browser.ask(f"""(() => {{ const c = document.querySelector('#viewer-stage canvas').getContext('2d');
            return {json.dumps(places)}.map(([x, y]) => [...c.getImageData(x, y, 1, 1).data.slice(0, 3)]); }})()""")


def check_readout(page):
    """V, error and masks of pixels of every kind equal those in the files, to the last bit."""
    penumbra = max(range(WIDTH * HEIGHT), key=lambda i: -abs(page.v(2, 0, i) - 0.5))
    second = max(range(WIDTH * HEIGHT), key=lambda i: -abs(page.v(2, 1, i) - 0.5))
    differing = next(i for i in range(WIDTH * HEIGHT)
                     if page.bits["edge-scatter"][i] != page.bits["accumulate:size=16"][i])
    expect(0 < page.v(2, 0, penumbra) < 1, "a pixel in a penumbra")
    for pixel, light in ((penumbra, 0), (second, 1), (differing, 0), (0, 0), (WIDTH * HEIGHT - 1, 1)):
        x, y = pixel % WIDTH, pixel // WIDTH
        page.look(f"light={light}&pixel={x},{y}")
        values = page.values()
        same([value["entry"] for value in values], list(range(len(page.entries))), "a row for each entry")
        for value, name in zip(values, page.entries):
            if name is None:
                continue
            wanted = page.v(value["entry"], light, pixel)
            same(float(value["v"]), wanted, f"V of {name} at {x},{y} under light {light}")
            if name != "reference":
                same(float(value["error"]), wanted - page.v(0, light, pixel), f"error of {name} at {x},{y}")
            if light == 0 and name in page.bits:
                same(value["seen"], page.bits[name][pixel], f"light samples that {name} sees at {x},{y}")
            if name == "pcss":
                same(value["seen"], None, "pcss has no masks")
        text = page.browser.ask("document.querySelector('#viewer-values tr:last-child td:last-child').textContent")
        others = sum(a != b for a, b in zip(values[-1]["seen"], values[1]["seen"]))
        same("other than rays" in text, others > 0, f"{others} light samples are seen otherwise than by rays, and the page says so: {text}")
    expect(any("other than rays" in t for t in [page_text(page, differing)]), "a pair that differs is named")


def page_text(page, pixel):
    page.look(f"light=0&pixel={pixel % WIDTH},{pixel // WIDTH}")
    page.values()
    return page.browser.ask("document.getElementById('viewer-values').textContent")


def check_keys(page):
    page.look("layer=v&view=one&a=2")
    same(page.title(), "V: edge-scatter", "the address says what is shown")
    for keys, title in ((["ArrowRight"], "V: pcss"), (["ArrowLeft", "ArrowLeft"], f"V: raytrace, {SAMPLES} light samples"),
                        (["ArrowLeft", "ArrowLeft"], "V: accumulate:size=16"), (["ArrowDown"], "Error: accumulate:size=16"),
                        (["ArrowDown"], "Beauty: accumulate:size=16"), (["ArrowUp", "ArrowUp"], "V: accumulate:size=16"),
                        (["w"], "V: accumulate:size=16 | V: raytrace (reference)"),
                        ([" "], "V: raytrace (reference) | V: accumulate:size=16"), (["g"], "V: all"),
                        (["g"], "V: raytrace (reference)")):
        page.press(*keys)
        same(page.title(), title, f"after {keys}")
    state = "document.getElementById('viewer-zoom-text').value"
    page.press("+", "+")
    same(page.browser.ask(state), "400 %", "zoomed twice")
    page.press("0")
    same(page.browser.ask(state), "100 %", "the whole picture again")
    page.press("l")
    same(page.browser.ask("document.getElementById('viewer-light').value"), "1", "the next light")
    page.press("w", "]", "]")
    same(page.browser.ask("document.getElementById('viewer-wipe').value"), "60", "the wipe, two steps to the right")
    page.look("layer=beauty&stops=1")
    page.press(".", ".")
    same(page.browser.ask("document.getElementById('viewer-stops').value"), "2", "exposure, two steps up")
    page.look("pixel=10,10")
    page.press("Shift+ArrowRight", "Shift+ArrowDown", "Shift+ArrowDown")
    page.browser.wait(f"{READ} === '11,12'")
    expect("Pixel 11, 12" in page.browser.ask("document.querySelector('#viewer-place[role=status]').textContent"),
           "the read-out is said")
    # The address keeps the view: when it is opened again, the view is the same.
    page.look("layer=error&a=3&light=1&view=one&limit=0.2&pixel=5,6")
    page.browser.wait("location.hash.includes('limit=0.2')")
    same((page.title(), page.browser.ask("document.getElementById('viewer-limit').value")), ("Error: pcss", "0.2"), "limit")
    # An address that names no view of this report is corrected.
    page.look("layer=nothing&a=99&b=x&light=-7&view=7&wipe=NaN&zoom=1e9&pixel=1e9,-4&limit=-1&constructor=1")
    same(page.title(), "V: raytrace (reference)", "an address with invalid values shows the default view")
    page.values()


def check_from_the_page(page):
    """Tab and Enter open a picture; Escape closes it, and the focus returns to where it was."""
    browser = page.browser
    browser.open(page.url)
    browser.ask("document.querySelector('nav a[href=\"#pictures\"]').click()")
    browser.wait("document.getElementById('pictures').open")
    browser.ask("document.querySelector('input[data-layer=error][data-entry=\"3\"][data-light=\"1\"]').focus()")
    same(browser.ask("document.activeElement.type"), "button", "with script a picture is a button")
    browser.key("Enter")
    browser.wait(f"document.getElementById('viewer').open && {READY}")
    same(page.title(), "Error: pcss", "the picture that was chosen")
    same(browser.ask("document.activeElement.id"), "viewer-stage", "the focus is on the picture")
    browser.key("Escape")
    browser.wait("!document.getElementById('viewer').open")
    same(browser.ask("document.activeElement.dataset.entry"), "3", "the focus is back")
    # Tab reaches every control, and stays inside the viewer.
    page.look("view=wipe&layer=error")
    reached = set()
    for _ in range(60):
        browser.key("Tab")
        reached.add(browser.ask("document.activeElement.id || document.activeElement.name || document.activeElement.tagName"))
    for control in ("viewer-light", "viewer-a", "viewer-b", "viewer-wipe", "viewer-limit", "viewer-out", "viewer-in",
                    "viewer-whole", "viewer-close", "viewer-stage", "layer", "view"):
        expect(control in reached, f"Tab reaches {control}: {sorted(reached)}")
    names = [node for node in browser.call("Accessibility.getFullAXTree")["nodes"] if not node.get("ignored")]
    for node in names:
        if node["role"]["value"] in ("button", "slider", "combobox", "radio", "dialog", "application", "table"):
            expect(node.get("name", {}).get("value"), f"a {node['role']['value']} without a name")


def check_pictures(page):
    """The viewer paints the same as the page's own pictures; the wipe shows one on either side."""
    browser, places = page.browser, [(7 * i % WIDTH, 13 * i % HEIGHT) for i in range(96)]
    painted = {}
    for layer, entry, light, most in (("v", 3, 0, 0), ("v", 2, 1, 0), ("error", 3, 0, 0), ("error", 4, 1, 0), ("beauty", 3, 0, 1)):
        page.look(f"layer={layer}&a={entry}&light={light}&view=one")
        painted[layer, entry, light] = page.colors([page.place(x, y) for x, y in places])
        browser.open(page.url)
        browser.ask("document.getElementById('pictures').open = true")
        figure = (f"""document.querySelector('input[data-layer={layer}][data-entry="{entry}"][data-light="{light}"]')"""
                  ".parentElement.querySelector('canvas')")
        browser.ask(f"{figure}.scrollIntoView({{behavior: 'instant'}})")
        browser.wait(f"{figure}.dataset.painted === 'yes'")
        wanted = browser.ask(f"""(async () => {{
            const canvas = {figure}, context = canvas.getContext('2d');
            return {json.dumps(places)}.map(([x, y]) => [...context.getImageData(x, y, 1, 1).data.slice(0, 3)]);
        }})()""")
        if layer == "beauty":
            # Radiance is packed to 1/128 of a stop, 0.54 %: less than a step of sRGB's 255 (the steepest of them, near
            # white, is 0.9 % of the light).
            exposure = browser.ask("JSON.parse(document.getElementById('report-data').textContent).exposure")
            channels = page.exr[page.entries[entry]]
            wanted = [[srgb(exposure * channels[c][y * WIDTH + x]) for c in "RGB"] for x, y in places]
        off = max(abs(a - b) for mine, other in zip(painted[layer, entry, light], wanted) for a, b in zip(mine, other))
        expect(off <= most, f"{layer} of entry {entry} under light {light} is off by {off} of 255")
    page.look("layer=v&view=wipe&a=3&b=3&wipe=0.5&bLayer=error&light=0")
    stage = page.stage()
    for (x, y), v, error, shown in zip(places, painted["v", 3, 0], painted["error", 3, 0],
                                       page.colors([page.place(x, y) for x, y in places])):
        at = page.place(x, y)
        if abs(at[0] - stage["width"] / 2) > 3 and at[1] > 24:  # away from the line, and below the names
            same(shown, v if at[0] < stage["width"] / 2 else error, f"the wipe at {x},{y}")
    # The pointer drags the wipe, and reads values.
    middle = (stage["x"] + stage["width"] / 2, stage["y"] + stage["height"] / 2)
    browser.pointer("mousePressed", *middle, button="left", clickCount=1)
    browser.pointer("mouseMoved", stage["x"] + stage["width"] / 4, middle[1], button="left", buttons=1)
    browser.pointer("mouseReleased", stage["x"] + stage["width"] / 4, middle[1], button="left", clickCount=1)
    same(browser.ask("document.getElementById('viewer-wipe').value"), "25", "dragged to a quarter")
    page.look("layer=v&view=one&a=3")
    at = page.place(30, 60)
    browser.pointer("mouseMoved", stage["x"] + at[0], page.stage()["y"] + at[1])
    browser.wait(f"{READ} === '30,60'")
    same(float(page.values()[3]["v"]), page.v(3, 0, 60 * WIDTH + 30), "V under the pointer")
    # All pictures share one zoom: the wheel keeps the place under the pointer, in whichever picture.
    browser.call("Input.dispatchMouseEvent", type="mouseWheel", x=stage["x"] + at[0], y=page.stage()["y"] + at[1], deltaX=0, deltaY=-480)
    browser.wait("document.getElementById('viewer-zoom-text').value === '400 %'")
    for key in ("ArrowRight", "ArrowLeft"):
        page.press(key)
        same(browser.ask("document.getElementById('viewer-zoom-text').value"), "400 %", "the zoom stays")
    same(browser.ask(READ), "30,60", "and the pixel")


def check_first_look(page):
    """The page begins with a wipe between the worst and the best method; a key moves it and a button opens it."""
    browser = page.browser
    browser.open(page.url)
    browser.wait("document.getElementById('look').dataset.painted === '50'")
    errors = [method["lights"][0]["error"]["rmse"] for method in page.metrics["methods"]]
    same(browser.ask("[document.getElementById('look').dataset.left, document.getElementById('look').dataset.right]"),
         [f"{2 + errors.index(max(errors))}", f"{2 + errors.index(min(errors))}"], "the worst and the best")
    seen = browser.ask(f"""(() => {{ const c = document.querySelector('#look canvas').getContext('2d');
        return [[10, 60], [{WIDTH} - 10, 60]].map(([x, y]) => c.getImageData(x, y, 1, 1).data[0]); }})()""")
    for grey, entry, x in zip(seen, (2 + errors.index(max(errors)), 2 + errors.index(min(errors))), (10, WIDTH - 10)):
        expect(abs(grey - 255 * page.v(entry, 0, 60 * WIDTH + x)) <= 0.51, f"V on the side of entry {entry}")
    browser.ask("document.querySelector('#look input').focus()")
    browser.key("ArrowLeft")
    browser.wait("document.getElementById('look').dataset.painted === '49'")
    browser.ask("document.querySelector('#look button').click()")
    browser.wait(f"document.getElementById('viewer').open && {READY}")
    same(browser.ask("document.getElementById('viewer-wipe').value"), "49", "the viewer goes on where the line is")
    # The page as opened is at most three screens long, on a wide and on a narrow window. No text is smaller than 14
    # pixels.
    for window in ({"width": 1400, "height": 900}, {"width": 390, "height": 844, "phone": True}):
        browser.open(page.url, **window)
        browser.wait("document.getElementById('look').dataset.painted === '50'")
        screens = browser.ask("document.documentElement.scrollHeight / innerHeight")
        expect(screens <= 3, f"{screens:.2f} screens of {window['width']} pixels")
        small = browser.ask("""[...new Set([...document.querySelectorAll('body *')].filter(e => e.checkVisibility()
            && [...e.childNodes].some(n => n.nodeType === 3 && n.textContent.trim()))
            .filter(e => parseFloat(getComputedStyle(e).fontSize) * (e.ownerSVGElement
                ? Math.hypot(e.getScreenCTM().a, e.getScreenCTM().b) : 1) < 13.99).map(e => e.tagName + '.' + (e.className.baseVal ?? e.className)))]""")
        same(small, [], "smaller than 14 pixels")
    browser.ask("document.querySelector('#numbers tbody a').click()")
    browser.wait("document.getElementById('methods').open")
    expect(browser.ask("document.querySelector('#methods details[open] p').textContent.includes('-based')"),
           "a method's name leads to what it is")


def check_live(page, scene):
    """The dialog "Open live": the command of the live view with two methods, which a key copies, and the address of a
    running view."""
    browser = page.browser
    say = "document.getElementById('live-say').textContent"
    browser.open(page.url)
    browser.wait("document.getElementById('look').dataset.painted === '50'")
    browser.ask("document.querySelector('#look a').click()")
    browser.wait("document.getElementById('live').open")
    errors = {method["entry"]: method["lights"][0]["error"]["rmse"] for method in page.metrics["methods"]}
    worst, best = max(errors, key=errors.get), min(errors, key=errors.get)
    command = f"./run.sh view {scene} --size {WIDTH}x{HEIGHT} --light-samples {SAMPLES} --method {worst} --method-b "
    same(browser.ask("document.getElementById('live-command').textContent"), command + best, "the command of the live view")
    browser.ask("""(() => { const b = document.getElementById('live-b'); b.value = '1'; b.dispatchEvent(new Event('change'));
        document.addEventListener('copy', () => { window.copied = getSelection().toString(); });
        document.getElementById('live-copy').focus(); })()""")
    browser.key("Enter")
    same(browser.ask("window.copied"), command + METHODS[1], "what is copied")
    expect("Copied" in browser.ask(say), browser.ask(say))

    def submit(address):
        browser.ask(f"""(() => {{ window.opened = null; window.open = (url) => {{ window.opened = `${{url}}`; }};
            const field = document.getElementById('live-address'); field.value = {json.dumps(address)}; field.focus(); }})()""")
        browser.key("Enter")
        return browser.ask("window.opened")

    for wrong in ("", "127.0.0.1:8080", "http://127.0.0.1:8080/", "javascript:alert(1)//?token=1", "file:///etc/passwd?token=1"):
        same(submit(wrong), None, f"no address of a view: {wrong}")
        expect("no address of a view" in browser.ask(say), f"said of {wrong}: {browser.ask(say)}")
    opened = submit(" http://127.0.0.1:8080/?token=ab ")
    address, _, wanted = (opened or "").partition("#")
    same(address, "http://127.0.0.1:8080/?token=ab", "the view that is opened")
    same(urllib.parse.parse_qs(wanted), {"scene": ["room.json"], "a": [worst], "b": [METHODS[1]], "samples": [str(SAMPLES)]}, "what it is to show")
    expect("token=" not in (page.folder / "report.html").read_text(encoding="utf-8").replace("?token=…", ""), "the file holds no token")


def check_windows(page, photographs):
    """Nothing is wider than the window; takes pictures of the parts that people should look at."""
    browser = page.browser
    wide, narrow = {"width": 1400, "height": 900}, {"width": 390, "height": 844, "phone": True}
    for name, window in (("wide", wide), ("narrow", narrow), ("dark", {**wide, "dark": True})):
        browser.open(page.url, **window)
        expect(browser.ask("document.documentElement.scrollWidth <= innerWidth"), f"the page is too wide: {name}")
        if photographs:
            browser.photograph(photographs / f"page-{name}.png", whole=True)
        for view in ("one", "wipe", "all"):
            page.look(f"layer=error&view={view}&a=3&b=4&pixel=40,60", **window)
            page.values()
            expect(browser.ask("document.getElementById('viewer').scrollWidth <= innerWidth"), f"{view} is too wide: {name}")
            if photographs:
                browser.photograph(photographs / f"{view}-{name}.png")
    browser.open(page.url, script=False)
    text = browser.ask("document.body.innerText")
    for word in ("Allow scripts", "metrics.csv", ".exr"):
        expect(word in text, f"without script the page says what to do: {word}")


def main():
    program, scene = sys.argv[1:3]
    photographs = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None
    if photographs:
        photographs.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "compare", scene, "-o", folder, "--size", f"{WIDTH}x{HEIGHT}", "--light-samples", str(SAMPLES),
                        "--methods", ",".join(METHODS), "--runs", "1", "--bits", "--quiet"], check=True,
                       stdout=subprocess.DEVNULL)
        with Browser() as browser:
            page = Page(browser, folder)
            same(len(page.lights), 2, "lights of the scene")
            for check in (check_first_look, check_readout, check_keys, check_from_the_page, check_pictures):
                check(page)
            check_live(page, scene)
            check_windows(page, photographs)
            same(browser.problems, [], "the page logs errors, or requests something outside itself")
    return verdict()


if __name__ == "__main__":
    sys.exit(main())
