# SPDX-License-Identifier: GPL-3.0-or-later
"""The committed scenes are what their scripts and the exporter make today."""

import pathlib
import subprocess

import bpy
import pytest
from glb import Glb

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = sorted(path.stem for path in (ROOT / "scenes").glob("*.glb"))

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not bpy.app.binary_path, reason="scripts/make-scenes runs the application"),
]


def assert_same(made, kept, where):
    """JSON against JSON; numbers by 1e-4, as meshes that modifiers make differ in their last digits from run to run."""
    if isinstance(kept, float) or isinstance(made, float):
        assert made == pytest.approx(kept, rel=1e-4, abs=1e-5), where
    elif isinstance(kept, dict) and isinstance(made, dict):
        assert set(made) == set(kept), where
        for key in kept:
            assert_same(made[key], kept[key], f"{where}.{key}")
    elif isinstance(kept, list) and isinstance(made, list):
        assert len(made) == len(kept), where
        for index, (one, other) in enumerate(zip(made, kept, strict=True)):
            assert_same(one, other, f"{where}[{index}]")
    else:
        assert made == kept, where


@pytest.mark.parametrize("name", SCENES)
def test_committed(name, tmp_path):
    made = tmp_path / f"{name}.glb"
    command = [bpy.app.binary_path, "-b", "--factory-startup", "--python-exit-code", "1", "--python"]
    subprocess.run([*command, ROOT / "scenes/export.py", "--", name, made], check=True, timeout=300)
    fresh, kept = Glb(made).json, Glb(ROOT / "scenes" / f"{name}.glb").json
    for document in (fresh, kept):
        for key in ("buffers", "bufferViews"):  # compressed pictures differ in length from library to library
            document.pop(key)
    assert_same(fresh, kept, name)
