#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures how fast `penumbra view` answers: clients without a page drag the camera and a light, one after the other and
both at once, and note the times of pictures, their cost, and whether each is complete. The same drags are then made by a
pointer in the page itself, in headless Chromium if that is installed.
  live_latency.py PROGRAM SCENE… [--seconds S] [--minutes M] [--out FILE.json]
--minutes: for this time the first scene's camera and light are then dragged, and memory is noted every ten seconds.
Without --out a table is printed; FILE.json is one of bench/results/."""
import argparse
import json
import math
import os
import pathlib
import shutil
import statistics
import struct
import subprocess
import sys
import threading
import time
import zlib

TESTS = pathlib.Path(__file__).resolve().parent.parent / "tests"
sys.path[:0] = [str(TESTS / "live"), str(TESTS / "browser")]
from browser import Browser  # noqa: E402
from live_client import Client, Server  # noqa: E402

COLUMNS = ["scene, and what is dragged", "pictures a second (median)", "from input to picture: median, ms", "95 % within, ms",
           "from the last move to the exact picture, s", "processor ms a picture", "memory, MiB", "torn"]
FORMATS = [None, ".1f", ".0f", ".0f", ".2f", ".0f", ".0f", None]


def is_whole(frame):
    """Returns whether each image of a picture is complete: a JPEG from its first to its last marker, a PNG with all checksums right."""
    for image, data in zip(frame["images"], frame["files"]):
        if image["type"] == "image/jpeg":
            if data[:2] != b"\xff\xd8" or data[-2:] != b"\xff\xd9":
                return False
            continue
        at = 8
        while at < len(data):
            size, = struct.unpack_from(">I", data, at)
            if struct.unpack_from(">I", data, at + 8 + size)[0] != zlib.crc32(data[at + 4:at + 8 + size]):
                return False
            at += size + 12
        if data[-8:-4] != b"IEND" or at != len(data):
            return False
    return True


class Use:
    """Processor seconds and memory of a process."""

    def __init__(self, process):
        self.folder = pathlib.Path(f"/proc/{process.pid}")
        self.began = self.processor()

    def processor(self):
        fields = (self.folder / "stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def memory(self):
        return next(int(line.split()[1]) / 1024 for line in (self.folder / "status").read_text().splitlines() if line.startswith("VmRSS"))

    def since(self):
        return self.processor() - self.began


class Drag:
    """Sends a change every sixtieth of a second, and notes the times of pictures, and how long each change waited for the
    first picture that shows this change or a later one."""

    def __init__(self, client, seconds, message, each=lambda: None):
        sent, self.came, self.delays, self.torn, number = {}, [], [], 0, 0
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            number += 1
            sent[number] = time.monotonic()
            client.send(**message(number / 60), moving=True, stamp=number)
            for answer in client.wait(1 / 60):
                if answer["type"] != "frame":
                    continue
                self.torn += not is_whole(answer)
                stamp = answer["stamps"].get(str(client.number))
                if stamp is None:
                    continue
                self.came.append(time.monotonic())
                self.delays += [self.came[-1] - sent.pop(earlier) for earlier in [change for change in sent if change <= stamp]]
            each()
        ended = time.monotonic()
        client.send(type="still")
        client.final(number)
        self.exact = time.monotonic() - ended

    def row(self, name, processor, memory):
        ordered, first = sorted(self.delays), self.came[0]
        seconds = [0] * max(1, int(self.came[-1] - first))
        for when in self.came:
            if when - first < len(seconds):
                seconds[int(when - first)] += 1
        return [name, float(statistics.median(seconds)), 1000 * statistics.median(ordered), 1000 * ordered[int(0.95 * (len(ordered) - 1))], self.exact,
                None if processor is None else 1000 * processor / len(self.came), memory, self.torn]


class PageDrag(Drag):
    """A drag by the pointer on the page, with a move every sixtieth of a second. The page's data-stamp tells which
    input a picture shows."""

    NOTES = """(() => { const root = document.documentElement.dataset; window.notes = []; window.moves = []; window.released = 0;
        addEventListener('pointermove', (event) => { if (event.buttons) moves.push(event.timeStamp); }, true);
        addEventListener('pointerup', () => { released = performance.now(); }, true);
        new MutationObserver(() => notes.push([performance.now(), Number(root.stamp), root.exact === 'true']))
          .observe(document.documentElement, { attributeFilter: ['data-frame'] }); })()"""

    def __init__(self, browser, seconds, start, across):
        x, y = start
        browser.ask(self.NOTES)
        browser.pointer("mouseMoved", x, y)
        browser.pointer("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        began, moves = time.monotonic(), 0
        while time.monotonic() < began + seconds:
            moves += 1
            browser.pointer("mouseMoved", x + across * math.sin(moves / 60), y, button="left", buttons=1)
            time.sleep(max(0, began + moves / 60 - time.monotonic()))
        browser.pointer("mouseReleased", x + across * math.sin(moves / 60), y, button="left", clickCount=1)
        browser.wait("released && notes.length && notes.at(-1)[2] && notes.at(-1)[0] > released")
        notes, released, waiting = browser.ask("notes"), browser.ask("released"), browser.ask("moves")
        self.came, self.delays = [when / 1000 for when, _, _ in notes if when < released], []
        for when, stamp, _ in notes:
            self.delays += [(when - move) / 1000 for move in waiting if move <= stamp]
            waiting = [move for move in waiting if move > stamp]
        self.exact, self.torn = (notes[-1][0] - released) / 1000, None


def orbit(state):
    camera = state["camera"]
    away = [a - b for a, b in zip(camera["eye"], camera["target"])]

    def message(t):
        c, s = math.cos(0.5 * math.sin(t)), math.sin(0.5 * math.sin(t))
        eye = [c * away[0] + s * away[2], away[1], c * away[2] - s * away[0]]
        return {"type": "camera", "camera": {**{key: camera[key] for key in ("target", "up", "verticalFov") if key in camera},
                                             "eye": [a + b for a, b in zip(eye, camera["target"])]}}
    return message


def moved_light(state):
    light = state["lights"][0]
    kind = next(key for key in light if key not in ("name", "radiance", "irradiance", "twoSided", "fixed", "textured"))
    bright = "irradiance" if "irradiance" in light else "radiance"

    def message(t):
        x, y, z = light[kind]["center"]
        return {"type": "light", "name": light["name"], "light": {kind: {**light[kind], "center": [x + 0.3 * math.sin(t), y, z]}, bright: light[bright]}}
    return message


def measure(program, scene, seconds):
    name, rows = pathlib.Path(scene).name, []
    with Server(program, scene, "--size", "512x512") as server:
        client = Client(server).begin()
        triangles = client.final()["triangles"]
        for what, message in (("camera", orbit(client.state)), ("light", moved_light(client.state))):
            use = Use(server.process)
            drag = Drag(client, seconds, message)
            rows.append(drag.row(f"`{name}` ({triangles:,} triangles), {what}", use.since(), use.memory()))
    return rows


def measure_two(program, scene, seconds):
    """Measures two clients at once, one that drags the camera and one that drags a light: pictures of each client's own
    moves."""
    with Server(program, scene, "--size", "512x512") as server:
        clients = [Client(server).begin() for _ in range(2)]
        clients[0].final()
        drags, use = {}, Use(server.process)
        kinds = {"camera": (clients[0], orbit(clients[0].state)), "light": (clients[1], moved_light(clients[0].state))}
        threads = [threading.Thread(target=lambda kind=kind, client=client, message=message: drags.update({kind: Drag(client, seconds, message)}))
                   for kind, (client, message) in kinds.items()]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        each = use.since()
        return [drags[kind].row(f"`{pathlib.Path(scene).name}`, two clients: the one with the {kind}", each if kind == "camera" else None, use.memory()) for kind in kinds]


def measure_page(program, scene, seconds):
    """Measures the page in headless Chromium, which also takes processor time."""
    name, rows = pathlib.Path(scene).name, []
    middle = "(() => { const b = document.querySelector('%s').getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; })()"
    with Browser() as browser, Server(program, scene, "--size", "512x512") as server:
        browser.open(server.url)
        browser.wait("document.documentElement.dataset.exact === 'true'")
        for what, handle, across in (("camera", "#picture", 150), ("light", "[data-handle=\\'move\\']", 60)):
            if what == "light":
                browser.ask("document.getElementById('see-light').click()")
                time.sleep(0.3)
                browser.wait("document.documentElement.dataset.exact === 'true'")
            use = Use(server.process)
            drag = PageDrag(browser, seconds, browser.ask(middle % handle), across)
            rows.append(drag.row(f"`{name}`, the page in Chromium, {what}", use.since(), use.memory()))
        browser.call("Page.navigate", url="about:blank")  # otherwise the page would try to reconnect
    return rows


def measure_long(program, scene, minutes):
    """Measures memory every ten seconds after the first minute."""
    with Server(program, scene, "--size", "512x512") as server:
        client = Client(server).begin()
        client.final()
        camera, light, use, notes, began = orbit(client.state), moved_light(client.state), Use(server.process), [], time.monotonic()

        def note():
            if time.monotonic() - began > 60 + 10 * len(notes):
                notes.append(use.memory())

        drag = Drag(client, 60 * minutes, lambda t: light(t) if int(t / 5) % 2 else camera(t), note)
        row = drag.row(f"`{pathlib.Path(scene).name}`, {minutes:g} minutes, camera and light by turns", use.since(), use.memory())
        return row, notes, len(drag.came)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--minutes", type=float, default=0)
    parser.add_argument("--out", type=pathlib.Path)
    arguments = parser.parse_args()
    loads, rows, said = [os.getloadavg()[0]], [], ""
    for scene in arguments.scenes:
        rows += measure(arguments.program, scene, arguments.seconds)
        loads.append(os.getloadavg()[0])
    rows += measure_two(arguments.program, arguments.scenes[0], arguments.seconds)
    if shutil.which("chromium"):
        rows += measure_page(arguments.program, arguments.scenes[0], arguments.seconds)
    if arguments.minutes:
        row, notes, count = measure_long(arguments.program, arguments.scenes[0], arguments.minutes)
        rows.append(row)
        if len(notes) > 1:
            said = f" In the long drag {count:,} pictures came; memory after a minute {notes[0]:.0f} MiB, then {min(notes):.0f} to {max(notes):.0f} MiB."
    loads.append(os.getloadavg()[0])
    load = f"{min(loads):.0f} to {max(loads):.0f}"
    # The program and the clients add to the load: on an otherwise idle machine it is at most three.
    busy = [what for what, one in (("", loads[0]), (" in the long drag", loads[-1])) if one > 4]
    others = f"Other programs were at work on the same threads{busy[0]}: an idle machine does better. " if busy else ""
    if not arguments.out:
        for row in rows:
            print(" | ".join("" if value is None else f"{value:{form or ''}}" for value, form in zip(row, FORMATS)))
        return print(f"{os.cpu_count()} threads, load {load}.{said}")
    root = pathlib.Path(__file__).resolve().parent.parent
    commit = subprocess.run(["git", "-C", str(root), "rev-parse", "--short=8", "HEAD"], capture_output=True, text=True, check=True).stdout.strip()
    model = next((line.partition(":")[2].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "a processor")
    result = {"title": "answers of the live view to a drag", "commit": commit, "machine": f"{model}, {os.cpu_count()} threads, load {load}",
              "command": f"bench/live_latency.py build/penumbra {' '.join(f'scenes/{pathlib.Path(scene).name}' for scene in arguments.scenes)} "
                         f"--seconds {arguments.seconds:g} --minutes {arguments.minutes:g}",
              "conditions": "A bare client sends 60 changes a second, at 512 × 512 pixels. " + others +
                            "Processor time is of all pictures, quick and exact, and depends less on the load: quick pictures are coarser when time is short. Memory is that of the whole process at the end." + said,
              "columns": COLUMNS, "formats": FORMATS, "rows": rows}
    parts = [f' "{key}": {json.dumps(value, ensure_ascii=False)}' for key, value in result.items() if key != "rows"]
    listed = ",\n".join("  " + json.dumps([round(cell, 2) if isinstance(cell, float) else cell for cell in row], ensure_ascii=False) for row in rows)
    arguments.out.write_text("{\n" + ",\n".join(parts) + ',\n "rows": [\n' + listed + "\n ]\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
