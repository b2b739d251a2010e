# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads OpenEXR files of scan lines, uncompressed or zipped, so that tests depend on no picture library."""

import struct
import zlib

import numpy as np

_TYPES = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}
_LINES = {0: 1, 2: 1, 3: 16}  # compression: none, ZIPS, ZIP


def _unzip(content, size):
    if len(content) == size:  # kept as it was, where zipping did not help
        return content
    values = np.frombuffer(zlib.decompress(content), np.uint8).astype(np.int64)
    values[1:] -= 128
    values = np.cumsum(values).astype(np.uint8)
    half = (len(values) + 1) // 2
    result = np.empty(len(values), np.uint8)
    result[0::2], result[1::2] = values[:half], values[half:]
    return result.tobytes()


def read(path):
    """{channel: height × width array, row 0 at the bottom} of the data window, in file order."""
    content = open(path, "rb").read()
    assert content[:4] == b"\x76\x2f\x31\x01", f"{path} is no EXR file"
    at, attributes = 8, {}

    def string(at):
        end = content.index(b"\0", at)
        return content[at:end].decode(), end + 1

    while content[at]:
        name, at = string(at)
        _, at = string(at)
        size = struct.unpack_from("<I", content, at)[0]
        attributes[name] = content[at + 4 : at + 4 + size]
        at += 4 + size
    at += 1
    listed, channels = attributes["channels"], []
    start = 0
    while listed[start]:
        end = listed.index(b"\0", start)
        channels.append((listed[start:end].decode(), _TYPES[struct.unpack_from("<i", listed, end + 1)[0]]))
        start = end + 17
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    lines = _LINES[attributes["compression"][0]]
    result = {name: np.zeros((height, width), np.float32) for name, _ in channels}
    row = sum(kind.itemsize for _, kind in channels) * width
    for offset in struct.unpack_from(f"<{-(-height // lines)}Q", content, at):
        y, size = struct.unpack_from("<iI", content, offset)
        count = min(lines, y1 - y + 1)
        block = content[offset + 8 : offset + 8 + size]
        if lines > 1 or attributes["compression"][0]:
            block = _unzip(block, row * count)
        place = 0
        for k in range(count):
            for name, kind in channels:
                values = np.frombuffer(block, kind, width, place)
                result[name][y1 - y - k] = values
                place += values.nbytes
    return result


def image(channels, prefix=""):
    """height × width × channels of R, G, B (and A) whose names start with prefix."""
    return np.stack([channels[prefix + letter] for letter in "RGBA" if prefix + letter in channels], axis=-1)
