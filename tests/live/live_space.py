#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the answers of `penumbra view` for its page's 3D view with the output of `wedges` and `inspect`.
live_space.py PROGRAM"""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "browser"))
from claims import expect, same, verdict  # noqa: E402
from exr import read_exr  # noqa: E402
from live_client import LIGHTS, Client, Server  # noqa: E402

PROGRAM = sys.argv[1]


class Space:
    """An answer: its `header`, and arrays of numbers by name."""

    def __init__(self, status, data):
        self.status, self.text, self.arrays = status, "", {}
        if status != 200:
            self.text = data.decode()
            return
        length = struct.unpack_from("<I", data)[0]
        self.header, at = json.loads(data[4:4 + length]), 4 + length
        for array in self.header["buffers"]:
            code = {"float32": "f", "uint32": "I", "int32": "i"}[array["type"]]
            self.arrays[array["name"]] = struct.unpack_from(f"<{array['count']}{code}", data, at)
            at += 4 * array["count"]
        same(at, len(data), "an answer has as many bytes as its header")


def ask(server, what, **parameters):
    query = urllib.parse.urlencode(parameters)
    status, _, body = server.get(f"/space/{what}", token=f"{server.token}&{query}")
    return Space(status, body)


def wedges(scene, folder, *arguments):
    """Returns the output of `wedges` for the scene."""
    subprocess.run([PROGRAM, "wedges", str(scene), "--json", str(folder / "wedges.json"), *arguments], check=True, stdout=subprocess.DEVNULL)
    return json.loads((folder / "wedges.json").read_text())


def check_meshes(server):
    meshes = ask(server, "meshes")
    same(meshes.header["shown"], meshes.header["triangles"], "all triangles are drawn")
    same(len(meshes.arrays["objects"]), meshes.header["triangles"], "each triangle has its object")
    same([one["name"] for one in meshes.header["objects"]], ["floor", "knot"], "the objects")
    expect(max(meshes.arrays["triangles"]) < len(meshes.arrays["positions"]) / 3, "every index of a triangle is a position")
    low = min(meshes.arrays["positions"][1::3]) + meshes.header["origin"][1]
    expect(abs(low - meshes.header["lower"][1]) < 1e-6 and abs(low) < 1e-6, f"the floor is at 0, not {low}")
    defects = ask(server, "defects")
    kinds = {one["what"]: one["count"] for one in defects.header["kinds"]}
    same(kinds.get("boundary edges"), 4, "the floor has an outline, the knot none")
    same(len(defects.arrays["lines"]), 6 * len(defects.arrays["lineColors"]), "each line has a colour")


def check_shadows(server, scene, folder):
    for light, construction, source in (("key", "original", "centre"), ("key", "tight", "anywhere"), ("ball", "tight", "centre")):
        answer = ask(server, "shadows", light=light, construction=construction, **{"from": source})
        known = wedges(scene, folder, "--light", light, "--construction", construction, "--from", source)
        same(answer.header["wedges"], len(known["wedges"]), f"wedges of {light}, {construction}, from {source}")
        places = [value for wedge in known["wedges"] for end in wedge["edge"] for value in end]
        expect(all(abs(a - b) <= 1e-6 * max(1, abs(b)) for a, b in zip(answer.arrays["wedgeEdges"], places)), "their edges")
        names = ["wedge", "split", "everywhere", "empty"]
        same([names[number] for number in answer.arrays["outcomes"]], [wedge["outcome"] for wedge in known["wedges"]], "the outcome of each edge")
        bodies = answer.arrays["bodies"]
        same(len(bodies) // 4, sum(wedge["outcome"] == "wedge" for wedge in known["wedges"]), "each wedge has a body")
        same(len(answer.arrays["bodyTriangles"]), 9 * sum(bodies[1::4]), "their triangles")
        same(len(answer.arrays["floorLines"]), 6 * sum(bodies[3::4]), "and the polygons in which the floor cuts them")
        expect(answer.header["silhouettes"] > 50, "silhouettes of the knot")
    # The planes of a wedge hold at the corners of its body, and the body reaches the floor.
    known = wedges(scene, folder, "--light", "key")
    number = next(i for i, wedge in enumerate(known["wedges"]) if wedge["outcome"] == "wedge" and wedge["edge"][0][1] > -0.5)
    one = ask(server, "shadows", light="key", wedge=number)
    same((one.header["bodies"], one.arrays["bodies"][0]), (1, number), "one wedge")
    corners = list(zip(*[iter(one.arrays["bodyTriangles"])] * 3))
    for a, b, c, d in known["wedges"][number]["planes"]:
        size = (a * a + b * b + c * c) ** 0.5
        expect(min(a * x + b * y + c * z + d for x, y, z in corners) > -1e-5 * size, "no corner of the body is outside of a plane")
    floor = min(y for _, y, _ in corners)
    same(set(one.arrays["floorLines"][1::3]), {floor}, "it is cut by the lowest plane")
    higher = ask(server, "shadows", light="key", wedge=number, floor=0.25)
    expect(higher.header["floor"] == 0.25 and len(higher.arrays["floorLines"]) > 0, "and by another")


def check_pixel(server, scene, folder):
    """The wedges that contain a pixel's point are those of `wedges --explain`, which names one for each edge."""
    subprocess.run([PROGRAM, "render", str(scene), "-o", str(folder / "v.exr"), "-q"], check=True)
    exr = read_exr(folder / "v.exr")[0]
    found = [(i % 64, i // 64) for i, v in enumerate(exr["key.V"]) if 0.1 < v < 0.9 and exr["id"][i] < 2]  # points on the floor
    expect(len(found) > 30, f"pixels in the penumbra: {len(found)}")
    for x, y in found[::len(found) // 4]:
        answer = ask(server, "shadows", light="key", x=x, y=y)
        known = wedges(scene, folder, "--light", "key", "--explain", f"{x},{y}")["explain"]
        named = {wedge["wedge"] for wedge in known["wedges"]}
        expect(named and named <= set(answer.header["inside"]["wedges"]), f"wedges at {x},{y}: {answer.header['inside']}, not {named}")
    expect("inside" not in ask(server, "shadows", light="key", x=0, y=0).header, "a pixel without a surface")


def check_moved_light(server, scene, folder):
    client = Client(server).begin()
    client.final()
    same(client.state["meshes"], 1, "the number of the meshes")
    client.send(type="light", name="key", light={"rectangle": {"center": [1, 5, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}, "radiance": [1, 1, 1]}, stamp=1)
    client.final(1)
    moved = ask(server, "shadows", light="key", s=-1, t=1)
    expect(max(abs(a - b) for a, b in zip(moved.header["point"], [0.5, 5, 0.5])) < 1e-6, f"a corner of the moved light: {moved.header['point']}")
    saved = folder / "moved.json"
    saved.write_bytes(server.get("/scene.json")[2])
    same(moved.header["wedges"], len(wedges(saved, folder, "--light", "key")["wedges"]), "wedges of the moved light")
    client.socket.close()


def check_refusals(server):
    expect("sun" in ask(server, "shadows", light="sun").header["refused"], "a sun has no wedges")
    for parameters in ({"light": "moon"}, {"light": "key", "s": 2}, {"light": "key", "t": "x"}, {"light": "key", "wedge": -1}, {"light": "key", "floor": "nan"},
                       {"light": "key", "construction": "best"}, {"light": "key", "from": "behind"}):
        answer = ask(server, "shadows", **parameters)
        same(answer.status, 400, f"{parameters}")
        expect(len(answer.text) > 10, "the refusal gives a reason")
    same(server.get("/space/meshes", token="")[0], 403, "meshes without the token")
    same(server.get("/three.js", token="x")[0], 403, "the script without the token")
    same(server.get("/space/", token=None)[0], 404, "nothing else")


def main():
    with tempfile.TemporaryDirectory(prefix="penumbra-space-") as name:
        folder = pathlib.Path(name)
        scene = folder / "scene.json"
        scene.write_text(LIGHTS)
        with Server(PROGRAM, scene) as server:
            Client(server).begin().final()
            check_meshes(server)
            check_shadows(server, scene, folder)
            check_pixel(server, scene, folder)
            check_refusals(server)
            check_moved_light(server, scene, folder)
    return verdict()


if __name__ == "__main__":
    sys.exit(main())
