# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on is registered once for all tests, and unregistered at the end: bpy does not exit otherwise.

TRIPTYCH_LIBRARY names the library (build/lib/libtriptych.so by default), TRIPTYCH_CLI the command (build/bin/triptych).
"""

import os
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "blender_addon"), str(Path(__file__).parent)]
os.environ.setdefault("TRIPTYCH_LIBRARY", str(ROOT / "build/lib/libtriptych.so"))


def pytest_collection_modifyitems(items):
    from triptych import abi

    why = abi.missing()
    for item in items:
        if why and item.get_closest_marker("library"):
            item.add_marker(pytest.mark.skip(reason=why))


@pytest.fixture(scope="session", autouse=True)
def addon():
    import triptych

    triptych.register()
    yield triptych
    triptych.unregister()


@pytest.fixture
def scene(addon):
    """An empty scene of 64 × 48 pixels that Triptych renders, with a black world and no camera."""
    import bpy
    import stage

    bpy.ops.wm.read_factory_settings(use_empty=True)
    stage.prepare(bpy.context.scene)
    return bpy.context.scene


@pytest.fixture(scope="session")
def cli():
    path = Path(os.environ.get("TRIPTYCH_CLI", ROOT / "build/bin/triptych"))
    if not path.is_file():
        pytest.skip(f"no command at {path}")
    return str(path)
