# SPDX-License-Identifier: Apache-2.0
"""Tests that all presets configure, and that everything compiles as in a `clang`, `fuzz`, `coverage` and Debug build,
without building them:

    compilers.py SOURCE BUILD

clang checks all sources and their templates without generating code. g++ does the same without optimisation; sources
that Highway compiles once for each target are fully compiled, since errors in an intrinsic's immediate appear only when
code is generated, and only with precompiled headers. Sources are joined as run.sh joins them. BUILD must have
been built: shaders embedded as headers are taken from there. Takes eight minutes of two cores."""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

HIGHWAY = re.compile(rb"hwy/foreach_target\.h")


def configure(source, build, name, *options):
    """Returns the compile commands of the sources, in a separate folder; the embedded shaders are those of BUILD."""
    folder = os.path.join(build, name)
    command = ["cmake", "-S", source, "-B", folder, "-G", "Ninja", "-DPENUMBRA_TESTS=ON", *options]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(done.stdout)
    make_generated(folder)
    with open(os.path.join(folder, "compile_commands.json")) as file:
        entries = json.load(file)
    own = [entry for entry in entries if not entry["file"].startswith(build + os.sep) or f"{os.sep}Unity{os.sep}" in entry["file"]]
    for entry in own:
        entry["command"] = entry["command"].replace(os.path.join(folder, "shaders"), os.path.join(build, "shaders"))
    return folder, [entry for entry in own if entry["file"].endswith((".cpp", ".cxx"))]


def presets_that_fail(source, build):
    """Configures each preset that users may name. Returns how many fail."""
    with open(os.path.join(source, "CMakePresets.json")) as file:
        names = [preset["name"] for preset in json.load(file)["configurePresets"] if not preset.get("hidden")]
    failed = 0
    for name in names:
        folder = os.path.join(build, "compilers-preset")
        shutil.rmtree(folder, ignore_errors=True)
        done = subprocess.run(["cmake", "--preset", name, "-B", folder], cwd=source, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
        if done.returncode != 0:
            print(f"preset {name}:\n" + done.stdout, file=sys.stderr)
            failed += 1
    shutil.rmtree(folder, ignore_errors=True)
    print(f"style: {len(names)} presets, {failed} do not configure", flush=True)
    return failed


def make_generated(folder):
    """Makes the sources that the build generates, because joined files include them."""
    targets = subprocess.run(["ninja", "-C", folder, "-t", "targets", "all"], stdout=subprocess.PIPE, text=True, check=True).stdout
    written = [line.partition(": ")[0] for line in targets.splitlines() if line.endswith(": CUSTOM_COMMAND")]
    sources = [name for name in written if name.endswith(".cpp") and not os.path.isabs(name)]
    if sources:
        subprocess.run(["ninja", "-C", folder, *sources], stdout=subprocess.DEVNULL, check=True)


def is_highway(entry):
    with open(entry["file"], "rb") as file:
        return HIGHWAY.search(file.read()) is not None


def compile_one(entry, how):
    """Compiles one file and keeps no result. Returns the compiler's messages."""
    words = shlex.split(entry["command"])
    words[words.index("-o") + 1] = "/dev/null"
    done = subprocess.run([*words, *how], cwd=entry["directory"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return "" if done.returncode == 0 else f"{entry['file']}:\n" + "\n".join(done.stdout.splitlines()[:30])


def check(name, jobs):
    """Compiles on all cores and prints failures. Returns how many there are."""
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        failures = [text for text in pool.map(lambda job: compile_one(*job), jobs) if text]
    for text in failures:
        print(text, file=sys.stderr)
    print(f"style: {name}: {len(jobs)} files, {len(failures)} do not compile", flush=True)
    return len(failures)


def main(source, build):
    source, build = os.path.realpath(source), os.path.realpath(build)
    failed = presets_that_fail(source, build)
    _, clang = configure(source, build, "compilers-clang", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_C_COMPILER=clang",
                         "-DCMAKE_CXX_COMPILER=clang++", "-DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON", "-DPENUMBRA_JOIN=ON")
    failed += check("clang", [(entry, ["-fsyntax-only"]) for entry in clang])

    folder, debug = configure(source, build, "compilers-debug", "-DCMAKE_BUILD_TYPE=Debug")
    headers = subprocess.run(["ninja", "-C", folder, "penumbra_precompiled", "penumbra_precompiled_tests"],
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if headers.returncode != 0:
        sys.exit(headers.stdout)
    failed += check("g++ without optimisation",
                    [(entry, [] if is_highway(entry) else ["-fsyntax-only"]) for entry in debug])
    return failed


if __name__ == "__main__":
    sys.exit(1 if main(*sys.argv[1:]) else 0)
