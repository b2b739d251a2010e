# SPDX-License-Identifier: GPL-3.0-or-later
"""What benchmarks in Python share: what processes cost, how far pictures are apart, and figures as lines of JSON."""

import argparse
import json
import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tests" / "blender"))
import exr  # noqa: E402


def arguments(description):
    """A parser of what scripts/bench hands to every benchmark."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build", help="a build directory")
    parser.add_argument("--threads", type=int, default=2, help="of both sides")
    parser.add_argument("--repeats", type=int, default=5, help="medians of so many")
    return parser


def cpu_seconds(who=resource.RUSAGE_SELF):
    """Of this process, or of its children that have ended (RUSAGE_CHILDREN)."""
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


def cost_of(command, folder):
    """(wall seconds, CPU seconds, what it printed on standard error) of a command in that folder."""
    cpu, start = cpu_seconds(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    wall = time.monotonic() - start
    if done.returncode:
        raise SystemExit(f"{command[0]} ended with exit code {done.returncode}:\n{done.stderr}")
    return wall, cpu_seconds(resource.RUSAGE_CHILDREN) - cpu, done.stderr


def picture(path):
    """Height × width × 3 linear numbers of an OpenEXR file, row 0 at the bottom."""
    channels = exr.read(path)
    prefix = next(name[:-1] for name in channels if name == "R" or name.endswith("Combined.R"))
    return exr.image(channels, prefix)[..., :3].astype(np.float64)


def relative_error(image, reference):
    """relMSE, the mean of (I − R)² / (R² + 0.01)."""
    return float(np.mean((image - reference) ** 2 / (reference**2 + 0.01)))


def figure(name, value, unit, peer=None, peer_value=None, goal=None):
    """Prints a figure; its ratio is ours to the peer's, and the goal is the most that it may be."""
    ratio = value / peer_value if peer_value else None
    row = {"name": name, "value": value, "unit": unit, "peer": peer, "peer_value": peer_value, "ratio": ratio}
    print(json.dumps({**row, "goal": goal}), flush=True)
