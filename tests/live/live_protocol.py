#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests `penumbra view` with a minimal client: which connections and messages are accepted, and that the final pictures
equal those that `render` writes.   live_protocol.py PROGRAM"""
import json
import math
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "browser"))
from claims import expect, same, verdict  # noqa: E402
from exr import read_bits, read_exr  # noqa: E402
from live_client import LIGHTS, Client, Closed, Server, png_pixels  # noqa: E402

PROGRAM = sys.argv[1]
SCENES = pathlib.Path(__file__).parents[2] / "scenes"
SIZE = 64


def render(scene, folder, name, *arguments):
    """Returns the output of `render`: the EXR's channels, and the PNG's pixels."""
    exr, png = folder / f"{name}.exr", folder / f"{name}.png"
    subprocess.run([PROGRAM, "render", str(scene), "-o", str(exr), "--png", str(png), "-q", *map(str, arguments)], check=True)
    return read_exr(exr)[0], png_pixels(png.read_bytes())


def check_who_is_let_in(server):
    same(server.get()[0], 200, "the page with its token")
    same(server.get(method="HEAD")[2], b"", "HEAD has no body")
    for what, answer in (("no token", server.get(token="")), ("a wrong token", server.get(token="0" * 32)),
                         ("a part of the token", server.get(token=server.token[:-1])),
                         ("no token for the scene", server.get("/scene.json", token="")),
                         ("no token for nothing", server.get("/nothing", token="")),
                         ("another host", server.get(Host="evil.example")),
                         ("a host that begins alike", server.get(Host="localhost.evil.example:80")),
                         ("another origin", server.get(Origin="http://evil.example")),
                         ("a file as origin", server.get(Origin="null"))):
        same(answer[0], 403, what)
    same(server.get(Host="localhost:9999")[0], 200, "a tunnel's port")
    same(server.get(Host="localhost:9999", Origin="http://localhost:9999")[0], 200, "the page's own origin")
    same(server.get(method="POST")[0], 405, "POST")
    same(server.get("/../etc/passwd")[0], 404, "a file of the system")
    headers = server.get()[1]
    policy = headers["Content-Security-Policy"]
    expect("default-src 'none'" in policy and "frame-ancestors 'none'" in policy, f"the policy of the page: {policy}")
    same(headers["Cache-Control"], "no-store", "nothing is kept")
    expect("http" not in server.get()[2].decode().replace("http://www.w3.org/2000/svg", ""), "the page requests nothing from other servers")
    same(Client(server, token="x").status, 403, "a socket without the token")
    same(Client(server, Origin="http://evil.example").status, 403, "a socket of another page")
    same(Client(server, Host="evil.example").status, 403, "a socket opened under another host name")
    with socket.create_connection((server.parts.hostname, server.parts.port)) as raw:
        raw.sendall(b"GET / HTTP/1.1\r\nX: " + b"x" * 20000)
        raw.settimeout(20)
        try:
            expect(raw.recv(100) == b"", "a header without end is not answered")
        except ConnectionResetError:
            pass


def check_refusals(server):
    """A message with an impossible request changes nothing, and is answered; a message that no page would send ends the
    connection."""
    client = Client(server).begin()
    client.final()
    rectangle = {"center": [0, 4, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}
    for what, message in (("no JSON", b"{"), ("no object", b"[1]"), ("no type", b"{}"), ("a type that is none", b'{"type": "shutdown"}'),
                          ("a light that is none", {"type": "light", "name": "moon", "light": {}}),
                          ("another kind of light", {"type": "light", "name": "key", "light": {"sphere": {"center": [0, 1, 0], "radius": 1}}}),
                          ("no size", {"type": "light", "name": "ball", "light": {"sphere": {"center": [0, 1, 0], "radius": -1}}}),
                          ("a file", {"type": "light", "name": "key", "light": {"rectangle": rectangle, "texture": "/etc/passwd"}}),
                          ("negative light", {"type": "light", "name": "key", "light": {"rectangle": rectangle, "radiance": [-1, 0, 0]}}),
                          ("a camera that sees nothing", {"type": "camera", "camera": {"eye": [0, 0, 0], "target": [0, 0, 0]}}),
                          ("a deep message", b'{"type": "light", "name": "key", "light": {"rectangle": ' + b"[" * 25000 + b"]" * 25000 + b"}}"),
                          ("a camera of words", {"type": "camera", "camera": {"eye": "here"}}),
                          ("a method that is none", {"type": "method", "slot": "a", "entry": "magic"}),
                          ("an option that is none", {"type": "method", "slot": "a", "entry": "edge-scatter:x=1"}),
                          ("too many samples", {"type": "samples", "count": 5000}), ("a size", {"type": "size", "width": 1e9, "height": 4}),
                          ("a channel", {"type": "display", "channel": "smell"}), ("a pixel outside", {"type": "pixel", "x": 64, "y": 0}),
                          ("half a pixel", {"type": "pixel", "x": 0.5, "y": 0}), ("missing members", {"type": "lights"})):
        client.send_bytes(message if isinstance(message, bytes) else json.dumps(message).encode())
        expect(client.kind("say")["level"] == "error", what)
        same(client.kind("state"), client.state, f"the state after {what}")

    def ends(what, code, send):
        other = Client(server).begin()
        try:
            send(other)
            other.until(lambda _: False, 30)
        except Closed as closed:
            expect(closed.code in (code, None), f"{what} ends the connection with {closed.code}, not {code}")
            return
        except (ConnectionResetError, BrokenPipeError):
            return
        expect(False, f"{what} ends the connection")

    ends("a message of 70,000 bytes", 1009, lambda other: other.send_bytes(b" " * 70000))
    ends("a binary message", 1008, lambda other: other.send_bytes(b"x", 2))
    ends("a flood", 1008, lambda other: [other.send(type="still") for _ in range(2000)])
    client.pixel(1, 1)  # the other clients are still connected


def edges_of(scene):
    """Returns the number of edges in scene floats: float32 of positions relative to the middle of their box."""
    triangles = [mesh["triangles"][i] for mesh in scene["meshes"] for i in range(len(mesh["triangles"]))]
    middle = [(min(min(t[k::3]) for t in triangles) + max(max(t[k::3]) for t in triangles)) / 2 for k in range(3)]
    corner = lambda t, i: struct.pack("3f", *(t[3 * i + k] - middle[k] + 0.0 for k in range(3)))  # noqa: E731
    return len({frozenset((corner(t, i), corner(t, (i + 1) % 3))) for t in triangles for i in range(3)})


def check_final_pictures(server, scene, folder):
    """The final picture equals the one that `render` writes, for the original scene and after changes by hand."""
    client = Client(server).begin()
    frame = client.final()
    exr, png = render(scene, folder, "first", "--exposure", frame["stops"])
    same(frame["images"][0]["type"], "image/png", "the final picture is lossless")
    same(png_pixels(frame["files"][0]), png, "the picture of the scene")
    if frame["edges"] is None:  # edges are counted after the picture has been sent
        frame = client.until(lambda message: message["type"] == "frame" and message["edges"] is not None)
    same(frame["edges"], edges_of(json.loads(server.get("/scene.json")[2])), "the number of edges")
    for x, y in ((5, 60), (30, 40), (40, 20), (0, 0), (63, 63)):
        answer = client.pixel(x, y)["answers"][0]
        for light in ("key", "ball", "sun"):
            same(answer["V"][light], exr[f"{light}.V"][y * SIZE + x], f"V of {light} at {x},{y}")

    client.send(type="camera", camera={"eye": [3, 2, 5], "target": [0, 1, 0], "up": [0, 1, 0], "verticalFov": 40}, stamp=1)
    client.send(type="light", name="key", stamp=2, light={
        "rectangle": {"center": [1, 4, 0.5], "halfU": [0.8, 0, 0], "halfV": [0, 0.2, 0.5]}, "radiance": [8, 9, 10], "twoSided": True})
    client.send(type="light", name="sun", stamp=3, light={"sun": {"direction": [-1, -2, 0.5], "angle": 12}, "irradiance": [2, 1, 1]})
    client.send(type="lights", off=["ball"], solo="", stamp=4)
    frame = client.final(4)
    status, headers, saved = server.get("/scene.json")
    same(status, 200, "the scene is saved")
    expect("attachment" in headers["Content-Disposition"], "as a file")
    file = folder / "saved.json"
    file.write_bytes(saved)
    exr, png = render(file, folder, "changed", "--exposure", frame["stops"])
    same(png_pixels(frame["files"][0]), png, "the picture of the changed scene, by `render` of the saved one")
    for x, y in ((5, 60), (30, 40), (40, 20)):
        same(client.pixel(x, y)["answers"][0]["V"]["key"], exr["key.V"][y * SIZE + x], f"V of the moved light at {x},{y}")
    subprocess.run([PROGRAM, "convert", str(file), "-o", str(folder / "again.json"), "-q"], check=True)
    client.send(type="lights", off=[], solo="", stamp=5)
    client.final(5)


def check_saved_pictures(folder):
    """Lights with pictures, rectangles and domes, are saved with them: `render` makes of the saved files the picture
    that is shown."""
    for name, light in (("textured-light.json", "window"), ("skies/knot.json", "evening")):
        into = folder / name.replace("/", "-").replace(".json", "")
        into.mkdir()
        with Server(PROGRAM, SCENES / name, "--size", f"{SIZE}x{SIZE}") as server:
            client = Client(server).begin()
            same(list(client.state["saved"]["pictures"]), [light], f"lights with pictures of {name}")
            client.send(type="camera", camera={"eye": [3, 3, 4], "target": [0, 0.5, 0], "up": [0, 1, 0], "verticalFov": 40}, stamp=1)
            words = next(one for one in client.state["lights"] if one["name"] == light)
            words = {key: value for key, value in words.items() if key not in ("fixed", "textured")}
            client.send(type="light", name=light, light={**words, "radiance": [9, 8, 7]})
            client.send(type="lights", off=[], solo=light, stamp=2)
            frame = client.final(2)
            saved = client.save(server, into)
            same([one["radiance"] for one in json.loads(saved.read_text())["lights"] if one["name"] == light], [[9, 8, 7]], "its radiance")
            same(len(list(into.iterdir())), 2, "the scene and a picture beside it")
            same(render(saved, into, "saved", "--exposure", frame["stops"])[1], png_pixels(frame["files"][0]),
                 f"what is saved of {name} is what is shown")
            same(server.get("/scene/picture", parameters={"light": "none"})[0], 400, "no such light")
            same(server.get("/scene/picture", token="", parameters={"light": light})[0], 403, "a picture without the token")


def check_comparing(server, scene, folder):
    """Two methods: each has its own V, and the difference is that of the two; masks equal those of --bits."""
    client = Client(server).begin()
    client.send(type="method", slot="b", entry="view-sample", none=False, stamp=10)
    client.send(type="samples", count=16, stamp=11)
    frame = client.final(11)
    same([answer["method"] for answer in frame["answers"]], ["edge-scatter", "view-sample"], "the methods")
    same([answer["lightSamples"] for answer in frame["answers"]], [16, 16], "light samples")
    same(frame["difference"]["rmse"], 0, "two methods that are exact on the same light samples")
    client.send(type="display", channel="error", light="ball")
    client.send(type="samples", count=0, stamp=12)
    client.send(type="method", slot="b", entry="depth-complexity", none=False, stamp=13)
    frame = client.final(13)
    same([image["shows"] for image in frame["images"]], ["difference"], "one picture of the error")
    file = folder / "compared.json"
    file.write_bytes(server.get("/scene.json")[2])
    a, _ = render(file, folder, "a")
    b, _ = render(file, folder, "b", "--method", "depth-complexity")
    off = [p - q for p, q, number in zip(a["ball.V"], b["ball.V"], a["id"]) if number != 0xffffffff]
    wanted = math.sqrt(sum(value * value for value in off) / len(off))
    expect(wanted > 1e-4 and abs(frame["difference"]["rmse"] - wanted) < 1e-9, f"RMSE {frame['difference']['rmse']}, not {wanted}")
    client.send(type="display", channel="beauty", light="key")
    client.send(type="method", slot="b", entry="", none=True, stamp=14)
    client.final(14)
    client.send(type="masks", wanted=True)
    subprocess.run([PROGRAM, "render", str(file), "-o", str(folder / "bits.exr"), "--bits", str(folder / "m.bits"), "--light", "key",
                    "--light-samples", "256", "-q"], check=True)
    masks = read_bits(folder / "m.bits")
    mixed = next(i for i, bits in enumerate(masks) if 40 < bits.count("1") < 200)
    end, seen = time.monotonic() + 30, None
    while seen is None and time.monotonic() < end:
        time.sleep(0.1)
        seen = client.pixel(mixed % SIZE, mixed // SIZE).get("seen")
    same(seen and seen["bits"], masks[mixed], "the light as a pixel sees it")
    check_outline(client, a)
    client.send(type="masks", wanted=False)


def is_inside(place, polygon):
    """Returns whether the place is inside a convex polygon s, t, s, t …, of either winding."""
    corners = list(zip(polygon[::2], polygon[1::2]))
    sides = [(b[0] - a[0]) * (place[1] - a[1]) - (b[1] - a[1]) * (place[0] - a[0]) for a, b in zip(corners, corners[1:] + corners[:1])]
    return min(sides) >= 0 or max(sides) <= 0


def check_outline(client, exr):
    """V is the share of a light that the outlines leave visible."""
    for wanted in (0.3, 0.7):
        i = min(range(SIZE * SIZE), key=lambda i: abs(exr["key.V"][i] - wanted) + (exr["id"][i] == 0xffffffff))
        outline = client.pixel(i % SIZE, i // SIZE)["outline"]
        same((outline["light"], outline["rim"], outline["whole"]), ("key", "square", True), "the outline's light, rim and completeness")
        places = [((k + 0.5) / 20 - 1, (j + 0.5) / 20 - 1) for j in range(40) for k in range(40)]
        seen = sum(not any(is_inside(place, blocker) for blocker in outline["blockers"]) for place in places) / len(places)
        expect(abs(seen - exr["key.V"][i]) < 0.03, f"the outline leaves {seen}, and V is {exr['key.V'][i]}")


def check_moving(server):
    """While something moves, quick pictures of newer and newer states come, and then the final one; to all clients,
    whether or not one of them reads."""
    client, other = Client(server).begin(), Client(server).begin()
    silent = Client(server, lazy=True)  # reads nothing from now on
    client.final()
    began, came = time.monotonic(), []
    for i in range(60):
        angle = 0.5 + i / 60
        client.send(type="camera", moving=True, stamp=100 + i, camera={
            "eye": [6 * math.sin(angle), 3, 6 * math.cos(angle)], "target": [0, 0.5, 0], "up": [0, 1, 0], "verticalFov": 45})
        silent.send(type="pixel", x=1, y=1)
        came += client.wait(0.02)
    client.send(type="still")
    # The final picture of a small scene may come before the drag ends.
    frame = next((message for message in came if message["type"] == "frame" and message["final"] and
                  message["stamps"].get(str(client.number)) == 159), None)
    if frame is None:
        frame = client.final(159)
        came += client.seen
    frames = [message for message in came if message["type"] == "frame" and str(client.number) in message["stamps"]]
    stamps = [message["stamps"][str(client.number)] for message in frames]
    expect(stamps == sorted(stamps), f"pictures of newer and newer states: {stamps}")
    expect(len(set(stamps)) >= 5, f"pictures come while the camera moves: {stamps}")
    for message in frames:
        same(message["images"][0]["type"], "image/png" if message["final"] else "image/jpeg", "final pictures are PNG, others JPEG")
        expect(message["files"][0][:2] == (b"\x89P" if message["final"] else b"\xff\xd8"), "and the bytes are of that format")
    theirs = other.until(lambda message: message["type"] == "frame" and message["final"] and
                         message["stamps"].get(str(client.number)) == 159)
    same(theirs["files"], frame["files"], "the other client's picture")
    state = [message for message in other.seen if message["type"] == "state"]
    other.send(type="samples", count=0, stamp=1)
    last = other.kind("state")
    expect(state and last["camera"]["eye"] == [6 * math.sin(0.5 + 59 / 60), 3, 6 * math.cos(0.5 + 59 / 60)], "the other client's camera")
    expect(time.monotonic() - began < 60, "a client that does not read delays no other")
    other.socket.close()  # closed in the middle of everything
    client.pixel(1, 1)


def check_host(scene):
    """Another address of this machine: one of the loopback addresses, which every machine has."""
    with Server(PROGRAM, scene, "--host", "127.0.0.2") as server:
        expect(server.url.startswith("http://127.0.0.2:"), f"the address: {server.url}")
        same(server.get()[0], 200, "the page on another address")
        same(server.get(token="")[0], 403, "no token there")
        same(server.get(Host="127.0.0.3")[0], 403, "a third address is refused")
        same(server.get(Host="evil.example")[0], 403, "a foreign host name that resolves to this address is refused")
        Client(server).begin()
    for host in ("0.0.0.0", "::", "here", "127.0.0.1:80", "224.0.0.1", ""):
        answer = subprocess.run([PROGRAM, "view", str(scene), "--no-browser", "--host", host], capture_output=True, text=True)
        same(answer.returncode, 2, f"--host {host}")


def check_beginning(scene):
    """The view begins with two methods, as the command in a report requests."""
    with Server(PROGRAM, scene, "--method", "view-sample", "--method-b", "depth-complexity", "--light-samples", 16) as server:
        frame = Client(server).begin().final()
        same([(answer["method"], answer["lightSamples"]) for answer in frame["answers"]], [("view-sample", 16), ("depth-complexity", 16)], "the two methods")
    wrong = subprocess.run([PROGRAM, "view", str(scene), "--no-browser", "--method-b", "nothing"], capture_output=True, text=True)
    same((wrong.returncode, wrong.stdout), (2, ""), f"no such method: {wrong.stderr}")


def check_forest(folder):
    """Instances without copies, a thousand million triangles: the final picture and the values of pixels equal those of
    `render`; features that need copies are refused."""
    document, scene = json.loads(LIGHTS), folder / "forest.json"
    document["size"] = [48, 36]
    document["meshes"].append({"name": "balls", "shape": {"type": "sphere", "radius": 0.2, "segments": 256}, "instances": [
        {"translate": [0.5 * (i % 200) - 50, 0.2, -0.5 * (i // 200) - 1]} for i in range(20000)]})
    scene.write_text(json.dumps(document))
    with Server(PROGRAM, scene) as server:
        client = Client(server).begin()
        frame = client.final()
        exr, png = render(scene, folder, "forest", "--exposure", frame["stops"])
        same(png_pixels(frame["files"][0]), png, "the picture of the forest")
        names = set()
        for x, y in ((5, 30), (20, 14), (30, 15), (40, 16), (24, 20), (0, 0)):
            told, i = client.pixel(x, y), y * 48 + x
            same(told["answers"][0]["V"]["key"], exr["key.V"][i], f"V at {x},{y}")
            if told["surface"]:
                same(told["id"], exr["id"][i], f"the triangle at {x},{y}")
                names.add(told["object"])
        expect("balls" in names and len(names) > 1, f"objects of both kinds: {names}")
        client.send(type="light", name="key", stamp=1, light={
            "rectangle": {"center": [1, 4, 0.5], "halfU": [0.8, 0, 0], "halfV": [0, 0.2, 0.5]}, "radiance": [8, 9, 10]})
        frame = client.final(1)
        exr, png = render(client.save(server, folder), folder, "moved", "--exposure", frame["stops"])
        same(png_pixels(frame["files"][0]), png, "the picture under the moved light, by `render` of the saved scene")
        client.send(type="method", slot="a", entry="vssm", stamp=2)
        said = client.until(lambda message: message["type"] == "say" and message["level"] == "error")["text"]
        expect("vssm needs more than the triangles between" in said, f"a method that needs copies: {said}")
        status, _, text = server.get("/space/meshes")
        expect(status >= 400 and b"instances" in text, f"the 3D view: {status} {text[:200]}")
        client.send(type="method", slot="a", entry="view-sample", stamp=3)
        same(client.final(3)["answers"][0]["method"], "view-sample", "a method that needs none")


def check_slow_method(folder):
    """A method that takes long at any size delays a drag for a few pictures only; then another method's light samples
    replace it until the drag ends."""
    document, scene, slow = json.loads(LIGHTS), folder / "slow.json", "layered-attenuation"
    document["lights"] = document["lights"][:1]
    scene.write_text(json.dumps(document))
    with Server(PROGRAM, scene, "--method", f"{slow}:size=512") as server:
        client = Client(server).begin()
        client.until(lambda message: message["type"] == "frame" and message["final"], 100)
        stamp, quick, end = 0, [], time.monotonic() + 100
        while len(quick) < 20 and time.monotonic() < end:
            stamp += 1
            client.send(type="light", name="key", moving=True, stamp=stamp, light={
                "rectangle": {"center": [0.01 * (stamp % 50), 4, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}, "radiance": [10, 10, 10]})
            quick += [message for message in client.wait(0.05) if message["type"] == "frame" and not message["final"]]
        made = [(message["answers"][0]["method"].split(":")[0], message["answers"][0]["milliseconds"]) for message in quick]
        # The method's maps take long at any quality. There are three pictures until the quality is lowest, two slow
        # ones at that quality, and one already begun.
        run, longest = 0, 0
        for method, milliseconds in made:
            run = run + 1 if method == slow and milliseconds > 60 else 0
            longest = max(longest, run)
        expect(len(quick) == 20 and longest <= 6, f"pictures of a drag: {made}")
        client.send(type="still")
        frame = client.until(lambda message: message["type"] == "frame" and message["final"] and
                             message["stamps"].get(str(client.number)) == stamp, 100)
        same(frame["answers"][0]["method"].split(":")[0], slow, "the final picture is by the method that was chosen")


def check_watching(folder):
    """Editing a lamp in the file does not send meshes again; editing a mesh file does."""
    into = folder / "edited"
    into.mkdir()
    mesh, scene = into / "tent.obj", into / "scene.json"

    def write(height, lamp, color):
        mesh.write_text(f"v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 {height} 0\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n")
        document = json.loads(LIGHTS)
        document["meshes"][1] = {"name": "tent", "file": "tent.obj", "color": color}
        document["lights"] = [{"name": "key", "rectangle": {"center": lamp, "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}, "radiance": [10, 10, 10]}]
        text = json.dumps(document)
        if not scene.exists() or scene.read_text() != text:
            scene.write_text(text)

    def shown_is_rendered(what):
        frame = client.until(lambda message: message["type"] == "frame" and message["final"] and message["edges"] is not None)
        same(png_pixels(frame["files"][0]), render(scene, folder, "edited", "--exposure", frame["stops"])[1], what)
        return frame

    write(1, [0, 4, 0], [0.5, 0.5, 0.5])
    with Server(PROGRAM, scene, "--watch") as server:
        client = Client(server).begin()
        meshes = client.state["meshes"]
        first = shown_is_rendered("the scene")
        write(1, [1, 4, 1], [0.5, 0.5, 0.5])
        state = client.until(lambda message: message["type"] == "state" and message["lights"][0]["rectangle"]["center"] == [1, 4, 1])
        same(state["meshes"], meshes, "another lamp: the meshes are kept")
        frame = shown_is_rendered("the lamp of the file")
        same(frame["edges"], first["edges"], "and their edges")
        write(1.5, [1, 4, 1], [0.5, 0.5, 0.5])
        state = client.until(lambda message: message["type"] == "state" and message["meshes"] != meshes)
        shown_is_rendered("the mesh of the file")
        write(1.5, [1, 4, 1], [0.9, 0.2, 0.1])
        client.until(lambda message: message["type"] == "state" and message["meshes"] != state["meshes"])
        shown_is_rendered("the colour of the file")


def check_ending(folder):
    scene = folder / "watched.json"
    scene.write_text(LIGHTS)
    with Server(PROGRAM, scene, "--watch") as server:
        taken = subprocess.run([PROGRAM, "view", str(scene), "--no-browser", "--port", str(server.parts.port)], capture_output=True, text=True)
        same(taken.returncode, 4, "a port that is taken")
        expect("--port" in taken.stderr and taken.stdout == "", f"what is said of it: {taken.stderr}")
        client = Client(server).begin()
        client.final()
        client.send(type="camera", camera={"eye": [3, 2, 5], "target": [0, 1, 0]}, stamp=1)
        client.final(1)
        scene.write_text(LIGHTS.replace('"center": [0, 4, 0]', '"center": [1, 4, 1]').replace('"radius": 0.6', '"radius": 0.5'))
        state = client.until(lambda message: message["type"] == "state" and message["lights"][0]["rectangle"]["center"] == [1, 4, 1])
        same(state["camera"]["eye"], [3, 2, 5], "the camera stays where it was put by hand")
        saved = folder / "reloaded.json"
        frame = client.final()
        saved.write_bytes(server.get("/scene.json")[2])
        same(png_pixels(frame["files"][0]), render(saved, folder, "reloaded", "--exposure", frame["stops"])[1], "the mesh has changed, too")
        scene.write_text(LIGHTS.replace('"lights"', '"lamps"'))
        expect("lamps" in client.until(lambda message: message["type"] == "say" and message["level"] == "error")["text"], "a faulty file")
        client.pixel(3, 3)
        client.send(type="camera", camera={"eye": [3, 2, 4], "target": [0, 1, 0]}, moving=True)
        began = time.monotonic()
        server.process.send_signal(signal.SIGINT)
        same(server.process.wait(10), 130, "Ctrl-C")
        expect(time.monotonic() - began < 2, "at once")
    same(subprocess.run([PROGRAM, "view", str(folder / "none.json"), "--no-browser"], capture_output=True).returncode, 3, "no such scene")
    same(subprocess.run([PROGRAM, "view", str(scene), "--port", "70000"], capture_output=True).returncode, 2, "no such port")


def main():
    with tempfile.TemporaryDirectory(prefix="penumbra-live-") as name:
        folder = pathlib.Path(name)
        scene = folder / "scene.json"
        scene.write_text(LIGHTS)
        with Server(PROGRAM, scene) as server:
            expect(server.url.startswith("http://127.0.0.1:"), f"the address: {server.url}")
            check_who_is_let_in(server)
            check_final_pictures(server, scene, folder)
            check_refusals(server)
            check_comparing(server, scene, folder)
            check_moving(server)
            server.process.send_signal(signal.SIGTERM)
            out, _ = server.process.communicate(timeout=10)
            same(out, "", "nothing but the address is on stdout")
        check_saved_pictures(folder)
        check_host(scene)
        check_beginning(scene)
        check_forest(folder)
        check_slow_method(folder)
        check_watching(folder)
        check_ending(folder)
    return verdict()


if __name__ == "__main__":
    sys.exit(main())
