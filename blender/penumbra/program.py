# SPDX-License-Identifier: Apache-2.0
"""Runs the command-line program. Independent of Blender."""

import os
import queue
import re
import shutil
import subprocess
import tempfile
import threading

EXACT, SAMPLES = "EXACT", "SAMPLES"
BOX, BLACKMAN_HARRIS = "BOX", "BLACKMAN_HARRIS"


def find(wanted):
    """Returns the program's path: `wanted`, or else the value of PENUMBRA, or else the program on the shell's PATH."""
    for name in (wanted, os.environ.get("PENUMBRA", ""), "penumbra"):
        path = shutil.which(os.path.expanduser(name)) if name else None
        if path:
            return path
        if name == wanted and wanted:
            raise FileNotFoundError(f"there is no program {wanted}; set the path of penumbra in the add-on's preferences")
    raise FileNotFoundError("penumbra is not found; set its path in the add-on's preferences, or in the variable PENUMBRA")


# Layers for all passes except those of single lights: with hundreds of lights these would take longer than the picture.
_WITHOUT_LIGHTS = "beauty,V,Z,P,N,Crypto*"


def arguments(program, scene, picture, size, settings, moments=()):
    """Returns the command that renders the scene, or the mean over the files of `moments`. `settings`: exactness,
    light_samples, method, pixel_samples, pixel_filter, filter_width, light_cutoff, shading_normals, lenient, device,
    light_passes."""
    command = [program, "render", scene, "-o", picture, "--no-studio", "--size", f"{size[0]}x{size[1]}"]
    command += _of_shadows(settings)
    if int(settings.pixel_samples) > 1:
        command += ["--pixel-samples", str(settings.pixel_samples)]
        if settings.pixel_filter == BLACKMAN_HARRIS:
            command += ["--pixel-filter", "blackman-harris", "--filter-width", f"{settings.filter_width:.6g}"]
    if settings.light_cutoff > 0:
        command += ["--light-cutoff", f"{settings.light_cutoff:.6g}"]
    for moment in moments:
        command += ["--moment", moment]
    command += _of_surfaces(settings)
    if not settings.light_passes:
        command += ["--layers", _WITHOUT_LIGHTS]
    return command + ["--compression", "none"]  # only the add-on reads the file, and only once


def bake_arguments(program, scene, picture, mesh, settings):
    """Returns the command that bakes a mesh by its second texture coordinates. `settings`: those of `arguments` except
    the pixel settings, and bake_size, bake_margin."""
    return [program, "bake", scene, "-o", picture, "--no-studio", "--mesh", mesh, "--uv", "1", "--size", str(settings.bake_size),
            "--margin", str(settings.bake_margin), *_of_shadows(settings), *_of_surfaces(settings)]


def _of_shadows(settings):
    method = ["--method", settings.method] if settings.method else []
    return method + (["--light-samples", str(settings.light_samples)] if settings.exactness == SAMPLES else [])


def _of_surfaces(settings):
    normals = ["--normals", "shading" if settings.shading_normals else "geometric"]
    return normals + (["--lenient"] if settings.lenient else []) + (["--device", settings.device] if settings.device else [])


# Terms of the program's command line and files, and those of Blender's user interface that replace them.
_IN_BLENDER = (
    (re.compile(r"Shadows would be wrong: --lenient .*"), "Shadows would be wrong; 'Lenient' renders the scene nevertheless"),
    (re.compile(r"--lenient"), "'Lenient'"),
    (re.compile(r"--light-samples( N)?"), "'Light samples'"),
    (re.compile(r"--pixel-samples( N)?"), "'Pixel samples'"),
    (re.compile(r"--method( NAME)?"), "'Method'"),
    (re.compile(r"--device( NAME)?"), "'Device'"),
)


def messages(text, *files):
    """Returns the warnings, each once, and the error (or None) in the program's output. `files`: exchange files, whose names
    the messages omit."""
    warnings, errors = [], []
    for line in text.splitlines():
        kind, _, what = line.removeprefix("penumbra: ").partition(": ")
        for name in (name for file in files for name in (file, os.path.basename(file))):
            what = what.replace(f"{name}: ", "").replace(name, "the scene")
        for pattern, words in _IN_BLENDER:
            what = pattern.sub(words, what)
        if kind == "warning":
            warnings += [what] if what not in warnings else []
        elif kind == "error":
            errors.append(what)
    return warnings, "; ".join(errors) or None


# Shell script that ends when its input is closed, however this process ends. It then ends the running program and
# removes the folder. Each line of input is the program's process id, or empty if no program is running.
_KEEPER = """while read -r line; do program=$line; done
[ -n "$program" ] && kill "$program" && sleep 1
rm -rf -- "$1"
"""


class Workspace:
    """A folder for one frame's files, which is deleted even if this process is killed."""

    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="penumbra-")
        self._keeper = None
        if os.name == "posix":
            self._keeper = subprocess.Popen(["/bin/sh", "-c", _KEEPER, "sh", self.folder], stdin=subprocess.PIPE,
                                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)

    def note_program(self, number):
        """Tells the keeper the process id of the running program (`number`); "" after it has ended."""
        if self._keeper is not None:
            self._keeper.stdin.write(f"{number}\n".encode())
            self._keeper.stdin.flush()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        if self._keeper is not None:
            self._keeper.stdin.close()
            self._keeper.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


def run(command, cancelled, workspace=None):
    """Returns (exit code, printed text); the code is None if `cancelled()` became true, which ends the program."""
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                          text=True, errors="replace") as process:
        note = workspace.note_program if workspace is not None else lambda number: None
        note(process.pid)
        lines = queue.SimpleQueue()
        reader = threading.Thread(target=_read, args=(process.stderr, lines))
        reader.start()
        printed = []
        try:
            while True:
                try:
                    line = lines.get(timeout=0.1)
                except queue.Empty:
                    if cancelled():
                        return None, ""
                    continue
                if line is None:
                    return process.wait(), "".join(printed)
                printed.append(line)
        finally:
            if process.poll() is None:
                process.terminate()
            process.wait()
            reader.join()
            note("")


def _read(stream, lines):
    for line in stream:
        lines.put(line)
    lines.put(None)
