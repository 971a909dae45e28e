#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests `--tev` for pictures, comparisons and sequences: a listener that understands tev's protocol gets what the EXR
has.
  tev_pictures.py PROGRAM"""
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import threading

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "browser"))
from claims import same, verdict  # noqa: E402
from exr import read_exr  # noqa: E402
from live_client import LIGHTS  # noqa: E402

PROGRAM = sys.argv[1]


class FakeTev(threading.Thread):
    """Keeps the pictures that one run of the program sends: {name: (width, height, {channel: values})}."""

    def __init__(self):
        super().__init__()
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.address = "127.0.0.1:%d" % self.listener.getsockname()[1]
        self.pictures, self.focused = {}, []
        self.start()

    def run(self):
        connection, _ = self.listener.accept()
        data = b""
        while part := connection.recv(1 << 20):
            data += part
        while data:
            length, kind = struct.unpack_from("<IB", data)
            self.packet(kind, data[5:length])
            data = data[length:]

    def packet(self, kind, rest):
        def text():
            nonlocal rest
            value, rest = rest.split(b"\0", 1)
            return value.decode()

        def numbers(letters):
            nonlocal rest
            values = struct.unpack_from("<" + letters, rest)
            rest = rest[struct.calcsize("<" + letters):]
            return values

        (focus,) = numbers("?")
        name = text()
        if kind == 4:  # CreateImage
            width, height, count = numbers("iii")
            channels = [text() for _ in range(count)]
            self.pictures[name] = (width, height, {channel: [None] * (width * height) for channel in channels})
            if focus:
                self.focused.append(name)
        else:
            assert kind == 6, kind  # UpdateImage, version 3
            (count,) = numbers("i")
            channels = [text() for _ in range(count)]
            x, y, width, height = numbers("iiii")
            offsets, strides = numbers(f"{count}q"), numbers(f"{count}q")
            values = struct.unpack(f"<{len(rest) // 4}f", rest)
            rest = b""
            full_width, _, into = self.pictures[name]
            for channel, offset, stride in zip(channels, offsets, strides):
                for i in range(width * height):
                    into[channel][(y + i // width) * full_width + x + i % width] = values[offset + i * stride]
        assert rest == b"", "a packet is as long as it says"


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments), "-q"], capture_output=True, text=True)


def check(tev, name, file, channels):
    exr, (width, height) = read_exr(file)
    shown = tev.pictures.get(name)
    same(shown and shown[:2], (width, height), f"{name} is shown")
    if shown is None:
        return
    same(list(shown[2]), channels, f"channels of {name}")
    for channel in channels:
        same(shown[2][channel], exr[channel], f"channel {channel} of {name}")


def main():
    lights = ["key.V", "ball.V", "sun.V"]
    with tempfile.TemporaryDirectory(prefix="penumbra-tev-") as name:
        folder = pathlib.Path(name)
        scene = folder / "scene.json"
        scene.write_text(LIGHTS)
        tev = FakeTev()
        same(run("render", scene, "-o", folder / "a.exr", "--tev", tev.address).returncode, 0, "render --tev")
        tev.join(10)
        check(tev, "a.exr", folder / "a.exr", ["R", "G", "B", "A", "V", *lights])
        same(tev.focused, ["a.exr"], "the picture comes to the front")
        # A picture too large for one packet comes in stripes.
        tev = FakeTev()
        same(run("render", scene, "-o", folder / "wide.exr", "--size", "900x300", "--light", "key", "--tev", tev.address).returncode, 0, "in stripes")
        tev.join(10)
        check(tev, "wide.exr", folder / "wide.exr", ["R", "G", "B", "A", "V"])
        tev = FakeTev()
        same(run("compare", scene, "-o", folder / "c", "--methods", "edge-scatter,view-sample", "--light-samples", "16", "--reference-samples", "same",
                 "--size", "32x32", "--light", "key", "--runs", "1", "--tev", tev.address).returncode, 0, "compare --tev")
        tev.join(10)
        same(sorted(tev.pictures), ["edge-scatter.exr", "reference.exr", "view-sample.exr"], "pictures of a comparison")
        check(tev, "view-sample.exr", folder / "c" / "view-sample.exr", ["R", "G", "B", "A", "V"])

        # A sequence: each frame is a picture with its own name, one after the other on one connection.
        for frame in (1, 2, 3):
            (folder / f"moving.000{frame}.json").write_text(LIGHTS.replace('"translate": [0, 1, 0]', f'"translate": [{0.4 * frame - 0.8}, 1, 0]'))
        tev = FakeTev()
        same(run("render", folder / "moving.####.json", "--frames", "1-3", "-o", folder / "s.####.exr", "--tev", tev.address).returncode, 0, "a sequence")
        tev.join(10)
        names = [f"s.000{frame}.exr" for frame in (1, 2, 3)]
        same(list(tev.pictures), names, "frames appear in their order")
        same(tev.focused, names, "and each comes to the front")
        for name in names:
            check(tev, name, folder / name, ["R", "G", "B", "A", "V", *lights])
        same(len({tuple(picture[2]["V"]) for picture in tev.pictures.values()}), 3, "different pictures")

        free = socket.create_server(("127.0.0.1", 0))
        gone = "127.0.0.1:%d" % free.getsockname()[1]
        free.close()
        answer = run("render", scene, "-o", folder / "none.exr", "--tev", gone)
        same((answer.returncode, "no tev answers" in answer.stderr), (4, True), "the error if no viewer listens")
        same((folder / "none.exr").exists(), False, "and nothing is rendered")
        for wrong in ("tev", "127.0.0.1", "127.0.0.1:0", ":14158", "127.0.0.1:x"):
            same(run("render", scene, "-o", folder / "none.exr", "--tev", wrong).returncode, 2, wrong)
    return verdict()


if __name__ == "__main__":
    sys.exit(main())
