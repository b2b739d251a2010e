# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that the add-on makes to show what it found, which no picture has in it.

Each carries its own name as a custom property, so that a copy or what the user has renamed is the user's own.
"""

import bpy


def is_generated(made, mark=None):
    """Whether an object or collection is one of ours; mark: one of MARKS, or None for any."""
    marks = MARKS if mark is None else (mark,)
    return not made.library and any(made.get(one) == made.name for one in marks)


MARKS = ("triptych_radiosity_mesh", "triptych_radiosity_links", "triptych_radiosity")
MESH, LINKS, COLLECTION = MARKS


def find(scene, mark):
    """The object of a kind in a scene, or None."""
    return next((made for made in scene.objects if is_generated(made, mark)), None)


def find_or_make(scene, mark, name):
    """The object of a kind in a scene, its mesh empty where it is new; in the collection of all of them."""
    made = find(scene, mark)
    if made is None:
        made = bpy.data.objects.new(name, bpy.data.meshes.new(name))
        made[mark] = made.name
        made.hide_render = True
        _collection(scene).objects.link(made)
    return made


def _collection(scene):
    for collection in scene.collection.children_recursive:
        if is_generated(collection, COLLECTION):
            return collection
    made = bpy.data.collections.new("Triptych Radiosity")
    made[COLLECTION] = made.name
    made.hide_render = True
    scene.collection.children.link(made)
    return made


def remove(scene, *marks):
    """Removes the objects of these kinds, and their collection where the user has put nothing into it."""
    for mark in marks:
        made = find(scene, mark)
        if made is not None:
            mesh = made.data
            bpy.data.objects.remove(made)
            if not mesh.users:
                bpy.data.meshes.remove(mesh)
    for collection in scene.collection.children_recursive:
        if is_generated(collection, COLLECTION) and not (collection.objects or collection.children):
            bpy.data.collections.remove(collection)
            return
