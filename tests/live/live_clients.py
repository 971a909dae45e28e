#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests `penumbra view` with clients that fail: one disconnects in the middle of a drag, one never reads, there are too
many, or they send messages and requests without end. The other clients are served, and memory stays bounded.
live_clients.py PROGRAM"""
import math
import pathlib
import socket
import struct
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "browser"))
from claims import expect, same, verdict  # noqa: E402
from live_client import LIGHTS, Client, Closed, Server  # noqa: E402

PROGRAM = sys.argv[1]


def camera(angle):
    return {"eye": [6 * math.sin(angle), 3, 6 * math.cos(angle)], "target": [0, 0.5, 0], "up": [0, 1, 0], "verticalFov": 45}


def memory(server):
    with open(f"/proc/{server.process.pid}/status") as file:
        return next(int(line.split()[1]) / 1024 for line in file if line.startswith("VmRSS"))


def check_gone_in_a_drag(server):
    """In the end the other clients see the final picture of the last state that arrived, whether the failing client
    says goodbye, is cut off, or is cut off in the middle of a message. A connection that is cut off may lose the last
    messages."""
    other = Client(server).begin()
    other.final()
    for turn, how in enumerate(("closes", "is cut off", "is cut off in a message")):
        client = Client(server).begin()
        angles = [turn + i / 40 for i in range(20)]
        for i, angle in enumerate(angles):
            client.send(type="camera", moving=True, stamp=i, camera=camera(angle))
            client.wait(0.02)
        if how == "closes":
            client.send_bytes(struct.pack(">H", 1001), 8)
        else:
            if how == "is cut off in a message":
                client.socket.sendall(b"\x81\xfe\x10\x00abcd{")  # the beginning of a text of 4096 bytes
            client.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))  # closed by a reset
        client.socket.close()
        frame, quiet = None, 0
        while quiet < 3:  # until nothing comes any more
            came = [message for message in other.wait(0.5) if message["type"] == "frame"]
            frame, quiet = (came[-1], 0) if came else (frame, quiet + 1)
        stamp = frame["stamps"][str(client.number)]
        expect(frame["final"], f"the last picture after a client {how} is final")
        expect(how != "closes" or stamp == 19, f"it shows what was sent last: {stamp}")
        other.send(type="samples", count=0, stamp=turn)
        same(other.kind("state")["camera"]["eye"], camera(angles[int(stamp)])["eye"], f"the camera after a client {how}")
        other.final(turn)


def check_never_reads(server):
    """A client sends requests and never reads: its answers are not kept without limit, and it is disconnected."""
    other = Client(server).begin()
    other.final()
    deaf = Client(server, lazy=True)
    before, ended, asked = memory(server), False, 0
    end = time.monotonic() + 60
    while not ended and time.monotonic() < end:
        try:
            for _ in range(20):  # more than 250 requests a second would end it, too
                deaf.send(type="x" * 60_000)  # the answer repeats the refused text
                asked += 1
        except (BrokenPipeError, ConnectionResetError):
            ended = True
        time.sleep(0.1)
        if asked % 100 == 0:
            other.pixel(1, 1)  # the other clients are served in the meantime
    expect(ended, f"it is disconnected, with {asked} answers not read")
    grown = memory(server) - before
    expect(grown < 64, f"memory grew by {grown:.0f} MiB for a client that does not read {asked} answers")
    other.pixel(2, 2)
    deaf.socket.close()


def check_pace(server):
    """While a client has not acknowledged the last picture of a drag, the next picture begins only after a quarter of a
    second."""
    slow, moves, seconds = Client(server).begin(), 120, 2
    first = slow.final()["frame"]
    slow.lazy = True
    began = time.monotonic()
    for i in range(moves):
        slow.send(type="camera", camera=camera(0.001 * i), moving=True, stamp=i)
        time.sleep(seconds / moves)
    slow.send(type="still")
    slow.lazy = False
    slow.send(type="taken")
    took = time.monotonic() - began
    made = slow.final(moves - 1)["frame"] - first
    # The first picture, one every quarter of a second, and the final one, which a quick one may precede.
    expect(3 <= made <= 4 * took + 3, f"{made} pictures of {took:.1f} seconds were made for a client that takes none")
    slow.socket.close()


def check_too_many(server):
    """There may be eight clients; a ninth is told to try later, and when one leaves, another may come."""
    clients = [Client(server).begin() for _ in range(8)]
    late = Client(server)
    try:
        late.until(lambda _: False, 10)
        expect(False, "a ninth client is refused")
    except Closed as closed:
        same(closed.code, 1013, "a ninth client is told to try again later")
    clients[0].send(type="camera", camera=camera(0.3), stamp=5)
    for client in clients:  # all of them see the change of one
        client.until(lambda message: message["type"] == "frame" and message["final"] and message["stamps"].get(str(clients[0].number)) == 5)
    for client in clients:
        client.socket.close()
    end = time.monotonic() + 10
    while time.monotonic() < end:
        try:
            Client(server).begin().socket.close()
            return
        except Closed:
            time.sleep(0.05)
    expect(False, "there is room again")


def check_many_requests(server):
    """Sends requests that take the server a while, without waiting for answers: some are dropped, memory does not grow
    with their number, and the server continues."""
    client = Client(server).begin()
    client.final()
    before, sockets = memory(server), []
    for _ in range(200):
        one = socket.create_connection((server.parts.hostname, server.parts.port), timeout=60)
        one.sendall(f"GET /space/shadows?light=key&from=anywhere&token={server.token} HTTP/1.1\r\nHost: {server.parts.netloc}\r\n\r\n".encode())
        sockets.append(one)
    client.pixel(3, 3)
    client.send(type="camera", camera=camera(0.6), stamp=6)
    client.final(6)
    for one in sockets:
        one.close()
    expect(memory(server) - before < 128, f"memory: {before:.0f} MiB, then {memory(server):.0f}")
    end, status = time.monotonic() + 60, None
    while status != 200 and time.monotonic() < end:
        try:
            status = server.get("/space/meshes")[0]
        except (ConnectionError, OSError):
            time.sleep(0.1)
    same(status, 200, "requests are answered again")
    client.socket.close()


def main():
    with tempfile.TemporaryDirectory(prefix="penumbra-clients-") as name:
        scene = pathlib.Path(name) / "scene.json"
        scene.write_text(LIGHTS)
        with Server(PROGRAM, scene) as server:
            check_gone_in_a_drag(server)
            check_never_reads(server)
            check_pace(server)
            check_too_many(server)
            check_many_requests(server)
            expect(server.process.poll() is None, "the server is still there")
    return verdict()


if __name__ == "__main__":
    sys.exit(main())
