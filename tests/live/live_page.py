#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the page of `penumbra view` in headless Chromium, by pointer and by keyboard, against files that the program writes.
  live_page.py PROGRAM SCENES [PHOTOGRAPHS]   PHOTOGRAPHS: a folder for pictures of the page, for people to look at"""
import base64
import json
import pathlib
import subprocess
import sys
import tempfile
import time
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "browser"))
from browser import Browser  # noqa: E402
from claims import expect, same, verdict  # noqa: E402
from exr import read_exr  # noqa: E402
from live_client import LIGHTS, Client, Server, png_pixels  # noqa: E402

PROGRAM, SCENES = sys.argv[1], pathlib.Path(sys.argv[2])
PHOTOGRAPHS = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None
ROOT = "document.documentElement.dataset"


class Page:
    def __init__(self, browser, server, **window):
        self.browser, self.server = browser, server
        browser.open(server.url, **window)
        self.exact()

    def ask(self, expression):
        return self.browser.ask(expression)

    def exact(self, seconds=60):
        self.browser.wait(f"{ROOT}.exact === 'true'", seconds)

    def frames(self):
        return int(self.ask(f"{ROOT}.frame"))

    def after(self, action):
        """Waits for the final picture that results from an action."""
        before = self.frames()
        action()
        self.browser.wait(f"{ROOT}.frame > {before} && {ROOT}.exact === 'true'")

    def choose(self, control, value):
        """Sets a control as a user does."""
        self.type(f"#{control}", value)

    def type(self, selector, value):
        self.after(lambda: self.ask(f"(() => {{ const c = document.querySelector({json.dumps(selector)}); c.value = {json.dumps(value)}; "
                                    "c.dispatchEvent(new Event('change')); })()"))

    def tick(self, control):
        self.after(lambda: self.ask(f"document.getElementById('{control}').click()"))

    def box(self, selector):
        return self.ask(f"(() => {{ const b = document.querySelector({json.dumps(selector)}).getBoundingClientRect(); "
                        "return [b.x, b.y, b.width, b.height]; })()")

    def place(self, x, y):
        """Returns the place in the window of a part of the picture."""
        left, top, width, height = self.box("#picture")
        return left + x * width, top + y * height

    def drag(self, start, end, steps=20, button="left"):
        held = {"left": 1, "right": 2}[button]
        self.browser.pointer("mouseMoved", *start)
        self.browser.pointer("mousePressed", *start, button=button, buttons=held, clickCount=1)
        for i in range(1, steps + 1):
            self.browser.pointer("mouseMoved", start[0] + (end[0] - start[0]) * i / steps, start[1] + (end[1] - start[1]) * i / steps,
                                 button=button, buttons=held)
            time.sleep(0.02)
        self.browser.pointer("mouseReleased", *end, button=button, clickCount=1)
        self.exact()

    def canvas(self):
        """Returns the picture's pixels in the form of png_pixels()."""
        data = self.ask("""(() => { const c = document.getElementById('picture'); const p = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
            let text = ''; for (let i = 0; i < p.length; i += 4) text += String.fromCharCode(p[i], p[i + 1], p[i + 2]);
            return [c.width, c.height, btoa(text)]; })()""")
        width, height, bytes_ = data[0], data[1], base64.b64decode(data[2])
        return width, height, [bytes_[3 * width * y:3 * width * (y + 1)] for y in range(height)]

    def camera(self):
        self.ask("document.getElementById('copy-camera').click()")
        return json.loads(self.ask("document.getElementById('copy-camera').dataset.copied"))

    def state(self):
        client = Client(self.server).begin()
        client.socket.close()
        return client.state

    def picture(self, name):
        if PHOTOGRAPHS:
            PHOTOGRAPHS.mkdir(parents=True, exist_ok=True)
            self.browser.photograph(PHOTOGRAPHS / f"{name}.png")


def rendered(page, folder, name, *arguments):
    """Returns the channels and pixels that `render` writes for the saved scene, with the page's exposure."""
    scene = folder / f"{name}.json"
    scene.write_bytes(page.server.get("/scene.json")[2])
    stops = page.ask("document.getElementById('stops').dataset.stops")
    subprocess.run([PROGRAM, "render", str(scene), "-o", str(folder / f"{name}.exr"), "--png", str(folder / f"{name}.png"), "-q",
                    "--exposure", str(stops), *arguments], check=True)
    return read_exr(folder / f"{name}.exr")[0], png_pixels((folder / f"{name}.png").read_bytes())


