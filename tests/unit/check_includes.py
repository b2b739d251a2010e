"""Fails on an include that runs uphill, and on a file that is too long to be read in one sitting.

Usage: check_includes.py CORE_FOLDER

The rooms of the core import each other in one order; the command line is a client of the C ABI and of nothing else.
"""

import re
import sys
from pathlib import Path

ROOMS = ["base", "scene", "geometry", "textures", "shading", "film", "raster", "radiosity", "trace", "api"]
ABI = "triptych/triptych.h"
CLIENTS = ["cli"]
SUFFIXES = {".h", ".c", ".cpp", ".hpp", ".inl"}
MOST_LINES = 500
# The ABI is documented where it is declared, and stays one header.
MAY_BE_LONG = {"include/" + ABI}

INCLUDE = re.compile(r'^\s*#\s*include\s+(?:"([^"]+)"|<([^>]+)>)')
# Highway includes a file again, once for each instruction set, by this name.
SELF = re.compile(r'^\s*#\s*define\s+HWY_TARGET_INCLUDE\s+"([^"]+)"')


def find_target(core, source, name, quoted):
    """The file of the core that an include means, relative to the core; None where it is of another library."""
    beside = source.parent / name
    if quoted and beside.is_file():
        return beside.resolve().relative_to(core)
    for root in (core, core / "include"):
        if (root / name).is_file():
            return (root / name).resolve().relative_to(core)
    return None


def fault_of(source, target, name):
    """What is wrong with an include between files relative to the core; None if it is allowed."""
    if target is None:
        # Ours by its first folder, but not there: a build would fail, unless the file is made by it.
        first = name.split("/")[0]
        return "there is no such file" if "/" in name and first in ROOMS + CLIENTS else None
    if target.as_posix() == "include/" + ABI:
        return None
    room, wanted = source.parts[0], target.parts[0]
    if room == wanted:
        return None
    if room == "include":
        return "the C ABI includes nothing of the core"
    if room in CLIENTS:
        return f"{room} is a client of {ABI} alone"
    if wanted in CLIENTS:
        return f"{wanted} is a client, from which the core takes nothing"
    if ROOMS.index(wanted) > ROOMS.index(room):
        return f"{wanted} comes after {room}"
    return None


def check_file(core, path):
    source = path.relative_to(core)
    lines = path.read_text(encoding="utf-8").splitlines()
    if len(lines) > MOST_LINES and source.as_posix() not in MAY_BE_LONG:
        yield f"{source}: {len(lines)} lines; at most {MOST_LINES}"
    for number, line in enumerate(lines, 1):
        if match := SELF.match(line):
            if match.group(1) != source.as_posix():
                yield f"{source}:{number}: HWY_TARGET_INCLUDE names {match.group(1)}"
            continue
        match = INCLUDE.match(line)
        if not match:
            continue
        name = match.group(1) or match.group(2)
        fault = fault_of(source, find_target(core, path, name, bool(match.group(1))), name)
        if fault:
            yield f"{source}:{number}: includes {name}: {fault}"


def main():
    core = Path(sys.argv[1]).resolve()
    faults = []
    files = sorted(p for p in core.rglob("*") if p.suffix in SUFFIXES)
    for path in files:
        room = path.relative_to(core).parts[0]
        if room not in ROOMS + CLIENTS + ["include"]:
            faults.append(f"{path.relative_to(core)}: {room} is no room of the house")
            continue
        faults.extend(check_file(core, path))
    if not files:
        faults.append(f"{core}: no source files")
    for fault in faults:
        print(fault)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
