#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the animated picture of docs/view.md: the page of `penumbra view` in headless Chromium, photographed while a
light is dragged by its handle, when the final picture has come, and while the camera orbits.
  live_moving.py PROGRAM SCENE FILE.webp
A photograph is made when the page has shown a newer picture, so the file shows the order of pictures and not their rate."""
import io
import math
import pathlib
import sys

from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "browser"))
from browser import Browser  # noqa: E402
from claims import expect, verdict  # noqa: E402
from live_client import Server  # noqa: E402

WINDOW = {"width": 1180, "height": 720}
SHOWN = (786, 480)  # size of the picture in the file, in pixels
STEPS = 28
MILLISECONDS = {"moving": 90, "final": 900}


class Photographs:
    """Photographs of a page, and how long each is shown."""

    def __init__(self, browser):
        self.browser, self.pictures, self.delays, self.pointer = browser, [], [], None

    def make(self, delay):
        picture = Image.open(io.BytesIO(self.browser.picture())).convert("RGB")
        self.pictures.append(picture.resize(SHOWN, Image.LANCZOS))
        self.delays.append(delay)

    def final(self):
        self.browser.wait("document.documentElement.dataset.exact === 'true'")
        self.make(MILLISECONDS["final"])

    def drag(self, start, place):
        """Drags the pointer from `start` through place(0 … 1), and photographs each picture that results."""
        self.browser.pointer("mouseMoved", *start)
        self.browser.pointer("mousePressed", *start, button="left", buttons=1, clickCount=1)
        for step in range(1, STEPS + 1):
            shown = self.browser.ask("document.documentElement.dataset.frame")
            at = place(step / STEPS)
            self.browser.pointer("mouseMoved", *at, button="left", buttons=1)
            self.browser.wait(f"document.documentElement.dataset.frame !== {shown!r}")
            self.make(MILLISECONDS["moving"])
        self.browser.pointer("mouseReleased", *at, button="left", clickCount=1)
        self.final()

    def write(self, path):
        self.pictures[0].save(path, save_all=True, append_images=self.pictures[1:], duration=self.delays, loop=0, quality=70, method=6)


def middle(browser, selector):
    return browser.ask(f"(() => {{ const b = document.querySelector({selector!r}).getBoundingClientRect(); "
                       "return [b.x + b.width / 2, b.y + b.height / 2]; })()")


def photograph(program, scene, path):
    with Browser() as browser, Server(program, scene) as server:
        browser.open(server.url, **WINDOW)
        photographs = Photographs(browser)
        photographs.final()
        browser.ask("document.getElementById('see-light').click()")  # the camera moves back until the light is in the picture
        photographs.final()
        x, y = middle(browser, "[data-handle='move along X']")
        photographs.drag((x, y), lambda t: (x + 110 * math.sin(2 * math.pi * t), y + 25 * math.sin(2 * math.pi * t)))
        x, y = middle(browser, "#picture")
        photographs.drag((x, y + 150), lambda t: (x - 160 * math.sin(math.pi * t) ** 2, y + 150))
        browser.call("Page.navigate", url="about:blank")  # a page whose server has ended would search for it and log errors
    path.parent.mkdir(parents=True, exist_ok=True)
    photographs.write(path)
    return photographs.pictures


def main():
    path = pathlib.Path(sys.argv[3])
    made = photograph(sys.argv[1], sys.argv[2], path)
    with Image.open(path) as written:
        expect(written.n_frames == len(made) and written.size == SHOWN, "all photographs are in the file")
    different = sum(a.tobytes() != b.tobytes() for a, b in zip(made, made[1:]))
    expect(different > 0.9 * len(made), f"the page changes from photograph to photograph: {different} of {len(made)}")
    print(f"{path}: {len(made)} photographs, {path.stat().st_size:,} bytes")
    return verdict()


if __name__ == "__main__":
    sys.exit(main())
