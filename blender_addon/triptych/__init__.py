# SPDX-License-Identifier: GPL-3.0-or-later
"""Triptych: a rasterizer, a ray tracer and a radiosity solver in one render engine.

The modules, in the order in which data walks through them:

    data        plain descriptions of what the core takes; no bpy, no ctypes
    compat      what differs between Blender's versions
    export_*    Blender's scene to data
    abi         the shared library's C interface in ctypes
    core        data to the shared library; with abi, the only ctypes
    gltf, gltf_mesh, glb        data to a .glb file, without the library
    engine, properties, panels      Blender's side: what is registered
    shading_sheet, lettering        a sheet that compares flat, Gouraud and Phong shading
    ray_tree, ray_tree_panel        the rays of a pixel as curves and as a list
    radiosity, radiosity_play, radiosity_panel      the solution that is kept from render to render, and step by step
    radiosity_mesh, radiosity_mesh_operators        it as meshes, which are `generated`: in no picture
"""

import atexit

bl_info = {
    "name": "Triptych",
    "author": "Triptych contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Render Properties > Render Engine",
    "description": "Rasterizer, ray tracer and radiosity side by side",
    "category": "Render",
}


def _modules():
    # Imported on demand, so that `import triptych.gltf` works in a script that never registers.
    from . import (
        engine,
        export_operator,
        panels,
        properties,
        radiosity,
        radiosity_mesh_operators,
        radiosity_panel,
        radiosity_play,
        ray_tree,
        ray_tree_panel,
        shading_sheet,
    )

    return (
        *(properties, engine, radiosity, panels, export_operator, shading_sheet, ray_tree, ray_tree_panel),
        *(radiosity_play, radiosity_mesh_operators, radiosity_panel),
    )


_registered = []


def register():
    """Registers everything; a second call without unregister() starts afresh. Needs no library."""
    import bpy

    unregister()
    if not bpy.app.binary_path:  # bpy as a module does not exit while an engine is registered
        atexit.register(unregister)
    try:
        for module in _modules():
            _registered.append(module)
            module.register()
    except BaseException:
        unregister()
        raise


def unregister():
    """Takes back what register() did. Nothing happens where nothing is registered."""
    while _registered:
        _registered.pop().unregister()
    atexit.unregister(unregister)
