# SPDX-License-Identifier: Apache-2.0
"""Runs the example in the help of each command as a reader would, in a folder that has scenes/:

  examples.py PROGRAM SOURCE

`view` is started, and stopped when it has printed its address; `submit` is not run, since its example is for a farm."""

import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

NOT_RUN = {"submit"}


def example_of(program, command):
    text = subprocess.run([program, command, "--help"], check=True, capture_output=True, text=True, env={**os.environ, "COLUMNS": "100"}).stdout
    found = re.findall(r"^Example:\n  (.*)\n", text, re.M)
    assert len(found) == 1 and shlex.split(found[0])[:2] == ["penumbra", command], f"{command} --help: {found}"
    return found[0]


def view(example, folder):
    with subprocess.Popen(["bash", "-c", f"exec {example}"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
        line = process.stdout.readline()
        process.send_signal(signal.SIGINT)
        process.communicate()
    assert "http://127.0.0.1:" in line, f"{example}: {line}"


def main():
    program, source = (Path(argument).resolve() for argument in sys.argv[1:3])
    commands = subprocess.run([program, "completion", "commands"], check=True, capture_output=True, text=True).stdout.strip().split(";")
    assert len(commands) > 10, commands
    examples = {command: example_of(program, command) for command in commands}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scenes").symlink_to(source / "scenes")
        (folder / "bin").mkdir()
        penumbra = folder / "bin" / "penumbra"
        penumbra.write_text(f'#!/bin/sh\nexec {shlex.quote(str(program))} "$@"\n')
        penumbra.chmod(0o755)
        os.environ["PATH"] = f"{penumbra.parent}:{os.environ['PATH']}"
        for command in commands:
            if command == "view":
                view(examples[command], folder)
            elif command not in NOT_RUN:
                done = subprocess.run(["bash", "-c", examples[command]], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True)
                if done.returncode != 0:
                    sys.exit(f"{examples[command]}\nexit code {done.returncode}\n{done.stderr}")


main()
