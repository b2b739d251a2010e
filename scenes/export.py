# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds a scene of this folder and writes it as glTF by the add-on's exporter.

    blender -b --factory-startup --python-exit-code 1 --python scenes/export.py -- NAME OUTPUT.glb
    python scenes/export.py NAME OUTPUT.glb        with the module bpy
"""

import importlib
import pathlib
import sys

import bpy

HERE = pathlib.Path(__file__).resolve().parent


def main(arguments):
    if len(arguments) != 2:
        sys.exit("usage: export.py NAME OUTPUT.glb")
    name, output = arguments
    if not (HERE / f"{name}.py").is_file():
        sys.exit(f"export.py: error: no scene {name!r} in {HERE}")
    sys.dont_write_bytecode = True
    sys.path[:0] = [str(HERE), str(HERE.parent / "blender_addon")]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    importlib.import_module(name).build()
    bpy.context.view_layer.update()
    from triptych import gltf

    for warning in gltf.write(output, bpy.context.evaluated_depsgraph_get()):
        print(f"export.py: warning: {warning}", file=sys.stderr)


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else sys.argv[1:])
