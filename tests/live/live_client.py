# SPDX-License-Identifier: Apache-2.0
"""A minimal client of `penumbra view`, with only Python's standard library: HTTP, WebSocket (RFC 6455), the messages of
docs/view.md, and as much PNG as they need."""
import base64
import http.client
import json
import os
import select
import socket
import struct
import subprocess
import time
import urllib.parse
import zlib


LIGHTS = """{"format": "penumbra-scene/1", "size": [64, 64],
  "camera": {"eye": [2, 3, 6], "target": [0, 0.5, 0], "verticalFov": 45},
  "meshes": [{"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [4, 0, 0], "halfV": [0, 0, -4]}, "color": [0.5, 0.5, 0.5]},
    {"name": "knot", "shape": {"type": "knot", "radius": 0.6, "tube": 0.2, "segments": 64}, "transform": {"translate": [0, 1, 0]}}],
  "lights": [{"name": "key", "rectangle": {"center": [0, 4, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}, "radiance": [10, 10, 10]},
    {"name": "ball", "sphere": {"center": [2, 3, 2], "radius": 0.4}, "radiance": [4, 3, 2]},
    {"name": "sun", "sun": {"direction": [1, -3, -1], "angle": 6}, "irradiance": [1, 1, 1]}]}"""


class Closed(Exception):
    """The server has ended the connection; `code` is the reason it gave, or None."""

    def __init__(self, code=None):
        super().__init__(f"closed: {code}")
        self.code = code


