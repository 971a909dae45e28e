#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opens the live view and a report in headless Chromium: both draw their contents, and their scripts report no errors.
  pages_open.py PROGRAM"""
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "live"))
from browser import Browser  # noqa: E402
from claims import same, verdict  # noqa: E402
from live_client import LIGHTS, Server  # noqa: E402

ROOT, SPACE = "document.documentElement.dataset", "document.getElementById('space-canvas').dataset"


def check_view(browser, program, scene):
    """Checks the picture, another one after a key, and the 3D view."""
    with Server(program, scene) as server:
        browser.open(server.url)
        browser.wait(f"{ROOT}.exact === 'true'")
        before = int(browser.ask(f"{ROOT}.frame"))
        browser.ask("document.getElementById('picture').focus()")
        browser.key("ArrowLeft")
        browser.wait(f"{ROOT}.frame > {before} && {ROOT}.exact === 'true'")
        if browser.ask("document.getElementById('tab-space') !== null"):
            browser.ask("document.getElementById('tab-space').click()")
            browser.wait(f"{SPACE}.busy === 'false' && Number({SPACE}.drawn) > 0")
        browser.call("Page.navigate", url="about:blank")  # a page whose server has ended would search for it and log errors


def check_report(browser, program, scene, folder):
    subprocess.run([program, "compare", scene, "-o", folder, "--methods", "edge-scatter,shadow-map", "--reference-samples", "16", "--light-samples", "16",
                    "--size", "48x48", "--quiet"], check=True, stdout=subprocess.DEVNULL)
    browser.open((folder / "report.html").as_uri() + "#look")
    browser.wait("document.getElementById('viewer').dataset.drawn !== undefined")


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory(prefix="penumbra-pages-") as name, Browser() as browser:
        folder = pathlib.Path(name)
        scene = folder / "scene.json"
        scene.write_text(LIGHTS)
        check_view(browser, program, scene)
        check_report(browser, program, scene, folder / "report")
        problems = [problem for problem in browser.problems if not problem.startswith("asks for http://127.0.0.1:")]
        same(problems, [], "problems of the pages")
    return verdict()


if __name__ == "__main__":
    sys.exit(main())
