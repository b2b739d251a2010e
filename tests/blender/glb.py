# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads back what gltf.py writes, and checks what the glTF specification asks of every file."""

import json
import os
import struct

import numpy as np
from triptych import gltf

_TYPES = {5126: "<f4", 5121: "<u1", 5123: "<u2", 5125: "<u4"}
_WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Glb:
    """json: the document; array(accessor): its numbers; extras(item): item's extras.triptych."""

    def __init__(self, path):
        content = open(path, "rb").read()
        magic, version, length = struct.unpack_from("<4sII", content)
        assert (magic, version, length) == (b"glTF", 2, len(content))
        size, kind = struct.unpack_from("<I4s", content, 12)
        assert kind == b"JSON" and size % 4 == 0
        self.json = json.loads(content[20 : 20 + size])
        self.binary = b""
        if len(content) > 20 + size:
            length, kind = struct.unpack_from("<I4s", content, 20 + size)
            assert kind == b"BIN\0" and length % 4 == 0
            self.binary = content[28 + size :]
            assert len(self.binary) == length == self.json["buffers"][0]["byteLength"]
        self._check()

    def _check(self):
        document = self.json
        assert document["asset"]["version"] == "2.0"
        for view in document.get("bufferViews", ()):
            assert view["byteOffset"] % 4 == 0 and view["byteOffset"] + view["byteLength"] <= len(self.binary)
        for index, accessor in enumerate(document.get("accessors", ())):
            values = self.array(index)
            if accessor["componentType"] == 5126:
                assert np.isfinite(values).all()
            if "min" in accessor:
                assert np.allclose(values.min(axis=0), accessor["min"])
                assert np.allclose(values.max(axis=0), accessor["max"])
        for mesh in document.get("meshes", ()):
            for primitive in mesh["primitives"]:
                attributes = primitive["attributes"]
                counts = {document["accessors"][accessor]["count"] for accessor in attributes.values()}
                assert len(counts) == 1 and "min" in document["accessors"][attributes["POSITION"]]
                assert self.array(primitive["indices"]).max() < counts.pop()
                if "NORMAL" in attributes:
                    assert np.allclose(np.linalg.norm(self.array(attributes["NORMAL"]), axis=1), 1, atol=5e-3)
        for node in document.get("nodes", ()):
            assert len(node["matrix"]) == 16 and node["matrix"][15] == 1
        for camera in document.get("cameras", ()):
            assert 0 < camera[camera["type"]]["znear"] < camera[camera["type"]]["zfar"]
        for texture in document.get("textures", ()):
            assert texture["source"] < len(document["images"]) and texture["sampler"] < len(document["samplers"])
        used = set(document.get("extensionsUsed", ()))
        for name in document.get("extensions", {}):
            assert name in used
        for item in (*document.get("materials", ()), *document.get("nodes", ())):
            assert set(item.get("extensions", {})) <= used

    def array(self, index):
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        width = _WIDTH[accessor["type"]]
        values = np.frombuffer(
            self.binary, _TYPES[accessor["componentType"]], accessor["count"] * width, view["byteOffset"]
        )
        assert values.nbytes == view["byteLength"]
        return values.reshape(-1, width) if width > 1 else values

    def image(self, index):
        view = self.json["bufferViews"][self.json["images"][index]["bufferView"]]
        return self.binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]

    @staticmethod
    def extras(item):
        return item.get("extras", {}).get("triptych", {})


def written(scene, tmp_path):
    """The Glb of a bpy.types.Scene, the only file in that folder."""
    path = tmp_path / "scene.glb"
    gltf.write(str(path), scene)
    assert os.listdir(tmp_path) == ["scene.glb"]
    return Glb(path)