class Server:
    """Runs `penumbra view SCENE` for the duration of the `with` block."""

    def __init__(self, program, scene, *arguments):
        self.command = [program, "view", str(scene), "--no-browser", *map(str, arguments)]

    def __enter__(self):
        self.process = subprocess.Popen(self.command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().strip()
        self.parts = urllib.parse.urlsplit(self.url)
        self.token = urllib.parse.parse_qs(self.parts.query).get("token", [""])[0]
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()

    def get(self, path="/", token=None, method="GET", parameters=None, **headers):
        """Returns status, headers and body of a request; an empty `token` leaves the token out, and then `parameters`,
        too."""
        connection = http.client.HTTPConnection(self.parts.hostname, self.parts.port, timeout=60)
        token = self.token if token is None else token
        more = "".join("&" + urllib.parse.urlencode({name: value}) for name, value in (parameters or {}).items())
        connection.request(method, f"{path}?token={token}{more}" if token else path,
                           headers={name.replace("_", "-"): value for name, value in headers.items()})
        answer = connection.getresponse()
        return answer.status, dict(answer.getheaders()), answer.read()


class Client:
    """One WebSocket. Acknowledges each picture as soon as it has read it, unless `lazy`."""

    def __init__(self, server, token=None, lazy=False, **headers):
        self.lazy, self.rest, self.seen, self.end = lazy, b"", [], None
        self.socket = socket.create_connection((server.parts.hostname, server.parts.port), timeout=60)
        key = base64.b64encode(os.urandom(16)).decode()
        lines = {"Host": server.parts.netloc, "Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Key": key,
                 "Sec-WebSocket-Version": "13", **headers}
        text = f"GET /live?token={server.token if token is None else token} HTTP/1.1\r\n"
        text += "".join(f"{name}: {value}\r\n" for name, value in lines.items()) + "\r\n"
        self.socket.sendall(text.encode())
        while b"\r\n\r\n" not in self.rest:
            self.more()
        head, self.rest = self.rest.split(b"\r\n\r\n", 1)
        self.status = int(head.split()[1])

    def more(self):
        if self.end is not None:  # packets that keep a connection alive do not count
            left = self.end - time.monotonic()
            if left <= 0:
                raise TimeoutError("no such message came")
            self.socket.settimeout(left)
        part = self.socket.recv(1 << 20)
        if not part:
            raise Closed()
        self.rest += part

    def take(self, count):
        while len(self.rest) < count:
            self.more()
        part, self.rest = self.rest[:count], self.rest[count:]
        return part

    def send_bytes(self, data, opcode=1):
        mask = os.urandom(4)
        size = len(data)
        head = bytes([0x80 | opcode])
        if size < 126:
            head += bytes([0x80 | size])
        elif size < 65536:
            head += bytes([0x80 | 126]) + struct.pack(">H", size)
        else:
            head += bytes([0x80 | 127]) + struct.pack(">Q", size)
        repeated = (mask * (size // 4 + 1))[:size]
        masked = (int.from_bytes(data, "big") ^ int.from_bytes(repeated, "big")).to_bytes(size, "big")
        self.socket.sendall(head + mask + masked)

    def send(self, **message):
        self.send_bytes(json.dumps(message).encode())

    def read(self):
        """Returns the next message, a dict. For a picture it is the header with `files`, the bytes of each image."""
        whole = b""
        while True:
            first, second = self.take(2)
            size = second & 0x7f
            if size == 126:
                size = struct.unpack(">H", self.take(2))[0]
            elif size == 127:
                size = struct.unpack(">Q", self.take(8))[0]
            data, opcode = self.take(size), first & 0x0f
            if opcode == 8:
                raise Closed(struct.unpack(">H", data[:2])[0] if len(data) >= 2 else None)
            if opcode == 9:
                self.send_bytes(data, 10)
            if opcode >= 8:
                continue
            whole, kind = whole + data, opcode or kind  # if a message is in pieces, the first has its kind
            if not first & 0x80:
                continue
            data, whole = whole, b""
            if kind == 1:
                return json.loads(data)
            if kind == 2:
                length = struct.unpack_from("<I", data)[0]
                header = json.loads(data[4:4 + length])
                header["files"], at = [], 4 + length
                for image in header["images"]:
                    header["files"].append(data[at:at + image["bytes"]])
                    at += image["bytes"]
                assert at == len(data), "a picture's message has the bytes that it says"
                if not self.lazy:
                    self.send(type="taken")
                return header

    def until(self, wanted, seconds=30):
        """Returns the first message for which `wanted` is true; it and all messages before it are in `seen`."""
        self.seen, self.end = [], time.monotonic() + seconds
        try:
            while True:
                message = self.read()
                self.seen.append(message)
                if wanted(message):
                    return message
        except TimeoutError as error:
            said = [message for message in self.seen if message["type"] == "say"]
            raise TimeoutError(f"no such message came; {len(self.seen)} others, of which {said}") from error
        finally:
            self.end = None
            self.socket.settimeout(60)

    def wait(self, seconds):
        """Reads the messages that arrive in the meantime."""
        self.seen, end = [], time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            if not self.rest and not select.select([self.socket], [], [], left)[0]:
                break
            self.seen.append(self.read())
        return self.seen

    def save(self, server, folder):
        """Saves the scene as the page does, and returns its file."""
        names = self.state["saved"]
        (folder / names["scene"]).write_bytes(server.get("/scene.json")[2])
        for light, name in names["pictures"].items():
            (folder / name).write_bytes(server.get("/scene/picture", parameters={"light": light})[2])
        return folder / names["scene"]

    def kind(self, kind):
        return self.until(lambda message: message["type"] == kind)

    def final(self, stamp=None):
        """Waits for the final picture of the current state, or of the state after this client's change with that
        stamp."""
        return self.until(lambda message: message["type"] == "frame" and message["final"] and
                          (stamp is None or message["stamps"].get(str(self.number)) == stamp))

    def begin(self):
        """Reads the messages that every client gets first."""
        self.number = self.kind("hello")["client"]
        self.state = self.kind("state")
        return self

    def pixel(self, x, y):
        self.send(type="pixel", x=x, y=y)
        return self.until(lambda message: message["type"] == "pixel" and (message["x"], message["y"]) == (x, y))


def png_pixels(data):
    """Returns width, height and rows of (red, green, blue) of an 8-bit PNG file without interlacing or alpha."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, color, _, _, interlace = struct.unpack(">IIBBBBB", body)
            assert (depth, color, interlace) == (8, 2, 0)
        elif kind == b"IDAT":
            packed += body
        at += size + 12
    raw, stride, rows, above = zlib.decompress(packed), 3 * width, [], bytes(3 * width)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left, up, corner = line[i - 3] if i >= 3 else 0, above[i], above[i - 3] if i >= 3 else 0
            nearest = left + up - corner
            paeth = min((left, up, corner), key=lambda value: abs(nearest - value))
            line[i] = (line[i] + (0, left, up, (left + up) // 2, paeth)[kind]) & 0xff
        rows.append(bytes(line))
        above = line
    return width, height, rows
