#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the 3D view of `penumbra view` in headless Chromium (WebGL in software): what is drawn, by which controls, and
that it equals what `wedges` builds.   live_space_page.py PROGRAM SCENES [PHOTOGRAPHS]"""
import base64
import json
import pathlib
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "browser"))
from browser import Browser  # noqa: E402
from claims import expect, same, verdict  # noqa: E402
from live_client import LIGHTS, Server, png_pixels  # noqa: E402
from live_page import PHOTOGRAPHS, PROGRAM, SCENES, Page, rendered  # noqa: E402

CANVAS = "document.getElementById('space-canvas')"
CHOSEN = (0xff, 0xd2, 0x3f)  # the colour of the chosen wedge's edge


class SpacePage(Page):
    def data(self, name):
        return self.ask(f"{CANVAS}.dataset.{name}")

    def number(self, name):
        return int(self.data(name))

    def settle(self):
        """Waits until everything requested is drawn."""
        self.browser.wait(f"{CANVAS}.dataset.busy === 'false'", 60)
        self.ask("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
        self.browser.wait(f"{CANVAS}.dataset.busy === 'false' && Number({CANVAS}.dataset.drawn) > 0", 60)

    def show(self):
        self.ask("document.getElementById('tab-space').click()")
        self.settle()

    def set(self, control, value):
        """Sets a control that does not lead to another picture."""
        action = f"c.checked !== {json.dumps(value)} && c.click()" if isinstance(value, bool) else \
            f"(c.value = {json.dumps(str(value))}, c.dispatchEvent(new Event('input')), c.dispatchEvent(new Event('change')))"
        self.ask(f"(() => {{ const c = document.getElementById('{control}'); {action}; }})()")
        self.settle()

    def pixels(self):
        """Returns the rows of the 3D view as it is on the screen, and its place in the window."""
        self.ask("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
        left, top, width, height = [round(value) + edge for value, edge in zip(self.box("#space-canvas"), (2, 2, -4, -4))]
        picture = self.browser.call("Page.captureScreenshot", format="png", clip={"x": left, "y": top, "width": width, "height": height, "scale": 1})
        _, _, rows = png_pixels(base64.b64decode(picture["data"]))
        return [[tuple(row[x:x + 3]) for x in range(0, len(row), 3)] for row in rows], (left, top)


def colors(rows):
    return {pixel for row in rows for pixel in row}


def wedges(scene, folder, *arguments):
    subprocess.run([PROGRAM, "wedges", str(scene), "--json", str(folder / "wedges.json"), *arguments], check=True, stdout=subprocess.DEVNULL)
    return json.loads((folder / "wedges.json").read_text())


def check_drawn(page, scene, folder):
    known = wedges(scene, folder, "--light", "key")
    page.show()
    same(page.data("trouble"), None, "nothing went wrong")
    same(page.number("wedges"), len(known["wedges"]), "the wedges")
    same(page.data("shown"), page.data("triangles"), "all triangles")
    expect(page.ask("document.getElementById('frame').hidden && !document.getElementById('space').hidden"), "the tab's panel alone is shown")
    rows, _ = page.pixels()
    expect(len(rows) > 300 and len(colors(rows)) > 100, f"the view is not blank: {len(colors(rows))} colours")
    page.picture("space-first")
    # Each layer is drawn, and is not drawn when it is off.
    page.set("layer-volume", True)
    page.set("layer-defects", True)
    same(page.number("defectLines"), 4, "the floor's outline")
    expect(page.ask("document.querySelectorAll('#space-defects li').length") >= 2, "a legend of the defects")
    for layer in ("meshes", "lights", "frustum", "silhouettes", "volume", "wedges", "floor", "defects"):
        before, first = page.number("calls"), page.number("drawn")
        page.set(f"layer-{layer}", False)
        page.browser.wait(f"Number({CANVAS}.dataset.drawn) > {first}", 20)
        expect(page.number("calls") < before, f"{layer} is no longer drawn: {before} calls, then {page.number('calls')}")
    same(page.number("calls"), 0, "nothing is drawn")
    rows, _ = page.pixels()
    same(len(colors(rows)), 1, "then the view is empty")
    for layer in ("meshes", "lights", "frustum", "silhouettes", "wedges", "floor"):
        page.set(f"layer-{layer}", True)


def check_one_wedge(page):
    page.set("space-all", False)
    same(page.number("bodies"), 1, "one body")
    wedge = page.number("wedges") // 3
    page.set("space-wedge", wedge)
    same(page.number("chosen"), wedge, "the wedge that was typed")
    expect(page.number("floorLines") >= 3, "the floor cuts it")
    expect(f"Wedge {wedge}: edge from" in page.ask("document.getElementById('space-wedge-facts').textContent"), "what is said of it")
    page.set("layer-wedges", True)
    for layer in ("meshes", "lights", "frustum", "silhouettes", "floor"):
        page.set(f"layer-{layer}", False)
    rows, (left, top) = page.pixels()
    places = [(x, y) for y, row in enumerate(rows) for x, pixel in enumerate(row) if max(abs(a - b) for a, b in zip(pixel, CHOSEN)) < 12]
    expect(places, "the chosen wedge's edge is on the screen")
    x, y = places[len(places) // 2]
    page.set("space-all", True)
    page.set("space-wedge", 0)
    page.browser.click(left + x + 0.5, top + y + 0.5)
    page.settle()
    expect(abs(page.number("chosen") - wedge) <= 2 and page.number("chosen") > 0, f"a click on its edge chooses it: {page.number('chosen')}, not {wedge}")
    for layer in ("meshes", "lights", "frustum", "silhouettes", "floor"):
        page.set(f"layer-{layer}", True)
    page.ask(f"{CANVAS}.focus()")
    chosen = page.number("chosen")
    page.browser.key("n")
    page.settle()
    same(page.number("chosen"), chosen + 1, "N chooses the next")
    before, drawn = page.pixels()[0], page.number("drawn")
    page.browser.key("ArrowRight")
    page.browser.wait(f"Number({CANVAS}.dataset.drawn) > {drawn}", 20)
    expect(page.pixels()[0] != before, "an arrow turns the view")
    x, y, width, height = page.box("#space-canvas")
    drawn = page.number("drawn")
    start = (x + width / 2, y + height / 2)
    page.browser.pointer("mouseMoved", *start)
    page.browser.pointer("mousePressed", *start, button="left", buttons=1, clickCount=1)
    page.browser.pointer("mouseMoved", start[0] + 60, start[1] + 10, button="left", buttons=1)
    page.browser.pointer("mouseReleased", start[0] + 60, start[1] + 10, button="left", clickCount=1)
    page.browser.wait(f"Number({CANVAS}.dataset.drawn) > {drawn}", 20)
    page.ask("document.getElementById('space-home').click()")


def check_constructions(page, scene, folder):
    page.set("space-construction", "tight")
    page.set("space-from", "anywhere")
    same(page.number("wedges"), len(wedges(scene, folder, "--light", "key", "--construction", "tight", "--from", "anywhere")["wedges"]), "tight, from anywhere")
    page.set("space-construction", "original")
    page.set("space-from", "centre")
    silhouettes = page.number("silhouettes")
    page.set("space-s", 1)
    page.set("space-t", -1)
    expect(page.number("silhouettes") != silhouettes, "silhouettes from a corner of the light are others")
    page.set("space-s", 0)
    page.set("space-t", 0)
    same(page.number("silhouettes"), silhouettes, "and from its centre the same as before")
    lines = page.number("floorLines")
    page.set("space-floor", 0.5)
    expect(page.number("floorLines") != lines, "a higher floor cuts other polygons")
    page.set("space-cut", True)
    page.set("space-cut", False)
    page.set("space-floor", "")


def check_light_and_pixel(page, folder):
    page.type("[aria-label='position x']", "1.5")
    page.settle()
    saved = folder / "moved.json"
    saved.write_bytes(page.server.get("/scene.json")[2])
    page.browser.wait(f"{CANVAS}.dataset.wedges === '{len(wedges(saved, folder, '--light', 'key')['wedges'])}'", 30)
    page.choose("light", "sun")
    page.settle()
    same(page.data("refused"), "true", "a sun has no wedges")
    expect("sun" in page.ask("document.getElementById('space-facts').textContent"), "and the page says so")
    page.choose("light", "key")
    page.settle()
    page.ask("document.getElementById('tab-picture').click()")
    exr, _ = rendered(page, folder, "pixel")
    i = min(range(64 * 64), key=lambda i: abs(exr["key.V"][i] - 0.5) + (exr["id"][i] == 0xffffffff))  # a pixel in a penumbra
    x, y = i % 64, i // 64
    page.browser.pointer("mouseMoved", *page.place((x + 0.5) / 64, (y + 0.5) / 64))
    page.browser.wait(f"document.getElementById('readout').dataset.pixel === '{x},{y}'")
    page.show()
    page.set("space-pixel", True)
    known = wedges(saved, folder, "--light", "key", "--explain", f"{x},{y}")["explain"]
    expect(page.number("inside") >= len(known["wedges"]) > 0, f"the pixel's wedges: {page.data('inside')}, not {len(known['wedges'])}")
    page.picture("space-pixel")
    page.set("space-pixel", False)


def check_reach(page):
    page.ask("document.activeElement.blur()")
    reached = set()
    for _ in range(75):
        page.browser.key("Tab")
        reached.add(page.ask("document.activeElement.id"))
    for control in ("tab-space", "space-canvas", "layer-meshes", "layer-defects", "space-all", "space-wedge", "space-pixel", "space-construction", "space-from",
                    "space-s", "space-t", "space-floor", "space-cut", "space-home"):
        expect(control in reached, f"Tab reaches {control}")
    for node in page.browser.call("Accessibility.getFullAXTree")["nodes"]:
        if not node.get("ignored") and node["role"]["value"] in ("button", "slider", "combobox", "spinbutton", "checkbox", "application", "tab", "tabpanel"):
            expect(node.get("name", {}).get("value"), f"a {node['role']['value']} without a name")
    page.ask("document.getElementById('tab-space').focus()")
    page.browser.key("ArrowLeft")
    same(page.ask("document.getElementById('tab-picture').getAttribute('aria-selected')"), "true", "an arrow goes to the other tab")


def take_pictures(browser):
    """Takes pictures for the documentation, and for people to look at."""
    for name, scene, window in (("space", "contact.json", {"width": 1400, "height": 900}), ("space-dark", "contact.json", {"width": 1400, "height": 900, "dark": True}),
                                ("space-narrow", "room.json", {"width": 420, "height": 900, "phone": True}),
                                ("space-broken", "broken.json", {"width": 1400, "height": 900})):
        with Server(PROGRAM, SCENES / scene) as server:
            page = SpacePage(browser, server, **window)
            page.show()
            if name == "space-broken":
                page.set("layer-defects", True)
                page.set("layer-wedges", False)
            if name == "space":
                page.set("layer-frustum", False)
                page.ask(f"{CANVAS}.focus()")
                for _ in range(7):
                    page.browser.key("+")
                page.ask("document.activeElement.blur()")
            if name == "space-narrow":
                page.set("space-glass", True)
            time.sleep(0.5)
            page.picture(name)
            browser.call("Page.navigate", url="about:blank")


def main():
    with tempfile.TemporaryDirectory(prefix="penumbra-space-page-") as name, Browser() as browser:
        folder = pathlib.Path(name)
        scene = folder / "scene.json"
        scene.write_text(LIGHTS)
        with Server(PROGRAM, scene) as server:
            page = SpacePage(browser, server, width=1400, height=900)
            check_drawn(page, scene, folder)
            check_one_wedge(page)
            check_constructions(page, scene, folder)
            check_light_and_pixel(page, folder)
            check_reach(page)
            browser.call("Page.navigate", url="about:blank")
        if PHOTOGRAPHS:
            take_pictures(browser)
        problems = [problem for problem in browser.problems if not problem.startswith("asks for http://127.0.0.1:")]
        same(problems, [], "problems of the page")
    return verdict()


if __name__ == "__main__":
    sys.exit(main())
