# SPDX-License-Identifier: GPL-3.0-or-later
"""A binary glTF 2.0 file (.glb) as it is written: a JSON document and one buffer, without a thought of scenes."""

import json
import os
import struct

import numpy as np

ARRAY_BUFFER, ELEMENT_BUFFER = 34962, 34963  # targets of buffer views: attributes of vertices, and indices

_FLOAT, _UINT8, _UINT16, _UINT32 = 5126, 5121, 5123, 5125
_COMPONENT = {"f4": _FLOAT, "u1": _UINT8, "u2": _UINT16, "u4": _UINT32}


class Glb:
    """`json` is the document; buffer views, accessors and extensions are added by the methods."""

    def __init__(self, asset):
        self.json = {"asset": asset, "scene": 0, "bufferViews": [], "accessors": []}
        self._binary = bytearray()
        self._extensions = set()

    def view(self, content, target=None):
        """The index of a buffer view of these bytes."""
        view = {"buffer": 0, "byteOffset": len(self._binary), "byteLength": len(content)}
        if target:
            view["target"] = target
        self._binary += content
        self._binary += b"\0" * (-len(self._binary) % 4)
        self.json["bufferViews"].append(view)
        return len(self.json["bufferViews"]) - 1

    def accessor(self, values, target=None, bounds=False):
        """The index of an accessor for n or n × 1..4 numbers; None for None or nothing. bounds: with min and max."""
        if values is None or not len(values):
            return None
        values = np.ascontiguousarray(values)
        kind = "SCALAR" if values.ndim == 1 else {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}[values.shape[1]]
        accessor = {
            "bufferView": self.view(values.tobytes(), target),
            "componentType": _COMPONENT[values.dtype.str[1:]],
            "count": len(values),
            "type": kind,
        }
        if bounds:
            accessor["min"], accessor["max"] = (
                [float(number) for number in np.atleast_1d(pick(axis=0))] for pick in (values.min, values.max)
            )
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def extend(self, item, name, content):
        """Gives an item of the document (or the document itself) an extension."""
        self._extensions.add(name)
        item.setdefault("extensions", {})[name] = content

    def content(self):
        """The bytes of the file."""
        if self._extensions:
            self.json["extensionsUsed"] = sorted(self._extensions)
        if self._binary:
            self.json["buffers"] = [{"byteLength": len(self._binary)}]
        document = {key: value for key, value in self.json.items() if value != []}
        text = json.dumps(document, separators=(",", ":"), allow_nan=False, ensure_ascii=False).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
        if self._binary:
            chunks += struct.pack("<II", len(self._binary), 0x004E4942) + self._binary
        return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks

    def write(self, path):
        """The file appears whole or not at all; its folder must exist. OSError where it cannot be written."""
        content = self.content()
        temporary = f"{path}.{os.getpid()}.part"
        try:
            with open(temporary, "wb") as file:
                file.write(content)
            os.replace(temporary, path)
        except OSError:
            if os.path.exists(temporary):
                os.remove(temporary)
            raise


def plain(value):
    """JSON of floats: the shortest text of what the core's float holds."""
    if isinstance(value, (tuple, list, np.ndarray)):
        return [plain(one) for one in value]
    if isinstance(value, (float, np.floating)):
        short = float(str(np.float32(value)))
        return int(short) if abs(short) < 1e6 and short == int(short) else short
    return value
