"""Runs the command-line program. Knows nothing of Blender."""

import os
import shutil
import subprocess

EXACT, SAMPLES = "EXACT", "SAMPLES"
BOX, BLACKMAN_HARRIS = "BOX", "BLACKMAN_HARRIS"


def find(wanted):
    """The program's path: `wanted`, or else what PENUMBRA says, or else where the shell would find it."""
    for name in (wanted, os.environ.get("PENUMBRA", ""), "penumbra"):
        path = shutil.which(os.path.expanduser(name)) if name else None
        if path:
            return path
        if name == wanted and wanted:
            raise FileNotFoundError(f"there is no program {wanted}; say in the add-on's preferences where penumbra is")
    raise FileNotFoundError("penumbra is not found; say in the add-on's preferences where it is, or set PENUMBRA")


def arguments(program, scene, picture, size, settings):
    """The command. `settings`: exactness, light_samples, method, pixel_samples, pixel_filter, filter_width,
    shading_normals, lenient, device."""
    command = [program, "render", scene, "-o", picture, "--size", f"{size[0]}x{size[1]}"]
    if settings.method:
        command += ["--method", settings.method]
    if settings.exactness == SAMPLES:
        command += ["--light-samples", str(settings.light_samples)]
    if int(settings.pixel_samples) > 1:
        command += ["--pixel-samples", str(settings.pixel_samples)]
        if settings.pixel_filter == BLACKMAN_HARRIS:
            command += ["--pixel-filter", "blackman-harris", "--filter-width", f"{settings.filter_width:.6g}"]
    if settings.shading_normals:
        command += ["--normals", "shading"]
    if settings.lenient:
        command += ["--lenient"]
    if settings.device:
        command += ["--device", settings.device]
    return command


def messages(text):
    """Warnings, and the error (or None), of what the program printed."""
    warnings, errors = [], []
    for line in text.splitlines():
        kind, _, what = line.removeprefix("penumbra: ").partition(": ")
        if kind == "warning":
            warnings.append(what)
        elif kind == "error":
            errors.append(what)
    return warnings, "; ".join(errors) or None


def run(command, cancelled):
    """Returns (exit code, what it printed); the code is None if `cancelled()` came true meanwhile, which ends it."""
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                          text=True, errors="replace") as process:
        while True:
            try:
                _, printed = process.communicate(timeout=0.1)
                return process.returncode, printed
            except subprocess.TimeoutExpired:
                if cancelled():
                    process.terminate()
                    process.communicate()
                    return None, ""
