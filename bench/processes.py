# SPDX-License-Identifier: Apache-2.0
"""Measures processor time and memory of a whole process, from its start to its end. Used by scripts that measure."""

import json
import platform
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

# A new process inherits the largest resident set of its parent as its own. So a small process starts the measured one,
# and waits for it.
STARTER = """
import json, os, subprocess, sys
process = subprocess.Popen(sys.argv[2:], stdin=subprocess.DEVNULL)
_, status, usage = os.wait4(process.pid, 0)
with open(sys.argv[1], "w") as file:
    json.dump([os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024], file)
"""


@dataclass
class Usage:
    seconds: float  # processor time, user and system, of the process and its children
    mebibytes: float  # the largest resident set among the process and its children


def usage_of(command, environment=None):
    """Runs `command`, which must exit with code 0, and returns its processor time and memory."""
    command = [str(part) for part in command]
    with tempfile.TemporaryFile() as log, tempfile.NamedTemporaryFile("r") as result:
        subprocess.run([sys.executable, "-S", "-c", STARTER, result.name, *command], stdin=subprocess.DEVNULL, stdout=log, stderr=log, env=environment, check=True)
        code, seconds, mebibytes = json.load(result)
        if code != 0:
            log.seek(0)
            raise SystemExit(f"{' '.join(command)}: exit code {code}\n{log.read().decode(errors='replace')[-2000:]}")
    return Usage(seconds, mebibytes)


def processor():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return platform.processor()
