#!/usr/bin/env python3
"""How fast `penumbra view` answers: a bare client drags the camera, or a light, and notes when pictures come.
  live_latency.py PROGRAM SCENE [SECONDS]"""
import math
import os
import pathlib
import statistics
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests" / "live"))
from live_client import Client, Server  # noqa: E402


def drag(client, seconds, message):
    """Sends a change each sixtieth of a second; returns when pictures came and what each took from its input, in seconds."""
    sent, came, delays, number = {}, [], [], 0
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        number += 1
        sent[number] = time.monotonic()
        client.send(**message(number / 60), moving=True, stamp=number)
        for answer in client.wait(1 / 60):
            stamp = answer.get("stamps", {}).get(str(client.number)) if answer["type"] == "frame" else None
            if stamp in sent:
                came.append(time.monotonic())
                delays.append(came[-1] - sent[stamp])
    last = time.monotonic()
    client.send(type="still")
    client.final(number)
    return came, delays, time.monotonic() - last, time.monotonic() - sent[number]


def report(name, came, delays, after_still, after_move):
    ordered = sorted(delays)
    rate = (len(came) - 1) / (came[-1] - came[0])
    print(f"{name}: {rate:.1f} pictures a second, {1000 * statistics.median(delays):.0f} ms from input to picture (median), "
          f"95 % within {1000 * ordered[int(0.95 * (len(ordered) - 1))]:.0f} ms; final picture {after_move:.2f} s after the last move")


def memory(process):
    with open(f"/proc/{process.pid}/status") as file:
        return next(int(line.split()[1]) / 1024 for line in file if line.startswith("VmRSS"))


def main():
    seconds = float(sys.argv[3]) if len(sys.argv) > 3 else 10
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    with Server(sys.argv[1], sys.argv[2]) as server:
        client = Client(server).begin()
        client.final()
        camera = client.state["camera"]
        away = [a - b for a, b in zip(camera["eye"], camera["target"])]

        def orbit(t):
            c, s = math.cos(0.5 * math.sin(t)), math.sin(0.5 * math.sin(t))
            eye = [c * away[0] + s * away[2], away[1], c * away[2] - s * away[0]]
            return {"type": "camera", "camera": {**{key: camera[key] for key in ("target", "up", "verticalFov") if key in camera},
                                                 "eye": [a + b for a, b in zip(eye, camera["target"])]}}

        report("camera", *drag(client, seconds, orbit))
        before = memory(server.process)
        light = client.state["lights"][0]
        kind = next(key for key in light if key not in ("name", "radiance", "irradiance", "twoSided", "fixed", "textured"))
        if "center" in light[kind]:
            bright = "irradiance" if "irradiance" in light else "radiance"

            def move(t):
                x, y, z = light[kind]["center"]
                return {"type": "light", "name": light["name"],
                        "light": {kind: {**light[kind], "center": [x + 0.3 * math.sin(t), y, z]}, bright: light[bright]}}

            report("light", *drag(client, seconds, move))
        print(f"memory: {before:.0f} MiB after the first drag, {memory(server.process):.0f} MiB in the end")


if __name__ == "__main__":
    main()