def check_camera(page, folder):
    before = page.camera()
    same(page.canvas(), rendered(page, folder, "first")[1], "the first picture is that of `render`")
    frames = page.frames()
    page.drag(page.place(0.3, 0.8), page.place(0.6, 0.75))
    moved = page.camera()
    expect(page.frames() > frames + 2, "pictures come while the pointer drags")
    distance = lambda camera: sum((a - b) ** 2 for a, b in zip(camera["eye"], camera["target"])) ** 0.5  # noqa: E731
    expect(moved["eye"] != before["eye"] and moved["target"] == before["target"], "dragging orbits")
    expect(abs(distance(moved) - distance(before)) < 1e-9, "at the same distance")
    same(page.canvas(), rendered(page, folder, "orbit")[1], "what is shown in the end is what `render` writes")
    page.drag(page.place(0.5, 0.5), page.place(0.6, 0.5), button="right")
    panned = page.camera()
    shift = [a - b for a, b in zip(panned["eye"], moved["eye"])]
    expect(max(abs(value) for value in shift) > 0.1 and all(abs(a - b - c) < 1e-9 for a, b, c in zip(panned["target"], moved["target"], shift)),
           "the right button pans eye and pivot alike")
    x, y = page.place(0.5, 0.5)
    page.after(lambda: page.browser.call("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=-200))
    expect(distance(page.camera()) < 0.9 * distance(panned), "the wheel comes nearer")
    near = page.camera()
    page.ask("document.getElementById('picture').focus()")
    page.after(lambda: page.browser.key("w"))
    expect(page.camera()["target"] != near["target"], "W walks")
    page.tick("home")
    same(page.camera(), before, "Home returns to the file's camera")
    page.type("#paste-camera", json.dumps(near))
    same(page.camera()["eye"], near["eye"], "the pasted camera is used")
    page.ask("(() => { const c = document.getElementById('paste-camera'); c.value = '{'; c.dispatchEvent(new Event('change')); })()")
    expect("no JSON" in page.ask("document.getElementById('trouble').textContent"), "text that is not JSON is named")
    page.ask("document.getElementById('paste-camera').value = ''")
    page.tick("home")
    x, y = page.place(0.5, 0.9)

    def click_twice():
        for count in (1, 2):
            page.browser.pointer("mousePressed", x, y, button="left", clickCount=count)
            page.browser.pointer("mouseReleased", x, y, button="left", clickCount=count)
    page.after(click_twice)
    target = page.camera()["target"]
    expect(abs(target[1]) < 1e-3, f"a double click on the floor sets the pivot there: {target}")
    page.tick("home")


def check_lights(page, folder):
    before = page.state()["lights"]
    page.tick("see-light")
    time.sleep(0.3)
    handle = page.box("[data-handle='move along Y']")
    start = (handle[0] + handle[2] / 2, handle[1] + handle[3] / 2)
    page.drag(start, (start[0], start[1] - 40))
    moved = page.state()["lights"]
    was, now = before[0]["rectangle"]["center"], moved[0]["rectangle"]["center"]
    expect(now[1] > was[1] + 0.05 and abs(now[0] - was[0]) < 1e-9 and abs(now[2] - was[2]) < 1e-9, f"the handle moves along Y alone: {now}")
    same(page.canvas(), rendered(page, folder, "lit")[1], "and what is shown is what `render` writes")
    page.picture("gizmo")
    handle = page.box("[data-handle='aim']")
    start = (handle[0] + handle[2] / 2, handle[1] + handle[3] / 2)
    page.drag(start, (start[0] + 50, start[1]))
    aimed = page.state()["lights"][0]["rectangle"]
    expect(aimed["center"] == now and abs(aimed["halfU"][1]) + abs(aimed["halfV"][1]) > 0.02, "the light has been turned")
    handle = page.box("[data-handle='size along halfU']")
    start, middle = (handle[0] + handle[2] / 2, handle[1] + handle[3] / 2), page.box("[data-handle='move']")
    centre = (middle[0] + middle[2] / 2, middle[1] + middle[3] / 2)
    page.drag(start, (start[0] + (start[0] - centre[0]), start[1] + (start[1] - centre[1])))
    length = lambda v: sum(value ** 2 for value in v) ** 0.5  # noqa: E731
    sized = page.state()["lights"][0]["rectangle"]
    expect(length(sized["halfU"]) > 1.3 * length(aimed["halfU"]) and sized["halfV"] == aimed["halfV"], "one side has grown")
    # Roll: turns by a sixth of a circle about the middle, as seen in the picture.
    handle, middle = page.box("[data-handle='roll']"), page.box("[data-handle='move']")
    start, centre = (handle[0] + handle[2] / 2, handle[1] + handle[3] / 2), (middle[0] + middle[2] / 2, middle[1] + middle[3] / 2)
    x, y = start[0] - centre[0], start[1] - centre[1]
    page.drag(start, (centre[0] + 0.5 * x - 0.87 * y, centre[1] + 0.87 * x + 0.5 * y))
    rolled = page.state()["lights"][0]["rectangle"]
    cross = lambda a, b: [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]  # noqa: E731
    apart = lambda a, b: max(abs(p - q) for p, q in zip(a, b))  # noqa: E731
    expect(rolled["center"] == sized["center"] and apart(cross(rolled["halfU"], rolled["halfV"]), cross(sized["halfU"], sized["halfV"])) < 1e-6,
           "a roll keeps the middle, the axis and the area")
    expect(abs(length(rolled["halfU"]) - length(sized["halfU"])) < 1e-6 and apart(rolled["halfU"], sized["halfU"]) > 0.3 * length(sized["halfU"]),
           f"and turns the sides: {rolled['halfU']}, was {sized['halfU']}")
    for wanted in (sized, aimed, moved[0]["rectangle"], before[0]["rectangle"]):
        page.tick("undo")
        same(page.state()["lights"][0]["rectangle"], wanted, "undone")
    expect(page.ask("document.getElementById('undo').disabled"), "nothing more to undo")
    page.tick("redo")
    same(page.state()["lights"], moved, "redone")
    # Numbers.
    page.type("[aria-label='position x']", "1.25")
    same(page.state()["lights"][0]["rectangle"]["center"][0], 1.25, "a number that was typed")
    page.choose("light", "sun")
    page.browser.wait("document.querySelector(\"[data-handle='angle of the sun']\") !== null")
    handle, tip = page.box("[data-handle='angle of the sun']"), page.box("[data-handle='direction of the sun']")
    start, away = (handle[0] + handle[2] / 2, handle[1] + handle[3] / 2), [handle[i] + handle[i + 2] / 2 - tip[i] - tip[i + 2] / 2 for i in (0, 1)]
    page.drag(start, (start[0] + away[0], start[1] + away[1]))
    sun = page.state()["lights"][2]
    expect(sun["sun"]["angle"] > 1.5 * before[2]["sun"]["angle"], f"the angle of the sun has grown: {sun['sun']}")
    same(sun["sun"]["direction"], before[2]["sun"]["direction"], "in the same direction")
    expect(apart(sun["irradiance"], before[2]["irradiance"]) < 1e-9, f"and as much light comes from it: {sun['irradiance']}")
    page.tick("undo")
    expect(abs(page.state()["lights"][2]["sun"]["angle"] - before[2]["sun"]["angle"]) < 1e-9, "undone")
    page.type("input[aria-label='by stops']", "1")
    same(page.state()["lights"][2]["irradiance"], [2 * value for value in before[2]["irradiance"]], "one stop brighter")
    page.tick("light-solo")
    same(page.state()["solo"], "sun", "solo")
    page.tick("light-solo")
    page.tick("light-on")
    same(page.state()["off"], ["sun"], "off")
    same(page.canvas(), rendered(page, folder, "off")[1], "the saved scene renders without the light that is off")
    page.tick("light-on")
    page.choose("light", "key")
    page.tick("home")


def check_methods(page, folder):
    page.choose("method", "view-sample")
    same(page.ask(f"{ROOT}.method"), "view-sample", "the method that was chosen")
    page.choose("method-b", "edge-scatter")
    expect(" | edge-scatter" in page.ask(f"{ROOT}.method"), "two methods")
    expect("RMSE 0.0" in page.ask("document.getElementById('difference').textContent"), "their difference")
    names = page.ask("[...document.querySelectorAll('#options-a [data-option]')].map(input => input.dataset.option)")
    known = json.loads(subprocess.run([PROGRAM, "methods", "--json"], capture_output=True, text=True, check=True).stdout)["methods"]
    same(names, [option["name"] for method in known if method["name"] == "view-sample" for option in method["options"]], "its options")
    entries = page.ask("[...document.querySelectorAll('#method option')].map(option => option.value).filter(Boolean)")
    same(sorted(entries), sorted(method["name"] for method in known), "every method")
    same(page.ask("document.querySelector('#method-b').options[0].value"), "", "the second may be none")
    page.choose("channel", "v")
    page.ask("document.getElementById('compare').value = 'side'; document.getElementById('compare').dispatchEvent(new Event('change'))")
    same(page.canvas()[0], 128, "side by side")
    page.picture("side")
    page.ask("document.getElementById('compare').value = 'flip'; document.getElementById('compare').dispatchEvent(new Event('change'))")
    labels = "[document.getElementById('label-a').textContent, document.getElementById('label-b').textContent].map(Boolean)"
    same(page.ask(labels), [True, False], "A is shown")
    page.ask("document.getElementById('picture').focus()")
    page.browser.key("f")
    same(page.ask(labels), [False, True], "F flips to B")
    page.ask("document.getElementById('flip').click()")
    same(page.ask(labels), [True, False], "and the button back")
    page.ask("document.getElementById('compare').value = 'wipe'; document.getElementById('compare').dispatchEvent(new Event('change'))")
    same(page.ask("document.getElementById('error-scale').hidden"), True, "V is shown without the scale of errors")
    page.choose("channel", "error")
    page.choose("limit", "0.25")
    ticks = "[...document.querySelectorAll('#error-ticks span')].map(tick => tick.textContent)"
    page.browser.wait(f"{ticks}[4] === '+0.25'")
    same(page.ask(ticks), ["\u22120.25", "\u22120.0625", "0", "+0.0625", "+0.25"], "the scale of errors")
    same(page.state()["display"]["limit"], 0.25, "is the one that was typed")
    expect("+0.25" in page.ask("document.getElementById('error-bar').getAttribute('aria-label')"), "in words")
    page.picture("error")
    page.choose("limit", "")
    same(page.state()["display"]["limit"], None, "and chosen from the picture again")
    largest = float(page.ask("document.getElementById('difference').textContent").split("largest ")[1].split(";")[0])
    same(page.ask(ticks)[4], f"+{next(limit for limit in (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1) if largest <= limit)}", "the next of the scales")
    page.choose("method-b", "")
    same(page.ask("document.getElementById('error-scale').hidden"), True, "without B there is no error")
    expect("no B" in page.ask("document.getElementById('difference').textContent"), "and the page says so")
    same(page.ask("document.querySelector('#channel [value=error]').disabled"), True, "and it can not be chosen")
    page.choose("method-b", "edge-scatter")
    same(page.ask("document.getElementById('error-scale').hidden"), False, "with B there is")
    for channel in ("ids", "normals", "depth"):
        page.choose("channel", channel)
    page.choose("channel", "beauty")
    page.choose("method-b", "")
    page.choose("method", "")


def check_pixel(page, folder):
    page.browser.wait("document.getElementById('size-facts').textContent.includes(' edges, ')", 20)
    exr, _ = rendered(page, folder, "pixel")
    for x, y in ((20, 40), (40, 50)):
        page.browser.pointer("mouseMoved", *page.place((x + 0.5) / 64, (y + 0.5) / 64))
        page.browser.wait(f"document.getElementById('readout').dataset.pixel === '{x},{y}'")
        text = page.ask("document.getElementById('readout').textContent")
        v = exr["key.V"][y * 64 + x]
        found = float(text.split("V key = ")[1].split(",")[0].split("at ")[0])
        expect(abs(found - v) < 1e-5, f"V at {x},{y}: {found}, not {v}")
    page.ask("document.getElementById('show-seen').click()")
    page.browser.wait("document.getElementById('outline').dataset.blockers !== undefined", 20)
    lit = page.ask("""(() => { const c = document.getElementById('outline'); const p = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
        let lit = 0, dark = 0; for (let i = 0; i < p.length; i += 4) { lit += p[i] > 200 && p[i + 1] > 180; dark += p[i] === 0x45 && p[i + 1] === 0x4a; }
        return lit / (lit + dark); })()""")
    expect(abs(lit - found) < 0.08, f"the outline leaves {lit} of the light, V = {found}")
    page.browser.wait("document.getElementById('seen').dataset.bits !== undefined", 20)
    bits = page.ask("document.getElementById('seen').dataset.bits")
    expect(len(bits) == 256 and abs(bits.count("1") / 256 - found) < 0.1, f"{bits.count('1')} of 256 light samples are seen, V = {found}")
    page.ask("document.getElementById('show-seen').click()")


def check_typed_pixel(page, folder):
    """A pixel chosen by its coordinates, without a pointer: its values, its outline in words, and a pivot at it."""
    exr, _ = rendered(page, folder, "typed")
    page.browser.pointer("mouseMoved", 2, 2)
    x, y = min(((x, y) for y in range(64) for x in range(64)), key=lambda at: abs(exr["key.V"][at[1] * 64 + at[0]] - 0.5))
    page.ask("document.getElementById('show-seen').click()")
    for field, value in (("pixel-x", x), ("pixel-y", y)):
        page.ask(f"(() => {{ const c = document.getElementById('{field}'); c.value = '{value}'; c.dispatchEvent(new Event('change')); }})()")
    page.browser.wait(f"document.getElementById('readout').dataset.pixel === '{x},{y}'")
    v = exr["key.V"][y * 64 + x]
    text = page.ask("document.getElementById('readout').innerText")
    expect(abs(float(text.split("V key = ")[1].split(",")[0].split()[0]) - v) < 1e-5, f"V at {x},{y}: {text}, not {v}")
    same(page.ask("[...'role aria-live'.split(' ')].map(name => document.getElementById('readout').getAttribute(name))"), ["status", "polite"], "it is read out")
    page.browser.wait(f"document.getElementById('outline').getAttribute('aria-label').includes('as pixel {x}, {y} sees it')", 20)
    label = page.ask("document.getElementById('outline').getAttribute('aria-label')")
    expect("The outline of key" in label and abs(float(label.split("V = ")[1]) - v) < 1e-5, f"the outline in words: {label}")
    page.browser.wait("document.getElementById('seen').dataset.bits !== undefined", 20)
    same(page.ask("document.querySelectorAll('#overlay .mark').length"), 2, "the pixel is marked in the picture")
    position = [float(part) for part in text.split("at ")[1].split(";")[0].split(",")]
    page.tick("pivot")
    same([round(value, 4) for value in page.camera()["target"]], position, "the pivot is at the pixel")
    page.tick("home")
    page.ask("document.getElementById('picture').focus()")
    page.after(lambda: page.browser.key("p"))
    same([round(value, 4) for value in page.camera()["target"]], position, "and by P")
    page.tick("home")
    page.browser.pointer("mouseMoved", *page.place(0.3, 0.3))
    page.browser.wait("document.querySelectorAll('#overlay .mark').length === 0")
    page.browser.wait("document.getElementById('readout').getAttribute('aria-live') === 'off'")
    page.ask("document.getElementById('show-seen').click()")


def check_report(page):
    """A report's address names the methods and light samples to show; they are used only if the scene is the same."""
    url = page.server.url + "#" + urllib.parse.urlencode({"scene": "scene.json", "a": "view-sample", "b": "edge-scatter", "samples": 16})
    page.browser.open(url)
    page.browser.wait(f"{ROOT}.exact === 'true' && {ROOT}.method?.includes('edge-scatter')")
    same(page.state()["method"], "view-sample", "A of the report")
    same(page.state()["other"], "edge-scatter", "B of the report")
    same(page.state()["lightSamples"], 16, "light samples of the report")
    same(page.ask("location.hash"), "", "taken once")
    page.browser.open(url.replace("scene.json", "another.json").replace("view-sample", "depth-complexity"))
    page.browser.wait("document.getElementById('trouble').textContent.includes('another.json')")
    same(page.state()["method"], "view-sample", "a report about another scene changes nothing")
    page.choose("method-b", "")
    page.choose("method", "")
    page.choose("light-samples", "0")


def check_saving(browser, folder):
    """The button saves the scene and the picture of its light, and `render` makes of them the picture that the page
    shows."""
    into = folder / "saved"
    into.mkdir()
    with Server(PROGRAM, SCENES / "textured-light.json", "--size", "64x64") as server:
        page = Page(browser, server, width=1400, height=900)
        browser.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(into))
        page.ask("document.getElementById('save').click()")
        wanted = ["textured-light-view-light0.exr", "textured-light-view.json"]
        end = time.monotonic() + 20
        while sorted(file.name for file in into.iterdir()) != wanted and time.monotonic() < end:
            time.sleep(0.1)
        same(sorted(file.name for file in into.iterdir()), wanted, "the files that are saved")
        stops = page.ask("document.getElementById('stops').dataset.stops")
        subprocess.run([PROGRAM, "render", str(into / wanted[1]), "-o", str(into / "a.exr"), "--png", str(into / "a.png"), "-q", "--exposure", stops], check=True)
        same(page.canvas(), png_pixels((into / "a.png").read_bytes()), "`render` of the saved files gives the picture that the page shows")
        browser.call("Page.navigate", url="about:blank")


def reached_by_tab(page):
    """Returns everything that Tab reaches, from the top: identifiers, names of options, labels of numbers."""
    page.ask("document.activeElement.blur()")
    names = "document.activeElement.id || document.activeElement.dataset.option || document.activeElement.getAttribute('aria-label')"
    reached = set()
    for _ in range(110):
        page.browser.key("Tab")
        reached.add(page.ask(names))
    return reached


def check_reach(page):
    """Tab reaches every control, and each has a name."""
    page.choose("method", "view-sample")
    page.choose("method-b", "edge-scatter")
    page.type("[aria-label='position x']", "0.5")
    page.type("[aria-label='position x']", "0.25")
    page.tick("undo")  # now there is something to undo and to redo
    page.ask("document.querySelector('#options-a summary').focus()")
    page.browser.key("Enter")
    same(page.ask("document.getElementById('options-a').open"), True, "Enter opens the options")
    options = page.ask("[...document.querySelectorAll('#options-a [data-option]')].map(input => input.dataset.option)")
    numbers = page.ask("[...document.querySelectorAll('#light-numbers input')].map(input => input.getAttribute('aria-label'))")
    expect(len(options) > 1 and "radiance g" in numbers, f"options {options}, numbers {numbers}")
    compare = lambda how: page.ask(f"(() => {{ const c = document.getElementById('compare'); c.value = '{how}'; c.dispatchEvent(new Event('change')); }})()")  # noqa: E731
    compare("wipe")
    page.browser.pointer("mouseMoved", *page.place(0.5, 0.6))  # over a surface, where a pivot may be set
    page.browser.wait("!document.getElementById('pivot').disabled", 20)
    reached = reached_by_tab(page)
    for control in ("picture", "wipe", "method", "method-b", *options, "light-samples", "compare", "channel", "stops", "auto-stops", "size", "camera", "home",
                    "copy-camera", "paste-camera", "light", "light-on", "light-solo", "show-lights", *numbers, "undo", "redo", "save", "see-light", "pixel-x",
                    "pixel-y", "pivot", "show-seen"):
        expect(control in reached, f"Tab reaches {control}")
    compare("flip")
    expect("flip" in reached_by_tab(page), "Tab reaches flip")
    for node in page.browser.call("Accessibility.getFullAXTree")["nodes"]:
        if not node.get("ignored") and node["role"]["value"] in ("button", "slider", "combobox", "spinbutton", "checkbox", "application", "image"):
            expect(node.get("name", {}).get("value"), f"a {node['role']['value']} without a name")
    compare("wipe")
    page.tick("undo")
    page.choose("method-b", "")
    page.choose("method", "")


def main():
    with tempfile.TemporaryDirectory(prefix="penumbra-page-") as name, Browser() as browser:
        folder = pathlib.Path(name)
        scene = folder / "scene.json"
        scene.write_text(LIGHTS)
        with Server(PROGRAM, scene) as server:
            page = Page(browser, server, width=1400, height=900)
            check_camera(page, folder)
            check_lights(page, folder)
            check_methods(page, folder)
            check_pixel(page, folder)
            check_typed_pixel(page, folder)
            check_reach(page)
            check_report(page)
            browser.call("Page.navigate", url="about:blank")  # a page whose server has ended would search for it and log errors
        check_saving(browser, folder)
        if PHOTOGRAPHS:
            with Server(PROGRAM, SCENES / "room.json") as server:
                for name, window in (("wide", {"width": 1400, "height": 900}), ("dark", {"width": 1400, "height": 900, "dark": True}),
                                     ("narrow", {"width": 420, "height": 900, "phone": True})):
                    page = Page(browser, server, **window)
                    if name == "wide":
                        page.choose("light", "sky")
                        page.ask("document.getElementById('see-light').click()")
                        page.choose("method-b", "shadow-map")
                        browser.pointer("mouseMoved", *page.place(0.35, 0.7))
                        time.sleep(1)
                    page.exact()
                    page.picture(name)
                browser.call("Page.navigate", url="about:blank")
        problems = [problem for problem in browser.problems if not problem.startswith("asks for http://127.0.0.1:")]
        same(problems, [], "problems of the page")
    return verdict()


if __name__ == "__main__":
    sys.exit(main())
