# SPDX-License-Identifier: Apache-2.0
"""A `penumbra serve` child and its messages (docs/serve.md). Independent of Blender."""

import collections
import itertools
import json
import queue
import struct
import subprocess
import threading

import numpy

_LEVELS = {"note": "info"}  # other levels have the same names on the program's stderr


def packed(head, data=b""):
    """Returns a message's bytes for the pipe."""
    if data:
        head = {**head, "bytes": len(data)}
    text = json.dumps(head, separators=(",", ":")).encode()
    return struct.pack("<I", len(text)) + text + data


def read_message(stream):
    """Returns (head, bytes) of the next message; None at the end of input."""
    length = stream.read(4)
    if len(length) < 4:
        return None
    head = json.loads(stream.read(struct.unpack("<I", length)[0]))
    data = stream.read(head.get("bytes", 0))
    return (head, data) if len(data) == head.get("bytes", 0) else None


class Picture:
    """A picture. `head`: its message; `rgba`: height x width x 4, first row at the top; `visibility`: V of each light by name."""

    def __init__(self, head, data):
        self.head, self.visibility, at = head, {}, 0
        for buffer in head["buffers"]:
            values = numpy.frombuffer(data, "<f4", buffer["bytes"] // 4, at).reshape(head["height"], head["width"], -1)
            at += buffer["bytes"]
            if buffer["name"] == "RGBA":
                self.rgba = values
            else:
                self.visibility[buffer["light"]] = values[..., 0]


class Child:
    """A `penumbra serve` process. It ends when this process ends for any reason, since its input is closed then. Sending and
    receiving never block."""

    def __init__(self, program, *arguments, started=lambda number: None):
        """`started` is called with the process id before anything else is done."""
        self.process = subprocess.Popen([program, "serve", *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        started(self.process.pid)
        # Heads of all messages except pictures, in order; None at the end. The member `arrival` of each head, also of a
        # picture's, is its number among all messages.
        self.messages = queue.SimpleQueue()
        self._picture, self._waiting, self._wake = None, collections.deque(), threading.Condition()
        self._ends = False
        for work in (self._write, self._read):
            threading.Thread(target=work, daemon=True).start()

    def send(self, head, data=b""):
        """Adds a message to the queue. Of two consecutive `show` messages that wait, only the later is sent."""
        with self._wake:
            waiting = self._waiting
            if head["type"] == "show" and waiting and waiting[-1][0]["type"] == "show":
                waiting[-1] = ({**waiting[-1][0], **head}, b"")
            else:
                waiting.append((head, data))
            self._wake.notify_all()

    def has_news(self):
        return self._picture is not None or not self.messages.empty()

    def take_picture(self):
        """Returns the newest picture once; None if no new picture has arrived since."""
        with self._wake:
            picture, self._picture = self._picture, None
        return picture

    def close(self):
        """Closes the child's input: it then ends at once, unless it hangs."""
        with self._wake:
            self._ends = True
            self._waiting.clear()
            self._wake.notify_all()
        try:
            self.process.wait(2)
        except subprocess.TimeoutExpired:
            self.kill()

    def kill(self):
        self.process.kill()
        self.process.wait()

    def _write(self):
        while True:
            with self._wake:
                self._wake.wait_for(lambda: self._waiting or self._ends)
                message = self._waiting.popleft() if self._waiting else None
            try:
                if message is None:
                    self.process.stdin.close()
                    return
                self.process.stdin.write(packed(*message))
                self.process.stdin.flush()
            except (OSError, ValueError):
                return  # the reading thread notices the end, too

    def _read(self):
        try:
            stream, arrivals = self.process.stdout, itertools.count()
            while (message := read_message(stream)) is not None:
                message[0]["arrival"] = next(arrivals)
                if message[0]["type"] == "picture":
                    picture = Picture(*message)
                    with self._wake:
                        self._picture = picture
                else:
                    self.messages.put(message[0])
        finally:  # also after bytes that are not a message
            self.messages.put(None)


_kept = {}  # the process that renders pictures of a sequence, by its program


def run(command, cancelled, workspace=None):
    """Renders like program.run, but in a child process that is kept for the next picture. `command`: PROGRAM render
    ARGUMENT…"""
    program, _, *arguments = command
    # A child that hangs does not notice that its input has ended: the workspace's keeper ends the child then.
    note = workspace.note_program if workspace is not None else lambda number: None
    child = _kept.get(program)
    if child is None or child.process.poll() is not None:
        child = _kept[program] = Child(program, started=note)
    else:
        note(child.process.pid)
    printed = []
    child.send({"type": "render", "arguments": arguments})
    try:
        while True:
            try:
                head = child.messages.get(timeout=0.1)
            except queue.Empty:
                head = {"type": "nothing came"}
            if head is None:
                _kept.pop(program, None)  # forget() may have run meanwhile
                child.close()
                return child.process.returncode, "".join(printed)
            if head["type"] == "done":
                return head["code"], "".join(printed)
            if head["type"] == "say":
                printed.append(f"penumbra: {_LEVELS.get(head['level'], head['level'])}: {head['text']}\n")
            if cancelled():
                forget(now=True)
                return None, ""
    except BaseException:
        forget(now=True)
        raise
    finally:
        note("")


def forget(*_, now=False):
    """Ends the kept children: the sequence has no further picture."""
    while _kept:
        child = _kept.popitem()[1]
        child.kill() if now else child.close()
